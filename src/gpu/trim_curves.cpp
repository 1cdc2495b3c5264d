// Trimming loops for graphics cards.
//
// Idea. Whether a fragment is inside its face is decided for that fragment, by the curves themselves: a ray
// in the direction of u meets a curve that is monotone in u and v once or not at all, and halving finds out.
// Curves whose box the ray misses, nearly all, cost one comparison each, and only those of one band are
// looked at.
//
// Method. Parameter curves become rational Bezier pieces in the unit box of the face. A piece whose control
// points increase or decrease in both coordinates is monotone (variation diminishing: a line u = c meets the
// curve no more often than the polygon; weights are positive). Others are cut where a coordinate has an
// extremum, found by the sign of its derivative, else in the middle. The ends of neighbours are made the same
// numbers, so that the half-open rule lo <= v < hi counts every joint once; open joints get a segment. Curves
// along the sides of the box alone are left out: then the face is the box.
//
// Cost. Pieces times their degree; bands as many as curves, up to 1024.
//
// Accuracy. In shaders parameters and curves are floats in the unit box: the boundary is off by some 2^-23 of
// the face, which a picture of 16384 pixels does not show.
//
// References: [Schollmeyer Froehlich 2009], who trim by monotone curves in bands, too; [Nishita Sederberg
// Kakimoto 1990].
//
// Why not a texture of the trimmed domain: it is as coarse as its texels, and zooming in shows them.
#include "gpu/rational_pieces_detail.hpp"
#include "gpu/trim_curves_detail.hpp"

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kFlatStep =
    0x1p-26;  // of the unit box, below what floats show: control points may step back
constexpr double kSmallCurve = 0x1p-26;  // what is smaller is its chord
constexpr std::size_t kMostCurves = 100'000, kMostBands = 1024;
constexpr int kSamples = 16;
constexpr double kNearEnd = 1.0 / 64;

using Net2 = std::vector<Hom<2>>;

bool is_monotone(const Net2& net, int axis) {
    double least = 0, most = 0;
    for (std::size_t i = 1; i < net.size(); ++i) {
        const double step = project(net[i])[axis] - project(net[i - 1])[axis];
        least = std::min(least, step), most = std::max(most, step);
    }
    return least >= -kFlatStep || most <= kFlatStep;
}

std::array<Net2, 2> halves_at(const Net2& net, double t) {
    std::array<Net2, 2> out{net, net};
    const std::size_t n = net.size();
    for (std::size_t r = 1; r < n; ++r)
        for (std::size_t i = n - 1; i >= r; --i) out[0][i] = (1 - t) * out[0][i - 1] + t * out[0][i];
    for (std::size_t r = 1; r < n; ++r)
        for (std::size_t i = 0; i < n - r; ++i) out[1][i] = (1 - t) * out[1][i] + t * out[1][i + 1];
    return out;
}

// The sign of the derivative of a coordinate: U' W - U W'.
double turning(Net2 net, int axis, double t) {
    const std::size_t n = net.size();
    for (std::size_t r = 1; r + 1 < n; ++r)
        for (std::size_t i = 0; i < n - r; ++i) net[i] = (1 - t) * net[i] + t * net[i + 1];
    const Hom<2> at = (1 - t) * net[0] + t * net[1], slope = net[1] - net[0];
    return slope[axis] * at.weight() - at[axis] * slope.weight();
}

double place_to_cut(const Net2& net) {
    for (const int axis : {0, 1}) {
        if (is_monotone(net, axis)) continue;
        double lo = 0, before = turning(net, axis, 0);
        for (int k = 1; k <= kSamples; ++k) {
            double hi = double(k) / kSamples;
            const double here = turning(net, axis, hi);
            if (before * here < 0) {
                for (int step = 0; step < 60; ++step) {
                    const double middle = (lo + hi) / 2;
                    ((turning(net, axis, middle) < 0) == (before < 0) ? lo : hi) = middle;
                }
                // Near an end it may be rounding at the last cut; after halving it is not near.
                if (lo > kNearEnd && lo < 1 - kNearEnd) return lo;
            }
            lo = double(k) / kSamples, before = here;
        }
    }
    return 0.5;
}

Box<2> hull_of(const Net2& net) {
    Box<2> box;
    for (const Hom<2>& h : net) box.add(project(h));
    return box;
}

// Stops beyond kMostCurves.
void add_monotone(std::vector<MonotoneCurve>& out, const Net2& whole) {
    std::vector<Net2> stack{whole};
    while (!stack.empty() && out.size() <= kMostCurves) {
        Net2 net = std::move(stack.back());
        stack.pop_back();
        const Box<2> hull = hull_of(net);
        if (max_abs(hull.hi - hull.lo) < kSmallCurve) net = {net.front(), net.back()};
        if (is_monotone(net, 0) && is_monotone(net, 1)) {
            out.push_back({std::move(net), {}});
            continue;
        }
        auto [low, high] = halves_at(net, place_to_cut(net));
        stack.push_back(std::move(high));
        stack.push_back(std::move(low));
    }
}

float as_float(double x) { return float(x); }

// Rounded to what shaders see, with weights 1 at the ends, so that neighbours end in the same numbers.
Hom<2> rounded_end(const Vec<2>& p) { return weighted(Vec<2>{{as_float(p[0]), as_float(p[1])}}, 1.0); }

void end_with(Net2& net, bool last, const Vec<2>& p) {
    Hom<2>& end = last ? net.back() : net.front();
    end = end.weight() * rounded_end(p);
}

// One loop: its curves in order, joints closed.
void add_loop(std::vector<MonotoneCurve>& out, const std::vector<Net2>& pieces) {
    std::vector<MonotoneCurve> loop;
    for (const Net2& net : pieces) {
        std::vector<MonotoneCurve> own;
        add_monotone(own, net);
        for (std::size_t i = 0; i + 1 < own.size(); ++i) own[i + 1].net.front() = own[i].net.back();
        loop.insert(loop.end(), own.begin(), own.end());
    }
    const std::size_t n = loop.size();
    std::vector<MonotoneCurve> joints;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec<2> from = project(loop[i].net.back()), to = project(loop[(i + 1) % n].net.front());
        const Hom<2> a = rounded_end(from), b = rounded_end(to);
        end_with(loop[i].net, true, from);
        end_with(loop[(i + 1) % n].net, false, to);
        if (a != b) joints.push_back({{a, b}, {}});
    }
    loop.insert(loop.end(), joints.begin(), joints.end());
    for (MonotoneCurve& c : loop) {
        for (const bool last : {false, true}) {
            const Vec<2> p = project(last ? c.net.back() : c.net.front());
            c.box.add(Vec<2>{{as_float(p[0]), as_float(p[1])}});
        }
        out.push_back(std::move(c));
    }
}

// Along a side of the box, or a point.
bool is_on_side(const MonotoneCurve& c) {
    constexpr double kSide = 0x1p-22;
    for (const int axis : {0, 1})
        if (c.box.hi[axis] <= kSide || c.box.lo[axis] >= 1 - kSide) return true;
    return false;
}

Result<std::vector<std::vector<Net2>>> loop_pieces(const Face& face, const std::vector<Edge>& edges) {
    std::vector<std::vector<Net2>> loops;
    for (std::size_t l = 0; l < face.loops.size(); ++l) {
        loops.emplace_back();
        const auto& coedges = face.loops[l].coedges;
        for (std::size_t c = 0; c < coedges.size(); ++c) {
            auto pieces = rational_pieces(coedges[c].curve, edges[std::size_t(coedges[c].edge)].range);
            if (!pieces) return refuse_within(text("loops[", l, "][", c, "]"), pieces.error());
            if (coedges[c].reversed) {
                std::ranges::reverse(*pieces);
                for (CurvePiece<2>& p : *pieces) std::ranges::reverse(p.net);
            }
            for (CurvePiece<2>& p : *pieces) loops.back().push_back(std::move(p.net));
        }
    }
    return loops;
}

std::unexpected<Refusal> too_many_curves() {
    return refuse(RefusalKind::limit, "loops", text("more than ", kMostCurves, " monotone curves"));
}

Result<Box<2>> box_of(const std::vector<std::vector<Net2>>& loops, const SurfaceGeometry& surface) {
    std::vector<MonotoneCurve> curves;
    for (const auto& loop : loops)
        for (const Net2& net : loop) add_monotone(curves, net);
    if (curves.size() > kMostCurves) return too_many_curves();
    Box<2> box;
    const auto on = limits(surface);
    for (const MonotoneCurve& c : curves)
        for (const Hom<2>* end : {&c.net.front(), &c.net.back()}) box.add(clamped(project(*end), on));
    return box;
}

}  // namespace

Result<Box<2>> parameter_box(const Face& face, const std::vector<Edge>& edges) {
    const auto loops = loop_pieces(face, edges);
    if (!loops) return std::unexpected(loops.error());
    auto box = box_of(*loops, face.surface);
    if (!box) return box;
    if (loops->empty()) {
        const auto on = domain(face.surface);
        *box = {{{on[0].lo, on[1].lo}}, {{on[0].hi, on[1].hi}}};
    }
    for (const int axis : {0, 1})
        if (!(box->lo[axis] < box->hi[axis]))
            return refuse(RefusalKind::invalid, "loops", "enclose nothing in the parameter plane");
    return box;
}

Result<TrimCurves> trim_curves(const Face& face, const std::vector<Edge>& edges) {
    const auto box = parameter_box(face, edges);
    if (!box) return std::unexpected(box.error());
    TrimCurves out{*box, {}, {}};
    auto loops = loop_pieces(face, edges);
    for (auto& loop : *loops) {
        for (Net2& net : loop)
            for (Hom<2>& h : net)
                for (int k = 0; k < 2; ++k)
                    h[k] = (h[k] - h.weight() * box->lo[k]) / (box->hi[k] - box->lo[k]);
        add_loop(out.curves, loop);
        if (out.curves.size() > kMostCurves) return too_many_curves();
    }
    if (std::ranges::all_of(out.curves, is_on_side)) out.curves.clear();
    const std::size_t bands = std::min(out.curves.size(), kMostBands);
    out.bands.resize(bands);
    for (std::size_t i = 0; i < out.curves.size(); ++i) {
        // A band more on both sides: shaders round otherwise.
        const Box<2>& b = out.curves[i].box;
        if (b.lo[1] == b.hi[1]) continue;
        const double n = double(bands);
        const auto band = [&](double v) { return std::size_t(std::clamp(v, 0.0, n - 1)); };
        for (std::size_t k = band(b.lo[1] * n - 0.001); k <= band(b.hi[1] * n + 0.001); ++k)
            out.bands[k].push_back(int(i));
    }
    return out;
}

namespace {

Vec<2> point_at(const Net2& net, double t) {
    std::array<Hom<2>, kMaxDegree + 1> b;
    std::ranges::copy(net, b.begin());
    for (std::size_t n = net.size(); n > 1; --n)
        for (std::size_t i = 0; i + 1 < n; ++i) b[i] = (1 - t) * b[i] + t * b[i + 1];
    return project(b[0]);
}

// Of a curve whose box q lies in: halved until q is beside the box of what is left.
bool is_left_of(const Vec<2>& q, const Net2& net) {
    Vec<2> low = project(net.front()), high = project(net.back());
    const bool rises = low[1] < high[1];
    double lo = 0, hi = 1;
    for (int step = 0; step < 60; ++step) {
        if (q[0] < std::min(low[0], high[0])) return true;
        if (q[0] > std::max(low[0], high[0])) return false;
        const double middle = (lo + hi) / 2;
        const Vec<2> at = point_at(net, middle);
        if ((at[1] > q[1]) == rises)
            hi = middle, high = at;
        else
            lo = middle, low = at;
    }
    return q[0] < low[0];
}

}  // namespace

bool is_inside(const TrimCurves& trim, const Vec<2>& q) {
    if (trim.curves.empty()) return true;
    const double n = double(trim.bands.size());
    bool inside = false;
    for (const int i : trim.bands[std::size_t(std::clamp(q[1] * n, 0.0, n - 1))]) {
        const MonotoneCurve& c = trim.curves[std::size_t(i)];
        if (q[1] < c.box.lo[1] || q[1] >= c.box.hi[1] || q[0] > c.box.hi[0]) continue;
        if (q[0] < c.box.lo[0] || is_left_of(q, c.net)) inside = !inside;
    }
    return inside;
}

}  // namespace freiform
