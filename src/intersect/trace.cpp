// Following branches; trace_detail.hpp is the essay.
#include "trace_detail.hpp"

namespace freiform::detail {

namespace {

constexpr double kBeyond = 0.05;  // of a core, that a step ends behind it

double noise_of(const Interval& on) {
    return 0x1p-44 * std::max(on.length(), std::max(std::abs(on.lo), std::abs(on.hi)));
}

}  // namespace

std::vector<Trace> Tracer::all() {
    std::vector<Trace> out;
    for (std::size_t i = 0; i < charts_.charts().size(); ++i)
        if (charts_.charts()[i].branch < 0)
            if (auto trace = from(int(i))) {
                if (trace->points.size() > 1) out.push_back(std::move(*trace));
                ++branch_;
            }
    return out;
}

std::optional<Trace> Tracer::from(int chart) {
    auto& all = charts_.charts();
    TracePoint start{all[std::size_t(chart)].seed, chart, false};
    // Seeds are as near as a proof needs; the zero itself may be beyond the border beside them.
    if (const auto exact = charts_.zero(all[std::size_t(chart)], start.x)) {
        start.x = exact->x;
        leave(start);
    }
    for (std::size_t k = 0; k < 4; ++k) start.x[k] = charts_.wrapped(k, start.x[k]);
    charts_.leaves_at(start.x, leaves_);
    for (const int i : leaves_.charts)
        if (const int b = all[std::size_t(i)].branch; b >= 0) {
            all[std::size_t(chart)].branch = b;
            return std::nullopt;
        }
    all[std::size_t(chart)].branch = branch_;
    all[std::size_t(chart)].passed = all[std::size_t(chart)].seed[all[std::size_t(chart)].free];
    if (!leaves_.charts.empty()) start.chart = leaves_.charts[0];
    Chart& first = all[std::size_t(start.chart)];
    touched_ = {chart, start.chart};
    first.branch = branch_, first.passed = start.x[first.free];

    Trace out;
    const Step done = follow(start, 1, out.points, out.ends[1]);
    if (done == Step::known) return std::nullopt;
    if (done == Step::closed) {
        out.closed = true;
        return out;
    }
    std::vector<TracePoint> back;
    if (follow(start, -1, back, out.ends[0]) == Step::known) return std::nullopt;
    // Reversed, a chart leads to the next point instead of the one before.
    std::vector<TracePoint> points;
    for (std::size_t i = back.size(); i-- > 1;)
        points.push_back({back[i].x, back[i - 1].chart, back[i - 1].seam});
    points.insert(points.end(), out.points.begin(), out.points.end());
    out.points = std::move(points);
    return out;
}

Tracer::Step Tracer::follow(const TracePoint& start, int direction, std::vector<TracePoint>& way, int& end) {
    way.assign(1, start);
    // Every step leaves a core or goes half its length; a chart is left for good once its end is passed.
    const std::size_t most = 64 + 8 * charts_.charts().size();
    while (way.size() < most) {
        TracePoint from = way.back();
        Step done = step(from, direction, way);
        if (done == Step::on) done = arrive(way, direction);
        switch (done) {
            case Step::on:
                continue;
            case Step::border:
                end = kTraceBorder;
                return done;
            case Step::cluster:
                end = cluster_;
                return done;
            case Step::lost:
                end = kTraceLost;
                return done;
            case Step::closed:
            case Step::known:
                return done;
        }
    }
    end = kTraceLost;
    return Step::lost;
}

// The last point in the period of a place beside it. It may be on a seam, with the parameter of the other
// side: where two seams are at one place, a step goes over one of them only. Then a point is added.
Place4 Tracer::in_period_of(const Place4& place, std::vector<TracePoint>& way, int chart) const {
    Place4 x = way.back().x;
    for (std::size_t k = 0; k < 4; ++k)
        if (charts_.is_cyclic(k)) {
            const double period = charts_.domain(k).length(), d = x[k] - place[k];
            x[k] -= d > 0.6 * period ? period : d < -0.6 * period ? -period : 0;
        }
    if (x == way.back().x) return x;
    way.back().seam = true;
    TracePoint other{x, chart, false};
    for (std::size_t k = 0; k < 4; ++k) other.x[k] = clamped(x[k], charts_.domain(k));
    way.push_back(other);
    return x;
}

// To the next point, along the arc of the chart.
Tracer::Step Tracer::step(TracePoint& from, int direction, std::vector<TracePoint>& way) {
    Chart& c = charts_.charts()[std::size_t(from.chart)];
    const std::size_t f = c.free;
    const double w = c.width(f), sense = direction * c.forward;
    Place4 middle;
    for (std::size_t k = 0; k < 4; ++k) middle[k] = c.core[k].middle();
    const Place4 x = in_period_of(middle, way, from.chart);
    const double goal = sense > 0 ? c.core[f].hi + kBeyond * w : c.core[f].lo - kBeyond * w;
    double by = std::clamp(goal - x[f], -0.98 * Sheet::kMargin * w / std::max(c.slope, 0.7),
                           0.98 * Sheet::kMargin * w / std::max(c.slope, 0.7));
    if (by * sense <= 0) by = sense * kBeyond * w;
    std::optional<ArcZero> next;
    for (int i = 0; i < 4 && !next; ++i, by /= 2) {
        Place4 y = x;
        for (std::size_t k = 0; k < 4; ++k) y[k] += c.along[k] * by;
        y[f] = x[f] + by;
        next = charts_.zero(c, y);
    }
    if (!next) return Step::lost;
    TracePoint to{next->x, from.chart, false};
    c.passed = to.x[f];
    if (leave(to)) {
        way.push_back(to);
        return Step::border;
    }
    // Over a seam: first to it, then on from its other side.
    for (std::size_t k = 0; k < 4; ++k) {
        const Interval on = charts_.domain(k);
        const double noise = noise_of(on);
        if (!charts_.is_cyclic(k) || (to.x[k] >= on.lo - noise && to.x[k] <= on.hi + noise)) continue;
        const double seam = to.x[k] < on.lo ? on.lo : on.hi;
        Place4 y = to.x;
        y[k] = seam;
        const std::array<double, 4> width{c.width(0), c.width(1), c.width(2), c.width(3)};
        if (!charts_.newton(y, k, width)) return Step::lost;
        y[k] = seam;
        c.passed = y[f];
        way.push_back({y, from.chart, true});
        y[k] = seam == on.lo ? on.hi : on.lo;
        way.push_back({y, from.chart, false});
        return Step::on;
    }
    for (std::size_t k = 0; k < 4; ++k) to.x[k] = clamped(to.x[k], charts_.domain(k));
    way.push_back(to);
    return Step::on;
}

// Beyond a border: then `to` becomes the point on it.
bool Tracer::leave(TracePoint& to) const {
    const Chart& c = charts_.charts()[std::size_t(to.chart)];
    bool left = false;
    for (std::size_t k = 0; k < 4; ++k) {
        const Interval on = charts_.domain(k);
        const double noise = noise_of(on);
        if (charts_.is_cyclic(k) || (to.x[k] >= on.lo - noise && to.x[k] <= on.hi + noise)) continue;
        const double border = to.x[k] < on.lo ? on.lo : on.hi;
        Place4 y = to.x;
        y[k] = border;
        const std::array<double, 4> width{c.width(0), c.width(1), c.width(2), c.width(3)};
        if (!charts_.newton(y, k, width)) continue;
        y[k] = border;
        to.x = y;
        left = true;
    }
    if (left)
        for (std::size_t k = 0; k < 4; ++k)
            if (!charts_.is_cyclic(k)) to.x[k] = clamped(to.x[k], charts_.domain(k));
    return left;
}

// Which chart goes on?
Tracer::Step Tracer::arrive(std::vector<TracePoint>& way, int direction) {
    auto& all = charts_.charts();
    TracePoint& at = way.back();
    charts_.leaves_at(at.x, leaves_);
    int next = -1;
    for (const int i : leaves_.charts) {
        Chart& c = all[std::size_t(i)];
        if (c.branch >= 0 && c.branch != branch_) {
            for (const int other : touched_) all[std::size_t(other)].branch = c.branch;
            return Step::known;
        }
        if (next < 0 || i != at.chart) next = i;
        if (c.branch < 0 || direction < 0) continue;
        double x = at.x[c.free];
        if (charts_.is_cyclic(c.free)) {
            const double period = charts_.domain(c.free).length(), d = x - c.core[c.free].middle();
            x -= d > 0.6 * period ? period : d < -0.6 * period ? -period : 0;
        }
        if (direction * c.forward * (x - c.passed) >= -0x1p-30 * c.width(c.free)) continue;
        const Chart& first = all[std::size_t(way[0].chart)];
        // Round. Points beyond the start are left out again.
        const Charts::Direction d = charts_.direction(way[0].x);
        while (way.size() > 2) {
            double ahead = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                double by = way.back().x[k] - way[0].x[k];
                if (charts_.is_cyclic(k))
                    by -= charts_.domain(k).length() * std::round(by / charts_.domain(k).length());
                const double w = first.width(k);
                ahead += direction * d.x[k] * by / (w * w);
            }
            if (ahead < 0) break;
            way.pop_back();
        }
        const TracePoint start = way[0];
        way.back().seam = false;
        in_period_of(start.x, way, way.back().chart);
        way.push_back(start);
        return Step::closed;
    }
    if (next < 0) {
        if (leaves_.clusters.empty()) return Step::lost;
        cluster_ = leaves_.clusters[0];
        return Step::cluster;
    }
    at.chart = next;
    Chart& c = all[std::size_t(next)];
    if (c.branch < 0) {
        c.branch = branch_, c.passed = at.x[c.free];
        touched_.push_back(next);
    }
    return Step::on;
}

}  // namespace freiform::detail
