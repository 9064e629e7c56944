#!/usr/bin/env bash
# Builds and runs the tests.
#   ./test.sh                      what every change must pass: all rooms in release, then `doors`, one small program
#                                  under the address and undefined-behaviour sanitizers that reads whatever comes
#                                  from outside
#   ./test.sh ROOM...              the tests of these rooms (./test.sh fit evaluation)
#   ./test.sh --changed [COMMIT]   the tests of the rooms touched by uncommitted files and by the commits since COMMIT,
#                                  and of the rooms above them; COMMIT: by default the last one that passed ./test.sh
#   ./test.sh --sanitizers         all rooms under the address and undefined-behaviour sanitizers, but for what
#                                  tests/unsanitized.txt names
#   ./test.sh --full               all rooms in release with the full counts behind the figures in docs/, the oracles of
#                                  the fits and the judge of the intervals; then what runs in several threads under the
#                                  thread sanitizer: the record that a run and its live page share, the live page, the
#                                  evaluation
# What these tests find and what they miss: tests/faults/README.md.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
if [ -n "${RONDURE_REWRITE+set}" ]; then
  echo "RONDURE_REWRITE is set: the tests would write the files that they compare with. Unset it." >&2
  exit 2
fi
. .ci/packages.sh
rooms="core fit wire record fixture cmm plans evaluation reports web app usb house benchmarks fuzz browser package"

# Not run under the sanitizers.
unsanitized=$(grep -v -e '^#' -e '^$' tests/unsanitized.txt | sed 's/\./\\./g' | paste -sd '|')

usage() {
  sed -n '1,/^set /s/^#  \( .*\)/\1/p' test.sh
  echo "Rooms: $rooms" | fold -s -w 79
}
wrong() { usage >&2; exit 2; }

# Rooms that stand on ROOM: those whose CMakeLists.txt links it, and those above these.
above() {  # ROOM
  local found=" $1 " room more=yes
  while [ -n "$more" ]; do
    more=""
    for room in core fit wire record fixture cmm plans evaluation reports web app; do
      [[ "$found" == *" $room "* ]] && continue
      for below in $found; do
        if grep -qE "rondure::$below\b" "$room/CMakeLists.txt"; then
          found+="$room " more=yes
          break
        fi
      done
    done
  done
  echo "$found"
}

# The rooms to test for a list of changed files on standard input, or "all".
rooms_of() {
  local file room found=" "
  while read -r file; do
    case "$file" in
      CMakeLists.txt | CMakePresets.json | tests/CMakeLists.txt | test.sh | .ci/* | tests/data/*) echo all; return ;;
      tests/*) room=${file#tests/} room=${room%%/*} ;;
      *) room=${file%%/*} ;;
    esac
    [[ "$file" != */error_model.* ]] || found+="$(above evaluation) "  # the one part of these rooms that it links
    case " $rooms " in
      *" $room "*) [[ "$file" == tests/* ]] && found+="$room " || found+="$(above "$room") " ;;
      *) found+="house " ;;  # documents
    esac
  done
  [ "$found" != " " ] || return 0
  # The tests of the program's devices and doors, and those of the pages, see what the program does.
  [[ "$found" != *" app "* ]] || found+="usb fuzz "
  [[ "$found" != *" reports "* && "$found" != *" web "* ]] || found+="browser "
  tr ' ' '\n' <<<"$found house" | sort -u | tr '\n' ' '
}

# Runs tests, and says of every one that was skipped why.
run_tests() {  # PRESET [ARGUMENT OF CTEST]...
  local status=0 log=build/$1/Testing/Temporary/LastTest.log
  rm -f "$log"
  ctest --preset "$@" || status=$?
  [ ! -f "$log" ] || awk '
    /^[0-9]+\/[0-9]+ Testing: / { sub(/^[^:]*: /, ""); name = $0 }
    skipped { print "skipped: " name ": " $0; skipped = 0 }
    /: Skipped$/ { skipped = 1 }
    /^(SKIPPED|skipped): / { sub(/^[^:]*: /, ""); print "skipped: " name ": " $0 }' "$log"
  return $status
}

# Builds and runs the tests of rooms.
test_rooms() {  # ROOM...
  local room targets=()
  for room in "$@"; do
    [[ " $rooms " == *" $room "* ]] || { echo "There is no room '$room'. Rooms: $rooms" | fold -s -w 79 >&2; exit 2; }
    case "$room" in
      browser | package) targets+=(rondure) ;;
      *) targets+=("${room}_tests") ;;
    esac
  done
  build release ON "${targets[@]}"
  local IFS="|"
  run_tests release -R "^($*)\\."
}

# What the tests start comes while the compiler works, where nobody has to be asked for a password. Everything but the
# browser tests runs also without Chromium.
fetch_programs() {
  fetching="" browser="" log=$(new_log programs)
  if [ "$(id -u)" -eq 0 ]; then
    (ensure_packages $rondure_test_programs; ensure_packages $rondure_browser_packages) >"$log" 2>&1 &
    fetching=$!
  else
    ensure_packages $rondure_test_programs
    (ensure_packages $rondure_browser_packages) || browser=none
  fi
}
await_programs() {
  [ -z "$fetching" ] || wait "$fetching" || { cat "$log" >&2; browser=none; }
  rm -f "$log"
  ensure_packages $rondure_test_programs
  [ "$browser" != none ] || echo "Without these packages the browser tests are skipped." >&2
}

# The commit that last passed ./test.sh here, with nothing uncommitted.
passed=build/release/passed
clean() { [ -z "$(git status --porcelain 2>/dev/null || echo unknown)" ]; }

changed_rooms() {  # [COMMIT]
  local since=${1:-$(cat $passed 2>/dev/null || true)}
  if [ -z "$since" ]; then
    echo "No commit has passed ./test.sh here yet: all rooms." >&2
    echo all
    return
  fi
  git rev-parse --quiet --verify "$since^{commit}" >/dev/null || { echo "There is no commit '$since'." >&2; exit 2; }
  { git diff --name-only "$since"; git ls-files --others --exclude-standard; } | rooms_of
}

case "${1:-}" in
  "" | --full | --sanitizers) [ $# -le 1 ] || wrong ;;
  --changed) [ $# -le 2 ] || wrong ;;
  -h | --help) usage; exit ;;
  -*) wrong ;;
esac
ensure_packages $rondure_build_packages $rondure_test_libraries
[ $# -eq 0 ] && mode=all || mode=$1
if [ "$mode" = --changed ]; then
  changed=$(changed_rooms "${2:-}")
  set -- $changed
  [ $# -gt 0 ] || { echo "Nothing has changed."; exit 0; }
  echo "Rooms: $*"
  [ "$1" != all ] || mode=all
fi
case "$mode" in
  --sanitizers)
    ensure_packages $rondure_test_programs
    build asan ON all
    echo "Not run under the sanitizers: tests/unsanitized.txt"
    run_tests asan -E "$unsanitized"
    ;;
  all | --full)
    fetch_programs
    ;;&
  all)
    clean && commit=$(git rev-parse HEAD) || commit=""
    build release ON all
    await_programs
    # The tests wait for much and leave room on two cores: `doors` is built meanwhile, at the lowest priority, in a
    # process group of its own.
    set -m
    (renice -n 19 "$BASHPID"; build doors ON doors_tests) >/dev/null 2>&1 &
    doors=$!
    set +m
    trap 'kill -- "-$doors" 2>/dev/null || true' EXIT
    run_tests release
    wait "$doors" || true
    build doors ON doors_tests  # nothing is left to do, or it says what went wrong
    run_tests doors
    [ -z "$commit" ] || echo "$commit" >$passed
    ;;
  --full)
    export RONDURE_FULL=1
    build release ON all
    await_programs
    run_tests release
    build tsan ON threads_tests
    unset RONDURE_FULL
    run_tests tsan -R "^threads\.(GrowingRecord|Live|Uncertainty\.HasTheSameNumbersAtAnyThreadCount)"
    ;;
  *)
    ensure_packages $rondure_test_programs
    test_rooms "$@"
    ;;
esac
