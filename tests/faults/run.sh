#!/usr/bin/env bash
# Measures what the tests find: plants faults in a copy of the sources, and runs for each the tests that reach it. See
# README.md.
#   run.sh                         60 faults drawn by seed 1, and those by hand; goes on where it was stopped
#   run.sh --seed S --count N      other faults
#   run.sh --only 3,17             some of them
#   run.sh --suite full            the tests with the full counts
#   run.sh --preset asan [--targets "a_tests b_tests"] [--tests REGEX]   another build, or a part of it
#   run.sh --commit C --faults F --only 3,17   these faults of the table F, in the sources and tests of commit C
#   run.sh --work DIR              where the copy, the table of faults and the results are (default: build/faults)
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
seed=1 count=60 work=$root/build/faults suite=default only="" preset=release targets=all tests="" commit=HEAD faults=""
while [ $# -gt 0 ]; do
  case "$1" in
    --seed | --count | --work | --suite | --only | --preset | --targets | --tests | --commit | --faults) ;;
    *) sed -n '2,10s/^# \?//p' "$0" >&2; exit 2 ;;
  esac
  [ $# -ge 2 ] || { echo "$1 needs a value" >&2; exit 2; }
  printf -v "${1#--}" %s "$2"
  shift 2
done
[[ $suite = default || $suite = full ]] || { echo "--suite is default or full" >&2; exit 2; }
[ -z "$faults" ] || faults=$(realpath "$faults")
if [ "$suite" = full ]; then export RONDURE_FULL=1; else unset RONDURE_FULL; fi
unset RONDURE_FAULT RONDURE_REWRITE
trap 'exit 130' INT TERM

# The copy, instrumented: made once. The table is written last, and says that it is whole.
mkdir -p "$work"
work=$(cd "$work" && pwd)
tree=$work/tree table=$work/faults.tsv
asked="$(git -C "$root" rev-parse --verify "$commit^{commit}") ${faults:+$faults $only}"
[ -n "$faults" ] || asked+="seed $seed, $count faults"
if [ -f "$table" ] && [ "$asked" != "$(cat "$work/asked")" ]; then
  echo "$work holds other faults ($(cat "$work/asked")); give another --work, or remove it." >&2
  exit 2
fi
[ -d "$tree/.git" ] || git clone -q --no-checkout "$root" "$tree"
if [ ! -f "$table" ]; then
  echo "$asked" >"$work/asked"
  git -C "$tree" checkout -q -f --detach "${asked%% *}"
  (cd "$tree" && cmake --preset release -DBUILD_TESTING=ON -DCMAKE_COMPILE_WARNING_AS_ERROR=OFF) >"$work/configure.txt"
  if [ -n "$faults" ]; then
    "$here/draw.py" --tree "$tree" --apply "$faults" ${only:+--only "$only"} --out "$table"
  else
    "$here/draw.py" --tree "$tree" --seed "$seed" --count "$count" --out "$table"
  fi
fi
# Committed, so that the program names a commit, as in a clone that nobody changed.
git -C "$tree" diff --quiet ||
  git -C "$tree" -c user.name=faults -c user.email=faults@localhost commit -qam "Faults, switched by RONDURE_FAULT"

cd "$tree"
[ "$suite" = full ] && full=ON || full=OFF  # builds the oracles, too
grep -qs "^RONDURE_FULL:.*=$full" "build/$preset/CMakeCache.txt" ||
  cmake --preset "$preset" -DBUILD_TESTING=ON -DRONDURE_FULL=$full -DCMAKE_COMPILE_WARNING_AS_ERROR=OFF \
    >"$work/configure-$preset.txt"
cmake --build --preset "$preset" --target $targets >"$work/build-$preset.txt" 2>&1 ||
  { tail -n 30 "$work/build-$preset.txt" >&2; exit 2; }
tests_of() { find "build/$preset" -name '*_tests.cmake' -o -name CTestTestfile.cmake; }
# Each test says its name to the programs that it starts.
tests_of | xargs sed -i -E \
  '/RONDURE_FAULT_TEST/!s|^(add_test\(\[=*\[([^]]*)\]=*\] +)|\1/usr/bin/env [==[RONDURE_FAULT_TEST=\2]==] |'
ctest --preset "$preset" --show-only=json-v1 >"$work/tests.json"

# Without a fault every test must pass; meanwhile each says which faults it reaches. The slowest one says after what
# time a test hangs.
TMPDIR=$(mktemp -d)
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT
chmod 1777 "$TMPDIR"  # some tests start the program as another user
reach=$work/reach-$preset
mkdir -p "$reach"
chmod 1777 "$reach"
untraced=$("$here/reach.py" "$work/tests.json" "$reach" "$tests")
if [ -n "$untraced" ]; then
  echo "The tests without a fault"
  passed=yes
  env -u RONDURE_FULL RONDURE_FAULT_TRACE="$reach" ctest --preset "$preset" -I "$untraced" \
    --repeat until-pass:2 --output-junit "$work/sound.xml" </dev/null >"$work/sound-$preset.txt" 2>&1 || passed=no
  mv "$work/sound.xml" "$reach/$(date +%s).xml"
  [ $passed = yes ] || {
    tail -n 30 "$work/sound-$preset.txt" >&2
    echo "Without a fault not all tests pass: nothing is measured." >&2
    exit 2
  }
fi
hangs_after=$(grep -ho '<testcase [^>]*' "$reach"/*.xml | sed 's/.* time="\([0-9.]*\)".*/\1/' |
  awk '{ if ($1 > most) most = $1 } END { print (most > 15 ? int(4 * most) : 60) }')
[ "$suite" = default ] || hangs_after=600
tests_of | xargs sed -i -E "s/\bTIMEOUT \"?[0-9.]+\"?/TIMEOUT $hangs_after/"

# Once for each fault: of the tests that reach it the quick ones of its room, those of others, and the slow ones, until
# one fails.
name=$suite-$preset${tests:+-$(tr -c 'a-zA-Z0-9\n' _ <<<"$tests")}
results=$work/results-$name.tsv
[ -f "$results" ] || printf 'number\troom\tplace\tkind\tresult\ttest\tseconds\n' >"$results"
while IFS=$'\t' read -r number room place kind _; do
  [ "$number" != number ] && ! grep -q "^$number"$'\t' "$results" || continue
  [ -z "$only" ] || [[ ",$only," = *",$number,"* ]] || continue
  temporary=build/$preset/Testing/Temporary log=$work/fault-$number-$name.txt
  start=$SECONDS result="not reached" test="" failed=""
  rm -rf "$log" "${TMPDIR:?}"/*
  for step in $("$here/reach.py" "$work/tests.json" "$reach" "$tests" "$number" "$room"); do
    result="not found"
    rm -f "$temporary"/{LastTestsFailed.log,CTestCostData.txt}  # not the slow ones first
    RONDURE_FAULT=$number ctest --preset "$preset" -I "$step" --stop-on-failure \
      --repeat until-pass:2 --timeout "$hangs_after" </dev/null >>"$log" 2>&1 && continue
    IFS=: read -r failed test <"$temporary/LastTestsFailed.log" || [ -n "$failed" ] ||
      { echo "ctest did not run: see $log" >&2; exit 2; }
    ctest --preset "$preset" -I "0,0,0,$failed" </dev/null >>"$log" 2>&1 && result=found || result="fails without it"
    break
  done
  printf '%s\t' "$number" "$room" "$place" "$kind" "$result" "$test" | tee -a "$results"
  echo $((SECONDS - start)) | tee -a "$results"
done <"$table"

awk -F'\t' -v path="the $suite path ($preset)" '
  NR > 1 { hand = $4 ~ /^by hand/; all[hand]++; if ($5 == "found") found[hand]++; else missed[hand] = missed[hand] ", " $1 }
  END { for (hand = 0; hand < 2; hand++) if (all[hand]) {
    printf "faults%s: %d of %d found by %s", hand ? " by hand" : "", found[hand], all[hand], path
    print missed[hand] ? "; not found: " substr(missed[hand], 3) : "" } }' "$results"
