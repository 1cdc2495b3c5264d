#!/usr/bin/env python3
"""tools/bench_intersect.py [--programs DIR] [--print]: intersections of plane curves and of surfaces beside Open CASCADE, SISL and plain subdivision.

Runs bench-intersect, bench-surface_pairs and the same with Open CASCADE and SISL in turns, each a process of its own, and writes bench/INTERSECT.md; with
--print only prints it. The time of a task is the shortest of all runs.
"""
import argparse

import oracle_intersect
from bench_shared import duration, head, keep_shortest, parse, ratio, run, verdicts, write

ROUNDS = 3
TASKS = [("cubics", "1000 pairs of Bézier cubics"), ("splines", "50 pairs of cubic splines of 30 points")]
METHODS = [("freiform", "bench-intersect", ""), ("plain subdivision", "bench-intersect", "_plain"),
           ("Open CASCADE", "bench-intersect-occt", ""), ("SISL s1857", "bench-intersect-sisl", "")]

SURFACE_TASKS = [("rational", "10 x 10 control points, rational"), ("polynomial", "10 x 10 control points"),
                 ("loops", "20 x 20 control points, many small loops"),
                 ("single", "4 x 4 control points: one Bézier patch each")]
SURFACE_METHODS = [("freiform", "bench-surface_pairs"), ("Open CASCADE", "bench-surface_pairs-occt")]

PAGE = """# Intersections beside others

{head}

One thread, curves prepared before the clock starts, the shortest of many runs in each of {rounds} processes; in brackets the
ratio to this library, above 1 where that is slower. Control points are uniform in a square. The plain method halves what
overlaps by boxes, ends with Newton's method and drops what it finds twice; it proves nothing and stands for the
truth here. Open CASCADE is Geom2dAPI_InterCurveCurve at 1e-9, SISL s1857 at 1e-9. Missed, invented and doubled roots of SISL come with the
status "done".

| task | | time per pair | roots | missed | invented | doubled |
|---|---|---:|---:|---:|---:|---:|
{rows}

## Two surfaces

Ten pairs of hills each; the tolerance is 1e-6. The time is that of the branches as splines in space
(here with both parameter curves and bounds). The truth is from a fine grid. Open CASCADE is GeomAPI_IntSS. SISL's s1859 has no row: on some
of these pairs it does not end.

| ten pairs of | | time per pair | branches of | length of |
|---|---|---:|---:|---:|
{surfaces}

## Curves on which others fail

What every library that was tried gets wrong somewhere: misses, doubles, invents, or answers with hundreds of points. Right: all points, overlaps as one
interval each, and nothing else, proven; the number that is none is refused. The accuracy asked for is 0.

| case | pairs | right | open | wrong | time |
|---|---:|---:|---:|---:|---:|
{known}

The pairs of dhermes/bezier's functional tests, whose common points are known exactly, by the command line: as many points as there are, each at its
parameters within 1e-8 and of its kind, proven (`tools/oracle_intersect.py`).

| kind | pairs | right | open | wrong |
|---|---:|---:|---:|---:|
{oracle}

1,000 nasty pairs whose number of common points is counted by Sturm's theorem in integers, up to degree 4 and 4. Open: the answer says that it does
not know, and the truth is within what it says.

| kind | pairs | right | open | wrong | longest call |
|---|---:|---:|---:|---:|---:|
{curves}

## Nasty pairs of surfaces

Pairs that touch, overlap, nearly do so, or are singular where they meet; the tolerance is 1e-6 of coordinates of about 1, the budget the
default one. Each is one call, in each of {rounds} processes. The longest call of {nasty_count}: {nasty_longest}. "along": near each other and parallel, and no more is known; "undecided": the
budget ended; more than 64 boxes that are left are shown as one around all.

| pair | time | branches | tangent ones | points | overlaps | along | undecided |
|---|---:|---:|---:|---:|---:|---:|---:|
{nasty}
"""


def measure(programs, names):
    """program -> task -> numbers."""
    best = {}
    for _ in range(ROUNDS):
        for program in names:
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


def surface_table(best):
    rows = []
    for task, title in SURFACE_TASKS:
        own = best["bench-surface_pairs"][task]["seconds"]
        for name, program in SURFACE_METHODS:
            n = best.get(program, {}).get(task)
            if not n:
                continue
            beside = "" if name == "freiform" else f" ({ratio(n['seconds'], own)})"
            rows.append(f"| {title} | {name} | {duration(n['seconds'])}{beside} | {n['branches']:.0f} of {n['true_branches']:.0f} "
                        f"| {n['length']:.2f} of {n['true_length']:.2f} |")
    return "\n".join(rows)


def nasty(best):
    """name -> numbers of the pairs that touch, overlap, ..."""
    return {task.split(":")[1]: n for task, n in best["bench-surface_pairs"].items() if task.startswith("nasty:") and n}


def nasty_table(pairs):
    keys = ("crossing", "tangent", "points", "overlaps", "along", "undecided")
    return "\n".join(f"| {name.replace('_', ' ')} | {duration(n['seconds'])} | " + " | ".join(f"{n[k]:.0f}" for k in keys) + " |"
                     for name, n in pairs.items())


def main():
    options = parse(argparse.ArgumentParser(description=__doc__.splitlines()[0]), "bench-intersect")
    top = head("bench_intersect.py")
    curves = measure(options.programs, dict.fromkeys(p for _, p, _ in METHODS))
    surfaces = measure(options.programs, [p for _, p in SURFACE_METHODS])
    nasty_curves = measure(options.programs, ["bench-nasty"]).get("bench-nasty", {})
    hard = nasty(surfaces)
    longest = max(hard, key=lambda name: hard[name]["seconds"])
    write(options, "INTERSECT.md",
          PAGE.format(head=top, rounds=ROUNDS, rows=table(curves), surfaces=surface_table(surfaces), nasty=nasty_table(hard),
                      known=verdicts(nasty_curves, "known"), oracle=oracle_intersect.rows(options.programs / "freiform"),
                      curves=verdicts(nasty_curves, "curves"),
                      nasty_count=len(hard),
                      nasty_longest=f"{duration(hard[longest]['seconds'])} ({longest.replace('_', ' ')})"))


if __name__ == "__main__":
    main()
