#!/usr/bin/env bash
# debian.sh BUILD_FOLDER: both Debian packages are made; lintian finds no error in them, and what was promised is inside.
set -euo pipefail
build=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cpack --config "$build/CPackConfig.cmake" -B "$folder" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
ls -l "$folder"/*.deb
lintian --allow-root --fail-on error --tag-display-limit 0 "$folder"/*.deb
# One commit gives one package: nothing in it is as old as the build.
date=$(sed -n 's/.*set(ENV{SOURCE_DATE_EPOCH} \([0-9]*\)).*/\1/p' "$build/generated/package_date.cmake")
day=$(date -u -d "@$date" '+%Y-%m-%d %H:%M')
for package in "$folder"/*.deb; do
  ! TZ=UTC dpkg-deb -c "$package" | grep -v " $day " || { echo "these are not as old as the commit, $day"; exit 1; }
done
dpkg-deb --info "$folder"/rondure_*.deb
dpkg-deb -f "$folder"/rondure_*.deb Recommends | grep -qw chromium || { echo "chromium, which prints PDFs, is not recommended"; exit 1; }
dpkg-deb -f "$folder"/rondure_*.deb Depends | grep -qw libsoci-postgresql4.0 || { echo "what archives on a server load is not required"; exit 1; }
for package in "$folder"/*.deb; do dpkg-deb -x "$package" "$folder/root"; done
for file in bin/rondure lib/udev/rules.d/60-rondure.rules lib/cmake/rondure/rondureConfig.cmake lib/librondure_fit.a \
  include/rondure/fit/references/min_zone.h share/man/man1/rondure.1.gz share/bash-completion/completions/rondure \
  share/rondure/plans/schema/{plan,report}.schema.json share/doc/rondure/docs/plan.md share/doc/rondure/copyright; do
  [ -s "$folder/root/usr/$file" ] || { echo "missing: /usr/$file"; exit 1; }
done
cd "$folder"
# What a wrong index or an overrun would do is ended at once: canaries, checked copies, no writable table of addresses.
readelf -dlsW root/usr/bin/rondure >elf
for sign in __stack_chk_fail _chk@ BIND_NOW GNU_RELRO; do
  grep -q "$sign" elf || { echo "the program is not hardened: no $sign"; exit 1; }
done
! grep "NEEDED.*libpq" elf || { echo "a start of the program loads what only an archive on a server needs"; exit 1; }
for plan in root/usr/share/rondure/plans/examples/*.json; do root/usr/bin/rondure validate "$plan"; done
root/usr/bin/rondure run root/usr/share/rondure/plans/examples/09_axle_points_file.json --out run --archive none --quiet
root/usr/bin/rondure verify run
