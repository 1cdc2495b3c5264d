"""What the comparisons of tools/bench_*.py share: programs run in turns, their lines, times and ratios as text, the page."""
import datetime
import os
import pathlib
import platform
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

HEAD = """Made by `make bench` (`tools/{script}`); do not edit. {when}, {machine}{build}. Load when it began: {load:.1f} on {cores}
processors (more than 1 per processor: others were at work, and times are too long, unevenly)."""


def run(program, text=None):
    """The program, or a list with its arguments: task -> numbers, from lines "task seconds [name=number ..]" or "task failed" (None)."""
    command = [str(word) for word in program] if isinstance(program, list) else [str(program)]
    done = subprocess.run(command, input=text, capture_output=True, text=True, timeout=600, check=True)
    out = {}
    for line in done.stdout.splitlines():
        task, *words = line.split()
        if words == ["failed"]:
            out[task] = None
            continue
        numbers = {"seconds": float(words[0])}
        for word in words[1:]:
            key, value = word.split("=")
            numbers[key] = float.fromhex(value) if "0x" in value else float(value)
        out[task] = numbers
    return out


def keep_shortest(kept, tasks):
    for task, numbers in tasks.items():
        old = kept.get(task)
        if old is None or (numbers and numbers["seconds"] < old["seconds"]):
            kept[task] = numbers


def medians(rounds):
    """Of several runs of one program: the last numbers of each task, with the median of the times."""
    out = {task: dict(numbers) for task, numbers in rounds[-1].items()}
    for task, numbers in out.items():
        numbers["seconds"] = statistics.median(r[task]["seconds"] for r in rounds)
    return out


def duration(seconds):
    for unit, size in (("ns", 1e-9), ("µs", 1e-6), ("ms", 1e-3)):
        if seconds < 1000 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds:.3g} s"


def ratio(other, mine):
    return f"{other / mine:.2g}" if other / mine < 100 else f"{other / mine:.0f}"


def head(script, build=""):
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")),
               platform.machine())
    return HEAD.format(script=script, when=datetime.date.today().isoformat(), machine=cpu, build=build and "; " + build,
                       load=os.getloadavg()[0], cores=os.cpu_count())


def parse(arguments, needed):
    """Adds --programs and --print; leaves if the program is not built."""
    arguments.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "bin")
    arguments.add_argument("--print", action="store_true", dest="only_print")
    options = arguments.parse_args()
    if not (options.programs / needed).is_file():
        sys.exit(f"{options.programs / needed} is not built (make bench builds it)")
    return options


def verdicts(tasks, kind):
    """The rows of a table from lines "kind:name seconds count= right= open= wrong=" of bench-nasty, and the sum of all."""
    rows, total, longest = [], {"count": 0, "right": 0, "open": 0, "wrong": 0}, (0, "")
    for task, n in tasks.items():
        if not task.startswith(kind + ":"):
            continue
        name = task.split(":", 1)[1].replace("_", " ")
        rows.append(f"| {name} | {n['count']:.0f} | {n['right']:.0f} | {n['open']:.0f} | {n['wrong']:.0f} | {duration(n['seconds'])} |")
        total = {k: v + n[k] for k, v in total.items()}
        longest = max(longest, (n["seconds"], name))
    rows.append(f"| all | {total['count']:.0f} | {total['right']:.0f} | {total['open']:.0f} | {total['wrong']:.0f} | "
                f"{duration(longest[0])} ({longest[1]}) |")
    return "\n".join(rows)


def write(options, name, page):
    if options.only_print:
        print(page)
    else:
        (ROOT / "bench" / name).write_text(page, encoding="utf-8")
        print(f"bench/{name}: {page.count(chr(10))} lines")
