#include "edge_joints.hpp"

#include "joint_units.hpp"

#include <freiform/io/bpt.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace freiform::cli {

namespace {

constexpr double kGapOfModel = 1e-6, kBendOfModel = 1e-2, kDegreesOfPlanes = 0.1;
constexpr double kDegree = std::numbers::pi / 180;

std::string within(double found, double bound, double factor) {
    return text(rounded(found / factor), std::isfinite(bound)
                                             ? text(" (at most ", rounded(bound / factor), ")")
                                             : " (without a bound)");
}

}  // namespace

Result<ModelJoints> joints_of(const Model& model, std::size_t object, std::optional<double> gap,
                              std::optional<double> angle, std::optional<double> curvature) {
    const double size = summary(model).box.diagonal();
    ModelJoints out;
    out.object = object;
    out.options.gap = gap.value_or(kGapOfModel * size);
    out.options.angle = angle.value_or(kDegreesOfPlanes) * kDegree;
    out.options.curvature = curvature.value_or(kBendOfModel / size);
    auto found = edge_continuity(model, out.options);
    if (!found) return std::unexpected(found.error());
    out.joints = *std::move(found);
    return out;
}

void write_joints(json::Writer& w, const ModelJoints& all) {
    w.key("allowed").begin_object().field("gap", all.options.gap).field("angle", all.options.angle / kDegree);
    w.field("curvature", all.options.curvature).end_object();
    std::array<std::size_t, 4> count{};
    for (const EdgeContinuity& j : all.joints) ++count[std::size_t(j.g_at_most + 1)];
    w.key("edges_at_most").begin_object().field("none", count[0]).field("G0", count[1]).field("G1", count[2]);
    w.field("G2", count[3]).end_object().key("edges").begin_array();
    for (const EdgeContinuity& j : all.joints) {
        w.new_line(2).begin_object().field("edge", j.edge).key("faces").array(j.face);
        w.field("g_order", j.g_order).field("g_at_most", j.g_at_most);
        w.key("gap").begin_object().field("size", j.gap).field("bound", j.gap_bound).end_object();
        w.key("angle")
            .begin_object()
            .field("size", j.angle / kDegree)
            .field("bound", j.angle_bound / kDegree);
        w.field("at", j.at).field("outward", j.directed).end_object();
        if (j.curvature >= 0)
            w.key("curvature")
                .begin_object()
                .field("estimate", j.curvature)
                .field("at", j.curvature_at)
                .end_object();
        w.field("singular", j.singular).end_object();
    }
    w.end_array();
}

std::string joints_text(const Document& d, const ModelJoints& all) {
    std::string s = text("  allowed: gap ", rounded(all.options.gap), " ", unit_of(d), ", angle ",
                         rounded(all.options.angle / kDegree), " degrees, curvature ",
                         rounded(all.options.curvature), " 1/", unit_of(d), "; worst first\n");
    for (const EdgeContinuity& j : all.joints) {
        s += text("  edge ", j.edge, ", faces ", j.face[0], " and ", j.face[1], ": ",
                  order_text('G', j.g_order));
        if (j.g_at_most > j.g_order)
            s += text(" proven, ", order_text('G', j.g_at_most), " by what was found");
        s += text(", angle ", within(j.angle, j.angle_bound, kDegree), " degrees, gap ",
                  within(j.gap, j.gap_bound, 1), " ", unit_of(d));
        if (j.curvature >= 0)
            s += text(", curvature differs by about ", rounded(j.curvature), " 1/", unit_of(d));
        s += j.singular ? ", has a pole\n" : "\n";
    }
    return s;
}

}  // namespace freiform::cli
