// Evaluation on tensor grids with the kernels, of one patch and of many.
//
// Idea. The functions of all axes are computed once for the grid, those of the last in the order in which
// vectors of parameters take them. A row contracts the net along the outer axes, which leaves a curve. None
// of the first depends on the coefficients, so patches of the same bases share it, and a small patch costs
// little but its points.
#include "coefficients_detail.hpp"
#include "prepared_detail.hpp"

#include <freiform/core/parallel.hpp>

#include <algorithm>
#include <limits>

namespace freiform::detail {

namespace {

using kernel::kernels;
using Tables = PreparedNet::Tables;

constexpr std::size_t kGridChunk = 4096;  // points that one thread takes at once
constexpr std::size_t kManyFrom = PreparedPatch<1, Vec<1>>::kParallelFrom;

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

// Everything about a grid that does not depend on coefficients.
struct Grid {
    int order = 0;
    std::size_t rows = 1, count = 0, second = 1;  // second: parameters of the second of two outer axes
    LastAxis last;
    std::vector<OuterAxis> outer;
    std::vector<Index<2>> orders;  // along the outer axes
    std::size_t along = 0, row = 0;
    kernel::GridAxis view() const {
        kernel::GridAxis v = last.view;
        v.part = last.part.data();
        v.weights = last.weights.data();
        return v;
    }
};

// The parameters in the period of closed axes; refuses those that are not in the domain.
Result<std::vector<std::vector<double>>> wrapped_axes(std::span<const BSplineBasis> bases,
                                                      std::span<const std::span<const double>> axes) {
    std::vector<std::vector<double>> wrapped(axes.size());
    for (std::size_t d = 0; d < axes.size(); ++d) {
        if (auto ok = check_axis(axes[d], bases[d].domain(), bases[d].is_closed(), d); !ok)
            return std::unexpected(ok.error());
        for (const double x : axes[d]) wrapped[d].push_back(bases[d].wrap(x));
        if (axes[d].size() > std::size_t(std::numeric_limits<int>::max()))
            return refuse(RefusalKind::limit, text("axes[", d, "]"), "more than 2^31 - 1 parameters");
    }
    return wrapped;
}

// REQUIRES two or three axes, none of them empty.
Grid plan_of(const Tables& t, const std::vector<std::vector<double>>& axes, int order) {
    const std::size_t n = axes.size();
    const kernel::Net net = t.view();
    Grid g;
    g.order = order;
    g.count = axes[n - 1].size();
    g.last = last_axis(net.axis[n - 1], axes[n - 1], order);
    for (std::size_t d = 0; d + 1 < n; ++d) {
        g.outer.push_back(outer_axis(net.axis[d], axes[d], order));
        g.rows *= axes[d].size();
    }
    if (n == 3) g.second = axes[1].size();
    for (int o = 0; n == 2 && o <= order; ++o) g.orders.push_back({o, 0});
    if (n == 3) g.orders = jet_orders<2>(order);
    g.along = std::size_t(t.extent[2]);
    g.row = std::size_t(net.planes()) * g.along * 4;
    return g;
}

// What a row needs for itself.
struct Room {
    Lines sums;
    std::vector<double> w;
    std::vector<const double*> from;
};

// The outer axes of one row contracted.
void contract_outer(const kernel::Net& net, const Grid& g, std::size_t i, Room& room) {
    const std::size_t outer = g.outer.size(), at[2] = {i / g.second, i % g.second};
    room.sums.resize(g.orders.size() * g.row + 8);
    for (std::size_t c = 0; c < g.orders.size(); ++c) {
        room.w.clear(), room.from.clear();
        const double* base = net.coefficients;
        const double* weights[2] = {};
        for (std::size_t d = 0; d < outer; ++d) {
            const std::size_t lanes = std::size_t(net.axis[d].lanes);
            weights[d] =
                &g.outer[d].weights[(at[d] * std::size_t(g.order + 1) + std::size_t(g.orders[c][d])) * lanes];
            base += std::size_t(g.outer[d].first[at[d]]) * net.stride[d];
        }
        for (int r = 0; r <= net.axis[0].degree; ++r)
            for (int m = 0; m <= (outer == 2 ? net.axis[1].degree : 0); ++m) {
                room.w.push_back(outer == 2 ? weights[0][r] * weights[1][m] : weights[0][r]);
                room.from.push_back(base + std::size_t(r) * net.stride[0] +
                                    (outer == 2 ? std::size_t(m) * net.stride[1] : 0));
            }
        for (int q = 0; q < net.planes(); ++q) {
            kernels().combine(room.from.data(), room.w.data(), int(room.w.size()),
                              &room.sums[c * g.row + std::size_t(q) * g.along * 4], g.along * 4);
            for (const double*& f : room.from) f += net.plane;
        }
    }
}

// Rows begin .. end of the grid of one net.
void grid_rows(const kernel::Net& net, const Grid& g, std::size_t slots, const PreparedNet::Destination& to,
               bool past, std::size_t begin, std::size_t end, Room& room) {
    const kernel::GridAxis view = g.view();
    for (std::size_t i = begin; i < end; ++i) {
        contract_outer(net, g, i, room);
        kernels().grid_row(net, view, room.sums.data(), g.row,
                           output(to, i * g.count, g.order, slots, std::size_t(net.dim), past));
    }
    if (past) kernels().flush();
}

bool any_empty(std::span<const std::span<const double>> axes) {
    return std::ranges::any_of(axes, [](const auto& a) { return a.empty(); });
}

}  // namespace

Result<void> PreparedNet::evaluate_grid(std::span<const std::span<const double>> axes, int order,
                                        std::size_t slots, const Destination& to) const {
    const Tables& t = *tables_;
    std::vector<BSplineBasis> bases;
    for (const AxisTable& a : t.axis) bases.push_back(a.basis);
    const auto wrapped = wrapped_axes(bases, axes);
    if (!wrapped) return std::unexpected(wrapped.error());
    if (any_empty(axes)) return {};
    if (axes.size() == 1) return evaluate((*wrapped)[0], order, slots, to, Outside::refuse);
    const Grid g = plan_of(t, *wrapped, order);
    const kernel::Net net = t.view();
    const std::size_t points = g.rows * g.count;
    const bool past = points * to.numbers(slots * std::size_t(net.dim)) * sizeof(double) > kPastFrom;
    if (points < kManyFrom) {
        Room room;
        grid_rows(net, g, slots, to, past, 0, g.rows, room);
        return {};
    }
    const std::size_t together = std::max<std::size_t>(1, kGridChunk / g.count);
    parallel_for((g.rows + together - 1) / together, 1, [&](std::size_t i) {
        Room room;
        grid_rows(net, g, slots, to, past, i * together, std::min(g.rows, (i + 1) * together), room);
    });
    return {};
}

// A curve is a surface of degree 0 along the other axis.
Result<void> evaluate_grids(std::span<const BSplineBasis> bases, std::span<const Tuples> nets,
                            std::span<const std::span<const double>> axes, std::size_t begin,
                            double* points) {
    std::vector<BSplineBasis> all(bases.begin(), bases.end());
    std::vector<std::span<const double>> at(axes.begin(), axes.end());
    const auto wrapped_or = wrapped_axes(bases, axes);
    if (!wrapped_or) return std::unexpected(wrapped_or.error());
    std::vector<std::vector<double>> wrapped = *wrapped_or;
    if (bases.size() == 1) {
        all.insert(all.begin(), *BSplineBasis::bezier(0));
        wrapped.insert(wrapped.begin(), std::vector<double>{0.0});
    }
    for (std::size_t k = 0; k < nets.size(); ++k)
        if (auto ok = check_net_range(nets[k]); !ok)
            return refuse(ok.error().kind, text("patches[", begin + k, "].", ok.error().where),
                          ok.error().message);
    const auto first = PreparedNet::make(all, nets[0]);
    if (!first)
        return refuse(first.error().kind, text("patches[", begin, "].", first.error().where),
                      first.error().message);
    if (any_empty(axes)) return {};
    const Tables& t = first->tables();
    const Grid g = plan_of(t, wrapped, 0);
    const std::size_t each = g.rows * g.count, size = each * std::size_t(t.net.dim);
    const bool past = nets.size() * size * sizeof(double) > kPastFrom;
    const std::size_t together = std::max<std::size_t>(1, kGridChunk / each);
    const auto some = [&](std::size_t i) {
        Room room;
        Lines coefficients(t.coefficients.size(), 0.0);
        kernel::Net net = t.view();
        net.coefficients = coefficients.data();
        for (std::size_t k = i * together; k < std::min(nets.size(), (i + 1) * together); ++k) {
            put_coefficients(t, nets[k], coefficients.data());
            grid_rows(net, g, 1, {points + k * size, nullptr, nullptr}, past, 0, g.rows, room);
        }
    };
    const std::size_t parts = (nets.size() + together - 1) / together;
    if (nets.size() * each < kManyFrom)
        for (std::size_t i = 0; i < parts; ++i) some(i);
    else
        parallel_for(parts, 1, some);
    return {};
}

}  // namespace freiform::detail
