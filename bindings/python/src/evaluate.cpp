// Evaluation of many parameters on NumPy's memory.
//
// Method. Parameters of a curve that lie one after the other go to the kernels where they are, and results
// come where NumPy has them. Parameters of several axes, or with other strides (as broadcasting makes them),
// are gathered in small pieces (spline/evaluate_gathered.hpp), so that there is no memory beyond the result.
// Patches that the kernels do not take (extreme spans or weights), and derivatives of order above 2, go point
// by point. Cost. 1e6 points of a cubic curve: what PreparedPatch takes, and one call.
#include "handles.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/spline/accurate.hpp>
#include <freiform/spline/evaluate_gathered.hpp>

namespace freiform::python {
namespace {

using AnyArray = py::array_t<double, py::array::forcecast>;

constexpr std::size_t kBlock = 4096;

// N arrays of the same shape, read in C order.
template <std::size_t N>
class Parameters {
public:
    explicit Parameters(const std::vector<AnyArray>& given) {
        if (given.size() != N) reject(RefusalKind::invalid, "parameters", text(N, " are needed"));
        shape_.assign(given[0].shape(), given[0].shape() + given[0].ndim());
        for (std::size_t d = 0; d < N; ++d) {
            const AnyArray& a = given[d];
            if (!std::equal(shape_.begin(), shape_.end(), a.shape(), a.shape() + a.ndim()))
                reject(RefusalKind::invalid, "parameters", "have different shapes");
            first_[d] = reinterpret_cast<const char*>(a.data());
            stride_[d].assign(a.strides(), a.strides() + a.ndim());
            contiguous_ = contiguous_ && (a.flags() & py::array::c_style);
        }
        for (const py::ssize_t n : shape_) size_ *= std::size_t(n);
    }
    const std::vector<py::ssize_t>& shape() const { return shape_; }
    std::size_t size() const { return size_; }
    // Where the parameters are doubles one after the other.
    const double* direct() const {
        return N == 1 && contiguous_ ? reinterpret_cast<const double*>(first_[0]) : nullptr;
    }
    // Parameters from .. from + count - 1, those of one point together.
    void gather(std::size_t from, std::size_t count, double* out) const {
        if (contiguous_) {
            if constexpr (N == 2) {  // one pass
                const double* u = reinterpret_cast<const double*>(first_[0]) + from;
                const double* v = reinterpret_cast<const double*>(first_[1]) + from;
                for (std::size_t i = 0; i < count; ++i) out[2 * i] = u[i], out[2 * i + 1] = v[i];
                return;
            }
            for (std::size_t d = 0; d < N; ++d) {
                const double* x = reinterpret_cast<const double*>(first_[d]) + from;
                for (std::size_t i = 0; i < count; ++i) out[i * N + d] = x[i];
            }
            return;
        }
        // Along the last axis the steps are all the same: row after row, from the first to its end.
        const std::size_t last = shape_.size() - 1, length = std::size_t(shape_[last]);
        std::vector<py::ssize_t> at(shape_.size());
        std::size_t rest = from;
        for (std::size_t k = shape_.size(); k-- > 0; rest /= std::size_t(shape_[k]))
            at[k] = py::ssize_t(rest % std::size_t(shape_[k]));
        while (count > 0) {
            const std::size_t n = std::min(count, length - std::size_t(at[last]));
            for (std::size_t d = 0; d < N; ++d) {
                const char* p = first_[d];
                for (std::size_t k = 0; k <= last; ++k) p += at[k] * stride_[d][k];
                for (std::size_t i = 0; i < n; ++i, p += stride_[d][last])
                    std::memcpy(&out[i * N + d], p, sizeof(double));
            }
            out += n * N, count -= n, at[last] = 0;
            for (std::size_t k = last; k-- > 0;) {
                if (++at[k] < shape_[k]) break;
                at[k] = 0;
            }
        }
    }

private:
    std::vector<py::ssize_t> shape_;
    std::array<const char*, N> first_{};
    std::array<std::vector<py::ssize_t>, N> stride_;
    std::size_t size_ = 1;
    bool contiguous_ = true;
};

// "at[3]: .." of a block that begins at `from` as a place in the whole.
Refusal shifted(Refusal r, std::size_t from) {
    if (!r.where.starts_with("at[") || from == 0) return r;
    const std::size_t end = r.where.find(']');
    r.where = text("at[", std::stoull(r.where.substr(3, end - 3)) + from, r.where.substr(end));
    return r;
}

// f(from, count) for blocks that cover 0 .. n - 1, on several threads; the refusal of the first block that
// has one.
template <class F>
Result<void> in_blocks(std::size_t n, F&& f) {
    std::mutex mutex;
    std::optional<std::pair<std::size_t, Refusal>> first;
    parallel_for((n + kBlock - 1) / kBlock, 8, [&](std::size_t block) {
        const std::size_t from = block * kBlock, count = std::min(kBlock, n - from);
        if (Result<void> done = f(from, count); !done) {
            const std::scoped_lock lock(mutex);
            if (!first || from < first->first) first.emplace(from, done.error());
        }
    });
    if (first) return std::unexpected(shifted(std::move(first->second), first->first));
    return {};
}

// Point by point, any order.
template <std::size_t N>
Result<void> one_by_one(const PatchVariant<N>& patch, std::span<const double> at, int order,
                        std::size_t slots, double* out, Outside outside) {
    return std::visit(
        [&](const auto& p) -> Result<void> {
            using V = PointOf<CoefficientOf<decltype(p)>>;
            for (std::size_t i = 0; i < at.size() / N; ++i) {
                Param<N> u;
                std::memcpy(&u, &at[i * N], sizeof u);
                V value;
                const Result<void> ok = p.evaluate(std::span<const Param<N>>(&u, 1), std::span<V>(&value, 1));
                double* to = out + i * slots * std::size_t(V::kCoords);
                if (!ok && outside == Outside::nan) {
                    std::fill_n(to, slots * std::size_t(V::kCoords),
                                std::numeric_limits<double>::quiet_NaN());
                    continue;
                }
                if (!ok) return std::unexpected(shifted(ok.error(), i));
                const auto jet = p.derivatives(u, order);
                for (std::size_t k = 0; k < slots; ++k)
                    for (int c = 0; c < V::kCoords; ++c) *to++ = jet[k][c];
            }
            return {};
        },
        patch);
}

template <std::size_t N>
Result<void> evaluate(const PatchHandle<N>& h, const Parameters<N>& at, int order, std::size_t slots,
                      std::size_t dim, const detail::PreparedNet::Destination& to, Outside outside) {
    const detail::PreparedNet* fast = order <= 2 ? h.prepared() : nullptr;
    if (!fast && (to.normals || to.curvatures))
        return refuse(RefusalKind::unsupported, "surface",
                      "spans or weights are too extreme for this question");
    if (fast && at.direct()) return fast->evaluate({at.direct(), at.size()}, order, slots, to, outside);
    const auto gather = [&](std::size_t from, std::size_t count, double* out) {
        at.gather(from, count, out);
    };
    if (fast) return detail::evaluate_gathered(*fast, at.size(), gather, order, slots, to, outside);
    return in_blocks(at.size(), [&](std::size_t from, std::size_t count) {
        std::vector<double> block(count * N);
        at.gather(from, count, block.data());
        return one_by_one<N>(*h.patch, block, order, slots, to.jets + from * slots * dim, outside);
    });
}

template <std::size_t N>
std::size_t dimension_of(const PatchHandle<N>& h) {
    return std::visit([](const auto& p) { return std::size_t(dim_of<CoefficientOf<decltype(p)>>); },
                      *h.patch);
}

py::array_t<double> empty(std::vector<py::ssize_t> shape, std::initializer_list<std::size_t> more) {
    for (const std::size_t n : more) shape.push_back(py::ssize_t(n));
    return py::array_t<double>(shape);
}

// The array that results go to: a new one, or the one that is given if it is as the new one would be.
py::array_t<double> destination(const py::object& given, std::vector<py::ssize_t> shape,
                                std::initializer_list<std::size_t> more) {
    if (given.is_none()) return empty(std::move(shape), more);
    for (const std::size_t n : more) shape.push_back(py::ssize_t(n));
    if (!py::isinstance<py::array_t<double, py::array::c_style>>(given))
        reject(RefusalKind::invalid, "out", "is not an array of float64 in C order");
    auto out = py::reinterpret_borrow<py::array_t<double>>(given);
    if (!out.writeable()) reject(RefusalKind::invalid, "out", "is read-only");
    if (!std::equal(shape.begin(), shape.end(), out.shape(), out.shape() + out.ndim()))
        reject(RefusalKind::invalid, "out",
               text("has the shape ", std::string(py::str(out.attr("shape"))), " and not ",
                    std::string(py::str(py::tuple(py::cast(shape))))));
    return out;
}

void check_order(int order) {
    if (order < 0 || order > 100)
        reject(RefusalKind::invalid, "derivatives", text(order, " is not an order from 0 to 100"));
}

template <std::size_t N>
void bind_values_of(py::module_& m) {
    // Order 0: points; else all partial derivatives up to the order, in graded order.
    m.def(
        "evaluate",
        [](const PatchHandle<N>& h, const std::vector<AnyArray>& given, int order, bool nan,
           const py::object& into) {
            check_order(order);
            const Parameters<N> at(given);
            const std::size_t dim = dimension_of(h), slots = jet_size(N, order);
            auto out = order == 0 ? destination(into, at.shape(), {dim})
                                  : destination(into, at.shape(), {slots, dim});
            double* to = out.mutable_data();
            take(unlocked([&] {
                return evaluate<N>(h, at, order, slots, dim, {to}, nan ? Outside::nan : Outside::refuse);
            }));
            return out;
        },
        py::arg("patch"), py::arg("at"), py::arg("order"), py::arg("nan"), py::arg("out"));
    m.def(
        "evaluate_grid",
        [](const PatchHandle<N>& h, const std::vector<Array>& given, int order) {
            check_order(order);
            if (given.size() != N) reject(RefusalKind::invalid, "axes", text(N, " are needed"));
            std::vector<std::span<const double>> axes;
            std::vector<py::ssize_t> shape;
            for (const Array& a : given) {
                axes.push_back(numbers_of(a));
                shape.push_back(a.size());
            }
            const std::size_t dim = dimension_of(h), slots = jet_size(N, order);
            auto out = order == 0 ? empty(shape, {dim}) : empty(shape, {slots, dim});
            double* to = out.mutable_data();
            take(unlocked([&]() -> Result<void> {
                if (const auto* fast = order <= 2 ? h.prepared() : nullptr)
                    return fast->evaluate_grid(axes, order, slots, {to});
                std::vector<double> at;
                std::size_t n = 1;
                for (const auto& a : axes) n *= a.size();
                return in_blocks(n, [&](std::size_t from, std::size_t count) {
                    std::vector<double> block(count * N);
                    for (std::size_t i = 0; i < count; ++i)
                        for (std::size_t d = N, rest = from + i; d-- > 0; rest /= axes[d].size())
                            block[i * N + d] = axes[d][rest % axes[d].size()];
                    return one_by_one<N>(*h.patch, block, order, slots, to + from * slots * dim,
                                         Outside::refuse);
                });
            }));
            return out;
        },
        py::arg("patch"), py::arg("axes"), py::arg("order"));
    // Values and their bounds, with twice the digits.
    m.def(
        "evaluate_accurate",
        [](const PatchHandle<N>& h, const std::vector<AnyArray>& given) {
            const Parameters<N> at(given);
            return std::visit(
                [&](const auto& p) {
                    using V = PointOf<CoefficientOf<decltype(p)>>;
                    std::vector<Param<N>> u(at.size());
                    at.gather(0, at.size(), reinterpret_cast<double*>(u.data()));
                    std::vector<Accurate<V>> found(at.size());
                    take(unlocked([&] {
                        return evaluate_accurate(p, std::span<const Param<N>>(u),
                                                 std::span<Accurate<V>>(found));
                    }));
                    auto value = empty(at.shape(), {std::size_t(V::kCoords)});
                    auto bound = empty(at.shape(), {std::size_t(V::kCoords)});
                    double *v = value.mutable_data(), *b = bound.mutable_data();
                    for (const auto& f : found)
                        for (int c = 0; c < V::kCoords; ++c) *v++ = f.value[c], *b++ = f.bound[c];
                    return py::make_tuple(value, bound);
                },
                *h.patch);
        },
        py::arg("patch"), py::arg("at"));
    m.def(
        "value_error_bound",
        [](const PatchHandle<N>& h) {
            const double plain = std::visit([](const auto& p) { return p.value_error_bound(); }, *h.patch);
            const auto* fast = h.prepared();
            return fast ? std::max(plain, fast->error_bound(0)) : plain;
        },
        py::arg("patch"));
    m.def(
        "evaluate_grids",
        [](const std::vector<PatchHandle<N>>& patches, const std::vector<Array>& given) {
            if (given.size() != N) reject(RefusalKind::invalid, "axes", text(N, " are needed"));
            std::array<std::span<const double>, N> axes;
            std::vector<py::ssize_t> shape{py::ssize_t(patches.size())};
            for (std::size_t d = 0; d < N; ++d) {
                axes[d] = numbers_of(given[d]);
                shape.push_back(given[d].size());
            }
            return with_common<1, 4, N>(patches, "patches", [&](const auto& all) -> py::object {
                using P = CoefficientOf<decltype(all[0])>;
                auto out = empty(shape, {std::size_t(dim_of<P>)});
                const std::span<PointOf<P>> to(reinterpret_cast<PointOf<P>*>(out.mutable_data()),
                                               std::size_t(out.size()) / dim_of<P>);
                take(unlocked([&] {
                    return evaluate_grids<N, P, BSplineBasis>(std::span<const Patch<N, P>>(all), axes, to);
                }));
                return out;
            });
        },
        py::arg("patches"), py::arg("axes"));
}

}  // namespace

void bind_evaluate(py::module_& m) {
    bind_values_of<1>(m);
    bind_values_of<2>(m);
    bind_values_of<3>(m);
    m.def(
        "evaluate_normals",
        [](const SurfaceHandle& h, const std::vector<AnyArray>& given, bool nan) {
            if (dimension_of(h) != 3)
                reject(RefusalKind::unsupported, "surface", "normals need three coordinates");
            const Parameters<2> at(given);
            auto points = empty(at.shape(), {3}), normals = empty(at.shape(), {3});
            double *to = points.mutable_data(), *n = normals.mutable_data();
            take(unlocked([&] {
                return evaluate<2>(h, at, 1, 1, 3, {to, n}, nan ? Outside::nan : Outside::refuse);
            }));
            return py::make_tuple(points, normals);
        },
        py::arg("surface"), py::arg("at"), py::arg("nan"));
    m.def(
        "evaluate_curvatures",
        [](const SurfaceHandle& h, const std::vector<AnyArray>& given, bool nan) {
            if (dimension_of(h) != 3)
                reject(RefusalKind::unsupported, "surface", "curvatures need three coordinates");
            const Parameters<2> at(given);
            auto out = empty(at.shape(), {2});
            double* to = out.mutable_data();
            take(unlocked([&] {
                return evaluate<2>(h, at, 2, 0, 3, {nullptr, nullptr, to},
                                   nan ? Outside::nan : Outside::refuse);
            }));
            return out;
        },
        py::arg("surface"), py::arg("at"), py::arg("nan"));
}

}  // namespace freiform::python
