// libFuzzer: the constrained Delaunay triangulation of arbitrary loops. Not part of the test suite; with
// clang,
//   tests/fuzz/run.sh triangulate 300
// builds and runs it for 300 seconds.
//
// Checked is what the header promises: a refusal names a conflict, or all triangles turn left, the inside
// ones have the area of the odd-even rule along the constrained edges (each segment is there), and points
// inserted later keep all that.
#include "bytes.hpp"

#include <freiform/mesh/triangulate.hpp>
#include <freiform/poly/predicates.hpp>

using namespace freiform;

namespace {

// Small integers, so that points coincide and lie on lines, or any double.
double number(Bytes& bytes, bool any) { return any ? bytes.any() : bytes.next() % 16; }

void check(const Triangulation& t) {
    for (int i = 0; i < t.size(); ++i) {
        if (!t.is_inside(i)) continue;
        const auto v = t.vertices(i);
        const auto p = [&](std::size_t k) { return t.points()[std::size_t(v[k])]; };
        demand(orient2d(p(0), p(1), p(2)) > 0);
        for (int e = 0; e < 3; ++e) {
            const int other = t.neighbour(i, e);
            // Inside ends at constrained edges only.
            if (other < 0 || !t.is_inside(other)) demand(t.is_constrained(i, e));
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes{data, size};
    const int kind = bytes.next();
    const bool any = kind % 4 == 0;
    std::vector<Vec<2>> points;
    std::vector<Triangulation::Segment> segments;
    const int loops = 1 + kind / 4 % 4;
    for (int l = 0; l < loops && bytes.left > 0; ++l) {
        const int first = int(points.size()), count = 1 + bytes.next() % 12;
        for (int i = 0; i < count; ++i) {
            const double x = number(bytes, any), y = number(bytes, any);
            points.push_back({{x, y}});
        }
        for (int i = 0; i < count; ++i) segments.push_back({first + i, first + (i + 1) % count});
    }
    auto t = Triangulation::attempt(points, segments);
    if (!t) {
        demand(!t.error().refusal.message.empty());
        return 0;
    }
    check(*t);
    for (const auto& s : segments) {
        if (t->size() == 0) break;  // all points on one line
        const auto e = t->find_edge(s.a, s.b);
        demand(e.triangle >= 0 && t->is_constrained(e.triangle, e.edge));
    }
    for (int i = 0; i < 16 && bytes.left > 0; ++i) {
        const double x = number(bytes, any), y = number(bytes, any);
        t->insert({{x + 0.5 * (i % 2), y + 0.25 * (i % 3)}});
    }
    check(*t);
    return 0;
}
