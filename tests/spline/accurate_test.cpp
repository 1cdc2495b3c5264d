// Exact rational arithmetic as the judge of accurate values, of splitting and of elevation.
#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/spline/accurate.hpp>
#include <freiform/spline/bezier.hpp>

#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::gap;
using test::must;
using test::Random;
using test::Rational;

double ulp(double x) {
    const double a = std::abs(x);
    return std::nextafter(a, std::numeric_limits<double>::infinity()) - a;
}

template <std::size_t N, class P, class B>
Accurate<PointOf<P>> accurate(const Patch<N, P, B>& s, const Param<N>& u) {
    Accurate<PointOf<P>> out;
    const auto ok = evaluate_accurate<N, P, B>(s, std::span(&u, 1), std::span(&out, 1));
    EXPECT_TRUE(ok.has_value());
    return out;
}

// Largest error in units of the bound; every value that the bound promises within a unit is counted.
struct Outcome {
    double ratio = 0, ordinary = 0;
    int values = 0, certain = 0;
};

template <std::size_t N, class P, class B>
void judge(const Patch<N, P, B>& s, const Param<N>& u, Outcome& o) {
    const auto computed = accurate<N, P, B>(s, u);
    const auto right = test::value_of<Rational>(s, u);
    const auto plain = s(u);
    for (int c = 0; c < Space<P>::kDim; ++c) {
        const double error = gap(computed.value[c], right[std::size_t(c)]), bound = computed.bound[c];
        EXPECT_LE(error, bound);
        if (bound > 0) o.ratio = std::max(o.ratio, error / bound);
        o.ordinary = std::max(o.ordinary, gap(plain[c], right[std::size_t(c)]) / s.value_error_bound());
        ++o.values;
        o.certain += bound <= ulp(computed.value[c]);
        // Without cancellation of forty bits the promise is kept.
        double most = 0;
        for (const P& p : s.net().flat()) most = std::max(most, std::abs(project(p)[c]));
        if (std::abs(computed.value[c]) > 0x1p-38 * most) EXPECT_LE(bound, 0.51 * ulp(computed.value[c]));
        EXPECT_LE(bound, 0.51 * ulp(computed.value[c]) + 0x1p-92 * most);
    }
}

// Rational numbers grow with the degree: short parameters keep the time of tests in bounds.
double parameter(Random& random, Interval on, int degree) {
    const double t = random.real(on.lo, on.hi);
    return std::clamp(degree > 8 ? std::round(t * 0x1p20) * 0x1p-20 : t, on.lo, on.hi);
}

template <class P>
Curve<P, Bernstein> random_bezier(Random& random, int degree) {
    return must(Curve<P, Bernstein>::make({must(Bernstein::make(degree))},
                                          test::random_net<1, P>(random, {degree + 1})));
}

TEST(EvaluateAccurate, stays_within_its_bound_for_all_degrees) {
    std::printf("  largest error / bound of evaluate, evaluate_accurate; values certain to one unit:\n");
    Outcome all;
    for (int degree = 1; degree <= 25; ++degree) {
        Random random(std::uint64_t(degree) + 100);
        Outcome o;
        for (int k = 0; k < (degree > 8 ? 2 : 6); ++k) {
            judge<1, Vec<2>, Bernstein>(random_bezier<Vec<2>>(random, degree),
                                        parameter(random, {0, 1}, degree), o);
            judge<1, Hom<2>, Bernstein>(random_bezier<Hom<2>>(random, degree),
                                        parameter(random, {0, 1}, degree), o);
            const test::BasisOptions options{k % 2 ? test::Ends::clamped : test::Ends::closed, 2, false,
                                             degree > 8};
            const auto basis = test::random_basis(random, degree, options);
            const auto s = test::random_patch_on<1, Vec<1>>(random, {basis});
            const auto r = test::random_patch_on<1, Hom<1>>(random, {basis});
            const Interval on = basis.domain();
            judge<1, Vec<1>, BSplineBasis>(s, parameter(random, on, degree), o);
            if (degree < 13) judge<1, Hom<1>, BSplineBasis>(r, parameter(random, on, degree), o);
        }
        std::printf("  degree %2d   %.3f   %.6f   %d of %d\n", degree, o.ordinary, o.ratio, o.certain,
                    o.values);
        EXPECT_LE(o.ordinary, 1);
        EXPECT_EQ(o.certain, o.values);
        all.ratio = std::max(all.ratio, o.ratio);
    }
    EXPECT_GT(all.ratio, 0.5);
}

TEST(EvaluateAccurate, works_for_surfaces_and_volumes) {
    Random random(5);
    Outcome o;
    for (int k = 0; k < 6; ++k) {
        const auto s = test::random_patch<2, Hom<3>>(random, 4, {test::Ends::closed, 2});
        const auto v = test::random_patch<3, Vec<2>>(random, 3, {test::Ends::clamped, 2});
        std::array<double, 2> a{};
        std::array<double, 3> b{};
        for (std::size_t d = 0; d < 2; ++d) a[d] = s.domain()[d].middle();
        for (std::size_t d = 0; d < 3; ++d) b[d] = v.domain()[d].lo + 0.3 * v.domain()[d].length();
        judge<2, Hom<3>, BSplineBasis>(s, a, o);
        judge<3, Vec<2>, BSplineBasis>(v, b, o);
    }
    EXPECT_EQ(o.certain, o.values);
}

// The product of linear factors (x - root), in Bernstein form, rounded to doubles.
Curve<Vec<1>, Bernstein> with_roots(const std::vector<double>& roots) {
    std::vector<Rational> c{1};
    for (double root : roots) {
        const Rational a = Rational(0) - Rational(root), b = Rational(1) - Rational(root);
        std::vector<Rational> next(c.size() + 1, Rational(0));
        const int n = int(c.size()) - 1;
        for (int i = 0; i <= n; ++i) {
            next[std::size_t(i)] += c[std::size_t(i)] * a * (n + 1 - i) / (n + 1);
            next[std::size_t(i) + 1] += c[std::size_t(i)] * b * (i + 1) / (n + 1);
        }
        c = std::move(next);
    }
    std::vector<Vec<1>> net;
    for (const Rational& x : c) net.push_back({{x.convert_to<double>()}});
    const int degree = int(net.size()) - 1;
    return must(
        Curve<Vec<1>, Bernstein>::make({must(Bernstein::make(degree))}, {{degree + 1}, std::move(net)}));
}

TEST(EvaluateAccurate, keeps_all_digits_near_multiple_roots_where_ordinary_values_have_few) {
    for (int k : {0, 3, 8}) {
        std::vector<double> roots(7, 0.75);
        roots.insert(roots.end(), std::size_t(k), 0.5);
        const auto s = with_roots(roots);
        for (int i = 0; i < 20; ++i) {
            const double t = 0.75 + (i % 2 ? -1 : 1) * 0x1p-6 * (1 + i / 20.0);
            const Rational right = test::value_of<Rational>(s, t)[0];
            const auto a = accurate<1, Vec<1>, Bernstein>(s, t);
            const double unit = ulp(right.convert_to<double>());
            EXPECT_LE(gap(s(t)[0], right), s.value_error_bound());
            EXPECT_GE(s.value_error_bound(), 1e9 * unit);
            EXPECT_LE(a.bound[0], unit) << k << " " << t;
            EXPECT_LE(gap(a.value[0], right), a.bound[0]);
        }
        // Nearer to the root digits are lost here too, and the bound says so.
        Outcome o;
        for (int i = -5; i <= 5; ++i) judge<1, Vec<1>, Bernstein>(s, 0.75 + i * 0x1p-14, o);
        EXPECT_EQ(o.certain, 0);
    }
}

TEST(EvaluateAccurate, says_what_is_left_where_all_digits_cancel) {
    // 2^-60 (1 - t) + ... : the sum of 1 and -1 leaves what two neighbouring doubles do not hold.
    const auto s = with_roots(std::vector<double>(25, 1.0 / 3));
    const auto a = accurate<1, Vec<1>, Bernstein>(s, 1.0 / 3);
    const Rational exact = test::value_of<Rational>(s, 1.0 / 3)[0];
    EXPECT_LE(gap(a.value[0], exact), a.bound[0]);
    EXPECT_GT(a.bound[0], 0);
    EXPECT_LT(a.bound[0], 0x1p-92);
}

TEST(EvaluateAccurate, scales_exactly_and_survives_the_ends_of_the_range) {
    Random random(9);
    const auto s = random_bezier<Hom<2>>(random, 7);
    for (int e : {-300, 200, 700}) {
        auto net = s.net();
        for (auto& p : net.flat())
            for (int c = 0; c < 2; ++c) p[c] = std::ldexp(p[c], e);
        const auto scaled = must(Curve<Hom<2>, Bernstein>::make(s.bases(), net));
        const auto one = accurate<1, Hom<2>, Bernstein>(s, 0.3),
                   other = accurate<1, Hom<2>, Bernstein>(scaled, 0.3);
        for (int c = 0; c < 2; ++c) {
            EXPECT_EQ(other.value[c], std::ldexp(one.value[c], e));
            EXPECT_EQ(other.bound[c], std::ldexp(one.bound[c], e));
        }
    }
    for (int e : {-1060, -1020, 1021}) {
        auto net = random_bezier<Vec<1>>(random, 5).net();
        for (auto& p : net.flat()) p[0] = std::ldexp(p[0], e);
        const auto tiny = must(Curve<Vec<1>, Bernstein>::make({must(Bernstein::make(5))}, net));
        const auto a = accurate<1, Vec<1>, Bernstein>(tiny, 0.7);
        EXPECT_LE(gap(a.value[0], test::value_of<Rational>(tiny, 0.7)[0]), a.bound[0]);
        EXPECT_LE(a.bound[0], ulp(a.value[0]) * 3);
    }
}

TEST(EvaluateAccurate, does_not_depend_on_the_scale_of_the_knots) {
    Random random(4);
    const std::vector<double> knots{0, 0, 0, 0.25, 0.75, 1, 1, 1};
    const auto net = test::random_net<1, Vec<1>>(random, {5});
    const auto s = must(Curve<Vec<1>>::make({must(BSplineBasis::make(2, knots))}, net));
    const auto one = accurate<1, Vec<1>, BSplineBasis>(s, 0.4375);
    for (int e : {-1070, -900, 800, 1000}) {
        std::vector<double> far;
        for (double t : knots) far.push_back(std::ldexp(t, e));
        const auto other = must(Curve<Vec<1>>::make({must(BSplineBasis::make(2, far))}, net));
        const auto a = accurate<1, Vec<1>, BSplineBasis>(other, std::ldexp(0.4375, e));
        EXPECT_EQ(a.value, one.value) << e;
        EXPECT_EQ(a.bound, one.bound) << e;
    }
}

TEST(EvaluateAccurate, refuses_with_the_index) {
    Random random(2);
    const auto s = random_bezier<Vec<1>>(random, 3);
    const std::array<double, 2> at{0.5, 1.5};
    std::array<Accurate<Vec<1>>, 2> out;
    const auto r = evaluate_accurate<1, Vec<1>, Bernstein>(s, at, out);
    ASSERT_FALSE(r.has_value());
    EXPECT_EQ(r.error().where, "at[1]");
    EXPECT_EQ(r.error().kind, RefusalKind::out_of_domain);
}

// Coefficient j of what is the same spline on the knots of `fresh`: its blossom, in exact arithmetic.
template <class P>
std::vector<Rational> coefficient(const Curve<P>& s, const std::vector<double>& args, double inside) {
    const auto& basis = s.basis();
    const int p = basis.degree(), span = basis.span(inside);
    std::vector<Rational> x(args.begin(), args.end()), w(std::size_t(p) + 1);
    blossom(basis, span, static_cast<const Rational*>(x.data()), w.data());
    std::vector<Rational> sum(std::size_t(P::kCoords), Rational(0));
    for (int k = 0; k <= p; ++k)
        for (int c = 0; c < P::kCoords; ++c)
            sum[std::size_t(c)] += w[std::size_t(k)] * Rational(s.net().flat()[std::size_t(span - p + k)][c]);
    return sum;
}

template <class P>
double largest(const Curve<P>& s) {
    double most = 0;
    for (const P& p : s.net().flat()) most = std::max(most, max_abs(p));
    return most;
}

// Coefficients whose support lies in one span of the old knots need no care about which piece acts.
TEST(Splitting, stays_within_its_bound_for_all_degrees) {
    std::printf("  degree   error / bound of splitting, elevation\n");
    for (int p = 1; p <= 25; ++p) {
        Random random(std::uint64_t(p) + 7);
        double split = 0, raised = 0;
        for (int k = 0; k < (p > 8 ? 1 : 3); ++k) {
            const auto s = test::random_patch_on<1, Hom<2>>(
                random, {test::random_basis(random, p, {test::Ends::clamped, 1, false, p > 8})});
            const Interval on = s.domain()[0];
            const double cut = parameter(random, on, p);
            for (const Interval part : {Interval{on.lo, cut}, Interval{cut, on.hi}}) {
                const auto half = must(restrict_to(s, 0, part));
                for (int j = 0; j <= p; ++j) {
                    std::vector<double> args(std::size_t(p), part.lo);
                    for (int i = 0; i < j; ++i) args[std::size_t(i)] = part.hi;
                    const auto right = coefficient(s, args, part.middle());
                    for (int c = 0; c < 3; ++c)
                        split =
                            std::max(split, gap(half.net().flat()[std::size_t(j)][c], right[std::size_t(c)]) /
                                                (refinement_error(p) * largest(s)));
                }
            }
            if (p == kMaxDegree) continue;
            const auto up = must(elevate(s, 0));
            for (int j = 0; j <= p + 1; ++j)
                for (int c = 0; c < 3; ++c) {
                    const auto net = s.net().flat();
                    const Rational share = Rational(j) / (p + 1);
                    Rational right(0);
                    if (j > 0) right += share * Rational(net[std::size_t(j) - 1][c]);
                    if (j <= p) right += (1 - share) * Rational(net[std::size_t(j)][c]);
                    raised = std::max(raised, gap(up.net().flat()[std::size_t(j)][c], right) /
                                                  (elevation_error(p) * largest(s)));
                }
        }
        std::printf("  %6d   %.3f  %.3f\n", p, split, raised);
        EXPECT_LE(split, 1);
        EXPECT_LE(raised, 1);
        EXPECT_GT(split, 0.002);
    }
}

TEST(Splitting, of_splines_stays_within_its_bound_too) {
    for (int p : {1, 2, 3, 5, 9}) {
        Random random(std::uint64_t(p) + 77);
        const auto s = test::random_patch_on<1, Vec<2>>(
            random, {test::random_basis(random, p, {test::Ends::clamped, 3, false, true})});
        const Interval on = s.domain()[0];
        const auto part = must(restrict_to(s, 0, {parameter(random, {on.lo, on.middle()}, 9), on.hi}));
        const auto up = must(elevate(s, 0));
        // Values are judged: both maps change no value, and a value is a convex combination of coefficients.
        for (double t : {part.domain()[0].lo, parameter(random, part.domain()[0], 9), on.hi}) {
            const auto right = test::value_of<Rational>(s, t), split = test::value_of<Rational>(part, t),
                       raised = test::value_of<Rational>(up, t);
            for (std::size_t c = 0; c < 2; ++c) {
                EXPECT_LE(abs(Rational(split[c] - right[c])).convert_to<double>(),
                          refinement_error(p) * largest(s));
                EXPECT_LE(abs(Rational(raised[c] - right[c])).convert_to<double>(),
                          elevation_error(p) * largest(s));
            }
        }
    }
}

TEST(Splitting, of_bezier_coefficients_in_place_stays_within_its_bound) {
    for (int p = 1; p <= 25; ++p) {
        Random random(std::uint64_t(p) + 3);
        const auto s = random_bezier<Vec<1>>(random, p);
        const double t = random.real(0, 1);
        std::vector<Vec<1>> left(s.net().flat().begin(), s.net().flat().end()), right = left;
        keep_left(Fibre<Vec<1>>{left.data(), p + 1, 1}, t);
        keep_right(Fibre<Vec<1>>{right.data(), p + 1, 1}, t);
        std::vector<Rational> row;
        for (const auto& x : s.net().flat()) row.push_back(Rational(x[0]));
        double worst = 0;
        for (int k = 0; k <= p; ++k) {
            worst = std::max({worst, gap(left[std::size_t(k)][0], row.front()),
                              gap(right[std::size_t(p - k)][0], row.back())});
            for (std::size_t i = 0; i + 1 < row.size(); ++i) row[i] += Rational(t) * (row[i + 1] - row[i]);
            row.pop_back();
        }
        EXPECT_LE(worst, split_error(p));
    }
}

}  // namespace
}  // namespace freiform
