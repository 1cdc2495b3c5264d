// Nearest and farthest points, distances, hulls.
#include "records/query/nearest.hpp"

#include "records/core/interval.hpp"
#include "records/query/distance.hpp"
#include "records/query/hull.hpp"
#include "records/query/oriented_box.hpp"

namespace freiform::python {
namespace {

template <std::size_t N>
NearestObject object_of(const PatchHandle<N>& h) {
    return std::visit([](const auto& p) { return NearestObject::of(p); }, *h.patch);
}
NearestObject object_of(const py::handle& x) {
    if (py::isinstance<CurveHandle>(x)) return object_of(x.cast<const CurveHandle&>());
    if (py::isinstance<SurfaceHandle>(x)) return object_of(x.cast<const SurfaceHandle&>());
    if (py::isinstance<VolumeHandle>(x)) return object_of(x.cast<const VolumeHandle&>());
    if (py::isinstance<TriangleHandle>(x))
        return std::visit([](const auto& p) { return NearestObject::of(p); },
                          x.cast<const TriangleHandle&>().patch);
    reject(RefusalKind::invalid, "objects", "are curves, surfaces, volumes and triangular patches");
}

// One answer for each point, as arrays: object, at, point, distance, point_error, and the bound.
template <int D, class Answer, class Bound>
py::tuple columns(std::span<const Answer> found, const std::vector<py::ssize_t>& shape, Bound bound) {
    auto with = [&](py::ssize_t n) {
        auto s = shape;
        s.push_back(n);
        return py::array_t<double>(s);
    };
    py::array_t<std::int64_t> object(shape);
    py::array_t<double> at = with(3), point = with(D), distance(shape), error(shape), limit(shape);
    for (std::size_t i = 0; i < found.size(); ++i) {
        object.mutable_data()[i] = std::int64_t(found[i].object);
        for (std::size_t k = 0; k < 3; ++k) at.mutable_data()[3 * i + k] = found[i].at[k];
        for (std::size_t k = 0; k < D; ++k) point.mutable_data()[D * i + k] = found[i].point[int(k)];
        distance.mutable_data()[i] = found[i].distance;
        error.mutable_data()[i] = found[i].point_error;
        limit.mutable_data()[i] = found[i].*bound;
    }
    return py::make_tuple(object, at, point, distance, error, limit);
}

// f(dimension, points) where the points have the coordinates of the objects.
template <class F>
py::object with_query(const NearestQuery& q, const Array& points, F&& f) {
    return with_dimension(q.coordinates(), "objects", [&](auto d) -> py::object {
        return f(d, points_of<Vec<decltype(d)::value>>(points, "points"));
    });
}
template <class F>
py::object with_point(const NearestQuery& q, const Array& point, F&& f) {
    return with_dimension(q.coordinates(), "objects", [&](auto d) -> py::object {
        return f(d, vec_of<decltype(d)::value>(point, "point"));
    });
}
template <class F>
py::object plane_or_space(const NearestQuery& q, F&& f) {
    if (q.coordinates() == 2) return f(std::integral_constant<int, 2>());
    if (q.coordinates() == 3) return f(std::integral_constant<int, 3>());
    reject(RefusalKind::unsupported, "objects", "have neither two nor three coordinates");
}

}  // namespace

void bind_nearest(py::module_& m) {
    using Q = NearestQuery;
    py::class_<Q>(m, "NearestHandle")
        .def(py::init([](const py::list& objects) {
                 std::vector<NearestObject> all;
                 for (const py::handle& x : objects) all.push_back(object_of(x));
                 return take(unlocked([&] { return Q::make(all); }));
             }),
             py::arg("objects"))
        .def_property_readonly("coordinates", &Q::coordinates)
        .def(
            "nearest",
            [](const Q& q, const Array& points, double accuracy, int max_parts) {
                return with_query(q, points, [&](auto d, auto p) {
                    constexpr int D = decltype(d)::value;
                    std::vector<Nearest<D>> found(p.size());
                    take(unlocked([&] { return q.nearest<D>(p, found, {accuracy, max_parts}); }));
                    return columns<D>(std::span<const Nearest<D>>(found),
                                      {points.shape(), points.shape() + points.ndim() - 1},
                                      &Nearest<D>::lower_bound);
                });
            },
            py::arg("points"), py::arg("accuracy"), py::arg("max_parts"))
        .def(
            "farthest",
            [](const Q& q, const Array& points, double accuracy, int max_parts) {
                return with_query(q, points, [&](auto d, auto p) {
                    constexpr int D = decltype(d)::value;
                    std::vector<Farthest<D>> found(p.size());
                    take(unlocked([&] { return q.farthest<D>(p, found, {accuracy, max_parts}); }));
                    return columns<D>(std::span<const Farthest<D>>(found),
                                      {points.shape(), points.shape() + points.ndim() - 1},
                                      &Farthest<D>::upper_bound);
                });
            },
            py::arg("points"), py::arg("accuracy"), py::arg("max_parts"))
        .def(
            "feet",
            [](const Q& q, const Array& point, int count, double accuracy, int max_parts) {
                return with_point(q, point, [&](auto d, const auto& p) {
                    constexpr int D = decltype(d)::value;
                    return answer([&] { return q.feet<D>(p, count, {accuracy, max_parts}); });
                });
            },
            py::arg("point"), py::arg("count"), py::arg("accuracy"), py::arg("max_parts"))
        .def(
            "within",
            [](const Q& q, const Array& point, double radius, double finest, int max_parts) {
                return with_point(q, point, [&](auto d, const auto& p) {
                    constexpr int D = decltype(d)::value;
                    return answer([&] { return q.within<D>(p, radius, finest, {0, max_parts}); });
                });
            },
            py::arg("point"), py::arg("radius"), py::arg("finest"), py::arg("max_parts"))
        .def(
            "least_distance",
            [](const Q& a, const Q& b, double accuracy, int max_pairs) {
                return with_dimension(a.coordinates(), "objects", [&](auto d) -> py::object {
                    constexpr int D = decltype(d)::value;
                    return answer([&] { return least_distance<D>(a, b, {accuracy, max_pairs}); });
                });
            },
            py::arg("other"), py::arg("accuracy"), py::arg("max_pairs"))
        .def(
            "convex_hull",
            [](const Q& q, double tolerance, int max_parts) {
                return plane_or_space(q, [&](auto d) {
                    constexpr int D = decltype(d)::value;
                    return answer([&] { return convex_hull<D>(q, tolerance, max_parts); });
                });
            },
            py::arg("tolerance"), py::arg("max_parts"))
        .def(
            "oriented_box",
            [](const Q& q, double accuracy, int max_parts) {
                return plane_or_space(q, [&](auto d) {
                    constexpr int D = decltype(d)::value;
                    return answer([&] { return oriented_box<D>(q, accuracy, max_parts); });
                });
            },
            py::arg("accuracy"), py::arg("max_parts"));
    m.def(
        "convex_hull_of_points",
        [](const Array& points) {
            return last_extent(points, "points") == 2
                       ? answer([&] { return convex_hull(points_of<Vec<2>>(points, "points")); })
                       : answer([&] { return hull_triangles(points_of<Vec<3>>(points, "points")); });
        },
        py::arg("points"));
}

}  // namespace freiform::python
