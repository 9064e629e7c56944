#!/usr/bin/env bash
# Builds the benchmarks, runs them, judges the gates and writes the table of docs/developer/performance.md.
#   ./benchmarks/run.sh [--quick | --full] [--allow-noise]
#     --quick        few and small sets: does everything run? Writes no table.
#     --full         1e7 points too
#     --allow-noise  a noisy machine is no failure; times are then not judged
# Exit status: that of benchmarks/gates.py.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
command="./benchmarks/run.sh${*:+ $*}"
extent="" noise="" repetitions=9 doc="--doc docs/developer/performance.md"
for argument in "$@"; do
  case "$argument" in
    --quick) extent=--quick repetitions=2 doc=--partial ;;
    --full) extent=--full ;;
    --allow-noise) noise=--allow-noise ;;
    *) echo "usage: ./benchmarks/run.sh [--quick | --full] [--allow-noise]" >&2; exit 2 ;;
  esac
done

. .ci/packages.sh
ensure_packages $rondure_build_packages $rondure_benchmark_packages
build bench OFF rondure_benchmarks

# The build itself is load; wait for it to fade, two minutes at most.
for _ in $(seq 24); do
  [ "$extent" != --quick ] && [ -z "$noise" ] || break
  awk '{ exit !($1 > 0.9) }' /proc/loadavg || break
  sleep 5
done

json=build/bench/benchmarks.json
build/bench/benchmarks/rondure_benchmarks $extent \
  --benchmark_repetitions=$repetitions --benchmark_enable_random_interleaving=true \
  --benchmark_report_aggregates_only=true --benchmark_min_time=0.02 \
  --benchmark_out_format=json --benchmark_out=$json >build/bench/benchmarks.txt
exec python3 benchmarks/gates.py $json $doc $noise --command "$command"
