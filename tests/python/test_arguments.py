"""Wrong arguments: an error of the right class that names the argument and what was expected."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import freiform as ff

CURVE = ff.Curve([[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]], degree=2)
SURFACE = ff.Surface(np.zeros((3, 3, 3)) + np.arange(3.0)[:, None, None], degrees=(2, 2))

WRONG: list[tuple[Callable[[], object], type[Exception], str]] = [
    (lambda: ff.Curve("abc"), ValueError, "points: holds"),  # type: ignore[arg-type]
    (lambda: ff.Curve(None), ValueError, "points: holds None"),  # type: ignore[arg-type]
    (lambda: ff.Curve([]), ValueError, "points: have 1 axes"),
    (lambda: ff.Curve([[0.0, 0.0], [1.0, float("nan")]]), ValueError, r"points\[1\]: has a coordinate"),
    (lambda: ff.Curve([[0.0, 0.0], [1.0, 1.0]], degree="x"), ValueError, "degree: 'x' is no integer"),  # type: ignore[arg-type]
    (lambda: ff.Curve([[0.0, 0.0], [1.0, 1.0]], degree=-1), ValueError, "degree"),
    (lambda: ff.Curve([[0.0, 0.0], [1.0, 1.0]], degree=5), ValueError, "degree|points"),
    (lambda: ff.Curve(np.zeros((3, 2), dtype=complex)), ValueError, "points: holds complex"),
    (lambda: CURVE("x"), ValueError, "parameters: holds"),  # type: ignore[operator]
    (lambda: CURVE(None), ValueError, "parameters: holds None"),  # type: ignore[operator]
    (lambda: CURVE(float("nan")), ValueError, r"at\[0\]: nan is not a finite number"),
    (lambda: CURVE.derivative(-1), ValueError, "order: -1 is negative"),
    (lambda: SURFACE("u", 0.5), ValueError, "holds"),  # type: ignore[arg-type]
    (lambda: ff.Path("\u2603"), ValueError, "character 1: found '\u2603'"),
    (lambda: ff.Path("M 0 0 L \u2603"), ValueError, "character 9: found '\u2603', expected a number"),
    (lambda: ff.Path(3), ValueError, "data: is no text"),  # type: ignore[arg-type]
    (lambda: ff.Path(None), ValueError, "data: is no text"),  # type: ignore[arg-type]
    (lambda: ff.read("\u2603.stp"), OSError, "\u2603.stp: cannot be read"),
    (lambda: ff.read(None), TypeError, "expected str"),  # type: ignore[arg-type]
    (lambda: ff.interpolate([[0.0, 0.0], [1.0, 1.0]], degree=-3), ValueError, "degree: degree -3 is outside 1..25"),
    (lambda: ff.interpolate(np.array(["a", "b"])), ValueError, "points: holds"),
    (lambda: ff.Motion.uniform(-1.0, 1.0), ValueError, "length: a positive number is expected"),
    (lambda: ff.Motion.along(CURVE, 0.0, speed=1.0), ValueError, "accuracy: a positive number is expected"),
    (lambda: ff.Motion.along(CURVE, 1e-6, speed=1.0, jerk=-2.0), ValueError, "jerk: a positive number is expected"),
]


@pytest.mark.parametrize("index", range(len(WRONG)))
def test_wrong_arguments_are_named(index: int) -> None:
    call, kind, message = WRONG[index]
    with pytest.raises(kind, match=message) as caught:
        call()
    str(caught.value).encode("utf-8")
