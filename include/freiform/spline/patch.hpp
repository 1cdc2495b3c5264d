// Patch<N, P, B>: a map from an N-dimensional parameter box to space, N = 1 (curve), 2 (surface), 3 (volume).
//
//     f(u) = project( sum_i  B^1_{i1}(u1) .. B^N_{iN}(uN)  P_i )
//
// The coefficient type P says whether it is polynomial (Vec<D>) or rational (Hom<D>), the basis type B
// whether it is one Bezier piece (Bernstein) or a spline, open or closed (BSplineBasis). A patch is valid
// from construction on: finite coefficients, positive weights, as many coefficients as the bases ask for.
#pragma once
#include <freiform/basis/change.hpp>
#include <freiform/spline/jet.hpp>

#include <concepts>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace freiform {

template <std::size_t N, Coefficient P, Basis B = BSplineBasis>
class Patch {
public:
    static constexpr std::size_t kParams = N;
    using Coefficients = P;
    using Point = PointOf<P>;

    // Refuses nets that do not fit the bases, coefficients that are not finite or above 2^1022, and weights
    // that are not positive or subnormal. So every value inside the domain is finite.
    static Result<Patch> make(std::array<B, N> bases, Net<N, P> net);
    // REQUIRES what `make` checks. For results of operations that keep a valid patch valid.
    static Patch trusted(std::array<B, N> bases, Net<N, P> net) { return {std::move(bases), std::move(net)}; }

    const B& basis(int axis = 0) const { return bases_[std::size_t(axis)]; }
    const std::array<B, N>& bases() const { return bases_; }
    const Net<N, P>& net() const { return net_; }
    std::array<Interval, N> domain() const;

    // Primary interface: many parameters, caller's memory. REQUIRES out.size() == at.size().
    // Refuses, with the index, parameters that are not finite or (on open bases) outside the domain.
    // Error of a value: at most value_error_bound(), rounding of the result included.
    Result<void> evaluate(std::span<const Param<N>> at, std::span<Point> out) const;
    template <int K>
    Result<void> evaluate(std::span<const Param<N>> at, std::span<Jet<N, K, Point>> out) const {
        FF_REQUIRE(at.size() == out.size());
        if constexpr (K <= 2) {
            if (out.empty()) return {};
            if (const auto done = by_kernels(at, K, jet_size(N, K), out[0].d[0].c.data())) return *done;
        }
        for (std::size_t i = 0; i < at.size(); ++i) {
            if (auto ok = check(at[i], i); !ok) return ok;
            partials(at[i], K, out[i].d);
            for (const Point& d : out[i].d)
                if (!is_finite(d))
                    return refuse(RefusalKind::ill_conditioned, text("at[", i, "]"),
                                  "a derivative is above the largest double");
        }
        return {};
    }

    // Conveniences. REQUIRES finite parameters; outside the domain the first or last piece is continued.
    Point operator()(const Param<N>& u) const;
    template <std::convertible_to<double>... U>
    requires(sizeof...(U) == N && N > 1) Point operator()(U... u) const {
        return (*this)(Param<N>{double(u)...});
    }
    template <int K>
    Jet<N, K, Point> jet(const Param<N>& u) const {
        Jet<N, K, Point> j;
        partials(u, K, j.d);
        return j;
    }
    // All partial derivatives up to total order `order`, which may be any number >= 0, in graded order.
    std::vector<Point> derivatives(const Param<N>& u, int order) const;

    // A bound of |computed - exact| in each coordinate of a value inside the domain.
    double value_error_bound() const;

    friend bool operator==(const Patch&, const Patch&) = default;

private:
    Patch(std::array<B, N> bases, Net<N, P> net) : bases_(std::move(bases)), net_(std::move(net)) {}
    Result<void> check(const Param<N>& u, std::size_t index) const;
    // With the kernels of spline/prepared.hpp; nothing if preparing would cost more than it saves, or the
    // patch is too extreme for them.
    std::optional<Result<void>> by_kernels(std::span<const Param<N>> at, int order, std::size_t slots,
                                           double* out) const;
    void partials(const Param<N>& u, int order, std::span<Point> out) const;

    std::array<B, N> bases_;
    Net<N, P> net_;
};

template <Coefficient P, Basis B = BSplineBasis>
using Curve = Patch<1, P, B>;
template <Coefficient P, Basis B = BSplineBasis>
using Surface = Patch<2, P, B>;
template <Coefficient P, Basis B = BSplineBasis>
using Volume = Patch<3, P, B>;

// What algorithms ask for that only need values and derivatives.
template <class S, std::size_t N>
concept Parametric = requires(const S& s, const Param<N>& u) {
    { s.domain() } -> std::same_as<std::array<Interval, N>>;
    s.template jet<1>(u);
};

// Replace one basis and carry the net along. Every refinement is this function.
template <std::size_t N, class P, Basis B, Basis C>
Patch<N, P, C> rebase(const Patch<N, P, B>& patch, int axis,
                      Change<C> change) requires(std::same_as<B, C> || N == 1) {
    if constexpr (std::same_as<B, C>) {
        auto bases = patch.bases();
        bases[std::size_t(axis)] = std::move(change.basis);
        return Patch<N, P, C>::trusted(std::move(bases), along(axis, change.map, patch.net()));
    } else {
        return Patch<N, P, C>::trusted({std::move(change.basis)}, along(axis, change.map, patch.net()));
    }
}

template <std::size_t N, class P>
Result<Patch<N, P>> rebase(const Patch<N, P>& patch, int axis, Result<Change<BSplineBasis>> change) {
    if (!change) return std::unexpected(change.error());
    return rebase(patch, axis, std::move(*change));
}

template <std::size_t N, class P>
Result<Patch<N, P>> insert_knots(const Patch<N, P>& s, int axis, std::span<const double> knots) {
    return rebase(s, axis, insert_knots(s.basis(axis), knots));
}
template <std::size_t N, class P>
Result<Patch<N, P>> elevate(const Patch<N, P>& s, int axis, int by = 1) {
    Result<Patch<N, P>> out = s;
    for (; by > 0 && out; --by) out = rebase(*out, axis, elevate(out->basis(axis)));
    return out;
}
template <std::size_t N, class P>
Result<Patch<N, P>> restrict_to(const Patch<N, P>& s, int axis, Interval on) {
    return rebase(s, axis, restrict_to(s.basis(axis), on));
}
template <std::size_t N, class P>
Patch<N, P> reverse(const Patch<N, P>& s, int axis) {
    return rebase(s, axis, reverse(s.basis(axis)));
}
// The partial derivative along `axis`. REQUIRES degree >= 1 there.
template <std::size_t N, class P>
requires(!Space<P>::kRational) Patch<N, P> derivative(const Patch<N, P>& s, int axis) {
    return rebase(s, axis, differentiate(s.basis(axis)));
}

// The patch of one parameter less where parameter `axis` is `at`: an iso-curve of a surface, a face of a
// volume. REQUIRES a finite `at`, of an open basis inside the domain.
template <std::size_t N, class P, Basis B>
requires(N >= 2) Patch<N - 1, P, B> iso(const Patch<N, P, B>& s, int axis, double at) {
    const Net<N, P> net = along(axis, collocation(s.basis(axis), std::span(&at, 1)), s.net());
    Index<N - 1> extent{};
    for (std::size_t d = 0, k = 0; d < N; ++d)
        if (int(d) != axis) extent[k++] = net.extent()[d];
    auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<B, N - 1>{s.basis(int(I) + (int(I) >= axis))...};
    }
    (std::make_index_sequence<N - 1>{});
    return Patch<N - 1, P, B>::trusted(std::move(bases),
                                       Net<N - 1, P>(extent, {net.flat().begin(), net.flat().end()}));
}
// The boundary where parameter `axis` is at the lower (side 0) or upper (side 1) end of its domain.
template <std::size_t N, class P, Basis B>
requires(N >= 2) Patch<N - 1, P, B> boundary(const Patch<N, P, B>& s, int axis, int side) {
    const Interval on = s.basis(axis).domain();
    return iso(s, axis, side == 0 ? on.lo : on.hi);
}

// Values on a tensor grid, by sum factorisation: collocation maps applied axis by axis, then one projection.
// Refuses, as "axes[d][i]", parameters that are not finite or outside the domain.
template <std::size_t N, class P, Basis B>
Result<Net<N, PointOf<P>>> evaluate_grid(const Patch<N, P, B>& s,
                                         const std::array<std::span<const double>, N>& axes);

// Points and weights to coefficients and back.
template <int D>
Result<std::vector<Hom<D>>> make_rational(std::span<const Vec<D>> points, std::span<const double> weights);
template <std::size_t N, class P, Basis B>
std::vector<PointOf<P>> points(const Patch<N, P, B>& s);
template <std::size_t N, class P, Basis B>
std::vector<double> weights(const Patch<N, P, B>& s);  // all 1 if polynomial

// The same map with rational coefficients of weight 1.
template <std::size_t N, int D, Basis B>
Patch<N, Hom<D>, B> to_rational(const Patch<N, Vec<D>, B>& s);

}  // namespace freiform
