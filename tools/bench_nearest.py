#!/usr/bin/env python3
"""tools/bench_nearest.py [--programs DIR] [--print]: nearest points of a curve and a surface beside SISL.

Runs bench-nearest and bench-nearest-sisl in turns, each a process of its own, and writes bench/NEAREST.md; with --print only
prints it. The time of a task is the median of the medians of all processes.
"""
import argparse

from bench_shared import duration, head, keep_shortest, medians, parse, ratio, run, verdicts, write

ROUNDS = 3
TASKS = [("curve", "curve of 30 points, 10,000 queries", 10000), ("surface", "surface of 10 x 10 points, 2,000 queries", 2000)]
METHODS = [("freiform, proven to 1e-9", "bench-nearest", ""), ("freiform, proven as far as rounding allows", "bench-nearest", "_exact"),
           ("SISL s1953, s1954", "bench-nearest-sisl", ""), ("SISL s1957, s1958", "bench-nearest-sisl", "_quick")]

PAGE = """# Nearest points beside SISL

{head}

One thread, objects prepared before the clock starts. The time, of the processor, is the median of {rounds} processes, of the median of
several runs in each; in brackets the ratio to the first row, above 1 where that is slower. Curve and surface are cubic and rational;
the points lie in the box of the control points, made larger by 1.2 (of the surface 3 in z). Right: the distance is within 1e-6 of
that of the nearest of many samples, refined. This library proves a lower bound of every distance; s1953 and s1954 look everywhere,
at 1e-6; s1957 and s1958 are quick and promise nothing.

| task | | time per query | right | wrong by up to |
|---|---|---:|---:|---:|
{rows}

## Nasty questions

1,000 questions about objects with folds, cusps, collapsed sides, uneven weights, and of extreme size and place, one of four on the object
itself. Right: no sample is nearer than the answer, and the lower bound proves it to 1e-9 of the size. Open: what the answer says holds, but its
interval is wider, or `max_parts` ended the search. Wrong: a sample is nearer than the bound, or than an answer that is said to be proven. The longest
call of each kind is the shortest of {rounds} processes.

| kind | questions | right | open | wrong | longest call |
|---|---:|---:|---:|---:|---:|
{nasty}

What stays open are rational pieces whose weights are 1e10 and more apart: where the curve is between two heavy control points, squares of distances
times squares of weights are below what is lost to rounding beside them; and, of surfaces flattened to a line, a place beyond which they turn back.
"""


def main():
    options = parse(argparse.ArgumentParser(description=__doc__.splitlines()[0]), "bench-nearest")
    top = head("bench_nearest.py")
    programs = [p for p in dict.fromkeys(p for _, p, _ in METHODS) if (options.programs / p).is_file()]
    rounds = {p: [] for p in programs}
    hard = {}
    for _ in range(ROUNDS):
        for p in programs:
            rounds[p].append(run(options.programs / p))
        if (options.programs / "bench-nasty").is_file():
            keep_shortest(hard, run(options.programs / "bench-nasty"))
    found = {p: medians(r) for p, r in rounds.items()}
    rows = []
    for task, title, count in TASKS:
        own = found["bench-nearest"][task]["seconds"]
        for name, program, suffix in METHODS:
            if program not in found:
                continue
            numbers = found[program][task + suffix]
            beside = "" if program + suffix == "bench-nearest" else f" ({ratio(numbers['seconds'], own)})"
            rows.append(f"| {title} | {name} | {duration(numbers['seconds'])}{beside} | {100 * numbers['right'] / count:.2f} % | "
                        f"{numbers['worst']:.2g} |")
    write(options, "NEAREST.md", PAGE.format(head=top, rounds=ROUNDS, rows="\n".join(rows), nasty=verdicts(hard, "nearest")))


if __name__ == "__main__":
    main()
