#!/usr/bin/env python3
"""tools/bench_curves.py [--programs DIR] [--print]: tasks on curves beside Open CASCADE, SciPy and Boost.

Runs bench-curves and its siblings of bench/compare, each a process of its own, in turns, on curves made here; SciPy runs in
this one. Writes bench/CURVES.md; with --print only prints it. The time of a task is the shortest of many runs.
"""
import argparse
import importlib.util
import json
import math
import os
import random
import sys
import time

from bench_shared import duration, head, keep_shortest, parse, ratio, run, write

ROUNDS = 4
COUNT = 100_000  # parameters
PROGRAMS = [("freiform", "bench-curves"), ("Open CASCADE", "bench-curves-occt"), ("Boost", "bench-curves-boost")]


def make(name, degree, size, rational, seed):
    """A winding curve: a spiral with noise, uniform inner knots, clamped."""
    generator = random.Random(seed)
    inner = size - degree - 1
    knots = [0.0] * (degree + 1) + [(i + 1) / (inner + 1) for i in range(inner)] + [1.0] * (degree + 1)
    net = []
    for i in range(size):
        a = 12 * i / size
        w = 2.0 ** generator.choice((-1, 0, 0, 1)) if rational else 1.0
        p = [10 * math.cos(a) + generator.uniform(-1, 1), 10 * math.sin(a) + generator.uniform(-1, 1),
             a + generator.uniform(-1, 1)]
        net.append([w * x for x in p] + [w])
    at = [generator.random() for _ in range(COUNT)]
    return {"name": name, "degree": degree, "rational": rational, "knots": knots, "net": net, "at": at}


CURVES = [make("cubic, 40 points", 3, 40, False, 1), make("rational cubic, 40 points", 3, 40, True, 2),
          make("degree 7, 24 points", 7, 24, False, 3)]


def text(c):
    words = [str(c["degree"]), str(len(c["net"])), str(int(c["rational"]))]
    words += [k.hex() for k in c["knots"]]
    words += [x.hex() for p in c["net"] for x in p]
    words.append(str(len(c["at"])))
    return " ".join(words + [t.hex() for t in c["at"]])


def shortest(job, budget=0.4):
    best, total, i = math.inf, 0.0, 0
    while i < 5 or (total < budget and i < 2000):
        start = time.perf_counter()
        job()
        seconds = time.perf_counter() - start
        best, total, i = min(best, seconds), total + seconds, i + 1
    return best


def scipy_tasks(c):
    import numpy
    import scipy.integrate
    import scipy.interpolate

    knots, net, degree = numpy.array(c["knots"]), numpy.array(c["net"]), c["degree"]
    given = numpy.array(c["at"])
    spline = scipy.interpolate.BSpline(knots, net if c["rational"] else net[:, :3], degree)

    def value(t):
        h = spline(t)
        return h[..., :3] / h[..., 3:] if c["rational"] else h

    out = {}
    for task, at in (("evaluate_sorted", numpy.sort(given)), ("evaluate_random", given)):
        out[task] = {"seconds": shortest(lambda at=at: value(at)) / len(at)}

    def split():
        cut, columns = 0.4321, net if c["rational"] else net[:, :3]
        for k in range(columns.shape[1]):
            scipy.interpolate.insert(cut, (knots, numpy.append(columns[:, k], [0.0] * (degree + 1)), degree), m=degree)

    out["split"] = {"seconds": shortest(split)}
    first = spline.derivative()

    def speed(t):
        d = first(t)
        if c["rational"]:
            h = spline(t)
            d = (d[:3] - d[3] * h[:3] / h[3]) / h[3]
        return math.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])

    found = [0.0]
    breaks = sorted(set(c["knots"]))

    def length():
        found[0] = sum(scipy.integrate.quad(speed, a, b, epsabs=1e-9 / len(breaks), epsrel=0)[0]
                       for a, b in zip(breaks, breaks[1:]))

    out["length"] = {"seconds": shortest(length), "value": found[0]}
    return out


def measure(programs):
    """curve -> library -> task -> numbers, the shortest time of all rounds."""
    results = {}
    for c in CURVES:
        mine = results[c["name"]] = {}
        for _ in range(ROUNDS):
            answers = [(name, run(programs / program, text(c))) for name, program in PROGRAMS if (programs / program).is_file()]
            if importlib.util.find_spec("scipy"):
                answers.append(("SciPy", scipy_tasks(c)))
            for name, tasks in answers:
                keep_shortest(mine.setdefault(name, {}), tasks)
    return results


def simple_table(results, tasks, names):
    rows = ["| curve | task | freiform | " + " | ".join(names) + " |", "|---|---|---:|" + "---:|" * len(names)]
    for curve, mine in results.items():
        for task, title in tasks:
            own = mine["freiform"][task]["seconds"]
            cells = []
            for name in names:
                numbers = mine.get(name, {}).get(task)
                cells.append("–" if not numbers else f"{duration(numbers['seconds'])} ({ratio(numbers['seconds'], own)})")
            rows.append(f"| {curve} | {title} | {duration(own)} | " + " | ".join(cells) + " |")
    return "\n".join(rows)


def length_table(results):
    rows = ["| curve | | time | error | promised |", "|---|---|---:|---:|---:|"]
    for curve, mine in results.items():
        best = mine["freiform"]["length"]["best"]
        for name, tasks in mine.items():
            if "length" not in tasks:
                continue
            numbers = tasks["length"]
            promised = f"{numbers['bound']:.1e}, proven" if "bound" in numbers else "1e-9"
            error = abs(numbers["value"] - best)
            floor = mine["freiform"]["length"]["best_bound"]
            said = f"{error:.1e}" if error > 2 * floor else f"below {2 * floor:.0e}"
            rows.append(f"| {curve} | {name} | {duration(numbers['seconds'])} | {said} | {promised} |")
    return "\n".join(rows)


FLATTENERS = [("freiform", "flatten", "freiform, adaptive"), ("freiform", "flatten_uniform", "freiform, uniform"),
              ("Open CASCADE", "flatten_quasi", "GCPnts_QuasiUniformDeflection"),
              ("Open CASCADE", "flatten_uniform", "GCPnts_UniformDeflection"),
              ("Open CASCADE", "flatten_tangential", "GCPnts_TangentialDeflection")]


def flatten_table(results):
    rows = ["| curve | within | | time | segments | strays, of the tolerance | proven |", "|---|---:|---|---:|---:|---:|---:|"]
    for curve, mine in results.items():
        for tolerance in (1e-2, 1e-4, 1e-6):
            for name, task, title in FLATTENERS:
                numbers = mine.get(name, {}).get(f"{task}_{tolerance:g}" if tolerance > 1e-6 else f"{task}_1e-06")
                if name not in mine:
                    continue
                if not numbers:
                    rows.append(f"| {curve} | {tolerance:g} | {title} | no result | – | – | – |")
                    continue
                proven = f"{numbers['bound'] / tolerance:.2f}" if "bound" in numbers else "–"
                rows.append(f"| {curve} | {tolerance:g} | {title} | {duration(numbers['seconds'])} | "
                            f"{int(numbers['segments'])} | {numbers['strays'] / tolerance:.2f} | {proven} |")
    return "\n".join(rows)


def losses(results):
    lines, flat = [], {}
    for curve, mine in results.items():
        for task, own in mine["freiform"].items():
            for name, tasks in mine.items():
                numbers = tasks.get(task)
                if name != "freiform" and numbers and not task.startswith("flatten") and numbers["seconds"] < own["seconds"]:
                    lines.append(f"- {curve}, {task.replace('_', ' ')}: {name} takes {numbers['seconds'] / own['seconds']:.2f} "
                                 "of the time")
            if not task.startswith("flatten_") or task.startswith("flatten_uniform"):
                continue
            tolerance = task.split("_")[-1]
            for name, kind, title in FLATTENERS:
                numbers = mine.get(name, {}).get(f"{kind}_{tolerance}")
                if name != "freiform" and numbers:
                    flat.setdefault(title, []).append((numbers["seconds"] / own["seconds"],
                                                       numbers["segments"] / own["segments"],
                                                       numbers["strays"] / float(tolerance)))
    for title, rows in flat.items():
        faster = [r for r in rows if r[0] < 1]
        over = sum(r[2] > 1.005 for r in rows)
        if faster:
            lines.append(f"- flattening, adaptive: {title} is faster in {len(faster)} of {len(rows)} rows and takes "
                         f"{min(r[0] for r in faster):.2f} to {max(r[0] for r in faster):.2f} of the time, with "
                         f"{min(r[1] for r in rows):.2f} to {max(r[1] for r in rows):.2f} times the segments; beyond the "
                         f"tolerance in {over} rows, by up to {max(r[2] for r in rows):.2f} of it")
    return "\n".join(lines) or "- none"


PAGE = """# Curves beside other libraries

{head}

One thread. The time is the shortest of many runs in each of {rounds} processes; in brackets the ratio to this library, above
1 where that is slower. Open CASCADE works through GeomAdaptor_Curve, which keeps the piece it was in; SciPy through BSpline
with arrays (of a rational curve numerator and denominator); Boost.Math has uniform cubic splines of one coordinate, three of
which stand for a curve here, and quadrature, run over the derivative of this library. Curves: spirals with noise in space,
10 units wide.

## Losses

{losses}

## Values ({count} parameters, per value), splitting

{simple}

`evaluate` is backward stable with a stated bound; `evaluate_accurate` is right to the last digit ([accuracy](../docs/accuracy.md)),
which none of the others offers.

## Length within 1e-9

{length}

## Flattening within a tolerance

`strays`: the largest distance of samples of the curve, 15 for each segment, from the segment that stands for them.

{flatten}
"""


def main():
    options = parse(argparse.ArgumentParser(description=__doc__.splitlines()[0]), "bench-curves")
    build = json.loads((options.programs / "bench.json").read_text()) if (options.programs / "bench.json").is_file() else {}
    top = head("bench_curves.py", f"{build.get('compiler', '')} {build.get('flags', '')}".strip())
    results = measure(options.programs)
    tasks = [("evaluate_sorted", "value, sorted"), ("evaluate_random", "value, random"), ("evaluate_accurate", "accurate value"),
             ("split", "split in two")]
    write(options, "CURVES.md",
          PAGE.format(head=top, rounds=ROUNDS, count=COUNT, losses=losses(results),
                      simple=simple_table(results, tasks, ["Open CASCADE", "SciPy", "Boost"]),
                      length=length_table(results), flatten=flatten_table(results)))


# Debian's SciPy belongs to Debian's Python, which need not be the first on the path.
DEBIAN = "/usr/bin/python3"
if __name__ == "__main__":
    if not importlib.util.find_spec("scipy") and os.access(DEBIAN, os.X_OK) and not os.environ.get("BENCH_AGAIN"):
        os.execve(DEBIAN, [DEBIAN, *sys.argv], dict(os.environ, BENCH_AGAIN="1"))
    main()
