// Edges that a file has twice. A loop that runs through one of two edges between the same vertices on the
// same curve, and back through the other, runs through one edge there and back: a seam of the surface, or a
// way that encloses nothing, by which two shells that touch along it hang together. In both cases the two are
// one edge, in all faces; a way that encloses nothing is left out.
#include "step_shape.hpp"

#include <algorithm>
#include <utility>

namespace freiform::step {

// Between the same vertices in the same sense, and of the same points at the same parameters.
bool ShapeReader::are_twins(const EdgeMade& a, const EdgeMade& b) const {
    if (a.edge == b.edge || a.empty || b.empty) return false;
    const Edge &x = out_.model.edges[std::size_t(a.edge)], &y = out_.model.edges[std::size_t(b.edge)];
    if (x.start != y.start || x.end != y.end || x.range != y.range || !x.curve || !y.curve) return false;
    if (a.curve == b.curve && a.curve != kMissing) return true;
    const auto *line = std::get_if<Line<3>>(&*x.curve), *other = std::get_if<Line<3>>(&*y.curve);
    if (line != nullptr && other != nullptr) return *line == *other;
    const auto *conic = std::get_if<Conic<3>>(&*x.curve), *second = std::get_if<Conic<3>>(&*y.curve);
    return conic != nullptr && second != nullptr && *conic == *second;
}

void ShapeReader::fold_twins(std::vector<LoopPiece>& loop) {
    const auto is_reversed = [](const LoopPiece& p) { return p.along == p.made.flipped; };
    std::map<std::pair<int, int>, std::size_t> first;
    bool found = false;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        if (loop[k].made.empty) continue;
        if (const int one = twin_of(loop[k].made.edge); one != loop[k].made.edge) {
            loop[k].made.edge = one;
            loop[k].twin = found = true;
        }
        const Edge& e = out_.model.edges[std::size_t(loop[k].made.edge)];
        const LoopPiece& other = loop[first.emplace(std::pair(e.start, e.end), k).first->second];
        if (is_reversed(other) == is_reversed(loop[k]) || !are_twins(other.made, loop[k].made)) continue;
        twins_now_.emplace(loop[k].made.edge, other.made.edge);
        report(
            other.made.edge,
            text(f_.label(other.of), " and ", f_.label(loop[k].of), " are the same, and taken for one edge"),
            0.0, 0);
        loop[k].along = is_reversed(loop[k]) == other.made.flipped;
        loop[k].made = other.made;
        loop[k].twin = true;
        found = true;
    }
    if (!found) return;
    fold_spurs(
        loop,
        [&](const LoopPiece& a, const LoopPiece& b) {
            return (a.twin || b.twin) && !a.made.empty && a.made.edge == b.made.edge &&
                   is_reversed(a) != is_reversed(b);
        },
        [&](const LoopPiece& p) { out_.released.push_back(p.made.edge); });
}

// What stands for the edge by now.
int ShapeReader::twin_of(int edge) const {
    for (bool found = true; std::exchange(found, false);)
        for (const auto* twins : {&twins_, &twins_now_})
            if (const auto to = twins->find(edge); to != twins->end()) edge = to->second, found = true;
    return edge;
}

void ShapeReader::merge_twins() {
    for (const auto& [edge, other] : twins_) out_.released.push_back(edge);
    for (Face& f : out_.model.faces)
        for (Loop& l : f.loops)
            for (Coedge& c : l.coedges) c.edge = twin_of(c.edge);
}

}  // namespace freiform::step
