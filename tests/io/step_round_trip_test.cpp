// Random models as STEP, and read again by the library's own reader.
//
// Equal means: as many bodies, solids, shells, faces, loops, edges and vertices; and to the last bit the
// points of all vertices, the control points, weights and knots of all spline surfaces, of the profiles of
// extrusions and revolutions, and of all edges that are splines in space. Lines, conics and axes are written
// as the standard has them, with directions of length 1, and are equal up to rounding. Parameter curves are
// made anew, and so are seams and poles.
#include "io/step_elementary.hpp"

#include <freiform/io/scene.hpp>
#include <freiform/io/step.hpp>
#include <freiform/io/step_read.hpp>
#include <freiform/model/swept_solid.hpp>

#include <algorithm>
#include <cstdlib>
#include <io/step_elementary.hpp>
#include <io/step_part21.hpp>
#include <map>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/sanitizer.hpp>
#include <support/solids.hpp>
#include <support/step_items.hpp>
#include <support/step_measures.hpp>
#include <support/step_polygons.hpp>
#include <support/trimmed_faces.hpp>

namespace freiform::test {
namespace {

using Numbers = std::vector<double>;

template <class S>
Numbers bits_of(const S& s) {
    Numbers out;
    for (int axis = 0; axis < int(S::kParams); ++axis) {
        out.push_back(s.basis(axis).degree());
        for (const double t : s.basis(axis).knots()) out.push_back(t);
    }
    for (const auto& p : s.net().flat())
        for (std::size_t i = 0; i < p.c.size(); ++i) out.push_back(p.c[i]);
    return out;
}

// What has to come back with the same bits, in any order; what is elementary is counted.
struct Bits {
    std::vector<Numbers> vertices, surfaces, curves;
    std::map<std::string, int> counts;

    explicit Bits(const Model& m) {
        std::vector<char> used(m.edges.size(), 0), corner(m.vertices.size(), 0);
        for (const Face& f : m.faces) {
            counts["loops"] += int(f.loops.size());
            counts["reversed"] += f.reversed;
            counts["kind " + std::to_string(f.surface.index())]++;
            surface(f.surface);
            for (const Loop& l : f.loops)
                for (const Coedge& c : l.coedges) used[std::size_t(c.edge)] = 1;
        }
        for (std::size_t i = 0; i < m.edges.size(); ++i) {
            const Edge& e = m.edges[i];
            if (!used[i] || e.degenerate) continue;
            counts["edges"]++;
            corner[std::size_t(e.start)] = corner[std::size_t(e.end)] = 1;
            if (e.curve) curve(*e.curve, curves, "elementary edges");
        }
        for (std::size_t i = 0; i < m.vertices.size(); ++i)
            if (const Vec<3>& p = m.vertices[i].point; corner[i]) vertices.push_back({p[0], p[1], p[2]});
        counts["shells"] = int(m.shells.size());
        for (const Shell& shell : m.shells) {
            int turned = 0;
            for (const FaceUse& u : shell.faces) turned += u.reversed;
            counts["shells with " + std::to_string(turned) + " turned faces"]++;
        }
        counts["bodies"] = int(m.bodies.size());
        counts["solids"] = int(std::ranges::count_if(m.bodies, [](const Body& b) { return b.solid; }));
        for (auto* list : {&vertices, &surfaces, &curves}) std::ranges::sort(*list);
    }

private:
    void curve(const CurveGeometry<3>& c, std::vector<Numbers>& to, const char* elementary) {
        std::visit(
            [&](const auto& g) {
                if constexpr (requires { g.net(); })
                    to.push_back(bits_of(g));
                else
                    counts[elementary]++;
            },
            c);
    }
    void surface(const SurfaceGeometry& s) {
        std::visit(
            [&](const auto& g) {
                if constexpr (requires { g.net(); })
                    surfaces.push_back(bits_of(g));
                else if constexpr (requires { g.profile; })
                    curve(g.profile, surfaces, "elementary profiles");
            },
            s);
    }
};

void expect_equal(const Model& written, const Model& read, bool space_curves) {
    const Bits a(written), b(read);
    EXPECT_EQ(a.counts.size(), b.counts.size());
    for (const auto& [what, n] : a.counts)
        if (space_curves || what != "elementary edges")
            EXPECT_EQ(n, b.counts.contains(what) ? b.counts.at(what) : 0) << what;
    EXPECT_EQ(a.vertices, b.vertices) << "vertices";
    EXPECT_EQ(a.surfaces, b.surfaces) << "surfaces";
    if (space_curves) EXPECT_EQ(a.curves, b.curves) << "edges";
}

// A star of lines, parabolas and cubics around (x, y), polynomial and rational ones.
std::vector<CurveGeometry<2>> random_star(Random& r, Vec<2> middle, double radius) {
    const int n = r.integer(5, 8);
    std::vector<Vec<2>> corners;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * kPi * (i + r.real(-0.2, 0.2)) / n, far = radius * r.real(0.8, 1.2);
        corners.push_back(middle + far * Vec<2>{{std::cos(angle), std::sin(angle)}});
    }
    std::vector<CurveGeometry<2>> loop;
    for (int i = 0; i < n; ++i) {
        const Vec<2> a = corners[std::size_t(i)], b = corners[std::size_t((i + 1) % n)], d = b - a;
        const Vec<2> aside = r.real(0.02, 0.1) * Vec<2>{{d[1], -d[0]}};
        const int degree = r.integer(1, 3);
        std::vector<Vec<2>> net{a};
        for (int k = 1; k < degree; ++k) net.push_back(a + (double(k) / degree) * d + aside);
        net.push_back(b);
        const auto basis = must(BSplineBasis::clamped_uniform(degree, degree + 1));
        if (degree < 2 || r.chance(0.5)) {
            loop.push_back(must(Curve<Vec<2>>::make({basis}, Net<1, Vec<2>>({degree + 1}, net))));
            continue;
        }
        std::vector<Hom<2>> weighted_net;
        for (std::size_t k = 0; k < net.size(); ++k)
            weighted_net.push_back(
                weighted(net[k], k == 0 || k + 1 == net.size() ? 1.0 : std::ldexp(1.0, r.integer(-1, 1))));
        loop.push_back(must(Curve<Hom<2>>::make({basis}, Net<1, Hom<2>>({degree + 1}, weighted_net))));
    }
    return loop;
}

RegionLoops random_region(Random& r, Vec<2> middle) {
    RegionLoops loops{random_star(r, middle, 1)};
    if (r.chance(0.5)) loops.push_back(random_star(r, middle, 0.2));
    return loops;
}

template <class P>
Shape random_spline(Random& r) {
    const auto basis = [&](int degree, int size) {
        Numbers t(std::size_t(degree) + 1, r.real(-2, 0));
        for (int i = 0; i < size - degree - 1; ++i) t.push_back(t.back() + r.real(0.1, 1));
        t.insert(t.end(), std::size_t(degree) + 1, t.back() + r.real(0.1, 1));
        return must(BSplineBasis::make(degree, std::move(t)));
    };
    const int p = r.integer(1, 5), q = r.integer(1, 4), nu = p + r.integer(1, 5), nv = q + r.integer(1, 4);
    std::vector<P> net;
    for (int i = 0; i < nu * nv; ++i) {
        const Vec<3> x{{i / nv + r.real(-0.3, 0.3), i % nv + r.real(-0.3, 0.3), r.real(-0.5, 0.5)}};
        if constexpr (Space<P>::kRational)
            net.push_back(weighted(x, std::ldexp(1.0, r.integer(-1, 1))));
        else
            net.push_back(x);
    }
    return must(Surface<P>::make({basis(p, nu), basis(q, nv)}, Net<2, P>({nu, nv}, std::move(net))));
}

Shape random_shape(Random& r, TrimmedFaces& trimmed, int i) {
    switch (i % 8) {
        case 0:
            return random_spline<Vec<3>>(r);
        case 1:
            return random_spline<Hom<3>>(r);
        case 2:
        case 3:
            return must(
                prism(random_region(r, {{r.real(-9, 9), r.real(-9, 9)}}),
                      {{r.real(-1, 1), r.real(-1, 1), r.chance(0.5) ? r.real(0.5, 4) : -r.real(0.5, 4)}}));
        case 4:
            return must(solid_of_revolution(random_region(r, {{r.real(2, 9), r.real(-9, 9)}}),
                                            {{{0, 0, 0}}, {{0, r.chance(0.5) ? 1.0 : -1.0, 0}}},
                                            r.chance(0.4) ? 2 * kPi : r.real(0.3, 6)));
        case 5:
            return sphere({{r.real(-9, 9), r.real(-9, 9), r.real(-9, 9)}}, r.real(0.1, 10));
        case 6:
            return r.chance(0.5)
                       ? torus(r.real(2, 9), r.real(0.1, 1.5))
                       : frustum(r.real(0.5, 5), r.chance(0.3) ? 0 : r.real(0.5, 5), r.real(0.2, 9));
        default:
            for (;;)
                if (TrimmedFace f = trimmed.next(); f.nasty == Nasty::none) return std::move(f.model);
    }
}

TEST(StepRoundTrip, random_models_come_back_equal_to_the_last_bit) {
    const char* named = std::getenv("FREIFORM_STEP_ROUND_TRIPS");
    const int count = named != nullptr ? std::atoi(named) : kAddressSanitizer ? 400 : 1'000;
    Random r(1299);
    TrimmedFaces trimmed(77);
    for (int i = 0; i < count; ++i) {
        SCOPED_TRACE(i);
        const bool space_curves = i % 8 != 7;
        const Document d{"mm", {{"", random_shape(r, trimmed, i), {}}}};
        const Model written = must(scene_of(d));
        const Model read = must(read_step(must(write_step(d))));
        EXPECT_TRUE(read.refused.empty()) << read.refused[0].where << ": " << read.refused[0].message;
        expect_equal(written, read, space_curves);
        // Once read, it is what was written in everything that is not made anew.
        const Model again = must(read_step(must(write_step(Document{"mm", {{"", read, {}}}}))));
        expect_equal(read, again, true);
        if (HasFailure()) break;
    }
}

// Hollows are bounded by faces that are used from behind; in other shells some may be.
TEST(StepRoundTrip, faces_stay_turned_as_their_shells_use_them) {
    Random r(1300);
    TrimmedFaces trimmed(78);
    for (int i = 0; i < 24; ++i) {
        SCOPED_TRACE(i);
        Model m = must(scene_of(Document{"mm", {{"", random_shape(r, trimmed, i % 7), {}}}}));
        const bool some = r.chance(0.5);
        for (Shell& shell : m.shells)
            for (FaceUse& u : shell.faces) u.reversed = !some || r.chance(0.5);
        const Model read = must(read_step(must(write_step(Document{"mm", {{"", m, {}}}}))));
        expect_equal(m, read, true);
    }
}

// Turned by any angles, whose directions are not exact.
TEST(StepRoundTrip, cylinders_cones_spheres_and_tori_stay_what_they_are_called) {
    Random r(41);
    const char* kinds[][2] = {{"CYLINDRICAL_SURFACE", "2.5"},  {"CONICAL_SURFACE", "2.5,0.4"},
                              {"CONICAL_SURFACE", "2.5,-0.4"}, {"CONICAL_SURFACE", "0.,0.4"},
                              {"SPHERICAL_SURFACE", "2.5"},    {"TOROIDAL_SURFACE", "5.,2.5"}};
    for (int i = 0; i < 300; ++i) {
        const auto [name, sizes] = kinds[i % 6];
        const bool narrows = i % 6 == 2;
        const double far = i < 150 ? 100 : 1e4;
        SCOPED_TRACE(text(i, " ", name, " ", sizes));
        const auto triple = [&](double size) {
            return text("(", size * r.real(-1, 1), ",", size * r.real(-1, 1), ",", size * r.real(-1, 1), ")");
        };
        const Model m = items_model(
            "#10", text("#10=GEOMETRIC_SET('',(#11));\n#11=RECTANGULAR_TRIMMED_SURFACE('',#12,0.5,2.,0.25,1.,"
                        ".T.,.T.);\n"
                        "#12=",
                        name, "('',#13,", sizes,
                        ");\n#13=AXIS2_PLACEMENT_3D('',#14,#15,#16);\n#14=CARTESIAN_POINT('',", triple(far),
                        ");\n#15=DIRECTION('',", triple(1), ");\n#16=DIRECTION('',", triple(1), ");\n"));
        ASSERT_EQ(m.faces.size(), 1u);
        const std::string written = must(write_step(Document{"mm", {{"", m, {}}}}));
        EXPECT_NE(written.find(text("=", name, "(")), std::string::npos);
        const Model read = must(read_step(written));
        ASSERT_EQ(read.faces.size(), 1u);
        const SurfaceGeometry &a = m.faces[0].surface, &b = read.faces[0].surface;
        EXPECT_EQ(kind_name(a), kind_name(b));
        for (int k = 0; k < 20; ++k) {
            // One that narrows is turned around, as the standard asks for.
            const Param<2> at{r.real(0, 7), r.real(-1, 1)},
                there{narrows ? -at[0] : at[0], narrows ? -at[1] : at[1]};
            EXPECT_LE(norm(jet<0>(a, at).value() - jet<0>(b, there).value()), 1e-14 * far);
            EXPECT_LE(norm(normal(a, at) - normal(b, there)), 1e-12);
        }
    }
    // What turns the other way, is skew, or is not what it is called is written as what it is.
    const Conic<3> circle{ConicKind::ellipse, {{4, 0, 0}}, {{1, 0, 0}}, {{0, 0, 1}}};
    Conic<3> skew = circle, beside = circle;
    skew.y[0] = 1e-3, beside.centre[1] = 1e-3;
    const Extrusion tube{
        Conic<3>{ConicKind::ellipse, {}, {{1, 0, 0}}, {{0, 1, 0}}}, {{0, 0, 1}}, SurfaceKind::cylinder};
    Extrusion down = tube, long_steps = tube;
    down.direction[2] = -1, long_steps.direction[2] = 2;
    EXPECT_TRUE(detail::elementary_of(tube));
    EXPECT_FALSE(detail::elementary_of(down));
    EXPECT_FALSE(detail::elementary_of(long_steps));
    const auto turned = [](const CurveGeometry<3>& profile, SurfaceKind kind) {
        return detail::elementary_of(Revolution{profile, {}, {{0, 0, 1}}, kind});
    };
    EXPECT_TRUE(turned(circle, SurfaceKind::torus));
    EXPECT_FALSE(turned(circle, SurfaceKind::general));
    EXPECT_FALSE(turned(circle, SurfaceKind::sphere));
    EXPECT_FALSE(turned(skew, SurfaceKind::torus));
    EXPECT_FALSE(turned(beside, SurfaceKind::torus));
    EXPECT_FALSE(turned(Line<3>{{{1, 0, 0}}, {{1, 1, 1}}}, SurfaceKind::cone));
    EXPECT_FALSE(turned(Line<3>{{{1, 0, 0}}, {{1, 0, -1}}}, SurfaceKind::cone));
    EXPECT_TRUE(turned(Line<3>{{{1, 0, 0}}, {{1, 0, 1}}}, SurfaceKind::cone));
}

// A drop: a spline turned about the line from its beginning to its end, without a boundary. The seam that it
// gets has a curve in space, which a file needs.
TEST(StepRoundTrip, whole_surfaces_of_revolution_have_seams_with_curves) {
    const Model m = must(read_step(flat_file(
        "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',("
        "#12));\n"
        "#12=ADVANCED_FACE('',(#13),#9,.T.);\n#13=FACE_BOUND('',#14,.T.);\n#14=VERTEX_LOOP('',#15);\n"
        "#15=VERTEX_POINT('',#20);\n#9=SURFACE_OF_REVOLUTION('',#16,#17);\n"
        "#17=AXIS1_PLACEMENT('',#20,#18);\n#18=DIRECTION('',(0.,0.,1.));\n"
        "#16=B_SPLINE_CURVE_WITH_KNOTS('',3,(#20,#21,#22,#23),.UNSPECIFIED.,.F.,.F.,(4,4),(0.,1.),."
        "UNSPECIFIED.);\n"
        "#20=CARTESIAN_POINT('',(1.,2.,0.));\n#21=CARTESIAN_POINT('',(3.,2.,0.));\n"
        "#22=CARTESIAN_POINT('',(2.,2.,2.));\n#23=CARTESIAN_POINT('',(1.,2.,3.));\n")));
    ASSERT_EQ(m.faces.size(), 1u);
    EXPECT_EQ(summary(m).seams, 1);
    const Model again = must(read_step(must(write_step(Document{"mm", {{"", m, {}}}}))));
    EXPECT_EQ(summary(again).seams, 1);
    EXPECT_NEAR(area_of(again, 1e-3), area_of(m, 1e-3), 0.02);
    for (const Edge& e : m.edges) {
        if (e.degenerate) continue;
        ASSERT_TRUE(e.curve);
        for (const Loop& l : m.faces[0].loops)
            for (const Coedge& c : l.coedges)
                if (&m.edges[std::size_t(c.edge)] == &e)
                    for (int k = 0; k <= 10; ++k) {
                        const double t = e.range.lo + e.range.length() * k / 10;
                        EXPECT_LE(norm(jet<0>(*e.curve, t).value() -
                                       jet<0>(m.faces[0].surface, jet<0>(c.curve, t).value().c).value()),
                                  1e-14);
                    }
    }
}

TEST(StepRoundTrip, files_say_how_accurate_the_model_is) {
    const auto written_and_read = [](const Model& m) {
        return must(read_step(must(write_step(Document{"mm", {{"", m, {}}}}))));
    };
    Model m = must(read_step(polygon_file({{0, 0}, {300, 0}, {300, 200}, {0, 200}})));  // within 1e-4
    for (const double tolerance : {1e-4, 3e-5, 1e-7}) {
        for (Edge& e : m.edges) e.tolerance = tolerance;
        for (Face& f : m.faces) f.tolerance = tolerance;
        m.edges[2].tolerance = 10 * tolerance;  // one that is off by more
        EXPECT_EQ(written_and_read(m).faces[0].tolerance, tolerance);
        EXPECT_EQ(written_and_read(m).edges[0].tolerance, tolerance);
    }
    m.faces[0].tolerance = 0;  // as made by ourselves
    EXPECT_EQ(written_and_read(m).faces[0].tolerance, 1e-7);
}

// Of all planes of Unicode, with what strings of the format treat apart.
std::string random_name(Random& r) {
    std::string name;
    for (int n = r.integer(1, 12); n > 0; --n) {
        const int kind = r.integer(0, 5);
        char32_t c = kind == 0   ? U"'\\\n\0\x7f/*S\x80"[std::size_t(r.integer(0, 8))]
                     : kind <= 2 ? char32_t(r.integer(0x20, 0x7e))
                     : kind == 3 ? char32_t(r.integer(0x80, 0xd7ff))
                     : kind == 4 ? char32_t(r.integer(0xe000, 0xffff))
                                 : char32_t(r.integer(0x10000, 0x10ffff));
        if (c < 0x80) {
            name += char(c);
        } else if (c < 0x800) {
            name += {char(0xc0 | c >> 6), char(0x80 | (c & 63))};
        } else if (c < 0x10000) {
            name += {char(0xe0 | c >> 12), char(0x80 | (c >> 6 & 63)), char(0x80 | (c & 63))};
        } else {
            name += {char(0xf0 | c >> 18), char(0x80 | (c >> 12 & 63)), char(0x80 | (c >> 6 & 63)),
                     char(0x80 | (c & 63))};
        }
    }
    return name;
}

TEST(StepRoundTrip, names_are_written_in_ascii_with_escapes) {
    EXPECT_EQ(step::encoded("it's \\ a"), "it''s \\\\ a");
    EXPECT_EQ(step::encoded("a\tb\x7f"), "a\\X\\09b\\X\\7F");
    EXPECT_EQ(step::encoded("\u00e4\u4e2dx"), "\\X2\\00E44E2D\\X0\\x");
    EXPECT_EQ(step::encoded("\u00e4\U0001F600"), "\\X2\\00E4\\X0\\\\X4\\0001F600\\X0\\");
    EXPECT_EQ(step::encoded("\xe4"), "\\X2\\00E4\\X0\\") << "not UTF-8: ISO 8859-1";
    EXPECT_EQ(step::decoded("\\X2\\D83D0041DE00\\X0\\"), "\ufffdA\ufffd") << "halves of pairs";
    EXPECT_EQ(step::decoded("\xed\xa0\x80"), "\u00ed\u00a0\u0080") << "a surrogate is no UTF-8";
}

TEST(StepRoundTrip, names_of_any_characters_come_back) {
    Random r(1300);
    const Model plain = must(prism(random_region(r, {}), {{0, 0, 2}}));
    for (int i = 0; i < 200; ++i) {
        Model m = plain;
        m.layers = {{random_name(r), random_name(r)}, {"2 " + random_name(r), ""}};
        for (Body& b : m.bodies) b.name = random_name(r), b.layers = {1};
        for (Face& f : m.faces) f.name = random_name(r), f.layers = {0};
        const std::string bytes = must(write_step(Document{"mm", {{"", m, {}}}}));
        EXPECT_TRUE(std::ranges::all_of(bytes, [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
        const Model read = must(read_step(bytes));
        ASSERT_EQ(read.faces.size(), m.faces.size());
        for (std::size_t k = 0; k < m.faces.size(); ++k) EXPECT_EQ(read.faces[k].name, m.faces[k].name);
        EXPECT_EQ(read.bodies.at(0).name, m.bodies.at(0).name);
        ASSERT_EQ(read.layers.size(), 2u);
        for (std::size_t k = 0; k < 2; ++k) {
            EXPECT_EQ(read.layers[k].name, m.layers[k].name);
            EXPECT_EQ(read.layers[k].description, m.layers[k].description);
        }
        const Model named = must(read_step(must(write_step(Document{"mm", {{m.bodies[0].name, m, {}}}}))));
        EXPECT_EQ(named.bodies.at(0).name, m.bodies[0].name) << "of the product";
        if (HasFailure()) break;
    }
}

TEST(StepRoundTrip, files_are_of_the_schema_that_they_say) {
    Random r(7);
    const std::string bytes =
        must(write_step(Document{"mm", {{"", must(prism(random_region(r, {}), {{0, 0, 2}})), {}}}}));
    EXPECT_EQ(must(step::parse(bytes)).schema,
              "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }");
    EXPECT_NE(bytes.find("'ap242_managed_model_based_3d_engineering',2014,"), bytes.npos);
    EXPECT_EQ(bytes.find("AUTOMOTIVE"), bytes.npos);
}

}  // namespace
}  // namespace freiform::test
