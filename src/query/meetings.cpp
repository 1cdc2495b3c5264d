// Which ends of curves meet, and how: a sweep along the first coordinate.
//
// Method: ends sorted by their first coordinate; each is compared with those that follow within `gap`. Cost:
// O(n log n) and the pairs so near; a drawing whose ends all have one first coordinate costs O(n^2).
#include <freiform/core/sort.hpp>
#include <freiform/query/continuity.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace freiform {

namespace {

struct EndPlace {
    std::vector<double> point;
    std::size_t curve = 0;
    End end = End::start;
};

std::vector<double> point_of(const CurveSide& side) {
    std::vector<double> p;
    for (std::size_t i = 0; i < std::size_t(side.dimension); ++i)
        p.push_back(side.origin[i] + side.derivatives[i].value);
    return p;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
    double d = 0;
    for (std::size_t i = 0; i < a.size(); ++i) d = std::hypot(d, b[i] - a[i]);
    return d;
}

// As run through: the end of one, the start of the other, where the pair allows it.
Meeting meeting(const EndPlace& one, const EndPlace& other, double d) {
    const bool ordered = std::tuple(one.curve, one.end) < std::tuple(other.curve, other.end);
    const EndPlace *a = ordered ? &one : &other, *b = ordered ? &other : &one;
    if (a->end == End::start && b->end == End::end) std::swap(a, b);
    return {a->curve, b->curve, a->end, b->end, d};
}

auto order_of(const Meeting& m) {
    return std::tuple(std::min(m.first, m.second), std::max(m.first, m.second), m.first, m.first_end,
                      m.second_end);
}

}  // namespace

Result<std::vector<Meeting>> meetings(std::span<const CurveEnds> curves, double gap, std::size_t most) {
    if (!(gap >= 0)) return refuse(RefusalKind::invalid, "gap", text(gap, " is not a number >= 0"));
    std::vector<EndPlace> places;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        if (curves[i].start.dimension == 0) continue;
        for (const End e : {End::start, End::end}) {
            places.push_back({point_of(e == End::start ? curves[i].start : curves[i].end), i, e});
            for (const double x : places.back().point)
                if (!std::isfinite(x))
                    return refuse(RefusalKind::nonfinite, text("curves[", i, "]"), "an end is not finite");
        }
    }
    sort(places.begin(), places.end(), [](const EndPlace& a, const EndPlace& b) {
        return std::tuple(a.point[0], a.curve, a.end) < std::tuple(b.point[0], b.curve, b.end);
    });
    std::vector<Meeting> all;
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t j = i + 1; j < places.size() && places[j].point[0] - places[i].point[0] <= gap;
             ++j) {
            if (places[i].point.size() != places[j].point.size()) continue;
            const double d = distance(places[i].point, places[j].point);
            if (!(d <= gap)) continue;
            if (all.size() >= most)
                return refuse(RefusalKind::limit, "gap",
                              text("more than ", most, " pairs of ends are at most ", gap, " apart"));
            all.push_back(meeting(places[i], places[j], d));
        }
    sort(all.begin(), all.end(),
         [](const Meeting& a, const Meeting& b) { return order_of(a) < order_of(b); });
    return all;
}

Result<std::vector<CurveJoint>> joints(std::span<const CurveEnds> curves, double gap,
                                       const ContinuityOptions& options, std::size_t most) {
    const auto pairs = meetings(curves, gap, most);
    if (!pairs) return std::unexpected(pairs.error());
    std::vector<CurveJoint> all;
    for (const Meeting& m : *pairs) {
        const CurveEnds &a = curves[m.first], &b = curves[m.second];
        auto j = continuity(m.first_end == End::end ? a.end : reversed(a.start),
                            m.second_end == End::start ? b.start : reversed(b.end), options);
        if (!j) return refuse_within(text("curves[", m.first, "] and curves[", m.second, "]"), j.error());
        all.push_back({m, *std::move(j)});
    }
    return all;
}

}  // namespace freiform
