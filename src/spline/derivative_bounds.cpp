// Bounds of derivatives of curves and surfaces from those of their parts: Bezier blocks (block_bounds.cpp),
// profiles, offset bases.
//
// Idea: restricting a block to a smaller box (de Casteljau) makes the bound as tight as wanted, quadratically
// in the size of the box.
//
// Offsets: O = S + d n with n = m / |m|, m = S_u x S_v:   |n_a| <= |m_a| / L,  |n_ab|
// <= |m_ab| / L + 3 |m_a| |m_b| / L^2, L a lower bound of |m| on the box: |m| at its middle less the
// variation by m_u, m_v.
//
// Along n: n . S has the coefficients n . P, which are off by sqrt(3) times what P is off by, and by 6 u |P|
// from the products; both together are less than what would come from coefficients of size 2 |P|. For a
// revolution with u = u0 + s, and w = n_across turned back by u0,
//     n . S_i = w_i . (cos s q_j + sin s (axis x q_j)) for i > 0, q_j the j-th derivative of the profile
//     across the axis,
// w_i a quarter turn of w for each order; i = 0 has the profile's own n . P_j, turned back, and (cos s - 1) w
// . q_j.
//
// References: [Farin 2002, 5.3], [PT97, 4.2], [Filip Magedson Markot 1986].
#include "kinks_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kSmallestBlock = 0x1p-8;  // of a Bezier piece: blocks are not restricted further

// Calls f(net, widths) for the pieces of a spline that meet the box, each restricted to its part of it.
template <std::size_t N, class P, class F>
void each_part(const BezierPieces<N, P>& pieces, const std::array<Interval, N>& box, F&& f) {
    Index<N> from{}, count{};
    for (std::size_t d = 0; d < N; ++d) {
        const auto& b = pieces.breaks(int(d));
        const int n = int(b.size()) - 1;
        const int first =
            std::clamp(int(std::upper_bound(b.begin(), b.end(), box[d].lo) - b.begin()) - 1, 0, n - 1);
        const int last =
            std::clamp(int(std::lower_bound(b.begin(), b.end(), box[d].hi) - b.begin()) - 1, first, n - 1);
        from[d] = first;
        count[d] = last - first + 1;
    }
    std::vector<P> block;
    each_index(count, [&](const Index<N>& k) {
        Index<N> piece{};
        for (std::size_t d = 0; d < N; ++d) piece[d] = from[d] + k[d];
        const NetView<N, const P> whole = pieces.net(piece);
        block.resize(std::size_t(count_of(whole.extent)));
        NetView<N, P> own{block.data(), whole.extent, {}};
        std::ptrdiff_t stride = 1;
        for (std::size_t d = N; d-- > 0;) {
            own.stride[d] = stride;
            stride *= whole.extent[d];
        }
        each_index(whole.extent, [&](const Index<N>& at) { own(at) = whole(at); });
        std::array<double, N> width{};
        const auto on = pieces.box(piece);
        for (std::size_t d = 0; d < N; ++d) {
            width[d] = on[d].length();
            double lo = std::clamp(box[d].lo, on[d].lo, on[d].hi),
                   hi = std::clamp(box[d].hi, on[d].lo, on[d].hi);
            // Differences of a very short part are all rounding: a longer part around it gives the better
            // bound.
            const double lack = kSmallestBlock * width[d] - (hi - lo);
            if (lack > 0) {
                lo = std::max(on[d].lo, lo - lack);
                hi = std::min(on[d].hi, hi + lack);
            }
            if (lo <= on[d].lo && hi >= on[d].hi) continue;
            each_fibre(int(d), whole.extent, [&](const Index<N>& at) {
                if (hi < on[d].hi) keep_left(own.fibre(int(d), at), (hi - on[d].lo) / width[d]);
                if (lo > on[d].lo) keep_right(own.fibre(int(d), at), (lo - on[d].lo) / (hi - on[d].lo));
            });
            width[d] = hi - lo;
        }
        f(NetView<N, const P>(own), width);
    });
}

template <std::size_t N, class P>
DerivativeBounds<N> bounds_of(const BezierPieces<N, P>& pieces, const std::array<Interval, N>& box,
                              int order) {
    DerivativeBounds<N> out;
    each_part(pieces, box, [&](const NetView<N, const P>& net, const std::array<double, N>& width) {
        out.include(derivative_bounds<N, P>(net, width, order));
    });
    return out;
}

// One coordinate of the coefficients of a plane curve.
void coordinate(const NetView<1, const Vec<2>>& net, int i, std::vector<Vec<1>>& out) {
    out.clear();
    for (int k = 0; k < net.extent[0]; ++k) out.push_back({{net({k})[i]}});
}
void coordinate(const NetView<1, const Hom<2>>& net, int i, std::vector<Hom<1>>& out) {
    out.clear();
    for (int k = 0; k < net.extent[0]; ++k) out.push_back({{net({k})[i], net({k}).weight()}});
}

// n . p, of coefficients.
template <int D>
Vec<1> coordinate_along(const Vec<D>& p, const Vec<D>& n) {
    return {{dot(p, n)}};
}
template <int D>
Hom<1> coordinate_along(const Hom<D>& p, const Vec<D>& n) {
    double sum = 0;
    for (int i = 0; i < D; ++i) sum += p[i] * n[i];
    return {{sum, p.weight()}};
}

template <std::size_t N, class P, int D>
DerivativeBounds<N> bounds_along(const BezierPieces<N, P>& pieces, const Vec<D>& n,
                                 const std::array<Interval, N>& box, int order) {
    using Q = std::conditional_t<Space<P>::kRational, Hom<1>, Vec<1>>;
    DerivativeBounds<N> out;
    std::vector<Q> one;
    each_part(pieces, box, [&](const NetView<N, const P>& net, const std::array<double, N>& width) {
        one.clear();
        double largest = 0;
        each_index(net.extent, [&](const Index<N>& at) {
            one.push_back(coordinate_along(net(at), n));
            for (int i = 0; i < D; ++i) largest = std::max(largest, std::abs(net(at)[i]));
        });
        out.include(derivative_bounds<N, Q>({one.data(), net.extent, net.stride}, width, order, 2 * largest));
    });
    return out;
}

template <int D>
DerivativeBounds<1> bounds_of(const Line<D>& line, Interval on) {
    return {{norm(line.direction) * on.length() / 2, norm(line.direction), 0, 0}};
}

template <int D>
DerivativeBounds<1> bounds_of(const Conic<D>& c, Interval on) {
    const double xx = dot(c.x, c.x), yy = dot(c.y, c.y), xy = dot(c.x, c.y),
                 t = std::max(std::abs(on.lo), std::abs(on.hi));
    const double grow = 1 + 64 * kUnitRoundoff;
    DerivativeBounds<1> out;
    if (c.kind == ConicKind::ellipse) {  // the larger semi-axis: the larger singular value of (x y)
        const double s = grow * std::sqrt((xx + yy + std::hypot(xx - yy, 2 * xy)) / 2);
        out.d = {s, s, s, s};
    } else if (c.kind == ConicKind::hyperbola) {  // any derivative, from the middle outwards by the next one
        const double s = std::cosh(t) * (std::sqrt(xx) + std::sqrt(yy)), m = on.middle(),
                     half = on.length() / 2;
        const double even = norm(std::cosh(m) * c.x + std::sinh(m) * c.y) + half * s;
        const double odd = norm(std::sinh(m) * c.x + std::cosh(m) * c.y) + half * s;
        out.d = {s, std::min(s, odd) * grow, std::min(s, even) * grow, std::min(s, odd) * grow};
    } else {
        out.d = {0, grow * (2 * t * std::sqrt(xx) + std::sqrt(yy)), grow * 2 * std::sqrt(xx), 0};
    }
    out.d[0] = std::min(out.d[0] > 0 ? out.d[0] : kInfinity, out.d[1] * on.length() / 2);
    return out;
}

DerivativeBounds<2> bounds_of(const Extrusion& e, const DerivativeQuery<1, 3>& profile,
                              const std::array<Interval, 2>& box, int order) {
    const auto c = profile({box[0]}, order);
    DerivativeBounds<2> out;
    for (int i = 0; i <= order; ++i) out.d[jet_slot(Index<2>{i, 0})] = c.d[std::size_t(i)];
    out.d[2] = norm(e.direction);
    out.d[0] += out.d[2] * box[1].length() / 2;
    return out;
}

// Partial (i, j): the j-th derivative of the profile, turned; for i > 0 only its part across the axis counts,
// which is bounded from the middle of the interval outwards.
DerivativeBounds<2> bounds_of(const Revolution& r, const DerivativeQuery<1, 3>& profile,
                              const std::array<Interval, 2>& box, int order) {
    const auto c = profile({box[1]}, std::min(order + 1, kBoundOrder));
    auto at = jet<3>(r.profile, box[1].middle());
    at.d[0] -= r.origin;
    const double half = box[1].length() / 2, grow = 1 + 64 * kUnitRoundoff;
    const double slip =
        value_error_bound(r.profile, {box[1]}) + 8 * kUnitRoundoff * (max_abs(r.origin) + norm(at.d[0]));
    DerivativeBounds<2> out;
    for (int j = 0; j <= order; ++j) {
        double across = c.d[std::size_t(j)];
        if (j < kBoundOrder) {
            const double here = norm(cross(r.axis, at.d[std::size_t(j)])) + half * c.d[std::size_t(j) + 1] +
                                (j == 0 ? slip : 0);
            across = j == 0 ? here : std::min(across, here);
        }
        for (int i = 0; i + j <= order; ++i)
            out.d[jet_slot(Index<2>{i, j})] = grow * (i == 0 ? c.d[std::size_t(j)] : across);
    }
    out.d[0] = out.d[1] * box[0].length() / 2 + c.d[0];
    return out;
}

// n . C^(k)(m + s) = cos s (n . C^(k)(m)) + sin s (n . C^(k+1)(m)) of an ellipse about its centre.
template <int D>
DerivativeBounds<1> bounds_along(const Conic<D>& c, const Vec<D>& n, Interval on) {
    DerivativeBounds<1> out = bounds_of(c, on);
    if (c.kind != ConicKind::ellipse) return out;
    const double x = dot(n, c.x), y = dot(n, c.y), m = on.middle(), turn = std::min(1.0, on.length() / 2);
    const double slip = 16 * kUnitRoundoff * (norm(c.x) + norm(c.y));
    const double even = std::abs(std::cos(m) * x + std::sin(m) * y) + slip;
    const double odd = std::abs(std::cos(m) * y - std::sin(m) * x) + slip;
    for (std::size_t k = 1; k < 4; ++k)
        out.d[k] =
            std::min(out.d[k], (k == 2 ? even + turn * odd : odd + turn * even) * (1 + 64 * kUnitRoundoff));
    return out;
}
template <int D>
DerivativeBounds<1> bounds_along(const Line<D>& line, const Vec<D>& n, Interval on) {
    DerivativeBounds<1> out = bounds_of(line, on);
    out.d[1] = std::abs(dot(n, line.direction)) + 8 * kUnitRoundoff * norm(line.direction);
    return out;
}

DerivativeBounds<2> bounds_along(const Extrusion& e, const Vec<3>& n, const DerivativeQuery<1, 3>& profile,
                                 const std::array<Interval, 2>& box, int order) {
    const auto c = profile.along(n, {box[0]}, order);
    DerivativeBounds<2> out;
    for (int i = 0; i <= order; ++i) out.d[jet_slot(Index<2>{i, 0})] = c.d[std::size_t(i)];
    out.d[2] = std::abs(dot(n, e.direction)) + 8 * kUnitRoundoff * norm(e.direction);
    out.d[0] += out.d[2] * box[1].length() / 2;
    return out;
}

DerivativeBounds<2> bounds_along(const Revolution& r, const Vec<3>& n, const DerivativeQuery<1, 3>& profile,
                                 const std::array<Interval, 2>& box, int order,
                                 const DerivativeBounds<2>& full) {
    const double u = box[0].middle(), half = box[0].length() / 2, turn = std::min(1.0, half);
    const double less = std::min(2.0, half * half / 2);
    const Vec<3> straight = dot(n, r.axis) * r.axis, out_of = n - straight;
    const Vec<3> w = std::cos(u) * out_of - std::sin(u) * cross(r.axis, out_of), turned = -cross(r.axis, w);
    const auto a = profile.along(w, {box[1]}, order), b = profile.along(turned, {box[1]}, order),
               c = profile.along(straight + w, {box[1]}, order);
    const Vec<3> middle = jet<0>(r.profile, box[1].middle()).value() - r.origin;
    const auto of = [&](const DerivativeBounds<1>& d, const Vec<3>& along, int j) {
        return j > 0 ? d.d[std::size_t(j)] : std::abs(dot(along, middle)) + d.d[1] * (box[1].length() / 2);
    };
    // Rounding of w, turned and the middle: a few units of the last place of what they are multiplied by.
    const double slip =
        3 * value_error_bound(r.profile, {box[1]}) + 64 * kUnitRoundoff * (max_abs(r.origin) + norm(middle));
    DerivativeBounds<2> out;
    for (int i = 0; i <= order; ++i)
        for (int j = 0; i + j <= order; ++j) {
            const std::size_t slot = jet_slot(Index<2>{i, j});
            const double even = of(a, w, j), odd = of(b, turned, j);
            const double most = i == 0       ? of(c, straight + w, j) + less * even + turn * odd
                                : i % 2 == 0 ? even + turn * odd
                                             : odd + turn * even;
            out.d[slot] =
                std::min(full.d[slot], most + 64 * kUnitRoundoff * full.d[slot] + (j == 0 ? slip : 0));
        }
    out.d[0] = full.d[0];
    return out;
}

DerivativeBounds<2> bounds_of(const OffsetSurface& o, const DerivativeQuery<2, 3>& base,
                              const std::array<Interval, 2>& box) {
    const auto s = base(box, 3);
    const auto& S = s.d;
    const double mu = S[3] * S[2] + S[1] * S[4], mv = S[4] * S[2] + S[1] * S[5];
    const double second[3] = {S[6] * S[2] + 2 * S[3] * S[4] + S[1] * S[7],
                              S[7] * S[2] + S[3] * S[5] + S[1] * S[8],
                              S[8] * S[2] + 2 * S[4] * S[5] + S[1] * S[9]};
    const auto at = jet<1>(*o.base, {box[0].middle(), box[1].middle()});
    const double least =
        norm(cross(at.d[1], at.d[2])) * (1 - 1e-12) - mu * box[0].length() / 2 - mv * box[1].length() / 2;
    DerivativeBounds<2> out;
    out.d.fill(kInfinity);
    if (!(least > 0)) return out;
    const double d = std::abs(o.distance), m[2] = {mu, mv}, grow = 1 + 64 * kUnitRoundoff;
    out.d[0] = S[0] + 2 * d;
    for (int a = 0; a < 2; ++a) out.d[std::size_t(1 + a)] = grow * (S[std::size_t(1 + a)] + d * m[a] / least);
    for (int k = 0; k < 3; ++k)
        out.d[std::size_t(3 + k)] =
            grow *
            (S[std::size_t(3 + k)] + d * (second[k] / least + 3 * m[k == 2] * m[k >= 1] / (least * least)));
    return out;
}

}  // namespace

template <std::size_t N, int D>
DerivativeQuery<N, D>::DerivativeQuery(const Geometry& geometry) : geometry_(&geometry) {
    thinnest_.fill(kInfinity);
    std::visit(
        [&](const auto& g) {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (requires { g.net(); }) {
                auto pieces = decompose(g);
                for (std::size_t d = 0; d < N; ++d) {
                    kinks_[d] = kinks_of(g, pieces, int(d));
                    const auto& b = pieces.breaks(int(d));
                    for (std::size_t i = 1; i < b.size(); ++i)
                        thinnest_[d] = std::min(thinnest_[d], b[i] - b[i - 1]);
                }
                pieces_ = std::move(pieces);
            } else if constexpr (requires { g.profile; }) {
                profile_ = std::make_shared<const DerivativeQuery<1, 3>>(g.profile);
                constexpr std::size_t axis = std::same_as<G, Revolution>;
                kinks_[axis].assign(profile_->kinks(0).begin(), profile_->kinks(0).end());
                thinnest_[axis] = profile_->thinnest_piece(0);
            } else if constexpr (requires { g.base; }) {
                base_ = std::make_shared<const DerivativeQuery<2, 3>>(*g.base);
                for (std::size_t d = 0; d < N; ++d) {
                    thinnest_[d] = base_->thinnest_piece(int(d));
                    for (Kink k : base_->kinks(int(d)))  // where the base has a kink, its offset is torn
                        kinks_[d].push_back({k.at, kInfinity});
                }
            }
        },
        geometry);
}

template <std::size_t N, int D>
DerivativeBounds<N> DerivativeQuery<N, D>::operator()(const std::array<Interval, N>& box, int order) const {
    return std::visit(
        [&](const auto& g) -> DerivativeBounds<N> {
            if constexpr (requires { g.net(); })
                return bounds_of(
                    std::get<BezierPieces<N, typename std::remove_cvref_t<decltype(g)>::Coefficients>>(
                        pieces_),
                    box, order);
            else if constexpr (requires { g.profile; })
                return bounds_of(g, *profile_, box, order);
            else if constexpr (requires { g.base; })
                return bounds_of(g, *base_, box);
            else
                return bounds_of(g, box[0]);
        },
        *geometry_);
}

template <std::size_t N, int D>
DerivativeBounds<N> DerivativeQuery<N, D>::along(const Vec<D>& n, const std::array<Interval, N>& box,
                                                 int order) const {
    return std::visit(
        [&](const auto& g) -> DerivativeBounds<N> {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (requires { g.net(); })
                return bounds_along(std::get<BezierPieces<N, typename G::Coefficients>>(pieces_), n, box,
                                    order);
            else if constexpr (std::same_as<G, Extrusion>)
                return bounds_along(g, n, *profile_, box, order);
            else if constexpr (std::same_as<G, Revolution>)
                return bounds_along(g, n, *profile_, box, order, (*this)(box, order));
            else if constexpr (requires { g.base; })
                return (*this)(box, order);
            else
                return bounds_along(g, n, box[0]);
        },
        *geometry_);
}

PlaneCurveBounds coordinate_bounds(const DerivativeQuery<1, 2>& curve, Interval on) {
    PlaneCurveBounds out;
    const auto of_pieces = [&]<class P>(const BezierPieces<1, P>& pieces) {
        std::vector<std::conditional_t<Space<P>::kRational, Hom<1>, Vec<1>>> one;
        using Q = typename decltype(one)::value_type;
        each_part(pieces, {on}, [&](const NetView<1, const P>& net, const std::array<double, 1>& width) {
            out.both.include(derivative_bounds<1, P>(net, width, 2));
            for (int i = 0; i < 2; ++i) {
                coordinate(net, i, one);
                out.coordinate[std::size_t(i)].include(
                    derivative_bounds<1, Q>({one.data(), net.extent, {1}}, width, 2));
            }
        });
    };
    std::visit(
        [&](const auto& g) {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (requires { g.net(); }) {
                of_pieces(std::get<BezierPieces<1, typename G::Coefficients>>(curve.pieces_));
            } else {
                out.both = bounds_of(g, on);
                for (int i = 0; i < 2; ++i) {
                    auto& c = out.coordinate[std::size_t(i)];
                    if constexpr (std::same_as<G, Line<2>>)
                        c = bounds_of(Line<1>{{{g.origin[i]}}, {{g.direction[i]}}}, on);
                    else
                        c = bounds_of(Conic<1>{g.kind, {{g.centre[i]}}, {{g.x[i]}}, {{g.y[i]}}}, on);
                }
            }
        },
        *curve.geometry_);
    return out;
}

template class DerivativeQuery<1, 1>;
template class DerivativeQuery<1, 2>;
template class DerivativeQuery<1, 3>;
template class DerivativeQuery<2, 3>;

}  // namespace freiform
