// What the programs of the comparison are asked and print in the same words, for tools/bench_report.py.
#pragma once
#include "measure.hpp"

#include <freiform/io/json.hpp>

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace freiform::bench {

inline std::optional<double> number(std::string_view s) {
    double x = 0;
    const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), x);
    if (error != std::errc() || end != s.data() + s.size()) return std::nullopt;
    return x;
}

// FILE --relative R [--diagonal D] [--repetitions N] [--times-only]
struct Arguments {
    std::string file;
    double relative = 0, diagonal = 0;
    int repetitions = 5;
    bool times_only = false, sew = false;
};

inline std::optional<Arguments> parse(int count, char** values) {
    Arguments a;
    for (int i = 1; i < count; ++i) {
        const std::string_view v = values[i];
        if (v == "--times-only") {
            a.times_only = true;
        } else if (v == "--sew") {
            a.sew = true;
        } else if (v.starts_with("--") && i + 1 < count) {
            const std::optional<double> x = number(values[++i]);
            if (!x) return std::nullopt;
            if (v == "--relative")
                a.relative = *x;
            else if (v == "--diagonal")
                a.diagonal = *x;
            else if (v == "--repetitions")
                a.repetitions = int(*x);
            else
                return std::nullopt;
        } else {
            a.file = v;
        }
    }
    if (a.file.empty() || !(a.relative > 0)) return std::nullopt;
    return a;
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
