// Pairs of plane curves on which intersections are known to fail, each with the truth, and what an answer is
// worth beside it.
//
// Truth. B is the graph y = f(x / n) over [0, n] with integer coordinates over a power of two, and A stays
// over [0, n]: they meet where f(x_A(t) / n) = y_A(t), a polynomial in t whose distinct roots Sturm's theorem
// counts in integers. A shear that doubles hold exactly hides this form.
#pragma once
#include "evaluation_inputs.hpp"

#include <freiform/intersect/curve_curve.hpp>

#include <array>
#include <string>
#include <sturm.hpp>

namespace freiform::bench {

using NastyGrid = std::vector<Vec<2>>;
using PlaneBezier = Curve<Vec<2>>;

inline PlaneBezier plane_bezier(NastyGrid g) {
    const int n = int(g.size());
    return *PlaneBezier::make({*BSplineBasis::bezier(n - 1)}, Net<1, Vec<2>>({n}, std::move(g)));
}

inline NastyGrid points_of(const PlaneBezier& c) { return {c.net().flat().begin(), c.net().flat().end()}; }

// Points and overlaps that there are; -1 points: those of a wrong question, which is refused.
struct CurveCase {
    std::string kind;
    NastyGrid a, b;
    int points = 0, overlaps = 0;
};

enum class Verdict { right, open, wrong };

// open: the truth is not excluded, and the answer says that it does not know.
inline Verdict judge(const CurveCase& c, const Intersections<2, 2>& found) {
    int proven = 0, least = 0, most = 0;
    for (const auto& x : found.contacts) proven += x.is_proven(), least += x.least, most += x.most;
    const bool open = proven < int(found.contacts.size()) || !found.undecided.empty();
    if (int(found.overlaps.size()) > c.overlaps) return Verdict::wrong;
    if (!open)
        return proven == c.points && int(found.overlaps.size()) == c.overlaps ? Verdict::right
                                                                              : Verdict::wrong;
    const bool possible = least <= c.points && (c.points <= most || !found.undecided.empty());
    return possible || c.overlaps > 0 ? Verdict::open : Verdict::wrong;
}

// The cases on which every library that was tried fails somewhere.
inline std::vector<CurveCase> known_hard_cases() {
    const NastyGrid arch{{{0, 0}}, {{1, 2}}, {{3, 2}}, {{4, 0}}}, cap{{{-1, -1}}, {{0, 1}}, {{1, -1}}},
        cusp{{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}};
    const auto cup = [](double h) { return NastyGrid{{{-1, 1 + h}}, {{0, -1 + h}}, {{1, 1 + h}}}; };
    const auto times = [](NastyGrid g, double s) {
        for (Vec<2>& p : g) p = s * p;
        return g;
    };
    const NastyGrid part = points_of(*restrict_to(plane_bezier(arch), 0, {0.25, 0.75}));
    const NastyGrid wave{{{-1, -1.25}}, {{-0.3125, 6.25}}, {{0.3125, -6.25}}, {{1, 1.25}}};
    NastyGrid mirrored = wave;
    for (Vec<2>& p : mirrored) std::swap(p[0], p[1]);
    const NastyGrid bow{{{0, 0}}, {{2, 4}}, {{4, 0}}}, across{{{0, 0.7}}, {{4, 1.1}}};
    return {{"tangent parabolas", cup(0), cap, 1, 0},
            {"parabolas that overlap by 1e-9", cup(-1e-9), cap, 2, 0},
            {"parabolas that overlap by 1e-12", cup(-1e-12), cap, 2, 0},
            {"parabolas 1e-9 apart", cup(1e-9), cap, 0, 0},
            {"parabolas 1e-12 apart", cup(1e-12), cap, 0, 0},
            {"a cubic and itself", arch, arch, 0, 1},
            {"a cubic and itself, 100 times as large", times(arch, 100), times(arch, 100), 0, 1},
            {"a cubic and a part of it", arch, part, 0, 1},
            {"a cubic and itself reversed", arch, {arch[3], arch[2], arch[1], arch[0]}, 0, 1},
            {"a line through a cusp", cusp, {{{0.5, 0}}, {{0.5, 1}}}, 1, 0},
            {"two cubics that cross nine times", wave, mirrored, 9, 0},
            {"a plain crossing at 1e-9", times(bow, 1e-9), times(across, 1e-9), 2, 0},
            {"a plain crossing at 1e11", times(bow, 1e11), times(across, 1e11), 2, 0},
            {"a curve that is a point of a line", {4, Vec<2>{{1, 1}}}, {{{0, 1}}, {{4, 1}}}, 1, 0},
            {"a coordinate that is no number", {{{0, 0}}, {{std::nan(""), 1}}}, arch, -1, 0}};
}

// --- Nasty ones, from random numbers -----------------------------------------------------------------------

class NastyCurves {
public:
    explicit NastyCurves(std::uint64_t seed) : random_(seed) {}

    static constexpr int kKinds = 8;
    CurveCase next() {
        const int kind = made_++ % kKinds;
        if (kind == 6) return coincident();
        CurveCase c{kNames[kind], {}, {}, -1, 0};
        NastyGrid a, graph;
        while (c.points < 0) {  // by chance the same curve
            const int n = whole(1, 3), fine = kind == 0 ? 1 : 8;
            graph = grid(n + 1, n, fine), a = grid(whole(2, 5), n, fine);
            for (int k = 0; k <= n; ++k) graph[std::size_t(k)][0] = k;
            if (kind == 1) a.front() = graph.back(), a.back() = whole(0, 1) ? graph.front() : a.back();
            if (kind == 2) a[1] = a[0], a[a.size() - 2] = whole(0, 1) ? a.back() : a[a.size() - 2];
            if (kind == 3 || kind == 4)
                a = touching(graph, kind == 3 ? 0 : std::ldexp(whole(0, 1) ? 1 : -1, -whole(25, 42)));
            c.points = truth(a, graph);
        }
        c.a = sheared(a), c.b = sheared(graph);
        if (kind == 5) scale(c, std::ldexp(1.0, whole(0, 1) ? 200 : -200));
        if (kind == 7) move(c, 0x1p40);
        return c;
    }

private:
    static constexpr const char* kNames[kKinds] = {"integers: tangents and ends on the curve",
                                                   "common ends",
                                                   "ends that stand still",
                                                   "touching, two- and threefold",
                                                   "touching within 2^-25 to 2^-42",
                                                   "in units of 2^200 and 2^-200",
                                                   "parts of one curve",
                                                   "2^40 from the origin"};

    int whole(int lo, int hi) { return lo + int(random_.next() * (hi - lo + 1)); }
    NastyGrid grid(int count, int width, int fine) {
        NastyGrid g;
        for (int i = 0; i < count; ++i) {
            const double x = whole(0, fine * width) / double(fine);
            g.push_back({{x, whole(-2 * fine, 2 * fine) / double(fine)}});
        }
        return g;
    }
    // The graph, and over it (t - r)^m (2 - t) 3 / 8 with r = k / 8 and m = 2 or 3, and `more`; of degree 4.
    // Heights become multiples of 3, so that all is exact: raising the degree divides by 2, 3 and 4.
    NastyGrid touching(NastyGrid& graph, double more) {
        for (Vec<2>& p : graph) p[1] *= 3;
        NastyGrid out = points_of(*elevate(plane_bezier(graph), 0, 5 - int(graph.size())));
        const double r = whole(1, 7) / 8.0;
        const int m = whole(2, 3);
        for (std::size_t i = 0; i < 5; ++i) {
            // The blossom, at 0 (4 - i times) and 1 (i times): the mean over all orders of the factors.
            std::array<double, 4> t{};
            for (std::size_t k = 0; k < i; ++k) t[3 - k] = 1;
            std::array<std::size_t, 4> order{0, 1, 2, 3};
            double sum = 0;
            do {
                double product = 2 - t[order[3]];
                for (std::size_t k = 0; k < std::size_t(m); ++k) product *= t[order[k]] - r;
                sum += product;
            } while (std::next_permutation(order.begin(), order.end()));
            out[i][0] = double(i) * (double(graph.size()) - 1) / 4;
            out[i][1] = std::ldexp(std::round(std::ldexp(out[i][1], 12)), -12) + sum / 64 + more;
        }
        return out;
    }
    // Exact: eighths of a curve with coarse coordinates that does not meet itself.
    CurveCase coincident() {
        NastyGrid g = grid(4, 3, 2);
        for (int k = 0; k < 4; ++k) g[std::size_t(k)][0] = k;
        const auto part = [&](int lo, int hi) {
            return points_of(*restrict_to(plane_bezier(g), 0, {lo / 8.0, hi / 8.0}));
        };
        const int lo = whole(0, 3), hi = whole(4, 7), from = whole(1, 6), to = whole(from + 1, 8);
        const int common = std::min(hi, to) - std::max(lo, from);
        CurveCase out{kNames[6], part(lo, hi), part(from, to), common == 0, common > 0};
        if (whole(0, 1)) std::reverse(out.b.begin(), out.b.end());
        return out;
    }

    static test::Polynomial product(const test::Polynomial& a, const test::Polynomial& b) {
        test::Polynomial p(a.size() + b.size() - 1);
        for (std::size_t i = 0; i < a.size(); ++i)
            for (std::size_t j = 0; j < b.size(); ++j) p[i + j] += a[i] * b[j];
        return p;
    }
    static test::Polynomial coordinate(const NastyGrid& g, int k) {  // times 2^110
        test::Polynomial c;
        for (const Vec<2>& p : g) c.push_back(test::whole_of(p[k], -110));
        auto out = test::power_form(std::move(c));
        if (out.empty()) out.push_back(0);
        return out;
    }
    // Distinct t in [0, 1] where A meets the graph; -1: all of them.
    static int truth(const NastyGrid& a, const NastyGrid& graph) {
        using test::Polynomial, test::Whole;
        const Polynomial x = coordinate(a, 0), y = coordinate(a, 1), f = coordinate(graph, 1);
        const Whole n = Whole(std::int64_t(graph.size()) - 1) << 110;
        Polynomial sum, power{1};
        Whole scale = 1;
        for (std::size_t k = 0; k + 1 < f.size(); ++k) scale *= n;
        const Whole all = scale;
        for (std::size_t k = 0; k < f.size(); ++k) {
            sum.resize(std::max(sum.size(), power.size()));
            for (std::size_t i = 0; i < power.size(); ++i) sum[i] += f[k] * scale * power[i];
            if (k + 1 < f.size()) power = product(power, x), scale /= n;
        }
        sum.resize(std::max(sum.size(), y.size()));
        for (std::size_t i = 0; i < y.size(); ++i) sum[i] -= y[i] * all;
        test::trim(sum);
        if (sum.empty()) return -1;
        return test::RootCount(sum).distinct(0, 1) + (test::sign_at(sum, 0) == 0);
    }
    static NastyGrid sheared(const NastyGrid& g) {
        NastyGrid out;
        for (const Vec<2>& p : g) out.push_back({{p[0] + 2 * p[1], p[1] - p[0]}});
        return out;
    }
    static void scale(CurveCase& c, double s) {
        for (NastyGrid* g : {&c.a, &c.b})
            for (Vec<2>& p : *g) p = s * p;
    }
    static void move(CurveCase& c, double by) {
        for (NastyGrid* g : {&c.a, &c.b})
            for (Vec<2>& p : *g) p += Vec<2>{{by, -by}};
    }

    Sequence random_;
    int made_ = 0;
};

}  // namespace freiform::bench
