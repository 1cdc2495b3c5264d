#include "bezier.hpp"

#include <freiform/path/flatten.hpp>
#include <freiform/path/forward_differences.hpp>

#include <gtest/gtest.h>
#include <limits>

namespace freiform::test {
namespace {

const Curve<Vec<2>> kArch = bezier<Vec<2>>({{{0, 0}}, {{1, 2}}, {{3, 2}}, {{4, 0}}});

Curve<Hom<2>> circle(double radius = 1) {
    const double h = std::sqrt(0.5), x[] = {1, 1, 0, -1, -1, -1, 0, 1, 1},
                 y[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
    std::vector<Hom<2>> c;
    for (int i = 0; i < 9; ++i) c.push_back(weighted(Vec<2>{{radius * x[i], radius * y[i]}}, i % 2 ? h : 1));
    return must(Curve<Hom<2>>::make({must(BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}))},
                                    Net<1, Hom<2>>({9}, std::move(c))));
}

template <int D>
double distance_to_segment(const Vec<D>& x, const Vec<D>& a, const Vec<D>& b) {
    const Vec<D> e = b - a;
    const double l = dot(e, e);
    const double t = l > 0 ? std::clamp(dot(x - a, e) / l, 0.0, 1.0) : 0;
    return norm(x - a - t * e);
}

FlattenOptions by_tolerance(FlattenMethod method, double tolerance) {
    FlattenOptions o;
    o.method = method;
    o.tolerance = tolerance;
    return o;
}
FlattenOptions by_segments(FlattenMethod method, int segments) {
    FlattenOptions o;
    o.method = method;
    o.segments = segments;
    return o;
}

// The largest distance of samples of the curve between neighbouring parameters from the segment between their
// points (of a function: from the value of the linear interpolant).
template <class P>
double measured(const Curve<P>& curve, const Polyline<Space<P>::kDim>& line, int samples = 24) {
    double most = 0;
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
        if (std::ranges::find(line.parts, i + 1) != line.parts.end()) continue;
        const double s = line.parameters[i], t = line.parameters[i + 1];
        for (int k = 1; k < samples; ++k) {
            const double u = std::min(s + (t - s) * k / samples, t), x = (u - s) / (t - s);
            const auto at = curve(u);
            most = std::max(most, Space<P>::kDim == 1
                                      ? distance(at, (1 - x) * line.points[i] + x * line.points[i + 1])
                                      : distance_to_segment(at, line.points[i], line.points[i + 1]));
        }
    }
    return most;
}

// The least number of segments with ends on a grid of parameters, each within `tolerance` of samples of the
// curve: dynamic programming over all pairs.
template <class P>
int least_segments(const Curve<P>& curve, double tolerance, int grid, int samples) {
    const Interval on = curve.domain()[0];
    std::vector<PointOf<P>> at;
    for (int i = 0; i <= grid * samples; ++i) at.push_back(curve(on.lo + on.length() * i / (grid * samples)));
    std::vector<int> least(std::size_t(grid) + 1, grid + 1);
    least[0] = 0;
    for (int i = 0; i < grid; ++i)
        for (int j = i + 1, misses = 0; j <= grid && misses < 8; ++j) {
            bool near = true;
            for (int k = i * samples + 1; k < j * samples && near; ++k)
                near = distance_to_segment(at[std::size_t(k)], at[std::size_t(i * samples)],
                                           at[std::size_t(j * samples)]) <= tolerance;
            if (near)
                least[std::size_t(j)] = std::min(least[std::size_t(j)], least[std::size_t(i)] + 1);
            else
                ++misses;
        }
    return least.back();
}

constexpr FlattenMethod kMethods[] = {FlattenMethod::adaptive, FlattenMethod::uniform, FlattenMethod::forward,
                                      FlattenMethod::halving};

// --- The rows of the requirements, literally ---

TEST(R18, horner_and_the_power_form_give_the_points_of_the_curve) {
    // Q(t) = ((a t + b) t + c) t + d with (a, b, c, d) from the Bezier matrix.
    const Vec<2> p[] = {{{0, 0}}, {{1, 2}}, {{3, 2}}, {{4, 0}}};
    const Vec<2> a = -1.0 * p[0] + 3.0 * p[1] - 3.0 * p[2] + p[3], b = 3.0 * p[0] - 6.0 * p[1] + 3.0 * p[2],
                 c = -3.0 * p[0] + 3.0 * p[1], d = p[0];
    const auto power = power_form(std::span<const Vec<2>>(p));
    EXPECT_EQ(power, (std::vector{d, c, b, a}));
    const auto line = must(flatten(kArch, by_segments(FlattenMethod::uniform, 10)));
    ASSERT_EQ(line.points.size(), 11u);
    for (int i = 0; i <= 10; ++i) {
        const double t = i / 10.0;
        EXPECT_DOUBLE_EQ(line.parameters[std::size_t(i)], t);
        const Vec<2> q = t * (t * (t * a + b) + c) + d;
        EXPECT_EQ(horner<Vec<2>>(power, t), q);
        EXPECT_LT(distance(line.points[std::size_t(i)], q), 1e-15 * 4);
    }
}

TEST(R18, third_order_forward_differences) {
    // f(t) = a t^3 + b t^2 + c t + d: D f_0 = a h^3 + b h^2 + c h, D^2 f_0 = 6 a h^3 + 2 b h^2, D^3 f = 6 a
    // h^3; f += D f, D f += D^2 f, D^2 f += D^3 f. With h = 1/8 and whole numbers everything is exact.
    const double a = 2, b = -5, c = 7, d = 3, h = 0.125;
    const Vec<1> bez[] = {{{d}}, {{d + c / 3}}, {{d + 2 * c / 3 + b / 3}}, {{d + c + b + a}}};
    ForwardDifferences<Vec<1>> f(std::span<const Vec<1>>(bez), 8);
    double v = d, d1 = a * h * h * h + b * h * h + c * h, d2 = 6 * a * h * h * h + 2 * b * h * h,
           d3 = 6 * a * h * h * h;
    for (int i = 0; i <= 8; ++i) {
        EXPECT_NEAR(f.value()[0], v, 1e-14);
        EXPECT_NEAR(f.differences()[1][0], d1, 1e-14);
        EXPECT_NEAR(f.differences()[2][0], d2, 1e-14);
        EXPECT_NEAR(f.differences()[3][0], d3, 1e-14);
        EXPECT_NEAR(v, ((a * (i * h) + b) * (i * h) + c) * (i * h) + d, 1e-14);
        v += d1, d1 += d2, d2 += d3;
        f.advance();
    }
    const auto line = must(flatten(kArch, by_segments(FlattenMethod::forward, 8)));
    ASSERT_EQ(line.points.size(), 9u);
    for (int i = 0; i <= 8; ++i) EXPECT_LT(distance(line.points[std::size_t(i)], kArch(i * h)), 1e-14);
}

TEST(R19, halving_goes_on_until_every_part_is_flat_and_draws_the_control_polygons) {
    auto options = by_tolerance(FlattenMethod::halving, 0.01);
    const auto chords = must(flatten(kArch, options));
    for (std::size_t i = 0; i < chords.points.size(); ++i) {  // ends are dyadic
        const double t = chords.parameters[i] * 64;
        EXPECT_EQ(t, std::floor(t));
        EXPECT_LT(distance(chords.points[i], kArch(chords.parameters[i])), 1e-14);
    }
    // The last level: each half of the halving matrices, until flat.
    options.polygons = true;
    const auto polygons = must(flatten(kArch, options));
    ASSERT_EQ(polygons.segments() % 3, 0u);
    for (std::size_t i = 0; i + 3 < polygons.points.size(); i += 3) {
        const Interval on{polygons.parameters[i], polygons.parameters[i + 3]};
        const auto part = must(restrict_to(kArch, 0, on));
        for (std::size_t k = 0; k < 4; ++k)
            EXPECT_LT(distance(polygons.points[i + k], points(part)[k]), 1e-14) << i << " " << k;
    }
    EXPECT_LE(polygons.bound, 0.01);
}

TEST(R19, the_comparison_at_equal_effort_says_what_each_method_reaches) {
    const auto rows = must(compare_flattening(kArch, 16));
    ASSERT_EQ(rows.size(), 5u);
    for (const auto& r : rows) {
        EXPECT_GT(r.measured, 0);
        EXPECT_LE(r.measured, r.bound);
        if (!r.polygons) EXPECT_EQ(r.segments, 16u) << name_of(r.method);
        EXPECT_GE(r.measured, rows[0].measured * (1 - 1e-3)) << "nothing is better than adaptive";
    }
    // A quarter of the error for twice the segments.
    const auto finer = must(compare_flattening(kArch, 32));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(rows[i].measured / finer[i].measured, 4, 0.5);
}

// --- Laws ---

template <class P>
void expect_bounded(Random& random, int max_degree, BasisOptions basis) {
    for (int k = 0; k < 12; ++k) {
        const auto curve = random_patch<1, P>(random, max_degree, basis);
        for (const FlattenMethod method : kMethods) {
            const double tolerance = std::exp2(random.real(-12, 0));
            const auto line = must(flatten(curve, by_tolerance(method, tolerance)));
            const double found = measured(curve, line);
            EXPECT_LE(found, line.bound + 4 * curve.value_error_bound())
                << name_of(method) << " " << tolerance;
            EXPECT_LE(line.bound, tolerance);
            EXPECT_EQ(line.parameters.front(), curve.domain()[0].lo);
            EXPECT_EQ(line.parameters.back(), curve.domain()[0].hi);
            EXPECT_TRUE(std::ranges::is_sorted(line.parameters));
            if (!basis.jumps)
                for (std::size_t i = 0; i < line.points.size(); ++i)
                    EXPECT_LT(distance(line.points[i], curve(line.parameters[i])), 1e-9);
        }
    }
}

TEST(Flatten, stays_within_its_bound_and_the_bound_within_the_tolerance) {
    Random random(191);
    expect_bounded<Vec<2>>(random, 6, {});
    expect_bounded<Hom<2>>(random, 4, {});
    expect_bounded<Vec<3>>(random, 4, {Ends::closed});
    expect_bounded<Hom<3>>(random, 3, {Ends::unclamped});
    expect_bounded<Vec<4>>(random, 3, {});
    expect_bounded<Hom<4>>(random, 3, {Ends::closed});
    expect_bounded<Vec<1>>(random, 5, {});
    expect_bounded<Hom<1>>(random, 3, {});
    expect_bounded<Vec<2>>(random, 3, {Ends::clamped, 4, true});
}

TEST(Flatten, bounds_are_near_the_truth_on_smooth_curves) {
    for (const FlattenMethod method : kMethods)
        for (const int n : {8, 100}) {
            const auto arch = must(flatten(kArch, by_segments(method, n)));
            EXPECT_GT(measured(kArch, arch), 0.8 * arch.bound) << name_of(method) << n;
            const auto round = must(flatten(circle(), by_segments(method, n)));
            EXPECT_GT(measured(circle(), round),
                      (method == FlattenMethod::uniform || method == FlattenMethod::forward ? 0.5 : 0.8) *
                          round.bound)
                << name_of(method) << n;
        }
}

TEST(Flatten, adaptive_needs_at_most_a_tenth_more_than_the_minimum) {
    Random random(7);
    const auto check = [](const auto& curve, double tolerance) {
        const auto line = must(flatten(curve, by_tolerance(FlattenMethod::adaptive, tolerance)));
        const int n = int(line.segments()),
                  least = least_segments(curve, tolerance, std::max(300, 30 * n), 3);
        EXPECT_LE(n, std::max(1.1 * least, least + 0.0)) << tolerance << " " << least;
        EXPECT_GE(n, int(0.93 * least) - 1) << "more than the grid of the minimum explains";
    };
    for (const double tolerance : {0.1, 0.01, 1e-3}) {
        check(kArch, tolerance);
        check(circle(), tolerance);
        // Inflections, uneven speed, space, many pieces.
        check(bezier<Vec<2>>({{{0, 0}}, {{1, 3}}, {{2, -3}}, {{3, 0}}}), tolerance);
        check(bezier<Vec<2>>({{{0, 0}}, {{0.1, 0}}, {{0.2, 0.1}}, {{3, 1}}, {{4, 0}}}), tolerance);
        check(bezier<Vec<3>>({{{0, 0, 0}}, {{1, 2, 1}}, {{3, 2, -1}}, {{4, 0, 2}}}), tolerance);
        check(random_patch_on<1, Vec<2>>(random, {must(BSplineBasis::clamped_uniform(3, 12))}), tolerance);
        check(random_patch_on<1, Vec<2>>(random, {must(BSplineBasis::clamped_uniform(2, 9))}), tolerance);
    }
}

TEST(Flatten, a_straight_line_is_two_points_at_any_speed_and_degree) {
    for (const int degree : {1, 2, 3, 7, 25}) {
        std::vector<Vec<3>> b;
        for (int i = 0; i <= degree; ++i) {
            const double x = double(i * i) / (degree * degree);
            b.push_back({{x, 2 * x, -4 * x}});
        }
        for (const FlattenMethod method : kMethods)
            EXPECT_EQ(must(flatten(bezier(b), by_tolerance(method, 1e-6))).points.size(), 2u)
                << degree << name_of(method);
    }
    const auto spline = must(Curve<Vec<2>>::make(
        {must(BSplineBasis::clamped_uniform(3, 6))},
        Net<1, Vec<2>>({6}, {{{0, 0}}, {{1, 1}}, {{2, 2}}, {{3, 3}}, {{4, 4}}, {{5, 5}}})));
    EXPECT_EQ(must(flatten(spline, by_tolerance(FlattenMethod::adaptive, 1e-9))).points.size(), 2u);
}

TEST(Flatten, a_line_that_runs_back_keeps_its_turn_within_the_tolerance) {
    const auto there_and_back = bezier<Vec<2>>({{{0, 0}}, {{2, 0}}, {{0.5, 0}}});
    for (const FlattenMethod method : kMethods) {
        const auto line = must(flatten(there_and_back, by_tolerance(method, 1e-4)));
        double farthest = 0;
        for (const auto& p : line.points) farthest = std::max(farthest, p[0]);
        EXPECT_NEAR(farthest, 8.0 / 7, 1e-4) << name_of(method);
    }
}

TEST(Flatten, corners_stay_and_smooth_breaks_need_not) {
    const auto polygon =
        must(Curve<Vec<2>>::make({must(BSplineBasis::clamped_uniform(1, 4))},
                                 Net<1, Vec<2>>({4}, {{{0, 0}}, {{1, 0}}, {{2, 0}}, {{2, 1}}})));
    const auto line = must(flatten(polygon, by_tolerance(FlattenMethod::adaptive, 10)));
    EXPECT_EQ(line.points, (std::vector<Vec<2>>{{{0, 0}}, {{2, 0}}, {{2, 1}}}));
    // A corner without a multiple knot: three equal control points.
    const auto tripled = must(Curve<Vec<2>>::make(
        {must(BSplineBasis::clamped_uniform(3, 9))},
        Net<1, Vec<2>>(
            {9},
            {{{0, 0}}, {{1, 0}}, {{2, 0}}, {{3, 0}}, {{3, 0}}, {{3, 0}}, {{3, 1}}, {{3, 2}}, {{3, 3}}})));
    const auto bent = must(flatten(tripled, by_tolerance(FlattenMethod::adaptive, 1e-3)));
    EXPECT_EQ(bent.points, (std::vector<Vec<2>>{{{0, 0}}, {{3, 0}}, {{3, 3}}}));
}

TEST(Flatten, cusps_loops_and_points_end) {
    const auto cusp = bezier<Vec<2>>({{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}});
    const auto loop = bezier<Vec<2>>({{{0, 0}}, {{3, 2}}, {{-3, 2}}, {{0, 0}}});
    const auto point = bezier<Vec<2>>({{{1, 2}}, {{1, 2}}, {{1, 2}}});
    for (const FlattenMethod method : kMethods)
        for (const double tolerance : {0.1, 1e-7}) {
            const auto a = must(flatten(cusp, by_tolerance(method, tolerance)));
            EXPECT_LE(measured(cusp, a), a.bound);
            const auto b = must(flatten(loop, by_tolerance(method, tolerance)));
            EXPECT_LE(measured(loop, b), b.bound);
            EXPECT_GT(b.points.size(), 2u);
            const auto c = must(flatten(point, by_tolerance(method, tolerance)));
            EXPECT_EQ(c.points, (std::vector<Vec<2>>{{{1, 2}}, {{1, 2}}}));
        }
}

TEST(Flatten, closed_curves_end_where_they_begin) {
    Random random(5);
    const auto curve = random_patch<1, Vec<2>>(random, 3, {Ends::closed});
    for (const FlattenMethod method : kMethods) {
        const auto line = must(flatten(curve, by_tolerance(method, 0.01)));
        EXPECT_TRUE(line.closed);
        EXPECT_EQ(line.points.front(), line.points.back());
    }
}

TEST(Flatten, jumps_begin_new_parts) {
    const auto curve =
        must(Curve<Vec<2>>::make({must(BSplineBasis::make(1, {0, 0, 1, 1, 2, 2}))},
                                 Net<1, Vec<2>>({4}, {{{0, 0}}, {{1, 0}}, {{5, 5}}, {{6, 5}}})));
    for (const FlattenMethod method : kMethods) {
        const auto line = must(flatten(curve, by_tolerance(method, 0.1)));
        EXPECT_EQ(line.parts, (std::vector<std::size_t>{0, 2})) << name_of(method);
        EXPECT_EQ(line.points, (std::vector<Vec<2>>{{{0, 0}}, {{1, 0}}, {{5, 5}}, {{6, 5}}}));
        EXPECT_EQ(line.segments(), 2u);
    }
}

TEST(Flatten, scales_exactly_with_powers_of_two) {
    Random random(23);
    for (const int e : {-1000, -40, 30, 990}) {
        const auto curve = random_patch<1, Hom<2>>(random, 4, {});
        Net<1, Hom<2>> net = curve.net();
        for (auto& p : net.flat())
            for (int i = 0; i < 2; ++i) p[i] = std::scalbn(p[i], e);
        const auto scaled = must(Curve<Hom<2>>::make(curve.bases(), net));
        for (const FlattenMethod method : kMethods) {
            const auto a = must(flatten(curve, by_tolerance(method, 0.01)));
            const auto b = must(flatten(scaled, by_tolerance(method, std::scalbn(0.01, e))));
            ASSERT_EQ(a.parameters, b.parameters);
            EXPECT_DOUBLE_EQ(std::scalbn(a.bound, e), b.bound);
            for (std::size_t i = 0; i < a.points.size(); ++i)
                for (int k = 0; k < 2; ++k) EXPECT_EQ(std::scalbn(a.points[i][k], e), b.points[i][k]);
        }
    }
}

TEST(Flatten, by_number_of_segments_adaptive_uses_them_well) {
    for (const int n : {1, 2, 7, 40}) {
        const auto line = must(flatten(kArch, by_segments(FlattenMethod::adaptive, n)));
        EXPECT_LE(line.segments(), std::size_t(n));
        const auto uniform = must(flatten(kArch, by_segments(FlattenMethod::uniform, n)));
        EXPECT_LE(line.bound, uniform.bound * 1.01);
    }
}

TEST(Flatten, conics_and_lines_of_models_are_flattened_as_they_are) {
    const Conic<3> ellipse{ConicKind::ellipse, {{1, 2, 3}}, {{5, 0, 0}}, {{0, 1, 0.5}}},
        hyperbola{ConicKind::hyperbola, {}, {{1, 0, 0}}, {{0, 2, 0}}},
        parabola{ConicKind::parabola, {}, {{0, 1, 0}}, {{3, 0, 0}}};
    const auto check = [](const CurveGeometry<3>& curve, Interval on, FlattenOptions o, std::size_t most) {
        const auto line = must(flatten(curve, on, o));
        double found = 0;
        for (std::size_t i = 0; i + 1 < line.points.size(); ++i)
            for (int k = 1; k < 32; ++k) {
                const double s = line.parameters[i], t = line.parameters[i + 1];
                found = std::max(found, distance_to_segment(jet<0>(curve, s + (t - s) * k / 32).value(),
                                                            line.points[i], line.points[i + 1]));
            }
        EXPECT_LE(found, line.bound);
        EXPECT_GE(found, 0.95 * line.bound);
        EXPECT_LE(line.bound, o.tolerance > 0 ? o.tolerance : 1e300);
        EXPECT_LE(line.segments(), most);
    };
    for (const double tolerance : {0.1, 1e-4, 1e-7})
        for (const FlattenMethod method : {FlattenMethod::adaptive, FlattenMethod::uniform}) {
            check(ellipse, {-1, 5.28}, by_tolerance(method, tolerance), 100000);
            check(hyperbola, {-2, 1}, by_tolerance(method, tolerance), 100000);
            check(parabola, {-1, 3}, by_tolerance(method, tolerance), 100000);
        }
    check(ellipse, {0, 1}, by_segments(FlattenMethod::adaptive, 7), 7);
    // A circle needs pi / acos(1 - tolerance / r) segments.
    const Conic<3> circle_of_9{ConicKind::ellipse, {}, {{9, 0, 0}}, {{0, 9, 0}}};
    check(circle_of_9, {0, 2 * std::acos(-1)}, by_tolerance(FlattenMethod::adaptive, 1e-3),
          std::size_t(std::ceil(std::acos(-1) / std::acos(1 - 1e-3 / 9))) + 1);
    const CurveGeometry<3> line = Line<3>{{{1, 1, 1}}, {{1, 2, 3}}};
    EXPECT_EQ(must(flatten(line, {0, 4}, by_tolerance(FlattenMethod::adaptive, 1e-3))).points,
              (std::vector<Vec<3>>{{{1, 1, 1}}, {{5, 9, 13}}}));
    const CurveGeometry<2> spline = kArch;
    const auto part = must(flatten(spline, {0.25, 0.5}, by_tolerance(FlattenMethod::adaptive, 1e-3)));
    EXPECT_EQ(part.parameters.front(), 0.25);
    EXPECT_EQ(part.parameters.back(), 0.5);
    EXPECT_LT(distance(part.points.back(), kArch(0.5)), 1e-14);
    EXPECT_FALSE(flatten(line, {0, std::numeric_limits<double>::infinity()},
                         by_tolerance(FlattenMethod::adaptive, 1)));
}

TEST(Flatten, refuses_what_it_cannot_do_and_says_what_is_needed) {
    const auto kind = [](const auto& r) { return r ? RefusalKind::io : r.error().kind; };
    EXPECT_EQ(kind(flatten(kArch, {})), RefusalKind::invalid);
    for (const FlattenMethod method : kMethods) {
        auto o = by_tolerance(method, -1);
        EXPECT_EQ(kind(flatten(kArch, o)), RefusalKind::invalid);
        o.tolerance = std::numeric_limits<double>::quiet_NaN();
        EXPECT_EQ(kind(flatten(kArch, o)), RefusalKind::invalid);
        EXPECT_EQ(kind(flatten(kArch, by_tolerance(method, 1e-17))), RefusalKind::ill_conditioned);
        EXPECT_EQ(kind(flatten(kArch, by_segments(method, -3))), RefusalKind::invalid);
        o.tolerance = 1e-6;
        o.max_segments = 100;
        const auto refused = flatten(kArch, o);
        ASSERT_EQ(kind(refused), RefusalKind::limit) << name_of(method);
        EXPECT_NE(refused.error().message.find("1296"), std::string::npos) << refused.error().message;
    }
    auto o = by_tolerance(FlattenMethod::uniform, 0.1);
    o.segments = 4;
    EXPECT_EQ(kind(flatten(kArch, o)), RefusalKind::invalid);
}

// A curve around a torus-like patch and on a cylinder: samples of it are as near to the polyline as was said.
TEST(FlattenOn, follows_curves_on_surfaces_within_the_bound) {
    Random random(91);
    const SurfaceGeometry patch = random_patch<2, Hom<3>>(random, 3, {Ends::clamped, 2});
    const auto uv = std::get<Surface<Hom<3>>>(patch).domain();
    const auto at = [&](double x, double y) {
        return Vec<2>{{uv[0].lo + x * uv[0].length(), uv[1].lo + y * uv[1].length()}};
    };
    const CurveGeometry<2> cubic = bezier<Vec<2>>({at(0.1, 0.2), at(0.9, 0.1), at(0.2, 0.9), at(0.8, 0.7)});
    const SurfaceGeometry cylinder = Extrusion{
        Conic<3>{ConicKind::ellipse, {}, {{2, 0, 0}}, {{0, 2, 0}}}, {{0, 0, 1}}, SurfaceKind::cylinder};
    const CurveGeometry<2> helix = Line<2>{{{0, 0}}, {{1, 0.25}}};
    const auto check = [&](const SurfaceGeometry& s, const CurveGeometry<2>& c, Interval on,
                           double tolerance) {
        const auto line = must(flatten_on(s, c, on, tolerance, 1'000'000));
        EXPECT_LE(line.bound, tolerance);
        EXPECT_EQ(line.parameters.front(), on.lo);
        EXPECT_EQ(line.parameters.back(), on.hi);
        double most = 0;
        for (std::size_t i = 0; i + 1 < line.points.size(); ++i)
            for (int k = 0; k <= 8; ++k) {
                const double t = line.parameters[i] + (line.parameters[i + 1] - line.parameters[i]) * k / 8;
                const Vec<2> p = jet<0>(c, t).value();
                most = std::max(most, distance_to_segment(jet<0>(s, {p[0], p[1]}).value(), line.points[i],
                                                          line.points[i + 1]));
            }
        EXPECT_LE(most, line.bound);
        return line.segments();
    };
    for (const double tolerance : {1e-1, 1e-3, 1e-5}) check(patch, cubic, {0, 1}, tolerance);
    // A helix of radius 2 needs about (angle / 2) / acos(1 - tolerance / 2) segments.
    const auto n = check(cylinder, helix, {0, 12}, 1e-4);
    EXPECT_LT(double(n), 2.1 * 12 / (2 * std::acos(1 - 1e-4 / 2)));
}

TEST(FlattenOn, refuses_what_it_cannot_follow) {
    const SurfaceGeometry plane = Extrusion{Line<3>{{}, {{1, 0, 0}}}, {{0, 1, 0}}, SurfaceKind::plane};
    const CurveGeometry<2> line = Line<2>{{{0, 0}}, {{1, 1}}};
    const CurveGeometry<2> jump =
        must(Curve<Vec<2>>::make({must(BSplineBasis::make(1, {0, 0, 1, 1, 2, 2}))},
                                 Net<1, Vec<2>>({4}, {{{0, 0}}, {{1, 0}}, {{2, 2}}, {{3, 2}}})));
    const CurveGeometry<2> circle = Conic<2>{ConicKind::ellipse, {}, {{1, 0}}, {{0, 1}}};
    EXPECT_EQ(flatten_on(plane, line, {0, 1}, 0, 10).error().where, "tolerance");
    EXPECT_EQ(flatten_on(plane, line, {1, 1}, 1, 10).error().where, "on");
    EXPECT_EQ(flatten_on(plane, jump, {0, 2}, 1, 10).error().kind, RefusalKind::no_answer);
    EXPECT_EQ(flatten_on(plane, circle, {0, 6}, 1e-6, 10).error().kind, RefusalKind::limit);
    EXPECT_EQ(flatten_on(plane, circle, {0, 6}, 1e-17, 1000).error().kind, RefusalKind::ill_conditioned);
}

// Points are those of the curve at the parameters that are given, which are rounded.
TEST(Flatten, bounds_count_the_rounding_of_parameters) {
    for (const double from : {0.0, 1e3, 1e6})
        for (const FlattenMethod method :
             {FlattenMethod::uniform, FlattenMethod::forward, FlattenMethod::halving}) {
            const auto line =
                must(Curve<Vec<2>>::make({must(BSplineBasis::bezier(1, {from, from + 1}))},
                                         Net<1, Vec<2>>({2}, {Vec<2>{{0, 0}}, Vec<2>{{3e6, 0}}})));
            const auto f = must(flatten(line, {.method = method, .segments = 7}));
            for (std::size_t i = 0; i < f.points.size(); ++i)
                EXPECT_LE(std::abs(3e6 * (f.parameters[i] - from) - f.points[i][0]), f.bound) << from;
            EXPECT_LE(f.bound, 1e-7 + 3e-9 * from) << "of use";
        }
}

}  // namespace
}  // namespace freiform::test
