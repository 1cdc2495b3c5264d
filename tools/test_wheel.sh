#!/usr/bin/env bash
# tools/test_wheel.sh [PACKAGE]: `pip install .` into a new environment without network, and the tests of the package from
# a folder outside of the tree. PACKAGE: a folder `freiform` that was built already, as build-dev/python/freiform. Without
# it all is built from a copy of the files that git knows; CMAKE_ARGS (-D..) goes to CMake.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
python=${PYTHON:-/usr/bin/python3}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
settings=()
if [ $# -ge 1 ]; then
    FREIFORM_PYTHON_PACKAGE=$(realpath "$1")
    export FREIFORM_PYTHON_PACKAGE
else
    root=$work/source
    mkdir "$root"
    git ls-files -z | tar -c --null -T - | tar -x -C "$root"
    if [ -n "${CMAKE_ARGS:-}" ]; then settings=(--config-settings "cmake-args=$CMAKE_ARGS"); fi
fi
# NumPy is the system's: there is no network to get it from.
"$python" -m venv --system-site-packages "$work/venv"
PIP_NO_INDEX=1 "$work/venv/bin/pip" --quiet --disable-pip-version-check install "${settings[@]}" "$root"
cp -r tests/python "$work/tests"
cd "$work"
unset PYTHONPATH
"$work/venv/bin/python" - <<'END'
import freiform as ff
assert "/venv/" in ff.__file__, ff.__file__
curve = ff.Curve([[0, 0], [1, 2], [3, 2], [4, 0]])
assert abs(ff.nearest(curve, [2, 3]).distance - 1.5) < 1e-12
END
"$work/venv/bin/python" -m pytest -q -p no:cacheprovider tests/test_manners.py tests/test_evaluation.py
echo "The wheel holds."
