// Continuity across edges.
//
// Idea. Along the edge the difference d(t) of the two unit normals is a curve that is sampled, and bounds of
// its second derivative say what it does between the samples: nothing above the larger end plus h^2/8
// max|d''| (a component of d less its linear interpolation, in any direction). |d| = 2 sin(angle / 2).
//
// Notation. On a face N(t) = S_u x S_v at p(t) = (u, v), n = N / |N|; S_ij, u_k, v_k: bounds of derivatives
// over a part of length h and a box that contains p there; m: a lower bound of |N|.
//     |S_u'| <= a_1 = S_20 u_1 + S_11 v_1,   |S_v'| <= b_1 = S_11 u_1 + S_02 v_1,
//     |S_u''| <= a_2 = S_30 u_1^2 + 2 S_21 u_1 v_1 + S_12 v_1^2 + S_20 u_2 + S_11 v_2, likewise b_2,
//     |N'| <= N_1 = a_1 S_01 + S_10 b_1,     |N''| <= N_2 = a_2 S_01 + 2 a_1 b_1 + S_10 b_2,
//     m = |N(middle)| - h/2 N_1,
// and with P the projection across n: n' = P N' / |N|, hence |n'| <= N_1 / m, and from P' = -(n' n^T + n
// n'^T)
//     |n''| <= N_2 / m + 3 N_1^2 / m^2.
//
// Method. Parts begin at the breaks of the parameter curves; the one with the largest bound is halved until
// it is below what is asked for, or no more than a hundredth above what was found.
//
// Seams. Where the box reaches over a line along which the surface is not C^2, or over the end of its domain,
// that parameter is held in the middle of the part: n with u held differs by at most
// h/2 u_1 (S_20 S_01 + S_10 S_11) / m, nothing for an edge along the seam. Across a kink N jumps by at most J
// S_01, J the jump of S_u, and n by twice that over m: nothing at the knots of pieces that are C^1 but for
// rounding.
//
// Poles: where |N| is not certainly above 0 on a part that is 2^-10 of the edge, the part is left out, and
// the joint is called singular.
//
// The gap: edge_gap of both uses, added up.
//
// Accuracy. S_u is a sum of differences of the coefficients that make a value, times degree / width of the
// piece: off by at most 8 p / width times what a value is off, or 64 u of itself on analytic surfaces; the
// same for S_v. n is off by at most twice (off_u S_01 + S_10 off_v) / |N|, and by the error of p.
//
// Cost. About sqrt(K / angle) parts for a tangent joint, K a bound of |d''| times the length of the edge
// squared: a hundred for a thousandth of a radian. Bounds below 1e-6 are out of reach; seams and edges that
// are made of the same numbers would allow more.
//
// References. [Pegna & Wolter 1992].
//
// Why not the continuity of splines (query/surface_continuity.hpp): it compares pieces of two surfaces along
// parameter lines with the same parameters; edges of models cross the parameters of both faces anyhow.
#include "surface_seams_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/core/text.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/model/edge_continuity.hpp>
#include <freiform/model/edge_gap.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <tuple>

namespace freiform {

namespace {

constexpr double kAngleEnough = 1.01;         // of what was found: a bound need not be less
constexpr double kPolePart = 0x1p-10;         // of the edge
constexpr double kNormalSlack = 1 + 0x1p-40;  // more than the roundings of the bounds of a part
constexpr int kCurvaturePlaces = 16;

struct PreparedFace {
    explicit PreparedFace(const Face& f)
        : face(&f), query(f.surface), seams(seams_of(f.surface)), ends(limits(f.surface)) {
        visit_one(
            [&](const auto& surface) {
                if constexpr (requires { surface.net(); })
                    for (int k = 0; k < 2; ++k) degree[std::size_t(k)] = surface.basis(k).degree();
            },
            f.surface);
    }
    const Face* face;
    DerivativeQuery<2, 3> query;
    std::array<std::vector<SurfaceSeam>, 2> seams;
    std::array<Interval, 2> ends;
    std::array<int, 2> degree{1, 1};
};

double zero_times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

// What n does on a part: bounds of |n''| where it is smooth, of how far holding a parameter moves it, and of
// rounding. Infinite `bend`: none.
struct NormalBounds {
    double bend = 0, held = 0, rounding = 0;
    bool pole = false;  // n may vanish
};

// A face along one of its edges.
class FaceAlong {
public:
    FaceAlong(const PreparedFace& face, const Coedge& coedge, double sign)
        : face_(&face), coedge_(&coedge), along_(coedge.curve), sign_(sign) {}

    const PreparedFace& face() const { return *face_; }
    const Coedge& coedge() const { return *coedge_; }
    bool has_bounds() const {  // of third derivatives
        return !std::holds_alternative<OffsetSurface>(face_->face->surface);
    }
    void turn() { sign_ = -sign_; }
    Vec<2> uv(double t) const { return clamped(jet<0>(coedge_->curve, t).value(), face_->ends); }
    Vec<3> point(double t) const { return jet<0>(face_->face->surface, uv(t).c).value(); }
    Vec<3> normal_at(double t) const { return sign_ * normal(face_->face->surface, uv(t).c); }

    NormalBounds bounds(Interval on) const {
        constexpr NormalBounds kNone{kInfinity, kInfinity, kInfinity, false};
        const double h = on.length() * kNormalSlack;
        auto p = coordinate_bounds(along_, on).coordinate;
        const Vec<2> middle = jet<0>(coedge_->curve, on.middle()).value();
        const double off = value_error_bound(coedge_->curve, {on});
        std::array<Interval, 2> box;
        std::array<bool, 2> held{};
        std::array<double, 2> jump{};  // of S_u, S_v: a knot where the surface is only nearly C^1
        for (std::size_t k = 0; k < 2; ++k) {
            const double reach = h / 2 * p[k](1) + off;
            box[k] = {middle[int(k)] - reach, middle[int(k)] + reach};
            const Interval& ends = face_->ends[k];
            if (box[k].hi <= ends.lo || box[k].lo >= ends.hi)
                p[k] = {};  // moved back: constant
            else
                held[k] = box[k].lo < ends.lo || box[k].hi > ends.hi;
            box[k] = {clamped(box[k].lo, ends), clamped(box[k].hi, ends)};
            for (const SurfaceSeam& s : face_->seams[k]) held[k] = held[k] || box[k].contains(s.at);
            for (const Kink& kink : face_->query.kinks(int(k)))
                if (box[k].contains(kink.at)) held[k] = true, jump[k] += kink.jump;
        }
        const auto s = face_->query(box, 3);
        const double twist_u = zero_times(s(2, 0), s(0, 1)) + zero_times(s(1, 0), s(1, 1));
        const double twist_v = zero_times(s(1, 1), s(0, 1)) + zero_times(s(1, 0), s(0, 2));
        const auto j = jet<1>(face_->face->surface, uv(on.middle()).c);
        const double across = h / 2 * (zero_times(twist_u, p[0](1)) + zero_times(twist_v, p[1](1)));
        std::array<double, 2> rounding;
        for (std::size_t k = 0; k < 2; ++k)
            rounding[k] =
                64 * kUnitRoundoff * (k == 0 ? s(1, 0) : s(0, 1)) +
                8 * face_->degree[k] * face_->query.value_error(box) / face_->query.thinnest_piece(int(k));
        const double slip = rounding[0] * s(0, 1) + s(1, 0) * rounding[1];
        const double leap = zero_times(jump[0], s(0, 1)) + zero_times(jump[1], s(1, 0));
        const double m = norm(cross(j(1, 0), j(0, 1))) / kNormalSlack - across - slip - leap;
        if (!(m > 0)) return {kInfinity, kInfinity, kInfinity, leap == 0};
        NormalBounds out;
        out.rounding = (2 * slip + off * (twist_u + twist_v)) / m + 16 * kUnitRoundoff;
        out.held = 2 * leap / m;
        if (held[0]) out.held += h / 2 * zero_times(twist_u, p[0](1)) / m, p[0] = {};
        if (held[1]) out.held += h / 2 * zero_times(twist_v, p[1](1)) / m, p[1] = {};
        const double u = p[0](1), v = p[1](1), uu = p[0](2), vv = p[1](2);
        const double a1 = zero_times(s(2, 0), u) + zero_times(s(1, 1), v);
        const double b1 = zero_times(s(1, 1), u) + zero_times(s(0, 2), v);
        const double a2 = zero_times(s(3, 0), u * u) + 2 * zero_times(s(2, 1), u * v) +
                          zero_times(s(1, 2), v * v) + zero_times(s(2, 0), uu) + zero_times(s(1, 1), vv);
        const double b2 = zero_times(s(2, 1), u * u) + 2 * zero_times(s(1, 2), u * v) +
                          zero_times(s(0, 3), v * v) + zero_times(s(1, 1), uu) + zero_times(s(0, 2), vv);
        const double n1 = a1 * s(0, 1) + s(1, 0) * b1, n2 = a2 * s(0, 1) + 2 * a1 * b1 + s(1, 0) * b2;
        out.bend = n2 / m + 3 * (n1 / m) * (n1 / m);
        return std::isnan(out.bend + out.held + out.rounding) ? kNone : out;
    }

    // The curvature of the normal section orthogonal to the edge.
    std::optional<double> curvature_across(double t) const {
        const auto j = jet<2>(face_->face->surface, uv(t).c);
        const Vec<2> dp = jet<1>(coedge_->curve, t).d[1];
        const Vec<3> su = j(1, 0), sv = j(0, 1), n = normal_at(t), edge = dp[0] * su + dp[1] * sv;
        const double e = dot(su, su), f = dot(su, sv), g = dot(sv, sv), det = e * g - f * f;
        if (!(det > 0x1p-40 * e * g) || !(norm(edge) > 0)) return std::nullopt;
        const Vec<3> w = unit(cross(n, edge));
        const double x = dot(w, su), y = dot(w, sv), a = (g * x - f * y) / det, b = (e * y - f * x) / det;
        return dot(n, a * a * j(2, 0) + 2 * a * b * j(1, 1) + b * b * j(0, 2));
    }

private:
    const PreparedFace* face_;
    const Coedge* coedge_;
    DerivativeQuery<1, 2> along_;
    double sign_;
};

double angle_of(double chord) { return 2 * std::asin(std::clamp(chord / 2, 0.0, 1.0)); }

class Joint {
public:
    Joint(FaceAlong a, FaceAlong b, const Edge& edge, const EdgeContinuityOptions& options)
        : side_{std::move(a), std::move(b)}, edge_(edge), options_(options) {}

    EdgeContinuity measure(bool directed) {
        out_.directed = directed;
        out_.face = {};
        const Interval on = edge_.range;
        if (!directed && dot(side_[0].normal_at(on.middle()), side_[1].normal_at(on.middle())) < 0)
            side_[1].turn();
        measure_gap();
        measure_angle();
        if (!directed) out_.angle = std::min(out_.angle, kTwoPi / 2 - out_.angle);
        decide();
        return out_;
    }

private:
    struct Part {
        Interval on;
        double first = 0, last = 0, bound = 0;  // of |n - n'|
        bool pole = false;
        bool operator<(const Part& o) const { return bound < o.bound; }
    };

    void measure_gap() {
        double bound = 0;
        if (edge_.curve)
            for (const FaceAlong& s : side_)
                bound += edge_gap(s.face().query, s.coedge().curve, *edge_.curve, edge_.range,
                                  {.target = options_.gap / 4, .max_samples = 20 * options_.max_parts})
                             .bound;
        else
            bound = kInfinity;
        out_.gap_bound = bound;
    }

    double chord_at(double t) {
        const Vec<3> n[2] = {side_[0].normal_at(t), side_[1].normal_at(t)};
        out_.gap = std::max(out_.gap, norm(side_[0].point(t) - side_[1].point(t)));
        if (n[0] == Vec<3>{} || n[1] == Vec<3>{}) return -1;  // a pole
        const double chord = norm(n[0] - n[1]);
        if (chord > found_ || out_.angle == 0) found_ = std::max(found_, chord), out_.at = t;
        out_.angle = angle_of(found_);
        return chord;
    }

    Part part(Interval on, double first, double last) const {
        Part p{on, first, last, kInfinity, first < 0 || last < 0};
        const NormalBounds a = side_[0].bounds(on), b = side_[1].bounds(on);
        const double h = on.length() * kNormalSlack;
        if (first >= 0 && last >= 0)
            p.bound = (std::max(first, last) + h * h / 8 * (a.bend + b.bend) + 2 * (a.held + b.held) +
                       a.rounding + b.rounding) *
                      kNormalSlack;
        if (std::isnan(p.bound)) p.bound = kInfinity;
        p.pole = p.pole || a.pole || b.pole;
        return p;
    }

    std::vector<double> cuts() const {
        std::vector<double> t{edge_.range.lo, edge_.range.hi};
        for (int i = 1; i < 4; ++i) t.push_back(edge_.range.lo + edge_.range.length() * i / 4);
        for (const FaceAlong& s : side_)
            visit_one(
                [&](const auto& c) {
                    if constexpr (requires { c.net(); })
                        for (const double x : c.basis().breaks())
                            if (edge_.range.lo < x && x < edge_.range.hi) t.push_back(x);
                },
                s.coedge().curve);
        sort(t);
        t.erase(std::unique(t.begin(), t.end()), t.end());
        return t;
    }

    void measure_angle() {
        const auto t = cuts();
        if (!side_[0].has_bounds() || !side_[1].has_bounds()) {
            for (std::size_t i = 0; i + 1 < t.size(); ++i)
                for (int k = 0; k < 16; ++k) chord_at(t[i] + (t[i + 1] - t[i]) * k / 16);
            chord_at(t.back());
            out_.angle_bound = kInfinity;
            return;
        }
        std::priority_queue<Part> todo;
        double first = chord_at(t[0]);
        for (std::size_t i = 0; i + 1 < t.size(); ++i) {
            const double last = chord_at(t[i + 1]);
            todo.push(part({t[i], t[i + 1]}, first, last));
            first = last;
        }
        double bound = 0;
        const double target = 2 * std::sin(std::min(options_.angle, 3.0) / 2) / kAngleEnough;
        for (int parts = int(t.size()); !todo.empty(); parts += 2) {
            const Part p = todo.top();
            const double middle = p.on.middle();
            if (p.bound <= std::max(target, kAngleEnough * found_)) break;
            todo.pop();
            const bool tiny = p.on.length() < kPolePart * edge_.range.length();
            if (tiny && !std::isfinite(p.bound) && p.pole) {
                out_.singular = true;
            } else if (parts >= options_.max_parts || !(p.on.lo < middle && middle < p.on.hi)) {
                bound = std::max(bound, p.bound);
                if (!std::isfinite(bound)) break;
            } else {
                const double between = chord_at(middle);
                todo.push(part({p.on.lo, middle}, p.first, between));
                todo.push(part({middle, p.on.hi}, between, p.last));
            }
        }
        if (!todo.empty()) bound = std::max(bound, todo.top().bound);
        out_.angle_bound = std::isfinite(bound) ? angle_of(bound) * kNormalSlack : kInfinity;
    }

    void measure_curvature() {
        out_.curvature = 0;
        out_.curvature_at = edge_.range.middle();
        for (int i = 0; i < kCurvaturePlaces; ++i) {
            const double t = edge_.range.lo + edge_.range.length() * (i + 0.5) / kCurvaturePlaces;
            const auto a = side_[0].curvature_across(t), b = side_[1].curvature_across(t);
            if (a && b && std::abs(*a - *b) > out_.curvature)
                out_.curvature = std::abs(*a - *b), out_.curvature_at = t;
        }
    }

    void decide() {
        const double allowed = std::max({options_.gap, edge_.tolerance, side_[0].face().face->tolerance,
                                         side_[1].face().face->tolerance});
        const auto order = [&](double gap, double angle) {
            return gap > allowed                         ? -1
                   : angle > options_.angle              ? 0
                   : out_.curvature > options_.curvature ? 1
                                                         : 2;
        };
        if (out_.angle <= options_.angle && out_.gap <= allowed) measure_curvature();
        out_.g_order = order(out_.gap_bound, out_.angle_bound);
        out_.g_at_most = order(out_.gap, out_.angle);
    }

    std::array<FaceAlong, 2> side_;
    const Edge& edge_;
    EdgeContinuityOptions options_;
    EdgeContinuity out_;
    double found_ = 0;
};

}  // namespace

Result<std::vector<EdgeContinuity>> edge_continuity(const Model& model,
                                                    const EdgeContinuityOptions& options) {
    for (const auto& [name, x] :
         {std::pair("gap", options.gap), {"angle", options.angle}, {"curvature", options.curvature}})
        if (!(x >= 0)) return refuse(RefusalKind::invalid, name, text(x, " is not a number >= 0"));
    // Where the outward normal is: of the face, and of its use in the first shell that has it.
    std::vector<int> shell(model.faces.size(), -1);
    std::vector<double> sign(model.faces.size(), 1);
    for (std::size_t f = 0; f < model.faces.size(); ++f) sign[f] = model.faces[f].reversed ? -1 : 1;
    for (std::size_t s = 0; s < model.shells.size(); ++s)
        for (const FaceUse& use : model.shells[s].faces)
            if (int& own = shell[std::size_t(use.face)]; own < 0)
                own = int(s), sign[std::size_t(use.face)] *= use.reversed ? -1 : 1;
    struct Use {
        int face;
        const Coedge* coedge;
    };
    std::vector<std::vector<Use>> uses(model.edges.size());
    for (std::size_t f = 0; f < model.faces.size(); ++f)
        for (const Loop& loop : model.faces[f].loops)
            for (const Coedge& c : loop.coedges)
                if (!model.edges[std::size_t(c.edge)].degenerate)
                    uses[std::size_t(c.edge)].push_back({int(f), &c});
    std::vector<std::unique_ptr<PreparedFace>> faces;
    for (const Face& f : model.faces) faces.push_back(std::make_unique<PreparedFace>(f));
    struct Pair {
        int edge;
        Use a, b;
    };
    std::vector<Pair> pairs;
    for (std::size_t e = 0; e < uses.size(); ++e)
        for (std::size_t i = 1; i < uses[e].size(); ++i)
            pairs.push_back({int(e), uses[e][i - 1], uses[e][i]});
    std::vector<EdgeContinuity> out(pairs.size());
    parallel_for(pairs.size(), 1, [&](std::size_t i) {
        const auto& [e, a, b] = pairs[i];
        const auto side = [&](const Use& u) {
            return FaceAlong(*faces[std::size_t(u.face)], *u.coedge, sign[std::size_t(u.face)]);
        };
        const int own = shell[std::size_t(a.face)];
        Joint joint(side(a), side(b), model.edges[std::size_t(e)], options);
        out[i] = joint.measure(a.face == b.face || (own >= 0 && own == shell[std::size_t(b.face)]));
        out[i].edge = e;
        out[i].face = {a.face, b.face};
    });
    const auto key = [](const EdgeContinuity& x) {
        return std::tuple(x.g_at_most, -x.angle, -x.curvature, -x.gap, x.edge, x.face);
    };
    sort(out, {}, key);
    return out;
}

}  // namespace freiform
