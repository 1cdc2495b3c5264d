#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/basis/change.hpp>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace freiform {
namespace {

using test::Ends;
using test::must;
using test::Random;

// A spline of one coordinate whose coefficients are in [-1, 1].
using Values = Net<1, Vec<1>>;

double value(const BSplineBasis& b, const Values& c, double u, int order = 0) {
    double w[kMaxDegree + 1], sum = 0;
    const int first = weights(b, u, order, w);
    for (int i = 0; i <= b.degree(); ++i) sum += w[i] * c.flat()[std::size_t((first + i) % b.size())][0];
    return sum;
}

struct Sample {
    BSplineBasis basis;
    Values net;
};

template <class F>
void each_spline(bool jumps, F&& f) {
    Random random(21);
    for (int p = 0; p <= 9; ++p)
        for (Ends ends : {Ends::clamped, Ends::unclamped, Ends::closed})
            for (int k = 0; k < 25; ++k) {
                if (p == 0 && ends == Ends::closed) continue;
                const auto b = test::random_basis(
                    random, p, {ends, random.integer(1, 5), jumps && k % 2 == 0, k % 3 == 0});
                f(random, Sample{b, test::random_net<1, Vec<1>>(random, {b.size()})});
            }
}

void expect_same(const Sample& a, const Change<BSplineBasis>& change, std::span<const double> at,
                 double tolerance) {
    const auto net = along(0, change.map, a.net);
    ASSERT_EQ(net.extent()[0], change.basis.size());
    for (double u : at)
        ASSERT_NEAR(value(a.basis, a.net, u), value(change.basis, net, u), tolerance)
            << "degree " << a.basis.degree() << (a.basis.is_closed() ? " closed" : " open") << " at " << u;
}

// Rows of a map that carries control points to control points inside their convex hull.
void expect_convex(const BandMap& map, double tolerance) {
    for (int i = 0; i < map.rows(); ++i) {
        double sum = 0;
        for (double w : map.row(i)) {
            ASSERT_GE(w, 0) << "row " << i;
            sum += w;
        }
        ASSERT_NEAR(sum, 1, tolerance);
    }
}

TEST(InsertKnots, leaves_the_function_unchanged) {
    each_spline(true, [](Random& random, const Sample& s) {
        const auto [lo, hi] = s.basis.domain();
        const int p = s.basis.degree();
        std::vector<double> more;
        for (double b : s.basis.breaks()) {
            const int room = p + (s.basis.is_closed() ? 0 : 1) - s.basis.multiplicity(b);
            if (s.basis.is_closed() && b == (random.chance(0.5) ? lo : hi)) continue;  // the same place
            if (s.basis.is_closed() && (b == lo || b == hi) && !more.empty() && more[0] == lo) continue;
            if (room > 0 && random.chance(0.5))
                more.insert(more.end(), std::size_t(random.integer(1, room)), b);
        }
        for (int k = 0; k < 4; ++k)
            more.insert(more.end(), std::size_t(random.integer(1, std::max(p, 1))), random.real(lo, hi));
        std::sort(more.begin(), more.end());
        const auto change = must(insert_knots(s.basis, more));
        EXPECT_EQ(change.basis.size(), s.basis.size() + int(more.size()));
        EXPECT_EQ(change.basis.domain(), s.basis.domain());
        expect_convex(change.map, 1e-14 * (p + 1));
        expect_same(s, change, test::parameters(random, s.basis), 2e-14 * (p + 1));
        // Inserting nothing is the identity, to the bit.
        const auto same = must(insert_knots(s.basis, {}));
        EXPECT_EQ(same.basis, s.basis);
        EXPECT_EQ(along(0, same.map, s.net), s.net);
    });
}

TEST(InsertKnots, at_the_seam_of_a_closed_spline_leaves_the_function_unchanged) {
    Random random(22);
    for (int p = 2; p <= 9; ++p) {
        const auto b = must(BSplineBasis::periodic(p, {0.1, 0.3, 0.35, 0.7, 0.9}));
        const Sample s{b, test::random_net<1, Vec<1>>(random, {b.size()})};
        for (const std::vector<double>& more :
             {std::vector{0.1}, std::vector{0.9}, std::vector(std::size_t(p - 1), 0.1),
              std::vector(std::size_t(p - 1), 0.9)}) {
            const auto change = must(insert_knots(b, more));
            EXPECT_EQ(change.basis.multiplicity(0.1), 1 + int(more.size()));
            expect_convex(change.map, 1e-13);
            expect_same(s, change, test::parameters(random, b, 20), 1e-13);
        }
        // With p knots at the seam the curve passes through a coefficient there.
        const auto full = must(insert_knots(b, std::vector(std::size_t(p - 1), 0.1)));
        const auto net = along(0, full.map, s.net);
        double nearest = 1;
        for (const auto& c : net.flat()) nearest = std::min(nearest, std::abs(c[0] - value(b, s.net, 0.1)));
        EXPECT_LT(nearest, 1e-14);
        EXPECT_FALSE(insert_knots(b, std::vector(std::size_t(p), 0.1)).has_value());
    }
}

TEST(InsertKnots, refuses_knots_that_cannot_be_inserted_and_says_which) {
    const auto b = must(BSplineBasis::make(2, {0, 0, 0, 1, 2, 2, 2}));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto where = [&](std::vector<double> more) {
        const auto r = insert_knots(b, more);
        return r ? std::string("accepted") : text(name_of(r.error().kind), " ", r.error().where);
    };
    EXPECT_EQ(where({0.5, 2.5}), "out_of_domain knots[1]");
    EXPECT_EQ(where({-0.5}), "out_of_domain knots[0]");
    EXPECT_EQ(where({0.5, nan}), "nonfinite knots[1]");
    EXPECT_EQ(where({0.5, 0.25}), "invalid knots[1]");
    EXPECT_EQ(where({0.0}).substr(0, 7), "invalid");
    EXPECT_EQ(where({1.0, 1.0}), "accepted");
    EXPECT_EQ(where({1.0, 1.0, 1.0}).substr(0, 7), "invalid");
}

TEST(Elevate, leaves_the_function_unchanged_and_raises_every_multiplicity) {
    each_spline(true, [](Random& random, const Sample& s) {
        const auto change = must(elevate(s.basis));
        EXPECT_EQ(change.basis.degree(), s.basis.degree() + 1);
        EXPECT_EQ(change.basis.domain(), s.basis.domain());
        EXPECT_EQ(change.basis.breaks(), s.basis.breaks());
        for (double b : s.basis.breaks())
            if (s.basis.domain().lo < b && b < s.basis.domain().hi) {
                EXPECT_EQ(change.basis.multiplicity(b), s.basis.multiplicity(b) + 1);
            }
        expect_convex(change.map, 1e-13);
        expect_same(s, change, test::parameters(random, s.basis), 2e-13);
    });
    const auto r = elevate(must(BSplineBasis::bezier(25)));
    ASSERT_FALSE(r.has_value());
    EXPECT_EQ(r.error().kind, RefusalKind::unsupported);
    EXPECT_EQ(r.error().where, "degree");
}

TEST(Elevate, reaches_the_highest_degree) {
    Random random(23);
    for (Ends ends : {Ends::clamped, Ends::unclamped, Ends::closed}) {
        auto b = test::random_basis(random, 2, {ends, 3});
        const Sample s{b, test::random_net<1, Vec<1>>(random, {b.size()})};
        Values net = s.net;
        while (b.degree() < kMaxDegree) {
            auto up = must(elevate(b));
            net = along(0, up.map, net);
            b = std::move(up.basis);
        }
        for (double u : test::parameters(random, b))
            ASSERT_NEAR(value(b, net, u), value(s.basis, s.net, u), 1e-12);
    }
}

TEST(RestrictTo, leaves_the_function_unchanged_inside) {
    each_spline(true, [](Random& random, const Sample& s) {
        const auto on = s.basis.domain();
        auto inner = test::parameters(random, s.basis);
        std::sort(inner.begin(), inner.end());
        const auto pick = [&] { return inner[std::size_t(random.integer(0, int(inner.size()) - 1))]; };
        Interval part{pick(), pick()};
        if (part.lo > part.hi) std::swap(part.lo, part.hi);
        if (part.lo == part.hi) part = on;
        for (const Interval& to : {part, on}) {
            const auto change = must(restrict_to(s.basis, to));
            EXPECT_EQ(change.basis.domain(), to);
            EXPECT_FALSE(change.basis.is_closed());
            expect_convex(change.map, 1e-13);
            std::vector<double> at;
            for (double u : inner)
                if (to.lo <= u && u < to.hi) at.push_back(u);
            // The upper end is the limit from the left.
            if (to.hi == on.hi || s.basis.multiplicity(to.hi) <= s.basis.degree()) at.push_back(to.hi);
            expect_same(s, change, at, 2e-13);
            // Clamped: the ends are coefficients.
            const auto net = along(0, change.map, s.net);
            EXPECT_NEAR(net.flat().front()[0], value(s.basis, s.net, to.lo), 1e-13);
        }
    });
    const auto b = must(BSplineBasis::bezier(2));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(restrict_to(b, {0.5, 0.5}).error().where, "interval");
    EXPECT_EQ(restrict_to(b, {0.5, 1.5}).error().kind, RefusalKind::out_of_domain);
    EXPECT_EQ(restrict_to(b, {nan, 1}).error().kind, RefusalKind::nonfinite);
}

TEST(Reverse, runs_through_the_function_backwards) {
    each_spline(true, [](Random& random, const Sample& s) {
        const auto [lo, hi] = s.basis.domain();
        const auto change = reverse(s.basis);
        EXPECT_EQ(change.basis.domain(), s.basis.domain());
        EXPECT_EQ(change.basis.breaks().size(), s.basis.breaks().size());
        const auto net = along(0, change.map, s.net);
        for (int k = 0; k < 20; ++k) {
            const double u = random.real(lo, hi);
            // Rounding of lo + hi - u and of the knots: a shift of a few ulps times the slope, where there is
            // one.
            double slope = 1;
            if (s.basis.degree() > 0) slope += std::abs(value(s.basis, s.net, u, 1));
            bool near_jump = false;
            for (double b : s.basis.breaks()) near_jump = near_jump || std::abs(b - u) < 1e-9;
            if (near_jump) continue;
            ASSERT_NEAR(value(change.basis, net, lo + (hi - u)), value(s.basis, s.net, u), 1e-12 * slope);
        }
    });
}

TEST(Reverse, twice_is_the_identity_where_the_knots_are_dyadic) {
    Random random(24);
    for (int p = 1; p <= 9; ++p)
        for (Ends ends : {Ends::clamped, Ends::unclamped, Ends::closed}) {
            const auto b = test::random_basis(random, p, {ends, 4, false, true});
            const auto net = test::random_net<1, Vec<1>>(random, {b.size()});
            const auto once = reverse(b), twice = reverse(once.basis);
            EXPECT_EQ(twice.basis, b);
            EXPECT_EQ(along(0, twice.map, along(0, once.map, net)), net);
        }
}

TEST(Reverse, keeps_distinct_knots_distinct) {
    // 1 - 1e-20 rounds to 1; four knots of a degree 1 basis cannot be the same.
    const auto b = must(BSplineBasis::make(1, {0, 0, 1e-20, 1e-20, 2e-20, 1, 1}));
    const auto r = reverse(b).basis;
    EXPECT_EQ(r.breaks().size(), b.breaks().size());
    EXPECT_EQ(r.multiplicity(r.breaks()[2]), 2);
    EXPECT_EQ(r.domain(), b.domain());
}

TEST(Differentiate, gives_the_derivative) {
    each_spline(true, [](Random& random, const Sample& s) {
        const int p = s.basis.degree();
        if (p == 0) return;
        const auto change = differentiate(s.basis);
        EXPECT_EQ(change.basis.degree(), p - 1);
        EXPECT_EQ(change.basis.domain(), s.basis.domain());
        const auto net = along(0, change.map, s.net);
        double scale = 1;
        for (const auto& c : net.flat()) scale = std::max(scale, std::abs(c[0]));
        for (double u : test::parameters(random, s.basis))
            ASSERT_NEAR(value(change.basis, net, u), value(s.basis, s.net, u, 1), 1e-13 * scale)
                << "degree " << p << (s.basis.is_closed() ? " closed" : " open") << " at " << u;
    });
}

TEST(Differentiate, opens_a_closed_spline_whose_derivative_jumps) {
    Random random(25);
    for (int p = 2; p <= 5; ++p)
        for (int where = 0; where < 2; ++where) {
            std::vector<double> t{0, 1, 2, 3};
            t.insert(t.begin() + where, std::size_t(p - 1), double(where));  // multiplicity p: a kink
            const auto b = must(BSplineBasis::periodic(p, t));
            const Sample s{b, test::random_net<1, Vec<1>>(random, {b.size()})};
            const auto change = differentiate(b);
            EXPECT_FALSE(change.basis.is_closed());
            const auto net = along(0, change.map, s.net);
            for (double u : test::parameters(random, b, 20))
                ASSERT_NEAR(value(change.basis, net, u), value(b, s.net, u, 1), 1e-11) << "at " << u;
        }
}

TEST(ToBezier, gives_every_span_its_own_coefficients) {
    each_spline(true, [](Random& random, const Sample& s) {
        const auto change = to_bezier(s.basis);
        const int p = s.basis.degree();
        EXPECT_EQ(change.basis.size(), (p + 1) * (int(s.basis.breaks().size()) - 1));
        expect_convex(change.map, 1e-13);
        expect_same(s, change, test::parameters(random, s.basis), 2e-13);
    });
}

// Row j of a change is a mean of blossoms of the old basis in the span of knot j, here in exact arithmetic.
double largest_entry_error(const BSplineBasis& old, const Change<BSplineBasis>& change, bool elevation) {
    const int p = old.degree();
    double worst = 0;
    for (int j = 0; j < change.basis.size(); ++j) {
        const auto& t = change.basis;
        if (t.knot(j + t.degree() + 1) <= t.domain().lo || t.knot(j) >= t.domain().hi) continue;
        const int s = old.span(t.knot(j));
        std::vector<test::Rational> exact(std::size_t(p) + 1), w(exact), args(std::size_t(p) + 1);
        for (int skip = 0; skip <= (elevation ? p : 0); ++skip) {
            for (int k = 0; k < p; ++k) args[std::size_t(k)] = t.knot(j + 1 + k + (elevation && k >= skip));
            blossom(old, s, args.data(), w.data());
            for (std::size_t k = 0; k < w.size(); ++k) exact[k] += w[k] / (elevation ? p + 1 : 1);
        }
        EXPECT_EQ(change.map.first[std::size_t(j)], s - p);
        for (int k = 0; k <= p; ++k) {
            const double entry = change.map.row(j)[std::size_t(k)];
            const auto& x = exact[std::size_t(k)];
            EXPECT_EQ(entry == 0, x == 0);
            if (x != 0) worst = std::max(worst, test::gap(entry, x) / x.convert_to<double>() * 0x1p53);
        }
    }
    return worst;
}

TEST(Changes, entries_carry_no_more_roundings_than_their_essay_says) {
    Random random(27);
    double refined = 0, elevated = 0;
    for (int p = 1; p <= 9; ++p)
        for (Ends ends : {Ends::clamped, Ends::unclamped}) {
            const auto b = test::random_basis(random, p, {ends, 3});
            const auto [lo, hi] = b.domain();
            std::vector<double> more;
            for (int k = 0; k < 4; ++k) more.push_back(random.real(lo, hi));
            std::sort(more.begin(), more.end());
            refined =
                std::max({refined, largest_entry_error(b, must(insert_knots(b, more)), false) / (5 * p),
                          largest_entry_error(b, must(restrict_to(b, {more[0], more[3]})), false) / (5 * p),
                          largest_entry_error(b, to_bezier(b), false) / (5 * p)});
            elevated = std::max(elevated, largest_entry_error(b, must(elevate(b)), true) / (6 * p + 3));
        }
    std::printf("  largest observed / claimed relative error: refined %.3f, elevated %.3f\n", refined,
                elevated);
    EXPECT_LE(refined, 1);
    EXPECT_LE(elevated, 1);
    EXPECT_GE(refined, 0.05);
    EXPECT_GE(elevated, 0.05);
}

TEST(Collocation, rows_are_the_weights) {
    Random random(26);
    const auto b = test::random_basis(random, 3, {Ends::closed, 4});
    const auto net = test::random_net<1, Vec<1>>(random, {b.size()});
    const auto at = test::parameters(random, b);
    for (int order = 0; order <= 4; ++order) {
        const auto values = along(0, collocation(b, std::span(at), order), net);
        for (std::size_t i = 0; i < at.size(); ++i)
            ASSERT_NEAR(values.flat()[i][0], value(b, net, at[i], order), 1e-14 * std::exp2(8 * order));
    }
    EXPECT_EQ(along(0, collocation(b, std::span<const double>()), net).extent()[0], 0);
}

}  // namespace
}  // namespace freiform
