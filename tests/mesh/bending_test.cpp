// What is seen of the interpolation error in a cell, along normals that turn, is not more than what is said
// from the middle of the box, and what is said is useful.
#include "mesh/curvature_tree_detail.hpp"
#include "support/random.hpp"

#include <freiform/core/constants.hpp>

#include <functional>
#include <gtest/gtest.h>
#include <numbers>

namespace freiform {
namespace {

using test::must;
using test::Random;

// Control points there are those of the identity.
double greville(const BSplineBasis& basis, int i) {
    double sum = 0;
    for (int k = 1; k <= basis.degree(); ++k) sum += basis.knots()[std::size_t(i + k)];
    return sum / basis.degree();
}

// z over the plane, times `height`; its parameter lines are moved by up to `aside`.
template <class P>
SurfaceGeometry graph(const BSplineBasis& basis, double height, const std::function<double(int, int)>& z,
                      const std::function<double()>& weight, const std::function<double()>& aside) {
    const int n = basis.size();
    std::vector<P> c;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const Vec<3> at{{greville(basis, i) + aside(), greville(basis, k) + aside(), height * z(i, k)}};
            if constexpr (std::same_as<P, Hom<3>>)
                c.push_back(weighted(at, weight()));
            else
                c.push_back(at);
        }
    return must(Surface<P>::make({basis, basis}, Net<2, P>({n, n}, c)));
}

double one() { return 1; }
double none() { return 0; }

// A random part of the interval, or all of it.
Interval part_of(Random& random, const Interval& all, bool is_all) {
    if (is_all) return all;
    const double a = random.real(all.lo, all.hi), b = random.real(all.lo, all.hi);
    return {std::min(a, b), std::max(a, b)};
}

// The largest of |m . (S - L)| in the triangles, m of length 1 within `turn` of the normals.
double largest_seen(const SurfaceGeometry& s, std::span<const std::array<Vec<2>, 3>> triangles, double turn);

// The largest of |S - L| in the triangle.
double largest_whole(const SurfaceGeometry& s, const std::array<Vec<2>, 3>& t) {
    double most = 0;
    std::array<Vec<3>, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = jet<0>(s, t[k].c).value();
    for (int i = 0; i <= 12; ++i)
        for (int k = 0; i + k <= 12; ++k) {
            const double l = i / 12.0, m = k / 12.0, n = 1 - l - m;
            const Vec<3> flat = l * corner[0] + m * corner[1] + n * corner[2];
            most = std::max(most, norm(jet<0>(s, (l * t[0] + m * t[1] + n * t[2]).c).value() - flat));
        }
    return most;
}

// The same of triangles of points on the sides of the cell.
double largest_seen(Random& random, const SurfaceGeometry& s, const Box<2>& cell, double turn) {
    const auto at = [&](double x, double y) {
        return Vec<2>{
            {cell.lo[0] + x * (cell.hi[0] - cell.lo[0]), cell.lo[1] + y * (cell.hi[1] - cell.lo[1])}};
    };
    const double x = random.real(0, 1), y = random.real(0, 1);
    const std::array<std::array<Vec<2>, 3>, 4> triangles{{{at(0, 0), at(1, 0), at(1, 1)},
                                                          {at(0, 0), at(1, 1), at(0, 1)},
                                                          {at(0, 0), at(1, y), at(x, 1)},
                                                          {at(x, 0), at(1, y), at(0, 1)}}};
    return largest_seen(s, triangles, turn);
}

double largest_seen(const SurfaceGeometry& s, std::span<const std::array<Vec<2>, 3>> triangles, double turn) {
    double most = 0;
    for (const auto& t : triangles) {
        std::array<Vec<3>, 3> corner;
        for (std::size_t k = 0; k < 3; ++k) corner[k] = jet<0>(s, t[k].c).value();
        for (int i = 0; i <= 12; ++i)
            for (int k = 0; i + k <= 12; ++k) {
                const double l = i / 12.0, m = k / 12.0, n = 1 - l - m;
                const auto j = jet<1>(s, (l * t[0] + m * t[1] + n * t[2]).c);
                const Vec<3> error = j.value() - (l * corner[0] + m * corner[1] + n * corner[2]);
                const Vec<3> normal = unit(cross(j(1, 0), j(0, 1)));
                // The worst direction of so much: towards the error, along the surface.
                const Vec<3> aside = error - dot(normal, error) * normal;
                for (const double sign : {1.0, -1.0}) {
                    const Vec<3> turned = norm(aside) > 0 ? sign * unit(aside) : Vec<3>{};
                    const double sine = turn * std::sqrt(1 - turn * turn / 4);
                    const Vec<3> seen = std::sqrt(1 - sine * sine) * normal + sine * turned;
                    most = std::max(most, std::abs(dot(seen, error)));
                }
            }
    }
    return most;
}

Vec<2> place_in(Random& random, const Box<2>& box) {
    return {{random.real(box.lo[0], box.hi[0]), random.real(box.lo[1], box.hi[1])}};
}

struct Found {
    int known = 0, sharper = 0, halved = 0, whole_halved = 0;
    double sharpest = 0, sharpest_half = 0, sharpest_whole = 0;
};

// Halves by the better diagonal, and any triangle in the cell.
void look_at_parts(Random& random, const SurfaceGeometry& s, const Bending& b, const Box<2>& cell,
                   double turn, Found& out) {
    const bool rising = b.prefers_rising(cell.hi - cell.lo);
    const std::array halves{half_of(cell, rising),
                            std::array{cell.lo, rising ? cell.hi : Vec<2>{{cell.hi[0], cell.lo[1]}},
                                       Vec<2>{{cell.lo[0], cell.hi[1]}}}};
    const double most = largest_seen(s, halves, turn), said = b.halves_error(cell, turn, 0);
    EXPECT_LE(most, said * (1 + 1e-9));
    for (const double enough : {0.8 * said, said, 1.2 * said, 2 * said}) {
        const double less = b.halves_error(cell, turn, enough);
        EXPECT_LE(said, less * (1 + 1e-9));
        EXPECT_LE(less, std::max(enough, said) * (enough < said ? 10 : 1));
    }
    out.halved += said < 0.8 * b.seen_error(cell, turn);
    out.sharpest_half = std::max(out.sharpest_half, most / said);
    const double whole = b.whole_halves_error(cell);
    for (const auto& t : halves) {
        const double found = largest_whole(s, t);
        EXPECT_LE(found, whole * (1 + 1e-9));
        out.sharpest_whole = std::max(out.sharpest_whole, found / whole);
    }
    out.whole_halved += whole < 0.8 * b.full.error(cell.hi - cell.lo);
    for (int i = 0; i < 4; ++i) {
        const std::array t{place_in(random, cell), place_in(random, cell), place_in(random, cell)};
        EXPECT_LE(largest_seen(s, std::span(&t, 1), turn), b.triangle_error(cell, t, turn, 0) * (1 + 1e-9));
        EXPECT_LE(largest_whole(s, t), b.whole_error(cell, t) * (1 + 1e-9));
    }
}

// Of halves, and of triangles of sides and the centre.
double largest_in_cells(const SurfaceGeometry& s, const Bending& b, const Box<2>& cell, double turn) {
    const bool rising = b.prefers_rising(cell.hi - cell.lo);
    const Vec<2> right{{cell.hi[0], cell.lo[1]}}, left{{cell.lo[0], cell.hi[1]}},
        centre = 0.5 * (cell.lo + cell.hi);
    const std::array triangles{half_of(cell, rising),
                               std::array{cell.lo, rising ? cell.hi : right, left},
                               std::array{cell.lo, right, centre},
                               std::array{right, cell.hi, centre},
                               std::array{cell.hi, left, centre},
                               std::array{left, cell.lo, centre}};
    return largest_seen(s, triangles, turn);
}

// In boxes of the surface, so large in parts of all of it, and in parts of them. `most_turn` of normals
// beyond those at the samples.
Found look_at(Random& random, const SurfaceGeometry& s, const Interval& on, int boxes, const Interval& sizes,
              double most_turn) {
    const DerivativeQuery<2, 3> surface(s);
    Found out;
    for (int k = 0; k < boxes; ++k) {
        Box<2> box;
        for (int d = 0; d < 2; ++d) {
            const double size = on.length() * random.real(sizes.lo, sizes.hi);
            box.lo[d] = random.real(on.lo, on.hi - size);
            box.hi[d] = box.lo[d] + size;
        }
        if (!surface.is_twice_smooth({box.side(0), box.side(1)})) continue;
        const bool is_all = k % 2 == 0;
        const Interval u = part_of(random, box.side(0), is_all), v = part_of(random, box.side(1), is_all);
        const Box<2> cell{{{u.lo, v.lo}}, {{u.hi, v.hi}}};
        const auto middle = jet<2>(s, {box.side(0).middle(), box.side(1).middle()});
        Variation varies;
        const double turn = random.real(0, most_turn);
        for (const Bending& b : {Bending(bending_of(surface, box, true, middle, &varies)),
                                 Bending(bending_from_middle(surface, box, true, middle, varies)),
                                 Bending(bending_by_fit(surface, box, true, middle))}) {
            if (!(b.least > 0)) continue;
            EXPECT_TRUE(b.knows_middle());
            const double said = b.seen_error(cell, turn), usual = b.seen(turn).error(cell.hi - cell.lo);
            const double most = largest_seen(random, s, cell, turn);
            EXPECT_LE(most, said * (1 + 1e-9));
            EXPECT_LE(said, usual);
            ++out.known;
            out.sharper += said < 0.8 * usual;
            out.sharpest = std::max(out.sharpest, most / said);
            look_at_parts(random, s, b, cell, turn, out);
            EXPECT_LE(largest_in_cells(s, b, cell, turn),
                      b.cells_error(box.hi - box.lo, cell.hi - cell.lo, turn) * (1 + 1e-9));
        }
    }
    return out;
}

TEST(Bending, what_cells_show_is_bounded_from_the_middle_of_a_box) {
    Random random(31);
    const auto z = [&](int, int) { return random.real(-1, 1); };
    const auto weight = [&] { return random.real(0.7, 1.4); };
    const auto aside = [&] { return random.real(-0.4, 0.4); };
    const auto basis = *BSplineBasis::clamped_uniform(3, 7);
    for (const SurfaceGeometry& s :
         {graph<Vec<3>>(basis, 0.4, z, weight, aside), graph<Hom<3>>(basis, 0.4, z, weight, aside)}) {
        const Found found = look_at(random, s, {0, 4}, 1000, {0.01, 0.15}, 0.1);
        EXPECT_GT(found.known, 500);
        EXPECT_GT(found.sharper, found.known / 4);
        EXPECT_GT(found.sharpest, 0.5);
        EXPECT_GT(found.halved, found.known / 8);
        EXPECT_GT(found.sharpest_half, 0.6);
        EXPECT_GT(found.whole_halved, found.known / 8);
        EXPECT_GT(found.sharpest_whole, 0.6);
    }
}

// Also where three points are nearly on a line: then what is said comes near what is true of the longest
// side, however wrong the plane through them is beside it.
TEST(Bending, what_one_triangle_shows_is_bounded_by_a_fit_to_it) {
    Random random(36);
    const auto z = [&](int, int) { return random.real(-1, 1); };
    const auto weight = [&] { return random.real(0.5, 2); };
    const auto aside = [&] { return random.real(-0.4, 0.4); };
    const auto basis = *BSplineBasis::clamped_uniform(3, 7);
    for (const SurfaceGeometry& s :
         {graph<Vec<3>>(basis, 0.4, z, weight, aside), graph<Hom<3>>(basis, 0.4, z, weight, aside)}) {
        const DerivativeQuery<2, 3> surface(s);
        int known = 0, thin = 0;
        double sharpest = 0, slackest_sliver = 0;
        for (int k = 0; k < 2000; ++k) {
            const double size = 4 * std::pow(0.5, random.real(2, 9)),
                         width = std::pow(0.1, random.real(0, 15));
            const Vec<2> a{{random.real(size, 4 - size), random.real(size, 4 - size)}};
            const double angle = k % 3 == 0 ? (k % 2) * std::numbers::pi / 2 : random.real(0, 7);
            const Vec<2> along{{size * std::cos(angle), size * std::sin(angle)}},
                across{{-along[1], along[0]}};
            const std::array t{a, a + along, a + random.real(0.1, 0.9) * along + width * across};
            Box<2> box;
            TriangleOn on{t, {}};
            for (std::size_t i = 0; i < 3; ++i) box.add(t[i]), on.at[i] = jet<0>(s, t[i].c).value();
            if (!(box.lo[0] < box.hi[0] && box.lo[1] < box.hi[1])) continue;
            const Box<2> wide = room_for_fit(surface, box);
            EXPECT_TRUE(wide.contains(box.lo) && wide.contains(box.hi));
            if (!is_fitted(surface, wide)) continue;
            const auto middle = jet<2>(s, (0.5 * (wide.lo + wide.hi)).c);
            const Bending b = bending_by_fit(surface, wide, true, middle, &on);
            const double whole = largest_whole(s, t), said = b.whole_error(box, t);
            EXPECT_LE(whole, said * (1 + 1e-9) + 1e-14) << width;
            if (whole > 1e-9) sharpest = std::max(sharpest, whole / said);
            if (size < 0.1 && width < 1e-6 && whole > 1e-9)
                slackest_sliver = std::max(slackest_sliver, said / whole), ++thin;
            if (!(b.least > 0)) continue;
            ++known;
            const double turn = random.real(0, 0.1);
            EXPECT_LE(largest_seen(s, std::span(&t, 1), turn),
                      b.triangle_error(box, t, turn, 0) * (1 + 1e-9) + 1e-14)
                << width;
        }
        EXPECT_GT(known, 500);
        EXPECT_GT(thin, 100);
        EXPECT_GT(sharpest, 0.9);
        EXPECT_LT(slackest_sliver, 2);
    }
}

// Nearly flat, so that normals hardly turn: sums of cubic splines of u and of v with a knot in the middle,
// whose second derivatives grow to both sides of it, or are anything else.
TEST(Bending, cubic_splines_are_seen_nearly_as_they_are) {
    Random random(32);
    double sharpest = 0;
    const auto basis = *BSplineBasis::clamped_uniform(3, 5);
    for (int k = 0; k < 400; ++k) {
        std::array<double, 5> p{}, q{};
        const double both = k % 3 == 0 ? random.real(0, 0.1) : 0, by_v = random.integer(0, 1);
        for (double& x : p) x = random.real(-1, 1);
        for (double& x : q) x = by_v * random.real(-1, 1);
        if (k % 2 == 0) {  // even about the middle
            p[4] = p[0], p[3] = p[1];
            q[4] = q[0], q[3] = q[1];
        }
        const auto z = [&](int i, int j) { return p[std::size_t(i)] + q[std::size_t(j)] + both * i * j; };
        const Found found = look_at(random, graph<Vec<3>>(basis, 1e-5, z, one, none), {0, 2}, 2, {1, 1}, 0);
        EXPECT_EQ(found.known, 6);
        sharpest = std::max(sharpest, found.sharpest);
    }
    EXPECT_GT(sharpest, 0.97);
}

// A smooth spline has many pieces, some short: what is too small beside one is not beside another, nor beside
// all of them.
TEST(Bending, small_boxes_get_the_room_of_their_piece) {
    std::vector<double> knots{0, 0, 0, 0, 1e-6};
    for (int k = 1; k <= 40; ++k) knots.push_back(k);
    knots.insert(knots.end(), 3, 40);
    const auto basis = *BSplineBasis::make(3, knots);
    const SurfaceGeometry surface = graph<Vec<3>>(
        basis, 1, [](int i, int j) { return i * j; }, one, none);
    const DerivativeQuery<2, 3> query(surface);
    const auto length_about = [&](double at, double length) {
        const Vec<2> lo{{at, at}}, hi{{at + length, at + length}};
        const Box<2> room = room_for_fit(query, {lo, hi});
        EXPECT_LE(room.lo[0], lo[0]);
        EXPECT_GE(room.hi[1], hi[1]);
        EXPECT_NEAR(room.side(0).length(), room.side(1).length(), 1e-12 * length);
        return room.side(0).length();
    };
    EXPECT_DOUBLE_EQ(length_about(20.25, 0.125), 0.125);
    EXPECT_NEAR(length_about(20.25, 0x1p-12), 0x1p-8, 1e-9);
    EXPECT_NEAR(length_about(2e-7, 1e-8), 1e-8, 1e-12);
    EXPECT_NEAR(length_about(2e-7, 1e-10), 0x1p-8 * 1e-6, 1e-12);
}

// Third derivatives are 0, but where the curve is slow, its normals turn faster than in the middle: away from
// it in small cells, and within large ones.
TEST(Bending, normals_that_turn_are_counted) {
    const auto basis = *BSplineBasis::clamped_uniform(2, 3);
    const auto line = *BSplineBasis::clamped_uniform(1, 2);
    double small = 0, whole = 0;
    for (const double c : {0.02, 0.05, 0.1, 0.15}) {  // (u + c u^2, v, u^2 / 20), u from -1 to 1
        std::vector<Vec<3>> points;
        for (const Vec<2>& p : {Vec<2>{{-1 + c, 0.05}}, Vec<2>{{-c, -0.05}}, Vec<2>{{1 + c, 0.05}}})
            for (const double v : {0.0, 1.0}) points.push_back({{p[0], v, p[1]}});
        const SurfaceGeometry s = must(Surface<Vec<3>>::make({basis, line}, Net<2, Vec<3>>({3, 2}, points)));
        const DerivativeQuery<2, 3> surface(s);
        const Bending b = bending_of(surface, {{{0, 0}}, {{1, 1}}}, true);
        ASSERT_TRUE(b.least > 0 && b.knows_middle());
        Random random(34);
        for (const Box<2>& cell : {Box<2>{{{0, 0}}, {{1, 1}}}, Box<2>{{{0, 0}}, {{0.02, 1}}}}) {
            const double most = largest_seen(random, s, cell, 0), said = b.seen_error(cell, 0);
            EXPECT_LE(most, said * (1 + 1e-9)) << c;
            const double size = cell.hi[0] - cell.lo[0];
            const double flat = b.across.uu * size * size / 8;  // normals as in the middle
            (size < 1 ? small : whole) = std::max(size < 1 ? small : whole, most / flat);
        }
    }
    EXPECT_GT(small, 1.2);
    EXPECT_GT(whole, 1.01);
}

// The critical point of the distance from p that Newton's method finds from y.
Vec<2> foot_from(const SurfaceGeometry& s, const Vec<3>& p, Vec<2> x) {
    for (int k = 0; k < 30; ++k) {
        const auto j = jet<2>(s, x.c);
        const Vec<3> d = j.value() - p, &u = j(1, 0), &v = j(0, 1);
        const double uu = dot(u, u) + dot(d, j(2, 0)), uv = dot(u, v) + dot(d, j(1, 1)),
                     vv = dot(v, v) + dot(d, j(0, 2)), det = uu * vv - uv * uv, by_u = dot(u, d),
                     by_v = dot(v, d);
        x = x - Vec<2>{{(vv * by_u - uv * by_v) / det, (uu * by_v - uv * by_u) / det}};
    }
    return x;
}

TEST(Shift, feet_are_as_near_as_it_says) {
    Random random(35);
    const auto aside = [&] { return random.real(-0.45, 0.45); };
    const auto z = [&](int, int) { return random.real(-1, 1); };
    const auto weight = [&] { return random.real(0.5, 2); };
    int beyond = 0;
    double farthest = 0;
    for (int round = 0; round < 300; ++round) {
        const SurfaceGeometry s = graph<Hom<3>>(*BSplineBasis::clamped_uniform(3, 7), 0.3, z, weight, aside);
        const DerivativeQuery<2, 3> surface(s);
        const double size = random.real(0.02, 0.5);
        const Vec<2> lo = place_in(random, {{{1, 1}}, {{3 - size, 3 - size}}});
        const Box<2> cell{lo, lo + Vec<2>{{size, size * random.real(0.3, 1)}}};
        const Bending b = bending_of(surface, cell, true);
        if (!(b.least > 0) || !b.knows_middle()) continue;
        const double e = b.full.error(cell.hi - cell.lo);
        const Vec<2> reach = reach_of(b, e);
        const Box<2> around{cell.lo - reach, cell.hi + reach};
        if (around.lo[0] < 0 || around.lo[1] < 0 || around.hi[0] > 4 || around.hi[1] > 4) continue;
        const auto own = surface({around.side(0), around.side(1)});
        const Curvature near{own(2, 0), own(1, 1), own(0, 2)};
        const Shift shift = shift_of(b, e, near, 1, true);
        EXPECT_GE(shift.exists, shift_of(b, e, near, 1, false).exists);
        if (!shift.exists) continue;
        beyond += !shift_of(b, e, near, 1, false).exists;
        const auto t = half_of(cell, b.prefers_rising(cell.hi - cell.lo));
        const double across = shift.across(b.halves_error(cell, shift.turn, 0), e);
        std::array<Vec<3>, 3> corner;
        for (std::size_t k = 0; k < 3; ++k) corner[k] = jet<0>(s, t[k].c).value();
        for (int i = 0; i < 20; ++i) {
            const double l = random.real(0, 1), m = random.real(0, 1 - l), n = 1 - l - m;
            const Vec<3> p = l * corner[0] + m * corner[1] + n * corner[2];
            const Vec<2> y = l * t[0] + m * t[1] + n * t[2], x = foot_from(s, p, y), d = x - y;
            const auto j = jet<1>(s, x.c);
            const double far = std::hypot(b.a * d[0], b.b * d[1]) * b.least / e;
            EXPECT_LE(far, shift.far * (1 + 1e-9));
            EXPECT_LE(norm(j.value() - p), across * (1 + 1e-9));
            EXPECT_LE(norm(unit(cross(j(1, 0), j(0, 1))) - b.n), b.tilt + shift.turn);
            farthest = std::max(farthest, far);
        }
    }
    EXPECT_GT(beyond, 10);  // which may not be at the boundary of a face
    EXPECT_GT(farthest, 0.3);
}

TEST(Bending, of_several_boxes_knows_no_middle) {
    Random random(33);
    const SurfaceGeometry s = graph<Vec<3>>(
        *BSplineBasis::clamped_uniform(3, 4), 0.2, [&](int, int) { return random.real(-1, 1); }, one, none);
    const DerivativeQuery<2, 3> surface(s);
    Bending both = bending_of(surface, {{{0, 0}}, {{0.1, 0.1}}}, true);
    const Bending other = bending_of(surface, {{{0.1, 0}}, {{0.2, 0.1}}}, true);
    ASSERT_TRUE(both.knows_middle() && other.knows_middle());
    both.include(other);
    EXPECT_FALSE(both.knows_middle());
}

}  // namespace
}  // namespace freiform
