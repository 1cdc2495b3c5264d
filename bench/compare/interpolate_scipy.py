#!/usr/bin/python3
"""The same as bench-interpolate with SciPy: processor times in milliseconds, as JSON. Exit status 3 without SciPy."""
import json
import sys
import time

try:
    import numpy as np
    import scipy
    from scipy.interpolate import RectBivariateSpline, make_interp_spline
except ImportError:
    sys.exit(3)

np.seterr(over="ignore")


def noise(seed, n):
    z = np.uint64(seed) + np.arange(1, n + 1, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return ((z ^ (z >> np.uint64(31))) >> np.uint64(11)).astype(float) * 2.0**-53


def times(job, repetitions=15):
    out = []
    for _ in range(repetitions):
        start = time.process_time()
        job()
        out.append(1e3 * (time.process_time() - start))
    return {"processor_ms": out}


result = {"version": scipy.__version__}
for n in (1000, 10000, 100000):
    s = np.arange(n) / (n - 1)
    turn = 4 * np.pi * s
    q = np.stack([np.cos(turn) * (1 + 0.3 * np.sin(40 * s)), np.sin(turn), 2 * s], 1)
    q += 0.002 * (noise(9001, 3 * n).reshape(n, 3) - 0.5)
    at = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(q, axis=0), axis=1))])
    for ends in ("natural", "not-a-knot"):
        result[f"curve {n} {ends}"] = times(lambda: make_interp_spline(at, q, 3, bc_type=ends))
for n in (50, 100, 200):
    x = np.arange(n) / (n - 1)
    u, v = np.meshgrid(x, x, indexing="ij")
    z = 0.15 * np.sin(6 * u) * np.cos(5 * v) + 0.02 * (noise(9002, n * n).reshape(n, n) - 0.5)
    # One function for each coordinate: SciPy has no other way.
    result[f"grid {n}"] = times(lambda: [RectBivariateSpline(x, x, c, s=0) for c in (u, v, z)])
print(json.dumps(result))
