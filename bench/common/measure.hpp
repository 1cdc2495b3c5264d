// Looks at a tessellation from outside: the same code, which uses nothing of any tessellator, measures all of
// them.
#pragma once
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace freiform::bench {

using Point = std::array<double, 3>;

// The triangles of one face, the parameters of their corners, and the surface that they stand for.
struct FaceTriangles {
    std::vector<Point> points;
    std::vector<std::array<double, 2>> uv;      // of each point; empty if the tessellator does not tell
    std::vector<std::array<int, 3>> triangles;  // indices into points
    std::function<Point(double, double)> surface;
};

struct Deviation {
    double largest = 0;  // from a sample on the surface to the nearest triangle of its face
    int face = -1;       // where that is
    long long over = 0;  // triangles with a sample further away than the tolerance
    long long samples = 0;
};

// Ten samples inside every triangle, evenly spread over its parameters. A sample counts for the nearest
// triangle of the whole face, not for its own: parameters say nothing about which triangle covers a point in
// space.
Deviation deviation(const std::vector<FaceTriangles>& faces, double tolerance);

struct Welded {
    long long open = 0;          // edges used by one triangle
    long long non_manifold = 0;  // by more than two
    long long degenerate = 0;    // triangles with two equal corners
};

// Points closer than `distance` become one; the edges of what is left are counted.
Welded weld(const std::vector<FaceTriangles>& faces, double distance);

// The share of triangles whose smallest angle, in degrees, is below each limit.
std::vector<double> smallest_angles(const std::vector<FaceTriangles>& faces,
                                    const std::vector<double>& limits);

long long triangle_count(const std::vector<FaceTriangles>& faces);

// Seconds of wall clock and of the processor (all threads of this process).
struct Seconds {
    double wall = 0, processor = 0;
};
Seconds now();

// Runs `job` until `repetitions` are done, or two of them and `budget` seconds are over; the times of each.
std::vector<Seconds> repeat(int repetitions, double budget, const std::function<void()>& job);

}  // namespace freiform::bench
