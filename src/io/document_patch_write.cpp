// Patches of a document, written.
//
// Rational patches. The document says points x and weights w, the patch holds h = fl(w x). Written is, for
// each coordinate, the x with fl(w x) = h whose text is shortest among h / w and its neighbours. Not every h
// has such an x (then the products are written too, as `weighted_points`), so that reading gives the same
// bits in every case.
#include "document_detail.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

namespace freiform::document_detail {

namespace {

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

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
