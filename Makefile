# What a person types; CMake does the work (CMakePresets.json). JOBS=n sets how many compilers run at once.
SHELL := /bin/bash
JOBS ?= $(shell nproc)
export CMAKE_BUILD_PARALLEL_LEVEL := $(JOBS)
.DEFAULT_GOAL := help
.PHONY: help setup build python demo test bench accuracy wasm wasm-tests studio format clean
.NOTPARALLEL:

help:
	@echo "make demo    build the program, tessellate and draw two models, check the reports (out/); then the page of the studio, if five minutes are enough (PAGE=yes, PAGE=no)"
	@echo "make test    build everything and run all tests"
	@echo "make bench   compare tessellation and curves with other libraries (bench/*.md)"
	@echo "make accuracy  compare values of curves, digit by digit, with other libraries (docs/accuracy.md)"
	@echo "make build   build the program: build/bin/freiform"
	@echo "make python  build the Python package: build/python (PYTHONPATH=build/python python3 -c 'import freiform')"
	@echo "make wasm    build the WebAssembly modules and test them in node (bindings/wasm/)"
	@echo "make wasm-tests  1,630 C++ tests, from core to model, as WebAssembly, in node"
	@echo "make studio  build the page that freiform view serves (studio/dist); make build then puts it into the program"
	@echo "make setup   install the Debian packages that are missing (the other targets do it too)"
	@echo "make format  format the C++ files"
	@echo "make clean   remove what was built"

setup:
	@tools/setup.sh test

build:
	@source tools/steps.sh; \
	step "Packages" tools/setup.sh demo; \
	step "Configure" cmake --preset release --log-level=WARNING; \
	step "Build" cmake --build --preset release

python:
	@source tools/steps.sh; \
	step "Packages" tools/setup.sh python; \
	step "Configure" cmake --preset python --log-level=WARNING; \
	step "Build" cmake --build --preset python

demo:
	@source tools/steps.sh; \
	step "Packages" tools/setup.sh demo; \
	step "Configure" cmake --preset demo --log-level=WARNING; \
	step "Build" cmake --build --preset demo; \
	step "Demo" env FREIFORM=build-demo/bin/freiform tools/demo.sh; \
	step "Page" env FREIFORM=build-demo/bin/freiform DEMO_BEGAN=$$steps_began tools/demo_page.sh

test:
	@source tools/steps.sh; \
	step "Packages" tools/setup.sh test; \
	step "Configure" cmake --preset dev --log-level=WARNING; \
	step "Build" cmake --build --preset dev; \
	step "Test" tools/run_tests.sh dev

bench:
	@source tools/steps.sh; \
	step "Packages" tools/setup.sh bench; \
	step "Configure" cmake --preset release -DFREIFORM_BENCH=ON --log-level=WARNING; \
	step "Build" cmake --build --preset release --target bench-tessellate bench-interpolate bench-tessellate-occt freiform-occt-import \
		bench-curves bench-curves-occt bench-curves-boost bench-intersect bench-intersect-occt bench-intersect-sisl bench-nasty bench-surface_pairs bench-surface_pairs-occt bench-nearest bench-nearest-sisl bench-uses \
		bench-evaluation bench-evaluation-occt bench-evaluation-sisl bench-micro-evaluation bench-thresholds-evaluation; \
	step "Compare" tools/bench_report.py; \
	step "Compare curves" tools/bench_curves.py; \
	step "Compare intersections" tools/bench_intersect.py; \
	step "Compare nearest points" tools/bench_nearest.py; \
	step "Measure letters and Boolean operations" tools/bench_uses.py; \
	step "Compare evaluation" tools/bench_evaluation.py; \
	step "Measure kernels" tools/bench_micro.py; \
	step "Measure thresholds" tools/bench_thresholds.py

accuracy:
	@source tools/steps.sh; \
	step "Packages" tools/setup.sh bench; \
	step "Configure" cmake --preset release -DFREIFORM_BENCH=ON --log-level=WARNING; \
	step "Build" cmake --build --preset release --target bench-accuracy bench-accuracy-occt bench-accuracy-sisl; \
	step "Compare" tools/accuracy_report.py

WASM_IN_NODE := node --test bindings/wasm/test/order.test.js bindings/wasm/test/pack.test.js bindings/wasm/test/module.test.js

wasm:
	@source tools/steps.sh; \
	step "Packages" tools/setup.sh wasm; \
	step "Configure" cmake --preset wasm --log-level=WARNING; \
	step "Build" cmake --build --preset wasm; \
	step "Test in node" $(WASM_IN_NODE)

# Built with the modules: while functions of one are put in order, which one processor does, others compile.
wasm-tests:
	@source tools/steps.sh; \
	step "Packages" tools/setup.sh wasm; \
	step "Packages" tools/setup.sh test; \
	step "Configure" cmake --preset wasm --log-level=WARNING; \
	step "Build" cmake --build --preset wasm --target all freiform-tests; \
	step "Test in node" $(WASM_IN_NODE); \
	step "C++ tests in node" node bindings/wasm/test/corpus.js

studio: wasm
	@source tools/steps.sh; \
	step "Packages" tools/setup.sh studio; \
	step "Packages (npm)" npm ci --prefix studio --no-audit --no-fund; \
	step "Page" npm run build --prefix studio

format:
	@tools/format.sh

clean:
	rm -rf build build-* out
