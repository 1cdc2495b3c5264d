// Drawings and path data that are written and read again are the same curves, to 1e-9 of their boxes and far
// below. FREIFORM_TABLE=1 prints the rows of the table in docs/svg.md.
#include <freiform/io/file.hpp>
#include <freiform/io/svg.hpp>

#include <corpus.hpp>
#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>

namespace freiform {
namespace {

struct RoundTrip {
    int drawings = 0, shapes = 0, segments = 0, arcs = 0, left_out = 0;
    double worst = 0;  // largest distance between points of equal parameters, over the larger side of the box
};

void print_row(std::string_view name, const RoundTrip& sum) {
    std::puts(text("| ", name, " | ", sum.drawings, " | ", sum.shapes, " | ", sum.segments, " | ", sum.arcs,
                   " | ", sum.worst, " | ", sum.left_out, " |")
                  .c_str());
}

// Points of equal parameters are this near. With the weight w of the middle point, d curve / d w is
// (share of the middle point) / w (middle point - curve): at most the diameter of the control points over w.
double distance_bound(const PathSegment& a, const PathSegment& b) {
    double apart = 0, diameter = 0;
    for (std::size_t i = 0; i <= std::size_t(a.degree); ++i) {
        apart = std::max(apart, norm(a.points[i] - b.points[i]));
        for (std::size_t j = 0; j < i; ++j) diameter = std::max(diameter, norm(a.points[i] - a.points[j]));
    }
    return apart + diameter * std::abs(a.weight - b.weight) / std::min(a.weight, b.weight);
}

void compare(const Path& a, const Path& b, double size, RoundTrip& sum) {
    ASSERT_EQ(a.subpaths.size(), b.subpaths.size());
    for (std::size_t i = 0; i < a.subpaths.size(); ++i) {
        const Subpath &s = a.subpaths[i], &t = b.subpaths[i];
        ASSERT_EQ(s.segments.size(), t.segments.size());
        EXPECT_EQ(s.closed, t.closed);
        for (std::size_t k = 0; k < s.segments.size(); ++k) {
            ASSERT_EQ(s.segments[k].degree, t.segments[k].degree);
            ++sum.segments, sum.arcs += s.segments[k].weight != 1;
            sum.worst = std::max(sum.worst, distance_bound(s.segments[k], t.segments[k]) / size);
        }
    }
}

// The larger side of the box of the ends of all segments, which is not larger than that of the drawing.
double size_of(const Path& path, Box<2>& box) {
    for (const Subpath& s : path.subpaths) {
        box.add(s.start);
        for (const PathSegment& segment : s.segments) box.add(segment.back());
    }
    return box.is_empty() ? 0 : max_abs(box.hi - box.lo);
}

TEST(SvgRoundTrip, real_drawings_come_back_the_same) {
    FF_CORPUS_OR_SKIP(folder, "svg");
    std::map<std::string, RoundTrip> kinds;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".svg") continue;
        SCOPED_TRACE(entry.path());
        const auto bytes = read_file(entry.path().string(), 1 << 24);
        ASSERT_TRUE(bytes);
        const auto first = read_svg(*bytes);
        ASSERT_TRUE(first) << first.error().where << ' ' << first.error().message;
        const auto again = read_svg(write_svg(*first));
        ASSERT_TRUE(again);
        ASSERT_EQ(again->shapes.size(), first->shapes.size());
        EXPECT_TRUE(again->left_out.empty());
        Box<2> box;
        double size = 0;
        for (const SvgShape& s : first->shapes) size = size_of(s.path, box);
        const std::string name = entry.path().stem().string();
        RoundTrip& sum = kinds[name.substr(0, name.find('_', name.find('_') + 1))];
        ++sum.drawings, sum.left_out += int(first->left_out.size()), sum.shapes += int(first->shapes.size());
        for (std::size_t i = 0; i < first->shapes.size(); ++i)
            compare(first->shapes[i].path, again->shapes[i].path, size, sum);
    }
    RoundTrip all;
    for (const auto& [kind, sum] : kinds) {
        EXPECT_LT(sum.worst, 1e-9) << kind;
        all.drawings += sum.drawings, all.segments += sum.segments;
        if (std::getenv("FREIFORM_TABLE") != nullptr) print_row(kind, sum);
    }
    EXPECT_GE(all.drawings, 80);
    EXPECT_GE(all.segments, 2000);
}

TEST(SvgRoundTrip, path_data_come_back_the_same) {
    FF_CORPUS_OR_SKIP(oracle, "oracle/svg_lengths_open.json");
    const auto known = nlohmann::json::parse(*read_file(oracle.string(), 1 << 24));
    RoundTrip sum;
    for (const auto& c : known["cases"]) {
        if (!c.contains("d")) continue;
        const std::string d = c["d"].get<std::string>();
        SCOPED_TRACE(d);
        const Path path = parse_path_data(d).path;
        const PathData again = parse_path_data(path_data(path));
        EXPECT_FALSE(again.stopped);
        Box<2> box;
        const double size = size_of(path, box);
        ++sum.drawings;
        if (size > 0) compare(path, again.path, size, sum);
    }
    EXPECT_LT(sum.worst, 1e-9);
    EXPECT_GE(sum.drawings, 80);
    if (std::getenv("FREIFORM_TABLE") != nullptr) print_row("path data", sum);
}

}  // namespace
}  // namespace freiform
