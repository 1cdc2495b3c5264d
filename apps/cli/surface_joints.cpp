#include "surface_joints.hpp"

#include "command.hpp"
#include "joint_units.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>

namespace freiform::cli {

namespace {

std::string edge_name(SurfaceEdge e) {
    return text(e.axis == 0 ? 'u' : 'v', e.end == End::start ? " start" : " end");
}
void write_jump(json::Writer& w, const LargestJump& j, int order, const std::string& unit) {
    w.begin_object().field("order", order).field("size", j.size).field("bound", j.bound);
    w.field("unit", unit).field("at", j.at).end_object();
}
template <class Unit>
void write_jumps(json::Writer& w, const char* kind, const std::vector<LargestJump>& jumps, int order,
                 Unit&& unit) {
    w.key(text("first_", kind, "_jump"));
    if (order + 1 < int(jumps.size()))
        write_jump(w, jumps[std::size_t(order + 1)], order + 1, unit(order + 1));
    else
        w.null();
    w.key(text(kind, "_jumps")).begin_array();
    for (std::size_t k = 0; k < jumps.size(); ++k) write_jump(w, jumps[k], int(k), unit(int(k)));
    w.end_array();
}

template <class Unit>
std::string first_text(char kind, const std::vector<LargestJump>& jumps, int order, Unit&& unit) {
    if (order + 1 >= int(jumps.size())) return "";
    const LargestJump& j = jumps[std::size_t(order + 1)];
    return text(kind, order + 1, " by ", rounded(j.size), " ", unit(order + 1), " at ", rounded(j.at));
}

}  // namespace

void SurfaceNeighbours::add(const Shape& shape, std::size_t index, const ContinuityOptions& options) {
    visit_one(
        [&](const auto& s) {
            using S = std::remove_cvref_t<decltype(s)>;
            if constexpr (TensorPatch<S>)
                if constexpr (S::kParams == 2) object.push_back(index), edges.push_back(edges_of(s, options));
        },
        shape);
}

Result<void> SurfaceNeighbours::find(double gap, const ContinuityOptions& options) {
    auto found = freiform::joints(edges, gap, options);
    if (!found) return std::unexpected(found.error());
    joints = *std::move(found);
    return {};
}

void write_joints(json::Writer& w, const Document& d, const SurfaceNeighbours& all) {
    for (const SurfaceJoint& s : all.joints) {
        const SurfaceMeeting& m = s.meeting;
        const SurfaceContinuity& j = s.joint;
        w.new_line(1).begin_object().field("first", all.object[m.first]);
        w.field("first_edge", edge_name(m.first_edge)).field("second", all.object[m.second]);
        w.field("second_edge", edge_name(m.second_edge)).field("against", m.against);
        w.field("whole", m.whole).key("first_on").array(std::array{m.first_on.lo, m.first_on.hi});
        w.key("second_on").array(std::array{m.second_on.lo, m.second_on.hi});
        w.field("distance", m.distance).field("c_order", j.c_order).field("g_order", j.g_order);
        write_jumps(w, "c", j.c, j.c_order, [&](int k) { return c_unit(d, k); });
        write_jumps(w, "g", j.g, j.g_order, [&](int k) { return g_unit(d, k); });
        w.field("opposed", j.opposed).key("singular").begin_array();
        for (const Interval& x : j.singular) w.array(std::array{x.lo, x.hi});
        w.end_array().end_object();
    }
}

std::vector<std::vector<std::string>> joint_rows(const Document& d, const SurfaceNeighbours& all) {
    std::vector<std::vector<std::string>> rows;
    for (const SurfaceJoint& s : all.joints) {
        const SurfaceMeeting& m = s.meeting;
        const SurfaceContinuity& j = s.joint;
        std::string remark = j.opposed ? "turns back" : "";
        if (!j.singular.empty()) remark += remark.empty() ? "has a pole" : ", has a pole";
        if (!m.whole) remark += remark.empty() ? "part of an edge" : ", part of an edge";
        const auto place = [&](std::size_t surface, SurfaceEdge e, const Interval& on) {
            return text(object_label(d, all.object[surface]), " ", edge_name(e),
                        m.whole ? "" : text(" [", rounded(on.lo), ", ", rounded(on.hi), "]"));
        };
        rows.push_back({text(place(m.first, m.first_edge, m.first_on), " - ",
                             place(m.second, m.second_edge, m.second_on)),
                        order_text('C', j.c_order), order_text('G', j.g_order),
                        first_text('C', j.c, j.c_order, [&](int k) { return c_unit(d, k); }),
                        first_text('G', j.g, j.g_order, [&](int k) { return g_unit(d, k); }), remark});
    }
    return rows;
}

}  // namespace freiform::cli
