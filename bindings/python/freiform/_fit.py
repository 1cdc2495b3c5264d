"""Interpolation and approximation."""
from __future__ import annotations

from typing import Sequence

from . import _core
from ._base import Array, ArrayLike, from_header, points_array, rows
from ._basis import Basis
from ._patches import Curve, Surface
from ._records import Fitted, FittedSurface, Interpolant

__all__ = ["parameters", "grid_parameters", "interpolate", "interpolate_grid", "interpolate_data", "averaged_basis",
           "least_squares", "least_squares_surface", "approximate", "cubic_through", "bicubic_through"]


@from_header("fit/parameters:parameters", "fit/parameters:Spacing")
def parameters(points: ArrayLike, spacing: str = "chordal", *, closed: bool = False) -> Array:
    """Parameters for points: uniform, chordal or centripetal."""
    return _core.parameters(rows(points), spacing, closed)


@from_header("fit/parameters:parameters")
def grid_parameters(points: ArrayLike, axis: int, spacing: str = "chordal", *, closed: bool = False) -> Array:
    """Parameters along one axis of a grid (n, m, D)."""
    return _core.grid_parameters(points_array(points), axis, spacing, closed)


@from_header("fit/interpolate:interpolate")
def interpolate(points: ArrayLike, degree: int = 3, ends: str = "natural", at: ArrayLike | None = None, *,
                spacing: str = "chordal", start: ArrayLike | None = None, end: ArrayLike | None = None) -> Interpolant:
    """The spline through points; ends: natural, clamped (start, end: derivatives), not_a_knot, periodic.

    Without `at` the parameters are those of `spacing`.
    """
    p = rows(points)
    t = parameters(p, spacing, closed=ends == "periodic") if at is None else points_array(at)
    return _core.interpolate(p, degree, ends, t, None if start is None else points_array(start).reshape(-1, p.shape[-1]),
                             None if end is None else points_array(end).reshape(-1, p.shape[-1]))


@from_header("fit/interpolate:interpolate")
def interpolate_grid(points: ArrayLike, degree: int | Sequence[int] = 3, ends: str | Sequence[str] = "natural",
                     at: Sequence[ArrayLike] | None = None, *, spacing: str = "chordal") -> Interpolant:
    """The surface (volume) through a grid of points (n, m, D); degree and ends for all axes or for each."""
    p = points_array(points)
    n = p.ndim - 1
    degrees = [degree] * n if isinstance(degree, int) else list(degree)
    kinds = [ends] * n if isinstance(ends, str) else list(ends)
    given = [grid_parameters(p, d, spacing, closed=kinds[d] == "periodic") for d in range(n)] if at is None else \
        [points_array(a) for a in at]
    return _core.interpolate_grid(p, list(zip(degrees, kinds, given)))


@from_header("fit/interpolate:Datum", "fit/interpolate:interpolate")
def interpolate_data(basis: Basis, at: ArrayLike, values: ArrayLike, orders: Sequence[int] | None = None) -> Interpolant:
    """The spline on a basis with values (order 0) and derivatives at parameters."""
    v = points_array(values)
    return _core.interpolate_data(basis._c, points_array(at), [0] * len(v) if orders is None else list(orders), v)


@from_header("fit/interpolate:averaged_basis")
def averaged_basis(degree: int, sites: ArrayLike) -> Basis:
    """Knots for data at these sites."""
    return _core.averaged_basis(degree, points_array(sites))


@from_header("fit/least_squares:least_squares")
def least_squares(basis: Basis, points: ArrayLike, at: ArrayLike, *, weights: ArrayLike | None = None,
                  smoothing: float = 0.0, smoothing_order: int = 2) -> Fitted:
    """The curve on given knots that comes closest to points."""
    return _core.least_squares(basis._c, rows(points), points_array(at),
                               None if weights is None else points_array(weights), smoothing, smoothing_order)


@from_header("fit/least_squares:least_squares")
def least_squares_surface(bases: tuple[Basis, Basis], points: ArrayLike, at: tuple[ArrayLike, ArrayLike]) -> FittedSurface:
    """The surface on given knots that comes closest to a grid of points."""
    return _core.least_squares_surface(bases[0]._c, bases[1]._c, points_array(points), points_array(at[0]),
                                       points_array(at[1]))


@from_header("fit/approximate:approximate", "fit/approximate:ApproximateOptions")
def approximate(points: ArrayLike, tolerance: float, degree: int = 3, *, closed: bool = False, spacing: str = "chordal",
                move_parameters: bool = True, smoothing: float = 0.0, smoothing_order: int = 2) -> Fitted:
    """The smallest curve found within a distance of points."""
    return _core.approximate(rows(points), tolerance, degree, closed, spacing, move_parameters, smoothing,
                             smoothing_order)


@from_header("fit/local:LocalSlopes")
def cubic_through(points: ArrayLike, at: ArrayLike | None = None, slopes: str = "catmull_rom", *,
                  closed: bool = False) -> Curve:
    """Cubic pieces through points, from neighbours only: catmull_rom, akima, monotone or fritsch_carlson."""
    p = rows(points)
    t = parameters(p, closed=closed) if at is None else points_array(at)
    return _core.cubic_through(p, t, slopes, closed)


@from_header("fit/bicubic:bicubic_through", "fit/bicubic:Twists")
def bicubic_through(points: ArrayLike, u: ArrayLike, v: ArrayLike, *, closed: tuple[bool, bool] = (False, False),
                    twists: str = "tensor") -> Surface:
    """Bicubic patches through a grid of points; twists: tensor, zero, adini or bessel."""
    return _core.bicubic_through(points_array(points), points_array(u), points_array(v), list(closed), twists)
