// Method: everything becomes paths in the plane of the view, flattened within a tolerance t in that plane;
// then the box of the paths is fitted into the picture with s pixels per unit. The error is s t pixels, so
// that s <= kDrawingTolerance / t is all that has to hold. A first, coarse round finds points of the curves,
// hence a size from below, hence a bound of s, from which t follows for the second round.
#include "io/drawing_detail.hpp"
#include "io/drawing_lift.hpp"

#include <freiform/io/bpt.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace drawing {
namespace {

constexpr int kFewestIsolines = 5, kMostIsolines = 25;  // in each direction
constexpr int kNeedles = 200, kFewestNeedles = 8;       // of a comb: per curve, per Bezier piece
constexpr double kCombSize = 0.3;                       // longest needle, of the size of its curve
constexpr double kStraight = 1e-7;                      // curvature times size below which a line is straight
constexpr double kPointRadius = 3.5;

Colour colour_of(std::size_t object) {  // dark enough on white, told apart also by the colour-blind
    constexpr std::array<std::array<double, 3>, 7> kColours{{{0.00, 0.33, 0.62},
                                                             {0.80, 0.30, 0.00},
                                                             {0.00, 0.50, 0.36},
                                                             {0.66, 0.27, 0.52},
                                                             {0.18, 0.55, 0.80},
                                                             {0.72, 0.50, 0.00},
                                                             {0.25, 0.25, 0.28}}};
    const auto& c = kColours[object % kColours.size()];
    return {c[0], c[1], c[2], 1};
}

Colour mixed(const Colour& a, const Colour& b, double t) {
    return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b), 1};
}

DrawnPath polyline(std::span<const Vec<2>> points) {
    DrawnPath path{points[0], {}, false};
    for (const Vec<2>& p : points.subspan(1)) path.segments.push_back({1, {p}});
    return path;
}

class Composer {
public:
    Composer(const Plane& plane, double tolerance, double size, const DrawingOptions& options)
        : plane_(plane), tolerance_(tolerance), size_(size), options_(options) {}

    // Refuses what no drawing should be made of; what only this object lacks goes to left_out.
    Result<void> add(const Document& document, std::size_t index) {
        label_ = object_label(document, index);
        const std::string& name = document.objects[index].name;
        name_ = name.empty() ? label_ : name;
        colour_ = colour_of(index);
        std::visit([&](const auto& s) { add_shape(s); }, document.objects[index].shape);
        if (failure_) return std::unexpected(*failure_);
        if (used_ >= kMostSegments)
            return refuse(RefusalKind::limit, label_,
                          text("the drawing needs more than ", kMostSegments, " segments"));
        return {};
    }
    std::vector<DrawnGroup> groups;
    std::vector<Refusal> left_out;
    bool constructed = false;

private:
    template <class S>
    void add_shape(const S& s) {
        if constexpr (TensorPatch<S>) {
            auto in_space = lifted(s);
            if (!in_space) return leave_out(in_space.error().message);
            if constexpr (S::kParams == 1)
                add_curve(*in_space, s);
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

    void leave_out(std::string why) {
        left_out.push_back({RefusalKind::unsupported, label_, std::move(why)});
    }

    DrawnGroup& group(std::string role, const Colour& colour, double width) {
        groups.push_back({name_, std::move(role), colour, width, {}, {}});
        return groups.back();
    }

    void take(DrawnGroup& to, DrawnPath path) {
        used_ += path.segments.size();
        to.paths.push_back(std::move(path));
    }

    template <class P>
    void add_paths(DrawnGroup& to, const Curve<P>& curve) {
        auto paths = paths_of(curve, plane_, tolerance_, kMostSegments - std::min(used_, kMostSegments));
        if (!paths) return leave_out("a curve of it cannot be followed in double precision");
        for (DrawnPath& path : *paths) take(to, std::move(path));
    }

    template <class P, class Q>
    void add_curve(const Curve<P>& curve, const Curve<Q>& original) {
        if (options_.comb && size_ > 0) add_comb(curve);
        if (options_.control) add_control(curve);
        DrawnGroup drawn{name_, "curve", colour_, 2.2, {}, {}};
        add_paths(drawn, curve);
        groups.push_back(std::move(drawn));
        if (options_.knots) add_knots(curve, original.basis());
        if (options_.construction) add_construction(curve, *options_.construction);
    }

    template <std::size_t N, class P>
    void add_control(const Patch<N, P>& patch) {
        DrawnGroup& g = group("control", mixed(colour_, {1, 1, 1, 1}, 0.45), 1);
        const auto net = patch.net().view();
        for (std::size_t axis = 0; axis < N; ++axis)
            each_fibre(int(axis), net.extent, [&](const Index<N>& at) {
                const auto fibre = net.fibre(int(axis), at);
                std::vector<Vec<2>> line;
                for (int i = 0; i < fibre.size; ++i) line.push_back(plane_(project(fibre[i])));
                DrawnPath path = polyline(line);
                path.closed = patch.basis(int(axis)).is_closed();
                take(g, std::move(path));
            });
        add_points(g, patch.net().flat());
    }

    template <class P>
    void add_points(DrawnGroup& g, std::span<const P> coefficients) {
        double mean = 0;
        for (const P& c : coefficients) mean += Space<P>::weight(c) / double(coefficients.size());
        for (const P& c : coefficients)
            g.discs.push_back(
                {plane_(project(c)),
                 std::clamp(kPointRadius * std::sqrt(Space<P>::weight(c) / mean), 1.5, 3 * kPointRadius),
                 false});
    }

    template <class P>
    void add_knots(const Curve<P>& curve, const BSplineBasis& basis) {
        DrawnGroup& g = group("knots", mixed(colour_, {0, 0, 0, 1}, 0.3), 1.5);
        for (const double u : basis.breaks())
            g.discs.push_back({plane_(curve(u)), 2 + 1.2 * basis.multiplicity(u), true});
    }

    // Curvature vector k = (C'' - (C''.T) T) / |C'|^2; the needle is -k times a length chosen per curve.
    template <class P>
    void add_comb(const Curve<P>& curve) {
        const BezierPieces<1, P> pieces(curve);
        if (pieces.degree(0) < 2) return;
        const int n = std::max(kFewestNeedles, kNeedles / pieces.extent()[0]);
        struct Needle {
            int piece;
            Vec<3> foot, k;
        };
        std::vector<Needle> needles;
        double longest = 0;
        Box<3> feet;
        for (int i = 0; i < pieces.extent()[0]; ++i) {
            const auto piece = pieces.piece({i});
            const Interval on = pieces.box({i})[0];
            for (int j = 0; j <= n; ++j) {
                const auto jet = piece.template jet<2>(on.lo + on.length() * j / n);
                const Vec<3> d = plane_.scaled(jet(1)), a = plane_.scaled(jet(2));
                const double speed = norm(d);
                if (!(speed * on.length() > kStraight * size_)) continue;  // no tangent, no curvature
                const Vec<3> t = (1 / speed) * d, k = (1 / speed / speed) * (a - dot(a, t) * t);
                if (!is_finite(k)) continue;
                longest = std::max(longest, norm(k));
                needles.push_back({i, plane_.scaled(jet.value()), k});
                feet.add(needles.back().foot);
            }
        }
        if (needles.empty()) return;
        const double size = max_abs(feet.hi - feet.lo);
        if (longest * size > kStraight) draw_comb(needles, kCombSize * size / longest);
    }

    template <class Needles>
    void draw_comb(const Needles& needles, double scale) {
        const auto flat = [&](const Vec<3>& p) { return Vec<2>{{dot(plane_.right, p), dot(plane_.up, p)}}; };
        DrawnGroup& g = group("comb", mixed(colour_, {0.75, 0.75, 0.75, 1}, 0.65), 0.8);
        for (std::size_t i = 0; i < needles.size(); ++i) {
            const Vec<2> tip = flat(needles[i].foot - scale * needles[i].k);
            take(g, {flat(needles[i].foot), {{1, {tip}}}, false});
        }
        std::vector<Vec<2>> envelope;  // of one piece: the curvature may jump between two
        for (std::size_t i = 0; i < needles.size(); ++i) {
            envelope.push_back(flat(needles[i].foot - scale * needles[i].k));
            if (i + 1 < needles.size() && needles[i + 1].piece == needles[i].piece) continue;
            take(g, polyline(envelope));
            envelope.clear();
        }
    }

    // Level r of the scheme of de Boor: the control points that inserting u the r-th time adds; with one
    // Bezier piece that is de Casteljau.
    template <class P>
    void add_construction(const Curve<P>& curve, double u) {
        const BSplineBasis& basis = curve.basis();
        const Interval on = basis.domain();
        if (!basis.is_closed() && !on.contains(u)) {
            failure_ = Refusal{RefusalKind::out_of_domain, label_,
                               text("the construction is asked for at ", u, ", outside the domain [", on.lo,
                                    ", ", on.hi, "]")};
            return;
        }
        constructed = true;
        u = basis.wrap(u);
        const int p = basis.degree(), span = basis.span(u);
        std::vector<P> d;
        for (int i = span - p; i <= span; ++i) d.push_back(curve.net().flat()[std::size_t(i % basis.size())]);
        for (int r = 1; r <= p; ++r) {
            for (int i = 0; i <= p - r; ++i) {
                const double lo = basis.knot(span - p + r + i), hi = basis.knot(span + 1 + i);
                const double t = (u - lo) / (hi - lo);
                d[std::size_t(i)] = (1 - t) * d[std::size_t(i)] + t * d[std::size_t(i) + 1];
            }
            d.pop_back();
            draw_level(d, double(r) / p);
        }
        DrawnGroup& g = group("point", {0.1, 0.1, 0.1, 1}, 1);
        g.discs.push_back({plane_(project(d[0])), 5, false});
    }

    template <class P>
    void draw_level(const std::vector<P>& d, double part) {
        DrawnGroup& g = group("construction", mixed({0.93, 0.65, 0.10, 1}, {0.72, 0.05, 0.10, 1}, part), 1.2);
        std::vector<Vec<2>> line;
        for (const P& c : d) line.push_back(plane_(project(c)));
        if (line.size() > 1) take(g, polyline(line));
        for (const Vec<2>& p : line) g.discs.push_back({p, 3, false});
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
        DrawnGroup inner{name_, "isolines", mixed(colour_, {1, 1, 1, 1}, 0.3), 0.9, {}, {}};
        DrawnGroup outer{name_, "edges", colour_, 1.8, {}, {}};
        for (int axis = 0; axis < 2; ++axis)
            for (const double at : levels(s.basis(axis))) {
                const Interval on = s.basis(axis).domain();
                const bool end = !s.basis(axis).is_closed() && (at == on.lo || at == on.hi);
                add_paths(end ? outer : inner, iso(s, axis, at));
            }
        groups.push_back(std::move(inner));
        groups.push_back(std::move(outer));
        if (options_.control) add_control(s);
    }

    // The twelve edges of a volume.
    template <class P>
    void add_patch(const Volume<P>& v) {
        DrawnGroup g{name_, "edges", colour_, 1.5, {}, {}};
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side)
                for (int other = 0; other < 2; ++other) {
                    const auto face = boundary(v, axis, side);
                    // Axis 0 of the face with axis 0, 1, 2 left out: every edge is met once.
                    add_paths(g, boundary(face, axis == 1 ? 1 : 0, other));
                }
        groups.push_back(std::move(g));
        if (options_.control) add_control(v);
    }

    template <class P>
    void add_triangle(const Triangle<P>& t) {
        if constexpr (Space<P>::kDim == 1 || Space<P>::kDim == 4) {
            leave_out(text("its points have ", Space<P>::kDim, " coordinates, a drawing needs 2 or 3"));
        } else {
            const int n = t.degree();
            const auto basis = BSplineBasis::bezier(n);
            if (!basis) return leave_out(basis.error().message);
            DrawnGroup g{name_, "edges", colour_, 1.8, {}, {}};
            for (int edge = 0; edge < 3; ++edge) {
                std::vector<InSpace<P>> c;
                for (int i = 0; i <= n; ++i)
                    c.push_back(in_space(edge == 0   ? t.coefficient(n - i, i)
                                         : edge == 1 ? t.coefficient(0, n - i)
                                                     : t.coefficient(i, 0)));
                add_paths(g, Curve<InSpace<P>>::trusted({*basis}, Net<1, InSpace<P>>({n + 1}, std::move(c))));
            }
            groups.push_back(std::move(g));
            if (options_.control) add_triangle_net(t);
        }
    }

    template <class P>
    void add_triangle_net(const Triangle<P>& t) {
        DrawnGroup& g = group("control", mixed(colour_, {1, 1, 1, 1}, 0.45), 1);
        std::vector<InSpace<P>> c;
        for (const P& p : t.coefficients()) c.push_back(in_space(p));
        const auto at = [&](int j, int k) { return plane_(project(in_space(t.coefficient(j, k)))); };
        for (int row = 1; row <= t.degree(); ++row)  // rows j + k; the small triangles that point away
            for (int k = 0; k < row; ++k) {
                const int j = row - 1 - k;
                const std::array<Vec<2>, 3> corners{at(j, k), at(j + 1, k), at(j, k + 1)};
                DrawnPath path = polyline(corners);
                path.closed = true;
                take(g, std::move(path));
            }
        add_points(g, std::span<const InSpace<P>>(c));
    }

    void add_trimmed(const TrimmedSurface& s) {
        if (s.loops.empty()) return std::visit([&](const auto& patch) { add_shape(patch); }, s.surface);
        const SurfaceGeometry surface =
            std::visit([](const auto& patch) { return SurfaceGeometry(patch); }, s.surface);
        DrawnGroup g{name_, "edges", colour_, 1.8, {}, {}};
        for (const auto& loop : s.loops)
            for (const CurveGeometry<2>& c : loop)
                keep(g, path_of(c, domain(c)[0], surface, plane_, tolerance_, rest()), "a curve of a loop");
        groups.push_back(std::move(g));
    }

    void add_model(const Model& model) {
        std::vector<std::pair<const Face*, const Coedge*>> first(model.edges.size());
        for (const Face& face : model.faces)
            for (const Loop& loop : face.loops)
                for (const Coedge& c : loop.coedges)
                    if (auto& f = first[std::size_t(c.edge)]; !f.first) f = {&face, &c};
        DrawnGroup g{name_, "edges", colour_, 1.4, {}, {}};
        for (std::size_t i = 0; i < model.edges.size(); ++i) {
            const Edge& e = model.edges[i];
            if (e.degenerate || (!e.curve && !first[i].first)) continue;
            keep(g,
                 e.curve ? path_of(*e.curve, e.range, plane_, tolerance_, rest())
                         : path_of(first[i].second->curve, e.range, first[i].first->surface, plane_,
                                   tolerance_, rest()),
                 text("edge ", i));
        }
        for (const Face& face : model.faces)
            if (face.loops.empty())
                std::visit(
                    [&](const auto& s) {
                        if constexpr (requires { s.net(); }) add_patch(s);
                    },
                    face.surface);
        groups.push_back(std::move(g));
    }

    std::size_t rest() const { return kMostSegments - std::min(used_, kMostSegments); }
    void keep(DrawnGroup& to, std::optional<DrawnPath> path, std::string_view what) {
        if (!path) return leave_out(text(what, " cannot be followed in double precision"));
        take(to, std::move(*path));
    }

    const Plane plane_;
    const double tolerance_, size_;
    const DrawingOptions& options_;
    std::string label_, name_;
    Colour colour_;
    std::optional<Refusal> failure_;
    std::size_t used_ = 0;
};

// The Bezier curve from `from` on, at t.
Vec<2> point_at(const Vec<2>& from, const DrawnSegment& s, double t) {
    std::array<Vec<2>, 4> b{from};
    for (int i = 0; i < s.degree; ++i) b[std::size_t(i) + 1] = s.points[std::size_t(i)];
    for (int r = s.degree; r > 0; --r)
        for (std::size_t i = 0; i < std::size_t(r); ++i) b[i] = (1 - t) * b[i] + t * b[i + 1];
    return b[0];
}

// A box of points of the curves: inside the true box.
Box<2> inner_box(const std::vector<DrawnGroup>& groups) {
    Box<2> box;
    for (const DrawnGroup& g : groups)
        for (const DrawnPath& path : g.paths) {
            Vec<2> from = path.start;
            box.add(from);
            for (const DrawnSegment& s : path.segments) {
                for (const double t : {0.25, 0.5, 0.75, 1.0}) box.add(point_at(from, s, t));
                from = s.points[std::size_t(s.degree - 1)];
            }
        }
    return box;
}

// A box that contains the paths and the centres of the discs. A curve leaves the box of its points at k / 16
// by at most max |second difference of the coefficients| degree (degree - 1) / (8 16^2).
Box<2> outer_box(const std::vector<DrawnGroup>& groups, double tolerance) {
    constexpr int kParts = 16;
    Box<2> box;
    const auto add = [&](const Vec<2>& p, double by) {
        box.add(p - Vec<2>{{by, by}});
        box.add(p + Vec<2>{{by, by}});
    };
    for (const DrawnGroup& g : groups) {
        for (const DrawnPath& path : g.paths) {
            Vec<2> from = path.start;
            add(from, 0);
            for (const DrawnSegment& s : path.segments) {
                const Vec<2>& end = s.points[std::size_t(s.degree - 1)];
                if (s.degree == 1) {
                    add(end, tolerance);
                } else {
                    double bend = norm(from - 2 * s.points[0] + s.points[1]);
                    if (s.degree == 3) bend = std::max(bend, norm(s.points[0] - 2 * s.points[1] + end));
                    const double by = bend * s.degree * (s.degree - 1) / (8.0 * kParts * kParts);
                    for (int k = 1; k <= kParts; ++k) add(point_at(from, s, double(k) / kParts), by);
                }
                from = end;
            }
        }
        for (const DrawnDisc& d : g.discs) add(d.centre, 0);
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
                std::visit([&](const auto& patch) { add(patch.net().flat()); }, s.surface);
        }
    };
    std::visit(visit, shape);
}

Result<Composer> compose(const Document& document, std::span<const std::size_t> objects, const Plane& plane,
                         double tolerance, double size, const DrawingOptions& options) {
    Composer c(plane, tolerance, size, options);
    for (const std::size_t i : objects)
        if (auto ok = c.add(document, i); !ok) return std::unexpected(ok.error());
    return c;
}

void fit(Drawing& d, const Plane& plane, double tolerance, const DrawingOptions& options) {
    const Box<2> box = outer_box(d.groups, tolerance);
    const double margin = options.margin * std::min(options.width, options.height);
    const double wide = box.hi[0] - box.lo[0], high = box.hi[1] - box.lo[1];
    double s = kDrawingTolerance / tolerance;
    if (wide > 0) s = std::min(s, (options.width - 2 * margin) / wide);
    if (high > 0) s = std::min(s, (options.height - 2 * margin) / high);
    const Vec<2> middle = box.lo + 0.5 * (box.hi - box.lo);
    const auto to_pixel = [&](const Vec<2>& p) {
        return Vec<2>{
            {options.width / 2.0 + s * (p[0] - middle[0]), options.height / 2.0 - s * (p[1] - middle[1])}};
    };
    for (DrawnGroup& g : d.groups) {
        for (DrawnPath& path : g.paths) {
            path.start = to_pixel(path.start);
            for (DrawnSegment& segment : path.segments)
                for (Vec<2>& p : segment.points) p = to_pixel(p);
        }
        for (DrawnDisc& disc : g.discs) disc.centre = to_pixel(disc.centre);
    }
    d.scale = std::scalbn(s, -plane.exponent);
    d.origin = to_pixel({});
}

Result<void> check(const DrawingOptions& o) {
    if (o.width < 16 || o.height < 16 || o.width > 16384 || o.height > 16384)
        return refuse(RefusalKind::invalid, "size",
                      text(o.width, " x ", o.height, " pixels; expected 16 to 16384 each"));
    if (!(o.margin >= 0 && o.margin <= 0.4))
        return refuse(RefusalKind::invalid, "margin", text("is ", o.margin, "; expected 0 to 0.4"));
    if (o.construction && !std::isfinite(*o.construction))
        return refuse(RefusalKind::nonfinite, "construction", "is not a finite number");
    if (o.view && !(std::isfinite(o.view->azimuth) && std::isfinite(o.view->elevation)))
        return refuse(RefusalKind::nonfinite, "view", "is not finite");
    return {};
}

}  // namespace
}  // namespace drawing

Result<Drawing> draw(const Document& document, std::span<const std::size_t> objects,
                     const DrawingOptions& options) {
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

    DrawingOptions bare = options;
    bare.comb = bare.control = bare.knots = false;
    bare.construction.reset();
    const double coarse = hull > 0 ? hull / 1000 : 1;
    const auto first = compose(document, all, plane, coarse, 0, bare);
    if (!first) return std::unexpected(first.error());
    const Box<2> inner = inner_box(first->groups);
    const double size = inner.is_empty() ? 0 : max_abs(inner.hi - inner.lo);
    // s <= side of the picture / size, whatever else is drawn.
    const double fine =
        size > 0 ? 0.999 * kDrawingTolerance * size / std::max(options.width, options.height) : coarse / 1e4;
    auto composed = compose(document, all, plane, fine, size, options);
    if (!composed) return std::unexpected(composed.error());
    const bool drawn = std::ranges::any_of(
        composed->groups, [](const DrawnGroup& g) { return !g.paths.empty() || !g.discs.empty(); });
    if (!drawn)
        return refuse(
            RefusalKind::no_answer, composed->left_out.empty() ? "objects" : composed->left_out[0].where,
            composed->left_out.empty() ? "there is nothing to draw"
                                       : text("nothing can be drawn: ", composed->left_out[0].message));
    if (options.construction && !composed->constructed)
        return refuse(RefusalKind::no_answer, "objects", "there is no curve to show the construction of");
    Drawing d{
        options.width, options.height, std::move(composed->groups), 1, {}, std::move(composed->left_out)};
    fit(d, plane, fine, options);
    return d;
}

}  // namespace freiform
