// From charts to branches: each is followed from chart to chart, so that nothing is linked by guess.
//
// Idea. A point of the curve is in the core of a chart, and the curve near it is the arc of that chart. So a
// step along the arc, out of the core, ends in the core of another chart, and where two branches come to the
// same chart they are one. Every seed that no branch came by begins a new one.
#pragma once
#include "charts_detail.hpp"

namespace freiform::detail {

struct TracePoint {
    Place4 x{};
    int chart = -1;     // contains the way to the next point
    bool seam = false;  // the next point is this one, with other parameters
};

inline constexpr int kTraceBorder = -1, kTraceLost = -2;

struct Trace {
    std::vector<TracePoint> points;
    bool closed = false;                                  // the last point is the first one, but for periods
    std::array<int, 2> ends{kTraceBorder, kTraceBorder};  // or the index of a cluster
};

class Tracer {
public:
    explicit Tracer(Charts& charts) : charts_(charts) {}
    std::vector<Trace> all();

private:
    enum class Step { on, border, cluster, lost, closed, known };
    Step step(TracePoint& from, int direction, std::vector<TracePoint>& way);
    Step arrive(std::vector<TracePoint>& way, int direction);
    bool leave(TracePoint& to) const;
    Place4 in_period_of(const Place4& place, std::vector<TracePoint>& way, int chart) const;
    std::optional<Trace> from(int chart);
    Step follow(const TracePoint& start, int direction, std::vector<TracePoint>& way, int& end);

    Charts& charts_;
    Charts::Leaves leaves_;
    int branch_ = 0, cluster_ = -1;
    std::vector<int> touched_;  // charts of this branch
};

}  // namespace freiform::detail
