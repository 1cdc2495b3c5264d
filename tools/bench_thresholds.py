#!/usr/bin/env python3
"""Measures where preparing, threads and stores past the caches begin to pay; writes bench/THRESHOLDS.md and a result as JSON.

Runs bench-thresholds-evaluation (Google Benchmark; make bench builds it) and compares with what the library has set, which it
reads from the source.
"""
import argparse
import pathlib
import re
import sys

from benchmark_runs import ROOT, Machine, measure

AXES = {1: "curve", 2: "surface", 3: "volume"}


def constant(file, pattern):
    found = re.search(pattern, (ROOT / file).read_text(encoding="utf-8"))
    if not found:
        sys.exit(f"{file}: {pattern} is not there")
    return found.group(1)


def rules():
    """What the library has set: points for each function of each span, by axes and order; points; bytes."""
    rows = constant("src/spline/patch_detail.hpp", r"kWorth\[3\]\[4\] = \{(.*)\};")
    worth = [[float(x) for x in row.split(",")] for row in re.findall(r"\{([^{}]*)\}", rows)]
    threads = int(constant("include/freiform/spline/prepared.hpp", r"kParallelFrom = (\d+)"))
    past = int(constant("src/spline/prepared_detail.hpp", r"kPastFrom = std::size_t\((\d+)\) << 20"))
    return worth, threads, past


def functions(axes, degree, size):
    return axes * (degree + 1) * max(1, size - degree)


def preparing(found, worth):
    lines = []
    for name, q in found.items():
        match = re.fullmatch(r"prepare<(\d)>/(\d+)/(\d+)", name)
        if not match:
            continue
        axes, degree, size = map(int, match.groups())
        for order in range(3):
            slow = found[f"one_by_one<{axes}, {order}>/{degree}/{size}"]["median"]
            fast = found[f"batch<{axes}, {order}>/{degree}/{size}"]["median"]
            pays = q["median"] / (slow - fast) if slow > fast else float("inf")
            rule = worth[axes - 1][order] * functions(axes, degree, size)
            lines.append((axes, order, degree, size, q["median"] / 1000, slow, fast, pays, rule, rule / pays))
    lines.sort()
    return "\n".join(f"| {AXES[a]} | {o} | {p} | {n} | {us:.3g} | {slow:.3g} | {fast:.3g} | {pays:.0f} | {rule:.0f} | {x:.2f} |"
                     for a, o, p, n, us, slow, fast, pays, rule, x in lines)


def grids(found, worth):
    lines = []
    for size in (4, 20, 100):
        cells = []
        for name, q in found.items():
            match = re.fullmatch(rf"grid_unprepared/3/{size}/(\d+)", name)
            if match:
                other = found[f"grid_prepared/3/{size}/{match.group(1)}"]
                cells.append((int(match.group(1)), q["median"], other["median"]))
        rule = worth[1][3] * functions(2, 3, size)
        for n, slow, fast in sorted(cells):
            took = "prepared" if n * n >= rule else "not"
            best = "prepared" if fast < slow else "not"
            wrong = took != best and max(fast, slow) > 1.1 * min(fast, slow)
            lines.append(f"| {size} x {size} | {n} x {n} | {slow:.3g} | {fast:.3g} | {took} | {'wrong' if wrong else ''} |")
    return "\n".join(lines)


def threads(found, limit):
    lines = []
    for name, q in sorted(found.items(), key=lambda f: [int(w) for w in f[0].split("/")[1:] if w.isdigit()]):
        match = re.fullmatch(r"threads/(\d+)/1", name)
        if match:
            n = int(match.group(1))
            two = found[f"threads/{n}/2"]["median"]
            lines.append(f"| {n} | {q['median']:.3g} | {two:.3g} | {q['median'] / two:.2f} | {'two' if n >= limit else 'one'} |")
    return "\n".join(lines)


def stores(found, limit):
    lines = []
    sizes = sorted(int(name.split("/")[1]) for name in found if re.fullmatch(r"stores/\d+/0/0", name))
    for n in sizes:
        near, past, near_read, past_read = (found[f"stores/{n}/{p}/{r}"]["median"] for r in (0, 1) for p in (0, 1))
        lines.append(f"| {n} | {near:.3g} | {past:.3g} | {near_read:.3g} | {past_read:.3g} | "
                     f"{'past' if n * 1024 > limit << 20 else 'into'} |")
    return "\n".join(lines)


PAGE = """# Evaluation: from where on preparing, threads and stores past the caches pay

Made by `tools/bench_thresholds.py` (part of `make bench`); do not edit. {when}, {machine}; {build}; kernels: {kernels}. Load
when it began: {load:.1f} on {cores} processors. Median of {repetitions} repetitions in random order, nanoseconds of the processor for a point, rational
patches. What the library has set is read from its source.

## Preparing for one call

`Patch::evaluate` makes tables where so many points save as much as these cost. The rule counts the functions of all spans,
p + 1 for each of each axis; it is set for medium degrees, and the last column (rule / measured) says how far off it is for others. A factor
of two there costs at most half of the time of the tables.

| | order | degree | points a side | tables, us | one by one, ns | prepared, ns | pays from | rule | rule / measured |
|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|
{preparing}

## Grids

`evaluate_grid` of a patch; without tables a grid is contracted along its axes too, so that tables pay later. Bicubic surfaces.
"Wrong" is where the other way would be more than a tenth faster.

| control points | grid | without tables, ns | tables and grid, ns | the rule takes | |
|---|---|---:|---:|---|---|
{grids}

## Threads

Pieces of 4096 points of a bicubic surface, by the clock. The library takes several threads from {parallel} points on. On a machine whose
processors are at work elsewhere a second thread gains nothing.

| points | one thread, ns | two, ns | ratio | the library takes |
|---:|---:|---:|---:|---|
{threads}

## Stores past the caches

Rows of a grid, into memory that was written before; with and without a pass that reads them afterwards. The library stores past the
caches above {past} MiB.

| KiB | into the caches, ns | past them, ns | into, then read, ns | past, then read, ns | the library stores |
|---:|---:|---:|---:|---:|---|
{stores}
"""


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "bin")
    arguments.add_argument("--repetitions", type=int, default=7)
    arguments.add_argument("--least", type=float, default=0.02, help="seconds of a repetition")
    options = arguments.parse_args()
    program = options.programs / "bench-thresholds-evaluation"
    if not program.is_file():
        sys.exit(f"{program} is not built (make bench builds it where Google Benchmark is)")
    machine = Machine(options.programs)
    context, found = measure(program, options.repetitions, options.least)
    worth, parallel, past = rules()
    page = PAGE.format(**machine.words(), kernels=context.get("kernels", "?"), repetitions=options.repetitions, parallel=parallel, past=past,
                       preparing=preparing(found, worth), grids=grids(found, worth), threads=threads(found, parallel),
                       stores=stores(found, past))
    (ROOT / "bench" / "THRESHOLDS.md").write_text(page, encoding="utf-8")
    machine.record("thresholds", {"kernels": context.get("kernels"), "ns": found})
    print(f"bench/THRESHOLDS.md: {len(found)} measurements")


if __name__ == "__main__":
    main()
