// Our own reader of STEP files: text, geometry, boundaries, assemblies; the corpus.
#include <freiform/io/document.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/step.hpp>
#include <freiform/io/step_read.hpp>
#include <freiform/model/tessellate.hpp>

#include <algorithm>
#include <io/step_part21.hpp>
#include <nlohmann/json.hpp>
#include <support/corpus.hpp>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/solids.hpp>
#include <support/step_solids.hpp>

namespace freiform::test {
namespace {

double gap_of(const Model& m, const Face& f, const Coedge& c) {
    const Edge& e = m.edges[std::size_t(c.edge)];
    const auto on = limits(f.surface);
    double worst = 0;
    for (int k = 0; k <= 40; ++k) {
        const double t = e.range.lo + e.range.length() * k / 40;
        const Vec<3> p = jet<0>(f.surface, clamped(jet<0>(c.curve, t).value(), on).c).value();
        if (e.curve) worst = std::max(worst, norm(p - jet<0>(*e.curve, t).value()));
        if (e.degenerate) worst = std::max(worst, norm(p - m.vertices[std::size_t(e.start)].point));
    }
    return worst;
}

// What every model keeps, wherever it is from: parameter curves follow their edges within the tolerance,
// loops are closed in the parameters, and edges begin and end at their vertices.
void expect_sound(const Model& m, std::string_view name) {
    for (std::size_t i = 0; i < m.faces.size(); ++i)
        for (const Loop& l : m.faces[i].loops)
            for (std::size_t k = 0; k < l.coedges.size(); ++k) {
                const Coedge &c = l.coedges[k], &d = l.coedges[(k + 1) % l.coedges.size()];
                const Edge &e = m.edges[std::size_t(c.edge)], &f = m.edges[std::size_t(d.edge)];
                EXPECT_LE(gap_of(m, m.faces[i], c), e.tolerance * (1 + 1e-9) + 1e-9) << name << " face " << i;
                EXPECT_EQ(c.reversed ? e.start : e.end, d.reversed ? f.end : f.start)
                    << name << " face " << i;
                const Vec<2> at = jet<0>(c.curve, c.reversed ? e.range.lo : e.range.hi).value(),
                             next = jet<0>(d.curve, d.reversed ? f.range.hi : f.range.lo).value();
                const Vec<3>
                    p = jet<0>(m.faces[i].surface, clamped(at, limits(m.faces[i].surface)).c).value(),
                    q = jet<0>(m.faces[i].surface, clamped(next, limits(m.faces[i].surface)).c).value();
                const double joint = 4 * std::max({e.tolerance, f.tolerance, 1e-9}) +
                                     2 * m.vertices[std::size_t(c.reversed ? e.start : e.end)].tolerance;
                EXPECT_LE(norm(p - q), joint) << name << " face " << i << " coedge " << k;
            }
}

double volume_of(const Model& m, double tolerance) {
    const auto t = must(tessellate(m, {.tolerance = tolerance}));
    EXPECT_EQ(t.topology.open_edges, 0);
    EXPECT_TRUE(t.refused.empty());
    return signed_volume(t.mesh);
}

TEST(StepText, escapes_in_strings_become_utf8) {
    EXPECT_EQ(step::decoded("it''s \\\\ a"), "it's \\ a");
    EXPECT_EQ(step::decoded("\\X\\E4\\S\\d"), "\u00e4\u00e4");
    EXPECT_EQ(step::decoded("\\X2\\00E4D83DDE00\\X0\\x"), "\u00e4\U0001F600x");
    EXPECT_EQ(step::decoded("\\X4\\0001F600\\X0\\"), "\U0001F600");
    EXPECT_EQ(step::decoded("\u00e4"), "\u00e4") << "edition 3 has UTF-8";
    EXPECT_EQ(step::decoded("\xe4"), "\u00e4") << "older programs write ISO 8859-1";
    EXPECT_EQ(step::decoded("\\X2\\00E4"), "\u00e4") << "not ended";
}

TEST(StepText, comments_complex_instances_scopes_and_anchors_are_read) {
    const std::string bytes =
        "ISO-10303-21;HEADER;FILE_SCHEMA(('X'));ENDSEC;ANCHOR;<a>=#1;ENDSEC;REFERENCE;#9=<b>;ENDSEC;DATA('s',"
        "(1));"
        "#3=/* ; ' */(LENGTH_UNIT()SI_UNIT(.MILLI.,.METRE.));#1=&SCOPE #2=POINT('a;b',#3);ENDSCOPE /#2/ "
        "LINE('',((1,2.E1),(-3)),$,*,.T.,\"0F\",LENGTH_MEASURE(+1.5),#4);ENDSEC;END-ISO-10303-21;";
    const auto f = must(step::parse(bytes));
    EXPECT_EQ(f.schema, "X");
    ASSERT_EQ(f.instances.size(), 3u);
    EXPECT_EQ(f.label(0), "#3 LENGTH_UNIT&SI_UNIT");
    EXPECT_TRUE(f.is(0, step::Type::SI_UNIT));
    EXPECT_EQ(f.type(0), step::Type::unknown);
    EXPECT_EQ(f.label(2), "#1 LINE");
    const auto& tokens = f.tokens;
    EXPECT_EQ(tokens.back().kind, step::TokenKind::reference);
    EXPECT_EQ(tokens.back().at, step::kMissing) << "#4 is not there";
    EXPECT_TRUE(f.refused.empty());
}

TEST(StepText, damage_is_told_with_instance_and_byte) {
    expect_refusal(step::parse("solid cube"), RefusalKind::unreadable, "byte 0", "ISO-10303-21");
    const std::string good = file_of("#7=CARTESIAN_POINT('',(1.,2.,3.));\n");
    for (std::size_t n = 0; n + 2 < good.size(); n += 7) {
        const auto cut = step::parse(std::string_view(good).substr(0, n));
        ASSERT_FALSE(cut.has_value()) << n;
        EXPECT_TRUE(cut.error().where.starts_with("byte ")) << cut.error().where;
    }
    const std::string bad = file_of("#7=CARTESIAN_POINT('',(1.,,3.));\n#8=DIRECTION('',(0.,0.,1.));\n");
    const auto f = must(step::parse(bad));
    ASSERT_EQ(f.refused.size(), 1u);
    EXPECT_EQ(f.refused[0].where, "#7");
    EXPECT_NE(f.refused[0].message.find(text("byte ", bad.find(",,") + 1)), std::string::npos)
        << f.refused[0].message;
    EXPECT_EQ(f.instances.back().id, 8u);
    // Depth is no stack.
    const std::string deep =
        file_of("#7=A(" + std::string(200'000, '(') + std::string(200'000, ')') + ");\n");
    EXPECT_TRUE(step::parse(deep).has_value());
}

TEST(StepRead, a_sphere_without_edges_gets_its_poles_and_a_seam) {
    const Model m = must(read_step(solid_of(
        "#24",
        text(kFrame,
             "#24=ADVANCED_FACE('ball',(#25),#30,.T.);\n#25=FACE_BOUND('',#26,.T.);\n"
             "#26=VERTEX_LOOP('',#27);\n#27=VERTEX_POINT('',#28);\n#28=CARTESIAN_POINT('',(1.,2.,-2.));\n"
             "#30=SPHERICAL_SURFACE('',#23,5.);\n"))));
    const ModelSummary s = summary(m);
    EXPECT_EQ(s.faces, 1);
    EXPECT_EQ(s.edges, 3);
    EXPECT_EQ(s.degenerate_edges, 2);
    EXPECT_EQ(s.seams, 1);
    EXPECT_EQ(m.faces[0].name, "ball");
    EXPECT_EQ(m.bodies.at(0).name, "part");
    expect_sound(m, "sphere");
    EXPECT_NEAR(volume_of(m, 0.02), 4 * kPi / 3 * 125, 8);
}

TEST(StepRead, a_tube_without_a_seam_gets_one_and_a_cone_its_apex) {
    const Model tube = must(read_step(round_solid("CYLINDRICAL_SURFACE('',#23,2.)", 10, false)));
    EXPECT_TRUE(tube.refused.empty());
    EXPECT_EQ(summary(tube).edges, 3);
    EXPECT_EQ(summary(tube).seams, 1);
    EXPECT_EQ(summary(tube).open_edges, 0);
    EXPECT_EQ(kind_name(tube.faces.back().surface), "cylinder");
    expect_sound(tube, "tube");
    EXPECT_NEAR(volume_of(tube, 1e-3), 40 * kPi, 0.5);
    const Model cone = must(read_step(round_solid("CONICAL_SURFACE('',#23,2.,-45.)", 0, true)));
    EXPECT_TRUE(cone.refused.empty());
    EXPECT_EQ(summary(cone).degenerate_edges, 1) << "degrees become radians, and the apex is found";
    EXPECT_EQ(summary(cone).seams, 1);
    expect_sound(cone, "cone");
    EXPECT_NEAR(volume_of(cone, 1e-3), kPi * 4 * 2 / 3, 0.05);
}

TEST(StepRead, faces_whose_loops_wind_into_nothing_are_refused_with_their_number) {
    std::string bytes = round_solid("CYLINDRICAL_SURFACE('',#23,2.)", 10, true);
    const Model m = must(read_step(bytes));
    ASSERT_EQ(m.refused.size(), 1u);
    EXPECT_EQ(m.refused[0].where, "#60 ADVANCED_FACE");
    EXPECT_NE(m.refused[0].message.find("winds around"), std::string::npos);
}

TEST(StepRead, units_are_named_and_mixed_ones_scaled) {
    const std::string_view curve =
        "#10=SHAPE_REPRESENTATION('',(#11),#1);\n#11=GEOMETRIC_CURVE_SET('',(#12));\n"
        "#12=POLYLINE('',(#13,#14));\n#13=CARTESIAN_POINT('',(0.,0.,0.));\n#14=CARTESIAN_POINT('',(1.,2.,3.))"
        ";\n";
    EXPECT_EQ(must(read_step(file_of(curve))).unit, "mm");
    EXPECT_EQ(must(read_step(file_of(curve, "$,.METRE."))).unit, "m");
    const Model two = must(read_step(
        file_of(text(curve,
                     "#50=SHAPE_REPRESENTATION('',(#51),#60);\n#51=GEOMETRIC_CURVE_SET('',(#12));\n"
                     "#60=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#61,#3))"
                     "REPRESENTATION_CONTEXT('',''));\n#61=(CONVERSION_BASED_UNIT('INCH',#62)LENGTH_UNIT()"
                     "NAMED_UNIT(*));\n"
                     "#62=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#2);\n"))));
    ASSERT_EQ(two.edges.size(), 2u);
    EXPECT_EQ(two.vertices.at(1).point, (Vec<3>{{1, 2, 3}}));
    EXPECT_NEAR(two.vertices.at(3).point[2], 76.2, 1e-12);
}

TEST(StepRead, an_assembly_that_contains_itself_is_refused) {
    expect_refusal(
        read_step(file_of("#10=SHAPE_REPRESENTATION('',(#11,#20),#1);\n#11=MAPPED_ITEM('',#12,#20);\n"
                          "#12=REPRESENTATION_MAP(#20,#15);\n#15=SHAPE_REPRESENTATION('',(#16,#20),#1);\n"
                          "#16=MAPPED_ITEM('',#17,#20);\n#17=REPRESENTATION_MAP(#20,#15);\n"
                          "#20=AXIS2_PLACEMENT_3D('',#21,$,$);\n#21=CARTESIAN_POINT('',(0.,0.,0.));\n")),
        RefusalKind::invalid, "representation", "contains itself");
    // Twice itself, and so on: more places than there is memory for.
    std::string doubling = "#20=AXIS2_PLACEMENT_3D('',#21,$,$);\n#21=CARTESIAN_POINT('',(0.,0.,0.));\n";
    for (int i = 0; i < 60; ++i)
        doubling += text("#", 100 + i, "=SHAPE_REPRESENTATION('',(#", 200 + i, ",#", 300 + i, "),#1);\n#",
                         200 + i, "=MAPPED_ITEM('',#", 400 + i, ",#20);\n#", 300 + i, "=MAPPED_ITEM('',#",
                         400 + i, ",#20);\n#", 400 + i, "=REPRESENTATION_MAP(#20,#", 101 + i, ");\n");
    doubling += "#160=SHAPE_REPRESENTATION('',(#161),#1);\n#161=GEOMETRIC_CURVE_SET('',(#21));\n";
    expect_refusal(read_step(file_of(doubling), {.memory_bytes = 1 << 20}), RefusalKind::limit, "assembly",
                   "places");
}

// What our writer writes comes back with the same bits: control points, knots, weights.
template <class P>
P random_point(Random& r, int i, int j) {
    const Vec<3> x{{i + r.real(-0.3, 0.3), j + r.real(-0.3, 0.3), r.real(-0.5, 0.5)}};
    if constexpr (Space<P>::kRational)
        return weighted(x, std::ldexp(1.0, r.integer(-1, 1)));
    else
        return x;
}
BSplineBasis random_clamped(Random& r, int degree, int size) {
    std::vector<double> t(std::size_t(degree) + 1, r.real(-2, 0));
    for (int i = 0; i < size - degree - 1; ++i)
        t.push_back(t.back() + (r.chance(0.2) && i > 0 && i % 2 ? 0.0 : r.real(0.1, 1)));
    t.insert(t.end(), std::size_t(degree) + 1, t.back() + 1);
    return must(BSplineBasis::make(degree, std::move(t)));
}
template <class P>
Surface<P> random_surface(Random& r) {
    const int p = r.integer(2, 4), q = r.integer(2, 4), nu = p + r.integer(1, 4), nv = q + r.integer(1, 3);
    std::vector<P> net;
    for (int i = 0; i < nu * nv; ++i) net.push_back(random_point<P>(r, i / nv, i % nv));
    return must(Surface<P>::make({random_clamped(r, p, nu), random_clamped(r, q, nv)},
                                 Net<2, P>({nu, nv}, std::move(net))));
}

TEST(StepRead, splines_come_back_from_our_writer_with_the_same_bits) {
    Random r(12);
    for (int i = 0; i < 60; ++i) {
        Document d;
        d.unit = "mm";
        if (i % 2)
            d.objects.push_back({"", random_surface<Vec<3>>(r), {}});
        else
            d.objects.push_back({"", random_surface<Hom<3>>(r), {}});
        const auto bytes = write_step(d);
        ASSERT_TRUE(bytes.has_value()) << bytes.error().message;
        const auto m = read_step(*bytes);
        ASSERT_TRUE(m.has_value()) << i << ": " << m.error().where << ": " << m.error().message;
        ASSERT_EQ(m->faces.size(), 1u) << i << (m->refused.empty() ? "" : m->refused[0].message);
        if (i % 2)
            EXPECT_EQ(std::get<Surface<Vec<3>>>(m->faces[0].surface),
                      std::get<Surface<Vec<3>>>(d.objects[0].shape))
                << i;
        else
            EXPECT_EQ(std::get<Surface<Hom<3>>>(m->faces[0].surface),
                      std::get<Surface<Hom<3>>>(d.objects[0].shape))
                << i;
        expect_sound(*m, "round trip");
    }
}

// Faces, edges and open edges of small files that each are about one thing; -1: nothing is read.
struct Micro {
    const char* name;
    int solids, faces, edges, open, refused;
};
constexpr Micro kMicros[] = {
    {"ap203_toroidal_band", 0, 1, 3, 2, 0},
    {"ap203_doubly_periodic_segmented_band", 0, 1, 5, 4, 0},
    {"ap203_false_face_closed_edge_use", 1, 6, 8, 0, 0},
    {"ap203_part21_scope", 0, 0, 1, 1, 0},
    {"ap203_periodic_budget_solid_a", 1, 32, 67, 0, 0},
    {"ap203_single_singular_periodic_branch", 1, 2, 5, 0, 0},
    {"ap214_brep_with_voids", 2, 8, 12, 0, 0},
    {"ap214_faceted_brep", 1, 4, 6, 0, 0},
    {"ap214_offset_revolution", 0, 1, 3, 2, 0},
    {"ap214_periodic_torus", 1, 1, 2, 0, 0},
    {"ap214_shifted_two_arc_sphere", 1, 2, 6, 0, 0},
    {"ap214_short_cylinder_seam", 1, 3, 3, 0, 0},
    {"ap214_vertex_loop_conical_face", 0, 1, 3, 1, 0},
    {"ap214_vertex_loop_torus", 1, 1, 2, 0, 0},
    {"ap203_invalid_brep", 0, 0, 1, 1, 1},
    {"ap214_single_winding_cylinder_boundary_invalid", 0, 0, 1, 1, 1},
    {"ap203_non_geometric_representation", -1, 0, 0, 0, 0},
};

TEST(StepCorpus, small_files_have_the_counts_that_they_are_known_to_have) {
    FF_CORPUS_OR_SKIP(folder, "step_micro");
    for (const Micro& x : kMicros) {
        const auto m =
            read_step(must(read_file((folder / (std::string(x.name) + ".stp")).string(), 1 << 20)));
        if (x.solids < 0) {
            EXPECT_FALSE(m.has_value()) << x.name;
            continue;
        }
        ASSERT_TRUE(m.has_value()) << x.name << m.error().message;
        const ModelSummary s = summary(*m);
        EXPECT_EQ(s.solids, x.solids) << x.name;
        EXPECT_EQ(s.faces, x.faces) << x.name;
        EXPECT_EQ(s.edges, x.edges) << x.name;
        EXPECT_EQ(s.open_edges, x.open) << x.name;
        EXPECT_EQ(m->refused.size(), std::size_t(x.refused)) << x.name;
        expect_sound(*m, x.name);
    }
}

// Solids of the corpus against volumes that another program integrated.
TEST(StepCorpus, solids_have_the_faces_and_volumes_that_another_reader_finds) {
    FF_CORPUS_OR_SKIP(oracle, "oracle/occt_massprops_open.json");
    const auto cases = nlohmann::json::parse(must(read_file(oracle.string(), 1 << 26)))["cases"];
    for (const char* name :
         {"step/io1-cm-214.stp", "step/cube-in.step", "step/screw.step", "step/pr1sy.stp",
          "step/as1-oc-214.stp", "step/red_cube_blue_cylinder.step", "step/trj10_ch1-id-chs.stp"}) {
        FF_CORPUS_OR_SKIP(path, name);
        const auto& known = cases.at(text("open/", name));
        const Model m = must(read_step(must(read_file(path.string(), 1 << 26))));
        EXPECT_TRUE(m.refused.empty()) << name << m.refused[0].message;
        EXPECT_EQ(m.faces.size(), known["face_areas"].size()) << name;
        EXPECT_EQ(summary(m).solids, int(known["solids"].size())) << name;
        double volume = 0;
        for (const auto& s : known["solids"]) volume += s["volume"].get<double>();
        const double unit = m.unit == "inch" ? 25.4 : m.unit == "m" ? 1000 : 1;
        Box<3> box;
        for (const Vertex& v : m.vertices) box.add(v.point);
        EXPECT_NEAR(volume_of(m, 5e-4 * box.diagonal()) * unit * unit * unit, volume, 1e-2 * volume) << name;
        expect_sound(m, name);
    }
}

}  // namespace
}  // namespace freiform::test
