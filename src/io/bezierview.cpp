#include <freiform/core/scan.hpp>
#include <freiform/io/bezierview.hpp>

#include <algorithm>

namespace freiform {

namespace {

class Words {
public:
    explicit Words(std::string_view text) : rest_(text) {}

    // Empty at the end.
    std::string_view peek() {
        skip();
        std::size_t n = 0;
        while (n < rest_.size() && !is_blank(rest_[n]) && rest_[n] != '\n') ++n;
        return rest_.substr(0, n);
    }
    void pass(std::string_view word) { rest_.remove_prefix(word.size()); }
    // What the line still has.
    std::string_view rest_of_line() {
        const std::string_view line = rest_.substr(0, std::min(rest_.find('\n'), rest_.size()));
        rest_.remove_prefix(line.size());
        return trimmed(line);
    }

    template <class T>
    Result<T> number(std::string_view what) {
        const std::string_view word = peek();
        if (word.empty()) return fail(text("the file ends where ", what, " is expected"));
        const auto x = scan_number<T>(word);
        if (!x) return fail(text("expected ", what, ", found ", shown(word)));
        pass(word);
        return *x;
    }

    std::size_t left() const { return rest_.size(); }
    std::size_t line() const { return line_; }
    std::unexpected<Refusal> fail(std::string message) const {
        return refuse(RefusalKind::unreadable, text("line ", line_), std::move(message));
    }
    static std::string shown(std::string_view word) {
        std::string s = "\"";
        for (const char c : word.substr(0, 40)) s += c >= ' ' && c < 127 ? c : '?';
        return s + (word.size() > 40 ? "...\"" : "\"");
    }

private:
    void skip() {
        while (!rest_.empty() && (is_blank(rest_[0]) || rest_[0] == '\n')) {
            line_ += rest_[0] == '\n';
            rest_.remove_prefix(1);
        }
    }

    std::string_view rest_;
    std::size_t line_ = 1;
};

class BezierViewReader {
public:
    explicit BezierViewReader(std::string_view text) : w_(text) {}

    Result<Document> read() {
        if (w_.peek().empty()) return w_.fail("the file is empty");
        while (!w_.peek().empty())
            if (auto ok = segment(); !ok) return std::unexpected(ok.error());
        if (normals_ > 0)
            out_.left_out.push_back(
                {RefusalKind::unsupported, text("line ", normals_at_),
                 text("normals of their own, of ", normals_, normals_ == 1 ? " patch" : " patches",
                      ", are left out: those of the surfaces are what they are")});
        return std::move(out_);
    }

private:
    Result<void> segment() {
        const std::string_view word = w_.peek();
        if (word == "group" || word == "Group" || word == "GROUP") {
            w_.pass(word);
            if (auto ok = w_.number<int>("the number of a group"); !ok) return std::unexpected(ok.error());
            name_ = w_.rest_of_line();
            return {};
        }
        const auto kind = w_.number<int>("the kind of what follows (1, 3, 4, 5, 8, 9 or 10)");
        if (!kind) return std::unexpected(kind.error());
        switch (*kind) {
            case 1:
                return polyhedron();
            case 3:
                return triangle(false);
            case 4:
                return patch<Vec<3>>(true, false);
            case 5:
                return patch<Vec<3>>(false, false);
            case 8:
                return patch<Hom<3>>(false, false);
            case 9:
                return triangle(true);
            case 10:
                return patch<Vec<3>>(false, true);
            default:
                return w_.fail(
                    text("is of kind ", *kind,
                         "; known are 1 (polyhedron), 3 (triangle), 4 and 5 (patches), 8 (rational), "
                         "9 and 10 (with normals)"));
        }
    }

    Result<int> degree() {
        const auto n = w_.number<int>("a degree");
        if (n && (*n < 0 || *n > kMaxDegree))
            return w_.fail(text("degree ", *n, " is outside 0..", kMaxDegree));
        return n;
    }

    template <class P>
    Result<void> points(std::span<P> out) {
        for (std::size_t i = 0; i < out.size(); ++i)
            for (double& x : out[i].c) {
                const auto number =
                    w_.number<double>(text("a coordinate of point ", i + 1, " of ", out.size()));
                if (!number) return std::unexpected(number.error());
                x = *number;
            }
        return {};
    }

    Result<void> pass_normals(std::size_t count) {
        normals_at_ = normals_++ == 0 ? w_.line() : normals_at_;
        std::vector<Vec<3>> unused(count);
        return points<Vec<3>>(unused);
    }

    // `made` at the line where it begins.
    template <class S>
    Result<void> keep(Result<S> made, std::size_t line) {
        if (!made)
            return refuse(
                RefusalKind::unreadable, text("line ", line),
                text(made.error().where, made.error().where.empty() ? "" : ": ", made.error().message));
        out_.objects.push_back({name_, std::move(*made), {}});
        return {};
    }

    template <class P>
    Result<void> patch(bool one_degree, bool has_normals) {
        const std::size_t line = w_.line();
        const auto m = degree();
        if (!m) return std::unexpected(m.error());
        const auto n = one_degree ? m : degree();
        if (!n) return std::unexpected(n.error());
        std::array<int, 2> of_normals{};
        for (int i = 0; i < 2 && has_normals; ++i) {
            const auto k = degree();
            if (!k) return std::unexpected(k.error());
            of_normals[std::size_t(i)] = *k;
        }
        Net<2, P> net({*m + 1, *n + 1});
        if (auto ok = points<P>(net.flat()); !ok) return ok;
        if (has_normals)
            if (auto ok = pass_normals(std::size_t((of_normals[0] + 1) * (of_normals[1] + 1))); !ok)
                return ok;
        return keep(Surface<P>::make({*BSplineBasis::bezier(*m), *BSplineBasis::bezier(*n)}, std::move(net)),
                    line);
    }

    // The rows of the file begin at the side opposite to our first corner, and turn the same way.
    Result<void> triangle(bool has_normals) {
        const std::size_t line = w_.line();
        const auto n = degree();
        if (!n) return std::unexpected(n.error());
        const auto k = has_normals ? degree() : 0;
        if (!k) return std::unexpected(k.error());
        const auto count = [](int degree) { return std::size_t((degree + 1) * (degree + 2) / 2); };
        std::vector<Vec<3>> rows(count(*n)), coefficients;
        if (auto ok = points<Vec<3>>(rows); !ok) return ok;
        if (has_normals)
            if (auto ok = pass_normals(count(*k)); !ok) return ok;
        coefficients.reserve(rows.size());
        for (std::size_t length = 1, end = rows.size(); end > 0; end -= length++)
            coefficients.insert(coefficients.end(), rows.begin() + std::ptrdiff_t(end - length),
                                rows.begin() + std::ptrdiff_t(end));
        return keep(Triangle<Vec<3>>::make(*n, std::move(coefficients)), line);
    }

    Result<void> polyhedron() {
        const std::size_t line = w_.line();
        const auto n = w_.number<long long>("a number of points");
        if (!n) return std::unexpected(n.error());
        const auto polygons = w_.number<long long>("a number of polygons");
        if (!polygons) return std::unexpected(polygons.error());
        // A coordinate and a corner take two bytes at least, but for the last one.
        const auto room = (long long)(w_.left() / 2 + 1);
        if (*n < 0 || *polygons < 0 || *n > room / 3 || *polygons > room)
            return refuse(
                RefusalKind::unreadable, text("line ", line),
                text(*n, " points and ", *polygons, " polygons are announced, ", w_.left(), " bytes follow"));
        std::vector<Vec<3>> p(static_cast<std::size_t>(*n));
        if (auto ok = points<Vec<3>>(p); !ok) return ok;
        for (long long i = 0; i < *polygons; ++i)
            if (auto ok = polygon(p, i, *polygons); !ok) return ok;
        return {};
    }

    Result<void> polygon(std::span<const Vec<3>> p, long long i, long long count) {
        const std::string what = text("the number of corners of polygon ", i + 1, " of ", count);
        const auto corners = w_.number<long long>(what);
        if (!corners) return std::unexpected(corners.error());
        const std::size_t line = w_.line();
        if (*corners < 3) return w_.fail(text("a polygon has ", *corners, " corners"));
        std::array<Vec<3>, 4> c{};
        for (long long j = 0; j < *corners; ++j) {
            const auto at = w_.number<long long>(text("corner ", j + 1, " of polygon ", i + 1));
            if (!at) return std::unexpected(at.error());
            if (*at < 0 || *at >= (long long)p.size())
                return w_.fail(text("corner ", *at, " is outside 0..", (long long)p.size() - 1));
            if (j < 4) c[std::size_t(j)] = p[std::size_t(*at)];
        }
        if (*corners == 3) return keep(Triangle<Vec<3>>::make(1, {c[0], c[1], c[2]}), line);
        if (*corners > 4) {
            out_.left_out.push_back({RefusalKind::unsupported, text("line ", line),
                                     text("a polygon of ", *corners,
                                          " corners; triangles and quadrangles are read as surfaces")});
            return {};
        }
        Net<2, Vec<3>> net({2, 2});
        const std::array<Vec<3>, 4> rows{c[0], c[3], c[1], c[2]};
        std::copy(rows.begin(), rows.end(), net.flat().begin());
        return keep(Surface<Vec<3>>::make({*BSplineBasis::bezier(1), *BSplineBasis::bezier(1)}, net), line);
    }

    Words w_;
    Document out_;
    std::string name_;
    std::size_t normals_ = 0, normals_at_ = 0;
};

}  // namespace

Result<Document> read_bezierview(std::string_view bytes) { return BezierViewReader(bytes).read(); }

}  // namespace freiform
