#!/usr/bin/env bash
# The last part of `make demo`: builds the page of the studio and says how to look at the teapot in it. Its WebAssembly
# module takes longer than all of the demo, so everything else has been shown before. What is missing for it is said
# and is no failure: the demo has succeeded without it. FREIFORM names the program; PAGE=no leaves the page out.
set -euo pipefail
cd "$(dirname "$0")/.."
source tools/steps.sh
freiform=${FREIFORM:-build/bin/freiform}
page=studio/dist/index.html

without() {
    echo "The page of the studio is not built: $*"
    echo "\`make studio\` installs what is missing and builds it."
    exit 0
}

module() {
    [ -e bindings/wasm/freiform.wasm ] && return 0
    echo "    The pictures above are finished; the page takes longer (docs/studio.md says how long). Ctrl+C leaves it"
    echo "    out, PAGE=no make demo from the start; make studio goes on where it was left."
    cmake --preset wasm --log-level=WARNING && cmake --build --preset wasm --target freiform
}

if [ ! -e "$page" ]; then
    [ "${PAGE:-yes}" != no ] || without "PAGE is no."
    command -v npm >/dev/null || without "npm is not there."
    if [ ! -e bindings/wasm/freiform.wasm ]; then
        command -v clang++-22 >/dev/null || without "clang-22, which makes its WebAssembly module, is not there."
        [ -e "$(clang++-22 -Wno-deprecated --target=wasm32-wasi -print-file-name=libc++.a)" ] ||
            without "the C++ library for WebAssembly (libc++-22-dev-wasm32) is not there."
    fi
    (step "Page: the WebAssembly module" module) || without "its WebAssembly module could not be made."
    [ -e studio/node_modules ] || (step "Page: packages (npm)" npm ci --prefix studio --no-audit --no-fund --silent) ||
        without "npm could not fetch what it is made with."
    (cd studio && step "Page: put together" npx --no-install vite build --logLevel warn) || without "it could not be put together."
fi
echo "The studio, a page in the browser of this machine:"
echo "  $(pwd)/$page"
echo "A first look at the teapot in it:"
echo "  $freiform view examples/teapot.bpt --page studio/dist"
