// Values of the library as Python objects, and back.
//
// Idea. What the library answers is made of few kinds of things: numbers, points, intervals, enumerations,
// patches, and records (structs) of such. `to_py` turns any of them into Python, records into the dataclass
// of the same name: generate.py reads fields and comments from the headers and writes both sides, so that
// nothing is said twice. Refusals become exceptions; everything that computes runs without the GIL
// (`answer`).
#pragma once

#include <freiform/core/bounded.hpp>
#include <freiform/core/colour.hpp>
#include <freiform/core/hom.hpp>
#include <freiform/core/interval.hpp>
#include <freiform/core/net.hpp>
#include <freiform/core/result.hpp>
#include <freiform/core/spelling.hpp>

#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>
#include <variant>
#include <vector>

namespace freiform::python {

namespace py = pybind11;

// Doubles in C order: what has them already is not copied.
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

// A refusal on its way to Python.
struct Thrown {
    Refusal refusal;
};

template <class T>
T take(Result<T>&& r) {
    if (!r) throw Thrown{std::move(r.error())};
    if constexpr (!std::is_void_v<T>) return std::move(*r);
}
[[noreturn]] inline void reject(RefusalKind kind, std::string where, std::string message) {
    throw Thrown{Refusal{kind, std::move(where), std::move(message)}};
}

// A class or function of the package.
inline py::object attribute(const char* module, std::string_view name) {
    return py::module_::import(module).attr(py::str(name.data(), name.size()));
}

// --- enumerations: their names are their values in Python ---

template <auto V>
constexpr std::string_view value_name() {
    constexpr std::string_view all = __PRETTY_FUNCTION__;
    constexpr std::size_t from = all.find("V = ") + 4;
    constexpr std::string_view value = all.substr(from, all.find_first_of(";]", from) - from);
    if constexpr (value.empty() || value[0] == '(' || (value[0] >= '0' && value[0] <= '9'))
        return {};
    else
        return value.substr(value.rfind(':') + 1);
}
template <class E>
constexpr auto value_names() {
    return []<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<std::string_view, sizeof...(I)>{value_name<E(I)>()...};
    }
    (std::make_index_sequence<16>{});
}
template <class E>
E enum_of(std::string_view name, std::string_view where) {
    static constexpr auto names = value_names<E>();
    std::vector<std::string_view> known;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i].empty()) continue;
        if (names[i] == name) return E(i);
        known.push_back(names[i]);
    }
    reject(RefusalKind::invalid, std::string(where), text("\"", name, "\" is not ", listed(known)));
}

// --- from the library ---

template <class T>
struct Fields;  // of records: generated
template <class T>
struct Wrapped;  // patches, models, meshes: handles.hpp

template <class T>
concept IsRecord = requires(const T& x) {
    Fields<T>::of(x);
};
template <class T>
concept IsWrapped = requires(const T& x) {
    Wrapped<T>::object(x);
};

template <class T, template <class...> class Form>
inline constexpr bool is_form = false;
template <template <class...> class Form, class... A>
inline constexpr bool is_form<Form<A...>, Form> = true;
template <class T>
inline constexpr int tuple_size_of = 0;  // of Vec and Hom: how many numbers
template <int D>
inline constexpr int tuple_size_of<Vec<D>> = D;
template <int D>
inline constexpr int tuple_size_of<Hom<D>> = D + 1;
template <class T>
inline constexpr bool is_std_array = false;
template <class T, std::size_t N>
inline constexpr bool is_std_array<std::array<T, N>> = true;
template <class T>
inline constexpr bool is_net = false;
template <std::size_t N, class P>
inline constexpr bool is_net<Net<N, P>> = true;

inline Array array_of(const double* numbers, std::vector<py::ssize_t> shape) {
    Array a(shape);
    if (a.size() > 0) std::memcpy(a.mutable_data(), numbers, std::size_t(a.size()) * sizeof(double));
    return a;
}

template <class T>
py::object to_py(const T& x);

// A sequence: numbers and points as an array, everything else as a list.
template <class Range>
py::object sequence(const Range& range) {
    using T = std::remove_cvref_t<decltype(*std::begin(range))>;
    const std::span<const T> all(range);
    if constexpr (std::same_as<T, double>) {
        return array_of(all.data(), {py::ssize_t(all.size())});
    } else if constexpr (std::same_as<T, int> || std::same_as<T, std::size_t>) {
        py::array_t<std::int64_t> a(py::ssize_t(all.size()));
        for (std::size_t i = 0; i < all.size(); ++i) a.mutable_at(py::ssize_t(i)) = std::int64_t(all[i]);
        return a;
    } else if constexpr (tuple_size_of<T> > 0) {
        return array_of(all.empty() ? nullptr : all[0].c.data(), {py::ssize_t(all.size()), tuple_size_of<T>});
    } else {
        py::list list;
        for (const T& x : all) list.append(to_py(x));
        return list;
    }
}

template <class T>
py::object to_py(const T& x) {
    if constexpr (std::same_as<T, py::object>) {
        return x;
    } else if constexpr (std::same_as<T, bool> || std::integral<T> || std::floating_point<T> ||
                         std::same_as<T, std::string>) {
        return py::cast(x);
    } else if constexpr (std::same_as<T, std::string_view>) {
        return py::str(x.data(), x.size());
    } else if constexpr (std::is_enum_v<T>) {
        return to_py(value_names<T>()[std::size_t(x)]);
    } else if constexpr (std::same_as<T, Interval>) {
        return attribute("freiform._base", "Interval")(x.lo, x.hi);
    } else if constexpr (std::same_as<T, Bounded>) {
        return attribute("freiform._base", "Bounded")(x.value, x.bound);
    } else if constexpr (std::same_as<T, Colour>) {
        return attribute("freiform._base", "Colour")(x.r, x.g, x.b, x.a);
    } else if constexpr (std::same_as<T, Refusal>) {
        return attribute("freiform._refusals", "refusal_of")(to_py(x.kind), x.where, x.message);
    } else if constexpr (tuple_size_of<T> > 0) {
        return array_of(x.c.data(), {tuple_size_of<T>});
    } else if constexpr (IsWrapped<T>) {
        return Wrapped<T>::object(x);
    } else if constexpr (IsRecord<T>) {
        return attribute("freiform._records", Fields<T>::name)(*Fields<T>::of(x));
    } else if constexpr (is_form<T, std::optional>) {
        return x ? to_py(*x) : py::none();
    } else if constexpr (is_form<T, std::variant>) {
        return std::visit([](const auto& y) { return to_py(y); }, x);
    } else if constexpr (is_form<T, std::pair>) {
        return py::make_tuple(to_py(x.first), to_py(x.second));
    } else if constexpr (is_net<T>) {
        using P = std::remove_cvref_t<decltype(x.flat()[0])>;
        std::vector<py::ssize_t> shape(x.extent().begin(), x.extent().end());
        shape.push_back(tuple_size_of<P>);
        return array_of(numbers(x.flat()).data(), shape);
    } else if constexpr (is_std_array<T>) {
        using E = typename T::value_type;
        if constexpr (std::same_as<E, double> || std::same_as<E, int> || std::same_as<E, std::size_t> ||
                      tuple_size_of < E >> 0) {
            return sequence(x);
        } else {
            py::tuple t(x.size());
            for (std::size_t i = 0; i < x.size(); ++i) t[i] = to_py(x[i]);
            return t;
        }
    } else {
        return sequence(x);  // vectors and spans
    }
}

// What f() answers, computed without the GIL, as a Python object; its refusal as an exception.
template <class F>
auto unlocked(F&& f) {
    py::gil_scoped_release release;
    return f();
}
template <class F>
py::object answer(F&& f) {
    using R = decltype(f());
    if constexpr (is_form<R, std::expected>) {
        R r = unlocked(f);
        if constexpr (std::is_void_v<typename R::value_type>) {
            take(std::move(r));
            return py::none();
        } else {
            return to_py(take(std::move(r)));
        }
    } else {
        return to_py(unlocked(f));
    }
}

// --- to the library ---

// Coordinates in any dimension from 1 to 4.
template <class F>
auto with_dimension(py::ssize_t d, std::string_view where, F&& f) {
    switch (d) {
        case 1:
            return f(std::integral_constant<int, 1>());
        case 2:
            return f(std::integral_constant<int, 2>());
        case 3:
            return f(std::integral_constant<int, 3>());
        case 4:
            return f(std::integral_constant<int, 4>());
        default:
            reject(RefusalKind::invalid, std::string(where), text("points have 1 to 4 coordinates, not ", d));
    }
}

inline std::span<const double> numbers_of(const Array& a) { return {a.data(), std::size_t(a.size())}; }

inline py::ssize_t last_extent(const Array& a, std::string_view where) {
    if (a.ndim() < 1)
        reject(RefusalKind::invalid, std::string(where), "is a number and not an array of points");
    return a.shape(a.ndim() - 1);
}
// The array as points, (n, D); without copying.
template <class P>
std::span<const P> points_of(const Array& a, std::string_view where) {
    constexpr int kNumbers = tuple_size_of<P>;
    if (last_extent(a, where) != kNumbers)
        reject(RefusalKind::invalid, std::string(where),
               text("the last extent is ", last_extent(a, where), " and not ", kNumbers));
    static_assert(sizeof(P) == kNumbers * sizeof(double));
    return {reinterpret_cast<const P*>(a.data()), std::size_t(a.size()) / kNumbers};
}
template <int D>
Vec<D> vec_of(const Array& a, std::string_view where) {
    if (a.ndim() != 1 || a.size() != D)
        reject(RefusalKind::invalid, std::string(where), text("is not a vector of ", D, " numbers"));
    Vec<D> v;
    for (int i = 0; i < D; ++i) v[i] = a.data()[i];
    return v;
}
template <std::size_t N, class P>
Net<N, P> net_of(const Array& a, std::string_view where) {
    if (a.ndim() != py::ssize_t(N) + 1)
        reject(RefusalKind::invalid, std::string(where), text("has ", a.ndim(), " axes and not ", N + 1));
    Index<N> extent;
    for (std::size_t d = 0; d < N; ++d)
        extent[d] = int(std::min<py::ssize_t>(a.shape(py::ssize_t(d)), 0x7fffffff));
    const auto p = points_of<P>(a, where);
    return take(Net<N, P>::make(extent, std::vector<P>(p.begin(), p.end())));
}
inline Interval interval_of(std::pair<double, double> on) { return {on.first, on.second}; }

}  // namespace freiform::python
