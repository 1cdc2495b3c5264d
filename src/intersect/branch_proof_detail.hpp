// How far a cubic piece of a curve is from a surface along a cubic piece of parameters: a bound.
//
// Notation. C(t) in space, q(t) in the parameters, 0 <= t <= 1; E = C - S o q.
//
// Accuracy. Over a part of length 1, |E| <= max |E(ends)| + max |E''| / 8, and
//     |E''| <= |C''| + |S_uu| u'^2 + 2 |S_uv u' v'| + |S_vv| v'^2 + |S_u u''| + |S_v v''|
// or, where E'' is continuous, since |4 D - E''(middle)| <= |E'''| / 6 for D = E(0) - 2 E(middle) + E(1),
//     |E| <= max |E(ends)| + |D| / 2 + max |E'''| / 12
// with derivatives of S bounded over a box that contains q. If S has a kink in the box along an axis, S is
// replaced by S with that parameter fixed, off by the width of the box times |S_u|, twice.
#pragma once
#include "cubic_arc_detail.hpp"
#include "sheet_detail.hpp"

namespace freiform::detail {

class BranchProof {
public:
    BranchProof(const SurfaceGeometry& geometry, const Sheet& sheet);
    // Of a surface that is not, or not all, what a sheet is made of.
    BranchProof(const SurfaceGeometry& geometry, const std::array<Interval, 2>& domain);

    // The bound; nothing: it is not up to the tolerance.
    std::optional<double> operator()(const CubicArc<Vec<3>>& c, const CubicArc<Vec<2>>& q,
                                     double tolerance) const;
    // At one place, rounding included.
    double off(const Vec<3>& x, const Vec<2>& u) const { return sample(x, u).size(); }
    bool contains(const Vec<2>& u) const { return domain_[0].contains(u[0]) && domain_[1].contains(u[1]); }
    // Lines of parameters over which second derivatives jump.
    const std::vector<double>& stops(int axis) const { return stops_[std::size_t(axis)]; }

private:
    struct Sample {
        Vec<3> off{};
        double error = 0;
        double size() const { return 1.01 * (norm(off) + error); }
    };
    Sample sample(const Vec<3>& x, const Vec<2>& u) const;
    // What is known of the surface over a box of parameters.
    struct Bending {
        DerivativeBounds<2> d;
        std::array<bool, 2> kinked{};
        bool smooth = true;
    };
    Bending bending(const std::array<Interval, 2>& box) const;
    // `over`: of a box around q, if that has been found.
    bool prove(const CubicArc<Vec<3>>& c, const CubicArc<Vec<2>>& q, const Sample& a, const Sample& b,
               int depth, const Bending* over) const;

    double bound_over(const CubicArc<Vec<3>>& c, const ArcSpeeds& path,
                      const std::array<const Sample*, 3>& at, const Bending& over) const;

    DerivativeQuery<2, 3> query_;
    const Sheet* sheet_ = nullptr;
    std::array<Interval, 2> domain_{};
    double error_ = 0;  // of each coordinate of a value
    std::array<std::vector<double>, 2> stops_;
    mutable double tolerance_ = 0, most_ = 0;
    mutable int parts_ = 0;
};

}  // namespace freiform::detail
