#!/usr/bin/env bash
# consumer.sh BUILD_FOLDER SOURCE_FOLDER: installs the fits into an empty folder; another CMake project finds them there,
# is built and gives the right number. A component that does not exist is refused by name.
set -euo pipefail
build=$1 source=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cmake --install "$build" --component development --prefix "$folder/installed" >"$folder/log"
configure() { cmake -S "$1" -B "$folder/build" -G Ninja -DCMAKE_PREFIX_PATH="$folder/installed" >"$folder/log" 2>&1; }
configure "$source/tests/consumer" || { cat "$folder/log"; exit 1; }
cmake --build "$folder/build"
"$folder/build/consumer"
if grep -rl "$source" "$folder/installed"; then
  echo "These installed files name the folder they were built from."
  exit 1
fi
mkdir "$folder/wrong"
sed 's/COMPONENTS fit/COMPONENTS nothing/' "$source/tests/consumer/CMakeLists.txt" >"$folder/wrong/CMakeLists.txt"
touch "$folder/wrong/main.cpp"
rm -rf "$folder/build"
if configure "$folder/wrong"; then
  echo "A component that does not exist was found."
  exit 1
fi
grep -q 'rondure has no component nothing' "$folder/log"
