// Panels beside a curve: the curve of its derivatives, and its B-splines.
#include "io/drawing_detail.hpp"
#include "io/drawing_lift.hpp"

#include <algorithm>

namespace freiform::drawing {

namespace {

constexpr int kHodographSteps = 400;  // per piece of a rational curve
constexpr int kMostFunctions = 400, kMostNamedFunctions = 12;

Panel& panel(Sketch& s, std::string_view name) {
    const std::string full(name);
    for (Panel& p : s.more)
        if (p.name == full) return p;
    s.more.emplace_back();
    s.more.back().name = full;
    s.more.back().caption = plain_text(full);
    return s.more.back();
}

Vec<2> highest(const DrawnGroup& g) {
    Vec<2> top{{0, -1}};
    for (const DrawnPath& path : g.paths) {
        Vec<2> from = path.start;
        for (const DrawnSegment& s : path.segments) {
            for (int k = 0; k <= 32; ++k)
                if (const Vec<2> p = point_at(from, s, k / 32.0); p[1] > top[1]) top = p;
            from = end_of(s);
        }
    }
    return top;
}

}  // namespace

// c'(t) as a curve of its own, seen from the origin. The panel is that of all curves of the drawing.
template <class P>
void add_hodograph(Sketch& s, const Curve<P>& curve) {
    DrawnGroup g{s.name, "hodograph", s.colour, 2, {}, {}, {}}, control{s.name, "control", {}, 1, {}, {}, {}};
    control.colour = mixed(s.colour, kGrey, 0.65);
    if constexpr (!Space<P>::kRational) {
        if (curve.basis().degree() < 1) return;
        const Curve<P> d = derivative(curve, 0);
        Sketch scaled(s.plane, s.tolerance, s.size, s.options);
        scaled.add_paths(g, d);
        std::vector<Vec<2>> line;
        for (const P& c : d.net().flat()) line.push_back(s.plane(c));
        control.paths.push_back(line_through(line, d.basis().is_closed()));
        for (const Vec<2>& p : line) control.discs.push_back({p, 3, false});
    } else {
        const BezierPieces<1, P> pieces(curve);
        for (int i = 0; i < pieces.extent()[0]; ++i) {
            const auto piece = pieces.piece({i});
            g.paths.push_back(
                sampled_path([&](double u) { return s.plane(Vec<3>(piece.template jet<1>(u)(1))); },
                             pieces.box({i})[0], kHodographSteps));
        }
    }
    Panel& to = panel(s, "hodograph");
    to.axes = Axes::ticks;
    to.share = 0.7;
    DrawnGroup origin = dots("origin", kInk, std::array{Vec<2>{}}, 3);
    if (to.groups.empty()) to.groups.push_back(std::move(origin));
    to.groups.push_back(std::move(control));
    to.groups.push_back(std::move(g));
}

// The graphs of the B-splines over the parameter.
void add_basis(Sketch& s, const BSplineBasis& basis) {
    Panel& to = panel(s, "basis functions");
    to.axes = Axes::grid;
    to.equal = false;
    to.share = 0.8;
    to.x_name = formula("*u*");
    const int n = basis.size();
    if (n > kMostFunctions)
        return s.leave_out(text("it has ", n, " basis functions, a panel holds ", kMostFunctions));
    const Plane plane;
    const double width = basis.domain().length();
    for (int i = 0; i < n; ++i) {
        std::vector<Vec<1>> c(std::size_t(n), Vec<1>{});
        c[std::size_t(i)] = {{1}};
        auto b = Result<Curve<Vec<1>>>(Curve<Vec<1>>::trusted({basis}, Net<1, Vec<1>>({n}, std::move(c))));
        // Only where it is not zero.
        const Interval on{std::max(basis.knot(i), basis.domain().lo),
                          std::min(basis.knot(i + basis.degree() + 1), basis.domain().hi)};
        if (!basis.is_closed() && on.lo < on.hi) b = restrict_to(*b, 0, on);
        if (!b) continue;
        const auto f = lifted(*b);
        if (!f) continue;
        // A graph is as long as the domain is; heights are at most 1 and shown as large.
        auto paths = paths_of(*f, plane, 1e-4 * std::min(1.0, width), s.rest());
        if (!paths) continue;
        DrawnGroup g{s.name, "basis", kPalette[std::size_t(i) % kPalette.size()], 1.8, {}, {}, {}};
        for (DrawnPath& path : *paths) s.take(g, std::move(path));
        if (s.options.names != PointNames::none && n <= kMostNamedFunctions) {
            const Vec<2> top = highest(g);
            to.notes.push_back(
                {top, formula(text("*B*_{", i, "}")), mixed(g.colour, kInk, 0.35), 14, {{0, 1}}});
        }
        to.groups.push_back(std::move(g));
    }
    DrawnGroup knots{s.name, "knots", kInk, 1.3, {}, {}, {}};
    for (const double u : basis.breaks()) {
        const int m = basis.multiplicity(u);
        for (int k = 0; k < m; ++k) knots.discs.push_back({{{u, -0.05 - 0.035 * k}}, 3, false});
    }
    to.groups.push_back(std::move(knots));
}

template void add_hodograph(Sketch&, const Curve<Vec<3>>&);
template void add_hodograph(Sketch&, const Curve<Hom<3>>&);

}  // namespace freiform::drawing
