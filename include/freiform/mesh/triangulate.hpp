// Constrained Delaunay triangulations of regions of the plane, which grow by inserted points.
//
// The region is what the boundary segments enclose by the odd-even rule: islands in holes in islands, in any
// order and direction. All decisions are exact (poly/predicates), so a triangle is never inverted, whatever
// the points are, and coordinates times a power of two give the same triangles. Same input, same result, on
// every machine.
//
//     auto t = Triangulation::make(points, segments);
//     t->insert({{0.5, 0.5}});
//     for (int i = 0; i < t->size(); ++i)
//         if (t->is_inside(i)) use(t->vertices(i));
//
// Corners and edges of a triangle: counter-clockwise, and edge i is the one opposite to corner i.
//
//              2
//             / \                edge i leads from corner i + 1 to corner i + 2 (modulo 3),
//     edge 1 /   \ edge 0        neighbour(t, i) is on its other side
//           /     \.
//          0-------1
//            edge 2
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/core/vec.hpp>

#include <array>
#include <cstdint>
#include <expected>
#include <span>
#include <utility>
#include <vector>

namespace freiform {

class Triangulation {
public:
    struct Segment {
        int a = 0, b = 0;
    };

    // Why segments and points do not fit together; -1 where it does not apply.
    //   points `point` and `other_point` (the lower index) have the same coordinates; or
    //   `first_segment` crosses `second_segment`; or `first_segment` passes exactly through `point`. Of two
    //   segments that overlap, at least one passes through an end of the other.
    struct Conflict {
        int first_segment = -1, second_segment = -1, point = -1, other_point = -1;
        friend bool operator==(const Conflict&, const Conflict&) = default;
    };
    struct Problem {
        Refusal refusal;                  // of the first conflict
        std::vector<Conflict> conflicts;  // empty if something else is wrong
    };

    // Point i becomes vertex i, and every segment becomes an edge: none is split or dropped. A segment given
    // twice, in either direction, stays an edge, but counts twice for the odd-even rule: the region does not
    // change across it. Points without segments are allowed. If all points are on one line, there are no
    // triangles. Refused as `invalid`: indices out of range, a segment from a point to itself, a point where
    // an odd number of segments end ("points[i]": the boundary is not closed), equal points ("points[j]"),
    // segments that cross or pass through a point ("segments[i]"); `nonfinite`; `limit` above kMaxPoints
    // points. Cost: O(n log n) but for segments, which cost as many steps as Delaunay edges cross them.
    static Result<Triangulation> make(std::span<const Vec<2>> points, std::span<const Segment> segments);

    // The same, and tells which segments and points are in conflict so that the caller can refine them and
    // try again: every equal pair of neighbours in the order of coordinates; otherwise the first conflict of
    // each segment with a point or with segments before it.
    static std::expected<Triangulation, Problem> attempt(std::span<const Vec<2>> points,
                                                         std::span<const Segment> segments);

    static constexpr int kMaxPoints = 1 << 28;

    // --- what there is ---

    std::span<const Vec<2>> points() const { return points_; }

    // Triangles inside, outside in the convex hull, and infinite ones (a hull edge and the vertex kInfinite):
    // one on each side of every edge. Indices stay the same when points are inserted, though the triangle at
    // an index changes.
    static constexpr int kInfinite = -1;
    int size() const { return int(triangles_.size()); }
    const std::array<int, 3>& vertices(int triangle) const { return at(triangle).vertex; }
    int neighbour(int triangle, int edge) const { return at(triangle).neighbour[std::size_t(edge)]; }
    bool is_constrained(int triangle, int edge) const { return at(triangle).flags >> edge & 1; }
    bool is_inside(int triangle) const { return at(triangle).flags & kInsideFlag; }
    bool is_infinite(int triangle) const { return corner_of(triangle, kInfinite) >= 0; }

    // Which corner of the triangle is the vertex? -1 if none.
    int corner_of(int triangle, int vertex) const {
        const auto& v = at(triangle).vertex;
        return v[0] == vertex ? 0 : v[1] == vertex ? 1 : v[2] == vertex ? 2 : -1;
    }
    // A triangle at the vertex; -1 if there are no triangles.
    int triangle_of(int vertex) const { return vertex_triangle_[std::size_t(vertex)]; }

    // The triangle and edge that lead from vertex a to vertex b; {-1, -1} if that is no edge.
    struct Edge {
        int triangle = -1, edge = -1;
    };
    Edge find_edge(int a, int b) const;

    // --- changes ---

    // Grows whenever the corners of the triangle at this index change: tells stale entries of a queue.
    std::uint32_t stamp(int triangle) const { return at(triangle).stamp; }
    // The triangles that the last insert or insert_all that inserted something has created or changed.
    std::span<const int> changed() const { return changed_; }

    struct Location {
        enum class On { face, edge, vertex, outside } on = On::outside;  // outside the convex hull
        int triangle = -1;  // that has the point; where outside, an infinite one whose edge sees it, or -1
        int part = -1;      // index of the edge or corner in the triangle
    };
    // Walks from the triangle `hint` (-1: from the last insertion).
    Location locate(const Vec<2>& p, int hint = -1) const;

    enum class Insert {
        done,
        outside,     // outside the region, or not finite
        duplicate,   // on a vertex
        on_segment,  // on a constrained edge
        rejected,    // `reject` says no
        full,        // kMaxPoints is reached
    };
    struct Inserted {
        Insert status = Insert::outside;
        int vertex = -1;  // the new one, or of a duplicate the one that is there
        friend bool operator==(const Inserted&, const Inserted&) = default;
    };
    // Inserts a point inside the region. `reject(triangle)` is asked last, with the triangle that has the
    // point.
    Inserted insert(const Vec<2>& p, int hint = -1) {
        return insert(p, hint, [](int) { return false; });
    }
    template <class Reject>
    Inserted insert(const Vec<2>& p, int hint, Reject&& reject) {
        const Location where = locate(p, hint);
        const Inserted can = admit(where);
        if (can.status != Insert::done) return can;
        if (reject(where.triangle)) return {Insert::rejected, -1};
        start_change();
        return {Insert::done, insert_at(p, where)};
    }
    // More points, whose numbers follow those that are there, and segments, which may end at any of them:
    // what is there counts as a boundary as before. Refused as `make` does; the triangulation is of no use
    // then.
    Result<void> extend(std::span<const Vec<2>> points, std::span<const Segment> segments);
    // Inserts many points in an order of its own, which is fast: result[i] is about points[i]. Of equal
    // points, one is inserted.
    std::vector<Inserted> insert_all(std::span<const Vec<2>> points);

private:
    friend struct TriangulationProbe;  // tests of what is hardly ever reached

    static constexpr std::uint8_t kInsideFlag = 64,
                                  kMarkFlag = 128;  // bits 0..2: constrained, 3..5: toggles inside
    static constexpr std::uint8_t kEdgeFlags = 9;   // constrained and toggle bit of edge 0

    struct Triangle {
        std::array<int, 3> vertex, neighbour;
        std::uint32_t stamp = 0;
        std::uint8_t flags = 0;
    };
    // What is across an edge, and the flags of the edge (shifted to edge 0).
    struct Side {
        int neighbour;
        std::uint8_t flags;
    };
    struct Edges;  // of a cavity

    Triangulation() = default;
    const Triangle& at(int t) const { return triangles_[std::size_t(t)]; }
    Triangle& at(int t) { return triangles_[std::size_t(t)]; }
    const Vec<2>& point(int v) const { return points_[std::size_t(v)]; }
    Side side(int t, int i) const {
        return {at(t).neighbour[std::size_t(i)], std::uint8_t(at(t).flags >> i & kEdgeFlags)};
    }

    // triangulate.cpp
    void triangulate_points();
    void find_inside();
    // triangulate_insert.cpp
    void start_change();
    void touch(int t);
    int append(const Triangle& like);
    void place(int t, const std::array<int, 3>& vertices, const std::array<Side, 3>& sides);
    void relink(int t, int from, int to);
    int opposite(int t, int i) const;
    bool is_in_circle(int t, int v) const;
    bool has_inside(int t, const Vec<2>& p, Location& where) const;
    Location locate_by_search(const Vec<2>& p) const;
    Inserted admit(const Location& where) const;
    int insert_at(const Vec<2>& p, const Location& where);
    void insert_vertex(int v, const Location& where);
    void split_face(int t, int v);
    void split_edge(int t, int i, int v);
    void flip(int t, int i);
    void restore_delaunay(int v);
    // triangulate_segment.cpp
    bool insert_segment(const Segment& s, Conflict& conflict);
    bool start_of_segment(const Segment& s, int& triangle, int& through) const;
    void constrain(int t, int i);
    void replace_cavity(const std::vector<int>& cavity, const std::vector<std::array<int, 3>>& by);
    void restore_delaunay_in(std::vector<int> cavity);

    std::vector<Vec<2>> points_;
    std::vector<Triangle> triangles_;
    std::vector<int> vertex_triangle_;
    std::vector<int> changed_;
    std::vector<int> stack_;  // work space of restore_delaunay
    std::uint32_t now_ = 0;   // the stamp of the change that is going on
    int last_ = -1;           // where the next walk begins
};

}  // namespace freiform
