#!/usr/bin/env bash
# tools/check_alone.sh [all]: does every source file of the programs and the library include what it needs? The builds of
# developers compile several files as one and precompile headers, which hides what is missing; `make build` does not.
# All of them take as long as a build. Without `all` it is those that the last commits changed, or of which they changed a
# header, also by way of other headers: the rest is as it was when it was checked. Of that a third all the same, by the day.
set -euo pipefail
cd "$(dirname "$0")/.."
temp=$(mktemp -d)
trap 'rm -rf "$temp"' EXIT
cmake -S . -B "$temp" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=None -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
    -DFREIFORM_TESTS=OFF -DFREIFORM_PCH=OFF -DFREIFORM_UNITY=OFF -DFREIFORM_CCACHE=OFF >/dev/null
python3 - "$temp/compile_commands.json" "${1:-}" <<'EOF'
import concurrent.futures, datetime, glob, json, os, re, shlex, subprocess, sys, zlib

COMMITS, PARTS = 40, 3

def changed():
    """What the last commits changed, and what is not committed; None where there are no such commits to ask."""
    def git(*words):
        return subprocess.run(["git", *words], capture_output=True, text=True, check=True).stdout.splitlines()
    try:
        names = git("diff", "--name-only", f"HEAD~{COMMITS}") + git("ls-files", "--others", "--exclude-standard")
    except (OSError, subprocess.CalledProcessError):
        return None
    return {os.path.abspath(name) for name in names}

def check(entry):
    words = shlex.split(entry["command"])
    del words[words.index("-o"):words.index("-o") + 2]
    done = subprocess.run(words + ["-fsyntax-only"], cwd=entry["directory"], capture_output=True, text=True)
    if done.returncode:
        print(done.stderr, file=sys.stderr)
    return done.returncode == 0

entries = list({entry["file"]: entry for entry in json.load(open(sys.argv[1]))}.values())
total, new = len(entries), changed()
if sys.argv[2] != "all" and new is not None:
    def includes(name):
        return set(re.findall(r'#include [<"](?:[^>"]*/)?([^>"/]*)[>"]', open(name, encoding="utf-8").read()))
    day = datetime.date.today().toordinal()
    headers = {name: includes(name) for folder in ("include", "src", "apps", "bindings", "examples")
               for name in glob.glob(f"{folder}/**/*.hpp", recursive=True)}
    of_headers, before = {os.path.basename(name) for name in new if name.endswith(".hpp")}, None
    while of_headers != before:
        before = set(of_headers)
        of_headers |= {os.path.basename(name) for name, own in headers.items() if own & of_headers}
    def wanted(name):
        return name in new or includes(name) & of_headers or (zlib.crc32(os.path.relpath(name).encode()) + day) % PARTS == 0
    entries = [entry for entry in entries if wanted(entry["file"])]
jobs = int(os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", os.cpu_count()))
with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
    good = list(pool.map(check, entries))
print(f"{sum(good)} of {len(entries)} files compile by themselves, of {total}")
sys.exit(len(entries) == 0 or not all(good))
EOF
