// Models of edges alone, as STEP files and back.
#include <freiform/io/read.hpp>
#include <freiform/io/step.hpp>
#include <freiform/io/step_read.hpp>

#include <numbers>
#include <support/corpus.hpp>
#include <support/random.hpp>
#include <support/sanitizer.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

// A net of edges between shared vertices: lines, arcs, splines, rational ones, and whole circles.
Model random_net(Random& r) {
    Model m;
    m.unit = "mm";
    for (int i = 0, n = r.integer(2, 9); i < n; ++i)
        m.vertices.push_back({{{r.real(-5, 5), r.real(-5, 5), r.real(-5, 5)}}, 0});
    const auto add = [&](CurveGeometry<3> curve, Interval on, int from, int to) {
        m.edges.push_back({std::move(curve), false, on, from, to, 0, r.chance(0.5) ? "edge 'one'" : ""});
    };
    for (int i = 0, n = r.integer(1, 12); i < n; ++i) {
        const int a = r.integer(0, int(m.vertices.size()) - 1), b = (a + 1) % int(m.vertices.size());
        const Vec<3> p = m.vertices[std::size_t(a)].point, q = m.vertices[std::size_t(b)].point;
        const int kind = r.integer(0, 3);
        if (kind == 0) {
            add(Line<3>{p, unit(q - p)}, {0, norm(q - p)}, a, b);
        } else if (kind == 1) {  // through p, where it begins and ends
            const Vec<3> x = unit(q - p), y = unit(cross(x, Vec<3>{{0.3, 0.4, 0.5}}));
            const double radius = r.real(0.1, 2);
            add(Conic<3>{ConicKind::ellipse, p - radius * x, radius * x, radius * y},
                {0, 2 * std::numbers::pi}, a, a);
        } else if (kind == 2) {
            add(*Curve<Vec<3>>::make(
                    {*BSplineBasis::make(2, std::vector{0., 0., 0., 0.3, 1., 1., 1.})},
                    Net<1, Vec<3>>({4}, {p, p + Vec<3>{{1, 0, 2}}, q - Vec<3>{{0, 1, 1}}, q})),
                {0, 1}, a, b);
        } else {
            add(*Curve<Hom<3>>::make(
                    {*BSplineBasis::bezier(2)},
                    Net<1, Hom<3>>({3}, {weighted(p, 1), weighted(p + Vec<3>{{0, 2, 0}}, r.real(0.3, 3)),
                                         weighted(q, 1)})),
                {0, 1}, a, b);
        }
    }
    return m;
}

// The parts of the model that are used, in the order of their use.
Model in_order_of_use(const Model& m) {
    Model out = m;
    out.vertices.clear();
    std::vector<int> at(m.vertices.size(), -1);
    for (Edge& e : out.edges)
        for (int* v : {&e.start, &e.end}) {
            int& k = at[std::size_t(*v)];
            if (k < 0) k = int(out.vertices.size()), out.vertices.push_back(m.vertices[std::size_t(*v)]);
            *v = k;
        }
    return out;
}

TEST(StepWires, come_back_with_their_vertices_shared) {
    Random r(23);
    for (int i = 0; i < cases(300); ++i) {
        SCOPED_TRACE(i);
        const Model m = in_order_of_use(random_net(r));
        const Model back = must(read_step(must(write_step(Document{"mm", {{"net", m, {}}}}))));
        EXPECT_TRUE(back.refused.empty());
        EXPECT_TRUE(back.faces.empty());
        ASSERT_EQ(back.vertices.size(), m.vertices.size());
        ASSERT_EQ(back.edges.size(), m.edges.size());
        for (std::size_t k = 0; k < m.vertices.size(); ++k)
            EXPECT_EQ(back.vertices[k].point, m.vertices[k].point);
        for (std::size_t k = 0; k < m.edges.size(); ++k) {
            const Edge &a = m.edges[k], &b = back.edges[k];
            EXPECT_EQ(a.start, b.start);
            EXPECT_EQ(a.end, b.end);
            EXPECT_EQ(a.name, b.name);
            ASSERT_EQ(a.curve->index(), b.curve->index());
            if (const auto* s = std::get_if<Curve<Vec<3>>>(&*a.curve)) {
                EXPECT_EQ(*s, std::get<Curve<Vec<3>>>(*b.curve));
            } else if (const auto* h = std::get_if<Curve<Hom<3>>>(&*a.curve)) {
                EXPECT_EQ(*h, std::get<Curve<Hom<3>>>(*b.curve));
            }
            for (const double t : {0.0, 0.25, 0.5, 1.0})
                EXPECT_LT(norm(jet<0>(*a.curve, a.range.lo + t * a.range.length()).value() -
                               jet<0>(*b.curve, b.range.lo + t * b.range.length()).value()),
                          1e-13);
        }
    }
}

TEST(StepWires, of_several_objects_and_beside_solids_are_written) {
    Model cross;
    cross.unit = "mm";
    cross.vertices = {{{{9, 0, 0}}, 0}, {{{9, 0, 1}}, 0}};
    cross.edges = {{Line<3>{{{9, 0, 0}}, {{0, 0, 1}}}, false, {0, 1}, 0, 1, 0, ""}};
    const Model two = must(read_step(must(write_step(Document{"mm", {{"a", cross, {}}, {"b", cross, {}}}}))));
    EXPECT_EQ(two.edges.size(), 2u);
    EXPECT_EQ(two.vertices.size(), 4u);

    const std::string text =
        must(write_step(Document{"mm", {{"", sphere(Vec<3>{}, 1), {}}, {"wire", cross, {}}}}));
    EXPECT_NE(text.find("MANIFOLD_SOLID_BREP"), std::string::npos);
    EXPECT_NE(text.find("EDGE_BASED_WIREFRAME_MODEL('wire'"), std::string::npos);
    const Model mixed = must(read_step(text));  // which leaves them out, and says so
    EXPECT_EQ(mixed.faces.size(), 1u);
    ASSERT_EQ(mixed.refused.size(), 1u);
    EXPECT_NE(mixed.refused[0].message.find("1 curve that bounds no face"), std::string::npos);

    Model loose = sphere(Vec<3>{}, 1);  // an edge of the same model
    loose.vertices.insert(loose.vertices.end(), cross.vertices.begin(), cross.vertices.end());
    loose.edges.push_back(cross.edges[0]);
    loose.edges.back().start = 2, loose.edges.back().end = 3;
    EXPECT_NE(must(write_step(Document{"mm", {{"", loose, {}}}})).find("EDGE_BASED_WIREFRAME_MODEL"),
              std::string::npos);
}

TEST(StepWires, that_say_too_little_are_refused) {
    Model m;
    m.unit = "mm";
    m.vertices = {{{{0, 0, 0}}, 0}, {{{1, 0, 0}}, 0}};
    m.edges = {{{}, false, {0, 1}, 0, 1, 0, ""}};
    const auto no_curve = write_step(Document{"mm", {{"net", m, {}}}});
    ASSERT_FALSE(no_curve);
    EXPECT_EQ(no_curve.error().kind, RefusalKind::unsupported);
    EXPECT_NE(no_curve.error().where.find("edges[0]"), std::string::npos) << no_curve.error().where;
    m.edges[0].curve = Line<3>{{{0, 0, 0}}, {{1, 0, 0}}};
    const auto units = write_step(Document{"inch", {{"net", m, {}}}});
    ASSERT_FALSE(units);
    EXPECT_NE(units.error().message.find("mm"), std::string::npos) << units.error().message;
    EXPECT_FALSE(write_step(Document{"mm", {{"", Model{}, {}}}}));
}

TEST(StepWires, of_files_share_vertices_that_the_file_shares) {
    FF_CORPUS_OR_SKIP(path, "step_micro/ap203_topology_wireframes.stp");
    const Document read = must(read_any(path.string()));
    const Model& m = std::get<Model>(read.objects.at(0).shape);
    EXPECT_EQ(m.edges.size(), 4u);
    EXPECT_EQ(m.vertices.size(), 6u);
}

}  // namespace
}  // namespace freiform::test
