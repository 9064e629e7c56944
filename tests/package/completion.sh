#!/usr/bin/env bash
# completion.sh RONDURE: bash, zsh and fish take their completion, and it proposes what --help says.
set -euo pipefail
rondure=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export HOME=$folder
for shell in bash zsh fish; do
  "$rondure" completion $shell >"$folder/$shell"
  $shell -n "$folder/$shell"
done

# expect "WORDS TYPED" "A PROPOSAL" "WHAT MUST NOT BE PROPOSED": the last word typed is completed.
. "$folder/bash"
expect() {
  read -ra COMP_WORDS <<<"$1"
  [ "${1: -1}" != " " ] || COMP_WORDS+=("")
  COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
  COMPREPLY=()
  _rondure
  local in_fish
  in_fish=$(fish -c "source $folder/fish; complete -C'$1'" | cut -f1)
  for proposals in "${COMPREPLY[*]}" "$in_fish"; do
    grep -qxF -e "$2" <<<"${proposals// /$'\n'}" || { echo "'$1' does not propose $2 but: $proposals"; exit 1; }
    [ -z "$3" ] || ! grep -qxF -e "$3" <<<"${proposals// /$'\n'}" || { echo "'$1' proposes $3"; exit 1; }
  done
}
expect 'rondure ' validate --json
expect 'rondure ver' verify validate
expect 'rondure run --re' --resume --seed
expect 'rondure run plan.json --format ' qif --out
expect 'rondure fit ' cylinder validate
expect 'rondure fit ' roundness run
expect 'rondure fit roundness --cut' --cutoff-upr --reference
expect 'rondure fit roundness --filter ' robust mz
expect 'rondure completion ' fish run
verbs=$("$rondure" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p')
[ "$(wc -l <<<"$verbs")" -gt 10 ]
for verb in $verbs; do expect "rondure $verb" "$verb" ""; done

# zsh completes in a terminal only: its own function is asked what it hands to _arguments.
mkdir "$folder/functions"
cp "$folder/zsh" "$folder/functions/_rondure"
zsh -f -c "
  fpath=($folder/functions); autoload -Uz _rondure
  _arguments() { print -rl -- \"\$@\"; }
  words=(rondure fit roundness ''); CURRENT=4
  _rondure" >"$folder/arguments"
grep -q -- '--cutoff-upr\[' "$folder/arguments"
! grep -q -- '--resume\[' "$folder/arguments"
