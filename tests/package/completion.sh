#!/usr/bin/env bash
# completion.sh RONDURE: bash takes its completion, and it proposes what --help says.
set -euo pipefail
rondure=$1
script=$(mktemp)
trap 'rm -f "$script"' EXIT
"$rondure" completion bash >"$script"
bash -n "$script"
. "$script"

# expect "WORDS TYPED" "A PROPOSAL" "WHAT MUST NOT BE PROPOSED": the last word typed is completed.
expect() {
  read -ra COMP_WORDS <<<"$1"
  [ "${1: -1}" != " " ] || COMP_WORDS+=("")
  COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
  COMPREPLY=()
  _rondure
  proposals=$(printf '%s\n' "${COMPREPLY[@]}")
  grep -qxF -e "$2" <<<"$proposals" || { echo "'$1' does not propose $2 but: $proposals"; exit 1; }
  [ -z "$3" ] || ! grep -qxF -e "$3" <<<"$proposals" || { echo "'$1' proposes $3"; exit 1; }
}
expect 'rondure ' validate --json
expect 'rondure ver' verify validate
expect 'rondure run --re' --resume --seed
expect 'rondure run plan.json --format ' qif --out
expect 'rondure fit ' cylinder validate
expect 'rondure fit ' roundness run
expect 'rondure fit roundness --cut' --cutoff-upr --reference
expect 'rondure fit roundness --filter ' robust mz
expect 'rondure completion ' bash run
verbs=$("$rondure" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p')
[ "$(wc -l <<<"$verbs")" -gt 10 ]
for verb in $verbs; do expect "rondure $verb" "$verb" ""; done
