// Shapes as curves and surfaces in space, with rational or polynomial coefficients: what the drawing sees.
// Plane ones lie in z = 0; those of one coordinate become graphs over their parameters.
#pragma once
#include <freiform/basis/greville.hpp>
#include <freiform/spline/bezier.hpp>
#include <freiform/spline/in_space.hpp>

#include <vector>

namespace freiform::drawing {

// The graph of f = F / w is (u w, F) / w, of degree p + 1, piece by piece: with b(s) = sum_i b_i B_i^p(s) on
// [lo, hi], u = lo + (hi - lo) s and s B_i^p(s) = (i + 1) / (p + 1) B_{i+1}^{p+1}(s). All breaks get
// multiplicity p + 2, because f may jump there.
template <class P>
Result<Curve<InSpace<P>>> graph_by_pieces(const Curve<P>& f) {
    const BezierPieces<1, P> pieces(f);
    const int p = pieces.degree(0);
    std::vector<InSpace<P>> c;
    std::vector<double> knots(std::size_t(p) + 2, pieces.breaks(0)[0]);
    for (int piece = 0; piece < pieces.extent()[0]; ++piece) {
        const Interval on = pieces.box({piece})[0];
        const auto b = pieces.net({piece});
        for (int j = 0; j <= p + 1; ++j) {
            const double a = double(j) / (p + 1);
            P raised{};
            double uw = 0;
            if (j <= p) raised += (1 - a) * b({j});
            if (j > 0) raised += a * b({j - 1}), uw = on.length() * a * Space<P>::weight(b({j - 1}));
            InSpace<P> q{};
            q[1] = raised[0];
            double w = 1;
            if constexpr (Space<P>::kRational) q[3] = w = raised.weight();
            q[0] = on.lo * w + uw;
            c.push_back(q);
        }
        knots.insert(knots.end(), std::size_t(p) + 2, on.hi);
    }
    auto basis = BSplineBasis::make(p + 1, std::move(knots));
    if (!basis) return std::unexpected(basis.error());
    const int n = int(c.size());
    return Curve<InSpace<P>>::make({std::move(*basis)}, Net<1, InSpace<P>>({n}, std::move(c)));
}

template <class P>
Result<Curve<InSpace<P>>> lifted(const Curve<P>& curve) {
    if constexpr (Space<P>::kDim == 4) {
        return refuse(RefusalKind::unsupported, "", "its points have four coordinates");
    } else if constexpr (Space<P>::kDim == 1) {
        if (Space<P>::kRational || curve.basis().degree() == 0) return graph_by_pieces(curve);
        auto open = restrict_to(curve, 0, curve.domain()[0]);
        if (!open) return std::unexpected(open.error());
        std::vector<InSpace<P>> c;
        for (int i = 0; i < open->basis().size(); ++i) {
            c.push_back({});
            c.back()[0] = greville(open->basis(), i);
            c.back()[1] = open->net().flat()[std::size_t(i)][0];
        }
        const int n = int(c.size());
        return Curve<InSpace<P>>::trusted(open->bases(), Net<1, InSpace<P>>({n}, std::move(c)));
    } else {
        return in_space(curve);
    }
}

// Surfaces and volumes. Of one coordinate only polynomial surfaces of degrees >= 1.
template <std::size_t N, class P>
Result<Patch<N, InSpace<P>>> lifted(const Patch<N, P>& patch) {
    if constexpr (Space<P>::kDim == 4 || (N == 3 && Space<P>::kDim < 3)) {
        return refuse(RefusalKind::unsupported, "",
                      text("its points have ", Space<P>::kDim, " coordinates, a drawing needs ",
                           N == 3 ? "3" : "2 or 3"));
    } else {
        if constexpr (Space<P>::kDim == 1) {
            Patch<N, P> open = patch;
            std::vector<InSpace<P>> c;
            if (Space<P>::kRational || patch.basis(0).degree() == 0 || patch.basis(1).degree() == 0)
                return refuse(RefusalKind::unsupported, "",
                              "a surface of one coordinate is drawn as a graph if it is polynomial and of "
                              "degrees of at least 1");
            for (int axis = 0; axis < 2; ++axis) {
                auto cut = restrict_to(open, axis, patch.domain()[std::size_t(axis)]);
                if (!cut) return std::unexpected(cut.error());
                open = std::move(*cut);
            }
            each_index(open.net().extent(), [&](const Index<N>& at) {
                c.push_back({});
                c.back()[0] = greville(open.basis(0), at[0]);
                c.back()[1] = greville(open.basis(1), at[1]);
                c.back()[2] = open.net().view()(at)[0];
            });
            return Patch<N, InSpace<P>>::trusted(open.bases(),
                                                 Net<N, InSpace<P>>(open.net().extent(), std::move(c)));
        } else {
            return in_space(patch);
        }
    }
}

}  // namespace freiform::drawing
