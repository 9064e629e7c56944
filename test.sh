#!/usr/bin/env bash
# Builds and runs all tests with the release preset, then those of the rooms that compute and that read
# bytes from outside once more under the address and undefined-behaviour sanitizers. (Null pointers,
# alignment and sizes of objects are left to the address sanitizer: checked twice they cost a third of
# the build.)
#   ./test.sh               the tests every change must pass
#   ./test.sh --full        with the full counts behind the figures in docs/ (release preset only)
#   ./test.sh --sanitizers  all rooms under the sanitizers, but for the oracles of the fits
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. .ci/packages.sh
sanitized="core wire record fixture cmm fit fuzz"
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
if [ -z "${RONDURE_FULL:-}" ]; then
  build asan ON $(printf '%s_tests ' $sanitized)
  ctest --preset asan -R "^(${sanitized// /|})\\."
fi
