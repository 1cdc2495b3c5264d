// Idea. All loops together are one chain of Bezier pieces that jumps from loop to loop; where it meets itself is
// what query/self_intersection.cpp finds, none missed, with a proof where it crosses. What that search leaves open
// are places where branches touch, overlap, or meet in corners; three exact tests decide some of them:
//   - in a vertex that both branches have: they cross if the legs of one separate those of the other;
//   - in a vertex of one that lies on a segment of the other: likewise;
//   - by winding numbers: a loop that does not cross itself goes round points 0 times or once, in one direction.
// What remains is returned as a contact, not refused: nothing proves that it is more than a touch.
//
// Accuracy. Ends that are apart are moved onto each other, by at most the gap, and conversions are rounded; both
// count as errors of the coefficients, for all of which a certain crossing holds. Exact tests ask for pieces that
// have no such error. Curves of different degree are elevated: one step is a convex combination, off by 4 u.
//
// Orientation. Points inside are the middles between neighbouring crossings of a horizontal line with the loop,
// and the winding number there is exact. On which side of another loop a loop lies is asked for its vertices: those
// of polynomial curves are exact, and loops do not cross; one that is not on the other loop decides. Points of
// rational curves are rounded; beside a contact one might be on the wrong side, so all that are asked must agree.
//
// Cost: as the search; orientation asks some points for each pair of loops.
#include "query/self_intersection_detail.hpp"
#include "trim/chain_detail.hpp"

#include <freiform/poly/exact.hpp>
#include <freiform/query/crossings.hpp>
#include <freiform/trim/loops.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace freiform {

namespace {

using Loop = std::vector<CurveGeometry<2>>;
constexpr double kU = 0x1p-53;

// --- the chain of all loops
// ------------------------------------------------------------------------------------

struct Link {
    std::vector<Hom<2>> net;
    double error = 0;
    std::size_t loop = 0, curve = 0;
};
struct Links {
    std::vector<Link> link;       // link i is over [i, i + 1] of the parameter
    std::vector<Interval> loops;  // of the parameter, each; empty ones have lo == hi
    int exponent = 0;             // points of `link` are those given, times 2^-exponent: of size 1

    Vec<2> given(const Vec<2>& p) const { return {{std::scalbn(p[0], exponent), std::scalbn(p[1], exponent)}}; }

    const Link& before(std::size_t joint) const {
        const Interval& on = loops[link[joint].loop];
        return link[double(joint) == on.lo ? std::size_t(on.hi) - 1 : joint - 1];
    }
};

bool is_point(const std::vector<Hom<2>>& net) {
    return std::all_of(net.begin(), net.end(), [&](const auto& p) { return project(p) == project(net[0]); });
}

double size_of(const std::vector<Hom<2>>& net) {
    double most = 0;
    for (const Hom<2>& p : net) most = std::max(most, max_abs(p));
    return most;
}

// Quarters of an ellipse: corners of a frame, each the sum of three vectors, rounded, times sqrt(1/2), rounded.
std::vector<std::vector<Hom<2>>> quarters(const Conic<2>& e) {
    const Vec<2> axis[5] = {e.x, e.y, -e.x, -e.y, e.x};
    std::vector<std::vector<Hom<2>>> all;
    for (int i = 0; i < 4; ++i)
        all.push_back({weighted(e.centre + axis[i], 1),
                       weighted(e.centre + axis[i] + axis[i + 1], std::numbers::sqrt2 / 2),
                       weighted(e.centre + axis[i + 1], 1)});
    return all;
}

// So that errors of coordinates and of weights can be measured alike. Exact.
void scale(Links& all) {
    double most = 0;
    for (const Link& link : all.link)
        for (const Hom<2>& p : link.net) most = std::max(most, max_abs(project(p)));
    if (most == 0) return;
    all.exponent = std::ilogb(most);
    for (Link& link : all.link) {
        for (Hom<2>& p : link.net)
            for (int d = 0; d < 2; ++d) p[d] = std::scalbn(p[d], -all.exponent);
        if (link.error > 0) link.error = std::scalbn(link.error, -all.exponent) + 8 * kU;
    }
}

Result<Links> links_of(std::span<const Loop> loops, double gap) {
    Links all;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const auto chain = detail::chain_of(loops[l], gap);
        if (!chain) return refuse_within(text("loops[", l, "]"), chain.error());
        const std::size_t first = all.link.size();
        for (const auto& piece : *chain)
            if (auto net = piece.lifted(); !is_point(net))
                all.link.push_back({std::move(net), 0, l, piece.curve});
        if (const Conic<2>* e = detail::ellipse_of(loops[l]))
            for (auto& net : quarters(*e)) {
                const double error = 8 * kU * (max_abs(e->centre) + max_abs(e->x) + max_abs(e->y));
                all.link.push_back({std::move(net), error, l, 0});
            }
        const std::size_t end = all.link.size();
        for (std::size_t i = first; i < end; ++i) {  // close what is open
            const std::vector<Hom<2>>& before = all.link[i == first ? end - 1 : i - 1].net;
            Link& link = all.link[i];
            if (before.back() == link.net.front()) continue;
            const Hom<2> moved = weighted(project(before.back()), link.net.front().weight());
            link.error += 1.01 * max_abs(moved - link.net.front()) +
                          4 * kU * (max_abs(moved) + max_abs(link.net.front()));
            link.net.front() = moved;
        }
        all.loops.push_back({double(first), double(end)});
    }
    scale(all);
    return all;
}

// One degree more; off by 4 u of the largest coefficient.
std::vector<Hom<2>> elevated(const std::vector<Hom<2>>& b) {
    const int n = int(b.size());
    std::vector<Hom<2>> up(b.size() + 1);
    for (int i = 0; i <= n; ++i) {
        const double s = double(i) / n;
        if (i > 0) up[std::size_t(i)] += s * b[std::size_t(i) - 1];
        if (i < n) up[std::size_t(i)] += (1 - s) * b[std::size_t(i)];
    }
    return up;
}

// On neighbouring whole numbers; it jumps between loops.
Result<std::vector<SelfIntersection<2>>> meetings(const Links& all, double accuracy) {
    std::size_t most = 0;
    for (const Link& l : all.link) most = std::max(most, l.net.size());
    const int degree = int(most) - 1, count = int(all.link.size());
    std::vector<double> knots(1, 0.0), errors;
    std::vector<Hom<2>> net;
    for (int i = 0; i < count; ++i) {
        const Link& link = all.link[std::size_t(i)];
        std::vector<Hom<2>> b = link.net;
        double error = link.error;
        for (; b.size() < most; b = elevated(b)) error += 4 * kU * size_of(b);
        errors.push_back(error);
        const bool jumps = i == 0 || all.link[std::size_t(i) - 1].loop != link.loop;
        net.insert(net.end(), b.begin() + (jumps ? 0 : 1), b.end());
        knots.insert(knots.end(), std::size_t(degree + (jumps && i > 0)), double(i));
    }
    knots.insert(knots.end(), std::size_t(degree) + 1, double(count));
    auto basis = BSplineBasis::make(degree, std::move(knots));
    if (!basis) return std::unexpected(basis.error());
    const Index<1> extent{int(net.size())};
    auto chain = Curve<Hom<2>>::make({*std::move(basis)}, Net<1, Hom<2>>(extent, std::move(net)));
    if (!chain) return std::unexpected(chain.error());
    const int budget = 20000 + 100 * std::min(count, 1 << 20);
    auto found = detail::meetings_of_chain(*chain, all.loops, errors, accuracy, budget);
    if (!found)
        return refuse(RefusalKind::limit, "loops",
                      text("more than ", budget, " pairs of their ", count, " pieces lie on each other"));
    return *std::move(found);
}

// --- exact tests in vertices
// -----------------------------------------------------------------------------------

// Where a branch comes from and goes to: control points beside the apex.
struct Branch {
    Hom<2> from, to;
};

// The sign of the determinant of three points: do they turn to the left?
int turn(const Hom<2>& p, const Hom<2>& q, const Hom<2>& r) {
    const auto minor = [](const Hom<2>& a, const Hom<2>& b, int i, int j) {
        return Exact(a[i]) * Exact(b[j]) - Exact(a[j]) * Exact(b[i]);
    };
    return (Exact(p[0]) * minor(q, r, 1, 2) - Exact(p[1]) * minor(q, r, 0, 2) + Exact(p[2]) * minor(q, r, 0, 1))
        .sign();
}
// The sign of (q - p) . (r - p).
int along(const Hom<2>& p, const Hom<2>& q, const Hom<2>& r) {
    Exact sum;
    for (int i = 0; i < 2; ++i)
        sum = sum + (Exact(q[i]) * Exact(p[2]) - Exact(p[i]) * Exact(q[2])) *
                        (Exact(r[i]) * Exact(p[2]) - Exact(p[i]) * Exact(r[2]));
    return sum.sign();
}
bool is_same(const Hom<2>& p, const Hom<2>& q) {
    const auto agrees = [&](int i) { return Exact(p[i]) * Exact(q[2]) == Exact(q[i]) * Exact(p[2]); };
    return agrees(0) && agrees(1);
}

// Do the branches cross at p? Nothing, where two of the four legs have one direction.
std::optional<bool> cross_at(const Hom<2>& p, const Branch& a, const Branch& b) {
    const Hom<2> legs[4] = {a.from, a.to, b.from, b.to};
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < i; ++j)
            if (turn(p, legs[i], legs[j]) == 0 && along(p, legs[i], legs[j]) >= 0) return std::nullopt;
    // Counter-clockwise from a.to to a.from.
    const auto is_left = [&](const Hom<2>& d) {
        const int whole = turn(p, a.to, a.from), first = turn(p, a.to, d), second = turn(p, d, a.from);
        if (whole > 0) return first > 0 && second > 0;
        if (whole < 0) return first > 0 || second > 0;
        return first > 0;
    };
    return is_left(b.from) != is_left(b.to);
}

std::optional<Branch> branch_at(const Links& all, std::size_t joint) {
    const Link &in = all.before(joint), &out = all.link[joint];
    if (in.error > 0 || out.error > 0) return std::nullopt;
    const Hom<2>& p = out.net.front();
    const auto other = [&](const Hom<2>& q) { return !is_same(p, q); };
    const auto from = std::find_if(in.net.rbegin(), in.net.rend(), other);
    const auto to = std::find_if(out.net.begin(), out.net.end(), other);
    if (from == in.net.rend() || to == out.net.end()) return std::nullopt;
    return Branch{*from, *to};
}

// The links whose start is a vertex in `on`, and all links that reach into it.
struct Around {
    std::vector<std::size_t> joints, links;
};
Around around(const Links& all, Interval on) {
    Around found;
    const auto index = [&](double t) { return std::size_t(std::clamp(t, 0.0, double(all.link.size()) - 1)); };
    const std::size_t loop = all.link[index(on.middle())].loop;
    const Interval whole = all.loops[loop];
    for (std::size_t i = index(std::max(whole.lo, on.lo)); i < all.link.size() && double(i) <= on.hi; ++i) {
        if (all.link[i].loop != loop) break;
        found.links.push_back(i);
        if (double(i) >= on.lo) found.joints.push_back(i);
    }
    if (on.hi >= whole.hi) found.joints.push_back(std::size_t(whole.lo));
    return found;
}

// A vertex in which the branches over both intervals cross.
std::optional<Hom<2>> crossing_vertex(const Links& all, const Interval& first, const Interval& second) {
    const Around sides[2] = {around(all, first), around(all, second)};
    for (const std::size_t i : sides[0].joints)
        for (const std::size_t j : sides[1].joints) {
            const Hom<2>& p = all.link[i].net.front();
            const auto a = branch_at(all, i), b = branch_at(all, j);
            if (i != j && a && b && is_same(p, all.link[j].net.front()) && cross_at(p, *a, *b).value_or(false))
                return p;
        }
    for (int k = 0; k < 2; ++k)
        for (const std::size_t i : sides[k].joints)
            for (const std::size_t j : sides[1 - k].links) {
                const Hom<2>& p = all.link[i].net.front();
                const Link& l = all.link[j];
                const auto a = branch_at(all, i);
                if (!a || l.error > 0 || l.net.size() != 2 || turn(p, l.net[0], l.net[1]) != 0 ||
                    along(p, l.net[0], l.net[1]) >= 0)
                    continue;
                if (cross_at(p, *a, {l.net[0], l.net[1]}).value_or(false)) return p;
            }
    return std::nullopt;
}

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
        std::sort(x.begin(), x.end());
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
        c.bound = std::max(c.bound, (d + next.bound) * (1 + 8 * kU));
        return;
    }
    all.push_back(next);
}

struct Checked {
    Links links;
    std::vector<LoopContact> contacts;
};
Result<Checked> checked(std::span<const Loop> loops, const LoopTolerance& tolerance) {
    if (!(tolerance.gap >= 0)) return refuse(RefusalKind::invalid, "gap", "is not a length >= 0");
    if (!(tolerance.accuracy > 0)) return refuse(RefusalKind::invalid, "accuracy", "is not a length > 0");
    auto links = links_of(loops, tolerance.gap);
    if (!links) return std::unexpected(links.error());
    Checked out{*std::move(links), {}};
    if (out.links.link.empty()) return out;
    const double accuracy =
        std::clamp(std::scalbn(tolerance.accuracy, -out.links.exponent), 0x1p-1000, 0x1p1000);
    const auto found = meetings(out.links, accuracy);
    if (!found) return std::unexpected(found.error());
    const auto link_at = [&](const Interval& on) -> const Link& {
        const double last = double(out.links.link.size()) - 1;
        return out.links.link[std::size_t(std::clamp(on.middle(), 0.0, last))];
    };
    std::vector<char> meets_itself(loops.size());
    for (const SelfIntersection<2>& m : *found) {
        const Link &a = link_at(m.first), &b = link_at(m.second);
        LoopContact contact{{a.loop, b.loop},
                            {a.curve, b.curve},
                            out.links.given(m.point),
                            std::scalbn(m.bound, out.links.exponent)};
        bool is_crossing = m.is_certain;
        if (const auto p = is_crossing ? std::nullopt : crossing_vertex(out.links, m.first, m.second)) {
            is_crossing = true;
            contact.point = out.links.given(project(*p));
            contact.bound = 2 * kU * max_abs(contact.point);
        }
        if (is_crossing)
            return refuse(RefusalKind::invalid, name_of(a.loop, a.curve),
                          text("crosses ", name_of(b.loop, b.curve), " at (", contact.point[0], ", ",
                               contact.point[1], "), known within ", contact.bound));
        if (a.loop == b.loop) meets_itself[a.loop] = true;
        add(out.contacts, contact);
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
        back.push_back(std::visit(
            []<class C>(const C& curve) -> CurveGeometry<2> {
                if constexpr (requires { curve.basis(); }) return reverse(curve, 0);
                C other = curve;
                if constexpr (std::same_as<C, Conic<2>>) other.y = -curve.y;
                return other;
            },
            *c));
    return back;
}

// Whether loop `inner` lies in the region that `outer` goes round; nothing where its points say different things.
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
