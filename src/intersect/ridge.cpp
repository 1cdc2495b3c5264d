// Following valleys; ridge_detail.hpp is the essay.
#include "ridge_detail.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::detail {

namespace {

constexpr double kShortestPiece = 0x1p-40;                  // of the longest
constexpr int kMostRidgeSteps = 2000, kShortestRidge = 30;  // halvings of the first step
constexpr double kRidgeNoise = 0x1p-42;                     // of a domain
constexpr double kValley = 64;  // it bends across by so many times what it does along

double noise_along(const Interval& on) {
    return kRidgeNoise * std::max(on.length(), std::max(std::abs(on.lo), std::abs(on.hi)));
}

}  // namespace

// Gauss-Newton for (s, t) of the foot of A(u, v).
bool RidgeTracer::foot(Place4& x) const {
    const Vec<3> p = jet<0>(*shapes_[0], {x[0], x[1]}).value();
    for (int i = 0; i < 20; ++i) {
        const auto b = jet<2>(*shapes_[1], {x[2], x[3]});
        const Vec<3> r = b.value() - p, u = b.d[1], v = b.d[2];
        // With second derivatives, Newton's method: far feet, too, take few steps.
        const double uu = dot(u, u) + dot(r, b.d[3]), uv = dot(u, v) + dot(r, b.d[4]),
                     vv = dot(v, v) + dot(r, b.d[5]), det = uu * vv - uv * uv;
        if (!(det > 0)) return false;
        const double ds = (vv * dot(u, r) - uv * dot(v, r)) / det,
                     dt = (uu * dot(v, r) - uv * dot(u, r)) / det;
        x[2] -= ds, x[3] -= dt;
        if (std::abs(ds) > charts_.domain(2).length() || std::abs(dt) > charts_.domain(3).length())
            return false;
        if (std::abs(ds) <= 0x1p-46 * charts_.domain(2).length() &&
            std::abs(dt) <= 0x1p-46 * charts_.domain(3).length())
            return true;
    }
    return true;
}

// The directions of most and least bending of the distance at a place, x with its foot.
std::optional<RidgeTracer::Valley> RidgeTracer::look(Place4 x, const Vec<3>& heading) const {
    if (!foot(x)) return std::nullopt;
    const auto a = jet<2>(*shapes_[0], {x[0], x[1]}), b = jet<2>(*shapes_[1], {x[2], x[3]});
    const Vec<3> n = unit(cross(b.d[1], b.d[2]));
    const double uu = dot(b.d[1], b.d[1]), uv = dot(b.d[1], b.d[2]), vv = dot(b.d[2], b.d[2]),
                 det = uu * vv - uv * uv;
    if (!(det > 0)) return std::nullopt;
    const auto moved = [&](const Vec<3>& d) {  // of (s, t), along a tangent
        const double p = dot(b.d[1], d), q = dot(b.d[2], d);
        return Vec<2>{{(vv * p - uv * q) / det, (uu * q - uv * p) / det}};
    };
    // An orthonormal frame of the tangent plane of A, as directions in (u, v).
    const double length = norm(a.d[1]);
    if (!(length > 0)) return std::nullopt;
    const double lean = dot(a.d[1], a.d[2]) / (length * length);
    const Vec<3> side = a.d[2] - lean * a.d[1];
    const double width = norm(side);
    if (!(width > 0x1p-20 * norm(a.d[2]))) return std::nullopt;
    const std::array<Vec<2>, 2> frame{Vec<2>{{1 / length, 0}}, {{-lean / width, 1 / width}}};
    const auto derivative = [&](const Vec<2>& d) { return d[0] * a.d[1] + d[1] * a.d[2]; };
    const auto bend = [&](const Vec<2>& d, const Vec<2>& e) {
        const Vec<2> j = moved(derivative(d)), k = moved(derivative(e));
        const Vec<3> own = d[0] * e[0] * a.d[3] + (d[0] * e[1] + d[1] * e[0]) * a.d[4] + d[1] * e[1] * a.d[5];
        const Vec<3> other =
            j[0] * k[0] * b.d[3] + (j[0] * k[1] + j[1] * k[0]) * b.d[4] + j[1] * k[1] * b.d[5];
        return dot(n, own - other);
    };
    const double p = bend(frame[0], frame[0]), q = bend(frame[0], frame[1]), r = bend(frame[1], frame[1]);
    // Rotated by `turn`, the matrix of p, q, r is diagonal; the larger one across.
    double turn = 0.5 * std::atan2(2 * q, p - r);
    const double mean = 0.5 * (p + r), spread = std::hypot(0.5 * (p - r), q);
    if (std::abs(mean + spread) < std::abs(mean - spread)) turn += 0.5 * std::numbers::pi;
    const double most = std::max(std::abs(mean + spread), std::abs(mean - spread)),
                 least = std::min(std::abs(mean + spread), std::abs(mean - spread));
    // No valley where the surfaces are the same: it is as deep as the tolerance a step beside its bottom.
    if (!(most > kValley * least && 0.5 * most * longest_ * longest_ > tolerance_)) return std::nullopt;
    const double c = std::cos(turn), s = std::sin(turn);
    Valley out;
    out.across = c * frame[0] + s * frame[1];
    Vec<2> along = c * frame[1] - s * frame[0];
    if (dot(derivative(along), heading) < 0) along = -1.0 * along;
    out.tangent = derivative(along);
    const Vec<2> foot_along = moved(out.tangent);
    out.x = x, out.along = {along[0], along[1], foot_along[0], foot_along[1]};
    out.point = 0.5 * (a.value() + b.value());
    out.height = dot(n, derivative(out.across)) / bend(out.across, out.across);  // Newton's step across
    return out;
}

// To where the distance does not change across.
std::optional<RidgeTracer::Valley> RidgeTracer::bottom(Place4 x, const Vec<3>& heading) const {
    for (int i = 0; i < 12; ++i) {
        auto at = look(x, heading);
        if (!at) return at;
        if (!(std::abs(at->height) <= 0.25 * longest_)) return std::nullopt;
        if (std::abs(at->height) <= 0x1p-30 * longest_ || i == 11) {
            // The last step needs no other frame.
            for (std::size_t k = 0; k < 2; ++k) at->x[k] -= at->height * at->across[int(k)];
            if (!foot(at->x)) return std::nullopt;
            for (std::size_t k = 0; k < 4; ++k) {
                const Interval on = charts_.domain(k);
                if (at->x[k] < on.lo && at->x[k] >= on.lo - noise_along(on)) at->x[k] = on.lo;
                if (at->x[k] > on.hi && at->x[k] <= on.hi + noise_along(on)) at->x[k] = on.hi;
            }
            at->point = 0.5 * (jet<0>(*shapes_[0], {at->x[0], at->x[1]}).value() +
                               jet<0>(*shapes_[1], {at->x[2], at->x[3]}).value());
            return at;
        }
        for (std::size_t k = 0; k < 2; ++k) x[k] = at->x[k] - at->height * at->across[int(k)];
        x[2] = at->x[2], x[3] = at->x[3];
    }
    return std::nullopt;
}

// On a seam and about to leave over it: to its other side.
bool RidgeTracer::step_over_seams(Valley& from) const {
    bool any = false;
    for (std::size_t k = 0; k < 4; ++k) {
        const Interval on = charts_.domain(k);
        if (!charts_.is_cyclic(k) || std::abs(from.along[k]) * longest_ <= noise_along(on)) continue;
        const bool up = from.along[k] > 0;
        if (std::abs(from.x[k] - (up ? on.hi : on.lo)) > noise_along(on)) continue;
        from.x[k] = up ? on.lo : on.hi;
        any = true;
    }
    return any;
}
bool RidgeTracer::is_at_border(const Valley& from) const {
    for (std::size_t k = 0; k < 4; ++k) {
        const Interval on = charts_.domain(k);
        if (charts_.is_cyclic(k) || std::abs(from.along[k]) * longest_ <= noise_along(on)) continue;
        if (std::abs(from.x[k] - (from.along[k] > 0 ? on.hi : on.lo)) <= noise_along(on)) return true;
    }
    return false;
}

// The bottom a step further, no farther than borders and seams: `by` becomes shorter.
std::optional<RidgeTracer::Valley> RidgeTracer::ahead(const Valley& from, double& by, bool& at_border) const {
    at_border = false;
    for (int i = 0; i < 8; ++i) {
        Place4 x;
        for (std::size_t k = 0; k < 4; ++k) x[k] = from.x[k] + by * from.along[k];
        auto to = bottom(x, from.tangent);
        if (!to) return to;
        double shorter = 1;
        std::size_t which = 4;
        double border = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const Interval on = charts_.domain(k);
            const double t = to->x[k], end = t < on.lo ? on.lo : on.hi;
            if (on.contains(t)) continue;
            const double part = (end - from.x[k]) / (t - from.x[k]);
            if (!(part < shorter) && which < 4) continue;
            shorter = std::max(0.0, part), which = k, border = end;
        }
        if (which == 4) return to;
        at_border = true;
        if (i >= 5 || std::abs(to->x[which] - border) <= 64 * noise_along(charts_.domain(which))) {
            for (std::size_t k = 0; k < 4; ++k) to->x[k] = clamped(to->x[k], charts_.domain(k));
            return to;
        }
        by *= shorter;
        if (!(by > 0)) return std::nullopt;
    }
    return std::nullopt;
}

std::optional<std::array<double, 2>> RidgeTracer::prove(const Valley& from, const Valley& to,
                                                        Piece& out) const {
    out.length = arc_interval(from.point, to.point, from.tangent, to.tangent, 0, tolerance_);
    // Where a valley ends its bottom may stay where it is; and knots of a branch must be told apart.
    if (!(out.length > kShortestPiece * longest_)) return std::nullopt;
    const double h = out.length / 3;
    out.space = {from.point, from.point + h * from.tangent, to.point - h * to.tangent, to.point};
    std::array<double, 2> bound{};
    for (std::size_t s = 0; s < 2; ++s) {
        const auto place = [&](const Valley& v, double by) {
            Vec<2> q;
            for (std::size_t k = 0; k < 2; ++k) {
                const Interval on = charts_.domain(2 * s + k);
                double& t = q[int(k)];
                t = v.x[2 * s + k] + by * v.along[2 * s + k];
                if (t < on.lo && t >= on.lo - 64 * noise_along(on)) t = on.lo;
                if (t > on.hi && t <= on.hi + 64 * noise_along(on)) t = on.hi;
            }
            return q;
        };
        out.at[s] = {place(from, 0), place(from, h), place(to, -h), place(to, 0)};
        const auto proven = (*proofs_[s])(out.space, out.at[s], tolerance_);
        if (!proven) return std::nullopt;
        bound[s] = *proven;
    }
    return bound;
}

RidgeTracer::Run RidgeTracer::follow(Valley from, double first, const Valley& start, int node) {
    Run run;
    double by = first, gone = 0;
    for (int i = 0; i < kMostRidgeSteps; ++i) {
        if (is_at_border(from)) return run;
        step_over_seams(from);
        bool proven = false;
        for (int half = 0; half < kShortestRidge && !proven; ++half, by /= 2) {
            double step = by;
            bool at_border = false;
            auto to = ahead(from, step, at_border);
            if (!to) continue;
            // Round: the start is ahead, within the step.
            const Vec<3> back = start.point - from.point;
            const double ahead_by = dot(back, from.tangent);
            const bool round = gone > 2 * by && ahead_by > 0 &&
                               norm(back) <= 1.5 * norm(to->point - from.point) &&
                               dot(start.tangent, from.tangent) > 0.5;
            Piece piece;
            if (round) {
                Valley end = start;
                for (std::size_t k = 0; k < 4; ++k)
                    if (charts_.is_cyclic(k)) {
                        const double period = charts_.domain(k).length();
                        end.x[k] +=
                            period * std::round((from.x[k] + step * from.along[k] - end.x[k]) / period);
                    }
                if (const auto bound = prove(from, end, piece)) {
                    for (std::size_t s = 0; s < 2; ++s) bound_[s] = std::max(bound_[s], (*bound)[s]);
                    run.pieces.push_back(piece);
                    run.closed = true;
                    return run;
                }
            }
            const auto bound = prove(from, *to, piece);
            if (!bound) continue;
            for (std::size_t s = 0; s < 2; ++s) bound_[s] = std::max(bound_[s], (*bound)[s]);
            run.pieces.push_back(piece);
            gone += piece.length;
            from = *to;
            proven = true;
        }
        if (!proven) {
            run.end = node;
            return run;
        }
        by = std::min(3 * by, longest_);  // it was halved once more
    }
    run.end = kAtUnresolved;
    return run;
}

std::vector<SurfaceBranch> RidgeTracer::all(const Cluster& cluster, int node) {
    std::vector<SurfaceBranch> out;
    longest_ = 0.125 * std::min(charts_.sheet(0)[0].extent(), charts_.sheet(1)[0].extent());
    constexpr int kMostRidges = 16, kMostSeeds = 64;
    std::vector<std::array<double, 4>> seen;  // along the branches
    const std::size_t stride = std::max<std::size_t>(1, cluster.cores.size() / kMostSeeds);
    for (std::size_t c = 0; c < cluster.cores.size() && out.size() < kMostRidges; c += stride) {
        const auto& cell = cluster.cores[c];
        Place4 x;
        for (std::size_t k = 0; k < 4; ++k) x[k] = cell[k].middle();
        const auto start = bottom(x, {{1, 0, 0}});
        if (!start) continue;
        const auto is_beside = [&](const Place4& p) {
            double most = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                double d = std::abs(p[k] - start->x[k]);
                if (charts_.is_cyclic(k)) d = std::min(d, std::abs(charts_.domain(k).length() - d));
                most = std::max(most, d / charts_.domain(k).length());
            }
            return most < 0x1p-6;
        };
        bool inside = true;
        for (std::size_t k = 0; k < 4; ++k)
            inside = inside && (charts_.is_cyclic(k) || charts_.domain(k).contains(start->x[k]));
        if (!inside || std::ranges::any_of(seen, is_beside)) continue;
        bound_ = {};
        Valley turned = *start;
        turned.tangent = -1.0 * turned.tangent;
        for (double& t : turned.along) t = -t;
        const Run forth = follow(*start, longest_, *start, node);
        const Run back = forth.closed ? Run{} : follow(turned, longest_, turned, node);
        if (forth.pieces.empty() && back.pieces.empty()) continue;
        SurfaceBranch b = branch(back, forth);
        const Interval on = b.curve.domain()[0];
        for (int i = 0; i <= 256; ++i) {
            const double t = on.lo + on.length() * i / 256;
            const Vec<2> p = b.at_a(t), q = b.at_b(t);
            seen.push_back({p[0], p[1], q[0], q[1]});
        }
        out.push_back(std::move(b));
    }
    return out;
}

bool RidgeTracer::are_all_of(const Cluster& cluster, const std::vector<SurfaceBranch>& branches) const {
    constexpr int kSamplesOfRidge = 512;
    std::vector<Vec<3>> on;
    double spacing = 0;
    for (const SurfaceBranch& b : branches) {
        const Interval t = b.curve.domain()[0];
        for (const int end : b.ends)
            if (end != kAtBorder) return false;
        for (int i = 0; i <= kSamplesOfRidge; ++i)
            on.push_back(b.curve(t.lo + t.length() * i / kSamplesOfRidge));
        spacing = std::max(spacing, 1.25 * t.length() / kSamplesOfRidge);
    }
    const auto place = [&](double u, double v) { return charts_.sheet(0).at(u, v).point; };
    double widest = 0;
    for (const auto& c : cluster.cores)
        widest = std::max(widest, norm(place(c[0].hi, c[1].hi) - place(c[0].lo, c[1].lo)));
    return !on.empty() && std::ranges::all_of(cluster.cores, [&](const std::array<Interval, 4>& c) {
        const Vec<3> p = place(c[0].middle(), c[1].middle());
        return std::ranges::any_of(on, [&](const Vec<3>& q) { return norm(q - p) <= 4 * widest + spacing; });
    });
}

SurfaceBranch RidgeTracer::branch(const Run& back, const Run& forth) const {
    std::vector<Piece> pieces;
    for (std::size_t i = back.pieces.size(); i-- > 0;) {
        Piece p = back.pieces[i];
        std::ranges::reverse(p.space);
        for (auto& at : p.at) std::ranges::reverse(at);
        pieces.push_back(p);
    }
    pieces.insert(pieces.end(), forth.pieces.begin(), forth.pieces.end());
    const auto joined = [&]<class V>(V, auto&& of) {
        std::vector<V> net{of(pieces[0])[0]};
        std::vector<double> knots(4, 0.0);
        double t = 0;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const auto& p = of(pieces[i]);
            t += pieces[i].length;
            net.insert(net.end(), {p[1], p[2], p[3]});
            const bool last = i + 1 == pieces.size(), jump = !last && !(of(pieces[i + 1])[0] == p[3]);
            if (jump) net.push_back(of(pieces[i + 1])[0]);
            knots.insert(knots.end(), last || jump ? 4 : 3, t);
        }
        const int n = int(net.size());
        return Curve<V>::trusted({*BSplineBasis::make(3, std::move(knots))}, Net<1, V>({n}, std::move(net)));
    };
    SurfaceBranch out{joined(
                          Vec<3>{}, [](const Piece& p) -> const auto& { return p.space; }),
                      joined(
                          Vec<2>{}, [](const Piece& p) -> const auto& { return p.at[0]; }),
                      joined(
                          Vec<2>{}, [](const Piece& p) -> const auto& { return p.at[1]; })};
    out.kind = SurfaceBranchKind::tangent;
    out.closed = forth.closed;
    out.ends = {back.end, forth.end};
    if (forth.closed) out.ends = {kAtBorder, kAtBorder};
    out.bound_a = bound_[0], out.bound_b = bound_[1];
    return out;
}

}  // namespace freiform::detail
