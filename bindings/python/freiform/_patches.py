"""Curves, surfaces and volumes."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, Sequence, TypeVar, Union

import numpy as np

from . import _core
from ._base import Array, ArrayLike, Bounded, Interval, IntervalLike, from_header, pair, points_array, same
from ._basis import Basis, PolynomialBasis
from ._records import (AFrame, ArcLengthCurve, Continuity, Converted, Crossing, Extended, Extent, Feature, FlattenComparison,
                       ImplicitTerm, KnotContinuity, KnotLine, LimitNormal, LineContinuity, Measure, NearPolynomial,
                       Polyline, Reduced, Section, SelfIntersection, SurfaceCurvature, TightBox, Transformed)
from ._refusals import InvalidError, UnsupportedError

if TYPE_CHECKING:
    from ._meshes import Mesh

__all__ = ["Curve", "Surface", "Volume", "Derivative", "ArcLength", "Implicit", "AnyPatch"]

P = TypeVar("P", bound="_Patch[Any]")
H = TypeVar("H", _core.CurveHandle, _core.SurfaceHandle, _core.VolumeHandle)
BasisTuple = tuple[int, Array, bool]

_ORDER_NAMES = "graded order: the value; first derivatives by u, by v; second ones by uu, uv, vv; .."


def _basis_tuple(size: int, degree: int | None, knots: ArrayLike | None, closed: bool) -> BasisTuple:
    """(degree, knots, closed) where some of it is left out: a Bezier patch, or clamped and uniform knots."""
    if knots is not None:
        given = points_array(knots)
        return (given.size - size - 1 if degree is None and not closed else 3 if degree is None else degree), given, closed
    if closed:
        return 3 if degree is None else degree, np.arange(size + 1.0), True
    p = size - 1 if degree is None else degree
    if not 0 <= p < size:
        raise InvalidError("degree", f"{p} needs {p + 1} points or more, not {size}")
    if p == size - 1:
        return p, np.repeat([0.0, 1.0], p + 1), False
    return p, np.concatenate([np.zeros(p), np.arange(size - p + 1.0), np.full(p, float(size - p))]), False


def _broadcast(*parameters: ArrayLike) -> list[Array]:
    arrays = [np.asarray(p, dtype=np.float64) for p in parameters]
    return list(np.broadcast_arrays(*arrays)) if len(arrays) > 1 else arrays


class _Patch(Generic[H]):
    """What curves, surfaces and volumes have in common. Immutable."""

    __slots__ = ("_c",)
    _c: H
    _parameters = 0

    @classmethod
    def _of(cls: type[P], handle: Any) -> P:
        made = object.__new__(cls)
        made._c = handle
        return made

    # --- what it is made of

    @property
    def dimension(self) -> int:
        """Coordinates of a point, 1 to 4."""
        return self._c.dimension

    @property
    def is_rational(self) -> bool:
        return self._c.is_rational

    @property
    def points(self) -> Array:
        """The control points, not multiplied by weights: the last axis holds the coordinates."""
        points: Array = self._c.points()
        return points

    @property
    def weights(self) -> Array | None:
        """The weights; None of a polynomial patch."""
        return self._c.weights() if self._c.is_rational else None

    @property
    def coefficients(self) -> Array:
        """What is stored: points, or (w x, w) of a rational patch."""
        coefficients: Array = self._c.coefficients()
        return coefficients

    @property
    def bases(self) -> tuple[Basis, ...]:
        return tuple(Basis._of(self._c.basis(d)) for d in range(self._parameters))

    def to_rational(self: P) -> P:
        """The same map with weights, all 1 where there were none."""
        return self._c.to_rational()  # type: ignore[no-any-return]

    def in_space(self: P) -> P:
        """With three coordinates; those that are missing are 0."""
        return self._c.in_space()  # type: ignore[no-any-return]

    def value_error_bound(self) -> float:
        """A bound of |computed - exact| in each coordinate of a value inside the domain."""
        return _core.value_error_bound(self._c)

    # --- values

    def _evaluate(self, parameters: Sequence[ArrayLike], derivatives: int | None, outside: str) -> Array:
        if outside not in ("refuse", "nan"):
            raise InvalidError("outside", f'"{outside}" is not "refuse" or "nan"')
        values: Array = _core.evaluate(self._c, _broadcast(*parameters), derivatives or 0, outside == "nan")
        return values if derivatives != 0 else values[..., np.newaxis, :]

    def _grid(self, axes: Sequence[ArrayLike], derivatives: int | None) -> Array:
        values: Array = _core.evaluate_grid(self._c, [np.atleast_1d(points_array(a)) for a in axes], derivatives or 0)
        return values if derivatives != 0 else values[..., np.newaxis, :]

    def _accurate(self, parameters: Sequence[ArrayLike]) -> tuple[Array, Array]:
        return _core.evaluate_accurate(self._c, _broadcast(*parameters))

    # --- changes

    def _axis(self, axis: int) -> int:
        return axis

    @from_header("spline/patch:insert_knots", "basis/change:insert_knots")
    def insert_knots(self: P, knots: ArrayLike, axis: int = 0) -> P:
        """The same function with more knots."""
        return _core.insert_knots(self._c, axis, np.atleast_1d(points_array(knots)))  # type: ignore[no-any-return]

    @from_header("basis/subdivide:insert_knot")
    def insert_knot(self: P, u: float, axis: int = 0) -> P:
        return _core.insert_knot(self._c, axis, u)  # type: ignore[no-any-return]

    @from_header("spline/refine:remove_knots")
    def remove_knots(self, tolerance: float, axis: int = 0) -> Reduced:
        """Fewer knots within a distance."""
        return _core.remove_knots(self._c, axis, tolerance)

    @from_header("basis/change:elevate")
    def elevate(self: P, by: int = 1, axis: int = 0) -> P:
        """The same function with a higher degree."""
        return _core.elevate(self._c, axis, by)  # type: ignore[no-any-return]

    @from_header("spline/refine:reduce_degree")
    def reduce_degree(self, tolerance: float, axis: int = 0) -> Reduced:
        """The degree less one within a distance."""
        return _core.reduce_degree(self._c, axis, tolerance)

    @from_header("basis/change:restrict_to")
    def restrict_to(self: P, on: IntervalLike, axis: int = 0) -> P:
        """The part on an interval."""
        return _core.restrict_to(self._c, axis, *pair(on))  # type: ignore[no-any-return]

    @from_header("spline/subdivision:extend_to")
    def extend_to(self, on: IntervalLike, axis: int = 0) -> Extended:
        """The same map on a larger domain."""
        return _core.extend_to(self._c, axis, *pair(on))

    @from_header("spline/subdivision:split")
    def split(self: P, u: float, axis: int = 0) -> tuple[P, P]:
        """The parts below and above a parameter."""
        return _core.split(self._c, axis, u)  # type: ignore[no-any-return]

    @from_header("basis/change:reverse")
    def reverse(self: P, axis: int = 0) -> P:
        return _core.reverse(self._c, axis)  # type: ignore[no-any-return]

    @from_header("spline/subdivision:halve_uniform")
    def halve_uniform(self: P, axis: int = 0) -> P:
        return _core.halve_uniform(self._c, axis)  # type: ignore[no-any-return]

    def decompose(self: P) -> list[P]:
        """The Bezier pieces, in the order of the net."""
        return _core.decompose(self._c)

    @from_header("spline/transform:transform")
    def transform(self, linear: ArrayLike, offset: ArrayLike | None = None) -> Transformed:
        """The image under x -> linear x + offset, in the plane or in space."""
        a = points_array(linear)
        return _core.transform(self._c, a, np.zeros(a.shape[0]) if offset is None else points_array(offset))

    @from_header("spline/transform:perspective")
    def project(self, eye: ArrayLike, origin: ArrayLike, across: ArrayLike, up: ArrayLike) -> Transformed:
        """The picture that a perspective makes: plane and rational."""
        return _core.project(self._c, points_array(eye), points_array(origin), points_array(across), points_array(up))

    # --- questions

    @from_header("query/bounds:tight_box")
    def bounds(self, accuracy: float = 0.0, max_pieces: int = 20000) -> TightBox:
        """The box that contains it, and how far it may be from tight."""
        return _core.tight_box(self._c, accuracy, max_pieces)

    @from_header("query/bounds:extent_along")
    def extent_along(self, direction: ArrayLike, accuracy: float = 0.0, max_pieces: int = 20000) -> Extent:
        return _core.extent_along(self._c, points_array(direction), accuracy, max_pieces)

    @from_header("query/continuity:knot_lines")
    def knot_lines(self, axis: int = 0, *, tolerance: float = 0.0, roundings: float = 4.0) -> list[KnotLine]:
        return _core.knot_lines(self._c, axis, (3, tolerance, 0.0, 0.0, 0.0, roundings))

    # --- manners

    def _bases(self) -> list[BasisTuple]:
        return [(b.degree, b.defining, b.is_closed) for b in self.bases]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and bool(self._c.equals(other._c))  # type: ignore[attr-defined]

    def __hash__(self) -> int:
        return hash((type(self).__name__, self.coefficients.tobytes(), self.bases))

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (type(self), self.is_rational, self._bases(), self.coefficients)

    def __copy__(self: P) -> P:
        return self

    def __deepcopy__(self: P, memo: object) -> P:
        return self

    def _knots_text(self) -> str:
        b = [(b.degree, b.defining.tolist(), b.is_closed) for b in self.bases]
        if self._parameters == 1:
            return f"degree={b[0][0]}, knots={b[0][1]!r}" + (", closed=True" if b[0][2] else "")
        closed = f", closed={tuple(x[2] for x in b)!r}" if any(x[2] for x in b) else ""
        return f"degrees={tuple(x[0] for x in b)!r}, knots={tuple(x[1] for x in b)!r}{closed}"

    def __repr__(self) -> str:
        name = type(self).__name__
        if not self.is_rational:
            return f"{name}({self.points.tolist()!r}, {self._knots_text()})"
        points, weights = self.points, self.coefficients[..., -1]
        if same(np.concatenate([points * weights[..., None], weights[..., None]], axis=-1), self.coefficients):
            return f"{name}({points.tolist()!r}, {self._knots_text()}, weights={weights.tolist()!r})"
        return f"{name}.from_homogeneous({self.coefficients.tolist()!r}, {self._knots_text()})"


def _restored(cls: type[P], rational: bool, bases: list[BasisTuple], coefficients: Array) -> P:
    handle: Any = {Curve: _core.CurveHandle, Surface: _core.SurfaceHandle, Volume: _core.VolumeHandle}[cls]
    return cls._of(handle.from_homogeneous(bases, coefficients) if rational else handle.make(bases, coefficients, None))


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
        return self._c.basis(0).degree

    @property
    def knots(self) -> Array:
        """The knots; of a closed curve the breaks of one period."""
        return self._c.basis(0).defining

    @property
    def domain(self) -> Interval:
        return self._c.basis(0).domain

    @property
    def is_closed(self) -> bool:
        """Whether the basis is closed."""
        return self._c.basis(0).is_closed

    def __call__(self, t: ArrayLike, nu: int = 0, *, outside: str = "refuse") -> Array:
        """The points (nu: the derivatives of this order) at parameters of any shape: shape t.shape + (dimension,).

        Parameters outside the domain are refused; with outside="nan" they give NaN.
        """
        if nu == 0:
            return self._evaluate([t], None, outside)
        return self._evaluate([t], nu, outside)[..., nu, :]

    def evaluate(self, t: ArrayLike, derivatives: int | None = None, *, outside: str = "refuse") -> Array:
        """Points, or with derivatives=k value and derivatives to order k: shape t.shape + (k + 1, dimension)."""
        return self._evaluate([t], derivatives, outside)

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


@from_header("spline/patch:Patch")
class Surface(_Patch[_core.SurfaceHandle]):
    """A polynomial or rational tensor product surface; points: (n_u, n_v, D).

    ``Surface(points)`` is the Bezier patch on [0, 1] x [0, 1]; ``Surface(points, (3, 3))`` has clamped uniform knots.
    """

    __slots__ = ()
    _parameters = 2

    def __init__(self, points: ArrayLike, degrees: tuple[int, int] | None = None,
                 knots: tuple[ArrayLike, ArrayLike] | None = None, weights: ArrayLike | None = None, *,
                 closed: tuple[bool, bool] = (False, False)) -> None:
        p = points_array(points)
        if p.ndim != 3:
            raise InvalidError("points", f"have {p.ndim} axes; an array (n_u, n_v, D) is needed")
        self._c = _core.SurfaceHandle.make(_basis_tuples(p, degrees, knots, closed), p,
                                           None if weights is None else points_array(weights))

    @classmethod
    def from_homogeneous(cls, coefficients: ArrayLike, degrees: tuple[int, int] | None = None,
                         knots: tuple[ArrayLike, ArrayLike] | None = None, *,
                         closed: tuple[bool, bool] = (False, False)) -> Surface:
        """From weighted coefficients (w x, w)."""
        c = points_array(coefficients)
        return cls._of(_core.SurfaceHandle.from_homogeneous(_basis_tuples(c, degrees, knots, closed), c))

    @property
    def degrees(self) -> tuple[int, int]:
        return self._c.basis(0).degree, self._c.basis(1).degree

    @property
    def knots(self) -> tuple[Array, Array]:
        return self._c.basis(0).defining, self._c.basis(1).defining

    @property
    def domain(self) -> tuple[Interval, Interval]:
        return self._c.basis(0).domain, self._c.basis(1).domain

    @property
    def is_closed(self) -> tuple[bool, bool]:
        """Whether the bases are closed."""
        return self._c.basis(0).is_closed, self._c.basis(1).is_closed

    def __call__(self, u: ArrayLike, v: ArrayLike, nu: tuple[int, int] = (0, 0), *, outside: str = "refuse") -> Array:
        """Points (nu: partial derivatives of these orders) at parameters that are broadcast against each other."""
        order = sum(nu)
        if order == 0:
            return self._evaluate([u, v], None, outside)
        return self._evaluate([u, v], order, outside)[..., order * (order + 1) // 2 + nu[1], :]

    def evaluate(self, u: ArrayLike, v: ArrayLike, derivatives: int | None = None, *, outside: str = "refuse") -> Array:
        """Points, or with derivatives=k all partial derivatives to total order k in graded order:
        S; S_u, S_v; S_uu, S_uv, S_vv; .."""
        return self._evaluate([u, v], derivatives, outside)

    @from_header("spline/accurate:Accurate")
    def evaluate_accurate(self, u: ArrayLike, v: ArrayLike) -> tuple[Array, Array]:
        """Values to the last digit, and bounds of their errors."""
        return self._accurate([u, v])

    def grid(self, u: ArrayLike, v: ArrayLike, derivatives: int | None = None) -> Array:
        """Points on a tensor grid: shape (len(u), len(v), dimension)."""
        return self._grid([u, v], derivatives)

    def normal(self, u: ArrayLike, v: ArrayLike, *, outside: str = "refuse") -> Array:
        """Unit normals S_u x S_v; zero where that is zero."""
        normals: Array = _core.evaluate_normals(self._c, _broadcast(u, v), outside == "nan")[1]
        return normals

    def curvatures(self, u: ArrayLike, v: ArrayLike, *, outside: str = "refuse") -> Array:
        """Gaussian and mean curvature: shape (.., 2); estimates. With a bound: curvature_at."""
        return _core.evaluate_curvatures(self._c, _broadcast(u, v), outside == "nan")

    @from_header("query/surface_curvature:surface_curvature")
    def curvature_at(self, u: float, v: float) -> SurfaceCurvature:
        """Fundamental forms, normal and curvatures, each with a bound."""
        return _core.surface_curvature(self._c, (u, v))

    @from_header("query/surface_curvature:limit_normal")
    def limit_normal(self, u: float, v: float, direction: ArrayLike | None = None) -> LimitNormal:
        """The unit normal, also at poles."""
        return _core.limit_normal(self._c, (u, v), None if direction is None else points_array(direction))

    def partial(self, axis: int) -> Surface:
        """The partial derivative as a surface; refused of rational ones."""
        return _core.derivative(self._c, axis)  # type: ignore[no-any-return]

    @from_header("spline/patch:iso")
    def iso(self, axis: int, at: float) -> Curve:
        """The curve where parameter `axis` has a value."""
        return _core.iso(self._c, axis, at)  # type: ignore[no-any-return]

    def boundary(self, axis: int, side: int) -> Curve:
        """The side where parameter `axis` is at its lower (0) or upper (1) end."""
        return self.iso(axis, self.domain[axis][side])

    @from_header("intersect/section:section")
    def section(self, normal: ArrayLike, offset: float, tolerance: float, max_cells: int = 100_000) -> Section:
        """Where the surface meets the plane normal . x + offset = 0."""
        return _core.section(self._c, points_array(normal), offset, tolerance, max_cells)

    @from_header("query/surface_continuity:continuity")
    def continuity(self, axis: int, *, orders: int = 3, tolerance: float = 0.0, angle: float = 0.0,
                   curvature: float = 0.0, roundings: float = 4.0) -> list[LineContinuity]:
        """Every knot line of an axis, and the seam."""
        return _core.surface_continuity(self._c, axis, (orders, tolerance, angle, curvature, 0.0, roundings))

    @from_header("make/surface_joint:next_c")
    def next_c(self, axis: int, end: str, order: int, free: ArrayLike, on: IntervalLike = (0.0, 1.0)) -> Surface:
        """A neighbour that joins an edge ("start" or "end" of the axis) with C^order."""
        return _core.next_surface_c(self._c, axis, end, order, points_array(free), pair(on))

    @from_header("make/surface_joint:next_g")
    def next_g(self, axis: int, end: str, across: Sequence[Sequence[float]], free: ArrayLike,
               along: Sequence[Sequence[float]] = (), scale: Sequence[Sequence[float]] = (),
               on: IntervalLike = (0.0, 1.0)) -> Surface:
        """A neighbour that joins an edge with G^k."""
        return _core.next_surface_g(self._c, axis, end, [list(a) for a in across], [list(a) for a in along],
                                    [list(a) for a in scale], points_array(free), pair(on))

    def tessellate(self, tolerance: float, **options: Any) -> Mesh:
        """A triangle mesh within the tolerance; options as of Model.tessellate, which also has the report."""
        from ._models import Model
        return Model.assemble([self]).tessellate(tolerance, **options).mesh

    def _repr_html_(self) -> str | None:
        from ._notebook import html_of
        return html_of(self) if self.dimension in (2, 3) else None

    def _repr_png_(self) -> bytes | None:
        from ._notebook import png_of
        return png_of(self) if self.dimension in (2, 3) else None


@from_header("spline/patch:Patch")
class Volume(_Patch[_core.VolumeHandle]):
    """A polynomial or rational tensor product volume; points: (n_u, n_v, n_w, D)."""

    __slots__ = ()
    _parameters = 3

    def __init__(self, points: ArrayLike, degrees: tuple[int, int, int] | None = None,
                 knots: tuple[ArrayLike, ArrayLike, ArrayLike] | None = None, weights: ArrayLike | None = None, *,
                 closed: tuple[bool, bool, bool] = (False, False, False)) -> None:
        p = points_array(points)
        if p.ndim != 4:
            raise InvalidError("points", f"have {p.ndim} axes; an array (n_u, n_v, n_w, D) is needed")
        self._c = _core.VolumeHandle.make(_basis_tuples(p, degrees, knots, closed), p,
                                          None if weights is None else points_array(weights))

    @classmethod
    def from_homogeneous(cls, coefficients: ArrayLike, degrees: tuple[int, int, int] | None = None,
                         knots: tuple[ArrayLike, ArrayLike, ArrayLike] | None = None, *,
                         closed: tuple[bool, bool, bool] = (False, False, False)) -> Volume:
        """From weighted coefficients (w x, w)."""
        c = points_array(coefficients)
        return cls._of(_core.VolumeHandle.from_homogeneous(_basis_tuples(c, degrees, knots, closed), c))

    @property
    def degrees(self) -> tuple[int, int, int]:
        return self._c.basis(0).degree, self._c.basis(1).degree, self._c.basis(2).degree

    @property
    def knots(self) -> tuple[Array, Array, Array]:
        return self._c.basis(0).defining, self._c.basis(1).defining, self._c.basis(2).defining

    @property
    def domain(self) -> tuple[Interval, Interval, Interval]:
        return self._c.basis(0).domain, self._c.basis(1).domain, self._c.basis(2).domain

    def __call__(self, u: ArrayLike, v: ArrayLike, w: ArrayLike, *, outside: str = "refuse") -> Array:
        """Points at parameters that are broadcast against each other."""
        return self._evaluate([u, v, w], None, outside)

    def evaluate(self, u: ArrayLike, v: ArrayLike, w: ArrayLike, derivatives: int | None = None, *,
                 outside: str = "refuse") -> Array:
        """Points, or all partial derivatives to a total order in graded order."""
        return self._evaluate([u, v, w], derivatives, outside)

    def grid(self, u: ArrayLike, v: ArrayLike, w: ArrayLike, derivatives: int | None = None) -> Array:
        """Points on a tensor grid."""
        return self._grid([u, v, w], derivatives)

    @from_header("spline/patch:iso")
    def iso(self, axis: int, at: float) -> Surface:
        """The surface where parameter `axis` has a value."""
        return _core.iso(self._c, axis, at)  # type: ignore[no-any-return]

    def boundary(self, axis: int, side: int) -> Surface:
        """The face where parameter `axis` is at its lower (0) or upper (1) end."""
        return self.iso(axis, self.domain[axis][side])


AnyPatch = Union[Curve, Surface, Volume]


def _basis_tuples(points: Array, degrees: Sequence[int] | None, knots: Sequence[ArrayLike] | None,
                  closed: Sequence[bool]) -> list[BasisTuple]:
    count = points.ndim - 1
    for name, given in (("degrees", degrees), ("knots", knots), ("closed", closed)):
        if given is not None and len(given) != count:
            raise InvalidError(name, f"{len(given)} are given; {count} are needed")
    return [_basis_tuple(points.shape[d], None if degrees is None else degrees[d], None if knots is None else knots[d],
                         closed[d]) for d in range(count)]


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
        return self._c.at(np.asarray(t, dtype=np.float64))

    def parameter(self, length: ArrayLike) -> tuple[Array, Array]:
        """The inverse: (parameters, bounds in model units)."""
        return self._c.parameter(np.asarray(length, dtype=np.float64))

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
