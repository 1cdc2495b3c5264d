#!/usr/bin/env bash
# Does every source file of the programs and the library include what it needs? The builds of developers compile several
# files as one and precompile headers, which hides what is missing; `make build` does not.
set -euo pipefail
cd "$(dirname "$0")/.."
temp=$(mktemp -d)
trap 'rm -rf "$temp"' EXIT
cmake -S . -B "$temp" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=None -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
    -DFREIFORM_TESTS=OFF -DFREIFORM_PCH=OFF -DFREIFORM_UNITY=OFF -DFREIFORM_CCACHE=OFF >/dev/null
python3 - "$temp/compile_commands.json" <<'EOF'
import concurrent.futures, json, os, shlex, subprocess, sys

def check(entry):
    words = shlex.split(entry["command"])
    del words[words.index("-o"):words.index("-o") + 2]
    done = subprocess.run(words + ["-fsyntax-only"], cwd=entry["directory"], capture_output=True, text=True)
    if done.returncode:
        print(done.stderr, file=sys.stderr)
    return done.returncode == 0

entries = json.load(open(sys.argv[1]))
jobs = int(os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", os.cpu_count()))
with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
    good = list(pool.map(check, entries))
print(f"{sum(good)} of {len(entries)} files compile by themselves")
sys.exit(len(entries) == 0 or not all(good))
EOF
