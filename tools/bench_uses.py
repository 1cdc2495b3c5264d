#!/usr/bin/env python3
"""tools/bench_uses.py [--programs DIR] [--print] [FONT ..]: what letters and Boolean operations take.

Runs bench-uses and writes bench/USES.md; with --print only prints it. Times are those of the processor.
"""
import argparse
import pathlib

from bench_shared import duration, head, keep_shortest, parse, run, write

ROUNDS = 2
FONTS = ["/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/truetype/noto/NotoSansMono-Regular.ttf"]
STEPS = {"read": "read from the font", "flattened": "flattened", "united": "united (one outline, winding number 1)", "stroked": "stroked"}
KINDS = {"random_polygons": "random polygons", "random_curves": "random lines, parabolas, conics and cubics", "nasty": "nasty pairs"}

PAGE = """# Letters and Boolean operations

{head}

One thread; times of the processor, of each task the shortest mean of {rounds} processes.

## All glyphs of two fonts

Every glyph is read, its curves are flattened and its contours united within a thousandth of an em, and stroked by a pen of a twentieth of an em.
Glyphs without an outline count as read and are left out after that.

| font | step | glyphs | refused | time per glyph | longest |
|---|---|---:|---:|---:|---:|
{glyphs}

## Boolean operations

Union, intersection, difference and exclusion of 1,000 random pairs that cross themselves and each other, and of the nasty pairs of
`tests/support/nasty_regions.hpp` by both fill rules: common edges and arcs, tangent circles, cusps, slivers, nests, huge coordinates. Tolerance 1e-9
(of the huge ones 1). Wrong: one of |A or B| = |A| + |B| - |A and B|, |A - B| = |A| - |A and B|, |A xor B| = |A or B| - |A and B| fails by more than
1e-9 of |A| + |B| and what the bounds of the outlines leave open. Off by: the largest failure, of |A| + |B|, where the two cover more than a
millionth of their box. Time: of all four operations.

| pairs | number | right | wrong | refused | off by | time per pair | longest |
|---|---:|---:|---:|---:|---:|---:|---:|
{pairs}
"""


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("fonts", nargs="*", default=FONTS)
    options = parse(arguments, "bench-uses")
    top = head("bench_uses.py")
    found = {}
    fonts = [f for f in options.fonts if pathlib.Path(f).is_file()]
    for _ in range(ROUNDS):
        keep_shortest(found, run([options.programs / "bench-uses", *fonts]))
    glyphs, pairs = [], []
    for task, n in found.items():
        if n is None:
            continue
        if task.startswith("glyphs:"):
            _, font, step = task.split(":")
            glyphs.append(f"| {font} | {STEPS[step]} | {n['count']:.0f} | {n['refused']:.0f} | {duration(n['seconds'])} | "
                          f"{duration(n['longest'])} (glyph {n['at']:.0f}) |")
        else:
            kind = KINDS[task.split(":")[1]]
            pairs.append(f"| {kind} | {n['count']:.0f} | {n['right']:.0f} | {n['wrong']:.0f} | {n['refused']:.0f} | {n['off']:.1g} | "
                         f"{duration(n['seconds'])} | {duration(n['longest'])} |")
    write(options, "USES.md", PAGE.format(head=top, rounds=ROUNDS, glyphs="\n".join(glyphs), pairs="\n".join(pairs)))


if __name__ == "__main__":
    main()
