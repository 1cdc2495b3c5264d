"""Surfaces and volumes."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Sequence

from . import _core
from ._base import Array, ArrayLike, Interval, IntervalLike, from_header, pair, points_array
from ._curves import Curve
from ._patch import _basis_tuples, _broadcast, _Patch
from ._records import FoundSphere, LimitNormal, LineContinuity, Section, SurfaceCurvature
from ._refusals import InvalidError

if TYPE_CHECKING:
    from ._meshes import Mesh

__all__ = ["Surface", "Volume"]


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
        return self._basis(0).degree, self._basis(1).degree

    @property
    def knots(self) -> tuple[Array, Array]:
        return self._basis(0).defining, self._basis(1).defining

    @property
    def domain(self) -> tuple[Interval, Interval]:
        return self._basis(0).domain, self._basis(1).domain

    @property
    def is_closed(self) -> tuple[bool, bool]:
        """Whether the bases are closed."""
        return self._basis(0).is_closed, self._basis(1).is_closed

    def __call__(self, u: ArrayLike, v: ArrayLike, nu: tuple[int, int] = (0, 0), *, outside: str = "refuse") -> Array:
        """Points (nu: partial derivatives of these orders) at parameters that are broadcast against each other."""
        order = sum(nu)
        if order == 0:
            return self._evaluate([u, v], None, outside)
        return self._evaluate([u, v], order, outside)[..., order * (order + 1) // 2 + nu[1], :]

    def evaluate(self, u: ArrayLike, v: ArrayLike, derivatives: int | None = None, *, outside: str = "refuse",
                 out: Array | None = None) -> Array:
        """Points, or with derivatives=k all partial derivatives to total order k in graded order:
        S; S_u, S_v; S_uu, S_uv, S_vv; .. (out: as Curve.evaluate has it)"""
        return self._evaluate([u, v], derivatives, outside, out)

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

    @from_header("query/sphere_of:sphere_of")
    def sphere(self, tolerance: float) -> FoundSphere | None:
        """The sphere that the surface lies on within the tolerance, with a proven distance; None for others."""
        return _core.sphere_of(self._c, tolerance)

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
        return self._basis(0).degree, self._basis(1).degree, self._basis(2).degree

    @property
    def knots(self) -> tuple[Array, Array, Array]:
        return self._basis(0).defining, self._basis(1).defining, self._basis(2).defining

    @property
    def domain(self) -> tuple[Interval, Interval, Interval]:
        return self._basis(0).domain, self._basis(1).domain, self._basis(2).domain

    def __call__(self, u: ArrayLike, v: ArrayLike, w: ArrayLike, *, outside: str = "refuse") -> Array:
        """Points at parameters that are broadcast against each other."""
        return self._evaluate([u, v, w], None, outside)

    def evaluate(self, u: ArrayLike, v: ArrayLike, w: ArrayLike, derivatives: int | None = None, *,
                 outside: str = "refuse", out: Array | None = None) -> Array:
        """Points, or all partial derivatives to a total order in graded order (out: as Curve.evaluate has it)."""
        return self._evaluate([u, v, w], derivatives, outside, out)

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
