// Changes of basis by blossoms.
//
// Idea: coefficient j of a spline on knots t' is its blossom at (t'_{j+1}, .., t'_{j+p}) [Ramshaw 1989]. So a
// new knot vector alone says what the new coefficients are; which map it is (insertion, restriction, Bezier
// extraction) only depends on how t' was made.
// Notation: `old` has knots t and degree p, `fresh` has knots t'.
// Accuracy: for insertion all entries of a row are non-negative and sum to 1 up to rounding (Oslo algorithm
// [Cohen Lyche Riesenfeld 1980]). For elevation they are means of blossoms whose arguments leave the span,
// with entries of both signs; tests tally the growth. Why not Boehm's algorithm: it inserts one knot after
// the other; the rows here are independent of each other.
#include <freiform/basis/change.hpp>

#include <algorithm>

namespace freiform {

namespace {

// The map from `old` to `fresh` whose row j is what `row(span of old, t' + j + 1, w)` adds to w[0..p].
template <class F>
Change<BSplineBasis> change(const BSplineBasis& old, BSplineBasis fresh, F&& row) {
    const int width = old.degree() + 1, rows = fresh.size();
    BandMap m{old.size(), width, std::vector<int>(std::size_t(rows)),
              std::vector<double>(std::size_t(rows) * std::size_t(width))};
    for (int j = fresh.wrapped(); j < fresh.wrapped() + rows; ++j) {
        const int s = old.span(fresh.knot(j)), r = j % rows;
        m.first[std::size_t(r)] = s - old.degree();
        row(s, fresh.knots().data() + j + 1, &m.entry[std::size_t(r) * std::size_t(width)]);
    }
    return {std::move(fresh), std::move(m)};
}

Change<BSplineBasis> refined(const BSplineBasis& old, BSplineBasis fresh) {
    return change(old, std::move(fresh),
                  [&](int s, const double* args, double* w) { blossom(old, s, args, w); });
}

}  // namespace

Result<Change<BSplineBasis>> insert_knots(const BSplineBasis& old, std::span<const double> more) {
    for (std::size_t i = 0; i < more.size(); ++i) {
        if (!old.domain().contains(more[i]))
            return refuse(
                RefusalKind::out_of_domain, text("knots[", i, "]"),
                text(more[i], " is outside the domain [", old.domain().lo, ", ", old.domain().hi, "]"));
        if (i > 0 && more[i] < more[i - 1])
            return refuse(RefusalKind::invalid, text("knots[", i, "]"),
                          text("decreases: ", more[i - 1], " -> ", more[i]));
    }
    std::vector<double> t;
    std::merge(old.defining().begin(), old.defining().end(), more.begin(), more.end(), std::back_inserter(t));
    auto fresh = old.same_kind(old.degree(), std::move(t));
    if (!fresh) return std::unexpected(fresh.error());
    return refined(old, std::move(*fresh));
}

Result<Change<BSplineBasis>> elevate(const BSplineBasis& old) {
    const int p = old.degree();
    const auto from = old.defining();
    std::vector<double> t;
    for (std::size_t i = 0; i < from.size(); ++i) {
        t.push_back(from[i]);
        if (i + 1 == from.size() ? !old.is_closed() : from[i] != from[i + 1]) t.push_back(from[i]);
    }
    auto fresh = old.same_kind(p + 1, std::move(t));
    if (!fresh) return std::unexpected(fresh.error());
    // The blossom of degree p + 1 is the mean of the old one over all arguments but one.
    return change(old, std::move(*fresh), [&](int s, const double* args, double* w) {
        double some[kMaxDegree + 1], v[kMaxDegree + 1];
        for (int skip = 0; skip <= p; ++skip) {
            for (int k = 0; k < p; ++k) some[k] = args[k + (k >= skip)];
            blossom(old, s, static_cast<const double*>(some), v);
            for (int k = 0; k <= p; ++k) w[k] += v[k] / (p + 1);
        }
    });
}

Result<Change<BSplineBasis>> restrict_to(const BSplineBasis& old, Interval on) {
    const int p = old.degree();
    if (!old.domain().contains(on.lo) || !old.domain().contains(on.hi) || !(on.lo < on.hi))
        return refuse(RefusalKind::out_of_domain, "interval",
                      text("[", on.lo, ", ", on.hi, "] is empty or outside the domain [", old.domain().lo,
                           ", ", old.domain().hi, "]"));
    std::vector<double> t(std::size_t(p) + 1, on.lo);
    for (double x : old.knots())
        if (on.lo < x && x < on.hi) t.push_back(x);
    t.insert(t.end(), std::size_t(p) + 1, on.hi);
    auto fresh = BSplineBasis::make(p, std::move(t));
    if (!fresh) return std::unexpected(fresh.error());
    return refined(old, std::move(*fresh));
}

Change<BSplineBasis> reverse(const BSplineBasis& old) {
    const Interval on = old.domain();
    const auto from = old.defining();
    std::vector<double> t(from.size());
    for (std::size_t i = 0; i < t.size(); ++i) {
        const double x = from[from.size() - 1 - i];
        t[i] = x == on.lo ? on.hi : x == on.hi ? on.lo : on.lo + (on.hi - x);
        // Rounding must not move an inner knot over the end.
        if (x > on.lo && x < on.hi) t[i] = std::clamp(t[i], on.lo, on.hi);
        if (i > 0) t[i] = std::max(t[i], t[i - 1]);
    }
    const int n = old.size(), p = old.degree();
    BandMap m{n, 1, std::vector<int>(std::size_t(n)), std::vector<double>(std::size_t(n), 1.0)};
    // Open: coefficient j comes from n - 1 - j. Closed: coefficient i of the unwound sequence has the support
    // [t_i, t_{i+p+1}], which is mirrored to that of n - 1 + p - i in the unwound sequence of the reversed
    // basis.
    for (int j = 0; j < n; ++j)
        m.first[std::size_t(j)] = old.is_closed() ? (((n - 1 + p - j) % n) + n) % n : n - 1 - j;
    auto fresh = old.same_kind(p, std::move(t));
    FF_REQUIRE(fresh.has_value());
    return {std::move(*fresh), std::move(m)};
}

Change<BSplineBasis> differentiate(const BSplineBasis& old) {
    FF_REQUIRE(old.degree() >= 1);
    const int p = old.degree(), rows = old.size() - (old.is_closed() ? 0 : 1);
    BandMap m{old.size(), 2, {}, {}};
    for (int i = 0; i < rows; ++i) {
        const double d = old.knot(i + p + 1) - old.knot(i + 1), q = d > 0 ? p / d : 0;
        m.first.push_back(i);
        m.entry.push_back(-q);
        m.entry.push_back(q);
    }
    const auto t = old.is_closed() ? old.defining() : old.knots().subspan(1, old.knots().size() - 2);
    auto fresh = old.same_kind(p - 1, {t.begin(), t.end()});
    if (!fresh) {  // a knot of multiplicity p + 1: the jump there has no derivative, its coefficient drops
                   // out
        std::vector<double> u;
        std::vector<int> first;
        std::vector<double> entry;
        const auto k = old.knots();
        for (int i = 0; i < rows; ++i)
            if (old.knot(i + p + 1) > old.knot(i + 1)) {
                u.push_back(k[std::size_t(i) + 1]);
                first.push_back(m.first[std::size_t(i)]);
                entry.insert(entry.end(), {m.entry[std::size_t(2 * i)], m.entry[std::size_t(2 * i) + 1]});
            }
        u.insert(u.end(), k.end() - 1 - p, k.end() - 1);
        m.first = std::move(first);
        m.entry = std::move(entry);
        fresh = BSplineBasis::make(p - 1, std::move(u));
    }
    FF_REQUIRE(fresh.has_value());
    return {std::move(*fresh), std::move(m)};
}

Change<BSplineBasis> to_bezier(const BSplineBasis& old) {
    const auto breaks = old.breaks();
    std::vector<double> t;
    for (double x : breaks) t.insert(t.end(), std::size_t(old.degree()) + 1, x);
    auto fresh = BSplineBasis::make(old.degree(), std::move(t));
    FF_REQUIRE(fresh.has_value());
    return refined(old, std::move(*fresh));
}

}  // namespace freiform
