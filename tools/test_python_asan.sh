#!/usr/bin/env bash
# tools/test_python_asan.sh [PYTEST ARGUMENTS]: the tests of the Python package with the address and undefined-behaviour
# sanitizers in the bindings: the only C++ that C++ tests do not run (the library runs under them in the preset asan).
# Takes the libraries of the preset dev. Leaks are not looked for: an interpreter keeps objects until it ends.
set -euo pipefail
cd "$(dirname "$0")/.."
cmake --preset dev --log-level=WARNING
cmake --build --preset dev --target freiform_python_asan_package
# Python does not bring the library of C++, where the sanitizer looks for what throws.
runtime="$(g++ -print-file-name=libasan.so) $(g++ -print-file-name=libstdc++.so.6)"
export PYTHONPATH=$PWD/build-dev/python-asan PYTHONDONTWRITEBYTECODE=1
export FREIFORM_OCCT_IMPORT=${FREIFORM_OCCT_IMPORT:-$PWD/build-dev/bin/freiform-occt-import}
export ASAN_OPTIONS=detect_leaks=0:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1
[ $# -gt 0 ] || set -- tests/python --ignore=tests/python/test_types.py --ignore=tests/python/test_headers.py
LD_PRELOAD=$runtime /usr/bin/python3 -m pytest -q --capture=sys -p no:cacheprovider "$@"
