#include "surface_meetings.hpp"

namespace freiform::cli {

namespace {

template <int D>
void write_spline(json::Writer& w, std::string_view key, const Curve<Vec<D>>& curve) {
    w.key(key).begin_object().field("degree", curve.basis().degree());
    w.key("knots").array(curve.basis().knots());
    w.key("points").begin_array();
    for (const Vec<D>& p : curve.net().flat()) w.array(p.c);
    w.end_array().end_object();
}
void write_sides(json::Writer& w, std::string_view key, const std::array<Interval, 2>& box) {
    w.key(key).begin_array();
    for (const Interval& t : box) w.array(std::array{t.lo, t.hi});
    w.end_array();
}

void write_corners(json::Writer& w, std::string_view key, const std::vector<Vec<2>>& loop) {
    w.key(key).begin_array();
    for (const Vec<2>& p : loop) w.array(p.c);
    w.end_array();
}

// Nodes of the whole answer.
std::array<int, 2> moved(std::array<int, 2> ends, int by) {
    for (int& end : ends)
        if (end >= 0) end += by;
    return ends;
}

}  // namespace

void SurfaceMeetings::add_branch(const SurfaceBranch& b, int before,
                                 const std::array<std::size_t, 2>& objects, const std::string& where,
                                 const FaceBranch* of_faces) {
    struct OfFaces {
        std::array<int, 2> faces;
        std::array<TrimPlace, 2> trims;
    };
    const std::array<int, 2> ends = moved(b.ends, before);
    const bool tangent = b.kind == SurfaceBranchKind::tangent;
    std::optional<OfFaces> own;
    if (of_faces) own = OfFaces{of_faces->faces, of_faces->trims};
    branches_.push_back([=](json::Writer& w) {
        w.new_line(1).begin_object().key("objects").array(objects);
        if (own) w.key("faces").array(own->faces);
        w.field("kind", name_of(b.kind)).field("closed", b.closed).key("ends").array(ends);
        if (tangent) w.field("gap", b.gap()).field("node", b.node < 0 ? b.node : b.node + before);
        if (own) {
            w.key("trims").begin_array();
            for (std::size_t e = 0; e < 2; ++e) {
                const TrimPlace& t = own->trims[e];
                if (ends[e] == kAtTrim)
                    w.array(std::array{t.side, t.loop, t.coedge, t.edge});
                else
                    w.array(std::array<int, 0>{});
            }
            w.end_array();
        }
        w.field("bound", b.bound()).field("a_bound", b.bound_a).field("b_bound", b.bound_b);
        write_spline(w, "curve", b.curve);
        write_spline(w, "a", b.at_a);
        write_spline(w, "b", b.at_b);
        w.end_object();
    });
    curves_.objects.push_back({text("intersection ", branches_.size()), b.curve});
    plain_ += text(where, own ? text(", faces ", own->faces[0], " and ", own->faces[1]) : "", ": ",
                   b.closed ? "closed" : "open", tangent ? " tangent branch, " : " branch, ",
                   b.curve.basis().size(), " control points, within ", b.bound(), " of both\n");
}

void SurfaceMeetings::add_node(const SurfaceNode& n, const std::array<std::size_t, 2>& objects,
                               const std::string& where, const FaceNode* of_faces) {
    std::optional<std::array<int, 2>> own;
    std::vector<FaceOverlap> regions;
    if (of_faces) own = of_faces->faces, regions = of_faces->regions;
    nodes_.push_back([=](json::Writer& w) {
        w.new_line(1).begin_object().key("objects").array(objects);
        if (own) w.key("faces").array(*own);
        w.field("kind", name_of(n.kind));
        w.key("a").array(n.at_a).key("b").array(n.at_b).key("point").array(n.point.c);
        w.field("gap", n.gap).field("arms", n.arms).field("cells", n.cells.size());
        write_sides(w, "a_box", n.box_a);
        write_sides(w, "b_box", n.box_b);
        w.key("overlaps").begin_array();
        for (const SurfaceOverlap& o : n.overlaps) {
            w.begin_object().field("gap", o.gap);
            write_corners(w, "a", o.loop_a);
            write_corners(w, "b", o.loop_b);
            w.end_object();
        }
        w.end_array();
        if (own) {
            w.key("regions").begin_array();
            for (const FaceOverlap& o : regions)
                w.begin_object()
                    .field("gap", o.gap)
                    .field("bound", o.bound)
                    .field("a", path_data(o.at_a))
                    .field("b", path_data(o.at_b))
                    .end_object();
            w.end_array();
        }
        w.end_object();
    });
    plain_ += text(where, own ? text(", faces ", (*own)[0], " and ", (*own)[1]) : "", ": ", name_of(n.kind),
                   " at ", n.point[0], ", ", n.point[1], ", ", n.point[2], ", ", n.arms,
                   " branches end there, gap at most ", n.gap, "\n");
}

void SurfaceMeetings::add(const SurfaceIntersection& found, const std::array<std::size_t, 2>& objects,
                          const std::string& where) {
    const int before = int(nodes_.size());
    for (const SurfaceBranch& b : found.branches) add_branch(b, before, objects, where, nullptr);
    for (const SurfaceNode& n : found.nodes) add_node(n, objects, where, nullptr);
}

void SurfaceMeetings::add(const ModelIntersection& found, const std::array<std::size_t, 2>& objects,
                          const std::string& where) {
    const int before = int(nodes_.size()), first = int(branches_.size());
    for (const FaceBranch& b : found.branches) add_branch(b, before, objects, where, &b);
    for (const FaceNode& n : found.nodes) add_node(n, objects, where, &n);
    for (const BranchChain& c : found.chains) {
        chains_.push_back([=](json::Writer& w) {
            std::vector<int> curves, reversed;
            for (const ChainLink& l : c.links) {
                curves.push_back(first + l.branch);
                if (l.reversed) reversed.push_back(first + l.branch);
            }
            w.new_line(1).begin_object().key("objects").array(objects).key("curves").array(curves);
            w.key("reversed").array(reversed).field("closed", c.closed).field("gap", c.gap).end_object();
        });
        if (c.links.size() > 1)
            plain_ += text(where, ": ", c.links.size(), " branches are one ", c.closed ? "closed" : "open",
                           " curve over edges, with gaps of at most ", c.gap, "\n");
    }
}

void SurfaceMeetings::write(json::Writer& w) const {
    for (const auto& [key, rows] :
         {std::pair("curves", &branches_), {"nodes", &nodes_}, {"chains", &chains_}}) {
        w.key(key).begin_array();
        for (const Row& row : *rows) row(w);
        w.end_array();
    }
}

}  // namespace freiform::cli
