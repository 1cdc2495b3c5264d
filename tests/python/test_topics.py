"""Each part of the library answers through Python as its header promises."""
from math import pi, tau

import numpy as np
import pytest

import freiform as ff

LINE = ff.Curve([[0, 0], [4, 2]])
WAVE = ff.Curve([[0, 0], [1, 2], [3, 2], [4, 0]])
SAIL = ff.Surface([[[0, 0, 0], [0, 1, 1]], [[1, 0, 1], [1, 1, 0]]])
BALL = ff.sphere(2.0).surface
BOX = ff.Model.prism(ff.Path("M 0 0 H 2 V 1 H 0 Z"), (0, 0, 3))


def test_bases_have_partition_of_unity_and_matrices_that_keep_the_function():
    b = ff.Basis(3, [0, 0, 0, 0, 1, 2.5, 4, 4, 4, 4])
    at = np.linspace(0, 4, 23)
    assert np.allclose(b.collocation(at).sum(axis=1), 1) and np.allclose(b.collocation(at, 1).sum(axis=1), 0)
    c = np.random.default_rng(0).normal(size=b.size)
    for other, matrix in (b.insert_knots([0.5, 3]), b.elevate(), b.to_bezier(), b.restrict_to((0, 4)), b.insert_knot(2)):
        assert np.allclose(other.collocation(at) @ (matrix @ c), b.collocation(at) @ c)
    u = np.linspace(0, 4, 9)
    assert np.allclose(b.collocation(u) @ b.greville, u)
    closed = ff.Basis.periodic(2, [0, 1, 2, 3, 4])
    assert np.allclose(closed.collocation([0.2, 3.9]).sum(axis=1), 1)


def test_the_polar_form_is_symmetric_affine_and_gives_values_and_coefficients():
    b = ff.Basis(3, [0, 0, 0, 0, 1, 2.5, 4, 4, 4, 4])
    c = np.random.default_rng(0).normal(size=(b.size, 2))
    curve, s = ff.Curve(c, 3, b.knots), b.span(1.5)

    def polar(*arguments):
        return b.blossom(s, arguments) @ c[s - 3: s + 1]
    assert np.allclose(polar(1.5, 1.5, 1.5), curve(1.5)) and np.allclose(polar(1.1, 2, 7), polar(7, 1.1, 2))
    assert np.allclose(polar(1, 2, 0.25 * 3 + 0.75 * 5), 0.25 * polar(1, 2, 3) + 0.75 * polar(1, 2, 5))
    assert np.allclose([polar(*b.knots[i + 1: i + 4]) for i in range(s - 3, s + 1)], c[s - 3: s + 1])
    for span, arguments, kind in ((2, [1, 1, 1], ff.InvalidError), (6, [1, 1, 1], ff.InvalidError), (s, [1, 1], ff.InvalidError),
                                  (s, [1, 1, np.nan], ff.NonFiniteError)):
        with pytest.raises(kind):
            b.blossom(span, arguments)
    t = ff.TriangularPatch([[0, 0, 0], [0.5, 0, 1], [0, 0.5, 1], [1, 0, 0], [0.5, 0.5, 1], [0, 1, 0]])
    assert np.allclose(t.blossom([[0.2, 0.3]] * 2), t(0.2, 0.3))
    assert np.allclose(t.blossom([[0, 0], [1, 0]]), t.points[1]) and np.allclose(t.blossom([[1, 0], [0, 1]]), t.points[4])
    with pytest.raises(ff.InvalidError):
        t.blossom([[0, 0]])


def test_changes_of_polynomial_bases_are_inverses():
    m, b = ff.PolynomialBasis.monomial(4), ff.PolynomialBasis.bernstein(4)
    there, back = ff.change_basis(m, b), ff.change_basis(b, m)
    assert np.allclose(np.reshape(there.entry, (5, 5)) @ np.reshape(back.entry, (5, 5)), np.eye(5), atol=1e-12)
    value, bound, condition = ff.convert_coefficients(m, b, [[1.0], [0], [0], [0], [0]])  # t^4
    assert np.allclose(value[:, 0], [0, 0, 0, 0, 1]) and (bound >= 0).all() and condition >= 1
    curve = ff.from_basis(ff.PolynomialBasis.monomial(2), [[1.0, 0], [0, 1], [0, 0]]).curve  # (t^2, t)
    assert np.allclose(curve(0.5), [0.25, 0.5])


def test_roots_and_predicates_are_exact():
    roots = ff.real_roots([-1, 0.5, 2])
    assert roots.kind == "isolated" and len(roots.roots) == 1 and roots.roots[0].at.lo <= roots.roots[0].at.hi
    assert ff.orient2d([0, 0], [1e300, 1e-300], [1e300, 0]) == -1
    assert ff.in_circle([1, 0], [0, 1], [-1, 0], [0, 0]) == 1
    assert ff.orient3d([0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, -1]) == 1


def test_conics_are_exact_within_their_bound():
    arc = ff.arc_through([1, 0], [0, 1], [-1, 0])
    assert np.abs(np.hypot(*arc.curve(np.linspace(0, 1, 50)).T) - 1).max() <= arc.bound + 1e-15
    assert ff.classify_conic([1, 0, 4, 0, 0, -4]) == "ellipse"
    assert np.allclose(np.abs(ff.solve_conic([1, 0, 4, 0, 0, -4]).conic.conic.x), [2, 0])
    assert ff.five_point_arc([[5, 0], [4, 3], [3, 4], [0, 5], [-5, 0]]).type == "circle"
    assert len(ff.conic_arcs_inside([1, 0, 1, 0, 0, -1], [-0.5, -2], [0.5, 2])) == 2
    g = ff.graph([0, 0, 1.0], (-1, 1)).curve
    assert np.allclose(g([0.5]), [[0.5, 0.25]])


def test_named_curves_pass_where_they_should():
    p = np.array([[0, 0], [1, 1], [2, 0], [3, 1], [4, 0.0]])
    assert np.allclose(ff.catmull_rom(p)([0, 1, 2]), p[1:4])
    assert np.allclose(ff.catmull_rom(p, closed=True)([0, 1, 2, 3, 4]), p)
    assert np.allclose(ff.hermite([0, 0], [1, 1], [3, 0], [0, 3])([0, 1], 1), [[3, 0], [0, 3]])
    assert np.allclose(ff.kochanek_bartels(p, [(0, 0, 0)])(1), p[2])
    assert np.allclose(ff.uniform_b_spline(p)(0), (p[0] + 4 * p[1] + p[2]) / 6)
    geometry = np.random.default_rng(0).normal(size=(4, 4, 3))
    m = ff.named_matrix("bezier")
    assert np.allclose(ff.bicubic(geometry, m, m).points, geometry)
    with pytest.raises(ff.InvalidError, match="uniform-b-spline"):
        ff.named_matrix("bspline")


@pytest.mark.parametrize("made, size", [
    (lambda: ff.revolve(ff.Curve([[1, 0, 0], [1, 0, 2]])), (2, 2, 2)),
    (lambda: ff.extrude(WAVE, (0, 0, 3)), (4, 1.5, 3)),
    (lambda: ff.ruled(LINE, WAVE), (4, 2, 0)),
    (lambda: ff.loft([WAVE, ff.Curve(WAVE.in_space().points + [0, 0, 2])]), (4, 1.5, 2)),
    (lambda: ff.sweep(ff.circle([0, 0], 0.1).curve, ff.Curve([[0, 0, 0], [0, 0, 5]]), 1e-3), (0.2, 0.2, 5)),
    (lambda: ff.translate_along(WAVE, ff.Curve([[0, 0, 0], [0, 0, 1]])), (4, 1.5, 1)),
    (lambda: ff.coons(ff.Curve([[0, 0, 0], [1, 0, 0]]), ff.Curve([[0, 1, 0], [1, 1, 0]]), ff.Curve([[0, 0, 0], [0, 1, 0]]),
                      ff.Curve([[1, 0, 0], [1, 1, 0]]), 1e-9), (1, 1, 0)),
    (lambda: ff.gordon([ff.Curve([[0, 0, 0], [1, 0, 0]]), ff.Curve([[0, 1, 0], [1, 1, 0]])], [0, 1],
                       [ff.Curve([[0, 0, 0], [0, 1, 0]]), ff.Curve([[1, 0, 0], [1, 1, 0]])], [0, 1], 1e-9), (1, 1, 0)),
    (lambda: ff.sphere(2.0), (4, 4, 4)), (lambda: ff.cylinder(1.0, (0, 3)), (2, 2, 3)),
    (lambda: ff.cone(1.0, 0.0, (0, 3)), (2, 2, 3)), (lambda: ff.torus(3.0, 1.0), (8, 8, 2)),
])
def test_constructed_surfaces_have_the_right_size_and_say_what_they_are_off(made, size):
    answer = made()
    assert answer.bound <= 2e-3
    box = answer.surface.in_space().bounds(1e-6).box
    assert np.allclose(box.hi - box.lo, size, atol=1e-2)


def test_offsets_are_near_the_surface_moved_along_its_normals():
    vase = ff.revolve(ff.Curve([[1, 0, 0], [2, 0, 1], [1, 0, 2]]), angle=2.0).surface
    part = ((0.1, 0.9), (0.0, 0.5))
    for on, u, v in ((None, vase.domain[0], vase.domain[1]), (part, *part)):
        made = ff.offset_spline(vase, 0.25, 1e-4, on)
        assert 1e-6 < made.bound <= 1e-4 and made.surface.degrees == (3, 3)
        u, v = np.linspace(*u, 20)[:, None], np.linspace(*v, 20)
        off = np.linalg.norm(made.surface(u, v) - vase(u, v) - 0.25 * vase.normal(u, v), axis=-1)
        assert off.max() <= made.bound
    with pytest.raises(ff.LimitError):
        ff.offset_spline(vase, 0.25, 1e-15)


def test_mixed_kinds_of_curves_are_brought_together():
    half = ff.arc_through([1, 0], [0, 1], [-1, 0]).curve
    s = ff.ruled(half, ff.Curve([[1, 0, 2], [-1, 0, 2.0]])).surface
    assert s.is_rational and s.dimension == 3


def test_fits_report_what_they_reached():
    t = np.linspace(0, 2 * pi, 40)
    p = np.c_[np.cos(t), np.sin(t)]
    i = ff.interpolate(p, 3, "natural")
    assert i.bound < 1e-12 and i.patch.degree == 3
    closed = ff.interpolate(p[:-1], 3, "periodic").patch
    assert closed.is_closed and np.abs(np.hypot(*closed(np.linspace(*closed.domain, 200)).T) - 1).max() < 1e-3
    f = ff.approximate(p, 1e-3)
    assert f.report.bound <= 1e-3 and f.curve.basis.size < 40
    at = ff.parameters(p)
    basis = ff.Basis.clamped_uniform(3, 8)
    l = ff.least_squares(basis, p, at / at[-1] * 5)
    assert l.report.rms_error < 0.02
    assert np.allclose(ff.cubic_through(p[:5], slopes="akima")(ff.parameters(p[:5])), p[:5])
    grid = np.random.default_rng(1).normal(size=(6, 5, 3))
    g = ff.interpolate_grid(grid, at=(range(6), range(5)))
    assert g.bound < 1e-12 and np.allclose(g.patch.grid(range(6), range(5)), grid)
    assert np.allclose(ff.bicubic_through(grid, range(6), range(5)).grid(range(6), range(5)), grid)


def test_curves_know_their_features():
    assert [f.kind for f in ff.Curve([[0, 0], [1, 3], [2, -3], [3, 0]]).inflections()] == ["inflection"]
    assert [f.kind for f in ff.Curve([[0, 0], [1, 1], [0, 1], [1, 0]]).cusps()] == ["cusp"]
    assert [f.kind for f in WAVE.extrema([0, 1], 1e-9)] == ["maximum"]
    hits = WAVE.crossings([0, 1], -1.0, 1e-9)
    assert [h.kind for h in hits] == ["crossing", "crossing"]
    loop = ff.Curve([[0, 0], [4, 3], [-1, 3], [3, 0]]).self_intersections(1e-9)
    assert [x.kind for x in loop] == ["crossing"]
    assert WAVE.implicit().degree == 3 and WAVE.implicit().sign(WAVE(0.5)) == 0
    (knot,) = ff.Curve([[0, 0], [1, 1], [2, 0], [3, 1], [4, 0]], 3).continuity()
    assert knot.joint.c_order == 2 and knot.multiplicity == 1
    assert LINE.joint(ff.Curve([[4, 2], [8, 4]])).g_order >= 1


def test_intersections_of_every_pair_of_kinds():
    assert len(ff.intersect(LINE, WAVE).contacts) == 2
    through = ff.Curve([[0, 0, -5], [0, 0, 5]])
    hits = ff.intersect(through, BALL, 1e-9)
    assert len(hits.contacts) >= 2 and all(abs(abs(c.point[2]) - 2) < 1e-6 for c in hits.contacts)
    rays = ff.intersect_lines(BALL, [[-5, 0.1, 0.2], [9, 9, 9]], [1, 0, 0])
    assert [len(r.contacts) for r in rays] == [2, 0]
    cut = BALL.section([0, 0, 1], -1.0, 1e-4)
    assert len(cut.branches) == 1 and abs(cut.branches[0].curve.length(1e-6).value - tau * 3**0.5) < 1e-3
    both = ff.intersect(BALL, ff.sphere(2.0, [1, 0, 0]).surface, tolerance=1e-3)
    assert both.branches and all(b.bound_a <= 1e-3 for b in both.branches)
    table = ff.intersect_all([LINE, WAVE], [WAVE, LINE])
    assert len(table) == 2 and len(table[0][0].contacts) == 2


def test_nearest_answers_are_arrays_with_bounds():
    q = ff.NearestQuery(BALL, ff.Curve([[5, 0, 0], [5, 1, 0]]))
    points = np.random.default_rng(4).normal(size=(4, 3, 3)) * 4
    found = q.nearest(points)
    assert found.distance.shape == (4, 3) and found.point.shape == (4, 3, 3)
    assert (found.lower_bound <= found.distance + found.point_error).all() and set(found.object.ravel()) <= {0, 1}
    assert abs(ff.least_distance(BALL, ff.Curve([[5, 0, 0], [5, 1, 0]])).distance - 3) < 1e-6
    assert len(q.feet([0, 0, 9], 2).feet) >= 1
    hull = ff.convex_hull(WAVE, 1e-3)
    assert hull.slack <= 1e-3 and ff.hull_of_points([[0, 0], [1, 0], [0.2, 0.2], [0, 1]]).tolist() == [0, 1, 3]
    assert ff.oriented_box(WAVE, 1e-6).slack <= 1e-6


def test_surfaces_know_their_curvature():
    k = BALL.curvature_at(0.2, 0.3)
    assert abs(k.gauss.value - 0.25) <= k.gauss.bound + 1e-12
    assert np.allclose(BALL.curvatures([0.1, 0.7], 0.4), [[0.25, -0.5]] * 2)
    assert np.allclose(BALL.limit_normal(0.3, 1.0).normal, [0, 0, 1])
    assert np.allclose(np.linalg.norm(BALL.normal(0.2, [0.3, 0.6]), axis=-1), 1)
    smooth = ff.Surface(np.random.default_rng(0).normal(size=(6, 5, 3)), (3, 3)).continuity(0)
    assert [j.joint.c_order for j in smooth] == [2, 2]
    other = SAIL.next_c(0, "end", 1, [])
    assert ff.surface_joint(SAIL, (0, "end"), other, (0, "start")).c_order >= 1


def test_triangles():
    t = ff.TriangularPatch([[0, 0, 0], [0.5, 0, 1], [0, 0.5, 1], [1, 0, 0], [0.5, 0.5, 1], [0, 1, 0]])
    assert t.degree == 2 and np.allclose(t(0, 0), [0, 0, 0]) and t.evaluate([0.1, 0.2], 0.3, 1).shape == (2, 3, 3)
    assert np.allclose(t.elevate()(0.2, 0.3), t(0.2, 0.3)) and len(t.split_in_four()) == 4
    assert np.allclose(t.boundary(2)([0, 1]), [[0, 0, 0], [1, 0, 0]])
    s = t.to_surface()
    assert s.bound < 1e-14 and np.allclose(s.parts[0](0.5, 0.5), t(0.25, 0.25))
    with pytest.raises(ff.OutOfDomainError):
        t(0.8, 0.8)
    assert np.allclose(ff.point_normal_triangle(np.eye(3), np.eye(3)).patch(0, 0), [1, 0, 0])


def test_paths_and_regions():
    square, disc = ff.Path("M 0 0 H 2 V 2 H 0 Z"), ff.Path.ellipse([2, 1], 0.5)
    moon = ff.combine(square, disc, "difference", 1e-6)
    area = moon.path.area()
    assert abs(area.value - (4 - pi / 8)) < 1e-6 and area.bound < 1e-9
    assert abs(square.grow(0.5, 1e-6).path.area().value - (4 + 4 + pi / 4)) < 1e-3
    assert abs(ff.Path("M 0 0 H 3").stroke(0.5, 1e-6).path.area().value - 1.5) < 1e-9
    assert ff.Path(square.data) == square and square.curves()[0].degree == 1
    path, bound = ff.Path.of_curve(WAVE, 1e-3)
    assert bound == 0 and path.data.startswith("M")
    assert square.transform([[2, 0], [0, 2]]).area().value == 16
    with pytest.raises(ff.Refusal):
        ff.Path("M 0 0 L x")


def test_nearest_points_of_models_are_arrays():
    grid = np.moveaxis(np.mgrid[-1:3:4j, -1:2:3j, -1:4:3j], 0, -1)
    found = BOX.nearest(grid)
    assert isinstance(found, ff.ModelNearestPoints) and found.distance.shape == (4, 3, 3) and found.uv.shape == (4, 3, 3, 2)
    nearest = np.clip(grid, 0, [2, 1, 3])
    outside = (nearest != grid).any(axis=-1)
    assert outside.sum() > 30 and np.allclose(found.point[outside], nearest[outside], atol=1e-9)
    assert np.allclose(found.distance, np.linalg.norm(grid - found.point, axis=-1), atol=1e-12)
    assert (found.lower_bound <= found.distance).all() and (found.distance - found.lower_bound < 1e-6).all()
    assert set(found.face.flat) <= set(range(len(BOX.faces))) and found.face.dtype == np.int64
    # Before a corner, an edge and a face.
    three = BOX.nearest([[-1, -1, -1], [1, -1, -1], [1, 0.5, 4]])
    assert (three.vertex >= 0).tolist() == [True, False, False] and (three.edge >= 0).tolist() == [True, True, False]
    # As one at a time, and one of them.
    for i, p in enumerate([[-1, -1, -1], [1, -1, -1], [1, 0.5, 4]]):
        alone = BOX.nearest(p)
        assert alone.distance.shape == () and alone.point.shape == (3,) and alone.distance == three.distance[i]
        assert isinstance(three[i], ff.ModelNearest) and three[i].distance == three.distance[i] and three[i].face == three.face[i]
        assert three[i].edge == three.edge[i] and np.array_equal(three[i].point, three.point[i]) and np.array_equal(three[i].uv, three.uv[i])
    assert len(three) == 3 and [x.distance for x in three] == three.distance.tolist() and three == BOX.nearest(np.array(
        [[-1, -1, -1], [1, -1, -1], [1, 0.5, 4]]))
    assert BOX.nearest(np.zeros((0, 3))).distance.shape == (0,)
    with pytest.raises(ff.InvalidError, match="last extent is 2 and not 3"):
        BOX.nearest([[0, 0]])
    with pytest.raises(ff.NonFiniteError):
        BOX.nearest([[0, 0, np.nan]])
    with pytest.raises(TypeError, match=r"\(4, 3, 3\)"):
        found[0]


def test_models_and_meshes(tmp_path):
    t = BOX.tessellate(0.01)
    assert t.topology.open_edges == 0 and len(t.mesh) == 12 and t.error_bound <= 0.01
    m = t.mesh
    assert not m.points.flags.writeable and m.points.base is not None
    corners = m.points[m.faces]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert abs(volume - 6) < 1e-12
    assert np.asarray(m).shape == m.points.shape
    for ending in ("glb", "stl", "obj", "ply"):
        m.write(tmp_path / f"m.{ending}")
        assert len(ff.Mesh.read(tmp_path / f"m.{ending}")) == 12
    assert BOX.inside([[1, 0.5, 1], [5, 5, 5]], 1e-6)[0].place == "inside"
    near = BOX.nearest([[1, 0.5, 4]])[0]
    assert abs(near.distance - 1) < 1e-9 and near.lower_bound <= 1
    assert abs(BOX.section([0, 0, 1], -1.0, 0.01).area - 2) < 1e-9
    assert BOX.summary().solids == 1 and len(BOX.faces) == 6 and len(BOX.edges) == 12
    assert np.allclose(BOX.bounds(1e-9).box.hi, [2, 1, 3])
    assert sorted(round(x.value, 9) for x in BOX.edge_lengths())[0] == 1
    assert BOX.deviation(m, 1e-3).bound <= 1e-3
    square = np.stack([*np.meshgrid([0, 1, 2, 3], [0, 1, 2, 3], indexing="ij"), np.zeros((4, 4))], axis=-1)
    square[1, 1] += [0.5, 0.8, 0]  # parameter lines that are bent in their plane
    bent = ff.Model.assemble([ff.Surface(square)])
    assert len(bent.tessellate(1e-3, as_planes=True).mesh) == 2 < len(bent.tessellate(1e-3).mesh)
    ball = ff.Model.assemble([BALL])
    assert np.isfinite(ball.surface_field(ball.tessellate(0.05).mesh, "gauss").values).all()
    tri, distance, point = m.nearest([[1, 0.5, 4]])
    assert abs(distance[0] - 1) < 1e-12
    assert m.refine(0.5).topology().open_edges == 0
    assert len(ff.triangulate([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1], [1, 2], [2, 3], [3, 0]])) == 2


def test_a_region_along_a_rail_is_a_solid():
    s = ff.Model.along(ff.Path("M -1 -1 H 1 V 1 H -1 Z"), ff.Curve([[0, 0, 0], [0, 0, 9], [9, 0, 9]]), 1e-4)
    assert s.bound <= 1e-4 and s.model.summary().solids == 1 and s.model.tessellate(0.01).topology.open_edges == 0


def test_a_pipe_has_the_volume_of_its_disc_times_its_way():
    corners = [[0, 0, 0], [9, 0, 0], [9, 7, 0]]
    m = ff.Model.pipe(corners, 0.75, 0.5, bend=1.5)
    made = m.tessellate(1e-3)
    assert made.topology.open_edges == 0 and [f.kind for f in m.faces].count("torus") == 2
    a, b, c = made.mesh.points[made.mesh.vertex_points[made.mesh.triangles.T]]
    volume = (a * np.cross(b, c)).sum() / 6
    assert volume == pytest.approx((9 + 7 - 2 * 1.5 + 1.5 * pi / 2) * pi * (0.75**2 - 0.5**2), 1e-2)
    assert m.summary().solids == 1
    with pytest.raises(ff.InvalidError, match="needs an arc"):
        ff.Model.pipe(corners, 0.75)


def test_the_sphere_that_a_surface_lies_on_is_found():
    found = BALL.sphere(1e-9)
    assert found.off < 1e-12 and found.radius == pytest.approx(2, 1e-12)
    assert SAIL.sphere(1e-3) is None
    assert ff.sphere_through([[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0]]).radius == pytest.approx(1)
    assert ff.sphere_through([[1, 0, 0], [0, 1, 0], [0, 0, 0], [-1, 0, 0]]) is None


def test_a_model_that_is_not_closed_is_refused_a_side():
    with pytest.raises(ff.NoAnswerError):
        ff.Model.assemble([SAIL]).inside([[0, 0, 0]], 1e-3)


def test_trimmed_surfaces_decide_exactly():
    square = ff.Curve([[0.25, 0.25], [0.75, 0.25], [0.75, 0.75], [0.25, 0.75], [0.25, 0.25]], 1)
    s = ff.TrimmedSurface(SAIL, [[square]])
    assert s.inside([[0.5, 0.5], [0.1, 0.1], [0.25, 0.5]]) == ["inside", "outside", "boundary"]
    assert len(s.tessellate(0.01)) > 0
    assert ff.inside_loops([[square]], [[0.5, 0.5]])[1].tolist() == [1]


def test_files(tmp_path):
    d = ff.Document([WAVE, BALL, ff.Volume(np.zeros((2, 2, 2, 3)) + np.arange(3))], "mm", ["wave", "ball", "block"])
    d.write(tmp_path / "d.json")
    back = ff.read(tmp_path / "d.json")
    assert back.types == ["curve", "surface", "volume"] and back == d
    ff.write(tmp_path / "b.step", BALL)
    assert (tmp_path / "b.step").read_bytes().startswith(b"ISO-10303-21")
    ff.write(tmp_path / "b.iges", [WAVE, BALL])
    ff.write(tmp_path / "b.obj", BALL)
    assert ff.read(tmp_path / "b.obj").types == ["surface"]
    ff.write(tmp_path / "w.svg", WAVE, tolerance=1e-3)
    assert ff.read(tmp_path / "w.svg").types == ["curve"]
    ff.write(tmp_path / "b.stl", BALL, tolerance=0.01)
    assert len(ff.Mesh.read(tmp_path / "b.stl")) > 100
    (tmp_path / "p.csv").write_text("x,y\n0,0\n1,2\n")
    assert np.array_equal(ff.read_points(tmp_path / "p.csv"), [[0, 0], [1, 2]])


def test_drawings_and_views():
    svg = ff.draw(WAVE, control=True, comb=True)
    assert svg.startswith(b"<") and b"svg" in svg[:200]
    for format, magic in (("pdf", b"%PDF"), ("png", b"\x89PNG")):
        try:
            assert ff.draw(WAVE, format).startswith(magic)
        except ff.UnavailableError:
            pass
    assert "<svg" in WAVE._repr_svg_() and ff.Document([WAVE])._repr_svg_()
    try:
        picture = BOX.tessellate(0.1).mesh.render(width=64, height=48)
        assert picture.shape == (48, 64, 3) and picture.std() > 0
        mesh = BOX.tessellate(0.1).mesh
        assert mesh.pixel_size(width=640, height=480) * 5 < mesh.pixel_size(width=64, height=48)
        can_draw = True
    except ff.UnavailableError:
        can_draw = False
    square = ff.Curve([[0.25, 0.25], [0.75, 0.25], [0.75, 0.75], [0.25, 0.75], [0.25, 0.25]], 1)
    dome = ff.TriangularPatch([[0, 0, 0], [0.5, 0, 1], [0, 0.5, 1], [1, 0, 0], [0.5, 0.5, 1], [0, 1, 0]])
    for x in (BALL, BOX, BOX.tessellate(0.1).mesh, ff.Document([BALL]), ff.TrimmedSurface(SAIL, [[square]]), dome):
        page = x._repr_html_()
        assert page.startswith("<iframe") and "http" not in page.replace("http-equiv", "")
        png = x._repr_png_()
        assert png.startswith(b"\x89PNG") and len(png) > 500 if can_draw else png is None


def test_animation():
    ease = ff.CubicBezierEasing("ease-in-out")
    assert np.allclose(ease([0, 0.5, 1]), [0, 0.5, 1])
    assert ff.step_easing([0.1, 0.6], 2).tolist() == [0, 0.5]
    track = ff.Track([ff.Key(0, [0.0, 1.0]), ff.Key(2, [4.0, 1.0])])
    assert np.allclose(track([1, 5]), [[2, 1], [4, 1]])
    turns = ff.RotationTrack([0, 1], [(0, 0, 0, 1), ff.turn_about([0, 0, 1], pi / 2)])
    assert np.allclose(ff.rotated(turns(0.5), [1, 0, 0]), [2**-0.5, 2**-0.5, 0])
    motion = ff.Motion.limited(10, 2, 1, 4)
    assert abs(motion(motion.duration).distance - 10) < 1e-9
    # Round a quarter of the unit circle: v^2 <= across, and the ends take v / acceleration each.
    quarter = ff.Curve([[1, 0], [1, 1], [0, 1]], weights=[1, 2**-0.5, 1])
    slow = ff.Motion.along(quarter, 1e-9, acceleration=8, across=1)
    assert ff.Motion.along(quarter, 1e-9, acceleration=8, across=1, jerk=9).duration > slow.duration
    assert abs(slow(slow.duration / 2).speed - 1) < 0.02 and slow(slow.duration / 2).speed <= 1
    assert abs(slow.duration - (pi / 2 + 1 / 8)) < 0.03
    assert ff.Motion.along(quarter, 1e-9, speed=0.5).duration == pytest.approx(pi, 1e-9)
    with pytest.raises(ff.Refusal):
        ff.Motion.along(quarter, 1e-9)
    way = ff.Trajectory(WAVE, ff.Motion.uniform(WAVE.length(1e-9).value, 2), 1e-6, facing="upright")
    assert np.allclose(way(2).point, [4, 0, 0], atol=1e-5)


def test_animations_are_written_as_they_are_read():
    way = ff.Trajectory(WAVE, ff.Motion.uniform(WAVE.length(1e-9).value, 2), 1e-6, facing="upright")
    times = np.linspace(0, way.duration, 9)
    states = [way(t) for t in times]
    places = [s.point for s in states]
    velocities = [s.speed * s.tangent for s in states]
    data = ff.to_animated_glb(times, places, velocities, [s.facing for s in states], places, name="cart", size=0.2)
    (animation,) = ff.read_gltf_animations(data)
    moved, turned = animation.channels
    assert (moved.node, moved.path, moved.interpolation) == ("cart", "translation", "cubic_spline")
    assert np.allclose(moved.times, times) and np.allclose(np.reshape(moved.values, (9, 3, 3))[:, 1], places, atol=1e-6)
    assert np.allclose(np.reshape(moved.values, (9, 3, 3))[:, 2], velocities, atol=1e-6)
    assert turned.path == "rotation" and np.allclose(
        np.reshape(turned.values, (9, 4)), [[q.x, q.y, q.z, q.w] for q in (s.facing for s in states)], atol=1e-6)
    assert np.allclose(ff.rotated(states[3].facing, [1, 0, 0]), states[3].tangent)
    assert len(ff.read_gltf_animations(ff.to_animated_glb(times, places, velocities))[0].channels) == 1
    with pytest.raises(ff.InvalidError):
        ff.to_animated_glb(times, places[1:], velocities)
    with pytest.raises(ff.InvalidError):
        ff.to_animated_glb(times, [[0, 0]] * 9, velocities)


def test_colours():
    g = ff.Gradient([(0, "#000000"), (1, "#ffffff")])
    assert np.allclose(g([0, 1]), [[0, 0, 0, 1], [1, 1, 1, 1]])
    assert ff.hex_of("#12ab9f") == "#12ab9f" and ff.colour_map([0, 1]).shape == (2, 4)
    assert ff.oklab_distance("#000000", "#ffffff") > 0.9
    mesh = ff.MeshGradient(ff.Surface([[[0, 0], [0, 1]], [[1, 0], [1, 1]]]), ["#ff0000", "#00ff00", "#0000ff", "#ffffff"])
    assert mesh.picture(16).shape == (16, 16, 3) and mesh.colour(0, 0) == (1, 0, 0, 1)


def test_fonts():
    try:
        font = ff.Font("DejaVu Sans")
    except (ff.UnavailableError, ff.NoAnswerError) as why:
        pytest.skip(str(why))
    assert font.info.family == "DejaVu Sans" and font.index_of("A") > 0
    paths = font.outlines("Ag", 10)
    assert len(paths) == 2 and paths[0].area().value != 0
    solid = ff.Model.prism(paths[0], (0, 0, 2))
    assert solid.tessellate(0.05).topology.open_edges == 0
