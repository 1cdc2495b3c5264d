// What rounding does to the joins `arcs`: bounds against the rules in long double.
#include "region/arcs_join_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/region/stroke.hpp>

#include <gtest/gtest.h>
#include <optional>
#include <random.hpp>
#include <region_laws.hpp>
#include <sanitizer.hpp>

namespace freiform {
namespace {

using namespace test;
using detail::ArcsJoin, detail::ArcsJoinKind, detail::JoinSide, detail::kJoinSideError;

using Long = long double;
struct LongVec {
    Long x, y;
};
LongVec operator+(LongVec a, LongVec b) { return {a.x + b.x, a.y + b.y}; }
LongVec operator-(LongVec a, LongVec b) { return {a.x - b.x, a.y - b.y}; }
LongVec operator*(Long s, LongVec a) { return {s * a.x, s * a.y}; }
Long dot(LongVec a, LongVec b) { return a.x * b.x + a.y * b.y; }
Long norm(LongVec a) { return std::sqrt(dot(a, a)); }

// A side of a corner, of numbers that the join may have been meant for.
struct LongSide {
    LongVec at, direction;
    Long bend;

    Long radius() const { return std::abs((1 + bend) / bend); }
    LongVec centre(Long wider) const { return (1 - std::copysign(radius() + wider, bend)) * at; }
};

// Where the circles of two sides meet, found by their centres; then, for those without a point in common,
// the least change of the radii that makes them touch, found by steps and halving.
std::vector<LongVec> meetings(LongVec c, Long r, LongVec d, Long s) {
    const LongVec between = d - c;
    const Long apart = norm(between), along = (apart * apart + r * r - s * s) / (2 * apart);
    if (r * r < along * along) return {};
    const Long across = std::sqrt(r * r - along * along);
    const LongVec e = (1 / apart) * between, foot = c + along * e;
    return {foot + across * LongVec{-e.y, e.x}, foot - across * LongVec{-e.y, e.x}};
}
bool is_ahead_of(const LongSide& s, LongVec p) { return dot(s.direction, p - s.at) > 0; }

std::optional<LongVec> tip_by_centres(const LongSide& a, const LongSide& b) {
    const Long r = a.radius(), s = b.radius();
    std::optional<LongVec> tip;
    const std::vector<LongVec> both = meetings(a.centre(0), r, b.centre(0), s);
    for (const LongVec& p : both)
        if (is_ahead_of(a, p) && is_ahead_of(b, p) && (!tip || dot(p, p) < dot(*tip, *tip))) tip = p;
    if (!both.empty()) return tip;
    const bool apart = norm(b.centre(0) - a.centre(0)) > std::max(r, s);
    const Long ra = apart || r < s ? 1 : -1, rb = apart || s <= r ? 1 : -1;
    const auto gap = [&](Long d) {
        const Long between = norm(b.centre(rb * d) - a.centre(ra * d)), x = r + ra * d, y = s + rb * d;
        return apart ? between - x - y : std::abs(x - y) - between;
    };
    Long lo = 0, hi = 0x1p-60L;
    const Long end = apart ? 0x1p30L : std::abs(r - s);
    while (gap(hi) > 0 && hi < end) lo = hi, hi *= 1.01L;
    if (gap(hi) > 0) return {};
    for (int i = 0; i < 90; ++i) (gap((lo + hi) / 2) > 0 ? lo : hi) = (lo + hi) / 2;
    const LongVec c = a.centre(ra * hi), d = b.centre(rb * hi), between = d - c;
    const bool from_a = apart || ra < 0;  // the centre of the larger one
    const LongVec touch = from_a ? c + ((r + ra * hi) / norm(between)) * between
                                 : d - ((s + rb * hi) / norm(between)) * between;
    if (is_ahead_of(a, touch) && is_ahead_of(b, touch)) return touch;
    return {};
}

// Two sides whose directions meet at an angle, on the outside of a corner that turns by `turn`.
struct Corner {
    JoinSide first, last;
};
Corner corner_of(double from, double turn, double bend, double other_bend) {
    const auto at = [](double angle) { return Vec<2>{{std::cos(angle), std::sin(angle)}}; };
    const Vec<2> e = at(from), f = at(from + turn);
    return {{e, {{-e[1], e[0]}}, bend}, {f, {{f[1], -f[0]}}, other_bend}};
}
// The same but for errors as large as those that are allowed.
LongSide nearby(const JoinSide& s, Random& random) {
    const auto off = [&](double x, double by) { return Long(x) + Long(by) * random.real(-1, 1); };
    LongVec at{off(s.at[0], kJoinSideError / 4), off(s.at[1], kJoinSideError / 4)};
    at = (1 / norm(at)) * at;
    const Long side = cross(s.at, s.direction) > 0 ? 1 : -1;
    return {at, side * LongVec{-at.y, at.x}, off(s.bend.value, s.bend.bound)};
}
// Circles that touch within 10^-digits: the second curvature by halving between a meeting and none.
std::optional<double> bend_that_touches(double from, double turn, double bend, double meets, double misses) {
    const auto meet = [&](double other) {
        const Corner c = corner_of(from, turn, bend, other);
        const LongSide a{{c.first.at[0], c.first.at[1]}, {}, bend},
            b{{c.last.at[0], c.last.at[1]}, {}, other};
        return !meetings(a.centre(0), a.radius(), b.centre(0), b.radius()).empty();
    };
    if (!meet(meets) || meet(misses)) return {};
    for (int i = 0; i < 60; ++i) (meet((meets + misses) / 2) ? meets : misses) = (meets + misses) / 2;
    return meets;
}

TEST(ArcsBound, reaches_to_the_tip_of_all_numbers_that_may_be_meant) {
    Random random(5);
    int tips = 0, touching = 0, sharp = 0;
    std::vector<double> bounds;
    for (int i = 0; i < cases(4000); ++i) {
        const double from = random.real(-3, 3), turn = random.real(0.1, 3);
        const bool touch = i % 2 == 1;
        const double bend = random.real(-0.45, touch ? 0 : 3);
        double other = random.real(-0.45, 3);
        if (touch) {  // almost, and to all degrees of that
            std::optional<double> found;
            for (int k = 0; k < 40 && !found; ++k)
                found = bend_that_touches(from, turn, bend, random.real(-0.45, 1), random.real(-0.49, 0));
            if (!found) continue;
            other = *found * (1 + std::ldexp(random.real(-1, 1), -random.integer(3, 60)));
        }
        Corner c = corner_of(from, turn, bend, other);
        c.first.bend.bound = c.last.bend.bound = std::ldexp(1.0, -random.integer(40, 52));
        if (std::abs(other) < 1e-3 || std::abs(bend) < 1e-3) continue;  // the twin wants circles
        const ArcsJoin join = arcs_join(c.first, c.last, 1e6);
        if (join.bound == kInfinity) continue;
        for (int k = 0; k < 3; ++k) {
            const LongSide a = nearby(c.first, random), b = nearby(c.last, random);
            const auto tip = tip_by_centres(a, b);
            const LongVec middle = a.at + b.at + a.direction + b.direction;
            if (!tip || dot(middle, *tip) <= 0) {
                EXPECT_EQ(join.kind, ArcsJoinKind::miter_clip) << i;
                continue;
            }
            ASSERT_EQ(join.kind, ArcsJoinKind::arcs) << i << ' ' << touch;
            const LongVec off = *tip - LongVec{join.from_first[0], join.from_first[1]};
            EXPECT_LE(norm(off), join.bound) << i << ' ' << touch << ' ' << double(norm(*tip));
            ++tips, touching += int(touch), sharp += int(double(norm(off)) > 1e-3 * join.bound);
        }
        if (!touch && join.kind == ArcsJoinKind::arcs) bounds.push_back(join.bound);
    }
    EXPECT_GT(tips, cases(4000));
    EXPECT_GT(4 * touching, tips);
    EXPECT_GT(10 * sharp, tips);  // bounds that say something
    std::ranges::sort(bounds);
    EXPECT_LT(bounds[bounds.size() / 2], 1e-10);
}

TEST(ArcsBound, reaches_to_where_the_limit_cuts) {
    Random random(6);
    int cut = 0;
    for (int i = 0; i < cases(3000); ++i) {
        const double from = random.real(-3, 3), turn = random.real(1, 3);
        Corner c = corner_of(from, turn, random.real(0.01, 1), random.real(0.01, 1));
        const double noise = std::ldexp(1.0, -random.integer(20, 52));
        const ArcsJoin whole = arcs_join(c.first, c.last, 1e6);
        if (whole.kind != ArcsJoinKind::arcs) continue;
        const double reach = norm(whole.from_first),
                     limit = random.chance(0.2) ? reach * (1 + 1e-9 * random.real(-1, 1))
                                                : std::max(1.0, reach * random.real(0.6, 1.1));
        const ArcsJoin exact = arcs_join(c.first, c.last, limit);
        c.first.bend.bound = c.last.bend.bound = noise;
        const ArcsJoin join = arcs_join(c.first, c.last, limit);
        for (Bounded* b : {&c.first.bend, &c.last.bend}) b->value += noise * random.real(-1, 1), b->bound = 0;
        const ArcsJoin other = arcs_join(c.first, c.last, limit);
        if (join.bound == kInfinity || exact.bound == kInfinity || other.bound == kInfinity) continue;
        ASSERT_EQ(join.kind, other.kind) << i;
        if (join.kind != ArcsJoinKind::arcs) continue;
        const double slack = join.bound + other.bound;
        EXPECT_LE(norm(join.from_first - other.from_first), slack) << i;
        EXPECT_LE(norm(join.from_last - other.from_last), slack) << i;
        cut += int(norm(join.from_first - join.from_last) > 1e-3);
    }
    EXPECT_GT(5 * cut, cases(3000));
}

TEST(ArcsBound, is_in_that_of_the_stroke_and_what_it_exceeds_is_refused) {
    const auto stroke = [](std::string_view data, double width, double tolerance) {
        return stroked(path_from(data),
                       {.width = width, .miter_limit = 20, .join = LineJoin::arcs, .dashes = {}},
                       {.tolerance = tolerance});
    };
    // Edges with the radius of the pen, but for rounding: a tip, or round.
    int refused = 0;
    for (int i = 1; i <= 20; ++i) {
        const double x = 0.1 * i;
        const auto open = stroke(
            text("M ", x - 2, ' ', x - 2, " A 2 2 0 0 0 ", x, ' ', x, " A 2 2 0 0 0 ", x + 2, ' ', x + 2), 2,
            1e-3);
        if (open) continue;
        ++refused;
        EXPECT_EQ(open.error().kind, RefusalKind::ill_conditioned);
        EXPECT_EQ(open.error().where, "path.subpaths[0]");
        EXPECT_NE(open.error().message.find(text("join at (", x, ", ", x, ")")), std::string::npos)
            << open.error().message;
    }
    EXPECT_GT(refused, 0);
    // Lines that are cubics, whose control points lie on the line but for rounding.
    const auto lines = stroke("M 0 0 C 0.1 0.3 0.2 0.6 0.3 0.9 C 0.6 0.8 0.9 0.7 1.2 0.6", 0.2, 1e-6),
               miter = stroke("M 0 0 L 0.3 0.9 L 1.2 0.6", 0.2, 1e-6);
    ASSERT_TRUE(lines && miter);
    EXPECT_NEAR(signed_area(lines->path).value, signed_area(miter->path).value, 1e-9);
}

}  // namespace
}  // namespace freiform
