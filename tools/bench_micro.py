#!/usr/bin/env python3
"""Measures the kernels of evaluation; writes bench/MICRO.md, its plot and a result as JSON.

Runs bench-micro-evaluation (Google Benchmark; make bench builds it) on one thread. A number is the time of the processor for
one point: the median of the repetitions, with quartiles in the result.
"""
import argparse
import pathlib
import sys

from benchmark_runs import ROOT, Machine, measure, plot, series


PAGE = """# Evaluation: derivatives, grids and many patches

Made by `tools/bench_micro.py` (part of `make bench`); do not edit. {when}, {machine}; {build}; kernels: {kernels}. One thread;
load when it began: {load:.1f} on {cores} processors. Rational surfaces, uniform knots, 20 x 20 control points. Time of the
processor for a point, median of {repetitions} repetitions in random order, in nanoseconds; in the plot bars go from quartile to
quartile. Values against points, degree and control points, beside other libraries: [EVALUATION.md](EVALUATION.md). From where on
preparing, threads and stores past the caches pay: [THRESHOLDS.md](THRESHOLDS.md).

![Time against the degree](micro-degree.svg)

Degrees 1, 2, 3 and 5 have loops of their own.

## A thousand bicubic patches, each on a small grid

| grid | one call, `evaluate_grids` | a loop over `PreparedPatch` | ratio |
|---|---:|---:|---:|
{patches}

## All

| work | points (grids: a side) | degree | control points a side | ns | q1 | q3 |
|---|---:|---:|---:|---:|---:|---:|
{table}
"""


def page(found, context, words):
    rows, patches = [], []
    for name, q in sorted(found.items(), key=lambda n: [int(w) if w.isdigit() else w for w in n[0].split("/")]):
        job, *arguments = name.split("/")
        arguments += [""] * (3 - len(arguments))
        rows.append(f"| {job.replace('_', ' ')} | " + " | ".join(arguments) + f" | {q['median']:.3g} | {q['q1']:.3g} | {q['q3']:.3g} |")
    for side, q in series(found, "many_at_once", 0, {}):
        loop = dict(series(found, "many_in_a_loop", 0, {}))[side]
        patches.append(f"| {side} x {side} | {q['median']:.3g} | {loop['median']:.3g} | {loop['median'] / q['median']:.1f} |")
    return PAGE.format(**words, kernels=context.get("kernels", "?"), table="\n".join(rows), patches="\n".join(patches))


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "bin")
    arguments.add_argument("--repetitions", type=int, default=9)
    arguments.add_argument("--least", type=float, default=0.05, help="seconds of a repetition")
    options = arguments.parse_args()
    program = options.programs / "bench-micro-evaluation"
    if not program.is_file():
        sys.exit(f"{program} is not built (make bench builds it where Google Benchmark is)")
    machine = Machine(options.programs)
    context, found = measure(program, options.repetitions, options.least)
    lines = [(job.replace("_", " "), series(found, job, 1, {0: 4096}))
             for job in ("first_derivatives", "second_derivatives", "curvatures")]
    plot("4096 points, 20 x 20 control points", "degree", lines, ROOT / "bench" / "micro-degree.svg")
    words = machine.words() | {"repetitions": options.repetitions}
    (ROOT / "bench" / "MICRO.md").write_text(page(found, context, words), encoding="utf-8")
    machine.record("micro", {"kernels": context.get("kernels"), "ns": found})
    print(f"bench/MICRO.md: {len(found)} measurements")


if __name__ == "__main__":
    main()
