#!/usr/bin/env python3
"""tools/bench_intersect.py [--programs DIR] [--print]: intersections of plane curves beside Open CASCADE and plain subdivision.

Runs bench-intersect and bench-intersect-occt in turns, each a process of its own, and writes bench/INTERSECT.md; with
--print only prints it. The time of a task is the shortest of all runs.
"""
import argparse
import datetime
import os
import pathlib
import platform
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
ROUNDS = 3
TASKS = [("cubics", "1000 pairs of Bézier cubics"), ("splines", "50 pairs of cubic splines of 30 points")]
METHODS = [("freiform", "bench-intersect", ""), ("plain subdivision", "bench-intersect", "_plain"),
           ("Open CASCADE", "bench-intersect-occt", "")]

PAGE = """# Intersections of plane curves beside others

Made by `make bench` (`tools/bench_intersect.py`); do not edit. {when}, {machine}. Load when it began: {load:.1f} on {cores}
processors (more than 1 per processor: others were at work, and times are too long, unevenly).

One thread, curves prepared before the clock starts, the shortest of many runs in each of {rounds} processes; in brackets the
ratio to this library, above 1 where that is slower. Control points are uniform in a square. The plain method halves what
overlaps by boxes, ends with Newton's method and drops what it finds twice; it proves nothing and stands for the
truth here. Open CASCADE is Geom2dAPI_InterCurveCurve at 1e-9.

| task | | time per pair | roots | missed | invented | doubled |
|---|---|---:|---:|---:|---:|---:|
{rows}
"""


def run(program):
    done = subprocess.run([str(program)], capture_output=True, text=True, timeout=600, check=True)
    out = {}
    for line in done.stdout.splitlines():
        task, seconds, *words = line.split()
        out[task] = {"seconds": float(seconds)} | {k: int(v) for k, v in (w.split("=") for w in words)}
    return out


def measure(programs):
    best = {}
    for _ in range(ROUNDS):
        for program in dict.fromkeys(p for _, p, _ in METHODS):
            if not (programs / program).is_file():
                continue
            for task, numbers in run(programs / program).items():
                old = best.get((program, task))
                if old is None or numbers["seconds"] < old["seconds"]:
                    best[program, task] = numbers
    return best


def table(best):
    rows = []
    for task, title in TASKS:
        own = best["bench-intersect", task]["seconds"]
        for name, program, suffix in METHODS:
            numbers = best.get((program, task + suffix))
            if not numbers:
                continue
            ratio = "" if name == "freiform" else f" ({numbers['seconds'] / own:.2g})"
            cells = " | ".join(str(numbers[k]) for k in ("roots", "missed", "invented", "doubled"))
            rows.append(f"| {title} | {name} | {1e6 * numbers['seconds']:.3g} µs{ratio} | {cells} |")
    return "\n".join(rows)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "bin")
    arguments.add_argument("--print", action="store_true", dest="only_print")
    options = arguments.parse_args()
    if not (options.programs / "bench-intersect").is_file():
        sys.exit(f"{options.programs / 'bench-intersect'} is not built (make bench builds it)")
    load = os.getloadavg()[0]
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")),
               platform.machine())
    page = PAGE.format(when=datetime.date.today().isoformat(), machine=cpu, load=load, cores=os.cpu_count(), rounds=ROUNDS,
                       rows=table(measure(options.programs)))
    if options.only_print:
        print(page)
    else:
        (ROOT / "bench" / "INTERSECT.md").write_text(page, encoding="utf-8")
        print(f"bench/INTERSECT.md: {page.count(chr(10))} lines")


if __name__ == "__main__":
    main()
