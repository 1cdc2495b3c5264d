// Evaluation of many points with the kernels: checks, pieces of the batch, grids.
#include "coefficients_detail.hpp"
#include "prepared_detail.hpp"

#include <freiform/core/parallel.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freiform {

std::string_view instruction_set() { return kernel::kernels().name; }

namespace detail {

namespace {

using kernel::kernels;
using Tables = PreparedNet::Tables;

constexpr std::size_t kChunk = 4096;  // points that one thread takes at once
// What does not stay in the cache goes past it: a store would first read what it overwrites.
constexpr std::size_t kPastFrom = std::size_t(4) << 20;  // bytes
constexpr std::size_t kChunksFrom = PreparedPatch<1, Vec<1>>::kParallelFrom / kChunk;

bool is_good(const BSplineBasis& basis, double x) {
    return std::isfinite(x) && (basis.is_closed() || basis.domain().contains(x));
}

// Whether all parameters may be handed to the kernels as they are.
bool all_inside(const Tables& t, std::span<const double> at) {
    double lo[3], hi[3];
    for (std::size_t d = 0; d < t.axis.size(); ++d) {
        const Interval on = t.axis[d].basis.domain();
        lo[d] = on.lo, hi[d] = on.hi;
    }
    return kernels().inside(at.data(), at.size(), int(t.axis.size()), lo, hi);
}

// The refusal of the first parameter that is not good, if there is one.
Result<void> check(const Tables& t, std::span<const double> at) {
    const std::size_t axes = t.axis.size();
    for (std::size_t i = 0; i < at.size(); ++i) {
        const BSplineBasis& basis = t.axis[i % axes].basis;
        if (!is_good(basis, at[i]))
            return bad_parameter(at[i], basis.domain(), "at", i / axes,
                                 axes == 1 ? -1 : std::ptrdiff_t(i % axes));
    }
    return {};
}

// f(first, count) for pieces of n points, on several threads if there are many. Where pieces begin does not
// depend on the threads.
void in_chunks(std::size_t n, const std::function<void(std::size_t, std::size_t)>& f) {
    if (n < PreparedPatch<1, Vec<1>>::kParallelFrom) {
        for (std::size_t i = 0; i < n; i += kChunk) f(i, std::min(kChunk, n - i));
        return;
    }
    parallel_for((n + kChunk - 1) / kChunk, kChunksFrom / 2,
                 [&](std::size_t i) { f(i * kChunk, std::min(kChunk, n - i * kChunk)); });
}

// Parameters that the kernels can take: good ones, of closed axes wrapped, bad ones replaced.
void make_good(const Tables& t, std::span<const double> at, std::vector<double>& good,
               std::vector<char>& bad) {
    const std::size_t axes = t.axis.size();
    good.assign(at.begin(), at.end());
    bad.assign(at.size() / axes, 0);
    for (std::size_t i = 0; i < at.size(); ++i) {
        const BSplineBasis& basis = t.axis[i % axes].basis;
        if (is_good(basis, at[i])) {
            good[i] = basis.wrap(at[i]);
        } else {
            good[i] = basis.domain().lo;
            bad[i / axes] = 1;
        }
    }
}

// Evaluates one piece. `wrapped`: its parameters have to be looked at one by one.
void evaluate_chunk(const Tables& t, const kernel::Net& net, std::span<const double> at, bool wrapped,
                    const kernel::Output& out) {
    const std::size_t axes = t.axis.size(), n = at.size() / axes;
    if (!wrapped) {
        kernels().scattered(net, at.data(), n, out);
        if (out.past) kernels().flush();
        return;
    }
    std::vector<double> good;
    std::vector<char> bad;
    make_good(t, at, good, bad);
    kernels().scattered(net, good.data(), n, out);
    if (out.past) kernels().flush();
    const std::size_t size = std::size_t(out.slots * net.dim);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < n; ++i) {
        if (!bad[i]) continue;
        std::fill_n(out.jets + i * size, size, nan);
        if (out.normals) std::fill_n(out.normals + 3 * i, 3, nan);
    }
}

// The weights of the outer axes of a grid: lanes numbers for each parameter and order.
struct OuterAxis {
    std::vector<double> weights;
    std::vector<int> first;
};
OuterAxis outer_axis(const kernel::Axis& axis, std::span<const double> at, int order) {
    OuterAxis a{std::vector<double>(at.size() * std::size_t((order + 1) * axis.lanes)),
                std::vector<int>(at.size())};
    kernels().weights(axis, at.data(), at.size(), order, a.weights.data(), a.first.data());
    return a;
}

struct LastAxis {
    std::vector<kernel::GridPart> part;
    Lines weights;
    kernel::GridAxis view;
};
LastAxis last_axis(const kernel::Axis& axis, std::span<const double> at, int order) {
    const OuterAxis all = outer_axis(axis, at, order);
    LastAxis a;
    const int width = kernels().width, n = int(at.size());
    a.view = {n, axis.degree, width, order, 0, nullptr, nullptr};
    const std::size_t lanes = std::size_t(axis.lanes), stride = a.view.stride();
    for (int g = 0; g * width < n; ++g) {
        const std::size_t begin = a.part.size();
        for (int i = g * width; i < std::min(n, (g + 1) * width); ++i) {
            const int first = all.first[std::size_t(i)];
            std::size_t k = begin;
            while (k < a.part.size() && a.part[k].first != first) ++k;
            if (k == a.part.size()) {
                a.part.push_back({g, first});
                a.weights.resize(a.weights.size() + stride, 0.0);
            }
            double* to = &a.weights[k * stride] + i % width;
            for (int o = 0; o <= order; ++o) {
                const double* from =
                    &all.weights[(std::size_t(i) * std::size_t(order + 1) + std::size_t(o)) * lanes];
                for (int j = 0; j <= axis.degree; ++j, to += width) *to = from[j];
            }
        }
        // Lanes behind the end repeat the last parameter, so that no weight is 0 there.
        for (std::size_t k = begin; k < a.part.size(); ++k)
            if (n % width != 0 && (g + 1) * width > n && a.part[k].first == all.first.back())
                for (std::size_t r = 0; r < stride; r += std::size_t(width))
                    for (int i = n % width; i < width; ++i)
                        a.weights[k * stride + r + std::size_t(i)] =
                            a.weights[k * stride + r + std::size_t(n % width - 1)];
    }
    a.view.parts = int(a.part.size());
    return a;
}

}  // namespace

Result<void> PreparedNet::evaluate(std::span<const double> at, int order, std::size_t slots, double* jets,
                                   double* normals, Outside outside) const {
    const Tables& t = *tables_;
    const std::size_t axes = t.axis.size();
    const bool plain = all_inside(t, at);
    if (!plain && outside == Outside::refuse)
        if (auto ok = check(t, at); !ok) return ok;
    const kernel::Net net = t.view();
    const std::size_t numbers = at.size() / axes * (slots * std::size_t(net.dim) + (normals ? 3 : 0));
    const bool past = numbers * sizeof(double) > kPastFrom;
    in_chunks(at.size() / axes, [&](std::size_t first, std::size_t count) {
        evaluate_chunk(t, net, at.subspan(first * axes, count * axes), !plain,
                       {order, int(slots), jets + first * slots * std::size_t(net.dim),
                        normals ? normals + 3 * first : nullptr, past});
    });
    return {};
}

Result<void> PreparedNet::evaluate_single(std::span<const double> at, float* points, Outside outside) const {
    const Tables& t = *tables_;
    const std::size_t axes = t.axis.size(), dim = std::size_t(t.net.dim);
    const bool plain = all_inside(t, at);
    if (!plain && outside == Outside::refuse)
        if (auto ok = check(t, at); !ok) return ok;
    const kernel::Net net = t.view();
    in_chunks(at.size() / axes, [&](std::size_t first, std::size_t count) {
        double some[512 * 4];
        for (std::size_t i = first; i < first + count; i += 512) {
            const std::size_t n = std::min<std::size_t>(512, first + count - i);
            evaluate_chunk(t, net, at.subspan(i * axes, n * axes), !plain, {0, 1, some, nullptr, false});
            for (std::size_t k = 0; k < n * dim; ++k) points[i * dim + k] = float(some[k]);
        }
    });
    return {};
}

Result<void> PreparedNet::evaluate_grid(std::span<const std::span<const double>> axes, int order,
                                        std::size_t slots, double* jets, double* normals) const {
    const Tables& t = *tables_;
    const std::size_t n = t.axis.size();
    std::vector<std::vector<double>> wrapped(n);
    std::size_t rows = 1;
    for (std::size_t d = 0; d < n; ++d) {
        const BSplineBasis& basis = t.axis[d].basis;
        if (auto ok = check_axis(axes[d], basis.domain(), basis.is_closed(), d); !ok) return ok;
        for (const double x : axes[d]) wrapped[d].push_back(basis.wrap(x));
        if (d + 1 < n) rows *= axes[d].size();
        if (axes[d].size() > std::size_t(std::numeric_limits<int>::max()))
            return refuse(RefusalKind::limit, text("axes[", d, "]"), "more than 2^31 - 1 parameters");
        if (axes[d].empty()) rows = 0;
    }
    if (rows == 0) return {};
    if (n == 1) return evaluate(wrapped[0], order, slots, jets, normals, Outside::refuse);

    const kernel::Net net = t.view();
    const std::size_t count = axes[n - 1].size(), size = slots * std::size_t(net.dim);
    const LastAxis last = last_axis(net.axis[n - 1], wrapped[n - 1], order);
    std::vector<OuterAxis> outer;
    for (std::size_t d = 0; d + 1 < n; ++d) outer.push_back(outer_axis(net.axis[d], wrapped[d], order));
    const auto orders = n == 2 ? std::vector<Index<2>>() : jet_orders<2>(order);
    const std::size_t combinations = n == 2 ? std::size_t(order) + 1 : orders.size();
    const std::size_t along =
        std::size_t(t.axis[n - 1].basis.knots().size()) - std::size_t(t.axis[n - 1].basis.degree()) - 1;
    const std::size_t planes = std::size_t(net.planes()), row = planes * along * 4;
    kernel::GridAxis view = last.view;
    view.part = last.part.data();
    view.weights = last.weights.data();
    const bool past = rows * count * (size + (normals ? 3 : 0)) * sizeof(double) > kPastFrom;
    const auto do_rows = [&](std::size_t begin, std::size_t end) {
        Lines sums(combinations * row + 8);
        std::vector<double> w;
        std::vector<const double*> from;
        const auto contract = [&](const Index<2>& at, const Index<2>& o, std::size_t c) {
            w.clear(), from.clear();
            const double* base = net.coefficients;
            const double* weights[2] = {};
            for (std::size_t d = 0; d + 1 < n; ++d) {
                const std::size_t lanes = std::size_t(net.axis[d].lanes), i = std::size_t(at[d]);
                weights[d] = &outer[d].weights[(i * std::size_t(order + 1) + std::size_t(o[d])) * lanes];
                base += std::size_t(outer[d].first[i]) * net.stride[d];
            }
            for (int r = 0; r <= net.axis[0].degree; ++r)
                for (int m = 0; m <= (n == 3 ? net.axis[1].degree : 0); ++m) {
                    w.push_back(n == 3 ? weights[0][r] * weights[1][m] : weights[0][r]);
                    from.push_back(base + std::size_t(r) * net.stride[0] +
                                   (n == 3 ? std::size_t(m) * net.stride[1] : 0));
                }
            for (std::size_t q = 0; q < planes; ++q) {
                kernels().combine(from.data(), w.data(), int(w.size()), &sums[c * row + q * along * 4],
                                  along * 4);
                for (const double*& f : from) f += net.plane;
            }
        };
        for (std::size_t i = begin; i < end; ++i) {
            Index<2> at{int(i), 0};
            if (n == 3) at = {int(i / axes[1].size()), int(i % axes[1].size())};
            for (std::size_t c = 0; c < combinations; ++c)
                contract(at, n == 2 ? Index<2>{int(c), 0} : orders[c], c);
            double* to = jets + i * count * size;
            double* to_normals = normals ? normals + i * count * 3 : nullptr;
            kernels().grid_row(net, view, sums.data(), row, {order, int(slots), to, to_normals, past});
        }
        if (past) kernels().flush();
    };
    const std::size_t together = std::max<std::size_t>(1, kChunk / count);
    if (rows * count < PreparedPatch<1, Vec<1>>::kParallelFrom) {
        do_rows(0, rows);
    } else {
        parallel_for((rows + together - 1) / together, 1,
                     [&](std::size_t i) { do_rows(i * together, std::min(rows, (i + 1) * together)); });
    }
    return {};
}

double PreparedNet::value_error_bound() const { return tables_->error; }

}  // namespace detail

}  // namespace freiform
