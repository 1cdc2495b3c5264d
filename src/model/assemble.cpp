#include <freiform/core/visit.hpp>
#include <freiform/model/assemble.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using SplineCurve = std::variant<Curve<Vec<3>>, Curve<Hom<3>>>;

// Do two curves have the same control points, and the same knots after scaling to [0, 1]?
template <class P>
bool is_same(const Curve<P>& a, const Curve<P>& b) {
    if (a.basis().degree() != b.basis().degree() || a.net() != b.net()) return false;
    const auto s = a.basis().knots(), t = b.basis().knots();
    const Interval on = a.basis().domain(), of = b.basis().domain();
    for (std::size_t i = 0; i < s.size(); ++i)  // the knots of one are scaled, which rounds
        if (std::abs((s[i] - on.lo) / on.length() - (t[i] - of.lo) / of.length()) > 1e-12) return false;
    return true;
}

template <class P>
Surface<P> opened(Surface<P> s) {
    for (int axis = 0; axis < 2; ++axis) {
        auto cut = restrict_to(s, axis, s.basis(axis).domain());
        if (cut) s = std::move(*cut);  // a whole domain is never refused
    }
    return s;
}

// The parts of a curve between its corners, the inner knots of multiplicity p and more: neighbours that are
// cut elsewhere still share what they have in common. Control points stay what they are to the bit.
template <class P>
std::vector<Curve<P>> between_corners(const Curve<P>& c) {
    const int p = c.basis().degree(), n = c.basis().size();
    const auto knots = c.basis().knots();
    const auto net = c.net().flat();
    std::vector<Curve<P>> parts;
    for (int first = 0; first < n - 1;) {
        // The next coefficient that the curve passes through: t_{i+1} = .. = t_{i+p} above it.
        int last = first + p;
        while (last < n - 1 && knots[std::size_t(last + 1)] != knots[std::size_t(last + p)]) ++last;
        last = std::min(last, n - 1);
        if (last == n - 1 && first == 0) return {c};
        std::vector<double> t(knots.begin() + first, knots.begin() + last + p + 2);
        t.front() = t[1], t.back() = t[t.size() - 2];
        auto basis = BSplineBasis::make(p, std::move(t));
        if (!basis) return {c};
        const int size = last - first + 1;
        parts.push_back(Curve<P>::trusted({std::move(*basis)},
                                          Net<1, P>({size}, {net.begin() + first, net.begin() + last + 1})));
        first = last;
    }
    return parts;
}

Line<2> straight(Interval on, const Vec<2>& from, const Vec<2>& to) {
    const Vec<2> direction = (1 / on.length()) * (to - from);
    return {from - on.lo * direction, direction};
}

}  // namespace

int ModelBuilder::vertex_at(const Vec<3>& p) {
    const auto [it, fresh] =
        vertices_.try_emplace({p[0] + 0.0, p[1] + 0.0, p[2] + 0.0}, int(model_.vertices.size()));
    if (fresh) model_.vertices.push_back({p, 0});
    return it->second;
}

// The coedge along a side of a surface; its edge is an old one if that is the same curve.
Coedge ModelBuilder::coedge_for(const SplineCurve& curve, const Vec<2>& from, const Vec<2>& to) {
    return visit_one(
        [&](const auto& c) -> Coedge {
            using C = std::remove_cvref_t<decltype(c)>;
            const auto net = c.net().flat();
            const int start = vertex_at(project(net.front())), end = vertex_at(project(net.back()));
            auto& known = edges_[std::minmax(start, end)];
            const bool degenerate = std::all_of(net.begin(), net.end(),
                                                [&](const auto& p) { return project(p) == project(net[0]); });
            if (!degenerate)
                for (int e : known) {
                    const Edge& old = model_.edges[std::size_t(e)];
                    const C* other = old.curve ? std::get_if<C>(&*old.curve) : nullptr;
                    if (other && is_same(*other, c)) return {e, false, straight(old.range, from, to)};
                    if (other && is_same(*other, reverse(c, 0)))
                        return {e, true, straight(old.range, to, from)};
                }
            Edge edge;
            edge.range = c.basis().domain();
            edge.start = start, edge.end = end, edge.degenerate = degenerate;
            if (!degenerate) edge.curve = c;
            known.push_back(int(model_.edges.size()));
            model_.edges.push_back(edge);
            return {known.back(), false, straight(edge.range, from, to)};
        },
        curve);
}

Result<int> ModelBuilder::add(SplineSurface surface, std::string name, std::optional<Colour> colour) {
    Face face;
    face.name = std::move(name), face.colour = colour;
    visit_one(
        [&](auto& s) {
            const bool closed[2] = {s.basis(0).is_closed(), s.basis(1).is_closed()};
            s = opened(std::move(s));
            const Interval u = s.basis(0).domain(), v = s.basis(1).domain();
            // Of a closed direction the two sides are one curve, whatever rounding says.
            const auto side = [&](int axis, int which) {
                return boundary(s, axis, closed[axis] ? 0 : which);
            };
            Loop loop;
            const auto add_side = [&](int axis, int which, Vec<2> from, Vec<2> to, bool backwards) {
                auto parts = between_corners(side(axis, which));
                const int along = 1 - axis;
                if (backwards) std::reverse(parts.begin(), parts.end());
                for (const auto& part : parts) {
                    Vec<2> a = from, b = to;
                    if (parts.size() > 1)
                        a[along] = part.basis().domain().lo, b[along] = part.basis().domain().hi;
                    Coedge c = coedge_for(part, a, b);
                    if (backwards) c.reversed = !c.reversed;
                    loop.coedges.push_back(std::move(c));
                }
            };
            add_side(1, 0, {{u.lo, v.lo}}, {{u.hi, v.lo}}, false);
            add_side(0, 1, {{u.hi, v.lo}}, {{u.hi, v.hi}}, false);
            add_side(1, 1, {{u.lo, v.hi}}, {{u.hi, v.hi}}, true);
            add_side(0, 0, {{u.lo, v.lo}}, {{u.lo, v.hi}}, true);
            face.loops.push_back(std::move(loop));
            face.surface = s;
        },
        surface);
    model_.faces.push_back(std::move(face));
    return int(model_.faces.size()) - 1;
}

// Half of a parallelogram, which unlike a patch with a side of length zero is an affine map: nothing about it
// needs refinement.
Result<int> ModelBuilder::add(const std::array<Vec<3>, 3>& corners, std::string name,
                              std::optional<Colour> colour) {
    const auto& [a, b, c] = corners;
    const auto linear = *BSplineBasis::bezier(1);
    auto surface = Surface<Vec<3>>::make({linear, linear}, Net<2, Vec<3>>({2, 2}, {a, c, b, b + (c - a)}));
    if (!surface) return std::unexpected(surface.error());
    Face face;
    face.name = std::move(name), face.colour = colour, face.surface = std::move(*surface);
    const Vec<2> at[3] = {{{0, 0}}, {{1, 0}}, {{0, 1}}};
    Loop loop;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        loop.coedges.push_back(coedge_for(
            Curve<Vec<3>>::trusted({linear}, Net<1, Vec<3>>({2}, {corners[i], corners[j]})), at[i], at[j]));
    }
    face.loops.push_back(std::move(loop));
    model_.faces.push_back(std::move(face));
    return int(model_.faces.size()) - 1;
}

Result<int> ModelBuilder::add_trimmed(SplineSurface surface,
                                      std::span<const std::vector<CurveGeometry<2>>> loops, std::string name,
                                      std::optional<Colour> colour) {
    Face face;
    face.name = std::move(name), face.colour = colour;
    visit_one([&](auto& s) { face.surface = opened(std::move(s)); }, surface);
    std::map<std::array<double, 2>, int> vertex_at;  // loops that touch in a vertex have it in common
    for (std::size_t l = 0; l < loops.size(); ++l) {
        if (loops[l].empty()) return refuse(RefusalKind::invalid, text("loops[", l, "]"), "has no curves");
        Loop loop;
        const int count = int(loops[l].size());
        std::vector<int> starts;
        for (int c = 0; c < count; ++c) {
            const CurveGeometry<2>& curve = loops[l][std::size_t(c)];
            const Interval on = domain(curve)[0];
            if (!std::isfinite(on.length()))
                return refuse(RefusalKind::invalid, text("loops[", l, "][", c, "]"), "has no ends");
            const Vec<2> uv = jet<0>(curve, on.lo).value();
            const auto [it, fresh] =
                vertex_at.try_emplace({uv[0] + 0.0, uv[1] + 0.0}, int(model_.vertices.size()));
            if (fresh) model_.vertices.push_back({jet<0>(face.surface, uv.c).value(), 0});
            starts.push_back(it->second);
        }
        for (int c = 0; c < count; ++c) {
            const CurveGeometry<2>& curve = loops[l][std::size_t(c)];
            Edge edge;
            edge.range = domain(curve)[0];
            edge.start = starts[std::size_t(c)], edge.end = starts[std::size_t((c + 1) % count)];
            model_.edges.push_back(edge);
            loop.coedges.push_back({int(model_.edges.size()) - 1, false, curve});
        }
        face.loops.push_back(std::move(loop));
    }
    model_.faces.push_back(std::move(face));
    return int(model_.faces.size()) - 1;
}

Result<Model> ModelBuilder::finish(std::string name) && {
    Shell shell;
    for (std::size_t f = 0; f < model_.faces.size(); ++f) shell.faces.push_back({int(f), false});
    model_.shells = {shell};
    model_.bodies = {{{0}, false, std::move(name), {}}};
    auto model = make_model(std::move(model_));
    if (!model) return model;
    const bool closed = summary(*model).open_edges == 0 && !model->faces.empty();
    model->shells[0].closed = model->bodies[0].solid = closed;
    return model;
}

}  // namespace freiform
