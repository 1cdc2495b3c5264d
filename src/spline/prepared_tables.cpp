// Tables for the evaluation of many points.
//
// Idea. On a span [a, b] with t = (x - a) / (b - a) the basis functions are combinations of Bernstein
// polynomials, N_i = sum_k e_ik B_k(t), e_ik >= 0: row i of Bezier extraction, the weights of the blossom at
// (a, .., a, b, .., b). With r = t / (1 - t) that is (1 - t)^p sum_k C(p, k) e_ik r^k, by Horner's rule: one
// product and one sum for a coefficient, all of them non-negative. Where t > 1/2 the two ends change places,
// so that r <= 1. The coefficients are made once, in doubled precision, for both halves of every span;
// vectors of parameters compute r side by side, without the divisions of the recurrence. What is rational
// needs no powers of 1 - t: they cancel. Derivatives: differences of the e_ik, and since 1 - t is far / (b -
// a), with `far` the distance to the farther end, a power of 1 / far. Of a curve, the coefficients are
// multiplied in, and what is left is its Bezier pieces.
//
// Why not: powers of x - a need no quotient, but their terms have both signs and add up to as much as 2^p.
//
// Accuracy: prepared_bounds.cpp.
//
// References: [Borden et al. 2011] extraction.
#include "coefficients_detail.hpp"
#include "prepared_detail.hpp"

#include <freiform/basis/blossom.hpp>
#include <freiform/core/double_double.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freiform::detail {

namespace {

// The knots of one basis, for blossom().
struct Knots {
    const BSplineBasis& basis;
    int degree() const { return basis.degree(); }
    double knot(int i) const { return basis.knot(i); }
};

// Looks up spans by `buckets` equal parts of the domain; returns how far a lookup may be off, in spans.
int put_buckets(AxisTable& table, std::size_t buckets) {
    kernel::Axis& a = table.axis;
    const std::size_t spans = std::size_t(a.spans);
    a.buckets = int(buckets);
    a.scale = a.buckets / (table.span(spans - 1).hi - a.lo);
    // The same expression as in the kernels, which is monotone; so a parameter at or above the start of a
    // span is in its bucket or a later one.
    const auto bucket_of = [&](double x) { return std::min(int((x - a.lo) * a.scale), a.buckets - 1); };
    table.bucket.assign(buckets, 0);
    int most = 0;
    for (std::size_t s = 0, b = 0; b < buckets; ++b) {
        while (s + 1 < spans && bucket_of(table.span(s + 1).lo) < int(b)) ++s;
        table.bucket[b] = int(s * (a.stride / kernel::Axis::kLine));
        int more = 0;
        while (s + std::size_t(more) + 1 < spans &&
               bucket_of(table.span(s + std::size_t(more) + 1).lo) <= int(b))
            ++more;
        most = std::max(most, more);
    }
    return most;
}

// As few buckets as leave one step, since they share the cache with the coefficients; if that takes too many,
// the number of steps is rounded up to 2^k - 1.
void make_search(AxisTable& table) {
    kernel::Axis& a = table.axis;
    const std::size_t spans = std::size_t(a.spans), limit = std::size_t(1) << 20;
    const std::size_t end = std::min(std::max(std::min<std::size_t>(64 * spans, 2048), 8 * spans), limit);
    a.lo = table.span(0).lo;
    std::size_t buckets = std::min(2 * spans, end);
    int most = put_buckets(table, buckets);
    while (most > 1 && buckets < end) most = put_buckets(table, buckets = std::min(2 * buckets, end));
    while (a.steps < most) a.steps = 2 * a.steps + 1;
    const double infinity = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s + 1 < spans; ++s) table.span(s).next = table.span(s + 1).lo;
    table.span(spans - 1).next = infinity;
    table.records.resize((spans + std::size_t(a.steps)) * a.stride, 0);
    for (std::size_t s = spans; s < spans + std::size_t(a.steps); ++s) table.span(s).next = infinity;
}

// C(degree, k)
double binomial(int degree, int k) {
    double c = 1;
    for (int i = 0; i < k; ++i) c = c * (degree - i) / (i + 1);
    return c;
}

// The columns of one order, from its coefficients of Bernstein polynomials, for both halves of a span.
void put_columns(const std::vector<DoubleDouble>& column, int count, int lanes, double* left, double* right) {
    for (int k = count - 1; k >= 0; --k) {
        const DoubleDouble factor(binomial(count - 1, k));
        for (int i = 0; i < lanes; ++i) {
            *left++ = (factor * column[std::size_t(k * lanes + i)]).rounded();
            *right++ = (factor * column[std::size_t((count - 1 - k) * lanes + i)]).rounded();
        }
    }
}

}  // namespace

AxisTable make_axis(const BSplineBasis& basis, std::span<const double> curve, int lanes) {
    AxisTable table{basis, {}, {}, {}};
    const int p = basis.degree(), end = int(basis.knots().size()) - p - 1;
    std::vector<int> spans;
    for (int s = p; s < end; ++s)
        if (basis.knot(s) < basis.knot(s + 1)) spans.push_back(s);
    kernel::Axis& a = table.axis;
    a.degree = p;
    a.spans = int(spans.size());
    a.lanes = lanes;
    const std::size_t numbers = std::size_t(a.columns(0) + a.columns(1) + a.columns(2)) * std::size_t(lanes);
    a.half = (numbers + kernel::Axis::kLine - 1) / kernel::Axis::kLine * kernel::Axis::kLine;
    a.stride = kernel::Axis::kLine + 2 * a.half;
    table.records.assign(a.stride * spans.size(), 0);
    for (std::size_t s = 0; s < spans.size(); ++s) {
        const double lo = basis.knot(spans[s]), hi = basis.knot(spans[s] + 1);
        const double inverse = (DoubleDouble(1) / (DoubleDouble(hi) - DoubleDouble(lo))).rounded();
        table.span(s) = {lo, hi, inverse, 0, 0, spans[s] - p};
    }
    make_search(table);

    std::vector<DoubleDouble> args(std::size_t(std::max(p, 1))), weights(std::size_t(p) + 1);
    std::vector<DoubleDouble> column(std::size_t((p + 1) * lanes));
    for (std::size_t s = 0; s < std::size_t(a.spans); ++s) {
        const kernel::Span& span = table.span(s);
        std::ranges::fill(column, DoubleDouble());
        for (int k = 0; k <= p; ++k) {
            for (int i = 0; i < p; ++i) args[std::size_t(i)] = i < p - k ? span.lo : span.hi;
            blossom(Knots{basis}, span.first + p, args.data(), weights.data());
            DoubleDouble* to = &column[std::size_t(k * lanes)];
            for (int i = 0; i <= p; ++i) {
                if (curve.empty()) {
                    to[i] = weights[std::size_t(i)];
                    continue;
                }
                const double* from =
                    curve.data() + std::size_t((span.first + i) % basis.size()) * std::size_t(lanes);
                for (int c = 0; c < lanes; ++c) to[c] += weights[std::size_t(i)] * DoubleDouble(from[c]);
            }
        }
        double* to = &table.records[s * a.stride + kernel::Axis::kLine];
        for (int order = 0; order <= kernel::kMaxOrder && order <= p; ++order) {
            const int count = a.columns(order);
            for (int i = 0; order > 0 && i < count * lanes; ++i)
                column[std::size_t(i)] =
                    DoubleDouble(count) * (column[std::size_t(i + lanes)] - column[std::size_t(i)]);
            put_columns(column, count, lanes, to + a.column(order), to + a.half + a.column(order));
        }
    }
    return table;
}

kernel::Axis AxisTable::view() const {
    kernel::Axis a = axis;
    a.record = records.data();
    a.bucket = bucket.data();
    return a;
}

kernel::Net PreparedNet::Tables::view() const {
    kernel::Net n = net;
    for (std::size_t d = 0; d < axis.size(); ++d) n.axis[d] = axis[d].view();
    n.coefficients = coefficients.data();
    return n;
}

bool PreparedNet::Tables::any_closed() const {
    return std::ranges::any_of(axis, [](const AxisTable& a) { return a.basis.is_closed(); });
}

namespace {

// What PreparedPatch::make promises about sizes.
constexpr double kLargestNumber = 0x1p100, kLeastNumber = 0x1p-100;
Result<void> check_span_range(std::span<const BSplineBasis> bases) {
    for (std::size_t d = 0; d < bases.size(); ++d) {
        const auto knots = bases[d].knots();
        for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
            const double width = knots[i + 1] - knots[i];
            if (width != 0 && !(width >= kLeastNumber && width <= kLargestNumber))
                return refuse(RefusalKind::unsupported, text("bases[", d, "].knots[", i, "]"),
                              text("a span of length ", width, " is outside 2^-100 .. 2^100"));
        }
    }
    return {};
}

// One coefficient in its place of 4 numbers, or of 8 where there are four coordinates and a weight.
void place(const Tuples& net, std::size_t i, double* first, double* second) {
    const int dim = net.dim();
    for (int c = 0; c < dim; ++c) first[c] = net[i][c];
    if (net.rational) (dim == 4 ? second : first)[3] = net.weight(i);
}

}  // namespace

Result<void> check_net_range(const Tuples& net) {
    for (std::size_t i = 0; i < net.all.size(); ++i)
        if (!(std::abs(net.all[i]) <= kLargestNumber))
            return refuse(RefusalKind::unsupported, text("points[", i / std::size_t(net.size), "]"),
                          text("a coefficient ", net.all[i], " is above 2^100"));
    for (std::size_t i = 0; net.rational && i < net.count(); ++i)
        if (!(net.weight(i) >= kLeastNumber))
            return refuse(RefusalKind::unsupported, text("weights[", i, "]"),
                          text("a weight ", net.weight(i), " is below 2^-100"));
    return {};
}

void put_coefficients(const PreparedNet::Tables& t, const Tuples& net, double* coefficients) {
    each_index(t.extent, [&, to = std::size_t(0)](const Index<3>& at) mutable {
        std::size_t from = 0;
        for (std::size_t d = 0; d < 3; ++d)
            from = from * std::size_t(t.size[d]) + std::size_t(at[d] % t.size[d]);
        place(net, from, coefficients + to, coefficients + to + t.net.plane);
        to += 4;
    });
}

Result<PreparedNet> PreparedNet::make(std::span<const BSplineBasis> bases, const Tuples& net) {
    if (auto ok = check_span_range(bases); !ok) return std::unexpected(ok.error());
    if (auto ok = check_net_range(net); !ok) return std::unexpected(ok.error());
    auto tables = std::make_shared<Tables>();
    kernel::Net& n = tables->net;
    n.axes = int(bases.size());
    n.dim = net.dim();
    n.rational = net.rational;
    const int lanes = 4 * n.planes();
    tables->errors = batch_error_bounds(bases, net);
    if (bases.size() == 1) {
        std::vector<double> curve(net.count() * std::size_t(lanes), 0.0);
        for (std::size_t i = 0; i < net.count(); ++i)
            place(net, i, &curve[i * std::size_t(lanes)],
                  &curve[i * std::size_t(lanes) + std::size_t(lanes) - 4]);
        tables->axis.push_back(make_axis(bases[0], curve, lanes));
        tables->ready = tables->view();
        return PreparedNet(std::move(tables));
    }
    Index<3>&extent = tables->extent, &size = tables->size;
    const std::size_t skip = 3 - bases.size();
    for (std::size_t d = 0; d < bases.size(); ++d) {
        tables->axis.push_back(make_axis(bases[d], {}, (bases[d].degree() + 4) / 4 * 4));
        extent[skip + d] = int(bases[d].knots().size()) - bases[d].degree() - 1;
        size[skip + d] = bases[d].size();
    }
    for (std::size_t d = bases.size(), stride = 4; d-- > 0;) {
        n.stride[d] = stride;
        AxisTable& table = tables->axis[d];
        for (std::size_t s = 0; s < std::size_t(table.axis.spans); ++s)
            table.span(s).coefficients = std::size_t(table.span(s).first) * stride;
        stride *= std::size_t(extent[skip + d]);
    }
    // Unwinding a closed net may repeat it; what comes out must still be counted by an int.
    if (count_of(extent) < 0)
        return refuse(RefusalKind::limit, "points", "the net has more than 2^31 coefficients when unwound");
    const std::size_t all = std::size_t(count_of(extent)) * 4;
    n.plane = n.planes() == 2 ? all + 8 : 0;
    tables->coefficients.assign(n.plane + all + 8, 0.0);
    put_coefficients(*tables, net, tables->coefficients.data());
    tables->ready = tables->view();
    return PreparedNet(std::move(tables));
}

}  // namespace freiform::detail
