#include <freiform/path/flatten.hpp>
#include <freiform/region/stroke.hpp>

#include <gtest/gtest.h>
#include <numbers>
#include <refusal.hpp>
#include <regions.hpp>
#include <sanitizer.hpp>

namespace freiform {
namespace {

using namespace test;
using std::numbers::pi;

const StrokeStyle kRound{.width = 0.7, .cap = LineCap::round, .join = LineJoin::round, .dashes = {}};
constexpr RegionOptions kUsual{.tolerance = 1e-3};

double area_inside(const Path& path) { return signed_area(path).value; }
double stroke_area(std::string_view data, const StrokeStyle& style, double tolerance = 1e-6) {
    return area_inside(must(stroked(path_from(data), style, {.tolerance = tolerance})).path);
}

// How far points are from a path, by polylines: within 1e-5.
class PathDistance {
public:
    explicit PathDistance(const Path& path) {
        for (const Subpath& s : path.subpaths) {
            points_.push_back({s.start});
            for (const PathSegment& segment : s.segments) {
                const auto line =
                    std::visit([](const auto& c) { return must(flatten(c, {.tolerance = 1e-5})).points; },
                               curve_of({segment.front(), {segment}, false}));
                points_.back().insert(points_.back().end(), line.begin(), line.end());
            }
            if (s.closed) points_.back().push_back(s.start);
        }
    }
    double at(const Vec<2>& p) const {
        double least = HUGE_VAL;
        for (const auto& line : points_)
            for (std::size_t i = 0; i + 1 < line.size(); ++i) {
                const Vec<2> e = line[i + 1] - line[i];
                const double l = dot(e, e), t = l > 0 ? std::clamp(dot(p - line[i], e) / l, 0.0, 1.0) : 0;
                least = std::min(least, norm(p - line[i] - t * e));
            }
        return least;
    }

private:
    std::vector<std::vector<Vec<2>>> points_;
};

void expect_dilation(const Path& path, double width, Random& random, const std::string& what) {
    StrokeStyle style = kRound;
    style.width = width;
    const auto r = stroked(path, style, kUsual);
    ASSERT_TRUE(r) << what << ' ' << r.error().where << ": " << r.error().message;
    EXPECT_LE(r->bound, kUsual.tolerance) << what;
    const InsideQuery in = inside_query(r->path);
    const PathDistance distance(path);
    for (int i = 0; i < 100; ++i) {
        const Vec<2> p{{random.real(-1, 5), random.real(-1, 5)}};
        const double d = distance.at(p);
        if (std::abs(d - width / 2) < r->bound + 2e-5) continue;
        EXPECT_EQ(in.at(p).winding, int(d < width / 2))
            << what << " at " << p[0] << ' ' << p[1] << ", distance " << d;
    }
}

TEST(Stroked, with_round_caps_and_joins_is_all_that_is_near_the_path) {
    Random random(1);
    for (int i = 0; i < cases(10); ++i) {
        Path path{{random_loop(random, {.segments = random.integer(1, 4)})}};
        path.subpaths[0].closed = random.chance(0.5);
        if (!path.subpaths[0].closed) path.subpaths[0].segments.pop_back();
        if (path.subpaths[0].segments.empty()) continue;
        expect_dilation(path, random.chance(0.5) ? 0.3 : 1.5, random, text("case ", i));
    }
}

TEST(Stroked, where_curves_bend_more_than_the_pen_is_wide_nothing_is_taken_away) {
    Random random(2);
    for (const char* data : {"M 0.4 3.6 C 3.8 0.4 0.2 0.4 3.6 3.6",  // almost a cusp
                             "M 0.5 3.5 C 3.5 0.5 0.5 0.5 3.5 3.5",  // a cusp
                             "M 0 3 C 5 0 -1 0 4 3",                 // a loop
                             "M 2 2 A 0.2 0.2 0 0 1 2.2 2.3 A 0.3 0.3 0 0 0 2.5 2.5", "M 1 1 Q 3 1 1 1.01",
                             "M 1 1 C 3 3 3 3 1 1", "M 0 2 C 1 1 1 1 2 2 S 3 3 4 2"})
        for (const double width : {0.2, 1.3}) expect_dilation(path_from(data), width, random, data);
}

TEST(Stroked, the_inside_of_a_bend_does_not_take_away_what_another_part_covers) {
    // The pen passes over the centre of the arc, and behind it over what it has covered along the line.
    EXPECT_NEAR(stroke_area("M 0.5 2 H 2 A 0.2 0.2 0 0 1 2.2 2.2", {.width = 1.3, .dashes = {}}),
                1.5 * 1.3 + pi / 4 * 0.85 * 0.85, 1e-5);
}

TEST(Stroked, lines_and_circles_have_the_areas_of_the_textbook) {
    const double h = 0.25;
    StrokeStyle style{.width = 2 * h, .dashes = {}};
    EXPECT_NEAR(stroke_area("M 1 1 H 5", style), 4 * 2 * h, 1e-12);
    style.cap = LineCap::square;
    EXPECT_NEAR(stroke_area("M 1 1 H 5", style), (4 + 2 * h) * 2 * h, 1e-12);
    style.cap = LineCap::round;
    EXPECT_NEAR(stroke_area("M 1 1 H 5", style), 4 * 2 * h + pi * h * h, 1e-12);
    EXPECT_NEAR(stroke_area("M 1 1 Z", style), pi * h * h, 1e-12);
    // A square corner: miter, bevel, round.
    style.cap = LineCap::butt;
    const double legs = 2 * 4 * 2 * h - h * h;
    EXPECT_NEAR(stroke_area("M 0 0 H 4 V 4", style), legs + h * h, 1e-12);
    style.miter_limit = 1.4;
    EXPECT_NEAR(stroke_area("M 0 0 H 4 V 4", style), legs + h * h / 2, 1e-12);
    style.join = LineJoin::miter_clip, style.miter_limit = 1.2;  // the tip is cut off at 1.2 h
    EXPECT_NEAR(stroke_area("M 0 0 H 4 V 4", style), legs + h * h - std::pow((std::sqrt(2) - 1.2) * h, 2),
                1e-12);
    style.join = LineJoin::round;
    EXPECT_NEAR(stroke_area("M 0 0 H 4 V 4", style), legs + pi * h * h / 4, 1e-12);
    // A ring, and a disc where the pen passes over the centre.
    const Path ring = must(stroked({{ellipse({{0, 0}}, 1, 1)}}, style, {.tolerance = 1e-9})).path;
    EXPECT_EQ(ring.subpaths.size(), 2u);
    EXPECT_NEAR(area_inside(ring), pi * ((1 + h) * (1 + h) - (1 - h) * (1 - h)), 1e-8);
    style.width = 2.5;
    EXPECT_NEAR(stroke_area("M 1 0 A 1 1 0 0 1 -1 0 A 1 1 0 0 1 1 0 Z", style), pi * 2.25 * 2.25, 1e-5);
}

TEST(Stroked, dashes_cover_what_the_pattern_says) {
    StrokeStyle style{.width = 0.5, .dashes = {1, 0.5}};
    EXPECT_NEAR(stroke_area("M 0 0 H 6", style), 4 * 0.5, 1e-9);
    style.dash_offset = 0.75;
    EXPECT_EQ(must(dashed(path_from("M 0 0 H 6"), style, 1e-9)).subpaths.size(), 5u);
    style.dash_offset = -0.25;
    const Path shifted = must(dashed(path_from("M 0 0 H 2"), style, 1e-9));
    ASSERT_EQ(shifted.subpaths.size(), 2u);
    EXPECT_EQ(shifted.subpaths[0].start, (Vec<2>{{0.25, 0}}));
    EXPECT_NEAR(shifted.subpaths[1].start[0], 1.75, 1e-9);
    // Round a square of circumference 8: the dash over the start is one.
    style.dash_offset = 0.5;
    const Path around = must(dashed(path_from("M 0 0 H 2 V 2 H 0 Z"), style, 1e-9));
    EXPECT_EQ(around.subpaths.size(), 5u);
    EXPECT_NEAR(
        area_inside(
            must(stroked(path_from("M 0 0 H 20 V 20 H 0 Z"), {.width = 0.5, .dashes = {1, 1}}, kUsual)).path),
        40 * 0.5, 1e-2);
    // Half of a circle, in four parts.
    const Path arcs =
        must(dashed({{ellipse({{0, 0}}, 1, 1)}}, {.width = 0.1, .dashes = {pi / 4, pi / 4}}, 1e-9));
    ASSERT_EQ(arcs.subpaths.size(), 4u);
    EXPECT_LE(norm(arcs.subpaths[0].segments.back().back() - Vec<2>{{std::cos(pi / 4), std::sin(pi / 4)}}),
              1e-8);
}

// Of a cubic whose handles may be without length: lines of the pen, near each other at the ends of the curve.
struct PenLines {
    std::vector<std::array<Vec<2>, 2>> lines;
    double step = 0;  // ends of neighbours are this near

    PenLines(const PathSegment& s, double half_width) {
        std::vector<double> at;
        for (int i = 1; i < 2000; ++i) {
            const double small = std::exp2(-0.02 * i);
            at.insert(at.end(), {i / 2000.0, small, 1 - small});
        }
        std::ranges::sort(at);
        for (const double t : at) {
            if (t >= 1) break;
            const auto& p = s.points;
            const double a = (1 - t) * (1 - t), b = 2 * t * (1 - t), c = t * t;
            const Vec<2> d = unit(a * (p[1] - p[0]) + b * (p[2] - p[1]) + c * (p[3] - p[2])),
                         x = (1 - t) * (a * p[0] + b * 1.5 * p[1]) + t * (b * 1.5 * p[2] + c * p[3]),
                         n{{-d[1], d[0]}};
            lines.push_back({x + half_width * n, x - half_width * n});
            if (lines.size() > 1)
                for (std::size_t k = 0; k < 2; ++k)
                    step = std::max(step, norm(lines.back()[k] - lines[lines.size() - 2][k]));
        }
    }
    double distance(const Vec<2>& q) const {
        double least = HUGE_VAL;
        for (const auto& [a, b] : lines) {
            const Vec<2> e = b - a;
            const double t = std::clamp(dot(q - a, e) / dot(e, e), 0.0, 1.0);
            least = std::min(least, norm(q - a - t * e));
        }
        return least;
    }
};

TEST(Stroked, curves_that_stand_still_at_an_end_are_covered_as_the_pen_does_and_no_more) {
    Random random(3);
    for (const char* data : {
             "M 1 1 C 1 1 3 1 4 3",            // no handle at the start
             "M 1 1 C 2 1 4 3 4 3",            // nor at the end
             "M 1 1 C 1 1 1 1 4 3",            // a line that stands still at its start, twice,
             "M 1 1 C 1 1 4 3 4 3",            // and at both ends
             "M 1 1 C 1.0001 1.0001 3 1 4 3",  // handles with hardly any length
             "M 1 1 C 1.0000001 1 2 2.5 4 3",  //
             "M 1 1 C 1.000000001 1.000000001 3 1 4 3",
         })
        for (const double width : {0.3, 1.4}) {
            const Path path = path_from(data);
            const Region r = must(stroked(path, {.width = width, .dashes = {}}, kUsual));
            EXPECT_LE(r.bound, kUsual.tolerance) << data;
            const InsideQuery in = inside_query(r.path);
            const PathDistance outline(r.path);
            const PenLines pen(path.subpaths[0].segments[0], width / 2);
            const double slack = r.bound + pen.step + 2e-5;
            EXPECT_LT(slack, 0.02) << data;
            for (int i = 0; i < 100; ++i) {
                const Vec<2> p{{random.real(-0.5, 5), random.real(-0.5, 5)}};
                if (pen.distance(p) > slack)
                    EXPECT_EQ(in.at(p).winding, 0) << data << ' ' << p[0] << ' ' << p[1];
                const auto& line = pen.lines[std::size_t(random.integer(0, int(pen.lines.size()) - 1))];
                const double t = random.real(0, 1);
                const Vec<2> q = (1 - t) * line[0] + t * line[1];
                if (outline.at(q) > slack)
                    EXPECT_EQ(in.at(q).winding, 1) << data << ' ' << q[0] << ' ' << q[1];
            }
            // Behind the start there is nothing.
            const Vec<2> back =
                path.subpaths[0].start - 0.1 * unit(path.subpaths[0].segments[0].points[2] - Vec<2>{{1, 1}});
            if (path.subpaths[0].segments[0].points[1] == path.subpaths[0].start)
                EXPECT_EQ(in.at(back).winding, 0) << data;
        }
}

TEST(Grown, squares_and_discs_have_the_areas_of_the_textbook) {
    const Path square{{rectangle(0, 0, 2, 2)}}, disc{{ellipse({{0, 0}}, 1, 1)}};
    const RegionOptions fine{.tolerance = 1e-6};
    const auto grown_area = [&](const Path& p, const OffsetStyle& s) {
        return area_inside(must(grown({p}, s, fine)).path);
    };
    EXPECT_NEAR(grown_area(square, {.distance = 0.5}), 4 + 4 + pi / 4, 1e-9);
    EXPECT_NEAR(grown_area(square, {.distance = 0.5, .join = LineJoin::miter}), 9, 1e-9);
    EXPECT_NEAR(grown_area(square, {.distance = 0.5, .join = LineJoin::bevel}), 8.5, 1e-9);
    EXPECT_NEAR(grown_area(square, {.distance = -0.5}), 1, 1e-9);
    EXPECT_EQ(grown_area(square, {.distance = -1.5}), 0);
    EXPECT_NEAR(grown_area(disc, {.distance = 0.25}), pi * 1.25 * 1.25, 1e-5);
    EXPECT_NEAR(grown_area(disc, {.distance = -0.25}), pi * 0.75 * 0.75, 1e-5);
    EXPECT_EQ(grown_area(square, {.distance = 0}), 4);
    // A ring closes when it grows inwards by more than its hole.
    Path ring = square;
    ring.subpaths.push_back(rectangle(0.5, 0.5, 1.5, 1.5));
    const Region filled = must(grown({ring, FillRule::evenodd}, {.distance = 0.6}, fine));
    EXPECT_EQ(filled.path.subpaths.size(), 1u);
}

TEST(Stroked, refuses_what_makes_no_sense) {
    const Path line = path_from("M 0 0 H 1");
    const auto with = [&](StrokeStyle s) { return stroked(line, s, kUsual); };
    expect_refusal(with({.width = 0, .dashes = {}}), RefusalKind::invalid, "width");
    expect_refusal(with({.miter_limit = 0.5, .dashes = {}}), RefusalKind::invalid, "miter_limit");
    expect_refusal(with({.dashes = {1, -1}}), RefusalKind::invalid, "dashes[1]");
    expect_refusal(with({.dashes = {0, 0}}), RefusalKind::invalid, "dashes");
    expect_refusal(with({.dashes = {1e-6, 1e-6}}), RefusalKind::limit, "path.subpaths[0].dashes");
    expect_refusal(stroked(line, {.dashes = {}}, {.tolerance = -1}), RefusalKind::invalid, "tolerance");
    EXPECT_TRUE(must(stroked({}, {.dashes = {}}, kUsual)).path.subpaths.empty());
}

}  // namespace
}  // namespace freiform
