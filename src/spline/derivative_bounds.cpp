// Bounds of derivatives of curves and surfaces from those of their parts: Bezier blocks (block_bounds.cpp),
// profiles and offset bases (swept_bounds_detail.hpp).
//
// Idea: restricting a block to a smaller box (de Casteljau) makes the bound as tight as wanted, quadratically
// in the size of the box.
//
// Along n: n . S has the coefficients n . P, which are off by sqrt(3) times what P is off by, and by 6 u |P|
// from the products; both together are less than what would come from coefficients of size 2 |P|.
//
// References: [Farin 2002, 5.3], [PT97, 4.2], [Filip Magedson Markot 1986].
#include "bends_detail.hpp"
#include "kinks_detail.hpp"
#include "room_detail.hpp"
#include "swept_bounds_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kSmallestBlock = 0x1p-8;  // of a Bezier piece: blocks are not restricted further

// de Casteljau on points of n numbers, one after the other: their part on [0, t], or on [t, 1].
void keep_left_of(double* b, int size, int n, double t) {
    for (int r = 1; r < size; ++r)
        for (int i = size - 1; i >= r; --i) {
            double *const to = b + std::ptrdiff_t(i) * n, *const from = to - n;
            for (int c = 0; c < n; ++c) to[c] = (1 - t) * from[c] + t * to[c];
        }
}
void keep_right_of(double* b, int size, int n, double t) {
    for (int r = 1; r < size; ++r)
        for (int i = 0; i < size - r; ++i) {
            double *const to = b + std::ptrdiff_t(i) * n, *const from = to + n;
            for (int c = 0; c < n; ++c) to[c] = (1 - t) * to[c] + t * from[c];
        }
}

// Restricts a block without gaps along one axis of the piece's own interval `on` to `part`.
template <std::size_t N, class P>
void restrict_block(const NetView<N, P>& block, std::size_t axis, Interval on, Interval part) {
    const int size = block.extent[axis], n = int(block.stride[axis]) * P::kCoords,
              blocks = int(count_of(block.extent)) / (size * int(block.stride[axis]));
    for (int k = 0; k < blocks; ++k) {
        double* const first = block.data->c.data() + std::ptrdiff_t(k) * size * n;
        const auto restrict_rows = [&](int numbers) {  // as a constant, where it can be one
            if (part.hi < on.hi) keep_left_of(first, size, numbers, (part.hi - on.lo) / on.length());
            if (part.lo > on.lo) keep_right_of(first, size, numbers, (part.lo - on.lo) / (part.hi - on.lo));
        };
        n == P::kCoords ? restrict_rows(P::kCoords) : restrict_rows(n);
    }
}

// Calls f(net, widths) for the pieces of a spline that meet the box, each restricted to its part of it. The
// nets have no gaps.
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
    Room<P> room;
    each_index(count, [&](const Index<N>& k) {
        Index<N> piece{};
        for (std::size_t d = 0; d < N; ++d) piece[d] = from[d] + k[d];
        const NetView<N, const P> whole = pieces.net(piece);
        NetView<N, P> own{room.of(std::size_t(count_of(whole.extent))), whole.extent, {}};
        std::ptrdiff_t stride = 1;
        for (std::size_t d = N; d-- > 0;) {
            own.stride[d] = stride;
            stride *= whole.extent[d];
        }
        P* to = own.data;
        each_fibre(int(N) - 1, whole.extent, [&](const Index<N>& at) {
            const auto row = whole.fibre(int(N) - 1, at);
            for (int i = 0; i < row.size; ++i) *to++ = row[i];
        });
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
            restrict_block(own, d, on[d], {lo, hi});
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

// Of f, if it is asked for, and of n . f: one restriction serves both.
template <std::size_t N, class P, int D>
typename DerivativeQuery<N, D>::Both bounds_along(const BezierPieces<N, P>& pieces, const Vec<D>& n,
                                                  const std::array<Interval, N>& box, int order,
                                                  bool with_all) {
    using Q = std::conditional_t<Space<P>::kRational, Hom<1>, Vec<1>>;
    typename DerivativeQuery<N, D>::Both out;
    Room<Q> room;
    each_part(pieces, box, [&](const NetView<N, const P>& net, const std::array<double, N>& width) {
        if (with_all) out.all.include(derivative_bounds<N, P>(net, width, order));
        const std::size_t size = std::size_t(count_of(net.extent));
        Q* const one = room.of(size);
        double largest = 0;
        for (std::size_t k = 0; k < size; ++k) {
            one[k] = coordinate_along(net.data[k], n);
            for (int i = 0; i < D; ++i) largest = std::max(largest, std::abs(net.data[k][i]));
        }
        out.along.include(derivative_bounds<N, Q>({one, net.extent, net.stride}, width, order, 2 * largest));
    });
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

}  // namespace

template <std::size_t N, int D>
DerivativeQuery<N, D>::DerivativeQuery(const Geometry& geometry) : geometry_(&geometry) {
    thinnest_.fill(kInfinity);
    std::visit(
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
                return bounds_along<N>(std::get<BezierPieces<N, typename G::Coefficients>>(pieces_), n, box,
                                       order, false)
                    .along;
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

template <std::size_t N, int D>
typename DerivativeQuery<N, D>::Both DerivativeQuery<N, D>::both(const Vec<D>& n,
                                                                 const std::array<Interval, N>& box,
                                                                 int order) const {
    return std::visit(
        [&](const auto& g) -> Both {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (requires { g.net(); }) {
                return bounds_along<N>(std::get<BezierPieces<N, typename G::Coefficients>>(pieces_), n, box,
                                       order, true);
            } else if constexpr (std::same_as<G, Revolution>) {
                Both out{(*this)(box, order), {}};
                out.along = bounds_along(g, n, *profile_, box, order, out.all);
                return out;
            } else {
                return {(*this)(box, order), along(n, box, order)};
            }
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
