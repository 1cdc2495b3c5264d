// Gordon surfaces.
//
// Idea: the Boolean sum (boolean_sum.hpp) with the cardinal splines of the parameters: function k is 1 at
// at[k] and 0 at the others.
//
// Method: cardinal splines are interpolated like any data, and brought to one basis with the curves that run
// the same way, as curves (f, 0, 0).
//
// Accuracy: let the functions miss 1 and 0 by eps at most (the residual of their interpolation), T be a
// matrix of points from which both curves are at most gap / 2 + rounding = t away, M >= |a_k|, |T_kl|, and L
// the largest sum over l of |coefficient i of g_l|, which bounds sum |g_l(u)|. On the line v = at_v[k'] the
// sum differs from a_k' by
//     sum_k (h_k - delta_kk') a_k + sum_l g_l (b_l(at_v[k']) - T_k'l) - sum_l g_l sum_k (h_k - delta) T_kl,
// hence by at most K eps M + L t + L K eps M; and the same with the families exchanged. To that the bound of
// the net is added, which contains the roundings of its coefficients against exact curves and functions.
//
// References: [Gordon 1969], [Farin 2002, ch. 22].
#include <freiform/fit/loft.hpp>
#include <freiform/make/boolean_sum.hpp>
#include <freiform/spline/compatible.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

double max_abs_of(const Curve<Vec<3>>& c) {
    double m = 0;
    for (const Vec<3>& p : c.net().flat()) m = std::max(m, max_abs(p));
    return m;
}
// What an error of `relative` times the largest numerator and weight moves a coordinate by.
double moved_by(const Curve<Vec<3>>& c, double relative) { return relative * max_abs_of(c); }
double moved_by(const Curve<Hom<3>>& c, double relative) {
    double largest = 0, reach = 0, heaviest = 0, lightest = std::numeric_limits<double>::infinity();
    for (const Hom<3>& p : c.net().flat()) {
        for (int d = 0; d < 3; ++d) largest = std::max(largest, std::abs(p[d]));
        reach = std::max(reach, max_abs(project(p)));
        heaviest = std::max(heaviest, p.weight()), lightest = std::min(lightest, p.weight());
    }
    return relative * (largest + reach * heaviest) / (lightest - relative * heaviest) * (1 + 0x1p-40);
}

struct Family {
    BlendedFamily blend;
    double eps = 0;       // of the functions, which belong to the other family's basis
    double lebesgue = 0;  // L of the functions
    double reach = 0;     // M of the curves
};

std::vector<BoundedVec<3>> row_of(const Curve<Vec<3>>& c, double relative) {
    const double e = relative * max_abs_of(c) * (1 + 0x1p-40);
    std::vector<BoundedVec<3>> out;
    for (const Vec<3>& p : c.net().flat()) out.push_back({Bounded(p[0], e), {p[1], e}, {p[2], e}});
    return out;
}

Result<void> check_parameters(std::span<const double> at, std::size_t curves, Interval on, const char* name) {
    if (at.size() != curves || curves < 2)
        return refuse(RefusalKind::invalid, name,
                      text(at.size(), " parameters for ", curves, " curves; at least 2 of each are needed"));
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (!std::isfinite(at[i]))
            return refuse(RefusalKind::nonfinite, text(name, "[", i, "]"), "is not finite");
        if (i > 0 && !(at[i - 1] < at[i]))
            return refuse(RefusalKind::invalid, text(name, "[", i, "]"), "does not increase");
    }
    if (at.front() != on.lo || at.back() != on.hi)
        return refuse(RefusalKind::invalid, name,
                      text("run from ", at.front(), " to ", at.back(),
                           ", the curves of the other family from ", on.lo, " to ", on.hi));
    return {};
}

Result<std::vector<Curve<Vec<1>>>> cardinals(std::span<const double> at, double& eps) {
    const AxisSpline axis{std::min(3, int(at.size()) - 1), SplineEnds::not_a_knot, at};
    std::vector<Curve<Vec<1>>> all;
    for (std::size_t k = 0; k < at.size(); ++k) {
        std::vector<Vec<1>> one(at.size());
        one[k][0] = 1;
        auto f = interpolate<1>(std::span<const Vec<1>>(one), axis);
        if (!f) return std::unexpected(f.error());
        eps = std::max(eps, f->bound);
        all.push_back(std::move(f->patch));
    }
    return all;
}

// The curves on one basis together with the cardinal splines of `at`, which come last.
template <int D>
Result<Compatible<Vec<3>>> with_cardinals(std::span<const Curve<Vec<D>>> curves, std::span<const double> at,
                                          double& eps) {
    std::vector<Curve<Vec<3>>> all;
    for (const auto& c : curves) {
        if (c.basis().degree() < 1)
            return refuse(RefusalKind::unsupported, text("[", all.size(), "]"), "has degree 0");
        all.push_back(in_space(c));
    }
    const auto functions = cardinals(at, eps);
    if (!functions) return std::unexpected(functions.error());
    for (const auto& f : *functions) all.push_back(in_space(f));
    return compatible(std::span<const Curve<Vec<3>>>(all));
}

// Splits what with_cardinals made: curves to `own`, functions to `other`.
void distribute(const Compatible<Vec<3>>& same, std::size_t curves, Family& own, Family& other) {
    for (std::size_t i = 0; i < same.curves.size(); ++i) {
        const auto row = row_of(same.curves[i], same.relative[i]);
        if (i < curves) {
            own.blend.curves.push_back(row);
            for (const auto& p : row)
                own.reach = std::max(own.reach, norm(Vec<3>{{p[0].value, p[1].value, p[2].value}}));
            continue;
        }
        auto& f = other.blend.functions.emplace_back();
        for (const auto& p : row) f.push_back(p[0]);
    }
    for (int i = 0; i < own.blend.basis.size(); ++i) {
        double sum = 0;
        for (const auto& f : other.blend.functions)
            sum += std::abs(f[std::size_t(i)].value) + f[std::size_t(i)].bound;
        other.lebesgue = std::max(other.lebesgue, sum);
    }
}

struct Meetings {
    std::vector<std::vector<BoundedVec<3>>> middle;
    double gap = 0, off = 0;  // between the curves; of either from the middle
};

template <class Q>
Result<Meetings> meetings(const Compatible<Q>& u, std::span<const double> at_v, const Compatible<Q>& v,
                          std::span<const double> at_u, double tolerance) {
    Meetings out;
    for (std::size_t k = 0; k < at_v.size(); ++k) {
        out.middle.emplace_back();
        for (std::size_t l = 0; l < at_u.size(); ++l) {
            const Vec<3> p = u.curves[k](at_u[l]), q = v.curves[l](at_v[k]);
            // Rounding of the values, and what common bases moved.
            const double e =
                std::sqrt(3) * (u.curves[k].value_error_bound() + v.curves[l].value_error_bound() +
                                moved_by(u.curves[k], u.relative[k]) + moved_by(v.curves[l], v.relative[l]));
            const double found = norm(p - q) * (1 + 0x1p-48) + e;
            if (found - 2 * e > tolerance)
                return refuse(RefusalKind::invalid, text("u_curves[", k, "], v_curves[", l, "]"),
                              text("are ", norm(p - q), " apart at u = ", at_u[l], ", v = ", at_v[k],
                                   ", more than the tolerance ", tolerance));
            const Vec<3> m = p == q ? p : 0.5 * p + 0.5 * q;
            out.middle.back().push_back({Bounded(m[0]), Bounded(m[1]), Bounded(m[2])});
            out.gap = std::max(out.gap, found);
            out.off = std::max(out.off, (std::max(norm(p - m), norm(q - m))) * (1 + 0x1p-48) + e);
        }
    }
    return out;
}

template <class P>
Result<void> check_network(std::span<const Curve<P>> u_curves, std::span<const double> at_v,
                           std::span<const Curve<P>> v_curves, std::span<const double> at_u,
                           double tolerance) {
    if (u_curves.empty() || v_curves.empty())
        return refuse(RefusalKind::invalid, "curves", "a network needs at least two of each family");
    if (auto ok = check_parameters(at_v, u_curves.size(), v_curves[0].domain()[0], "at_v"); !ok) return ok;
    if (auto ok = check_parameters(at_u, v_curves.size(), u_curves[0].domain()[0], "at_u"); !ok) return ok;
    if (!(tolerance >= 0)) return refuse(RefusalKind::invalid, "tolerance", "is not a distance");
    return {};
}

// Of one family of rational curves, and what the bound is made of.
struct RationalFamily {
    OverOne over_one;
    Compatible<Hom<3>> same;
    double eps = 0, lebesgue = 0, reach = 0;
};
template <int D>
Result<RationalFamily> rational_family(std::span<const Curve<Hom<D>>> curves, std::span<const double> at) {
    RationalFamily out{{*BSplineBasis::bezier(1), {}, {}, {}}, {}};
    std::vector<Curve<Hom<3>>> all;
    for (const auto& c : curves) {
        if (c.basis().degree() < 1)
            return refuse(RefusalKind::unsupported, text("[", all.size(), "]"), "has degree 0");
        all.push_back(in_space(c));
        for (const Hom<3>& p : all.back().net().flat()) out.reach = std::max(out.reach, norm(project(p)));
    }
    const auto functions = cardinals(at, out.eps);
    if (!functions) return std::unexpected(functions.error());
    for (std::size_t i = 0; i < (*functions)[0].net().flat().size(); ++i) {
        double sum = 0;
        for (const auto& f : *functions) sum += std::abs(f.net().flat()[i][0]);
        out.lebesgue = std::max(out.lebesgue, sum * (1 + 0x1p-40));
    }
    auto over_one = over_one_denominator(all, *functions);
    if (!over_one) return std::unexpected(over_one.error());
    auto same = compatible(std::span<const Curve<Hom<3>>>(all));
    if (!same) return std::unexpected(same.error());
    out.over_one = *std::move(over_one), out.same = *std::move(same);
    return out;
}

// eps and lebesgue are those of the functions of u and of v; there are as many of v as curves along u.
double off_curves(double reach, double off, double eps_u, double eps_v, double lebesgue_u, double lebesgue_v,
                  std::size_t count_u, std::size_t count_v) {
    const double on_u_curves = double(count_v) * eps_v * reach * (1 + lebesgue_u) + lebesgue_u * off;
    const double on_v_curves = double(count_u) * eps_u * reach * (1 + lebesgue_v) + lebesgue_v * off;
    return std::max(on_u_curves, on_v_curves);
}

}  // namespace

template <int D>
Result<GordonSurface<Hom<3>>> gordon(std::span<const Curve<Hom<D>>> u_curves, std::span<const double> at_v,
                                     std::span<const Curve<Hom<D>>> v_curves, std::span<const double> at_u,
                                     double tolerance) {
    if (auto ok = check_network(u_curves, at_v, v_curves, at_u, tolerance); !ok)
        return std::unexpected(ok.error());
    const auto u = rational_family(u_curves, at_u), v = rational_family(v_curves, at_v);
    if (!u) return refuse_within("u_curves", u.error());
    if (!v) return refuse_within("v_curves", v.error());
    const auto met = meetings(u->same, at_v, v->same, at_u, tolerance);
    if (!met) return std::unexpected(met.error());
    auto made = boolean_sum(u->over_one, v->over_one, met->middle);
    if (!made) return std::unexpected(made.error());
    const double reach = std::max(u->reach, v->reach) + met->off;
    const double bound = (made->bound + off_curves(reach, met->off, u->eps, v->eps, u->lebesgue, v->lebesgue,
                                                   at_u.size(), at_v.size())) *
                         (1 + 0x1p-40);
    return GordonSurface<Hom<3>>{std::move(made->surface), bound, met->gap};
}

template <int D>
Result<GordonSurface<Vec<3>>> gordon(std::span<const Curve<Vec<D>>> u_curves, std::span<const double> at_v,
                                     std::span<const Curve<Vec<D>>> v_curves, std::span<const double> at_u,
                                     double tolerance) {
    if (auto ok = check_network(u_curves, at_v, v_curves, at_u, tolerance); !ok)
        return std::unexpected(ok.error());
    double eps_u = 0, eps_v = 0;
    const auto along_u = with_cardinals(u_curves, at_u, eps_u),
               along_v = with_cardinals(v_curves, at_v, eps_v);
    if (!along_u) return refuse_within("u_curves", along_u.error());
    if (!along_v) return refuse_within("v_curves", along_v.error());
    Family u{{along_u->curves[0].basis(), {}, {}}}, v{{along_v->curves[0].basis(), {}, {}}};
    distribute(*along_u, u_curves.size(), u, v);
    distribute(*along_v, v_curves.size(), v, u);
    const auto met = meetings(*along_u, at_v, *along_v, at_u, tolerance);
    if (!met) return std::unexpected(met.error());
    auto made = boolean_sum(u.blend, v.blend, met->middle);
    if (!made) return std::unexpected(made.error());
    // v.lebesgue is that of the functions of u, which multiply the curves of v.
    const double reach = std::max(u.reach, v.reach) + met->off;
    const double bound = (made->bound + off_curves(reach, met->off, eps_u, eps_v, v.lebesgue, u.lebesgue,
                                                   at_u.size(), at_v.size())) *
                         (1 + 0x1p-40);
    return GordonSurface<Vec<3>>{std::move(made->surface), bound, met->gap};
}

#define FF_GORDON(D)                                                                                       \
    template Result<GordonSurface<Vec<3>>> gordon(std::span<const Curve<Vec<D>>>, std::span<const double>, \
                                                  std::span<const Curve<Vec<D>>>, std::span<const double>, \
                                                  double);                                                 \
    template Result<GordonSurface<Hom<3>>> gordon(std::span<const Curve<Hom<D>>>, std::span<const double>, \
                                                  std::span<const Curve<Hom<D>>>, std::span<const double>, \
                                                  double);
FF_GORDON(2)
FF_GORDON(3)
#undef FF_GORDON

}  // namespace freiform
