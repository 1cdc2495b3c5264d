#include <freiform/path/flatten.hpp>
#include <freiform/path/path.hpp>
#include <freiform/query/length.hpp>
#include <freiform/spline/bezier.hpp>

#include <gtest/gtest.h>
#include <numbers>
#include <random.hpp>
#include <refusal.hpp>
#include <sanitizer.hpp>

namespace freiform {
namespace {

using test::Random;

Path read(std::string_view data) {
    auto out = parse_path_data(data);
    EXPECT_FALSE(out.stopped) << data << ": " << out.stopped->where << ' ' << out.stopped->message;
    return out.path;
}

Vec<2> value(const PathSegment& s, double t) {
    std::vector<Hom<2>> p;
    for (int i = 0; i <= s.degree; ++i)
        p.push_back(weighted(s.points[std::size_t(i)], s.degree == 2 && i == 1 ? s.weight : 1.0));
    keep_left(Fibre<Hom<2>>{p.data(), int(p.size()), 1}, t);
    return project(p.back());
}

void expect_same(const Path& a, const Path& b, double within) {
    ASSERT_EQ(a.subpaths.size(), b.subpaths.size());
    for (std::size_t i = 0; i < a.subpaths.size(); ++i) {
        const Subpath &s = a.subpaths[i], &t = b.subpaths[i];
        ASSERT_EQ(s.segments.size(), t.segments.size()) << i;
        EXPECT_EQ(s.closed, t.closed) << i;
        EXPECT_LE(norm(s.start - t.start), within);
        for (std::size_t k = 0; k < s.segments.size(); ++k)
            for (int j = 0; j <= 8; ++j)
                EXPECT_LE(norm(value(s.segments[k], j / 8.0) - value(t.segments[k], j / 8.0)), within)
                    << i << ' ' << k;
    }
}

TEST(Path, commands_may_be_relative_repeated_and_written_without_blanks) {
    const Path plain = read(
        "M 10 20 L 30 20 L 30 50 Q 40 60 50 50 Q 60 40 70 50 C 1 2 3 4 5 6 C 7 8 9 10 11 12 Z M 1 1 L 2 2");
    for (const char* other :
         {"M10,20H30V50Q40 60,50 50T70 50C1 2 3 4 5 6S9 10 11 12zM1 1L2 2",
          "m10 20h20v30q10 10 20 0t20 0C1 2 3 4 5 6s4 4 6 6z m-9-19 l1 1",
          "M10 20 30 20 30 50Q40 60 50 50 60 40 70 50C1 2 3 4 5 6 7 8 9 10 11 12ZM1 1 2 2",
          " \n M 1e1 2.e1 L30.0 20,30,50Q40 60 5e+1 50.0 60 40 70 5E1C1 2 3 4 5 6 7 8 9 10 11 12Z M+1 1 2 "
          "2 "})
        expect_same(plain, read(other), 0);
    const Path tight = read("M.5.5-1-1L1e-1-.1");
    ASSERT_EQ(tight.subpaths[0].segments.size(), 2u);
    EXPECT_EQ(tight.subpaths[0].segments[1].back(), (Vec<2>{{0.1, -0.1}}));
}

TEST(Path, after_closing_the_next_subpath_begins_where_the_closed_one_did) {
    const Path p = read("M 1 2 L 3 4 Z L 5 6 M 7 7 Z M 8 8");
    ASSERT_EQ(p.subpaths.size(), 3u);
    EXPECT_EQ(p.subpaths[0].segments.size(), 2u);  // the line back
    EXPECT_EQ(p.subpaths[1].start, (Vec<2>{{1, 2}}));
    EXPECT_FALSE(p.subpaths[1].closed);
    EXPECT_TRUE(p.subpaths[2].closed && p.subpaths[2].segments.empty());  // a dot; the last M draws nothing
    EXPECT_EQ(read("M 0 0 L 1 0 L 0 0 Z").subpaths[0].segments.size(), 2u);
    // A mirrored control point needs a curve of the same kind before it.
    EXPECT_EQ(read("M 0 0 Q 1 1 2 0 S 3 3 4 0").subpaths[0].segments[1].points[1], (Vec<2>{{2, 0}}));
}

TEST(Path, what_has_no_meaning_ends_the_path_and_is_named) {
    const struct {
        const char* data;
        std::size_t segments;
        const char *where, *message;
    } cases[] = {
        {"L 1 1", 0, "character 1", "found 'L', expected M first"},
        {"M 0 0 L 1 1 L 2 x 3", 1, "character 17", "found 'x', expected a number"},
        {"M 0 0 L 1 1 2", 1, "character 14", "found the end, expected a number"},
        {"M 0 0 L 1 1 B 3 3", 1, "character 13", "found 'B', expected a command, one of M L H V C S Q T A Z"},
        {"M 0 0 L 1 1 A 1 1 0 2 0 3 3", 1, "character 21", "found '2', expected a flag, 0 or 1"},
        {"M 0 0 L \u2603", 0, "character 9", "found '\u2603', expected a number"},
        {"M 0 0 \xE2 1", 0, "character 7", "found byte 226, expected a command, one of M L H V C S Q T A Z"},
        {"M 0 0 L 1 1 L 1e999 3", 1, "character 15", "found '1', expected a number that a double holds"},
        {"M 0 0 L 1 1 L nan 3", 1, "character 15", "found 'n', expected a number"},
        {"M 0 0 L 1 1 L", 1, "character 14", "found the end, expected a number"}};
    for (const auto& c : cases) {
        const PathData out = parse_path_data(c.data);
        ASSERT_TRUE(out.stopped) << c.data;
        EXPECT_EQ(out.stopped->where, c.where) << c.data;
        EXPECT_EQ(out.stopped->message, c.message) << c.data;
        std::size_t n = 0;
        for (const Subpath& s : out.path.subpaths) n += s.segments.size();
        EXPECT_EQ(n, c.segments) << c.data;
    }
    EXPECT_FALSE(parse_path_data("").stopped);
    EXPECT_FALSE(parse_path_data("  \n").stopped);
}

TEST(Path, arcs_are_on_their_ellipse_and_turn_as_they_are_told) {
    Random random(4);
    for (int i = 0; i < test::cases(200); ++i) {
        const double rx = random.real(1, 3), ry = random.real(1, 3), angle = random.real(-4, 4);
        const Vec<2> from{{random.real(-1, 1), random.real(-1, 1)}},
            to{{random.real(-1, 1), random.real(-1, 1)}};
        const auto map = [&](const Vec<2>& p) {  // the ellipse to the unit circle
            const double c = std::cos(angle), s = std::sin(angle);
            return Vec<2>{{(c * p[0] + s * p[1]) / rx, (c * p[1] - s * p[0]) / ry}};
        };
        double turned[4];
        for (int k = 0; k < 4; ++k) {
            const auto arc = elliptic_arc(from, to, rx, ry, angle, k & 1, k & 2);
            EXPECT_EQ(arc.front().front(), from);
            EXPECT_EQ(arc.back().back(), to);
            // The center of the circle through three points of the image.
            std::vector<Vec<2>> on;
            for (const PathSegment& s : arc)
                for (int j = 0; j <= 6; ++j) on.push_back(map(value(s, j / 6.0)));
            const Vec<2> a = on.front(), b = on[on.size() / 2] - a, c = on.back() - a;
            const double d = 2 * cross(b, c);
            const Vec<2> center = a + Vec<2>{{(c[1] * dot(b, b) - b[1] * dot(c, c)) / d,
                                              (b[0] * dot(c, c) - c[0] * dot(b, b)) / d}};
            turned[k] = 0;
            for (std::size_t j = 0; j < on.size(); ++j) {
                EXPECT_NEAR(norm(on[j] - center), 1, 1e-9);
                if (j > 0)
                    turned[k] += std::atan2(cross(on[j - 1] - center, on[j] - center),
                                            dot(on[j - 1] - center, on[j] - center));
            }
            EXPECT_EQ(std::abs(turned[k]) > std::numbers::pi, bool(k & 1));
            EXPECT_EQ(turned[k] > 0, bool(k & 2));
        }
        EXPECT_NEAR(turned[2] - turned[1], 2 * std::numbers::pi, 1e-8);
    }
    // Radii that are too small, no radius, no way to go.
    const auto half = elliptic_arc({{0, 0}}, {{4, 0}}, 1, 1, 0, false, true);
    EXPECT_LE(norm(half[0].back() - Vec<2>{{2, -2}}), 1e-14);
    EXPECT_EQ(elliptic_arc({{0, 0}}, {{4, 0}}, 0, 1, 0, false, true)[0].degree, 1);
    EXPECT_TRUE(elliptic_arc({{1, 1}}, {{1, 1}}, 2, 1, 0, true, true).empty());
}

TEST(Path, is_written_so_that_it_is_read_back_the_same) {
    const Path exact = read("M 0.1 0.2 L 1e-7 3 Q 4 5 6.25 7 C 1 2 3 4 5 6 Z M 9 9 L 8 8 9 9 M 3 3 Z");
    const std::string data = path_data(exact);
    EXPECT_EQ(data, "M 0.1,0.2 L 1e-07,3 Q 4,5 6.25,7 C 1,2 3,4 5,6 Z M 9,9 L 8,8 L 9,9 M 3,3 Z");
    expect_same(exact, read(data), 0);
    Random random(5);
    for (int i = 0; i < test::cases(200); ++i) {
        const Vec<2> from{{random.real(-1, 1), random.real(-1, 1)}},
            to{{random.real(-1, 1), random.real(-1, 1)}};
        Path path{{{from, {}, false}}};
        path.subpaths[0].segments = elliptic_arc(from, to, random.real(0.5, 3), random.real(0.5, 3),
                                                 random.real(-4, 4), random.chance(0.5), random.chance(0.5));
        expect_same(path, read(path_data(path)), 1e-11);
    }
}

// Segments may become several on the way, but none is lost: the way around is as long, and ends in the same
// points.
TEST(Path, arcs_of_radii_beyond_all_bounds_are_half_ellipses_or_lines) {
    const Vec<2> from{{0, 0}}, to{{2, 0}};
    for (const double tiny : {1e-320, 1e-200, 1e-100}) {
        const auto arc = elliptic_arc(from, to, 4 * tiny, 2 * tiny, 0, false, true);
        ASSERT_EQ(arc.size(), 2u) << tiny;
        EXPECT_NEAR(arc[0].points[2][0], 1, 1e-3);
        EXPECT_NEAR(std::abs(arc[0].points[2][1]), 0.5, 1e-3) << "half as high as it is long";
    }
    for (const bool large : {false, true}) {
        const auto line = elliptic_arc(from, to, 1e308, 1e308, 0, large, true);
        for (const PathSegment& s : line)
            for (int i = 0; i <= s.degree; ++i) EXPECT_TRUE(std::isfinite(max_abs(s.points[std::size_t(i)])));
        EXPECT_EQ(line.back().points[std::size_t(line.back().degree)], to);
    }
}

TEST(Path, arcs_far_from_the_origin_or_of_thin_ellipses_are_written_too) {
    const auto length_of = [](const Path& p) {
        return std::visit([](const auto& c) { return length(c, 1e-9).value; }, curve_of(p.subpaths[0]));
    };
    for (const double far : {1e3, 1e6, 1e9})
        for (const double thin : {1.0, 1e-3, 1e-7}) {
            const Path path{{ellipse({{far, -far}}, 1, thin)}};
            const Path back = read(path_data(path));
            ASSERT_EQ(back.subpaths.size(), 1u);
            EXPECT_TRUE(back.subpaths[0].closed);
            EXPECT_NEAR(length_of(back), length_of(path), 1e-15 * far + 1e-8) << far << ' ' << thin;
            EXPECT_EQ(back.subpaths[0].segments.back().back(), path.subpaths[0].start);
        }
    for (const double weight : {1e-3, 0.3, 1 - 1e-5, 1 - 1e-12}) {
        const Path path{{{{{0, 0}}, {{2, {Vec<2>{{0, 0}}, {{1, 1}}, {{2, 0}}}, weight}}, false}}};
        EXPECT_NEAR(length_of(read(path_data(path))), length_of(path), 1e-8) << weight;
    }
}

TEST(Path, curves_of_paths_are_the_same_and_come_back) {
    const Path path = read("M 1 0 L 3 1 C 4 2 5 2 6 0 Q 7 1 8 0 A 2 1 30 1 1 9 2 Z");
    const auto curve = std::get<Curve<Hom<2>>>(curve_of(path.subpaths[0]));
    EXPECT_EQ(curve.basis().degree(), 3);
    for (std::size_t k = 0; k < path.subpaths[0].segments.size(); ++k)
        for (int j = 0; j <= 8; ++j)
            EXPECT_LE(norm(curve(double(k) + j / 8.0) - value(path.subpaths[0].segments[k], j / 8.0)), 1e-14);
    const auto back = subpath_of(curve, 1e-3);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->bound, 0);
    expect_same(path, {{back->subpath}}, 1e-13);
    EXPECT_EQ(back->subpath.segments[0].degree, 1);
    EXPECT_EQ(back->subpath.segments[2].degree, 2);
    EXPECT_EQ(back->subpath.segments[3].degree, 2);
    const auto lines = std::get<Curve<Vec<2>>>(curve_of(read("M 0 0 H 1 V 1 Z").subpaths[0]));
    EXPECT_EQ(lines.basis().degree(), 1);
    const double circle = length(std::get<Curve<Hom<2>>>(curve_of(ellipse({{1, 2}}, 2, 2))), 1e-9).value;
    EXPECT_NEAR(circle, 4 * std::numbers::pi, 1e-9);
}

TEST(Path, other_curves_are_approximated_within_the_tolerance) {
    Random random(6);
    for (const int degree : {4, 7})
        for (const double tolerance : {1e-2, 1e-6}) {
            std::vector<Hom<2>> net;
            for (int i = 0; i < degree + 4; ++i)
                net.push_back(
                    weighted(Vec<2>{{random.real(-1, 1), random.real(-1, 1)}}, random.real(0.3, 3)));
            const auto curve = *Curve<Hom<2>>::make({*BSplineBasis::clamped_uniform(degree, degree + 4)},
                                                    Net<1, Hom<2>>({degree + 4}, net));
            const auto out = subpath_of(curve, tolerance);
            ASSERT_TRUE(out);
            EXPECT_GT(out->bound, 0);
            EXPECT_LE(out->bound, tolerance);
            // Each span is halved as often as needed, so ends of segments are where the parameter is a dyadic
            // fraction.
            const auto& segments = out->subpath.segments;
            const auto breaks = curve.basis().breaks();
            double worst = 0;
            std::size_t k = 0;
            for (std::size_t span = 0; span + 1 < breaks.size(); ++span) {
                const double from = breaks[span], width = breaks[span + 1] - from;
                for (double done = 0; done < 1;) {
                    double part = 1;
                    while (part > 1e-6 &&
                           !(std::fmod(done, part) == 0 && done + part <= 1 &&
                             norm(curve(from + width * (done + part)) - segments[k].back()) < 1e-12))
                        part /= 2;
                    ASSERT_GT(part, 1e-6) << "segment " << k;
                    for (int j = 0; j <= 16; ++j)
                        worst = std::max(worst, norm(curve(from + width * (done + part * j / 16)) -
                                                     value(segments[k], j / 16.0)));
                    done += part, ++k;
                }
            }
            EXPECT_EQ(k, segments.size());
            EXPECT_LE(worst, out->bound);
            EXPECT_GT(worst, 0.01 * tolerance);
        }
    const auto curve = std::get<Curve<Vec<2>>>(curve_of(read("M 0 0 H 1 V 1 Z").subpaths[0]));
    test::expect_refusal(subpath_of(curve, 0), RefusalKind::invalid, "tolerance");
    const auto jumps = *Curve<Vec<2>>::make({*BSplineBasis::make(1, {0, 0, 1, 1, 2, 2})},
                                            Net<1, Vec<2>>({4}, {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{2, 1}}}));
    const auto quartic =
        *Curve<Vec<2>>::make({*BSplineBasis::bezier(4)},
                             Net<1, Vec<2>>({5}, {{{9, 9}}, {{10, 12}}, {{11, 8}}, {{12, 12}}, {{13, 9}}}));
    test::expect_refusal(subpath_of(quartic, 1e-15), RefusalKind::ill_conditioned, "piece 0");
    test::expect_refusal(subpath_of(jumps, 1), RefusalKind::unsupported, "at 1");
}

}  // namespace
}  // namespace freiform
