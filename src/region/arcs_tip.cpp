// Where two circles meet that go on from the sides of a corner.
//
// Notation. Lengths in half widths, the joint in the origin; e a side's point, |e| = 1; b the curvature of
// the path there, l = b / (1 + b) that of its edge, > 0 if the centre (1 - 1 / l) e is opposite to e. The
// circle is
//     l |x|^2 + 2 (1 - l) e . x = 2 - l,
// a line for l = 0. Two of them meet on the line g . x = l2 - l1 with g = l2 (1 - l1) e1 - l1 (1 - l2) e2.
//
// Rules. Circles without a point in common: both radii change by d until the circles touch, the larger one
// becoming smaller if it encloses the other, both larger if they are apart; with a line only the circle
// changes. That the centres are r1 -+ r2 apart is an equation of degree 2 in d, whose least root >= 0 is
// taken. Of two points in common the one nearest to the joint is the tip, of those ahead of both sides.
//
// Rounding. All of it in numbers that carry the bound of their error. A question that these leave open is
// answered both ways: a tip that may be there and may be the nearest one is possible, and the bound reaches
// from the tip that is taken to all possible ones.
//
// References. SVG 2, section 13.5 ("Computing the circles", "Adjusting the circles").
#include "arcs_tip_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace freiform::detail {

namespace {

constexpr double kFar = 0x1p40;  // no radius changes by more

bool surely_positive(const Bounded& x) { return x.value > x.bound; }
bool perhaps_positive(const Bounded& x) { return !(x.value + x.bound <= 0); }

BoundedPoint operator*(const Bounded& s, const BoundedPoint& p) { return {s * p[0], s * p[1]}; }
BoundedPoint plus(const BoundedPoint& p, const BoundedPoint& q) { return {p[0] + q[0], p[1] + q[1]}; }
BoundedPoint minus(const BoundedPoint& p, const BoundedPoint& q) { return {p[0] - q[0], p[1] - q[1]}; }
BoundedPoint bounded(const Vec<2>& v) { return {Bounded(v[0], kJoinSideError), {v[1], kJoinSideError}}; }

bool is_straight(const EdgeCircle& c) { return std::abs(c.l.value) < kStraightEdge; }
double side_of(const EdgeCircle& c) { return c.l.value < 0 ? -1 : 1; }
Bounded radius(const EdgeCircle& c) { return Bounded(1) / abs(c.l); }
// Of the circle with a radius that is larger by d; and how it moves for each unit of d.
BoundedPoint centre(const EdgeCircle& c, const Bounded& d) {
    return (Bounded(1) - Bounded(side_of(c)) * (radius(c) + d)) * c.e;
}
BoundedPoint shift(const EdgeCircle& c) { return Bounded(-side_of(c)) * c.e; }

// Of a x^2 + 2 b x + c, where the discriminant is not below 0. An infinite bound: nothing is known of it.
std::array<Bounded, 2> roots(const Bounded& a, const Bounded& b, const Bounded& c) {
    const Bounded root = sqrt(b * b - a * c);
    std::array<Bounded, 2> out;
    for (const int i : {0, 1}) {
        const Bounded q = i == 0 ? root - b : -(root + b);  // root i is q / a, and the other one is c / q
        const Bounded over = q / a, other = i == 0 ? c / -(root + b) : c / (root - b);
        out[std::size_t(i)] = over.is_finite() && !(other.bound < over.bound) ? over : other;
    }
    return out;
}

struct PossibleTip {
    BoundedPoint at;
    bool sure = true;  // that it is there
};

// What is so if one of two things that rounding leaves open holds.
struct Branch {
    std::vector<PossibleTip> tips;
    bool known = true;  // no: there may be other tips, anywhere
};

// A circle that grows until it touches the line. Taking an edge of curvature below kStraightEdge as a line
// moves it by at most |x|^2 of that, and d and the tip with it.
Branch touching_line(const EdgeCircle& circle, const EdgeCircle& line) {
    const Bounded m = dot(line.e, centre(circle, 0)) - Bounded(1);
    if (!m.excludes_zero()) return {{}, false};
    const Bounded slope = Bounded(1) - Bounded(m.value < 0 ? -1 : 1) * dot(line.e, shift(circle));
    if (!(slope.value > kStraightEdge)) return {};
    const Bounded d = (abs(m) - radius(circle)) / slope;
    if (d.value + d.bound < 0) return {};
    const BoundedPoint c = centre(circle, d);
    BoundedPoint tip = minus(c, (dot(line.e, c) - Bounded(1)) * line.e);
    const double reach = 2 + std::abs(tip[0].value) + std::abs(tip[1].value),
                 bent = 16 * (std::abs(line.l.value) + line.l.bound) * reach * reach / slope.value;
    for (Bounded& z : tip) z.bound += bent;
    return {{{tip, true}}, true};
}

// Of circles that have no point in common.
Branch touching(const EdgeCircle& x, const EdgeCircle& y, bool parallel, bool& apart) {
    apart = is_straight(x) || is_straight(y);
    if (apart) return is_straight(y) ? touching_line(x, y) : touching_line(y, x);
    if (radius(x).value < radius(y).value) return touching(y, x, parallel, apart);
    const BoundedPoint between = minus(centre(y, 0), centre(x, 0));
    const Bounded larger = radius(x), outside = dot(between, between) - larger * larger;
    if (!outside.excludes_zero()) return {{}, false};
    apart = outside.value > 0;
    if (apart && parallel) return {};
    const Bounded sign = apart ? 1 : -1, sum = larger + sign * radius(y);
    const BoundedPoint change = minus(shift(y), sign * shift(x));
    const Bounded a = dot(change, change) - Bounded(4), b = dot(between, change) - Bounded(2) * sign * sum,
                  c = dot(between, between) - sum * sum;
    const Bounded discriminant = b * b - a * c;
    if (!perhaps_positive(discriminant)) return {};
    // Where circles almost touch, c is almost 0, and > 0 if they are apart: the root that is almost 0 is not
    // below it if b has the other sign.
    const bool near_is_above = !c.excludes_zero() && b.excludes_zero() && (b.value < 0) == apart;
    const std::array<Bounded, 2> both = roots(a, b, c);
    Branch branch;
    std::vector<std::pair<Bounded, bool>> steps;  // and whether they are surely there
    for (const int i : {0, 1}) {
        const Bounded &d = both[std::size_t(i)], &other = both[std::size_t(1 - i)];
        if (!d.is_finite()) {  // farther than q / a, unless that says nothing
            const double q = std::abs(b.value) - b.bound;
            branch.known = branch.known && q > kFar * (std::abs(a.value) + a.bound);
            continue;
        }
        const bool near = !(std::abs(d.value) > std::abs(other.value));
        const Bounded rest = apart ? Bounded(kFar) - d : sum - d;
        if (d.value + d.bound < 0 || rest.value + rest.bound < 0) continue;
        steps.push_back({d, (d.value >= d.bound || (near && near_is_above)) && rest.value >= rest.bound &&
                                surely_positive(discriminant)});
    }
    for (const auto& [d, sure] : steps) {
        // Not the least one, if another is surely there and below it.
        if (std::ranges::any_of(
                steps, [&](const auto& other) { return other.second && surely_positive(d - other.first); }))
            continue;
        const Bounded step = sign * d;
        const BoundedPoint from = centre(x, step), toward = minus(centre(y, d), from);
        // The centres are sum + 2 sign d apart.
        branch.tips.push_back({plus(from, ((larger + step) / (sum + Bounded(2) * step)) * toward), sure});
    }
    return branch;
}

// Leaves the tips that are ahead of both sides and may be the nearest.
void keep_nearest(Branch& branch, const JoinSide& first, const JoinSide& last) {
    const auto ahead = [](const JoinSide& s, const BoundedPoint& p) {
        return dot(bounded(s.direction), minus(p, bounded(s.at)));
    };
    std::erase_if(branch.tips, [&](PossibleTip& t) {
        const Bounded x = ahead(first, t.at), y = ahead(last, t.at);
        t.sure = t.sure && surely_positive(x) && surely_positive(y);
        return !perhaps_positive(x) || !perhaps_positive(y);
    });
    const std::vector<PossibleTip> all = branch.tips;
    std::erase_if(branch.tips, [&](const PossibleTip& t) {
        return std::ranges::any_of(all, [&](const PossibleTip& o) {
            return o.sure && surely_positive(dot(t.at, t.at) - dot(o.at, o.at));
        });
    });
}

Vec<2> value_of(const BoundedPoint& p) { return {{p[0].value, p[1].value}}; }

}  // namespace

EdgeCircle edge_circle(const JoinSide& side) {
    return {bounded(side.at), side.bend / (Bounded(1) + side.bend)};
}

ArcsTip arcs_tip(const JoinSide& first, const JoinSide& last) {
    const EdgeCircle x = edge_circle(first), y = edge_circle(last);
    const BoundedPoint g = minus((y.l * (Bounded(1) - x.l)) * x.e, (x.l * (Bounded(1) - y.l)) * y.e);
    const Bounded square = dot(g, g);
    if (!surely_positive(square)) return {{}, kInfinity};
    const EdgeCircle& z = std::abs(x.l.value) < std::abs(y.l.value) ? y : x;
    const BoundedPoint foot = ((y.l - x.l) / square) * g;
    const Bounded one(1), two(2),
        a = z.l * square, b = (one - z.l) * (g[0] * z.e[1] - g[1] * z.e[0]),
        c = z.l * dot(foot, foot) + two * (one - z.l) * dot(z.e, foot) - (two - z.l),
        discriminant = b * b - a * c;
    const bool parallel = dot(first.at, last.at) < -1 + kStraightEdge;
    ArcsTip out;
    std::vector<Branch> branches;
    if (discriminant.value + discriminant.bound >= 0) {
        branches.emplace_back();
        for (const Bounded& s : roots(a, b, c))
            branches.back().tips.push_back({plus(foot, s * BoundedPoint{-g[1], g[0]})});
    }
    if (!surely_positive(discriminant)) {
        branches.push_back(touching(x, y, parallel, out.apart));
        out.apart = out.apart && parallel && branches.size() == 1;
    }
    if (out.apart) return out;
    bool known = true, some = false, none = false;
    for (Branch& branch : branches) {
        keep_nearest(branch, first, last);
        known = known && branch.known;
        some = some || !branch.tips.empty();
        none = none || std::ranges::none_of(branch.tips, &PossibleTip::sure);
        for (const PossibleTip& t : branch.tips)
            if (const Vec<2> p = value_of(t.at);
                is_finite(p) && (!out.at || dot(p, p) < dot(*out.at, *out.at)))
                out.at = p;
    }
    if (!known || (some && none)) {
        out.bound = kInfinity;
        return out;
    }
    for (const Branch& branch : branches)
        for (const PossibleTip& t : branch.tips) {
            const double away =
                norm(value_of(t.at) - *out.at) * (1 + 0x1p-50) + t.at[0].bound + t.at[1].bound;
            out.bound = std::max(out.bound, away >= 0 ? away : kInfinity);
        }
    return out;
}

}  // namespace freiform::detail
