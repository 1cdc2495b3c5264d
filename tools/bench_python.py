#!/usr/bin/env python3
"""tools/bench_python.py CPP: compares evaluation from NumPy with the C++ program bench-python (CPP is its path) and with scipy,
and writes bench/PYTHON.md. PYTHONPATH names the package that is measured: a release build."""
import datetime
import pathlib
import statistics
import subprocess
import sys
import threading
import time
import tracemalloc

import numpy as np
import scipy.interpolate

import freiform as ff

N = 1_000_000


def nanoseconds(f, n=N):
    f()
    times = []
    for _ in range(15):
        start = time.perf_counter()
        f()
        times.append(time.perf_counter() - start)
    return statistics.median(times) / n * 1e9


def extra_memory(f):
    tracemalloc.start()
    out = f()
    peak = tracemalloc.get_traced_memory()[1] - out.nbytes
    tracemalloc.stop()
    return peak / 1e6


def in_two_threads(f):
    def run():
        threads = [threading.Thread(target=f) for _ in range(2)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
    return nanoseconds(run, 2 * N)


def main():
    i = np.arange(N)
    a, b = np.fmod(i * 0.6180339887498949, 1.0), np.fmod(i * 0.7548776662466927, 1.0)
    k, l = np.arange(100.0), np.arange(20.0)
    curve = ff.Curve(np.c_[k, 0 * k, np.sin(k)], 3, weights=1 + 0.1 * (k % 3))
    u, v = np.meshgrid(l, l, indexing="ij")
    surface = ff.Surface(np.stack([u, v, np.sin(u + 0.5 * v)], -1), (3, 3), weights=1 + 0.1 * ((u + v) % 3))
    calls = {"curve": lambda: curve(a97), "surface": lambda: surface(a17, b17)}
    a97, a17, b17 = a * 97, a * 17, b * 17
    rounds, cpp, ours = 3, {}, {}
    for _ in range(rounds):  # in turn, so that what else the machine does meets both
        for line in subprocess.run([sys.argv[1]], capture_output=True, text=True, check=True).stdout.splitlines():
            name, threads, ns = line.split()
            cpp.setdefault((name, threads), []).append(float(ns))
        for threads, setting in (("one", 1), ("all", 0)):
            ff.set_max_threads(setting)
            for name, call in calls.items():
                ours.setdefault((name, threads), []).append(nanoseconds(call))
    ff.set_max_threads(1)
    two = {name: in_two_threads(call) for name, call in calls.items()}
    plain = ff.Curve(curve.points, 3)
    spline = scipy.interpolate.BSpline(plain.knots, plain.points, 3)
    theirs, same = nanoseconds(lambda: spline(a97)), nanoseconds(lambda: plain(a97))
    best = lambda x: min(x)
    lines = ["# Evaluation from Python", "",
             f"Written by `tools/bench_python.py` on {datetime.date.today()}, {ff.instruction_set()}. A million points of a rational",
             "cubic curve (100 control points) and of a rational bicubic surface (20 x 20), u and v as two arrays; nanoseconds per",
             "point: the best of three medians of 15 runs, Python and C++ in turn.", "",
             "| | C++ | NumPy | ratio | extra memory, MB |", "|---|---|---|---|---|"]
    for (name, threads), c in cpp.items():
        p = ours[name, threads]
        lines.append(f"| {name}, {'one thread' if threads == 'one' else 'all threads'} | {best(c):.2f} | {best(p):.2f} | "
                     f"{best(p) / best(c):.2f} | {extra_memory(calls[name]):.2f} |")
    lines += ["", "Two threads of Python that evaluate at the same time, each on one thread of the library, against one after the other:", ""]
    for name in calls:
        lines.append(f"- {name}: {best(ours[name, 'one']) / two[name]:.2f} times as many points per second")
    lines += ["", f"Beside scipy's `BSpline` (polynomial, the same curve, one thread): {theirs:.1f} ns, freiform {same:.1f} ns: "
              f"{theirs / same:.1f} times as fast.", ""]
    root = pathlib.Path(__file__).resolve().parents[1]
    (root / "bench" / "PYTHON.md").write_text("\n".join(lines))
    print("\n".join(lines))


if __name__ == "__main__":
    main()
