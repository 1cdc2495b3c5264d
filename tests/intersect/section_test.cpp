#include "random.hpp"
#include "sanitizer.hpp"
#include "shapes.hpp"

#include <freiform/intersect/section.hpp>
#include <freiform/make/quadric.hpp>

#include <gtest/gtest.h>
#include <map>

namespace freiform::test {
namespace {

using CutPlane = freiform::Plane;

double height_over(const CutPlane& plane, const Vec<3>& p) {
    return (dot(plane.normal, p) + plane.offset) / norm(plane.normal);
}
double length_of(const SectionBranch& b) {
    const Interval on = b.curve.domain()[0];
    double sum = 0;
    for (int i = 0; i < 1000; ++i)
        sum += norm(b.curve(on.lo + on.length() * (i + 1) / 1000) - b.curve(on.lo + on.length() * i / 1000));
    return sum;
}
double length_of(const Section& s) {
    double sum = 0;
    for (const SectionBranch& b : s.branches) sum += length_of(b);
    return sum;
}
int closed_in(const Section& s) {
    return int(std::ranges::count_if(s.branches, [](const SectionBranch& b) { return b.closed; }));
}

template <class P>
void expect_bounds_hold(const Surface<P>& s, const CutPlane& plane, const SectionBranch& b) {
    const Interval on = b.curve.domain()[0];
    ASSERT_EQ(b.at.domain()[0], on);
    const auto domain = s.domain();
    double scale = 0;
    for (const Vec<3>& p : points(s)) scale = std::max(scale, max_abs(p));
    for (int i = 0; i <= 200; ++i) {
        const double t = i == 200 ? on.hi : on.lo + on.length() * i / 200;
        const Vec<3> x = b.curve(t);
        const Vec<2> u = b.at(t);
        for (int k = 0; k < 2; ++k) {
            const Interval d = domain[std::size_t(k)];
            ASSERT_GE(u[k], d.lo - 1e-14 * d.length());
            ASSERT_LE(u[k], d.hi + 1e-14 * d.length());
        }
        EXPECT_LE(std::abs(height_over(plane, x)), b.plane_bound + 1e-15 * scale);
        const Param<2> at{clamped(u[0], domain[0]), clamped(u[1], domain[1])};
        ASSERT_LE(norm(x - s(at)), b.surface_bound + 1e-15 * scale) << t << " of " << on.hi;
        EXPECT_LE(b.surface_bound, b.bound);
    }
    if (b.closed) EXPECT_LT(norm(b.curve(on.lo) - b.curve(on.hi)), 1e-12 * scale);
}
template <class P>
Section checked_section(const Surface<P>& s, const CutPlane& plane, double tolerance) {
    const Section cut = must(section(s, plane, {.tolerance = tolerance}));
    for (const SectionBranch& b : cut.branches) {
        expect_bounds_hold(s, plane, b);
        EXPECT_LE(b.bound, tolerance);
    }
    return cut;
}

// Components and length of the zeros on a dense grid of triangles.
struct Dense {
    int open = 0, closed = 0;
    double length = 0;
};
template <class P>
Dense dense_section(const Surface<P>& s, const CutPlane& plane, int m) {
    const auto on = s.domain();
    std::vector<Vec<3>> points;
    std::vector<double> f;
    for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= m; ++j) {
            points.push_back(s(on[0].lo + on[0].length() * i / m, on[1].lo + on[1].length() * j / m));
            f.push_back(height_over(plane, points.back()));
        }
    std::map<std::pair<int, int>, int> index, uses;
    std::vector<int> root;
    const auto find = [&](int i) {
        while (root[std::size_t(i)] != i) i = root[std::size_t(i)];
        return i;
    };
    Dense out;
    const auto triangle = [&](std::array<int, 3> t) {
        std::vector<int> nodes;
        std::vector<Vec<3>> ends;
        for (std::size_t k = 0; k < 3; ++k) {
            const int a = std::min(t[k], t[(k + 1) % 3]), b = std::max(t[k], t[(k + 1) % 3]);
            const double fa = f[std::size_t(a)], fb = f[std::size_t(b)];
            if ((fa > 0) == (fb > 0)) continue;
            const auto [it, is_new] = index.try_emplace({a, b}, int(root.size()));
            if (is_new) root.push_back(it->second);
            ++uses[{a, b}];
            nodes.push_back(it->second);
            ends.push_back(points[std::size_t(a)] +
                           fa / (fa - fb) * (points[std::size_t(b)] - points[std::size_t(a)]));
        }
        if (nodes.size() != 2) return;
        root[std::size_t(find(nodes[0]))] = find(nodes[1]);
        out.length += norm(ends[1] - ends[0]);
    };
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < m; ++j) {
            const int p = i * (m + 1) + j, q = p + m + 1;
            triangle({p, q, q + 1});
            triangle({p, q + 1, p + 1});
        }
    std::vector<int> ends(root.size());
    for (const auto& [edge, count] : uses)
        if (count == 1) ++ends[std::size_t(find(index[edge]))];
    for (std::size_t i = 0; i < root.size(); ++i)
        if (find(int(i)) == int(i)) ++(ends[i] > 0 ? out.open : out.closed);
    return out;
}

TEST(Section, has_the_branches_of_a_dense_grid) {
    std::mt19937 rng(7);
    int closed = 0, open = 0;
    for (int i = 0; i < cases(10); ++i) {
        const auto s = landscape(rng, 2 + i % 2, 6, 0.3);
        const CutPlane plane{{{uniform(rng, -0.1, 0.1), 0.1, 1}}, uniform(rng, -0.1, 0.1)};
        const Section cut = checked_section(s, plane, 1e-3);
        const Dense dense = dense_section(s, plane, 120);
        EXPECT_TRUE(cut.nodes.empty() && cut.undecided.empty());
        EXPECT_EQ(closed_in(cut), dense.closed) << i;
        EXPECT_EQ(int(cut.branches.size()) - closed_in(cut), dense.open) << i;
        EXPECT_NEAR(length_of(cut), dense.length, 2e-3 * dense.length) << i;
        closed += dense.closed, open += dense.open;
    }
    if (!kAddressSanitizer) EXPECT_GT(closed, 1);
    EXPECT_GT(open, 3);
}

TEST(Section, of_rational_splines_has_the_branches_of_a_dense_grid) {
    std::mt19937 rng(3);
    for (int i = 0; i < cases(10); ++i) {
        const auto s = random_patch<2, Hom<3>>(rng, {3, 2}, 1);
        const CutPlane plane{{{uniform(rng, -1, 1), uniform(rng, -1, 1), 1}}, uniform(rng, -0.2, 0.2)};
        const Section cut = checked_section(s, plane, 1e-2);
        const Dense dense = dense_section(s, plane, 120);
        EXPECT_EQ(closed_in(cut), dense.closed) << i;
        EXPECT_EQ(int(cut.branches.size()) - closed_in(cut), dense.open) << i;
        EXPECT_NEAR(length_of(cut), dense.length, 2e-2 * dense.length) << i;
    }
}

void expect_circle(const SectionBranch& b, const Vec<3>& centre, double radius, double more = 0) {
    EXPECT_TRUE(b.closed);
    const Interval on = b.curve.domain()[0];
    for (int i = 0; i <= 100; ++i)
        EXPECT_NEAR(norm(b.curve(on.lo + on.length() * i / 100) - centre), radius, b.bound + more);
    EXPECT_NEAR(length_of(b), 2 * std::numbers::pi * radius, 10 * b.bound + 2e-5 * radius);
}

TEST(Section, of_a_sphere_is_a_circle) {
    for (const EllipseForm form : {EllipseForm::open, EllipseForm::closed}) {
        const auto ball = must(sphere({}, 2, {.form = form})).surface;
        for (const CutPlane& plane : {CutPlane{{{0, 0, 1}}, -1},
                                      {{{0, 0, 1}}, 0},
                                      {{{0.3, 0.2, 2}}, 0.5},
                                      {{{1, 0, 0.1}}, 0.3},
                                      {{{1, 0, 0}}, -1.99999}}) {
            const Section cut = checked_section(ball, plane, 1e-3);
            ASSERT_EQ(cut.branches.size(), 1u);
            EXPECT_TRUE(cut.nodes.empty() && cut.undecided.empty());
            const double h = plane.offset / norm(plane.normal);
            expect_circle(cut.branches[0], -h * unit(plane.normal), std::sqrt(4 - h * h), 1e-15);
        }
        EXPECT_TRUE(checked_section(ball, {{{0, 0, 1}}, 2.001}, 1e-3).branches.empty());
    }
}

TEST(Section, goes_to_the_poles_of_a_sphere) {
    const auto ball = must(sphere({}, 2)).surface;
    for (const CutPlane& plane : {CutPlane{{{1, 0, 0}}, 0}, {{{3, 4, 0}}, 0}, {{{1, 0.1, 0}}, 0}}) {
        const Section cut = checked_section(ball, plane, 1e-3);
        ASSERT_EQ(cut.branches.size(), 2u);
        for (const SectionBranch& b : cut.branches) {
            const Interval on = b.curve.domain()[0];
            EXPECT_NEAR(std::abs(b.curve(on.lo)[2]), 2, 1e-3);
            EXPECT_NEAR(length_of(b), 2 * std::numbers::pi, 1e-2);
        }
    }
}

TEST(Section, of_a_torus_is_what_geometry_says) {
    for (const EllipseForm form : {EllipseForm::open, EllipseForm::closed}) {
        const auto ring = must(torus({}, 3, 1, {.form = form}, {.form = form})).surface;
        const Section equator = checked_section(ring, {{{0, 0, 1}}, 0}, 1e-3);
        ASSERT_EQ(equator.branches.size(), 2u);  // knot lines
        EXPECT_NEAR(length_of(equator), 2 * std::numbers::pi * (2 + 4), 1e-2);
        const Section across = checked_section(ring, {{{0.8, 0.6, 0}}, 0}, 1e-3);
        ASSERT_EQ(across.branches.size(), 2u);
        for (const SectionBranch& b : across.branches) {
            const Vec<3> p = b.curve(0);
            expect_circle(b, 3 / std::hypot(p[0], p[1]) * Vec<3>{{p[0], p[1], 0}}, 1, 1e-15);
        }
        EXPECT_EQ(checked_section(ring, {{{1, 0, 0}}, -2.5}, 1e-3).branches.size(), 1u);
        EXPECT_EQ(checked_section(ring, {{{1, 0, 0}}, -1.5}, 1e-3).branches.size(), 2u);
        // It lies on the plane along a circle.
        const Section top = checked_section(ring, {{{0, 0, 1}}, -1}, 1e-3);
        ASSERT_EQ(top.branches.size(), 1u);
        expect_circle(top.branches[0], {{0, 0, 1}}, 3, 1e-15);
    }
}

// z = sum of c_ij u^i v^j on [-1, 1]^2, as one patch of degree 2 x 2.
Surface<Vec<3>> quadratic(double c00, double c10, double c01, double c20, double c11, double c02) {
    Net<2, Vec<3>> net({3, 3});
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double u = i - 1, v = j - 1, uu = i == 1 ? -1 : 1, vv = j == 1 ? -1 : 1;
            net.view()({i, j}) = {{u, v, c00 + c10 * u + c01 * v + c20 * uu + c11 * u * v + c02 * vv}};
        }
    const auto basis = must(BSplineBasis::bezier(2, {-1, 1}));
    return must(Surface<Vec<3>>::make({basis, basis}, std::move(net)));
}
const CutPlane kGround{{{0, 0, 1}}, 0};

TEST(Section, names_crossings_and_isolated_points) {
    const auto saddle = quadratic(0, 0, 0, 1, 0.3, -1);
    const Section cross = checked_section(saddle, kGround, 1e-4);
    ASSERT_EQ(cross.nodes.size(), 1u);
    EXPECT_EQ(cross.nodes[0].kind, SectionNodeKind::crossing);
    EXPECT_EQ(cross.nodes[0].arms, 4);
    EXPECT_LT(cross.nodes[0].gap, 1e-11);
    EXPECT_LT(cross.nodes[0].box[0].length(), 1e-5);
    EXPECT_LT(norm(cross.nodes[0].point), 1e-5);
    EXPECT_EQ(cross.branches.size(), 4u);
    for (const SectionBranch& b : cross.branches)
        EXPECT_EQ(std::minmax(b.ends[0], b.ends[1]), std::minmax(kAtBoundary, 0));
    // Moved away by little, the branches pass each other by.
    for (const double off : {1e-3, 1e-9, -1e-9}) {
        const Section pass = checked_section(quadratic(off, 0, 0, 1, 0.3, -1), kGround, 1e-4);
        EXPECT_TRUE(pass.nodes.empty());
        EXPECT_EQ(pass.branches.size(), 2u);
    }
    const Section touch = checked_section(quadratic(0, 0, 0, 1, 0.3, 2), kGround, 1e-4);
    ASSERT_EQ(touch.nodes.size(), 1u);
    EXPECT_EQ(touch.nodes[0].kind, SectionNodeKind::touch);
    EXPECT_LT(touch.nodes[0].gap, 1e-12);
    EXPECT_TRUE(touch.branches.empty());
    const Section over = checked_section(quadratic(1e-13, 0, 0, 1, 0.3, 2), kGround, 1e-4);
    EXPECT_TRUE(over.nodes.empty() && over.branches.empty());
}

TEST(Section, finds_loops_of_any_size) {
    for (const double depth : {1e-2, 1e-6, 1e-12}) {
        const Section loop =
            checked_section(quadratic(-depth, 1e-3, 0, 1, 0, 1), kGround, 1e-2 * std::sqrt(depth));
        ASSERT_EQ(loop.branches.size(), 1u) << depth;
        const double radius = std::sqrt(depth + 0.25e-6);
        expect_circle(loop.branches[0], {{-0.5e-3, 0, 0}}, radius, 1e-3 * radius);
    }
}

TEST(Section, sides_and_knot_lines_in_the_plane_are_branches) {
    const double pi = std::numbers::pi;
    // A rim; a line along which the plane touches; both are knot lines or sides.
    const auto tube = must(cylinder({}, 1, {0, 2})).surface;
    const Section rim = checked_section(tube, kGround, 1e-3);
    ASSERT_EQ(rim.branches.size(), 1u);
    EXPECT_NEAR(length_of(rim), 2 * pi, 1e-2);
    expect_circle(rim.branches[0], {}, 1);
    const Section line = checked_section(tube, {{{0, 1, 0}}, -1}, 1e-3);
    ASSERT_EQ(line.branches.size(), 1u);
    EXPECT_NEAR(length_of(line), 2, 1e-3);
    EXPECT_EQ(line.branches[0].curve.basis().size(), 4);
    // The seam of the tube.
    EXPECT_EQ(checked_section(tube, {{{1, 0, 0}}, -1}, 1e-3).branches.size(), 1u);
    const Section two = checked_section(tube, {{{1, 0, 0}}, -0.6}, 1e-3);
    EXPECT_EQ(two.branches.size(), 2u);
    EXPECT_NEAR(length_of(two), 4, 1e-2);
}

TEST(Section, of_a_surface_in_the_plane_is_an_overlap) {
    const Section flat = must(section(quadratic(0, 0, 0, 0, 0, 0), kGround, {.tolerance = 1e-3}));
    ASSERT_EQ(flat.overlaps.size(), 1u);
    EXPECT_EQ(flat.overlaps[0][0], (Interval{-1, 1}));
    EXPECT_TRUE(flat.branches.empty() && flat.undecided.empty() && flat.nodes.empty());
}

TEST(Section, what_the_budget_leaves_open_is_said) {
    // It touches along a line that is no knot line: u + 0.3 v = 0.
    const auto s = quadratic(0, 0, 0, 1, 0.6, 0.09);
    const Section cut = must(section(s, kGround, {.tolerance = 1e-3, .max_cells = 300}));
    ASSERT_FALSE(cut.undecided.empty());
    for (double v = -0.99; v < 1; v += 0.01)
        EXPECT_TRUE(std::ranges::any_of(
                        cut.undecided,
                        [&](const auto& box) { return box[0].contains(-0.3 * v) && box[1].contains(v); }) ||
                    std::ranges::any_of(cut.nodes,
                                        [&](const SectionNode& n) {
                                            return n.box[0].contains(-0.3 * v) && n.box[1].contains(v);
                                        }))
            << v;
}

TEST(Section, follows_corners_of_creased_surfaces) {
    // Two planes, z = |x| / 2 over [-1, 1], joined by a knot of full multiplicity.
    const auto u = must(BSplineBasis::make(1, {-1, -1, 0, 1, 1})), v = must(BSplineBasis::bezier(1));
    Net<2, Vec<3>> net({3, 2});
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 2; ++j) net.view()({i, j}) = {{i - 1.0, double(j), i == 1 ? 0.0 : 0.5}};
    const auto roof = must(Surface<Vec<3>>::make({u, v}, std::move(net)));
    const Section cut = checked_section(roof, {{{0, 1, 1}}, -0.75}, 1e-6);
    ASSERT_EQ(cut.branches.size(), 1u);
    EXPECT_EQ(cut.branches[0].curve.basis().size(), 7);  // two straight pieces
    EXPECT_NEAR(length_of(cut), 2 * std::sqrt(1.5), 1e-5);
}

TEST(Section, of_degenerate_surfaces_is_what_it_can_be) {
    const auto line = must(BSplineBasis::bezier(1)), square = must(BSplineBasis::bezier(2));
    const auto surface = [&](auto&& point) {
        Net<2, Vec<3>> net({3, 2});
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 2; ++j) net.view()({i, j}) = point(i, j);
        return must(Surface<Vec<3>>::make({square, line}, std::move(net)));
    };
    // A curve: the same point for all u.
    const Section point = checked_section(surface([](int, int j) {
                                              return Vec<3>{{0, 0, j - 0.3}};
                                          }),
                                          kGround, 1e-3);
    ASSERT_EQ(point.branches.size(), 1u);
    EXPECT_LT(length_of(point), 1e-2);
    EXPECT_LT(norm(point.branches[0].curve(0)), 1e-3);
    // A point, on the plane and beside it.
    EXPECT_EQ(checked_section(surface([](int, int) { return Vec<3>{}; }), kGround, 1e-3).overlaps.size(), 1u);
    const Section none = checked_section(surface([](int, int) {
                                             return Vec<3>{{0, 0, 1e-300}};
                                         }),
                                         kGround, 1e-3);
    EXPECT_TRUE(none.branches.empty() && none.nodes.empty() && none.overlaps.empty());
    // Through a corner of the domain there is a node, or a branch that ends there.
    const Section corner = checked_section(surface([](int i, int j) {
                                               return Vec<3>{{i / 2.0, double(j), i / 2.0 - j}};
                                           }),
                                           kGround, 1e-3);
    EXPECT_EQ(corner.branches.size(), 1u);
    EXPECT_NEAR(length_of(corner), std::sqrt(2.0), 1e-3);
    for (const SectionNode& n : corner.nodes) EXPECT_EQ(n.kind, SectionNodeKind::unclear);
}

TEST(Section, says_what_it_reached_where_the_tolerance_is_below_rounding) {
    const auto s = quadratic(-0.25, 0, 0, 0, 0, 1);  // straight branches
    const Section cut = must(section(s, kGround, {.tolerance = 1e-17}));
    ASSERT_EQ(cut.branches.size(), 2u);
    for (const SectionBranch& b : cut.branches) {
        EXPECT_GT(b.bound, 1e-17);
        EXPECT_LT(b.bound, 1e-8);
        expect_bounds_hold(s, kGround, b);
    }
}

TEST(Section, scales_with_powers_of_two) {
    std::mt19937 rng(5);
    const auto s = landscape(rng, 3, 6, 0.3);
    const Section cut = must(section(s, {{{0.1, 0, 1}}, 0.03}, {.tolerance = 1e-3}));
    ASSERT_FALSE(cut.branches.empty());
    for (const int e : {-200, 200}) {
        auto net = s.net();
        for (Vec<3>& p : net.flat()) p = std::scalbn(1.0, e) * p;
        const auto scaled = must(Surface<Vec<3>>::make(s.bases(), std::move(net)));
        const Section other =
            must(section(scaled, {{{0.1, 0, 1}}, std::scalbn(0.03, e)}, {.tolerance = std::scalbn(1e-3, e)}));
        ASSERT_EQ(other.branches.size(), cut.branches.size());
        for (std::size_t i = 0; i < cut.branches.size(); ++i) {
            EXPECT_EQ(other.branches[i].bound, std::scalbn(cut.branches[i].bound, e));
            EXPECT_TRUE(
                std::ranges::equal(other.branches[i].at.net().flat(), cut.branches[i].at.net().flat()));
        }
    }
    // The length and the sign of the normal do not matter.
    EXPECT_EQ(must(section(s, {{{-0.4, 0, -4}}, -0.12}, {.tolerance = 1e-3})).branches.size(),
              cut.branches.size());
}

TEST(Section, refuses_what_is_no_plane_or_tolerance) {
    const auto s = quadratic(0, 0, 0, 1, 0, 1);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto where = [&](const CutPlane& plane, double tolerance) {
        const auto r = section(s, plane, {.tolerance = tolerance});
        return r ? std::string() : r.error().where;
    };
    EXPECT_EQ(where({}, 1), "plane");
    EXPECT_EQ(where({{{0, nan, 1}}, 0}, 1), "plane");
    EXPECT_EQ(where({{{0, 0, 1}}, nan}, 1), "plane");
    for (const double t : {0.0, -1.0, nan}) EXPECT_EQ(where(kGround, t), "tolerance");
}

}  // namespace
}  // namespace freiform::test
