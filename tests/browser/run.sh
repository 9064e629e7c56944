#!/usr/bin/env bash
# Runs one subject of the browser tests: run.sh FOLDER_FOR_PACKAGES SUBJECT.mjs. Ends with 77 (skipped)
# and a reason where Chromium or Node cannot be had.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
packages=$1
subject=$2

skip() {
  echo "SKIPPED: $1"
  exit 77
}
browser=$(command -v chromium || true)
[ -n "$browser" ] || skip "chromium is not installed and could not be (Debian package chromium)"
command -v node >/dev/null || skip "node is not installed and could not be (Debian package nodejs)"
[ "$(node -p 'process.versions.node.split(".")[0]')" -ge 18 ] || skip "node $(node --version) is older than 18"

# The packages of the lock file, installed once; another test may be at it.
mkdir -p "$packages"
exec 9>"$packages/lock"
flock 9
if ! cmp -s "$here/package-lock.json" "$packages/installed.json"; then
  command -v npm >/dev/null || skip "npm is not installed and could not be (Debian package npm)"
  cp "$here/package.json" "$here/package-lock.json" "$packages/"
  (cd "$packages" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >npm.log 2>&1) ||
    skip "npm could not fetch playwright-core and axe-core: $(tail -1 "$packages/npm.log")"
  cp "$here/package-lock.json" "$packages/installed.json"
fi
flock -u 9

export RONDURE_CHROMIUM=$browser RONDURE_NODE_MODULES=$packages/node_modules
exec node "$here/$subject"
