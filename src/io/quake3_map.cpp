// The text: words between blanks; { } around entities and brushes, ( ) around points, "..." around keys and
// values, and what follows // on a line is a remark.
#include "quake3_detail.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/io/quake3.hpp>

namespace freiform {

namespace quake3 {

Result<void> Grid::check() const {
    for (const int n : {width, height})
        if (n < 3 || n % 2 == 0 || n > kMostRows)
            return refuse(
                RefusalKind::unreadable, "grid",
                text("of ", width, " x ", height, " points; both must be odd, from 3 to ", kMostRows));
    return {};
}

Result<Object> Grid::object(std::string name, std::string material) const {
    const auto at = [&](int i, int j) -> const Vertex& { return vertices[std::size_t(i * height + j)]; };
    double agreement = 0;
    for (int i = 0; i + 1 < width; ++i)
        for (int j = 0; j + 1 < height; ++j)
            agreement += dot(
                cross(at(i + 1, j).position - at(i, j).position, at(i, j + 1).position - at(i, j).position),
                at(i, j).normal);
    std::vector<Vec<3>> net;
    std::vector<Colour> colours;
    bool coloured = false;
    for (int i = 0; i < width; ++i)
        for (int j = 0; j < height; ++j) {
            const Vertex& v = at(agreement < 0 ? width - 1 - i : i, j);
            net.push_back(v.position);
            colours.push_back(v.colour);
            coloured = coloured || !(v.colour == Colour{});
        }
    if (!coloured) colours.clear();
    const auto basis = [](int n) {
        std::vector<double> knots{0};
        for (int i = 0; i <= n / 2; ++i) knots.insert(knots.end(), 2, double(i));
        knots.push_back(n / 2);
        return *BSplineBasis::make(2, std::move(knots));
    };
    auto surface =
        Surface<Vec<3>>::make({basis(width), basis(height)}, Net<2, Vec<3>>({width, height}, std::move(net)));
    if (!surface) return std::unexpected(surface.error());
    return Object{std::move(name), std::move(*surface), {}, std::move(material), std::move(colours)};
}

}  // namespace quake3

namespace {

bool is_white(char c) { return is_blank(c) || c == '\n'; }

class MapWords {
public:
    explicit MapWords(std::string_view text) : rest_(text) {}

    // The next word; empty at the end. Quotes stay.
    std::string_view next() {
        for (;;) {
            while (!rest_.empty() && is_white(rest_[0])) skip(1);
            if (!rest_.starts_with("//")) break;
            skip(std::min(rest_.find('\n'), rest_.size()));
        }
        if (rest_.empty()) return {};
        std::size_t n = 1;
        if (rest_[0] == '"') {
            while (n < rest_.size() && rest_[n] != '"' && rest_[n] != '\n') ++n;
            n = std::min(n + 1, rest_.size());
        } else {
            while (n < rest_.size() && !is_white(rest_[n])) ++n;
        }
        const std::string_view word = rest_.substr(0, n);
        skip(n);
        return word;
    }
    Result<void> expect(std::string_view wanted) {
        if (const auto word = next(); word != wanted) return expected(text("\"", wanted, "\""), word);
        return {};
    }
    template <class T>
    Result<T> number() {
        const auto word = next();
        if (const auto x = scan_number<T>(word)) return *x;
        return expected("a number", word);
    }
    std::unexpected<Refusal> expected(std::string_view what, std::string_view found) const {
        std::string shown;
        for (const char c : found.substr(0, 40)) shown += c >= ' ' && c < 127 ? c : '?';
        return fail(found.empty() ? text("the file ends where ", what, " is expected")
                                  : text("expected ", what, ", found \"", shown, "\""));
    }
    std::unexpected<Refusal> fail(std::string message) const {
        return refuse(RefusalKind::unreadable, text("line ", line_), std::move(message));
    }
    std::size_t left() const { return rest_.size(); }

private:
    void skip(std::size_t n) {
        for (const char c : rest_.substr(0, n)) line_ += c == '\n';
        rest_.remove_prefix(n);
    }
    std::string_view rest_;
    long long line_ = 1;
};

// { texture ( width height and 3 or 5 numbers more ) ( ( ( x y z s t ) .. ) .. ) }
Result<Object> read_patch_words(MapWords& words, std::string name, int more) {
    if (auto ok = words.expect("{"); !ok) return std::unexpected(ok.error());
    const std::string material(words.next());
    if (auto ok = words.expect("("); !ok) return std::unexpected(ok.error());
    const auto width = words.number<int>();
    if (!width) return std::unexpected(width.error());
    const auto height = words.number<int>();
    if (!height) return std::unexpected(height.error());
    for (int i = 0; i < more; ++i)
        if (auto x = words.number<double>(); !x) return std::unexpected(x.error());
    quake3::Grid grid{*width, *height, {}};
    if (auto ok = grid.check(); !ok) return words.fail(text("a grid ", ok.error().message));
    // A point has at least 14 bytes.
    if (std::size_t(*width) * std::size_t(*height) > words.left() / 14 + 1)
        return words.fail(text("a grid of ", *width, " x ", *height, " points, but only ", words.left(),
                               " bytes are left"));
    for (const std::string_view opening : {")", "("})
        if (auto ok = words.expect(opening); !ok) return std::unexpected(ok.error());
    for (int i = 0; i < *width; ++i) {
        if (auto ok = words.expect("("); !ok) return std::unexpected(ok.error());
        for (int j = 0; j < *height; ++j) {
            if (auto ok = words.expect("("); !ok) return std::unexpected(ok.error());
            quake3::Vertex v;
            for (int k = 0; k < 5; ++k) {
                const auto x = words.number<double>();
                if (!x) return std::unexpected(x.error());
                if (k < 3) v.position[k] = *x;
            }
            grid.vertices.push_back(v);
            if (auto ok = words.expect(")"); !ok) return std::unexpected(ok.error());
        }
        if (auto ok = words.expect(")"); !ok) return std::unexpected(ok.error());
    }
    for (const std::string_view closing : {")", "}"})
        if (auto ok = words.expect(closing); !ok) return std::unexpected(ok.error());
    auto object = grid.object(std::move(name), material);
    if (!object) return words.fail(object.error().message);
    return object;
}

}  // namespace

Result<Document> read_quake3_map(std::string_view bytes) {
    MapWords words(bytes);
    Document document;
    long long entity = -1, brush = -1;
    int depth = 0;  // 1 in an entity, 2 in a brush
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
        if (word == "{") {
            if (++depth > 2) return words.fail("a brace inside a brush of planes");
            depth == 1 ? (++entity, brush = -1) : ++brush;
        } else if (word == "}") {
            if (--depth < 0) return words.fail("a closing brace without an opening one");
        } else if (depth == 0) {
            return words.expected("an entity: {", word);
        } else if (depth == 2 && (word == "patchDef2" || word == "patchDef3")) {
            auto object = read_patch_words(words, text("entity ", entity, " brush ", brush),
                                           word == "patchDef2" ? 3 : 5);
            if (!object) return std::unexpected(object.error());
            document.objects.push_back(std::move(*object));
        } else if (depth == 2 && word == "brushDef") {
            if (auto ok = words.expect("{"); !ok) return std::unexpected(ok.error());
            for (word = words.next(); word != "}"; word = words.next())
                if (word.empty()) return words.expected("\"}\"", word);
        }
    }
    if (depth != 0) return words.fail(text("the file ends inside ", depth, " braces"));
    if (document.objects.empty())
        return refuse(
            RefusalKind::no_answer, "",
            text("the map has ", entity + 1, " entities and no patch; walls made of planes are not read"));
    return document;
}

}  // namespace freiform
