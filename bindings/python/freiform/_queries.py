"""Nearest points, distances, hulls, intersections, joints."""
from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any, Sequence, Union, overload

import numpy as np

from . import _core
from ._base import Array, ArrayLike, IntervalLike, Record, from_header, handles, pair, points_array
from ._patches import AnyPatch, Curve, Surface
from ._records import (ConvexHull, CurveJoint, FoundSphere, Intersections, LeastDistance, NearestFeet,
                       NearRegions, OrientedBox, SurfaceContinuity, SurfaceIntersection, SurfaceJoint)
from ._refusals import InvalidError, UnsupportedError
from ._triangles import TriangularPatch

__all__ = ["NearestQuery", "NearestPoints", "FarthestPoints", "nearest", "farthest", "least_distance", "convex_hull",
           "oriented_box", "sphere_through", "hull_of_points", "intersect", "intersect_all", "intersect_lines",
           "joints", "surface_joint"]

NearObject = Union[AnyPatch, TriangularPatch]


@dataclass(frozen=True, eq=False, repr=False)
class NearestPoints(Record):
    """The nearest points of objects, one for each of the points asked for: every field is an array.

    No point of any object is nearer than ``lower_bound``; the true distance lies in
    [lower_bound, distance + point_error]. ``at``: the parameters, of which a curve has one.
    """

    object: Array
    at: Array
    point: Array
    distance: Array
    point_error: Array
    lower_bound: Array


@dataclass(frozen=True, eq=False, repr=False)
class FarthestPoints(Record):
    """The farthest points of objects: no point of any object is farther than ``upper_bound``."""

    object: Array
    at: Array
    point: Array
    distance: Array
    point_error: Array
    upper_bound: Array


@from_header("query/nearest:NearestQuery")
class NearestQuery:
    """Objects prepared for questions about nearest points. Answers are proven."""

    __slots__ = ("_c", "objects")

    def __init__(self, *objects: NearObject) -> None:
        self.objects = objects
        self._c = _core.NearestHandle(handles(objects, "objects"))

    @from_header("query/nearest:nearest")
    def nearest(self, points: ArrayLike, accuracy: float = 0.0, max_parts: int = 20000) -> NearestPoints:
        """For points of shape (.., D): arrays of shape (..)."""
        return NearestPoints(*self._c.nearest(points_array(points), accuracy, max_parts))

    @from_header("query/nearest:farthest")
    def farthest(self, points: ArrayLike, accuracy: float = 0.0, max_parts: int = 20000) -> FarthestPoints:
        return FarthestPoints(*self._c.farthest(points_array(points), accuracy, max_parts))

    @from_header("query/nearest:feet")
    def feet(self, point: ArrayLike, count: int, accuracy: float = 0.0, max_parts: int = 20000) -> NearestFeet:
        return self._c.feet(points_array(point), count, accuracy, max_parts)

    @from_header("query/nearest:within")
    def within(self, point: ArrayLike, radius: float, finest: float = 2.0**-5, max_parts: int = 20000) -> NearRegions:
        return self._c.within(points_array(point), radius, finest, max_parts)

    @from_header("query/distance:least_distance")
    def least_distance(self, other: NearestQuery, accuracy: float = 0.0, max_pairs: int = 200_000) -> LeastDistance:
        return self._c.least_distance(other._c, accuracy, max_pairs)

    @from_header("query/hull:convex_hull", "query/hull:ConvexHull")
    def convex_hull(self, tolerance: float, max_parts: int = 20000) -> ConvexHull:
        return self._c.convex_hull(tolerance, max_parts)

    @from_header("query/oriented_box:oriented_box", "query/oriented_box:OrientedBox")
    def oriented_box(self, accuracy: float, max_parts: int = 20000) -> OrientedBox:
        return self._c.oriented_box(accuracy, max_parts)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, NearestQuery) and self.objects == other.objects

    def __hash__(self) -> int:
        return hash(("NearestQuery", self.objects))

    def __repr__(self) -> str:
        return f"NearestQuery({', '.join(map(repr, self.objects))})"

    def __reduce__(self) -> tuple[Any, ...]:
        return NearestQuery, self.objects


def nearest(object: NearObject | Sequence[NearObject], points: ArrayLike, accuracy: float = 0.0) -> NearestPoints:
    """The nearest points of one object, or of all of several; for many questions: NearestQuery."""
    return NearestQuery(*_several(object)).nearest(points, accuracy)


def farthest(object: NearObject | Sequence[NearObject], points: ArrayLike, accuracy: float = 0.0) -> FarthestPoints:
    """The farthest points of one object, or of all of several."""
    return NearestQuery(*_several(object)).farthest(points, accuracy)


def _several(object: NearObject | Sequence[NearObject]) -> Sequence[NearObject]:
    if hasattr(object, "vertices") and hasattr(object, "edges"):
        raise InvalidError("object", "is a model: it answers Model.nearest, or ModelNearestQuery for many questions")
    return object if isinstance(object, (list, tuple)) else [object]  # type: ignore[list-item]


def least_distance(a: NearObject, b: NearObject, accuracy: float = 0.0) -> LeastDistance:
    """The least distance between two objects, with a lower bound."""
    return NearestQuery(a).least_distance(NearestQuery(b), accuracy)


def convex_hull(object: NearObject, tolerance: float) -> ConvexHull:
    """A polygon or polyhedron that contains an object."""
    return NearestQuery(object).convex_hull(tolerance)


def oriented_box(object: NearObject, accuracy: float) -> OrientedBox:
    """A small box in any orientation."""
    return NearestQuery(object).oriented_box(accuracy)


@from_header("query/sphere_of:sphere_through")
def sphere_through(points: ArrayLike) -> FoundSphere | None:
    """The sphere nearest to points of shape (n, 3) by least squares; None for points in a plane."""
    return _core.sphere_through(points_array(points))


@from_header("query/hull:convex_hull", "query/hull:hull_triangles")
def hull_of_points(points: ArrayLike) -> list[Any] | Array:
    """Indices of the corners of the convex hull (in the plane), or its triangles (in space); exact."""
    return _core.convex_hull_of_points(points_array(points))


@overload
def intersect(a: Curve, b: Curve | Surface, accuracy: float = 0.0, *, max_parts: int | None = None) -> Intersections: ...
@overload
def intersect(a: Surface, b: Surface, accuracy: float = 0.0, *, tolerance: float = 0.0,
              max_parts: int | None = None) -> SurfaceIntersection: ...
@from_header("intersect/curve_curve:intersect", "intersect/curve_surface:intersect", "intersect/surface_surface:intersect")
def intersect(a: Curve | Surface, b: Curve | Surface, accuracy: float = 0.0, *, tolerance: float = 0.0,
              max_parts: int | None = None) -> Intersections | SurfaceIntersection:
    """Where two curves, a curve and a surface, or two surfaces (tolerance: a distance > 0) meet: every place."""
    if isinstance(a, Surface) and isinstance(b, Surface):
        return _core.intersect_surfaces(a._c, b._c, tolerance or accuracy, max_parts or 2_000_000)
    if isinstance(a, Curve) and isinstance(b, Curve):
        return _core.intersect_curves(a._c, b._c, accuracy, max_parts or 50_000)
    if isinstance(a, Curve) and isinstance(b, Surface):
        return _core.intersect_curve_surface(a._c, b._c, accuracy, max_parts or 50_000)
    if isinstance(a, Surface) and isinstance(b, Curve):
        raise UnsupportedError("a", "give the curve first, then the surface")
    raise InvalidError("a, b", f"{type(a).__name__} and {type(b).__name__} are not two curves or surfaces; models answer "
                       "Model.intersect, Model.intersect_curve")


@from_header("intersect/curve_curve:IntersectCurve")
def intersect_all(a: Sequence[Curve], b: Sequence[Curve], accuracy: float = 0.0,
                  max_parts: int = 50_000) -> list[list[Intersections]]:
    """Every curve of `a` with every one of `b`, on all threads."""
    return _core.intersect_all_curves(handles(a, "a"), handles(b, "b"), accuracy, max_parts)


@from_header("intersect/curve_surface:IntersectSurface")
def intersect_lines(surface: Surface, points: ArrayLike, directions: ArrayLike, on: IntervalLike = (-inf, inf),
                    accuracy: float = 0.0, max_parts: int = 50_000) -> list[Intersections]:
    """Lines, rays (on = (0, inf)) or segments point + t direction with a surface, on all threads."""
    p, d = np.broadcast_arrays(np.atleast_2d(points_array(points)), np.atleast_2d(points_array(directions)))
    return _core.intersect_lines(surface._c, points_array(p), points_array(d), pair(on), accuracy, max_parts)


@from_header("query/continuity:joints", "query/surface_continuity:joints")
def joints(patches: Sequence[Curve] | Sequence[Surface], gap: float, *, orders: int = 3, tolerance: float = 0.0,
           angle: float = 0.0, curvature: float = 0.0, third: float = 0.0,
           roundings: float = 4.0) -> list[CurveJoint] | list[SurfaceJoint]:
    """All ends of curves (edges of surfaces) that meet, with the continuity of each joint."""
    options = (orders, tolerance, angle, curvature, third, roundings)
    if patches and isinstance(patches[0], Surface):
        return _core.surface_joints(handles(patches, "patches"), gap, options)
    return _core.joints(handles(patches, "patches"), gap, options)


@from_header("query/surface_continuity:joint")
def surface_joint(first: Surface, edge: tuple[int, str], second: Surface, second_edge: tuple[int, str], *,
                  against: bool = False, orders: int = 3, tolerance: float = 0.0, angle: float = 0.0,
                  curvature: float = 0.0, roundings: float = 4.0) -> SurfaceContinuity:
    """How two edges meet; edges: (axis, "start" or "end")."""
    return _core.surface_joint(first._c, edge[0], edge[1], second._c, second_edge[0], second_edge[1], against,
                               (orders, tolerance, angle, curvature, 0.0, roundings))
