#!/usr/bin/python3
"""Writes scipy_splines.txt beside this file: what SciPy's interpolants are at some parameters.

Run once, with Debian 12's python3-scipy (1.10.1) and python3-numpy; the tests read the result.
"""
import pathlib

import numpy as np
import scipy
from scipy.interpolate import Akima1DInterpolator, CubicSpline, PchipInterpolator, make_interp_spline

at = np.array([0, 0.5, 0.75, 2, 2.125, 3.5, 4, 6, 6.5, 7.75])
points = np.array([[0, 1], [1, 1.5], [1.25, 3], [2, 2.5], [4, 2.75], [4.5, 2], [3, 0.5], [2.5, 0.5], [1, -1], [0, 1]])
slopes = np.array([[2, -1], [0.5, 3]])
samples = np.linspace(at[0], at[-1], 41)
rising = np.cumsum(np.abs(points), axis=0)

cases = {
    "natural": CubicSpline(at, points, bc_type="natural"),
    "clamped": CubicSpline(at, points, bc_type=((1, slopes[0]), (1, slopes[1]))),
    "not-a-knot": CubicSpline(at, points, bc_type="not-a-knot"),
    "periodic": CubicSpline(at, points, bc_type="periodic"),
    "not-a-knot 2": make_interp_spline(at, points, k=2),
    "not-a-knot 5": make_interp_spline(at, points, k=5),
    "akima": Akima1DInterpolator(at, points),
    "monotone": PchipInterpolator(at, rising),
}
tables = {"at": at, "points": points, "rising": rising, "slopes": slopes, "samples": samples}
tables |= {name: f(samples) for name, f in cases.items()}
lines = [f"# scipy {scipy.__version__}: a table per line, its name, the number of columns, and its numbers row by row"]
for name, table in tables.items():
    columns = 1 if table.ndim == 1 else table.shape[1]
    lines.append(" ".join([name.replace(" ", "_"), str(columns)] + [repr(float(x)) for x in table.ravel()]))
pathlib.Path(__file__).with_suffix(".txt").write_text("\n".join(lines) + "\n")
