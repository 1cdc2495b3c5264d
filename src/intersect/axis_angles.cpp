// Angles of arcs of ellipses; axis_angles_detail.hpp is the essay.
#include "axis_angles_detail.hpp"

#include <algorithm>
#include <cmath>

namespace freiform::detail {

namespace {

constexpr double kOneWeight = 0x1p-42;  // relative, of the weights of rows
constexpr double kFlat = 0x1p-20;       // a piece with a smaller half angle is none

struct ArcWeights {
    double cosine = 0, ratio = 0;
};

}  // namespace

AxisAngles AxisAngles::identity(const Surface<Hom<3>>& surface, int axis) {
    AxisAngles out;
    out.breaks_ = BezierPieces<2, Hom<3>>(surface).breaks(axis);
    return out;
}

AxisAngles AxisAngles::of(const Surface<Hom<3>>& surface, int axis) {
    const BezierPieces<2, Hom<3>> pieces(surface);
    AxisAngles out;
    out.breaks_ = pieces.breaks(axis);
    if (pieces.degree(axis) != 2) return out;
    const std::size_t along = std::size_t(axis), across = 1 - along;
    std::vector<Arc> arcs;
    double angle = 0;
    for (int i = 0; i < pieces.extent()[along]; ++i) {
        std::optional<ArcWeights> all;
        for (int j = 0; j < pieces.extent()[across]; ++j)
            for (int row = 0; row <= pieces.degree(int(across)); ++row) {
                Index<2> at{};
                at[along] = i, at[across] = j;
                const auto net = pieces.net(at);
                std::array<double, 3> w{};
                for (int n = 0; n < 3; ++n) {
                    Index<2> c{};
                    c[along] = n, c[across] = row;
                    w[std::size_t(n)] = net(c).weight();
                }
                const ArcWeights own{w[1] / (std::sqrt(w[0]) * std::sqrt(w[2])), std::sqrt(w[2] / w[0])};
                if (!all) all = own;
                if (!(std::abs(own.cosine - all->cosine) <= kOneWeight) ||
                    !(std::abs(own.ratio - all->ratio) <= kOneWeight * own.ratio))
                    return out;
            }
        const double half = std::acos(std::min(all->cosine, 1.0));
        if (!(half > kFlat)) return out;
        arcs.push_back({angle, half, std::tan(half / 2), all->ratio});
        angle += 2 * half;
    }
    out.pieces_ = std::move(arcs);
    return out;
}

std::size_t AxisAngles::piece_of(double s) const {
    const auto next = std::upper_bound(breaks_.begin(), breaks_.end(), s);
    return std::size_t(
        std::clamp<std::ptrdiff_t>(next - breaks_.begin() - 1, 0, std::ptrdiff_t(breaks_.size()) - 2));
}

double AxisAngles::at(double s) const {
    if (is_identity()) return s;
    const std::size_t i = piece_of(s);
    const Arc& arc = pieces_[i];
    const double tau = clamped((s - breaks_[i]) / (breaks_[i + 1] - breaks_[i]), {0, 1});
    if (tau == 0) return arc.from;
    if (tau == 1) return arc.from + 2 * arc.half;
    const double moved = arc.ratio * tau / (1 - tau + arc.ratio * tau);
    return arc.from + arc.half + 2 * std::atan(arc.k * (2 * moved - 1));
}

double AxisAngles::slope(double s) const {
    if (is_identity()) return 1;
    const std::size_t i = piece_of(s);
    const Arc& arc = pieces_[i];
    const double width = breaks_[i + 1] - breaks_[i], tau = clamped((s - breaks_[i]) / width, {0, 1});
    const double below = 1 - tau + arc.ratio * tau, v = 2 * arc.ratio * tau / below - 1;
    return 4 * arc.k / (1 + arc.k * arc.k * v * v) * arc.ratio / (below * below) / width;
}

double AxisAngles::inverse(double x) const {
    if (is_identity()) return x;
    std::size_t i = 0;
    while (i + 1 < pieces_.size() && pieces_[i + 1].from <= x) ++i;
    const Arc& arc = pieces_[i];
    const double v = std::tan(clamped((x - arc.from - arc.half) / 2, {-arc.half / 2, arc.half / 2})) / arc.k;
    const double moved = clamped(0.5 + 0.5 * v, {0, 1}), tau = moved / (arc.ratio * (1 - moved) + moved);
    if (moved == 0) return breaks_[i];
    if (moved == 1) return breaks_[i + 1];
    return clamped(breaks_[i] + tau * (breaks_[i + 1] - breaks_[i]), {breaks_[i], breaks_[i + 1]});
}

Interval AxisAngles::over(const Interval& s) const {
    const double slack = kSlack * range().length();
    return {at(s.lo) - slack, at(s.hi) + slack};
}

Interval AxisAngles::inverse_over(const Interval& x) const {
    const double slack = kSlack * (breaks_.back() - breaks_.front());
    return {inverse(x.lo) - slack, inverse(x.hi) + slack};
}

}  // namespace freiform::detail
