#!/usr/bin/env bash
# run_examples.sh RONDURE SOURCE_FOLDER FOLDER: runs every example plan that needs no server once, with all formats that
# need no browser, for all tests that look at the outputs:
#   FOLDER/runs/NAME                   the run; examples of one part stand in one archive, in the order of their names
#   FOLDER/told/NAME.{status,out,err}  how it ended and what it said
set -euo pipefail
rondure=$1 source=$2 folder=$3
rm -rf "$folder"
mkdir -p "$folder/runs" "$folder/told"
for plan in "$source"/plans/examples/*.json; do
  if grep -q '"driver": "ippdme"' "$plan"; then continue; fi
  name=$(basename "$plan" .json)
  status=0
  "$rondure" run "$plan" --out "$folder/runs/$name" --format html,json,csv,qif,dmis \
    >"$folder/told/$name.out" 2>"$folder/told/$name.err" || status=$?
  echo "$status" >"$folder/told/$name.status"
  [ "$status" -le 1 ] || { echo "$name ended with status $status: $(cat "$folder/told/$name.err")"; exit 1; }
done
