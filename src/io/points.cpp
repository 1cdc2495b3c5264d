// Memory: proportional to the text; counts come from what was read, never from what the text claims.
#include <freiform/core/scan.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/json.hpp>
#include <freiform/io/points.hpp>

namespace freiform {

namespace {

constexpr std::size_t kMostPoints = 0x20000000;

// Numbers and words of one line. Where there is a comma or a semicolon it separates, and blanks do not.
std::vector<std::string_view> fields(std::string_view s) {
    const char separator = s.find(',') != std::string_view::npos   ? ','
                           : s.find(';') != std::string_view::npos ? ';'
                                                                   : ' ';
    std::vector<std::string_view> out;
    if (separator == ' ') {
        for (std::string_view word = next_word(s); !word.empty(); word = next_word(s)) out.push_back(word);
        return out;
    }
    if (s.ends_with(separator)) s.remove_suffix(1);  // as some programs end their lines
    do out.push_back(trimmed(next_part(s, separator)));
    while (!s.empty());
    return out;
}

// Whether a word, perhaps in quotes, stands for a number, finite or not: no heading, then.
bool stands_for_number(std::string_view word) {
    if (word.size() > 1 && word.front() == '"' && word.back() == '"') word = word.substr(1, word.size() - 2);
    if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
    const std::size_t length = scan_real(word).length;
    if (length > 0) return length == word.size();
    std::string lower(word);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return lower == "nan" || lower == "inf" || lower == "infinity";
}

Result<void> add_point(PointTable& t, std::span<const double> x, std::string place) {
    if (x.empty() || x.size() > 4)
        return refuse(RefusalKind::unreadable, std::move(place),
                      text("found ", x.size(), " numbers; points have 1 to 4 coordinates"));
    if (t.coords != 0 && x.size() != std::size_t(t.coords))
        return refuse(RefusalKind::unreadable, std::move(place),
                      text("found ", x.size(), x.size() == 1 ? " number, " : " numbers, ",
                           "the points before have ", t.coords));
    if (t.place.size() >= kMostPoints)
        return refuse(RefusalKind::limit, std::move(place), "more than 2^29 points");
    t.coords = int(x.size());
    t.values.insert(t.values.end(), x.begin(), x.end());
    t.place.push_back(std::move(place));
    return {};
}

Result<std::vector<double>> numbers(const json::Value& v, const std::string& place) {
    std::vector<double> x;
    for (const json::Value& e : v.elements()) {
        if (!e.is(json::Kind::number))
            return refuse(RefusalKind::unreadable, text(place, "[", x.size(), "]"),
                          text("expected a number, found ", name_of(e.kind())));
        if (!(e.number() - e.number() == 0))
            return refuse(RefusalKind::nonfinite, text(place, "[", x.size(), "]"),
                          "leaves the range of double");
        x.push_back(e.number());
    }
    return x;
}

// Whether the first element of the first element is an array: rows of points.
bool is_grid(const json::Value& v) {
    for (const json::Value& row : v.elements()) {
        if (!row.is(json::Kind::array)) return false;
        for (const json::Value& e : row.elements()) return e.is(json::Kind::array);
        return false;
    }
    return false;
}

Result<PointTable> points_of(const json::Value& v, const std::string& name) {
    if (!v.is(json::Kind::array))
        return refuse(RefusalKind::unreadable, name,
                      text("expected an array of points, found ", name_of(v.kind())));
    PointTable t;
    t.grid = is_grid(v);
    const auto add = [&](const json::Value& p, const std::string& place) -> Result<void> {
        if (!p.is(json::Kind::array))
            return refuse(RefusalKind::unreadable, place,
                          text("expected a point [x, ...], found ", name_of(p.kind())));
        const auto x = numbers(p, place);
        if (!x) return std::unexpected(x.error());
        return add_point(t, *x, place);
    };
    int i = 0;
    for (const json::Value& e : v.elements()) {
        const std::string place = text(name, "[", i, "]");
        if (!t.grid) {
            if (auto ok = add(e, place); !ok) return std::unexpected(ok.error());
        } else {
            if (!e.is(json::Kind::array))
                return refuse(RefusalKind::unreadable, place,
                              text("expected a row of points, found ", name_of(e.kind())));
            int j = 0;
            for (const json::Value& p : e.elements())
                if (auto ok = add(p, text(place, "[", j++, "]")); !ok) return std::unexpected(ok.error());
            if (i > 0 && j != t.extent[1])
                return refuse(RefusalKind::unreadable, place,
                              text("a row of ", j, " points, the rows before have ", t.extent[1]));
            t.extent[1] = j;
        }
        ++i;
    }
    t.extent = t.grid ? Index<2>{i, t.extent[1]} : Index<2>{i, 1};
    return t;
}

Result<PointTable> parse_json(std::string_view s) {
    const auto tree = json::parse(s);
    if (!tree) return std::unexpected(tree.error());
    const json::Value root = tree->root();
    if (!root.is(json::Kind::object)) return points_of(root, "");
    for (const json::Member& m : root.members())
        if (m.key == "points") return points_of(m.value, "points");
    return refuse(RefusalKind::unreadable, "",
                  "expected an array of points, or an object with the field points");
}

Refusal in_file(const std::string& path, Refusal r) {
    const std::string file = path == "-" ? "standard input" : path;
    if (r.where.find(file) == std::string::npos) r.where = r.where.empty() ? file : text(file, ": ", r.where);
    return r;
}

// What some editors put in front of UTF-8.
constexpr std::string_view kMark = "\xEF\xBB\xBF";

// Lines end with a line feed, a carriage return, or both.
std::string_view next_line(std::string_view& rest) {
    const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(rest.size(), end + (rest.substr(end, 2) == "\r\n" ? 2 : 1)));
    return line;
}

}  // namespace

Result<NumberLines> parse_number_lines(std::string_view s) {
    NumberLines out;
    if (s.starts_with(kMark)) s.remove_prefix(kMark.size());
    bool heading = false;
    for (std::size_t line = 1; !s.empty(); ++line) {
        const std::string_view whole = next_line(s);
        const std::string_view row = trimmed(whole.substr(0, whole.find('#')));
        if (row.empty()) continue;
        std::vector<double> values;
        std::string_view wrong;
        bool words = true;
        for (const std::string_view field : fields(row)) {
            words = words && !stands_for_number(field);
            if (const auto x = scan_number<double>(field))
                values.push_back(*x);
            else if (wrong.data() == nullptr)
                wrong = field;
        }
        if (wrong.data() == nullptr) {
            out.row.push_back(std::move(values));
            out.line.push_back(line);
        } else if (words && out.row.empty() && !heading && row[0] != '[' && row[0] != '{') {
            heading = true;
        } else {
            return refuse(
                RefusalKind::unreadable, text("line ", line),
                text("expected finite numbers separated by commas, found \"", wrong.substr(0, 40), "\""));
        }
    }
    return out;
}

Result<PointTable> parse_points(std::string_view s) {
    std::string_view rest = s;
    if (rest.starts_with(kMark)) rest.remove_prefix(kMark.size());
    while (!rest.empty() && (is_blank(rest.front()) || rest.front() == '\n')) rest.remove_prefix(1);
    if (rest.starts_with('[') || rest.starts_with('{')) return parse_json(s);
    const auto lines = parse_number_lines(s);
    if (!lines) return std::unexpected(lines.error());
    PointTable t;
    for (std::size_t i = 0; i < lines->row.size(); ++i)
        if (auto ok = add_point(t, lines->row[i], text("line ", lines->line[i])); !ok)
            return std::unexpected(ok.error());
    t.extent = {int(t.place.size()), 1};
    return t;
}

Result<PointTable> read_points(const std::string& path, const ReadOptions& options) {
    const auto bytes = read_file(path, options.max_bytes);
    if (!bytes) return std::unexpected(bytes.error());
    auto t = parse_points(*bytes);
    if (!t) return std::unexpected(in_file(path, t.error()));
    return t;
}

Result<NumberLines> read_number_lines(const std::string& path, const ReadOptions& options) {
    const auto bytes = read_file(path, options.max_bytes);
    if (!bytes) return std::unexpected(bytes.error());
    auto lines = parse_number_lines(*bytes);
    if (!lines) return std::unexpected(in_file(path, lines.error()));
    return lines;
}

}  // namespace freiform
