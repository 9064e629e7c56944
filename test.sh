#!/usr/bin/env bash
# Builds and runs all tests: the release preset, then the same tests under the address and
# undefined-behaviour sanitizers, but for the oracles of the fits. (Null pointers, alignment and sizes
# of objects are left to the address sanitizer: checked twice they cost a third of the build.)
#   ./test.sh          the tests every change must pass
#   ./test.sh --full   with the full counts behind the figures in docs/ (release preset only)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. .ci/packages.sh
ensure_packages $rondure_build_packages $rondure_test_packages

case "${1:-}" in
  "") ;;
  --full) export RONDURE_FULL=1 ;;
  *) echo "usage: ./test.sh [--full]" >&2; exit 2 ;;
esac

build release ON all
ctest --preset release
if [ -z "${RONDURE_FULL:-}" ]; then
  build asan ON all
  ctest --preset asan
fi
