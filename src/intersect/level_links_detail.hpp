// Branches of a zero set from settled cells: linked by the sides that they cross.
#pragma once
#include "level_set_detail.hpp"

#include <map>

namespace freiform::detail {

enum class LevelState { clear, simple, open, undecided, flat };

class LevelLinks {
public:
    // `whole`: cells go once round that cyclic axis.
    LevelLinks(const Index<2>& count, const std::array<bool, 2>& whole);
    void add(LevelCell&& cell, LevelState state);
    // Appends branches, nodes and undecided boxes.
    void finish(LevelSet& out);

private:
    // Between two neighbouring vertices of the grid; `axis` is the one across it.
    struct Side {
        int axis = 0;
        double line = 0, lo = 0, hi = 0;
        auto key() const { return std::array<double, 3>{double(axis), line, lo}; }
    };
    struct Held {
        LevelCell cell;
        LevelState state;
        std::vector<Side> crossed;
    };
    using Vertices = std::map<double, int>;  // their signs, along a line

    double canonical(int axis, double x) const;
    template <class F>
    void each_side(const LevelCell& cell, F&& f);
    double line_of(const Side& side, const LevelCell& cell) const;
    bool look_at_sides(Held& held);
    void link(LevelSet& out);
    void walk(int first, int from, bool closed, LevelSet& out);
    Place zero_on(const Side& side, const LevelCell& cell) const;
    void gather_nodes(LevelSet& out);
    bool is_open(std::size_t i) const {
        return held_[i].state == LevelState::open || held_[i].state == LevelState::undecided ||
               held_[i].state == LevelState::flat;
    }

    Index<2> count_;
    std::array<bool, 2> whole_;
    std::array<std::map<double, Vertices>, 2> lines_;
    std::vector<Held> held_;
    std::map<std::array<double, 3>, std::vector<int>> crossed_by_;  // simple cells
    std::map<std::array<double, 3>, int> open_at_;                  // open cells
    std::vector<int> node_of_;                                      // of open cells; -2: undecided
    std::vector<char> done_;
};

}  // namespace freiform::detail
