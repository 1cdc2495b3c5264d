// The tables behind PreparedPatch, and their view for the kernels.
#pragma once
#include "kernel/evaluate.hpp"

#include <freiform/spline/prepared.hpp>

#include <new>
#include <vector>

namespace freiform::detail {

// Numbers that begin with a line of the cache: a vector of them that straddles two lines costs two loads.
template <class T>
struct LineAllocator {
    using value_type = T;
    LineAllocator() = default;
    template <class U>
    LineAllocator(const LineAllocator<U>&) {}
    T* allocate(std::size_t n) {
        return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(64)));
    }
    void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t(64)); }
    friend bool operator==(LineAllocator, LineAllocator) { return true; }
};
using Lines = std::vector<double, LineAllocator<double>>;

struct AxisTable {
    BSplineBasis basis;
    kernel::Axis axis;  // without pointers
    Lines records;
    std::vector<int> bucket;

    kernel::Axis view() const;
    kernel::Span& span(std::size_t s) {
        return *reinterpret_cast<kernel::Span*>(records.data() + s * axis.stride);
    }
};

// The spans of `basis` and its functions in them; of a curve, its coordinates: `curve` is then the
// coefficients in places of `lanes` numbers.
AxisTable make_axis(const BSplineBasis& basis, std::span<const double> curve, int lanes);

struct PreparedNet::Tables {
    std::vector<AxisTable> axis;
    kernel::Net net;                          // without pointers
    Index<3> extent{1, 1, 1}, size{1, 1, 1};  // of the net, unwound and as given; the last axis last
    Lines coefficients;
    std::vector<double> errors;  // bounds, of each partial derivative up to kernel::kMaxOrder

    kernel::Net ready;  // the view of these tables

    kernel::Net view() const;
    bool any_closed() const;
};

// Refuses nets that PreparedPatch::make refuses.
Result<void> check_net_range(const Tuples& net);
// The net of a surface or volume as kernels want it. REQUIRES as many numbers as tables.coefficients has.
void put_coefficients(const PreparedNet::Tables& tables, const Tuples& net, double* coefficients);

// What does not stay in the cache goes past it: a store would first read what it overwrites.
inline constexpr std::size_t kPastFrom = std::size_t(4) << 20;  // bytes

// `to` from point `first` on, with `dim` numbers in a slot.
kernel::Output output(const PreparedNet::Destination& to, std::size_t first, int order, std::size_t slots,
                      std::size_t dim, bool past);

// Bounds of the rounding of a value, and of all partial derivatives up to kernel::kMaxOrder, in graded order.
double batch_error_bound(std::span<const int> degrees, const Tuples& net);
std::vector<double> batch_error_bounds(std::span<const BSplineBasis> bases, const Tuples& net);

}  // namespace freiform::detail
