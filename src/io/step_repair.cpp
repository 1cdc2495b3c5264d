// Where a file contradicts itself beyond its own tolerance. Nothing of that is made right unless the caller
// asks for it (StepReadOptions::repair). What a repair did is listed in Model::repairs; without it, this
// happens:
//
// - Open loops are refused, with the gap. A repair puts a straight edge between the end of one edge and the
//   start of the next. Nothing else moves, and faces whose loops have the same gap share the edge.
// - Edges that run against both their neighbours are taken the other way, and it is told: between the same
//   vertices no other loop can be meant.
// - Edges far beside their surface are refused, with the distance. A repair takes them: the parameter curve
//   follows the edge as near as the surface comes to it, and what is left is the tolerance of the edge.
// - Of loops that run the wrong way around a face, where the surface is not closed, it is told: some programs
//   write them so, and no other face can be meant than what they enclose. A repair turns them, or, where the
//   faces beside this one run through shared edges in the sense that asks for it, the normal.
//
// What is far: edges of real files lie up to a hundredth of the face beside its surface (bench/STEP.md), and
// are taken, and told, as ever.
//
// Why not move the ends of edges together to close a gap: that changes curves that other faces agree upon.
#include "step_shape.hpp"

#include <algorithm>
#include <array>

namespace freiform::step {

namespace {

// Of the size of the face: an edge further beside its surface than this may belong to another face; the
// longest gap that is closed where the caller says nothing.
constexpr double kFar = 0.02, kRepairs = 0.01;
constexpr int kLooks = 64;  // at an edge

}  // namespace

double ShapeReader::repair_limit(double size) const {
    return options_.repair_limit > 0 ? options_.repair_limit : kRepairs * size;
}

// Where the vertices of a loop follow each other in one sense alone, which is not that of its flags. Not two
// edges: either may be wrong.
void ShapeReader::turn_edges(std::vector<Oriented>& loop) {
    std::vector<std::size_t> place;
    std::vector<std::array<int, 2>> ends;  // as the edge runs, not the loop
    for (std::size_t k = 0; k < loop.size(); ++k) {
        std::array<int, 2> of{-1, -1};
        for (const EdgeMade& part : loop[k].made) {
            if (part.empty) continue;
            const Edge& e = out_.model.edges[std::size_t(part.edge)];
            if (of[0] < 0) of[0] = part.flipped ? e.end : e.start;
            of[1] = part.flipped ? e.start : e.end;
        }
        if (of[0] >= 0) place.push_back(k), ends.push_back(of);
    }
    const std::size_t n = ends.size();
    if (n < 3) return;
    const auto closes = [&](const std::vector<char>& along) {
        for (std::size_t k = 0; k < n; ++k)
            if (ends[k][along[k] ? 1 : 0] != ends[(k + 1) % n][along[(k + 1) % n] ? 0 : 1]) return false;
        return true;
    };
    std::vector<char> given;
    for (const std::size_t k : place) given.push_back(loop[k].along);
    if (closes(given)) return;
    std::vector<std::vector<char>> found;
    for (const char first : {char(0), char(1)}) {
        std::vector<char> along(given);
        along[0] = first;
        for (std::size_t k = 1; k < n; ++k) {
            const int at = ends[k - 1][along[k - 1] ? 1 : 0];
            if (ends[k][0] != ends[k][1]) along[k] = ends[k][0] == at;
        }
        if (closes(along)) found.push_back(std::move(along));
    }
    if (found.size() != 1) return;
    for (std::size_t k = 0; k < n; ++k) {
        if (found[0][k] == given[k]) continue;
        loop[place[k]].along = !loop[place[k]].along;
        report(-1,
               text(f_.label(loop[place[k]].instance),
                    ": runs against its neighbours, and is taken the other way"),
               0.0, 0);
    }
}

Result<void> ShapeReader::close_loop(std::uint32_t loop, std::vector<Use>& uses, const Chart& chart,
                                     double size, int loosely) {
    std::vector<Use> closed;
    const double limit = repair_limit(size);
    for (std::size_t k = 0; k < uses.size(); ++k) {
        const int from = uses[k].to, to = uses[(k + 1) % uses.size()].from;
        closed.push_back(std::move(uses[k]));
        if (from == to) continue;
        const double apart =
            norm(out_.model.vertices[std::size_t(from)].point - out_.model.vertices[std::size_t(to)].point);
        if (apart <= std::max(tolerance_, kDigits * size)) {
            join_vertices(from, to);
            continue;
        }
        if (!options_.repair || apart > limit)
            return refuse(
                RefusalKind::invalid, f_.label(loop),
                text("is not closed: its edge ", k + 1, " ends ", apart, " from where the next one begins; ",
                     apart <= limit ? "a repair (--repair) closes it with a straight edge"
                                    : text("a repair closes at most ", limit, " (--repair-limit)")));
        const auto bridge = straight_edge(from, to);
        if (!bridge) return std::unexpected(bridge.error());
        auto use = use_of(*bridge, true, chart, size, loosely);
        if (!use) return refuse(use.error().kind, f_.label(loop), use.error().message);
        closed.push_back(std::move(*use));
        repaired(loop, text("was open behind its edge ", k + 1, "; a straight edge closes it"), apart);
    }
    uses = std::move(closed);
    return {};
}

Result<void> ShapeReader::accept_gap(std::uint32_t edge, const Use& use, const Chart& chart, double size) {
    if (!is_far(use.gap, size)) return {};
    // On planes the gap is that of control points: too large.
    const Edge& e = out_.model.edges[std::size_t(use.coedge.edge)];
    double seen = 0;
    for (int k = 0; k <= kLooks; ++k) {
        const double t = e.range.lo + e.range.length() * k / kLooks;
        seen = std::max(seen,
                        norm(chart.point(jet<0>(use.coedge.curve, t).value()) - jet<0>(*e.curve, t).value()));
    }
    if (!is_far(seen, size)) return {};
    if (!options_.repair) return far_beside(f_.label(edge), seen, size);
    repaired(edge, "lies beside the surface of a face; that is its tolerance now", seen);
    return {};
}

bool ShapeReader::is_far(double gap, double size) const { return gap > std::max(tolerance_, kFar * size); }

std::unexpected<Refusal> ShapeReader::far_beside(std::string edge, double gap, double size) const {
    return refuse(RefusalKind::ill_conditioned, std::move(edge),
                  text("lies ", gap, " beside the surface; the face has a size of ", size,
                       ", and the file says at most ", tolerance_,
                       "; a repair (--repair) takes it with that tolerance"));
}

void ShapeReader::tell_turn(std::uint32_t face, const LoopBuilder& loops) {
    if (!loops.is_wrong || loops.wrong_way == LoopBuilder::WrongWay::taken) return;
    if (loops.wrong_way == LoopBuilder::WrongWay::told)
        return report(-1,
                      text(f_.label(face),
                           ": its loops run the wrong way around it; what they enclose is taken "
                           "as it stands, and a repair (--repair) turns them"),
                      0.0, 0);
    turned_now_ = out_.model.repairs.size();
    repaired(face, "its loops run the wrong way around it; they are turned", 0);
}

// Two faces of a shell run through their common edge in opposite senses, as seen from outside.
void ShapeReader::settle_turned(const Shell& shell) {
    if (turned_.empty()) return;
    std::unordered_map<int, int> senses;  // of edges, from the faces that are as they were: +1 and -1
    Model& m = out_.model;
    const auto each_sense = [&](const FaceUse& u, const auto& use) {
        const Face& f = m.faces[std::size_t(u.face)];
        for (const Loop& l : f.loops)
            for (const Coedge& c : l.coedges) {
                const bool back = (c.reversed != f.reversed) != u.reversed;
                use(c.edge, back ? -1 : 1);
            }
    };
    for (const FaceUse& u : shell.faces)
        if (!turned_.contains(u.face)) each_sense(u, [&](int edge, int sense) { senses[edge] += sense; });
    for (const FaceUse& u : shell.faces) {
        const auto at = turned_.find(u.face);
        if (at == turned_.end()) continue;
        int against = 0;
        each_sense(u, [&](int edge, int sense) {
            if (const auto other = senses.find(edge); other != senses.end()) against += sense * other->second;
        });
        if (against > 0) {
            Face& f = m.faces[std::size_t(u.face)];
            f.reversed = !f.reversed;
            m.repairs[at->second].what =
                "its loops run the wrong way around it, and as the faces beside it want; its normal is "
                "turned";
        }
        turned_.erase(at);
    }
}

}  // namespace freiform::step
