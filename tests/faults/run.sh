#!/usr/bin/env bash
# Measures what the tests find: plants faults in a copy of the sources, and runs the tests once for each. See README.md.
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
    *) sed -n '2,9s/^# \?//p' "$0" >&2; exit 2 ;;
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
[ -f "build/$preset/build.ninja" ] ||
  cmake --preset "$preset" -DBUILD_TESTING=ON -DCMAKE_COMPILE_WARNING_AS_ERROR=OFF >"$work/configure-$preset.txt"
cmake --build --preset "$preset" --target $targets >"$work/build-$preset.txt" 2>&1 ||
  { tail -n 30 "$work/build-$preset.txt" >&2; exit 2; }

# Without a fault every test must pass. The slowest one says after what time a test hangs.
name=$suite-$preset${tests:+-$(tr -c 'a-zA-Z0-9\n' _ <<<"$tests")}
TMPDIR=$(mktemp -d)
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT
if [ ! -f "$work/sound-$name.xml" ]; then
  echo "The tests without a fault ($name)"
  ctest --preset "$preset" ${tests:+-R "$tests"} --repeat until-pass:2 --output-junit "$work/sound.xml" \
    </dev/null >"$work/sound-$name.txt" 2>&1 || {
    tail -n 30 "$work/sound-$name.txt" >&2
    echo "Without a fault not all tests pass: nothing is measured." >&2
    exit 2
  }
  mv "$work/sound.xml" "$work/sound-$name.xml"
fi
hangs_after=$(grep -o '<testcase [^>]*' "$work/sound-$name.xml" | sed 's/.* time="\([0-9.]*\)".*/\1/' |
  awk '{ if ($1 > most) most = $1 } END { print (most > 15 ? int(4 * most) : 60) }')
find "build/$preset" -name '*_tests.cmake' -o -name CTestTestfile.cmake |
  xargs sed -i -E "s/\bTIMEOUT \"?[0-9.]+\"?/TIMEOUT $hangs_after/"

# Once for each fault: the tests of its room, then those of the rooms above, then the others, until one fails.
rooms="core fit wire record fixture cmm plans evaluation reports web app"
results=$work/results-$name.tsv
[ -f "$results" ] || printf 'number\troom\tplace\tkind\tresult\ttest\tseconds\n' >"$results"
while IFS=$'\t' read -r number room place kind _; do
  [ "$number" != number ] && ! grep -q "^$number"$'\t' "$results" || continue
  [ -z "$only" ] || [[ ",$only," = *",$number,"* ]] || continue
  log=$work/fault-$number-$name.txt failed=build/$preset/Testing/Temporary/LastTestsFailed.log
  above=${rooms#*"$room"}  # with a space before each
  steps=(-R "^$room\\." -R "^(above${above// /|})\\." -E "^($room${above// /|})\\.")
  [ -z "$tests" ] || steps=(-R "$tests")
  start=$SECONDS result="not found" test=""
  rm -rf "$log" "${TMPDIR:?}"/*
  for ((step = 0; step < ${#steps[@]}; step += 2)); do
    rm -f "$failed"
    RONDURE_FAULT=$number ctest --preset "$preset" --stop-on-failure --no-tests=ignore --repeat until-pass:2 \
      --timeout "$hangs_after" "${steps[@]:step:2}" </dev/null >>"$log" 2>&1 && continue
    [ -s "$failed" ] || { echo "ctest did not run: see $log" >&2; exit 2; }
    result=found test=$(head -n 1 "$failed" | cut -d: -f2-)
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
