// Changes of basis by blossoms.
//
// Idea: coefficient j of a spline on knots t' is its blossom at (t'_{j+1}, .., t'_{j+p}) [Ramshaw 1989]. So a
// new knot vector alone says what the new coefficients are; which map it is (insertion, restriction, Bezier
// extraction) only depends on how t' was made.
//
// Notation: `old` has knots t and degree p, `fresh` has knots t'; s is the span of t where t'_j lies.
//
// Method: a blossom is symmetric, so its arguments may be taken in any order; the order decides about
// rounding. Taken are first those <= t_s, downwards, then the others, upwards. Wherever an argument passes an
// old knot, that knot itself was an argument before (t' refines t around s), and the step for it has set the
// weights that the passing step would multiply by a negative factor to an exact zero. So all products are of
// non-negative numbers: the weights of insertion, restriction and extraction are the discrete B-splines of
// [Cohen Lyche Riesenfeld 1980], computed without cancellation. For elevation t' still refines t when one of
// the p + 1 arguments is left out, because every knot of t has got one more in t'; so the means of those
// blossoms are non-negative, too.
//
// Accuracy: an entry carries a relative error of at most 5 p (elevation: 6 p + 3) roundings; every row is a
// convex combination up to rounding. A coefficient adds a product and p sums, which makes refinement_error
// and elevation_error: with non-negative entries that add up to 1, k roundings are at most 1.01 k u max|P_i|.
// An insertion of nothing gives the identity to the bit.
//
// Why not Boehm's algorithm: it inserts one knot after the other; the rows here are independent of each
// other. Why not arguments in ascending order throughout: on an unclamped basis the first p rows then begin
// with extrapolation, and at degree 9 random knots lose all digits.
#include <freiform/basis/change.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freiform {

namespace {

// w[0..p] := the blossom of the piece s of `old` at p ascending arguments.
void blossom_at(const BSplineBasis& old, int s, const double* args, double* w) {
    const int p = old.degree();
    double order[kMaxDegree + 1];
    int below = 0, k = 0;
    while (below < p && args[below] <= old.knot(s)) ++below;
    for (int i = below; i-- > 0;) order[k++] = args[i];
    for (int i = below; i < p; ++i) order[k++] = args[i];
    blossom(old, s, static_cast<const double*>(order), w);
}

// The map from `old` to `fresh` whose row j is what `row(span of old, t' + j + 1, w)` adds to w[0..p].
template <class F>
Change<BSplineBasis> change(const BSplineBasis& old, BSplineBasis fresh, F&& row) {
    const int p = old.degree(), width = p + 1, rows = fresh.size();
    const Interval on = fresh.domain();
    BandMap m{old.size(), width, std::vector<int>(std::size_t(rows)),
              std::vector<double>(std::size_t(rows) * std::size_t(width))};
    // Of the indices j + k rows() of a closed basis the one whose support begins in the domain, but not at
    // its end.
    int start = 0;
    while (old.is_closed() && fresh.is_closed() && fresh.knot(start) < on.lo) ++start;
    for (int j = start; j < start + rows; ++j) {
        const std::size_t r = std::size_t(j % rows);
        double* w = &m.entry[r * std::size_t(width)];
        const bool before = fresh.knot(j + fresh.degree() + 1) <= on.lo, after = fresh.knot(j) >= on.hi;
        if (before || after) {  // no influence inside the domain (unclamped only): any coefficient will do
            const int from = std::clamp(before ? j : old.size() - rows + j, 0, old.size() - 1);
            m.first[r] = std::min(from, old.size() - width);
            w[from - m.first[r]] = 1;
            continue;
        }
        const int s = old.span(fresh.knot(j));
        m.first[r] = s - p;
        row(s, fresh.knots().data() + j + 1, w);
    }
    return {std::move(fresh), std::move(m)};
}

Change<BSplineBasis> refined(const BSplineBasis& old, BSplineBasis fresh) {
    return change(old, std::move(fresh),
                  [&](int s, const double* args, double* w) { blossom_at(old, s, args, w); });
}

}  // namespace

BandMap composed(const BandMap& first, const BandMap& second) {
    FF_REQUIRE(first.rows() == second.cols);
    BandMap out{first.cols, 0, std::vector<int>(second.first.size()), {}};
    const auto column = [&](int i, int k) {
        return std::size_t((second.first[std::size_t(i)] + k) % second.cols);
    };
    for (int i = 0; i < second.rows(); ++i) {
        int lo = first.first[column(i, 0)], hi = lo;
        for (int k = 1; k < second.width; ++k) {
            lo = std::min(lo, first.first[column(i, k)]);
            hi = std::max(hi, first.first[column(i, k)]);
        }
        out.first[std::size_t(i)] = lo;
        out.width = std::max(out.width, hi - lo + first.width);
    }
    out.entry.resize(out.first.size() * std::size_t(out.width));
    for (int i = 0; i < second.rows(); ++i)
        for (int k = 0; k < second.width; ++k) {
            const std::size_t c = column(i, k);
            double* w = &out.entry[std::size_t(i) * std::size_t(out.width)] + first.first[c] -
                        out.first[std::size_t(i)];
            for (int l = 0; l < first.width; ++l)
                w[l] += second.row(i)[std::size_t(k)] * first.row(int(c))[std::size_t(l)];
        }
    return out;
}

Result<Change<BSplineBasis>> insert_knots(const BSplineBasis& old, std::span<const double> more) {
    for (std::size_t i = 0; i < more.size(); ++i) {
        if (!std::isfinite(more[i]))
            return refuse(RefusalKind::nonfinite, text("knots[", i, "]"),
                          text(more[i], " is not a finite number"));
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
    if (!old.is_closed()) {
        // Of the knots before and behind the domain as many as degree p + 1 has room for, the nearest ones.
        int before = 0, behind = 0;
        for (std::size_t i = 0; i + 1 < from.size(); ++i) {
            before += from[i] != from[i + 1] && from[i] < old.domain().lo;
            behind += from[i] != from[i + 1] && from[i + 1] > old.domain().hi;
        }
        t.erase(t.end() - behind, t.end());
        t.erase(t.begin(), t.begin() + before);
    }
    auto fresh = old.same_kind(p + 1, std::move(t));
    if (!fresh) return std::unexpected(fresh.error());
    // The blossom of degree p + 1 is the mean of the old one over all arguments but one.
    return change(old, std::move(*fresh), [&](int s, const double* args, double* w) {
        double some[kMaxDegree + 1], v[kMaxDegree + 1];
        for (int skip = 0; skip <= p; ++skip) {
            for (int k = 0; k < p; ++k) some[k] = args[k + (k >= skip)];
            blossom_at(old, s, some, v);
            for (int k = 0; k <= p; ++k) w[k] += v[k] / (p + 1);
        }
    });
}

Result<Change<BSplineBasis>> restrict_to(const BSplineBasis& old, Interval on) {
    const int p = old.degree();
    if (!std::isfinite(on.lo) || !std::isfinite(on.hi))
        return refuse(RefusalKind::nonfinite, "interval", text("[", on.lo, ", ", on.hi, "] is not finite"));
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
    }
    // Where rounding would merge knots, or move one over an end, it is moved to the next number instead.
    const auto differ = [&](std::size_t i) {
        return from[t.size() - 1 - i] != from[t.size() - i];
    };  // t[i-1], t[i]
    const double inf = std::numeric_limits<double>::infinity();
    for (std::size_t i = t.size(); --i > 0;)
        t[i - 1] = std::min(t[i - 1], differ(i) ? std::nextafter(t[i], -inf) : t[i]);
    for (std::size_t i = 1; i < t.size(); ++i) {
        if (from[t.size() - i] == on.hi) t[i - 1] = on.lo;
        t[i] = std::max(t[i], differ(i) ? std::nextafter(t[i - 1], inf) : t[i - 1]);
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
    if (old.is_closed() && p > 1)
        for (double x : old.breaks())
            if (old.multiplicity(x) == p) {  // a kink: the derivative jumps there and cannot be closed
                auto open = restrict_to(old, old.domain());
                FF_REQUIRE(open.has_value());
                auto out = differentiate(open->basis);
                out.map = composed(open->map, out.map);
                return out;
            }
    BandMap m{old.size(), 2, {}, {}};
    std::vector<double> t;
    for (int i = 0; i < rows; ++i) {
        const double width = old.knot(i + p + 1) - old.knot(i + 1), q = p / width;
        if (width == 0)
            continue;  // p + 1 equal knots: the jump there has no derivative, its coefficient drops out
        t.push_back(old.knot(i + 1));
        m.first.push_back(i);
        m.entry.insert(m.entry.end(), {-q, q});
    }
    if (old.is_closed()) {
        t.assign(old.defining().begin(), old.defining().end());
    } else {
        const auto k = old.knots();
        t.insert(t.end(), k.end() - 1 - p, k.end() - 1);
    }
    auto fresh = old.same_kind(p - 1, std::move(t));
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
