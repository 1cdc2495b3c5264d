// Definitions of the members of Patch; instantiated once per number of parameters in patch_1.cpp ..
// patch_3.cpp.
//
// Accuracy of values. Notation: u = 2^-53, p_d degrees, all parameters inside the domain, h = the smallest
// denormal number, c = max |P_i|.
//
// Weights. A step of the recurrence maps non-negative numbers to sums of two products of non-negative
// numbers, so relative errors do not grow in it; two differences of given numbers, a quotient, a product and
// a sum add 5 roundings, of which the first step, where the old weight is 1 and the sum has one term, has
// only 3. A weight of degree p >= 1 carries at most 5 p - 2 roundings; of degree 0 it is exactly 1.
//
// Sums. A term is one more product, a sum of p + 1 terms p more sums: 6 p - 1 along an axis, and
// k = sum_d max(0, 6 p_d - 1) along all of them. So the computed value differs from the exact one by at most
//     g sum w_i |P_i| + e <= g c + e,    g = 1.01 k u >= k u / (1 - k u)
// by partition of unity, where e = h sum_d (p_d + 1) is what products that underflow lose (the weights of the
// outer sums are at most 1 in all; losses inside weights are below 2^-1050 c, which the factor 1.01 covers).
//
// Rational. All w_i are positive, so for numerator A and denominator W alike the absolute error is at most g
// times the sum of the absolute terms: g c W + e and g W + e with c = max |P_i / w_i| and W >= w_min. The
// quotient:
//     |A^/W^ - A/W| <= (2 g c + (1 + c) e / w_min) / (1 - g - e / w_min),   and one rounding of it,
// independent of the spread of the weights. Weights are not subnormal, so e / w_min < 2^-45 and the
// denominator is above 0.99. The factor 1.02 below pays for it and for the rounding of c and of the bound
// itself.
//
// Large batches are evaluated in another way, see prepared_tables.cpp; value_error_bound() is the larger
// bound of the two.
//
// References: [Higham 2002, ch. 3] for the counting of roundings.
#pragma once
#include "coefficients_detail.hpp"
#include "partials_detail.hpp"
#include "prepared_detail.hpp"

#include <freiform/spline/bezier.hpp>
#include <freiform/spline/patch.hpp>
#include <freiform/spline/prepared.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freiform {

namespace detail {

// Sum over the local (p_0 + 1) x .. block of the weights w[d] times the coefficients.
template <std::size_t N, class P>
P contract(const NetView<N, const P>& net, const std::array<const double*, N>& w, const Index<N>& first,
           const Index<N>& count, Index<N>& at, std::size_t d) {
    P sum{};
    int i = first[d];
    for (int k = 0; k < count[d]; ++k) {
        at[d] = i;
        if (d + 1 == N) {
            const P& p = net(at);
            const double weight = w[d][k];
            for (int c = 0; c < P::kCoords; ++c) sum[c] += weight * p[c];
        } else {
            const P inner = contract(net, w, first, count, at, d + 1);
            const double weight = w[d][k];
            for (int c = 0; c < P::kCoords; ++c) sum[c] += weight * inner[c];
        }
        if (++i == net.extent[d]) i = 0;  // closed bases wrap; the others end here
    }
    return sum;
}

template <Basis B>
bool is_closed(const B& basis) {
    if constexpr (requires { basis.is_closed(); })
        return basis.is_closed();
    else
        return false;
}

template <std::size_t N, Basis B>
Result<PreparedNet> prepared(const std::array<B, N>& bases, const Tuples& net) {
    std::vector<BSplineBasis> splines;
    for (const B& b : bases) splines.push_back(spline_basis(b));
    return PreparedNet::make(splines, net);
}

// Whether this many points pay for the tables, which take as long as so many points save, for each span of
// each axis and each of its p + 1 functions. order: of derivatives; kGrid: values on a grid, which takes far
// less than scattered points without tables too. Measured: bench/THRESHOLDS.md.
inline constexpr int kGrid = 3;
template <std::size_t N, Basis B>
bool worth_preparing(const std::array<B, N>& bases, int order, std::size_t points) {
    constexpr double kWorth[3][4] = {{33, 8, 7, 33}, {11, 3.5, 1.7, 50}, {11, 1.8, 0.7, 50}};
    double functions = 0;
    for (const B& b : bases)
        functions += double(b.degree() + 1) * std::max(1, is_closed(b) ? b.size() : b.size() - b.degree());
    return double(points) >= kWorth[N - 1][order] * functions;
}

template <std::size_t N>
std::span<const double> plain(std::span<const Param<N>> at) {
    if constexpr (N == 1)
        return at;
    else
        return {at.empty() ? nullptr : at.data()->data(), at.size() * N};
}

}  // namespace detail

template <std::size_t N, Coefficient P, Basis B>
Result<Patch<N, P, B>> Patch<N, P, B>::make(std::array<B, N> bases, Net<N, P> net) {
    for (std::size_t d = 0; d < N; ++d)
        if (net.extent()[d] != bases[d].size())
            return refuse(
                RefusalKind::invalid, "points",
                text(net.extent()[d], " coefficients along axis ", d, ", the basis has ", bases[d].size()));
    if (auto ok = detail::check_coefficients(tuples(std::as_const(net).flat())); !ok)
        return std::unexpected(ok.error());
    return Patch(std::move(bases), std::move(net));
}

template <std::size_t N, Coefficient P, Basis B>
std::array<Interval, N> Patch<N, P, B>::domain() const {
    std::array<Interval, N> d;
    for (std::size_t k = 0; k < N; ++k) d[k] = bases_[k].domain();
    return d;
}

template <std::size_t N, Coefficient P, Basis B>
Result<void> Patch<N, P, B>::check(const Param<N>& u, std::size_t index) const {
    for (std::size_t d = 0; d < N; ++d) {
        const double x = component<N>(u, d);
        const Interval on = bases_[d].domain();
        if (std::isfinite(x) && (detail::is_closed(bases_[d]) || on.contains(x))) continue;
        return detail::bad_parameter(x, on, "at", index, N == 1 ? -1 : std::ptrdiff_t(d));
    }
    return {};
}

template <std::size_t N, Coefficient P, Basis B>
typename Patch<N, P, B>::Point Patch<N, P, B>::operator()(const Param<N>& u) const {
    double w[N][kMaxDegree + 1];
    std::array<const double*, N> row{};
    Index<N> first{}, count{}, at{};
    for (std::size_t d = 0; d < N; ++d) {
        first[d] = freiform::weights(bases_[d], component<N>(u, d), 0, w[d]) % bases_[d].size();
        count[d] = bases_[d].degree() + 1;
        row[d] = w[d];
    }
    return freiform::project(detail::contract(net_.view(), row, first, count, at, 0));
}

template <std::size_t N, Coefficient P, Basis B>
std::optional<Result<void>> Patch<N, P, B>::by_kernels(std::span<const Param<N>> at, int order,
                                                       std::size_t slots, double* out) const {
    if (!detail::worth_preparing(bases_, order, at.size())) return {};
    const auto fast = detail::prepared(bases_, tuples(net_.flat()));
    if (!fast) return {};
    return fast->evaluate(detail::plain<N>(at), order, slots, {out}, Outside::refuse);
}

template <std::size_t N, Coefficient P, Basis B>
Result<void> Patch<N, P, B>::evaluate(std::span<const Param<N>> at, std::span<Point> out) const {
    FF_REQUIRE(at.size() == out.size());
    if (const auto done = by_kernels(at, 0, 1, numbers(out).data())) return *done;
    for (std::size_t i = 0; i < at.size(); ++i)
        if (auto ok = check(at[i], i); !ok) return ok;
    for (std::size_t i = 0; i < at.size(); ++i) out[i] = (*this)(at[i]);
    return {};
}

template <std::size_t N, Coefficient P, Basis B>
void Patch<N, P, B>::partials(const Param<N>& u, int order, std::span<Point> out) const {
    // Weights of every order along every axis; on the stack for the orders that are common.
    constexpr int kStackOrder = 3;
    double stack[N * (kStackOrder + 1) * (kMaxDegree + 1)];
    std::vector<double> heap;
    double* w = stack;
    const std::size_t per_axis = std::size_t(order + 1) * (kMaxDegree + 1);
    if (order > kStackOrder) {
        heap.resize(N * per_axis);
        w = heap.data();
    }
    Index<N> first{}, count{}, extent{};
    for (std::size_t d = 0; d < N; ++d) {
        const double x = bases_[d].wrap(component<N>(u, d));
        const int s = bases_[d].span(x);
        detail::weights_up_to(bases_[d], s, x, order, kMaxDegree + 1, w + d * per_axis);
        first[d] = (s - bases_[d].degree()) % bases_[d].size();
        count[d] = bases_[d].degree() + 1;
        extent[d] = order + 1;
    }
    const std::size_t size = jet_size(N, order);
    P stack_h[20];  // N = 3, order 3
    std::vector<P> heap_h;
    P* h = stack_h;
    if (size > std::size(stack_h)) {
        heap_h.resize(size);
        h = heap_h.data();
    }
    std::array<const double*, N> row{};
    for (std::size_t d = 0; d < N; ++d) row[d] = w + d * per_axis;
    if constexpr (N <= 2) {
        detail::contract_all<N, P>(net_.view(), row, kMaxDegree + 1, first, count, order, h);
    } else {
        each_index(extent, [&](const Index<N>& a) {
            int sum = 0;
            for (int x : a) sum += x;
            if (sum > order) return;
            std::array<const double*, N> of = row;
            for (std::size_t d = 0; d < N; ++d) of[d] += a[d] * (kMaxDegree + 1);
            Index<N> at{};
            h[jet_slot(a)] = detail::contract(net_.view(), of, first, count, at, 0);
        });
    }
    if constexpr (N <= 2 && Space<P>::kRational)
        if (order <= kStackOrder) return detail::project_low<N, P>(order, h, out);
    project_jet<N, P>(order, std::span<const P>(h, size), out);
}

template <std::size_t N, Coefficient P, Basis B>
std::vector<typename Patch<N, P, B>::Point> Patch<N, P, B>::derivatives(const Param<N>& u, int order) const {
    std::vector<Point> out(jet_size(N, order));
    partials(u, order, out);
    return out;
}

template <std::size_t N, Coefficient P, Basis B>
double Patch<N, P, B>::value_error_bound() const {
    const double unit = std::numeric_limits<double>::epsilon() / 2;
    const double denormal = std::numeric_limits<double>::denorm_min();
    double roundings = 0, terms = 1;
    std::vector<int> degrees;
    for (const B& b : bases_) {
        degrees.push_back(b.degree());
        roundings += std::max(0, 6 * b.degree() - 1);
        terms += b.degree() + 1;
    }
    const double g = 1.01 * roundings * unit, lost = terms * denormal;
    const auto [c, w_min] = detail::reach_of(tuples(net_.flat()));
    const double single =
        Space<P>::kRational ? 1.02 * ((2 * g + unit) * c + (1 + c) * (lost / w_min)) + lost : g * c + lost;
    return std::max(single, detail::batch_error_bound(degrees, tuples(net_.flat())));
}

template <std::size_t N, class P, Basis B>
Result<Net<N, PointOf<P>>> evaluate_grid(const Patch<N, P, B>& s,
                                         const std::array<std::span<const double>, N>& axes) {
    Index<N> extent{};
    for (std::size_t d = 0; d < N; ++d) {
        const Interval on = s.basis(int(d)).domain();
        if (auto ok = detail::check_axis(axes[d], on, detail::is_closed(s.basis(int(d))), d); !ok)
            return std::unexpected(ok.error());
        extent[d] = int(std::min<std::size_t>(axes[d].size(), 0x7fffffff));
    }
    if (const auto points = count_of(extent);
        points > 0 && detail::worth_preparing(s.bases(), detail::kGrid, std::size_t(points))) {
        if (const auto fast = detail::prepared(s.bases(), tuples(s.net().flat()))) {
            Net<N, PointOf<P>> out(extent);
            if (auto ok = fast->evaluate_grid(axes, 0, 1, {numbers(out.flat()).data()}); !ok)
                return std::unexpected(ok.error());
            return out;
        }
    }
    const auto map = [&](std::size_t d) { return collocation(s.basis(int(d)), axes[d]); };
    const auto all = detail::grid_of(tuples(s.net().flat()), s.net().extent(), extent, map);
    if (!all) return std::unexpected(all.error());
    Net<N, PointOf<P>> out(extent);
    std::ranges::copy(*all, numbers(out.flat()).begin());
    return out;
}

template <std::size_t N, class P, Basis B>
std::vector<PointOf<P>> points(const Patch<N, P, B>& s) {
    std::vector<PointOf<P>> out;
    for (const P& p : s.net().flat()) out.push_back(project(p));
    return out;
}

template <std::size_t N, class P, Basis B>
std::vector<double> weights(const Patch<N, P, B>& s) {
    std::vector<double> out;
    for (const P& p : s.net().flat()) out.push_back(Space<P>::weight(p));
    return out;
}

template <std::size_t N, int D, Basis B>
Patch<N, Hom<D>, B> to_rational(const Patch<N, Vec<D>, B>& s) {
    std::vector<Hom<D>> h;
    for (const auto& p : s.net().flat()) h.push_back(weighted(p, 1));
    return Patch<N, Hom<D>, B>::trusted(s.bases(), Net<N, Hom<D>>(s.net().extent(), std::move(h)));
}

template <std::size_t N, class P>
BezierPieces<N, P>::BezierPieces(const Patch<N, P>& patch) : net_(patch.net()) {
    for (std::size_t d = 0; d < N; ++d) {
        const BSplineBasis& basis = patch.basis(int(d));
        const int p = degree_[d] = basis.degree();
        breaks_[d] = basis.breaks();
        // One piece with all its knots at the ends is what it is to become.
        if (!basis.is_closed() && basis.size() == p + 1 && basis.knot(0) == basis.knot(p) &&
            basis.knot(p + 1) == basis.knot(2 * p + 1))
            continue;
        net_ = along(int(d), to_bezier(basis).map, net_);
    }
}
template <std::size_t N, class P>
Index<N> BezierPieces<N, P>::extent() const {
    Index<N> e{};
    for (std::size_t d = 0; d < N; ++d) e[d] = int(breaks_[d].size()) - 1;
    return e;
}
template <std::size_t N, class P>
std::array<Interval, N> BezierPieces<N, P>::box(const Index<N>& piece) const {
    std::array<Interval, N> b;
    for (std::size_t d = 0; d < N; ++d)
        b[d] = {breaks_[d][std::size_t(piece[d])], breaks_[d][std::size_t(piece[d]) + 1]};
    return b;
}
template <std::size_t N, class P>
NetView<N, const P> BezierPieces<N, P>::net(const Index<N>& piece) const {
    Index<N> from{}, size{};
    for (std::size_t d = 0; d < N; ++d) {
        size[d] = degree_[d] + 1;
        from[d] = piece[d] * size[d];
    }
    return net_.view().window(from, size);
}
template <std::size_t N, class P>
Patch<N, P, Bernstein> BezierPieces<N, P>::piece(const Index<N>& index) const {
    const auto on = box(index);
    const auto view = net(index);
    auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<Bernstein, N>{*Bernstein::make(degree_[I], on[I])...};
    }
    (std::make_index_sequence<N>{});
    Net<N, P> own(view.extent);
    each_index(view.extent, [&](const Index<N>& at) { own.view()(at) = view(at); });
    return Patch<N, P, Bernstein>::trusted(std::move(bases), std::move(own));
}

#define FF_INSTANTIATE_PATCH(N, P, B)                                          \
    template class Patch<N, P, B>;                                             \
    template Result<Net<N, PointOf<P>>> evaluate_grid<N, P, B>(                \
        const Patch<N, P, B>&, const std::array<std::span<const double>, N>&); \
    template std::vector<PointOf<P>> points<N, P, B>(const Patch<N, P, B>&);   \
    template std::vector<double> weights<N, P, B>(const Patch<N, P, B>&);
#define FF_INSTANTIATE_PATCHES(N, D)                                                            \
    FF_INSTANTIATE_PATCH(N, Vec<D>, BSplineBasis)                                               \
    FF_INSTANTIATE_PATCH(N, Hom<D>, BSplineBasis)                                               \
    FF_INSTANTIATE_PATCH(N, Vec<D>, Bernstein)                                                  \
    FF_INSTANTIATE_PATCH(N, Hom<D>, Bernstein)                                                  \
    template class BezierPieces<N, Vec<D>>;                                                     \
    template class BezierPieces<N, Hom<D>>;                                                     \
    template Patch<N, Hom<D>, BSplineBasis> to_rational(const Patch<N, Vec<D>, BSplineBasis>&); \
    template Patch<N, Hom<D>, Bernstein> to_rational(const Patch<N, Vec<D>, Bernstein>&);

}  // namespace freiform
