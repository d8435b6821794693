#!/usr/bin/env bash
# Installs a build tree somewhere fresh, moves it, and builds a stranger's program against it, once with
# find_package and once with pkg-config.
# Usage: run.sh BUILD_DIR CXX_COMPILER
set -euo pipefail
build=$1
cxx=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/first" >"$work/install.log" || { cat "$work/install.log"; exit 1; }
mv "$work/first" "$work/moved" # an installed tree must not remember where it was

for file in bin/forager share/forager/scenes/4A.toml share/doc/forager/README.md include/forager/hal/error.hpp; do
  [ -e "$work/moved/$file" ] || { echo "not installed: $file"; exit 1; }
done
"$work/moved/bin/forager" --version

echo "== find_package"
cmake -S "$here" -B "$work/cmake" -G Ninja -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_PREFIX_PATH="$work/moved"
cmake --build "$work/cmake"
with_cmake=$("$work/cmake/consumer")

echo "== pkg-config"
pc=$(dirname "$(find "$work/moved" -name forager.pc)")
flags=$(PKG_CONFIG_PATH=$pc pkg-config --cflags --libs forager)
# shellcheck disable=SC2086 # the flags are words
"$cxx" -std=c++20 "$here/main.cpp" -o "$work/consumer" $flags
with_pkg_config=$("$work/consumer")

echo "find_package: $with_cmake"
echo "pkg-config:   $with_pkg_config"
expected="3034257bf7194e4000001a85 line http http://192.168.1.50:3161"
if [ "$with_cmake" != "$expected" ] || [ "$with_pkg_config" != "$expected" ]; then
  echo "expected:     $expected"
  exit 1
fi
