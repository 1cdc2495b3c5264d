// Values, grids, bases and nearest points of shapes: what is asked many times a second.
#include "shapes.hpp"

#include <freiform/core/visit.hpp>

#include <cmath>

namespace freiform::wasm {

namespace {

const detail::PreparedNet* prepared(Held& h, const Parts& p) {
    if (!h.asked && !p.bases.empty() && !std::holds_alternative<TrimmedSurface>(h.object.shape)) {
        auto net = detail::PreparedNet::make(p.bases, p.coefficients);
        if (net) h.prepared = *std::move(net);
    }
    h.asked = true;
    return h.prepared ? &*h.prepared : nullptr;
}

[[noreturn]] void has_no_values(const Held& h) {
    refuse_to_page("unsupported", "", text("a ", type_name(h.object.shape), " is not evaluated"));
}

// Any order, any patch: parameter by parameter.
struct Slow {
    std::span<const double> at;
    int order;
    double* out;

    template <class S>
    Result<void> operator()(const S& s) const {
        if constexpr (TensorPatch<S> || TriangularPatch<S>) {
            constexpr std::size_t kN = [] {
                if constexpr (TensorPatch<S>)
                    return S::kParams;
                else
                    return std::size_t(2);
            }();
            double* to = out;
            for (std::size_t i = 0; i * kN < at.size(); ++i) {
                Param<kN> u;
                if constexpr (kN == 1)
                    u = at[i];
                else
                    for (std::size_t d = 0; d < kN; ++d) u[d] = at[i * kN + d];
                typename S::Point value;
                if (auto ok = s.evaluate(std::span(&u, 1), std::span(&value, 1)); !ok) {
                    Refusal r = ok.error();
                    if (r.where.starts_with("at[0]")) r.where = text("at[", i, "]", r.where.substr(5));
                    return std::unexpected(std::move(r));
                }
                if (order == 0) {
                    to = std::copy(value.c.begin(), value.c.end(), to);
                    continue;
                }
                for (const auto& d : s.derivatives(u, order)) {
                    if (!is_finite(d))
                        return refuse(RefusalKind::ill_conditioned, text("at[", i, "]"),
                                      "a derivative is above the largest double");
                    to = std::copy(d.c.begin(), d.c.end(), to);
                }
            }
            return {};
        } else {
            return refuse(RefusalKind::unsupported, "", "is not evaluated");
        }
    }
};

std::vector<std::span<const double>> axes_of(const double* axes, const std::size_t* sizes,
                                             std::size_t count) {
    std::vector<std::span<const double>> out;
    for (std::size_t d = 0; d < count; ++d) out.push_back({axes, sizes[d]}), axes += sizes[d];
    return out;
}

// All points of the grid, one after the other.
std::vector<double> grid_parameters(std::span<const std::span<const double>> axes) {
    std::size_t count = 1;
    for (const auto& a : axes) count *= a.size();
    std::vector<double> at(count * axes.size());
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t d = axes.size(), rest = i; d-- > 0; rest /= axes[d].size())
            at[i * axes.size() + d] = axes[d][rest % axes[d].size()];
    return at;
}

template <int D>
void ask_nearest(const NearestQuery& query, std::span<const double> points, double accuracy, int parameters) {
    std::vector<Vec<D>> where(points.size() / std::size_t(D));
    for (std::size_t i = 0; i < where.size(); ++i)
        for (int k = 0; k < D; ++k) where[i][k] = points[i * std::size_t(D) + std::size_t(k)];
    std::vector<Nearest<D>> found(where.size());
    if (auto ok = query.nearest<D>(where, found, {accuracy}); !ok) refuse_to_page(ok.error());
    std::vector<double>& out = reply().numbers;
    for (const Nearest<D>& n : found) {
        out.insert(out.end(), n.at.begin(), n.at.begin() + parameters);
        out.insert(out.end(), n.point.c.begin(), n.point.c.end());
        out.insert(out.end(), {n.distance, n.lower_bound});
    }
}

}  // namespace
}  // namespace freiform::wasm

using namespace freiform;
using namespace freiform::wasm;

// out: for each of `count` parameters all partial derivatives up to `order`.
FF_EXPORT(evaluate)
void ff_evaluate(int handle, const double* at, std::size_t count, int order, double* out) {
    Held& h = held(handle);
    const Parts p = parts_of(h.object.shape);
    if (p.parameters == 0 || std::holds_alternative<TrimmedSurface>(h.object.shape)) has_no_values(h);
    if (order < 0 || order > 50) refuse_to_page("usage", "derivatives", "an order from 0 to 50 was expected");
    const std::span<const double> parameters{at, count * std::size_t(p.parameters)};
    const auto* fast = order <= 2 ? prepared(h, p) : nullptr;
    const auto done =
        fast ? fast->evaluate(parameters, order, jet_size(p.bases.size(), order), {out}, Outside::refuse)
             : visit_one(Slow{parameters, order, out}, h.object.shape);
    if (!done) refuse_to_page(done.error());
}

FF_EXPORT(error_bound) double ff_error_bound(int handle) {
    Held& h = held(handle);
    const Parts p = parts_of(h.object.shape);
    if (const auto* fast = prepared(h, p)) return fast->error_bound(0);
    return visit_one(
        [](const auto& s) -> double {
            if constexpr (requires { s.value_error_bound(); })
                return s.value_error_bound();
            else
                return std::nan("");
        },
        h.object.shape);
}

// out: the points; normals and curvatures (Gauss, mean) of surfaces in space where they are not null.
FF_EXPORT(grid)
void ff_grid(int handle, const double* axes, const std::size_t* sizes, std::size_t count, double* out,
             double* normals, double* curvatures) {
    Held& h = held(handle);
    const Parts p = parts_of(h.object.shape);
    if (p.bases.empty() || std::holds_alternative<TrimmedSurface>(h.object.shape)) has_no_values(h);
    if (count != p.bases.size())
        refuse_to_page("invalid", "axes",
                       text("there are ", count, ", the shape has ", p.bases.size(), " parameters"));
    if ((normals || curvatures) && (count != 2 || p.coefficients.dim() != 3))
        refuse_to_page("unsupported", "", "normals and curvatures are those of surfaces in space");
    const auto all = axes_of(axes, sizes, count);
    const auto* fast = prepared(h, p);
    if (!fast) {
        if (normals || curvatures)
            refuse_to_page("unsupported", "", "the surface is too extreme for normals on a grid");
        if (const auto done = visit_one(Slow{grid_parameters(all), 0, out}, h.object.shape); !done)
            refuse_to_page(done.error());
        return;
    }
    const int order = curvatures ? 2 : normals ? 1 : 0;
    if (const auto done = fast->evaluate_grid(all, order, 1, {out, normals, curvatures}); !done)
        refuse_to_page(done.error());
}

// out: count x size numbers.
FF_EXPORT(basis)
void ff_basis(int handle, int axis, const double* at, std::size_t count, int order, double* out) {
    const Parts p = parts_of(held(handle).object.shape);
    if (axis < 0 || std::size_t(axis) >= p.bases.size())
        refuse_to_page("usage", "axis", text("the shape has ", p.bases.size(), " bases"));
    const BSplineBasis& basis = p.bases[std::size_t(axis)];
    if (order < 0 || order > basis.degree() + 1)
        refuse_to_page("usage", "order", "an order up to the degree was expected");
    std::vector<double> inside(at, at + count);
    const Interval on = basis.domain();
    for (std::size_t i = 0; i < count; ++i) {
        if (!std::isfinite(inside[i]))
            refuse_to_page("nonfinite", text("at[", i, "]"), "is not a finite number");
        inside[i] = basis.wrap(inside[i]);
        if (!(inside[i] >= on.lo && inside[i] <= on.hi))
            refuse_to_page("out_of_domain", text("at[", i, "]"),
                           text(inside[i], " is outside [", on.lo, ", ", on.hi, "]"));
    }
    std::fill(out, out + count * std::size_t(basis.size()), 0.0);
    if (order > basis.degree()) return;
    const BandMap map = collocation(basis, std::span<const double>(inside), order);
    for (std::size_t i = 0; i < count; ++i)
        for (int k = 0; k < map.width; ++k)
            out[i * std::size_t(map.cols) + std::size_t((map.first[i] + k) % map.cols)] +=
                map.row(int(i))[std::size_t(k)];
}

// reply: for each point the parameters, the point, the distance and its lower bound; of a model the face
// before them.
FF_EXPORT(nearest) void ff_nearest(int handle, const double* points, std::size_t count, double accuracy) {
    Held& h = held(handle);
    const Parts p = parts_of(h.object.shape);
    reply().numbers.clear();
#if FREIFORM_MODELS
    if (nearest_of_model(h, {points, count}, accuracy)) return;
#endif
    if (p.parameters == 0 || std::holds_alternative<TrimmedSurface>(h.object.shape)) has_no_values(h);
    const int dim = p.coefficients.dim();
    if (count % std::size_t(dim) != 0)
        refuse_to_page("invalid", "points", text("has ", count, " numbers, points have ", dim));
    if (!h.nearest) {
        const auto object = visit_one(
            [](const auto& s) -> std::optional<NearestObject> {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (TensorPatch<S> || TriangularPatch<S>)
                    return NearestObject::of(s);
                else
                    return std::nullopt;
            },
            h.object.shape);
        auto query = NearestQuery::make(std::span(&*object, 1));
        if (!query) refuse_to_page(query.error());
        h.nearest = *std::move(query);
    }
    const std::span<const double> all{points, count};
    dim == 1   ? ask_nearest<1>(*h.nearest, all, accuracy, p.parameters)
    : dim == 2 ? ask_nearest<2>(*h.nearest, all, accuracy, p.parameters)
    : dim == 3 ? ask_nearest<3>(*h.nearest, all, accuracy, p.parameters)
               : ask_nearest<4>(*h.nearest, all, accuracy, p.parameters);
}
