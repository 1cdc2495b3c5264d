// Neighbouring Bezier pieces of a spline begin and end in the same numbers, unless the spline jumps there:
// what they have in common was computed twice, and rounded.
#include "trim/chain_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::detail {

namespace {

Hom<2> lift(const Vec<2>& p) { return weighted(p, 1); }
Hom<2> lift(const Hom<2>& p) { return p; }

template <class P>
void append(std::vector<ChainPiece>& chain, const Curve<P>& c, std::size_t curve) {
    const auto pieces = decompose(c);
    const int count = pieces.extent()[0];
    std::vector<std::vector<P>> nets;
    for (int i = 0; i < count; ++i) {
        const auto net = pieces.net({i});
        nets.emplace_back(net.data, net.data + net.extent[0]);
        const double at = pieces.breaks(0)[std::size_t(i)];
        if (i > 0 && c.basis().multiplicity(at) <= c.basis().degree())
            nets.back().front() = nets[std::size_t(i) - 1].back();
    }
    if (c.basis().is_closed() && c.basis().multiplicity(c.basis().domain().lo) <= c.basis().degree())
        nets.front().front() = nets.back().back();
    for (auto& net : nets) chain.push_back({std::move(net), curve});
}

// An estimate: how far from each other rounding may have brought two ends that were one point: coordinates
// times weights are rounded, and so is the end of a spline whose knots are not clamped.
template <class P>
double end_rounding(const Curve<P>& c) {
    const BSplineBasis& b = c.basis();
    const int p = b.degree();
    const bool clamped = b.multiplicity(b.domain().lo) >= p && b.multiplicity(b.domain().hi) >= p;
    double size = 0;
    for (const P& x : c.net().flat()) size = std::max(size, max_abs(Space<P>::project(x)));
    return (clamped ? 0 : 12 * p + 8) * kUnitRoundoff * size +
           (Space<P>::kRational ? 4 : 0) * kUnitRoundoff * size;
}

}  // namespace

Hom<2> ChainPiece::start() const {
    return visit_one([](const auto& n) { return lift(n.front()); }, net);
}
Hom<2> ChainPiece::end() const {
    return visit_one([](const auto& n) { return lift(n.back()); }, net);
}
std::vector<Hom<2>> ChainPiece::lifted() const {
    std::vector<Hom<2>> all;
    visit_one(
        [&](const auto& n) {
            for (const auto& p : n) all.push_back(lift(p));
        },
        net);
    return all;
}

const Conic<2>* ellipse_of(const std::vector<CurveGeometry<2>>& loop) {
    if (loop.size() != 1) return nullptr;
    const auto* conic = std::get_if<Conic<2>>(&loop[0]);
    return conic && conic->kind == ConicKind::ellipse ? conic : nullptr;
}

Result<std::vector<ChainPiece>> chain_of(const std::vector<CurveGeometry<2>>& loop, double gap) {
    std::vector<ChainPiece> chain;
    if (loop.empty()) return refuse(RefusalKind::invalid, "", "has no curves");
    std::vector<double> rounding;  // of the ends of each curve
    for (std::size_t c = 0; c < loop.size(); ++c) {
        const std::string at = text("[", c, "]");
        if (auto ok = check(loop[c]); !ok) return refuse_within(at, ok.error());
        if (ellipse_of(loop)) return chain;
        if (const auto* s = std::get_if<Curve<Vec<2>>>(&loop[c]))
            append(chain, *s, c), rounding.push_back(end_rounding(*s));
        else if (const auto* r = std::get_if<Curve<Hom<2>>>(&loop[c]))
            append(chain, *r, c), rounding.push_back(end_rounding(*r));
        else
            return refuse(
                RefusalKind::unsupported, at,
                text("is a ", kind_name(loop[c]), "; a loop is made of splines, or is one ellipse"));
    }
    for (std::size_t i = 0; i < chain.size(); ++i) {
        const ChainPiece& next = chain[(i + 1) % chain.size()];
        const Hom<2> end = chain[i].end(), start = next.start();
        if (end == start) continue;
        const Vec<2> p = project(end), q = project(start);
        const double allowed = gap + std::sqrt(2.0) * (rounding[chain[i].curve] + rounding[next.curve]);
        if (const double distance = norm(q - p); !(distance <= allowed))
            return refuse(RefusalKind::invalid, "",
                          text("the loop is open: from the end of piece ", i, " at (", p[0], ", ", p[1],
                               ") to the start of the next it is ", distance, ", allowed is ", gap));
    }
    return chain;
}

}  // namespace freiform::detail
