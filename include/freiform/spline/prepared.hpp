// A patch ready to be evaluated at many parameters, by vector instructions of the processor at hand.
//
//     const auto fast = PreparedPatch<2, Hom<3>>::make(surface);
//     fast->evaluate(parameters, points);                       // scattered, in any order
//     fast->evaluate_grid({us, vs}, points, normals);           // points[i * vs.size() + j]
//
// Immutable, shared between threads, cheap to copy. It keeps the net and a small matrix for every span of
// every axis: of a surface of n x m coefficients 4 n m + 12 (p + 1) (n + m) numbers or so, of a curve 12 (p +
// 1) n. Patch::evaluate makes one for itself where that pays; what is evaluated again and again should be
// prepared once.
//
// Threads: more than kParallelFrom points are divided among the threads of core/parallel.hpp. The results are
// the same bits for any number of threads and wherever in a batch a parameter is. Different processors may
// give results that differ by up to twice value_error_bound().
#pragma once
#include <freiform/core/tuples.hpp>
#include <freiform/spline/patch.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

namespace freiform {

// Parameters that are not finite or (on open bases) outside the domain.
enum class Outside {
    refuse,  // the whole batch, with the index of the first, before anything is written
    nan,     // give points and derivatives of NaN
};

namespace detail {

// What PreparedPatch is for any number of parameters and coordinates.
class PreparedNet {
public:
    // Where results go; what is null is not asked for. jets: for each parameter the first `slots` partial
    // derivatives, of order at most `order`. normals need order 1, curvatures order 2.
    struct Destination {
        double* jets = nullptr;
        double* normals = nullptr;
        double* curvatures = nullptr;
        std::size_t numbers(std::size_t jet) const {
            return (jets ? jet : 0) + (normals ? 3 : 0) + (curvatures ? 2 : 0);
        }
    };

    static Result<PreparedNet> make(std::span<const BSplineBasis> bases, const Tuples& net);
    Result<void> evaluate(std::span<const double> at, int order, std::size_t slots, const Destination& to,
                          Outside outside) const;
    Result<void> evaluate_grid(std::span<const std::span<const double>> axes, int order, std::size_t slots,
                               const Destination& to) const;
    Result<void> evaluate_single(std::span<const double> at, float* points, Outside outside) const;
    double error_bound(std::size_t slot) const;

    struct Tables;
    const Tables& tables() const { return *tables_; }

private:
    explicit PreparedNet(std::shared_ptr<const Tables> tables) : tables_(std::move(tables)) {}
    std::shared_ptr<const Tables> tables_;
};

// The grid on every one of the nets, which share the bases; their points one after the other. They are called
// patches[first], patches[first + 1] ..
Result<void> evaluate_grids(std::span<const BSplineBasis> bases, std::span<const Tuples> nets,
                            std::span<const std::span<const double>> axes, std::size_t first, double* points);

inline const BSplineBasis& spline_basis(const BSplineBasis& b) { return b; }
inline BSplineBasis spline_basis(const Bernstein& b) { return *BSplineBasis::bezier(b.degree(), b.domain()); }

}  // namespace detail

// The name of the instruction set that evaluates: base, neon, simd128, avx2 or avx512. The environment
// variable FREIFORM_ISA, read once, chooses another one that the processor has.
std::string_view instruction_set();

struct Curvatures {
    double gauss = 0, mean = 0;  // 1 / length^2, 1 / length
};

template <std::size_t N, Coefficient P>
class PreparedPatch {
public:
    using Point = PointOf<P>;
    static constexpr std::size_t kParallelFrom = 32768;

    // Refuses (`unsupported`) patches with a span shorter than 2^-100 or longer than 2^100, coefficients
    // above 2^100 or weights below 2^-100: such are left to Patch. So nothing overflows here.
    template <Basis B>
    static Result<PreparedPatch> make(const Patch<N, P, B>& patch) {
        std::vector<BSplineBasis> bases;
        for (const B& b : patch.bases()) bases.push_back(detail::spline_basis(b));
        auto net = detail::PreparedNet::make(bases, tuples(patch.net().flat()));
        if (!net) return std::unexpected(net.error());
        return PreparedPatch(std::move(*net));
    }

    // REQUIRES out.size() == at.size().
    Result<void> evaluate(std::span<const Param<N>> at, std::span<Point> out,
                          Outside outside = Outside::refuse) const {
        FF_REQUIRE(at.size() == out.size());
        return net_.evaluate(plain(at), 0, 1, {numbers(out).data()}, outside);
    }
    template <int K>
    requires(K <= 2) Result<void> evaluate(std::span<const Param<N>> at, std::span<Jet<N, K, Point>> out,
                                           Outside outside = Outside::refuse)
    const {
        FF_REQUIRE(at.size() == out.size());
        return net_.evaluate(plain(at), K, jet_size(N, K), {first(out)}, outside);
    }
    // With the unit vector of S_u x S_v, within normal_error_bound(); zero where the product is zero.
    Result<void> evaluate(std::span<const Param<N>> at, std::span<Point> out, std::span<Vec<3>> normals,
                          Outside outside = Outside::refuse) const
        requires(N == 2 && std::same_as<Point, Vec<3>>) {
        FF_REQUIRE(at.size() == out.size() && at.size() == normals.size());
        return net_.evaluate(plain(at), 1, 1, {numbers(out).data(), numbers(normals).data()}, outside);
    }
    template <int K>
    requires(K == 1 ||
             K == 2) Result<void> evaluate(std::span<const Param<N>> at, std::span<Jet<N, K, Point>> out,
                                           std::span<Vec<3>> normals, Outside outside = Outside::refuse)
    const requires(N == 2 && std::same_as<Point, Vec<3>>) {
        FF_REQUIRE(at.size() == out.size() && at.size() == normals.size());
        return net_.evaluate(plain(at), K, jet_size(N, K), {first(out), numbers(normals).data()}, outside);
    }
    // Positive where the surface bends towards S_u x S_v; NaN where that is zero. Without a bound:
    // surface_curvature() has one.
    Result<void> evaluate(std::span<const Param<N>> at, std::span<Curvatures> out,
                          Outside outside = Outside::refuse) const
        requires(N == 2 && std::same_as<Point, Vec<3>>) {
        FF_REQUIRE(at.size() == out.size());
        return net_.evaluate(plain(at), 2, 0, {nullptr, nullptr, pairs(out)}, outside);
    }
    // Rounded to single precision, kDim numbers for each parameter. REQUIRES out.size() == kDim * at.size().
    Result<void> evaluate(std::span<const Param<N>> at, std::span<float> out,
                          Outside outside = Outside::refuse) const {
        FF_REQUIRE(at.size() * std::size_t(Point::kCoords) == out.size());
        return net_.evaluate_single(plain(at), out.data(), outside);
    }

    // On a tensor grid, the last axis fastest. Refuses, as "axes[d][i]", parameters that are not finite or
    // outside the domain. REQUIRES out.size() == the product of the sizes of the axes.
    using Axes = std::array<std::span<const double>, N>;
    Result<void> evaluate_grid(const Axes& axes, std::span<Point> out) const {
        FF_REQUIRE(count(axes) == out.size());
        return net_.evaluate_grid(axes, 0, 1, {numbers(out).data()});
    }
    template <int K>
    requires(K <= 2) Result<void> evaluate_grid(const Axes& axes, std::span<Jet<N, K, Point>> out)
    const {
        FF_REQUIRE(count(axes) == out.size());
        return net_.evaluate_grid(axes, K, jet_size(N, K), {first(out)});
    }
    Result<void> evaluate_grid(const Axes& axes, std::span<Point> out, std::span<Vec<3>> normals) const
        requires(N == 2 && std::same_as<Point, Vec<3>>) {
        FF_REQUIRE(count(axes) == out.size() && normals.size() == out.size());
        return net_.evaluate_grid(axes, 1, 1, {numbers(out).data(), numbers(normals).data()});
    }

    Result<void> evaluate_grid(const Axes& axes, std::span<Curvatures> out) const
        requires(N == 2 && std::same_as<Point, Vec<3>>) {
        FF_REQUIRE(count(axes) == out.size());
        return net_.evaluate_grid(axes, 2, 0, {nullptr, nullptr, pairs(out)});
    }

    // A bound of |computed - exact| in each coordinate of a value, and of a partial derivative of total order
    // <= 2, at any parameter of the domain.
    double value_error_bound() const { return net_.error_bound(0); }
    double error_bound(const Index<N>& orders) const {
        FF_REQUIRE(std::accumulate(orders.begin(), orders.end(), 0) <= 2 && std::ranges::min(orders) >= 0);
        return net_.error_bound(jet_slot(orders));
    }
    // A bound of |computed - exact| of a unit normal where S_u, S_v and S_u x S_v have these lengths.
    double normal_error_bound(double su, double sv, double product) const requires(N == 2) {
        constexpr double kUnit = 0x1p-53;
        const double root = std::sqrt(3.0), eu = root * error_bound({1, 0}), ev = root * error_bound({0, 1});
        const double off = eu * sv + ev * su + eu * ev + 4 * kUnit * su * sv;
        return (2 * off / product + 4 * kUnit) * (1 + 16 * kUnit);
    }

private:
    explicit PreparedPatch(detail::PreparedNet net) : net_(std::move(net)) {}
    static std::span<const double> plain(std::span<const Param<N>> at) {
        if constexpr (N == 1)
            return at;
        else
            return {at.empty() ? nullptr : at.data()->data(), at.size() * N};
    }
    template <int K>
    static double* first(std::span<Jet<N, K, Point>> out) {
        static_assert(sizeof(Jet<N, K, Point>) == jet_size(N, K) * sizeof(Point));
        return out.empty() ? nullptr : out[0].d[0].c.data();
    }
    static double* pairs(std::span<Curvatures> out) {
        static_assert(sizeof(Curvatures) == 2 * sizeof(double));
        return out.empty() ? nullptr : &out[0].gauss;
    }
    static std::size_t count(const Axes& axes) {
        std::size_t n = 1;
        for (const auto& a : axes) n *= a.size();
        return n;
    }
    detail::PreparedNet net_;
};

// The same grid on many patches: the points of patch k are the k-th part of `out`, the last axis fastest.
// What depends on bases and grid alone is computed once for patches of equal bases that follow one another,
// so that a thousand small patches take little more than their points do. Surfaces and volumes: the bits of
// PreparedPatch; curves: within its bound. Refuses what PreparedPatch refuses, parameters as "axes[d][i]",
// the rest with "patches[k]." before the place; patches before k are written then, if their bases differ.
// REQUIRES out.size() == patches.size() times the product of the sizes of the axes.
template <std::size_t N, Coefficient P, Basis B>
Result<void> evaluate_grids(std::span<const Patch<N, P, B>> patches,
                            const std::array<std::span<const double>, N>& axes, std::span<PointOf<P>> out) {
    std::size_t each = 1;
    for (const auto& a : axes) each *= a.size();
    FF_REQUIRE(out.size() == each * patches.size());
    for (std::size_t k = 0, end; k < patches.size(); k = end) {
        std::vector<BSplineBasis> bases;
        std::vector<Tuples> nets;
        for (const B& b : patches[k].bases()) bases.push_back(detail::spline_basis(b));
        for (end = k; end < patches.size() && patches[end].bases() == patches[k].bases(); ++end)
            nets.push_back(tuples(patches[end].net().flat()));
        const auto points = out.subspan(k * each, (end - k) * each);
        if (auto ok = detail::evaluate_grids(bases, nets, axes, k, numbers(points).data()); !ok) return ok;
    }
    return {};
}

}  // namespace freiform
