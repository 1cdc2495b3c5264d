// Whether a curve stays inside the domain. Idea: a Bezier piece stays in every box that contains its control
// points; a piece whose control points leave the box is halved until its ends leave (then the curve does) or
// its control points stay inside. Control points approach the curve quadratically, so with a slack the
// halving ends after about fifteen steps; the budget is a backstop, and a curve that needs more is taken for
// inside, where no point of it was found outside. Cost: pieces only near places where the curve touches the
// boundary.
//
// On closed axes a loop is also where it is shifted by periods. Copies of loops whose boxes reach loops are
// checked together with them. Shifts round, and what closes at the seam was often rounded by whoever wrote
// it: control points count as known up to the slack.
#include "trim/loop_links_detail.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/spline/bezier.hpp>
#include <freiform/trim/loops.hpp>
#include <freiform/trim/trimmed_surface.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace freiform {

namespace {

using Loops = std::vector<std::vector<CurveGeometry<2>>>;

// The box that curves have to stay in: closed axes go round, so that every parameter is inside.
Box<2> allowed(const std::variant<Surface<Vec<3>>, Surface<Hom<3>>>& surface) {
    Box<2> box;
    visit_one(
        [&](const auto& s) {
            for (int d = 0; d < 2; ++d) {
                const Interval on = s.basis(d).domain();
                const double slack = s.basis(d).is_closed() ? std::numeric_limits<double>::infinity()
                                                            : TrimmedSurface::kSlack * on.length();
                box.lo[d] = on.lo - slack;
                box.hi[d] = on.hi + slack;
            }
        },
        surface);
    return box;
}

template <class P>
std::optional<Vec<2>> point_outside(std::vector<P> piece, const Box<2>& box) {
    constexpr int kMostPieces = 4096;
    std::vector<std::vector<P>> pending;
    pending.push_back(std::move(piece));
    for (int i = 0; i < kMostPieces && !pending.empty(); ++i) {
        std::vector<P> b = std::move(pending.back());
        pending.pop_back();
        bool inside = true;
        for (const P& p : b) inside = inside && box.contains(project(p));
        if (inside) continue;
        for (const P& end : {b.front(), b.back()})
            if (!box.contains(project(end))) return project(end);
        std::vector<P> left = b;
        keep_left(Fibre<P>{left.data(), int(left.size()), 1}, 0.5);
        keep_right(Fibre<P>{b.data(), int(b.size()), 1}, 0.5);
        pending.push_back(std::move(b));
        pending.push_back(std::move(left));
    }
    return std::nullopt;
}

template <class P>
std::optional<Vec<2>> point_outside(const Curve<P>& curve, const Box<2>& box) {
    const auto pieces = decompose(curve);
    for (int i = 0; i < pieces.extent()[0]; ++i) {
        const auto net = pieces.net({i});
        if (auto p = point_outside(std::vector<P>(net.data, net.data + net.extent[0]), box)) return p;
    }
    return std::nullopt;
}

// An ellipse reaches centre +- sqrt(x_d^2 + y_d^2) along each axis.
std::optional<Vec<2>> point_outside(const Conic<2>& c, const Box<2>& box) {
    for (int d = 0; d < 2; ++d) {
        const double t = std::atan2(c.y[d], c.x[d]);
        for (const double at : {t, t + std::numbers::pi}) {
            const Vec<2> p = jet<0, 2>(CurveGeometry<2>(c), at).value();
            if (!(box.lo[d] <= p[d] && p[d] <= box.hi[d])) return p;
        }
    }
    return std::nullopt;
}
std::optional<Vec<2>> point_outside(const Line<2>&, const Box<2>&) { return std::nullopt; }

bool has_ends(const CurveGeometry<2>& c) {
    if (std::holds_alternative<Line<2>>(c)) return false;
    const auto* conic = std::get_if<Conic<2>>(&c);
    return !conic || conic->kind == ConicKind::ellipse;
}

Vec<2> end_of(const CurveGeometry<2>& c, int side) {
    // The cosine and sine of a rounded 2 pi would leave a gap in an ellipse that has none.
    if (std::holds_alternative<Conic<2>>(c)) return jet<0, 2>(c, 0).value();
    const Interval on = domain(c)[0];
    return jet<0, 2>(c, side == 0 ? on.lo : on.hi).value();
}

Result<void> check_loop(const std::vector<CurveGeometry<2>>& loop, const Box<2>& box, const Vec<2>& slack) {
    if (loop.empty()) return refuse(RefusalKind::invalid, "", "a loop needs at least one curve");
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::string at = text("[", i, "]");
        if (auto ok = check(loop[i]); !ok) return refuse_within(at, ok.error());
        if (!has_ends(loop[i]))
            return refuse(
                RefusalKind::invalid, at,
                text("a ", kind_name(loop[i]), " has no ends; a loop is made of splines and ellipses"));
        if (const auto p = visit_one([&](const auto& c) { return point_outside(c, box); }, loop[i]))
            return refuse(RefusalKind::out_of_domain, at,
                          text("leaves the domain of the surface at (", (*p)[0], ", ", (*p)[1], ")"));
    }
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec<2> end = end_of(loop[i], 1), start = end_of(loop[(i + 1) % loop.size()], 0),
                     gap = start - end;
        if (!(std::abs(gap[0]) <= slack[0] && std::abs(gap[1]) <= slack[1]))
            return refuse(
                RefusalKind::invalid, text("[", i, "]"),
                text("the loop is open: the curve ends at (", end[0], ", ", end[1], "), the next begins at (",
                     start[0], ", ", start[1], "), a gap of ", norm(gap), " in the parameters"));
    }
    return {};
}

Result<void> check_crossings(const Loops& loops, const Vec<2>& slack) {
    if (loops.empty()) return {};
    const double gap = norm(slack);
    auto contacts = check_loops(loops, {gap, gap});
    if (!contacts) return std::unexpected(contacts.error());
    return {};
}

using Loop = std::vector<CurveGeometry<2>>;

// A box of the curves' control points.
Box<2> box_of(const Loop& loop) {
    Box<2> box;
    for (const auto& curve : loop)
        visit_one(
            [&]<class C>(const C& c) {
                if constexpr (requires { c.net(); })
                    for (const auto& p : c.net().flat()) box.add(project(p));
                if constexpr (std::same_as<C, Conic<2>>)
                    for (const Vec<2>& x : {c.x + c.y, c.x - c.y})
                        box.add(c.centre + x), box.add(c.centre - x);
            },
            curve);
    return box;
}

Loop shifted(const Loop& loop, const Vec<2>& by) {
    Loop moved;
    for (const auto& curve : loop)
        moved.push_back(visit_one(
            [&]<class C>(const C& c) -> CurveGeometry<2> {
                if constexpr (requires { c.net(); }) {
                    auto net = c.net();
                    for (auto& p : net.flat())
                        for (int d = 0; d < 2; ++d)
                            p[d] += Space<std::remove_cvref_t<decltype(p)>>::weight(p) * by[d];
                    return C::trusted(c.bases(), std::move(net));
                } else {
                    C other = c;
                    if constexpr (std::same_as<C, Conic<2>>) other.centre = c.centre + by;
                    return other;
                }
            },
            curve));
    return moved;
}

// Loops against copies of loops that are whole periods away; a period of 0 is none.
Result<void> check_across_seams(const Loops& loops, const Vec<2>& period, const Vec<2>& slack) {
    constexpr double kMostCopies = 1000;
    std::vector<Box<2>> box;
    Box<2> all;
    for (const Loop& loop : loops) {
        box.push_back(box_of(loop));
        all.add(box.back().lo), all.add(box.back().hi);
    }
    double most[2];  // shifts by which anything still meets
    for (int d = 0; d < 2; ++d)
        most[d] = period[d] > 0 ? std::floor((all.hi[d] - all.lo[d] + slack[d]) / period[d]) : 0;
    if (!((2 * most[0] + 1) * (most[1] + 1) <= kMostCopies))
        return refuse(RefusalKind::limit, "loops",
                      "they go round the closed surface too often to be compared");
    Loops copies = loops;
    std::vector<std::size_t> shown;
    for (std::size_t i = 0; i < loops.size(); ++i) shown.push_back(i);
    // Of two opposite shifts one is enough.
    for (double m = 0; m <= most[1]; ++m)
        for (double k = m == 0 ? 1 : -most[0]; k <= most[0]; ++k) {
            const Vec<2> by{{k * period[0], m * period[1]}};
            for (std::size_t i = 0; i < loops.size(); ++i) {
                const bool meets = std::ranges::any_of(box, [&](const Box<2>& b) {
                    for (int d = 0; d < 2; ++d)
                        if (box[i].lo[d] + by[d] > b.hi[d] + slack[d] ||
                            box[i].hi[d] + by[d] < b.lo[d] - slack[d])
                            return false;
                    return true;
                });
                if (meets) copies.push_back(shifted(loops[i], by)), shown.push_back(i);
            }
        }
    if (copies.size() == loops.size()) return {};
    const double gap = norm(slack);
    return detail::check_copies(copies, shown, {gap, gap}, gap);
}

}  // namespace

Result<TrimmedSurface> TrimmedSurface::make(std::variant<Surface<Vec<3>>, Surface<Hom<3>>> surface,
                                            Loops loops) {
    const Box<2> box = allowed(surface);
    Vec<2> slack;
    visit_one(
        [&](const auto& s) {
            for (int d = 0; d < 2; ++d) slack[d] = kSlack * s.basis(d).domain().length();
        },
        surface);
    for (std::size_t i = 0; i < loops.size(); ++i)
        if (auto ok = check_loop(loops[i], box, slack); !ok)
            return refuse_within(text("loops[", i, "]"), ok.error());
    if (auto ok = check_crossings(loops, slack); !ok) return std::unexpected(ok.error());
    const Vec<2> period = visit_one(
        [](const auto& s) {
            Vec<2> p;
            for (int d = 0; d < 2; ++d) p[d] = s.basis(d).is_closed() ? s.basis(d).domain().length() : 0;
            return p;
        },
        surface);
    if (max_abs(period) > 0)
        if (auto ok = check_across_seams(loops, period, slack); !ok) return std::unexpected(ok.error());
    return TrimmedSurface{std::move(surface), std::move(loops)};
}

}  // namespace freiform
