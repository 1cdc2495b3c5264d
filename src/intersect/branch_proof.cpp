// The bound of branches; branch_proof_detail.hpp is the essay.
#include "branch_proof_detail.hpp"

namespace freiform::detail {

namespace {

// Hardly ever is a piece that is good proven to be so in fewer than four parts; and bounds of derivatives,
// which take most of the time, are as good over two parts as over one.
constexpr int kDeepestHalf = 20, kMostHalves = 400, kFirstHalf = 2;

// What the surface is along an axis where it is a spline there.
const BSplineBasis* basis_along(const SurfaceGeometry& g, int axis) {
    const auto of_curve = [](const CurveGeometry<3>& c) -> const BSplineBasis* {
        if (const auto* s = std::get_if<Curve<Vec<3>>>(&c)) return &s->basis();
        if (const auto* s = std::get_if<Curve<Hom<3>>>(&c)) return &s->basis();
        return nullptr;
    };
    if (const auto* s = std::get_if<Surface<Vec<3>>>(&g)) return &s->basis(axis);
    if (const auto* s = std::get_if<Surface<Hom<3>>>(&g)) return &s->basis(axis);
    if (const auto* s = std::get_if<Extrusion>(&g)) return axis == 0 ? of_curve(s->profile) : nullptr;
    if (const auto* s = std::get_if<Revolution>(&g)) return axis == 1 ? of_curve(s->profile) : nullptr;
    return nullptr;
}
std::vector<double> lines_of_jumps(const SurfaceGeometry& g, int axis) {
    std::vector<double> out;
    const BSplineBasis* basis = basis_along(g, axis);
    if (!basis) return out;
    const auto breaks = basis->breaks();
    for (std::size_t i = 1; i + 1 < breaks.size(); ++i)
        if (basis->multiplicity(breaks[i]) >= basis->degree() - 1) out.push_back(breaks[i]);
    return out;
}

}  // namespace

BranchProof::BranchProof(const SurfaceGeometry& geometry, const Sheet& sheet)
    : query_(geometry), sheet_(&sheet), domain_(sheet.domain()), error_(sheet.inner_error()) {
    for (int k = 0; k < 2; ++k) stops_[std::size_t(k)] = lines_of_jumps(geometry, k);
}

BranchProof::BranchProof(const SurfaceGeometry& geometry, const std::array<Interval, 2>& domain)
    : query_(geometry), domain_(domain), error_(value_error_bound(geometry, domain)) {
    for (int k = 0; k < 2; ++k) stops_[std::size_t(k)] = lines_of_jumps(geometry, k);
}

BranchProof::Sample BranchProof::sample(const Vec<3>& x, const Vec<2>& u) const {
    const Vec<3> p = sheet_ ? sheet_->at(u[0], u[1]).point : jet<0>(query_.geometry(), u.c).value();
    const double scale = std::max(max_abs(x), sheet_ ? sheet_->scale() : max_abs(p));
    return {x - p, 1.8 * (error_ + 64 * kUnitRoundoff * scale)};
}

std::optional<double> BranchProof::operator()(const CubicArc<Vec<3>>& c, const CubicArc<Vec<2>>& q,
                                              double tolerance) const {
    tolerance_ = tolerance, most_ = 0, parts_ = 0;
    const auto inside = [&](const Vec<2>& u) { return contains(u); };
    if (!inside(q[0]) || !inside(q[3])) return std::nullopt;
    if (!prove(c, q, sample(c[0], q[0]), sample(c[3], q[3]), 0, nullptr)) return std::nullopt;
    return most_;
}

bool BranchProof::prove(const CubicArc<Vec<3>>& c, const CubicArc<Vec<2>>& q, const Sample& a,
                        const Sample& b, int depth, const Bending* over) const {
    const auto [c0, c1] = arc_halves(c);
    const auto [q0, q1] = arc_halves(q);
    if (!contains(q0[3])) return false;
    const Sample m = sample(c0[3], q0[3]);
    if (std::max({a.size(), m.size(), b.size()}) > tolerance_) return false;
    std::optional<Bending> own;
    if (depth >= kFirstHalf) {
        const auto path = speeds_of(q, domain_);
        if (!path) return false;
        if (!over) over = &own.emplace(bending(path->box));
        const double here = bound_over(c, *path, {&a, &m, &b}, *over);
        if (here <= tolerance_) {
            most_ = std::max(most_, here);
            return true;
        }
        if ((depth - kFirstHalf) % 2 == 1) over = nullptr;
    }
    if (depth == kDeepestHalf || ++parts_ > kMostHalves) return false;
    return prove(c0, q0, a, m, depth + 1, over) && prove(c1, q1, m, b, depth + 1, over);
}

BranchProof::Bending BranchProof::bending(const std::array<Interval, 2>& box) const {
    Bending out;
    for (std::size_t k = 0; k < 2; ++k) {
        for (const double at : stops_[k]) out.smooth = out.smooth && !(box[k].lo < at && at < box[k].hi);
        for (const Kink& kink : query_.kinks(int(k)))
            out.kinked[k] = out.kinked[k] || (box[k].lo < kink.at && kink.at < box[k].hi);
    }
    out.smooth = out.smooth && !out.kinked[0] && !out.kinked[1];
    out.d = query_(box, out.smooth ? 3 : 2);
    return out;
}

double BranchProof::bound_over(const CubicArc<Vec<3>>& c, const ArcSpeeds& path,
                               const std::array<const Sample*, 3>& at, const Bending& over) const {
    const auto& [box, speed, bend, twist, slack] = path;
    const DerivativeBounds<2>& d = over.d;
    const std::array<double, 2> first{d(1, 0), d(0, 1)}, second{d(2, 0), d(0, 2)};
    double most = 1.01 * bend_of_arc(c), aside = 0, shift = 0;
    for (std::size_t k = 0; k < 2; ++k) {
        if (over.kinked[k])
            aside += 2 * first[k] * box[k].length();
        else
            most += second[k] * speed[k] * speed[k] + first[k] * bend[k];
        shift += first[k] * slack[k];
    }
    if (!over.kinked[0] && !over.kinked[1]) most += 2 * d(1, 1) * speed[0] * speed[1];
    double between = most / 8 + aside;
    if (over.smooth) {
        const Sample &a = *at[0], &m = *at[1], &b = *at[2];
        const double difference = norm(a.off - 2 * m.off + b.off) + a.error + 2 * m.error + b.error;
        const double twisted = 6 * norm((c[3] - c[0]) - 3 * (c[2] - c[1]));
        between = std::min(between, 1.01 * (difference / 2 + (twisted + third_of_arc(d, path)) / 12));
    }
    return 1.01 * (std::max(at[0]->size(), at[2]->size()) + between + 4 * shift);
}

}  // namespace freiform::detail
