"""Drawings of ours beside what Inkscape makes of the same: tools/compare_inkscape.py on a few of them."""
import pathlib
import shutil
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = next((p for p in (ROOT / "build-dev/bin/freiform", ROOT / "build/bin/freiform") if p.exists()), None)
CURVED = """<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100" viewBox="0 0 100 100">
<g fill="none" stroke="black" stroke-width="6"><path stroke-linejoin="round" stroke-linecap="round"
d="M10 40 A 20 20 0 0 1 50 40 Q 60 10 90 30"/><path stroke-linejoin="bevel" stroke-dasharray="12 7"
d="M10 60 C 40 40 60 90 90 60 L 60 95 Z"/></g></svg>"""


@pytest.mark.skipif(shutil.which("inkscape") is None, reason="Inkscape is not installed (apt-get install inkscape)")
@pytest.mark.skipif(PROGRAM is None, reason="the program is not built (build-dev/bin/freiform, build/bin/freiform)")
def test_strokes_unions_operations_offsets_and_text_look_as_in_inkscape(tmp_path):
    drawing = tmp_path / "curved.svg"
    drawing.write_text(CURVED)
    done = subprocess.run(
        [sys.executable, ROOT / "tools/compare_inkscape.py", "--freiform", PROGRAM, "--out", tmp_path / "out", "--pairs", "2",
         drawing, ROOT / "examples/badge.svg"], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    kinds = {line.split()[1] for line in done.stdout.splitlines() if line.startswith("| ") and "%" in line}
    assert kinds == {"written", "stroke", "union", "intersection", "difference", "exclusion", "offset", "text"}
