// Patches of a document: curves, surfaces and volumes, which differ in the number of nested arrays only.
//
// Rational patches. The document says points x and weights w, the patch holds h = fl(w x), or the product
// that the document gives as well (document_patch_write.cpp says when it does).
#include "document_detail.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/core/tuples.hpp>
#include <freiform/spline/weights.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

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

// points[i][j][c] of the flat index.
std::string point_name(std::size_t levels, const Index<3>& extent, std::size_t flat) {
    std::array<std::size_t, 3> at{};
    for (std::size_t d = levels; d-- > 0; flat /= std::size_t(extent[d]))
        at[d] = flat % std::size_t(extent[d]);
    std::string s;
    for (std::size_t d = 0; d < levels; ++d) s += text("[", at[d], "]");
    return s;
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

bool all_positive(const std::vector<double>& weights) {
    return std::all_of(weights.begin(), weights.end(), [](double w) { return w > 0; });
}

// How a patch differs from what was given.
struct Change {
    int inserted = 0;
    double moved = 0;
};

// Weights that are not positive are taken where the patch has no pole.
template <std::size_t N, class P>
Result<Patch<N, P>> make_patch(const std::array<BSplineBasis, N>& bases, Net<N, P> net, Change& change) {
    if constexpr (Space<P>::kRational) {
        auto form = positive_weights<N, Space<P>::kDim>(bases, net);
        if (!form) return std::unexpected(form.error());
        change = {form->inserted, form->bound};
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
    auto made = read_bases(*fields, N, net->points.extent);
    if (!made) return std::unexpected(made.error());
    const auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<BSplineBasis, N>{std::move((*made)[I])...};
    }
    (std::make_index_sequence<N>{});
    Change change;
    auto read = assemble(*net, [&]<class P>(std::vector<P> coefficients) {
        return make_patch(bases, Net<N, P>(net->template extent<N>(), std::move(coefficients)), change);
    });
    if (read) read->inserted = change.inserted, read->moved = change.moved;
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

}  // namespace freiform::document_detail
