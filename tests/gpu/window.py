#!/usr/bin/env python3
"""window.py PROGRAM FILE..: examples/gpu/window.cpp in a window of a virtual screen (Xvfb, Mesa's llvmpipe), against what
the library's renderer makes of the same view. Exit code 1 if they differ; 77 where there is no xvfb-run or no window."""
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

WIDTH, HEIGHT = 1000, 750


def read_png(path):
    """Rows of RGB bytes; 8 bits, three or four channels, not interlaced."""
    data = open(path, "rb").read()
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            packed += body
        at += 12 + size
    step = {2: 3, 6: 4}[colour]
    assert bits == 8, path
    raw, before, rows = zlib.decompress(packed), bytearray(width * step), []
    for y in range(height):
        start = y * (width * step + 1)
        method, row = raw[start], bytearray(raw[start + 1 : start + 1 + width * step])
        for i in range(len(row) if method else 0):
            left, up, corner = (row[i - step] if i >= step else 0), before[i], (before[i - step] if i >= step else 0)
            if method == 4:
                guess = left + up - corner
                near = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
            row[i] = (row[i] + {1: left, 2: up, 3: (left + up) // 2, 4: near if method == 4 else 0}[method]) & 255
        rows.append([tuple(row[step * x : step * x + 3]) for x in range(width)])
        before = row
    return rows


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
    bad = 0
    with tempfile.TemporaryDirectory(prefix="freiform-window-") as folder:
        for number, file in enumerate(files):
            name = os.path.join(folder, str(number))
            ran = subprocess.run(["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", program, file, "--picture", name],
                                 capture_output=True, text=True, timeout=200, env=os.environ | {"LIBGL_ALWAYS_SOFTWARE": "1"})
            if ran.returncode != 0:
                print(f"{file}: {ran.stderr.strip()}")
                if "no window" in ran.stderr:
                    return 77
                return 1
            if "error" in ran.stderr.lower() or "warning" in ran.stderr.lower():
                print(ran.stderr)
                bad = 1
            surface, different, cracked = compare(read_png(name + "-window.png"), read_png(name + "-offscreen.png"))
            print(f"{os.path.basename(file)}: {surface} pixels of surfaces, {different} differ, {cracked} cracked")
            if surface < 20000 or different > surface // 2000 or cracked:
                bad = 1
            if os.environ.get("FREIFORM_PICTURES"):
                for which in ("-window.png", "-offscreen.png"):
                    shutil.copy(name + which, os.path.join(os.environ["FREIFORM_PICTURES"], os.path.basename(file) + which))
    return bad


if __name__ == "__main__":
    sys.exit(main())
