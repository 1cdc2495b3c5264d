// Patches of a document: curves, surfaces and volumes, which differ in the number of nested arrays only.
//
// Rational patches. The document says points x and weights w, the patch holds h = fl(w x). Written is, for
// each coordinate, the x with fl(w x) = h whose text is shortest among h / w and its neighbours. Not every h
// has such an x (then the products are written too, as `weighted_points`), so that reading gives the same
// bits in every case.
#include "document_detail.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/spline/weights.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace freiform::document_detail {

namespace {

// The nested arrays of a net, in row-major order. `leaf` reads an entry and appends it.
template <std::size_t N>
struct Nested {
    Index<N> extent{};
    std::array<bool, N> known{};
};
template <std::size_t N, class Leaf>
Result<void> read_nested(json::Value v, std::size_t level, Nested<N>& shape, Leaf&& leaf) {
    if (!v.is(json::Kind::array))
        return expected(N == 1 ? "an array" : text("an array (", N - level, " more of ", N, ")"), v);
    if (v.size() == 0) return refuse(RefusalKind::invalid, "", "is empty");
    if (!shape.known[level]) shape.extent[level] = int(v.size());
    if (shape.extent[level] != int(v.size()))
        return refuse(RefusalKind::invalid, "",
                      text("has ", v.size(), " entries, the rows before have ", shape.extent[level]));
    shape.known[level] = true;
    std::size_t i = 0;
    for (const json::Value element : v.elements()) {
        auto ok = level + 1 == N ? leaf(element) : read_nested<N>(element, level + 1, shape, leaf);
        if (!ok) return refuse_within(text("[", i, "]"), ok.error());
        ++i;
    }
    return {};
}

template <std::size_t N>
struct Points {
    Index<N> extent{};
    int dim = 0;
    std::vector<double> flat;
};

template <std::size_t N>
Result<Points<N>> read_points(json::Value v) {
    Points<N> p;
    Nested<N> shape;
    const auto leaf = [&](json::Value point) -> Result<void> {
        if (!point.is(json::Kind::array)) return expected("a point (an array of 1 to 4 numbers)", point);
        if (p.dim == 0 && (point.size() < 1 || point.size() > 4))
            return expected("a point of 1 to 4 numbers", point);
        if (p.dim == 0) p.dim = int(point.size());
        if (point.size() != std::size_t(p.dim))
            return refuse(RefusalKind::invalid, "",
                          text("has ", point.size(), " coordinates, the points before have ", p.dim));
        std::size_t c = 0;
        for (const json::Value number : point.elements()) {
            const auto x = read_number(number);
            if (!x) return refuse_within(text("[", c, "]"), x.error());
            p.flat.push_back(*x);
            ++c;
        }
        return {};
    };
    if (auto ok = read_nested<N>(v, 0, shape, leaf); !ok) return std::unexpected(ok.error());
    p.extent = shape.extent;
    return p;
}

template <std::size_t N>
Result<std::vector<double>> read_weights(json::Value v, const Index<N>& extent) {
    std::vector<double> flat;
    Nested<N> shape;
    const auto leaf = [&](json::Value weight) -> Result<void> {
        const auto w = read_number(weight);
        if (!w) return std::unexpected(w.error());
        flat.push_back(*w);
        return {};
    };
    if (auto ok = read_nested<N>(v, 0, shape, leaf); !ok) return std::unexpected(ok.error());
    for (std::size_t d = 0; d < N; ++d)
        if (shape.extent[d] != extent[d])
            return refuse(RefusalKind::invalid, "",
                          text(shape.extent[d], " weights", N == 1 ? "" : text(" along axis ", d), " for ",
                               extent[d], " points"));
    return flat;
}

template <std::size_t N>
struct ReadNet {
    Points<N> points;
    std::optional<std::vector<double>> weights;
    std::optional<Points<N>> products;  // of points and weights
};

// One array per axis; of a curve the array itself.
template <std::size_t N, class Read>
auto read_per_axis(json::Value v, Read&& read)
    -> Result<std::vector<typename decltype(read(std::declval<json::Value>()))::value_type>> {
    if constexpr (N == 1) {
        auto one = read(v);
        if (!one) return std::unexpected(one.error());
        std::vector<typename decltype(read(std::declval<json::Value>()))::value_type> list;
        list.push_back(std::move(*one));
        return list;
    } else {
        if (!v.is(json::Kind::array) || v.size() != N)
            return expected(text("an array of ", N, ", one entry per parameter"), v);
        return read_list(v, read);
    }
}

struct Axis {
    int degree = -1;  // not given
    bool closed = false;
    std::optional<std::vector<double>> knots;
};

Result<BSplineBasis> make_basis(const Axis& a, int points, std::string_view degree_field,
                                std::string_view knots_field) {
    const auto fail = [&](std::string_view field, std::string message) {
        return refuse(RefusalKind::invalid, std::string(field), std::move(message));
    };
    if (a.closed && a.degree < 0) return fail(degree_field, "is missing; a closed spline needs it");
    if (!a.closed && !a.knots) {
        if (a.degree >= 0 && points != a.degree + 1)
            return fail(degree_field, text("without knots, degree ", a.degree, " needs ", a.degree + 1,
                                           " points, found ", points));
        if (points - 1 > kMaxDegree)
            return refuse(RefusalKind::unsupported, std::string(knots_field),
                          text("without knots, ", points, " points mean a Bezier curve of degree ",
                               points - 1, "; the highest degree is ", kMaxDegree));
        return BSplineBasis::bezier(points - 1);
    }
    std::vector<double> t;
    if (a.knots) {
        t = *a.knots;
        if (!a.closed && a.degree < 0) return fail(degree_field, "is missing; with knots it is needed");
        const long long wanted = a.closed ? points + 1LL : points + a.degree + 1LL;
        if (t.size() != std::size_t(wanted))
            return fail(
                knots_field,
                text(t.size(), a.closed ? " breaks for " : " knots for ", points, " points",
                     a.closed ? ", a closed spline" : text(" of degree ", a.degree), " needs ", wanted));
    } else {
        for (int i = 0; i <= points; ++i) t.push_back(i);
    }
    auto basis = a.closed ? BSplineBasis::periodic(a.degree, std::move(t))
                          : BSplineBasis::make(a.degree, std::move(t));
    if (basis) return basis;
    Refusal r = basis.error();  // its fields are "degree", "knots[i]", "breaks[i]"
    const std::size_t bracket = r.where.find('[');
    const std::string index = bracket == std::string::npos ? "" : r.where.substr(bracket);
    r.where = text(r.where.starts_with("degree") ? degree_field : knots_field, index);
    return std::unexpected(std::move(r));
}

// points[i][j][c] of the flat index.
template <std::size_t N>
std::string point_name(const Index<N>& extent, std::size_t flat) {
    std::array<std::size_t, N> at{};
    for (std::size_t d = N; d-- > 0; flat /= std::size_t(extent[d])) at[d] = flat % std::size_t(extent[d]);
    std::string s;
    for (const std::size_t i : at) s += text("[", i, "]");
    return s;
}

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

// Whether h is the product of x and w, or x the quotient of h and w: one rounding either way. A point at
// infinity (weight 0) is given by its direction h, for which x stands in.
bool agree(double x, double w, double h) { return w * x == h || (w == 0 ? x == h : h / w == x); }

template <int D>
std::vector<Vec<D>> polynomial_net(const std::vector<double>& flat) {
    std::vector<Vec<D>> net(flat.size() / std::size_t(D));
    for (std::size_t k = 0; k < flat.size(); ++k) net[k / std::size_t(D)][int(k % std::size_t(D))] = flat[k];
    return net;
}

template <int D, std::size_t N>
Result<std::vector<Hom<D>>> rational_net(const Points<N>& p, const std::vector<double>& weights,
                                         const Points<N>* weighted_points) {
    std::vector<Hom<D>> net(weights.size());
    for (std::size_t k = 0; k < p.flat.size(); ++k) {
        const std::size_t i = k / std::size_t(D), c = k % std::size_t(D);
        const double w = weights[i], x = p.flat[k], h = weighted_points ? weighted_points->flat[k] : w * x;
        if (!std::isfinite(h) || (w != 0 && !std::isfinite(h / w)))
            return refuse(RefusalKind::nonfinite, text("points", point_name<N>(p.extent, i), "[", c, "]"),
                          text(x, " times its weight ", w, " leaves the range of double"));
        if (!agree(x, w, h))
            return refuse(RefusalKind::invalid,
                          text("weighted_points", point_name<N>(p.extent, i), "[", c, "]"),
                          text(h, " is not the point ", x, " times its weight ", w));
        net[i][int(c)] = h;
        net[i][D] = w;
    }
    return net;
}

// "points[7]", counted through the net, as "points[1][3]".
template <std::size_t N>
Refusal nested(Refusal r, const Index<N>& extent) {
    // Numbers too large or too small to calculate with are no limit on effort.
    if (r.kind == RefusalKind::limit || r.kind == RefusalKind::ill_conditioned)
        r.kind = RefusalKind::unsupported;
    const std::size_t open = r.where.find('['), close = r.where.find(']');
    if (open == std::string::npos || close == std::string::npos) return r;
    const auto flat = scan_number<std::size_t>(std::string_view(r.where).substr(open + 1, close - open - 1));
    if (flat)
        r.where = text(r.where.substr(0, open), point_name<N>(extent, *flat), r.where.substr(close + 1));
    return r;
}

// Points, weights and products as one of the two kinds of net, handed to `make`.
template <int D, std::size_t N, class Make>
Result<ReadShape> assemble_in(const ReadNet<N>& in, Make&& make) {
    const auto shape_of = [&](auto patch, std::vector<double> given) -> Result<ReadShape> {
        if (!patch) return std::unexpected(nested(patch.error(), in.points.extent));
        return ReadShape{std::move(*patch), std::move(given)};
    };
    if (!in.weights) return shape_of(make(polynomial_net<D>(in.points.flat)), {});
    auto net = rational_net<D>(in.points, *in.weights, in.products ? &*in.products : nullptr);
    if (!net) return std::unexpected(net.error());
    return shape_of(make(std::move(*net)), in.points.flat);
}

// The same for the dimension that the points have.
template <std::size_t N, class Make>
Result<ReadShape> assemble(const ReadNet<N>& in, Make&& make) {
    switch (in.points.dim) {
        case 1:
            return assemble_in<1>(in, make);
        case 2:
            return assemble_in<2>(in, make);
        case 3:
            return assemble_in<3>(in, make);
        default:
            return assemble_in<4>(in, make);
    }
}

template <std::size_t N>
Result<ReadNet<N>> read_net(const Fields& fields) {
    ReadNet<N> net;
    auto points = fields.get("points", read_points<N>);
    if (!points) return std::unexpected(points.error());
    net.points = std::move(*points);
    if (fields.has("weights")) {
        auto w = fields.get("weights", [&](json::Value x) { return read_weights<N>(x, net.points.extent); });
        if (!w) return std::unexpected(w.error());
        net.weights = std::move(*w);
    }
    if (fields.has("weighted_points")) {
        if (!net.weights) return refuse(RefusalKind::invalid, "weighted_points", "needs weights");
        auto p = fields.get("weighted_points", read_points<N>);
        if (!p) return std::unexpected(p.error());
        if (p->extent != net.points.extent || p->dim != net.points.dim)
            return refuse(RefusalKind::invalid, "weighted_points", "is not of the same shape as the points");
        net.products = std::move(*p);
    }
    return net;
}

template <std::size_t N>
inline constexpr std::array<std::string_view, 10> kPatchFields = {"type",
                                                                  "name",
                                                                  N == 1 ? "degree" : "degrees",
                                                                  "knots",
                                                                  "closed",
                                                                  "points",
                                                                  "weights",
                                                                  "weighted_points",
                                                                  "material",
                                                                  "colours"};
constexpr std::string_view kPatchNames[] = {"", "a curve", "a surface", "a volume"};

template <std::size_t N>
Result<std::array<Axis, N>> read_axes(const Fields& fields) {
    std::array<Axis, N> axes;
    const std::string_view degree = N == 1 ? "degree" : "degrees";
    const auto whole = [](json::Value v) -> Result<int> {
        const auto p = read_int(v);
        if (p && *p < 0) return expected("a degree of at least 0", v);
        return p;
    };
    if (fields.has(degree)) {
        const auto d = fields.get(degree, [&](json::Value v) { return read_per_axis<N>(v, whole); });
        if (!d) return std::unexpected(d.error());
        for (std::size_t i = 0; i < N; ++i) axes[i].degree = (*d)[i];
    }
    if (fields.has("closed")) {
        const auto c = fields.get("closed", [&](json::Value v) { return read_per_axis<N>(v, read_bool); });
        if (!c) return std::unexpected(c.error());
        for (std::size_t i = 0; i < N; ++i) axes[i].closed = (*c)[i];
    }
    if (fields.has("knots")) {
        auto k = fields.get("knots", [&](json::Value v) { return read_per_axis<N>(v, read_numbers); });
        if (!k) return std::unexpected(k.error());
        for (std::size_t i = 0; i < N; ++i) axes[i].knots = std::move((*k)[i]);
    }
    return axes;
}

bool all_positive(const std::vector<double>& weights) {
    return std::all_of(weights.begin(), weights.end(), [](double w) { return w > 0; });
}

// Weights that are not positive are taken where the patch has no pole.
template <std::size_t N, class P>
Result<Patch<N, P>> make_patch(const std::array<BSplineBasis, N>& bases, Net<N, P> net) {
    if constexpr (Space<P>::kRational) {
        auto form = positive_weights<N, Space<P>::kDim>(bases, net);
        if (!form) return std::unexpected(form.error());
        return std::move(form->patch);
    } else {
        return Patch<N, P>::make(bases, std::move(net));
    }
}

}  // namespace

template <std::size_t N>
Result<ReadShape> read_patch(json::Value v) {
    const auto fields = Fields::read(v, kPatchNames[N], kPatchFields<N>);
    if (!fields) return std::unexpected(fields.error());
    const auto net = read_net<N>(*fields);
    if (!net) return std::unexpected(net.error());
    const auto axes = read_axes<N>(*fields);
    if (!axes) return std::unexpected(axes.error());

    std::vector<BSplineBasis> made;
    for (std::size_t d = 0; d < N; ++d) {
        const std::string index = N == 1 ? "" : text("[", d, "]");
        auto basis = make_basis((*axes)[d], net->points.extent[d], text(N == 1 ? "degree" : "degrees", index),
                                text("knots", index));
        if (!basis) return std::unexpected(basis.error());
        made.push_back(std::move(*basis));
    }
    const auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<BSplineBasis, N>{std::move(made[I])...};
    }
    (std::make_index_sequence<N>{});
    auto read = assemble(*net, [&]<class P>(std::vector<P> coefficients) {
        return make_patch(bases, Net<N, P>(net->points.extent, std::move(coefficients)));
    });
    // Points that were given are those of the patch unless knots had to be inserted or signs changed.
    if (read && net->weights && !all_positive(*net->weights)) read->given_points.clear();
    return read;
}

template Result<ReadShape> read_patch<1>(json::Value);
template Result<ReadShape> read_patch<2>(json::Value);
template Result<ReadShape> read_patch<3>(json::Value);

Result<ReadShape> read_triangle(json::Value v) {
    static constexpr std::string_view kFields[] = {
        "type", "name", "degree", "points", "weights", "weighted_points", "material", "colours"};
    const auto fields = Fields::read(v, "a triangle", kFields);
    if (!fields) return std::unexpected(fields.error());
    const auto net = read_net<1>(*fields);
    if (!net) return std::unexpected(net.error());
    const long long count = net->points.extent[0];
    int fitting = 0;
    while (fitting <= kMaxDegree && (fitting + 1) * (fitting + 2) / 2 < count) ++fitting;
    const auto degree = fields->get_or("degree", read_int, fitting);
    if (!degree) return std::unexpected(degree.error());
    if (*degree < 0 || *degree > kMaxDegree)
        return refuse(*degree < 0 ? RefusalKind::invalid : RefusalKind::unsupported, "degree",
                      text("degree ", *degree, " is outside 0..", kMaxDegree));
    if (const int wanted = (*degree + 1) * (*degree + 2) / 2; wanted != count)
        return refuse(RefusalKind::invalid, "points",
                      text(count, " points, a triangle of degree ", *degree, " has ", wanted));
    return assemble(*net, [&]<class P>(std::vector<P> coefficients) {
        return Triangle<P>::make(*degree, std::move(coefficients));
    });
}

namespace {

// `leaf(i)` writes entry i of the flat net.
template <std::size_t N, class Leaf>
void write_nested(json::Writer& w, const Index<N>& extent, Leaf&& leaf) {
    std::size_t i = 0;
    each_index(extent, [&](const Index<N>& at) {
        // A row begins where all inner indices are first, and ends where all are last.
        std::size_t begins = N, ends = N;
        while (begins > 0 && at[begins - 1] == 0) --begins;
        while (ends > 0 && at[ends - 1] == extent[ends - 1] - 1) --ends;
        for (std::size_t d = begins; d < N; ++d) w.begin_array();
        leaf(i++);
        for (std::size_t d = ends; d < N; ++d) w.end_array();
    });
}

// The shortest x of h / w and its neighbours with fl(w x) = h; nothing if there is none.
std::optional<double> point_of(double h, double w) {
    const double quotient = h / w, infinity = std::numeric_limits<double>::infinity();
    std::optional<double> best;
    std::size_t least = 0;
    for (const double x :
         {quotient, std::nextafter(quotient, -infinity), std::nextafter(quotient, infinity)}) {
        if (!std::isfinite(x) || !same_bits(w * x, h)) continue;
        const std::size_t length = text(x).size();
        if (best && length >= least) continue;
        best = x;
        least = length;
    }
    return best;
}

// The points of a rational net; sets `exact` to whether they and the weights give the coefficients back.
template <int D>
std::vector<double> points_of(std::span<const Hom<D>> net, std::span<const double> given, bool& exact) {
    std::vector<double> x(net.size() * std::size_t(D));
    exact = given.size() == x.size();
    for (std::size_t i = 0; i < x.size() && exact; ++i) {
        const Hom<D>& h = net[i / std::size_t(D)];
        exact = same_bits(h.weight() * given[i], h[int(i % std::size_t(D))]);
    }
    if (exact) return {given.begin(), given.end()};
    exact = true;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Hom<D>& p = net[i / std::size_t(D)];
        const double h = p[int(i % std::size_t(D))];
        const auto point = point_of(h, p.weight());
        exact = exact && point;
        x[i] = point.value_or(h / p.weight());
    }
    return x;
}

// The points, and of a rational net the weights.
template <std::size_t N, class P>
void write_net(json::Writer& w, const Index<N>& extent, std::span<const P> net,
               std::span<const double> given) {
    if constexpr (!Space<P>::kRational) {
        w.key("points");
        write_nested(w, extent, [&](std::size_t i) { w.array(net[i].c); });
    } else {
        constexpr auto kDim = std::size_t(Space<P>::kDim);
        bool exact = false;
        const std::vector<double> x = points_of(net, given, exact);
        w.key("points");
        write_nested(w, extent, [&](std::size_t i) { w.array(std::span(x).subspan(i * kDim, kDim)); });
        w.key("weights");
        write_nested(w, extent, [&](std::size_t i) { w.value(net[i].weight()); });
        if (exact) return;
        w.key("weighted_points");
        write_nested(w, extent, [&](std::size_t i) { w.array(std::span(net[i].c).first(kDim)); });
    }
}

}  // namespace

template <std::size_t N, class P>
void write_patch(json::Writer& w, const Patch<N, P>& patch, std::span<const double> given) {
    const auto per_axis = [&](std::string_view field, auto&& content) {
        w.key(field);
        if (N > 1) w.begin_array();
        for (std::size_t d = 0; d < N; ++d) content(patch.basis(int(d)));
        if (N > 1) w.end_array();
    };
    per_axis(N == 1 ? "degree" : "degrees", [&](const BSplineBasis& b) { w.value(b.degree()); });
    bool closed = false;
    for (const BSplineBasis& b : patch.bases()) closed = closed || b.is_closed();
    if (closed) per_axis("closed", [&](const BSplineBasis& b) { w.value(b.is_closed()); });
    per_axis("knots", [&](const BSplineBasis& b) { w.array(b.defining()); });

    write_net<N>(w, patch.net().extent(), patch.net().flat(), given);
}

template <class P>
void write_triangle(json::Writer& w, const Triangle<P>& triangle, std::span<const double> given) {
    w.field("degree", triangle.degree());
    write_net<1>(w, {int(triangle.coefficients().size())}, triangle.coefficients(), given);
}

#define FF_INSTANTIATE_WRITE(N, D)                                                              \
    template void write_patch(json::Writer&, const Patch<N, Vec<D>>&, std::span<const double>); \
    template void write_patch(json::Writer&, const Patch<N, Hom<D>>&, std::span<const double>);
#define FF_INSTANTIATE_WRITES(N) \
    FF_INSTANTIATE_WRITE(N, 1)   \
    FF_INSTANTIATE_WRITE(N, 2) FF_INSTANTIATE_WRITE(N, 3) FF_INSTANTIATE_WRITE(N, 4)
FF_INSTANTIATE_WRITES(1)
FF_INSTANTIATE_WRITES(2)
FF_INSTANTIATE_WRITES(3)
#define FF_INSTANTIATE_TRIANGLE(D)                                                                 \
    template void write_triangle(json::Writer&, const Triangle<Vec<D>>&, std::span<const double>); \
    template void write_triangle(json::Writer&, const Triangle<Hom<D>>&, std::span<const double>);
FF_INSTANTIATE_TRIANGLE(1)
FF_INSTANTIATE_TRIANGLE(2)
FF_INSTANTIATE_TRIANGLE(3)
FF_INSTANTIATE_TRIANGLE(4)

}  // namespace freiform::document_detail
