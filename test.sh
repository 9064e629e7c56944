#!/usr/bin/env bash
# Builds and runs all tests with the release preset, then those of all rooms once more under the address
# and undefined-behaviour sanitizers, but for what is named below. (Null pointers,
# alignment and sizes of objects are left to the address sanitizer: checked twice they cost a third of
# the build.)
#   ./test.sh               the tests every change must pass
#   ./test.sh --full        with the full counts behind the figures in docs/ (release preset), then what runs in
#                           several threads under the thread sanitizer: the record that a run and its live page
#                           share, the live page, the evaluation
#   ./test.sh --sanitizers  all rooms under the sanitizers, but for the oracles of the fits
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
if [ -n "${RONDURE_REWRITE+set}" ]; then
  echo "RONDURE_REWRITE is set: the tests would write the files that they compare with. Unset it." >&2
  exit 2
fi
. .ci/packages.sh
sanitized="core wire record fixture cmm fit plans evaluation reports web app fuzz"
# Figures of many trials and of time, held by the release build; and runs of the whole program that take long: what
# they do, the tests of plans, record and reports do within one process.
unsanitized="Prediction\\.WidthIs|Uncertainty\\.(DoesTen|ChangesWith|DoesNotDepend|HasTheSame)|Coverage\\."
unsanitized+="|EveryFlippedByteIsTold|PlantedShafts|PlanVerb\\.(Proposes|SaysWhatLimits|Predicts)"
unsanitized+="|app\\.(Killed|SmallDisk|FullDisk|Resume|Watch|Language|HardPlan)"
case "${1:-}" in
  "" | --sanitizers) ;;
  --full) export RONDURE_FULL=1 ;;
  *) echo "usage: ./test.sh [--full|--sanitizers]" >&2; exit 2 ;;
esac

ensure_packages $rondure_build_packages $rondure_test_packages
if [ "${1:-}" = --sanitizers ]; then
  build asan ON all
  exec ctest --preset asan
fi
# Everything else is tested also where there is no Chromium.
(ensure_packages $rondure_browser_packages) || echo "Without these packages the browser tests are skipped." >&2
build release ON all
ctest --preset release
if [ -n "${RONDURE_FULL:-}" ]; then
  build tsan ON record_tests web_tests evaluation_tests
  env -u RONDURE_FULL ctest --preset tsan -R "^(record\.GrowingRecord|web\.Live|evaluation\.Uncertainty\.HasTheSameNumbersAtAnyThreadCount)"
else
  build asan ON $(printf '%s_tests ' $sanitized)
  echo "Not run under the sanitizers (figures of many trials, and long runs of the program):" \
    "${unsanitized//\\/}"
  ctest --preset asan -R "^(${sanitized// /|})\\." -E "$unsanitized"
fi
