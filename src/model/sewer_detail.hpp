// The state of sewing: its passes are in sew.cpp, what a pass looks at in sew_parts.cpp.
#pragma once
#include "sew_detail.hpp"

#include <map>
#include <memory>
#include <optional>

namespace freiform {

// Who uses an edge, if it is one coedge alone.
struct Owner {
    int face = -1, loop = -1, index = -1, uses = 0;
};

std::vector<Owner> owners_of(const Model& m);

inline Vec<3> middle_of(const Box<3>& box) { return box.lo + 0.5 * (box.hi - box.lo); }

// Curves in space for edges of one face that have none, and poles named as such (sew_images.cpp).
void give_images(Model& m, double tolerance);

// Part of an open edge, between the ends of others; or all of it.
struct Part {
    int edge = -1;
    EdgeTrace trace;
    std::array<int, 2> ends{-1, -1};  // vertices; -1: made when the edge is cut here
};

struct Pair {
    int a = -1, b = -1;  // parts; a stays
    bool reversed = false;
    std::optional<EdgeMatch> match;
};

// An edge that was given up, and what became of it.
struct Given {
    int stays = -1;
    bool reversed = false;
    double bound = 0;
    FollowedCurve followed;
};

class Sewer {
public:
    Sewer(const Model& model, double tolerance);
    Sewing run();

private:
    int vertex(int v) const {
        while (vertex_of_[std::size_t(v)] != v) v = vertex_of_[std::size_t(v)];
        return v;
    }
    bool is_open(std::size_t e) const {
        return owners_[e].uses == 1 && m_.edges[e].curve && !m_.edges[e].degenerate &&
               !given_.contains(int(e));
    }
    bool is_group(int e) const { return members_.contains(e); }
    std::vector<double> cuts_along(const EdgeTrace& trace, const PointTree& tree,
                                   std::span<const int> ends) const;
    std::vector<Part> parts(bool cut) const;
    std::vector<Pair> candidates(const std::vector<Part>& parts) const;
    bool is_seam(const Part& a, const Part& b, const Pair& p) const;
    bool may_close(int edge, const Part& side) const;
    bool may_vanish(int e) const;
    void find_points();
    std::vector<int> chain_of(int v) const;
    std::optional<Refusal> obstacle(const Part& a, const Part& b, const Pair& p) const;
    void measure_extents();
    bool pass(bool cut);
    bool join(std::vector<Part>& parts, std::vector<int>& stays_for, std::vector<char>& given, Pair p,
              bool pairs_only, std::vector<std::pair<Pair, FollowedCurve>>& done);
    Box<3> box_of(std::span<const int> chain) const;
    void unite(int v, int w);
    void cut_edges(const std::vector<Part>& parts, std::vector<int>& edge_of);
    void refused(int edge, const Refusal& why, int rank);
    void rebuild();

    double tolerance_;
    bool careful_ = true;  // about short edges beside ends that become one
    Model m_;
    Sewing out_;
    std::vector<std::unique_ptr<DerivativeQuery<2, 3>>> queries_;
    std::vector<Owner> owners_;
    std::vector<int> vertex_of_;                  // a forest: the smallest number of those that became one
    std::map<int, std::vector<int>> chain_;       // by that number: the others
    std::vector<Vertex> before_;                  // as vertices were before they became one with others
    std::map<int, std::vector<int>> edges_at_;    // by vertex, as it was before joining
    std::vector<double> extent_;                  // of edges
    std::vector<std::pair<int, double>> points_;  // edges that became points, with their extents
    std::map<int, Given> given_;
    std::map<int, std::vector<int>> members_;     // by the edge that stays
    std::map<int, std::pair<int, Refusal>> why_;  // the nearest miss of an edge, with a rank
};

}  // namespace freiform
