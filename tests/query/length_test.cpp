#include "bezier.hpp"

#include <freiform/query/length.hpp>
#include <freiform/spline/bezier.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace freiform::test {
namespace {

const Curve<Vec<2>> kArch = bezier<Vec<2>>({{{0, 0}}, {{1, 2}}, {{3, 2}}, {{4, 0}}});
const Curve<Vec<2>> kCusp = bezier<Vec<2>>({{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}});

Curve<Hom<2>> arc(double radius, double angle) {
    const double h = std::cos(angle / 2);
    return bezier<Hom<2>>({weighted(Vec<2>{{radius, 0}}, 1),
                           weighted(Vec<2>{{radius, radius * std::tan(angle / 2)}}, h),
                           weighted(Vec<2>{{radius * std::cos(angle), radius * std::sin(angle)}}, 1)});
}

// Speed in long double, by de Casteljau on the pieces, and its integral.
template <class P>
struct BruteForce {
    explicit BruteForce(const Curve<P>& curve) : pieces(curve) {}
    using Real = long double;
    static constexpr int kCoords = P::kCoords, D = Space<P>::kDim;

    Real speed(const NetView<1, const P>& b, Real t) const {
        const int n = b.extent[0];
        std::vector<std::array<Real, std::size_t(kCoords)>> c(static_cast<std::size_t>(n));
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < kCoords; ++k) c[std::size_t(i)][std::size_t(k)] = b({i})[k];
        for (int r = n - 1; r > 1; --r)
            for (int i = 0; i < r; ++i)
                for (std::size_t k = 0; k < std::size_t(kCoords); ++k)
                    c[std::size_t(i)][k] = (1 - t) * c[std::size_t(i)][k] + t * c[std::size_t(i) + 1][k];
        Real sum = 0;
        const Real w0 = Space<P>::kRational ? c[0][std::size_t(kCoords) - 1] : 1,
                   w1 = Space<P>::kRational ? c[1][std::size_t(kCoords) - 1] : 1, w = (1 - t) * w0 + t * w1;
        for (std::size_t k = 0; k < std::size_t(D); ++k) {
            const Real d = (n - 1) * (c[1][k] * w0 - c[0][k] * w1) / (w * w);
            sum += d * d;
        }
        return std::sqrt(sum);
    }
    // Romberg's scheme on every piece.
    Real operator()(int levels) const {
        Real all = 0;
        for (int i = 0; i < pieces.extent()[0]; ++i) {
            const auto b = pieces.net({i});
            std::vector<Real> row{(speed(b, 0) + speed(b, 1)) / 2};
            for (int level = 1; level <= levels; ++level) {
                const int n = 1 << (level - 1);
                Real middle = 0;
                for (int k = 0; k < n; ++k) middle += speed(b, (k + 0.5L) / n) / n;
                std::vector<Real> next{(row[0] + middle) / 2};
                Real power = 4;
                for (std::size_t k = 0; k < row.size(); ++k, power *= 4)
                    next.push_back(next[k] + (next[k] - row[k]) / (power - 1));
                row = std::move(next);
            }
            all += row.back();
        }
        return all;
    }
    BezierPieces<1, P> pieces;
};

void expect_length(const Measure& m, long double exact, double within, const char* what) {
    EXPECT_LE(double(std::abs(m.value - exact)), m.bound + double(exact) * 0x1p-53) << what << " " << m.value;
    EXPECT_LE(m.bound, within) << what;
}

TEST(R20, arc_length_is_the_integral_of_the_speed) {
    const auto speed = [](double t) { return norm(kArch.jet<1>(t)(1)); };
    for (const double t : {0.0, 0.25, 0.7, 1.0}) {
        double sum = 0;  // Simpson's rule
        const int n = 2000;
        for (int i = 0; i < n; ++i) {
            const double a = t * i / n, b = t * (i + 1) / n;
            sum += (b - a) / 6 * (speed(a) + 4 * speed((a + b) / 2) + speed(b));
        }
        EXPECT_NEAR(must(ArcLength(kArch, 1e-12).at(t)).value, sum, 1e-11);
    }
}

TEST(R20, points_at_equal_distance) {
    const ArcLength s(kArch, 0);
    const auto places = must(s.equal_parts(10));
    ASSERT_EQ(places.size(), 11u);
    EXPECT_EQ(places.front().parameter, 0);
    EXPECT_EQ(places.back().parameter, 1);
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        const auto part = must(length(kArch, Interval{places[i].parameter, places[i + 1].parameter}, 1e-12));
        EXPECT_NEAR(part.value, s.total().value / 10, 1e-12);
    }
    const auto spaced = must(s.spaced(1.5));
    ASSERT_EQ(spaced.size(), 4u);  // 0, 1.5, 3, 4.5 of 5.268
    EXPECT_NEAR(must(s.at(spaced[2].parameter)).value, 3, 1e-13);
}

// Bounds are of parts of the whole length as it is, which is known as well as was asked for.
TEST(R20, bounds_of_equal_parts_count_what_the_whole_is_off_by) {
    Random r(3);
    for (int k = 0; k < 40; ++k) {
        const auto curve = random_patch<1, Hom<3>>(r, 2 + k % 4, {Ends::clamped, 3});
        const ArcLength rough(curve, 0.05), sharp(curve, 1e-11);
        const auto places = must(rough.equal_parts(7));
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto at = must(sharp.at(places[i].parameter));
            EXPECT_LE(std::abs(at.value - sharp.total().value * (double(i) / 7)),
                      places[i].bound + at.bound + sharp.total().bound)
                << "curve " << k << ", place " << i;
        }
    }
}

TEST(R20, places_on_a_part_are_those_of_the_curve_cut_out) {
    const auto random = [](std::uint64_t seed) {
        Random r(seed);
        return random_patch<1, Hom<3>>(r, 4, {Ends::clamped, 4});
    };
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const auto curve = random(seed);
        const Interval whole = curve.basis().domain();
        const Interval on{whole.lo + 0.21 * whole.length(), whole.lo + 0.83 * whole.length()};
        const ArcLength s(curve, 0), cut(must(restrict_to(curve, 0, on)), 0);
        const Measure all = must(s.total(on));
        EXPECT_NEAR(all.value, cut.total().value, 1e-12);
        const auto parts = must(s.equal_parts(7, on)), of_cut = must(cut.equal_parts(7));
        ASSERT_EQ(parts.size(), 8u);
        EXPECT_EQ(parts.front().parameter, on.lo);
        EXPECT_EQ(parts.back().parameter, on.hi);
        for (std::size_t i = 0; i < 8; ++i) {
            EXPECT_NEAR(parts[i].parameter, of_cut[i].parameter, 1e-11) << seed << ", " << i;
            const Measure here = must(length(curve, {on.lo, parts[i].parameter}, 0));
            EXPECT_LE(std::abs(here.value - all.value * double(i) / 7),
                      parts[i].bound + here.bound + all.bound + 1e-15 * all.value);
            EXPECT_LT(parts[i].bound, 1e-9);
        }
        const auto spaced = must(s.spaced(all.value / 3.5, on));
        ASSERT_EQ(spaced.size(), 4u);
        EXPECT_NEAR(spaced[2].parameter, must(s.parameter(all.value / 1.75, on)).parameter, 1e-12);
    }
    const ArcLength s(kArch, 0);
    EXPECT_EQ(s.parameter(3, {0, 0.5}).error().kind, RefusalKind::out_of_domain);
    EXPECT_EQ(s.equal_parts(3, {0.5, 2}).error().where, "on");
    EXPECT_EQ(s.total({0.5, 0.2}).error().where, "on");
    EXPECT_EQ(must(s.equal_parts(3, s.domain())).back().parameter, 1);
}

TEST(Length, of_closed_forms) {
    for (const double accuracy : {1e-2, 1e-6, 1e-10, 0.0}) {
        const double within = std::max(accuracy, 3e-13);
        const auto check = [&](const auto& curve, long double exact, const char* what) {
            expect_length(length(curve, accuracy), exact, within, what);
        };
        check(bezier<Vec<2>>({{{0, 0}}, {{3, 4}}}), 5, "line");
        check(bezier<Vec<1>>({{{0}}, {{2}}, {{0}}}), 2, "up and down");
        check(bezier<Vec<2>>({{{0, 0}}, {{2, 0}}, {{0.5, 0}}}), 2 * (8.0L / 7) - 0.5L, "back along itself");
        check(bezier<Vec<2>>({{{0, 0}}, {{0.5, 0}}, {{1, 1}}}), (2 * std::sqrt(5.0L) + std::asinh(2.0L)) / 4,
              "parabola");
        check(
            bezier<Vec<2>>({{{0, 0}}, {{0, 0}}, {{0.25, 0}}, {{0.75, 0.75}}}),
            [] {  // (3/4 t^2, 3/4 t^3), speed 3/2 t sqrt(1 + 9/4 t^2)
                const long double k = 2.25L;
                return (std::pow(1 + k, 1.5L) - 1) / (3 * k) * 1.5L;
            }(),
            "cusp at an end");
        check(kCusp, 1.82842712474619009760L, "cusp inside");
        check(arc(1, std::numbers::pi / 2), std::numbers::pi_v<long double> / 2, "quarter");
        check(arc(1, 2.5), 2.5L, "arc");
        check(bezier<Vec<3>>({{{1, 2, 3}}, {{1, 2, 3}}, {{1, 2, 3}}}), 0, "a point");
    }
}

TEST(Length, agrees_with_brute_force_on_random_curves) {
    Random random(201);
    const auto check = [&]<class P>(int max_degree, BasisOptions options) {
        for (int k = 0; k < 4; ++k) {
            const auto curve = random_patch<1, P>(random, max_degree, options);
            const Measure m = length(curve, 1e-9);
            const double brute = double(BruteForce<P>(curve)(10));
            EXPECT_NEAR(m.value, brute, 1e-4 * brute + m.bound);
            EXPECT_LE(m.bound, 1e-9);
            const Measure best = length(curve, 0);
            EXPECT_LE(std::abs(m.value - best.value), m.bound + best.bound);
        }
    };
    check.operator()<Vec<2>>(6, {});
    check.operator()<Hom<2>>(4, {});
    check.operator()<Vec<3>>(4, {Ends::closed});
    check.operator()<Hom<3>>(3, {Ends::unclamped});
    check.operator()<Hom<4>>(3, {});
}

TEST(Length, bound_holds_against_long_double_where_brute_force_converges) {
    Random random(202);
    for (const int degree : {2, 3, 5, 9, 16, 25})
        for (int k = 0; k < 3; ++k) {
            std::vector<Vec<2>> b;  // runs along x, so that the speed has no zero near by
            for (int i = 0; i <= degree; ++i)
                b.push_back({{double(i) / degree, 0.3 * random.real(-1, 1) / std::sqrt(degree)}});
            const auto curve = bezier(b);
            const long double brute = BruteForce<Vec<2>>(curve)(10);
            for (const double accuracy : {1e-5, 0.0}) {
                const Measure m = length(curve, accuracy);
                EXPECT_LE(double(std::abs(m.value - brute)), m.bound + 1e-13) << degree << " " << m.bound;
                EXPECT_LE(m.bound, std::max(accuracy, degree < 20 ? 5e-13 : 1e-10)) << degree;
            }
        }
}

TEST(Length, adds_up_reverses_scales_and_ignores_the_parametrisation) {
    Random random(203);
    for (int k = 0; k < 6; ++k) {
        const auto curve = random_patch<1, Hom<3>>(random, 4, {});
        const Interval on = curve.domain()[0];
        const ArcLength s(curve, 1e-11);
        const Measure all = s.total();
        const double t = random.real(on.lo, on.hi);
        const auto a = must(length(curve, Interval{on.lo, t}, 1e-11)),
                   b = must(length(curve, Interval{t, on.hi}, 1e-11));
        EXPECT_NEAR(a.value + b.value, all.value, a.bound + b.bound + all.bound);
        const auto back = length(reverse(curve, 0), 1e-11);
        EXPECT_NEAR(back.value, all.value, back.bound + all.bound);
        const auto finer = length(must(elevate(curve, 0)), 1e-11);
        EXPECT_NEAR(finer.value, all.value, finer.bound + all.bound);
        const auto left = length(must(restrict_to(curve, 0, {on.lo, t})), 1e-11);
        EXPECT_NEAR(left.value, a.value, left.bound + a.bound);
        for (const int e : {-1010, -3, 70, 1000}) {
            Net<1, Hom<3>> net = curve.net();
            for (auto& p : net.flat())
                for (int i = 0; i < 3; ++i) p[i] = std::scalbn(p[i], e);
            const auto scaled = length(must(Curve<Hom<3>>::make(curve.bases(), net)), std::scalbn(1e-11, e));
            EXPECT_EQ(scaled.value, std::scalbn(all.value, e));
        }
    }
}

TEST(Length, does_not_lose_digits_far_from_the_origin) {
    const double far = 0x1p20;
    const auto curve =
        bezier<Vec<2>>({{{far, far}}, {{far + 1, far + 2}}, {{far + 3, far + 2}}, {{far + 4, far}}});
    EXPECT_EQ(length(curve, 0).value, length(kArch, 0).value);
    EXPECT_LT(length(curve, 0).bound, 1e-13);
}

TEST(Length, inverse_gives_back_the_parameter_everywhere) {
    Random random(204);
    const auto check = [&](const auto& curve) {
        const ArcLength s(curve, 1e-10);
        const Measure all = s.total();
        double before = s.domain().lo;
        for (int k = 0; k <= 200; ++k) {
            const double wanted = all.value * k / 200;
            const auto place = must(s.parameter(wanted));
            const auto reached = must(s.at(place.parameter));
            EXPECT_LE(std::abs(reached.value - wanted), place.bound + reached.bound);
            EXPECT_LE(place.bound, 1e-9);
            EXPECT_GE(place.parameter, before);
            before = place.parameter;
        }
        EXPECT_EQ(before, s.domain().hi);
    };
    check(kArch);
    check(kCusp);
    check(bezier<Vec<2>>({{{0, 0}}, {{0, 0}}, {{0.25, 0}}, {{0.75, 0.75}}}));
    check(arc(1, 3));
    check(random_patch<1, Vec<3>>(random, 5, {Ends::closed}));
    check(random_patch<1, Hom<2>>(random, 3, {Ends::unclamped}));
}

TEST(Length, inverse_ends_for_lengths_of_any_size) {
    for (const int e : {-1000, -300, 0, 300, 1000}) {
        const double size = std::scalbn(1.0, e);
        const auto curve =
            bezier<Vec<2>>({{{0, 0}}, {{size, 2 * size}}, {{3 * size, -size}}, {{size * 1e-8, size}}});
        const ArcLength s(curve, 0);
        for (int k = 1; k < 50; ++k) {
            const auto place = must(s.parameter(s.total().value * k / 50));
            EXPECT_LE(place.bound, 1e-13 * s.total().value);
        }
    }
}

TEST(Length, jumps_add_nothing) {
    const auto curve =
        must(Curve<Vec<2>>::make({must(BSplineBasis::make(1, {0, 0, 1, 1, 2, 2}))},
                                 Net<1, Vec<2>>({4}, {{{0, 0}}, {{1, 0}}, {{5, 5}}, {{7, 5}}})));
    EXPECT_NEAR(length(curve, 0).value, 3, 1e-15);
}

TEST(Length, refuses_places_that_are_not_on_the_curve) {
    const auto kind = [](const auto& r) { return r ? RefusalKind::io : r.error().kind; };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const ArcLength s(kArch, 1e-9);
    EXPECT_EQ(kind(s.at(1.5)), RefusalKind::out_of_domain);
    EXPECT_EQ(kind(s.at(nan)), RefusalKind::nonfinite);
    EXPECT_EQ(kind(s.parameter(-1)), RefusalKind::out_of_domain);
    EXPECT_EQ(kind(s.parameter(6)), RefusalKind::out_of_domain);
    EXPECT_EQ(kind(s.parameter(nan)), RefusalKind::nonfinite);
    EXPECT_EQ(kind(s.equal_parts(0)), RefusalKind::invalid);
    EXPECT_EQ(kind(s.spaced(0)), RefusalKind::invalid);
    EXPECT_EQ(kind(s.spaced(1e-12)), RefusalKind::limit);
    EXPECT_EQ(kind(length(kArch, Interval{0.5, 0.2}, 0)), RefusalKind::invalid);
}

}  // namespace
}  // namespace freiform::test
