// What interpolate and fit share: points in, one spline and a report out.
#pragma once
#include "command.hpp"

#include <freiform/io/points.hpp>

namespace freiform::cli {

// The points of a table as vectors: calls f(std::vector<Vec<D>>) for its number of coordinates.
template <class F>
Result<void> with_points(const PointTable& t, F&& f) {
    const auto call = [&]<int D>(std::integral_constant<int, D>) {
        std::vector<Vec<D>> points(t.place.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t c = 0; c < D; ++c) points[i][int(c)] = t.values[i * D + c];
        return f(std::move(points));
    };
    switch (t.coords) {
        case 1:
            return call(std::integral_constant<int, 1>{});
        case 2:
            return call(std::integral_constant<int, 2>{});
        case 3:
            return call(std::integral_constant<int, 3>{});
        default:
            return call(std::integral_constant<int, 4>{});
    }
}

// A refusal of the library about points[i], said about the line or place in the file.
std::unexpected<Refusal> about_file(Refusal r, const PointTable& t, const std::string& file);

// The format that -o or --to asks for, "json" or "bpt"; else wrong usage.
std::string spline_format(const Context& context, const std::string& command);

// Vectors "1,0,0;0,1,0"; wrong usage if one has not `coords` numbers.
std::vector<std::vector<double>> parse_vectors(const std::string& option, std::string_view s, int coords);

// Writes the spline; then, if that went to a file, the report to standard output.
Result<void> emit_spline(const Context& context, const std::string& format, Document document,
                         const std::string& text_report, const std::string& json_report);

}  // namespace freiform::cli
