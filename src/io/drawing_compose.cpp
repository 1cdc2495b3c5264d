// Shapes of every kind as lines: a surface is its iso-curves, a volume its edges, a trimmed surface its
// loops, a model its edges and the surfaces that have none.
#include "io/drawing_detail.hpp"
#include "io/drawing_lift.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>

#include <algorithm>

namespace freiform::drawing {

namespace {

constexpr int kFewestIsolines = 5, kMostIsolines = 25;  // in each direction
constexpr double kWhiten = 0.45;

class Composer {
public:
    explicit Composer(Sketch& sketch) : s_(sketch) {}

    template <class S>
    void add_shape(const S& s) {
        if constexpr (TensorPatch<S>) {
            auto in_space = lifted(s);
            if (!in_space) return s_.leave_out(in_space.error().message);
            if constexpr (S::kParams == 1)
                add_curve(s_, *in_space, s.basis());
            else
                add_patch(*in_space);
        } else if constexpr (TriangularPatch<S>) {
            add_triangle(s);
        } else if constexpr (std::same_as<S, TrimmedSurface>) {
            add_trimmed(s);
        } else {
            add_model(s);
        }
    }

private:
    Colour net_colour() const { return mixed(s_.colour, {1, 1, 1, 1}, kWhiten); }

    template <std::size_t N, class P>
    void add_control(const Patch<N, P>& patch) {
        DrawnGroup& g = s_.group("control", net_colour(), 1);
        const auto net = patch.net().view();
        for (std::size_t axis = 0; axis < N; ++axis)
            each_fibre(int(axis), net.extent, [&](const Index<N>& at) {
                const auto fibre = net.fibre(int(axis), at);
                std::vector<Vec<2>> line;
                for (int i = 0; i < fibre.size; ++i) line.push_back(s_.plane(project(fibre[i])));
                s_.take(g, line_through(line, patch.basis(int(axis)).is_closed()));
            });
        add_points(s_, g, patch.net().flat());
    }

    // The parameters of iso-curves: the breaks, thinned out or filled up.
    static std::vector<double> levels(const BSplineBasis& basis) {
        const std::vector<double> breaks = basis.breaks();
        const std::size_t spans = breaks.size() - 1;
        std::vector<double> out;
        if (spans > kMostIsolines) {
            for (std::size_t i = 0; i <= kMostIsolines; ++i) out.push_back(breaks[i * spans / kMostIsolines]);
        } else {
            const std::size_t parts = (kFewestIsolines + spans - 1) / spans;
            for (std::size_t i = 0; i < spans; ++i)
                for (std::size_t k = 0; k < parts; ++k)
                    out.push_back(breaks[i] + (breaks[i + 1] - breaks[i]) * double(k) / double(parts));
            out.push_back(breaks.back());
        }
        if (basis.is_closed()) out.pop_back();
        return out;
    }

    template <class P>
    void add_patch(const Surface<P>& s) {
        DrawnGroup inner{s_.name, "isolines", mixed(s_.colour, {1, 1, 1, 1}, 0.3), 0.9, {}, {}, {}};
        DrawnGroup outer{s_.name, "edges", s_.colour, 1.8, {}, {}, {}};
        for (int axis = 0; axis < 2; ++axis)
            for (const double at : levels(s.basis(axis))) {
                const Interval on = s.basis(axis).domain();
                const bool end = !s.basis(axis).is_closed() && (at == on.lo || at == on.hi);
                s_.add_paths(end ? outer : inner, iso(s, axis, at));
            }
        s_.groups.push_back(std::move(inner));
        s_.groups.push_back(std::move(outer));
        if (s_.options.control) add_control(s);
    }

    // The twelve edges of a volume.
    template <class P>
    void add_patch(const Volume<P>& v) {
        DrawnGroup g{s_.name, "edges", s_.colour, 1.5, {}, {}, {}};
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side)
                for (int other = 0; other < 2; ++other) {
                    const auto face = boundary(v, axis, side);
                    // Axis 0 of the face with axis 0, 1, 2 left out: every edge is met once.
                    s_.add_paths(g, boundary(face, axis == 1 ? 1 : 0, other));
                }
        s_.groups.push_back(std::move(g));
        if (s_.options.control) add_control(v);
    }

    template <class P>
    void add_triangle(const Triangle<P>& t) {
        if constexpr (Space<P>::kDim == 1 || Space<P>::kDim == 4) {
            s_.leave_out(text("its points have ", Space<P>::kDim, " coordinates, a drawing needs 2 or 3"));
        } else {
            const int n = t.degree();
            const auto basis = BSplineBasis::bezier(n);
            if (!basis) return s_.leave_out(basis.error().message);
            DrawnGroup g{s_.name, "edges", s_.colour, 1.8, {}, {}, {}};
            for (int edge = 0; edge < 3; ++edge) {
                std::vector<InSpace<P>> c;
                for (int i = 0; i <= n; ++i)
                    c.push_back(in_space(edge == 0   ? t.coefficient(n - i, i)
                                         : edge == 1 ? t.coefficient(0, n - i)
                                                     : t.coefficient(i, 0)));
                s_.add_paths(g,
                             Curve<InSpace<P>>::trusted({*basis}, Net<1, InSpace<P>>({n + 1}, std::move(c))));
            }
            s_.groups.push_back(std::move(g));
            if (s_.options.control) add_triangle_net(t);
        }
    }

    template <class P>
    void add_triangle_net(const Triangle<P>& t) {
        DrawnGroup& g = s_.group("control", net_colour(), 1);
        std::vector<InSpace<P>> c;
        for (const P& p : t.coefficients()) c.push_back(in_space(p));
        const auto at = [&](int j, int k) { return s_.plane(project(in_space(t.coefficient(j, k)))); };
        for (int row = 1; row <= t.degree(); ++row)  // rows j + k; the small triangles that point away
            for (int k = 0; k < row; ++k) {
                const int j = row - 1 - k;
                s_.take(g, line_through(std::array{at(j, k), at(j + 1, k), at(j, k + 1)}, true));
            }
        add_points(s_, g, std::span<const InSpace<P>>(c));
    }

    void add_trimmed(const TrimmedSurface& s) {
        if (s.loops.empty()) return visit_one([&](const auto& patch) { add_shape(patch); }, s.surface);
        const SurfaceGeometry surface =
            visit_one([](const auto& patch) { return SurfaceGeometry(patch); }, s.surface);
        DrawnGroup g{s_.name, "edges", s_.colour, 1.8, {}, {}, {}};
        for (const auto& loop : s.loops)
            for (const CurveGeometry<2>& c : loop)
                s_.keep(g, path_of(c, domain(c)[0], surface, s_.plane, s_.tolerance, s_.rest()),
                        "a curve of a loop");
        s_.groups.push_back(std::move(g));
    }

    void add_model(const Model& model) {
        std::vector<std::pair<const Face*, const Coedge*>> first(model.edges.size());
        for (const Face& face : model.faces)
            for (const Loop& loop : face.loops)
                for (const Coedge& c : loop.coedges)
                    if (auto& f = first[std::size_t(c.edge)]; !f.first) f = {&face, &c};
        DrawnGroup g{s_.name, "edges", s_.colour, 1.4, {}, {}, {}};
        for (std::size_t i = 0; i < model.edges.size(); ++i) {
            const Edge& e = model.edges[i];
            if (e.degenerate || (!e.curve && !first[i].first)) continue;
            s_.keep(g,
                    e.curve ? path_of(*e.curve, e.range, s_.plane, s_.tolerance, s_.rest())
                            : path_of(first[i].second->curve, e.range, first[i].first->surface, s_.plane,
                                      s_.tolerance, s_.rest()),
                    text("edge ", i));
        }
        for (const Face& face : model.faces)
            if (face.loops.empty())
                visit_one(
                    [&](const auto& s) {
                        if constexpr (requires { s.net(); }) add_patch(s);
                    },
                    face.surface);
        s_.groups.push_back(std::move(g));
    }

    Sketch& s_;
};

// Before what is seen of the object, so that it lies over it.
void add_behind(Sketch& s) {
    Behind& b = s.behind;
    if (!b.paths.empty() && s.options.hidden == HiddenLines::dashed) {
        DrawnGroup& g = s.group("hidden", mixed(s.colour, {1, 1, 1, 1}, 0.45), 1);
        g.paths = std::move(b.paths);
        g.dashes = {4, 3};
    }
    if (b.net.empty() && b.points.empty()) return;
    DrawnGroup& g = s.group("control-behind", mixed(s.colour, {1, 1, 1, 1}, 0.75), 0.8);
    g.paths = std::move(b.net);
    g.discs = std::move(b.points);
}

}  // namespace

void add_object(Sketch& sketch, const Document& document, std::size_t index) {
    sketch.label = object_label(document, index);
    const std::string& name = document.objects[index].name;
    sketch.name = name.empty() ? sketch.label : name;
    sketch.colour = sketch.colour_of(index);
    sketch.behind = {};
    visit_one([&](const auto& s) { Composer(sketch).add_shape(s); }, document.objects[index].shape);
    add_behind(sketch);
}

}  // namespace freiform::drawing
