#!/usr/bin/env python3
"""Compares the evaluation of many points with other libraries; writes bench/EVALUATION.md and a result as JSON.

Runs bench-evaluation and the programs of the peers (make bench builds them) in turn, several rounds, one thread each
unless a row says otherwise. For each task the median of the least disturbed round stands, and the ratio is taken between
medians of the same round, since what else the machine does moves all programs of a round together.
"""
import argparse
import datetime
import importlib.util
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
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


def run(command):
    """task -> quartiles in ns and a sample."""
    found = {}
    remarks = []
    for line in subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines():
        if line.startswith("#"):
            remarks.append(line[2:])
            continue
        name, least, low, median, high, sample = line.split()
        found[name] = {"min": float(least), "q1": float(low), "median": float(median), "q3": float(high), "sample": float(sample)}
    return found, remarks


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
        ns.sort()
        return {"min": ns[0], "q1": ns[1], "median": ns[2], "q3": ns[3], "sample": float(out[123456, 0])}

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
    import math
    colours = ["#1f6feb", "#c44e52", "#8a6d3b", "#55a868"]
    rows, y = [], 30
    for task, title, *_ in ROWS:
        rows.append(f'<text x="8" y="{y + 11}" font-weight="bold">{title}</text>')
        y += 17
        for k, name in enumerate(names):
            q = least_disturbed(rounds, name, task)
            if not q:
                continue
            width = 130 * math.log10(max(q["median"], 1)) + 4
            rows.append(f'<rect x="110" y="{y}" width="{width:.1f}" height="11" fill="{colours[k]}"/>'
                        f'<text x="104" y="{y + 10}" text-anchor="end">{name}</text>'
                        f'<text x="{114 + width:.1f}" y="{y + 10}">{q["median"]:.3g} ns</text>')
            y += 14
        y += 8
    head = '<text x="8" y="16">Time of a point in nanoseconds, logarithmic, one thread</text>'
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="620" height="{y}" font-family="DejaVu Sans, sans-serif" '
            f'font-size="11"><rect width="620" height="{y}" fill="white"/>{head}{"".join(rows)}</svg>\n')


PAGE = """# Evaluation of many points beside other libraries

Made by `tools/bench_evaluation.py` (part of `make bench`); do not edit. {when}, {machine}; {build}; kernels: {kernels}. Load
when it began: {load:.1f} on {cores} processors (more than 1 per processor: others were at work; times are too long then, and
ratios, taken between programs that ran one after the other, are uneven).

A rational bicubic surface of 20 x 20 control points, a rational cubic curve of 100, uneven simple knots; {points} parameters.
Time of the processor. Medians of 9 runs, those of the least disturbed of {rounds} rounds; a ratio is the median over the rounds. SISL: s1421, s1506,
s1227. Open CASCADE: Geom_BSplineSurface for scattered parameters, adaptors with their cache for grids and curves. SciPy:
BSpline with four coordinates. Points here are Patch coefficients prepared once (`PreparedPatch`), checked against the domain.

{table}

![times](evaluation.svg)

## Others

{others}

- Largest error allowed to a value of this surface, proven: {bound}. What was found against exact rational arithmetic is in
  `tests/spline/prepared_test.cpp`, which fails beyond the bound.

## Losses

{losses}

## What was tried, and what would be next

- Grids: vectors of parameters, two of them side by side since one is a chain of dependent operations, divided by one
  reciprocal a point and stored past the caches in whole lines, whatever the alignment of the result. The line on memory above
  is what such stores take without any computing: a grid cannot be faster.
- Scattered points of a surface: basis functions by Horner's rule in r = near / far on half spans instead of Bernstein polynomials
  times a matrix (a coefficient costs one load and one fused operation, all terms stay positive, and powers of 1 - t cancel in what is
  rational): 20.0 to 16.6 ns at the time. Finding spans and placing parameters in them in two loops instead of one, which was a single
  chain of operations waiting for one another: 16.6 to 13.9 ns. Spans by gathers with the step to the next span always
  taken instead of a branch that is sometimes wrong: nothing by itself, 3 ns in two loops.
- Profiled now: two fifths are the sums over the coefficients, a third finds spans, a sixth the basis functions, the rest is projection and
  stores. Checking all parameters before anything is written reads them twice, 1.3 to 2.7 ns where memory is slow.
- Without gain on scattered points: tiles of 32 (3 % slower) or 128 points (6 % slower); fetching parameters ahead (2 % slower); coefficients
  read from where lines of the cache begin (values nothing, derivatives 7 %, and it would double the net); results collected in registers
  before they go past the caches. AVX2, with half the width, takes a fifth more with derivatives: what bounds it are loads and the
  length of the chains. With others at work on the machine the ratio to SISL was between 13.9 and 15.2 in four runs.
- Four vectors of a grid at once instead of two gain nothing; coefficients that begin with a line of the cache 5 %.
- Next: two points at once in the sums of the coefficients, with one fold for both; finding spans by comparing with knots that are kept
  in registers where there are few; second derivatives of surfaces specialised for more than degree 3.
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
    return "\n".join(lines) or "None in this table."


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "bin")
    arguments.add_argument("--rounds", type=int, default=5)
    arguments.add_argument("--print", action="store_true", dest="only_print")
    options = arguments.parse_args()
    present = [(name, options.programs / program) for name, program in PROGRAMS if (options.programs / program).is_file()]
    if not present or present[0][0] != "freiform":
        sys.exit(f"{options.programs / 'bench-evaluation'} is not built (make bench builds it)")
    load, rounds, remarks = os.getloadavg()[0], [], []
    for _ in range(options.rounds):
        answers = {}
        for name, program in present:
            answers[name], said = run([str(program)])
            remarks = said or remarks
        if importlib.util.find_spec("scipy"):
            answers["SciPy"] = scipy_tasks()
        rounds.append(answers)
    check_samples(rounds)
    names = [n for n in ("freiform", "SISL", "Open CASCADE", "SciPy") if n in rounds[0]]
    build = json.loads((options.programs / "bench.json").read_text()) if (options.programs / "bench.json").is_file() else {}
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")),
               platform.machine())
    words = dict(zip(remarks[0].split()[::2], remarks[0].split()[1::2])) if remarks else {}
    day = datetime.date.today().isoformat()
    page = PAGE.format(when=day, machine=cpu, build=f"{build.get('compiler', '')} {build.get('flags', '')}".strip(),
                       kernels=words.get("kernels", "?"), load=load, cores=os.cpu_count(), points=POINTS, rounds=options.rounds,
                       table=table(rounds, names), others=others(rounds, words.get("processors", "?")), bound=words.get("bound", "?"),
                       losses=losses(rounds, names))
    if options.only_print:
        print(page)
        return
    (ROOT / "bench" / "EVALUATION.md").write_text(page, encoding="utf-8")
    (ROOT / "bench" / "evaluation.svg").write_text(bars(rounds, names), encoding="utf-8")
    record = {"date": day, "cpu": cpu, "build": build, "load": load, "remarks": remarks, "rounds": rounds}
    (ROOT / "bench" / "results" / f"evaluation-{day}.json").write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    print(f"bench/EVALUATION.md: {page.count(chr(10))} lines")


# Debian's SciPy belongs to Debian's Python, which need not be the first on the path.
DEBIAN = "/usr/bin/python3"
if __name__ == "__main__":
    if not importlib.util.find_spec("scipy") and os.access(DEBIAN, os.X_OK) and not os.environ.get("BENCH_AGAIN"):
        os.execve(DEBIAN, [DEBIAN, *sys.argv], dict(os.environ, BENCH_AGAIN="1"))
    main()
