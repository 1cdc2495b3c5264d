// Evaluation of many points with the kernels: checks and pieces of the batch.
#include "coefficients_detail.hpp"
#include "prepared_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/spline/evaluate_gathered.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>

namespace freiform {

std::string_view instruction_set() { return kernel::kernels().name; }

namespace detail {

namespace {

using kernel::kernels;
using Tables = PreparedNet::Tables;

constexpr std::size_t kChunk = 4096;    // points that one thread takes at once
constexpr std::size_t kGathered = 512;  // points whose parameters are gathered at once: near the processor
constexpr std::size_t kChunksFrom = PreparedPatch<1, Vec<1>>::kParallelFrom / kChunk;

bool is_good(const BSplineBasis& basis, double x) {
    return std::isfinite(x) && (basis.is_closed() || basis.domain().contains(x));
}

// The refusal of the first parameter that is not good, if there is one; `at` begins with that of point first.
Result<void> check(const Tables& t, std::span<const double> at, std::size_t first = 0) {
    const std::size_t axes = t.axis.size();
    for (std::size_t i = 0; i < at.size(); ++i) {
        const BSplineBasis& basis = t.axis[i % axes].basis;
        if (!is_good(basis, at[i]))
            return bad_parameter(at[i], basis.domain(), "at", first + i / axes,
                                 axes == 1 ? -1 : std::ptrdiff_t(i % axes));
    }
    return {};
}

// f(first, count) for pieces of n points, on several threads if there are many. Where pieces begin does not
// depend on the threads.
template <class F>
void in_chunks(std::size_t n, F&& f) {
    if (n < PreparedPatch<1, Vec<1>>::kParallelFrom) {
        for (std::size_t i = 0; i < n; i += kChunk) f(i, std::min(kChunk, n - i));
        return;
    }
    parallel_for((n + kChunk - 1) / kChunk, kChunksFrom / 2,
                 [&](std::size_t i) { f(i * kChunk, std::min(kChunk, n - i * kChunk)); });
}

// Whether parameters may be handed to the kernels as they are.
class Inside {
public:
    explicit Inside(const Tables& t) : axes_(t.axis.size()) {
        for (std::size_t d = 0; d < axes_; ++d) {
            const Interval on = t.axis[d].basis.domain();
            lo_[d] = on.lo, hi_[d] = on.hi;
        }
    }
    bool operator()(std::span<const double> at) const {
        return kernels().inside(at.data(), at.size(), int(axes_), lo_, hi_);
    }

private:
    std::size_t axes_;
    double lo_[3], hi_[3];
};
bool all_inside(const Tables& t, std::span<const double> at) {
    const Inside inside(t);
    const std::size_t axes = t.axis.size();
    std::atomic<bool> fine = true;
    in_chunks(at.size() / axes, [&](std::size_t first, std::size_t count) {
        if (!inside(at.subspan(first * axes, count * axes))) fine = false;
    });
    return fine;
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
        if (size > 0) std::fill_n(out.jets + i * size, size, nan);
        if (out.normals) std::fill_n(out.normals + 3 * i, 3, nan);
        if (out.curvatures) std::fill_n(out.curvatures + 2 * i, 2, nan);
    }
}

}  // namespace

kernel::Output output(const PreparedNet::Destination& to, std::size_t first, int order, std::size_t slots,
                      std::size_t dim, bool past) {
    return {order,
            int(slots),
            to.jets ? to.jets + first * slots * dim : nullptr,
            to.normals ? to.normals + 3 * first : nullptr,
            to.curvatures ? to.curvatures + 2 * first : nullptr,
            past};
}

bool goes_past(const Tables& t, std::size_t points, std::size_t slots, const PreparedNet::Destination& to) {
    return points * to.numbers(slots * std::size_t(t.net.dim)) * sizeof(double) > kPastFrom;
}

Result<void> PreparedNet::evaluate(std::span<const double> at, int order, std::size_t slots,
                                   const Destination& to, Outside outside) const {
    const Tables& t = *tables_;
    const std::size_t axes = t.axis.size();
    const bool plain = all_inside(t, at);
    if (!plain && outside == Outside::refuse)
        if (auto ok = check(t, at); !ok) return ok;
    const kernel::Net& net = t.ready;
    const bool past = goes_past(t, at.size() / axes, slots, to);
    in_chunks(at.size() / axes, [&](std::size_t first, std::size_t count) {
        evaluate_chunk(t, net, at.subspan(first * axes, count * axes), !plain,
                       output(to, first, order, slots, std::size_t(net.dim), past));
    });
    return {};
}

Result<void> evaluate_gathered(const PreparedNet& net, std::size_t count, const Gather& gather, int order,
                               std::size_t slots, const PreparedNet::Destination& to, Outside outside) {
    const Tables& t = net.tables();
    const std::size_t axes = t.axis.size(), dim = std::size_t(t.net.dim);
    const Inside inside(t);
    const bool past = goes_past(t, count, slots, to);
    std::atomic<std::size_t> bad{count};  // where the first piece with a bad parameter begins
    in_chunks(count, [&](std::size_t first, std::size_t n) {
        double some[kGathered * 3];
        for (const std::size_t end = first + n; first < end; first += kGathered) {
            const std::size_t points = std::min(kGathered, end - first);
            gather(first, points, some);
            const std::span<const double> at(some, points * axes);
            const bool plain = inside(at);
            if (!plain && outside == Outside::refuse && !check(t, at, first)) {
                for (std::size_t least = bad; first < least && !bad.compare_exchange_weak(least, first);) {
                }
                return;
            }
            evaluate_chunk(t, t.ready, at, !plain, output(to, first, order, slots, dim, past));
        }
    });
    std::array<double, 3> one;
    for (std::size_t i = bad; i < count; ++i) {  // again, to say which: it is in that piece
        gather(i, 1, one.data());
        if (auto ok = check(t, {one.data(), axes}, i); !ok) return ok;
    }
    return {};
}

Result<void> PreparedNet::evaluate_single(std::span<const double> at, float* points, Outside outside) const {
    const Tables& t = *tables_;
    const std::size_t axes = t.axis.size(), dim = std::size_t(t.net.dim);
    const bool plain = all_inside(t, at);
    if (!plain && outside == Outside::refuse)
        if (auto ok = check(t, at); !ok) return ok;
    const kernel::Net& net = t.ready;
    in_chunks(at.size() / axes, [&](std::size_t first, std::size_t count) {
        double some[512 * 4];
        for (std::size_t i = first; i < first + count; i += 512) {
            const std::size_t n = std::min<std::size_t>(512, first + count - i);
            evaluate_chunk(t, net, at.subspan(i * axes, n * axes), !plain,
                           {0, 1, some, nullptr, nullptr, false});
            for (std::size_t k = 0; k < n * dim; ++k) points[i * dim + k] = float(some[k]);
        }
    });
    return {};
}

double PreparedNet::error_bound(std::size_t slot) const { return tables_->errors[slot]; }

}  // namespace detail

}  // namespace freiform
