// From what a search finds in pairs of pieces to contacts of the whole: boxes in parameters of the objects,
// roots on both sides of a knot joined.
#pragma once
#include "search_detail.hpp"

#include <freiform/core/result.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/core/text.hpp>
#include <freiform/intersect/contact.hpp>

namespace freiform::detail {

// A contact of a pair of pieces on its way.
template <int D, std::size_t N>
struct Raw {
    Contact<D, N> c;
    int sign = 0;           // how it crosses; 0: not known
    bool at_joint = false;  // its box reaches over a knot, where the curve goes on
    // Pair of pieces, and the parameters (bits) that were moved from the end of a closed domain to its begin.
    std::array<int, 3> from{};
};

inline Result<void> check_accuracy(const IntersectOptions& options) {
    if (!(options.accuracy >= 0))
        return refuse(RefusalKind::invalid, "accuracy", text(options.accuracy, " is not a length >= 0"));
    return {};
}

// Parameters of a piece to those of the object, outwards; 0 and 1 are knots exactly.
inline double global(const Interval& on, double t) {
    return t == 0 ? on.lo : t == 1 ? on.hi : on.lo + t * (on.hi - on.lo);
}
inline Interval global(const Interval& on, const Interval& t, const Interval& within) {
    const double slack = 4 * kUnitRoundoff * std::max(std::abs(on.lo), std::abs(on.hi));
    Interval g{global(on, t.lo), global(on, t.hi)};
    if (t.lo != 0 && t.lo != 1) g.lo -= slack;
    if (t.hi != 0 && t.hi != 1) g.hi += slack;
    return {clamped(g.lo, within), clamped(g.hi, within)};
}

// What `global` rounds a parameter by, in that of the piece: u for the length, for the product and for the
// sum. It moves points by so much of a derivative, to first order: where it is not small beside the piece,
// what is made of it is an estimate.
inline double parameter_rounding(const Interval& on) {
    return 1.01 * kUnitRoundoff * (std::max(std::abs(on.lo), std::abs(on.hi)) / on.length() + 2);
}

// Where the pieces of a pair are in the parameters of their objects.
template <std::size_t N>
struct Where {
    std::array<Interval, N> piece{}, domain{};
    std::array<bool, N> closed{};
};
template <std::size_t N>
std::array<Interval, N> global(const Where<N>& where, const std::array<Interval, N>& t, bool beyond = false) {
    std::array<Interval, N> out;
    for (std::size_t k = 0; k < N; ++k)
        out[k] = global(where.piece[k], t[k], beyond ? where.domain[k] : where.piece[k]);
    return out;
}

// Parameters of pieces become those of the objects. The two ends of a closed domain are one place, its
// beginning.
template <int D, std::size_t N>
void move_to_objects(Raw<D, N>& r, const Where<N>& where) {
    if (r.at_joint)  // the neighbour may have it beyond the knot
        for (Interval& t : r.c.box) t = {t.lo - 2 * t.length(), t.hi + 2 * t.length()};
    r.c.box = global(where, r.c.box, r.at_joint);
    for (std::size_t k = 0; k < N; ++k) {
        const Interval whole = where.domain[k];
        r.c.at[k] = global(where.piece[k], r.c.at[k]);
        r.c.box[k] = hull(r.c.box[k], {r.c.at[k], r.c.at[k]});
        if (!where.closed[k] || r.c.box[k].hi < whole.hi || r.c.box[k].lo <= whole.lo) continue;
        r.from[2] |= 1 << k;
        r.c.at[k] = std::max(r.c.at[k] - whole.length(), whole.lo);
        r.c.box[k] = {r.c.box[k].lo - whole.length(), whole.lo};
    }
}
// Its point, and how far the two objects are from each other there; x, y in units of 2^exponent, each within
// its part of `error`.
template <int D, std::size_t N>
void set_point(Raw<D, N>& r, const Vec<D>& x, const Vec<D>& y, double error, int exponent) {
    for (int k = 0; k < D; ++k) r.c.point[k] = std::scalbn(x[k], exponent);
    r.c.gap = std::scalbn(std::sqrt(double(D)) * 1.01 * (max_abs(x - y) + error), exponent);
}

template <std::size_t N>
bool touch(const std::array<Interval, N>& a, const std::array<Interval, N>& b) {
    for (std::size_t k = 0; k < N; ++k)
        if (!a[k].overlaps(b[k])) return false;
    return true;
}
template <std::size_t N>
void unite(std::array<Interval, N>& a, const std::array<Interval, N>& b) {
    for (std::size_t k = 0; k < N; ++k) a[k] = hull(a[k], b[k]);
}

// Boxes that touch become one.
template <std::size_t N>
std::vector<std::array<Interval, N>> clusters(const std::vector<std::array<Interval, N>>& boxes) {
    std::vector<std::array<Interval, N>> out;
    for (std::array<Interval, N> box : boxes) {
        for (std::size_t i = 0; i < out.size();) {
            if (touch(out[i], box)) {
                unite(box, out[i]);
                out[i] = out.back();
                out.pop_back();
                i = 0;
            } else {
                ++i;
            }
        }
        out.push_back(box);
    }
    return out;
}

// One contact from two whose boxes touch: of neighbouring pieces.
template <int D, std::size_t N>
void join(Raw<D, N>& x, const Raw<D, N>& y) {
    const bool proven = x.c.is_proven() && y.c.is_proven();
    const bool ends = x.c.kind == ContactKind::end || y.c.kind == ContactKind::end;
    const bool tangent = x.c.kind == ContactKind::tangent || y.c.kind == ContactKind::tangent;
    // Exact ones are at the knot itself; others are one where both branches cross the same way.
    const bool exact = !x.at_joint && !y.at_joint;
    const bool across = x.sign != 0 && x.sign == y.sign;
    unite(x.c.box, y.c.box);
    x.c.gap = std::max(x.c.gap, y.c.gap);
    x.at_joint = false;
    if (proven && (exact || across)) {
        x.c.kind = ends                 ? ContactKind::end
                   : tangent || !across ? ContactKind::tangent
                                        : ContactKind::crossing;
        x.c.multiplicity = across && !tangent ? 1 : 0;
        return;
    }
    x.c.kind = ends ? ContactKind::end : ContactKind::possible;
    x.c.least = exact ? std::max(x.c.least, y.c.least) : 0;
    x.c.most += y.c.most;
    x.c.multiplicity = 0;
}

template <int D, std::size_t N>
std::vector<Contact<D, N>> joined(std::vector<Raw<D, N>> all) {
    std::vector<Raw<D, N>> out;
    for (Raw<D, N>& r : all) {
        bool known = false;
        for (Raw<D, N>& o : out) {
            // Proven ones of one pair of pieces are different ones, however near they are.
            const bool differ = o.from == r.from && o.c.is_proven() && r.c.is_proven();
            if (differ || !touch(o.c.box, r.c.box)) continue;
            join(o, r);
            known = true;
            break;
        }
        if (!known) out.push_back(r);
    }
    std::vector<Contact<D, N>> contacts;
    for (Raw<D, N>& r : out) {
        if (r.at_joint) {  // only one side of the knot has it
            if (r.c.kind != ContactKind::end) r.c.kind = ContactKind::possible;
            r.c.least = 0;
        }
        contacts.push_back(r.c);
    }
    sort(contacts.begin(), contacts.end(), [](const auto& x, const auto& y) { return x.at < y.at; });
    return contacts;
}

// The answer of the curves in the other order.
template <int D>
void exchange(Intersections<D, 2>& all) {
    for (auto& c : all.contacts) std::swap(c.at[0], c.at[1]), std::swap(c.box[0], c.box[1]);
    for (auto& o : all.overlaps) std::swap(o.a, o.b);
    for (auto& u : all.undecided) std::swap(u[0], u[1]);
    sort(all.contacts.begin(), all.contacts.end(), [](const auto& x, const auto& y) { return x.at < y.at; });
    sort(all.overlaps.begin(), all.overlaps.end(),
         [](const auto& x, const auto& y) { return x.a.lo < y.a.lo; });
}

}  // namespace freiform::detail
