// What the programs of the comparison print in the same words, for tools/bench_report.py.
#pragma once
#include "measure.hpp"

#include <freiform/io/json.hpp>

#include <charconv>
#include <optional>
#include <string_view>

namespace freiform::bench {

inline std::optional<double> number(std::string_view s) {
    double x = 0;
    const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), x);
    if (error != std::errc() || end != s.data() + s.size()) return std::nullopt;
    return x;
}

// The times of a tessellation, one array for each clock, in milliseconds.
inline void write_times(json::Writer& w, std::string_view name, const std::vector<Seconds>& times) {
    std::vector<double> wall, processor;
    for (const Seconds& s : times) wall.push_back(1e3 * s.wall), processor.push_back(1e3 * s.processor);
    w.key(name).begin_object();
    w.key("wall_ms").array(wall).key("processor_ms").array(processor).end_object();
}

// What can be seen from outside.
inline void write_measured(json::Writer& w, const std::vector<FaceTriangles>& faces, double tolerance,
                           double diagonal) {
    const Deviation d = deviation(faces, tolerance);
    const Welded e = weld(faces, 1e-7 * diagonal);
    const std::vector<double> limits{1, 5, 10, 20};
    w.field("triangles", triangle_count(faces));
    w.field("deviation", d.largest).field("deviation_face", d.face).field("over_tolerance", d.over);
    w.field("samples", d.samples);
    w.field("open_edges", e.open)
        .field("non_manifold_edges", e.non_manifold)
        .field("degenerate_triangles", e.degenerate);
    w.key("angle_limits").array(limits).key("angles_below").array(smallest_angles(faces, limits));
}

}  // namespace freiform::bench
