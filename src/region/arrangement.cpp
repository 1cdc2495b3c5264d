// From the places where arcs meet to edges and bundles.
//
// Idea. What cannot be told apart becomes one place: cuts of an arc that overlap, and the parts between cuts
// that are smaller than rounding. A place may so contain several contacts and short parts of arcs; it is
// drawn together to one point. That is harmless as long as it is small: the boundary of a region is a sum of
// edges in which every place begins as often as it ends, and leaving out edges that begin and end at one
// place keeps that so. The loops that are left wind round every point outside of what was drawn together as
// before.
//
// Shared stretches. Both arcs are cut wherever one of them is: a cut is carried over to the nearest parameter
// of the other one, where it meets a cut that is there for the same reason. Then the edges of both go in
// pairs, which become bundles. If they do not, the arcs are too near to each other to tell.
//
// Lenses. Two arcs may cross twice, at proven places, with less than rounding between them: edges between the
// same places whose control points differ by less than kTwin of the coordinates are a bundle, too.
//
// Accuracy. `moved` bounds the distance from the point of a place to all that belongs to it, by boxes of
// control points, and the gaps of bundles.
#include "arrangement_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>

#include <cmath>
#include <tuple>

namespace freiform::detail {

namespace {

// Parts of arcs that are smaller than this times the largest coordinate are drawn together.
constexpr double kSmallest = 0x1p-44;
constexpr double kCarryPad = 0x1p-48;
// So are parts that begin and end at one place, below this times the tolerance.
constexpr double kLoop = 0x1p-10;
// Edges between the same places may be called the same this times the largest coordinate apart.
constexpr double kTwin = 0x1p-42;

// The parameter in `on` nearest to p, by halving; an estimate.
double nearest_parameter(const PathSegment& s, Interval on, const Vec<2>& p) {
    for (int i = 0; i < 60; ++i) {
        const double t = on.middle();
        (dot(point_of(s, t) - p, tangent_of(s, t)) < 0 ? on.lo : on.hi) = t;
    }
    return on.middle();
}

void carry_over(std::span<const RegionArc> arcs, Meetings& m) {
    struct New {
        std::size_t arc;
        Cut cut;
    };
    std::vector<New> fresh;
    const auto carry = [&](std::size_t i, Interval a, std::size_t j, Interval b, const SharedStretch& s) {
        for (const Cut& c : m.cuts[i]) {
            if (s.equal) {
                fresh.push_back({j, {s.reversed ? Interval{1 - c.at.hi, 1 - c.at.lo} : c.at, c.place}});
                continue;
            }
            const double t = c.at.middle();
            if (!(a.lo < t && t < a.hi)) continue;
            const double u = nearest_parameter(arcs[j].s, b, point_of(arcs[i].s, t));
            if (b.lo < u && u < b.hi)
                fresh.push_back({j, {{std::max(0.0, u - kCarryPad), std::min(1.0, u + kCarryPad)}, c.place}});
        }
    };
    for (const SharedStretch& s : m.shared) carry(s.i, s.a, s.j, s.b, s), carry(s.j, s.b, s.i, s.a, s);
    for (const New& n : fresh) m.cuts[n.arc].push_back(n.cut);
}

class Arranger {
public:
    Arranger(std::vector<RegionArc> arcs, const Nearness& near, const RegionOptions& options)
        : out_{std::move(arcs), ArcTree(), {}, {}, {}, 0, 0}, near_(near), options_(options) {}

    Result<Arrangement> run() && {
        for (const RegionArc& a : out_.arcs) out_.scale = std::max(out_.scale, a.box.scale());
        if (!(options_.tolerance > 4 * kSmallest * out_.scale))
            return refuse(RefusalKind::ill_conditioned, "tolerance",
                          text(options_.tolerance, " is below the rounding of coordinates up to ", out_.scale,
                               "; it must be above ", 4 * kSmallest * out_.scale));
        out_.tree = ArcTree(out_.arcs);
        auto m = meetings_of(out_.arcs, out_.tree, near_.accuracy, options_.max_pairs);
        if (!m) return std::unexpected(m.error());
        carry_over(out_.arcs, *m);
        for (std::size_t i = 0; i < out_.arcs.size(); ++i) unite_cuts(i, *m);
        for (std::size_t i = 0; i < out_.arcs.size(); ++i) close_short_loops(i, *m);
        if (const auto ok = measure(*m); !ok) return std::unexpected(ok.error());
        add_edges(*m);
        for (const SharedStretch& s : m->shared)
            if (const auto ok = bundle(s); !ok) return std::unexpected(ok.error());
        bundle_twins();
        finish_bundles();
        return std::move(out_);
    }

private:
    void unite_cuts(std::size_t i, Meetings& m) {
        std::vector<Cut>& cuts = m.cuts[i];
        sort(cuts, {}, [](const Cut& c) { return std::pair(c.at.lo, c.at.hi); });
        std::vector<Cut> united;
        for (const Cut& c : cuts) {
            if (!united.empty()) {
                Cut& last = united.back();
                const bool touch = c.at.lo <= last.at.hi;
                const Box<2> between =
                    touch ? Box<2>{} : box_of(part_of(out_.arcs[i].s, last.at.hi, c.at.lo));
                if (touch ||
                    norm(between.hi - between.lo) <= std::max(near_.smallest, kSmallest * out_.scale)) {
                    m.places.unite(last.place, c.place);
                    last.at = hull(last.at, c.at);
                    continue;
                }
            }
            united.push_back(c);
        }
        cuts = std::move(united);
    }

    // Of an arc that leaves a place and comes back to it at once: two cuts that others have united.
    void close_short_loops(std::size_t i, Meetings& m) const {
        std::vector<Cut> closed;
        for (const Cut& c : m.cuts[i]) {
            if (!closed.empty() && m.places.find(closed.back().place) == m.places.find(c.place)) {
                Cut& last = closed.back();
                const Box<2> between = box_of(part_of(out_.arcs[i].s, last.at.hi, c.at.lo));
                if (norm(between.hi - between.lo) <= std::max(near_.smallest, kLoop * options_.tolerance)) {
                    last.at = hull(last.at, c.at);
                    continue;
                }
            }
            closed.push_back(c);
        }
        m.cuts[i] = std::move(closed);
    }

    // How far what belongs to a place is from its point.
    Result<void> measure(Meetings& m) {
        for (std::size_t i = 0; i < out_.arcs.size(); ++i)
            for (Cut& c : m.cuts[i]) {
                c.place = m.places.find(c.place);
                const Vec<2> p = m.places.point(c.place);
                const Box<2> box = box_of(part_of(out_.arcs[i].s, c.at.lo, c.at.hi));
                for (int corner = 0; corner < 4; ++corner) {
                    const Vec<2> q{{corner & 1 ? box.hi[0] : box.lo[0], corner & 2 ? box.hi[1] : box.lo[1]}};
                    out_.moved = std::max(out_.moved, norm(p - q));
                }
                if (2 * out_.moved + kSmallest * out_.scale > options_.tolerance)
                    return refuse(
                        RefusalKind::ill_conditioned, place_text(out_.arcs[i]),
                        text("and ", other_at(m, c.place, i), " are so near to each other near ",
                             place_text(p), ", over ", out_.moved,
                             ", that they are not told apart; the tolerance is ", options_.tolerance));
            }
        for (std::size_t k = 0; k < m.places.size(); ++k) out_.places.push_back(m.places.point(int(k)));
        for (const SharedStretch& s : m.shared) {
            out_.moved = std::max(out_.moved, s.gap);
            if (2 * s.gap + kSmallest * out_.scale > options_.tolerance)
                return refuse(RefusalKind::ill_conditioned, place_text(out_.arcs[s.i]),
                              text("runs along ", place_text(out_.arcs[s.j]), " at most ", s.gap,
                                   " away; the tolerance is ", options_.tolerance));
        }
        return {};
    }

    // Another arc through the place.
    std::string other_at(Meetings& m, int place, std::size_t than) const {
        for (std::size_t i = 0; i < out_.arcs.size(); ++i)
            if (i != than && std::ranges::any_of(m.cuts[i], [&](const Cut& c) {
                    return m.places.find(c.place) == m.places.find(place);
                }))
                return place_text(out_.arcs[i]);
        return "itself";
    }

    void add_edges(const Meetings& m) {
        first_.assign(out_.arcs.size() + 1, 0);
        for (std::size_t i = 0; i < out_.arcs.size(); ++i) {
            const std::vector<Cut>& cuts = m.cuts[i];
            for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
                RegionEdge e;
                e.arc = i, e.number = k, e.bundle = out_.edges.size();
                e.on = {cuts[k].at.hi, cuts[k + 1].at.lo};
                if (k == 0 && cuts[k].at.lo == 0) e.on.lo = 0;
                if (k + 2 == cuts.size() && cuts[k + 1].at.hi == 1) e.on.hi = 1;
                e.from = cuts[k].place, e.to = cuts[k + 1].place;
                out_.edges.push_back(e);
            }
            first_[i + 1] = out_.edges.size();
        }
        root_.resize(out_.edges.size());
        for (std::size_t e = 0; e < root_.size(); ++e) root_[e] = {e, 1};
    }

    std::pair<std::size_t, int> root(std::size_t e) const {
        int sign = 1;
        while (root_[e].first != e) sign *= root_[e].second, e = root_[e].first;
        return {e, sign};
    }

    Result<void> bundle(const SharedStretch& s) {
        const auto inside = [&](std::size_t arc, Interval on) {
            std::vector<std::size_t> edges;
            for (std::size_t e = first_[arc]; e < first_[arc + 1]; ++e) {
                const double t = out_.edges[e].on.middle();
                if (on.lo < t && t < on.hi) edges.push_back(e);
            }
            return edges;
        };
        const auto a = inside(s.i, s.a);
        auto b = inside(s.j, s.b);
        if (s.reversed) std::ranges::reverse(b);
        bool same = a.size() == b.size();
        for (std::size_t k = 0; same && k < a.size(); ++k) {
            const RegionEdge &x = out_.edges[a[k]], &y = out_.edges[b[k]];
            same = s.reversed ? x.from == y.to && x.to == y.from : x.from == y.from && x.to == y.to;
            if (!same) break;
            const auto [p, sp] = root(a[k]);
            const auto [q, sq] = root(b[k]);
            if (p != q) root_[std::max(p, q)] = {std::min(p, q), sp * sq * (s.reversed ? -1 : 1)};
            out_.edges[a[k]].gap = std::max(x.gap, s.gap);
        }
        if (!same)
            return refuse(RefusalKind::ill_conditioned, place_text(out_.arcs[s.i]),
                          text("and ", place_text(out_.arcs[s.j]), " run along each other near ",
                               place_text(point_of(out_.arcs[s.i].s, s.a.middle())),
                               ", and where others cross them is not told"));
        return {};
    }

    // Edges between the same two places, as near to each other as rounding or as what may be called the same:
    // between places that are proven, lenses are longer than the tolerance and thinner than numbers.
    void bundle_twins() {
        std::vector<std::array<std::size_t, 3>> between;
        for (std::size_t e = 0; e < out_.edges.size(); ++e) {
            const RegionEdge& x = out_.edges[e];
            if (x.from != x.to && !out_.arcs[x.arc].is_rational())
                between.push_back(
                    {std::size_t(std::min(x.from, x.to)), std::size_t(std::max(x.from, x.to)), e});
        }
        sort(between);
        const double most = std::max(near_.accuracy, kTwin * out_.scale);
        for (std::size_t i = 0; i < between.size(); ++i)
            for (std::size_t k = i + 1;
                 k < between.size() && between[k][0] == between[i][0] && between[k][1] == between[i][1];
                 ++k) {
                const std::size_t a = between[i][2], b = between[k][2];
                const auto [p, sp] = root(a);
                const auto [q, sq] = root(b);
                const double gap = p == q ? kInfinity : apart(a, b);
                if (!(gap <= most) || 2 * gap + kSmallest * out_.scale > options_.tolerance) continue;
                const int against = out_.edges[a].from == out_.edges[b].from ? 1 : -1;
                root_[std::max(p, q)] = {std::min(p, q), sp * sq * against};
                out_.edges[a].gap = std::max(out_.edges[a].gap, gap);
                out_.moved = std::max(out_.moved, gap);
            }
    }

    // A bound of the distance of points of equal parameters of two edges between the same places: that of
    // control points of one degree, and the rounding of parts.
    double apart(std::size_t a, std::size_t b) const {
        const auto part = [&](const RegionEdge& e, bool against) {
            PathSegment s = part_of(out_.arcs[e.arc].s, e.on.lo, e.on.hi);
            if (against) s = reversed(s);
            for (; s.degree < 3; ++s.degree) {
                const double n = s.degree + 1;
                auto raised = s.points;
                raised[std::size_t(n)] = s.back();
                for (std::size_t i = 1; i <= std::size_t(s.degree); ++i)
                    raised[i] = (double(i) / n) * s.points[i - 1] + (1 - double(i) / n) * s.points[i];
                s.points = raised;
            }
            return s;
        };
        const RegionEdge &x = out_.edges[a], &y = out_.edges[b];
        const PathSegment s = part(x, false), t = part(y, x.from != y.from);
        double most = 0;
        for (std::size_t i = 0; i < 4; ++i) most = std::max(most, norm(s.points[i] - t.points[i]));
        return most + 4 * kPartError * out_.scale;
    }

    void finish_bundles() {
        out_.members.resize(out_.edges.size());
        for (std::size_t e = 0; e < out_.edges.size(); ++e) {
            RegionEdge& edge = out_.edges[e];
            std::tie(edge.bundle, edge.sign) = root(e);
            out_.members[edge.bundle].push_back(e);
            RegionEdge& first = out_.edges[edge.bundle];
            first.jump[std::size_t(out_.arcs[edge.arc].operand)] += edge.sign;
            first.gap = std::max(first.gap, edge.gap);
        }
    }

    Arrangement out_;
    Nearness near_;
    const RegionOptions& options_;
    std::vector<std::size_t> first_;                 // edge of each arc
    std::vector<std::pair<std::size_t, int>> root_;  // forest of bundles, with orientation
};

}  // namespace

Result<Arrangement> arrange(std::vector<RegionArc> arcs, const Nearness& near, const RegionOptions& options) {
    return Arranger(std::move(arcs), near, options).run();
}

}  // namespace freiform::detail
