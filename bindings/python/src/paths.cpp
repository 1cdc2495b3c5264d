// Plane paths, flattening, regions, drawings in SVG.
#include "paths.hpp"

#include "records/core/interval.hpp"
#include "records/io/svg.hpp"
#include "records/path/flatten.hpp"
#include "records/path/path.hpp"
#include "records/path/simplify.hpp"
#include "records/path/style.hpp"
#include "records/region/boolean.hpp"

#include <freiform/region/stroke.hpp>

namespace freiform::python {
namespace {

StrokeStyle stroke_of(double width, std::string_view cap, std::string_view join, double miter_limit,
                      const std::vector<double>& dashes, double dash_offset) {
    return {width,  miter_limit, enum_of<LineCap>(cap, "cap"), enum_of<LineJoin>(join, "join"),
            dashes, dash_offset};
}

void bind_flatten(py::module_& m) {
    m.def(
        "flatten",
        [](const CurveHandle& h, double tolerance, int segments, std::string_view method, bool polygons,
           std::size_t max_segments) {
            const FlattenOptions options{enum_of<FlattenMethod>(method, "method"), tolerance, segments,
                                         polygons, max_segments};
            return std::visit([&](const auto& p) { return answer([&] { return flatten(p, options); }); },
                              *h.patch);
        },
        py::arg("curve"), py::arg("tolerance"), py::arg("segments"), py::arg("method"), py::arg("polygons"),
        py::arg("max_segments"));
    m.def(
        "compare_flattening",
        [](const CurveHandle& h, int segments) {
            return std::visit(
                [&](const auto& p) { return answer([&] { return compare_flattening(p, segments); }); },
                *h.patch);
        },
        py::arg("curve"), py::arg("segments"));
}

void bind_regions(py::module_& m) {
    using H = PathHandle;
    m.def(
        "combine",
        [](const H& a, std::string_view rule_a, const H& b, std::string_view rule_b,
           std::string_view operation, double tolerance) {
            const auto what =
                enum_of<RegionOperation>(operation == "union" ? "union_of" : operation, "operation");
            const Filled p{*a.path, enum_of<FillRule>(rule_a, "rule")},
                q{*b.path, enum_of<FillRule>(rule_b, "rule")};
            return answer([&] { return combine(p, q, what, {.tolerance = tolerance}); });
        },
        py::arg("a"), py::arg("rule_a"), py::arg("b"), py::arg("rule_b"), py::arg("operation"),
        py::arg("tolerance"));
    m.def(
        "region_of",
        [](const H& a, std::string_view rule, double tolerance) {
            const Filled p{*a.path, enum_of<FillRule>(rule, "rule")};
            return answer([&] { return region_of(p, {.tolerance = tolerance}); });
        },
        py::arg("path"), py::arg("rule"), py::arg("tolerance"));
    m.def(
        "signed_area", [](const H& a) { return answer([&] { return signed_area(*a.path); }); },
        py::arg("path"));
    m.def(
        "stroked",
        [](const H& a, double width, std::string_view cap, std::string_view join, double miter_limit,
           const std::vector<double>& dashes, double dash_offset, double tolerance) {
            const auto style = stroke_of(width, cap, join, miter_limit, dashes, dash_offset);
            return answer([&] { return stroked(*a.path, style, {.tolerance = tolerance}); });
        },
        py::arg("path"), py::arg("width"), py::arg("cap"), py::arg("join"), py::arg("miter_limit"),
        py::arg("dashes"), py::arg("dash_offset"), py::arg("tolerance"));
    m.def(
        "dashed",
        [](const H& a, const std::vector<double>& dashes, double dash_offset, double accuracy) {
            StrokeStyle style;
            style.dashes = dashes, style.dash_offset = dash_offset;
            return answer([&] { return dashed(*a.path, style, accuracy); });
        },
        py::arg("path"), py::arg("dashes"), py::arg("dash_offset"), py::arg("accuracy"));
    m.def(
        "grown",
        [](const H& a, std::string_view rule, double distance, std::string_view join, double miter_limit,
           double tolerance) {
            const Filled p{*a.path, enum_of<FillRule>(rule, "rule")};
            const OffsetStyle style{distance, enum_of<LineJoin>(join, "join"), miter_limit};
            return answer([&] { return grown(p, style, {.tolerance = tolerance}); });
        },
        py::arg("path"), py::arg("rule"), py::arg("distance"), py::arg("join"), py::arg("miter_limit"),
        py::arg("tolerance"));
}

}  // namespace

void bind_paths(py::module_& m) {
    using H = PathHandle;
    py::class_<H>(m, "PathHandle")
        .def(py::init([](std::string_view data) {
                 PathData read = parse_path_data(data);
                 if (read.stopped) throw Thrown{*read.stopped};
                 return H{std::make_shared<const Path>(std::move(read.path))};
             }),
             py::arg("data"))
        .def_static(
            "of_curve",
            [](const CurveHandle& h, double tolerance) {
                return visit_dims<2, 2>(*h.patch, "curve", [&](const auto& p) -> py::object {
                    auto s = take(unlocked([&] { return subpath_of(p, tolerance); }));
                    return py::make_tuple(to_py(Path{{std::move(s.subpath)}}), s.bound);
                });
            },
            py::arg("curve"), py::arg("tolerance"))
        .def_static(
            "ellipse",
            [](const Array& centre, double rx, double ry) {
                return to_py(Path{{ellipse(vec_of<2>(centre, "centre"), rx, ry)}});
            },
            py::arg("centre"), py::arg("rx"), py::arg("ry"))
        // [(start, closed, [(degree, points, weight)])]
        .def_static(
            "from_subpaths",
            [](const std::vector<std::tuple<Array, bool, std::vector<std::tuple<int, Array, double>>>>&
                   given) {
                Path path;
                for (const auto& [start, closed, segments] : given) {
                    Subpath s{vec_of<2>(start, "start"), {}, closed};
                    for (const auto& [degree, points, weight] : segments) {
                        const auto p = points_of<Vec<2>>(points, "points");
                        if (degree < 1 || degree > 3 || p.size() <= std::size_t(degree) || p.size() > 4 ||
                            !(weight > 0) || !std::isfinite(weight))
                            reject(RefusalKind::invalid, "segments",
                                   "need a degree from 1 to 3, its points and a positive weight");
                        PathSegment g{degree, {}, weight};
                        std::ranges::copy(p, g.points.begin());
                        for (const Vec<2>& x : p)
                            if (!is_finite(x)) reject(RefusalKind::nonfinite, "points", "are not finite");
                        s.segments.push_back(g);
                    }
                    path.subpaths.push_back(std::move(s));
                }
                return to_py(path);
            },
            py::arg("subpaths"))
        .def("data",
             [](const H& h) {
                 for (const Subpath& s : h.path->subpaths)
                     for (const PathSegment& g : s.segments)
                         if (g.weight > 1)
                             reject(RefusalKind::unsupported, "path",
                                    "has an arc of a hyperbola, which SVG has not");
                 return path_data(*h.path);
             })
        .def("subpaths", [](const H& h) { return to_py(h.path->subpaths); })
        .def("curves",
             [](const H& h) {
                 py::list list;
                 for (const Subpath& s : h.path->subpaths)
                     if (!s.segments.empty()) list.append(to_py(curve_of(s)));
                 return list;
             })
        .def(
            "transformed",
            [](const H& h, const Array& linear, const Array& offset) {
                if (linear.ndim() != 2 || linear.shape(0) != 2 || linear.shape(1) != 2)
                    reject(RefusalKind::invalid, "linear", "is not a 2 x 2 matrix");
                Affinity<2> map;
                for (int i = 0; i < 2; ++i)
                    for (int k = 0; k < 2; ++k) map.linear[std::size_t(i)][std::size_t(k)] = linear.at(i, k);
                map.offset = vec_of<2>(offset, "offset");
                return to_py(transformed(*h.path, map));
            },
            py::arg("linear"), py::arg("offset"))
        .def(
            "simplified",
            [](const H& h, double tolerance, double corner) {
                return answer([&] { return simplified(*h.path, {tolerance, corner}); });
            },
            py::arg("tolerance"), py::arg("corner"));
    bind_flatten(m);
    bind_regions(m);
    m.def(
        "read_svg_picture", [](std::string_view bytes) { return answer([&] { return read_svg(bytes); }); },
        py::arg("bytes"));
}

}  // namespace freiform::python
