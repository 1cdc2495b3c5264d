// Path data: the little language of the attribute `d`.
//
// Grammar: that of SVG 2, 9.3.9. A number ends where another character cannot belong to it, so "1.5.5-2" is
// three of them, and flags of arcs are single digits. What has no meaning ends the path: before it everything
// stands.
//
// Writing. An arc of 2 t with the weight w = cos t and the control points A, B, C is the image of an arc of
// the unit circle: with the middle M of its chord, the axes (B - M) w / (1 - w^2) and (C - A) / (2 sin t)
// from its center M - (B - M) w^2 / (1 - w^2). Their singular values are the radii. Of thin or nearly
// straight ellipses rounding moves the center; an arc that reading would not give back within kArcKept of its
// size is written as cubics that near.
#include "path_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/scan.hpp>
#include <freiform/core/utf8.hpp>
#include <freiform/path/path_data.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace freiform {

namespace {

constexpr bool is_space(char c) { return is_blank(c) || c == '\n' || c == '\f'; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

class PathReader {
public:
    PathReader(std::string_view text, std::size_t most) : text_(text), most_(most) {}

    PathData read() {
        for (skip_space(); at_ < text_.size() && !out_.stopped; skip_space()) {
            const char c = text_[at_];
            if (std::string_view("MmLlHhVvCcSsQqTtAaZz").find(c) == std::string_view::npos) {
                stop("a command, one of M L H V C S Q T A Z");
            } else if (begins_ && c != 'M' && c != 'm') {
                stop("M first");
            } else {
                ++at_;
                command(c);
            }
        }
        return std::move(out_);
    }

private:
    void stop(std::string_view expected) {
        if (out_.stopped) return;
        const std::string found = at_ < text_.size() ? shown_character(text_.substr(at_)) : "the end";
        out_.stopped = Refusal{RefusalKind::unreadable, text("character ", at_ + 1),
                               text("found ", found, ", expected ", expected)};
    }
    void skip_space() {
        while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    }
    void skip_comma() {
        skip_space();
        if (at_ < text_.size() && text_[at_] == ',') ++at_, skip_space();
    }
    bool at_number() const {
        return at_ < text_.size() &&
               (is_digit(text_[at_]) || text_[at_] == '.' || text_[at_] == '-' || text_[at_] == '+');
    }
    // Whether another set of arguments follows.
    bool more() {
        const std::size_t before = at_;
        skip_comma();
        if (at_number()) return true;
        at_ = before;
        return false;
    }
    double number() {
        if (out_.stopped) return 0;
        std::size_t end = at_;
        const auto digits = [&] {
            const std::size_t first = end;
            while (end < text_.size() && is_digit(text_[end])) ++end;
            return end > first;
        };
        if (end < text_.size() && (text_[end] == '-' || text_[end] == '+')) ++end;
        bool any = digits();
        if (end < text_.size() && text_[end] == '.') ++end, any = digits() || any;
        if (!any) return stop("a number"), 0;
        if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
            const std::size_t mantissa = end++;
            if (end < text_.size() && (text_[end] == '-' || text_[end] == '+')) ++end;
            if (!digits()) end = mantissa;
        }
        const auto x = scan_number<double>(text_.substr(at_, end - at_));
        if (!x) return stop("a number that a double holds"), 0;
        at_ = end;
        return *x;
    }
    double argument(bool first) {
        if (!first) skip_comma();
        return number();
    }
    bool flag() {
        if (out_.stopped) return false;
        skip_comma();
        if (at_ < text_.size() && (text_[at_] == '0' || text_[at_] == '1')) return text_[at_++] == '1';
        stop("a flag, 0 or 1");
        return false;
    }
    Vec<2> point(bool relative, bool first = false) {
        const double x = argument(first), y = argument(false);
        return relative ? current_ + Vec<2>{{x, y}} : Vec<2>{{x, y}};
    }

    void begin(const Vec<2>& at) {
        begins_ = false, open_ = false;
        current_ = start_ = at;
    }
    Subpath& subpath() {
        if (!open_) {
            out_.path.subpaths.push_back({start_, {}, false}), open_ = true, ++segments_;
            if (const std::size_t n = segments_ahead(); n > 1) out_.path.subpaths.back().segments.reserve(n);
        }
        return out_.path.subpaths.back();
    }
    // How many segments this subpath has from here on, by its numbers: exact if they are spelled plainly. No
    // text is looked at twice, for at the next M or Z the subpath ends.
    std::size_t segments_ahead() const {
        double n = 1, each = arguments_of(kind_);
        if (each == 0) return 1;
        bool inside = false;
        for (std::size_t i = at_; i < text_.size(); ++i) {
            const char c = text_[i];
            const bool is_number = is_digit(c) || c == '.' || c == 'e' || c == 'E';
            if (is_number) {
                n += inside ? 0 : 1 / each;
            } else if (c >= 'A') {
                each = arguments_of(c);
                if (each == 0) break;
            }
            inside = is_number;
        }
        return std::min({std::size_t(n), kMostAhead, segments_ < most_ ? most_ - segments_ + 1 : 1});
    }
    // Of a command that goes on with the subpath; 0 of what ends it.
    static double arguments_of(char c) {
        constexpr std::string_view kCommands = "HVLTQSCA";
        constexpr double kArguments[] = {1, 1, 2, 2, 4, 4, 6, 7};
        const std::size_t i = kCommands.find(c >= 'a' ? char(c - 32) : c);
        return i == std::string_view::npos ? 0 : kArguments[i];
    }
    void count(std::size_t segments) {
        segments_ += segments;
        if (segments_ > most_ && !out_.stopped)
            out_.stopped = Refusal{RefusalKind::limit, text("character ", at_ + 1),
                                   text("there are more than ", most_, " segments")};
    }
    void add(int degree, const Vec<2>& a, const Vec<2>& b, const Vec<2>& end) {
        if (out_.stopped) return;
        PathSegment s{degree, {current_, a, b, end}, 1};
        if (degree < 3) s.points[std::size_t(degree)] = end;
        Subpath& to = subpath();
        count(1);
        if (out_.stopped) return;
        to.segments.push_back(s);
        current_ = end;
    }
    // The mirror image of the last control point, if the command before was of that kind.
    Vec<2> reflected(int degree) const { return last_ == degree ? 2.0 * current_ - control_ : current_; }

    void close() {
        count(subpath().segments.empty() ? 1 : 0);
        if (!(current_ == start_)) add(1, {}, {}, start_);
        Subpath& s = subpath();
        s.closed = true;
        open_ = false;
        last_ = 0;
    }
    void command(char c) {
        const bool relative = c >= 'a';
        const char kind = relative ? char(c - 32) : c;
        kind_ = kind == 'M' ? 'L' : kind;
        if (kind == 'Z') return close();
        skip_space();
        if (kind == 'M') {
            const Vec<2> to = point(relative, true);
            if (out_.stopped) return;
            begin(to);
            last_ = 0;
            while (!out_.stopped && more()) add(1, {}, {}, point(relative, true));
            return;
        }
        do {
            one(kind, relative);
        } while (!out_.stopped && more());
    }
    void one(char kind, bool relative) {
        int degree = 0;
        if (kind == 'L') {
            add(1, {}, {}, point(relative, true));
        } else if (kind == 'H' || kind == 'V') {
            Vec<2> to = current_;
            const int axis = kind == 'V';
            to[axis] = argument(true) + (relative ? current_[axis] : 0);
            add(1, {}, {}, to);
        } else if (kind == 'A') {
            arc(relative);
        } else {
            degree = kind == 'C' || kind == 'S' ? 3 : 2;
            const bool shown = kind == 'C' || kind == 'Q';
            const Vec<2> a = shown ? point(relative, true) : reflected(degree);
            const Vec<2> b = degree == 3 ? point(relative, !shown) : a;
            const Vec<2> to = point(relative, degree == 2 && !shown);
            add(degree, a, b, to);
            control_ = b;
        }
        last_ = degree;
    }
    void arc(bool relative) {
        const double rx = argument(true), ry = argument(false), angle = argument(false);
        const bool large = flag(), sweep = flag();
        const Vec<2> to = point(relative);
        if (out_.stopped) return;
        Subpath& s = subpath();
        for (const PathSegment& part :
             elliptic_arc(current_, to, rx, ry, angle * (std::numbers::pi / 180), large, sweep))
            if (count(1); !out_.stopped) s.segments.push_back(part);
        current_ = to;
    }

    // Segments for which text may ask for memory before it is read.
    static constexpr std::size_t kMostAhead = std::size_t(1) << 20;

    std::string_view text_;
    std::size_t at_ = 0;
    PathData out_;
    Vec<2> current_{}, start_{}, control_{};
    char kind_ = 'L';     // of the command, in upper case
    int last_ = 0;        // the degree of the command before, if it was a Bezier curve
    bool begins_ = true;  // nothing has been read
    bool open_ = false;   // the last subpath of out_ is being added to
    std::size_t segments_ = 0, most_;
};

// The radii, the angle in degrees and the direction of the ellipse of a segment with weight < 1.
struct Arc {
    double rx = 0, ry = 0, angle = 0;
    bool sweep = false;
};
Arc arc_of(const PathSegment& s) {
    const Vec<2> m = 0.5 * (s.points[0] + s.points[2]);
    const double w = s.weight, rest = (1 - w) * (1 + w);
    const Vec<2> a = (w / rest) * (s.points[1] - m),
                 b = (0.5 / std::sqrt(rest)) * (s.points[2] - s.points[0]);
    // Points a cos t + b sin t are farthest where tan 2 t = 2 a.b / (a.a - b.b).
    const double t = std::atan2(2 * dot(a, b), dot(a, a) - dot(b, b)) / 2;
    const Vec<2> major = std::cos(t) * a + std::sin(t) * b, minor = std::cos(t) * b - std::sin(t) * a;
    if (std::abs(norm(major) - norm(minor)) <= 8 * kUnitRoundoff * norm(major))
        return {norm(major), norm(major), 0, cross(a, b) > 0};
    return {norm(major), norm(minor), std::atan2(major[1], major[0]) * (180 / std::numbers::pi),
            cross(a, b) > 0};
}

constexpr double kArcKept = 1e-12;

double size_of(const PathSegment& s) {
    return std::max(norm(s.points[1] - s.points[0]), norm(s.points[2] - s.points[1]));
}

bool is_kept(const PathSegment& s, const Arc& arc) {
    const auto read = elliptic_arc(s.front(), s.back(), arc.rx, arc.ry, arc.angle * (std::numbers::pi / 180),
                                   false, arc.sweep);
    // Reading rounds coordinates as writing has done before.
    const double near =
        kArcKept * size_of(s) + 8 * kUnitRoundoff * std::max(max_abs(s.front()), max_abs(s.back()));
    return read.size() == 1 && read[0].degree == 2 && norm(read[0].points[1] - s.points[1]) <= near &&
           std::abs(read[0].weight - s.weight) <= kArcKept;
}

void append(std::string& out, const Vec<2>& p) { out += text(p[0], ",", p[1]); }

void append(std::string& out, const PathSegment& s) {
    out += text(" ", " LQC"[s.degree]);
    for (int k = 1; k <= s.degree; ++k) {
        out += ' ';
        append(out, s.points[std::size_t(k)]);
    }
}

}  // namespace

PathData parse_path_data(std::string_view text) {
    return PathReader(text, std::numeric_limits<std::size_t>::max()).read();
}

PathData parse_path_data_up_to(std::string_view text, std::size_t most_segments) {
    return PathReader(text, most_segments).read();
}

std::string path_data(const Path& path) {
    std::string out;
    for (const Subpath& s : path.subpaths) {
        out += out.empty() ? "M " : " M ";
        append(out, s.start);
        for (std::size_t i = 0; i < s.segments.size(); ++i) {
            const PathSegment& segment = s.segments[i];
            if (s.closed && i + 1 == s.segments.size() && segment.degree == 1 && segment.back() == s.start)
                break;
            if (segment.degree == 2 && segment.weight != 1) {
                const Arc arc = arc_of(segment);
                if (is_kept(segment, arc)) {
                    out += text(" A ", arc.rx, ",", arc.ry, " ", arc.angle, " 0,", arc.sweep ? "1 " : "0 ");
                    append(out, segment.back());
                } else {
                    for (const PathSegment& c : detail::cubics_of(segment, kArcKept * size_of(segment)))
                        append(out, c);
                }
            } else {
                append(out, segment);
            }
        }
        if (s.closed) out += " Z";
    }
    return out;
}

}  // namespace freiform
