#!/usr/bin/env bash
# tools/setup.sh [demo|python|test|bench|ci|wasm|studio]: installs the Debian packages that are missing for this purpose (default: demo).
# Does nothing, and takes no time, where all are there.
set -euo pipefail

build="g++ cmake ninja-build ccache pkg-config"
library="libtbb-dev libpugixml-dev libcli11-dev"
occt="libocct-data-exchange-dev"
gl="libegl-dev libepoxy-dev libegl-mesa0 libgl1-mesa-dri libpng-dev"
paint="libcairo2-dev fonts-dejavu-core"
font="libfreetype-dev libharfbuzz-dev libfontconfig-dev"
python="pybind11-dev python3-dev python3-numpy"
test="nlohmann-json3-dev $python python3-pytest python3-hypothesis python3-scipy mypy libgtest-dev librapidcheck-dev libboost-dev fonts-cantarell fonts-inter-variable"
wasm="clang-22 lld-22 binaryen xz-utils libc++-22-dev-wasm32 libc++abi-22-dev-wasm32 libclang-rt-22-dev-wasm32 wasi-libc"
ci="python3 python3-venv python3-pip gmsh blender inkscape libglfw3-dev xvfb xauth libclang-rt-22-dev clang-format g++-aarch64-linux-gnu qemu-user $wasm"
command -v node >/dev/null || ci="$ci nodejs"
command -v chromium >/dev/null || ci="$ci chromium"
bench="python3 gmsh-doc occt-misc fonts-noto-mono python3-scipy libsisl-dev libboost-dev libbenchmark-dev"

purpose=${1:-demo}
case $purpose in
    demo) packages="$build $library $occt $gl $paint $font" ;;
    python) packages="$build $library $gl $paint $font $python" ;;
    test) packages="$build $library $occt $gl $paint $font $test" ;;
    bench) packages="$build $library $occt $gl $paint $font $bench" ;;
    ci) packages="$build $library $occt $gl $paint $font $test $ci" ;;
    wasm) packages="$build $wasm"; command -v node >/dev/null || packages="$packages nodejs" ;;
    studio)
        packages="$build $wasm"
        command -v node >/dev/null || packages="$packages nodejs"
        command -v npm >/dev/null || packages="$packages npm"
        ;;
    *)
        echo "usage: tools/setup.sh [demo|python|test|bench|ci|wasm|studio]" >&2
        exit 2
        ;;
esac

what_for() {
    case $1 in
        g++) echo "the C++23 compiler (12 or newer)" ;;
        cmake) echo "configures the build (3.25 or newer)" ;;
        ninja-build) echo "runs the build" ;;
        ccache) echo "makes the second build quick" ;;
        pkg-config) echo "finds epoxy, EGL, cairo and FreeType" ;;
        libtbb-dev) echo "threads" ;;
        libpugixml-dev) echo "reads XML, for SVG" ;;
        nlohmann-json3-dev) echo "JSON as another library reads it, to test against" ;;
        libcli11-dev) echo "the options of the command line" ;;
        libocct-data-exchange-dev) echo "reads STEP, IGES and BREP (the largest: 400 MB)" ;;
        libegl-dev | libepoxy-dev) echo "OpenGL without a window, for pictures" ;;
        libegl-mesa0 | libgl1-mesa-dri) echo "OpenGL in software, for pictures without a graphics card" ;;
        libpng-dev) echo "writes pictures" ;;
        libglfw3-dev) echo "a window, for an example" ;;
        xvfb | xauth) echo "a screen in memory, to test that window on" ;;
        libcairo2-dev) echo "drawings as PDF and PNG" ;;
        fonts-dejavu-core) echo "the letters of drawings" ;;
        libfreetype-dev | libharfbuzz-dev | libfontconfig-dev) echo "outlines of letters, for text" ;;
        fonts-cantarell) echo "a font with cubics, to test on" ;;
        fonts-noto-mono) echo "a font with many letters, to measure on" ;;
        fonts-inter-variable) echo "a variable font, to test on" ;;
        pybind11-dev | python3-dev | python3-numpy) echo "the Python package" ;;
        python3-pytest | python3-hypothesis | mypy) echo "the tests of the Python package" ;;
        python3-venv | python3-pip) echo "the test of the wheel" ;;
        libgtest-dev | librapidcheck-dev) echo "the tests" ;;
        libboost-dev) echo "exact arithmetic to test against" ;;
        python3) echo "the checks of the source, the report of the benchmarks" ;;
        python3-scipy | libsisl-dev) echo "other libraries of curves, to compare with" ;;
        libbenchmark-dev) echo "measurements of kernels" ;;
        gmsh-doc | occt-misc) echo "models to compare on" ;;
        clang-22 | libclang-rt-22-dev) echo "the second compiler, with sanitizers" ;;
        g++-aarch64-linux-gnu | qemu-user) echo "the kernels for ARM, and a processor to test them on" ;;
        binaryen) echo "makes WebAssembly modules a fifth smaller (clang calls it where it is)" ;;
        nodejs) echo "runs the WebAssembly modules" ;;
        npm) echo "fetches what the page is built with" ;;
        chromium) echo "runs the WebAssembly modules and the page as a browser does" ;;
        gmsh) echo "measures the STEP and IGES files that are written" ;;
        blender) echo "measures the triangles that are written" ;;
        inkscape) echo "draws what is drawn, to compare pictures" ;;
        clang-format) echo "the format check" ;;
        *) echo "the WebAssembly build" ;;
    esac
}

if ! command -v dpkg-query >/dev/null; then
    echo "This is not Debian, so nothing is installed. Needed, by their Debian names: $packages"
    exit 0
fi

missing=()
# shellcheck disable=SC2086  # a list of words
present=" $(dpkg-query -W -f '${db:Status-Status}:${Package}\n' $packages 2>/dev/null | sed -n 's/^installed://p' | tr '\n' ' ' || true)"
for package in $packages; do
    [[ $present == *" $package "* ]] || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
    exit 0
fi

echo "Debian packages to install:"
for package in "${missing[@]}"; do
    printf '  %-28s %s\n' "$package" "$(what_for "$package")"
done

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "They need root, and there is no sudo. As root: apt-get install ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi
apt() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 "$@"
}
install() {
    apt install -y --no-install-recommends "${missing[@]}" >/dev/null
}
# A list of packages that is absent or old is the usual reason to fail: get it and try once more.
if ! { compgen -G '/var/lib/apt/lists/*Packages*' >/dev/null && install 2>/dev/null; }; then
    apt update
    if ! install; then
        echo "apt-get could not install them. By hand: apt-get install ${missing[*]}" >&2
        exit 1
    fi
fi
