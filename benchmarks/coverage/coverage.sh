#!/usr/bin/env bash
# Builds the judge of the intervals, runs it in several processes and prints its table. Started again it goes on
# where it was interrupted.
#   ./benchmarks/coverage/coverage.sh [--processes N] [options of coverage, see coverage --help]
#     --processes N  that share the work; one for each processor by default
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
processes=$(nproc)
if [ "${1:-}" = --processes ]; then
  processes=$2
  shift 2
fi

. .ci/packages.sh
ensure_packages $rondure_build_packages
build release OFF coverage
program=build/release/benchmarks/coverage/coverage
"$program" --selftest >build/release/benchmarks/coverage/selftest.txt ||
  { grep WRONG build/release/benchmarks/coverage/selftest.txt >&2; exit 1; }

running=()
trap 'kill "${running[@]}" 2>/dev/null || true; echo "Stopped. The next call goes on from here." >&2; exit 130' INT TERM
for ((i = 1; i <= processes; ++i)); do
  "$program" --part "$i/$processes" "$@" &
  running+=($!)
done
status=0
for process in "${running[@]}"; do wait "$process" || status=$?; done
[ $status -ne 0 ] || "$program" --table "$@"
exit $status
