#!/usr/bin/env bash
# The last part of `make demo`: builds the page of the studio, if its WebAssembly module is there, and says how to look
# at the teapot in it. The module itself takes longer to build than everything else in the demo: `make studio` does that.
# FREIFORM names the program.
set -euo pipefail
cd "$(dirname "$0")/.."
freiform=${FREIFORM:-build/bin/freiform}
page=studio/dist/index.html

if [ ! -e "$page" ]; then
    if ! command -v npm >/dev/null; then
        echo "The page of the studio is not built: npm is not there (apt-get install npm, then make studio)."
        exit 0
    fi
    if [ ! -e bindings/wasm/freiform.wasm ] && [ ! -e build-wasm/bin/freiform.wasm ]; then
        echo "The page of the studio is not built: its WebAssembly module is not there (make studio builds both)."
        exit 0
    fi
    [ -e studio/node_modules ] || npm ci --prefix studio --no-audit --no-fund --silent
    (cd studio && npx --no-install vite build --logLevel warn)
fi
echo "The studio, a page in the browser of this machine:"
echo "  $(pwd)/$page"
echo "A first look at the teapot in it:"
echo "  $freiform view examples/teapot.bpt --page studio/dist"
