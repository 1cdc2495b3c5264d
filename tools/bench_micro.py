#!/usr/bin/env python3
"""Measures the kernels of evaluation; writes bench/MICRO.md, its plots and a result as JSON.

Runs bench-micro-evaluation (Google Benchmark; make bench builds it) on one thread. A number is the time of the processor for
one point: the median of the repetitions, with quartiles in the result.
"""
import argparse
import datetime
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
COLOURS = ["#1f6feb", "#c44e52", "#55a868", "#8a6d3b"]


def measure(program, repetitions, least):
    """The context of the program, and name -> quartiles in ns a point."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.json"
        subprocess.run([str(program), f"--benchmark_out={out}", "--benchmark_out_format=json", f"--benchmark_min_time={least}",
                        f"--benchmark_repetitions={repetitions}", "--benchmark_enable_random_interleaving=true"],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        answer = json.loads(out.read_text())
    runs = {}
    for b in answer["benchmarks"]:
        if b.get("error_occurred"):
            sys.exit(f"{b['name']}: {b['error_message']}")
        if b["run_type"] == "iteration":
            runs.setdefault(b["run_name"].split("/repeats")[0], []).append(1e9 / b["items_per_second"])
    found = {}
    for name, ns in runs.items():
        q = statistics.quantiles(ns, n=4, method="inclusive") if len(ns) > 1 else ns * 3
        found[name] = {"q1": q[0], "median": q[1], "q3": q[2]}
    return answer["context"], found


def series(found, job, place, others):
    """Points (x, quartiles) of one job along its argument `place`, the other arguments as given."""
    points = []
    for name, q in found.items():
        words = name.split("/")
        arguments = [int(w) for w in words[1:]]
        if words[0] == job and all(arguments[i] == x for i, x in others.items()):
            points.append((arguments[place], q))
    return sorted(points, key=lambda p: p[0])


def plot(title, label, lines, path):
    """Lines over logarithmic axes, with bars from quartile to quartile."""
    xs = sorted({x for _, points in lines for x, _ in points})
    ys = [y for _, points in lines for _, q in points for y in (q["q1"], q["q3"])]
    low, high = math.floor(math.log10(min(ys))), math.ceil(math.log10(max(ys)))
    first, last = math.log2(xs[0]), max(math.log2(xs[-1]), math.log2(xs[0]) + 1)

    def x_of(x):
        return 60 + 470 * (math.log2(x) - first) / (last - first)

    def y_of(y):
        return 250 - 210 * (math.log10(y) - low) / (high - low)

    out = [f'<text x="8" y="18" font-weight="bold">{title}</text>']
    for e in range(low, high + 1):
        out.append(f'<line x1="60" x2="540" y1="{y_of(10 ** e):.1f}" y2="{y_of(10 ** e):.1f}" stroke="#ddd"/>'
                   f'<text x="54" y="{y_of(10 ** e) + 4:.1f}" text-anchor="end">{10 ** e:g} ns</text>')
    for x in xs:
        out.append(f'<text x="{x_of(x):.1f}" y="266" text-anchor="middle">{x}</text>')
    out.append(f'<text x="300" y="284" text-anchor="middle">{label}</text>')
    for k, (name, points) in enumerate(lines):
        colour = COLOURS[k]
        corners = " ".join(f"{x_of(x):.1f},{y_of(q['median']):.1f}" for x, q in points)
        out.append(f'<polyline points="{corners}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        for x, q in points:
            out.append(f'<line x1="{x_of(x):.1f}" x2="{x_of(x):.1f}" y1="{y_of(q["q1"]):.1f}" y2="{y_of(q["q3"]):.1f}" '
                       f'stroke="{colour}" stroke-width="3"/><circle cx="{x_of(x):.1f}" cy="{y_of(q["median"]):.1f}" r="2.5" fill="{colour}"/>')
        out.append(f'<text x="550" y="{50 + 16 * k}" fill="{colour}">{name}</text>')
    path.write_text('<svg xmlns="http://www.w3.org/2000/svg" width="700" height="294" font-family="DejaVu Sans, sans-serif" '
                    f'font-size="11"><rect width="700" height="294" fill="white"/>{"".join(out)}</svg>\n', encoding="utf-8")


PAGE = """# Evaluation: time against points, degree and control points

Made by `tools/bench_micro.py` (part of `make bench`); do not edit. {when}, {machine}; {build}; kernels: {kernels}. One thread;
load when it began: {load:.1f} on {cores} processors. Rational surfaces, uniform knots. Time of the processor for a point, median of {repetitions}
repetitions in random order, in nanoseconds; in the plots bars go from quartile to quartile.

![Time against the number of points](micro-points.svg)
![Time against the degree](micro-degree.svg)
![Time against control points](micro-size.svg)

A call costs {call:.0f} ns with one point; {half} points take {half_ns:.0f} ns each, many {many:.1f} ns.

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
    points = series(found, "scattered", 0, {1: 3, 2: 20})
    few = points[1]
    return PAGE.format(**words, kernels=context.get("kernels", "?"), table="\n".join(rows), patches="\n".join(patches),
                       call=points[0][1]["median"], half=few[0], half_ns=few[1]["median"], many=points[-2][1]["median"])


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "bin")
    arguments.add_argument("--repetitions", type=int, default=9)
    arguments.add_argument("--least", type=float, default=0.05, help="seconds of a repetition")
    options = arguments.parse_args()
    program = options.programs / "bench-micro-evaluation"
    if not program.is_file():
        sys.exit(f"{program} is not built (make bench builds it where Google Benchmark is)")
    load = os.getloadavg()[0]
    context, found = measure(program, options.repetitions, options.least)
    build = json.loads((options.programs / "bench.json").read_text()) if (options.programs / "bench.json").is_file() else {}
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")), "?")
    day = datetime.date.today().isoformat()
    bench = ROOT / "bench"
    single = [("one by one", series(found, "single", 1, {0: 64, 2: 20}))]
    plot("Points scattered over a bicubic surface of 20 x 20", "points in a call",
         [("scattered", series(found, "scattered", 0, {1: 3, 2: 20}))], bench / "micro-points.svg")
    plot("4096 points, 20 x 20 control points", "degree", [("scattered", series(found, "scattered", 1, {0: 4096, 2: 20}))] + single,
         bench / "micro-degree.svg")
    plot("4096 points, bicubic", "control points along a side", [("scattered", series(found, "scattered", 2, {0: 4096, 1: 3})),
                                                                 ("one by one", series(found, "single", 2, {0: 64, 1: 3}))],
         bench / "micro-size.svg")
    words = {"when": day, "machine": cpu, "build": f"{build.get('compiler', '')} {build.get('flags', '')}".strip(), "load": load,
             "cores": os.cpu_count(), "repetitions": options.repetitions}
    (bench / "MICRO.md").write_text(page(found, context, words), encoding="utf-8")
    record = {"date": day, "cpu": cpu, "build": build, "load": load, "kernels": context.get("kernels"), "ns": found}
    (bench / "results" / f"micro-{day}.json").write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    print(f"bench/MICRO.md: {len(found)} measurements")


if __name__ == "__main__":
    main()
