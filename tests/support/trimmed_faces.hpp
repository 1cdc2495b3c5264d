// Random trimmed faces, a third of them nasty on purpose.
#pragma once
#include <freiform/model/assemble.hpp>

#include <numbers>
#include <optional>
#include <support/random.hpp>

namespace freiform::test {

enum class Nasty { none, touching, tiny_edges, seam, slit, along_boundary, second_loop_outside };
inline const char* name_of(Nasty n) {
    const char* names[] = {"none", "touching", "tiny edges", "seam", "slit", "along boundary", "two regions"};
    return names[int(n)];
}

struct TrimmedFace {
    Model model;
    Nasty nasty = Nasty::none;
    bool cone = false;  // or cylinder, of a free-form curve
    double area = 0;    // of the polygons in the parameter plane; exact where all loops are polygons
    bool polygons = true;
    double size = 1;  // of the parameter domain
    std::vector<std::vector<Vec<2>>> corners;
};

class TrimmedFaces {
public:
    explicit TrimmedFaces(std::uint64_t seed) : rng_(seed) {}

    TrimmedFace next() {
        TrimmedFace f;
        f.nasty = rng_.chance(1.0 / 3) ? Nasty(rng_.integer(1, 6)) : Nasty::none;
        const bool closed = f.nasty == Nasty::seam;
        const int degree = rng_.integer(1, 4), n = rng_.integer(degree + 1, 7);
        const auto u = closed ? *BSplineBasis::periodic(3, {0, 1, 2, 3, 4, 5})
                              : *BSplineBasis::clamped_uniform(degree, n);
        f.cone = rng_.chance(0.3);
        const int m = f.cone ? 2 : rng_.integer(3, 6);
        const auto v = *BSplineBasis::clamped_uniform(f.cone ? 1 : 2, m);
        const double eu = u.domain().hi, ev = v.domain().hi, height = rng_.real(0, 0.4);
        std::vector<Vec<3>> points;
        std::vector<double> weights;
        for (int i = 0; i < u.size(); ++i)
            for (int k = 0; k < m; ++k) {
                const double a = 2 * std::numbers::pi * i / u.size(), r = 1 + height * rng_.real(-1, 1) / 2;
                const double y = double(k) / (m - 1), z = height * rng_.real(-1, 1);
                points.push_back(closed ? Vec<3>{{r * std::cos(a), r * std::sin(a), 2 * y}}
                                        : Vec<3>{{double(i) / (u.size() - 1), y, z}});
                weights.push_back(std::exp2(rng_.real(-1, 1)));
            }
        if (f.cone) {  // the first row is a copy of the second one, nearer to an apex, in it, or moved
            const Vec<3> apex{{rng_.real(0, 1), rng_.real(-1, 0), rng_.real(1, 2)}};
            const double part = rng_.chance(0.2) ? 1 : rng_.chance(0.2) ? 0 : rng_.real(0, 0.9);
            for (int i = 0; i < u.size(); ++i) {
                const Vec<3> far = points[std::size_t(2 * i + 1)];
                points[std::size_t(2 * i)] = part == 1 ? far + apex : apex + part * (far - apex);
                weights[std::size_t(2 * i)] = weights[std::size_t(2 * i + 1)];
            }
        }
        surface_ = must(Surface<Vec<3>>::make({u, v}, Net<2, Vec<3>>({u.size(), m}, points)));
        if (rng_.chance(0.4)) {
            std::vector<Hom<3>> c;
            for (std::size_t i = 0; i < points.size(); ++i) {
                const double w = weights[i];
                c.push_back({{w * points[i][0], w * points[i][1], w * points[i][2], w}});
            }
            surface_ = must(Surface<Hom<3>>::make({u, v}, Net<2, Hom<3>>({u.size(), m}, c)));
        }
        size_ = {{eu, ev}};
        f.size = std::min(eu, ev);
        loops_.clear();
        make_loops(f);
        ModelBuilder builder;
        if (auto ok = builder.add_trimmed(*surface_, loops_); !ok) must(std::move(ok));
        f.model = must(std::move(builder).finish());
        return f;
    }

private:
    Vec<2> at(double x, double y) const { return {{x * size_[0], y * size_[1]}}; }

    // Corners in the unit square.
    void polygon(TrimmedFace& f, const std::vector<Vec<2>>& p, int sign) {
        std::vector<CurveGeometry<2>> loop;
        std::vector<Vec<2>> q;
        for (const Vec<2>& c : p) q.push_back(at(c[0], c[1]));
        for (std::size_t i = 0; i < q.size(); ++i) {
            const Vec<2>&a = q[i], &b = q[(i + 1) % q.size()];
            f.area += sign * cross(a - q[0], b - q[0]) / 2;
            loop.push_back(
                must(Curve<Vec<2>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<2>>({2}, {a, b}))));
        }
        if (rng_.chance(0.3)) std::reverse(loop.begin(), loop.end()), reverse_each(loop);
        f.corners.push_back(q);
        loops_.push_back(std::move(loop));
    }
    static void reverse_each(std::vector<CurveGeometry<2>>& loop) {
        for (auto& c : loop) c = reverse(std::get<Curve<Vec<2>>>(c), 0);
    }

    std::vector<Vec<2>> star(Vec<2> centre, double least, double most, int corners = 6) {
        const int n = rng_.integer(corners, 14);
        std::vector<Vec<2>> p;
        for (int i = 0; i < n; ++i) {
            const double angle = 2 * std::numbers::pi * (i + rng_.real(0, 0.9)) / n;
            p.push_back(centre + rng_.real(least, most) * Vec<2>{{std::cos(angle), std::sin(angle)}});
        }
        return p;
    }
    // A closed cubic about the centre, its control points between the radii; no polygon.
    void smooth(TrimmedFace& f, Vec<2> centre, double least, double most) {
        const int n = rng_.integer(4, 9);
        std::vector<double> breaks;
        for (int i = 0; i <= n; ++i) breaks.push_back(i);
        std::vector<Vec<2>> c;
        for (int i = 0; i < n; ++i) {
            const double angle = 2 * std::numbers::pi * i / n, r = rng_.real(least, most);
            c.push_back(at(centre[0] + r * std::cos(angle), centre[1] + r * std::sin(angle)));
        }
        const auto closed =
            must(Curve<Vec<2>>::make({*BSplineBasis::periodic(3, breaks)}, Net<1, Vec<2>>({n}, c)));
        loops_.push_back({must(restrict_to(closed, 0, closed.domain()[0]))});
        f.polygons = false;
    }

    void make_loops(TrimmedFace& f) {
        const Vec<2> middle{{0.5, 0.5}};
        switch (f.nasty) {
            case Nasty::none: {
                if (rng_.chance(0.3))
                    smooth(f, middle, 0.4, 0.48);
                else
                    polygon(f, star(middle, 0.42, 0.49, 8), 1);
                const int holes = rng_.integer(0, 3);
                for (int h = 0; h < holes; ++h) {
                    const double angle = 2 * std::numbers::pi * h / 3;
                    const Vec<2> c = middle + 0.1 * Vec<2>{{std::cos(angle), std::sin(angle)}};
                    if (rng_.chance(0.4))
                        smooth(f, c, 0.02, 0.045);
                    else
                        polygon(f, star(c, 0.03, 0.045), -1);
                    if (rng_.chance(0.5)) polygon(f, star(c, 1e-4, 0.002), 1);  // an island
                }
                break;
            }
            case Nasty::touching: {
                polygon(f, {{{0.1, 0.1}}, {{0.5, 0.1}}, {{0.9, 0.1}}, {{0.9, 0.9}}, {{0.1, 0.9}}}, 1);
                polygon(f, {{{0.5, 0.1}}, {{0.6, 0.4}}, {{0.5, 0.6}}, {{0.4, 0.4}}}, -1);
                polygon(f, {{{0.5, 0.6}}, {{0.6, 0.8}}, {{0.4, 0.8}}}, -1);
                break;
            }
            case Nasty::tiny_edges: {
                const double tiny = std::pow(10, rng_.real(-12, -4));
                polygon(f,
                        {{{0.1, 0.1}},
                         {{0.9, 0.1}},
                         {{0.9, 0.1 + tiny}},
                         {{0.9, 0.9}},
                         {{0.9 - tiny, 0.9 + tiny}},
                         {{0.1, 0.9}}},
                        1);
                polygon(f, star({{0.4, 0.4}}, tiny, 3 * tiny), -1);
                break;
            }
            case Nasty::seam: {
                const double off = rng_.chance(0.3) ? 0 : std::pow(10, rng_.real(-12, -2));
                polygon(f, {{{off, 0.1}}, {{1 - off, 0.15}}, {{1 - off, 0.9}}, {{off, 0.85}}}, 1);
                polygon(f, star({{0.5, 0.5}}, 0.1, 0.2), -1);
                break;
            }
            case Nasty::slit: {
                const double wide = std::pow(10, rng_.real(-13, -2)), slope = rng_.real(-0.2, 0.2);
                polygon(f, star(middle, 0.44, 0.49, 8), 1);
                polygon(
                    f, {{{0.3, 0.5}}, {{0.7, 0.5 + slope}}, {{0.7, 0.5 + slope + wide}}, {{0.3, 0.5 + wide}}},
                    -1);
                break;
            }
            case Nasty::along_boundary: {
                const double off = std::pow(10, rng_.real(-12, -3));
                polygon(f, {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}}, 1);
                polygon(f, {{{0.1, off}}, {{0.9, off}}, {{0.8, 0.3}}}, -1);
                break;
            }
            case Nasty::second_loop_outside: {
                const double off = std::pow(10, rng_.real(-13, -2));
                polygon(f, {{{0.1, 0.1}}, {{0.5, 0.1}}, {{0.5, 0.9}}, {{0.1, 0.9}}}, 1);
                polygon(f, {{{0.5 + off, 0.1}}, {{0.9, 0.1}}, {{0.9, 0.9}}, {{0.5 + off, 0.9}}}, 1);
                break;
            }
        }
    }

    Random rng_;
    std::optional<ModelBuilder::SplineSurface> surface_;
    Vec<2> size_{};
    std::vector<std::vector<CurveGeometry<2>>> loops_;
};

}  // namespace freiform::test
