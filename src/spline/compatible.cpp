// Curves on one basis.
//
// Idea: elevation and insertion of knots leave a curve as it is; the union of all knots, each in the highest
// multiplicity that a curve has it in (after elevation), is the smallest basis that holds all.
//
// Accuracy: every step gives convex combinations of coefficients, off by the relative errors that change.hpp
// states; combinations do not enlarge earlier errors, so they add up. Steps that change nothing add nothing.
//
// Why not nearly equal knots made equal? That changes curves by an amount for which nobody asked.
#include <freiform/spline/compatible.hpp>

#include <algorithm>
#include <map>

namespace freiform {

namespace {

struct CommonKnots {
    int degree = 0;
    std::map<double, int> multiplicity;  // inside the domain; of a closed basis without the upper end
};

bool clamped_at_both_ends(const BSplineBasis& b) {
    return !b.is_closed() && b.multiplicity(b.domain().lo) == b.degree() + 1 &&
           b.multiplicity(b.domain().hi) == b.degree() + 1;
}

// The knots of `b`, moved linearly from its domain to `to`.
Result<BSplineBasis> moved(const BSplineBasis& b, Interval to) {
    const Interval on = b.domain();
    std::vector<double> t(b.defining().begin(), b.defining().end());
    for (double& x : t)
        x = x == on.hi ? to.hi : std::clamp(to.lo + (x - on.lo) / on.length() * to.length(), to.lo, to.hi);
    return b.same_kind(b.degree(), std::move(t));
}

template <class P>
class Common {
public:
    Common(std::span<const Curve<P>> curves, bool closed) : closed_(closed) {
        out_.curves.assign(curves.begin(), curves.end());
        out_.relative.assign(curves.size(), 0.0);
    }

    Result<Compatible<P>> run() {
        for (const auto& c : out_.curves) knots_.degree = std::max(knots_.degree, c.basis().degree());
        for (std::size_t i = 0; i < out_.curves.size(); ++i)
            if (auto ok = prepare(i); !ok) return std::unexpected(ok.error());
        for (const auto& c : out_.curves)
            for (const double t : c.basis().breaks())
                if (!closed_ || t < c.domain()[0].hi) {
                    int& m = knots_.multiplicity[t];
                    m = std::max(m, c.basis().multiplicity(t));
                }
        for (std::size_t i = 0; i < out_.curves.size(); ++i)
            if (auto ok = insert(i); !ok) return std::unexpected(ok.error());
        return std::move(out_);
    }

private:
    Result<void> prepare(std::size_t i) {
        Curve<P>& c = out_.curves[i];
        if (!closed_ && !clamped_at_both_ends(c.basis()))
            if (auto ok = replace(i, restrict_to(c, 0, c.domain()[0]), refinement_error(c.basis().degree()));
                !ok)
                return ok;
        while (c.basis().degree() < knots_.degree)
            if (auto ok = replace(i, elevate(c, 0), elevation_error(c.basis().degree())); !ok) return ok;
        const Interval on = out_.curves[0].domain()[0];
        if (c.domain()[0] == on) return {};
        auto basis = moved(c.basis(), on);
        if (!basis) return std::unexpected(basis.error());
        c = Curve<P>::trusted({std::move(*basis)}, c.net());
        return {};
    }
    Result<void> insert(std::size_t i) {
        Curve<P>& c = out_.curves[i];
        std::vector<double> more;
        for (const auto& [t, m] : knots_.multiplicity)
            more.insert(more.end(), std::size_t(std::max(0, m - c.basis().multiplicity(t))), t);
        if (more.empty()) return {};
        return replace(i, insert_knots(c, 0, more), refinement_error(c.basis().degree()));
    }
    Result<void> replace(std::size_t i, Result<Curve<P>> by, double error) {
        if (!by) return std::unexpected(by.error());
        out_.curves[i] = std::move(*by);
        out_.relative[i] = (out_.relative[i] + error) * (1 + 0x1p-40);
        return {};
    }

    bool closed_;
    CommonKnots knots_;
    Compatible<P> out_;
};

template <class P>
bool agree(const std::vector<Curve<P>>& curves) {
    return std::ranges::all_of(curves, [&](const auto& c) { return c.basis() == curves[0].basis(); });
}

}  // namespace

template <class P>
Result<Compatible<P>> compatible(std::span<const Curve<P>> curves) {
    if (curves.empty()) return refuse(RefusalKind::invalid, "curves", "there are none");
    if (std::ranges::all_of(curves, [](const auto& c) { return c.basis().is_closed(); })) {
        auto closed = Common<P>(curves, true).run();
        // CommonKnots at a seam may be stored before or after it; coefficients are then numbered differently.
        if (closed && agree(closed->curves)) return closed;
    }
    auto open = Common<P>(curves, false).run();
    if (open && !agree(open->curves))
        return refuse(RefusalKind::ill_conditioned, "curves", "rounding leaves no knots that all can have");
    return open;
}

template Result<Compatible<Vec<2>>> compatible(std::span<const Curve<Vec<2>>>);
template Result<Compatible<Vec<3>>> compatible(std::span<const Curve<Vec<3>>>);
template Result<Compatible<Hom<2>>> compatible(std::span<const Curve<Hom<2>>>);
template Result<Compatible<Hom<3>>> compatible(std::span<const Curve<Hom<3>>>);

}  // namespace freiform
