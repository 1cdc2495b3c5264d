// Dashes: a path cut at lengths along it.
//
// Method. The arc length of the subpath as one curve (query/length.hpp), whose pieces are the segments, each
// on an interval of length 1; its inverse says where a dash begins and ends, within the accuracy. What lies
// between are parts of segments.
#include "arcs_detail.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/query/length.hpp>
#include <freiform/region/stroke.hpp>

#include <cmath>

namespace freiform {

namespace {

using namespace detail;

constexpr double kMaxDashes = 100'000;

// The part of the subpath from parameter s to t, in segments.
std::vector<PathSegment> between(const Subpath& path, double s, double t) {
    std::vector<PathSegment> out;
    const std::size_t n = path.segments.size();
    for (std::size_t i = std::min(std::size_t(s), n - 1); i < n && double(i) < t; ++i) {
        const double lo = std::max(0.0, s - double(i)), hi = std::min(1.0, t - double(i));
        if (!(lo < hi)) continue;
        PathSegment part = part_of(path.segments[i], lo, hi);
        if (!out.empty()) part.points[0] = out.back().back();
        out.push_back(part);
    }
    return out;
}

// The pattern, and where in it a subpath begins.
struct Pattern {
    std::vector<double> lengths;
    double period = 0, start = 0;
};

Result<Pattern> pattern_of(const StrokeStyle& style) {
    Pattern out;
    for (int twice = 0; twice < (style.dashes.size() % 2 == 0 ? 1 : 2); ++twice)
        for (std::size_t i = 0; i < style.dashes.size(); ++i) {
            if (!(style.dashes[i] >= 0) || !std::isfinite(style.dashes[i]))
                return refuse(RefusalKind::invalid, text("dashes[", i, "]"),
                              text(style.dashes[i], " is not a length >= 0"));
            out.lengths.push_back(style.dashes[i]);
            out.period += style.dashes[i];
        }
    if (!(out.period > 0) || !std::isfinite(style.dash_offset))
        return refuse(RefusalKind::invalid, "dashes", "the pattern of dashes has no length");
    out.start = std::fmod(style.dash_offset, out.period);
    if (out.start < 0) out.start += out.period;
    return out;
}

struct Dash {
    double from, to;  // lengths
};

std::vector<Dash> dashes_of(const Pattern& pattern, double total) {
    std::vector<Dash> out;
    double at = -pattern.start;
    while (at <= total)
        for (std::size_t i = 0; i < pattern.lengths.size(); ++i) {
            const double next = at + pattern.lengths[i];
            if (i % 2 == 0 && next >= 0 && at <= total && (next > 0 || at == next))
                out.push_back({std::max(at, 0.0), std::min(next, total)});
            at = next;
        }
    return out;
}

template <class P>
Result<void> cut(const Subpath& path, const Curve<P>& curve, const Pattern& pattern, double accuracy,
                 Path& out) {
    const ArcLength<P> length(curve, accuracy / 4);
    const double total = length.total().value;
    if (total / pattern.period * double(pattern.lengths.size()) > kMaxDashes)
        return refuse(RefusalKind::limit, "dashes",
                      text("a subpath of the length ", total, " has more than ", kMaxDashes, " dashes"));
    const std::vector<Dash> dashes = dashes_of(pattern, total);
    std::vector<Subpath> made;
    for (const Dash& d : dashes) {
        std::array<double, 2> at{0, double(path.segments.size())};
        for (const int k : {0, 1}) {
            const double wanted = k == 0 ? d.from : d.to;
            if (wanted <= 0 || wanted >= total) {
                at[std::size_t(k)] = wanted <= 0 ? 0 : double(path.segments.size());
                continue;
            }
            const auto place = length.parameter(wanted);
            if (!place) return std::unexpected(place.error());
            at[std::size_t(k)] = place->parameter;
        }
        Subpath s;
        s.segments = between(path, at[0], at[1]);
        if (s.segments.empty()) {
            const std::size_t i = std::min(std::size_t(at[0]), path.segments.size() - 1);
            s.start = point_of(path.segments[i], at[0] - double(i));
        } else {
            s.start = s.segments.front().front();
        }
        made.push_back(std::move(s));
    }
    // In a closed subpath a dash at its end goes on in one at its start.
    if (path.closed && made.size() > 1 && dashes.front().from == 0 && dashes.back().to == total) {
        Subpath& last = made.back();
        last.segments.insert(last.segments.end(), made.front().segments.begin(), made.front().segments.end());
        made.front() = std::move(last);
        made.pop_back();
    } else if (path.closed && made.size() == 1 && dashes[0].from == 0 && dashes[0].to == total) {
        made[0].closed = true;
    }
    for (Subpath& s : made) out.subpaths.push_back(std::move(s));
    return {};
}

}  // namespace

Result<Path> dashed(const Path& path, const StrokeStyle& style, double accuracy) {
    const auto pattern = pattern_of(style);
    if (!pattern) return std::unexpected(pattern.error());
    Path out;
    for (std::size_t i = 0; i < path.subpaths.size(); ++i) {
        Subpath s = path.subpaths[i];
        if (s.segments.empty()) {
            out.subpaths.push_back(s);
            continue;
        }
        if (s.closed && s.segments.back().back() != s.start)
            s.segments.push_back({1, {s.segments.back().back(), s.start}, 1});
        const auto ok =
            visit_one([&](const auto& curve) { return cut(s, curve, *pattern, accuracy, out); }, curve_of(s));
        if (!ok) return refuse_within(text("path.subpaths[", i, "]"), ok.error());
    }
    return out;
}

}  // namespace freiform
