"""Every public object pickles, copies, compares, and has a repr; refusals are exceptions of their kind."""
import copy
import dataclasses
import pickle
import re

import numpy as np
import pytest

import freiform as ff

CURVE = ff.Curve([[0, 0], [1, 2], [3, 2], [4, 0.1]], 3)
ARC = ff.circle([0.1, 0.2], 1 / 3).curve
BALL = ff.sphere(2.0).surface
SQUARE = ff.Path("M 0 0 H 1 V 1 H 0 Z")
SURFACE = ff.Surface(np.random.default_rng(1).normal(size=(4, 5, 3)), (3, 2))

SOLID = ff.Model.prism(SQUARE, (0, 0, 1))

OBJECTS = [
    ff.Interval(0, 1), ff.Bounded(1, 0.5), ff.Colour(0, 0.5, 1),
    ff.Basis(2, [0, 0, 0, 1, 2, 2, 2]), ff.Basis.periodic(3, [0, 1, 2, 3, 4, 5]),
    ff.PolynomialBasis.monomial(3, 0.5), ff.PolynomialBasis.bernstein(2, (1, 3)), ff.PolynomialBasis.hermite(3),
    ff.PolynomialBasis.lagrange([0, 0.5, 1]), ff.PolynomialBasis.newton([0, 0.5, 1]),
    ff.PolynomialBasis.uniform_b_spline(3), ff.PolynomialBasis.b_spline(ff.Basis(2, [0, 0, 0, 1, 2, 2, 2]), 2),
    CURVE, ARC, ff.Curve([[0.0], [1.0]]), ff.Curve([[0, 0], [1, 0], [1, 1], [0, 1]], closed=True),
    CURVE.derivative(2), CURVE.arc_length(1e-9), CURVE.implicit(), CURVE.bounds(), CURVE.length(1e-9),
    SURFACE, BALL, ff.cylinder(1 / 3, (0, 1), form="closed").surface, ff.Volume(np.random.default_rng(2).normal(size=(2, 3, 2, 3))),
    ff.TriangularPatch([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), ff.sphere_in_eight(1.0).octants[0],
    SQUARE, SQUARE.area(), SQUARE.stroke(0.1, 1e-6), ff.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], "mm"),
    ff.TrimmedSurface(SURFACE, [[ff.Curve([[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.1, 0.1]], 1)]]),
    ff.Model.assemble([ff.Surface([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])], "mm"),
    ff.Document([CURVE, SURFACE], "mm", ["a", "b"]),
    ff.NearestQuery(CURVE), ff.nearest(CURVE, [[0, 1], [2, 2]]), ff.intersect(CURVE, ARC),
    ff.CubicBezierEasing(0.25, 0.1, 0.25, 1), ff.CubicBezierEasing("ease-in"), ff.Key(0, [1.0]),
    ff.Track([ff.Key(0, [0.0]), ff.Key(1, [2.0])]), ff.RotationTrack([0, 1], [(0, 0, 0, 1), (1, 0, 0, 0)]),
    ff.Motion.limited(3, 1, 2), ff.Motion.with_speed(ff.Curve([[1.0], [2.0]], knots=[0, 0, 3, 3]), 1e-6),
    ff.Motion.along(CURVE, 1e-6, speed=2, across=1),
    ff.Motion.along(CURVE, 1e-6, speed=2, across=1, jerk=3),
    ff.Trajectory(CURVE, ff.Motion.uniform(CURVE.length(1e-9).value, 2), 1e-6),
    ff.Gradient([(0, "#ff0000"), (1, "#0000ff")]),
    ff.MeshGradient(ff.Surface([[[0, 0], [0, 1]], [[1, 0], [1, 1]]]), ["#ff0000"] * 4),
    ff.Frame(), ff.frame_about([0, 0, 1], [1, 1, 0]), SOLID, SOLID.faces[0], SOLID.edges[0], ff.ModelNearestQuery(SOLID),
    SOLID.tessellate(0.1).mesh, SOLID.nearest([[0.5, 0.5, 3], [2, 2, 2]]),
]
try:
    OBJECTS.append(ff.Font("DejaVu Sans"))
except (ff.UnavailableError, ff.NoAnswerError):
    pass
try:
    OBJECTS.append(ff.SurfaceBuffers(SOLID, 0.01, [(ff.TriangularPatch([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), "#ff0000")]))
    OBJECTS += [ff.SurfaceRenderer(OBJECTS[-1]), ff.SurfaceEvaluator(BALL)]
except ff.UnavailableError:
    pass


# Every class of the package, and objects of those that are made of fields: an example of what each field may be.

CLASSES = [getattr(ff, name) for name in ff.__all__ if isinstance(getattr(ff, name), type)]


def example(kind):
    """A value of an annotation of a record."""
    kind = kind.removesuffix(" | None")
    if inner := re.fullmatch(r"list\[(.*)\]", kind):
        return [example(inner[1])] * 2
    if inner := re.fullmatch(r"tuple\[(.*), (\.\.\.|Any)\]", kind):
        return (example(inner[1]),) * 2
    plain = {"Array": np.arange(6).reshape(2, 3) / 7, "float": 1 / 3, "int": 5, "bool": True, "str": "a 'word'", "Any": 0.1,
             "AnyPatch": CURVE, "Refusal": ff.NoAnswerError("here", "nothing"), "Quaternion4": (0.0, 0.0, 0.6, 0.8)}
    if kind in plain:
        return plain[kind]
    made = next((x for x in OBJECTS if type(x).__name__ == kind), None)
    return made if made is not None else record(getattr(ff, kind))


def record(kind):
    return kind(*[example(f.type) for f in dataclasses.fields(kind)])


for _kind in CLASSES:
    if dataclasses.is_dataclass(_kind):
        OBJECTS.append(record(_kind))
    elif issubclass(_kind, ff.Refusal):
        OBJECTS.append(_kind("at[0]", "2 is outside"))
IDS = [f"{i}-{type(x).__name__}" for i, x in enumerate(OBJECTS)]


@pytest.mark.parametrize("x", OBJECTS, ids=IDS)
def test_an_object_pickles_copies_compares_and_has_a_hash(x):
    for y in (pickle.loads(pickle.dumps(x)), copy.copy(x), copy.deepcopy(x)):
        assert type(y) is type(x)
        assert y == x
        assert hash(y) == hash(x)
    assert x != 3 and x != "x"


@pytest.mark.parametrize("x", OBJECTS, ids=IDS)
def test_a_repr_can_be_evaluated(x):
    names = dict(vars(ff), array=np.array, inf=np.inf, nan=np.nan)
    assert eval(repr(x), names) == x


def test_what_is_large_is_printed_short_and_its_repr_can_be_evaluated(tmp_path):
    vase = ff.Model.assemble([ff.revolve(ff.Curve([[1.0, 0, 0], [2.0, 0, 1], [0.5, 0, 2], [1.0, 0, 3]])).surface, BALL], "mm")
    mesh = vase.tessellate(0.01).mesh
    assert len(vase.to_binary()) > 2000 and len(mesh) > 500
    for x in (vase, mesh):
        assert eval(repr(x), vars(ff)) == x and len(str(x)) < 60
    for text in ("", "x", repr(CURVE), ff.Mesh([[0, 0, 0]] * 3, [[0, 1, 2]]).to_bytes("stl").hex()):
        for kind in (ff.Model, ff.Mesh):
            with pytest.raises(ff.UnreadableError):
                kind.unpacked(text)


def test_a_font_says_where_it_is_from(tmp_path):
    try:
        font = ff.Font("DejaVu Sans")
    except (ff.UnavailableError, ff.NoAnswerError) as why:
        pytest.skip(str(why))
    data = font.__reduce__()[1][0]
    (tmp_path / "x.ttf").write_bytes(data)
    for made, says in ((font, "Font('DejaVu Sans', {})"), (ff.Font.read(tmp_path / "x.ttf"), "x.ttf"), (ff.Font.from_bytes(data), "b'")):
        for same in (made, pickle.loads(pickle.dumps(made))):
            assert says in repr(same) and eval(repr(same), vars(ff)) == made == same and str(same) == "<Font DejaVu Sans Book>"


def test_every_public_class_is_among_them():
    seen = {type(x) for x in OBJECTS}
    missing = {c.__name__ for c in CLASSES} - {c.__name__ for c in seen}
    # What records have in common; a font where there is one, and a card or what does its work.
    assert missing <= {"Record", "Font", "SurfaceBuffers", "SurfaceRenderer", "SurfaceEvaluator"}
    # Nor is there a class that could be met and has no name of its own.
    assert all(hasattr(ff, c.__name__) for c in ff.Record.__subclasses__() + ff.Refusal.__subclasses__())


@pytest.mark.parametrize("x", [x for x in OBJECTS if dataclasses.is_dataclass(x)], ids=lambda x: type(x).__name__)
def test_records_that_differ_in_a_field_are_not_equal_and_cannot_be_changed(x):
    for field in dataclasses.fields(x):
        assert dataclasses.replace(x, **{field.name: "something else"}) != x
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(x, field.name, 0)


def test_different_objects_are_not_equal():
    for i, x in enumerate(OBJECTS):
        for y in OBJECTS[i + 1:]:
            assert not (type(x) is type(y) and repr(x) != repr(y) and x == y)


def test_a_bit_of_a_coefficient_makes_a_difference():
    p = CURVE.points.copy()
    p[2, 1] = np.nextafter(p[2, 1], 9)
    assert ff.Curve(p, 3) != CURVE


@pytest.mark.parametrize("make, kind, where", [
    (lambda: CURVE(2.0), ff.OutOfDomainError, "at[0]"),
    (lambda: CURVE([0.5, np.nan]), ff.NonFiniteError, "at[1]"),
    (lambda: ff.Curve([[0, 0], [1, np.inf]]), ff.NonFiniteError, ""),
    (lambda: ff.Curve([[0, 0], [1, 1], [2, 0]], 2, [0, 0, 0, 1, 0.5, 1]), ff.InvalidError, "knots"),
    (lambda: ff.Curve([[0, 0], [1, 1]], weights=[1, 0]), ff.InvalidError, "weights"),
    (lambda: ff.Curve([[0, 0], [1, 1]], weights=[1, 1, 1]), ff.InvalidError, "weights"),
    (lambda: ff.Curve([1.0, 2.0]), ff.InvalidError, "points"),
    (lambda: CURVE.insert_knot(7), ff.Refusal, ""),
    (lambda: CURVE.insert_knot(0.5, axis=3), ff.InvalidError, "axis"),
    (lambda: CURVE.flatten(-1), ff.InvalidError, ""),
    (lambda: CURVE.flatten(0.1, method="adaptve"), ff.InvalidError, "method"),
    (lambda: ARC.hodograph(), ff.UnsupportedError, ""),
    (lambda: ff.read("/no/such/file.json"), ff.IoError, "/no/such/file.json"),
    (lambda: ff.parse("{", "json"), ff.UnreadableError, ""),
    (lambda: ff.draw(CURVE, wdith=3), ff.InvalidError, "wdith"),
    (lambda: ff.draw(CURVE, width="x"), ff.InvalidError, "width"),
])
def test_what_is_refused_says_kind_place_and_why(make, kind, where):
    with pytest.raises(kind) as caught:
        make()
    error = caught.value
    assert isinstance(error, ff.Refusal) and error.kind and error.message
    assert error.where.startswith(where) or where in error.where
    assert error.message in str(error)


def test_bad_arguments_are_value_errors():
    for kind in (ff.InvalidError, ff.NonFiniteError, ff.OutOfDomainError, ff.UnreadableError, ff.UnsupportedError):
        assert issubclass(kind, ValueError)
    assert issubclass(ff.IoError, OSError) and issubclass(ff.IllConditionedError, ArithmeticError)


def test_every_function_and_class_is_documented():
    for name in ff.__all__:
        x = getattr(ff, name)
        if callable(x) and name not in ("Array", "ArrayLike", "AnyPatch", "Shape", "ColourLike"):
            assert x.__doc__, name
    assert "GUARANTEE" not in ff.revolve.__doc__ and "Profiles may be polynomial or rational" in ff.revolve.__doc__
