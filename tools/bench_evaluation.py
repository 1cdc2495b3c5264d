#!/usr/bin/env python3
"""Compares the evaluation of many points with other libraries; writes bench/EVALUATION.md, plots and a result as JSON.

Runs bench-evaluation and the programs of the peers (Google Benchmark; make bench builds them) in turn, several rounds, one
thread each unless a row says otherwise. For each task the median of the least disturbed round stands, and the ratio is taken
between medians of the same round, since what else the machine does moves all programs of a round together.
"""
import argparse
import importlib.util
import math
import os
import pathlib
import statistics
import sys
import time

from benchmark_runs import COLOURS, ROOT, Machine, measure, plot, quartiles, series

PROGRAMS = [("freiform", "bench-evaluation"), ("SISL", "bench-evaluation-sisl"),
            ("Open CASCADE", "bench-evaluation-occt")]
POINTS = 1000000
# task, title, the peer it is compared with (None: the fastest one), at least, aim
ROWS = [("scattered", "surface, scattered", None, 15, 25),
        ("scattered_d1_normal", "surface, scattered, with first derivatives and normal", None, 10, 20),
        ("grid", "surface, grid of 1000 x 1000", None, 20, 30),
        ("grid_normal", "surface, grid, with normals", None, 10, 20),
        ("curve_sorted", "curve, sorted", "Open CASCADE", 5, 10),
        ("curve_random", "curve, random", "SciPy", 10, 20),
        ("curve_sorted_d2", "curve, sorted, two derivatives", "Open CASCADE", 5, 10),
        ("curve_random_d2", "curve, random, two derivatives", None, None, None)]


def scipy_tasks():
    """The curve with scipy.interpolate.BSpline, the four homogeneous coordinates at once."""
    import numpy as np
    from scipy.interpolate import BSpline

    def uniform(seed, n):
        with np.errstate(over="ignore"):
            z = np.uint64(seed) + np.arange(1, n + 1, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)
            z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
            z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        return ((z ^ (z >> np.uint64(31))) >> np.uint64(11)).astype(float) * 2.0 ** -53

    n = 100
    r = uniform(3001, n - 3 + 4 * n)
    widths = 0.25 + r[:n - 3]
    inner = np.cumsum(widths)[:-1] / widths.sum()
    knots = np.concatenate([np.zeros(4), inner, np.ones(4)])
    s, noise = np.arange(n) / (n - 1), r[n - 3:].reshape(n, 4)
    points = np.stack([np.cos(4 * np.pi * s), np.sin(4 * np.pi * s), 2 * s], 1) + 0.4 * (noise[:, :3] - 0.5)
    w = 0.5 + 1.5 * noise[:, 3:]
    spline = BSpline(knots, np.concatenate([points * w, w], 1), 3)
    first, second = spline.derivative(1), spline.derivative(2)
    t = uniform(4001, POINTS)

    def values(at):
        h = spline(at)
        return h[:, :3] / h[:, 3:]

    def derivatives(at):
        a, b, c = spline(at), first(at), second(at)
        weight = a[:, 3:]
        p = a[:, :3] / weight
        q = (b[:, :3] - b[:, 3:] * p) / weight
        return (c[:, :3] - 2 * b[:, 3:] * q - c[:, 3:] * p) / weight

    def task(job, at):
        ns = []
        for _ in range(5):
            start = time.process_time()
            out = job(at)
            ns.append((time.process_time() - start) * 1e9 / len(at))
        return quartiles(ns) | {"sample": float(out[123456, 0])}

    ordered = np.sort(t)
    return {"curve_random": task(values, t), "curve_sorted": task(values, ordered),
            "curve_random_d2": task(derivatives, t), "curve_sorted_d2": task(derivatives, ordered)}


def check_samples(rounds):
    """All programs must have computed the same point: what is wrong is no peer."""
    first = rounds[0]
    for task, own in first["freiform"].items():
        for name, tasks in first.items():
            if task in tasks and abs(tasks[task]["sample"] - own["sample"]) > 1e-6 * (1 + abs(own["sample"])):
                sys.exit(f"{name} differs in {task}: {tasks[task]['sample']} and {own['sample']}")


def least_disturbed(rounds, name, task):
    return min((r[name][task] for r in rounds if task in r.get(name, {})), key=lambda q: q["median"], default=None)


def ratio(rounds, name, task):
    """The median over the rounds of peer / freiform."""
    found = [r[name][task]["median"] / r["freiform"][task]["median"] for r in rounds if task in r.get(name, {})]
    return statistics.median(found) if found else None


def ns(q):
    return f"{q['median']:.3g}" if q else "–"


def table(rounds, names):
    lines = ["| work | " + " | ".join(f"{n}, ns" for n in names) + " | ratio to | ratio | at least | aim | |",
             "|---|" + "---:|" * len(names) + "---|---:|---:|---:|---|"]
    for task, title, peer, least, aim in ROWS:
        ratios = {n: ratio(rounds, n, task) for n in names[1:]}
        ratios = {n: x for n, x in ratios.items() if x}
        against = peer if peer in ratios else min(ratios, key=ratios.get, default=None)
        if not against:
            continue
        x = ratios[against]
        verdict = "" if least is None else "aim reached" if x >= aim else "reached" if x >= least else "**missed**"
        cells = [ns(least_disturbed(rounds, n, task)) for n in names]
        lines.append(f"| {title} | " + " | ".join(cells) + f" | {against} | {x:.1f} | {least or '–'} | {aim or '–'} | {verdict} |")
    return "\n".join(lines)


def bars(rounds, names):
    """An SVG of the times, logarithmic, one group for each task."""
    rows, y = [], 30
    for task, title, *_ in ROWS:
        rows.append(f'<text x="8" y="{y + 11}" font-weight="bold">{title}</text>')
        y += 17
        for k, name in enumerate(names):
            q = least_disturbed(rounds, name, task)
            if not q:
                continue
            width = 130 * math.log10(max(q["median"], 1)) + 4
            rows.append(f'<rect x="110" y="{y}" width="{width:.1f}" height="11" fill="{COLOURS[k]}"/>'
                        f'<text x="104" y="{y + 10}" text-anchor="end">{name}</text>'
                        f'<text x="{114 + width:.1f}" y="{y + 10}">{q["median"]:.3g} ns</text>')
            y += 14
        y += 8
    head = '<text x="8" y="16">Time of a point in nanoseconds, logarithmic, one thread</text>'
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="620" height="{y}" font-family="DejaVu Sans, sans-serif" '
            f'font-size="11"><rect width="620" height="{y}" fill="white"/>{head}{"".join(rows)}</svg>\n')


# title, label of the axis, place of the argument, the others, file
SWEEPS = [("Points scattered over a bicubic surface of 20 x 20", "points in a call", 0, {1: 3, 2: 20}, "evaluation-points.svg"),
          ("4096 points, 20 x 20 control points", "degree", 1, {0: 4096, 2: 20}, "evaluation-degree.svg"),
          ("4096 points, bicubic", "control points along a side", 2, {0: 4096, 1: 3}, "evaluation-size.svg")]


def sweep(rounds, name, job, place, others):
    """Points (x, quartiles) of the least disturbed rounds."""
    known = {task: least_disturbed(rounds, name, task) for task in rounds[0].get(name, {})}
    return series(known, job, place, others)


def draw_sweeps(rounds, names):
    for title, label, place, fixed, file in SWEEPS:
        lines = [(name, sweep(rounds, name, "sweep", place, fixed)) for name in names]
        one = sweep(rounds, "freiform", "one_by_one", place, fixed)
        plot(title, label, lines + ([("one by one", one)] if len(one) > 1 else []), ROOT / "bench" / file)


def sweep_table(rounds, names):
    """What the plots show, and the ratio to the fastest of the others."""
    peers = [n for n in names[1:] if any(t.startswith("sweep/") for t in rounds[0][n])]
    lines = ["| points | degree | control points a side | freiform, ns | one by one, ns | " + " | ".join(f"{n}, ns" for n in peers)
             + " | ratio to the fastest |", "|---:|---:|---:|---:|---:|" + "---:|" * len(peers) + "---:|"]
    tasks = [t for t in rounds[0]["freiform"] if t.startswith("sweep/")]
    for task in sorted(tasks, key=lambda t: [int(w) for w in t.split("/")[1:]]):
        ratios = [x for x in (ratio(rounds, n, task) for n in peers) if x]
        one = least_disturbed(rounds, "freiform", task.replace("sweep", "one_by_one"))
        cells = [ns(least_disturbed(rounds, "freiform", task)), ns(one)] + [ns(least_disturbed(rounds, n, task)) for n in peers]
        lines.append("| " + " | ".join(task.split("/")[1:] + cells) + f" | {min(ratios):.2f} |" if ratios else " |")
    return "\n".join(lines)


PAGE = """# Evaluation of many points beside other libraries

Made by `tools/bench_evaluation.py` (part of `make bench`); do not edit. {when}, {machine}; {build}; kernels: {kernels}. Load
when it began: {load:.1f} on {cores} processors (more than 1 per processor: others were at work; times are too long then, and
ratios, taken between programs that ran one after the other, are uneven).

A rational bicubic surface of 20 x 20 control points, a rational cubic curve of 100, uneven simple knots; {points} parameters.
Time of the processor. Medians of {repetitions} runs, those of the least disturbed of {rounds} rounds; a ratio is the median over the rounds. SISL: s1421, s1506,
s1227. Open CASCADE: Geom_BSplineSurface for scattered parameters, adaptors with their cache for grids and curves. SciPy:
BSpline with four coordinates. Points here are Patch coefficients prepared once (`PreparedPatch`), checked against the domain.
All programs write to memory that they have written once before, so that none of them waits for pages.

{table}

![times](evaluation.svg)

## Against points, degree and control points

Rational surfaces with equal spans, points scattered; prepared before the clock starts, SISL and Open CASCADE point by point.
In the plots bars go from quartile to quartile.

![Time against the number of points](evaluation-points.svg)
![Time against the degree](evaluation-degree.svg)
![Time against control points](evaluation-size.svg)

{sweeps}

## Others

{others}

- Largest error allowed to a value of this surface, proven: {bound}. What was found against exact rational arithmetic is in
  `docs/evaluation.md`; `tests/spline/prepared_kernels_test.cpp` fails beyond the bound.

## Losses

{losses}

## What was tried, and what would be next

- Grids: vectors of parameters, two of them side by side since one is a chain of dependent operations, divided by one
  reciprocal a point, a division of which goes beside the fused operations (5 % less than an estimate with two of Newton's steps), and stored past the caches in whole lines, whatever the alignment of the result. The line on memory above
  is what such stores take without any computing: a grid cannot be faster. Storing into the caches takes 1.9 times as long as past
  them (3.1 and 1.6 ns on an AMD EPYC, of which 1 ns or so is computing: 16 fused operations, a division and nine
  shuffles for eight points, about what that processor issues). Where the output begins makes no difference that could be measured (stores
  are shifted to whole lines); pages of 2 MiB gain a tenth; memory that was never touched costs 15 ns a point more, in every program. Blocks
  within one span share the spread coefficients: 5 to 20 % with AVX2, a quarter with SSE2, nothing with AVX-512. Accumulating in
  single precision would halve the work and is not allowed.
- Without gain on grids: parts of 32768 points instead of 4096 for a thread.
- Next for grids: Horner's rule in r = near / far, the columns of a row made once for each of its spans, which saves a quarter of the fused
  operations and keeps all terms of one sign; vectors across spans would be put together by masks, so that bits do not depend on the place.
- Scattered points of a surface: basis functions by Horner's rule in r = near / far on half spans instead of Bernstein polynomials
  times a matrix (a coefficient costs one load and one fused operation, all terms stay positive, and powers of 1 - t cancel in what is
  rational): 20.0 to 16.6 ns at the time. Finding spans and placing parameters in them in two loops instead of one, which was a single
  chain of operations waiting for one another: 16.6 to 13.9 ns. The step to the next span always
  taken instead of a branch that is sometimes wrong: nothing by itself, 3 ns in two loops.
- After that, 4096 points of the surface above, least of many runs in turn with what was before: as few buckets for finding spans as
  leave one step, since coefficients share the cache with them, 12.3 to 11.8 ns; one lookup after the other instead of gathers, 11.8 to
  11.6; written out eight at a time, 11.4 to 11.2; divisions instead of estimates of reciprocals with Newton's steps, 11.6 to 11.4. A million
  points: 15.6 to 14.7 by these; parameters asked for some pages ahead where the results do not stay in the cache, to 13.4.
- One point in a call: 222 ns before, 81 now. Much of it was waiting: a vector from numbers that were stored one by one a moment ago has to
  wait until they are in the cache, so a single parameter is spread over the lanes from a register.
- All parameters are checked before anything is written; the threads that evaluate share that, which was the part that one of them did alone.
- Profiled before the last of these: a third are the sums over the coefficients, a third finds spans, a sixth the basis functions, the rest is projection and
  stores. Checking reads all parameters twice, 1 ns where memory is slow.
- Without gain on scattered points: tiles of 32 (3 % slower) or 128 points (6 % slower); fetching parameters ahead where all is in the cache (2 % slower), or for the check;
  two points at once in the sums with one fold for both (1 % slower, no clear change of derivatives); coefficients
  read from where lines of the cache begin (values nothing, derivatives 7 %, and it would double the net); results collected in registers
  before they go past the caches. AVX2, with half the width, takes a fifth more with derivatives: what bounds it are loads and the
  length of the chains. With others at work on the machine the ratio to SISL was between 13.9 and 15.2 in four runs.
- Four vectors of a grid at once instead of two gain nothing; coefficients that begin with a line of the cache 5 %.
- Second derivatives of surfaces with loops of their own for degrees 1, 2 and 5, as 3 had: 90 to 23, 90 to 34 and 140 to 51 ns (degree 5
  with AVX2: 130 to 62), for 1 KB of program and no time of the compiler that could be measured.
- Next: the Bezier coefficients of every box of spans in the powers of both r, 512 bytes for a bicubic one, which need no basis functions, as
  long as all of them stay in the second cache; finding spans by looking up knots that are kept in registers where there are few; the kernels of old processors (SSE2) in vectors of two, which g++ does not make of vectors of four.
"""


def others(rounds, processors):
    def quotient(a, b):
        return statistics.median(r["freiform"][a]["median"] / r["freiform"][b]["median"] for r in rounds)

    def own(task):
        return ns(least_disturbed(rounds, "freiform", task))

    return "\n".join([
        f"- Two threads: {quotient('scattered_one_thread', 'scattered_two_threads'):.2f} times as fast as one on scattered parameters, by the clock ({own('scattered_two_threads')} ns); "
        f"1.8 were asked for, 1.95 hoped for. Two threads that only count got {processors} processors of this machine at that time.",
        f"- `Patch::evaluate`, which prepares for the one call: {own('scattered_unprepared')} ns; single precision: {own('scattered_single_precision')} ns; "
        f"points and normals without derivatives: {own('scattered_normal')} ns.",
        f"- Memory: storing points that are not computed takes {own('store')} ns each, past the caches {own('store_past')} ns, "
        f"which is {quotient('store_past', 'grid'):.2f} of the time of the grid."])


def ratio_of_stores(rounds, peer):
    return statistics.median(r[peer]["grid"]["median"] / r["freiform"]["store_past"]["median"] for r in rounds)


def losses(rounds, names):
    lines = []
    for task, title, peer, least, aim in ROWS:
        ratios = {n: ratio(rounds, n, task) for n in names[1:]}
        ratios = {n: x for n, x in ratios.items() if x}
        against = peer if peer in ratios else min(ratios, key=ratios.get, default=None)
        if against and least and ratios[against] < least:
            limit = ratio_of_stores(rounds, against) if task == "grid" else None
            why = f" Storing points that are not computed, past the caches, is {limit:.1f} times as fast as {against}: no more is possible in such a run." if limit else ""
            lines.append(f"- {title}: {ratios[against]:.1f} times {against}, {least} were asked for.{why}")
        for n, x in ratios.items():
            if x < 1:
                lines.append(f"- {title}: {n} is faster, {x:.2f} of the time.")
    for task in rounds[0]["freiform"]:
        for n in names[1:]:
            x = ratio(rounds, n, task) if task.startswith("sweep/") else None
            if x and x < 1:
                points, degree, size = task.split("/")[1:]
                lines.append(f"- {points} point{'s' * (points != '1')} in a call, degree {degree}, {size} x {size} control points: {n} takes {x:.2f} of the time.")
    return "\n".join(lines) or "None in these tables."


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "bin")
    arguments.add_argument("--rounds", type=int, default=5)
    arguments.add_argument("--repetitions", type=int, default=5)
    arguments.add_argument("--least", type=float, default=0.02, help="seconds of a repetition")
    arguments.add_argument("--print", action="store_true", dest="only_print")
    options = arguments.parse_args()
    present = [(name, options.programs / program) for name, program in PROGRAMS if (options.programs / program).is_file()]
    if not present or present[0][0] != "freiform":
        sys.exit(f"{options.programs / 'bench-evaluation'} is not built (make bench builds it where Google Benchmark is)")
    machine, rounds, context = Machine(options.programs), [], {}
    for _ in range(options.rounds):
        answers = {}
        for name, program in present:
            said, answers[name] = measure(program, options.repetitions, options.least)
            if name == "freiform":
                context = said
        if importlib.util.find_spec("scipy"):
            answers["SciPy"] = scipy_tasks()
        rounds.append(answers)
    check_samples(rounds)
    names = [n for n in ("freiform", "SISL", "Open CASCADE", "SciPy") if n in rounds[0]]
    page = PAGE.format(**machine.words(), kernels=context.get("kernels", "?"), points=POINTS, rounds=options.rounds,
                       repetitions=options.repetitions, table=table(rounds, names), sweeps=sweep_table(rounds, names),
                       others=others(rounds, f"{float(context['processors']):.2f}"), bound=f"{float(context['bound']):.3g}",
                       losses=losses(rounds, names))
    if options.only_print:
        print(page)
        return
    (ROOT / "bench" / "EVALUATION.md").write_text(page, encoding="utf-8")
    (ROOT / "bench" / "evaluation.svg").write_text(bars(rounds, names), encoding="utf-8")
    draw_sweeps(rounds, names)
    kept = {k: context.get(k) for k in ("kernels", "bound", "processors", "caches", "mhz_per_cpu", "num_cpus")}
    machine.record("evaluation", {"context": kept, "rounds": rounds})
    print(f"bench/EVALUATION.md: {page.count(chr(10))} lines")


# Debian's SciPy belongs to Debian's Python, which need not be the first on the path.
DEBIAN = "/usr/bin/python3"
if __name__ == "__main__":
    if not importlib.util.find_spec("scipy") and os.access(DEBIAN, os.X_OK) and not os.environ.get("BENCH_AGAIN"):
        os.execve(DEBIAN, [DEBIAN, *sys.argv], dict(os.environ, BENCH_AGAIN="1"))
    main()
