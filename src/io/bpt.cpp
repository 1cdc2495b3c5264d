#include <freiform/core/scan.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>

#include <algorithm>

namespace freiform {

namespace {

// The lines that say something.
class Lines {
public:
    explicit Lines(std::string_view text) : rest_(text) {}

    // False at the end. `line` is without comment and blanks.
    bool next(std::string_view& line) {
        while (!rest_.empty()) {
            ++number_;
            std::string_view s = next_part(rest_, '\n');
            line = trimmed(s.substr(0, s.find('#')));
            if (!line.empty()) return true;
        }
        return false;
    }
    std::size_t left() const { return rest_.size(); }
    std::unexpected<Refusal> fail(std::string message) const {
        return refuse(RefusalKind::unreadable, text("line ", number_), std::move(message));
    }
    std::unexpected<Refusal> ended(std::string_view wanted) const {
        return refuse(RefusalKind::unreadable, text("line ", number_ + 1),
                      text("the file ends where ", wanted, " is expected"));
    }

private:
    std::string_view rest_;
    std::size_t number_ = 0;
};

std::string shown_line(std::string_view line) {
    std::string s = "\"";
    for (const char c : line.substr(0, 40)) s += c >= ' ' && c < 127 ? c : '?';
    return s + (line.size() > 40 ? "...\"" : "\"");
}

// K numbers and nothing else.
template <class T, std::size_t K>
bool numbers(std::string_view line, std::array<T, K>& out) {
    for (T& x : out) {
        const auto number = scan_number<T>(next_word(line));
        if (!number) return false;
        x = *number;
    }
    return trimmed(line).empty();
}

Result<Shape> read_patch_lines(Lines& lines, long long patch, long long patches) {
    std::string_view line;
    if (!lines.next(line)) return lines.ended(text("patch ", patch + 1, " of ", patches));
    std::array<int, 2> degree{};
    if (!numbers(line, degree))
        return lines.fail(text("expected the two degrees of a patch, found ", shown_line(line)));
    for (const int p : degree)
        if (p < 0 || p > kMaxDegree) return lines.fail(text("degree ", p, " is outside 0..", kMaxDegree));
    Net<2, Vec<3>> net({degree[0] + 1, degree[1] + 1});
    const std::size_t count = net.flat().size();
    for (std::size_t i = 0; i < count; ++i) {
        if (!lines.next(line)) return lines.ended(text("point ", i + 1, " of ", count));
        if (!numbers(line, net.flat()[i].c))
            return lines.fail(text("expected three finite numbers (point ", i + 1, " of ", count, "), found ",
                                   shown_line(line)));
    }
    auto surface =
        Surface<Vec<3>>::make({*BSplineBasis::bezier(degree[0]), *BSplineBasis::bezier(degree[1])}, net);
    if (!surface) return lines.fail(surface.error().message);
    return std::move(*surface);
}

void append_patch(std::string& s, std::span<const BSplineBasis> bases, const std::vector<Vec<3>>& points) {
    s += text(bases[0].degree(), " ", bases[1].degree(), "\n");
    for (const Vec<3>& p : points) s += text(p[0], " ", p[1], " ", p[2], "\n");
}

// Why a shape has no place in the format; empty if it has one.
std::string obstacle(const Shape& shape) {
    return visit_one(
        [&](const auto& s) -> std::string {
            using S = std::remove_cvref_t<decltype(s)>;
            if constexpr (std::same_as<S, Surface<Vec<3>>> || std::same_as<S, Surface<Hom<3>>>) {
                for (const BSplineBasis& b : s.bases())
                    if (b.is_closed() || b.size() != b.degree() + 1 || b.domain().lo != b.knot(0) ||
                        b.domain().hi != b.knot(b.size() + b.degree()))
                        return "is a spline of several pieces, the format has Bezier patches only (convert "
                               "with "
                               "--to-bezier)";
                const auto w = weights(s);
                if (std::any_of(w.begin(), w.end(), [](double x) { return x != 1; }))
                    return "has weights, the format has polynomial patches only";
                return {};
            } else {
                return text("is a ", type_name(shape), TensorPatch<S> ? " (or not in space)" : "",
                            ", the format has Bezier patches in space only");
            }
        },
        shape);
}

}  // namespace

std::string object_label(const Document& document, std::size_t index) {
    const std::string& name = document.objects[index].name;
    return name.empty() ? text("objects[", index, "]") : text("objects[", index, "] \"", name, "\"");
}

Result<Document> read_bpt(std::string_view bytes) {
    Lines lines(bytes);
    std::string_view line;
    if (!lines.next(line)) return lines.ended("the number of patches");
    std::array<long long, 1> patches{};
    if (!numbers(line, patches) || patches[0] < 0)
        return lines.fail(text("expected the number of patches, found ", shown_line(line)));
    // A patch needs two degrees and a point: at least ten bytes.
    if (patches[0] > (long long)(lines.left() / 8))
        return lines.fail(text(patches[0], " patches are announced, ", lines.left(), " bytes follow"));
    Document document;
    for (long long i = 0; i < patches[0]; ++i) {
        auto shape = read_patch_lines(lines, i, patches[0]);
        if (!shape) return std::unexpected(shape.error());
        document.objects.push_back({"", std::move(*shape), {}});
    }
    if (lines.next(line))
        return lines.fail(text("more follows the ", patches[0], " patches: ", shown_line(line)));
    return document;
}

Result<std::string> write_bpt(const Document& document) {
    std::string s = text(document.objects.size(), "\n");
    for (std::size_t i = 0; i < document.objects.size(); ++i) {
        const Shape& shape = document.objects[i].shape;
        if (const std::string why = obstacle(shape); !why.empty())
            return refuse(RefusalKind::no_answer, object_label(document, i),
                          text("cannot be written as .bpt: it ", why));
        if (const auto* polynomial = std::get_if<Surface<Vec<3>>>(&shape))
            append_patch(s, polynomial->bases(), points(*polynomial));
        else if (const auto* rational = std::get_if<Surface<Hom<3>>>(&shape))
            append_patch(s, rational->bases(), points(*rational));
    }
    return s;
}

}  // namespace freiform
