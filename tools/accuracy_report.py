#!/usr/bin/env python3
"""tools/accuracy_report.py [--programs DIR]: values of curves beside exact arithmetic, for this library and others.

Runs bench-accuracy (this library), bench-accuracy-occt (Open CASCADE), bench-accuracy-sisl (SISL), each a program of its
own, and SciPy; takes the error of every value in units of the last place of the exact value (fractions.Fraction);
writes docs/accuracy.md and its pictures, docs/accuracy/*.svg. What is missing is left out, and the page says so.
"""
import argparse
import importlib.util
import math
import os
import pathlib
import random
import re
import subprocess
import sys
from fractions import Fraction

ROOT = pathlib.Path(__file__).resolve().parent.parent
FLOOR, TOP = -1.3, 22.0  # of the pictures, decimal logarithms of units in the last place
SERIES = [  # name, colour, what it is
    ("SISL", "#b07aa1", "SISL s1221"),
    ("SciPy", "#59a14f", "SciPy BPoly, BSpline"),
    ("Open CASCADE", "#e1912b", "Open CASCADE Geom_BezierCurve, Geom_BSplineCurve"),
    ("evaluate", "#4e79a7", "this library, evaluate"),
    ("evaluate_accurate", "#d1384b", "this library, evaluate_accurate"),
]


class Curve:
    """A spline over doubles: weighted coefficients and weights. Exact values by de Boor's recurrence."""

    def __init__(self, name, title, degree, knots, x, w=None):
        self.name, self.title, self.degree, self.knots, self.x = name, title, degree, knots, x
        self.w = w or [1.0] * len(x)
        self.rational = w is not None
        self.at, self.centre = [], None

    def is_bezier(self):
        return len(self.x) == self.degree + 1

    def span(self, t):
        p, n = self.degree, len(self.x)
        s = p
        while s < n - 1 and self.knots[s + 1] <= t:
            s += 1
        return s

    def exact(self, t):
        p, s = self.degree, self.span(t)
        knots = [Fraction(k) for k in self.knots]
        t = Fraction(t)

        def boor(c):
            d = [Fraction(c[s - p + j]) for j in range(p + 1)]
            for r in range(1, p + 1):
                for j in range(p, r - 1, -1):
                    lo, hi = knots[s - p + j], knots[s + 1 + j - r]
                    a = (t - lo) / (hi - lo)
                    d[j] = (1 - a) * d[j - 1] + a * d[j]
            return d[p]

        return boor(self.x) / boor(self.w)

    def text(self):
        words = [str(self.degree), str(len(self.x)), str(int(self.rational))]
        words += [k.hex() for k in self.knots]
        for x, w in zip(self.x, self.w):
            words += [x.hex(), w.hex()]
        words.append(str(len(self.at)))
        words += [t.hex() for t in self.at]
        return " ".join(words)


def bernstein_of_roots(factors):
    """Bernstein coefficients of prod (a t + b), each rounded to a double."""
    c = [Fraction(1)]
    for a, b in factors:
        n = len(c) - 1
        lo, hi = Fraction(b), Fraction(a + b)
        longer = [Fraction(0)] * (n + 2)
        for i in range(n + 1):
            longer[i] += c[i] * lo * Fraction(n + 1 - i, n + 1)
            longer[i + 1] += c[i] * hi * Fraction(i + 1, n + 1)
        c = longer
    return [float(v) for v in c]


def bezier_knots(degree):
    return [0.0] * (degree + 1) + [1.0] * (degree + 1)


def curves():
    steps = 120
    near = [Fraction(3, 4) + Fraction(i, steps) * Fraction(9, 128) for i in range(-steps, steps + 1)]
    near = [float(t) for t in near if t != Fraction(3, 4)]
    out = []
    roots = bernstein_of_roots([(4, -3)] * 7 + [(2, -1)] * 3)
    out.append(Curve("polynomial", "(4t − 3)⁷ (2t − 1)³ near its root 3/4, Bézier of degree 10", 10,
                     bezier_knots(10), roots))
    w = [1.0, 2.0, 4.0, 2.0, 1.0, 0.5, 1.0, 2.0]  # powers of two: weight times point is exact
    out.append(Curve("rational", "(4t − 3)⁷ over a denominator of degree 7, near its root 3/4", 7, bezier_knots(7),
                     bernstein_of_roots([(4, -3)] * 7), w))
    for c in out:
        c.at, c.centre = near, 0.75
    generator = random.Random(1)
    knots = [0.0] * 4 + sorted(generator.random() for _ in range(6)) + [1.0] * 4
    plain = Curve("ordinary", "an ordinary cubic spline (coefficients between 1 and 2, 7 pieces)", 3, knots,
                  [1 + generator.random() for _ in range(10)])
    plain.at = [(i + 0.5) / 241 for i in range(241)]
    out.append(plain)
    crossing = Curve("crossing", "a cubic spline with signs that change (coefficients between −1 and 1)", 3, knots,
                     [2 * generator.random() - 1 for _ in range(10)])
    crossing.at = plain.at
    return out + [crossing]


def scipy_values(c):
    try:
        import numpy
        import scipy.interpolate as si
    except ImportError:
        return None
    at = numpy.array(c.at)

    def form(v):
        if c.is_bezier():
            return si.BPoly(numpy.array(v)[:, None], numpy.array([0.0, 1.0]))(at)
        return si.BSpline(numpy.array(c.knots), numpy.array(v), c.degree)(at)

    return [float(v) for v in (form(c.x) / form(c.w) if c.rational else form(c.x))]


def run(program, c):
    if not program.is_file():
        return None
    done = subprocess.run([str(program)], input=c.text(), capture_output=True, text=True, timeout=60, check=True)
    return [[float.fromhex(word) for word in line.split()] for line in done.stdout.splitlines()]


def measure(c, programs):
    """Errors in units in the last place of the exact value: name -> list; bounds likewise."""
    exact = [c.exact(t) for t in c.at]
    unit = [math.ulp(float(v)) for v in exact]
    own = run(programs / "bench-accuracy", c)
    if own is None:
        sys.exit(f"{programs / 'bench-accuracy'} is not built (make accuracy builds it)")
    values = {"evaluate": [v[0] for v in own], "evaluate_accurate": [v[1] for v in own], "SciPy": scipy_values(c)}
    for name, program in (("Open CASCADE", "bench-accuracy-occt"), ("SISL", "bench-accuracy-sisl")):
        rows = run(programs / program, c)
        values[name] = rows and [r[0] for r in rows]

    def in_units(error, u):
        return float(error / Fraction(u))

    errors = {k: [in_units(abs(Fraction(x) - e), u) for x, e, u in zip(v, exact, unit)]
              for k, v in values.items() if v}
    bounds = {"evaluate": [v[3] / u for v, u in zip(own, unit)],
              "evaluate_accurate": [v[2] / u for v, u in zip(own, unit)]}
    for k, b in bounds.items():
        for error, bound in zip(errors[k], b):
            if error > bound * (1 + 1e-9):
                sys.exit(f"{c.name}: an error of {error} units of {k} is above its bound of {bound}")
    return errors, bounds


def svg(c, errors, bounds):
    width, height, left, right, top, bottom = 860, 440, 64, 16, 34, 84
    lo, hi = min(c.at), max(c.at)
    most = max(max(b) for b in list(bounds.values()) + list(errors.values()))
    high = min(TOP, math.ceil(math.log10(most)) + 0.5)

    def x(t):
        return left + (t - lo) / (hi - lo) * (width - left - right)

    def y(v):
        e = max(FLOOR, min(high, math.log10(v) if v > 0 else FLOOR))
        return height - bottom - (e - FLOOR) / (high - FLOOR) * (height - top - bottom)

    s = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
         'font-family="DejaVu Sans, Helvetica, Arial, sans-serif" font-size="12">',
         f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
         f'<text x="{left}" y="20" font-size="14">{c.title}</text>']
    step = 1 if high - FLOOR < 9 else 2
    for e in range(math.ceil(FLOOR), int(high) + 1):
        if e % step:
            continue
        at = y(10.0 ** e)
        s.append(f'<path d="M{left} {at:.1f}H{width - right}" stroke="{"#999999" if e == 0 else "#e4e4e4"}"/>')
        name = "1" if e == 0 else f'10<tspan dy="-5" font-size="9">{str(e).replace("-", "−")}</tspan>'
        s.append(f'<text x="{left - 8}" y="{at + 4:.1f}" text-anchor="end">{name}</text>')
    for i in range(5):
        t = lo + (hi - lo) * i / 4
        anchor = ("start", "middle", "middle", "middle", "end")[i]
        s.append(f'<text x="{x(t):.1f}" y="{height - bottom + 17}" text-anchor="{anchor}">{t:.4f}</text>')
    s.append(f'<text x="{(left + width - right) / 2}" y="{height - bottom + 34}" text-anchor="middle">t</text>')
    s.append(f'<text transform="translate(16 {(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">'
             'error, units in the last place</text>')
    for name, colour, _ in SERIES:
        if name in errors:
            dots = "".join(f"M{x(t):.1f} {y(v):.1f}h0" for t, v in zip(c.at, errors[name]))
            s.append(f'<path d="{dots}" stroke="{colour}" stroke-width="3.2" stroke-linecap="round" fill="none" '
                     'stroke-opacity="0.75"/>')
    for name, colour, _ in SERIES:
        if name in bounds:
            line = " ".join(f"{x(t):.1f},{y(v):.1f}" for t, v in zip(c.at, bounds[name]))
            s.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="1.4"/>')
    at = left
    for name, colour, _ in SERIES[::-1]:
        if name not in errors:
            continue
        s.append(f'<circle cx="{at + 4}" cy="{height - 30}" r="3.5" fill="{colour}"/>')
        s.append(f'<text x="{at + 13}" y="{height - 26}">{name}</text>')
        at += 30 + 7.4 * len(name)
    s.append(f'<text x="{left}" y="{height - 8}" fill="#555555">lines: proven bounds of the functions of the same colour; '
             'dots at the lower edge: at most 1/20</text>')
    return "\n".join(s + ["</svg>"]) + "\n"


def number(v):
    return f"{v:.2f}" if v < 1000 else re.sub(r"e\+0?", "e", f"{v:.1e}")


def table(errors):
    rows = ["| | median | 19 of 20 below | largest | at most 1 unit |", "|---|---:|---:|---:|---:|"]
    for name, _, what in SERIES[::-1]:
        if name in errors:
            e = sorted(errors[name])
            n = len(e)
            rows.append(f"| {what} | {number(e[n // 2])} | {number(e[int(0.95 * (n - 1))])} | {number(e[-1])} | "
                        f"{sum(v <= 1 for v in e)} of {n} |")
    return "\n".join(rows)


PAGE = """# Accuracy of values

Made by `make accuracy` (`tools/accuracy_report.py`); do not edit. {peers}

Errors of computed values in units in the last place of the exact value (one unit: the distance of neighbouring doubles),
exact in rational arithmetic for the coefficients, knots and parameters that all programs got, bit for bit. Where dots of
two programs coincide, those of this library lie on top.

`Patch::evaluate` is off by at most `value_error_bound()`: 1.01 (6 p − 1) u max|Pᵢ| in each coordinate of a polynomial
curve of degree p, u = 2⁻⁵³, twice that and a rounding for a rational one with positive weights. That is the upper line in
each picture: beside small values it is many units, and no algorithm that works with doubles alone does much better, as the
others show. `evaluate_accurate` works with pairs of doubles, and gives each value with its own bound (the lower line): half a
unit wherever less than 2⁻³⁸ of the coefficients is not left over, and the truth where more cancels.

```cpp
#include <freiform/spline/accurate.hpp>
std::vector<Accurate<Vec<1>>> out(t.size());
evaluate_accurate(curve, t, out);   // out[i].value, out[i].bound
```

    freiform eval curve.json --at 0.75 --accurate

It works for curves, surfaces and volumes, polynomial and rational, Bernstein and B-spline bases, of all degrees, and takes
10 to 60 times as long. The bound is derived in `src/spline/accurate.cpp`. Splitting, insertion and elevation have bounds too
(`refinement_error`, `elevation_error`, `split_error`); the tests hold all of them against exact arithmetic for the
degrees 1 to 25.
"""


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "bin")
    arguments.add_argument("--output", type=pathlib.Path, default=ROOT / "docs")
    options = arguments.parse_args()
    (options.output / "accuracy").mkdir(parents=True, exist_ok=True)
    sections, absent = [], set()
    for c in curves():
        errors, bounds = measure(c, options.programs)
        absent |= {what for name, _, what in SERIES if name not in errors}
        (options.output / "accuracy" / f"{c.name}.svg").write_text(svg(c, errors, bounds), encoding="utf-8")
        sections.append(f"## {c.title[0].upper()}{c.title[1:]}\n\n![error over t](accuracy/{c.name}.svg)\n\n{table(errors)}\n")
        print(f"{c.name}\n{table(errors)}\n")
    peers = "Missing here: " + "; ".join(sorted(absent)) + "." if absent else \
        "Beside it Open CASCADE, SISL and SciPy as Debian 12 has them."
    page = PAGE.format(peers=peers) + "\n" + "\n".join(sections)
    (options.output / "accuracy.md").write_text(page, encoding="utf-8")


# Debian's SciPy belongs to Debian's Python, which need not be the first on the path.
DEBIAN = "/usr/bin/python3"
if __name__ == "__main__":
    if not importlib.util.find_spec("scipy") and os.access(DEBIAN, os.X_OK) and not os.environ.get("ACCURACY_AGAIN"):
        os.execve(DEBIAN, [DEBIAN, *sys.argv], dict(os.environ, ACCURACY_AGAIN="1"))
    main()
