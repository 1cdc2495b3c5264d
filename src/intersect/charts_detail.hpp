// Charts of the intersection of two surfaces: boxes of parameters (u, v, s, t) in which it is one arc.
//
// Notation. F(x) = A(u, v) - B(s, t), x = (u, v, s, t). A chart belongs to a part of A and a part of B, its
// core; E is the core with its surroundings. `free`: one of the four parameters, y the other three, all
// measured in lengths of the core. Y: about the inverse of F_y in the middle.
//
// Idea. If |1 - Y F_y| <= q < 1 over E, then by the mean value theorem (of the convex hull of derivatives, so
// kinks do not matter) there is at most one zero of F in E for each value of the free parameter, and zeros
// are a graph over it whose slope is at most S = max |Y F_free| / (1 - q). So all zeros in the core are on
// the one arc that goes through the zero in E where the free parameter is in its middle, at most 1 / 2 + S /
// 2 away from the middle in the others: if there is none such, there is none in the core. This zero is the
// `seed`. A pair of parts for which E leaves the surface has a chart only if each border that the arc may
// reach is crossed by it at most once: the parameter is monotone along it.
#pragma once
#include "same_map_detail.hpp"
#include "sheet_detail.hpp"

#include <functional>
#include <optional>

namespace freiform::detail {

using Place4 = std::array<double, 4>;

// A pair of parts.
struct PartPair {
    int a = 0, b = 0;
    friend bool operator==(const PartPair&, const PartPair&) = default;
};

struct Chart {
    PartPair parts;
    std::array<Interval, 4> core{};
    std::size_t free = 0;
    std::array<Vec<3>, 4> y{};  // rows of Y, that of `free` is empty
    double q = 0, slope = 0;    // S
    Place4 along{};             // about how x changes with the free parameter
    Place4 seed{};
    int forward = 1;    // the free parameter rises in the direction of the product of the normals
    int branch = -1;    // that came here
    double passed = 0;  // the free parameter where it was last
    double width(std::size_t k) const { return core[k].length(); }
};

struct ArcZero {
    Place4 x{};
    double off = kInfinity;  // in lengths of the core: a zero with this free parameter is no farther away
};

// Pairs next to each other where nothing is decided, although both surfaces are near to each other all over
// them.
struct Cluster {
    std::vector<std::array<Interval, 4>> cores;
    bool same = false;  // of whole pieces the control points are the same, or a map says so, for most of them
    std::vector<int> maps;  // in the order of `search`
};

class Charts {
public:
    // `same`: where both are the same.
    Charts(Sheet& a, Sheet& b, const Sameness& same);

    // Finds all. What is no farther apart than `nearness` all over a pair of parts is halved no more; what
    // such pairs are about, if it seems to be one point, down to `finest`.
    // Where that would be very many pairs, the search is for a coarser nearness, `coarse`, first: what is
    // then near is given to `is_known` as the cluster with this number, and looked at no more where that is
    // true.
    using IsKnown = std::function<bool(const Cluster&, int number)>;
    void search(double nearness, double finest, int max_pairs, double coarse, const IsKnown& is_known);

    const Sheet& sheet(std::size_t i) const { return *sheets_[i]; }
    std::vector<Chart>& charts() { return charts_; }
    const std::vector<Chart>& charts() const { return charts_; }
    const std::vector<Cluster>& clusters() const { return clusters_; }
    const std::vector<PartPair>& left() const { return left_; }  // the budget ended
    std::array<Interval, 4> core(PartPair p) const {
        const SheetPart &a = (*sheets_[0])[p.a], &b = (*sheets_[1])[p.b];
        return {a.on[0], a.on[1], b.on[0], b.on[1]};
    }

    struct Value {
        Vec<3> f;
        std::array<Vec<3>, 4> d;  // those of -B, too
    };
    Value value(const Place4& x) const;
    // Of each coordinate of f.
    double error_at(const Place4& x) const;
    // Newton's method with parameter `fixed` as it is, until a step is so many lengths. False: no
    // convergence.
    bool newton(Place4& x, std::size_t fixed, const std::array<double, 4>& width,
                double until = 0x1p-27) const;
    // The zero of the chart near x with its free parameter.
    std::optional<ArcZero> zero(const Chart& chart, Place4 x, double until = 0x1p-27) const;
    // The null vector of the derivatives in units of length along the curve in space: dx/ds, and the tangent.
    struct Direction {
        Place4 x{};
        Vec<3> tangent{};
    };
    Direction direction(const Place4& x) const;

    // Those whose core contains x, seams crossed, or is off it by rounding.
    struct Leaves {
        std::vector<int> charts, clusters;
    };
    void leaves_at(const Place4& x, Leaves& out) const;

    bool is_cyclic(std::size_t k) const { return sheets_[k / 2]->is_cyclic(int(k % 2)); }
    Interval domain(std::size_t k) const { return sheets_[k / 2]->domain()[k % 2]; }
    // In the domain, seams crossed.
    double wrapped(std::size_t k, double x) const {
        const Interval on = domain(k);
        if (!is_cyclic(k)) return x;
        return x < on.lo ? x + on.length() : x > on.hi ? x - on.length() : x;
    }

private:
    enum class Answer { nothing, chart, open };
    // The pairs that were looked at, as a tree.
    struct Node {
        PartPair parts;
        int left = -1, chart = -1, cluster = -1;
        int map = -1;  // that explains it
    };
    bool explained(int node, bool& nothing);
    std::optional<std::array<double, 2>> slack_where_one_to_one(std::size_t side, int part,
                                                                const std::array<Interval, 2>& with,
                                                                double gap);
    void look(int node);
    void look_at_all(std::size_t most_given_up);
    Cluster cluster_of(const std::vector<int>& nodes, bool same) const;
    std::vector<std::vector<int>> neighbours(std::vector<int> nodes) const;
    void finish(const std::vector<int>& nodes, bool same);
    bool has_core_at(PartPair p, const Place4& x) const;
    bool are_apart(const SheetPart& p, const SheetPart& q) const;
    bool are_apart_by_slabs(PartPair p, bool& near) const;
    Answer settle(PartPair p);
    bool set_up(Chart& c, const Sheet::Slopes& a, const Sheet::Slopes& b,
                std::array<double, 4>& slopes) const;
    Answer seed(Chart& c, const std::array<double, 4>& drift) const;
    void split(int node);

    std::array<Sheet*, 2> sheets_;
    std::span<const SameMap> maps_;
    double same_from_ = 0;  // extent of parts of one sphere that are looked at no more; 0: there is none
    std::vector<std::array<std::array<Interval, 2>, 2>> regions_;           // of the maps, for both sheets
    std::vector<std::pair<int, std::array<Interval, 4>>> explained_cells_;  // of nodes
    std::vector<Chart> charts_;
    std::vector<Cluster> clusters_;
    std::vector<Node> nodes_;
    std::vector<int> open_, given_up_, same_;
    std::vector<PartPair> left_;
    double nearness_ = 0;
    int looked_at_ = 0, max_pairs_ = 0;
    std::array<double, 4> slack_{};  // of parameters, that rounding may move a place by
};

}  // namespace freiform::detail
