// Every number that is a length is multiplied; weights, parameters and directions of length 1 are none.
#include <freiform/core/visit.hpp>
#include <freiform/model/rescale.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

template <class Change>
class Rescaler {
public:
    explicit Rescaler(Change change) : change_(change) {}

    double operator()(double x) {
        const double y = change_(x);
        finite_ = finite_ && std::isfinite(y);
        return y;
    }
    Vec<3> operator()(Vec<3> p) {
        for (double& x : p.c) x = (*this)(x);
        return p;
    }
    Hom<3> operator()(Hom<3> p) {
        for (int i = 0; i < 3; ++i) p[i] = (*this)(p[i]);
        return p;
    }
    Line<3> operator()(const Line<3>& l) { return {(*this)(l.origin), (*this)(l.direction)}; }
    Conic<3> operator()(const Conic<3>& c) { return {c.kind, (*this)(c.centre), (*this)(c.x), (*this)(c.y)}; }
    template <std::size_t N, class P>
    Patch<N, P> operator()(const Patch<N, P>& patch) {
        std::vector<P> points;
        for (const P& p : patch.net().flat()) points.push_back((*this)(p));
        return Patch<N, P>::trusted(patch.bases(), Net<N, P>(patch.net().extent(), std::move(points)));
    }
    CurveGeometry<3> operator()(const CurveGeometry<3>& curve) {
        return visit_one([&](const auto& c) -> CurveGeometry<3> { return (*this)(c); }, curve);
    }
    Extrusion operator()(const Extrusion& s) { return {(*this)(s.profile), (*this)(s.direction), s.kind}; }
    Revolution operator()(const Revolution& s) {
        return {(*this)(s.profile), (*this)(s.origin), s.axis, s.kind};
    }
    OffsetSurface operator()(const OffsetSurface& s) {
        return {std::make_shared<const SurfaceGeometry>((*this)(*s.base)), (*this)(s.distance)};
    }
    SurfaceGeometry operator()(const SurfaceGeometry& surface) {
        return visit_one([&](const auto& s) -> SurfaceGeometry { return (*this)(s); }, surface);
    }
    bool is_finite() const { return finite_; }

private:
    Change change_;
    bool finite_ = true;
};

// `change` in words: for refusals.
template <class Change>
Result<Model> changed(const Model& model, Change change, const std::string& words) {
    Rescaler scale(change);
    Model out = model;
    const auto check = [&](const char* what, std::size_t i) -> Result<void> {
        if (scale.is_finite()) return {};
        return refuse(RefusalKind::nonfinite, text(what, "[", i, "]"),
                      text(words, " is beyond the largest double"));
    };
    for (std::size_t i = 0; i < out.vertices.size(); ++i) {
        Vertex& v = out.vertices[i];
        v.point = scale(v.point), v.tolerance = scale(v.tolerance);
        if (auto ok = check("vertices", i); !ok) return std::unexpected(ok.error());
    }
    for (std::size_t i = 0; i < out.edges.size(); ++i) {
        Edge& e = out.edges[i];
        if (e.curve) e.curve = scale(*e.curve);
        e.tolerance = scale(e.tolerance);
        if (auto ok = check("edges", i); !ok) return std::unexpected(ok.error());
    }
    for (std::size_t i = 0; i < out.faces.size(); ++i) {
        Face& f = out.faces[i];
        f.surface = scale(f.surface), f.tolerance = scale(f.tolerance);
        if (auto ok = check("faces", i); !ok) return std::unexpected(ok.error());
    }
    for (Approximation& a : out.approximations) {
        if (a.bound) a.bound = scale(*a.bound);
        a.estimate = scale(a.estimate);
    }
    for (Repair& r : out.repairs) r.distance = scale(r.distance);
    return out;
}

}  // namespace

Result<Model> rescaled(const Model& model, int exponent) {
    return changed(
        model, [=](double x) { return std::ldexp(x, exponent); }, text("times 2^", exponent));
}

Result<Model> divided(const Model& model, double by) {
    if (!(by > 0) || !std::isfinite(by))
        return refuse(RefusalKind::invalid, "by", text("is ", by, "; a positive number is expected"));
    return changed(
        model, [=](double x) { return x / by; }, text("divided by ", by));
}

}  // namespace freiform
