"""Curves, their derivatives, lengths and implicit forms."""
from __future__ import annotations

from typing import Any, Sequence

import numpy as np

from . import _core
from ._base import Array, ArrayLike, Bounded, Interval, IntervalLike, from_header, numbers, pair, points_array
from ._basis import Basis, PolynomialBasis
from ._patch import _basis_tuple, _Patch
from ._records import (AFrame, ArcLengthCurve, Continuity, Converted, Crossing, Feature, FlattenComparison, ImplicitTerm,
                       KnotContinuity, Measure, NearPolynomial, Polyline, SelfIntersection)
from ._refusals import InvalidError, UnsupportedError

__all__ = ["Curve", "Derivative", "ArcLength", "Implicit"]


@from_header("spline/patch:Patch")
class Curve(_Patch[_core.CurveHandle]):
    """A polynomial or rational spline curve.

    ``Curve(points)`` is the Bezier curve on [0, 1]; ``Curve(points, 3)`` has clamped uniform knots; ``closed=True`` with
    the breaks of one period as knots (0, 1, .., n where they are left out) is a closed curve.
    """

    __slots__ = ()
    _parameters = 1

    def __init__(self, points: ArrayLike, degree: int | None = None, knots: ArrayLike | None = None,
                 weights: ArrayLike | None = None, *, closed: bool = False) -> None:
        p = points_array(points)
        if p.ndim != 2:
            raise InvalidError("points", f"have {p.ndim} axes; an array (n, D) is needed")
        self._c = _core.CurveHandle.make([_basis_tuple(p.shape[0], degree, knots, closed)], p,
                                         None if weights is None else points_array(weights))

    @classmethod
    def from_homogeneous(cls, coefficients: ArrayLike, degree: int | None = None, knots: ArrayLike | None = None, *,
                         closed: bool = False) -> Curve:
        """From weighted coefficients (w x, w)."""
        c = points_array(coefficients)
        return cls._of(_core.CurveHandle.from_homogeneous([_basis_tuple(c.shape[0], degree, knots, closed)], c))

    @classmethod
    @from_header("spline/weights:positive_weights")
    def with_any_weights(cls, coefficients: ArrayLike, degree: int | None = None,
                         knots: ArrayLike | None = None) -> tuple[Curve, float]:
        """From weighted coefficients whose weights may be zero or negative: (curve, bound)."""
        c = points_array(coefficients)
        made = _core.CurveHandle.positive([_basis_tuple(c.shape[0], degree, knots, False)], c)
        return made[0], made[1]

    @property
    def basis(self) -> Basis:
        return self.bases[0]

    @property
    def degree(self) -> int:
        return self._basis(0).degree

    @property
    def knots(self) -> Array:
        """The knots; of a closed curve the breaks of one period."""
        return self._basis(0).defining

    @property
    def domain(self) -> Interval:
        return self._basis(0).domain

    @property
    def is_closed(self) -> bool:
        """Whether the basis is closed."""
        return self._basis(0).is_closed

    def __call__(self, t: ArrayLike, nu: int = 0, *, outside: str = "refuse") -> Array:
        """The points (nu: the derivatives of this order) at parameters of any shape: shape t.shape + (dimension,).

        Parameters outside the domain are refused; with outside="nan" they give NaN.
        """
        if nu == 0:
            return self._evaluate([t], None, outside)
        return self._evaluate([t], nu, outside)[..., nu, :]

    def evaluate(self, t: ArrayLike, derivatives: int | None = None, *, outside: str = "refuse",
                 out: Array | None = None) -> Array:
        """Points, or with derivatives=k value and derivatives to order k: shape t.shape + (k + 1, dimension).

        out: an array of this shape that they are written to; no memory is taken then.
        """
        return self._evaluate([t], derivatives, outside, out)

    @from_header("spline/accurate:Accurate", "spline/accurate:evaluate_accurate")
    def evaluate_accurate(self, t: ArrayLike) -> tuple[Array, Array]:
        """Values to the last digit, and bounds of their errors."""
        return self._accurate([t])

    def derivative(self, order: int = 1) -> Derivative:
        """The derivative as a function: ``curve.derivative(2)(t)``."""
        return Derivative(self, order)

    def hodograph(self) -> Curve:
        """The derivative as a spline of its own; refused of rational curves."""
        return _core.derivative(self._c, 0)  # type: ignore[no-any-return]

    def tangent(self, t: ArrayLike) -> Array:
        """Unit tangents; NaN where the derivative is zero."""
        d = self(t, 1)
        with np.errstate(invalid="ignore"):
            return d / np.linalg.norm(d, axis=-1, keepdims=True)  # type: ignore[no-any-return]

    def curvature(self, t: ArrayLike) -> Array:
        """Estimates, in the plane with a sign (left turns > 0), in space >= 0; NaN where the derivative is zero."""
        jet = self._evaluate([t], 2, "refuse")
        first, second = jet[..., 1, :], jet[..., 2, :]
        speed = np.linalg.norm(first, axis=-1)
        with np.errstate(invalid="ignore", divide="ignore"):
            if self.dimension == 2:
                return (first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]) / speed**3  # type: ignore[no-any-return]
            along = np.einsum("...i,...i->...", first, second) / speed**2
            return np.linalg.norm(second - along[..., None] * first, axis=-1) / speed**2  # type: ignore[no-any-return]

    # --- changes

    @from_header("spline/construction:de_boor")
    def construction(self, t: float) -> list[Array]:
        """The points of de Boor's (de Casteljau's) construction, level after level."""
        levels: list[Array] = _core.construction(self._c, t)[0]
        return levels

    @from_header("spline/a_frame:a_frames")
    def a_frames(self) -> list[AFrame]:
        return _core.a_frames(self._c)

    def to_basis(self, u: float, basis: PolynomialBasis) -> Converted:
        """The coefficients in another basis of the polynomial on the span of u."""
        return _core.to_basis(self._c, u, basis._c)

    @from_header("make/polynomial_near:polynomial_near")
    def polynomial_near(self, tolerance: float) -> NearPolynomial:
        """A polynomial curve within a distance of this rational one."""
        return _core.polynomial_near(self._c, tolerance)

    @from_header("query/reparametrise:by_arc_length")
    def by_arc_length(self, tolerance: float, max_pieces: int = 1_000_000) -> ArcLengthCurve:
        """The curve at unit speed."""
        return _core.by_arc_length(self._c, tolerance, max_pieces)

    @from_header("query/continuity:reparametrised")
    def reparametrised(self, phi: ArrayLike, from_: float) -> Curve:
        return _core.reparametrised(self._c, points_array(phi), from_)

    @from_header("query/continuity:reparametrised_rationally")
    def reparametrised_rationally(self, rate: float, second: float, from_: float) -> Curve:
        return _core.reparametrised_rationally(self._c, rate, second, from_)

    @from_header("make/joint:next_c")
    def next_c(self, order: int, free: ArrayLike = (), on: IntervalLike = (0.0, 1.0),
               weights: Sequence[float] = ()) -> Curve:
        """The next piece, which joins the end of this curve with C^order; free: its further coefficients."""
        return _core.next_c(self._c, order, points_array(free), pair(on), list(weights))

    @from_header("make/joint:next_g")
    def next_g(self, phi: ArrayLike, free: ArrayLike = (), on: IntervalLike = (0.0, 1.0),
               weights: Sequence[float] = ()) -> Curve:
        """The next piece, which joins with G^k; phi: derivatives of the change of parameter."""
        return _core.next_g(self._c, np.atleast_1d(points_array(phi)), points_array(free), pair(on), list(weights))

    # --- questions

    @from_header("query/length:length")
    def length(self, accuracy: float = 0.0, on: IntervalLike | None = None) -> Measure:
        """The arc length with a bound."""
        lengths = ArcLength(self, accuracy)
        return lengths.total if on is None else lengths.between(on)

    def arc_length(self, accuracy: float = 0.0) -> ArcLength:
        """The arc length prepared for many questions: s(t), its inverse, equal parts."""
        return ArcLength(self, accuracy)

    @from_header("path/flatten:flatten")
    def flatten(self, tolerance: float = 0.0, *, segments: int = 0, method: str = "adaptive", polygons: bool = False,
                max_segments: int = 10_000_000) -> Polyline:
        """A polyline within a distance."""
        return _core.flatten(self._c, tolerance, segments, method, polygons, max_segments)

    @from_header("path/flatten:compare_flattening")
    def compare_flattening(self, segments: int) -> list[FlattenComparison]:
        return _core.compare_flattening(self._c, segments)

    @from_header("query/crossings:crossings")
    def crossings(self, normal: ArrayLike, offset: float, accuracy: float = 0.0) -> list[Crossing]:
        """Where normal . C(t) + offset = 0: every place."""
        return _core.crossings(self._c, np.atleast_1d(points_array(normal)), offset, accuracy)

    @from_header("query/features:inflections")
    def inflections(self, accuracy: float = 0.0) -> list[Feature]:
        return _core.inflections(self._c, accuracy)

    @from_header("query/features:cusps")
    def cusps(self, accuracy: float = 0.0) -> list[Feature]:
        return _core.cusps(self._c, accuracy)

    @from_header("query/features:extrema")
    def extrema(self, direction: ArrayLike, accuracy: float = 0.0) -> list[Feature]:
        return _core.extrema(self._c, np.atleast_1d(points_array(direction)), accuracy)

    @from_header("query/features:vertices")
    def vertices(self, accuracy: float = 0.0) -> list[Feature]:
        return _core.vertices(self._c, accuracy)

    @from_header("query/self_intersection:self_intersections")
    def self_intersections(self, accuracy: float, max_pairs: int = 200_000) -> list[SelfIntersection]:
        """Where the curve meets itself: every place."""
        return _core.self_intersections(self._c, accuracy, max_pairs)

    @from_header("query/continuity:continuity")
    def continuity(self, *, orders: int = 3, tolerance: float = 0.0, angle: float = 0.0, curvature: float = 0.0,
                   third: float = 0.0, roundings: float = 4.0) -> list[KnotContinuity]:
        """Every knot inside the domain, and the seam: the orders of C and G."""
        return _core.continuity(self._c, (orders, tolerance, angle, curvature, third, roundings))

    @from_header("query/continuity:joint")
    def joint(self, second: Curve, *, orders: int = 3, tolerance: float = 0.0, angle: float = 0.0,
              curvature: float = 0.0, third: float = 0.0, roundings: float = 4.0) -> Continuity:
        """How the end of this curve meets the start of another one."""
        return _core.joint(self._c, second._c, (orders, tolerance, angle, curvature, third, roundings))

    def implicit(self) -> Implicit:
        """The implicit form of a plane curve of one piece."""
        return Implicit(self)

    # --- other libraries

    def to_scipy(self) -> Any:
        """``scipy.interpolate.BSpline`` of the same map; of a rational curve that of (w x, w), to be divided."""
        from scipy.interpolate import BSpline  # type: ignore[import]
        if self.is_closed:
            n, basis = self.basis.size, self.basis
            return BSpline(basis.knots, np.take(self.coefficients, np.arange(n + self.degree), axis=0, mode="wrap"),
                           self.degree, extrapolate="periodic")
        return BSpline(self.knots, self.coefficients, self.degree)

    @classmethod
    def from_scipy(cls, spline: Any) -> Curve:
        """From ``BSpline`` (values of one number become curves of one coordinate), ``PPoly`` and ``CubicSpline``."""
        if hasattr(spline, "t"):
            c = np.asarray(spline.c, dtype=np.float64)
            c = c.reshape(len(c), -1)[: len(spline.t) - spline.k - 1]
            return cls(c, int(spline.k), spline.t)
        c, x = np.asarray(spline.c, dtype=np.float64), np.asarray(spline.x, dtype=np.float64)
        if c.ndim < 2:
            raise UnsupportedError("spline", f"{type(spline).__name__} is no BSpline or PPoly")
        order, pieces = c.shape[:2]
        bezier = []
        for i in range(pieces):
            h = x[i + 1] - x[i]
            powers = c[:, i].reshape(order, -1) * (h ** np.arange(order - 1, -1, -1.0))[:, None]
            change = _core.convert_coefficients(PolynomialBasis.monomial(order - 1)._c,
                                                PolynomialBasis.bernstein(order - 1)._c, points_array(powers))
            bezier.append(change[0])
        return cls(np.concatenate(bezier), order - 1, np.repeat(x, order))

    def _repr_svg_(self) -> str | None:
        from ._files import Document
        if self.dimension == 4:
            return None
        return Document([self]).draw("svg", width=640, height=400, control=True).decode()


class Derivative:
    """The derivative of a curve as a function of its parameter."""

    __slots__ = ("curve", "order")

    def __init__(self, curve: Curve, order: int = 1) -> None:
        if order < 0:
            raise InvalidError("order", f"{order} is negative")
        self.curve = curve
        self.order = order

    def __call__(self, t: ArrayLike, *, outside: str = "refuse") -> Array:
        return self.curve(t, self.order, outside=outside)

    def derivative(self, order: int = 1) -> Derivative:
        return Derivative(self.curve, self.order + order)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Derivative) and (self.curve, self.order) == (other.curve, other.order)

    def __hash__(self) -> int:
        return hash((self.curve, self.order))

    def __repr__(self) -> str:
        return f"Derivative({self.curve!r}, {self.order})"

    def __reduce__(self) -> tuple[Any, ...]:
        return Derivative, (self.curve, self.order)


@from_header("query/length:ArcLength")
class ArcLength:
    """The arc length s(t) of a curve, prepared once; every number with a bound."""

    __slots__ = ("_c", "curve", "accuracy")

    def __init__(self, curve: Curve, accuracy: float = 0.0) -> None:
        self.curve, self.accuracy = curve, accuracy
        self._c = _core.ArcLengthHandle(curve._c, accuracy)

    @property
    def total(self) -> Measure:
        return self._c.total()

    def between(self, on: IntervalLike) -> Measure:
        """The length of a part."""
        return self._c.between(pair(on))

    def __call__(self, t: ArrayLike) -> Array:
        """The lengths from the start of the domain to t."""
        return self.at(t)[0]

    def at(self, t: ArrayLike) -> tuple[Array, Array]:
        """(lengths, bounds)."""
        return self._c.at(numbers(t, "parameters"))

    def parameter(self, length: ArrayLike) -> tuple[Array, Array]:
        """The inverse: (parameters, bounds in model units)."""
        return self._c.parameter(numbers(length, "length"))

    def equal_parts(self, n: int) -> tuple[Array, Array]:
        """n + 1 parameters that divide the curve into n parts of equal length, and bounds."""
        return self._c.equal_parts(n)

    def spaced(self, distance: float) -> tuple[Array, Array]:
        """The parameters at 0, d, 2 d, .. along the curve, and bounds."""
        return self._c.spaced(distance)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ArcLength) and (self.curve, self.accuracy) == (other.curve, other.accuracy)

    def __hash__(self) -> int:
        return hash((self.curve, self.accuracy))

    def __repr__(self) -> str:
        return f"ArcLength({self.curve!r}, {self.accuracy!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return ArcLength, (self.curve, self.accuracy)


@from_header("query/implicit:Implicit")
class Implicit:
    """The implicit form F(x, y) = 0 of a plane curve of one piece."""

    __slots__ = ("_c", "curve")

    def __init__(self, curve: Curve) -> None:
        self.curve = curve
        self._c = _core.ImplicitHandle(curve._c)

    @property
    def degree(self) -> int:
        return self._c.degree

    @property
    def traces(self) -> int:
        """How often the curve runs along its image."""
        return self._c.traces

    def __call__(self, at: ArrayLike) -> Bounded:
        """F with a bound, up to a factor."""
        return self._c.value(points_array(at))

    def sign(self, at: ArrayLike) -> int:
        """The sign of F: exact."""
        return self._c.sign(points_array(at))

    def terms(self) -> list[ImplicitTerm]:
        """F as a sum of coefficient x^i y^j."""
        return self._c.terms()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Implicit) and self.curve == other.curve

    def __hash__(self) -> int:
        return hash(("Implicit", self.curve))

    def __repr__(self) -> str:
        return f"Implicit({self.curve!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return Implicit, (self.curve,)
