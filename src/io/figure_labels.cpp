// Where the words go.
//
// Method: greedy. The page is divided into small cells that know what lies on them; each note tries 16
// directions at five distances and takes the place that costs least: what would be covered, plus distance,
// plus the angle to the direction that was wished. Then it lies there itself.
//
// Cost: proportional to the pixels of lines and to 80 times the cells of a label.
//
// Why not an optimal placement: it is NP-hard [Christensen, Marks & Shieber 1995], and figures with few
// labels do not need it.
#include "io/figure_detail.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::figure {

namespace {

constexpr int kDirections = 16, kDistances = 5;
constexpr double kCell = 3;  // pixels
constexpr float kLine = 1.6F, kAxis = 6, kPoint = 3, kWord = 12, kOffPanel = 40, kOffPage = 10000;

class Occupied {
public:
    Occupied(int width, int height)
        : cell_(std::max(kCell, std::max(width, height) / 800.0)),
          columns_(int(width / cell_) + 1),
          rows_(int(height / cell_) + 1),
          weight_(std::size_t(columns_) * std::size_t(rows_)) {}

    void add(const DrawnGroup& g) {
        if (g.role == "grid") return;
        const float weight = g.role == "axes" ? kAxis : kLine;
        for (const DrawnPath& path : g.paths) {
            Vec<2> from = path.start;
            for (const DrawnSegment& s : path.segments) {
                add_segment(from, s, weight);
                from = end_of(s);
            }
            if (path.closed) add_segment(from, {1, {path.start}}, weight);
        }
        for (const DrawnDisc& d : g.discs) {
            const Vec<2> r{{d.radius, d.radius}};
            add({d.centre - r, d.centre + r}, kPoint);
        }
        for (const DrawnLabel& l : g.labels) {
            const double w = width_of(l.text, l.size);
            const double x = l.at[0] - w * (l.anchor == Anchor::start    ? 0
                                            : l.anchor == Anchor::middle ? 0.5
                                                                         : 1);
            add({{{x, l.at[1] - 0.8 * l.size}}, {{x + w, l.at[1] + 0.25 * l.size}}}, kWord);
        }
    }
    void add(const Box<2>& box, float weight) {
        each(box, [&](float& w) { w = std::max(w, weight); });
    }
    double cost(const Box<2>& box) {
        double sum = 0;
        each(box, [&](const float& w) { sum += w; });
        return sum * cell_ * cell_ / (kCell * kCell);
    }

private:
    void add_segment(const Vec<2>& from, const DrawnSegment& s, float weight) {
        double length = norm(s.points[0] - from);
        for (int i = 1; i < s.degree; ++i)
            length += norm(s.points[std::size_t(i)] - s.points[std::size_t(i) - 1]);
        const int n = int(std::clamp(length / cell_, 1.0, 4096.0));
        for (int i = 0; i <= n; ++i) {
            const Vec<2> p = point_at(from, s, double(i) / n);
            add({p, p}, weight);
        }
    }
    template <class F>
    void each(const Box<2>& box, F&& f) {
        const auto index = [&](double x, int n) { return int(std::clamp(x / cell_, 0.0, n - 1.0)); };
        const int x0 = index(box.lo[0], columns_), x1 = index(box.hi[0], columns_);
        const int y0 = index(box.lo[1], rows_), y1 = index(box.hi[1], rows_);
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x)
                f(weight_[std::size_t(y) * std::size_t(columns_) + std::size_t(x)]);
    }
    double cell_;
    int columns_, rows_;
    std::vector<float> weight_;
};

struct Place {
    Box<2> box;
    Vec<2> direction{};  // y down
};

double outside(const Box<2>& box, const Box<2>& area) {
    double sum = 0;
    for (int i = 0; i < 2; ++i)
        sum += std::max(0.0, area.lo[i] - box.lo[i]) + std::max(0.0, box.hi[i] - area.hi[i]);
    return sum;
}

Place best_place(const PlacedNote& n, Occupied& occupied, const Box<2>& page) {
    const Note& note = n.note;
    const double wide = width_of(note.text, note.size), high = 1.05 * note.size;
    const bool any = max_abs(note.toward) == 0;
    const Vec<2> wish = unit(any ? Vec<2>{{1, -1}} : Vec<2>{{note.toward[0], -note.toward[1]}});
    Place best;
    double least = std::numeric_limits<double>::infinity();
    for (int far = 0; far < (note.fixed ? 1 : kDistances); ++far)
        for (int i = 0; i < (note.fixed ? 1 : kDirections); ++i) {
            const double a = 2 * std::numbers::pi * i / kDirections, gap = note.gap * (1 + 0.9 * far);
            Vec<2> u{{std::cos(a), std::sin(a)}};
            if (note.fixed) u = {};
            const Vec<2> middle = note.at + Vec<2>{{u[0] * (wide / 2 + gap), u[1] * (high / 2 + gap)}};
            const Vec<2> half{{wide / 2, high / 2}};
            const Box<2> box{middle - half, middle + half};
            const double cost = occupied.cost(box) + 6 * far + (any ? 1.5 : 9) * (1 - dot(u, wish)) +
                                kOffPanel * (outside(box, n.area) > 0) + kOffPage * outside(box, page);
            if (cost < least) least = cost, best = {box, u};
        }
    return best;
}

}  // namespace

std::vector<DrawnGroup> labels_of(std::span<const PlacedNote> notes, std::span<const DrawnGroup> groups,
                                  int width, int height) {
    std::vector<DrawnGroup> out;
    if (notes.empty()) return out;
    Occupied occupied(width, height);
    for (const DrawnGroup& g : groups) occupied.add(g);
    const Box<2> page{{{2, 2}}, {{width - 2.0, height - 2.0}}};
    for (const PlacedNote& n : notes) {
        const Place place = best_place(n, occupied, page);
        occupied.add(place.box, kWord);
        const Anchor anchor = place.direction[0] > 0.5    ? Anchor::start
                              : place.direction[0] < -0.5 ? Anchor::end
                                                          : Anchor::middle;
        const double x = anchor == Anchor::start ? place.box.lo[0]
                         : anchor == Anchor::end ? place.box.hi[0]
                                                 : place.box.side(0).middle();
        const auto same = std::ranges::find_if(
            out, [&](const DrawnGroup& g) { return g.layer == n.layer && g.colour == n.note.colour; });
        DrawnGroup* g = same == out.end() ? nullptr : &*same;
        if (!g) {
            out.push_back({"", "labels", n.note.colour, 1, {}, {}, {}});
            g = &out.back();
            g->layer = n.layer;
        }
        g->labels.push_back(
            {{{x, place.box.side(1).middle() + 0.33 * n.note.size}}, n.note.text, n.note.size, anchor});
    }
    return out;
}

}  // namespace freiform::figure
