"""Triangular patches."""
from __future__ import annotations

from typing import Any, Sequence

import numpy as np

from . import _core
from ._base import Array, ArrayLike, from_header, numbers, points_array, same
from ._patches import Curve, Surface
from ._records import (Deviation, JoinedTriangle, Parts, PointNormalTriangle, ReducedTriangle, SurfaceCurvature, TightBox,
                       TriangleJoint)

__all__ = ["TriangularPatch", "point_normal_triangle"]

Pair = tuple[float, float]


@from_header("spline/simplex:SimplexPatch")
class TriangularPatch:
    """A polynomial or rational triangular Bezier patch: (n + 1)(n + 2) / 2 points, b_n00 first, b_00n last."""

    __slots__ = ("_c",)
    _c: _core.TriangleHandle

    def __init__(self, points: ArrayLike, degree: int | None = None, weights: ArrayLike | None = None) -> None:
        p = points_array(points)
        n = int((np.sqrt(8 * len(p) + 1) - 3) / 2 + 0.5) if degree is None else degree
        self._c = _core.TriangleHandle.make(n, p, None if weights is None else points_array(weights).ravel())

    @classmethod
    def _of(cls, handle: _core.TriangleHandle) -> TriangularPatch:
        made = object.__new__(cls)
        made._c = handle
        return made

    @classmethod
    def from_homogeneous(cls, coefficients: ArrayLike, degree: int) -> TriangularPatch:
        """From weighted coefficients (w x, w)."""
        return cls._of(_core.TriangleHandle.from_homogeneous(degree, points_array(coefficients)))

    @property
    def degree(self) -> int:
        return self._c.degree

    @property
    def is_rational(self) -> bool:
        return self._c.is_rational

    @property
    def coefficients(self) -> Array:
        """What is stored: points, or (w x, w)."""
        return self._c.coefficients()

    @property
    def points(self) -> Array:
        c = self.coefficients
        points: Array = c[:, :-1] / c[:, -1:] if self.is_rational else c
        return points

    @property
    def weights(self) -> Array | None:
        return self.coefficients[:, -1].copy() if self.is_rational else None

    @property
    def dimension(self) -> int:
        return self.coefficients.shape[1] - int(self.is_rational)

    def value_error_bound(self) -> float:
        return self._c.value_error_bound()

    def evaluate(self, u: ArrayLike, v: ArrayLike, derivatives: int | None = None) -> Array:
        """Points, or all partial derivatives by u and v to a total order in graded order."""
        a, b = np.broadcast_arrays(numbers(u, "parameters"), numbers(v, "parameters"))
        at = np.stack([a.ravel(), b.ravel()], axis=-1)
        values: Array = _core.triangle_evaluate(self._c, at, derivatives or 0)
        if derivatives == 0:
            values = values[:, None, :]
        return values.reshape(a.shape + values.shape[1:])

    def __call__(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Points at (1 - u - v, u, v), broadcast."""
        return self.evaluate(u, v)

    @from_header("spline/simplex:normal")
    def normal(self, u: float, v: float) -> Array:
        return _core.triangle_normal(self._c, (u, v))

    @from_header("query/surface_curvature:surface_curvature")
    def curvature_at(self, u: float, v: float) -> SurfaceCurvature:
        return _core.triangle_curvature(self._c, (u, v))

    @from_header("spline/simplex_construction:derivative")
    def directional(self, u: float, v: float, directions: ArrayLike) -> Array:
        """The derivative in all these directions, one after the other."""
        return _core.triangle_directional(self._c, (u, v), points_array(directions))

    def construction(self, u: float, v: float) -> list[Array]:
        """de Casteljau's nets, level after level."""
        levels: list[Array] = _core.triangle_construction(self._c, (u, v))[0]
        return levels

    @from_header("spline/simplex_construction:blossom")
    def blossom(self, arguments: ArrayLike) -> Array:
        """The polar form at as many (u, v) as the degree says: a coefficient (of rational patches a weighted one)."""
        return _core.triangle_blossom(self._c, points_array(arguments))

    @from_header("spline/simplex:elevate")
    def elevate(self) -> TriangularPatch:
        return _core.triangle_elevate(self._c)

    @from_header("spline/simplex_convert:reduce_degree")
    def reduce_degree(self, tolerance: float) -> ReducedTriangle:
        return _core.triangle_reduce_degree(self._c, tolerance)

    @from_header("spline/simplex:restrict_to")
    def restrict_to(self, corners: Sequence[Pair]) -> TriangularPatch:
        return _core.triangle_restrict_to(self._c, list(corners))

    @from_header("spline/simplex:split_at")
    def split_at(self, u: float, v: float) -> tuple[TriangularPatch, ...]:
        return _core.triangle_split_at(self._c, (u, v))

    @from_header("spline/simplex:split_in_four")
    def split_in_four(self) -> tuple[TriangularPatch, ...]:
        return _core.triangle_split_in_four(self._c)

    @from_header("spline/simplex_convert:split_edge")
    def split_edge(self, edge: int, at: float) -> tuple[TriangularPatch, ...]:
        return _core.triangle_split_edge(self._c, edge, at)

    @from_header("spline/simplex:boundary")
    def boundary(self, edge: int) -> Curve:
        return _core.triangle_boundary(self._c, edge)

    @from_header("spline/simplex_convert:reversed")
    def reverse(self) -> TriangularPatch:
        return _core.triangle_reversed(self._c)

    @from_header("spline/simplex_convert:to_surface")
    def to_surface(self) -> Parts:
        return _core.triangle_to_surface(self._c)

    @from_header("spline/simplex_convert:to_three_surfaces")
    def to_three_surfaces(self, centre: Pair = (1 / 3, 1 / 3)) -> Parts:
        return _core.triangle_to_three_surfaces(self._c, centre)

    @staticmethod
    @from_header("spline/simplex_convert:to_triangles")
    def from_surface(surface: Surface) -> Parts:
        """A Bezier patch as two triangles."""
        return _core.surface_to_triangles(surface._c)

    @from_header("query/bounds:tight_box")
    def bounds(self, accuracy: float = 0.0, max_pieces: int = 20000) -> TightBox:
        return _core.triangle_tight_box(self._c, accuracy, max_pieces)

    @from_header("make/triangle_joint:next_c")
    def next_c(self, edge: int, order: int, apex: Pair, free: ArrayLike = ()) -> JoinedTriangle:
        return _core.triangle_next_c(self._c, edge, order, apex, points_array(free))

    @from_header("make/triangle_joint:next_g1")
    def next_g1(self, edge: int, free: ArrayLike, lambda_: Pair = (1.0, 1.0), gamma: Pair = (0.0, 0.0)) -> TriangularPatch:
        return _core.triangle_next_g1(self._c, edge, lambda_, gamma, points_array(free))

    @from_header("query/triangle_joint:triangle_joint")
    def joint(self, edge: int, other: TriangularPatch, other_edge: int) -> TriangleJoint:
        return _core.triangle_joint(self._c, edge, other._c, other_edge)

    @from_header("query/triangle_joint:c1_deviation")
    def c1_deviation(self, edge: int, other: TriangularPatch, other_edge: int, apex: Pair) -> Deviation:
        return _core.c1_deviation(self._c, edge, other._c, other_edge, apex)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TriangularPatch) and self._c.equals(other._c)

    def __hash__(self) -> int:
        return hash((self.degree, self.is_rational, self.coefficients.tobytes()))

    def __repr__(self) -> str:
        if not self.is_rational:
            return f"TriangularPatch({self.points.tolist()!r}, {self.degree})"
        p, w = self.points, self.coefficients[:, -1]
        if same(np.concatenate([p * w[:, None], w[:, None]], axis=-1), self.coefficients):
            return f"TriangularPatch({p.tolist()!r}, {self.degree}, weights={w.tolist()!r})"
        return f"TriangularPatch.from_homogeneous({self.coefficients.tolist()!r}, {self.degree})"

    def _repr_html_(self) -> str | None:
        from ._notebook import html_of
        return html_of(self) if self.dimension == 3 else None

    def _repr_png_(self) -> bytes | None:
        from ._notebook import png_of
        return png_of(self) if self.dimension == 3 else None

    def __reduce__(self) -> tuple[Any, ...]:
        if self.is_rational:
            return TriangularPatch.from_homogeneous, (self.coefficients, self.degree)
        return TriangularPatch, (self.points, self.degree)

    def __copy__(self) -> TriangularPatch:
        return self

    def __deepcopy__(self, memo: object) -> TriangularPatch:
        return self


@from_header("make/triangle_joint:point_normal_triangle", "make/triangle_joint:PointNormalTriangle")
def point_normal_triangle(points: ArrayLike, normals: ArrayLike) -> PointNormalTriangle:
    """A curved triangle through three points with normals."""
    return _core.point_normal_triangle(points_array(points), points_array(normals))
