"""The test cases of verb, replayed: its functions by ours of the same meaning. What has none is named below with the reason;
a case that is neither is a failure."""
import json
from math import pi

import numpy as np
import pytest
from conftest import corpus

import freiform as ff

ARITHMETIC = "arithmetic on arrays: NumPy's"
MESHES = "a step of verb's intersection of meshes; freiform intersects the surfaces themselves"
STORED = "gives back an argument of the constructor of a class of verb"
PIECES = "counts pieces that depend on verb's meshes"
ELSEWHERE = {
    "core.BoundingBox": ARITHMETIC, "core.Mat.solve": ARITHMETIC, "core.Mat.transpose": ARITHMETIC,
    "core.Vec.sortedSetUnion": ARITHMETIC, "core.Vec.sortedSetSub": ARITHMETIC,
    "core.Trig.distToRay": ARITHMETIC, "eval.Eval.homogenize2d": ARITHMETIC, "eval.Intersect.threePlanes": ARITHMETIC,
    "unclamped knots": "no knots for verb; here they are",
    "core.Plane": ARITHMETIC, "core.MeshData": MESHES, "core.Ray": MESHES, "core.MeshIntersectionPoint": MESHES,
    "eval.Intersect.segmentWithTriangle": MESHES, "geom.RevolvedSurface": PIECES,
    "Arc.": STORED, "CylindricalSurface.": STORED, "ConicalSurface.": STORED,
}


class Elsewhere(Exception):
    """A function of verb without a counterpart of the same meaning."""


def standard(patch):
    """The same patch with every axis on [0, 1], as verb's constructors give it."""
    if isinstance(patch, ff.Curve):
        lo, hi = patch.domain
        return ff.Curve.from_homogeneous(patch.to_rational().coefficients, patch.degree, (patch.knots - lo) / (hi - lo))
    knots = tuple((k - on.lo) / on.length for k, on in zip(patch.knots, patch.domain))
    return ff.Surface.from_homogeneous(patch.to_rational().coefficients, patch.degrees, knots)


# --- verb's data

def curve_data(degree, knots, points):
    """NurbsCurveData: whether the last coordinate is a weight is known from the function that it is given to."""
    return {"degree": degree, "knots": knots, "controlPoints": points}


def surface_data(degree_u, degree_v, knots_u, knots_v, points):
    return {"degreeU": degree_u, "degreeV": degree_v, "knotsU": knots_u, "knotsV": knots_v, "controlPoints": points}


def data_of(patch):
    if isinstance(patch, ff.Curve):
        return curve_data(patch.degree, patch.knots, patch.coefficients)
    return surface_data(*patch.degrees, *patch.knots, patch.coefficients)


def plain(d):
    c = np.array(d["controlPoints"], dtype=float)
    if "degree" in d:
        return ff.Curve(c, d["degree"], d["knots"])
    return ff.Surface(c, (d["degreeU"], d["degreeV"]), (d["knotsU"], d["knotsV"]))


def rational(d):
    if isinstance(d, (ff.Curve, ff.Surface)):
        return d
    c = np.array(d["controlPoints"], dtype=float)
    if "degree" in d:
        return ff.Curve.from_homogeneous(c, d["degree"], d["knots"])
    return ff.Surface.from_homogeneous(c, (d["degreeU"], d["degreeV"]), (d["knotsU"], d["knotsV"]))


def graded(jet, order):
    """derivatives[i][j] of verb from the graded order."""
    return [[jet[(i + j) * (i + j + 1) // 2 + j] for j in range(order + 1 - i)] for i in range(order + 1)]


def basis_rows(span, u, degree, orders, knots):
    basis = ff.Basis(degree, knots)
    assert basis.span(u) == span
    return [basis.collocation([u], k)[0, span - degree: span + 1] for k in range(orders + 1)]


# --- constructions

def arc(centre, x, y, start, end):
    return standard(ff.conic_arc(centre, x, y, (start, end)).curve)


def swapped(s):
    """The same surface with the parameters in the other order."""
    return ff.Surface.from_homogeneous(np.swapaxes(s.to_rational().coefficients, 0, 1), s.degrees[::-1], s.knots[::-1])


def extrusion(direction, profile):
    """verb's begins at the far end, the profile second, and is quadratic along the vector."""
    made = ff.extrude(profile, direction).surface
    return standard(swapped(made).reverse(0).elevate(1, 0))


def cylinder(axis, xaxis, base, height, radius):
    """verb's begins at the far end, the circle second."""
    return standard(swapped(ff.cylinder(radius, (0, height), ff.frame_about(base, axis, xaxis)).surface).reverse(0))


def cone(axis, xaxis, base, height, radius):
    """verb's begins at the apex."""
    return standard(ff.cone(radius, 0, (0, height), ff.frame_about(base, axis, xaxis)).surface.reverse(1))


def four_points(a, b, c, d):
    return standard(ff.Surface([[a, d], [b, c]], (1, 1)).elevate(2, 0).elevate(2, 1))


def polyline(points, at=None):
    at = ff.parameters(points, "chordal") if at is None else np.array(at, dtype=float)
    return ff.Curve(points, 1, np.r_[at[0], at, at[-1]])


# --- questions

def contacts(a, b, tolerance, surface=False):
    found = ff.intersect(a, b, tolerance)
    out = []
    for c in found.contacts:
        if surface:
            out.append({"u": c.at[0], "uv": c.at[1:], "curvePoint": a(c.at[0]), "surfacePoint": b(c.at[1], c.at[2])})
        else:
            out.append({"u0": c.at[0], "u1": c.at[1], "point0": a(c.at[0]), "point1": b(c.at[1])})
    return out


def segment_and_plane(p, q, origin, normal):
    found = ff.Curve([p, q]).crossings(normal, -np.dot(normal, origin))
    return {"p": found[0].at.middle} if found else None


def is_valid(knots, degree):
    try:
        basis = ff.Basis(degree, knots)
    except ff.InvalidError:
        return False
    if basis.multiplicity(basis.domain.lo) <= degree or basis.multiplicity(basis.domain.hi) <= degree:
        raise Elsewhere("unclamped knots")
    return True


def distance_to_segment(a, b, c):
    """verb's is that of the second point from the segment between the others."""
    return ff.nearest(ff.Curve([a, c]), np.array(b, dtype=float)).distance


def multiplicities(knots):
    values, counts = np.unique(knots, return_counts=True)
    basis = ff.Basis(max(counts) - 1, knots)
    return [{"knot": x, "mult": basis.multiplicity(x)} for x in values]


FUNCTIONS = {
    "eval.Eval.knotSpanGivenN": lambda n, p, u, k: ff.Basis(p, k).span(u),
    "eval.Eval.basisFunctions": lambda u, p, k: basis_rows(ff.Basis(p, k).span(u), u, p, 0, k)[0],
    "eval.Eval.basisFunctionsGivenKnotSpanIndex": lambda i, u, p, k: basis_rows(i, u, p, 0, k)[0],
    "eval.Eval.derivativeBasisFunctionsGivenNI": lambda i, u, p, n, k: basis_rows(i, u, p, n, k),
    "eval.Eval.curvePointGivenN": lambda n, c, u: plain(c)(u),
    "eval.Eval.surfacePoint": lambda s, u, v: plain(s)(u, v),
    "eval.Eval.surfacePointGivenNM": lambda n, m, s, u, v: plain(s)(u, v),
    "eval.Eval.volumePoint": lambda w, *at: ff.Volume(w[6], w[:3], tuple(w[3:6]))(*at),
    "eval.Eval.curveDerivatives": lambda c, u, n: plain(c).evaluate(u, n),
    "eval.Eval.curveDerivativesGivenN": lambda n, c, u, order: plain(c).evaluate(u, order),
    "eval.Eval.rationalCurvePoint": lambda c, u: rational(c)(u),
    "eval.Eval.rationalSurfacePoint": lambda s, u, v: rational(s)(u, v),
    "eval.Eval.rationalCurveDerivatives": lambda c, u, n: rational(c).evaluate(u, n),
    "eval.Eval.rationalSurfaceDerivatives": lambda s, u, v, n: graded(rational(s).evaluate(u, v, n), n),
    "eval.Modify.curveKnotInsert": lambda c, u, r: data_of(plain(c).insert_knots([u] * r)),
    "eval.Modify.decomposeCurveIntoBeziers": lambda c: plain(c).decompose(),
    "eval.Modify.curveElevateDegree": lambda c, p: data_of(rational(c).elevate(p - c["degree"])),
    "eval.Modify.knotsReverse": lambda k: ff.Basis(0, k).reverse()[0].knots,
    "eval.Make.ellipseArc": arc,
    "eval.Make.arc": lambda o, x, y, r, a, b: arc(o, np.multiply(r, x), np.multiply(r, y), a, b),
    "eval.Make.polyline": lambda p: data_of(polyline(p).to_rational()),
    "eval.Make.extrudedSurface": lambda axis, length, c: data_of(extrusion(np.multiply(length, axis), rational(c))),
    "eval.Make.cylindricalSurface": lambda *a: data_of(cylinder(*a).elevate(1, 0)),
    "eval.Make.rationalBezierCurve": lambda p: ff.Curve(p),
    "eval.Make.rationalTranslationalSurface": lambda profile, rail: ff.translate_along(profile, rail).surface,
    "eval.Make.fourPointSurface": lambda *corners: data_of(four_points(*corners)),
    "eval.Make.rationalInterpCurve": lambda p, n, *tangents: data_of(ff.interpolate(p, n, "not_a_knot").patch),
    "eval.Analyze.knotMultiplicities": multiplicities,
    "eval.Analyze.rationalCurveClosestParam": lambda c, p: ff.nearest(rational(c), np.array(p, dtype=float)).at[0],
    "eval.Analyze.rationalSurfaceClosestParam": lambda s, p: ff.nearest(rational(s), np.array(p, dtype=float)).at[:2],
    "eval.Check.isValidKnotVector": is_valid,
    "eval.Intersect.curves": lambda a, b, e: contacts(rational(a), rational(b), e),
    "eval.Intersect.polylines": lambda a, b, e: contacts(a, b, e),
    "eval.Intersect.curveAndSurface": lambda a, b, e: contacts(rational(a), rational(b), e, True),
    "eval.Intersect.segmentAndPlane": segment_and_plane,
    "eval.Intersect.meshes": lambda a, b: ff.intersect(rational(a), rational(b), tolerance=1e-6).branches,
    "eval.Tess.rationalSurfaceAdaptive": lambda s: s,
    "core.Trig.distToSegment": distance_to_segment,
    "geom.NurbsCurve": rational, "geom.NurbsSurface": rational,
    "geom.NurbsCurve.byKnotsControlPointsWeights": lambda p, k, c, w: ff.Curve(c, p, k, w),
    "geom.NurbsSurface.byKnotsControlPointsWeights": lambda p, q, u, v, c, w=None: ff.Surface(c, (p, q), (u, v), w),
    "geom.NurbsSurface.byCorners": four_points,
    "geom.Line": lambda a, b: ff.Curve([a, b]), "geom.BezierCurve": ff.Curve,
    "geom.Circle": lambda o, x, y, r: arc(o, np.multiply(r, x), np.multiply(r, y), 0, 2 * pi),
    "geom.Arc": lambda o, x, y, r, a, b: arc(o, np.multiply(r, x), np.multiply(r, y), a, b),
    "geom.Ellipse": lambda o, x, y: arc(o, x, y, 0, 2 * pi), "geom.EllipseArc": arc,
    "geom.ExtrudedSurface": lambda profile, direction: extrusion(direction, profile),
    "geom.CylindricalSurface": cylinder, "geom.ConicalSurface": cone,
    "geom.SphericalSurface": lambda centre, r: standard(ff.sphere(r, centre).surface),
    "geom.Intersect.curveAndSurface": lambda a, b, e: contacts(a, b, e, True),
    "core.NurbsCurveData": curve_data, "core.NurbsSurfaceData": surface_data,
    "core.PolylineData": polyline, "core.VolumeData": lambda *a: list(a),
}
for _of in ("Curve", "BezierCurve"):
    FUNCTIONS[f"eval.Analyze.rational{_of}ArcLength"] = lambda c, u=None, n=0: rational(c).length(
        1e-9, None if u is None else (rational(c).domain.lo, u)).value
    FUNCTIONS[f"eval.Analyze.rational{_of}ParamAtArcLength"] = lambda c, s, *a: float(
        rational(c).arc_length(1e-9).parameter(s)[0])


def nearest(patch, point):
    return ff.nearest(patch, np.array(point, dtype=float))


def domain_of(on):
    return {"min": on.lo, "max": on.hi}


METHODS = {
    "point": lambda x, *u: x(*u),
    "tangent": lambda x, u: x(u, 1),
    "derivatives": lambda x, *a: x.evaluate(a[0], a[1] if len(a) > 1 else 1) if isinstance(x, ff.Curve) else
    graded(x.evaluate(*a), a[2]),
    "closestParam": lambda x, p: nearest(x, p).at[:2] if isinstance(x, ff.Surface) else nearest(x, p).at[0],
    "closestPoint": lambda x, p: nearest(x, p).point,
    "lengthAtParam": lambda x, u: x.arc_length(1e-9)(u),
    "split": lambda x, u, along_v=None: x.split(u, int(bool(along_v))),
    "tessellate": lambda x: x,
    "transform": lambda x, m: x.transform(np.array(m)[:3, :3], np.array(m)[:3, 3]).patch,
    "degree": lambda x: x.degree, "degreeU": lambda x: x.degrees[0], "degreeV": lambda x: x.degrees[1],
    "knots": lambda x: x.knots, "knotsU": lambda x: x.knots[0], "knotsV": lambda x: x.knots[1],
    "controlPoints": lambda x: x.points, "weights": lambda x: x.weights,
    "domain": lambda x: domain_of(x.domain), "domainU": lambda x: domain_of(x.domain[0]),
    "domainV": lambda x: domain_of(x.domain[1]),
}
CONSTANTS = {"verb.core.Constants.TOLERANCE": 1e-6, "verb.core.Constants.EPSILON": 1e-10}


def called(name, arguments):
    name = name.removeprefix("verb.")
    if name in ELSEWHERE:
        raise Elsewhere(name)
    return FUNCTIONS[name](*arguments)


def value(node):
    if isinstance(node, list):
        return [value(x) for x in node]
    if isinstance(node, str):
        return CONSTANTS[node]
    if not isinstance(node, dict):
        return node
    if "new" in node:
        return called(node["new"], [value(x) for x in node["args"]])
    if "call" in node:
        arguments = [value(x) for x in node["args"]]
        if isinstance(node["call"], str):
            return called(node["call"], arguments)
        of, method = node["call"]["of"], node["call"]["get"]
        kind = of.get("new", "").split(".")[-1] + "."
        if method not in METHODS and f"core.{kind[:-1]}" in ELSEWHERE:
            raise Elsewhere(f"core.{kind[:-1]}")
        if method not in METHODS and kind in ELSEWHERE:
            raise Elsewhere(kind)
        return METHODS[method](value(of), *arguments)
    of, key = value(node["of"]), str(node["get"])
    if isinstance(of, dict):
        return of[key]
    return len(of) if key == "length" else of[int(key)]


def test_verb():
    replayed, met = 0, set()
    cases = json.loads(corpus("oracle/verb.json").read_text())["cases"]
    for case in cases:
        try:
            actual = value(case["actual"])
        except Elsewhere as why:
            met.add(str(why))
            continue
        except Exception as why:
            pytest.fail(f"{why!r} of {json.dumps(case)[:2000]}")
        # Exact equality in verb is here the same numbers up to rounding.
        tolerance = 1e-6 if isinstance(case["tol"], str) else case["tol"] or 1e-9
        if case["expected"] is None:
            assert actual is None, case
        else:
            assert np.shape(actual) == np.shape(case["expected"]), case
            assert np.allclose(np.asarray(actual, dtype=float), case["expected"], rtol=0, atol=tolerance), (actual, case)
        replayed += 1
    assert met == set(ELSEWHERE)
    assert (replayed, len(cases)) == (366, 901)
