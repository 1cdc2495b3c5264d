// What the library's reader of STEP files makes of a file: counts, areas and volumes, time of the
// processor, refusals, as one line of JSON for each file. tools/bench_step.py compares them with those of
// other programs.
//
//     bench-step [--repeat N] part.step ...
//
// Areas and volumes are integrals over the faces as they are, not over triangles. With F(u, v) the integral
// of f = |S_u x S_v| from a fixed parameter to u, Green's theorem makes that of f over the face the one of
// F dv along its loops; for volumes f = S . (S_u x S_v) / 3. Both integrals are Gauss's with ten points,
// along pieces that are halved until both halves agree with the whole.
#include <freiform/core/text.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/step_read.hpp>
#include <freiform/spline/geometry.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <sys/resource.h>
#include <vector>

namespace {

using namespace freiform;

constexpr double kNodes[] = {0.1488743389816312, 0.4333953941292472, 0.6794095682990244, 0.8650633666889845,
                             0.9739065285171717};
constexpr double kWeights[] = {0.2955242247147529, 0.2692667193099963, 0.2190863625159820, 0.1494513491505806,
                               0.0666713443086881};

// Of the largest part of a face; and half a turn, which is much for ten points.
constexpr double kRelative = 1e-8, kWidest = 3.2;
constexpr int kDeepest = 6;

template <class F>
Vec<2> gauss(Interval on, F&& f) {
    const double c = on.middle(), h = on.length() / 2;
    Vec<2> sum{};
    for (int i = 0; i < 5; ++i) sum += kWeights[i] * (f(c - h * kNodes[i]) + f(c + h * kNodes[i]));
    return h * sum;
}

std::vector<double> breaks_of(const SurfaceGeometry& s, int axis) {
    return std::visit(
        [&](const auto& g) -> std::vector<double> {
            if constexpr (requires { g.net(); })
                return g.basis(axis).breaks();
            else if constexpr (requires { g.base; })
                return breaks_of(*g.base, axis);
            else {
                constexpr int along = std::same_as<std::remove_cvref_t<decltype(g)>, Extrusion> ? 0 : 1;
                if (axis != along) return {};
                return std::visit(
                    [](const auto& c) -> std::vector<double> {
                        if constexpr (requires { c.net(); })
                            return c.basis().breaks();
                        else
                            return {};
                    },
                    g.profile);
            }
        },
        s);
}

class FaceIntegral {
public:
    explicit FaceIntegral(const Face& face)
        : s_(face.surface), limits_(limits(face.surface)), breaks_(breaks_of(face.surface, 0)) {
        flat_ = std::holds_alternative<Extrusion>(s_) &&
                std::holds_alternative<Line<3>>(std::get<Extrusion>(s_).profile);
    }
    // Area, and volume of the cone from `apex` to the face.
    Vec<2> operator()(const Model& m, const Face& face, const Vec<3>& apex) {
        apex_ = apex;
        // The loop that encloses most parameters, and holes in it, however they run.
        Vec<2> outer_loop{}, sum{};
        double widest = 0;
        bool first = true;
        for (const Loop& l : face.loops) {
            std::vector<Part> todo;
            double enclosed = 0;
            for (const Coedge& c : l.coedges) {
                const Interval on = m.edges[std::size_t(c.edge)].range;
                if (first) from_ = jet<0>(c.curve, on.lo).value()[0], first = false;
                const double sign = c.reversed ? -1 : 1;
                for (const Interval part : parts_of(c.curve, on)) {
                    todo.push_back({&c.curve, part, outer(c.curve, part), sign, 0});
                    enclosed += sign * gauss(part, [&](double t) {
                                    const auto j = jet<1>(c.curve, t);
                                    return Vec<2>{{(j.d[0][0] - from_) * j.d[1][1], 0}};
                                })[0];
                }
            }
            const Vec<2> one = (enclosed < 0 ? -1 : 1) * total(std::move(todo));
            sum -= one;
            if (std::abs(enclosed) > widest) outer_loop = one, widest = std::abs(enclosed);
        }
        sum += 2 * outer_loop;
        if (face.reversed) sum[1] = -sum[1];
        return sum;
    }

private:
    static std::vector<Interval> parts_of(const CurveGeometry<2>& c, Interval on) {
        std::vector<double> places{on.lo};
        std::visit(
            [&](const auto& g) {
                if constexpr (requires { g.net(); })
                    for (const double t : g.basis().breaks())
                        if (on.lo < t && t < on.hi) places.push_back(t);
            },
            c);
        places.push_back(on.hi);
        std::vector<Interval> parts;
        for (std::size_t i = 0; i + 1 < places.size(); ++i) parts.push_back({places[i], places[i + 1]});
        return parts;
    }
    Vec<2> density(double u, double v) const {
        const auto j = jet<1>(s_, clamped(Vec<2>{{u, v}}, limits_).c);
        const Vec<3> n = cross(j.d[1], j.d[2]);
        return {{norm(n), dot(j.d[0] - apex_, n) / 3}};
    }
    // From the fixed parameter to u, piece by piece. The densities of planes are constant.
    Vec<2> inner(double u, double v) const {
        if (flat_) return (u - from_) * density(u, v);
        const double lo = std::min(from_, u), hi = std::max(from_, u);
        std::vector<double> places{lo};
        for (const double t : breaks_)
            if (lo < t && t < hi) places.push_back(t);
        places.push_back(hi);
        if (breaks_.empty() && hi - lo > kWidest) places[1] = (lo + hi) / 2, places.push_back(hi);
        Vec<2> sum{};
        for (std::size_t i = 0; i + 1 < places.size(); ++i)
            sum += gauss({places[i], places[i + 1]}, [&](double x) { return density(x, v); });
        return u < from_ ? -1.0 * sum : sum;
    }
    Vec<2> outer(const CurveGeometry<2>& c, Interval on) const {
        return gauss(on, [&](double t) {
            const auto j = jet<1>(c, t);
            if (j.d[1][1] == 0) return Vec<2>{};
            return j.d[1][1] * inner(j.d[0][0], j.d[0][1]);
        });
    }
    struct Part {
        const CurveGeometry<2>* curve;
        Interval on;
        Vec<2> value;
        double sign;
        int depth;
    };
    Vec<2> total(std::vector<Part> todo) const {
        Vec<2> largest{}, sum{};
        for (const Part& p : todo)
            for (int k = 0; k < 2; ++k) largest[k] = std::max(largest[k], std::abs(p.value[k]));
        while (!todo.empty()) {
            const Part p = todo.back();
            todo.pop_back();
            const double m = p.on.middle();
            const Vec<2> a = outer(*p.curve, {p.on.lo, m}), b = outer(*p.curve, {m, p.on.hi});
            const Vec<2> off = a + b - p.value;
            if (p.depth > kDeepest ||
                (std::abs(off[0]) <= kRelative * largest[0] && std::abs(off[1]) <= kRelative * largest[1])) {
                sum += p.sign * (a + b);
            } else {
                todo.push_back({p.curve, {p.on.lo, m}, a, p.sign, p.depth + 1});
                todo.push_back({p.curve, {m, p.on.hi}, b, p.sign, p.depth + 1});
            }
        }
        return sum;
    }

    const SurfaceGeometry& s_;
    std::array<Interval, 2> limits_;
    std::vector<double> breaks_;
    bool flat_ = false;
    Vec<3> apex_{};
    double from_ = 0;
};

std::string quoted(std::string_view s) {
    std::string out = "\"";
    for (const char c : s) {
        if (c == '"' || c == '\\') out += '\\';
        out += static_cast<unsigned char>(c) < 32 ? ' ' : c;
    }
    return out + "\"";
}

double millimetres(const std::string& unit) {
    return unit == "m" ? 1000 : unit == "cm" ? 10 : unit == "inch" ? 25.4 : unit == "ft" ? 304.8 : 1;
}

void report(const std::string& path, int repeat) {
    const auto bytes = read_file(path, std::size_t(1) << 30);
    if (!bytes) return void(std::printf("{\"file\": %s, \"error\": \"no file\"}\n", quoted(path).c_str()));
    std::vector<double> seconds;
    Result<Model> m = read_step(*bytes);
    for (int i = 0; i < repeat; ++i) {
        const std::clock_t begin = std::clock();
        m = read_step(*bytes);
        seconds.push_back(double(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    std::sort(seconds.begin(), seconds.end());
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    std::string s = text("{\"file\": ", quoted(path), ", \"bytes\": ", bytes->size(),
                         ", \"seconds\": ", seconds.empty() ? 0.0 : seconds[seconds.size() / 2],
                         ", \"peak_kib\": ", used.ru_maxrss);
    if (!m) {
        s += text(", \"error\": ", quoted(text(m.error().where, ": ", m.error().message)), "}");
        std::puts(s.c_str());
        return;
    }
    const ModelSummary sum = summary(*m);
    s += text(", \"faces\": ", sum.faces, ", \"edges\": ", sum.edges, ", \"shells\": ", sum.shells,
              ", \"solids\": ", sum.solids, ", \"open_edges\": ", sum.open_edges,
              ", \"unit\": ", quoted(m->unit), ", \"refused\": [");
    for (std::size_t i = 0; i < m->refused.size(); ++i)
        s += text(i > 0 ? ", " : "", quoted(text(m->refused[i].where, ": ", m->refused[i].message)));
    const double mm = millimetres(m->unit);
    std::vector<Vec<2>> parts;
    s += "], \"areas\": [";
    for (std::size_t i = 0; i < m->faces.size(); ++i) {
        parts.push_back(FaceIntegral(m->faces[i])(*m, m->faces[i], 0.5 * (sum.box.lo + sum.box.hi)));
        s += text(i > 0 ? ", " : "", mm * mm * parts.back()[0]);
    }
    s += "], \"volumes\": [";
    bool first = true;
    for (const Body& b : m->bodies) {
        if (!b.solid) continue;
        double volume = 0;
        for (std::size_t k = 0; k < b.shells.size(); ++k) {
            double one = 0;
            for (const FaceUse& u : m->shells[std::size_t(b.shells[k])].faces)
                one += (u.reversed ? -1 : 1) * parts[std::size_t(u.face)][1];
            volume += (k == 0 ? 1 : -1) * std::abs(one);
        }
        s += text(first ? "" : ", ", mm * mm * mm * volume);
        first = false;
    }
    s += "]}";
    std::puts(s.c_str());
    std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
    int repeat = 0;
    for (int i = 1; i < count; ++i) {
        if (std::string(words[i]) == "--repeat" && i + 1 < count)
            repeat = std::atoi(words[++i]);
        else
            report(words[i], repeat);
    }
}
