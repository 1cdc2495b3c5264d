#!/usr/bin/env bash
# Uses the library from a project outside in four ways: installed and found by find_package, staged with DESTDIR,
# through pkg-config, and as a subdirectory. Takes what `make test` built.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
temp=$(mktemp -d)
trap 'rm -rf "$temp"' EXIT

[ -f build-dev/lib/libfreiform_core.a ] || { cmake --preset dev --log-level=WARNING && cmake --build --preset dev; } >/dev/null

# outside NAME ARGUMENT...: configures, builds and runs tests/install in a folder of its own.
outside() {
    local name=$1
    shift
    cp -r tests/install "$temp/$name"
    cmake -S "$temp/$name" -B "$temp/$name/build" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Debug "$@"
    cmake --build "$temp/$name/build" >"$temp/log" || { cat "$temp/log"; return 1; }
    printf '%-18s ' "$name:"
    "$temp/$name/build/outside"
}

cmake --install build-dev --prefix "$temp/installed" >/dev/null
outside find_package -DCMAKE_PREFIX_PATH="$temp/installed"

DESTDIR=$temp/stage cmake --install build-dev --prefix /usr >/dev/null
outside staged -DCMAKE_PREFIX_PATH="$temp/stage/usr"

export PKG_CONFIG_PATH
PKG_CONFIG_PATH=$(dirname "$(find "$temp/installed" -name freiform-core.pc)")
# shellcheck disable=SC2046  # a list of flags
g++ -std=c++23 tests/install/main.cpp $(pkg-config --cflags --libs freiform-core) -o "$temp/by_pkg_config"
printf '%-18s ' pkg-config:
"$temp/by_pkg_config"

outside add_subdirectory -DFREIFORM_ROOT="$root" -DFREIFORM_IO=OFF -DFREIFORM_UNITY=ON

# What was installed must not remember where it was built.
if grep -rlF -e "$root" -e "$temp" "$temp/stage/usr" --include='*.cmake' --include='*.pc' --include='*.hpp'; then
    echo "the files above name the folder of the build" >&2
    exit 1
fi
if [ -x "$temp/installed/bin/freiform" ]; then
    printf '%-18s ' program:
    "$temp/installed/bin/freiform" --version
fi
