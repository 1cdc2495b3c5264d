#include "sewing.hpp"

#include <freiform/core/scan.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::cli {

namespace {

// The largest bounds of all joins.
SewnEdge largest_bounds(const Sewing& s) {
    SewnEdge most;
    for (const SewnEdge& e : s.joined) {
        most.bound = std::max(most.bound, e.bound);
        most.face_bound = std::max(most.face_bound, e.face_bound);
    }
    return most;
}

constexpr double kProvable = 0x1p-40;  // of coordinates: edges less apart may not be proven to be

double farthest_from_zero(const Model& model) {
    double most = 0;
    for (const Vertex& v : model.vertices) most = std::max(most, max_abs(v.point));
    return most;
}

// Whether another edge may run along it within twice the tolerance.
bool is_beside_another(const RemainingGap& gap, double tolerance) {
    return gap.reason.where == "edges" || gap.gap <= 2 * tolerance;
}

}  // namespace

void SewArguments::add_to(const Command& command) {
    const auto read = [this](const std::string& s) {
        wanted = true;
        if (s.empty()) return;
        tolerance = scan_number<double>(s);
        if (!tolerance)
            wrong_usage(text("--sew needs a number, or none and another option after it; found \"", s, "\""));
    };
    command.optional_value(
        "--sew", read,
        "Join edges of loose faces that are the same within this distance, in the file's unit "
        "(without a number: the largest tolerance that the file gives, twice that where edges along each "
        "other stay open, or what numbers so far from zero can tell)",
        "[NUMBER]");
}

Result<std::optional<Sewing>> sewn(const Model& model, const SewArguments& how) {
    if (!how.wanted) return std::nullopt;
    const double given = how.tolerance ? *how.tolerance : largest_tolerance(model);
    if (!how.tolerance && !(given > 0))
        return refuse(RefusalKind::invalid, "--sew", "the file gives no tolerance: say one, --sew NUMBER");
    const double tolerance = how.tolerance ? given : std::max(given, kProvable * farthest_from_zero(model));
    auto s = sew(model, {.tolerance = tolerance});
    if (!s) return std::unexpected(s.error());
    if (how.tolerance) return *std::move(s);
    bool is_twice = false;
    if (tolerance == given && std::ranges::any_of(s->remaining, [&](const RemainingGap& g) {
            return is_beside_another(g, tolerance);
        }))
        if (auto wider = sew(model, {.tolerance = 2 * tolerance});
            wider && wider->remaining.size() < s->remaining.size())
            s = std::move(wider), is_twice = true;
    const std::string unit = model.unit.empty() ? "" : " " + model.unit;
    remark(
        is_twice ? text("sewn within ", s->tolerance, unit, ", twice the largest tolerance of the file: two ",
                        "edges at one place may be that far apart")
        : tolerance > given ? text("sewn within ", tolerance, unit, ", as closely as numbers so far from ",
                                   "zero can tell; the largest tolerance of the file is ", given, unit)
                            : text("sewn within ", tolerance, unit, ", the largest tolerance of the file"));
    return *std::move(s);
}

void write_sewing(json::Writer& w, const Sewing& s) {
    const SewnEdge most = largest_bounds(s);
    w.key("sewing").begin_object();
    w.field("tolerance", s.tolerance).field("open_edges_before", s.open_before);
    w.field("joined", s.joined.size()).field("split", s.split);
    w.field("vertices_joined", s.vertices_joined).field("vertex_moved", s.vertex_moved);
    w.field("bound", most.bound).field("face_bound", most.face_bound);
    w.key("non_manifold").begin_array();
    for (const SewnEdge& e : s.joined) {
        if (e.faces.size() < 3) continue;
        w.begin_object().field("edge", e.edge).key("faces").begin_array();
        for (const int f : e.faces) w.value(f);
        w.end_array().end_object();
    }
    w.end_array();
    for (const auto& [name, list] : {std::pair{"flipped", &s.flipped}, std::pair{"twisted", &s.twisted}}) {
        w.key(name).begin_array();
        for (const int i : *list) w.value(i);
        w.end_array();
    }
    w.key("remaining_gaps").begin_array();
    for (const RemainingGap& g : s.remaining) {
        w.new_line(1).begin_object().field("face", g.face).field("name", g.face_name).field("edge", g.edge);
        w.field("gap", g.gap);  // null where there is no other open edge
        w.key("at").array(std::span<const double>(g.at.c));
        if (g.opening >= 0) w.field("opening", g.opening);
        w.field("kind", name_of(g.reason.kind)).field("where", g.reason.where);
        w.field("message", g.reason.message).end_object();
    }
    w.end_array().key("openings").begin_array();
    for (const Opening& o : s.openings) {
        w.new_line(1).begin_object().key("edges").begin_array();
        for (const int e : o.edges) w.value(e);
        w.end_array().key("lo").array(std::span<const double>(o.box.lo.c));
        w.key("hi").array(std::span<const double>(o.box.hi.c)).end_object();
    }
    w.end_array().end_object();
}

std::string sewing_text(const Sewing& s, const std::string& unit) {
    const SewnEdge most = largest_bounds(s);
    const std::string word = unit.empty() ? "" : " " + unit;
    std::string out = text("sewn            ", s.joined.size(), " edges of ", s.open_before, " open ones, ",
                           s.split, " cuts, within ", s.tolerance, word, "\n");
    if (!s.joined.empty())
        out += text("edges apart     at most ", most.bound, ", from faces at most ", most.face_bound, word,
                    "\n");
    if (!s.flipped.empty()) out += text("turned over     ", s.flipped.size(), " faces\n");
    for (const int e : s.twisted) out += text("twisted         edge ", e, ": its faces cannot agree\n");
    for (const SewnEdge& e : s.joined)
        if (e.faces.size() > 2)
            out += text("non-manifold    edge ", e.edge, ": ", e.faces.size(), " faces\n");
    if (s.remaining.empty()) return out + "remaining gaps  none\n";
    out += text("remaining gaps  ", s.remaining.size(), "\n");
    for (std::size_t i = 0; i < s.openings.size(); ++i) {
        const Vec<3> size = s.openings[i].box.hi - s.openings[i].box.lo;
        out += text("opening ", i, "       ", s.openings[i].edges.size(), " of them go round a place ",
                    size[0], " x ", size[1], " x ", size[2], word, " large where there is no face\n");
    }
    for (const RemainingGap& g : s.remaining) {
        out += text("  face ", g.face, g.face_name.empty() ? "" : text(" '", g.face_name, "'"), ", edge ",
                    g.edge, ": ");
        out += std::isfinite(g.gap) ? text("about ", g.gap, word, " from the others")
                                    : std::string("no other is open");
        if (g.opening >= 0) out += text(", round opening ", g.opening);
        out += text("; ", g.reason.where, " ", g.reason.message, "\n");
    }
    return out;
}

}  // namespace freiform::cli
