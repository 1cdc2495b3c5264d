// Nets of triangles as plain numbers that carry the bounds of their rounding, so that what is done with them
// is compiled once for all kinds of coefficients, and counts its own errors.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/spline/patch.hpp>

namespace freiform::simplex {

// Coefficient after coefficient, `coords` numbers each.
using Flat = std::vector<Bounded>;
using Place = std::array<Bounded, 3>;  // barycentric

constexpr std::size_t count_for(int degree) { return std::size_t((degree + 1) * (degree + 2) / 2); }
constexpr std::size_t slot(int j, int k) { return std::size_t((j + k) * (j + k + 1) / 2 + k); }

Place place_of(const Param<2>& u);  // (1 - u - v, u, v)

// One step of de Casteljau: of a net of degree m, one of degree m - 1.
Flat stepped(const Flat& b, int coords, int m, const Place& t);
Flat elevated(const Flat& b, int coords, int degree);
// The coefficients along an edge, from its beginning (see SimplexPatch): numbers of slots.
std::vector<std::size_t> edge_slots(int degree, int edge);

template <class P>
Flat flat(std::span<const P> b) {
    Flat out;
    out.reserve(b.size() * std::size_t(P::kCoords));
    for (const P& p : b) out.insert(out.end(), p.c.begin(), p.c.end());
    return out;
}

template <class P>
struct Rounded {
    std::vector<P> coefficients;
    double bound = 0;  // of the distance of points, see make/bounded_net_detail.hpp; may be infinite
};
template <class P>
Rounded<P> rounded(const Flat& b) {
    Rounded<P> out;
    double reach = 0, moved = 0, rho = 0;
    for (std::size_t i = 0; i < b.size(); i += std::size_t(P::kCoords)) {
        P p;
        Vec<Space<P>::kDim> error;
        for (int c = 0; c < P::kCoords; ++c) p[c] = b[i + std::size_t(c)].value;
        const double w = Space<P>::weight(p);
        for (int c = 0; c < Space<P>::kDim; ++c) error[c] = b[i + std::size_t(c)].bound / w;
        moved = std::max(moved, norm(error));
        if constexpr (Space<P>::kRational) {
            reach = std::max(reach, norm(project(p)));
            rho = std::max(rho, b[i + std::size_t(Space<P>::kDim)].bound / w);
        }
        out.coefficients.push_back(p);
    }
    out.bound = rho < 0.5 ? (moved + reach * rho) / (1 - rho) * (1 + 0x1p-40)
                          : std::numeric_limits<double>::infinity();
    return out;
}

}  // namespace freiform::simplex
