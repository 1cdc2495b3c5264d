#include "model_contacts.hpp"

#include <freiform/io/points.hpp>
#include <freiform/io/scene.hpp>

namespace freiform::cli {

namespace {

std::string numbers(std::span<const double> all) {
    std::string s;
    for (const double x : all) s += text(s.empty() ? "" : ", ", x);
    return s;
}

void write_boxes(json::Writer& w, std::span<const Interval> box) {
    w.begin_array();
    for (const Interval& t : box) w.array(std::array{t.lo, t.hi});
    w.end_array();
}

}  // namespace

void ModelContactRows::add(const ModelContacts& found, const std::array<std::size_t, 2>& objects,
                           std::optional<std::size_t> ray, bool swapped, double tolerance,
                           const std::string& where) {
    for (const ModelContact& m : found.contacts) {
        const bool open = m.contact.kind == ContactKind::possible && !(m.contact.gap <= tolerance);
        (open ? possible_ : points_).push_back([=](json::Writer& w) {
            const Contact<3, 3>& c = m.contact;
            const std::span<const double> at(c.at);
            const std::span<const Interval> box(c.box);
            w.new_line(1).begin_object();
            if (ray)
                w.field("ray", *ray).field("object", objects[0]);
            else
                w.key("objects").array(objects);
            w.key("a").array(swapped ? at.subspan(1) : at.first(1));
            w.key("b").array(swapped ? at.first(1) : at.subspan(1));
            w.field("face", m.face);
            if (m.edge >= 0) w.field("edge", m.edge);
            if (!m.others.empty()) {
                w.key("others").begin_array();
                for (const ContactFace& o : m.others)
                    w.begin_object().field("face", o.face).key("parameters").array(o.uv).end_object();
                w.end_array();
            }
            w.key("point").array(c.point.c).field("kind", name_of(c.kind)).field("proven", c.is_proven());
            w.field("least", c.least).field("most", c.most).field("multiplicity", c.multiplicity);
            w.field("gap", c.gap);
            write_boxes(w.key("a_box"), swapped ? box.subspan(1) : box.first(1));
            write_boxes(w.key("b_box"), swapped ? box.first(1) : box.subspan(1));
            w.end_object();
        });
        const Contact<3, 3>& c = m.contact;
        plain_ += text(
            where, ": ", name_of(c.kind), " at ", c.at[0], ", face ", m.face, " at ",
            numbers(std::span(c.at).subspan(1)), m.edge >= 0 ? text(", edge ", m.edge) : "", ", point ",
            numbers(c.point.c),
            c.is_proven() ? "" : text(", ", c.least, " to ", c.most, " times, gap at most ", c.gap), "\n");
    }
    for (const ModelOverlap& o : found.overlaps) {
        overlaps_.push_back([=](json::Writer& w) {
            w.new_line(1).begin_object();
            if (ray)
                w.field("ray", *ray).field("object", objects[0]);
            else
                w.key("objects").array(objects);
            w.key(swapped ? "b" : "a").array(std::array{o.on.lo, o.on.hi});
            w.field("face", o.face).field("gap", o.gap).end_object();
        });
        plain_ += text(where, ": runs in face ", o.face, " over [", o.on.lo, ", ", o.on.hi, "], gap at most ",
                       o.gap, "\n");
    }
    for (const OpenContacts& o : found.open) {
        const std::string face = text(where, ", face ", o.face);
        if (o.reason) remark(text(face, ": nothing is known: ", o.reason->message));
        for (const auto& box : o.boxes) {
            std::string s;
            for (const Interval& t : box) s += text(s.empty() ? "[" : " x [", t.lo, ", ", t.hi, "]");
            undecided_.push_back(text(face, ": ", s));
        }
    }
}

Result<std::vector<StraightLine>> read_lines(const Context& context, const std::string& file, bool rays) {
    const auto table = read_number_lines(file, context.read_options());
    if (!table) return std::unexpected(table.error());
    std::vector<StraightLine> out;
    for (std::size_t i = 0; i < table->row.size(); ++i) {
        const auto& r = table->row[i];
        const std::string where = text(shown(file), ": line ", table->line[i]);
        if (r.size() != 6)
            return refuse(RefusalKind::invalid, where,
                          text("has ", r.size(), " numbers: px, py, pz, dx, dy, dz are expected"));
        StraightLine line{{{r[0], r[1], r[2]}}, {{r[3], r[4], r[5]}}};
        if (rays) line.on.lo = 0;
        if (auto ok = check_line(line, i); !ok) return refuse(ok.error().kind, where, ok.error().message);
        out.push_back(line);
    }
    return out;
}

Result<void> meet_lines(const Input& input, std::span<const StraightLine> lines, double tolerance,
                        ModelContactRows& rows) {
    bool any = false;
    for (const std::size_t i : input.chosen) {
        const auto* own = std::get_if<Model>(&input.object(i).shape);
        const Result<Model> model = own ? Result<Model>(*own) : scene_of(*input.document, std::span(&i, 1));
        if (!model || model->faces.empty()) {
            remark_left_out(input, i);
            continue;
        }
        any = true;
        std::vector<ModelContacts> found(lines.size());
        if (auto done = IntersectModel(*model).intersect(lines, found, {.accuracy = tolerance}); !done)
            return refuse_within(input.label(i), done.error());
        for (std::size_t r = 0; r < lines.size(); ++r)
            rows.add(found[r], {i, r}, r, true, tolerance, text("ray ", r, " with ", input.label(i)));
    }
    if (any) return {};
    return refuse(RefusalKind::no_answer, shown(input.file), "has no surface or model for lines to meet");
}

}  // namespace freiform::cli
