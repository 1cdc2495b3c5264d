"""What people hand over: lists, integers, views with strides, other byte orders are taken; what is none is refused with a
sentence that says what is needed. Answers about many objects; results into memory that is there."""
import decimal
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import freiform as ff

CURVE = ff.Curve([[0, 0], [1, 2], [3, 2], [4, 0]])
BALL = ff.sphere(1.0).surface
SOLID = ff.Model.prism(ff.Path("M 0 0 H 2 V 1 H 0 Z"), (0, 0, 3))
TEN = np.c_[np.arange(10), np.arange(10) ** 2 % 7]

SAME_POINTS = [TEN.tolist(), tuple(map(tuple, TEN.tolist())), TEN.astype(np.int8), TEN.astype(np.float32), TEN.astype(">f8"),
               TEN.astype(np.longdouble), TEN.astype(object), np.asfortranarray(TEN, dtype=float),
               np.repeat(TEN, 3, axis=0)[::3], TEN[::-1][::-1], [[decimal.Decimal(int(x)) for x in row] for row in TEN],
               np.ma.masked_array(TEN, False), TEN.view()]


@pytest.mark.parametrize("points", SAME_POINTS, ids=range(len(SAME_POINTS)))
def test_arrays_of_every_form_give_the_same_answers(points):
    exact = TEN.astype(float)
    assert ff.Curve(points, 3) == ff.Curve(exact, 3)
    assert ff.interpolate(points) == ff.interpolate(exact)
    assert ff.nearest(CURVE, points) == ff.nearest(CURVE, exact)
    t = [[x / 10 for x in row] for row in points] if isinstance(points, (list, tuple)) else points / 10
    assert np.allclose(CURVE([[float(x) / 7 for x in row] for row in t]), CURVE(exact / 70), atol=1e-12)
    assert np.array_equal(ff.hull_of_points(points), ff.hull_of_points(exact))


@pytest.mark.parametrize("make, says", [
    (lambda: ff.Curve("abc"), "not real numbers"),
    (lambda: ff.Curve([[0, 0], [1, 1, 1]]), "rows of different lengths"),
    (lambda: ff.Curve(np.exp(1j * TEN)), "complex128"),
    (lambda: ff.Curve(TEN, 3.0), "3.0 is no integer"),
    (lambda: ff.Curve(np.zeros((2, 2, 2))), "(n, D)"),
    (lambda: ff.Curve(np.zeros((3, 5))), "1 to 4 coordinates"),
    (lambda: ff.approximate((TEN[:, 0], TEN[:, 1]), 0.1), "transpose"),
    (lambda: ff.approximate(TEN[:, 0], 0.1), "numpy.c_"),
    (lambda: ff.interpolate(None), "None"),
    (lambda: ff.interpolate(np.ma.masked_array(TEN, TEN > 3)), "masked"),
    (lambda: CURVE(None), "None"),
    (lambda: CURVE(np.array(["2020-01-01"], "datetime64[D]")), "datetime64"),
    (lambda: BALL([0.1, 0.2], [0.1, 0.2, 0.3]), "cannot be broadcast"),
    (lambda: CURVE.restrict_to(0.5), "(lo, hi)"),
    (lambda: CURVE.restrict_to((0, 0.5, 1)), "(lo, hi)"),
    (lambda: ff.nearest(SOLID, [0, 0, 0]), "Model.nearest"),
    (lambda: ff.nearest([CURVE, "x"], [0, 0]), "objects[1]"),
    (lambda: ff.intersect(CURVE, "x"), "str"),
    (lambda: ff.loft([TEN, TEN]), "ndarray"),
    (lambda: ff.Document(["x"]), "objects[0]"),
    (lambda: ff.circle([0, 0, 0], 1), "circle_conic"),
    (lambda: ff.Mesh(np.eye(3), [[0, 1, 0.5]]), "no indices"),
    (lambda: ff.Mesh(np.eye(3), [[0, 1, 2**32 + 2]]), "no indices"),
    (lambda: ff.Mesh(np.eye(3), [[0, 1, 3]]), "vertex 3 of 3"),
    (lambda: ff.Path([[0, 0], [1, 1]]), "Path.of_curve"),
    (lambda: CURVE.evaluate([0.5], out=np.zeros((1, 2), np.float32)), "float64"),
    (lambda: CURVE.evaluate([0.5], out=np.zeros((1, 3))), "(1, 2)"),
    (lambda: CURVE.evaluate([0.5], out=np.zeros((1, 4))[:, ::2]), "C order"),
    (lambda: CURVE.evaluate([0.5], out=np.broadcast_to(np.zeros(2), (1, 2))), "read-only"),
    (lambda: ff.parse(b"anything"), "format"),
    (lambda: ff.parse(b"", "iges"), "read from files"),
    (lambda: ff.Curve(None), "points: holds None"),
    (lambda: ff.Curve([]), "points: have 1 axes"),
    (lambda: ff.Curve([[0, 0], [1, float("nan")]]), "points[1]: has a coordinate that is not finite"),
    (lambda: ff.Curve(TEN, "x"), "degree: 'x' is no integer"),
    (lambda: CURVE("x"), "parameters: holds"),
    (lambda: CURVE(float("nan")), "at[0]: nan is not a finite number"),
    (lambda: CURVE.derivative(-1), "order: -1 is negative"),
    (lambda: ff.interpolate(TEN, degree=-3), "degree: degree -3 is outside 1..25"),
    (lambda: ff.Path(None), "data: is no text"),
    (lambda: ff.Path("\u2603"), "character 1: found '\u2603', expected"),
    (lambda: ff.Path("M 0 0 L \u2603"), "character 9: found '\u2603', expected a number"),
    (lambda: ff.Motion.uniform(-1, 1), "length: a positive number is expected"),
    (lambda: ff.Motion.along(CURVE, 0, speed=1), "accuracy: a positive number is expected"),
    (lambda: ff.Motion.along(CURVE, 1e-6, speed=1, jerk=-2), "jerk: a positive number is expected"),
])
def test_what_cannot_be_taken_is_refused_in_words_that_help(make, says):
    with pytest.raises(ff.Refusal) as caught:
        make()
    assert isinstance(caught.value, ValueError) and says in str(caught.value)


def test_results_go_where_they_are_told():
    t = np.linspace(0, 1, 10_001)
    for patch, at in ((CURVE, (t,)), (BALL, (t * BALL.domain[0].hi, t * 0.5))):
        for order in (None, 0, 1, 3):
            expected = patch.evaluate(*at, order)
            out = np.full(expected.shape, np.nan)
            given = patch.evaluate(*at, order, out=out)
            assert np.shares_memory(given, out) and np.array_equal(out, expected)
    line = ff.Curve([[0.0], [1.0]])
    with pytest.raises(ff.InvalidError, match="shares memory"):
        line.evaluate(t, out=t.reshape(-1, 1))


MEMORY = """
import resource, sys
import numpy as np
import freiform as ff
t, u = np.linspace(0, 1, 1_000_000), np.linspace(0, 1, 1_000_000)
v = np.random.default_rng(1).uniform(0, 1, 1_000_000)
call = {"curve": lambda t, u, v, out: ff.Curve(np.eye(3)).evaluate(t, out=out),
        "surface": lambda t, u, v, out: ff.Surface(np.arange(27.0).reshape(3, 3, 3)).evaluate(u, v, out=out),
        "broadcast": lambda t, u, v, out: ff.Surface(np.arange(27.0).reshape(3, 3, 3)).evaluate(
            u[:1000, None], v[:1000], out=out.reshape(1000, 1000, 3))}[sys.argv[1]]
out = np.ones((1_000_000, 3))
call(t[:9000], u[:9000], v[:9000], out[:9000] if sys.argv[1] != "broadcast" else out)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
call(t, u, v, out)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""


@pytest.mark.skipif("asan" in os.environ.get("LD_PRELOAD", ""), reason="the sanitizer keeps memory that was given back")
@pytest.mark.parametrize("what", ["curve", "surface", "broadcast"])
def test_a_million_points_raise_the_memory_of_the_process_by_less_than_a_megabyte(what):
    """What tracemalloc does not see: the library's own memory."""
    done = subprocess.run([sys.executable, "-c", MEMORY, what], capture_output=True, text=True, check=True)
    assert int(done.stdout) < 1000  # kB


def test_a_question_about_many_objects():
    curves = [ff.Curve(TEN[i: i + 4]) for i in range(6)]
    assert ff.each(ff.Curve.length, curves, 1e-9) == [c.length(1e-9) for c in curves]
    assert ff.each(ff.Curve.flatten, curves, 0.1, segments=0) == [c.flatten(0.1) for c in curves]
    assert ff.each(ff.nearest, curves, TEN) == [ff.nearest(c, TEN) for c in curves]
    assert ff.each(ff.Surface.tessellate, [BALL, BALL], 0.1) == [BALL.tessellate(0.1)] * 2
    assert ff.each(ff.Curve.length, []) == []
    with pytest.raises(ff.OutOfDomainError) as caught:
        ff.each(ff.Curve.split, [curves[0], curves[1].restrict_to((0, 0.25)), curves[2].restrict_to((0, 0.25))], 0.5)
    assert caught.value.where.startswith("objects[1]: ")
    together = ff.nearest(curves, TEN)
    assert np.array_equal(together.distance, np.min([ff.nearest(c, TEN).distance for c in curves], axis=0))
    assert ff.evaluate_grids(curves, [0, 0.5, 1]).shape == (6, 3, 2)


def test_3dm_files_are_models():
    path = pathlib.Path(__file__).parents[1] / "data" / "3dm" / "solids_8.3dm"
    for document in (ff.read(path), ff.read(path, format="rhino"), ff.parse(path.read_bytes()), ff.parse(path.read_bytes(), "3dm")):
        (model,) = document
        assert isinstance(model, ff.Model) and model.unit == "cm" and len(model.faces) == 30


def test_files_are_read_from_memory():
    document = ff.Document([BALL], "mm")
    for format in ("json", "step", "obj"):
        data = document.to_bytes(format)
        for back in (ff.parse(data, format), ff.parse(data.decode(), format)):
            assert len(back) == 1
        assert format == "obj" or len(ff.parse(data)) == 1
    (triangle,) = ff.parse(b"3 1\n0 0 0 1 0 0 0 1 0", "bezierview")
    assert isinstance(triangle, ff.TriangularPatch)
    (model,) = ff.parse(document.to_bytes("step"), "step")
    assert isinstance(model, ff.Model) and model.unit == "mm"
    assert abs(model.nearest([[3, 0, 0]])[0].distance - 2) < 1e-9
