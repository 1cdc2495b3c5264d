#!/usr/bin/env python3
"""Measures the WebAssembly module in node and Chromium beside the native kernels; writes bench/WASM.md.

The native numbers are those of bench-micro-evaluation (make bench builds it) with the kernels for any x86-64 (`base`) and with
those that this machine has; the module's contain the way through its interface. Rounds alternate, medians are compared.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
JOBS = {"first_derivatives/4096/3": "4096 scattered points with first derivatives",
        "second_derivatives/4096/3": "4096 scattered points with second derivatives",
        "grid/100/3/20": "a grid of 100 x 100 points"}
IN_NODE = """
import { load } from '%(root)s/bindings/wasm/freiform.js';
import { speed } from '%(root)s/bindings/wasm/test/speed.js';
import { readFileSync } from 'node:fs';
console.log(JSON.stringify(speed(await load(readFileSync('%(wasm)s/freiform.wasm')))));
"""
PAGE = """# The WebAssembly module beside the native kernels

Made by `tools/bench_wasm.py` ({rounds} rounds in alternation); do not edit. A rational bicubic surface of 20 x 20 control points; nanoseconds for
a point, medians of the rounds; native ones in processor time, the module's the least of 100 repetitions by the clock, after a second of the same work. `base` are the native kernels for every x86-64, without AVX and without fused products; the module's numbers contain its
interface and the copy of the answer into arrays that are there. Load when it began: {load:.1f} on {cores} processors.

| work | native, base | native, {best} | module in node | to base | module in Chromium | to base |
|---|---:|---:|---:|---:|---:|---:|
{table}
"""


def native(program, kernels):
    environment = dict(os.environ, **({"FREIFORM_ISA": kernels} if kernels else {}))
    out = subprocess.run([program, "--benchmark_format=json", "--benchmark_min_time=0.1",
                          "--benchmark_filter=^(" + "|".join(JOBS) + ")$"], env=environment, check=True, capture_output=True).stdout
    found = json.loads(out)
    return {b["name"]: 1e9 / b["items_per_second"] for b in found["benchmarks"]}, found["context"]["kernels"]


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--program", type=pathlib.Path, default=ROOT / "build" / "bin" / "bench-micro-evaluation")
    arguments.add_argument("--wasm", type=pathlib.Path, default=ROOT / "build-wasm" / "bin")
    arguments.add_argument("--rounds", type=int, default=5)
    arguments.add_argument("--output", type=pathlib.Path, default=ROOT / "bench" / "WASM.md")
    options = arguments.parse_args()
    for needed in (options.program, options.wasm / "freiform.wasm"):
        if not needed.is_file():
            sys.exit(f"{needed} is not built (make bench, make wasm)")
    load, best = os.getloadavg()[0], "?"
    rounds = {"base": [], "best": [], "node": [], "chromium": []}
    for _ in range(options.rounds):
        rounds["base"].append(native(options.program, "base")[0])
        found, best = native(options.program, None)
        rounds["best"].append(found)
        script = IN_NODE % {"root": ROOT, "wasm": options.wasm}
        rounds["node"].append(json.loads(subprocess.run(["node", "--input-type=module", "-e", script], check=True, capture_output=True).stdout))
        page = subprocess.run(["node", ROOT / "bindings/wasm/test/browser.js", "--speed"], capture_output=True,
                              env=dict(os.environ, FREIFORM_WASM=str(options.wasm)))
        if page.returncode == 0:
            rounds["chromium"].append(json.loads(page.stdout))
    table = []
    for job, words in JOBS.items():
        t = {where: statistics.median(r[job] for r in found) if found else None for where, found in rounds.items()}
        cells = [f"{t['base']:.3g}", f"{t['best']:.3g}"]
        for where in ("node", "chromium"):
            cells += [f"{t[where]:.3g}", f"{t[where] / t['base']:.2f}"] if t[where] else ["not there", ""]
        table.append(f"| {words} | " + " | ".join(cells) + " |")
    options.output.write_text(PAGE.format(rounds=options.rounds, load=load, cores=os.cpu_count(), best=best, table="\n".join(table)))
    print("\n".join(table))


if __name__ == "__main__":
    main()
