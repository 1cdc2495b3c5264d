"""Values on NumPy arrays: the right ones, in the right shapes, without copies, on several threads."""
import threading
import tracemalloc

import numpy as np
import pytest
from hypothesis import given, strategies as st

import freiform as ff

scipy_interpolate = pytest.importorskip("scipy.interpolate")
RNG = np.random.default_rng(5)


def some_curve(degree=3, size=9, dimension=2):
    inner = np.sort(RNG.uniform(0, 1, size - degree - 1))
    return ff.Curve(RNG.normal(size=(size, dimension)), degree, np.r_[np.zeros(degree + 1), inner, np.ones(degree + 1)])


@given(st.integers(1, 6), st.integers(1, 4), st.integers(0, 3))
def test_a_polynomial_curve_is_scipys_bspline(degree, dimension, order):
    curve = some_curve(degree, degree + 5, dimension)
    t = RNG.uniform(0, 1, (3, 7))
    # scipy 1.10 writes beyond its memory where the order is above the degree.
    theirs = scipy_interpolate.BSpline(curve.knots, curve.points, degree)(t, order) if order <= degree else np.zeros(1)
    assert np.allclose(curve(t, order), theirs, rtol=1e-11, atol=1e-9 * (1 + np.abs(theirs).max()))
    assert curve.derivative(order)(t).shape == (3, 7, dimension)


def test_shapes_follow_the_parameters():
    c, s = some_curve(), ff.Surface(RNG.normal(size=(4, 5, 3)), (3, 2))
    v = ff.Volume(RNG.normal(size=(2, 3, 4, 3)))
    assert c(0.5).shape == (2,) and c([]).shape == (0, 2) and c([[0.1, 0.2]]).shape == (1, 2, 2)
    assert c.evaluate(0.5, 2).shape == (3, 2) and c.evaluate([0.1, 0.2], 0).shape == (2, 1, 2)
    u = np.linspace(0, 1, 6)
    assert s(u, 0.5).shape == (6, 3) and s(u[:, None], u).shape == (6, 6, 3)
    assert s.evaluate(u, u, 2).shape == (6, 6, 3) and s.grid(u, u[:4]).shape == (6, 4, 3)
    assert s.normal(u, u).shape == (6, 3) and s.curvatures(u, 0.5).shape == (6, 2)
    assert v(u[:, None, None], u[:, None], u).shape == (6, 6, 6, 3) and v.grid(u, u, u[:2]).shape == (6, 6, 2, 3)


def test_broadcast_strided_and_grid_evaluation_are_the_same_bits_or_within_the_bound():
    s = ff.Surface(RNG.normal(size=(7, 6, 3)), (3, 3))
    u, v = np.linspace(0, 4, 90), np.linspace(0, 3, 70)
    scattered = s(u[:, None], v)
    assert np.abs(scattered - s.grid(u, v)).max() <= 2 * s.value_error_bound()
    uu, vv = np.meshgrid(u, v, indexing="ij")
    assert np.array_equal(s(uu, vv), scattered)
    assert np.array_equal(s(uu[::2, ::3], vv[::2, ::3]), scattered[::2, ::3])
    assert np.array_equal(s(np.asfortranarray(uu), vv), scattered)
    c = some_curve()
    t = np.linspace(0, 1, 10001)
    assert np.array_equal(c(t)[::5], c(t[::5])) and np.array_equal(c(t)[77], c(t[77]))


def test_integers_and_lists_and_other_types_are_taken():
    c = ff.Curve([[0, 0], [2, 2]])
    assert np.array_equal(c(1), [2, 2]) and np.array_equal(c(np.float32(0.5)), [1, 1])
    assert np.array_equal(c([0, 1]), [[0, 0], [2, 2]]) and np.array_equal(c(np.array([1], dtype=np.int8)), [[2, 2]])


def test_orders_above_two_are_those_of_scipy_too():
    c = some_curve(5, 12)
    t = np.linspace(0, 1, 50)
    jets = c.evaluate(t, 5)
    for k in range(6):
        theirs = scipy_interpolate.BSpline(c.knots, c.points, 5)(t, k)
        assert np.allclose(jets[:, k], theirs, rtol=1e-9, atol=1e-9 * np.abs(theirs).max())


def test_a_rational_derivative_is_that_of_the_quotient():
    arc = ff.circle([0, 0], 2.0).curve
    t = np.linspace(*arc.domain, 101)
    p, d = arc(t), arc(t, 1)
    assert np.allclose(np.hypot(*p.T), 2, atol=1e-14)
    assert np.allclose(np.einsum("ij,ij->i", p, d), 0, atol=1e-12)
    assert np.allclose(arc.curvature(t), 0.5, atol=1e-12)


def test_parameters_outside_are_refused_with_their_place_or_nan():
    c = some_curve()
    t = np.linspace(0, 1, 20000)
    t[12345] = 1.5
    with pytest.raises(ff.OutOfDomainError, match=r"at\[12345\]"):
        c(t)
    s = ff.Surface(RNG.normal(size=(4, 4, 3)))
    with pytest.raises(ff.OutOfDomainError, match=r"at\[12345\]"):
        s(t, 0.5)
    values = c(t, outside="nan")
    assert np.isnan(values[12345]).all() and np.isfinite(np.delete(values, 12345, 0)).all()
    with pytest.raises(ff.InvalidError):
        c(0.5, outside="clamp")


def test_closed_curves_go_round():
    c = ff.Curve([[0, 0], [1, 0], [1, 1], [0, 1], [-1, 0.5]], 3, closed=True)
    assert c.is_closed and np.allclose(c(0.25), c(5.25)) and np.allclose(c(-1.5), c(3.5))


def test_extreme_weights_and_spans_are_evaluated_without_the_kernels():
    c = ff.Curve([[0, 0], [1, 1], [2, 0]], knots=[0, 0, 0, 1e-200, 1e-200, 1e-200])
    assert np.allclose(c([0, 5e-201, 1e-200]), [[0, 0], [1, 0.5], [2, 0]])
    assert c.evaluate([5e-201], 0).shape == (1, 1, 2)
    assert np.isnan(c([1.0], outside="nan")).all()


def test_accurate_values_contain_the_exact_ones():
    c = ff.Curve([[1.0], [-1.0], [1.0]])  # (1 - 2 t)^2
    t = np.array([0.5, 0.5 + 2**-20, 0.25])
    value, bound = c.evaluate_accurate(t)
    exact = (1 - 2 * t) ** 2
    assert (np.abs(value[:, 0] - exact) <= bound[:, 0]).all() and (bound < 1e-16).all()


def test_a_million_points_take_no_memory_but_the_result():
    c, s = some_curve(dimension=3), ff.Surface(RNG.normal(size=(20, 20, 3)), (3, 3))
    t = np.linspace(0, 1, 1_000_000)
    c(t[:10]), s(t[:10], t[:10])
    for call, at_most in ((lambda: c(t), 1e6), (lambda: s(t, 0.5), 1e6), (lambda: s(t, t), 1e6)):
        tracemalloc.start()
        out = call()
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak - out.nbytes < at_most


def test_other_threads_run_while_a_batch_is_evaluated():
    """The GIL is released: a thread that counts gets on during one long call."""
    s = ff.Surface(RNG.normal(size=(30, 30, 3)), (5, 5))
    u = np.random.default_rng(1).uniform(0, 25, 400_000)
    s(u[:10], u[:10])
    counted, running = 0, True

    def count():
        nonlocal counted
        while running:
            counted += 1

    t = threading.Thread(target=count)
    t.start()
    before = counted
    s.evaluate(u, u, 2)
    during = counted - before
    running = False
    t.join()
    assert during > 100


def test_results_do_not_depend_on_threads():
    s = ff.Surface(RNG.normal(size=(9, 9, 3)), (3, 3))
    u = RNG.uniform(0, 6, 100_000)
    try:
        ff.set_max_threads(1)
        one = s(u, u[::-1])
    finally:
        ff.set_max_threads(0)
    assert np.array_equal(one, s(u, u[::-1])) and ff.max_threads() == 0


def test_grids_on_many_patches():
    patches = [ff.Surface(RNG.normal(size=(4, 4, 3))) for _ in range(5)]
    u = np.linspace(0, 1, 4)
    all_points = ff.evaluate_grids(patches, u, u)
    assert all_points.shape == (5, 4, 4, 3)
    assert np.allclose(all_points[3], patches[3].grid(u, u))
