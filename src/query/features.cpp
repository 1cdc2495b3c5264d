// Inflections, cusps, extrema and vertices as roots of polynomials.
//
// Notation. C = X / W; for polynomial curves W = 1. N = X' W - X W', so C' = N / W^2. For plane curves
// F = det((X, W), (X', W'), (X'', W'')), a determinant of 3 x 3.
//
// Method.
//     extrema along d      zeros of d . N
//     cusps                common zeros of all N_k
//     curvature            k = W^3 F / |N|^3, so inflections are the zeros of F; in space: common zeros of
//     the
//                          determinants of every two coordinates with W
//     vertices             zeros of (3 W' F + W F') |N|^2 - 3 W F (N . N')
// For row operations with W as pivot clear the first column of the determinant, N / W and (N / W)' remain; a
// common factor does not move zeros. Curvature is 0 where C' and C'' are parallel, in space for every two
// coordinates. The products are taken on Bezier pieces, with bounds; exact pieces whose zeros stay uncertain
// are taken again in integers (piecewise.cpp).
//   Common zeros: zeros of one function at which no other one is certainly different from zero. Generically
// there are none, which doubles prove; what is left is decided by the greatest common divisor in integers.
//   A cusp is a zero of F, too: of even order where the curve turns back (t^2, t^3). Such zeros are not
//   listed
// as flat points.
//
// Accuracy. That of roots.cpp and of Bounded. Degrees: N 2 n - 1, F 3 n - 3 (polynomial: n - 1, 2 n - 3).
//
// References. [Farin 2002, 11.4], [StoneDeRose1989] (inflections, loops and cusps of cubics).
//
// Why not closed formulas for cubics? They need the same care with signs of discriminants, and end at
// degree 3.
#include "query/piecewise_detail.hpp"

#include <freiform/poly/integer_roots.hpp>
#include <freiform/query/checks.hpp>
#include <freiform/query/features.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using namespace detail;

template <class T>
Form<T> speed_of(const Coordinates<T>& c, int k) {
    return derivative(c.x[std::size_t(k)]) * c.w - c.x[std::size_t(k)] * derivative(c.w);
}

// The determinant of coordinates i and j with the weight.
template <class T>
Form<T> bend_of(const Coordinates<T>& c, int i, int j) {
    const Form<T>&x = c.x[std::size_t(i)], &y = c.x[std::size_t(j)], &w = c.w;
    const Form<T> x1 = derivative(x), y1 = derivative(y), w1 = derivative(w);
    const Form<T> x2 = derivative(x1), y2 = derivative(y1), w2 = derivative(w1);
    return x * (y1 * w2 - y2 * w1) - y * (x1 * w2 - x2 * w1) + w * (x1 * y2 - x2 * y1);
}

template <class T>
Form<T> curvature_slope(const Coordinates<T>& c) {
    const Form<T> f = bend_of(c, 0, 1), x = speed_of(c, 0), y = speed_of(c, 1);
    const Form<T> square = x * x + y * y, half_slope = x * derivative(x) + y * derivative(y);
    return (3 * (derivative(c.w) * f) + c.w * derivative(f)) * square - 3 * (c.w * f * half_slope);
}

// A curve with all that the questions share.
template <class P>
struct Question {
    static constexpr int D = Space<P>::kDim;
    const Curve<P>& curve;
    CurvePieces pieces = detail::pieces_of(curve);
    std::vector<double> speed = speed_bounds(pieces);
    double accuracy = 0;

    Feature<D> feature(FeatureKind kind, const Interval& at) const {
        Feature<D> f{kind, at, curve(at.middle()), 0, false};
        f.bound = curve.value_error_bound() * std::sqrt(double(D)) + reach_of(pieces, speed, at);
        return f;
    }

    Result<std::vector<Zero>> zeros(const Expression& f) const {
        std::vector<PieceZeros> all;
        for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
            auto z = zeros_of(f, pieces.pieces[i], D, width_for(accuracy, speed[i]));
            if (!z) return refuse_within(text("pieces[", i, "]"), z.error());
            all.push_back(std::move(*z));
        }
        return joined(pieces, all);
    }

    Result<std::vector<Zero>> common_zeros(std::span<const Expression> functions) const {
        std::vector<PieceZeros> all;
        for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
            auto z = common_zeros_of(functions, pieces.pieces[i], width_for(accuracy, speed[i]));
            if (!z) return refuse_within(text("pieces[", i, "]"), z.error());
            all.push_back(std::move(*z));
        }
        return joined(pieces, all);
    }

private:
    // Is the polynomial certainly not 0 anywhere in this part of [0, 1]?
    static bool excludes_zero(const std::vector<Bounded>& c, const Interval& at) {
        std::vector<Bounded> b = c;
        const Bounded t(at.middle()), s = Bounded(1) - t;
        double step = 0;
        for (std::size_t i = 0; i + 1 < c.size(); ++i) {
            const Bounded d = c[i + 1] - c[i];
            step = std::max(step, std::abs(d.value) + d.bound);
        }
        for (std::size_t r = 1; r < c.size(); ++r)
            for (std::size_t i = 0; i + r < c.size(); ++i) b[i] = s * b[i] + t * b[i + 1];
        b[0].bound += 1.01 * step * double(c.size()) * at.length();
        return b[0].excludes_zero();
    }

    static Result<PieceZeros> common_zeros_of(std::span<const Expression> functions, const CurvePiece& piece,
                                              double width) {
        const auto coordinates = bounded_coordinates(piece, D);
        std::vector<std::vector<Bounded>> values;
        for (const Expression& f : functions) {
            values.push_back(bernstein(f.bounded(coordinates)));
            if (values.back().empty()) values.pop_back();  // zero everywhere: no condition
        }
        PieceZeros out;
        if (values.empty()) {
            out.found.kind = RootsKind::zero;
            return out;
        }
        // The zeros of the first one that is not zero within its error.
        RealRoots candidates;
        candidates.kind = RootsKind::possibly_zero;
        for (const auto& c : values) {
            std::vector<double> v;
            double error = 0;
            for (const Bounded& x : c) v.push_back(x.value), error = std::max(error, x.bound);
            auto found = real_roots(v, width, error);
            if (!found) return std::unexpected(found.error());
            candidates = std::move(*found);
            if (candidates.kind == RootsKind::isolated) break;
        }
        std::erase_if(candidates.roots, [&](const Root& r) {
            return std::any_of(values.begin(), values.end(),
                               [&](const auto& c) { return excludes_zero(c, r.at); });
        });
        if (candidates.kind == RootsKind::isolated && candidates.roots.empty()) return out;
        if (!piece.is_exact()) {
            for (Root& r : candidates.roots) r = {r.at, 0, r.most, false, 0, 0};
            out.found = std::move(candidates);
            return out;
        }
        const auto exact = integer_coordinates(piece, D);
        std::vector<std::vector<Integer>> whole;
        for (const Expression& f : functions) whole.push_back(bernstein(f.whole(exact)));
        const bool zero = std::all_of(whole.begin(), whole.end(), [](const auto& c) {
            return std::all_of(c.begin(), c.end(), [](const Integer& x) { return x.sign() == 0; });
        });
        out.found.kind = zero ? RootsKind::zero : RootsKind::isolated;
        if (!zero) out.found.roots = common_roots(whole, width);
        for (Root& r : out.found.roots) r.before = r.after = 0;  // of the divisor they say nothing
        return out;
    }
};

template <class P>
Result<std::vector<Zero>> cusp_zeros(const Question<P>& q) {
    std::vector<Expression> all;
    for (int k = 0; k < Space<P>::kDim; ++k)
        all.push_back(expression([k](const auto& c) { return speed_of(c, k); }));
    return q.common_zeros(all);
}

bool touches(const Interval& a, std::span<const Zero> places) {
    return std::any_of(places.begin(), places.end(),
                       [&](const Zero& z) { return z.least > 0 && z.at.overlaps(a); });
}

FeatureKind extremum_kind(const Zero& z, bool inside) {
    if (z.everywhere) return FeatureKind::constant;
    if (z.least == 0) return FeatureKind::possible;
    if (z.before > 0 && z.after < 0) return FeatureKind::maximum;
    if (z.before < 0 && z.after > 0) return FeatureKind::minimum;
    return !z.is_one || (inside && z.before * z.after == 0) ? FeatureKind::possible : FeatureKind::stationary;
}

}  // namespace

std::string_view name_of(FeatureKind kind) {
    switch (kind) {
        case FeatureKind::inflection:
            return "inflection";
        case FeatureKind::flat:
            return "flat";
        case FeatureKind::straight:
            return "straight";
        case FeatureKind::cusp:
            return "cusp";
        case FeatureKind::maximum:
            return "maximum";
        case FeatureKind::minimum:
            return "minimum";
        case FeatureKind::stationary:
            return "stationary";
        case FeatureKind::constant:
            return "constant";
        case FeatureKind::possible:
            return "possible";
    }
    return "";
}

template <class P>
requires(Space<P>::kDim == 2 ||
         Space<P>::kDim == 3) Result<std::vector<Feature<Space<P>::kDim>>> inflections(const Curve<P>& curve,
                                                                                       double accuracy) {
    constexpr int D = Space<P>::kDim;
    if (auto ok = detail::check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    Question<P> q{curve};
    q.accuracy = accuracy;
    const auto at_cusps = cusp_zeros(q);
    if (!at_cusps) return std::unexpected(at_cusps.error());
    Result<std::vector<Zero>> zeros;
    if constexpr (D == 2) {
        zeros = q.zeros(expression([](const auto& c) { return bend_of(c, 0, 1); }));
    } else {
        const Expression all[] = {expression([](const auto& c) { return bend_of(c, 0, 1); }),
                                  expression([](const auto& c) { return bend_of(c, 1, 2); }),
                                  expression([](const auto& c) { return bend_of(c, 2, 0); })};
        zeros = q.common_zeros(all);
    }
    if (!zeros) return std::unexpected(zeros.error());
    std::vector<Feature<D>> out;
    for (const Zero& z : *zeros) {
        const bool changes = z.before * z.after < 0;
        FeatureKind kind = z.everywhere   ? FeatureKind::straight
                           : z.least == 0 ? FeatureKind::possible
                           : changes      ? FeatureKind::inflection
                           : z.is_one     ? FeatureKind::flat
                                          : FeatureKind::possible;
        if (!z.everywhere && !changes && touches(z.at, *at_cusps)) continue;
        out.push_back(q.feature(kind, z.at));
        out.back().at_knot = z.jump;
    }
    return out;
}

template <class P>
requires(Space<P>::kDim >= 2) Result<std::vector<Feature<Space<P>::kDim>>> cusps(const Curve<P>& curve,
                                                                                 double accuracy) {
    if (auto ok = detail::check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    Question<P> q{curve};
    q.accuracy = accuracy;
    const auto zeros = cusp_zeros(q);
    if (!zeros) return std::unexpected(zeros.error());
    std::vector<Feature<Space<P>::kDim>> out;
    for (const Zero& z : *zeros)
        out.push_back(q.feature(z.everywhere              ? FeatureKind::constant
                                : z.least > 0 && z.is_one ? FeatureKind::cusp
                                                          : FeatureKind::possible,
                                z.at));
    return out;
}

template <class P>
Result<std::vector<Feature<Space<P>::kDim>>> extrema(const Curve<P>& curve, const PointOf<P>& direction,
                                                     double accuracy) {
    constexpr int D = Space<P>::kDim;
    if (auto ok = detail::check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    if (!is_finite(direction))
        return refuse(RefusalKind::nonfinite, "direction", "has a coordinate that is not finite");
    const double size = max_abs(direction);
    if (size == 0) return refuse(RefusalKind::invalid, "direction", "is zero");
    Question<P> q{curve};
    q.accuracy = accuracy;
    // In units of the largest coordinate; those that vanish beside it by 2^-960 do not count as exact.
    std::vector<double> d;
    for (int k = 0; k < D; ++k) d.push_back(std::scalbn(direction[k], -std::ilogb(size)));
    const Expression f{[d](const Coordinates<Bounded>& c) {
                           Form<Bounded> sum;
                           for (int k = 0; k < D; ++k)
                               if (d[std::size_t(k)] != 0)
                                   sum = sum + Form<Bounded>{{Bounded(d[std::size_t(k)])}} * speed_of(c, k);
                           return sum;
                       },
                       [d](const Coordinates<Integer>& c) {
                           const std::vector<Integer> whole = integer_coefficients(d, 1);
                           Form<Integer> sum;
                           for (int k = 0; k < D; ++k)
                               if (d[std::size_t(k)] != 0)
                                   sum = sum + Form<Integer>{{whole[std::size_t(k)]}} * speed_of(c, k);
                           return sum;
                       }};
    const auto zeros = q.zeros(f);
    if (!zeros) return std::unexpected(zeros.error());
    std::vector<Feature<D>> out;
    const Interval domain = curve.basis().domain();
    for (const Zero& z : *zeros) {
        const bool inside = q.pieces.is_closed || (z.at.lo > domain.lo && z.at.hi < domain.hi);
        out.push_back(q.feature(extremum_kind(z, inside), z.at));
        out.back().at_knot = z.jump;
    }
    return out;
}

template <class P>
requires(Space<P>::kDim == 2) Result<std::vector<Feature<2>>> vertices(const Curve<P>& curve,
                                                                       double accuracy) {
    if (auto ok = detail::check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    Question<P> q{curve};
    q.accuracy = accuracy;
    const auto at_cusps = cusp_zeros(q);
    if (!at_cusps) return std::unexpected(at_cusps.error());
    const auto zeros = q.zeros(expression([](const auto& c) { return curvature_slope(c); }));
    if (!zeros) return std::unexpected(zeros.error());
    std::vector<Feature<2>> out;
    const Interval domain = curve.basis().domain();
    for (const Zero& z : *zeros) {
        if (!z.everywhere && touches(z.at, *at_cusps)) continue;  // the curvature is infinite there
        const bool inside = q.pieces.is_closed || (z.at.lo > domain.lo && z.at.hi < domain.hi);
        out.push_back(q.feature(extremum_kind(z, inside), z.at));
        out.back().at_knot = z.jump;
    }
    return out;
}

#define FF_INSTANTIATE_FEATURES(P, D) \
    template Result<std::vector<Feature<D>>> extrema(const Curve<P>&, const Vec<D>&, double);
#define FF_INSTANTIATE_IN_SPACE(P, D) \
    FF_INSTANTIATE_FEATURES(P, D)     \
    template Result<std::vector<Feature<D>>> cusps(const Curve<P>&, double);
#define FF_INSTANTIATE_BENDING(P, D) \
    FF_INSTANTIATE_IN_SPACE(P, D)    \
    template Result<std::vector<Feature<D>>> inflections(const Curve<P>&, double);
FF_INSTANTIATE_FEATURES(Vec<1>, 1)
FF_INSTANTIATE_FEATURES(Hom<1>, 1)
FF_INSTANTIATE_BENDING(Vec<2>, 2)
FF_INSTANTIATE_BENDING(Hom<2>, 2)
FF_INSTANTIATE_BENDING(Vec<3>, 3)
FF_INSTANTIATE_BENDING(Hom<3>, 3)
FF_INSTANTIATE_IN_SPACE(Vec<4>, 4)
FF_INSTANTIATE_IN_SPACE(Hom<4>, 4)
#undef FF_INSTANTIATE_FEATURES
#undef FF_INSTANTIATE_IN_SPACE
#undef FF_INSTANTIATE_BENDING
template Result<std::vector<Feature<2>>> vertices(const Curve<Vec<2>>&, double);
template Result<std::vector<Feature<2>>> vertices(const Curve<Hom<2>>&, double);

}  // namespace freiform
