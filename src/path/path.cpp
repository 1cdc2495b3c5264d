// Paths and what they are made of.
//
// Arcs. The ellipse is the image of the unit circle under the map with columns (rx cos a, rx sin a), (-ry sin
// a, ry cos a); in its coordinates the chord between the ends has the half length d <= 1 after the radii are
// enlarged, and the center lies sqrt(1 - d^2) beside the middle of it. An arc of the unit circle by 2 t has
// the middle control point where its tangents meet, 1 / cos t away from the center, with the weight cos t.
//
// Curves. A segment of degree 2 raised to 3 is (P0, (P0 + 2 P1) / 3, (2 P1 + P2) / 3, P2) in homogeneous
// coordinates.
#include <freiform/core/constants.hpp>
#include <freiform/path/path.hpp>

#include <cmath>
#include <numbers>

namespace freiform {

namespace {

PathSegment line(const Vec<2>& a, const Vec<2>& b) { return {1, {a, b}, 1}; }

// Homogeneous control points of the segment, of degree `degree` >= its own.
std::array<Hom<2>, 4> raised(const PathSegment& s, int degree) {
    std::array<Hom<2>, 4> p{};
    for (int i = 0; i <= s.degree; ++i)
        p[std::size_t(i)] = weighted(s.points[std::size_t(i)], s.degree == 2 && i == 1 ? s.weight : 1.0);
    for (int n = s.degree; n < degree; ++n) {  // b_i = (i b_{i-1} + (n + 1 - i) b_i) / (n + 1)
        p[std::size_t(n) + 1] = p[std::size_t(n)];
        for (int i = n; i > 0; --i)
            p[std::size_t(i)] =
                (1.0 / (n + 1)) * (double(i) * p[std::size_t(i) - 1] + double(n + 1 - i) * p[std::size_t(i)]);
    }
    return p;
}

}  // namespace

Path transformed(Path path, const Affinity<2>& map) {
    const auto image = [&](const Vec<2>& p) {
        Vec<2> q = map.offset;
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j) q[i] += map.linear[std::size_t(i)][std::size_t(j)] * p[j];
        return q;
    };
    for (Subpath& s : path.subpaths) {
        s.start = image(s.start);
        for (PathSegment& segment : s.segments)
            for (int i = 0; i <= segment.degree; ++i)
                segment.points[std::size_t(i)] = image(segment.points[std::size_t(i)]);
    }
    return path;
}

std::vector<PathSegment> elliptic_arc(const Vec<2>& from, const Vec<2>& to, double rx, double ry,
                                      double angle, bool large, bool sweep) {
    if (from == to) return {};
    rx = std::abs(rx), ry = std::abs(ry);
    if (!(rx > 0) || !(ry > 0)) return {line(from, to)};
    const double c = std::cos(angle), s = std::sin(angle);
    const Vec<2> half = 0.5 * (from - to), middle = 0.5 * (from + to);
    // Radii that are far too small are made to fit below anyway; their quotients must not overflow.
    if (max_abs(half) > 0x1p400 * std::max(rx, ry)) {
        const int less = std::ilogb(max_abs(half)) - std::ilogb(std::max(rx, ry));
        rx = std::ldexp(rx, less - 4), ry = std::ldexp(ry, less - 4);
    }
    Vec<2> d{{(c * half[0] + s * half[1]) / rx, (c * half[1] - s * half[0]) / ry}};
    const double length = norm(d);
    if (length > 1) rx *= length, ry *= length, d = (1 / length) * d;
    const double beside = std::sqrt(std::max(0.0, 1 - dot(d, d))) / norm(d) * (large == sweep ? -1 : 1);
    const Vec<2> center{{d[1] * beside, -d[0] * beside}};
    const auto image = [&](const Vec<2>& p) {
        return middle + Vec<2>{{c * rx * p[0] - s * ry * p[1], s * rx * p[0] + c * ry * p[1]}};
    };
    const Vec<2> first = d - center, last = Vec<2>{} - d - center;
    double turn = std::atan2(cross(first, last), dot(first, last));
    // Radii beyond what doubles tell from infinity.
    const auto is_lost = [](const Vec<2>& p) { return !std::isfinite(p[0] + p[1]); };
    if (!std::isfinite(turn)) return {line(from, to)};
    if (sweep && turn < 0) turn += 2 * std::numbers::pi;
    if (!sweep && turn > 0) turn -= 2 * std::numbers::pi;
    const int pieces = std::max(1, int(std::ceil(std::abs(turn) / (std::numbers::pi / 2) - 1e-9)));
    const double start = std::atan2(first[1], first[0]), t = turn / (2 * pieces), weight = std::cos(t);
    std::vector<PathSegment> out;
    Vec<2> at = from;
    for (int i = 0; i < pieces; ++i) {
        const double mid = start + (2 * i + 1) * t, end = start + (2 * i + 2) * t;
        const Vec<2> next = i + 1 == pieces ? to : image(center + Vec<2>{{std::cos(end), std::sin(end)}});
        const Vec<2> corner = image(center + (1 / weight) * Vec<2>{{std::cos(mid), std::sin(mid)}});
        if (is_lost(corner) || is_lost(next)) return {line(from, to)};
        out.push_back({2, {at, corner, next}, weight});
        at = next;
    }
    return out;
}

Subpath ellipse(const Vec<2>& center, double rx, double ry) {
    constexpr double kX[9] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, kY[9] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
    const auto at = [&](int i) { return center + Vec<2>{{rx * kX[i], ry * kY[i]}}; };
    Subpath out{at(0), {}, true};
    for (int i = 0; i < 8; i += 2) out.segments.push_back({2, {at(i), at(i + 1), at(i + 2)}, std::sqrt(0.5)});
    return out;
}

std::variant<Curve<Vec<2>>, Curve<Hom<2>>> curve_of(const Subpath& subpath) {
    FF_REQUIRE(!subpath.segments.empty());
    int degree = 1;
    bool rational = false;
    for (const PathSegment& s : subpath.segments)
        degree = std::max(degree, s.degree), rational = rational || (s.degree == 2 && s.weight != 1);
    std::vector<Hom<2>> net;
    for (const PathSegment& s : subpath.segments) {
        const auto p = raised(s, degree);
        net.insert(net.end(), p.begin() + (net.empty() ? 0 : 1), p.begin() + degree + 1);
    }
    std::vector<double> knots{0};
    for (std::size_t i = 0; i <= subpath.segments.size(); ++i)
        knots.insert(knots.end(), std::size_t(degree), double(i));
    knots.push_back(knots.back());
    const auto basis = *BSplineBasis::make(degree, std::move(knots));
    const int count = int(net.size());
    if (rational) return *Curve<Hom<2>>::make({basis}, Net<1, Hom<2>>({count}, std::move(net)));
    std::vector<Vec<2>> plain;
    for (const Hom<2>& p : net) plain.push_back({{p[0], p[1]}});
    return *Curve<Vec<2>>::make({basis}, Net<1, Vec<2>>({count}, std::move(plain)));
}

}  // namespace freiform
