// Counts beside those of Sturm's theorem, and what must not change an answer.
#include "plane_curves.hpp"
#include "sturm.hpp"

#include <cstdlib>

namespace freiform::test {
namespace {

using Grid = std::vector<Vec<2>>;

// How many pairs: FREIFORM_INTERSECTIONS=100000 of random ones, and a hundredth of that of nasty ones.
int pairs_asked(int usual, int share = 1) {
    const char* said = std::getenv("FREIFORM_INTERSECTIONS");
    return said ? std::max(usual, std::atoi(said) / share) : usual;
}

// Control points that are multiples of 1 / n, so that contacts at tangents and ends are common.
Grid random_grid(Random& random, int count, int width, int height, int n) {
    Grid g;
    for (int i = 0; i < count; ++i)
        g.push_back({{random.integer(0, n * width) / double(n),
                      random.integer(-n * height, n * height) / double(n)}});
    return g;
}

Polynomial product(const Polynomial& a, const Polynomial& b) {
    Polynomial p(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j) p[i + j] += a[i] * b[j];
    return p;
}
// 8 times coordinate k, with power coefficients.
Polynomial coordinate(const Grid& g, int k) {
    Polynomial c;
    for (const Vec<2>& p : g) c.push_back(Whole(std::int64_t(8 * p[k])));
    Polynomial out = power_form(std::move(c));
    if (out.empty()) out.push_back(0);
    return out;
}

// B is the graph y = f(x / n) over 0 <= x <= n, and A stays in that strip: B meets A where f(x_A / n) = y_A.
Polynomial equation(const Grid& a, const Grid& graph) {
    const Polynomial x = coordinate(a, 0), y = coordinate(a, 1), f = coordinate(graph, 1);
    const Whole n = Whole(8 * (std::int64_t(graph.size()) - 1));
    // sum f_k x^k / n^k - y, times n^degree
    Polynomial sum, power{1};
    Whole scale = 1;
    for (std::size_t k = 0; k + 1 < f.size(); ++k) scale *= n;
    for (std::size_t k = 0; k < f.size(); ++k) {
        sum.resize(std::max(sum.size(), power.size()));
        for (std::size_t i = 0; i < power.size(); ++i) sum[i] += f[k] * scale * power[i];
        if (k + 1 < f.size()) power = product(power, x), scale /= n;
    }
    Whole whole = 1;
    for (std::size_t k = 0; k + 1 < f.size(); ++k) whole *= n;
    sum.resize(std::max(sum.size(), y.size()));
    for (std::size_t i = 0; i < y.size(); ++i) sum[i] -= y[i] * whole;
    trim(sum);
    return sum;
}

Grid sheared(const Grid& g) {  // exact, and different for both coordinates
    Grid out;
    for (const Vec<2>& p : g) out.push_back({{p[0] + 2 * p[1], p[1] - p[0]}});
    return out;
}

TEST(IntersectLaws, counts_are_those_of_exact_arithmetic) {
    Random random(11);
    int tangents = 0, roots = 0;
    for (int i = 0; i < pairs_asked(250); ++i) {
        const int n = random.integer(1, 3), m = random.integer(1, 4), fine = i % 3 == 0 ? 8 : 1;
        Grid graph = random_grid(random, n + 1, 1, 2, fine);
        for (int k = 0; k <= n; ++k) graph[std::size_t(k)][0] = k;
        const Grid a = random_grid(random, m + 1, n, i % 2 == 0 ? 1 : 2, fine);
        const Polynomial p = equation(a, graph);
        const PlaneAnswer found = meet(plane_bezier(sheared(a)), plane_bezier(sheared(graph)));
        ASSERT_TRUE(found.undecided.empty()) << i;
        if (p.empty()) continue;  // the same curve
        const RootCount exact(p);
        const int at_zero = sign_at(p, 0) == 0, distinct = exact.distinct(0, 1) + at_zero;
        int proven = 0, with_multiplicity = 0;
        for (const auto& c : found.contacts) {
            proven += c.is_proven();
            with_multiplicity += c.multiplicity;
            tangents += c.multiplicity > 1;
        }
        EXPECT_EQ(int(found.contacts.size()), distinct) << i;
        EXPECT_EQ(proven, distinct) << i;
        const int all = exact.with_multiplicity(0, 1) + (at_zero != 0 ? exact.multiplicity_at(0) : 0);
        EXPECT_EQ(with_multiplicity, all) << i;
        roots += distinct;
    }
    EXPECT_GT(roots, 150);
    EXPECT_GT(tangents, 3);
}

TEST(IntersectLaws, clusters_that_reach_to_one_root_give_it_once) {
    const Grid a{{{0, -1}}, {{0, -2}}, {{1, 2}}, {{0, -1}}, {{1, -1}}}, b{{{0, -1}}, {{1, 1}}};
    const PlaneAnswer found = meet(plane_bezier(sheared(a)), plane_bezier(sheared(b)));
    ASSERT_EQ(found.contacts.size(), 2u);
    EXPECT_EQ(found.contacts[0].kind, ContactKind::end);
    EXPECT_EQ(found.contacts[0].multiplicity, 1);
    EXPECT_EQ(found.contacts[1].multiplicity, 2);
}

TEST(IntersectLaws, what_the_budget_leaves_open_is_said) {
    Random random(16);
    const Plane c = random_bezier<Vec<2>>(random, 3);
    const Plane near = mapped(c, [](const Vec<2>& p) { return p + Vec<2>{{1e-10, 3e-11}}; });
    const PlaneAnswer found = must(intersect(c, near, {.accuracy = 0, .max_parts = 2000}));
    ASSERT_FALSE(found.undecided.empty());
    EXPECT_TRUE(found.overlaps.empty());
    // What lies outside of these boxes is known: the diagonal, along which the curves are near, is inside.
    for (double t = 0.01; t < 1; t += 0.01)
        EXPECT_TRUE(std::any_of(found.undecided.begin(), found.undecided.end(),
                                [&](const auto& box) { return box[0].contains(t) && box[1].contains(t); }) ||
                    std::any_of(found.contacts.begin(), found.contacts.end(),
                                [&](const auto& x) { return x.box[0].contains(t); }))
            << t;
    EXPECT_EQ(meet(c, near, 2e-10).overlaps.size(), 1u);
}

// Nasty numbers: multiples of 1/4, repeated control points, shared ends.
std::pair<Plane, Plane> nasty_pair(Random& random) {
    Grid a = random_grid(random, random.integer(2, 4), 2, 1, 8),
         b = random_grid(random, random.integer(2, 4), 2, 1, 8);
    if (random.chance(0.4)) b.front() = a.back();
    if (random.chance(0.3)) b.back() = a.front();
    if (random.chance(0.3)) a[1] = a[0];
    return {plane_bezier(a), plane_bezier(b)};
}

void expect_same(const PlaneAnswer& x, const PlaneAnswer& y, double scale, int i) {
    ASSERT_EQ(x.contacts.size(), y.contacts.size()) << i;
    ASSERT_EQ(x.overlaps.size(), y.overlaps.size()) << i;
    for (std::size_t k = 0; k < x.contacts.size(); ++k) {
        const auto &c = x.contacts[k], &d = y.contacts[k];
        EXPECT_EQ(c.at, d.at) << i;
        EXPECT_EQ(c.box, d.box) << i;
        EXPECT_EQ(c.kind, d.kind) << i;
        EXPECT_EQ(c.gap * scale, d.gap) << i;
        EXPECT_EQ(scale * c.point, d.point) << i;
    }
    for (std::size_t k = 0; k < x.overlaps.size(); ++k) EXPECT_EQ(x.overlaps[k].a, y.overlaps[k].a) << i;
}

TEST(IntersectLaws, exchanging_the_curves_exchanges_the_answer) {
    Random random(12);
    for (int i = 0; i < pairs_asked(80, 100); ++i) {
        const auto [a, b] = nasty_pair(random);
        const PlaneAnswer there = meet(a, b);
        PlaneAnswer back = meet(b, a);
        for (auto& c : back.contacts) std::swap(c.at[0], c.at[1]), std::swap(c.box[0], c.box[1]);
        for (auto& o : back.overlaps) std::swap(o.a, o.b);
        std::sort(back.contacts.begin(), back.contacts.end(),
                  [](const auto& x, const auto& y) { return x.at < y.at; });
        ASSERT_EQ(there.contacts.size(), back.contacts.size()) << i;
        for (std::size_t k = 0; k < there.contacts.size(); ++k)
            EXPECT_EQ(there.contacts[k].box, back.contacts[k].box) << i;
        EXPECT_EQ(there.overlaps.size(), back.overlaps.size()) << i;
    }
}

TEST(IntersectLaws, powers_of_two_scale_the_answer_bit_for_bit) {
    Random random(13);
    for (int i = 0; i < pairs_asked(40, 100); ++i) {
        const auto [a, b] = nasty_pair(random);
        const PlaneAnswer plain = meet(a, b);
        for (const int e : {-200, 200}) {
            const auto larger = [e](const Vec<2>& p) { return std::ldexp(1.0, e) * p; };
            expect_same(plain, meet(mapped(a, larger), mapped(b, larger)), std::ldexp(1.0, e), i);
        }
    }
}

TEST(IntersectLaws, reversing_a_curve_reverses_its_parameters) {
    Random random(14);
    for (int i = 0; i < pairs_asked(60, 100); ++i) {
        const auto [a, b] = nasty_pair(random);
        const PlaneAnswer there = meet(a, b), back = meet(reverse(a, 0), b);
        ASSERT_EQ(there.contacts.size(), back.contacts.size()) << i;
        ASSERT_EQ(there.overlaps.size(), back.overlaps.size()) << i;
        for (const auto& c : there.contacts)
            EXPECT_TRUE(std::any_of(back.contacts.begin(), back.contacts.end(), [&](const auto& d) {
                // Of several that a box may hold, `at` is one.
                const bool same = c.is_proven() ? std::abs(1 - d.at[0] - c.at[0]) < 1e-9 &&
                                                      std::abs(d.at[1] - c.at[1]) < 1e-9
                                                : c.box[0].overlaps({1 - d.box[0].hi, 1 - d.box[0].lo}) &&
                                                      c.box[1].overlaps(d.box[1]);
                return same && d.kind == c.kind && d.multiplicity == c.multiplicity && d.least == c.least &&
                       d.most == c.most;
            })) << i;
    }
}

TEST(IntersectLaws, many_pairs_at_once_have_the_answers_of_each) {
    Random random(15);
    std::vector<IntersectCurve<Vec<2>>> a, b;
    std::vector<Plane> first, second;
    for (int i = 0; i < 300; ++i) {
        first.push_back(random_bezier<Vec<2>>(random, 3));
        second.push_back(random_bezier<Vec<2>>(random, 2));
        a.emplace_back(first.back());
        b.emplace_back(second.back());
    }
    std::vector<PlaneAnswer> out(a.size());
    ASSERT_TRUE((intersect<Vec<2>>(a, b, out).has_value()));
    for (std::size_t i = 0; i < a.size(); ++i) expect_same(out[i], meet(first[i], second[i]), 1, int(i));
}

// Rational curves: a circle by its quarter, and lines whose distance from the centre is known.
TEST(IntersectLaws, rational_arcs_are_met_by_lines_where_the_circle_is) {
    const auto arc = bezier<Hom<2>>({{{1, 0, 1}}, {{1, 1, 1}}, {{0, 2, 2}}});  // (1 - t^2, 2 t) / (1 + t^2)
    const auto line = [](double x, double y, double u, double v) {
        return bezier<Hom<2>>({{{x, y, 1}}, {{u, v, 1}}});
    };
    const auto touch =
        must(intersect(arc, line(1.4, 0.2, 0.2, 1.1)));  // tangent at (3, 4) / 5 but for rounding
    EXPECT_LE(touch.contacts.size(), 2u);
    const auto exact = must(intersect(arc, line(0.25, 1.0625, 1.25, 0.3125)));  // 3 x + 4 y = 5
    ASSERT_EQ(exact.contacts.size(), 1u);
    EXPECT_EQ(exact.contacts[0].kind, ContactKind::tangent);
    EXPECT_EQ(exact.contacts[0].at[0], 0.5);
    const auto across = must(intersect(arc, line(0, 0, 2, 2)));
    ASSERT_EQ(across.contacts.size(), 1u);
    EXPECT_NEAR(across.contacts[0].at[0], std::sqrt(2) - 1, 1e-15);
    EXPECT_TRUE(across.contacts[0].is_proven());
    const auto same = must(intersect(arc, must(elevate(arc, 0))));
    EXPECT_EQ(same.overlaps.size(), 1u);
}

}  // namespace
}  // namespace freiform::test
