#!/usr/bin/env bash
# tests/fuzz/run.sh NAME SECONDS [CORPUS]: builds tests/fuzz/NAME_fuzzer.cpp with libFuzzer and runs it. What it finds lies in build-fuzz/.
set -euo pipefail
cd "$(dirname "$0")/../.."
name=$1 seconds=$2
mkdir -p build-fuzz/unity
corpus=${3:-build-fuzz/corpus-$name}
mkdir -p "$corpus"
flags=(-std=c++23 -DFF_CHECKED=1 -ffp-contract=off -Iinclude -Isrc)
checks=(-O1 -g -fsanitize=address,undefined -fsanitize=fuzzer-no-link)
libraries=()
longest=1024
case $name in
    triangulate)
        sources=(src/mesh/triangulate*.cpp src/mesh/insertion_order.cpp src/poly/predicates*.cpp src/poly/integer.cpp
            src/core/text.cpp src/core/result.cpp) ;;
    step | rhino)  # The layers below from the preset asan: what is mixed here has to come from one compiler.
        cmake --preset asan >build-fuzz/configure.log
        cmake --build --preset asan --target freiform_core
        for file in src/io/step_*.cpp src/io/mesh_builder.cpp; do
            case $file in *step_write.cpp) ;; *) printf '#include "%s"\n' "$PWD/$file" ;; esac
        done >build-fuzz/unity/step.cpp
        sources=(build-fuzz/unity/step.cpp)
        if [ "$name" = rhino ]; then
            flags+=(-DFUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION)  # checksums: hardly any mutant has the right one
            printf '#include "%s"\n' "$PWD"/src/io/rhino_*.cpp >build-fuzz/unity/rhino.cpp
            sources+=(build-fuzz/unity/rhino.cpp src/io/{mesh_write,glb_write,glb_chunks,stl_write,obj_write,ply_write,json,json_write,file,file_memory}.cpp)  # units
        fi
        libraries=(build-asan/lib/libfreiform_core.a -ltbb)
        longest=16384 rss=1024
        seeds=(tests/data/step/*.stp ../shared/data/step_micro/*.stp)
        if [ "$name" = rhino ]; then seeds=(tests/data/3dm/*.3dm) longest=32768; fi
        cp -n "${seeds[@]}" "$corpus" 2>>build-fuzz/configure.log || true ;;
    *)  # One unit for each layer up to that of the fuzzed one.
        sources=(src/kernel/*.cpp)
        case $name in svg | font) own=path ;; gltf) own= ;; region) own="make path query intersect region" ;; intersect) own="make intersect" ;; *) own=$name ;; esac
        for layer in core poly basis spline $own; do
            printf '#include "%s"\n' "$PWD"/src/"$layer"/*.cpp >"build-fuzz/unity/$layer.cpp"
            sources+=("build-fuzz/unity/$layer.cpp")
        done
        if [ "$name" = svg ]; then
            printf '#include "%s"\n' "$PWD"/src/io/svg*.cpp >build-fuzz/unity/svg.cpp
            sources+=(build-fuzz/unity/svg.cpp)
            libraries=(-lpugixml)
        elif [ "$name" = region ]; then
            longest=96  # the most that it reads: longer inputs are slow without being others
        elif [ "$name" = gltf ]; then
            sources+=(src/io/gltf_animation.cpp src/io/json.cpp src/io/json_write.cpp src/io/file.cpp src/io/file_memory.cpp src/animate/rotation.cpp)
            longest=4096
        elif [ "$name" = font ]; then
            sources+=(src/font/freetype.cpp src/font/harfbuzz.cpp)
            # shellcheck disable=SC2207  # lists of flags
            flags+=($(pkg-config --cflags freetype2 harfbuzz)) libraries=($(pkg-config --libs freetype2 harfbuzz))
            longest=65536
            cp -n /usr/share/fonts/opentype/cantarell/*.otf "$corpus" 2>/dev/null || true
        fi ;;
esac
compile() {
    local extra=()
    case $1 in  # layers below take many minutes with sanitizers, and are not what is fuzzed
        src/kernel/* | */spline.cpp | */basis.cpp | */core.cpp | */query.cpp | */make.cpp) extra=(-O1) ;;
        *) extra=("${checks[@]}") ;;
    esac
    case $1 in *_avx2.cpp) extra+=(-mavx2 -mfma) ;; *_avx512.cpp) extra+=(-mavx512f -mavx512dq -mavx512vl -mfma) ;; esac
    "${CXX:-clang++-22}" "${flags[@]}" "${extra[@]}" -c "$1" -o "build-fuzz/$name-objects/$(basename "$1" .cpp).o"
}
mkdir -p "build-fuzz/$name-objects"
for source in "${sources[@]}" "tests/fuzz/${name}_fuzzer.cpp"; do compile "$source"; done
cp -n tests/fuzz/seeds/"$name"/* "$corpus" 2>/dev/null || true
export ASAN_OPTIONS=detect_container_overflow=0  # vectors that layers without checks have grown
"${CXX:-clang++-22}" -fsanitize=fuzzer,address,undefined build-fuzz/"$name"-objects/*.o "${libraries[@]}" -o "build-fuzz/$name"
"build-fuzz/$name" -max_total_time="$seconds" -artifact_prefix="build-fuzz/$name-" -max_len="$longest" -rss_limit_mb="${rss:-600}" -malloc_limit_mb=256 "$corpus"
