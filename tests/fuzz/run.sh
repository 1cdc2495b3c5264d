#!/usr/bin/env bash
# tests/fuzz/run.sh NAME SECONDS [CORPUS]: builds tests/fuzz/NAME_fuzzer.cpp with libFuzzer and runs it. What it finds lies in build-fuzz/.
set -euo pipefail
cd "$(dirname "$0")/../.."
name=$1 seconds=$2
mkdir -p build-fuzz
corpus=${3:-build-fuzz/corpus-$name}
mkdir -p "$corpus"
"${CXX:-clang++-22}" -std=c++23 -O1 -g -DFF_CHECKED=1 -ffp-contract=off -fsanitize=fuzzer,address,undefined -Iinclude -Isrc \
    "tests/fuzz/${name}_fuzzer.cpp" src/mesh/triangulate*.cpp src/mesh/insertion_order.cpp src/poly/predicates*.cpp \
    src/poly/integer.cpp src/core/text.cpp src/core/result.cpp -o "build-fuzz/$name"
"build-fuzz/$name" -max_total_time="$seconds" -artifact_prefix="build-fuzz/$name-" -max_len=1024 "$corpus"
