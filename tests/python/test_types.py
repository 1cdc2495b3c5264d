"""The package, and what a user writes with it, pass mypy --strict."""
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

from conftest import ROOT

import freiform as ff

PACKAGE = pathlib.Path(ff.__file__).parent
USER = """
import numpy as np
import freiform as ff

curve = ff.Curve([[0, 0], [1, 2], [3, 2], [4, 0]])
points: np.ndarray[object, np.dtype[np.float64]] = curve(np.linspace(0, 1, 5))
length: float = curve.length(1e-9).value
ball: ff.Surface = ff.sphere(2.0).surface
try:
    curve(7.0)
except ff.OutOfDomainError as refusal:
    print(refusal.kind, refusal.where)
bound: float = ff.loft([curve, curve.reverse()]).bound
"""


def mypy(*arguments):
    if shutil.which("mypy") is None:
        pytest.skip("mypy is not installed")
    done = subprocess.run(["mypy", "--strict", "--cache-dir=/dev/null", *arguments], capture_output=True, text=True,
                          cwd=PACKAGE.parent)
    return done.returncode, done.stdout


def test_the_package_is_strictly_typed():
    code, report = mypy("freiform")
    assert code == 0, report


def test_a_users_program_is_checked_and_mistakes_are_found(tmp_path):
    (tmp_path / "good.py").write_text(USER)
    (tmp_path / "bad.py").write_text("import freiform as ff\nx: str = ff.Curve([[0, 0], [1, 1]]).degree\n")
    code, report = mypy(str(tmp_path / "good.py"))
    assert code == 0, report
    code, report = mypy(str(tmp_path / "bad.py"))
    assert code == 1 and "Incompatible types" in report
    assert sys.version_info >= (3, 9)


@pytest.mark.parametrize("page", ["python", "coming-from"])
def test_the_examples_of_a_page_are_strictly_typed(page, tmp_path):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / f"{page}.md").read_text(), re.S)
    assert len(blocks) >= 3
    (tmp_path / "page.py").write_text("import numpy as np\nimport freiform as ff\n" + "\n".join(blocks))
    code, report = mypy(str(tmp_path / "page.py"))
    assert code == 0, report
