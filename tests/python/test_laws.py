"""Laws that the C++ tests check too, here through Python on random curves and surfaces."""
import re

import numpy as np
import pytest
from conftest import ROOT
from hypothesis import assume, given, strategies as st

import freiform as ff

# Each law, and the C++ tests of the same.
SHARED = {
    "insertion_elevation_and_reversal_do_not_change_the_map": [
        "InsertKnots, leaves_the_function_unchanged", "Elevate, leaves_the_function_unchanged_and_raises_every_multiplicity",
        "Reverse, runs_through_the_function_backwards"],
    "parts_are_the_whole": ["Splitting, of_splines_stays_within_its_bound_too"],
    "removal_undoes_insertion_within_its_bound": ["RemoveKnots, undoes_insertion"],
    "a_curve_is_in_its_box": ["TightBox, contains_curves_and_touches_them"],
    "lengths_add_up_and_are_not_shorter_than_chords": ["Length, adds_up_reverses_scales_and_ignores_the_parametrisation"],
    "no_sample_is_nearer_than_the_lower_bound": ["NearestRandom, nothing_is_nearer_than_the_bound_or_the_answer",
                                                 "NearestExtent, farthest_and_within_agree_with_samples_of_curves"],
    "flattening_stays_within_its_bound": ["Flatten, stays_within_its_bound_and_the_bound_within_the_tolerance"],
    "intersection_is_symmetric": ["IntersectLaws, exchanging_the_curves_exchanges_the_answer"],
    "scaling_by_a_power_of_two_scales_every_answer_exactly": [
        "TightBox, scales_exactly_with_powers_of_two",
        "Nearest, scaling_by_powers_of_two_scales_the_answer_and_changes_nothing_else"],
    "documents_bring_back_the_same_curve": ["Document, gives_rational_points_back_as_they_were_given"],
}


def test_the_laws_are_those_of_the_tests_in_cpp():
    tests = "\n".join(p.read_text() for p in (ROOT / "tests").rglob("*_test.cpp"))
    known = set(re.findall(r"^TEST\((\w+,\s+\w+)\)", tests, re.M))
    for law, same in SHARED.items():
        assert f"test_{law}" in globals(), law
        assert {re.sub(r"\s+", " ", s) for s in same} <= {re.sub(r"\s+", " ", k) for k in known}, same


numbers = st.floats(-8, 8, allow_nan=False).map(lambda x: round(x * 64) / 64)


@st.composite
def curves(draw, dimensions=(2, 3), rational=None):
    degree, dimension = draw(st.integers(1, 5)), draw(st.sampled_from(dimensions))
    size = degree + 1 + draw(st.integers(0, 5))
    points = [[draw(numbers) for _ in range(dimension)] for _ in range(size)]
    inner = sorted(draw(st.lists(st.integers(1, 15), min_size=size - degree - 1, max_size=size - degree - 1, unique=True)))
    knots = [0.0] * (degree + 1) + [k / 16 for k in inner] + [1.0] * (degree + 1)
    weighted = draw(st.booleans()) if rational is None else rational
    weights = [draw(st.integers(1, 8)) / 4 for _ in range(size)] if weighted else None
    return ff.Curve(points, degree, knots, weights)


T = np.linspace(0, 1, 33)


def near(a, b, scale=64.0):
    return np.abs(np.asarray(a) - np.asarray(b)).max(initial=0) <= 1e-11 * scale


@given(curves(), st.lists(st.integers(1, 63), min_size=1, max_size=3, unique=True))
def test_insertion_elevation_and_reversal_do_not_change_the_map(c, more):
    finer = c.insert_knots(sorted(m / 64 for m in more))
    assert near(finer(T), c(T))
    assert sorted(finer.knots) == sorted([*c.knots, *(m / 64 for m in more)])
    once = c.insert_knot(more[0] / 64)
    assert near(once(T), c(T)) and len(once.points) == len(c.points) + 1
    assert near(c.elevate(2)(T), c(T)) and c.elevate(2).degree == c.degree + 2
    assert near(c.reverse()(T[::-1]), c(T))


@given(curves(), st.integers(1, 63))
def test_parts_are_the_whole(c, at):
    low, high = c.split(at / 64)
    assert low.domain == (0, at / 64) and high.domain == (at / 64, 1)
    t = np.linspace(0, at / 64, 9)
    assert near(low(t), c(t))
    for piece in c.decompose():
        t = np.linspace(*piece.domain, 5)
        assert near(piece(t[1:-1]), c(t[1:-1]))


@given(curves(rational=False), st.integers(1, 63))
def test_removal_undoes_insertion_within_its_bound(c, at):
    assume(not np.any(c.knots == at / 64))
    fewer = c.insert_knot(at / 64).remove_knots(1e-9)
    assert fewer.bound <= 1e-9 and near(fewer.patch(T), c(T), 1e3)


@given(curves())
def test_a_curve_is_in_its_box(c):
    box = c.bounds()
    p = c(T)
    assert (p >= box.box.lo).all() and (p <= box.box.hi).all()
    assert (box.box.hi - p.max(axis=0) >= 0).all()


@given(curves())
def test_lengths_add_up_and_are_not_shorter_than_chords(c):
    s = c.arc_length(1e-9)
    total = s.total
    chords = np.linalg.norm(np.diff(c(np.linspace(0, 1, 200)), axis=0), axis=1).sum()
    assert chords <= total.value + total.bound + 1e-9
    first, second = s.between((0, 0.375)), s.between((0.375, 1))
    assert abs(first.value + second.value - total.value) <= first.bound + second.bound + total.bound + 1e-12
    assume(total.value > 1e-3)
    t, bound = s.parameter(total.value / 3)
    assert abs(s(t) - total.value / 3) <= bound + total.bound + 1e-9


@given(curves(), st.tuples(numbers, numbers, numbers))
def test_no_sample_is_nearer_than_the_lower_bound(c, q):
    point = np.array(q[: c.dimension])
    found = ff.nearest(c, point)
    least = np.linalg.norm(c(np.linspace(0, 1, 500)) - point, axis=1).min()
    assert found.lower_bound <= least and found.distance <= least + found.point_error + 1e-12
    assert abs(np.linalg.norm(c(found.at[0]) - point) - found.distance) < 1e-9
    far = ff.farthest(c, point)
    assert far.upper_bound >= np.linalg.norm(c(np.linspace(0, 1, 500)) - point, axis=1).max()


@given(curves())
def test_flattening_stays_within_its_bound(c):
    line = c.flatten(0.05)
    assert line.bound <= 0.05
    for t in np.linspace(0, 1, 40):
        i = int(np.clip(np.searchsorted(line.parameters, t) - 1, 0, len(line.parameters) - 2))
        a, b, p = line.points[i], line.points[i + 1], c(t)
        d = b - a
        s = np.clip(np.dot(p - a, d) / (np.dot(d, d) or 1), 0, 1)
        assert np.linalg.norm(a + s * d - p) <= line.bound + 1e-9


@given(curves(dimensions=(2,)), curves(dimensions=(2,)))
def test_intersection_is_symmetric(a, b):
    ab, ba = ff.intersect(a, b), ff.intersect(b, a)
    assert len(ab.contacts) == len(ba.contacts)
    for c in ab.contacts:
        assert np.linalg.norm(a(c.at[0]) - b(c.at[1])) <= c.gap + 1e-9


def scaled(c, factor):
    if c.is_rational:
        return ff.Curve.from_homogeneous(c.coefficients * np.r_[[factor] * c.dimension, [1.0]], c.degree, c.knots)
    return ff.Curve(c.points * factor, c.degree, c.knots)


@given(curves(), st.sampled_from([2.0**-30, 0.5, 1024.0]))
def test_scaling_by_a_power_of_two_scales_every_answer_exactly(c, factor):
    """All digits, but for what underflows: bounds have denormal parts that do not scale."""
    big, point = scaled(c, factor), np.full(c.dimension, 0.3)

    def exactly(ours, scaled_ours):
        a, b = factor * np.asarray(ours), np.asarray(scaled_ours)
        return (np.abs(a - b) <= np.where(np.abs(a) < 1e-290, 1e-290, 1e-300)).all()

    assert np.array_equal(big(T), factor * c(T))
    assert exactly(c.length(1e-9).value, big.length(factor * 1e-9).value)
    for accuracy in (0.0, 1e-9, 0.125):
        ours, theirs = c.bounds(accuracy), big.bounds(factor * accuracy)
        assert exactly(ours.box.lo, theirs.box.lo) and exactly(ours.box.hi, theirs.box.hi)
        assert exactly(ours.slack, theirs.slack)
    near_one, near_other = ff.nearest(c, point), ff.nearest(big, factor * point)
    assert exactly(near_one.distance, near_other.distance) and exactly(near_one.lower_bound, near_other.lower_bound)


@given(curves())
def test_documents_bring_back_the_same_curve(c):
    back = ff.parse(ff.Document([c], "mm", ["c"]).to_bytes("json"), "json")
    assert back.names == ["c"] and back.unit == "mm"
    assert near(back[0](T), c(T)) and back[0].degree == c.degree
    if not c.is_rational:
        assert back[0] == c


@given(curves(dimensions=(2, 3)))
def test_to_scipy_and_back(c):
    spline = c.to_scipy()
    values = spline(T)
    assert near(values[:, :-1] / values[:, -1:] if c.is_rational else values, c(T))
    if not c.is_rational:
        assert ff.Curve.from_scipy(spline) == c


@pytest.mark.parametrize("closed", [(False, False), (True, False), (True, True)])
def test_surface_operations_do_not_change_the_map(closed):
    rng = np.random.default_rng(3)
    s = ff.Surface(rng.normal(size=(6, 7, 3)), (3, 2), closed=closed)
    (u0, u1), (v0, v1) = s.domain
    u, v = np.linspace(u0, u1, 11)[:, None], np.linspace(v0, v1, 9)
    for other in (s.insert_knot(u0 + 0.3, 0), s.insert_knots([v0 + 0.7], 1), s.elevate(1, 0), s.elevate(1, 1)):
        assert near(other(u, v), s(u, v))
    assert near(s.iso(0, u0 + 0.3)(v), s(u0 + 0.3, v))
    assert near(s.iso(1, v0 + 0.3)(u[:, 0]), s(u[:, 0], v0 + 0.3))
    assert near(s.partial(0)(u[1:-1], v), s(u[1:-1], v, (1, 0)), 1e3)
