#!/usr/bin/env python3
"""tools/bench_intersect.py [--programs DIR] [--print]: intersections of plane curves beside Open CASCADE and plain subdivision.

Runs bench-intersect and bench-intersect-occt in turns, each a process of its own, and writes bench/INTERSECT.md; with
--print only prints it. The time of a task is the shortest of all runs.
"""
import argparse

from bench_shared import duration, head, keep_shortest, parse, ratio, run, write

ROUNDS = 3
TASKS = [("cubics", "1000 pairs of Bézier cubics"), ("splines", "50 pairs of cubic splines of 30 points")]
METHODS = [("freiform", "bench-intersect", ""), ("plain subdivision", "bench-intersect", "_plain"),
           ("Open CASCADE", "bench-intersect-occt", "")]

PAGE = """# Intersections of plane curves beside others

{head}

One thread, curves prepared before the clock starts, the shortest of many runs in each of {rounds} processes; in brackets the
ratio to this library, above 1 where that is slower. Control points are uniform in a square. The plain method halves what
overlaps by boxes, ends with Newton's method and drops what it finds twice; it proves nothing and stands for the
truth here. Open CASCADE is Geom2dAPI_InterCurveCurve at 1e-9.

| task | | time per pair | roots | missed | invented | doubled |
|---|---|---:|---:|---:|---:|---:|
{rows}
"""


def measure(programs):
    """program -> task -> numbers."""
    best = {}
    for _ in range(ROUNDS):
        for program in dict.fromkeys(p for _, p, _ in METHODS):
            if (programs / program).is_file():
                keep_shortest(best.setdefault(program, {}), run(programs / program))
    return best


def table(best):
    rows = []
    for task, title in TASKS:
        own = best["bench-intersect"][task]["seconds"]
        for name, program, suffix in METHODS:
            numbers = best.get(program, {}).get(task + suffix)
            if not numbers:
                continue
            beside = "" if name == "freiform" else f" ({ratio(numbers['seconds'], own)})"
            cells = " | ".join(f"{numbers[k]:.0f}" for k in ("roots", "missed", "invented", "doubled"))
            rows.append(f"| {title} | {name} | {duration(numbers['seconds'])}{beside} | {cells} |")
    return "\n".join(rows)


def main():
    options = parse(argparse.ArgumentParser(description=__doc__.splitlines()[0]), "bench-intersect")
    top = head("bench_intersect.py")
    write(options, "INTERSECT.md", PAGE.format(head=top, rounds=ROUNDS, rows=table(measure(options.programs))))


if __name__ == "__main__":
    main()
