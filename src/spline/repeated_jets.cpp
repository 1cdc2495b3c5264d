#include "partials_detail.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/spline/repeated_jets.hpp>

#include <algorithm>
#include <bit>
#include <limits>

#if !defined(__wasm__)
namespace freiform {

namespace {

constexpr int kMost = 4;  // weights of a parameter
constexpr std::size_t kFewPlaces = 64, kMostKept = 512;

template <class S>
constexpr bool is_spline = requires(const S& s) {
    s.net();
};

}  // namespace

RepeatedJets::RepeatedJets(const SurfaceGeometry& surface, std::size_t places) : surface_(&surface) {
    if (places < kFewPlaces) return;
    visit_one(
        [&](const auto& s) {
            if constexpr (is_spline<std::remove_cvref_t<decltype(s)>>)
                if (s.basis(0).degree() < kMost && s.basis(1).degree() < kMost)
                    for (auto& kept : kept_)
                        kept.assign(
                            std::bit_floor(std::min(places, kMostKept)),
                            {std::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN()), 0, {}});
        },
        surface);
}

template <class S>
const RepeatedJets::Weights& RepeatedJets::weights(const S& surface, std::size_t axis, double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    Weights& w = kept_[axis][(bits * 0x9e3779b97f4a7c15u >> 32) & (kept_[axis].size() - 1)];
    if (w.at == bits) return w;
    const auto& basis = surface.basis(int(axis));
    const double wrapped = basis.wrap(x);
    const int span = basis.span(wrapped);
    detail::weights_up_to(basis, span, wrapped, 2, kMost, w.of_order[0]);
    w.at = bits, w.first = (span - basis.degree()) % basis.size();
    return w;
}

template <int K>
Jet<2, K, Vec<3>> RepeatedJets::at(const Param<2>& uv) {
    if (kept_[0].empty()) return jet<K>(*surface_, uv);
    return visit_one(
        [&](const auto& s) {
            using S = std::remove_cvref_t<decltype(s)>;
            Jet<2, K, Vec<3>> out;
            if constexpr (is_spline<S>) {
                using P = typename S::Coefficients;
                const Weights &u = weights(s, 0, uv[0]), &v = weights(s, 1, uv[1]);
                P h[jet_size(2, K)];
                detail::contract_all<2, P>(s.net().view(), {u.of_order[0], v.of_order[0]}, kMost,
                                           {u.first, v.first},
                                           {s.basis(0).degree() + 1, s.basis(1).degree() + 1}, K, h);
                if constexpr (Space<P>::kRational)
                    detail::project_low<2, P>(K, h, out.d);
                else
                    project_jet<2, P>(K, std::span<const P>(h), out.d);
            }
            return out;
        },
        *surface_);
}

template Jet<2, 1, Vec<3>> RepeatedJets::at<1>(const Param<2>&);
template Jet<2, 2, Vec<3>> RepeatedJets::at<2>(const Param<2>&);

}  // namespace freiform
#endif
