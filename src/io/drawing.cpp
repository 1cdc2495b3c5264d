// Method: everything becomes paths in the plane of the view, flattened within a tolerance t in that plane;
// then the box of the paths is fitted into the picture with s pixels per unit. The error is s t pixels, so
// that s <= kDrawingTolerance / t is all that has to hold. A first, coarse round finds points of the curves,
// hence a size from below, hence a bound of s, from which t follows for the second round.
#include "io/drawing_detail.hpp"
#include "io/drawing_lift.hpp"

#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace drawing {
namespace {

// A box of points of the curves: inside the true box.
Box<2> inner_box(const std::vector<DrawnGroup>& groups) {
    Box<2> box;
    for (const DrawnGroup& g : groups)
        for (const DrawnPath& path : g.paths) {
            Vec<2> from = path.start;
            box.add(from);
            for (const DrawnSegment& s : path.segments) {
                for (const double t : {0.25, 0.5, 0.75, 1.0}) box.add(point_at(from, s, t));
                from = end_of(s);
            }
        }
    return box;
}

struct Extent {
    Box<3> hull;  // of all coefficients
    bool all_plane = true;
};

void extend(Extent& extent, const Shape& shape) {
    const auto add = [&](const auto& coefficients) {
        for (const auto& c : coefficients) extent.hull.add(project(in_space(c)));
    };
    const auto visit = [&](const auto& s) {
        using S = std::remove_cvref_t<decltype(s)>;
        if constexpr (TensorPatch<S>) {
            if constexpr (Space<typename S::Coefficients>::kDim < 4)
                if (const auto in = lifted(s)) add(in->net().flat());
            if (Space<typename S::Coefficients>::kDim == 3 ||
                (S::kParams == 2 && Space<typename S::Coefficients>::kDim == 1))
                extent.all_plane = false;
        } else if constexpr (TriangularPatch<S>) {
            if constexpr (Space<typename S::Coefficients>::kDim < 4) add(s.coefficients());
            if (Space<typename S::Coefficients>::kDim == 3) extent.all_plane = false;
        } else {
            extent.all_plane = false;
            if constexpr (std::same_as<S, Model>)
                extent.hull.add(summary(s).box);
            else
                visit_one([&](const auto& patch) { add(patch.net().flat()); }, s.surface);
        }
    };
    visit_one(visit, shape);
}

// `hides`: surfaces hide what is behind them; `corners`: gets a box of points of them in the first round.
Result<Sketch> compose(const Document& document, std::span<const std::size_t> objects, const Plane& plane,
                       double tolerance, double size, const DrawingOptions& options, bool hides,
                       Box<2>& corners) {
    Sketch sketch(plane, tolerance, size, options);
    std::vector<std::size_t> faced;
    for (const std::size_t i : objects)
        if (hides && has_faces(document.objects[i].shape)) faced.push_back(i);
    if (!faced.empty() && size > 0) add_faces(sketch, document, faced);
    if (!faced.empty() && size == 0) corners = box_of_faces(sketch, document, faced);
    if (sketch.failure) return std::unexpected(*sketch.failure);
    for (const std::size_t i : objects) {
        if (std::ranges::find(faced, i) != faced.end()) continue;
        add_object(sketch, document, i);
        if (sketch.failure) return std::unexpected(*sketch.failure);
        if (sketch.used >= kMostSegments)
            return refuse(RefusalKind::limit, sketch.label,
                          text("the drawing needs more than ", kMostSegments, " segments"));
    }
    if (options.joints && size > 0) join_curves(sketch);
    return sketch;
}

Result<void> check(const DrawingOptions& o) {
    if (o.width < 16 || o.height < 16 || o.width > 16384 || o.height > 16384)
        return refuse(RefusalKind::invalid, "size",
                      text(o.width, " x ", o.height, " pixels; expected 16 to 16384 each"));
    if (!(o.margin >= 0 && o.margin <= 0.4))
        return refuse(RefusalKind::invalid, "margin", text("is ", o.margin, "; expected 0 to 0.4"));
    const auto finite = [](const std::optional<double>& u, const char* name) -> Result<void> {
        if (u && !std::isfinite(*u)) return refuse(RefusalKind::nonfinite, name, "is not a finite number");
        return {};
    };
    if (o.isolines && (*o.isolines < 0 || *o.isolines > 1000))
        return refuse(RefusalKind::invalid, "isolines", text(*o.isolines, "; expected 0 to 1000"));
    if (auto ok = finite(o.construction, "construction"); !ok) return ok;
    if (auto ok = finite(o.tangent, "tangent"); !ok) return ok;
    if (auto ok = finite(o.osculating, "osculating"); !ok) return ok;
    if (o.view && !(std::isfinite(o.view->azimuth) && std::isfinite(o.view->elevation)))
        return refuse(RefusalKind::nonfinite, "view", "is not finite");
    return {};
}

// Only what the size of the drawing can be told from.
DrawingOptions bare(const DrawingOptions& options) {
    DrawingOptions o;
    o.width = options.width, o.height = options.height, o.view = options.view, o.margin = options.margin;
    return o;
}

}  // namespace
}  // namespace drawing

Result<std::vector<Panel>> panels_of(const Document& document, std::span<const std::size_t> objects,
                                     const DrawingOptions& options, std::vector<Refusal>& left_out) {
    using namespace drawing;
    if (auto ok = check(options); !ok) return std::unexpected(ok.error());
    std::vector<std::size_t> all(objects.begin(), objects.end());
    if (objects.empty())
        for (std::size_t i = 0; i < document.objects.size(); ++i) all.push_back(i);
    Extent extent;
    for (const std::size_t i : all) {
        if (i >= document.objects.size())
            return refuse(RefusalKind::invalid, "objects",
                          text("there is no object ", i, " among ", document.objects.size()));
        extend(extent, document.objects[i].shape);
    }
    const Plane plane = plane_of(options.view, extent.all_plane, extent.hull.scale());
    const Vec<3> lo = plane.scaled(extent.hull.lo), hi = plane.scaled(extent.hull.hi);
    const double hull = extent.hull.is_empty() ? 0 : norm(hi - lo);

    const double coarse = hull > 0 ? hull / 1000 : 1;
    const DrawingOptions only_curves = bare(options);
    const bool hides = options.hidden != HiddenLines::shown && (!extent.all_plane || options.view);
    Box<2> corners;
    const auto first = compose(document, all, plane, coarse, 0, only_curves, hides, corners);
    if (!first) return std::unexpected(first.error());
    Box<2> inner = inner_box(first->groups);
    inner.add(corners);
    const double size = inner.is_empty() ? 0 : max_abs(inner.hi - inner.lo);
    // s <= side of the picture / size, whatever else is drawn.
    const double fine =
        size > 0 ? 0.999 * kDrawingTolerance * size / std::max(options.width, options.height) : coarse / 1e4;
    auto composed = compose(document, all, plane, fine, size, options, hides, corners);
    if (!composed) return std::unexpected(composed.error());
    const bool drawn = std::ranges::any_of(
        composed->groups, [](const DrawnGroup& g) { return !g.paths.empty() || !g.discs.empty(); });
    if (!drawn)
        return refuse(
            RefusalKind::no_answer, composed->left_out.empty() ? "objects" : composed->left_out[0].where,
            composed->left_out.empty() ? "there is nothing to draw"
                                       : text("nothing can be drawn: ", composed->left_out[0].message));
    if ((options.construction || options.tangent || options.osculating) && !composed->answered)
        return refuse(RefusalKind::no_answer, "objects",
                      options.construction ? "there is no curve to show the construction of"
                                           : "there is no curve with a tangent to show");
    left_out.insert(left_out.end(), composed->left_out.begin(), composed->left_out.end());
    std::vector<Panel> panels(1);
    Panel& main = panels[0];
    main.groups = std::move(composed->groups);
    main.notes = std::move(composed->notes);
    main.axes = options.axes;
    main.largest = kDrawingTolerance / fine;
    main.exponent = plane.exponent;
    // What is within the tolerance of the polylines may be drawn too.
    main.window = box_of(main.groups, fine);
    for (Panel& p : composed->more) panels.push_back(std::move(p));
    return panels;
}

Result<Drawing> draw(const Document& document, std::span<const std::size_t> objects,
                     const DrawingOptions& options) {
    std::vector<Refusal> left_out;
    auto panels = panels_of(document, objects, options, left_out);
    if (!panels) return std::unexpected(panels.error());
    Figure figure;
    figure.width = options.width, figure.height = options.height, figure.margin = options.margin;
    figure.title = plain_text(options.title);
    figure.legend = options.legend;
    figure.panels = std::move(*panels);
    if (figure.panels.size() > 1 && options.height > options.width) figure.columns = 1;
    Drawing d = arrange(figure);
    d.left_out = std::move(left_out);
    return d;
}

}  // namespace freiform
