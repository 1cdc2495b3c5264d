#include "point_commands.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/document.hpp>
#include <freiform/io/obj_freeform.hpp>
#include <freiform/io/step.hpp>

#include <algorithm>

namespace freiform::cli {

std::unexpected<Refusal> about_file(Refusal r, const PointTable& t, const std::string& file) {
    constexpr std::string_view kPoints = "points[";
    if (r.where.starts_with(kPoints)) {
        std::string_view rest = std::string_view(r.where).substr(kPoints.size());
        const auto i = scan_number<std::size_t>(next_part(rest, ']'));
        if (i && *i < t.place.size() && rest.empty()) r.where = t.place[*i];
    }
    // The same for a neighbour that the sentence names.
    if (const std::size_t at = r.message.find(kPoints); at != std::string::npos) {
        const std::size_t end = r.message.find(']', at);
        const auto i = end == std::string::npos ? std::nullopt
                                                : scan_number<std::size_t>(std::string_view(r.message).substr(
                                                      at + kPoints.size(), end - at - kPoints.size()));
        if (i && *i < t.place.size()) r.message.replace(at, end + 1 - at, t.place[*i]);
    }
    r.where = r.where.empty() ? shown(file) : text(shown(file), ": ", r.where);
    return std::unexpected(std::move(r));
}

std::string spline_format(const Context& context, const std::string& command) {
    std::string format = context.to;
    if (format.empty()) {
        const std::size_t dot = context.output.rfind('.'), slash = context.output.rfind('/');
        const bool ending = dot != std::string::npos && (slash == std::string::npos || slash < dot);
        format = ending && context.output != "-" ? context.output.substr(dot + 1) : "json";
    }
    for (char& c : format) c = c >= 'A' && c <= 'Z' ? char(c + 32) : c;
    if (format != "json" && format != "bpt" && format != "step" && format != "obj")
        wrong_usage(text(command, " writes .json, .bpt, .step and (free-form) .obj, not \"", format, "\""));
    return format;
}

std::vector<std::vector<double>> parse_vectors(const std::string& option, std::string_view s, int coords) {
    std::vector<std::vector<double>> out;
    while (!s.empty()) {
        std::string_view part = trimmed(next_part(s, ';'));
        const std::string shown_part(part);
        std::vector<double> v;
        while (!part.empty()) {
            const auto x = scan_number<double>(trimmed(next_part(part, ',')));
            if (!x)
                wrong_usage(text(option, " needs vectors of numbers, X,Y;X,Y, found \"", shown_part, "\""));
            v.push_back(*x);
        }
        if (int(v.size()) != coords)
            wrong_usage(text(option, ": \"", shown_part, "\" has ", v.size(),
                             v.size() == 1 ? " number" : " numbers", ", the points have ", coords));
        out.push_back(std::move(v));
    }
    return out;
}

Result<void> emit_spline(const Context& context, const std::string& format, Document document,
                         const std::string& text_report, const std::string& json_report) {
    remark_unknown_unit(document.unit, format);
    const auto bytes = format == "json"   ? Result<std::string>(write_document(document))
                       : format == "step" ? write_step(document)
                       : format == "obj"  ? write_obj_freeform(document)
                                          : write_bpt(document);
    if (!bytes) return std::unexpected(bytes.error());
    if (auto ok = emit(context, *bytes); !ok) return ok;
    if (context.output.empty() || context.output == "-") return {};
    return emit({}, context.json ? json_report : text_report);
}

}  // namespace freiform::cli
