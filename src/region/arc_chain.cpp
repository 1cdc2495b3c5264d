// Bezier curves as arcs of circles, with a bound for the pen that is moved along them.
//
// Idea. The sides of a stroke along an arc of a circle are arcs again. So each curve is replaced by arcs:
// pairs of arcs (biarcs) that join its ends with its tangents there; halved until they are near enough.
//
// Notation. C = X / W the curve over a part, in homogeneous form; D = X' W - X W', so that C' = D / W^2. a,
// n, k the start of an arc, its left normal and its curvature; R = 1 / |k|, c = a + n / k its centre; h half
// the width of the pen. Everything below is divided by k, so that lines, k = 0, are no other case.
//
// Accuracy. The pen at t covers C + r N for |r| <= h, that of the arc c + (R +- r) u. With the point of the
// arc in the direction of C - c from c, points of equal r differ by at most
//     | |C - c| - R |  +  h |N - u|.
// Both come from Bernstein coefficients:
//   - k (|C - c|^2 - R^2) = f / W^2 with f = k |X - a W|^2 - 2 W n . (X - a W), and |k| (|C - c| + R) is at
//   least
//     3/2 if C is within R / 2 of the circle (2 for lines);
//   - the sine of the angle between N and u is at most max |g_i| / (min w (1 - |k| d) |D|), with
//     g = k (X - a W) . D - W n . D, d the distance from the circle, and |D| at least the least product of
//     the D_i with the direction of the chord. For sines up to 0.1 the angle, and |N - u|, is at most 1.002
//     times as large.
// If k cross(X - a W, D) - W cross(n, D) has positive coefficients, the direction from c is monotone in t, so
// that the arc is passed once. The parts of the curve for both arcs meet at a parameter where the curve
// passes the joint J; what it is beside J along the tangent, e, moves ends of the pen by at most (1 + h / R)
// e more.
// Where control points coincide with an end the curve stands still there, D has a zero of that order and is
// divided by it: g and the last polynomial are linear in D, so that only its direction counts.
//   Rounding: all terms are sums of at most 30 products of coordinates relative to a, up to S, rounded a few
// times: 2^-46 of S (1 + |k| S) for f, of S^2 for D; numbers are rounded to 2^-53 of the coordinates before
// that.
//
// Cost. The angle is off by O(L^2) for parts of length L, so some sqrt(h / tolerance) arcs.
//
// References. [Bolton 1975] for biarcs.
//
// Why not offsets as cubics? They need fewer pieces, but a bound of their distance from the true offset asks
// for a proof around every cusp of it; arcs have none, and their ends and insides are known exactly.
#include "arc_chain_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/jet.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace freiform::detail {

namespace {

constexpr int kMostHalvings = 40;
constexpr std::size_t kMaxPieces = 100'000;

using Bern = std::vector<double>;

Bern times(const Bern& a, const Bern& b) {
    const int p = int(a.size()) - 1, q = int(b.size()) - 1;
    Bern out(std::size_t(p + q) + 1, 0.0);
    for (int i = 0; i <= p; ++i)
        for (int j = 0; j <= q; ++j)
            out[std::size_t(i + j)] += binomial(p, i) * binomial(q, j) / binomial(p + q, i + j) *
                                       a[std::size_t(i)] * b[std::size_t(j)];
    return out;
}
Bern plus(Bern a, const Bern& b, double factor = 1) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += factor * b[i];
    return a;
}
Bern mul(Bern a, double factor) {
    for (double& x : a) x *= factor;
    return a;
}
Bern slope(const Bern& a) {
    Bern out;
    for (std::size_t i = 0; i + 1 < a.size(); ++i) out.push_back(double(a.size() - 1) * (a[i + 1] - a[i]));
    return out;
}
double largest(const Bern& a) {
    double m = 0;
    for (const double x : a) m = std::max(m, std::abs(x));
    return m;
}

// Of how many control points each end of a segment has on it besides its own.
using Still = std::array<int, 2>;

Still still_of(const PathSegment& s) {
    Still still{};
    while (still[0] < s.degree && s.points[std::size_t(still[0]) + 1] == s.front()) ++still[0];
    while (still[1] < s.degree && s.points[std::size_t(s.degree - 1 - still[1])] == s.back()) ++still[1];
    return still;
}

// A part that stands still at its ends as said, which rounding would take from it.
PathSegment part_still(const PathSegment& s, double from, double to, const Still& still) {
    PathSegment part = part_of(s, from, to);
    for (int i = 1; i <= still[0]; ++i) part.points[std::size_t(i)] = part.front();
    for (int i = 1; i <= still[1]; ++i) part.points[std::size_t(part.degree - i)] = part.back();
    return part;
}

// Divided by t^still[0] (1 - t)^still[1]: b(n, i + 1) = n / (i + 1) t b(n - 1, i).
Bern divided(Bern a, const Still& still) {
    for (const bool at_end : {false, true}) {
        for (int k = 0; k < still[at_end]; ++k) {
            if (at_end) std::ranges::reverse(a);
            const double n = double(a.size() - 1);
            a.erase(a.begin());
            for (std::size_t i = 0; i < a.size(); ++i) a[i] *= n / double(i + 1);
            if (at_end) std::ranges::reverse(a);
        }
    }
    return a;
}

// The arc from a to b that leaves a in the direction ta.
ArcPiece arc_from(const Vec<2>& a, const Vec<2>& ta, const Vec<2>& b, const Vec<2>& tb) {
    ArcPiece piece{a, b, ta, tb, 0, {}};
    const Vec<2> chord = b - a;
    const double bend = 2 * cross(ta, chord) / dot(chord, chord);
    if (std::abs(bend) * norm(chord) < 0x1p-45) return piece;
    piece.curvature = bend;
    piece.centre = a + (1 / bend) * piece.normal_a();
    return piece;
}

// What the pen along the segment and that along the piece differ by; nothing where there is no bound.
std::optional<double> difference(const PathSegment& s, const ArcPiece& piece, double h, const Still& still) {
    const auto net = homogeneous(s);
    const Vec<2> n = piece.normal_a();
    const double k = piece.curvature;
    Bern x, y, w;
    double least_w = kInfinity, size = 0, scale = 0;
    for (int i = 0; i <= s.degree; ++i) {
        const Hom<2>& p = net[std::size_t(i)];
        x.push_back(p[0] - piece.a[0] * p[2]), y.push_back(p[1] - piece.a[1] * p[2]), w.push_back(p[2]);
        least_w = std::min(least_w, p[2]);
        size = std::max({size, std::abs(x.back()), std::abs(y.back())});
        scale = std::max({scale, std::abs(p[0]), std::abs(p[1]), max_abs(piece.a)});
    }
    const Bern wx = slope(w), dx = divided(plus(times(slope(x), w), times(x, wx), -1), still),
               dy = divided(plus(times(slope(y), w), times(y, wx), -1), still);
    const Vec<2> along = unit(s.back() - s.front());
    double speed = kInfinity;
    for (std::size_t i = 0; i < dx.size(); ++i) speed = std::min(speed, along[0] * dx[i] + along[1] * dy[i]);
    // Of a coordinate, and of D, which dividing makes up to 5 4 3 times as large.
    const double noise = (0x1p-46 * size + 0x1p-49 * scale) * (still == Still{} ? 1 : 64);
    if (!(speed > noise)) return {};
    const auto normal = [&](const Bern& u, const Bern& v) { return plus(mul(u, n[0]), v, n[1]); };
    const Bern f = plus(mul(plus(times(x, x), times(y, y)), k), times(w, normal(x, y)), -2),
               g = plus(mul(plus(times(x, dx), times(y, dy)), k), times(w, normal(dx, dy)), -1),
               turn = plus(mul(plus(times(x, dy), times(y, dx), -1), k),
                           times(w, plus(mul(dy, -n[0]), dx, n[1])));
    double distance = (largest(f) + 4 * noise * (1 + std::abs(k) * size)) / (least_w * least_w);
    if (!(distance * std::abs(k) < 0.5)) return {};
    distance /= k == 0 ? 2 : 1.5;
    for (const double c : turn)
        if (!(c > 0)) return {};
    const double sine = (largest(g) + 4 * noise * (1 + std::abs(k) * size)) /
                        (least_w * (1 - std::abs(k) * distance) * speed);
    if (!(sine < 0.1)) return {};
    return 1.01 * (distance + h * 1.002 * sine);
}

class ChainMaker {
public:
    ChainMaker(double half_width, double tolerance) : h_(half_width), tolerance_(tolerance) {}

    Result<ArcChain> run(const Subpath& subpath) && {
        std::vector<PathSegment> segments;
        for (PathSegment s : subpath.segments)
            if (const Box<2> box = box_of(s); box.lo != box.hi) segments.push_back(s);
        if (subpath.closed && !segments.empty() && segments.back().back() != subpath.start)
            segments.push_back({1, {segments.back().back(), subpath.start}, 1});
        const std::size_t n = segments.size();
        std::vector<Vec<2>> begin(n), end(n);
        std::vector<std::array<Bounded, 2>> bends(n);  // at the start and the end of each
        std::vector<bool> smooth(n, false);            // at the end of each
        for (std::size_t i = 0; i < n; ++i) {
            begin[i] = unit(end_tangent(segments[i], false));
            end[i] = unit(end_tangent(segments[i], true));
            bends[i] = {end_bend(segments[i]), -end_bend(reversed(segments[i]))};
        }
        for (std::size_t i = 0; i < n; ++i) {
            if (i + 1 == n && !subpath.closed) continue;
            const std::size_t k = (i + 1) % n;
            const double apart = h_ * norm(begin[k] - end[i]);
            if (!(apart <= tolerance_ / 16)) continue;
            smooth[i] = true;
            bend_ = std::max(bend_, 1.01 * apart);
            end[i] = begin[k];
        }
        out_.closed = subpath.closed;
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t previous = (i + n - 1) % n;
            joint_ = smooth[previous] ? PieceJoint::smooth : PieceJoint::corner;
            bends_ = {bends[previous][1], bends[i][0]};
            if (segments[i].degree == 1) {
                add({segments[i].points[0], segments[i].points[1], begin[i], begin[i], 0, {}});
                if (smooth[i]) out_.pieces.back().tb = end[i];
                continue;
            }
            if (const auto ok = approximate(segments[i], begin[i], end[i]); !ok)
                return std::unexpected(ok.error());
        }
        out_.bound += bend_;
        return std::move(out_);
    }

private:
    void add(const ArcPiece& piece) {
        out_.pieces.push_back(piece);
        out_.before.push_back(joint_);
        out_.bends.push_back(bends_);
        joint_ = PieceJoint::smooth;
    }
    static Vec<2> end_tangent(const PathSegment& s, bool at_end) {
        for (int i = 1; i <= s.degree; ++i) {
            const Vec<2> d = at_end ? s.back() - s.points[std::size_t(s.degree - i)]
                                    : s.points[std::size_t(i)] - s.front();
            if (max_abs(d) > 0) return d;
        }
        return {};
    }

    // The curvature at the start; 0 where the curve stands still there.
    static Bounded end_bend(const PathSegment& s) {
        if (s.degree == 1 || s.points[0] == s.points[1]) return 0;
        const auto side = [&](std::size_t i) {
            return BoundedVec<2>{Bounded(s.points[i + 1][0]) - Bounded(s.points[i][0]),
                                 Bounded(s.points[i + 1][1]) - Bounded(s.points[i][1])};
        };
        BoundedVec<2> d = side(0), next = side(1);
        const double size = std::ldexp(
            1.0,
            std::ilogb(std::max(std::abs(d[0].value), std::abs(d[1].value))));  // so that no power overflows
        for (BoundedVec<2>* v : {&d, &next})
            for (Bounded& x : *v) x = x / Bounded(size);
        const Bounded square = dot(d, d), w = s.degree == 2 ? s.weight : 1,
                      bend = Bounded(s.degree - 1) / Bounded(s.degree) * (d[0] * next[1] - d[1] * next[0]) /
                             (square * sqrt(square) * w * w * Bounded(size));
        return bend.is_finite() ? bend : 0;
    }

    struct Part {
        PathSegment s;
        Vec<2> begin, end;
        int depth;
        Still still;
        bool after_cusp = false;
    };
    Result<void> approximate(const PathSegment& whole, const Vec<2>& begin, const Vec<2>& end) {
        const double scale = box_of(whole).scale();
        std::vector<Part> stack{{whole, begin, end, 0, still_of(whole)}};
        while (!stack.empty()) {
            const Part part = stack.back();
            stack.pop_back();
            if (part.after_cusp) joint_ = PieceJoint::round;
            if (out_.pieces.size() > kMaxPieces)
                return refuse(RefusalKind::limit, "tolerance",
                              text("more than ", kMaxPieces, " arcs for a tolerance of ", tolerance_));
            if (take(part)) continue;
            const Box<2> box = box_of(part.s);
            const double size = norm(box.hi - box.lo);
            if (size < 0x1p-10 * tolerance_ && turn(part, size)) continue;
            if (size < 0x1p-20 * tolerance_ || part.depth == kMostHalvings || size < 0x1p-40 * scale) {
                if (size > tolerance_ / 4)
                    return refuse(RefusalKind::ill_conditioned, "tolerance",
                                  text(tolerance_, " is below what rounding leaves near (", part.s.front()[0],
                                       ", ", part.s.front()[1], ")"));
                turn_round(part, size);
                continue;
            }
            const Still before{part.still[0], 0}, after{0, part.still[1]};
            const PathSegment left = part_still(part.s, 0, 0.5, before);
            PathSegment right = part_still(part.s, 0.5, 1, after);
            right.points[0] = left.back();
            const Vec<2> middle = unit(tangent_of(part.s, 0.5));
            const bool cusp = max_abs(middle) == 0;  // exactly here
            stack.push_back({right, cusp ? unit(end_tangent(right, false)) : middle, part.end, part.depth + 1,
                             cusp ? still_of(right) : after, cusp});
            stack.push_back({left, part.begin, cusp ? unit(end_tangent(left, true)) : middle, part.depth + 1,
                             cusp ? still_of(left) : before, part.after_cusp});
        }
        return {};
    }

    // A part that is smaller than the tolerance, with a sharp bend: the pen turns on the spot.
    bool turn(const Part& part, double size) {
        const double slack = std::min(0.1, tolerance_ / (8 * h_));
        const Vec<2> middle = 0.5 * (part.s.front() + part.s.back());
        if (!turns_between(part, slack) || middle == part.s.front() || middle == part.s.back()) return false;
        out_.bound = std::max(out_.bound, 2 * size + 1.01 * h_ * slack);
        add({part.s.front(), middle, part.begin, part.begin, 0, {}});
        joint_ = PieceJoint::turn;
        add({middle, part.s.back(), part.end, part.end, 0, {}});
        return true;
    }

    // About a cusp, round.
    void turn_round(const Part& part, double size) {
        const Vec<2> d = part.s.back() - part.s.front();
        out_.bound = std::max(out_.bound, 2 * size);
        joint_ = PieceJoint::round;
        if (max_abs(d) == 0) return;
        const Vec<2> along = unit(d);
        add({part.s.front(), part.s.back(), along, along, 0, {}});
        joint_ = PieceJoint::round;
    }

    // Are all directions of the part between those of its ends, by less than a right angle, up to an angle of
    // sine `slack`? They are if all sides of the control polygon are, whose hull has those of a polynomial
    // curve.
    static bool turns_between(const Part& part, double slack) {
        if (part.s.weight != 1 || !(dot(part.begin, part.end) > 0)) return false;
        const double sign = cross(part.begin, part.end) < 0 ? -1 : 1,
                     noise = 0x1p-48 * box_of(part.s).scale();
        for (int i = 0; i < part.s.degree; ++i) {
            const Vec<2> side = part.s.points[std::size_t(i) + 1] - part.s.points[std::size_t(i)];
            const double least = -slack * norm(side) - noise;
            if (sign * cross(part.begin, side) < least || sign * cross(side, part.end) < least ||
                dot(part.begin, side) < least)
                return false;
        }
        return true;
    }

    bool take(const Part& part) {
        const Vec<2>&p = part.s.front(), &q = part.s.back();
        const Vec<2> v = q - p, t = part.begin + part.end;
        if (!(dot(part.begin, part.end) > 0.5) || !(dot(v, t) > 0)) return false;
        const double along = dot(v, t), square = dot(v, v), bend = 2 * (1 - dot(part.begin, part.end));
        const double d = square / (along + std::sqrt(along * along + bend * square));
        const Vec<2> from = p + d * part.begin, to = q - d * part.end, joint = 0.5 * (from + to),
                     direction = unit(to - from);
        if (!(dot(direction, v) > 0)) return false;
        // Where the curve passes the joint.
        Interval on{0, 1};
        for (int i = 0; i < 50; ++i)
            (dot(point_of(part.s, on.middle()) - joint, direction) < 0 ? on.lo : on.hi) = on.middle();
        const double at = on.middle();
        const ArcPiece first = arc_from(p, part.begin, joint, direction),
                       second = arc_from(joint, direction, q, part.end);
        const Still before{part.still[0], 0}, after{0, part.still[1]};
        const auto a = difference(part_still(part.s, 0, at, before), first, h_, before),
                   b = difference(part_still(part.s, at, 1, after), second, h_, after);
        if (!a || !b) return false;
        const double beside = std::abs(dot(point_of(part.s, at) - joint, direction)),
                     tight = std::max(std::abs(first.curvature), std::abs(second.curvature));
        const double bound = std::max(*a, *b) + 1.1 * (1 + h_ * tight) * beside;
        if (!(bound <= tolerance_ / 2)) return false;
        out_.bound = std::max(out_.bound, bound);
        add(first), add(second);
        return true;
    }

    double h_, tolerance_, bend_ = 0;
    ArcChain out_;
    PieceJoint joint_ = PieceJoint::smooth;
    std::array<Bounded, 2> bends_{};
};

}  // namespace

Result<ArcChain> arc_chain(const Subpath& subpath, double half_width, double tolerance) {
    return ChainMaker(half_width, tolerance).run(subpath);
}

}  // namespace freiform::detail
