"""What curves, surfaces and volumes have in common."""
from __future__ import annotations

from typing import Any, Generic, Sequence, TypeVar

import numpy as np

from . import _core
from ._base import Array, ArrayLike, IntervalLike, from_header, numbers, pair, points_array, same
from ._basis import Basis
from ._records import Extended, Extent, KnotLine, Reduced, TightBox, Transformed
from ._refusals import InvalidError

P = TypeVar("P", bound="_Patch[Any]")
H = TypeVar("H", _core.CurveHandle, _core.SurfaceHandle, _core.VolumeHandle)
BasisTuple = tuple[int, Array, bool]


def _basis_tuple(size: int, degree: int | None, knots: ArrayLike | None, closed: bool) -> BasisTuple:
    """(degree, knots, closed) where some of it is left out: a Bezier patch, or clamped and uniform knots."""
    if degree is not None and not isinstance(degree, (int, np.integer)):
        raise InvalidError("degree", f"{degree!r} is no integer")
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
    arrays = [numbers(p, "parameters") for p in parameters]
    try:
        return list(np.broadcast_arrays(*arrays)) if len(arrays) > 1 else arrays
    except ValueError:
        shapes = ", ".join(str(a.shape) for a in arrays)
        raise InvalidError("parameters", f"the shapes {shapes} cannot be broadcast against each other") from None


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

    def _basis(self, axis: int) -> _core.BasisHandle:
        handle: _core.BasisHandle = self._c.basis(axis)
        return handle

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
        return tuple(Basis._of(self._basis(d)) for d in range(self._parameters))

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

    def _evaluate(self, parameters: Sequence[ArrayLike], derivatives: int | None, outside: str,
                  out: Array | None = None) -> Array:
        if outside not in ("refuse", "nan"):
            raise InvalidError("outside", f'"{outside}" is not "refuse" or "nan"')
        at = _broadcast(*parameters)
        if out is not None and any(np.may_share_memory(out, a) for a in at):
            raise InvalidError("out", "shares memory with the parameters")
        into = out if derivatives != 0 or out is None else out[..., 0, :]
        values: Array = _core.evaluate(self._c, at, derivatives or 0, outside == "nan", into)
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
    handle: Any = {1: _core.CurveHandle, 2: _core.SurfaceHandle, 3: _core.VolumeHandle}[cls._parameters]
    return cls._of(handle.from_homogeneous(bases, coefficients) if rational else handle.make(bases, coefficients, None))


def _basis_tuples(points: Array, degrees: Sequence[int] | None, knots: Sequence[ArrayLike] | None,
                  closed: Sequence[bool]) -> list[BasisTuple]:
    count = points.ndim - 1
    for name, given in (("degrees", degrees), ("knots", knots), ("closed", closed)):
        if given is not None and len(given) != count:
            raise InvalidError(name, f"{len(given)} are given; {count} are needed")
    return [_basis_tuple(points.shape[d], None if degrees is None else degrees[d], None if knots is None else knots[d],
                         closed[d]) for d in range(count)]
