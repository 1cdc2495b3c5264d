#!/usr/bin/env python3
"""tools/compare_inkscape.py [--freiform PROGRAM] [--out FOLDER] [--pairs N] [--text WORDS] [--font FAMILY] [DRAWING.svg ...]

Pictures of drawings by Inkscape beside pictures of what freiform made of them, also by Inkscape:
  written   the drawing read and written again
  stroke    its strokes as filled outlines (freiform path stroke): the pen of Inkscape against ours
  union     all of its shapes as one (freiform path union), against the shapes in one colour
and of random pairs of shapes the Boolean operations against Inkscape's own, and offsets against its round pen; a line of text
as outlines against the text that Inkscape sets.

A row says which share of the pixels differs by more than a quarter of the range in some channel (`wrong`) and
the mean difference (`mean`, of 255), which is above 0 along edges, where pixels are covered in part. Without
drawings those of ../shared/data/svg and examples/ are taken. The pictures lie in FOLDER, two beside each other
where they differ. Where a picture lies beside a drawing (X.png beside X.svg) what was written is compared with it,
too: Inkscape does not know all of SVG 2. Where Inkscape is not installed this is said and nothing is compared; exit
code 1 where pictures differ that should not (those of drawings of which something was left out may).
"""
import argparse
import math
import os
import pathlib
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
WIDTH = 300
MOST_WRONG = 0.004  # share of pixels


def read_png(path):
    """Rows of premultiplied RGBA bytes of a PNG that is not interlaced and has at most 8 bits."""
    data = pathlib.Path(path).read_bytes()
    at, packed, palette, clear = 8, b"", b"", b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            packed += body
        elif kind == b"PLTE":
            palette = body
        elif kind == b"tRNS":
            clear = body
        at += 12 + size
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour]
    assert bits <= 8, path
    raw, stride, step = zlib.decompress(packed), (width * channels * bits + 7) // 8, max(1, channels * bits // 8)
    before, out = bytearray(stride), []
    for y in range(height):
        method, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for i in range(stride if method else 0):
            left, up = row[i - step] if i >= step else 0, before[i]
            if method == 1:
                guess = left
            elif method == 2:
                guess = up
            elif method == 3:
                guess = (left + up) // 2
            else:
                corner = before[i - step] if i >= step else 0
                guess = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
            row[i] = (row[i] + guess) & 255
        before = row
        if bits < 8:
            ones = (1 << bits) - 1
            row = bytes(row[i * bits // 8] >> (8 - bits - i * bits % 8) & ones for i in range(width))
        line = bytearray()
        for i in range(0, width * channels, channels):
            if colour == 3:
                k = row[i]
                pixel = *palette[3 * k : 3 * k + 3], clear[k] if k < len(clear) else 255
            elif channels <= 2:
                grey = row[i] * 255 // ((1 << bits) - 1)
                pixel = grey, grey, grey, row[i + 1] if channels == 2 else 255
            else:
                pixel = *row[i : i + 3], row[i + 3] if channels == 4 else 255
            line += bytes((*(c * pixel[3] // 255 for c in pixel[:3]), pixel[3]))
        out.append(line)
    return out


def write_png(path, rows):
    """Premultiplied RGBA on white."""
    lines = b""
    for row in rows:
        line = bytearray()
        for i in range(0, len(row), 4):
            line += bytes(min(255, row[i + k] + 255 - row[i + 3]) for k in range(3))
        lines += b"\0" + bytes(line)

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    head = struct.pack(">IIBBBBB", len(rows[0]) // 4, len(rows), 8, 2, 0, 0, 0)
    png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b"")
    pathlib.Path(path).write_bytes(png)


def differences(a, b):
    """(share of pixels that are wrong, mean difference); pictures of different sizes are all wrong."""
    if len(a) != len(b) or len(a[0]) != len(b[0]):
        return 1.0, 255.0
    wrong = total = 0
    for p, q in zip(a, b):
        if p == q:
            continue
        for i in range(0, len(p), 4):
            apart = [abs(p[i + k] - q[i + k]) for k in range(4)]
            wrong += max(apart) > 64
            total += sum(apart)
    pixels = len(a) * len(a[0]) // 4
    return wrong / pixels, total / (4 * pixels)


class Comparison:
    def __init__(self, freiform, out):
        self.freiform, self.out = freiform, out
        self.actions, self.rows = [], []  # of Inkscape; (kind, name, first, second, remark, reference)

    def render(self, svg, picture, actions=""):
        self.actions.append(
            f"file-open:{svg}; {actions}export-filename:{picture}; export-width:{WIDTH}; export-do; file-close"
        )

    def run(self, *words):
        """True, or what the program said."""
        done = subprocess.run([self.freiform, *map(str, words)], capture_output=True, text=True, timeout=300)
        return True if done.returncode == 0 else done.stderr.strip().splitlines()[-1]

    def on_page_of(self, drawing, other):
        """The page may have grown with what is drawn: the pictures are of the same one."""
        page = re.search(r"<svg[^>]*>", other.read_text())[0]
        drawing.write_text(re.sub(r"<svg[^>]*>", page, drawing.read_text(), count=1))

    def beside(self, kind, name, first, second, remark="", actions="", reference=None):
        """Pictures of two drawings, to be compared."""
        stem = self.out / f"{kind}-{name}"
        pictures = [f"{stem}-inkscape.png", f"{stem}-freiform.png"]
        self.render(first, pictures[0], actions)
        self.render(second, pictures[1])
        self.rows.append((kind, name, *pictures, remark, reference))

    def refused(self, kind, name, why):
        self.rows.append((kind, name, None, None, why, None))

    def drawing(self, path):
        name = path.stem.replace("=", "-")
        left_out = subprocess.run([self.freiform, "info", path], capture_output=True, text=True).stderr.strip()
        remark = left_out.splitlines()[0].split(": ", 2)[-1] if left_out else ""
        source = path.read_text(errors="replace")
        if not remark and re.search(r"opacity|url\(|gradient|marker|<text|<image|paint-order", source, re.I):
            remark = "paints that are not geometry"
        if not remark and re.search(r"\d(Q|rem|ic|ch|v[wh]|vmin|vmax)[\s\"]", source):
            remark = "units of SVG 2"
        reference = path.with_suffix(".png") if path.with_suffix(".png").exists() else None
        written = self.out / f"{name}-written.svg"
        done = self.run("convert", path, "-o", written)
        if done is not True:
            return self.refused("written", name, done)
        self.beside("written", name, path, written, remark, reference=reference)
        text = written.read_text()
        if 'stroke="' in text:
            outlines = self.out / f"{name}-stroke.svg"
            done = self.run("path", "stroke", path, "-o", outlines)
            if done is True:
                self.on_page_of(outlines, written)
                self.beside("stroke", name, written, outlines, reference=reference)
            else:
                self.refused("stroke", name, done)
        one = self.out / f"{name}-union.svg"
        done = self.run("path", "union", written, "-o", one)
        if done is not True:
            return self.refused("union", name, done)
        black = self.out / f"{name}-black.svg"
        plain = r' (fill|stroke|stroke-[a-z]+)="[^"]*"'
        black.write_text(re.sub(plain, "", text))
        one.write_text(re.sub(plain, "", one.read_text()))
        self.on_page_of(one, black)
        self.beside("union", name, black, one)

    def pair(self, number, source):
        shapes = [random_shape(source) for _ in range(2)]
        page = '<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100" viewBox="0 0 100 100">'
        two = self.out / f"pair-{number}.svg"
        paths = "".join(f'<path id="p{i}" fill="black" d="{d}"/>' for i, d in enumerate(shapes))
        two.write_text(f"{page}{paths}</svg>")
        for operation in ("union", "intersection", "difference", "exclusion"):
            ours = self.out / f"pair-{number}-{operation}.svg"
            done = self.run("path", operation, two, "-o", ours)
            if done is not True:
                self.refused(operation, f"pair-{number}", done)
                continue
            self.on_page_of(ours, two)
            self.beside(operation, f"pair-{number}", two, ours, actions=f"select-all; path-{operation}; ")
        grown, pen = self.out / f"pair-{number}-offset.svg", self.out / f"pair-{number}-pen.svg"
        pen.write_text(
            f'{page}<path d="{shapes[0]}" stroke="black" stroke-width="6" stroke-linejoin="round"/></svg>'
        )
        one = self.out / f"pair-{number}-one.svg"
        one.write_text(f'{page}<path d="{shapes[0]}"/></svg>')
        done = self.run("path", "offset", one, "--distance", "3", "-o", grown)
        if done is True:
            self.on_page_of(grown, pen)
            self.beside("offset", f"pair-{number}", pen, grown)
        else:
            self.refused("offset", f"pair-{number}", done)

    def text(self, words, font):
        name = f"{words}-{font}".replace(" ", "-")
        ours, theirs = self.out / f"text-{name}.svg", self.out / f"text-{name}-set.svg"
        done = self.run("text", words, "--font", font, "-o", ours)
        if done is not True:
            return self.refused("text", name, done)
        page = re.search(r"<svg[^>]*>", ours.read_text())[0]
        theirs.write_text(f'{page}<text x="0" y="0" font-family="{font}" font-size="72px">{words}</text></svg>')
        self.beside("text", name, theirs, ours)

    def compare(self):
        """The number of pairs of pictures that differ and should not."""
        subprocess.run(["inkscape", "--shell"], input="\n".join(self.actions) + "\n", capture_output=True, text=True,
                       timeout=1800)
        bad, sums = 0, {}
        for kind, name, first, second, remark, reference in self.rows:
            all_of = sums.setdefault(kind, [0, 0, 0, 0.0, 0.0, 0])
            all_of[0] += 1
            if first is None:
                all_of[2] += 1
                print(f"{kind:13}{name:60} refused: {remark}")
                continue
            if not os.path.exists(first) or not os.path.exists(second):
                print(f"{kind:13}{name:60} Inkscape made no picture")
                bad += 1
                continue
            a, b = read_png(first), read_png(second)
            wrong, mean = differences(a, b)
            known, as_known = "", False
            if wrong > MOST_WRONG and reference:
                other = read_png(reference)
                theirs, ours = differences(a, other)[0], differences(b, other)[0]
                known = f"the picture beside it: Inkscape's differs by {theirs:.4f}, ours by {ours:.4f}  "
                as_known = ours <= MOST_WRONG
            if wrong > MOST_WRONG:
                print(f"{kind:13}{name:60} wrong {wrong:.4f} mean {mean:6.2f}  {known}{remark}")
                if len(a) == len(b):
                    write_png(f"{first[:-12]}both.png", [p + q for p, q in zip(a, b)])
                all_of[5] += as_known
                bad += not remark and not as_known
            else:
                all_of[1] += 1
                all_of[3], all_of[4] = max(all_of[3], wrong), max(all_of[4], mean)
        print("\n| | pictures | the same | as the picture beside it | refused | wrong, at most | mean of 255, at most |")
        print("|---|--:|--:|--:|--:|--:|--:|")
        for kind, (count, same, refused, wrong, mean, known) in sums.items():
            print(f"| {kind} | {count} | {same} | {known} | {refused} | {100 * wrong:.2f} % | {mean:.2f} |")
        return bad


def random_shape(source):
    """A star, a blob of cubics, or arcs, closed, within the page of 100."""
    x, y = source.uniform(35, 65), source.uniform(35, 65)
    n, kind = source.randint(3, 8), source.randint(0, 2)
    at = []
    for i in range(3 * n):
        radius, angle = source.uniform(12, 30), 2 * math.pi * i / (3 * n)
        at.append(f"{x + radius * math.cos(angle):.3f} {y + radius * math.sin(angle):.3f}")
    if kind == 0:
        return "M " + " L ".join(at) + " Z"
    if kind == 1:
        return f"M {at[0]} " + " ".join(f"C {at[3 * i + 1]} {at[3 * i + 2]} {at[(3 * i + 3) % (3 * n)]}"
                                        for i in range(n)) + " Z"
    return f"M {at[0]} " + " ".join(f"A {source.uniform(8, 20):.3f} 9 {10 * i} 0 {i % 2} {at[(3 * i + 3) % (3 * n)]}"
                                    for i in range(n)) + " Z"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--freiform", default=str(ROOT / "build/bin/freiform"))
    parser.add_argument("--out")
    parser.add_argument("--pairs", type=int, default=20)
    parser.add_argument("--text", default="Wavy Tiger, 0.5")
    parser.add_argument("--font", default="DejaVu Sans")
    parser.add_argument("drawings", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    if shutil.which("inkscape") is None:
        print("Inkscape is not installed (apt-get install inkscape): nothing is compared")
        return 0
    folder = pathlib.Path(options.out or tempfile.mkdtemp(prefix="freiform-inkscape-")).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    drawings = options.drawings or sorted((ROOT / "../shared/data/svg").glob("*.svg")) + [ROOT / "examples/badge.svg"]
    comparison = Comparison(options.freiform, folder)
    for path in drawings:
        comparison.drawing(path.resolve())
    source = random.Random(8)
    for number in range(options.pairs):
        comparison.pair(number, source)
    if options.text:
        comparison.text(options.text, options.font)
    bad = comparison.compare()
    print(f"\npictures in {folder}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
