// Which ends of curves meet: a sweep along the first coordinate.
//
// Method: ends sorted by their first coordinate; each is compared with those that follow within `gap`. Cost:
// O(n log n) and the pairs so near; a drawing whose ends all have one first coordinate costs O(n^2).
#include <freiform/query/continuity.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace freiform {

namespace {

struct Place {
    std::size_t curve = 0;
    End end = End::start;
    const std::vector<double>* point = nullptr;
};

double distance(const std::vector<double>& a, const std::vector<double>& b) {
    double d = 0;
    for (std::size_t i = 0; i < a.size(); ++i) d = std::hypot(d, b[i] - a[i]);
    return d;
}

// As run through: the end of one, the start of the other, where the pair allows it.
Meeting meeting(Place a, Place b, double d) {
    if (std::tie(b.curve, b.end) < std::tie(a.curve, a.end)) std::swap(a, b);
    if (a.end == End::start && b.end == End::end) std::swap(a, b);
    return {a.curve, b.curve, a.end, b.end, d};
}

}  // namespace

Result<std::vector<Meeting>> meetings(std::span<const CurveEnds> curves, double gap, std::size_t most) {
    if (!(gap >= 0)) return refuse(RefusalKind::invalid, "gap", text(gap, " is not a number >= 0"));
    std::vector<Place> places;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        if (curves[i].start.size() != curves[i].end.size())
            return refuse(RefusalKind::invalid, text("curves[", i, "]"),
                          "its ends have different dimensions");
        if (curves[i].start.empty()) continue;
        for (const End e : {End::start, End::end}) {
            const std::vector<double>& p = e == End::start ? curves[i].start : curves[i].end;
            for (const double x : p)
                if (!std::isfinite(x))
                    return refuse(RefusalKind::nonfinite, text("curves[", i, "]"), "an end is not finite");
            places.push_back({i, e, &p});
        }
    }
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
        return std::tuple((*a.point)[0], a.curve, a.end) < std::tuple((*b.point)[0], b.curve, b.end);
    });
    std::vector<Meeting> all;
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t j = i + 1; j < places.size() && (*places[j].point)[0] - (*places[i].point)[0] <= gap;
             ++j) {
            if (places[i].point->size() != places[j].point->size()) continue;
            const double d = distance(*places[i].point, *places[j].point);
            if (!(d <= gap)) continue;
            if (all.size() >= most)
                return refuse(RefusalKind::limit, "gap",
                              text("more than ", most, " pairs of ends are at most ", gap, " apart"));
            all.push_back(meeting(places[i], places[j], d));
        }
    std::sort(all.begin(), all.end(), [](const Meeting& a, const Meeting& b) {
        return std::tuple(std::min(a.first, a.second), std::max(a.first, a.second), a.first, a.first_end,
                          a.second_end) < std::tuple(std::min(b.first, b.second), std::max(b.first, b.second),
                                                     b.first, b.first_end, b.second_end);
    });
    return all;
}

}  // namespace freiform
