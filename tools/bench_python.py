#!/usr/bin/python3
"""tools/bench_python.py [CPP]: compares evaluation from NumPy with the C++ program bench-python (build/bin/, or CPP), and with
scipy and geomdl where they are installed; writes bench/PYTHON.md. The package is that of build/python, or of PYTHONPATH.

    cmake --preset python -DFREIFORM_BENCH=ON && cmake --build build --target freiform_python_package bench-python
    tools/bench_python.py

Takes a minute (ROUNDS=1: a quick look). Ends with 1 where what the report demands is not reached. The machine has to be idle: times of the clock mean
nothing on a loaded one (those of the processor, beside them, do)."""
import datetime
import os
import pathlib
import re
import statistics
import subprocess
import sys
import threading
import time
import tracemalloc

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "build" / "python"))

import numpy as np  # noqa: E402

import freiform as ff  # noqa: E402

N, RUNS, ROUNDS = 1_000_000, 15, int(os.environ.get("ROUNDS", 5))
SLACK, GAIN, MEGABYTES = 1.10, 1.8, 1.0  # what is demanded


def nanoseconds(f, n=N, runs=RUNS):
    """(of the clock, of the processor) for each point: medians, after a run that is not counted."""
    f()
    clock, processor = [], []
    for _ in range(runs):
        before, start = time.process_time(), time.perf_counter()
        f()
        clock.append(time.perf_counter() - start)
        processor.append(time.process_time() - before)
    return statistics.median(clock) / n * 1e9, statistics.median(processor) / n * 1e9


def extra_memory(f):
    tracemalloc.start()
    out = f()
    peak = tracemalloc.get_traced_memory()[1] - out.nbytes
    tracemalloc.stop()
    return peak / 1e6


def in_two_threads(calls):
    """Nanoseconds for a point where two threads make their calls at the same time, from the first start to the last end."""
    gate, spans = threading.Barrier(len(calls)), []

    def work(f):
        f()
        gate.wait()
        start = time.perf_counter()
        for _ in range(RUNS):
            f()
        spans.append((start, time.perf_counter()))
    threads = [threading.Thread(target=work, args=(f,)) for f in calls]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    return (max(end for _, end in spans) - min(start for start, _ in spans)) / (len(calls) * RUNS * N) * 1e9


def best(pairs):
    """The least of each: what else the machine does only adds."""
    return tuple(map(min, zip(*pairs)))


def objects():
    i = np.arange(N)
    a, b = np.fmod(i * 0.6180339887498949, 1.0), np.fmod(i * 0.7548776662466927, 1.0)
    k, l = np.arange(100.0), np.arange(20.0)
    curve = ff.Curve(np.c_[k, 0 * k, np.sin(k)], 3, weights=1 + 0.1 * (k % 3))
    u, v = np.meshgrid(l, l, indexing="ij")
    surface = ff.Surface(np.stack([u, v, np.sin(u + 0.5 * v)], -1), (3, 3), weights=1 + 0.1 * ((u + v) % 3))
    return curve, surface, a * 97, a * 17, b * 17


def open_cascade(ours):
    """A line about what Open CASCADE takes for the same objects, called from C++: bench/EVALUATION.md has it."""
    page = (ROOT / "bench" / "EVALUATION.md").read_text()
    day = re.search(r"\d{4}-\d\d-\d\d", page)[0]
    theirs = {name: float(re.search(rf"^\| {work} \|[^|]*\|[^|]*\| ([\d.]+) \|", page, re.M)[1])
              for name, work in (("curve", "curve, random"), ("surface", "surface, scattered"))}
    return ("- Open CASCADE 7.6, called from C++, figures of `bench/EVALUATION.md` (" + day + "): "
            + ", ".join(f"{name} {x:.0f} ns, freiform from NumPy {ours[name]:.2f} ns: {x / ours[name]:.1f} times as fast"
                        for name, x in theirs.items()))


def others(curve, t):
    """Lines about other libraries, on one thread."""
    plain = ff.Curve(curve.points, 3)
    lines = []
    try:
        import scipy.interpolate
        spline = scipy.interpolate.BSpline(plain.knots, plain.points, 3)
        theirs, same = nanoseconds(lambda: spline(t), runs=5)[0], nanoseconds(lambda: plain(t))[0]
        lines.append(f"- scipy {scipy.__version__}, `BSpline` (polynomial, the same curve): {theirs:.1f} ns, freiform "
                     f"{same:.1f} ns: {theirs / same:.1f} times as fast")
    except ImportError:
        lines.append("- scipy: not installed")
    try:
        import geomdl.NURBS
        c = geomdl.NURBS.Curve()
        c.degree, c.ctrlptsw, c.knotvector = 3, curve.coefficients.tolist(), (curve.knots / 97).tolist()
        few = (t[:1000] / 97).tolist()
        theirs, same = nanoseconds(lambda: c.evaluate_list(few), 1000, 3)[0], nanoseconds(lambda: curve(t))[0]
        lines.append(f"- geomdl {geomdl.__version__} (the same curve): {theirs:.0f} ns: {theirs / same:.0f} times as fast")
    except ImportError:
        lines.append("- geomdl: not installed")
    return lines


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build" / "bin" / "bench-python")
    load = os.getloadavg()[0]
    if load > 0.5:
        print(f"the machine is not idle (load {load:.1f}): times of the clock will be wrong", file=sys.stderr)
    curve, surface, t, u, v = objects()
    out = np.empty((N, 3))
    calls = {("curve", "fresh"): lambda: curve(t), ("curve", "reused"): lambda: curve.evaluate(t, out=out),
             ("surface", "fresh"): lambda: surface(u, v), ("surface", "reused"): lambda: surface.evaluate(u, v, out=out)}
    cpp, ours = {}, {}
    for _ in range(ROUNDS):  # in turn, so that what else the machine does meets both
        for line in subprocess.run([program], capture_output=True, text=True, check=True).stdout.splitlines():
            name, threads, memory, clock, processor = line.split()
            cpp.setdefault((name, threads, memory), []).append((float(clock), float(processor)))
        for threads, setting in (("one", 1), ("all", 0)):
            ff.set_max_threads(setting)
            for (name, memory), call in calls.items():
                ours.setdefault((name, threads, memory), []).append(nanoseconds(call))
    ff.set_max_threads(1)
    held = []
    lines = ["# Evaluation from Python", "",
             f"Written by `tools/bench_python.py` on {datetime.date.today()}, {ff.instruction_set()}, {os.cpu_count()} cores, load "
             f"{load:.1f} at the start. A million points", "of a rational cubic curve (100 control points) and of a rational "
             "bicubic surface (20 x 20), u and v as two arrays;", "nanoseconds per point, of the clock and (in brackets) of the "
             f"processor: the best of {ROUNDS} medians of {RUNS} runs, Python and C++ in", "turn. Fresh: into a new array each time, "
             "in C++ into new memory that is not cleared; reused: into one that is there (`out=`).", "",
             "| | C++ | NumPy | ratio | extra memory, MB |", "|---|---|---|---|---|"]
    for key, pairs in cpp.items():
        name, threads, memory = key
        c, p, extra = best(pairs), best(ours[key]), extra_memory(calls[name, memory]) if memory == "fresh" else None
        ratio = p[0] / c[0]
        held += [ratio <= SLACK] + ([extra < MEGABYTES] if extra is not None else [])
        lines.append(f"| {name}, {threads} thread{'s' if threads == 'all' else ''}, {memory} | {c[0]:.2f} ({c[1]:.2f}) | "
                     f"{p[0]:.2f} ({p[1]:.2f}) | {ratio:.2f} ({p[1] / c[1]:.2f}) | {'' if extra is None else f'{extra:.3f}'} |")
    lines += ["", "Two threads of Python that evaluate at the same time, each on one thread of the library, against one:", ""]
    for name in ("curve", "surface"):
        for memory in ("fresh", "reused"):
            one = best(ours[name, "one", memory])[0]
            patch, at = (curve, (t,)) if name == "curve" else (surface, (u, v))
            into = [None, None] if memory == "fresh" else [np.empty((N, 3)), np.empty((N, 3))]
            both = [lambda x=x: patch.evaluate(*at, out=x) for x in into]
            gain = one / min(in_two_threads(both) for _ in range(ROUNDS))
            held.append(gain >= GAIN)
            lines.append(f"- {name}, {memory}: {gain:.2f} times as many points per second")
    lines += ["", "Beside other libraries, one thread:", ""] + others(curve, t)
    lines += [open_cascade({name: best(ours[name, "one", "fresh"])[0] for name in ("curve", "surface")})]
    lines += ["", f"Demanded: ratios of at most {SLACK}, less than {MEGABYTES} MB of extra memory, {GAIN} times as many points with two "
              f"threads: {sum(held)} of {len(held)} reached.", ""]
    (ROOT / "bench" / "PYTHON.md").write_text("\n".join(lines))
    print("\n".join(lines))
    return 0 if all(held) else 1


if __name__ == "__main__":
    sys.exit(main())
