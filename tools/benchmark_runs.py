"""What the scripts that measure evaluation share: running programs of Google Benchmark, quartiles, plots, records."""
import datetime
import json
import math
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
COLOURS = ["#1f6feb", "#c44e52", "#8a6d3b", "#55a868"]


def quartiles(ns):
    """Of some times."""
    q = statistics.quantiles(ns, n=4, method="inclusive") if len(ns) > 1 else ns * 3
    return {"min": min(ns), "q1": q[0], "median": q[1], "q3": q[2]}


def measure(program, repetitions, least, only=None):
    """The context of the program, and name -> quartiles in ns a point and, where there is one, a sample of the result."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.json"
        subprocess.run([str(program), f"--benchmark_out={out}", "--benchmark_out_format=json", f"--benchmark_min_time={least}",
                        f"--benchmark_repetitions={repetitions}", "--benchmark_enable_random_interleaving=true"]
                       + ([f"--benchmark_filter={only}"] if only else []),
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        answer = json.loads(out.read_text())
    runs, samples = {}, {}
    for b in answer["benchmarks"]:
        if b.get("error_occurred"):
            sys.exit(f"{b['name']}: {b['error_message']}")
        if b["run_type"] == "iteration":
            name = b["run_name"].split("/repeats")[0].removesuffix("/real_time")
            runs.setdefault(name, []).append(1e9 / b["items_per_second"])
            samples[name] = b.get("sample")
    found = {name: quartiles(ns) for name, ns in runs.items()}
    for name, sample in samples.items():
        if sample is not None:
            found[name]["sample"] = sample
    return answer["context"], found


def series(found, job, place, others):
    """Points (x, quartiles) of one job along its argument `place`, the other arguments as given."""
    points = []
    for name, q in found.items():
        words = name.split("/")
        arguments = [int(w) for w in words[1:]]
        if words[0] == job and all(arguments[i] == x for i, x in others.items()):
            points.append((arguments[place], q))
    return sorted(points, key=lambda p: p[0])


def plot(title, label, lines, path):
    """An SVG: lines (name, [(x, quartiles)]) over logarithmic axes, with bars from quartile to quartile."""
    lines = [line for line in lines if line[1]]
    xs = sorted({x for _, points in lines for x, _ in points})
    ys = [y for _, points in lines for _, q in points for y in (q["q1"], q["q3"])]
    low, high = math.floor(math.log10(min(ys))), math.ceil(math.log10(max(ys)))
    first, last = math.log2(xs[0]), max(math.log2(xs[-1]), math.log2(xs[0]) + 1)

    def x_of(x):
        return 60 + 470 * (math.log2(x) - first) / (last - first)

    def y_of(y):
        return 250 - 210 * (math.log10(y) - low) / (high - low)

    out = [f'<text x="8" y="18" font-weight="bold">{title}</text>']
    for e in range(low, high + 1):
        out.append(f'<line x1="60" x2="540" y1="{y_of(10 ** e):.1f}" y2="{y_of(10 ** e):.1f}" stroke="#ddd"/>'
                   f'<text x="54" y="{y_of(10 ** e) + 4:.1f}" text-anchor="end">{10 ** e:g} ns</text>')
    for x in xs:
        out.append(f'<text x="{x_of(x):.1f}" y="266" text-anchor="middle">{x}</text>')
    out.append(f'<text x="300" y="284" text-anchor="middle">{label}</text>')
    for k, (name, points) in enumerate(lines):
        colour = COLOURS[k]
        corners = " ".join(f"{x_of(x):.1f},{y_of(q['median']):.1f}" for x, q in points)
        out.append(f'<polyline points="{corners}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        for x, q in points:
            out.append(f'<line x1="{x_of(x):.1f}" x2="{x_of(x):.1f}" y1="{y_of(q["q1"]):.1f}" y2="{y_of(q["q3"]):.1f}" '
                       f'stroke="{colour}" stroke-width="3"/><circle cx="{x_of(x):.1f}" cy="{y_of(q["median"]):.1f}" r="2.5" fill="{colour}"/>')
        out.append(f'<text x="550" y="{50 + 16 * k}" fill="{colour}">{name}</text>')
    path.write_text('<svg xmlns="http://www.w3.org/2000/svg" width="700" height="294" font-family="DejaVu Sans, sans-serif" '
                    f'font-size="11"><rect width="700" height="294" fill="white"/>{"".join(out)}</svg>\n', encoding="utf-8")


class Machine:
    """What a record says of where it was made. Made before the measurements, for the sake of the load."""

    def __init__(self, programs):
        self.day = datetime.date.today().isoformat()
        self.load = os.getloadavg()[0]
        self.cores = os.cpu_count()
        about = programs / "bench.json"
        self.build = json.loads(about.read_text()) if about.is_file() else {}
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            self.cpu = next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.machine())

    def words(self):
        return {"when": self.day, "machine": self.cpu, "load": self.load, "cores": self.cores,
                "build": f"{self.build.get('compiler', '')} {self.build.get('flags', '')}".strip()}

    def record(self, name, content):
        """bench/results/NAME-DATE.json"""
        head = {"date": self.day, "cpu": self.cpu, "build": self.build, "load": self.load}
        path = ROOT / "bench" / "results" / f"{name}-{self.day}.json"
        path.write_text(json.dumps(head | content, indent=1) + "\n", encoding="utf-8")
