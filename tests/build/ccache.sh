#!/usr/bin/env bash
# ccache with precompiled headers: a header of which only a comment changes is precompiled again, in this folder and in
# a second one, and what did not change is not. ccache.sh COMPILER; 77 where there is no ccache.
set -euo pipefail
cd "$(dirname "$0")/../.."
command -v ccache >/dev/null || { echo "ccache is not installed"; exit 77; }
root=$PWD
temp=$(mktemp -d)
trap 'rm -rf "$temp"' EXIT
unset "${!CCACHE_@}"  # what it counts must not depend on how it is called
export CCACHE_DIR=$temp/cache

misses() { ccache --print-stats | sed -n 's/^cache_miss\t//p'; }

# build FOLDER COMMENT NUMBER: a clone in that folder, with this comment in the header and this number in the source.
build() {
    rm -rf "${temp:?}/$1"
    mkdir "$temp/$1"
    cp tests/build/CMakeLists.txt "$temp/$1"
    printf '#pragma once\n// %s\nstruct Line {\n    int degree;\n};\n' "$2" >"$temp/$1/line.hpp"
    printf '#include "line.hpp"\nint degree(const Line& line) {\n    return line.degree + %s;\n}\n' "$3" >"$temp/$1/part.cpp"
    cmake -S "$temp/$1" -B "$temp/$1/build" -G Ninja -DFREIFORM_ROOT="$root" -DCMAKE_CXX_COMPILER="$compiler" >"$temp/log"
    cmake --build "$temp/$1/build" >"$temp/log" || { cat "$temp/log"; echo "$1, \"$2\", $3: does not build"; exit 1; }
}

# expect N: what was not in the cache since the last time, a precompiled header and a file being two.
seen=0
expect() {
    local now
    now=$(misses)
    [ $((now - seen)) = "$1" ] || { echo "$((now - seen)) files compiled, expected $1"; exit 1; }
    seen=$now
}

compiler=$1
# Precompiled headers of clang remember their folder.
of_clang=0
if "$compiler" --version | grep -q clang; then of_clang=1; fi
build first "a word" 1
expect 2
build first "a word" 1
expect 0
build second "a word" 1
expect $((2 * of_clang))
build first "two words" 2
expect 2
build second "two words" 3
expect $((1 + of_clang))
