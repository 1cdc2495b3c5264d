#!/usr/bin/env python3
"""tools/bench_report.py [--build DIR] [--rounds N] [--only TEXT] [--tolerances T,T]: compares tessellation with Open CASCADE.

Runs bench-tessellate and bench-tessellate-occt (bench/CMakeLists.txt) in turns over the models below, each run a
process of its own with a time limit, and writes bench/results/DATE-COMMIT.json and, from it, bench/REPORT.md. With
--only, which takes only the models whose name contains TEXT, it prints the report instead of writing anything. For each
row Open CASCADE runs once more, at the deflection with which it reaches our tolerance: found by bisection and kept in
BUILD/bench-deflections.json. bench_report_text.py writes the words.
"""
import argparse
import datetime
import functools
import gzip
import json
import math
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import time

from bench_report_text import TOLERANCES, good, report, table_row

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIMIT = 60  # seconds for one process
BISECTIONS = 6
COPIES_AT = 1e-4  # of the diagonal: the tolerance at which two copies of the program are timed
SEARCH_LIMIT = 120  # seconds of search for one row, after which the run in progress is the last one
OCCT_DATA = "/usr/share/opencascade/data"
GMSH_DATA = "/usr/share/doc/gmsh-doc/doc/gmsh/demos/boolean"

# The 16 models of the comparison: Debian's packages occt-misc and gmsh-doc.
PEER_MODELS = [
    ("as1-tu-203.stp", f"{GMSH_DATA}/as1-tu-203.stp.gz"),
    ("bearing.iges", f"{OCCT_DATA}/iges/bearing.iges"),
    ("component8.step", f"{GMSH_DATA}/component8.step.gz"),
    ("hammer.iges", f"{OCCT_DATA}/iges/hammer.iges"),
    ("linkrods.step", f"{OCCT_DATA}/step/linkrods.step"),
    ("Ball.brep", f"{OCCT_DATA}/occ/Ball.brep"),
    ("CrankArm.brep", f"{OCCT_DATA}/occ/CrankArm.brep"),
    ("MODERN_Chair_1.brep", f"{OCCT_DATA}/occ/MODERN_Chair_1.brep"),
    ("Motor-c.brep", f"{OCCT_DATA}/occ/Motor-c.brep"),
    ("Pump_TopCover.brep", f"{OCCT_DATA}/occ/Pump_TopCover.brep"),
    ("Top.brep", f"{OCCT_DATA}/occ/Top.brep"),
    ("bottle.brep", f"{OCCT_DATA}/occ/bottle.brep"),
    ("hammer.brep", f"{OCCT_DATA}/occ/hammer.brep"),
    ("shell1.brep", f"{OCCT_DATA}/occ/shell1.brep"),
    ("wing.brep", f"{OCCT_DATA}/occ/wing.brep"),
    ("screw.step", f"{OCCT_DATA}/step/screw.step"),
]
# One large face that the programs make themselves (bench/common/hills_face.hpp).
# IGES files have loose faces; these rows are of their faces joined before, by each program in its way.
SEWN = [(f"{name}, sewn", path) for name, path in PEER_MODELS if name.endswith(".iges")]
FACES = ["hills", "hills-with-holes"]
OWN_MODELS = [("bracket.step", str(ROOT / "examples/bracket.step")), ("teapot.bpt", str(ROOT / "examples/teapot.bpt"))]


def unpacked(path, folder):
    """A readable file for `path`, or None. Debian compresses what lies under /usr/share/doc."""
    if path in FACES:
        return path
    path = pathlib.Path(path)
    if not path.is_file():
        return None
    if path.suffix != ".gz":
        return path
    folder.mkdir(parents=True, exist_ok=True)
    plain = folder / path.stem
    with gzip.open(path, "rb") as source, open(plain, "wb") as target:
        shutil.copyfileobj(source, target)
    return plain


def confine(first=0, end=2):
    """The next program gets two processors, or these of the ones there are."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[first:end])


def run(command):
    """What the program says, or {"refusal": why there is nothing}."""
    try:
        done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=LIMIT,
                              preexec_fn=confine)
    except subprocess.TimeoutExpired:
        return {"refusal": f"not finished after {LIMIT} s"}
    if done.returncode < 0:
        return {"refusal": f"crashed (signal {-done.returncode})"}
    try:
        # Some readers of Open CASCADE print to standard output themselves; the result is the last line.
        return json.loads(done.stdout.strip().split("\n")[-1])
    except ValueError:
        return {"refusal": f"exit status {done.returncode}: {(done.stderr or done.stdout).strip()[-200:]}"}


def add_times(result, more):
    for clock in ("one_thread", "two_threads"):
        for kind, values in more.get(clock, {}).items():
            result[clock][kind] += values


def sewing(name):
    return ["--sew"] if name.endswith(", sewn") else []


def measure(name, path, relative, programs, rounds):
    """One row: both programs in turns, `rounds` times; what is not a time is measured in the first round."""
    ours, occt = None, None
    wants_occt = programs["occt"] and not name.endswith(".bpt")
    for i in range(rounds):
        tail = ["--relative", repr(relative)] + (["--times-only"] if i else []) + sewing(name)
        if wants_occt and (occt is None or "refusal" not in occt):
            result = run([programs["occt"], path] + tail)
            occt = result if i == 0 else (add_times(occt, result) or occt)
        if ours is None or "refusal" not in ours:
            diagonal = ["--diagonal", repr(occt["diagonal"])] if occt and "diagonal" in occt else []
            result = run([programs["ours"], path] + tail + diagonal)
            ours = result if i == 0 else (add_times(ours, result) or ours)
    return {"model": name, "relative": relative, "freiform": ours, "occt": occt}


def deflection_that_reaches(path, relative, diagonal, program, cache, more):
    """The largest deflection found, relative to the diagonal, with which Open CASCADE's measured deviation is at most
    `relative` of it; None if none was found before SEARCH_LIMIT. Some deflections between it and `relative` may do as well: the
    deviation is not a monotone function of the deflection."""
    size = 0 if path in FACES else pathlib.Path(path).stat().st_size
    key = " ".join([f"{path} {size} {relative:g}"] + more)
    known = json.loads(cache.read_text()) if cache.is_file() else {}
    if key in known:
        return known[key]

    def reaches(deflection):
        result = run([program, path, "--relative", repr(deflection), "--diagonal", repr(diagonal), "--repetitions", "1"] + more)
        return good(result) and result["deviation"] <= relative * diagonal

    found, above, end = None, relative, time.monotonic() + SEARCH_LIMIT
    if reaches(relative):
        found = relative
    else:
        below = relative
        for _ in range(BISECTIONS):  # down by factors of four first
            below /= 4
            if time.monotonic() > end:
                break
            if reaches(below):
                found = below
                break
            above = below
        for _ in range(BISECTIONS if found else 0):
            middle = math.sqrt(found * above)
            if above / found < 1.1 or time.monotonic() > end:
                break
            if reaches(middle):
                found = middle
            else:
                above = middle
    known[key] = found
    cache.write_text(json.dumps(known, indent=1) + "\n")
    return found


def measure_at_same_error(row, path, programs, rounds, cache, reached_more):
    """Open CASCADE at the deflection that reaches our tolerance, as row["occt_reached"]; None where there is none. What is not
    reached for a larger tolerance (`reached_more` false) is not looked for."""
    row["occt_reached"] = None
    if not good(row["occt"]) or not good(row["freiform"]) or not reached_more:
        return row
    diagonal = row["occt"]["diagonal"]
    sewn = sewing(row["model"])
    deflection = deflection_that_reaches(path, row["relative"], diagonal, programs["occt"], cache, sewn)
    if deflection is None:
        return row
    for i in range(rounds):
        more = (["--times-only"] if i else []) + sewn
        result = run([programs["occt"], path, "--relative", repr(deflection), "--diagonal", repr(diagonal)] + more)
        if not good(result):
            return row
        row["occt_reached"] = result if i == 0 else (add_times(row["occt_reached"], result) or row["occt_reached"])
    row["occt_reached"]["relative"] = deflection
    return row


def measure_copies(program, rounds):
    """What a second processor is worth to the meshing of the large faces: for each, the times of one thread alone, of two
    copies of the program at the same time, each with one thread on a processor of its own, and of two threads, in turns.
    None where there are not two processors."""
    if not hasattr(os, "sched_getaffinity") or len(os.sched_getaffinity(0)) < 2:
        return None

    def times(face, clock, processors):
        command = [str(program), face, "--relative", repr(COPIES_AT), "--times-only"]
        running = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True, preexec_fn=functools.partial(confine, *p))
                   for p in processors]
        return [t for copy in running for t in json.loads(copy.communicate()[0])[clock]["wall_ms"]]

    out = []
    for face in FACES:
        found = {"model": face, "relative": COPIES_AT, "alone_ms": [], "together_ms": [], "two_threads_ms": []}
        for _ in range(max(rounds, 3)):
            found["alone_ms"] += times(face, "one_thread", [(0, 1)])
            found["together_ms"] += times(face, "one_thread", [(0, 1), (1, 2)])
            found["two_threads_ms"] += times(face, "two_threads", [(0, 2)])
        out.append(found)
    return out


def machine():
    names = [line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")] \
        if os.path.exists("/proc/cpuinfo") else []
    return {"cpu": names[0] if names else platform.machine(), "cores": os.cpu_count(), "load": os.getloadavg()[0]}


def commit():
    git = ["git", "-C", str(ROOT)]
    try:
        short = subprocess.run(git + ["rev-parse", "--short=7", "HEAD"], capture_output=True, text=True, check=True).stdout
        changed = subprocess.run(git + ["status", "--porcelain", "--", "src", "include", "bench/common", "bench/tasks",
                                        "bench/compare"], capture_output=True, text=True, check=True).stdout
        return short.strip() + ("-changed" if changed.strip() else "")
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def measure_interpolation(folder, rounds):
    """Interpolation by freiform and by SciPy in turns, or None where a program is missing."""
    ours, scipy = folder / "bin/bench-interpolate", ROOT / "bench/compare/interpolate_scipy.py"
    if not ours.is_file():
        return None
    both = {}
    for _ in range(rounds):
        for who, command in (("freiform", [ours]), ("scipy", ["/usr/bin/python3", scipy])):
            result = run(command)
            for name, value in result.items():
                if isinstance(value, dict) and name in both.setdefault(who, {}):
                    both[who][name]["processor_ms"] += value["processor_ms"]
                else:
                    both.setdefault(who, {})[name] = value
    return both


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("--build", default="build", help="the build folder (default: build)")
    options.add_argument("--rounds", type=int, default=2)
    options.add_argument("--only", default="")
    options.add_argument("--tolerances", type=lambda s: [float(t) for t in s.split(",")], default=TOLERANCES,
                         help="parts of the diagonal (default: 1e-3,1e-4,1e-5)")
    args = options.parse_args()
    folder = pathlib.Path(args.build)
    folder = folder if folder.is_absolute() else ROOT / folder
    programs = {"ours": folder / "bin/bench-tessellate", "occt": folder / "bin/bench-tessellate-occt"}
    if not programs["ours"].is_file():
        sys.exit(f"{programs['ours']} is not built: make bench")
    skipped = []
    if not programs["occt"].is_file():
        programs["occt"] = None
        skipped.append({"model": "all", "reason": "no Open CASCADE was found to compare with"})
    rows, before = [], machine()
    for name, source in PEER_MODELS + SEWN + [(f, f) for f in FACES] + OWN_MODELS:
        if args.only not in name:
            continue
        path = unpacked(source, folder / "bench-models")
        if path is None:
            skipped.append({"model": name, "reason": f"{source} is not there"})
            continue
        reached = True
        for relative in sorted(args.tolerances, reverse=True):
            row = measure(name, path, relative, programs, args.rounds)
            rows.append(measure_at_same_error(row, path, programs, args.rounds, folder / "bench-deflections.json", reached))
            reached = rows[-1]["occt_reached"] is not None
            print(table_row(rows[-1]), file=sys.stderr, flush=True)
    data = {"name": f"{datetime.date.today().isoformat()}-{commit()}", "commit": commit(), "rounds": args.rounds,
            "machine": before, "build": json.loads((folder / "bin/bench.json").read_text()), "skipped": skipped, "rows": rows,
            "copies": None if args.only else measure_copies(programs["ours"], args.rounds),
            "interpolation": None if args.only else measure_interpolation(folder, args.rounds)}
    if args.only:
        print(report(data))
        return
    results = ROOT / "bench/results"
    results.mkdir(parents=True, exist_ok=True)
    (results / f"{data['name']}.json").write_text(json.dumps(data, indent=1) + "\n")
    (ROOT / "bench/REPORT.md").write_text(report(data))
    print(f"bench/REPORT.md and bench/results/{data['name']}.json")


if __name__ == "__main__":
    main()
