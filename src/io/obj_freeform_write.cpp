// Statements count points from the beginning of the file, in order of appearance: v for points in space, vp
// for those in the parameters of surfaces, curv2 for trimming curves. The first parameter of a surface runs
// fastest.
//
// References: the specification of the object file format in Wavefront's Advanced Visualizer manual, appendix
// B.
#include "written_point.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/obj_freeform.hpp>
#include <freiform/model/spline_faces.hpp>
#include <freiform/spline/in_space.hpp>
#include <freiform/trim/loops.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

// A closed basis has fewer coefficients than its knots say to others: it is cut at its seam.
template <std::size_t N, class P>
Patch<N, P> opened(Patch<N, P> s) {
    for (int axis = 0; axis < int(N); ++axis)
        if (s.basis(axis).is_closed())
            if (auto cut = restrict_to(s, axis, s.basis(axis).domain())) s = *std::move(cut);
    return s;
}

class ObjFreeformWriter {
public:
    template <class P>
    void add_curve(const std::string& name, const Curve<P>& given) {
        const Curve<P> c = opened(given);
        const auto space = in_space(c);
        head<P>(name);
        const int first = vertices_ + 1;
        for (const auto& p : space.net().flat()) vertex(p);
        const Interval on = c.basis().domain();
        out += text("deg ", c.basis().degree(), "\ncurv ", on.lo, " ", on.hi);
        indices(first, vertices_);
        knots("parm u", c.basis());
        out += "end\n";
    }

    template <class P>
    void begin_surface(const std::string& name, const Surface<P>& given) {
        const Surface<P> s = opened(given);
        head<P>(name);
        const int first = vertices_ + 1;
        const auto [n, m] = s.net().extent();
        for (int j = 0; j < m; ++j)
            for (int i = 0; i < n; ++i) vertex(s.net().flat()[std::size_t(i * m + j)]);
        const Interval u = s.basis(0).domain(), v = s.basis(1).domain();
        out += text("deg ", s.basis(0).degree(), " ", s.basis(1).degree(), "\nsurf ", u.lo, " ", u.hi, " ",
                    v.lo, " ", v.hi);
        indices(first, vertices_);
        knots("parm u", s.basis(0));
        knots("parm v", s.basis(1));
    }
    void end() { out += "end\n"; }

    // Trimming curves stand before their surface. Returns the number of the curve; nothing for an ellipse.
    std::optional<int> add_trimming(const CurveGeometry<2>& curve) {
        return visit_one(
            [&](const auto& c) -> std::optional<int> {
                if constexpr (requires { c.net(); }) {
                    using P = typename std::remove_cvref_t<decltype(c)>::Coefficients;
                    const Curve<P> open = opened(c);
                    type<P>();
                    const int first = parameters_ + 1;
                    for (const P& q : open.net().flat()) {
                        const Vec<2> p = detail::written_point(q);
                        out += text("vp ", p[0], " ", p[1]);
                        if constexpr (Space<P>::kRational) out += text(" ", q.weight());
                        out += '\n', ++parameters_;
                    }
                    out += text("deg ", open.basis().degree(), "\ncurv2");
                    indices(first, parameters_);
                    knots("parm u", open.basis());
                    out += "end\n";
                    return ++trimmings_;
                }
                return std::nullopt;
            },
            curve);
    }

    std::string out = "# freiform\n";
    double tolerance = 0;  // 0: nothing is approximated
    double bound = 0;

private:
    template <class P>
    void type() {
        out += Space<P>::kRational ? "cstype rat bspline\n" : "cstype bspline\n";
    }
    template <class P>
    void head(const std::string& name) {
        std::string word = name;
        for (char& c : word)
            if (static_cast<unsigned char>(c) <= ' ' || c == '\x7f' || c == '\\') c = '_';
        out += text("o ", word, "\n");
        type<P>();
    }
    template <class P>
    void vertex(const P& q) {
        const Vec<3> p = detail::written_point(q);
        out += text("v ", p[0], " ", p[1], " ", p[2]);
        if constexpr (Space<P>::kRational) out += text(" ", q.weight());
        out += '\n', ++vertices_;
    }
    void indices(int first, int last) {
        for (int i = first; i <= last; ++i) out += text(" ", i);
        out += '\n';
    }
    void knots(std::string_view what, const BSplineBasis& basis) {
        out += what;
        for (const double t : basis.knots()) out += text(" ", t);
        out += '\n';
    }

    int vertices_ = 0, parameters_ = 0, trimmings_ = 0;
};

Result<void> add_trimmed(ObjFreeformWriter& w, const std::string& name, const TrimmedSurface& t) {
    std::vector<std::string> loops;
    for (std::size_t l = 0; l < t.loops.size(); ++l) {
        std::string loop = "trim";
        for (std::size_t c = 0; c < t.loops[l].size(); ++c) {
            const auto number = w.add_trimming(t.loops[l][c]);
            if (!number)
                return refuse(RefusalKind::unsupported, text("loops[", l, "][", c, "]"),
                              "is no spline; write ellipses as rational ones");
            const Interval on = domain(t.loops[l][c])[0];
            loop += text(" ", on.lo, " ", on.hi, " ", *number);
        }
        loops.push_back(std::move(loop));
    }
    visit_one([&](const auto& s) { w.begin_surface(name, s); }, t.surface);
    for (const std::string& loop : loops) w.out += loop + "\n";
    w.end();
    return {};
}

Result<TrimmedSurface> spline_face_of(ObjFreeformWriter& w, const Model& model, std::size_t f) {
    if (w.tolerance == 0) return spline_face(model, f);
    auto near = spline_face_within(model, f, w.tolerance);
    if (!near) return std::unexpected(near.error());
    w.bound = std::max(w.bound, near->bound);
    return std::move(near->face);
}

Result<void> add_faces(ObjFreeformWriter& w, const std::string& name, const Model& model) {
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        auto face = spline_face_of(w, model, f);
        if (!face) return refuse_within(text("faces[", f, "]"), face.error());
        // Outer loops counter-clockwise, holes clockwise: what the format demands.
        const auto sides = visit_one([](const auto& s) { return s.domain(); }, face->surface);
        const double gap = TrimmedSurface::kSlack * std::hypot(sides[0].length(), sides[1].length());
        if (auto turned = orient_loops(face->loops, {gap, gap})) face->loops = std::move(turned->loops);
        const std::string& own = model.faces[f].name;
        if (auto ok = add_trimmed(w, own.empty() ? text(name, ".", f) : own, *face); !ok)
            return refuse_within(text("faces[", f, "]"), ok.error());
    }
    return {};
}

Result<void> add_objects(ObjFreeformWriter& w, const Document& document) {
    for (std::size_t i = 0; i < document.objects.size(); ++i) {
        const Object& o = document.objects[i];
        const auto done = visit_one(
            [&](const auto& s) -> Result<void> {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (std::same_as<S, TrimmedSurface>) {
                    return add_trimmed(w, o.name, s);
                } else if constexpr (std::same_as<S, Model>) {
                    return add_faces(w, o.name, s);
                } else if constexpr (TensorPatch<S>) {
                    if constexpr (S::kParams == 1 && (S::Point::kCoords == 2 || S::Point::kCoords == 3))
                        return w.add_curve(o.name, s), Result<void>();
                    else if constexpr (S::kParams == 2 && S::Point::kCoords == 3)
                        return w.begin_surface(o.name, s), w.end(), Result<void>();
                }
                return refuse(RefusalKind::unsupported, "",
                              text("is a ", type_name(o.shape),
                                   "; OBJ files hold curves, surfaces in space, trimmed ones and models "
                                   "(freiform tessellate "
                                   "writes triangles of all)"));
            },
            o.shape);
        if (!done) return refuse_within(object_label(document, i), done.error());
    }
    return {};
}

}  // namespace

Result<std::string> write_obj_freeform(const Document& document) {
    ObjFreeformWriter w;
    if (auto ok = add_objects(w, document); !ok) return std::unexpected(ok.error());
    return std::move(w.out);
}

Result<WrittenObj> write_obj_freeform(const Document& document, double tolerance) {
    if (!(tolerance > 0 && std::isfinite(tolerance)))
        return refuse(RefusalKind::invalid, "tolerance", text(tolerance, " is not a positive number"));
    ObjFreeformWriter w;
    w.tolerance = tolerance;
    if (auto ok = add_objects(w, document); !ok) return std::unexpected(ok.error());
    return WrittenObj{std::move(w.out), w.bound};
}

}  // namespace freiform
