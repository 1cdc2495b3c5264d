// bounds: tight boxes of objects, each with the distance that it may be too large by.
#include "hull_bounds.hpp"
#include "input.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/model/bounds.hpp>

#include <cmath>
#include <limits>

namespace freiform::cli {

namespace {

// A box of up to four coordinates, and how far each side may be from the object.
struct BoundsAnswer {
    std::vector<double> lo, hi;
    double bound = 0;
};

template <int D>
BoundsAnswer answer_of(const Box<D>& box, double bound) {
    if (box.is_empty()) return {{}, {}, 0};
    return {{box.lo.c.begin(), box.lo.c.end()}, {box.hi.c.begin(), box.hi.c.end()}, bound};
}

// What an object contains for certain, against the box that contains it.
template <int D>
BoundsAnswer answer_of(const Box<D>& outer, const Box<D>& inner) {
    double bound = inner.is_empty() && !outer.is_empty() ? std::numeric_limits<double>::infinity() : 0;
    for (int i = 0; i < D && !inner.is_empty(); ++i)
        bound = std::max({bound, inner.lo[i] - outer.lo[i], outer.hi[i] - inner.hi[i]});
    return answer_of(outer, bound);
}

template <class P>
double diagonal(std::span<const P> control) {
    Box<Space<P>::kDim> box;
    for (const P& p : control) box.add(project(p));
    return box.diagonal();
}

class Bounding {
public:
    explicit Bounding(std::optional<double> accuracy) : accuracy_(accuracy) {}

    template <TensorPatch S>
    Result<BoundsAnswer> operator()(const S& s) const {
        return bounded(s, s.net().flat(), S::kParams == 1 ? 1e-12 : 1e-7);
    }
    template <TriangularPatch S>
    Result<BoundsAnswer> operator()(const S& s) const {
        return bounded(s, s.coefficients(), 1e-7);
    }
    // Where derivatives have no bounds: the surface over the box of the loops contains the face; the loops
    // are part of it.
    Result<BoundsAnswer> operator()(const TrimmedSurface& t) const {
        if (t.loops.empty()) return visit_one(*this, t.surface);
        Document one;
        one.objects.push_back({"", t, {}});
        if (const auto model = scene_of(one))
            if (const auto b = tight(*model)) return answer_of(b->box, b->slack);
        return visit_one(
            [&](const auto& s) -> Result<BoundsAnswer> {
                const auto domain = s.domain();
                Box<3> inner;
                Box<2> in_domain;
                for (const auto& loop : t.loops)
                    for (const auto& curve : loop) add_loop(s, curve, in_domain, inner);
                auto part = s;
                for (int d = 0; d < 2; ++d) {
                    Interval on = in_domain.side(d);
                    on = {std::max(on.lo, domain[std::size_t(d)].lo),
                          std::min(on.hi, domain[std::size_t(d)].hi)};
                    if (s.basis(d).is_closed() || !(on.lo < on.hi)) continue;
                    auto cut = restrict_to(part, d, on);
                    if (!cut) return std::unexpected(cut.error());
                    part = std::move(*cut);
                }
                const auto outer = (*this)(part);
                if (!outer) return outer;
                Box<3> box;
                for (int i = 0; i < 3; ++i) {
                    // Restriction moves points by a few roundings.
                    const double slack = 4 * s.value_error_bound();
                    box.lo[i] = outer->lo[std::size_t(i)] - slack;
                    box.hi[i] = outer->hi[std::size_t(i)] + slack;
                }
                return answer_of(box, inner);
            },
            t.surface);
    }
    Result<BoundsAnswer> operator()(const Model& m) const {
        if (const auto b = tight(m)) return answer_of(b->box, b->slack);
        Box<3> inner;
        for (const Vertex& v : m.vertices) inner.add(v.point);
        for (const Edge& e : m.edges) {
            if (!e.curve || !std::isfinite(e.range.length())) continue;
            for (int i = 0; i <= kSamples; ++i)
                inner.add(jet<0>(*e.curve, e.range.lo + e.range.length() * i / kSamples).value());
        }
        return answer_of(summary(m).box, inner);
    }

private:
    static constexpr int kSamples = 64;

    Result<TightBox<3>> tight(const Model& m) const {
        return tight_box(m, accuracy_ ? *accuracy_ : 1e-7 * summary(m).box.diagonal());
    }

    // Where no accuracy was asked for, this fraction of the control points' box.
    template <class S, class P>
    Result<BoundsAnswer> bounded(const S& s, std::span<const P> control, double fraction) const {
        const auto b = tight_box(s, accuracy_ ? *accuracy_ : fraction * diagonal(control));
        if (!b) return std::unexpected(b.error());
        return answer_of(b->box, b->slack);
    }

    template <class S>
    static void add_loop(const S& s, const CurveGeometry<2>& curve, Box<2>& in_domain, Box<3>& inner) {
        const Interval on = domain(curve)[0];
        for (int i = 0; i <= kSamples; ++i) {
            const Vec<2> uv = jet<0>(curve, on.lo + on.length() * i / kSamples).value();
            inner.add(s(Param<2>{uv[0], uv[1]}));
        }
        visit_one(
            [&](const auto& c) {
                if constexpr (requires { c.net(); }) {
                    for (const auto& p : points(c)) in_domain.add(p);
                } else if constexpr (requires { c.centre; }) {
                    // An ellipse reaches sqrt(x^2 + y^2) from its centre along each axis; |x| + |y| contains
                    // that.
                    for (const double sx : {-1.0, 1.0})
                        for (const double sy : {-1.0, 1.0}) in_domain.add(c.centre + sx * c.x + sy * c.y);
                }
            },
            curve);
    }

    std::optional<double> accuracy_;
};

struct BoundsArguments {
    std::string file, object;
    std::optional<double> accuracy, hull;
    bool oriented = false;
};

void add_to(BoundsAnswer& all, const BoundsAnswer& a, bool first) {
    if (first) {
        all = a;
        return;
    }
    if (all.lo.size() != a.lo.size()) {
        all = {};  // objects of different dimension have no common box
        return;
    }
    for (std::size_t i = 0; i < a.lo.size(); ++i) {
        all.lo[i] = std::min(all.lo[i], a.lo[i]);
        all.hi[i] = std::max(all.hi[i], a.hi[i]);
    }
    all.bound = std::max(all.bound, a.bound);
}

void write_box(json::Writer& w, const BoundsAnswer& a) {
    w.key("box");
    if (a.lo.empty()) {
        w.null();
        return;
    }
    w.begin_object().key("min").array(a.lo).key("max").array(a.hi).end_object().field("bound", a.bound);
}

std::string box_text(const BoundsAnswer& a) {
    if (a.lo.empty()) return "none";
    std::string s;
    for (std::size_t i = 0; i < a.lo.size(); ++i) s += text(i ? " x [" : "[", a.lo[i], ", ", a.hi[i], "]");
    return s + text(", each side within ", a.bound);
}

Result<void> run_bounds(Context& context, const BoundsArguments& options) {
    if (options.accuracy && !(*options.accuracy >= 0)) wrong_usage("--accuracy needs a length >= 0");
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    if (options.oriented || options.hull)
        return answer_hulls(context, *input, {options.oriented, options.hull, options.accuracy});
    const Document& document = *input->document;

    json::Writer w;
    std::string s;
    BoundsAnswer all;
    w.begin_object()
        .field("file", shown(options.file))
        .field("unit", document.unit)
        .key("objects")
        .begin_array();
    for (std::size_t k = 0; k < input->chosen.size(); ++k) {
        const std::size_t i = input->chosen[k];
        const Object& o = document.objects[i];
        const auto answer = visit_one(Bounding(options.accuracy), o.shape);
        if (!answer) return refuse_within(object_label(document, i), answer.error());
        w.new_line(1)
            .begin_object()
            .field("index", i)
            .field("name", o.name)
            .field("type", type_name(o.shape));
        write_box(w, *answer);
        w.end_object();
        s += text(object_label(document, i), ": ", box_text(*answer), "\n");
        add_to(all, *answer, k == 0 || (all.lo.empty() && k == 0));
    }
    w.end_array();
    write_box(w, all);
    w.end_object();
    if (input->chosen.size() > 1 && !all.lo.empty()) s += text("all: ", box_text(all), "\n");
    return emit(context, context.json ? w.take() + "\n" : s);
}

}  // namespace

void add_bounds(CommandLine& line) {
    const auto options = std::make_shared<BoundsArguments>();
    const Command command = line.add(
        "bounds", "Tight boxes: they contain the object, and the object comes within `bound` of every side",
        "  freiform bounds curve.json\n"
        "  freiform bounds teapot.bpt --accuracy 1e-6 --json\n"
        "  freiform bounds part.step --oriented\n"
        "  freiform bounds teapot.bpt --hull 0.01 -o hull.stl");
    command.file(options->file);
    command.number(
        "--accuracy", options->accuracy,
        "How far a side may be from the object, in the unit of the file (curves: 1e-12 of the diagonal, "
        "else 1e-7). The answer says what was reached");
    command.flag("--oriented", options->oriented,
                 "Instead: a small box in any orientation, as axes and the ranges along them");
    command.positive("--hull", options->hull,
                     "Instead: the convex hull of each object, at most this much too large; -o with "
                     "a name that ends in .stl, .obj, .ply or .glb writes a mesh");
    command.object(options->object);
    command.answer_file();
    command.limits();
    command.action(options, run_bounds);
}

}  // namespace freiform::cli
