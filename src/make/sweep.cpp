// Extrusions, ruled and translational surfaces.
//
// Idea: each is linear in the homogeneous coefficients of one curve, so it is a tensor product whose net can
// be written down. With coefficients (A, a) of the profile and (B, b) of the rail, weights in small letters:
//     extrusion       (A, a),  (A + a vector, a)
//     ruled           (A, a),  (B, b)                        on the common basis
//     translational   (A b + a (B - b r), a b)               r = rail(v0)
//
// Accuracy: computed with bounds (rounding_detail.hpp); what elevation and insertion of knots add is known
// from compatible.hpp.
//
// References: [PT97, 8.3, 8.4, 10.4].
//
// Why not ruled surfaces that divide rulings evenly for rational curves, too? That multiplies both curves
// with the weights of the other and doubles the degree, for the same lines.
#include "rounding_detail.hpp"

#include <freiform/make/sweep.hpp>
#include <freiform/spline/accurate.hpp>
#include <freiform/spline/compatible.hpp>

namespace freiform {

namespace {

using detail::Powers;
using detail::SpaceCoefficient;
using detail::SurfaceNet;

template <class Q>
Result<MadeSurface<Q>> finished(SurfaceNet<Q> net, const BSplineBasis& u, Result<BSplineBasis> v) {
    if (!v) return std::unexpected(v.error());
    const double bound = net.bound();
    const Index<2> extent{u.size(), v->size()};
    auto surface = Surface<Q>::make({u, std::move(*v)}, Net<2, Q>(extent, net.take()));
    if (!surface) return std::unexpected(surface.error());
    if (!std::isfinite(bound))
        return refuse(RefusalKind::ill_conditioned, "weights", "rounding leaves nothing of them");
    return MadeSurface<Q>{std::move(*surface), bound};
}

// The coefficients of a curve, each off by what making it compatible may have moved.
template <class P>
std::vector<SpaceCoefficient> coefficients(const Powers& powers, const Curve<P>& curve, double relative) {
    double largest = 0, heaviest = 0;
    std::vector<SpaceCoefficient> out;
    for (const P& p : curve.net().flat()) {
        out.push_back(powers.coefficient(p));
        for (const Bounded& x : out.back().x) largest = std::max(largest, std::abs(x.value));
        heaviest = std::max(heaviest, out.back().w.value);
    }
    if (relative == 0) return out;
    for (SpaceCoefficient& c : out) {
        for (Bounded& x : c.x) x.bound += relative * largest * (1 + 0x1p-40);
        if constexpr (Space<P>::kRational) c.w.bound += relative * heaviest * (1 + 0x1p-40);
    }
    return out;
}

// rail(v0) in divided units.
template <class P>
Result<BoundedVec<3>> start(const Powers& powers, const Curve<P>& rail) {
    const double at = rail.domain()[0].lo;
    if (!rail.basis().is_closed() && rail.basis().multiplicity(at) > rail.basis().degree()) {
        const auto c = powers.coefficient(rail.net().flat()[0]);
        if (!Space<P>::kRational) return c.x;
        return BoundedVec<3>{c.x[0] / c.w, c.x[1] / c.w, c.x[2] / c.w};
    }
    Accurate<PointOf<P>> value;
    if (auto ok = evaluate_accurate(rail, std::span<const double>(&at, 1), std::span(&value, 1)); !ok)
        return refuse_within("rail", ok.error());
    BoundedVec<3> r{};
    for (int i = 0; i < Space<P>::kDim; ++i) {
        r[std::size_t(i)] = detail::scaled(value.value[i], -powers.point());
        r[std::size_t(i)].bound += std::scalbn(value.bound[i], -powers.point()) + 0x1p-1070;
    }
    return r;
}

}  // namespace

template <class P>
Result<MadeSurface<InSpace<P>>> extrude(const Curve<P>& profile, const Vec<3>& vector) {
    if (!is_finite(vector)) return refuse(RefusalKind::nonfinite, "vector", "is not finite");
    if (max_abs(vector) == 0) return refuse(RefusalKind::invalid, "vector", "is zero");
    Powers powers;
    powers.include(profile);
    powers.include(vector);
    const BoundedVec<3> by = powers.vector(vector);
    SurfaceNet<InSpace<P>> net(powers);
    for (const P& p : profile.net().flat()) {
        net.add_exact(p);
        SpaceCoefficient c = powers.coefficient(p);
        for (std::size_t i = 0; i < 3; ++i) c.x[i] += c.w * by[i];
        net.add(c);
    }
    return finished(std::move(net), profile.basis(), BSplineBasis::bezier(1));
}

template <class P>
Result<MadeSurface<InSpace<P>>> ruled(const Curve<P>& a, const Curve<P>& b) {
    const Curve<P> both[] = {a, b};
    const auto same = compatible(std::span<const Curve<P>>(both));
    if (!same) return std::unexpected(same.error());
    Powers powers;
    powers.include(a);
    powers.include(b);
    SurfaceNet<InSpace<P>> net(powers);
    const auto from = coefficients(powers, same->curves[0], same->relative[0]);
    const auto to = coefficients(powers, same->curves[1], same->relative[1]);
    for (std::size_t i = 0; i < from.size(); ++i) {
        net.add(from[i]);
        net.add(to[i]);
    }
    return finished(std::move(net), same->curves[0].basis(), BSplineBasis::bezier(1));
}

template <class P>
Result<MadeSurface<InSpace<P>>> translate_along(const Curve<P>& profile, const Curve<P>& rail) {
    Powers powers;
    powers.include(profile);
    powers.include(rail);
    const auto r = start(powers, rail);
    if (!r) return std::unexpected(r.error());
    // Of the weights, products are taken; so each curve has its own power of two.
    Powers of_rail = powers, of_profile = powers;
    of_rail.heaviest = of_profile.heaviest = 0;
    of_profile.include(profile);
    of_rail.include(rail);
    const auto a = coefficients(of_profile, profile, 0.0), b = coefficients(of_rail, rail, 0.0);
    Powers product = powers;
    product.heaviest = std::scalbn(1.0, of_profile.weight() + of_rail.weight());
    SurfaceNet<InSpace<P>> net(product);
    for (const SpaceCoefficient& p : a)
        for (const SpaceCoefficient& q : b) {
            SpaceCoefficient c;
            for (std::size_t i = 0; i < 3; ++i) c.x[i] = p.x[i] * q.w + p.w * (q.x[i] - q.w * (*r)[i]);
            c.w = p.w * q.w;
            net.add(c);
        }
    return finished(std::move(net), profile.basis(), Result<BSplineBasis>(rail.basis()));
}

#define FF_SWEEP(P)                                                                   \
    template Result<MadeSurface<InSpace<P>>> extrude(const Curve<P>&, const Vec<3>&); \
    template Result<MadeSurface<InSpace<P>>> ruled(const Curve<P>&, const Curve<P>&); \
    template Result<MadeSurface<InSpace<P>>> translate_along(const Curve<P>&, const Curve<P>&);
FF_SWEEP(Vec<2>)
FF_SWEEP(Hom<2>)
FF_SWEEP(Vec<3>)
FF_SWEEP(Hom<3>)
#undef FF_SWEEP

}  // namespace freiform
