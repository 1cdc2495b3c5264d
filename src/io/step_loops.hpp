// The boundary of a face in the parameters of its surface: loops of the file made into closed chains.
#pragma once
#include "step_trace.hpp"
#include "step_ways.hpp"

#include <freiform/model/model.hpp>

#include <span>

namespace freiform::step {

// An edge as a loop runs through it.
struct Use {
    Coedge coedge;
    int from = -1, to = -1;  // vertices, in the direction of the loop
    Vec<2> start{}, end{};   // likewise
    double gap = 0;
    bool fitted = false, told = false;
};
Use make_use(Coedge coedge, const Edge& edge);

// Leaves out what a loop goes out along and comes back the same way, also from its end to its beginning.
// `is_back`: whether the second one of two neighbours is the way back of the first; `left_out`: is called
// with one of them.
template <class T, class IsBack, class LeftOut>
void fold_spurs(std::vector<T>& loop, const IsBack& is_back, const LeftOut& left_out) {
    std::vector<T> kept;
    for (T& x : loop) {
        if (kept.empty() || !is_back(kept.back(), x)) {
            kept.push_back(std::move(x));
            continue;
        }
        left_out(x);
        kept.pop_back();
    }
    std::size_t first = 0;
    for (; kept.size() - first > 1 && is_back(kept.back(), kept[first]); ++first) {
        left_out(kept[first]);
        kept.pop_back();
    }
    kept.erase(kept.begin(), kept.begin() + std::ptrdiff_t(first));
    loop = std::move(kept);
}

class LoopBuilder {
public:
    // New edges and vertices (seams, poles) go into the model. `close`: points nearer than this are one.
    LoopBuilder(const Chart& chart, Model& model, double close)
        : chart_(chart), model_(model), close_(close) {}

    void add(std::vector<Use> uses);
    void add_vertex(int vertex) { vertex_ = vertex; }
    // The part of the surface with these parameters, all around.
    void add_rectangle(const std::array<Interval, 2>& on);
    // All loops, one inside the other in one picture of the parameters. Empty refusal text of `note` unless
    // something in the file had to be understood against its letter.
    Result<std::vector<std::vector<Use>>> finish();
    std::string note;
    double note_off = 0;        // what that moves, about; 0: nothing
    std::vector<int> released;  // seams of the file that bound nothing any more

    // Where the surface ends, or goes on for ever, and the largest loop is a hole, the loops run the wrong
    // way.
    enum class WrongWay { taken, told, turned };
    WrongWay wrong_way = WrongWay::taken;  // what is to be done about it
    bool is_wrong = false;                 // finish() found it

private:
    struct Chain {
        std::vector<Use> uses;
        std::array<int, 2> winding{};  // in periods
        double area = 0;
        std::vector<Vec<2>> outline;
    };

    void attach(std::vector<Use>& done, Use next) const;
    void pole_between(std::vector<Use>& done, const Use& last, Use& next, bool closing, double extent);
    std::optional<double> short_side(const Use& last, const Use& next, double most) const;
    void corner_between(std::vector<Use>& done, const Use& last, const Use& next);
    const Pole* pole_at(const Vec<2>& a, const Vec<2>& b, double close = 0) const;
    Use degenerate(int vertex, const Vec<2>& from, const Vec<2>& to);
    void measure(Chain& c) const;
    void move(Chain& c, const Vec<2>& by) const;
    void close_joints(Chain& c) const;
    void end_at(Use& u, bool last, const Vec<2>& to) const;
    void end_both_at(Chain& c, Use& u, bool last, const Vec<2>& to) const;
    void end_at_poles(Use& u) const;
    static constexpr int kBegins = 64;  // of a closed surface, to find one with no hole across
    void turn_to(Chain& c, std::size_t first) const;
    void turn_around(Chain& c) const;
    Result<void> join_winding(int axis);
    // Whole periods of parameter k; more than 8, and what is no number, are 9.
    int turns(const Vec<2>& by, int k) const;
    void join(Chain& a, Chain b, int axis);
    bool crosses(const Chain& c, const Vec<2>& p, const Vec<2>& q) const;
    bool is_free(const Chain& a, const Chain& b, const Vec<2>& p, const Vec<2>& q) const;
    void release_spurs();
    bool is_way_back(const Use& a, const Use& b) const;
    Vec<2> direction(const Use& u, bool at_end) const;
    std::vector<std::vector<Use>> in_order(const std::vector<Use>& uses) const;
    Chain chain(std::vector<Use> uses);
    void release_seams();
    void join_pole(Chain& c, const Pole& pole);
    std::array<Use, 2> seam(int from, int to, const Vec<2>& a, const Vec<2>& b, const Vec<2>& period);
    std::optional<CurveGeometry<3>> iso_over(int axis, double at, Interval on) const;
    struct Seam {
        std::vector<Use> there, back;
    };
    Seam seams(int from, int to, std::span<const Vec<2>> points, const Vec<2>& period);
    std::optional<Way> way(const Chain* a, const Chain* b, int axis, double first, double last) const;
    bool is_closed_surface() const;
    Result<void> add_whole();
    bool add_from_pole_to_pole(int axis);
    void set_right(double all);
    bool rounds_pole(const Chain& c) const;
    static bool goes_around_all(const Chain& c, double all);
    void place_holes(double all);
    void into_domain();
    int vertex_near(const Vec<3>& p);

    const Chart& chart_;
    Model& model_;
    double close_;
    int vertex_ = -1;
    std::vector<Chain> chains_;
};

}  // namespace freiform::step
