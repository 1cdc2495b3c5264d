// Idea. All loops together are one chain of Bezier pieces that jumps from loop to loop; where it meets itself
// is what query/self_intersection.cpp finds, none missed, with a proof where it crosses. What that search
// leaves open are places where branches touch, overlap, or meet in corners. They are decided
//   - exactly, in a vertex that both branches have: they cross if the legs of one separate those of the
//   other;
//   - exactly, in a vertex of one that lies on a segment of the other: likewise;
//   - by the sides on which the loops are before and after, at tangents and curved vertices (loop_sides.cpp);
//   - by winding numbers: a loop that does not cross itself goes round points 0 times or once, in one
//   direction.
// What remains is returned as a contact, not refused: nothing proves that it is more than a touch.
//
// Accuracy. Ends that are apart are moved onto each other, by at most the gap, and conversions are rounded;
// both count as errors of the coefficients, for all of which a certain crossing holds. Exact tests ask for
// pieces that have no such error. Curves of different degree are elevated: one step is a convex combination,
// off by 4 u.
//
// Orientation. Points inside are the middles between neighbouring crossings of a horizontal line with the
// loop, and the winding number there is exact. On which side of another loop a loop lies is asked for its
// vertices: those of polynomial curves are exact, and loops do not cross; one that is not on the other loop
// decides. Points of rational curves are rounded; beside a contact one might be on the wrong side, so all
// that are asked must agree.
//
// Cost: as the search; orientation asks some points for each pair of loops.
#include "trim/loop_links_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/query/crossings.hpp>
#include <freiform/trim/loops.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace freiform {

namespace {

using detail::Link;
using detail::Links;
using detail::Loop;

// --- points inside
// ---------------------------------------------------------------------------------------------

struct Wound {
    Vec<2> point;
    int winding = 0;
};

// Points that the loop goes round, on some horizontal lines.
Result<std::vector<Wound>> points_inside(const Links& all, const Loop& loop, std::size_t index, double gap) {
    const auto query = InsideQuery::make(std::span(&loop, 1), gap);
    if (!query) return std::unexpected(query.error());
    Box<2> box;
    const Interval on = all.loops[index];
    for (std::size_t i = std::size_t(on.lo); i < std::size_t(on.hi); ++i)
        for (const Hom<2>& p : all.link[i].net) box.add(project(p));
    std::vector<Wound> found;
    for (const double part : {0.5, 0.3125, 0.71875, 0.125, 0.90625}) {
        const double y = box.lo[1] + part * (box.hi[1] - box.lo[1]);
        std::vector<double> x;
        for (std::size_t i = std::size_t(on.lo); i < std::size_t(on.hi); ++i) {
            const std::vector<Hom<2>>& net = all.link[i].net;
            const auto arc = Curve<Hom<2>>::make({*BSplineBasis::bezier(int(net.size()) - 1)},
                                                 Net<1, Hom<2>>({int(net.size())}, net));
            if (!arc) return std::unexpected(arc.error());
            const auto hits = crossings(*arc, Vec<2>{{0, 1}}, -y, 0);
            if (!hits) return std::unexpected(hits.error());
            for (const auto& hit : *hits) x.push_back(hit.point[0]);
        }
        sort(x.begin(), x.end());
        for (std::size_t i = 1; i < x.size(); ++i) {
            const Vec<2> q = all.given({{x[i - 1] + (x[i] - x[i - 1]) / 2, y}});
            if (const Inside in = query->at(q); in.winding != 0) found.push_back({q, in.winding});
        }
    }
    return found;
}

Result<void> check_winding(const Links& all, const Loop& loop, std::size_t index, double gap) {
    const auto inside = points_inside(all, loop, index, gap);
    if (!inside) return refuse_within(text("loops[", index, "]"), inside.error());
    for (const Wound& w : *inside)
        if (const Wound& first = inside->front(); std::abs(w.winding) != 1 || w.winding != first.winding)
            return refuse(RefusalKind::invalid, text("loops[", index, "]"),
                          text("the loop crosses itself: it goes round (", w.point[0], ", ", w.point[1], ") ",
                               w.winding, " times, round (", first.point[0], ", ", first.point[1], ") ",
                               first.winding, " times"));
    return {};
}

std::string name_of(std::size_t loop, std::size_t curve) { return text("loops[", loop, "][", curve, "]"); }

// Two edges end in a vertex that is on a third: one place.
void add(std::vector<LoopContact>& all, const LoopContact& next) {
    for (LoopContact& c : all) {
        const double d = norm(c.point - next.point);
        if (c.loop != next.loop || !(d <= c.bound + next.bound)) continue;
        c.bound = std::max(c.bound, (d + next.bound) * (1 + 8 * kUnitRoundoff));
        if (next.kind == LoopContactKind::undecided) c.kind = next.kind;
        return;
    }
    all.push_back(next);
}

struct Checked {
    Links links;
    std::vector<LoopContact> contacts;
};
Result<Checked> checked(std::span<const Loop> loops, const LoopTolerance& tolerance, double error = 0,
                        std::span<const std::size_t> shown = {}) {
    if (!(tolerance.gap >= 0)) return refuse(RefusalKind::invalid, "gap", "is not a length >= 0");
    if (!(tolerance.accuracy > 0)) return refuse(RefusalKind::invalid, "accuracy", "is not a length > 0");
    auto links = detail::links_of(loops, tolerance.gap, error);
    if (!links) return std::unexpected(links.error());
    Checked out{*std::move(links), {}};
    if (out.links.link.empty()) return out;
    const double accuracy =
        std::clamp(std::scalbn(tolerance.accuracy, -out.links.exponent), 0x1p-1000, 0x1p1000);
    const auto found = detail::meetings(out.links, accuracy);
    if (!found) return std::unexpected(found.error());
    const auto link_at = [&](const Interval& on) -> const Link& {
        const double last = double(out.links.link.size()) - 1;
        return out.links.link[std::size_t(std::clamp(on.middle(), 0.0, last))];
    };
    std::vector<LoopContact> contacts;
    std::vector<detail::LoopMeeting> places;
    const auto crosses = [&](const LoopContact& c) {
        const auto name = [&](std::size_t k) {
            return name_of(shown.empty() ? c.loop[k] : shown[c.loop[k]], c.curve[k]);
        };
        return refuse(RefusalKind::invalid, name(0),
                      text("crosses ", name(1), shown.empty() ? "" : " across the seam", " at (", c.point[0],
                           ", ", c.point[1], "), known within ", c.bound));
    };
    for (const SelfIntersection<2>& m : *found) {
        const Link &a = link_at(m.first), &b = link_at(m.second);
        LoopContact contact{{a.loop, b.loop},
                            {a.curve, b.curve},
                            out.links.given(m.point),
                            std::scalbn(m.bound, out.links.exponent)};
        bool is_crossing = m.is_certain();
        if (const auto p =
                is_crossing ? std::nullopt : detail::crossing_vertex(out.links, m.first, m.second)) {
            is_crossing = true;
            contact.point = out.links.given(project(*p));
            contact.bound = 2 * kUnitRoundoff * max_abs(contact.point);
        }
        if (is_crossing) return crosses(contact);
        contacts.push_back(contact);
        places.push_back({contact.loop, {m.first, m.second}});
    }
    const auto how = detail::how_they_meet(out.links, loops, tolerance.gap, places);
    std::vector<char> meets_itself(loops.size());
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        LoopContact& c = contacts[i];
        if (how[i] == detail::Meets::crosses) return crosses(c);
        c.kind = how[i] == detail::Meets::touches ? LoopContactKind::touch : LoopContactKind::undecided;
        if (c.loop[0] == c.loop[1]) meets_itself[c.loop[0]] = true;
        add(out.contacts, c);
    }
    for (std::size_t l = 0; l < loops.size(); ++l)
        if (meets_itself[l])
            if (auto ok = check_winding(out.links, loops[l], l, tolerance.gap); !ok)
                return std::unexpected(ok.error());
    return out;
}

Loop turned(const Loop& loop) {
    Loop back;
    for (auto c = loop.rbegin(); c != loop.rend(); ++c)
        back.push_back(visit_one(
            []<class C>(const C& curve) -> CurveGeometry<2> {
                if constexpr (requires { curve.basis(); }) return reverse(curve, 0);
                C other = curve;
                if constexpr (std::same_as<C, Conic<2>>) other.y = -curve.y;
                return other;
            },
            *c));
    return back;
}

// Whether loop `inner` lies in the region that `outer` goes round; nothing where its points say different
// things.
std::optional<bool> lies_in(const Links& all, std::size_t inner, const InsideQuery& outer) {
    constexpr std::size_t kMostAsked = 64;
    const Interval on = all.loops[inner];
    std::optional<bool> answer;
    std::size_t asked = 0;
    const auto ask = [&](const Vec<2>& p) {
        const Inside in = outer.at(all.given(p));
        if (in.place == Place::boundary) return true;
        ++asked;
        if (answer && *answer != (in.winding != 0)) return false;
        answer = in.winding != 0;
        return true;
    };
    for (std::size_t i = std::size_t(on.lo); i < std::size_t(on.hi) && asked < kMostAsked; ++i) {
        const std::vector<Hom<2>>& net = all.link[i].net;
        if (!ask(project(net.front()))) return std::nullopt;
        if (net.size() == 2 && !ask(0.5 * (project(net[0]) + project(net[1])))) return std::nullopt;
    }
    return answer;
}

}  // namespace

Result<void> detail::check_copies(std::span<const Loop> loops, std::span<const std::size_t> shown,
                                  const LoopTolerance& tolerance, double error) {
    if (auto done = checked(loops, tolerance, error, shown); !done) return std::unexpected(done.error());
    return {};
}

std::string to_text(const LoopContact& c) {
    return text(name_of(c.loop[0], c.curve[0]), " and ", name_of(c.loop[1], c.curve[1]), " at (", c.point[0],
                ", ", c.point[1], ")");
}

Result<std::vector<LoopContact>> check_loops(std::span<const Loop> loops, const LoopTolerance& tolerance) {
    auto done = checked(loops, tolerance);
    if (!done) return std::unexpected(done.error());
    return std::move(done->contacts);
}

Result<OrientedLoops> orient_loops(std::vector<Loop> loops, const LoopTolerance& tolerance) {
    const auto done = checked(loops, tolerance);
    if (!done) return std::unexpected(done.error());
    const std::size_t n = loops.size();
    OrientedLoops out{{}, std::vector<int>(n), {}};
    for (std::size_t o = 0; o < n; ++o) {
        const auto query = InsideQuery::make(std::span(&loops[o], 1), tolerance.gap);
        if (!query) return std::unexpected(query.error());
        for (std::size_t i = 0; i < n; ++i) {
            if (i == o) continue;
            const auto in = lies_in(done->links, i, *query);
            if (!in)
                return refuse(RefusalKind::no_answer, text("loops[", i, "]"),
                              text("it is not certain on which side of loops[", o, "] it lies"));
            out.depth[i] += *in;
        }
    }
    for (std::size_t l = 0; l < n; ++l) {
        const auto inside = points_inside(done->links, loops[l], l, tolerance.gap);
        if (!inside) return refuse_within(text("loops[", l, "]"), inside.error());
        if (inside->empty())
            return refuse(RefusalKind::no_answer, text("loops[", l, "]"),
                          "no point was found that the loop goes round");
        if ((inside->front().winding > 0) == (out.depth[l] % 2 == 0)) continue;
        loops[l] = turned(loops[l]);
        out.reversed.push_back(l);
    }
    out.loops = std::move(loops);
    return out;
}

}  // namespace freiform
