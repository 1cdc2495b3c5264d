// Boehm's algorithm, Lane-Riesenfeld subdivision, and extrapolation, as changes of basis.
//
// Idea: all three are rows of blossoms, as in change.cpp, in the special cases where a row needs no
// recurrence: with one new knot at most one argument of a blossom is new, so that one step of the recurrence
// is left (Boehm); with all knots uniform every row is the same binomial mask (Lane and Riesenfeld).
//
// Notation: t old knots, t' new ones, p degree, s the span of u: t_s <= u < t_{s+1}.
//
// Boehm: coefficient j of t' has the arguments t'_{j+1} .. t'_{j+p}. For j <= s - p and j > s they are
// consecutive old knots. Between, u is among them, and c'_j = a c_j + (1 - a) c_{j-1}, a = (u - t_j) /
// (t_{j+p} - t_j), is the step from the arguments where u is replaced by t_j and by t_{j+p}. On a closed
// basis the same with indices modulo n, beginning at j = s - p + 1; the previous copy of u has the index s -
// n there, and is no argument if n >= p - 1 (shorter ones are left to insert_knots).
//
// Lane and Riesenfeld: N_i(x) = sum_k C(p + 1, k) / 2^p N_{2i+k}(2 x) for knots at the integers. Row f of the
// matrix therefore has the entries a_{f - 2 i}; the first function that the domain [p, n] sees has f = p.
//
// Extension: coefficient j is the blossom of an end piece at (t'_{j+1} .. t'_{j+p}), where some of the
// arguments are new ends. Taken first are the old knots among them: by the argument in change.cpp these steps
// are without cancellation; then the new ends. The piece is the one next to the new end.
//
// Accuracy: Boehm's entries have a relative error of 3 roundings; both are >= 0, and their sum is 1 up to
// rounding. Subdivision is exact up to one rounding per product and sum. Extension is subject to the
// condition of extrapolation, which is the same for every method. Clamping first and extending then would be
// shorter; it lost nine digits where a short span is next to long ones, because the coefficients are large
// only on the way.
//
// References: [Boehm 1980], [Lane & Riesenfeld 1980], [Ramshaw 1989], [Cohen Lyche Riesenfeld 1980].
//
// Why not the doubling and averaging on nets of surfaces: the matrix goes through along() like every other
// change, and its rows are what the text prints.
#include <freiform/basis/subdivide.hpp>
#include <freiform/core/bounded.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

Result<Change<BSplineBasis>> insert_knot(const BSplineBasis& old, double u) {
    const int p = old.degree(), n = old.size();
    if (!std::isfinite(u)) return refuse(RefusalKind::nonfinite, "knot", text(u, " is not a finite number"));
    if (!old.domain().contains(u))
        return refuse(RefusalKind::out_of_domain, "knot",
                      text(u, " is outside the domain [", old.domain().lo, ", ", old.domain().hi, "]"));
    if (old.is_closed() && n < p - 1) return insert_knots(old, std::span(&u, 1));
    std::vector<double> t(old.defining().begin(), old.defining().end());
    t.insert(std::upper_bound(t.begin(), t.end(), u), u);
    auto fresh = old.same_kind(p, std::move(t));
    if (!fresh) return std::unexpected(fresh.error());

    const int s = old.span(u), rows = n + 1, start = old.is_closed() ? s - p + 1 : 0;
    BandMap m{n, 2, std::vector<int>(std::size_t(rows)), std::vector<double>(2 * std::size_t(rows))};
    for (int j = start; j < start + rows; ++j) {
        const std::size_t row = std::size_t(j % rows);
        double own = j <= s - p ? 1 : 0, before = 1 - own;
        if (s - p < j && j <= s) {
            const double tl = old.knot(j), tr = old.knot(j + p), width = tr - tl;
            own = (u - tl) / width, before = (tr - u) / width;
        }
        // Entries for c_{j-1}, c_j; at the ends of an open basis moved inside by one.
        const bool first = !old.is_closed() && j == 0, last = !old.is_closed() && j == n;
        m.first[row] = first ? 0 : last ? n - 2 : (j - 1 + n) % n;
        double* w = &m.entry[2 * row];
        if (first)
            w[0] = own;
        else if (last)
            w[1] = before;
        else
            w[0] = before, w[1] = own;
    }
    if (n == 1) {  // a constant: both columns of the band are the same coefficient
        m.width = 1;
        m.first.assign(std::size_t(rows), 0);
        m.entry.assign(std::size_t(rows), 1.0);
    }
    return Change<BSplineBasis>{std::move(*fresh), std::move(m)};
}

Result<Extension> extend_to(const BSplineBasis& old, Interval on) {
    const Interval was = old.domain();
    const int p = old.degree(), width = p + 1;
    if (!std::isfinite(on.lo) || !std::isfinite(on.hi) || !std::isfinite(on.length()))
        return refuse(RefusalKind::nonfinite, "interval", text("[", on.lo, ", ", on.hi, "] is not finite"));
    if (!(on.lo <= was.lo && was.hi <= on.hi))
        return refuse(
            RefusalKind::out_of_domain, "interval",
            text("[", on.lo, ", ", on.hi, "] does not contain the domain [", was.lo, ", ", was.hi, "]"));
    std::vector<double> t(std::size_t(width), on.lo);
    for (const double x : old.knots())
        if (was.lo < x && x < was.hi) t.push_back(x);
    t.insert(t.end(), std::size_t(width), on.hi);
    auto fresh = BSplineBasis::make(p, std::move(t));
    if (!fresh) return std::unexpected(fresh.error());
    const int n = fresh->size();
    BandMap m{old.size(), width, std::vector<int>(std::size_t(n)),
              std::vector<double>(std::size_t(n) * std::size_t(width))};
    std::vector<double> entry_bound(m.entry.size());
    for (int j = 0; j < n; ++j) {
        const auto arguments = fresh->knots().subspan(std::size_t(j) + 1, std::size_t(p));
        const bool below = on.lo < was.lo && p > 0 && arguments.front() == on.lo;
        const bool above = on.hi > was.hi && p > 0 && arguments.back() == on.hi;
        const int s = old.span(below ? was.lo : above ? was.hi : fresh->knot(j));
        // Old knots from t_s downwards, then upwards, then the new ends.
        Bounded order[kMaxDegree + 1], row[kMaxDegree + 1];
        int k = 0;
        const auto take = [&](bool wanted, double x) {
            if (wanted) order[k++] = x;
        };
        const auto is_old = [&](double x) { return was.contains(x); };
        for (std::size_t i = arguments.size(); i-- > 0;)
            take(is_old(arguments[i]) && arguments[i] <= old.knot(s), arguments[i]);
        for (const double x : arguments) take(is_old(x) && x > old.knot(s), x);
        for (const double x : arguments) take(!is_old(x), x);
        m.first[std::size_t(j)] = s - p;
        blossom(old, s, static_cast<const Bounded*>(order), row);
        for (int i = 0; i < width; ++i) {
            const std::size_t at = std::size_t(j) * std::size_t(width) + std::size_t(i);
            m.entry[at] = row[i].value, entry_bound[at] = row[i].bound;
        }
    }
    for (std::size_t i = 0; i < m.entry.size(); ++i)
        if (!std::isfinite(m.entry[i]) || !std::isfinite(entry_bound[i]))
            return refuse(RefusalKind::ill_conditioned, "interval",
                          text("[", on.lo, ", ", on.hi, "] is too far from [", was.lo, ", ", was.hi, "]"));
    return Extension{{std::move(*fresh), std::move(m)}, std::move(entry_bound)};
}

BandMap uniform_subdivision(int degree, int size, bool closed) {
    FF_REQUIRE(degree >= 0 && degree <= kMaxDegree && size >= (closed ? 1 : degree + 1));
    std::vector<double> mask(std::size_t(degree) + 2);
    mask[0] = std::ldexp(1.0, -degree);
    for (int k = 0; k <= degree; ++k)
        mask[std::size_t(k) + 1] = mask[std::size_t(k)] * (degree + 1 - k) / (k + 1);
    const int rows = closed ? 2 * size : 2 * size - degree, width = (degree + 1) / 2 + 1;
    BandMap m{size, closed ? width : std::min(width, size), std::vector<int>(std::size_t(rows)), {}};
    for (int row = 0; row < rows; ++row) {
        const int f = row + degree,
                  lowest = row / 2;  // the least i with f - 2 i <= p + 1 is (f - p) / 2, rounded
        m.first[std::size_t(row)] = closed ? lowest % size : std::min(lowest, size - m.width);
        const int from = closed ? lowest : m.first[std::size_t(row)];
        for (int i = from; i < from + m.width; ++i) {
            const int k = f - 2 * i;
            m.entry.push_back(k >= 0 && k <= degree + 1 ? mask[std::size_t(k)] : 0);
        }
    }
    return m;
}

Result<Change<BSplineBasis>> halve_uniform(const BSplineBasis& old) {
    const int p = old.degree();
    const auto t = old.knots();
    const double h = t[1] - t[0];
    for (std::size_t i = 1; i < t.size(); ++i)
        if (t[i] - t[i - 1] != h || h == 0)
            return refuse(RefusalKind::unsupported, text("knots[", i, "]"),
                          text("the span [", t[i - 1], ", ", t[i], "] has not the length ", h,
                               " of the first; a uniform basis is expected"));
    std::vector<double> fine;
    const auto from =
        old.is_closed() ? old.defining() : t.subspan(std::size_t(p), t.size() - 2 * std::size_t(p));
    if (!old.is_closed())
        for (int k = p; k > 0; --k) fine.push_back(from.front() - k * (h / 2));
    for (std::size_t i = 0; i + 1 < from.size(); ++i) {
        fine.push_back(from[i]);
        fine.push_back(from[i] + h / 2);
    }
    for (int k = 0; k <= (old.is_closed() ? 0 : p); ++k) fine.push_back(from.back() + k * (h / 2));
    auto fresh = old.same_kind(p, std::move(fine));
    if (!fresh) return std::unexpected(fresh.error());
    return Change<BSplineBasis>{std::move(*fresh), uniform_subdivision(p, old.size(), old.is_closed())};
}

}  // namespace freiform
