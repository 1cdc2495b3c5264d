// Curves and surfaces whose nearest points are hard: folds, cusps, collapsed sides, uneven weights, points;
// and what an answer is worth beside many samples.
#pragma once
#include "evaluation_inputs.hpp"
#include "nasty_curves.hpp"

#include <freiform/query/nearest.hpp>

#include <algorithm>
#include <string>

namespace freiform::bench {

struct NastyObject {
    std::string kind;
    NearestQuery query;
    double size = 1;  // of the object and of where the questions are
    std::vector<Vec<3>> samples, questions;
    double sample_error = 0;
};

inline double apart(const Vec<3>& a, const Vec<3>& b) {  // without under- or overflow
    const Vec<3> d = a - b;
    const double scale = max_abs(d);
    return scale > 0 ? scale * norm((1 / scale) * d) : 0;
}

// right: no sample is nearer than the answer, nor than its bound, and the bound proves it to 1e-9 of the
// size. open: what is said holds, but the bound is farther below.
inline Verdict judge(const NastyObject& o, const Vec<3>& q, const Result<Nearest<3>>& answer) {
    if (!answer) return Verdict::wrong;
    double least = std::numeric_limits<double>::infinity();
    for (const Vec<3>& x : o.samples) least = std::min(least, apart(x, q));
    const double rounding = 1e-14 * least + o.sample_error;
    const bool holds = answer->lower_bound <= std::min(least + rounding, answer->distance);
    const bool beaten = answer->distance - answer->point_error > least + rounding;
    if (!holds) return Verdict::wrong;
    const bool proven = answer->distance + answer->point_error - answer->lower_bound <= 1e-9 * o.size;
    if (beaten) return proven ? Verdict::wrong : Verdict::open;
    return proven ? Verdict::right : Verdict::open;
}

class NastyObjects {
public:
    explicit NastyObjects(std::uint64_t seed) : random_(seed) {}

    NastyObject next() {
        const int kind = made_ % kKinds, p = 2 + made_ / kKinds % 4;
        ++made_;
        return kind < kCurves ? curve(kind, p) : surface(kind, p);
    }

private:
    static constexpr int kCurves = 8, kKinds = 14;
    static constexpr const char* kNames[kKinds] = {"curve that is a point",
                                                   "curve with every other point the same",
                                                   "curve with weights 1e16 apart",
                                                   "curve of size 1e-150",
                                                   "curve 1e9 from the origin",
                                                   "line run to and fro",
                                                   "plane curve with weights 1e6 apart",
                                                   "curve on a coarse diagonal, to and fro",
                                                   "surface with a collapsed side",
                                                   "folded surface in a plane",
                                                   "surface with weights 1e10 apart",
                                                   "surface that is a line",
                                                   "surface that is a point",
                                                   "surface of size 1e200"};

    double real(double reach) { return reach * (2 * random_.next() - 1); }

    NastyObject curve(int kind, int p) {
        const auto basis = *BSplineBasis::make(p, uneven(p, int(3 * random_.next())));
        std::vector<Hom<3>> net;
        for (int k = 0; k < basis.size(); ++k) {
            Vec<3> x{{real(1), real(1), real(1)}};
            double w = 1;
            if (kind == 0) x = {};
            if (kind == 1 && k % 2) x = {{1, 0, 0}};
            if (kind == 2) w = k % 2 ? 1e8 : 1e-8;
            if (kind == 3) x = 1e-150 * x;
            if (kind == 4) x[0] += 1e9;
            if (kind == 5) x[1] = x[2] = 0;
            if (kind == 6) w = k % 2 ? 1e-6 : 1, x[2] = 0;
            if (kind == 7) x = std::round(2 * x[0]) * Vec<3>{{1, 1, 1}};
            net.push_back(weighted(x, w));
        }
        const auto c = *Curve<Hom<3>>::make({basis}, Net<1, Hom<3>>({basis.size()}, net));
        NastyObject out = begin(kind, c, kind == 3 ? 2e-150 : 2, kind == 4 ? 1e9 : 0);
        const Interval on = basis.domain();
        for (int i = 0; i <= 400; ++i)
            out.samples.push_back(c(std::min(on.hi, on.lo + on.length() * i / 400)));
        return with_questions(std::move(out), kind == 3 ? 2e-150 : 2);
    }
    NastyObject surface(int kind, int p) {
        const auto u = *BSplineBasis::bezier(p), v = *BSplineBasis::bezier(2);
        std::vector<Hom<3>> net;
        for (int k = 0; k < u.size() * v.size(); ++k) {
            Vec<3> x{{real(1), real(1), real(1)}};
            double w = 1;
            if (kind == 8 && k < 3) x = {};
            if (kind == 9) x[2] = 0;
            if (kind == 10) w = k % 2 ? 1e5 : 1e-5;
            if (kind == 11) x = x[0] * Vec<3>{{1, 2, 3}};
            if (kind == 12) x = {{1, 1, 1}};
            if (kind == 13) x = 1e200 * x;
            net.push_back(weighted(x, w));
        }
        const auto s = *Surface<Hom<3>>::make({u, v}, Net<2, Hom<3>>({u.size(), v.size()}, net));
        const double reach = kind == 13 ? 2e200 : 2;
        NastyObject out = begin(kind, s, reach, 0);
        for (int i = 0; i <= 30; ++i)
            for (int j = 0; j <= 30; ++j) out.samples.push_back(s(i / 30.0, j / 30.0));
        return with_questions(std::move(out), reach);
    }
    template <std::size_t N>
    static NastyObject begin(int kind, const Patch<N, Hom<3>>& patch, double reach, double offset) {
        return {kNames[kind],
                *NearestQuery::make(std::array{NearestObject::of(patch)}),
                reach + offset,
                {},
                {},
                2 * patch.value_error_bound()};
    }
    // Four, one of them on the object.
    NastyObject with_questions(NastyObject o, double reach) {
        for (int k = 0; k < 3; ++k) o.questions.push_back({{real(reach), real(reach), real(reach)}});
        o.questions.push_back(o.samples[std::size_t(random_.next() * double(o.samples.size()))]);
        return o;
    }
    std::vector<double> uneven(int p, int inner) {
        std::vector<double> t(std::size_t(p) + 1, 0.0);
        double x = 0;
        for (int i = 0; i < inner; ++i) t.push_back(x += 0.2 + 0.8 * random_.next());
        t.insert(t.end(), std::size_t(p) + 1, x + 0.5);
        return t;
    }

    Sequence random_;
    int made_ = 0;
};

}  // namespace freiform::bench
