// Curves as paths.
//
// Idea. A Bezier piece that paths have is taken as it is: polynomial of degree <= 3, or rational of degree 2
// once its weights are 1, w, 1, which a linear fractional change of the parameter does. Degrees are lowered
// as long as the leading difference of the homogeneous control points is rounding. Anything else is halved
// until the cubic with the same ends and derivatives there is near enough.
//
// Bound. Let A / w be the piece and q the cubic. (A - w q) / w at each parameter: A - w q is a polynomial,
// bounded by the largest of its Bernstein coefficients, and w is at least the least of its own. Computed
// coefficients are sums of p + 4 products of numbers of the size of A and w q, whose factors carry a few
// roundings: 8 (p + 8) u times their size is added.
//
// References: [Farouki & Rajan 1987] products in Bernstein form.
#include "path_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr std::size_t kMostSegments = 100000;
constexpr double kSame = 64 * kUnitRoundoff;  // differences below that of the coefficients are rounding

using Homogeneous = std::vector<Hom<2>>;

double largest_of(const Homogeneous& p) {
    double m = 0;
    for (const Hom<2>& h : p) m = std::max(m, max_abs(h));
    return m;
}

// Lowers the degree while that changes nothing but rounding.
void lower(Homogeneous& p) {
    const double size = largest_of(p);
    while (p.size() > 2) {
        const int n = int(p.size()) - 1;
        Hom<2> leading{};
        for (int i = 0; i <= n; ++i)
            leading = leading + ((n - i) % 2 ? -binomial(n, i) : binomial(n, i)) * p[std::size_t(i)];
        if (!(max_abs(leading) <= kSame * size)) return;
        Homogeneous q{p[0]};  // p_i = (i q_{i-1} + (n - i) q_i) / n
        for (int i = 1; i < n - 1; ++i)
            q.push_back((1.0 / (n - i)) * (double(n) * p[std::size_t(i)] - double(i) * q.back()));
        q.push_back(p.back());
        p = std::move(q);
    }
}

// The segment that the piece is, if paths have it.
std::optional<PathSegment> as_segment(const Homogeneous& p, bool rational) {
    const int degree = int(p.size()) - 1;
    if (degree == 0) {
        const Vec<2> at = project(p[0]);
        return PathSegment{1, {at, at}, 1};
    }
    if (degree > (rational ? 2 : 3)) return std::nullopt;
    PathSegment s{degree, {}, 1};
    for (std::size_t i = 0; i < p.size(); ++i) s.points[i] = project(p[i]);
    if (!rational) return s;
    if (degree == 2) s.weight = p[1].weight() / std::sqrt(p[0].weight() * p[2].weight());
    if (std::abs(s.weight - 1) <= kSame) s.weight = 1;
    if (s.weight > 1) return std::nullopt;
    return s;
}

bool is_rational(const Homogeneous& p) {
    return std::ranges::any_of(p, [&](const Hom<2>& h) { return h.weight() != p[0].weight(); });
}

// The cubic with the ends and derivatives of the piece on [0, 1].
std::array<Vec<2>, 4> hermite_cubic(const Homogeneous& p) {
    const int n = int(p.size()) - 1;
    const auto slope = [&](std::size_t end, std::size_t next) {
        return double(n) * (p[next].weight() / p[end].weight()) * (project(p[next]) - project(p[end]));
    };
    const Vec<2> a = project(p[0]), b = project(p.back());
    return {a, a + (1.0 / 3) * slope(0, 1), b + (1.0 / 3) * slope(p.size() - 1, p.size() - 2), b};
}

// The pieces of one Bezier piece, in order, onto `out`; what stands against it where that cannot be.
std::optional<Refusal> approximate(Homogeneous piece, double tolerance, SubpathOfCurve& out) {
    constexpr std::size_t kDeepest = 60;  // halvings
    std::vector<Homogeneous> stack{std::move(piece)};
    while (!stack.empty()) {
        Homogeneous p = std::move(stack.back());
        stack.pop_back();
        const auto q = hermite_cubic(p);
        const double bound = detail::distance_bound(p, q);
        if (bound <= tolerance) {
            out.subpath.segments.push_back({3, q, 1});
            out.bound = std::max(out.bound, bound);
            continue;
        }
        if (out.subpath.segments.size() + stack.size() > kMostSegments)
            return Refusal{RefusalKind::limit, "",
                           text("within ", tolerance, " it takes more than ", kMostSegments, " segments")};
        if (stack.size() > kDeepest)
            return Refusal{RefusalKind::ill_conditioned, "",
                           text(tolerance, " is below the rounding of the coordinates")};
        Homogeneous left = p;
        keep_left(Fibre<Hom<2>>{left.data(), int(left.size()), 1}, 0.5);
        keep_right(Fibre<Hom<2>>{p.data(), int(p.size()), 1}, 0.5);
        p.front() = left.back();
        stack.push_back(std::move(p)), stack.push_back(std::move(left));
    }
    return std::nullopt;
}

}  // namespace

double detail::distance_bound(const Homogeneous& p, const std::array<Vec<2>, 4>& q) {
    const int n = int(p.size()) - 1;
    double least = std::numeric_limits<double>::infinity(), heaviest = 0, reach = 0, most = 0;
    for (const Hom<2>& h : p) {
        least = std::min(least, h.weight()), heaviest = std::max(heaviest, h.weight());
        reach = std::max(reach, std::max(std::abs(h[0]), std::abs(h[1])));
    }
    for (const Vec<2>& c : q) reach = std::max(reach, heaviest * max_abs(c));
    for (int k = 0; k <= n + 3; ++k) {
        Vec<2> c{};
        for (int i = std::max(0, k - 3); i <= std::min(k, n); ++i) {
            const double part = binomial(n, i) * binomial(3, k - i) / binomial(n + 3, k);
            const Hom<2>& h = p[std::size_t(i)];
            c = c + part * (Vec<2>{{h[0], h[1]}} - h.weight() * q[std::size_t(k - i)]);
        }
        most = std::max(most, norm(c));
    }
    return (most + 8 * (n + 8) * kUnitRoundoff * 2 * reach) / least * (1 + 1e-12);
}

std::vector<PathSegment> detail::cubics_of(const PathSegment& segment, double tolerance) {
    const Vec<2> origin = segment.front();  // what counts for rounding is the size of the segment
    Homogeneous p;
    for (int i = 0; i <= segment.degree; ++i)
        p.push_back(weighted(segment.points[std::size_t(i)] - origin,
                             segment.degree == 2 && i == 1 ? segment.weight : 1.0));
    SubpathOfCurve out;
    for (double near = tolerance; std::isfinite(near) && approximate(p, near, out); near *= 16) out = {};
    if (out.subpath.segments.empty()) out.subpath.segments.push_back({3, hermite_cubic(p), 1});
    for (PathSegment& s : out.subpath.segments)
        for (Vec<2>& x : s.points) x += origin;
    out.subpath.segments.back().points[3] = segment.back();
    return std::move(out.subpath.segments);
}

template <class P>
Result<SubpathOfCurve> subpath_of(const Curve<P>& curve, double tolerance) {
    if (!(tolerance > 0))
        return refuse(RefusalKind::invalid, "tolerance", text("a positive number, not ", tolerance));
    const BezierPieces<1, P> pieces(curve);
    SubpathOfCurve out;
    double reach = 0;
    for (int i = 0; i < pieces.extent()[0]; ++i) {
        const auto net = pieces.net({i});
        Homogeneous p;
        for (int k = 0; k <= pieces.degree(0); ++k) {
            const P& c = net(Index<1>{k});
            if constexpr (Space<P>::kRational)
                p.push_back(c);
            else
                p.push_back(weighted(c, 1.0));
        }
        auto& segments = out.subpath.segments;
        const Vec<2> begins = project(p[0]);
        if (i == 0)
            out.subpath.start = begins;
        else if (!(max_abs(begins - segments.back().back()) <= kSame * std::max(max_abs(begins), reach)))
            return refuse(RefusalKind::unsupported, text("at ", pieces.breaks(0)[std::size_t(i)]),
                          "the curve jumps; a path is connected");
        const std::size_t first = segments.size();
        for (const Hom<2>& h : p) reach = std::max(reach, max_abs(project(h)));
        Homogeneous lowered = p;
        lower(lowered);
        if (const auto s = as_segment(lowered, is_rational(lowered)))
            segments.push_back(*s);
        else if (auto refused = approximate(std::move(p), tolerance, out))
            return refuse_within(text("piece ", i), *refused);
        if (i > 0) segments[first].points[0] = segments[first - 1].back();
    }
    out.subpath.closed = out.subpath.segments.back().back() == out.subpath.start;
    return out;
}

template Result<SubpathOfCurve> subpath_of(const Curve<Vec<2>>&, double);
template Result<SubpathOfCurve> subpath_of(const Curve<Hom<2>>&, double);

}  // namespace freiform
