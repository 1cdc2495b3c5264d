#!/usr/bin/env bash
# The last part of `make demo`: builds the page of the studio and says how to look at the teapot in it. FREIFORM names the
# program. The WebAssembly module takes longer to build than the program, so it is built where the processors are enough
# to end within five minutes of the demo's start (DEMO_BEGAN), or where PAGE=yes asks for it; PAGE=no leaves the page out.
# What is missing is said and is no failure.
set -euo pipefail
cd "$(dirname "$0")/.."
source tools/steps.sh
freiform=${FREIFORM:-build/bin/freiform}
page=studio/dist/index.html
kDemo=300 kModule=600 kRest=45  # seconds: of the demo; of one processor for the module; for npm and vite

without() {
    echo "The page of the studio is not built: $*"
    echo "\`make studio\` installs what is missing and builds it."
    exit 0
}

module() {
    cmake --preset wasm --log-level=WARNING && cmake --build --preset wasm --target freiform
}

if [ ! -e "$page" ]; then
    [ "${PAGE:-}" != no ] || without "PAGE is no."
    command -v npm >/dev/null || without "npm is not there."
    if [ ! -e bindings/wasm/freiform.packed ]; then
        command -v clang++-22 >/dev/null || without "clang-22, which makes its WebAssembly module, is not there."
        command -v xz >/dev/null || without "xz, which packs its WebAssembly module, is not there."
        [ -e "$(clang++-22 -Wno-deprecated --target=wasm32-wasi -print-file-name=libc++.a)" ] ||
            without "the C++ library for WebAssembly (libc++-22-dev-wasm32) is not there."
        ends=$(($(date +%s) + kModule / $(nproc) + kRest))
        [ "${PAGE:-}" = yes ] || [ "$ends" -le $((${DEMO_BEGAN:-$(date +%s)} + kDemo)) ] ||
            without "it would take $(((ends - $(date +%s)) / 60 + 1)) minutes more (PAGE=yes make demo takes them)."
        (step "Page: the WebAssembly module" module) || without "its WebAssembly module could not be made."
    fi
    [ -e studio/node_modules ] || (step "Page: packages (npm)" npm ci --prefix studio --no-audit --no-fund --silent) ||
        without "npm could not fetch what it is made with."
    (cd studio && step "Page: put together" npx --no-install vite build --logLevel error) || without "it could not be put together."
fi
echo "The studio, a page in the browser of this machine:"
echo "  $(pwd)/$page"
echo "A first look at the teapot in it:"
echo "  $freiform view examples/teapot.bpt --page studio/dist"
