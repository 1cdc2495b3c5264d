// Lengths of edges.
//
// Idea. Curves in space: query/length.hpp. An edge without one is g(t) = S(p(t)), and where that is a curve
// of the library, moved (on planes, along parameter lines: chord_curve.cpp), it is measured as that. Else
// chords: with e the direction of the chord of a part of length h, the integral of g' . e is the chord c
// exactly, and what is across, g' - (g' . e) e, has the mean 0, so that it is nowhere longer than the mean of
// |t - s| max|g''| <= M h / 2, M = max|g''|. Since |g'| - g' . e is the square of that over |g'| + g' . e,
//     c <= length <= c + h (M h / 2)^2 / (2 (c / h - M h / 2)),
// where the last bracket is positive; and always length <= h max|g'|. The part that leaves most open is
// halved until their sum is small enough.
//
// Notation. p = (u, v), S_ij, u_k, v_k: bounds of derivatives over the part and a box that contains p there,
//     |g'| <= S_10 u_1 + S_01 v_1,
//     M = S_20 u_1^2 + 2 S_11 u_1 v_1 + S_02 v_1^2 + S_10 u_2 + S_01 v_2.
//
// Seams. Where the box reaches over a kink of the surface or over the end of its domain, beyond which
// parameters are moved back, g is not smooth. There that parameter is held in the middle: |g'| of g with u
// held differs by at most S_10 u_1 + S_11 (h/2 u_1) v_1, which is nothing for an edge that runs along a seam
// and whose sum shrinks with the parts of one that crosses it. S_v is continuous across a kink in u.
//
// Accuracy. The ends of chords: value_error_bound of S, and S_10, S_01 times that of p. A lift has
// coefficients that are off by d, at most what points of S and p are: its length is off by at most that of
// the curve with the n differences as control points, 2 (n - 1) d. The chord of a held part is that of g
// itself, which differs by at most h S_10 u_1, too.
//
// Cost. What is left open falls by four with each halving of all: about 1 / (3 sqrt(e)) parts for e of the
// length on a circle's quarter.
#include "edge_mesh_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/model/edge_length.hpp>
#include <freiform/query/checks.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr std::size_t kMostChords = 20'000;  // of one edge; a backstop
constexpr int kMostRounds = 48;
constexpr double kEnoughOfLength = 0x1p-20;  // without an accuracy: of the length
constexpr double kChordSlack = 1 + 0x1p-40;  // more than the roundings of the bound of a part

class LiftedLength {
public:
    LiftedLength(const SurfaceGeometry& surface, const CurveGeometry<2>& curve)
        : surface_(surface), curve_(curve), query_(surface), along_(curve), limits_(limits(surface)) {}

    Measure measure(Interval on, double accuracy) {
        std::vector<Chord> chords;
        for (const Interval& part : parts_of(on)) chords.push_back(chord(part));
        for (int round = 0;; ++round) {
            const Measure sum = total(chords);
            const double enough = accuracy > 0 ? accuracy : kEnoughOfLength * sum.value;
            const std::size_t before = chords.size();
            if (sum.bound <= enough || round == kMostRounds || before > kMostChords) return sum;
            std::vector<Chord> finer;
            for (const Chord& c : chords) {
                const double middle = c.on.middle();
                if (c.above > enough / double(before) && c.on.lo < middle && middle < c.on.hi) {
                    finer.push_back(chord({c.on.lo, middle}));
                    finer.push_back(chord({middle, c.on.hi}));
                } else {
                    finer.push_back(c);
                }
            }
            if (finer.size() == before) return sum;  // the rest is rounding
            chords = std::move(finer);
        }
    }

private:
    struct Chord {
        Interval on;
        double length = 0, above = 0, rounding = 0;  // that of the part is in [length, length + above]
    };

    std::vector<Interval> parts_of(Interval on) const {
        std::vector<double> t{on.lo, on.hi};
        for (int i = 1; i < 4; ++i) t.push_back(on.lo + on.length() * i / 4);
        visit_one(
            [&](const auto& c) {
                if constexpr (requires { c.net(); })
                    for (const double x : c.basis().breaks())
                        if (on.lo < x && x < on.hi) t.push_back(x);
            },
            curve_);
        sort(t);
        std::vector<Interval> out;
        for (std::size_t i = 0; i + 1 < t.size(); ++i)
            if (t[i] < t[i + 1]) out.push_back({t[i], t[i + 1]});
        return out;
    }

    Vec<3> point(double t) const {
        return jet<0>(surface_, clamped(jet<0>(curve_, t).value(), limits_).c).value();
    }

    Chord chord(Interval on) const {
        const double h = on.length() * (1 + 0x1p-50);
        auto p = coordinate_bounds(along_, on).coordinate;
        const Vec<2> middle = jet<0>(curve_, on.middle()).value();
        const double off = value_error_bound(curve_, {on});
        std::array<Interval, 2> box;
        bool held[2] = {false, false}, torn = false;
        for (std::size_t k = 0; k < 2; ++k) {
            const double reach = (h / 2 * p[k](1) + off) * (1 + 0x1p-50);
            box[k] = {middle[int(k)] - reach, middle[int(k)] + reach};
            if (box[k].hi <= limits_[k].lo || box[k].lo >= limits_[k].hi)
                p[k] = {};  // moved back: constant
            else
                held[k] = box[k].lo < limits_[k].lo || box[k].hi > limits_[k].hi;
            box[k] = {clamped(box[k].lo, limits_[k]), clamped(box[k].hi, limits_[k])};
            for (const Kink& kink : query_.kinks(int(k)))
                if (box[k].contains(kink.at)) held[k] = true, torn = torn || !std::isfinite(kink.jump);
        }
        const auto s = query_(box);
        const auto times = [](double a, double b) { return a == 0 || b == 0 ? 0 : a * b; };  // infinite a
        const double fastest = times(s(1, 0), p[0](1)) + times(s(0, 1), p[1](1));
        const double twist = h / 2 * times(s(1, 1), p[0](1) * p[1](1));
        double aside = 0;
        if (held[0]) aside += h * (times(s(1, 0), p[0](1)) + twist);
        if (held[1]) aside += h * (times(s(0, 1), p[1](1)) + twist);
        for (std::size_t k = 0; k < 2; ++k)
            if (held[k]) p[k] = {};
        const double u = p[0](1), v = p[1](1);
        const double bend = times(s(2, 0), u * u) + 2 * times(s(1, 1), u * v) + times(s(0, 2), v * v) +
                            times(s(1, 0), p[0](2)) + times(s(0, 1), p[1](2));
        Chord c;
        c.on = on;
        c.length = norm(point(on.hi) - point(on.lo));
        c.rounding = 4 * value_error_bound(surface_, box) + 8 * kUnitRoundoff * c.length +
                     2 * off * (s(1, 0) + s(0, 1));
        const double turn = bend * h / 2, room = (c.length - aside - c.rounding) / h - turn;
        c.above = room > 0 ? h * turn * turn / (2 * room) + 2 * aside : kInfinity;
        c.above = std::min(c.above, h * fastest) * kChordSlack;
        if (torn || std::isnan(c.above) || std::isnan(c.rounding)) c.above = kInfinity;
        return c;
    }

    // In the middle of what is left open.
    static Measure total(const std::vector<Chord>& chords) {
        Measure sum;
        double above = 0;
        for (const Chord& c : chords) sum.value += c.length, above += c.above, sum.bound += c.rounding;
        sum.bound =
            (sum.bound + above / 2 + double(chords.size() + 2) * kUnitRoundoff * sum.value) * kChordSlack;
        if (std::isfinite(above)) sum.value += above / 2;
        return sum;
    }

    const SurfaceGeometry& surface_;
    const CurveGeometry<2>& curve_;
    DerivativeQuery<2, 3> query_;
    DerivativeQuery<1, 2> along_;
    std::array<Interval, 2> limits_;
};

// Of the length of a lift over `over`, of coefficients that are off by d each.
double moved_by(const CurveGeometry<3>& lift, Interval over, double d) {
    return visit_one(
        [&](const auto& c) {
            if constexpr (requires { c.net(); })
                return 2 * double(c.net().flat().size()) * d;
            else
                return 2 * (1 + over.length()) * d;
        },
        lift);
}

Result<Measure> length_on_face(const Face& face, const Coedge& coedge, Interval on, double accuracy) {
    if (const auto lift = lifted(face.surface, coedge.curve)) {
        const auto* spline = &*lift->geometry;
        Interval over = lift->over(on);
        const Interval whole = domain(*spline)[0];
        const bool inside = std::holds_alternative<Line<3>>(*spline) ||
                            std::holds_alternative<Conic<3>>(*spline) ||
                            (whole.lo <= over.lo && over.hi <= whole.hi);
        if (inside) {
            auto m = length(*spline, over, accuracy);
            const DerivativeQuery<2, 3> query(face.surface);
            const DerivativeQuery<1, 2> along(coedge.curve);
            const auto p = coordinate_bounds(along, on).coordinate;
            const Vec<2> middle = jet<0>(coedge.curve, on.middle()).value();
            std::array<Interval, 2> box;
            for (std::size_t k = 0; k < 2; ++k) {
                const double reach = on.length() * p[k](1);
                box[k] = {middle[int(k)] - reach, middle[int(k)] + reach};
            }
            const auto s = query(box, 1);
            const double d = value_error_bound(face.surface, box) +
                             (s(1, 0) + s(0, 1)) * value_error_bound(coedge.curve, {on});
            if (m) m->bound += moved_by(*spline, over, 4 * d);
            return m;
        }
    }
    return LiftedLength(face.surface, coedge.curve).measure(on, accuracy);
}

}  // namespace

Result<std::vector<Measure>> edge_lengths(const Model& model, double accuracy) {
    if (auto ok = detail::check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    struct Use {
        const Face* face = nullptr;
        const Coedge* coedge = nullptr;
    };
    std::vector<Use> first(model.edges.size());
    for (const Face& face : model.faces)
        for (const Loop& loop : face.loops)
            for (const Coedge& c : loop.coedges)
                if (Use& use = first[std::size_t(c.edge)]; !use.face) use = {&face, &c};
    std::vector<Result<Measure>> found(model.edges.size(), Measure{});
    parallel_for(model.edges.size(), 4, [&](std::size_t e) {
        const Edge& edge = model.edges[e];
        if (edge.degenerate) return;
        if (edge.curve)
            found[e] = length(*edge.curve, edge.range, accuracy);
        else if (first[e].face)
            found[e] = length_on_face(*first[e].face, *first[e].coedge, edge.range, accuracy);
    });
    std::vector<Measure> out;
    for (std::size_t e = 0; e < found.size(); ++e) {
        if (!found[e]) return refuse_within(text("edges[", e, "]"), found[e].error());
        out.push_back(*found[e]);
    }
    return out;
}

}  // namespace freiform
