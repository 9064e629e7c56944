#!/usr/bin/env bash
# Builds rondure and runs it. Without arguments: the first example plan on the simulated CMM.
#   ./run.sh                                  the main job; says where the report is
#   ./run.sh fit cylinder points.csv --json   any other call of rondure
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/.ci/packages.sh"
ensure_packages $rondure_build_packages
(cd "$here" && build release OFF rondure)
trap - INT

if [ $# -gt 0 ]; then
  exec "$here/build/release/rondure" "$@"
fi
cd "$here"
exec build/release/rondure run plans/examples/01_spool_simulated.json
