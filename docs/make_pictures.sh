#!/usr/bin/env bash
# Makes the pictures of README and docs: the first page of the report of example plan 01, and the way of its tip.
# Needs chromium and imagemagick (Debian packages).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build/release/rondure plan plans/examples/01_spool_simulated.json --svg docs/images/planning.svg
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
build/release/rondure run plans/examples/01_spool_simulated.json --out "$work/spool" --serial 0042 --quiet
sandbox=()
[ "$(id -u)" -eq 0 ] && sandbox=(--no-sandbox)
chromium --headless "${sandbox[@]}" --disable-gpu --no-first-run --disable-background-networking \
  --hide-scrollbars --force-device-scale-factor=1.5 --user-data-dir="$work/profile" \
  --window-size=960,1180 --screenshot="$work/report.png" "file://$work/spool/report.html" 2>/dev/null
convert "$work/report.png" -colors 64 -strip PNG8:docs/images/report.png
