// gallery: a folder with one figure for each row of what freiform knows about curves, the documents they are
// made from, and a page that shows them.
#include "gallery/gallery.hpp"

#include "command.hpp"
#include "drawing_bytes.hpp"

#include <freiform/io/file.hpp>

#include <algorithm>
#include <filesystem>

namespace freiform::cli {

namespace {

using gallery::Entry;

struct GalleryArguments {
    std::vector<std::string> only;  // all if empty; each as "R05", without the case
};

// In the order of the gallery, each once.
std::vector<const Entry*> chosen(std::vector<std::string> only) {
    for (std::string& row : only) {
        if (row.starts_with('r')) row[0] = 'R';
        if (std::ranges::find(gallery::entries(), row, &Entry::row) == gallery::entries().end())
            wrong_usage(text("--only needs rows of ", gallery::entries().front().row, " to ",
                             gallery::entries().back().row, ", found \"", row, "\""));
    }
    std::vector<const Entry*> out;
    for (const Entry& e : gallery::entries())
        if (only.empty() || std::ranges::find(only, e.row) != only.end()) out.push_back(&e);
    return out;
}

std::string_view source_of(const Entry& e) {
    const auto all = gallery::sources();
    const auto found = std::ranges::find(all, e.row, &gallery::Source::row);
    return found == all.end() ? std::string_view() : found->json;
}

// For HTML, where the words have no markup of their own.
std::string html(std::string_view s) {
    std::string out;
    for (const char c : s)
        out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    return out;
}

constexpr std::string_view kStyle = R"(
:root { color-scheme: light; --ink: #22252b; --grey: #6a6f78; --line: #dfe2e6; --blue: #00549e; }
* { box-sizing: border-box; }
body { margin: 0; background: #f6f7f8; color: var(--ink); font: 17px/1.55 Georgia, 'DejaVu Serif', serif; }
header, main, footer { max-width: 1180px; margin: 0 auto; padding: 0 28px; }
header { padding-top: 56px; padding-bottom: 12px; }
h1 { font-size: 40px; font-weight: normal; margin: 0 0 10px; }
header p { margin: 0; color: var(--grey); max-width: 44em; }
nav { margin: 26px 0 0; columns: 4 220px; font-size: 15px; }
nav a { display: block; color: var(--blue); text-decoration: none; padding: 1px 0; }
nav a:hover { text-decoration: underline; }
section { background: white; border: 1px solid var(--line); border-radius: 6px; margin: 30px 0; padding: 26px 30px; }
h2 { font-size: 24px; font-weight: normal; margin: 0 0 4px; }
h2 span { color: var(--grey); font-size: 16px; margin-right: 12px; font-variant-numeric: tabular-nums; }
section p { margin: 0 0 10px; max-width: 50em; }
img { display: block; width: 100%; height: auto; }
pre { margin: 12px 0 0; padding: 10px 14px; background: #f6f7f8; border-left: 3px solid var(--line); overflow-x: auto;
  font: 13.5px/1.6 'DejaVu Sans Mono', ui-monospace, monospace; color: #3c4149; }
pre a { color: var(--blue); }
footer { color: var(--grey); font-size: 15px; padding-bottom: 50px; }
@media print { body { background: white; } section { break-inside: avoid; border: 0; } nav { display: none; } }
)";

std::string page_of(std::span<const Entry* const> shown, const std::string& format) {
    std::string s = text(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
        "content=\"width=device-width, initial-scale=1\">\n<title>freiform: curves and surfaces "
        "in figures</title>\n<style>",
        kStyle, "</style>\n</head>\n<body>\n<header>\n<h1>Curves and surfaces in figures</h1>\n",
        "<p>What freiform knows about curves and surfaces, one figure for each subject. All are drawn by the "
        "program "
        "itself "
        "from the small documents beside this page; the commands below each figure draw it "
        "again.</p>\n<nav>\n");
    for (const Entry* e : shown)
        s += text("<a href=\"#", e->row, "\">", e->row.substr(1), "&ensp;", html(e->title), "</a>\n");
    s += "</nav>\n</header>\n<main>\n";
    for (const Entry* e : shown) {
        const std::string file = text(e->row, ".", format);
        s += text("<section id=\"", e->row, "\">\n<h2><span>", e->row, "</span>", html(e->title),
                  "</h2>\n<p>", html(e->words), "</p>\n");
        s += format == "pdf"
                 ? text("<p><a href=\"", file, "\">", file, "</a></p>\n")
                 : text("<img src=\"", file, "\" alt=\"", html(e->title), "\" loading=\"lazy\">\n");
        s += text("<pre>freiform gallery -o . --only ", e->row, format == "svg" ? "" : " --to ",
                  format == "svg" ? "" : format, "\n");
        if (!e->options.empty())
            s += text("freiform draw <a href=\"", e->row, ".json\">", e->row, ".json</a> -o curves.svg ",
                      html(e->options), "\n");
        s += "</pre>\n</section>\n";
    }
    return s + text("</main>\n<footer><p>freiform " FREIFORM_VERSION "</p></footer>\n</body>\n</html>\n");
}

Result<void> write_entry(const Entry& e, const std::string& folder, const std::string& format) {
    const std::string_view json = source_of(e);
    const auto document = read_document(json);
    if (!document) return refuse_within(e.row, document.error());
    const auto bytes = drawing_bytes(arrange(e.figure(*document)), format, "gallery");
    if (!bytes) return std::unexpected(bytes.error());
    if (auto ok = write_file(text(folder, "/", e.row, ".json"), json); !ok) return ok;
    return write_file(text(folder, "/", e.row, ".", format), *bytes);
}

Result<void> run_gallery(const Context& context, const GalleryArguments& options) {
    if (context.output.empty() || context.output == "-") wrong_usage("-o FOLDER says where the figures go");
    const std::string format = context.to.empty() ? "svg" : context.to;
    if (format != "svg" && format != "pdf" && format != "png")
        wrong_usage(text("figures are written as svg, pdf or png, not ", format));
    const std::vector<const Entry*> shown = chosen(options.only);
    std::error_code failed;
    std::filesystem::create_directories(context.output, failed);
    if (failed) return refuse(RefusalKind::io, context.output, text("cannot be made: ", failed.message()));
    for (const Entry* e : shown)
        if (auto ok = write_entry(*e, context.output, format); !ok) return ok;
    if (shown.size() > 1)
        if (auto ok = write_file(context.output + "/index.html", page_of(shown, format)); !ok) return ok;
    if (!context.json) return {};
    json::Writer w;
    w.begin_object().key("figures").begin_array();
    for (const Entry* e : shown) {
        w.begin_object();
        w.field("row", e->row).field("title", e->title).field("file", text(e->row, ".", format));
        w.end_object();
    }
    w.end_array().end_object();
    Context to_output;
    return emit(to_output, w.take() + "\n");
}

}  // namespace

void add_gallery(CommandLine& line) {
    const auto options = std::make_shared<GalleryArguments>();
    const Command command = line.add("gallery", "Figures of what freiform knows about curves and surfaces",
                                     "  freiform gallery -o figures        (then open figures/index.html)\n"
                                     "  freiform gallery -o figures --only R15 --to pdf");
    command.word("-o,--output", line.context().output, "The folder; it is made if it is not there")
        .shown_as("FOLDER");
    command.word("--to", line.context().to, "svg (default), pdf or png").shown_as("FORMAT");
    command.words("--only", options->only, "Only these figures: R01, R02, ..").shown_as("ROW ...");
    command.action(options, run_gallery);
}

}  // namespace freiform::cli
