// Animation: easings, key frames, rotations, motions along curves.
#include "records/animate/motion.hpp"
#include "records/animate/rotation.hpp"
#include "records/io/gltf_animation.hpp"
#include "records/query/length.hpp"

#include <freiform/animate/easing.hpp>
#include <freiform/animate/keys.hpp>

namespace freiform::python {
namespace {

using Four = std::array<double, 4>;
Quaternion quaternion(const Four& q) { return {q[0], q[1], q[2], q[3]}; }
py::tuple four(const Quaternion& q) { return py::make_tuple(q.x, q.y, q.z, q.w); }

void bind_easing(py::module_& m) {
    using E = CubicBezierEasing;
    py::class_<E>(m, "EasingHandle")
        .def_static(
            "make", [](double x1, double y1, double x2, double y2) { return take(E::make(x1, y1, x2, y2)); },
            py::arg("x1"), py::arg("y1"), py::arg("x2"), py::arg("y2"))
        .def_static(
            "named", [](std::string_view name) { return take(E::named(name)); }, py::arg("name"))
        .def_property_readonly("handles", [](const E& e) { return e.handles(); })
        .def(
            "evaluate",
            [](const E& e, const Array& x) {
                const std::vector<py::ssize_t> shape(x.shape(), x.shape() + x.ndim());
                py::array_t<double> value(shape), bound(shape);
                for (py::ssize_t i = 0; i < x.size(); ++i) {
                    const Bounded y = e(x.data()[i]);
                    value.mutable_data()[i] = y.value, bound.mutable_data()[i] = y.bound;
                }
                return py::make_tuple(value, bound);
            },
            py::arg("x"));
    m.def(
        "step_easing",
        [](const Array& x, int count, std::string_view jump) {
            const StepJump j = enum_of<StepJump>(jump, "jump");
            if (count < (j == StepJump::neither ? 2 : 1))
                reject(RefusalKind::invalid, "count", "is too small");
            const std::vector<py::ssize_t> shape(x.shape(), x.shape() + x.ndim());
            py::array_t<double> value(shape);
            for (py::ssize_t i = 0; i < x.size(); ++i)
                value.mutable_data()[i] = step_easing(x.data()[i], count, j);
            return value;
        },
        py::arg("x"), py::arg("count"), py::arg("jump"));
}

struct TrackHandle {
    std::variant<Track<1>, Track<2>, Track<3>, Track<4>> track;
};
// Keys: (time, value, next, arriving, leaving, before, after, easing); None where it is not given.
template <int D>
Key<D> key_of(const py::tuple& k, std::size_t i) {
    const std::string where = text("keys[", i, "]");
    Key<D> key;
    key.time = k[0].cast<double>();
    key.value = vec_of<D>(k[1].cast<Array>(), where);
    key.next = enum_of<Between>(k[2].cast<std::string>(), where);
    if (!k[3].is_none()) key.arriving = vec_of<D>(k[3].cast<Array>(), where);
    if (!k[4].is_none()) key.leaving = vec_of<D>(k[4].cast<Array>(), where);
    const auto handle = [&](const py::handle& h, typename Key<D>::Handle& to) {
        if (h.is_none()) return;
        const auto pair = h.cast<std::pair<double, Array>>();
        to = {pair.first, vec_of<D>(pair.second, where)};
    };
    handle(k[5], key.before), handle(k[6], key.after);
    if (!k[7].is_none()) key.easing = k[7].cast<Four>();
    return key;
}

void bind_tracks(py::module_& m) {
    py::class_<TrackHandle>(m, "TrackHandle")
        .def(py::init([](const std::vector<py::tuple>& keys, std::string_view outside, bool tangents) {
                 const auto beyond = enum_of<BeyondKeys>(outside, "outside");
                 if (keys.empty()) reject(RefusalKind::invalid, "keys", "are none");
                 return with_dimension(keys[0][1].cast<Array>().size(), "keys[0]", [&](auto d) {
                     constexpr int D = decltype(d)::value;
                     std::vector<Key<D>> all;
                     for (std::size_t i = 0; i < keys.size(); ++i) all.push_back(key_of<D>(keys[i], i));
                     if (tangents) {
                         take(Track<D>::make(all, beyond));
                         set_tangents<D>(all);
                     }
                     return TrackHandle{take(Track<D>::make(std::move(all), beyond))};
                 });
             }),
             py::arg("keys"), py::arg("outside"), py::arg("tangents"))
        .def("times",
             [](const TrackHandle& h) {
                 return std::visit([](const auto& t) { return to_py(t.times()); }, h.track);
             })
        .def(
            "evaluate",
            [](const TrackHandle& h, const Array& times) {
                return std::visit(
                    [&](const auto& t) {
                        using V = decltype(t(0.0));
                        std::vector<V> value(std::size_t(times.size()));
                        std::vector<double> bound(value.size());
                        unlocked(
                            [&] { return t.evaluate(numbers_of(times), std::span<V>(value), bound), 0; });
                        std::vector<py::ssize_t> shape(times.shape(), times.shape() + times.ndim());
                        auto bounds = array_of(bound.data(), shape);
                        shape.push_back(V::kCoords);
                        return py::make_tuple(array_of(value.empty() ? nullptr : value[0].c.data(), shape),
                                              bounds);
                    },
                    h.track);
            },
            py::arg("times"))
        .def("curve", [](const TrackHandle& h) {
            return std::visit([](const auto& t) { return answer([&] { return t.curve(); }); }, h.track);
        });
    py::class_<RotationTrack>(m, "RotationTrackHandle")
        .def(py::init(
                 [](const std::vector<double>& times, const std::vector<Four>& keys, std::string_view kind) {
                     std::vector<Quaternion> all;
                     for (const Four& q : keys) all.push_back(quaternion(q));
                     return take(RotationTrack::make(times, all, enum_of<RotationTrack::Kind>(kind, "kind")));
                 }),
             py::arg("times"), py::arg("keys"), py::arg("kind"))
        .def("times", [](const RotationTrack& t) { return to_py(t.times()); })
        .def(
            "evaluate",
            [](const RotationTrack& t, const Array& times) {
                std::vector<Quaternion> found(std::size_t(times.size()));
                t.evaluate(numbers_of(times), found);
                std::vector<py::ssize_t> shape(times.shape(), times.shape() + times.ndim());
                shape.push_back(4);
                return array_of(found.empty() ? nullptr : &found[0].x, shape);
            },
            py::arg("times"));
    m.def(
        "slerp",
        [](const Four& a, const Four& b, double t) { return four(slerp(quaternion(a), quaternion(b), t)); },
        py::arg("a"), py::arg("b"), py::arg("t"));
    m.def(
        "turn_about",
        [](const Array& axis, double angle) { return four(turn_about(vec_of<3>(axis, "axis"), angle)); },
        py::arg("axis"), py::arg("angle"));
    m.def(
        "rotated",
        [](const Four& q, const Array& v) { return to_py(rotated(quaternion(q), vec_of<3>(v, "v"))); },
        py::arg("q"), py::arg("v"));
    m.def(
        "angle_between",
        [](const Four& a, const Four& b) { return angle_between(quaternion(a), quaternion(b)); },
        py::arg("a"), py::arg("b"));
}

void bind_motion(py::module_& m) {
    py::class_<Motion>(m, "MotionHandle")
        .def_static(
            "uniform", [](double length, double duration) { return take(Motion::uniform(length, duration)); },
            py::arg("length"), py::arg("duration"))
        .def_static(
            "limited",
            [](double length, double speed, double acceleration, double jerk) {
                return take(Motion::limited(length, {speed, acceleration, jerk}));
            },
            py::arg("length"), py::arg("speed"), py::arg("acceleration"), py::arg("jerk"))
        .def_static(
            "with_speed",
            [](const CurveHandle& v, double accuracy) {
                const auto curve = as<Vec<1>, 1>(*v.patch, "speed");
                return take(unlocked([&] { return Motion::with_speed(curve, accuracy); }));
            },
            py::arg("speed"), py::arg("accuracy"))
        .def_static(
            "along",
            [](const CurveHandle& h, double speed, double acceleration, double across, double jerk,
               double accuracy) {
                const BendLimits limits{speed, acceleration, across, jerk};
                std::optional<Motion> made;
                visit_dims<2, 3>(*h.patch, "curve", [&](const auto& p) -> py::object {
                    made = take(unlocked([&] { return Motion::along(p, limits, accuracy); }));
                    return py::none();
                });
                return *made;
            },
            py::arg("curve"), py::arg("speed"), py::arg("acceleration"), py::arg("across"), py::arg("jerk"),
            py::arg("accuracy"))
        .def_property_readonly("duration", &Motion::duration)
        .def_property_readonly("length", &Motion::length)
        .def(
            "at", [](const Motion& motion, double time) { return to_py(motion.at(time)); }, py::arg("time"));
    py::class_<Trajectory>(m, "TrajectoryHandle")
        .def(py::init([](const CurveHandle& h, const Motion& motion, double accuracy, std::string_view facing,
                         const Array& up, double facing_accuracy) {
                 const TrajectoryOptions options{accuracy, enum_of<Facing>(facing, "facing"),
                                                 vec_of<3>(up, "up"), facing_accuracy};
                 std::optional<Trajectory> made;
                 visit_dims<2, 3>(*h.patch, "curve", [&](const auto& p) -> py::object {
                     made = take(unlocked([&] { return Trajectory::make(p, motion, options); }));
                     return py::none();
                 });
                 return *made;
             }),
             py::arg("curve"), py::arg("motion"), py::arg("accuracy"), py::arg("facing"), py::arg("up"),
             py::arg("facing_accuracy"))
        .def_property_readonly("duration", &Trajectory::duration)
        .def("length", [](const Trajectory& t) { return to_py(t.length()); })
        .def(
            "at", [](const Trajectory& t, double time) { return answer([&] { return t.at(time); }); },
            py::arg("time"));
    m.def(
        "read_gltf_animations",
        [](std::string_view bytes, const std::string& folder) {
            return answer([&] { return read_gltf_animations(bytes, folder); });
        },
        py::arg("data"), py::arg("folder"));
    m.def(
        "to_animated_glb",
        [](const Array& times, const Array& places, const Array& velocities, const Array& facing,
           const Array& line, const std::string& name, double size) {
            const auto list = [](const Array& a, const char* where) {
                const auto p = points_of<Vec<3>>(a, where);
                return std::vector<Vec<3>>(p.begin(), p.end());
            };
            const auto t = numbers_of(times);
            GltfMotion motion{name,
                              size,
                              {t.begin(), t.end()},
                              list(places, "places"),
                              list(velocities, "velocities"),
                              {},
                              list(line, "line")};
            for (const Vec<4>& q : points_of<Vec<4>>(facing, "facing"))
                motion.facing.push_back({q[0], q[1], q[2], q[3]});
            return py::bytes(take(unlocked([&] { return to_animated_glb(motion); })));
        },
        py::arg("times"), py::arg("places"), py::arg("velocities"), py::arg("facing"), py::arg("line"),
        py::arg("name"), py::arg("size"));
}

}  // namespace

void bind_animate(py::module_& m) {
    bind_easing(m);
    bind_tracks(m);
    bind_motion(m);
}

}  // namespace freiform::python
