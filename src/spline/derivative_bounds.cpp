// Bounds of derivatives of curves and surfaces from those of their parts: Bezier blocks (block_bounds.cpp),
// profiles and offset bases (swept_bounds_detail.hpp).
//
// Idea: restricting a block to a smaller box (de Casteljau) makes the bound as tight as wanted, quadratically
// in the size of the box.
//
// References: [Farin 2002, 5.3], [PT97, 4.2], [Filip Magedson Markot 1986].
#include "bends_detail.hpp"
#include "block_detail.hpp"
#include "kinks_detail.hpp"
#include "offset_kinks_detail.hpp"
#include "swept_bounds_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace freiform {

namespace {

constexpr double kSmallestBlock = 0x1p-8;  // of a Bezier piece: blocks are not restricted further

// Calls f(block, part) for the pieces of a spline that meet the box, each restricted to its part of it, or to
// somewhat more, and arranged.
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
    BezierBlock block;
    each_index(count, [&](const Index<N>& k) {
        Index<N> piece{};
        for (std::size_t d = 0; d < N; ++d) piece[d] = from[d] + k[d];
        block.load(pieces.net(piece));
        std::array<Interval, N> part{};
        const auto on = pieces.box(piece);
        for (std::size_t d = N; d-- > 0;) {
            part[d] = on[d];
            double lo = std::clamp(box[d].lo, on[d].lo, on[d].hi),
                   hi = std::clamp(box[d].hi, on[d].lo, on[d].hi);
            // Differences of a very short part are all rounding: a longer part around it gives the better
            // bound.
            const double lack = kSmallestBlock * on[d].length() - (hi - lo);
            if (lack > 0) {
                lo = std::max(on[d].lo, lo - lack);
                hi = std::min(on[d].hi, hi + lack);
            }
            if (lo <= on[d].lo && hi >= on[d].hi) continue;
            block.restrict(N == 1 ? 1 : int(d), lo > on[d].lo ? (lo - on[d].lo) / (hi - on[d].lo) : 0,
                           hi < on[d].hi ? (hi - on[d].lo) / on[d].length() : 1);
            part[d] = {lo, hi};
        }
        block.arrange();
        f(block, part);
    });
}

// Of f, if it is asked for, and of its coordinates along the directions: one restriction serves all.
template <std::size_t N>
struct PartBounds {
    DerivativeBounds<N> all;
    std::array<DerivativeBounds<N>, kernel::kBlockDirections> along;
};
template <std::size_t N, class P>
PartBounds<N> bounds_of(const BezierPieces<N, P>& pieces, const std::array<Interval, N>& box, int order,
                        std::span<const Vec<4>> directions, bool with_all) {
    PartBounds<N> out;
    each_part(pieces, box, [&](BezierBlock& block, const std::array<Interval, N>& part) {
        const BlockAnswer found = bounds_of_block(
            block, {{part[0].length(), part[N - 1].length()}, order, 0, with_all, directions});
        if (with_all) out.all.include(of_block<N>(found.all));
        for (std::size_t k = 0; k < directions.size(); ++k) out.along[k].include(of_block<N>(found.along[k]));
    });
    return out;
}

// Where M meets the surface; what it misses it by, beside rounding that bounds of its rest have anyway.
template <class G>
double set_corners(const G& g, double value_error, const BezierBlock& block,
                   const std::array<Interval, 2>& part, BoxQuadratic& m) {
    const bool is_all = part == m.box;
    const int last[2] = {block.shape().rows - 1, block.shape().columns - 1};
    for (std::size_t k = 0; k < 4; ++k) {
        const bool right = k & 1, above = k & 2;
        if (is_all) {
            const int i = right ? last[0] : 0, j = above ? last[1] : 0;
            for (int d = 0; d < 3; ++d) m.corner[k][d] = block.number(d, i, j) / block.weight(i, j);
        } else {
            const double u = right ? m.box[0].hi : m.box[0].lo, v = above ? m.box[1].hi : m.box[1].lo;
            m.corner[k] = g.template jet<0>({u, v}).value();
        }
    }
    return is_all ? 0 : value_error;
}

template <int D>
Vec<4> direction_of(const Vec<D>& n) {
    Vec<4> out;
    for (int i = 0; i < D; ++i) out[i] = n[i];
    return out;
}

template <std::size_t N, class P>
double spread_of_weights(const BezierPieces<N, P>& pieces) {
    if (!Space<P>::kRational) return 1;
    Index<N> count{};
    for (std::size_t d = 0; d < N; ++d) count[d] = int(pieces.breaks(int(d)).size()) - 1;
    double most = 1;
    each_index(count, [&](const Index<N>& piece) {
        const NetView<N, const P> net = pieces.net(piece);
        double least = kInfinity, largest = 0;
        each_index(net.extent, [&](const Index<N>& at) {
            const double w = Space<P>::weight(net(at));
            least = std::min(least, w), largest = std::max(largest, w);
        });
        most = std::max(most, largest / least);
    });
    return most;
}

using detail::bounds_along;
using detail::bounds_of;
using detail::bounds_of_both;
using detail::offset_kinks;

}  // namespace

template <std::size_t N, int D>
DerivativeQuery<N, D>::DerivativeQuery(const Geometry& geometry) : geometry_(&geometry) {
    thinnest_.fill(kInfinity);
    visit_one(
        [&](const auto& g) {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (requires { g.net(); }) {
                auto pieces = decompose(g);
                value_error_ = g.value_error_bound();
                for (std::size_t d = 0; d < N; ++d) {
                    kinks_[d] = kinks_of(g, pieces, int(d));
                    const auto& b = pieces.breaks(int(d));
                    bends_[d] = bends_of(g.basis(int(d)), b);
                    for (std::size_t i = 1; i < b.size(); ++i)
                        thinnest_[d] = std::min(thinnest_[d], b[i] - b[i - 1]);
                }
                second_rounding_ = second_rounding_of(g);
                weight_spread_ = spread_of_weights(pieces);
                piece_numbers_ = count_of(pieces.net({}).extent) * G::Coefficients::kCoords;
                pieces_ = std::move(pieces);
            } else if constexpr (requires { g.profile; }) {
                profile_ = std::make_shared<const DerivativeQuery<1, 3>>(g.profile);
                constexpr std::size_t axis = std::same_as<G, Revolution>;
                kinks_[axis].assign(profile_->kinks(0).begin(), profile_->kinks(0).end());
                thinnest_[axis] = profile_->thinnest_piece(0);
                weight_spread_ = profile_->weight_spread();
            } else if constexpr (requires { g.base; }) {
                base_ = std::make_shared<const DerivativeQuery<2, 3>>(*g.base);
                weight_spread_ = base_->weight_spread();
                for (std::size_t d = 0; d < N; ++d) {
                    thinnest_[d] = base_->thinnest_piece(int(d));
                    const auto* profile = base_->profile();
                    const bool along = !profile || d == std::holds_alternative<Revolution>(*g.base);
                    if (along)
                        kinks_[d] = offset_kinks(g, *base_, int(d),
                                                 profile ? profile->bends(0) : base_->bends(int(d)),
                                                 profile ? profile->second_rounding(0, 0)
                                                         : base_->second_rounding(int(d), int(d)));
                }
            }
        },
        geometry);
}

template <std::size_t N, int D>
DerivativeBounds<N> DerivativeQuery<N, D>::operator()(const std::array<Interval, N>& box, int order) const {
    return visit_one(
        [&](const auto& g) -> DerivativeBounds<N> {
            if constexpr (requires { g.net(); })
                return bounds_of(
                           std::get<BezierPieces<N, typename std::remove_cvref_t<decltype(g)>::Coefficients>>(
                               pieces_),
                           box, order, {}, true)
                    .all;
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
    return visit_one(
        [&](const auto& g) -> DerivativeBounds<N> {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (requires { g.net(); })
                return bounds_of(std::get<BezierPieces<N, typename G::Coefficients>>(pieces_), box, order,
                                 std::array{direction_of(n)}, false)
                    .along[0];
            else if constexpr (std::same_as<G, Extrusion>)
                return bounds_along(g, n, *profile_, box, order);
            else if constexpr (std::same_as<G, Revolution>)
                return bounds_along(g, n, *profile_, box, order, (*this)(box, order));
            else if constexpr (requires { g.base; })
                return bounds_of_both(g, n, *base_, box).second;
            else
                return bounds_along(g, n, box[0]);
        },
        *geometry_);
}

template <std::size_t N, int D>
std::array<DerivativeBounds<N>, 2> DerivativeQuery<N, D>::along_two(const std::array<Vec<D>, 2>& n,
                                                                    const std::array<Interval, N>& box,
                                                                    int order) const {
    return visit_one(
        [&](const auto& g) -> std::array<DerivativeBounds<N>, 2> {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (requires { g.net(); })
                return bounds_of(std::get<BezierPieces<N, typename G::Coefficients>>(pieces_), box, order,
                                 std::array{direction_of(n[0]), direction_of(n[1])}, false)
                    .along;
            else
                return {along(n[0], box, order), along(n[1], box, order)};
        },
        *geometry_);
}

template <std::size_t N, int D>
typename DerivativeQuery<N, D>::Both DerivativeQuery<N, D>::both(const Vec<D>& n,
                                                                 const std::array<Interval, N>& box,
                                                                 int order) const {
    return visit_one(
        [&](const auto& g) -> Both {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (requires { g.net(); }) {
                const auto found = bounds_of(std::get<BezierPieces<N, typename G::Coefficients>>(pieces_),
                                             box, order, std::array{direction_of(n)}, true);
                return {found.all, found.along[0]};
            } else if constexpr (std::same_as<G, Revolution>) {
                Both out{(*this)(box, order), {}};
                out.along = bounds_along(g, n, *profile_, box, order, out.all);
                return out;
            } else if constexpr (requires { g.base; }) {
                const auto [all, along] = bounds_of_both(g, n, *base_, box);
                return {all, along};
            } else {
                return {(*this)(box, order), along(n, box, order)};
            }
        },
        *geometry_);
}

PlaneCurveBounds coordinate_bounds(const DerivativeQuery<1, 2>& curve, Interval on) {
    PlaneCurveBounds out;
    visit_one(
        [&](const auto& g) {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (requires { g.net(); }) {
                const auto found =
                    bounds_of(std::get<BezierPieces<1, typename G::Coefficients>>(curve.pieces_), {on}, 2,
                              std::array{Vec<4>{{1}}, Vec<4>{{0, 1}}}, true);
                out.both = found.all;
                for (std::size_t i = 0; i < 2; ++i) out.coordinate[i] = found.along[i];
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

template <std::size_t N, int D>
QuadraticFit DerivativeQuery<N, D>::fit(const BoxQuadratic& m, bool at_corners, const Vec<3>& n,
                                        const std::array<int, 2>& cuts) const requires(N == 2 && D == 3) {
    const std::array<Interval, N>& box = m.box;
    QuadraticFit out{m, {}, {}};
    out.all.fill(kInfinity), out.along.fill(kInfinity);
    visit_one(
        [&](const auto& g) {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (requires { g.net(); }) {
                const auto& pieces = std::get<BezierPieces<N, typename G::Coefficients>>(pieces_);
                for (std::size_t d = 0; d < N; ++d)
                    if (const auto& b = pieces.breaks(int(d)); box[d].lo < b.front() || box[d].hi > b.back())
                        return;
                out.all.fill(0), out.along.fill(0);
                double slip = 0;
                const auto include = [&](const BezierBlock& block, const std::array<Interval, N>& part) {
                    if (std::exchange(at_corners, false))
                        slip = set_corners(g, *value_error_, block, part, out.m);
                    std::array<Interval, 2> at;
                    for (std::size_t d = 0; d < N; ++d)
                        at[d] = {(part[d].lo - box[d].lo) / box[d].length(),
                                 (part[d].hi - box[d].lo) / box[d].length()};
                    include_rest(block, at, n, out);
                };
                each_index(cuts, [&](const Index<N>& k) {
                    std::array<Interval, N> cut;
                    for (std::size_t d = 0; d < N; ++d) {
                        const auto end = [&](int i) {
                            return i == cuts[d] ? box[d].hi : box[d].lo + box[d].length() * i / cuts[d];
                        };
                        cut[d] = {end(k[d]), end(k[d] + 1)};
                    }
                    each_part(pieces, cut, include);
                });
                out.all[0] += slip, out.along[0] += slip;
            }
        },
        *geometry_);
    return out;
}

template <std::size_t N, int D>
std::span<const double> DerivativeQuery<N, D>::breaks(int axis) const {
    std::span<const double> out;
    visit_one(
        [&](const auto& pieces) {
            if constexpr (requires { pieces.breaks(axis); }) out = pieces.breaks(axis);
        },
        pieces_);
    return out;
}

template <std::size_t N, int D>
bool DerivativeQuery<N, D>::is_twice_smooth(const std::array<Interval, N>& box) const {
    for (std::size_t d = 0; d < N; ++d) {
        const auto& b = bends_[d];
        const auto next = std::upper_bound(b.begin(), b.end(), box[d].lo);
        const bool at_end = next == b.end() && !b.empty() && box[d].lo == b.back() && box[d].hi == b.back();
        if (!at_end && (next == b.begin() || next == b.end() || box[d].hi > *next)) return false;
    }
    return true;
}

template class DerivativeQuery<1, 1>;
template class DerivativeQuery<1, 2>;
template class DerivativeQuery<1, 3>;
template class DerivativeQuery<2, 3>;

}  // namespace freiform
