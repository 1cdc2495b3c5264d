#!/usr/bin/env bash
# The last part of `make demo`: builds the page of the studio and says how to look at the teapot in it. FREIFORM names the
# program. The WebAssembly module takes longer to build than the program: it gets what is left of the demo's five minutes
# (DEMO_BEGAN: when they began), which is enough with many processors or a warm cache; what was compiled until then is
# kept. PAGE=yes builds it however long it takes, PAGE=no leaves it out. What is missing is said and is no failure.
set -euo pipefail
cd "$(dirname "$0")/.."
source tools/steps.sh
freiform=${FREIFORM:-build/bin/freiform}
page=studio/dist/index.html
kDemo=285 kRest=45  # seconds: of the demo; of these for npm and vite, which take 15 and 7

without() {
    echo "The page of the studio is not built: $*"
    echo "\`make studio\` installs what is missing, goes on where this ended, and builds it."
    exit 0
}

module() {
    cmake --preset wasm --log-level=WARNING && timeout --foreground "$1" cmake --build --preset wasm --target freiform
}

if [ ! -e "$page" ]; then
    [ "${PAGE:-}" != no ] || without "PAGE is no."
    command -v npm >/dev/null || without "npm is not there."
    if [ ! -e bindings/wasm/freiform.wasm ]; then
        command -v clang++-22 >/dev/null || without "clang-22, which makes its WebAssembly module, is not there."
        [ -e "$(clang++-22 -Wno-deprecated --target=wasm32-wasi -print-file-name=libc++.a)" ] ||
            without "the C++ library for WebAssembly (libc++-22-dev-wasm32) is not there."
        left=$((kDemo - kRest - $(date +%s) + ${DEMO_BEGAN:-$(date +%s)}))
        [ "$left" -gt 0 ] || [ "${PAGE:-}" = yes ] || without "five minutes are over (PAGE=yes make demo takes longer)."
        [ "${PAGE:-}" != yes ] || left=0  # no limit
        (step "Page: the WebAssembly module" module "$left") ||
            without "its WebAssembly module is not finished (PAGE=yes make demo takes the time)."
    fi
    [ -e studio/node_modules ] || (step "Page: packages (npm)" npm ci --prefix studio --no-audit --no-fund --silent) ||
        without "npm could not fetch what it is made with."
    (cd studio && step "Page: put together" npx --no-install vite build --logLevel error) || without "it could not be put together."
fi
echo "The studio, a page in the browser of this machine:"
echo "  $(pwd)/$page"
echo "A first look at the teapot in it:"
echo "  $freiform view examples/teapot.bpt --page studio/dist"
