#!/usr/bin/env bash
# Searches for inputs that upset a target, with libFuzzer under the address and undefined-behaviour
# sanitizers of clang.
#   tests/fuzz/run.sh ipp_server|ipp_grammar [RUNS]     RUNS: 1000000 by default
# What it finds lies in build/fuzz as crash-*; the target run with that file shows it again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
target=${1:?which target: ipp_server or ipp_grammar}
runs=${2:-1000000}
. .ci/packages.sh
ensure_packages $rondure_build_packages $rondure_test_libraries $rondure_fuzz_packages
flags="-fsanitize=address,undefined,fuzzer-no-link -fno-sanitize-recover=all"
cmake -S . -B build/fuzz -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_COMPILER=/usr/bin/clang++-14 \
  -DCMAKE_CXX_FLAGS="$flags" -DRONDURE_FUZZERS=ON >/dev/null
cmake --build build/fuzz --target "fuzz_$target" >/dev/null
corpus=build/fuzz/corpus_$target
mkdir -p "$corpus"
dialogue=tests/data/ipp_dme_dialogue/dialogue.txt
sed -n 's/^[CS]: //p' $dialogue | awk -v d="$corpus" '{ f = d "/seed" NR; printf "%s", $0 > f; close(f) }'
{ printf '\002'; sed -n 's/^C: //p' $dialogue | sed 's/$/\r/'; } >"$corpus/all"
exec "build/fuzz/tests/fuzz/fuzz_$target" -runs="$runs" -max_len=4096 -timeout=10 -rss_limit_mb=1024 \
  -artifact_prefix=build/fuzz/ "$corpus"
