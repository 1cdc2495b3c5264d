// Patches of a document: curves, surfaces and volumes, which differ in the number of nested arrays only.
//
// Rational patches. The document says points x and weights w, the patch holds h = fl(w x). Written is, for
// each coordinate, the x with fl(w x) = h whose text is shortest among h / w and its neighbours. Not every h
// has such an x (then the products are written too, as `weighted_points`), so that reading gives the same
// bits in every case.
#include "document_detail.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/core/tuples.hpp>
#include <freiform/spline/weights.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

namespace freiform::document_detail {

namespace {

// The nested arrays of a net with `levels` axes, in row-major order.
struct Nested {
    std::size_t levels;
    Index<3> extent{1, 1, 1};
    std::array<bool, 3> known{};
};
// Reads an entry and appends it.
using Leaf = std::function<Result<void>(json::Value)>;

Result<void> read_nested(json::Value v, std::size_t level, Nested& shape, const Leaf& leaf) {
    const std::size_t levels = shape.levels;
    if (!v.is(json::Kind::array))
        return expected(
            levels == 1 ? "an array" : text("an array (", levels - level, " more of ", levels, ")"), v);
    if (v.size() == 0) return refuse(RefusalKind::invalid, "", "is empty");
    if (!shape.known[level]) shape.extent[level] = int(v.size());
    if (shape.extent[level] != int(v.size()))
        return refuse(RefusalKind::invalid, "",
                      text("has ", v.size(), " entries, the rows before have ", shape.extent[level]));
    shape.known[level] = true;
    std::size_t i = 0;
    for (const json::Value element : v.elements()) {
        auto ok = level + 1 == levels ? leaf(element) : read_nested(element, level + 1, shape, leaf);
        if (!ok) return refuse_within(text("[", i, "]"), ok.error());
        ++i;
    }
    return {};
}

struct Points {
    Index<3> extent{};
    int dim = 0;
    std::vector<double> flat;
};

Result<Points> read_points(json::Value v, std::size_t levels) {
    Points p;
    Nested shape{levels};
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
    if (auto ok = read_nested(v, 0, shape, leaf); !ok) return std::unexpected(ok.error());
    p.extent = shape.extent;
    return p;
}

Result<std::vector<double>> read_weights(json::Value v, std::size_t levels, const Index<3>& extent) {
    std::vector<double> flat;
    Nested shape{levels};
    const auto leaf = [&](json::Value weight) -> Result<void> {
        const auto w = read_number(weight);
        if (!w) return std::unexpected(w.error());
        flat.push_back(*w);
        return {};
    };
    if (auto ok = read_nested(v, 0, shape, leaf); !ok) return std::unexpected(ok.error());
    for (std::size_t d = 0; d < levels; ++d)
        if (shape.extent[d] != extent[d])
            return refuse(RefusalKind::invalid, "",
                          text(shape.extent[d], " weights", levels == 1 ? "" : text(" along axis ", d),
                               " for ", extent[d], " points"));
    return flat;
}

struct ReadNet {
    std::size_t levels = 1;
    Points points;
    std::optional<std::vector<double>> weights;
    std::optional<Points> products;  // of points and weights

    template <std::size_t N>
    Index<N> extent() const {
        Index<N> e{};
        std::copy_n(points.extent.begin(), N, e.begin());
        return e;
    }
};

// One array per axis; of a curve the array itself.
template <class Read>
auto read_per_axis(std::size_t axes, json::Value v, Read&& read)
    -> Result<std::vector<typename decltype(read(std::declval<json::Value>()))::value_type>> {
    if (axes == 1) {
        auto one = read(v);
        if (!one) return std::unexpected(one.error());
        std::vector<typename decltype(read(std::declval<json::Value>()))::value_type> list;
        list.push_back(std::move(*one));
        return list;
    }
    if (!v.is(json::Kind::array) || v.size() != axes)
        return expected(text("an array of ", axes, ", one entry per parameter"), v);
    return read_list(v, read);
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
std::string point_name(std::size_t levels, const Index<3>& extent, std::size_t flat) {
    std::array<std::size_t, 3> at{};
    for (std::size_t d = levels; d-- > 0; flat /= std::size_t(extent[d]))
        at[d] = flat % std::size_t(extent[d]);
    std::string s;
    for (std::size_t d = 0; d < levels; ++d) s += text("[", at[d], "]");
    return s;
}

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

// Whether h is the product of x and w, or x the quotient of h and w: one rounding either way. A point at
// infinity (weight 0) is given by its direction h, for which x stands in.
bool agree(double x, double w, double h) { return w * x == h || (w == 0 ? x == h : h / w == x); }

// The coefficients of a rational net, tuple after tuple.
Result<std::vector<double>> rational_net(const ReadNet& in) {
    const Points& p = in.points;
    const std::size_t dim = std::size_t(p.dim);
    std::vector<double> net;
    for (std::size_t k = 0; k < p.flat.size(); ++k) {
        const std::size_t i = k / dim, c = k % dim;
        const double w = (*in.weights)[i], x = p.flat[k], h = in.products ? in.products->flat[k] : w * x;
        const auto place = [&](std::string_view field) {
            return text(field, point_name(in.levels, p.extent, i), "[", c, "]");
        };
        if (!std::isfinite(h) || (w != 0 && !std::isfinite(h / w)))
            return refuse(RefusalKind::nonfinite, place("points"),
                          text(x, " times its weight ", w, " leaves the range of double"));
        if (!agree(x, w, h))
            return refuse(RefusalKind::invalid, place("weighted_points"),
                          text(h, " is not the point ", x, " times its weight ", w));
        net.push_back(h);
        if (c + 1 == dim) net.push_back(w);
    }
    return net;
}

// "points[7]", counted through the net, as "points[1][3]".
Refusal nested(Refusal r, const ReadNet& in) {
    // Numbers too large or too small to calculate with are no limit on effort.
    if (r.kind == RefusalKind::limit || r.kind == RefusalKind::ill_conditioned)
        r.kind = RefusalKind::unsupported;
    const std::size_t open = r.where.find('['), close = r.where.find(']');
    if (open == std::string::npos || close == std::string::npos) return r;
    const auto flat = scan_number<std::size_t>(std::string_view(r.where).substr(open + 1, close - open - 1));
    if (flat)
        r.where = text(r.where.substr(0, open), point_name(in.levels, in.points.extent, *flat),
                       r.where.substr(close + 1));
    return r;
}

// Coefficients handed to `make`, as those of the dimension that the points have.
template <class P, class Make>
Result<ReadShape> assemble_as(const ReadNet& in, const std::vector<double>& all, Make&& make) {
    std::vector<P> coefficients(all.size() / std::size_t(P::kCoords));
    std::ranges::copy(all, numbers(std::span(coefficients)).begin());
    auto patch = make(std::move(coefficients));
    if (!patch) return std::unexpected(nested(patch.error(), in));
    return ReadShape{std::move(*patch), in.weights ? in.points.flat : std::vector<double>()};
}
template <template <int> class P, class Make>
Result<ReadShape> assemble_in(const ReadNet& in, const std::vector<double>& all, Make&& make) {
    switch (in.points.dim) {
        case 1:
            return assemble_as<P<1>>(in, all, make);
        case 2:
            return assemble_as<P<2>>(in, all, make);
        case 3:
            return assemble_as<P<3>>(in, all, make);
        default:
            return assemble_as<P<4>>(in, all, make);
    }
}
// Points, weights and products as one of the two kinds of net.
template <class Make>
Result<ReadShape> assemble(const ReadNet& in, Make&& make) {
    if (!in.weights) return assemble_in<Vec>(in, in.points.flat, make);
    const auto net = rational_net(in);
    if (!net) return std::unexpected(net.error());
    return assemble_in<Hom>(in, *net, make);
}

Result<ReadNet> read_net(const Fields& fields, std::size_t levels) {
    ReadNet net;
    net.levels = levels;
    const auto of_levels = [&](json::Value v) { return read_points(v, levels); };
    auto points = fields.get("points", of_levels);
    if (!points) return std::unexpected(points.error());
    net.points = std::move(*points);
    if (fields.has("weights")) {
        auto w =
            fields.get("weights", [&](json::Value x) { return read_weights(x, levels, net.points.extent); });
        if (!w) return std::unexpected(w.error());
        net.weights = std::move(*w);
    }
    if (fields.has("weighted_points")) {
        if (!net.weights) return refuse(RefusalKind::invalid, "weighted_points", "needs weights");
        auto p = fields.get("weighted_points", of_levels);
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

Result<std::array<Axis, 3>> read_axes(const Fields& fields, std::size_t n) {
    std::array<Axis, 3> axes;
    const std::string_view degree = n == 1 ? "degree" : "degrees";
    const auto whole = [](json::Value v) -> Result<int> {
        const auto p = read_int(v);
        if (p && *p < 0) return expected("a degree of at least 0", v);
        return p;
    };
    if (fields.has(degree)) {
        const auto d = fields.get(degree, [&](json::Value v) { return read_per_axis(n, v, whole); });
        if (!d) return std::unexpected(d.error());
        for (std::size_t i = 0; i < n; ++i) axes[i].degree = (*d)[i];
    }
    if (fields.has("closed")) {
        const auto c = fields.get("closed", [&](json::Value v) { return read_per_axis(n, v, read_bool); });
        if (!c) return std::unexpected(c.error());
        for (std::size_t i = 0; i < n; ++i) axes[i].closed = (*c)[i];
    }
    if (fields.has("knots")) {
        auto k = fields.get("knots", [&](json::Value v) { return read_per_axis(n, v, read_numbers); });
        if (!k) return std::unexpected(k.error());
        for (std::size_t i = 0; i < n; ++i) axes[i].knots = std::move((*k)[i]);
    }
    return axes;
}

Result<std::vector<BSplineBasis>> read_bases(const Fields& fields, const ReadNet& net) {
    const auto axes = read_axes(fields, net.levels);
    if (!axes) return std::unexpected(axes.error());
    std::vector<BSplineBasis> made;
    for (std::size_t d = 0; d < net.levels; ++d) {
        const std::string index = net.levels == 1 ? "" : text("[", d, "]");
        auto basis = make_basis((*axes)[d], net.points.extent[d],
                                text(net.levels == 1 ? "degree" : "degrees", index), text("knots", index));
        if (!basis) return std::unexpected(basis.error());
        made.push_back(std::move(*basis));
    }
    return made;
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
    const auto net = read_net(*fields, N);
    if (!net) return std::unexpected(net.error());
    auto made = read_bases(*fields, *net);
    if (!made) return std::unexpected(made.error());
    const auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<BSplineBasis, N>{std::move((*made)[I])...};
    }
    (std::make_index_sequence<N>{});
    auto read = assemble(*net, [&]<class P>(std::vector<P> coefficients) {
        return make_patch(bases, Net<N, P>(net->template extent<N>(), std::move(coefficients)));
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
    const auto net = read_net(*fields, 1);
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

// `leaf(i)` writes entry i of the flat net of `levels` axes.
void write_nested(json::Writer& w, std::size_t levels, const Index<3>& extent,
                  const std::function<void(std::size_t)>& leaf) {
    std::size_t i = 0;
    each_index(extent, [&](const Index<3>& at) {
        // A row begins where all inner indices are first, and ends where all are last.
        std::size_t begins = levels, ends = levels;
        while (begins > 0 && at[begins - 1] == 0) --begins;
        while (ends > 0 && at[ends - 1] == extent[ends - 1] - 1) --ends;
        for (std::size_t d = begins; d < levels; ++d) w.begin_array();
        leaf(i++);
        for (std::size_t d = ends; d < levels; ++d) w.end_array();
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
std::vector<double> points_of(const Tuples& net, std::span<const double> given, bool& exact) {
    const std::size_t dim = std::size_t(net.dim());
    std::vector<double> x(net.count() * dim);
    exact = given.size() == x.size();
    for (std::size_t i = 0; i < x.size() && exact; ++i)
        exact = same_bits(net.weight(i / dim) * given[i], net[i / dim][i % dim]);
    if (exact) return {given.begin(), given.end()};
    exact = true;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double h = net[i / dim][i % dim], w = net.weight(i / dim);
        const auto point = point_of(h, w);
        exact = exact && point;
        x[i] = point.value_or(h / w);
    }
    return x;
}

// The points, and of a rational net the weights.
void write_net(json::Writer& w, std::size_t levels, const Index<3>& extent, const Tuples& net,
               std::span<const double> given) {
    const std::size_t dim = std::size_t(net.dim());
    bool exact = true;
    std::vector<double> own;
    if (net.rational) own = points_of(net, given, exact);
    const std::span<const double> x = net.rational ? std::span<const double>(own) : net.all;
    w.key("points");
    write_nested(w, levels, extent, [&](std::size_t i) { w.array(x.subspan(i * dim, dim)); });
    if (!net.rational) return;
    w.key("weights");
    write_nested(w, levels, extent, [&](std::size_t i) { w.value(net.weight(i)); });
    if (exact) return;
    w.key("weighted_points");
    write_nested(w, levels, extent, [&](std::size_t i) { w.array(std::span(net[i], dim)); });
}

}  // namespace

void write_tensor(json::Writer& w, std::span<const BSplineBasis> bases, const Tuples& net,
                  std::span<const double> given) {
    const std::size_t n = bases.size();
    const auto per_axis = [&](std::string_view field,
                              const std::function<void(const BSplineBasis&)>& content) {
        w.key(field);
        if (n > 1) w.begin_array();
        for (const BSplineBasis& b : bases) content(b);
        if (n > 1) w.end_array();
    };
    per_axis(n == 1 ? "degree" : "degrees", [&](const BSplineBasis& b) { w.value(b.degree()); });
    bool closed = false;
    for (const BSplineBasis& b : bases) closed = closed || b.is_closed();
    if (closed) per_axis("closed", [&](const BSplineBasis& b) { w.value(b.is_closed()); });
    per_axis("knots", [&](const BSplineBasis& b) { w.array(b.defining()); });
    Index<3> extent{1, 1, 1};
    for (std::size_t d = 0; d < n; ++d) extent[d] = bases[d].size();
    write_net(w, n, extent, net, given);
}

void write_triangle(json::Writer& w, int degree, const Tuples& net, std::span<const double> given) {
    w.field("degree", degree);
    write_net(w, 1, {int(net.count()), 1, 1}, net, given);
}

}  // namespace freiform::document_detail
