// All places where arcs meet: pairs of boxes, then the certified intersections.
//
// Idea. intersect() answers with boxes in the parameters outside of which nothing meets. What the boxes of
// one contact contain is one place. Neighbours of a path meet at their joint; to ask for it in general would
// mean a tangent contact, a millisecond, at each smooth joint. If all of one arc lies before the joint in
// some direction and all of the other behind it, there is nothing to ask.
//
// Joints. With d a direction and p the joint, arc a ends and arc b begins at p. If the control polygon of a
// half of each arc at p is monotone in d, so are the halves, and they meet at p alone. The other half of a
// has all its control points before p, that of b behind p, by more than the rounding of halving. Then a and b
// meet at p alone.
//
// Pairs whose boxes overlap are mostly apart all the same: a line along one of the chords says so.
//
// Loops of cubics. The classification of cubics [Loop Blinn 2005]: with the determinants of three homogeneous
// control points a1 = |b0 b3 b2|, a2 = |b1 b0 b3|, a3 = |b2 b1 b0| and
//     d1 = a1 - 2 a2 + 3 a3,   d2 = 3 a3 - a2,   d3 = 3 a3,   q = 4 d1 d3 - 3 d2^2
// the curve has a double point of two real parameters if and only if d1 is not 0 and q > 0, which is decided
// exactly; the parameters are (d2 -+ sqrt q) / (2 d1), off by some 2^-98 of their terms in double-double.
//
// Equal segments share all of their length, and their cuts are carried over by the parameter.
//
// Accuracy. Cuts at ends of overlaps are rounded by intersect to the nearest doubles; kPad times the domain
// covers that, and the parameters of double points. What rounding leaves between places is united by the
// caller (arrangement.cpp).
//
#include "meetings_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/double_double.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/intersect/curve_curve.hpp>
#include <freiform/poly/exact.hpp>

#include <map>

namespace freiform::detail {

std::string place_text(const RegionArc& arc) {
    return text(arc.operand == 0 ? "a" : "b", ".subpaths[", arc.place[0], "].segments[", arc.place[1], "]");
}
std::string place_text(const Vec<2>& p) { return text("(", p[0], ", ", p[1], ")"); }

namespace {

constexpr double kPad = 0x1p-48;

template <class P>
Curve<P> bezier_curve(const RegionArc& arc) {
    std::vector<P> net;
    const auto h = homogeneous(arc.s);
    for (int i = 0; i <= arc.s.degree; ++i) {
        if constexpr (Space<P>::kRational)
            net.push_back(h[std::size_t(i)]);
        else
            net.push_back(arc.s.points[std::size_t(i)]);
    }
    const int n = int(net.size());
    return *Curve<P>::make({*BSplineBasis::bezier(arc.s.degree)}, Net<1, P>({n}, std::move(net)));
}

// dot products of the control points, from p, with d; after halving: those of the half at `end`, then those
// of the other one.
std::array<std::array<double, 4>, 2> halves_along(const PathSegment& s, int end, const Vec<2>& d) {
    auto h = homogeneous(s);
    const auto n = std::size_t(s.degree);
    const Vec<2> p = end == 0 ? s.front() : s.back();
    if (end == 1) std::reverse(h.begin(), h.begin() + s.degree + 1);
    auto other = h;
    for (std::size_t r = 1; r <= n; ++r)
        for (std::size_t i = n; i >= r; --i) h[i] = 0.5 * (h[i - 1] + h[i]);
    for (std::size_t r = 1; r <= n; ++r)
        for (std::size_t i = 0; i + r <= n; ++i) other[i] = 0.5 * (other[i] + other[i + 1]);
    std::array<std::array<double, 4>, 2> out{};
    for (std::size_t i = 0; i <= n; ++i)
        out[0][i] = dot(d, project(h[i]) - p), out[1][i] = dot(d, project(other[i]) - p);
    return out;
}

// Do the arcs meet at nothing but the joint, end `ea` of a and `eb` of b? No: not known.
bool meet_at_joint_only(const RegionArc& a, int ea, const RegionArc& b, int eb, double noise) {
    const Vec<2> in = tangent_of(a.s, ea), out = tangent_of(b.s, eb);
    // Both point from the joint into the arc; the direction halves the angle between -in and out.
    const Vec<2> d = unit((eb == 0 ? 1.0 : -1.0) * unit(out) - (ea == 0 ? 1.0 : -1.0) * unit(in));
    if (!(max_abs(d) > 0)) return false;
    const auto behind = [&](const RegionArc& arc, int end, double sign) {
        const auto along = halves_along(arc.s, end, sign * d);
        const auto n = std::size_t(arc.s.degree);
        for (std::size_t i = 1; i <= n; ++i)
            if (!(along[0][i] - along[0][i - 1] > noise) || !(along[1][i] > noise)) return false;
        return true;
    };
    return behind(a, ea, -1) && behind(b, eb, 1);
}

DoubleDouble rounded(const Exact& x) {
    const double hi = x.rounded();
    return {hi, (x - Exact(hi)).rounded()};
}

// Is there a line along one of the chords that has all control points of one arc on one side, and all of the
// other on the other side?
bool are_apart(const PathSegment& s, const PathSegment& t, double noise) {
    for (const PathSegment* along : {&s, &t}) {
        const Vec<2> chord = along->back() - along->front(), normal{{-chord[1], chord[0]}};
        const auto range = [&](const PathSegment& x) {
            Interval on{kInfinity, -kInfinity};
            for (int i = 0; i <= x.degree; ++i) {
                const double at = dot(normal, x.points[std::size_t(i)] - along->front());
                on = {std::min(on.lo, at), std::max(on.hi, at)};
            }
            return on;
        };
        const Interval a = range(s), b = range(t);
        const double slack = noise * (std::abs(chord[0]) + std::abs(chord[1]));
        if (a.hi + slack < b.lo || b.hi + slack < a.lo) return true;
    }
    return false;
}

// The parameters of the double point of a cubic, the smaller one first; may lie outside of [0, 1].
std::optional<std::array<double, 2>> double_point(const PathSegment& s) {
    const auto det = [&](std::size_t i, std::size_t j, std::size_t k) {
        const auto minus = [&](std::size_t l, int d) {
            return Exact(s.points[l][d]) - Exact(s.points[i][d]);
        };
        return minus(j, 0) * minus(k, 1) - minus(j, 1) * minus(k, 0);
    };
    const Exact a1 = det(0, 3, 2), a2 = det(1, 0, 3), a3 = det(2, 1, 0), d1 = a1 - a2 - a2 + Exact(3) * a3,
                d3 = Exact(3) * a3, d2 = d3 - a2, q = Exact(4) * d1 * d3 - Exact(3) * d2 * d2;
    if (d1.sign() == 0 || q.sign() <= 0) return {};
    // Scaled alike, so that nothing leaves the range of double.
    const int e = -d1.exponent();
    const DoubleDouble n = rounded(d2.scaled(e)), m = DoubleDouble(2) * rounded(d1.scaled(e)),
                       square = rounded(q.scaled(2 * e));
    DoubleDouble root(std::sqrt(square.hi));
    if (root.hi > 0) root = root + (square - root * root) / (DoubleDouble(2) * root);
    const double t = ((n - root) / m).rounded(), u = ((n + root) / m).rounded();
    return {{std::min(t, u), std::max(t, u)}};
}

bool is_same(const PathSegment& s, const PathSegment& t) {
    if (s.degree != t.degree || (s.degree == 2 && s.weight != t.weight)) return false;
    for (std::size_t i = 0; i <= std::size_t(s.degree); ++i)
        if (s.points[i] != t.points[i]) return false;
    return true;
}

Interval padded(double t) { return {std::max(0.0, t - kPad), std::min(1.0, t + kPad)}; }

// Where two lines cross, right to the last bit but for ties.
Vec<2> crossing_of_lines(const PathSegment& s, const PathSegment& t) {
    const auto minus = [](double a, double b) { return DoubleDouble(a) - DoubleDouble(b); };
    const Vec<2>&a = s.points[0], &b = s.points[1], &c = t.points[0], &d = t.points[1];
    const DoubleDouble ex = minus(b[0], a[0]), ey = minus(b[1], a[1]), fx = minus(d[0], c[0]),
                       fy = minus(d[1], c[1]);
    const DoubleDouble at = (minus(c[0], a[0]) * fy - minus(c[1], a[1]) * fx) / (ex * fy - ey * fx);
    return {{(DoubleDouble(a[0]) + at * ex).rounded(), (DoubleDouble(a[1]) + at * ey).rounded()}};
}

class Finder {
public:
    Finder(std::span<const RegionArc> arcs, const ArcTree& tree, double accuracy, std::size_t max_pairs)
        : arcs_(arcs), tree_(tree), accuracy_(accuracy), max_pairs_(max_pairs) {
        for (const RegionArc& a : arcs) scale_ = std::max(scale_, a.box.scale());
    }
    Result<Meetings> run() && {
        add_ends();
        for (std::size_t i = 0; i < arcs_.size(); ++i) add_loop_of(i);
        const auto pairs = pairs_to_ask();
        if (!pairs) return std::unexpected(pairs.error());
        if (const auto ok = ask<Vec<2>>(pairs->plain); !ok) return std::unexpected(ok.error());
        if (const auto ok = ask<Hom<2>>(pairs->rational); !ok) return std::unexpected(ok.error());
        return std::move(out_);
    }

private:
    using Pair = std::array<std::size_t, 2>;
    struct Pairs {
        std::vector<Pair> plain, rational;
    };

    void add_ends() {
        std::map<std::array<double, 2>, int> known;
        out_.cuts.resize(arcs_.size());
        for (std::size_t i = 0; i < arcs_.size(); ++i)
            for (int end = 0; end < 2; ++end) {
                const Vec<2>& p = end == 0 ? arcs_[i].s.front() : arcs_[i].s.back();
                const auto [at, is_new] = known.try_emplace(p.c, 0);
                if (is_new) at->second = out_.places.add(0, p);
                out_.cuts[i].push_back({{double(end), double(end)}, at->second});
            }
    }

    void add_loop_of(std::size_t i) {
        if (arcs_[i].s.degree < 3) return;
        const auto at = double_point(arcs_[i].s);
        if (!at || (*at)[0] < -kPad || (*at)[1] > 1 + kPad) return;
        const int place = out_.places.add(2, point_of(arcs_[i].s, clamped((*at)[0], {0, 1})));
        for (const double t : *at) out_.cuts[i].push_back({padded(t), place});
    }

    Result<Pairs> pairs_to_ask() {
        Pairs out;
        std::size_t looked = 0;
        const auto look = [&](std::size_t i, std::size_t j) {
            consider({std::min(i, j), std::max(i, j)}, out);
            return out.plain.size() + out.rational.size() <= max_pairs_;
        };
        const auto step = [&] { return looked++ <= 100 * max_pairs_; };
        if (!tree_.each_pair(look, step))
            return refuse(RefusalKind::limit, "max_pairs",
                          text("more than ", max_pairs_, " pairs of segments may meet"));
        sort(out.plain), sort(out.rational);
        return out;
    }
    void consider(const Pair& pair, Pairs& out) {
        const RegionArc &a = arcs_[pair[0]], &b = arcs_[pair[1]];
        if (are_apart(a.s, b.s, 0x1p-47 * scale_) || is_settled(pair)) return;
        (a.is_rational() || b.is_rational() ? out.rational : out.plain).push_back(pair);
    }

    // Equal segments, and neighbours that meet at one common end and nowhere else.
    bool is_settled(const Pair& pair) {
        const RegionArc &a = arcs_[pair[0]], &b = arcs_[pair[1]];
        for (const bool against : {false, true})
            if (is_same(a.s, against ? reversed(b.s) : b.s)) {
                out_.shared.push_back({pair[0], pair[1], {0, 1}, {0, 1}, against, 0, true});
                return true;
            }
        int ea = -1, eb = -1, common = 0;
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j)
                if ((i == 0 ? a.s.front() : a.s.back()) == (j == 0 ? b.s.front() : b.s.back()))
                    ea = i, eb = j, ++common;
        return common == 1 && meet_at_joint_only(a, ea, b, eb, 0x1p-48 * scale_);
    }

    template <class P>
    Result<void> ask(const std::vector<Pair>& pairs) {
        constexpr std::size_t kChunk = 8192;
        std::vector<std::optional<IntersectCurve<P>>> prepared(pairs.empty() ? 0 : arcs_.size());
        std::vector<IntersectCurve<P>> a, b;
        std::vector<Intersections<2, 2>> found;
        for (std::size_t from = 0; from < pairs.size(); from += kChunk) {
            const auto chunk = std::span(pairs).subspan(from, std::min(kChunk, pairs.size() - from));
            a.clear(), b.clear();
            for (const Pair& p : chunk)
                for (std::size_t k = 0; k < 2; ++k) {
                    auto& curve = prepared[p[k]];
                    if (!curve) curve.emplace(bezier_curve<P>(arcs_[p[k]]));
                    (k == 0 ? a : b).push_back(*curve);
                }
            found.assign(chunk.size(), {});
            const auto ok = intersect<P>(a, b, found, {.accuracy = accuracy_});
            if (!ok) return ok;
            for (std::size_t k = 0; k < chunk.size(); ++k)
                if (const auto taken = take(chunk[k], found[k]); !taken) return taken;
        }
        return {};
    }

    Result<void> take(const Pair& pair, const Intersections<2, 2>& found) {
        const RegionArc &a = arcs_[pair[0]], &b = arcs_[pair[1]];
        if (!found.undecided.empty())
            return refuse(RefusalKind::ill_conditioned, place_text(a),
                          text("and ", place_text(b), " come so near to each other near ",
                               place_text(point_of(a.s, found.undecided[0][0].middle())),
                               " that where they meet is not told"));
        const bool lines = a.s.degree == 1 && b.s.degree == 1;
        for (const auto& c : found.contacts) {
            const bool proven = lines && c.is_proven() && c.kind == ContactKind::crossing;
            const int place = out_.places.add(proven ? 1 : 2, proven ? crossing_of_lines(a.s, b.s) : c.point);
            out_.cuts[pair[0]].push_back({hull(c.box[0], {c.at[0], c.at[0]}), place});
            out_.cuts[pair[1]].push_back({hull(c.box[1], {c.at[1], c.at[1]}), place});
        }
        for (const Overlap& o : found.overlaps) {
            out_.shared.push_back({pair[0], pair[1], o.a, o.b, o.reversed, o.gap});
            for (int end = 0; end < 2; ++end) {
                const double s = end == 0 ? o.a.lo : o.a.hi, t = (end == 0) != o.reversed ? o.b.lo : o.b.hi;
                const int place = out_.places.add(2, point_of(a.s, s));
                out_.cuts[pair[0]].push_back({padded(s), place});
                out_.cuts[pair[1]].push_back({padded(t), place});
            }
        }
        return {};
    }

    std::span<const RegionArc> arcs_;
    const ArcTree& tree_;
    double accuracy_;
    std::size_t max_pairs_;
    double scale_ = 0;
    Meetings out_;
};

}  // namespace

Result<Meetings> meetings_of(std::span<const RegionArc> arcs, const ArcTree& tree, double accuracy,
                             std::size_t max_pairs) {
    return Finder(arcs, tree, accuracy, max_pairs).run();
}

}  // namespace freiform::detail
