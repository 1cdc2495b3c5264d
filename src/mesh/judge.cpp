// See bending.cpp for what is claimed, and face_mesh.cpp for the whole.
#include "judge_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>

namespace freiform {

namespace {

constexpr double kLittleTilt = 0.1;  // of normals: cheap bounds say about as much as sharp ones
constexpr double kMargin = 0.125;    // of the box of the face: what is looked at beyond it

constexpr double kGrow = 1 + 1e-14;        // roundings of bounds over cells
constexpr double kNoUnderflow = 0x1p-900;  // products that are larger have all of their digits

}  // namespace

double triangle_bound(const DerivativeQuery<2, 3>& surface, const std::array<Vec<2>, 3>& corner) {
    Box<2> box;
    for (const Vec<2>& p : corner) box.add(p);
    const auto limit = limits(surface.geometry());
    if (clamped(box.lo, limit) != box.lo || clamped(box.hi, limit) != box.hi) return kInfinity;
    const auto bends = surface({box.side(0), box.side(1)});
    return linear_interpolation_bound({bends(2, 0), bends(1, 1), bends(0, 2)}, corner[0], corner[1],
                                      corner[2]) +
           kink_bound_of(surface.kinks(0), box.side(0)) + kink_bound_of(surface.kinks(1), box.side(1));
}

Judge::Judge(const CurvatureTree& tree, const DerivativeQuery<2, 3>& surface, const Box<2>& face,
             double tolerance)
    : tree_(tree), surface_(surface), tolerance_(tolerance), limits_(limits(surface.geometry())) {
    if (tree.is_all_plain()) return;
    const Vec<2> margin = kMargin * (face.hi - face.lo);
    whole_ = {clamped(face.lo - margin, limits_), clamped(face.hi + margin, limits_)};
    whole_bends_ = over_clamped(whole_);
}

Curvature Judge::over_clamped(const Box<2>& box) const {
    const auto own = surface_({box.side(0), box.side(1)});
    return {own(2, 0), own(1, 1), own(0, 2)};
}

Judgement Judge::operator()(const Bending& at, const Box<2>& box, const std::array<Vec<2>, 3>& corner,
                            int plain, int near_place, bool is_deep) const {
    if (const auto& cone = tree_.cone()) {
        ConeFace::Bends bends{at.full.uu, at.full.vv, {}};
        if (cone->across() == 1) std::swap(bends.across, bends.along);
        const double e = cone->error(bends, corner) + tree_.kink_bound(box);
        return {false, is_turned_over(corner) ? kInfinity : e, e, at.full};
    }
    const auto error_of = [&](const Curvature& c) {
        return linear_interpolation_bound(c, corner[0], corner[1], corner[2]);
    };
    const bool is_fitted = at.fit.exists();  // which says more than second derivatives alone
    double e = at.knows_middle() ? at.whole_error(box, corner) * kGrow : kInfinity;
    if (!is_fitted) e = std::min(e, error_of(at.full));
    e += tree_.kink_bound(box);
    // What takes least first where it mostly does, then what says most.
    const bool is_steady = !is_fitted && at.tilt < kLittleTilt;
    const auto seen_error = [&](double turn, double enough) {
        const auto of_all = [&] { return error_of(at.seen(turn)); };
        double seen = is_steady ? of_all() : kInfinity;
        if (seen > enough && at.knows_middle())
            seen = std::min(seen, at.triangle_error(box, corner, turn, enough / kGrow) * kGrow);
        if (seen > enough) seen = std::min(seen, at.seen_error(box, turn) * kGrow);
        return seen <= enough || is_fitted || is_steady ? seen : std::min(seen, of_all());
    };
    return judged(at, box, std::cref(seen_error), e, plain, near_place, is_deep);
}

// More than anybody sees.
bool Judge::is_turned_over(const std::array<Vec<2>, 3>& corner) const {
    if (!tree_.cone()->is_turned_over(corner)) return false;
    std::array<Vec<3>, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = jet<0>(surface_.geometry(), corner[k].c).value();
    const double longest = std::max({norm(p[1] - p[0]), norm(p[2] - p[1]), norm(p[0] - p[2])});
    return norm(cross(p[1] - p[0], p[2] - p[0])) > tolerance_ * longest;
}

// The smallest circle around a half has the diagonal of the cell as diameter.
double Judge::cell_error(const Bending& at, const Box<2>& box, const Vec<2>& sides) const {
    return at.full.error(sides) * kGrow + tree_.kink_bound(box);
}

Judgement Judge::cell(const Bending& at, const Box<2>& box, const Vec<2>& sides, double error, int plain,
                      int near_place) const {
    const auto seen_error = [&](double turn, double) { return at.seen(turn).error(sides) * kGrow; };
    return judged(at, box, std::cref(seen_error), error, plain, near_place, true);
}

Judgement Judge::leaf(const Bending& at, const Box<2>& box, double error, int plain, int near_place) const {
    const auto seen_error = [&](double turn, double) { return at.seen_error(box, turn) * kGrow; };
    return judged(at, box, std::cref(seen_error), error, plain, near_place, true);
}

Judgement Judge::cells(const Bending& at, const Box<2>& box, const Vec<2>& sides, double error,
                       int near_place) const {
    const Vec<2> size = kGrow * (box.hi - box.lo);
    const auto seen_error = [&](double turn, double) { return at.cells_error(size, sides, turn) * kGrow; };
    return judged(at, box, std::cref(seen_error), error, 0, near_place, true);
}

double Judge::whole_halves_error(const Bending& at, const Box<2>& box) const {
    return at.whole_halves_error(box) * kGrow + tree_.kink_bound(box);
}

bool Judge::is_within_limits(const Box<2>& box) const {
    return limits_[0].lo <= box.lo[0] && box.hi[0] <= limits_[0].hi && limits_[1].lo <= box.lo[1] &&
           box.hi[1] <= limits_[1].hi;
}

bool Judge::bends_evenly_around(const Bending& at, const Box<2>& box, double e) const {
    if (!(at.least > 0)) return false;
    const Vec<2> reach = reach_of(at, e);
    const Box<2> around{box.lo - reach, box.hi + reach};
    if (tree_.meets_kink(around) || !is_within_limits(around)) return false;
    const auto near = tree_.about(around);
    const double own = bend_of_lengths(at, at.full);
    return near && own > kNoUnderflow && own < kInfinity &&
           bend_of_lengths(at, *near) <= (kBeyond - 0x1p-40) * own;
}

double Judge::halves(const Bending& at, const Box<2>& box, double error, double proven,
                     int near_place) const {
    if (proven < kInfinity && bends_evenly_around(at, box, error)) return std::min(error, proven);
    const auto seen_error = [&](double turn, double enough) {
        return at.halves_error(box, turn, enough / kGrow) * kGrow;
    };
    return judged(at, box, std::cref(seen_error), error, 0, near_place, true, true).bound;
}

Judgement Judge::judged(const Bending& at, const Box<2>& box, const SeenError& seen_error, double e,
                        int plain, int near_place, bool is_deep, bool is_likely) const {
    Judgement k{false, kInfinity, e, at.full};
    if (plain == 3) {
        k.bound = e;
        return k;
    }
    if (!(at.least > 0)) return k;
    // Where a foot straight below would not do, none will.
    double straight = 0;
    if (e > tolerance_ && !is_likely) {
        straight = plain > 0 ? e : seen_error(0, tolerance_);
        if (straight > tolerance_) {
            k.curvature = plain > 0 ? at.full : at.seen(0);
            return k;
        }
    }
    const Vec<2> reach = reach_of(at, e);
    const Box<2> around{box.lo - reach, box.hi + reach};
    if (tree_.meets_kink(around)) return k;
    double reflected = 1;
    for (int d = 0; d < 2; ++d)
        if (around.lo[d] < limits_[std::size_t(d)].lo || around.hi[d] > limits_[std::size_t(d)].hi) {
            reflected = 3;
            if (reach[d] > limits_[std::size_t(d)].length()) return k;
        }
    // True if it is enough to know that `near` bounds second derivatives around. `is_last`: nothing else is
    // known.
    const auto is_enough = [&](const Curvature& near, bool is_last) {
        const Shift shift = shift_of(at, e, near, reflected, is_deep);
        if (!shift.exists) return false;
        k.shifted = true;
        if (!is_last && plain == 0 && std::min(e, shift.across(straight, e)) > tolerance_) {
            k.bound = std::min(k.bound, e);
            return false;
        }
        const auto across = [&] {
            return shift.across(seen_error(shift.turn, shift.left_of(tolerance_, e)), e);
        };
        const double bound = plain > 0 ? shift.way(e) : std::min(e, across());
        const bool is_less = bound < k.bound;
        if (is_less) k.bound = bound;
        if (k.bound <= tolerance_) return true;
        if (is_less) k.curvature = plain > 0 ? at.full : at.seen(shift.turn);
        return false;
    };
    // What holds everywhere first, then what holds in the part of the tree that has all of it.
    const Box<2> inside{clamped(around.lo, limits_), clamped(around.hi, limits_)};
    if (whole_.contains(inside.lo) && whole_.contains(inside.hi) && is_enough(whole_bends_, false)) return k;
    if (const auto near = tree_.about(inside); near && is_enough(*near, false)) return k;
    const int place = tree_.place_of(inside, near_place);
    if (const Curvature* all = tree_.all_in(place, inside); all && is_enough(*all, false)) return k;
    if (const auto near = tree_.all_over(inside, place)) {
        if (is_enough(*near, inside == around) || inside == around) return k;
    }
    is_enough(over_clamped(inside), true);  // less: of nothing else
    return k;
}

}  // namespace freiform
