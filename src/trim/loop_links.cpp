// Essay: loops.cpp.
#include "trim/loop_links_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/poly/exact.hpp>

#include <algorithm>
#include <numbers>

namespace freiform::detail {

namespace {

bool is_point(const std::vector<Hom<2>>& net) {
    return std::all_of(net.begin(), net.end(), [&](const auto& p) { return project(p) == project(net[0]); });
}

double size_of(const std::vector<Hom<2>>& net) {
    double most = 0;
    for (const Hom<2>& p : net) most = std::max(most, max_abs(p));
    return most;
}

// Quarters of an ellipse: corners of a frame, each the sum of three vectors, rounded, times sqrt(1/2),
// rounded.
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
        if (link.error > 0) link.error = std::scalbn(link.error, -all.exponent) + 8 * kUnitRoundoff;
    }
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
    return (Exact(p[0]) * minor(q, r, 1, 2) - Exact(p[1]) * minor(q, r, 0, 2) +
            Exact(p[2]) * minor(q, r, 0, 1))
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

}  // namespace

Result<Links> links_of(std::span<const Loop> loops, double gap, double error) {
    Links all;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const auto chain = chain_of(loops[l], gap);
        if (!chain) return refuse_within(text("loops[", l, "]"), chain.error());
        const std::size_t first = all.link.size();
        for (const auto& piece : *chain)
            if (auto net = piece.lifted(); !is_point(net))
                all.link.push_back({std::move(net), 0, l, piece.curve});
        if (const Conic<2>* e = ellipse_of(loops[l]))
            for (auto& net : quarters(*e)) {
                const double rounding =
                    8 * kUnitRoundoff * (max_abs(e->centre) + max_abs(e->x) + max_abs(e->y));
                all.link.push_back({std::move(net), rounding, l, 0});
            }
        const std::size_t end = all.link.size();
        for (std::size_t i = first; i < end; ++i) {  // close what is open
            const std::vector<Hom<2>>& before = all.link[i == first ? end - 1 : i - 1].net;
            Link& link = all.link[i];
            if (before.back() == link.net.front()) continue;
            const Hom<2> moved = weighted(project(before.back()), link.net.front().weight());
            link.error += 1.01 * max_abs(moved - link.net.front()) +
                          4 * kUnitRoundoff * (max_abs(moved) + max_abs(link.net.front()));
            link.net.front() = moved;
        }
        all.loops.push_back({double(first), double(end)});
    }
    if (error > 0)
        for (Link& link : all.link) {
            double heaviest = 0;
            for (const Hom<2>& p : link.net) heaviest = std::max(heaviest, p.weight());
            link.error += error * heaviest;
        }
    scale(all);
    return all;
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
        for (; b.size() < most; b = elevated(b)) error += 4 * kUnitRoundoff * size_of(b);
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
    auto found = self_intersections(*chain, all.loops, errors, accuracy, budget);
    if (!found) return refuse(found.error().kind, "loops", found.error().message);
    return found;
}

// A vertex in which the branches over both intervals cross.
std::optional<Hom<2>> crossing_vertex(const Links& all, const Interval& first, const Interval& second) {
    const Around sides[2] = {around(all, first), around(all, second)};
    for (const std::size_t i : sides[0].joints)
        for (const std::size_t j : sides[1].joints) {
            const Hom<2>& p = all.link[i].net.front();
            const auto a = branch_at(all, i), b = branch_at(all, j);
            if (i != j && a && b && is_same(p, all.link[j].net.front()) &&
                cross_at(p, *a, *b).value_or(false))
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

}  // namespace freiform::detail
