// Idea. The loops of a file bound a face on the surface; in its parameters they need not be closed. Each edge
// is moved by periods until it begins where the one before it ends. Where a loop passes through a pole, an
// edge of no length runs along the pole, to the left as seen from the face. A loop that ends whole periods
// from where it began winds around the surface: two of them, or one and a pole, are joined by a seam, an edge
// that is used twice. A closed surface on which all loops are holes gets its natural boundary.
//
//         v = v1   <---------------            A winds to the right: the face lies above it;
//              |         B         |           B winds to the left: the face lies below.
//         seam |       face        | seam
//              |         A         |           At a pole above, B is an edge of no length.
//         v = v0   --------------->
//
// Why not seams where the parameters begin, as other readers make them: they cut edges in two that the file
// knows as one, and cross holes.
#include "step_loops.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

constexpr double kNearPole = 1e-6;    // of a parameter, of its period or domain
constexpr double kBesidePole = 1e-2;  // likewise
constexpr double kAlongSide = 1e-3;   // likewise: a way along a side
constexpr double kShortSide = 1e-4;   // of the extent of a loop: how far a side is from a point
constexpr int kLooksAtSide = 8;
constexpr int kOutline = 32;                // points of an edge
constexpr std::size_t kMostInOrder = 2000;  // edges: pairs of them are looked at

double scale_of(const Chart& chart, int axis) {
    if (chart.period(axis) > 0) return chart.period(axis);
    const double length = chart.whole()[std::size_t(axis)].length();
    return std::isfinite(length) ? length : 1;
}

bool inside(const Vec<2>& p, const std::vector<Vec<2>>& outline) {
    bool in = false;
    for (std::size_t i = 0, k = outline.size() - 1; i < outline.size(); k = i++) {
        const Vec<2>&a = outline[i], &b = outline[k];
        if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]))
            in = !in;
    }
    return in;
}

}  // namespace

Use make_use(Coedge coedge, const Edge& edge) {
    Use u;
    u.from = edge.start, u.to = edge.end;
    u.start = jet<0>(coedge.curve, edge.range.lo).value();
    u.end = jet<0>(coedge.curve, edge.range.hi).value();
    if (coedge.reversed) std::swap(u.from, u.to), std::swap(u.start, u.end);
    u.coedge = std::move(coedge);
    return u;
}

Use LoopBuilder::degenerate(int vertex, const Vec<2>& from, const Vec<2>& to) {
    Edge e;
    e.degenerate = true;
    e.start = e.end = vertex;
    e.tolerance = close_;
    const int i = int(model_.edges.size());
    model_.edges.push_back(e);
    return make_use({i, false, Line<2>{from, to - from}}, e);
}

const Pole* LoopBuilder::pole_at(const Vec<2>& a, const Vec<2>& b, double close) const {
    for (const Pole& p : chart_.poles()) {
        const double near = kNearPole * scale_of(chart_, p.axis);
        const double turn = chart_.period(p.axis);
        // Exactly, or beside it, as near as vertices that are one: not at the other end of a side that is a
        // point.
        const auto is_there = [&](const Vec<2>& x) {
            const double d = x[p.axis] - p.at, off = std::abs(turn > 0 ? d - std::round(d / turn) * turn : d);
            const bool ends = turn > 0 || std::isfinite(chart_.whole()[std::size_t(p.axis)].length());
            return off <= near || ((!ends || off <= kBesidePole * scale_of(chart_, p.axis)) &&
                                   norm(chart_.point(x) - p.point) <= std::max(close, close_));
        };
        if (is_there(a) && is_there(b)) return &p;
    }
    return nullptr;
}

// Puts `next` behind what is done, with an edge along the pole between them if there is one. Closing: `next`
// is the first one, and stays where it is.
void LoopBuilder::pole_between(std::vector<Use>& done, const Use& last, Use& next, bool closing,
                               double extent) {
    const Pole* pole = pole_at(last.end, next.start);
    if (pole == nullptr)
        if (const auto off = short_side(last, next, kShortSide * extent)) {
            note =
                "a side of its surface, which is hardly longer than its edges lie beside it, closes its loop";
            note_off = std::max(note_off, *off);
            return done.push_back(degenerate(last.to, last.end, next.start));
        }
    if (pole == nullptr) return corner_between(done, last, next);
    const int o = 1 - pole->axis;
    const double turn = chart_.period(o);
    Vec<2> to = next.start;
    to[pole->axis] = last.end[pole->axis];
    if (turn > 0 && !closing) {
        // The side of the pole that the face is on says which way to go.
        const Edge& e = model_.edges[std::size_t(last.coedge.edge)];
        const double inner = jet<0>(last.coedge.curve, e.range.middle()).value()[pole->axis];
        const bool above = inner < last.end[pole->axis];
        const double sign = (pole->axis == 1) == above ? -1 : 1;
        double by = std::remainder(next.start[o] - last.end[o], turn);
        if (std::abs(by) <= kNearPole * turn)
            by = sign * turn;
        else if (by * sign < 0)
            by += sign * turn;
        to[o] = last.end[o] + by;
        const double move = std::round((to[o] - next.start[o]) / turn) * turn;
        Vec<2> shift{};
        shift[o] = move;
        next.coedge.curve = translated(next.coedge.curve, shift);
        next.start += shift, next.end += shift;
        to[o] = next.start[o];
    }
    if (std::abs(to[o] - last.end[o]) <= 1e-9 * scale_of(chart_, o)) return;
    done.push_back(degenerate(last.to, last.end, to));
}

// Whether both end on one side of a spline, far from each other in its parameters, and the side between them
// is so short that what their vertex stands for is all of it: how far it is from that, as seen. It is no
// pole: files have edges along such sides.
std::optional<double> LoopBuilder::short_side(const Use& last, const Use& next, double most) const {
    const Vec<2>&a = last.end, &b = next.start;
    for (int k = 0; k < 2; ++k) {
        const int o = 1 - k;
        if (!chart_.is_spline(k) || chart_.period(k) > 0 || chart_.period(o) > 0) continue;
        const Interval on = chart_.whole()[std::size_t(k)];
        const double slip = kNearPole * on.length();
        const auto at_end = [&](double end) {
            return std::abs(a[k] - end) <= slip && std::abs(b[k] - end) <= slip;
        };
        if (!at_end(on.lo) && !at_end(on.hi)) continue;
        if (!(std::abs(a[o] - b[o]) > kAlongSide * scale_of(chart_, o))) continue;
        const Vec<3>& at = model_.vertices[std::size_t(last.to)].point;
        double off = 0;
        for (int i = 0; i <= kLooksAtSide; ++i)
            off = std::max(off, norm(chart_.point(a + (double(i) / kLooksAtSide) * (b - a)) - at));
        if (off <= most) return off;
    }
    return std::nullopt;
}

// Where two neighbouring sides are one point, along both of them.
void LoopBuilder::corner_between(std::vector<Use>& done, const Use& last, const Use& next) {
    const Pole *a = pole_at(last.end, last.end), *b = pole_at(next.start, next.start);
    if (a == nullptr || b == nullptr || a->axis == b->axis || norm(a->point - b->point) > close_) return;
    Vec<2> corner;
    corner[a->axis] = last.end[a->axis], corner[b->axis] = next.start[b->axis];
    done.push_back(degenerate(last.to, last.end, corner));
    done.push_back(degenerate(last.to, corner, next.start));
}

// Moved by periods to where the one before it ends.
void LoopBuilder::attach(std::vector<Use>& done, Use next) const {
    Vec<2> by{};
    if (!done.empty())
        for (int k = 0; k < 2; ++k)
            if (const double turn = chart_.period(k); turn > 0)
                by[k] = std::round((done.back().end[k] - next.start[k]) / turn) * turn;
    if (by[0] != 0 || by[1] != 0) {
        next.coedge.curve = translated(next.coedge.curve, by);
        next.start += by, next.end += by;
    }
    done.push_back(std::move(next));
}

void LoopBuilder::add(std::vector<Use> uses) {
    const bool closed = is_closed_surface();
    Chain c = chain(closed ? uses : std::move(uses));
    // Seams belong a period apart, with the face between them, on the left.
    const auto is_astray = [&](const Chain& made) {
        bool seam = false;
        for (std::size_t k = 0; k < made.uses.size() && made.uses.size() <= kMostInOrder; ++k)
            for (std::size_t i = 0; i < k; ++i) {
                if (made.uses[i].coedge.edge != made.uses[k].coedge.edge) continue;
                if (is_way_back(made.uses[i], made.uses[k])) return true;
                seam = true;
            }
        return seam && made.area < 0;
    };
    if (closed && is_astray(c)) {
        std::vector<Chain> better;
        const std::size_t edges = model_.edges.size();
        for (auto& loop : in_order(uses)) better.push_back(chain(std::move(loop)));
        if (!better.empty() && std::ranges::none_of(better, is_astray)) {
            for (Chain& b : better) chains_.push_back(std::move(b));
            return;
        }
        model_.edges.resize(edges);
    }
    chains_.push_back(std::move(c));
}

int LoopBuilder::turns(const Vec<2>& by, int k) const {
    const double turn = chart_.period(k), n = turn > 0 ? std::round(by[k] / turn) : 0;
    return std::abs(n) < 9 ? int(n) : 9;
}

LoopBuilder::Chain LoopBuilder::chain(std::vector<Use> uses) {
    Chain c;
    Box<3> box;
    for (Use& u : uses) {
        end_at_poles(u);
        box.add(chart_.point(u.start));
        box.add(chart_.point(u.end));
    }
    const double extent = box.diagonal();
    for (Use& u : uses) {
        if (!c.uses.empty()) {
            const Use last = c.uses.back();
            pole_between(c.uses, last, u, false, extent);
        }
        attach(c.uses, std::move(u));
    }
    Use first = c.uses.front();
    const Use last = c.uses.back();
    const auto winding_of = [&] {
        for (int k = 0; k < 2; ++k) c.winding[std::size_t(k)] = turns(c.uses.back().end - first.start, k);
    };
    pole_between(c.uses, last, first, true, extent);
    winding_of();
    // Which way to turn about a pole between two uses of one edge, and whether at all, only the whole loop
    // tells.
    for (int k = 0; k < 2; ++k)
        for (std::size_t i = 0; i < c.uses.size() && c.winding[std::size_t(k)] != 0; ++i) {
            const double turn = chart_.period(k), by = c.uses[i].end[k] - c.uses[i].start[k];
            if (!model_.edges[std::size_t(c.uses[i].coedge.edge)].degenerate) continue;
            const double better = by - c.winding[std::size_t(k)] * turn;
            // A part of a turn only about the one pole that there is: on the other side there is no face.
            if (std::abs(std::abs(by) - turn) > kNearPole * turn && chart_.poles().size() != 1) continue;
            if (std::abs(better) > 1.5 * turn) continue;
            if (std::abs(better) <= kNearPole * turn) {
                c.uses.erase(c.uses.begin() + std::ptrdiff_t(i));
            } else {
                auto& line = std::get<Line<2>>(c.uses[i].coedge.curve);
                line.direction[k] = better;
                c.uses[i].end[k] = c.uses[i].start[k] + better;
            }
            std::vector<Use> again;
            for (Use& u : c.uses) attach(again, std::move(u));
            c.uses = std::move(again);
            first = c.uses.front();
            winding_of();
        }
    close_joints(c);
    measure(c);
    return c;
}

void LoopBuilder::measure(Chain& c) const {
    c.outline.clear();
    for (const Use& u : c.uses) {
        const Interval on = model_.edges[std::size_t(u.coedge.edge)].range;
        const bool straight = std::holds_alternative<Line<2>>(u.coedge.curve);
        const int n = straight ? 1 : kOutline;
        std::vector<double> t;
        for (int i = 0; i < n; ++i) t.push_back(on.lo + on.length() * i / n);
        if (const auto* s = std::get_if<Curve<Vec<2>>>(&u.coedge.curve); s != nullptr && u.fitted) {
            // Splines that follow an edge have their pieces where it turns.
            const auto breaks = s->basis().breaks();
            if (breaks.size() > t.size()) t.assign(breaks.begin(), breaks.end() - 1);
        }
        if (u.coedge.reversed) {
            t.push_back(on.hi);
            std::ranges::reverse(t);
            t.pop_back();
        }
        for (const double x : t) c.outline.push_back(jet<0>(u.coedge.curve, x).value());
    }
    c.area = 0;
    for (std::size_t i = 0; i < c.outline.size(); ++i)
        c.area +=
            cross(c.outline[i] - c.outline[0], c.outline[(i + 1) % c.outline.size()] - c.outline[0]) / 2;
}

void LoopBuilder::move(Chain& c, const Vec<2>& by) const {
    if (by[0] == 0 && by[1] == 0) return;
    for (Use& u : c.uses) {
        u.coedge.curve = translated(u.coedge.curve, by);
        u.start += by, u.end += by;
    }
    for (Vec<2>& p : c.outline) p += by;
}

bool LoopBuilder::is_closed_surface() const {
    for (int k = 0; k < 2; ++k) {
        const bool poles = std::count_if(chart_.poles().begin(), chart_.poles().end(),
                                         [&](const Pole& p) { return p.axis == k; }) >= 2;
        if (!(chart_.period(k) > 0) && !poles) return false;
    }
    return true;
}

// One that goes around all of the surface is its boundary, however it runs.
bool LoopBuilder::goes_around_all(const Chain& c, double all) { return std::abs(c.area) > all * (1 - 1e-6); }

// Holes to the picture of the parameters in which they lie inside the others.
void LoopBuilder::place_holes(double all) {
    std::size_t outer = chains_.size();
    const auto size = [&](const Chain& c) { return goes_around_all(c, all) ? std::abs(c.area) : c.area; };
    for (std::size_t i = 0; i < chains_.size(); ++i)
        if (outer == chains_.size() || size(chains_[i]) > size(chains_[outer])) outer = i;
    if (outer == chains_.size() || !(size(chains_[outer]) > 0)) return;
    for (std::size_t i = 0; i < chains_.size(); ++i) {
        if (i == outer || chains_[i].outline.empty()) continue;
        Chain& c = chains_[i];
        bool done = false;
        for (int n = 0; n < 25 && !done; ++n) {
            constexpr int kOrder[] = {0, 1, -1, 2, -2};
            const Vec<2> by{{kOrder[n % 5] * chart_.period(0), kOrder[n / 5] * chart_.period(1)}};
            std::size_t in = 0;
            for (const Vec<2>& p : c.outline) in += inside(p + by, chains_[outer].outline) ? 1 : 0;
            done = 2 * in > c.outline.size();
            if (done) move(c, by);
        }
    }
}

// Whether a whole turn of the chain is a pole: what it encloses lies between that and its other edges.
bool LoopBuilder::rounds_pole(const Chain& c) const {
    return std::any_of(c.uses.begin(), c.uses.end(), [&](const Use& u) {
        if (!model_.edges[std::size_t(u.coedge.edge)].degenerate) return false;
        const Vec<2> by = u.end - u.start;
        const double turn = chart_.period(by[0] != 0 ? 0 : 1);
        return turn > 0 && max_abs(by) >= (1 - kNearPole) * turn;
    });
}

// All loops together to parameters near the domain.
void LoopBuilder::into_domain() {
    Box<2> box;
    for (const Chain& c : chains_)
        for (const Vec<2>& p : c.outline) box.add(p);
    if (box.is_empty()) return;
    Vec<2> by{};
    for (int k = 0; k < 2; ++k)
        if (const double turn = chart_.period(k); turn > 0) {
            const bool sphere = chart_.whole()[std::size_t(k)].length() < turn || !chart_.poles().empty();
            const double lo = sphere && k == 1      ? chart_.whole()[1].lo
                              : chart_.is_spline(k) ? chart_.whole()[std::size_t(k)].lo
                                                    : 0;
            by[k] = -std::floor((box.lo[k] - lo) / turn + 1e-9) * turn;
        }
    for (Chain& c : chains_) move(c, by);
}

// The largest loop is the outer one, and runs counter-clockwise; the others are its holes.
void LoopBuilder::set_right(double all) {
    const auto outer = std::ranges::max_element(chains_, {}, [](const Chain& c) { return std::abs(c.area); });
    if (outer == chains_.end() || !(outer->area < 0) || goes_around_all(*outer, all)) return;
    is_wrong = true;
    if (wrong_way != WrongWay::turned) return;
    for (Chain& c : chains_)
        if ((c.area < 0) == (&c == &*outer)) turn_around(c);
}

Result<std::vector<std::vector<Use>>> LoopBuilder::finish() {
    for (const Chain& c : chains_)
        if (c.winding[0] != 0 && c.winding[1] != 0)
            return refuse(RefusalKind::unsupported, "loop", "winds around the surface in both directions");
    release_spurs();
    release_seams();
    for (int axis = 0; axis < 2; ++axis)
        if (auto ok = join_winding(axis); !ok) return std::unexpected(ok.error());
    for (Chain& c : chains_)
        if (c.area < 0 && rounds_pole(c)) {
            note =
                "its loop runs to a pole along a seam, and the wrong way around it; it is taken the other "
                "way";
            turn_around(c);
        }
    const double all = chart_.whole()[0].length() * chart_.whole()[1].length();
    const bool only_holes = std::all_of(chains_.begin(), chains_.end(), [&](const Chain& c) {
        return c.area < 0 && !goes_around_all(c, all);
    });
    if (!is_closed_surface()) set_right(all);
    if (only_holes && (is_closed_surface() || chains_.empty()))
        if (auto ok = add_whole(); !ok) return std::unexpected(ok.error());
    place_holes(all);
    into_domain();
    std::vector<std::vector<Use>> out;
    for (Chain& c : chains_) out.push_back(std::move(c.uses));
    return out;
}

}  // namespace freiform::step
