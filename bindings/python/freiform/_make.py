"""Construction: conics, curves of the named schemes, swept and blended surfaces, quadrics."""
from __future__ import annotations

from math import pi, tau
from typing import NamedTuple, Sequence

import numpy as np

from . import _core
from ._base import Array, ArrayLike, IntervalLike, from_header, handles, pair, plain, points_array, same, vector
from ._basis import PolynomialBasis
from ._patches import Curve, Surface
from ._records import (Compatible, ConicArc, ConicForm, CoonsPatch, FivePointArc, FoundConic, FoundEquation, FrameSweep,
                       GordonSurface, Graph, Loft, MadeSurface, PolynomialCurve, PolynomialPatch, Reduced,
                       RevolvedPolynomial, RoundSurface, SphereInEight, SphereInSix)
from ._refusals import InvalidError

__all__ = ["Frame", "conic_arc", "full_ellipse", "circle", "circle_conic", "arc_through", "weighted_arc", "tangent_arc",
           "five_point_arc", "conic_through", "conic_equation", "classify_conic", "solve_conic", "conic_arcs_inside", "graph",
           "hermite", "hermite_spline", "catmull_rom", "cardinal", "kochanek_bartels", "uniform_b_spline", "from_basis",
           "interpolating_polynomial", "from_bases", "bicubic", "revolve", "revolve_polynomial", "extrude", "ruled",
           "offset_spline", "translate_along", "sweep", "loft", "coons", "coons_bicubic", "gordon", "frame_about", "sphere", "cylinder",
           "cone", "torus", "sphere_in_six", "sphere_in_eight", "rejoined", "compatible", "join_pieces", "de_boor_points"]

QUARTER = pi / 2


@from_header("make/conic:conic_arc")
def conic_arc(centre: ArrayLike, x: ArrayLike, y: ArrayLike, on: IntervalLike, kind: str = "ellipse",
              widest: float = QUARTER) -> ConicArc:
    """The part of a conic (ellipse, hyperbola, parabola) over parameters, as a rational spline."""
    return _core.conic_arc(kind, points_array(centre), points_array(x), points_array(y), pair(on), widest)


@from_header("make/conic:full_ellipse", "make/conic:EllipseForm")
def full_ellipse(centre: ArrayLike, x: ArrayLike, y: ArrayLike, form: str = "closed") -> ConicArc:
    """centre + cos(t) x + sin(t) y: open, closed or quintic."""
    return _core.full_ellipse(points_array(centre), points_array(x), points_array(y), form)


def circle(centre: ArrayLike, radius: float, form: str = "closed") -> ConicArc:
    """A whole circle of the plane, counter-clockwise from (radius, 0) on."""
    c = points_array(centre)
    if c.shape != (2,):
        raise InvalidError("centre", f"has the shape {c.shape} and not two coordinates; in space: circle_conic, full_ellipse")
    return full_ellipse(c, (radius, 0.0), (0.0, radius), form)


@from_header("make/conic:circle")
def circle_conic(centre: ArrayLike, radius: float, normal: ArrayLike | None = None) -> FoundConic:
    """The analytic circle of the plane, or in space about a normal."""
    return _core.circle_of(points_array(centre), radius, None if normal is None else points_array(normal))


@from_header("make/conic:arc_through")
def arc_through(a: ArrayLike, b: ArrayLike, c: ArrayLike, widest: float = QUARTER) -> ConicArc:
    """The circular arc from a through b to c."""
    return _core.arc_through(points_array(a), points_array(b), points_array(c), widest)


@from_header("make/conic:weighted_arc")
def weighted_arc(a: ArrayLike, corner: ArrayLike, c: ArrayLike, weight: float) -> ConicArc:
    """The conic with weights 1, weight, 1."""
    return _core.weighted_arc(points_array(a), points_array(corner), points_array(c), weight)


@from_header("make/conic:tangent_arc")
def tangent_arc(a: ArrayLike, at_a: ArrayLike, c: ArrayLike, at_c: ArrayLike, through: ArrayLike) -> ConicArc:
    """The conic arc with given directions at its ends through a point."""
    return _core.tangent_arc(points_array(a), points_array(at_a), points_array(c), points_array(at_c),
                             points_array(through))


@from_header("make/conic_equation:arc_through", "make/conic_equation:FivePointArc")
def five_point_arc(points: ArrayLike) -> FivePointArc:
    """The arc of a conic through five points."""
    return _core.five_point_arc(points_array(points))


@from_header("make/conic_equation:equation_through")
def conic_through(points: ArrayLike) -> FoundEquation:
    """The equation of the conic through five points."""
    return _core.equation_through(points_array(points))


@from_header("make/conic_equation:equation_of")
def conic_equation(centre: ArrayLike, x: ArrayLike, y: ArrayLike, kind: str = "ellipse") -> FoundEquation:
    """The equation of an analytic conic."""
    return _core.equation_of(kind, points_array(centre), points_array(x), points_array(y))


def _six(c: Sequence[float]) -> list[float]:
    return [float(x) for x in c]


@from_header("make/conic_equation:classify")
def classify_conic(c: Sequence[float], origin: Sequence[float] = (0.0, 0.0)) -> str:
    """The kind of c0 x^2 + c1 x y + c2 y^2 + c3 x + c4 y + c5 = 0, exactly."""
    return _core.classify_conic(_six(c), _six(origin))


@from_header("make/conic_equation:solve")
def solve_conic(c: Sequence[float], origin: Sequence[float] = (0.0, 0.0)) -> ConicForm:
    """Centre and axes, lines or points of an equation."""
    return _core.solve_conic(_six(c), _six(origin))


@from_header("make/conic_equation:arcs_inside")
def conic_arcs_inside(c: Sequence[float], lo: ArrayLike, hi: ArrayLike,
                      origin: Sequence[float] = (0.0, 0.0)) -> list[ConicArc]:
    """The parts of a conic inside a box."""
    return _core.arcs_inside(_six(c), _six(origin), points_array(lo), points_array(hi))


@from_header("make/graph:graph")
def graph(coefficients: ArrayLike, on: IntervalLike) -> Graph:
    """The graph of a[0] + a[1] x + .. as a curve."""
    return _core.graph(points_array(coefficients), pair(on))


def hermite(p1: ArrayLike, p4: ArrayLike, r1: ArrayLike, r4: ArrayLike) -> Curve:
    """The cubic on [0, 1] from p1 to p4 with the derivatives r1 and r4 there."""
    return hermite_spline(np.array([p1, p4], dtype=float), np.array([r1, r4], dtype=float))


@from_header("make/named_curve:hermite_spline")
def hermite_spline(points: ArrayLike, tangents: ArrayLike, parameters: ArrayLike | None = None,
                   leaving: ArrayLike | None = None) -> Curve:
    """Cubics through points with given derivatives."""
    return _core.hermite_spline(points_array(points), points_array(tangents),
                                None if parameters is None else points_array(parameters),
                                None if leaving is None else points_array(leaving))


@from_header("make/named_curve:Ring")
def catmull_rom(points: ArrayLike, *, closed: bool = False) -> Curve:
    """The uniform spline of Catmull and Rom."""
    return _core.catmull_rom_spline(points_array(points), closed)


def cardinal(points: ArrayLike, tension: float, *, closed: bool = False) -> Curve:
    """Tangents (1 - tension) / 2 (P[i+1] - P[i-1])."""
    return _core.cardinal(points_array(points), tension, closed)


@from_header("basis/named:TensionContinuityBias")
def kochanek_bartels(points: ArrayLike, settings: Sequence[tuple[float, float, float]], *, closed: bool = False) -> Curve:
    """(tension, continuity, bias) for every point, or one for all."""
    return _core.kochanek_bartels(points_array(points), [tuple(s) for s in settings], closed)


@from_header("make/named_curve:uniform_b_spline")
def uniform_b_spline(points: ArrayLike, degree: int = 3, *, closed: bool = False) -> Curve:
    """The uniform B-spline with these control points."""
    return _core.uniform_b_spline(points_array(points), degree, closed)


@from_header("make/named_curve:from_basis", "make/named_curve:PolynomialCurve")
def from_basis(basis: PolynomialBasis, coefficients: ArrayLike, on: IntervalLike = (0.0, 1.0)) -> PolynomialCurve:
    """The polynomial with these coefficients as a Bezier curve."""
    return _core.from_basis(basis._c, points_array(coefficients), pair(on))


@from_header("make/named_curve:interpolating_polynomial")
def interpolating_polynomial(points: ArrayLike, nodes: ArrayLike) -> PolynomialCurve:
    """The polynomial of lowest degree through points."""
    return _core.interpolating_polynomial(points_array(points), points_array(nodes))


@from_header("make/named_surface:from_bases")
def from_bases(bases: tuple[PolynomialBasis, PolynomialBasis], coefficients: ArrayLike,
               on: tuple[IntervalLike, IntervalLike] = ((0.0, 1.0), (0.0, 1.0))) -> PolynomialPatch:
    """The patch with these coefficients in the tensor product of two bases."""
    return _core.from_bases([b._c for b in bases], points_array(coefficients), [*pair(on[0]), *pair(on[1])])


@from_header("make/named_surface:bicubic")
def bicubic(geometry: ArrayLike, along_u: ArrayLike, along_v: ArrayLike) -> Surface:
    """The bicubic patch of a 4 x 4 geometry and two basis matrices (named_matrix)."""
    return _core.bicubic(points_array(geometry), points_array(along_u), points_array(along_v))


# --- surfaces from curves

Z = (0.0, 0.0, 1.0)
O = (0.0, 0.0, 0.0)


@from_header("make/revolve:revolve")
def revolve(profile: Curve, origin: ArrayLike = O, direction: ArrayLike = Z, angle: float = tau, *,
            closed: bool = True) -> MadeSurface:
    """The surface of revolution, rational and exact."""
    return _core.revolve(profile._c, vector(origin, 3), vector(direction, 3), angle, closed)


@from_header("make/revolve:revolve_polynomial")
def revolve_polynomial(profile: Curve, tolerance: float, origin: ArrayLike = O, direction: ArrayLike = Z,
                       angle: float = tau, *, closed: bool = True) -> RevolvedPolynomial:
    """A polynomial surface within a distance of the surface of revolution."""
    return _core.revolve_polynomial(profile._c, vector(origin, 3), vector(direction, 3), angle, tolerance, closed)


@from_header("make/sweep:extrude")
def extrude(profile: Curve, vector_: ArrayLike) -> MadeSurface:
    """profile(u) + v vector."""
    return _core.extrude(profile._c, vector(vector_, 3))


@from_header("make/sweep:ruled")
def ruled(a: Curve, b: Curve) -> MadeSurface:
    """The straight lines between two curves."""
    return _core.ruled(a._c, b._c)


@from_header("make/offset_spline:offset_spline")
def offset_spline(surface: Surface, distance: float, tolerance: float,
                  on: tuple[IntervalLike, IntervalLike] | None = None) -> MadeSurface:
    """A bicubic spline near the surface moved along its normals."""
    return _core.offset_spline(surface._c, distance, tolerance, None if on is None else [*pair(on[0]), *pair(on[1])])


@from_header("make/sweep:translate_along")
def translate_along(profile: Curve, rail: Curve) -> MadeSurface:
    """The profile moved along the rail without turning."""
    return _core.translate_along(profile._c, rail._c)


@from_header("make/frame_sweep:sweep")
def sweep(profile: Curve, rail: Curve, tolerance: float, x_at_start: ArrayLike = O) -> FrameSweep:
    """A plane profile along a rail in the frame that does not turn about it."""
    return _core.sweep(profile._c, rail._c, tolerance, vector(x_at_start, 3))


@from_header("fit/loft:loft")
def loft(sections: Sequence[Curve], degree: int = 3, *, spacing: str = "chordal", ends: str = "natural",
         closed: bool = False) -> Loft:
    """The surface through sections."""
    return _core.loft(handles(sections, "sections"), degree, spacing, ends, closed)


@from_header("make/coons:coons")
def coons(u0: Curve, u1: Curve, v0: Curve, v1: Curve, tolerance: float) -> CoonsPatch:
    """The surface between four boundary curves."""
    return _core.coons(u0._c, u1._c, v0._c, v1._c, tolerance)


@from_header("make/coons:coons_bicubic", "make/coons:CoonsEdge")
def coons_bicubic(u0: tuple[Curve, Curve], u1: tuple[Curve, Curve], v0: tuple[Curve, Curve], v1: tuple[Curve, Curve],
                  tolerance: tuple[float, float, float]) -> CoonsPatch:
    """The same with derivatives across: each edge is (curve, across); tolerances of distance, tangent, twist."""
    return _core.coons_bicubic(handles((c for edge in (u0, u1, v0, v1) for c in edge), "edges"), list(tolerance))


@from_header("fit/loft:gordon")
def gordon(u_curves: Sequence[Curve], at_v: ArrayLike, v_curves: Sequence[Curve], at_u: ArrayLike,
           tolerance: float) -> GordonSurface:
    """The surface through a network of curves."""
    return _core.gordon(handles(u_curves, "u_curves"), points_array(at_v), handles(v_curves, "v_curves"), points_array(at_u),
                        tolerance)


@from_header("make/surface_joint:rejoined")
def rejoined(previous: Surface, edge: tuple[int, str], neighbour: Surface, neighbour_edge: tuple[int, str], order: int, *,
             against: bool = False) -> Surface:
    """A neighbour with its first rows replaced so that it joins with C^order; edges: (axis, "start" or "end")."""
    return _core.rejoined(previous._c, edge[0], edge[1], neighbour._c, neighbour_edge[0], neighbour_edge[1], against,
                          order)


@from_header("spline/compatible:compatible")
def compatible(curves: Sequence[Curve]) -> Compatible:
    """The same curves with the basis of all."""
    return _core.compatible(handles(curves, "curves"))


@from_header("spline/a_frame:join_pieces")
def join_pieces(pieces: Sequence[Curve], breaks: ArrayLike, tolerance: float) -> Reduced:
    """One curve of Bezier pieces of the same degree and kind."""
    c = np.concatenate([p.coefficients for p in pieces])
    return _core.join_pieces(points_array(c), pieces[0].is_rational, pieces[0].degree, points_array(breaks), tolerance)


@from_header("spline/a_frame:de_boor_points")
def de_boor_points(bezier: ArrayLike, breaks: ArrayLike) -> Reduced:
    """The cubic B-spline of the Bezier points of pieces."""
    return _core.de_boor_points(points_array(bezier), False, points_array(breaks))


# --- quadrics


class Frame(NamedTuple):
    """Where a surface stands: origin and three vectors."""

    origin: Array = np.zeros(3)
    x: Array = np.array([1.0, 0.0, 0.0])
    y: Array = np.array([0.0, 1.0, 0.0])
    z: Array = np.array([0.0, 0.0, 1.0])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Frame) and all(map(same, self, other))

    def __ne__(self, other: object) -> bool:
        return not self == other

    def __hash__(self) -> int:
        return hash(repr(self))

    def __repr__(self) -> str:
        return f"Frame({', '.join(f'{name}={plain(value)!r}' for name, value in zip(self._fields, self))})"


FULL = (0.0, tau)
POLES = (-QUARTER, QUARTER)


def _frame(f: Frame | ArrayLike) -> list[Array]:
    return [points_array(v) for v in f] if isinstance(f, Frame) else [vector(f, 3), *map(points_array, Frame()[1:])]


@from_header("make/quadric:frame_about")
def frame_about(origin: ArrayLike, axis: ArrayLike, toward: ArrayLike = O) -> Frame:
    """Three orthogonal unit vectors, z along the axis."""
    return Frame(*_core.frame_about(vector(origin, 3), vector(axis, 3), vector(toward, 3)))


@from_header("make/quadric:sphere")
def sphere(radius: float, frame: Frame | ArrayLike = O, *, angle: IntervalLike = FULL, form: str = "open",
           latitude: IntervalLike = POLES) -> RoundSurface:
    """A sphere, or a part of one; frame: a Frame, or the centre."""
    return _core.sphere(_frame(frame), radius, pair(angle), form, pair(latitude))


@from_header("make/quadric:cylinder")
def cylinder(radius: float, height: IntervalLike, frame: Frame | ArrayLike = O, *, angle: IntervalLike = FULL,
             form: str = "open") -> RoundSurface:
    """A cylinder about z."""
    return _core.cylinder(_frame(frame), radius, pair(height), pair(angle), form)


@from_header("make/quadric:cone")
def cone(radius_lo: float, radius_hi: float, height: IntervalLike, frame: Frame | ArrayLike = O, *,
         angle: IntervalLike = FULL, form: str = "open") -> RoundSurface:
    """A cone about z."""
    return _core.cone(_frame(frame), radius_lo, radius_hi, pair(height), pair(angle), form)


@from_header("make/quadric:torus")
def torus(ring: float, tube: float, frame: Frame | ArrayLike = O, *, angle: IntervalLike = FULL, form: str = "open",
          around: IntervalLike = FULL, around_form: str = "open") -> RoundSurface:
    """A torus about z."""
    return _core.torus(_frame(frame), ring, tube, pair(angle), form, pair(around), around_form)


@from_header("make/quadric:SphereInSix")
def sphere_in_six(radius: float, frame: Frame | ArrayLike = O) -> SphereInSix:
    """A sphere without poles: six patches."""
    return _core.sphere_in_six(_frame(frame), radius)


@from_header("make/quadric:SphereInEight")
def sphere_in_eight(radius: float, frame: Frame | ArrayLike = O) -> SphereInEight:
    """A sphere as eight triangular patches."""
    return _core.sphere_in_eight(_frame(frame), radius)
