#!/usr/bin/env bash
# Makes the pictures of README and docs: the paths of example plan 01 and of the first plan, the report of 01 on a screen, in dark, narrow,
# in Chinese, on paper and with numbered parts, each below 300 kB. Needs a release build and the packages of the browser tests
# (tests/browser/README.md), imagemagick, poppler-utils and, for Chinese, fonts-noto-cjk.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build/release/rondure plan plans/examples/01_spool_simulated.json --svg docs/pictures/planning.svg >/dev/null

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sed -n '/^```json/,/^```/{/^```/d;p}' docs/first-plan.md >"$work/first.json"
build/release/rondure plan "$work/first.json" --svg docs/pictures/first-plan.svg >/dev/null
export RONDURE_BINARY=$PWD/build/release/rondure RONDURE_SOURCE_DIR=$PWD RONDURE_PICTURES=$work
tests/browser/run.sh "$PWD/build/release/tests/browser/packages" ../../.ci/pictures.mjs

pdftoppm -r 60 -png -f 1 -l 3 "$work/print.pdf" "$work/page"
montage "$work"/page-*.png -tile 3x1 -geometry +10+10 -background '#c8ced4' "$work/print.png"
for picture in screen dark narrow chinese solid map print reading; do
  convert "$work/$picture.png" -strip -colors 96 "PNG8:docs/pictures/$picture.png"
done
find docs/pictures -name '*.png' -size +300k -exec echo "larger than 300 kB:" {} + -exec false {} +
