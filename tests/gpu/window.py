#!/usr/bin/env python3
"""window.py PROGRAM FILE..: examples/gpu/window.cpp in a window of a virtual screen (Xvfb, Mesa's llvmpipe), against what
the library's renderer makes of the same view. Exit code 1 if they differ; 77 where there is no xvfb-run or no window."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
from compare_inkscape import read_png

WIDTH, HEIGHT = 1000, 750


def pixels_of(path):
    return [list(zip(row[0::4], row[1::4], row[2::4])) for row in read_png(path)]


def compare(window, other):
    """Pixels of the surfaces; those that are lighter or darker than everything around in the other picture, by more than 24 of
    255; pixels that show the background where the other picture has none around."""
    ground, surface, different, cracked = other[0][0], 0, 0, 0
    assert (len(window), len(window[0])) == (len(other), len(other[0])) == (HEIGHT, WIDTH), "sizes differ"
    for y in range(1, HEIGHT - 1):
        for x in range(1, WIDTH - 1):
            if other[y][x] == ground and window[y][x] == ground:
                continue
            surface += 1
            if max(abs(a - b) for a, b in zip(window[y][x], other[y][x])) <= 24:
                continue
            for a, b in ((window, other), (other, window)):
                around = [b[y + j][x + i] for j in (-1, 0, 1) for i in (-1, 0, 1)]
                if any(not min(p[c] for p in around) - 24 <= a[y][x][c] <= max(p[c] for p in around) + 24 for c in range(3)):
                    different += 1
                    break
            cracked += window[y][x] == ground and all(other[y + j][x + i] != ground for j in (-1, 0, 1) for i in (-1, 0, 1))
    return surface, different, cracked


def main():
    program, files = sys.argv[1], sys.argv[2:]
    if not shutil.which("xvfb-run"):
        print("xvfb-run is not installed (apt-get install xvfb): the window is not tested")
        return 77
    # A window's libraries are unloaded with it, and what they then leave cannot be told by name from what is ours: with
    # sanitizers leaks are looked for in the tests that draw without a window.
    environment = os.environ | {"LIBGL_ALWAYS_SOFTWARE": "1",
                                "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"}
    bad = 0
    with tempfile.TemporaryDirectory(prefix="freiform-window-") as folder:
        for number, file in enumerate(files):
            name = os.path.join(folder, str(number))
            ran = subprocess.run(["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", program, file, "--picture", name],
                                 capture_output=True, text=True, timeout=200, env=environment)
            if ran.returncode != 0:
                print(f"{file}: {ran.stderr.strip()}")
                if "no window" in ran.stderr:
                    return 77
                return 1
            if "error" in ran.stderr.lower() or "warning" in ran.stderr.lower():
                print(ran.stderr)
                bad = 1
            surface, different, cracked = compare(pixels_of(name + "-window.png"), pixels_of(name + "-offscreen.png"))
            print(f"{os.path.basename(file)}: {surface} pixels of surfaces, {different} differ, {cracked} cracked")
            if surface < 20000 or different > surface // 2000 or cracked:
                bad = 1
            if os.environ.get("FREIFORM_PICTURES"):
                for which in ("-window.png", "-offscreen.png"):
                    shutil.copy(name + which, os.path.join(os.environ["FREIFORM_PICTURES"], os.path.basename(file) + which))
    return bad


if __name__ == "__main__":
    sys.exit(main())
