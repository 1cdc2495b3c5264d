#!/usr/bin/env python3
"""tools/oracle_intersect.py [--freiform PROGRAM]: the exact intersections of curves of the corpus, asked of the command line.

The pairs of dhermes/bezier's functional tests (oracle/dhermes_bezier in ../shared/data, or where FREIFORM_CORPUS says): parameters of all common points,
and what kind they are of. Prints a row for each kind of pair; exit code 1 if an answer is wrong. tools/bench_intersect.py puts the rows on its page.

Right: as many points as there are, each at its parameters within 1e-8 and of its kind, proven, and nothing else. Open: some are unproven, or the
program refuses with boxes that are undecided. Wrong: all else.
"""
import argparse
import fractions
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

from bench_shared import ROOT

KINDS = {"standard": "crossings and common ends", "tangent": "tangents", "coincident": "parts of one curve with a common end", "no-intersection": "no common point"}
# Touch only before 1/10 becomes a double. The first curve is a graph over x, so the points of the doubles can be counted exactly.
ROUNDED = {46}


def exact(x):
    """An integer, "3/8" or "0x1.8p-1" as a fraction."""
    return fractions.Fraction(float.fromhex(x)) if isinstance(x, str) and "0x" in x else fractions.Fraction(x)


def add(p, q):
    return [(p[i] if i < len(p) else 0) + (q[i] if i < len(q) else 0) for i in range(max(len(p), len(q)))]


def times(p, q):
    out = [fractions.Fraction(0)] * (len(p) + len(q) - 1)
    for i, x in enumerate(p):
        for j, y in enumerate(q):
            out[i + j] += x * y
    return out


def trimmed(p):
    while p and p[-1] == 0:
        p.pop()
    return p


def powers(control):
    """The polynomial of Bernstein coefficients."""
    out, n = [], len(control) - 1
    for i, c in enumerate(control):
        term = [exact(c) * math.comb(n, i)]
        for factor in [[0, 1]] * i + [[1, -1]] * (n - i):
            term = times(term, factor)
        out = add(out, term)
    return out


def distinct_roots(p):
    """In (0, 1), by Sturm's theorem; its ends are no roots."""
    chain = [trimmed(p), trimmed([k * c for k, c in enumerate(p)][1:])]
    while chain[-1]:
        rest, by = list(chain[-2]), chain[-1]
        while len(rest) >= len(by):
            shift, factor = len(rest) - len(by), rest[-1] / by[-1]
            rest = add(rest, [0] * shift + [-factor * c for c in by])
            rest = trimmed(rest[:-1])
        chain.append([-c for c in rest])
    signs = [[v > 0 for q in chain if q and (v := sum(c * at**k for k, c in enumerate(q))) != 0] for at in (0, 1)]
    return sum(x != y for x, y in zip(signs[0], signs[0][1:])) - sum(x != y for x, y in zip(signs[1], signs[1][1:]))


def points_of_doubles(curves):
    """REQUIRES x = t on the first, and that the second stays over [0, 1] where they meet."""
    graph, (x, y) = curves[0]["control_points"][1], [powers([float(exact(c)) for c in row]) for row in curves[1]["control_points"]]
    out, power = [-c for c in y], [fractions.Fraction(1)]
    for c in powers(graph):
        out, power = add(out, [c * k for k in power]), times(power, x)
    return distinct_roots(out)


def ask(program, folder, curves):
    """(exit code, answer)"""
    files = []
    for name, curve in zip("ab", curves):
        files.append(folder / f"{name}.json")
        points = [[float(exact(x)), float(exact(y))] for x, y in zip(*curve["control_points"])]
        files[-1].write_text(json.dumps({"type": "curve", "points": points}), encoding="utf-8")
    done = subprocess.run([program, "intersect", *files, "--json"], capture_output=True, text=True, timeout=100, check=False)
    return done.returncode, json.loads(done.stdout)


def judge(pair, curves, code, answer):
    if code == 4:
        return "open"
    if code != 0 or answer["overlaps"]:
        return "wrong"
    found = answer["points"] + answer["possible"]
    rounded = pair["id"] in ROUNDED
    wanted = [(float(exact(s)), float(exact(t))) for s, t in zip(pair["curve1_params"], pair["curve2_params"])]
    count = points_of_doubles(curves) if rounded else len(wanted)
    is_open = not all(p["proven"] for p in found)
    for s, t in wanted:
        near = [p for p in found if abs(p["a"][0] - s) < 1e-8 and abs(p["b"][0] - t) < 1e-8]
        kind = "end" if {s, t} & {0, 1} else "tangent" if pair["type"] == "tangent" and not rounded else "crossing"
        if not near or (not is_open and any(p["kind"] != kind for p in near)):
            return "wrong"
    if not is_open and len(found) != count:
        return "wrong"
    return "open" if is_open else "right"


def tallies(program):
    """kind -> {"right": n, "open": n, "wrong": n}; None without the corpus."""
    corpus = pathlib.Path(os.environ.get("FREIFORM_CORPUS", ROOT.parent / "shared" / "data")) / "oracle" / "dhermes_bezier"
    if not corpus.is_dir():
        return None
    pairs, curves = (json.loads((corpus / f"{name}.json").read_text(encoding="utf-8")) for name in ("curve_intersections", "curves"))
    out = {}
    with tempfile.TemporaryDirectory() as folder:
        for pair in pairs:
            both = [curves[pair[name]] for name in ("curve1", "curve2")]
            verdict = judge(pair, both, *ask(program, pathlib.Path(folder), both))
            out.setdefault(pair["type"], {"right": 0, "open": 0, "wrong": 0})[verdict] += 1
            if verdict != "right":
                print(f"pair {pair['id']} ({pair['type']}): {verdict}", file=sys.stderr)
    return out


def rows(program):
    all_kinds = tallies(program)
    if all_kinds is None:
        return "| the corpus is not here | | | | |"
    lines = [(KINDS.get(kind, kind), n) for kind, n in all_kinds.items()]
    lines.append(("all", {key: sum(n[key] for _, n in lines) for key in ("right", "open", "wrong")}))
    return "\n".join(f"| {name} | {sum(n.values())} | {n['right']} | {n['open']} | {n['wrong']} |" for name, n in lines)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--freiform", type=pathlib.Path, default=ROOT / "build" / "bin" / "freiform")
    table = rows(arguments.parse_args().freiform)
    print("| kind | pairs | right | open | wrong |\n|---|---:|---:|---:|---:|\n" + table)
    sys.exit(table.rsplit("|", 2)[1].strip() not in ("0", ""))


if __name__ == "__main__":
    main()
