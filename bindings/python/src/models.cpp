// Solid models and trimmed surfaces.
#include "records/core/interval.hpp"
#include "records/intersect/contact.hpp"
#include "records/intersect/surface_surface.hpp"
#include "records/mesh/triangle_mesh.hpp"
#include "records/model/curve_model.hpp"
#include "records/model/deviation.hpp"
#include "records/model/distance.hpp"
#include "records/model/edge_continuity.hpp"
#include "records/model/inside.hpp"
#include "records/model/intersect.hpp"
#include "records/model/model.hpp"
#include "records/model/nearest.hpp"
#include "records/model/section.hpp"
#include "records/model/sew.hpp"
#include "records/model/surface_field.hpp"
#include "records/model/surface_lines.hpp"
#include "records/model/swept_solid.hpp"
#include "records/model/tessellate.hpp"
#include "records/query/bounds.hpp"
#include "records/query/hull.hpp"
#include "records/query/length.hpp"
#include "records/query/oriented_box.hpp"
#include "records/spline/geometry.hpp"

#include <freiform/io/model_binary.hpp>
#include <freiform/model/assemble.hpp>
#include <freiform/model/bounds.hpp>
#include <freiform/model/edge_length.hpp>
#include <freiform/model/pipe.hpp>
#include <freiform/model/rescale.hpp>
#include <freiform/trim/loops.hpp>

namespace freiform::python {
namespace {

using TrimLoops = std::vector<std::vector<CurveGeometry<2>>>;

ModelHandle model_handle(Model model) { return {std::make_shared<const Model>(std::move(model))}; }

TrimLoops loops_from(const std::vector<std::vector<CurveHandle>>& given) {
    TrimLoops loops;
    for (std::size_t i = 0; i < given.size(); ++i) {
        loops.emplace_back();
        for (const CurveHandle& h : given[i]) {
            if (common_of<1>(std::span(&h, 1)).rational)
                loops.back().push_back(as<Hom<2>, 1>(*h.patch, text("loops[", i, "]")));
            else
                loops.back().push_back(as<Vec<2>, 1>(*h.patch, text("loops[", i, "]")));
        }
    }
    return loops;
}
ModelBuilder::SplineSurface spline_of(const SurfaceHandle& h, std::string_view where) {
    if (common_of<2>(std::span(&h, 1)).rational) return as<Hom<3>, 2>(*h.patch, where);
    return as<Vec<3>, 2>(*h.patch, where);
}

TessellateOptions tessellate_options(double tolerance, double max_edge, double max_angle, double max_aspect,
                                     bool quads, bool as_planes, long long max_triangles) {
    return {tolerance, max_edge, max_angle, max_aspect, quads, as_planes, max_triangles};
}

// One answer for each point, as arrays in the order of the record's fields.
py::tuple columns(std::span<const ModelNearest> found, const std::vector<py::ssize_t>& shape) {
    const auto with = [&](py::ssize_t n) {
        auto s = shape;
        s.push_back(n);
        return py::array_t<double>(s);
    };
    py::array_t<std::int64_t> face(shape), edge(shape), vertex(shape);
    py::array_t<double> uv = with(2), t(shape), point = with(3), distance(shape), error(shape), bound(shape);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const ModelNearest& x = found[i];
        face.mutable_data()[i] = x.face;
        for (std::size_t k = 0; k < 2; ++k) uv.mutable_data()[2 * i + k] = x.uv[int(k)];
        edge.mutable_data()[i] = x.edge;
        vertex.mutable_data()[i] = x.vertex;
        t.mutable_data()[i] = x.t;
        for (std::size_t k = 0; k < 3; ++k) point.mutable_data()[3 * i + k] = x.point[int(k)];
        distance.mutable_data()[i] = x.distance;
        error.mutable_data()[i] = x.point_error;
        bound.mutable_data()[i] = x.lower_bound;
    }
    return py::make_tuple(face, uv, edge, vertex, t, point, distance, error, bound);
}

void bind_model_making(py::module_& m) {
    py::class_<TrimmedHandle>(m, "TrimmedHandle")
        .def(py::init([](const SurfaceHandle& s, const std::vector<std::vector<CurveHandle>>& loops) {
                 auto made = take(TrimmedSurface::make(spline_of(s, "surface"), loops_from(loops)));
                 return TrimmedHandle{std::make_shared<const TrimmedSurface>(std::move(made))};
             }),
             py::arg("surface"), py::arg("loops"))
        .def("surface", [](const TrimmedHandle& h) { return to_py(h.surface->surface); })
        .def("loops", [](const TrimmedHandle& h) { return to_py(h.surface->loops); })
        .def(
            "inside",
            [](const TrimmedHandle& h, const Array& points) {
                const auto p = points_of<Vec<2>>(points, "points");
                std::vector<Inside> found(p.size());
                const auto query = take(InsideQuery::make(h.surface->loops, kInfinity));
                unlocked([&] { return query.at(p, found), 0; });
                py::list places;
                py::array_t<int> winding(py::ssize_t(found.size()));
                for (std::size_t i = 0; i < found.size(); ++i) {
                    places.append(to_py(found[i].place));
                    winding.mutable_data()[i] = found[i].winding;
                }
                return py::make_tuple(places, winding);
            },
            py::arg("points"));
    // Faces of one body: surfaces and trimmed surfaces that share equal boundaries.
    m.def(
        "assemble",
        [](const py::list& surfaces, const std::string& unit, const std::string& name) {
            ModelBuilder builder(unit);
            for (const py::handle& s : surfaces) {
                if (py::isinstance<TrimmedHandle>(s)) {
                    const auto& t = *s.cast<const TrimmedHandle&>().surface;
                    take(builder.add_trimmed(t.surface, t.loops));
                } else {
                    take(builder.add(spline_of(s.cast<const SurfaceHandle&>(), "surfaces")));
                }
            }
            return model_handle(take(std::move(builder).finish(name)));
        },
        py::arg("surfaces"), py::arg("unit"), py::arg("name"));
    m.def(
        "prism",
        [](const PathHandle& p, const Array& by) {
            const Vec<3> v = vec_of<3>(by, "by");
            return answer([&] { return prism(loops_of(*p.path), v); });
        },
        py::arg("path"), py::arg("by"));
    m.def(
        "solid_of_revolution",
        [](const PathHandle& p, const Array& origin, const Array& direction, double angle) {
            const Axis axis{vec_of<3>(origin, "origin"), vec_of<3>(direction, "direction")};
            return answer([&] { return solid_of_revolution(loops_of(*p.path), axis, angle); });
        },
        py::arg("path"), py::arg("origin"), py::arg("direction"), py::arg("angle"));
    m.def(
        "solid_along",
        [](const PathHandle& p, const CurveHandle& rail, double tolerance, const Array& x_at_start) {
            const FrameSweepOptions options{tolerance, vec_of<3>(x_at_start, "x_at_start")};
            return visit_dims<3, 3>(*rail.patch, "rail", [&](const auto& r) {
                return answer([&] { return solid_along(loops_of(*p.path), r, options); });
            });
        },
        py::arg("path"), py::arg("rail"), py::arg("tolerance"), py::arg("x_at_start"));
    m.def(
        "pipe",
        [](const Array& corners, double radius, double hole, double bend, bool closed) {
            const auto at = points_of<Vec<3>>(corners, "corners");
            return answer([&]() -> Result<Model> {
                const auto rail = bent_polyline(at, bend, closed);
                if (!rail) return std::unexpected(rail.error());
                return pipe(*rail, radius, hole);
            });
        },
        py::arg("corners"), py::arg("radius"), py::arg("hole"), py::arg("bend"), py::arg("closed"));
    m.def(
        "inside_loops",
        [](const std::vector<std::vector<CurveHandle>>& loops, double gap, const Array& points) {
            const auto p = points_of<Vec<2>>(points, "points");
            std::vector<Inside> found(p.size());
            const auto query = take(InsideQuery::make(loops_from(loops), gap));
            unlocked([&] { return query.at(p, found), 0; });
            py::list places;
            py::array_t<int> winding(py::ssize_t(found.size()));
            for (std::size_t i = 0; i < found.size(); ++i) {
                places.append(to_py(found[i].place));
                winding.mutable_data()[i] = found[i].winding;
            }
            return py::make_tuple(places, winding);
        },
        py::arg("loops"), py::arg("gap"), py::arg("points"));
    m.def(
        "orient_loops",
        [](const std::vector<std::vector<CurveHandle>>& loops, double gap, double accuracy) {
            auto found = take(unlocked([&] { return orient_loops(loops_from(loops), {gap, accuracy}); }));
            return py::make_tuple(to_py(found.loops), to_py(found.depth), to_py(found.reversed));
        },
        py::arg("loops"), py::arg("gap"), py::arg("accuracy"));
}

void bind_model_questions(py::module_& m) {
    m.def(
        "model_summary", [](const ModelHandle& h) { return answer([&] { return summary(*h.model); }); },
        py::arg("model"));
    m.def(
        "model_tight_box",
        [](const ModelHandle& h, double accuracy, int max_parts) {
            return answer([&] { return tight_box(*h.model, accuracy, max_parts); });
        },
        py::arg("model"), py::arg("accuracy"), py::arg("max_parts"));
    m.def(
        "model_oriented_box",
        [](const ModelHandle& h, double accuracy, int max_parts) {
            return answer([&] { return oriented_box(*h.model, accuracy, max_parts); });
        },
        py::arg("model"), py::arg("accuracy"), py::arg("max_parts"));
    m.def(
        "model_rescaled",
        [](const ModelHandle& h, int exponent) {
            return answer([&] { return rescaled(*h.model, exponent); });
        },
        py::arg("model"), py::arg("exponent"));
    m.def(
        "model_divided",
        [](const ModelHandle& h, double by) { return answer([&] { return divided(*h.model, by); }); },
        py::arg("model"), py::arg("by"));
    m.def(
        "model_sew",
        [](const ModelHandle& h, double tolerance) {
            return answer([&] { return sew(*h.model, {tolerance}); });
        },
        py::arg("model"), py::arg("tolerance"));
    m.def(
        "model_edge_lengths",
        [](const ModelHandle& h, double accuracy) {
            return answer([&] { return edge_lengths(*h.model, accuracy); });
        },
        py::arg("model"), py::arg("accuracy"));
    m.def(
        "model_edge_continuity",
        [](const ModelHandle& h, double gap, double angle, double curvature, int max_parts) {
            return answer([&] { return edge_continuity(*h.model, {gap, angle, curvature, max_parts}); });
        },
        py::arg("model"), py::arg("gap"), py::arg("angle"), py::arg("curvature"), py::arg("max_parts"));
    m.def(
        "model_inside",
        [](const ModelHandle& h, const Array& points, double accuracy, long long max_triangles) {
            return answer([&] {
                return inside_solid(*h.model, points_of<Vec<3>>(points, "points"), accuracy, max_triangles);
            });
        },
        py::arg("model"), py::arg("points"), py::arg("accuracy"), py::arg("max_triangles"));
    m.def(
        "model_intersect",
        [](const ModelHandle& a, const ModelHandle& b, double tolerance, int max_pairs) {
            return answer([&] {
                return intersect(*a.model, *b.model, SurfaceIntersectOptions{tolerance, max_pairs});
            });
        },
        py::arg("a"), py::arg("b"), py::arg("tolerance"), py::arg("max_pairs"));
    m.def(
        "model_convex_hull",
        [](const ModelHandle& h, double tolerance, int max_parts) {
            return answer([&] { return convex_hull(*h.model, tolerance, max_parts); });
        },
        py::arg("model"), py::arg("tolerance"), py::arg("max_parts"));
    m.def(
        "model_intersect_curve",
        [](const ModelHandle& h, const CurveHandle& c, double accuracy, int max_parts) {
            const auto curve = as<Hom<3>, 1>(*c.patch, "curve");
            return answer([&] { return IntersectModel(*h.model).intersect(curve, {accuracy, max_parts}); });
        },
        py::arg("model"), py::arg("curve"), py::arg("accuracy"), py::arg("max_parts"));
    // Lines point + t direction, t in on.
    m.def(
        "model_intersect_lines",
        [](const ModelHandle& h, const Array& points, const Array& directions, std::pair<double, double> on,
           double accuracy, int max_parts) {
            const auto from = points_of<Vec<3>>(points, "points"),
                       along = points_of<Vec<3>>(directions, "directions");
            if (from.size() != along.size())
                reject(RefusalKind::invalid, "directions",
                       text(along.size(), " for ", from.size(), " points"));
            std::vector<StraightLine> lines;
            for (std::size_t i = 0; i < from.size(); ++i)
                lines.push_back({from[i], along[i], interval_of(on)});
            std::vector<ModelContacts> found(lines.size());
            take(unlocked([&] {
                return IntersectModel(*h.model).intersect(lines, found, {accuracy, max_parts});
            }));
            return to_py(found);
        },
        py::arg("model"), py::arg("points"), py::arg("directions"), py::arg("on"), py::arg("accuracy"),
        py::arg("max_parts"));
    m.def(
        "model_section",
        [](const ModelHandle& h, const Array& normal, double offset, double tolerance,
           long long max_triangles) {
            const Plane plane{vec_of<3>(normal, "normal"), offset};
            TessellateOptions options{tolerance};
            options.max_triangles = max_triangles;
            return answer([&] { return section(*h.model, plane, options); });
        },
        py::arg("model"), py::arg("normal"), py::arg("offset"), py::arg("tolerance"),
        py::arg("max_triangles"));
    m.def(
        "model_deviation",
        [](const ModelHandle& h, const MeshHandle& mesh, double enough, std::size_t max_parts) {
            return answer([&] { return deviation(*h.model, *mesh.mesh, {enough, max_parts}); });
        },
        py::arg("model"), py::arg("mesh"), py::arg("enough"), py::arg("max_parts"));
    py::class_<ModelNearestQuery>(m, "ModelNearestHandle")
        .def(py::init([](const ModelHandle& h) {
                 return take(unlocked([&] { return ModelNearestQuery::make(*h.model); }));
             }),
             py::arg("model"))
        .def(
            "nearest",
            [](const ModelNearestQuery& q, const Array& points, double accuracy, int max_parts) {
                const auto p = points_of<Vec<3>>(points, "points");
                std::vector<ModelNearest> found(p.size());
                take(unlocked([&] {
                    return q.nearest(p, std::span<ModelNearest>(found), {accuracy, max_parts});
                }));
                return columns(found, {points.shape(), points.shape() + points.ndim() - 1});
            },
            py::arg("points"), py::arg("accuracy"), py::arg("max_parts"))
        .def(
            "farthest",
            [](const ModelNearestQuery& q, const Array& point, double accuracy, int max_parts) {
                const Vec<3> p = vec_of<3>(point, "point");
                return answer([&] { return q.farthest(p, {accuracy, max_parts}); });
            },
            py::arg("point"), py::arg("accuracy"), py::arg("max_parts"))
        .def(
            "nearest_faces",
            [](const ModelNearestQuery& q, const Array& point, int count, double radius) {
                const Vec<3> p = vec_of<3>(point, "point");
                return answer([&] { return q.nearest_faces(p, count, radius); });
            },
            py::arg("point"), py::arg("count"), py::arg("radius"))
        .def(
            "least_distance",
            [](const ModelNearestQuery& a, const ModelNearestQuery& b, double accuracy, int max_pairs) {
                return answer([&] { return least_distance(a, b, {accuracy, max_pairs}); });
            },
            py::arg("other"), py::arg("accuracy"), py::arg("max_pairs"));
}

void bind_tessellate(py::module_& m) {
    m.def(
        "tessellate",
        [](const ModelHandle& h, double tolerance, double max_edge, double max_angle, double max_aspect,
           bool quads, bool as_planes, long long max_triangles) {
            const auto options = tessellate_options(tolerance, max_edge, max_angle, max_aspect, quads,
                                                    as_planes, max_triangles);
            return answer([&] { return tessellate(*h.model, options); });
        },
        py::arg("model"), py::arg("tolerance"), py::arg("max_edge"), py::arg("max_angle"),
        py::arg("max_aspect"), py::arg("quads"), py::arg("as_planes"), py::arg("max_triangles"));
    m.def(
        "surface_field",
        [](const ModelHandle& h, const MeshHandle& mesh, std::string_view field) {
            const auto f = enum_of<SurfaceField>(field, "field");
            return answer([&] { return surface_field(*h.model, *mesh.mesh, f); });
        },
        py::arg("model"), py::arg("mesh"), py::arg("field"));
    m.def(
        "isolines",
        [](const ModelHandle& h, const MeshHandle& mesh, std::optional<int> count) {
            return answer([&] { return isolines(*h.model, *mesh.mesh, count); });
        },
        py::arg("model"), py::arg("mesh"), py::arg("count"));
    m.def(
        "silhouettes",
        [](const ModelHandle& h, const MeshHandle& mesh, const Array& eye) {
            const Vec<3> e = unit(vec_of<3>(eye, "eye"));
            return answer([&] { return silhouettes(*h.model, *mesh.mesh, e); });
        },
        py::arg("model"), py::arg("mesh"), py::arg("eye"));
}

}  // namespace

void bind_models(py::module_& m) {
    py::class_<ModelHandle>(m, "ModelHandle")
        .def("to_binary", [](const ModelHandle& h) { return py::bytes(to_binary(*h.model)); })
        .def_static(
            "from_binary", [](std::string_view bytes) { return model_handle(take(from_binary(bytes))); },
            py::arg("data"))
        .def_property_readonly("unit", [](const ModelHandle& h) { return h.model->unit; })
        .def("refused", [](const ModelHandle& h) { return to_py(h.model->refused); })
        .def("approximations", [](const ModelHandle& h) { return to_py(h.model->approximations); })
        .def("layers", [](const ModelHandle& h) { return to_py(h.model->layers); })
        .def("face_layers",
             [](const ModelHandle& h) {
                 std::vector<std::vector<int>> all;
                 for (const Face& f : h.model->faces) all.push_back(f.layers);
                 return all;
             })
        .def("body_layers",
             [](const ModelHandle& h) {
                 std::vector<std::vector<int>> all;
                 for (const Body& b : h.model->bodies) all.push_back(b.layers);
                 return all;
             })
        .def("repairs", [](const ModelHandle& h) { return to_py(h.model->repairs); })
        .def("vertices",
             [](const ModelHandle& h) {
                 std::vector<Vec<3>> p;
                 for (const Vertex& v : h.model->vertices) p.push_back(v.point);
                 return to_py(p);
             })
        .def("faces",
             [](const ModelHandle& h) {
                 py::list list;
                 for (const Face& f : h.model->faces)
                     list.append(
                         py::make_tuple(f.name, to_py(kind_name(f.surface)), f.reversed, to_py(f.colour)));
                 return list;
             })
        .def("edges", [](const ModelHandle& h) {
            py::list list;
            for (const Edge& e : h.model->edges)
                list.append(py::make_tuple(e.curve ? to_py(*e.curve) : py::none(), to_py(e.range), e.start,
                                           e.end, e.degenerate, e.name, to_py(e.colour)));
            return list;
        });
    bind_model_making(m);
    bind_model_questions(m);
    bind_tessellate(m);
}

}  // namespace freiform::python
