// libFuzzer: Boolean operations of two arbitrary paths, and strokes. Not part of the test suite; with clang,
//   tests/fuzz/run.sh region 300
// builds and runs it for 300 seconds.
//
// Checked is what the header promises: an answer or a refusal with words; loops that are closed and whose
// winding number is 1 where the operation says inside and 0 elsewhere, asked by the exact winding numbers of
// the input at points on a lattice; areas that add up; exchanged operands.
#include <freiform/poly/arc_index.hpp>
#include <freiform/region/stroke.hpp>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

using namespace freiform;

namespace {

void demand(bool holds) {
    if (!holds) std::abort();
}

struct Bytes {
    const std::uint8_t* at;
    std::size_t left;
    int next() { return left == 0 ? 0 : (--left, *at++); }
    // Small integers and eighths, so that segments touch and overlap, and some that are beside them by
    // little.
    double number(int kind) {
        const double x = (next() % 32) / (kind % 2 == 0 ? 1.0 : 8.0);
        return kind % 8 == 7 && next() % 4 == 0 ? x + std::ldexp(next() - 128, -50) : x;
    }
};

Path path_of(Bytes& bytes, int kind) {
    Path path;
    for (int loops = bytes.next() % 4 == 0 ? 2 : 1; loops > 0; --loops) {
        Subpath s;
        s.closed = true;
        s.start = {{bytes.number(kind), bytes.number(kind)}};
        Vec<2> at = s.start;
        const int count = 1 + bytes.next() % 3;
        for (int i = 0; i < count; ++i) {
            const int how = bytes.next();
            PathSegment segment{1 + how % 3, {at}, 1};
            if (segment.degree == 2 && how % 5 == 0) segment.weight = 0.125 * (1 + bytes.next() % 16);
            for (int k = 1; k <= segment.degree; ++k)
                segment.points[std::size_t(k)] = {{bytes.number(kind), bytes.number(kind)}};
            at = segment.back();
            s.segments.push_back(segment);
        }
        path.subpaths.push_back(s);
    }
    return path;
}

// The winding number; nothing on the path. Open subpaths are closed.
std::optional<int> winding(const Path& path, const Vec<2>& p) {
    int quarters = 0;
    for (const Subpath& s : path.subpaths) {
        const auto add = [&](const PathSegment& g) {
            std::array<double, 4> x{}, y{}, w{1, 1, 1, 1};
            const auto n = std::size_t(g.degree) + 1;
            for (std::size_t i = 0; i < n; ++i) {
                w[i] = g.degree == 2 && i == 1 ? g.weight : 1;
                x[i] = w[i] * g.points[i][0], y[i] = w[i] * g.points[i][1];
            }
            const auto index =
                arc_index(std::span(x).first(n), std::span(y).first(n), std::span(w).first(n), p);
            quarters += index.quarters;
            return !index.through;
        };
        for (const PathSegment& g : s.segments)
            if (!add(g)) return {};
        if (!s.segments.empty() && !add({1, {s.segments.back().back(), s.start}, 1})) return {};
    }
    return quarters / 4;
}

bool in(const Filled& f, int w) { return f.rule == FillRule::nonzero ? w != 0 : w % 2 != 0; }
bool in(RegionOperation o, bool a, bool b) {
    return o == RegionOperation::union_of       ? a || b
           : o == RegionOperation::intersection ? a && b
           : o == RegionOperation::difference   ? a && !b
                                                : a != b;
}

void check_points(const Filled& a, const Filled& b, RegionOperation o, const Region& r) {
    for (const Subpath& s : r.path.subpaths) demand(s.closed && s.segments.back().back() == s.start);
    for (int i = 0; i < 12; ++i) {
        // Beside every lattice that the coordinates are on.
        const Vec<2> p{{(i * 13 % 33) + 0.0371, (i * 7 % 31) + 0.0193}};
        const auto wa = winding(a.path, p), wb = winding(b.path, p), w = winding(r.path, p);
        if (!wa || !wb || !w) continue;
        demand(*w == int(in(o, in(a, *wa), in(b, *wb))));
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes{data, size};
    const int kind = bytes.next(), ask = bytes.next();
    const Path p = path_of(bytes, kind), q = path_of(bytes, kind);
    const Filled a{p, FillRule(kind & 1)}, b{q, FillRule(kind >> 1 & 1)};
    const RegionOptions options{.tolerance = 1e-7};
    const auto area = [&](const Filled& x, const Filled& y, RegionOperation o) -> std::optional<double> {
        const auto r = combine(x, y, o, options);
        if (!r) {
            demand(!r.error().message.empty() && !r.error().where.empty());
            return {};
        }
        demand(r->bound <= options.tolerance);
        check_points(x, y, o, *r);
        return signed_area(r->path).value;
    };
    // One operation, and of some inputs what takes others: most of the time is that of operations.
    const auto o = RegionOperation(ask & 3);
    const auto one = area(a, b, o);
    if (one && ask % 16 < 4 && o != RegionOperation::difference)
        if (const auto back = area(b, a, o)) demand(std::abs(*back - *one) < 1e-3);
    if (one && ask % 64 >= 60) {
        const auto both = area(a, b, RegionOperation::intersection),
                   either = area(a, b, RegionOperation::union_of),
                   other = area(a, b, RegionOperation::exclusion),
                   rest = area(a, b, RegionOperation::difference);
        if (both && either && other) demand(std::abs(*either - *both - *other) < 1e-3);
        demand(both.value_or(0) >= -1e-3 && rest.value_or(0) >= -1e-3);
    }
    if (kind % 16 == 3) {
        StrokeStyle style;
        style.width = 0.25 * (1 + bytes.next() % 16);
        style.cap = LineCap(bytes.next() % 3), style.join = LineJoin(bytes.next() % 5);
        if (bytes.next() % 4 == 0) style.dashes = {1.0 + bytes.next() % 8, double(bytes.next() % 8)};
        const auto r = stroked(p, style, {.tolerance = 0.01});
        demand(r ? signed_area(r->path).value >= 0 : !r.error().message.empty());
    }
    return 0;
}
