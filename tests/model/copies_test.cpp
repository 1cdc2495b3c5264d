// Parts that are copies of each other are meshed once, and say what holds of them all.
#include "model/copies_detail.hpp"
#include "support/random.hpp"
#include "support/shapes.hpp"
#include "support/solids.hpp"

#include <freiform/core/parallel.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Random;

RigidMotion any_motion(Random& random, double far) {
    const auto direction = [&] {
        return unit(Vec<3>{{random.real(-1, 1), random.real(-1, 1), random.real(0.1, 1)}});
    };
    const Vec<3> z = direction(), x = unit(cross(direction(), z)), y = cross(z, x);
    RigidMotion m;
    m.turn = {x, y, z};
    m.offset = {{random.real(-far, far), random.real(-far, far), random.real(-far, far)}};
    return m;
}

template <std::size_t N, class P>
Patch<N, P> moved(const Patch<N, P>& patch, const RigidMotion& by) {
    auto points = patch.net();
    for (P& p : points.flat())
        if constexpr (Space<P>::kRational)
            p = weighted(by(Space<P>::project(p)), p.weight());
        else
            p = by(p);
    return Patch<N, P>::trusted(patch.bases(), std::move(points));
}

CurveGeometry<3> moved(const CurveGeometry<3>& curve, const RigidMotion& by) {
    if (const auto* l = std::get_if<Line<3>>(&curve)) return Line<3>{by(l->origin), by.turned(l->direction)};
    if (const auto* s = std::get_if<Curve<Vec<3>>>(&curve)) return moved(*s, by);
    if (const auto* s = std::get_if<Curve<Hom<3>>>(&curve)) return moved(*s, by);
    const auto& c = std::get<Conic<3>>(curve);
    return Conic<3>{c.kind, by(c.centre), by.turned(c.x), by.turned(c.y)};
}

SurfaceGeometry moved(const SurfaceGeometry& surface, const RigidMotion& by) {
    if (const auto* e = std::get_if<Extrusion>(&surface))
        return Extrusion{moved(e->profile, by), by.turned(e->direction), e->kind};
    if (const auto* r = std::get_if<Revolution>(&surface))
        return Revolution{moved(r->profile, by), by(r->origin), by.turned(r->axis), r->kind};
    if (const auto* p = std::get_if<Surface<Vec<3>>>(&surface)) return moved(*p, by);
    return moved(std::get<Surface<Hom<3>>>(surface), by);
}

// Adds a part, moved.
void add(Model& model, const Model& part, const RigidMotion& by) {
    const int vertices = int(model.vertices.size()), edges = int(model.edges.size()),
              faces = int(model.faces.size()), shells = int(model.shells.size());
    for (Vertex v : part.vertices) {
        v.point = by(v.point);
        model.vertices.push_back(v);
    }
    for (Edge e : part.edges) {
        e.start += vertices, e.end += vertices;
        if (e.curve) e.curve = moved(*e.curve, by);
        model.edges.push_back(e);
    }
    for (Face f : part.faces) {
        f.surface = moved(f.surface, by);
        for (Loop& l : f.loops)
            for (Coedge& c : l.coedges) c.edge += edges;
        f.name = "face " + std::to_string(model.faces.size());
        model.faces.push_back(f);
    }
    for (Shell s : part.shells) {
        for (FaceUse& u : s.faces) u.face += faces;
        model.shells.push_back(s);
    }
    for (Body b : part.bodies) {
        for (int& s : b.shells) s += shells;
        b.colour = Colour{0.25 * (shells % 4), 0.5, 0.5};
        model.bodies.push_back(b);
    }
}

std::vector<Model> parts() {
    return {test::frustum(2, 1, 3), test::torus(3, 1), test::sphere({{1, 2, 3}}, 2)};
}

Model assembly(Random& random, int each, double far) {
    Model out;
    for (int k = 0; k < each; ++k)
        for (const Model& p : parts()) add(out, p, any_motion(random, far));
    return *make_model(std::move(out));
}

TEST(Copies, of_parts_are_found_wherever_they_are) {
    Random random(5);
    for (const double far : {0.0, 10.0, 1e6}) {
        const Model m = assembly(random, 4, far);
        const Copies copies = copies_in(m);
        const std::size_t faces = m.faces.size() / 4;
        EXPECT_EQ(copies.motions.size(), 9u);
        for (std::size_t f = 0; f < m.faces.size(); ++f) {
            const FaceCopy& c = copies.faces[f];
            EXPECT_EQ(c.of, f < faces ? -1 : int(f % faces));
            if (c.of < 0) continue;
            // At samples, the copy is where the motion puts the face.
            for (int k = 0; k < 20; ++k) {
                const Param<2> at{random.real(0, 1), random.real(-1, 1)};
                const Vec<3> here = jet<0>(m.faces[f].surface, at).value(),
                             there = copies.motions[std::size_t(c.motion)](
                                 jet<0>(m.faces[std::size_t(c.of)].surface, at).value());
                EXPECT_LE(norm(here - there), c.apart);
                EXPECT_LE(c.apart, 1e-12 * (10 + far));
            }
        }
    }
}

template <class P>
Model sail(Random& random) {
    const auto basis = *BSplineBasis::clamped_uniform(3, 5);
    std::vector<P> c;
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 5; ++k) {
            const Vec<3> p{{double(i), double(k), random.real(-1, 1)}};
            if constexpr (Space<P>::kRational)
                c.push_back(weighted(p, random.chance(0.5) ? 1.0 : 2.0));
            else
                c.push_back(p);
        }
    ModelBuilder builder;
    EXPECT_TRUE(builder.add(*Surface<P>::make({basis, basis}, Net<2, P>({5, 5}, c))));
    return *std::move(builder).finish();
}

TEST(Copies, of_splines_have_their_knots_and_weights) {
    Random random(10);
    for (const Model& part : {sail<Vec<3>>(random), sail<Hom<3>>(random)}) {
        Model m;
        for (int k = 0; k < 3; ++k) add(m, part, any_motion(random, 10));
        const Copies copies = copies_in(m);
        ASSERT_EQ(copies.motions.size(), 2u);
        const auto t = tessellate(m, {.tolerance = 1e-2});
        ASSERT_TRUE(t);
        EXPECT_LE(t->error_bound, 1e-2);
        EXPECT_LE(test::sampled_deviation(m, *t), t->error_bound + t->boundary_gap);
        // Another weight, another control point: another surface.
        if (auto* s = std::get_if<Surface<Hom<3>>>(&m.faces[1].surface)) {
            auto points = s->net();
            points.flat()[7] = weighted(Space<Hom<3>>::project(points.flat()[7]), 1.5);
            m.faces[1].surface = Surface<Hom<3>>::trusted(s->bases(), std::move(points));
        } else {
            auto points = std::get<Surface<Vec<3>>>(m.faces[1].surface).net();
            points.flat()[7][2] += 1e-8;
            m.faces[1].surface =
                Surface<Vec<3>>::trusted(std::get<Surface<Vec<3>>>(m.faces[1].surface).bases(), points);
        }
        EXPECT_EQ(copies_in(m).motions.size(), 1u);
        EXPECT_EQ(copies_in(m).faces[2].of, 0);
    }
}

TEST(Copies, are_meshed_as_the_part_was_and_keep_the_bound) {
    Random random(6);
    const Model m = assembly(random, 3, 20);
    for (const double tolerance : {0.1, 0.01}) {
        const auto t = tessellate(m, {.tolerance = tolerance});
        ASSERT_TRUE(t);
        EXPECT_EQ(t->topology.open_edges + t->topology.misoriented_edges, 0);
        EXPECT_EQ(t->topology.non_manifold_edges + t->topology.degenerate_triangles, 0);
        EXPECT_LE(t->error_bound, tolerance);
        EXPECT_LE(test::sampled_deviation(m, *t), t->error_bound + t->boundary_gap);
        ASSERT_EQ(t->mesh.parts.size(), m.faces.size());
        const std::size_t each = m.faces.size() / 3;
        for (std::size_t f = 0; f < m.faces.size(); ++f) {
            const MeshPart& part = t->mesh.parts[f];
            EXPECT_EQ(part.face, int(f));
            EXPECT_EQ(t->faces[f].face, int(f));
            EXPECT_EQ(part.name, m.faces[f].name);
            EXPECT_EQ(part.count, t->mesh.parts[f % each].count);
            EXPECT_EQ(part.count, t->faces[f].triangles);
            ASSERT_TRUE(part.colour);
        }
        for (std::size_t i = 0; i < t->mesh.triangles.size(); ++i)
            for (const int v : t->mesh.triangles[i])
                EXPECT_GT(dot(triangle_normal(t->mesh, i), t->mesh.vertices[std::size_t(v)].normal), 0.2);
        ASSERT_TRUE(validate(t->mesh));
    }
}

TEST(Copies, are_not_what_differs_a_little_or_is_mirrored) {
    Random random(7);
    const Model part = test::frustum(2, 1, 3), longer = test::frustum(2, 1, 3 + 1e-7);
    Model m;
    add(m, part, any_motion(random, 5));
    add(m, longer, any_motion(random, 5));
    EXPECT_FALSE(copies_in(m).any());
    Model moved_knot;
    add(moved_knot, part, any_motion(random, 5));
    add(moved_knot, part, any_motion(random, 5));
    EXPECT_TRUE(copies_in(moved_knot).any());
    moved_knot.edges.back().range.hi = std::nextafter(moved_knot.edges.back().range.hi, 10.0);
    EXPECT_FALSE(copies_in(moved_knot).any());
    // Turned inside out.
    Model mirrored;
    add(mirrored, part, any_motion(random, 5));
    RigidMotion mirror = any_motion(random, 5);
    mirror.turn[0] = -mirror.turn[0];
    add(mirrored, part, mirror);
    EXPECT_FALSE(copies_in(mirrored).any());
}

TEST(Copies, count_for_the_budget_and_are_refused_with_their_part) {
    Random random(8);
    Model m;
    for (int k = 0; k < 3; ++k) add(m, test::torus(3, 1), any_motion(random, 5));
    const auto all = tessellate(m, {.tolerance = 0.01});
    ASSERT_TRUE(all);
    const auto count = (long long)(all->mesh.triangles.size());
    EXPECT_TRUE(tessellate(m, {.tolerance = 0.01, .max_triangles = count}));
    const auto few = tessellate(m, {.tolerance = 0.01, .max_triangles = count - 1});
    ASSERT_FALSE(few);
    EXPECT_EQ(few.error().kind, RefusalKind::limit);
    for (Face& f : m.faces) f.loops[0].coedges.pop_back();  // open now
    const auto open = tessellate(m, {.tolerance = 0.01});
    ASSERT_TRUE(open);
    ASSERT_EQ(open->refused.size(), 3u);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(open->refused[std::size_t(k)].face, k);
    EXPECT_EQ(open->refused[2].name, "face 2");
    EXPECT_EQ(open->refused[2].reason.message, "a copy of faces[0]: " + open->refused[0].reason.message);
}

TEST(Copies, are_the_same_for_any_number_of_threads_and_in_company) {
    Random random(9);
    const Model m = assembly(random, 2, 20);
    set_max_threads(1);
    const auto one = tessellate(m, {.tolerance = 0.01});
    set_max_threads(2);
    const std::vector<TessellateOptions> both{{.tolerance = 0.05}, {.tolerance = 0.01}};
    const auto two = tessellate(m, both);
    set_max_threads(0);
    ASSERT_TRUE(one && two[1]);
    EXPECT_EQ(one->mesh.points, two[1]->mesh.points);
    EXPECT_EQ(one->mesh.triangles, two[1]->mesh.triangles);
    EXPECT_EQ(one->error_bound, two[1]->error_bound);
}

}  // namespace
}  // namespace freiform
