#!/usr/bin/env bash
# Compares two builds of the program, exactly: each example in every format, and each verb of `fit` on every table of
# tests/data and plans/examples.
#
#   tests/compare_builds.sh OLD NEW [FOLDER]     programs; what they wrote stays in FOLDER
#
# Of a run, times of the clock, ages, its id and the name of the build are left out; of a verb, its whole answer and its exit
# status count, refusals too. Exit status 1 where anything differs; each difference is named with its first lines.
set -euo pipefail
[ $# -ge 2 ] && [ $# -le 3 ] || { sed -n 's/^#  \( .*\)/\1/p' "$0" >&2; exit 2; }
old=$(realpath -e "$1") new=$(realpath -e "$2")
folder=${3:-$(mktemp -d)}
mkdir -p "$folder"
folder=$(realpath -e "$folder")
cd "$(dirname "$0")/.."
formats=html,json,csv,qif,dmis,corrections

# What two runs of one build do not share, and the length of a text that held it.
without_build() {
  sed -E 's/[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9:]{8}Z/TIME/g; s/[0-9]{4}-[0-9]{2}-[0-9]{2} [0-9:]{5,8}/TIME/g
          s/[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}/ID/g; s/commit [0-9a-f]{7,40}/COMMIT/g; s/"commit": "[^"]*"/COMMIT/g
          s/\b[0-9a-f]{64}\b/SHA256/g; s/"age_days": [0-9.]+/DAYS/g' "$@"
}

examples() {  # PROGRAM INTO
  local plan name
  for plan in plans/examples/*.json; do
    name=$(basename "$plan" .json)
    [ "$name" != 02_spool_over_ippdme ] || continue  # needs a machine at the other end
    mkdir -p "$2/$name"
    (
      status=0
      "$1" run "$plan" --out "$2/$name/run" --archive none --format "$formats" --quiet >"$2/$name/said" 2>&1 </dev/null || status=$?
      echo "exit $status" >>"$2/$name/said"
    )
    find "$2/$name" -name journal.db -delete -o -name SHA256SUMS -delete -o -name trials.bin -delete
    find "$2/$name" -type f -print0 | while IFS= read -r -d '' file; do
      without_build "$file" | sed "s,$2,RUN,g" >"$file.kept"
      mv "$file.kept" "$file"
    done
  done
}

fits() {  # PROGRAM INTO
  local table verb status
  mkdir -p "$2"
  find tests/data plans/examples -name '*.csv' | sort | while read -r table; do
    for verb in circle cylinder cone sphere plane line roundness rotary-axes wheel spindle; do
      for json in "" --json; do
        status=0
        timeout 120 "$1" fit "$verb" "$table" $json >"$2/answer" 2>&1 </dev/null || status=$?
        echo "exit $status" >>"$2/answer"
        without_build "$2/answer" >"$2/${table//\//-}.$verb$json"
      done
    done
  done
  rm -f "$2/answer"
}

for build in old new; do
  rm -rf "${folder:?}/$build"
  examples "${!build}" "$folder/$build/examples"
  fits "${!build}" "$folder/$build/fits"
done
status=0
for what in examples fits; do
  all=$(cd "$folder" && find old/$what new/$what -type f | cut -d/ -f2- | sort -u)
  equal=0
  while read -r file; do
    if cmp -s "$folder/old/$file" "$folder/new/$file"; then
      equal=$((equal + 1))
    else
      status=1
      echo "$file:"
      diff "$folder/old/$file" "$folder/new/$file" 2>&1 | head -4 | cut -c 1-160 || true
    fi
  done <<<"$all"
  echo "$what: $equal of $(wc -l <<<"$all") files are equal"
done
exit $status
