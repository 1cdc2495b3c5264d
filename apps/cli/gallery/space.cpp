#include "gallery/space.hpp"

#include <freiform/mesh/visibility.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace freiform::cli::gallery {

Eye::Eye(const View& view) : view_(view) {
    const double ca = std::cos(view.azimuth), sa = std::sin(view.azimuth);
    const double ce = std::cos(view.elevation), se = std::sin(view.elevation);
    right_ = {{-sa, ca, 0}};
    up_ = cross(Vec<3>{{ce * ca, ce * sa, se}}, right_);
}

Points Eye::operator()(const Points3& points) const {
    Points out;
    for (const Vec<3>& p : points) out.push_back((*this)(p));
    return out;
}

Eye eye_at(double azimuth, double elevation) {
    return Eye({azimuth * std::numbers::pi / 180, elevation * std::numbers::pi / 180});
}

Plot& together(Plot& plot, const std::vector<Shown>& shown, const Eye& eye, DrawingOptions how) {
    Document document;
    how.palette.clear();
    for (const Shown& s : shown) {
        document.objects.push_back({text(document.objects.size()), s.shape, {}});
        how.palette.push_back(s.look.colour);
    }
    how.view = eye.view();
    how.width = how.height = 600;  // about the size of a panel
    std::vector<Refusal> left_out;
    Panel main = std::move(sure(panels_of(document, {}, how, left_out)).at(0));
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const Look& look = shown[i].look;
        DrawnGroup* lines = nullptr;
        for (DrawnGroup& g : main.groups) {
            if (g.name != text(i)) continue;
            g.legend.clear();
            if (g.paths.empty()) continue;
            if (g.role == "curve" || g.role == "edges") {
                g.width = look.width;
                g.dashes = look.dashes;
            }
            if (!lines || g.role == "curve" || g.role == "edges") lines = &g;
        }
        if (lines) lines->legend = formula(look.legend);
    }
    for (DrawnGroup& g : main.groups) {
        g.name.clear();
        plot.panel.groups.push_back(std::move(g));
    }
    plot.panel.notes.insert(plot.panel.notes.end(), main.notes.begin(), main.notes.end());
    return plot;
}

Shape polyline(const Points3& points) {
    std::vector<double> knots{0};
    for (std::size_t i = 0; i < points.size(); ++i) knots.push_back(double(i));
    knots.push_back(knots.back());
    return spline(1, std::move(knots), points);
}

Shape segments(const std::vector<std::array<Vec<3>, 2>>& lines) {
    Points3 points;
    std::vector<double> knots{0, 0};
    for (const auto& [a, b] : lines) {
        points.insert(points.end(), {a, b});
        knots.insert(knots.end(), 2, double(points.size()));  // of multiplicity 2: it may jump there
    }
    return spline(1, std::move(knots), points);
}

Shape net_of(const Net<2, Vec<3>>& net) {
    std::vector<std::array<Vec<3>, 2>> lines;
    const auto b = net.view();
    each_index(net.extent(), [&](const Index<2>& at) {
        if (at[0] > 0) lines.push_back({b({at[0] - 1, at[1]}), b(at)});
        if (at[1] > 0) lines.push_back({b({at[0], at[1] - 1}), b(at)});
    });
    return segments(lines);
}

Surface3 bezier_surface(const Net<2, Vec<3>>& net) {
    const auto [m, n] = net.extent();
    return sure(Surface3::make({sure(BSplineBasis::bezier(m - 1)), sure(BSplineBasis::bezier(n - 1))}, net));
}

Plot& triangles_of(Plot& plot, const TriangleMesh& mesh, const Eye& eye, const std::vector<Colour>& colours) {
    constexpr double kNear = 1e-6;  // of the size: sides of a triangle lie on it
    std::vector<std::array<Vec<3>, 3>> triangles;
    Box<3> box;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        auto& t = triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            t[k] = eye.deep(mesh.points[std::size_t(mesh.points_of(i)[k])]);
            box.add(t[k]);
        }
    }
    const Occluders occluders(triangles, kNear * max_abs(box.hi - box.lo));
    for (std::size_t part = 0; part < mesh.parts.size(); ++part) {
        DrawnGroup g{"", "triangles", colours[part % colours.size()], 0.9, {}, {}, {}};
        const auto& p = mesh.parts[part];
        for (int i = p.first; i < p.first + p.count; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto& t = triangles[std::size_t(i)];
                const std::array<Vec<3>, 2> side{t[k], t[(k + 1) % 3]};
                for (const SeenPart& seen : seen_parts(occluders, side))
                    if (!seen.hidden) {
                        const Vec<3>&a = seen.points.front(), &b = seen.points.back();
                        g.paths.push_back(
                            line_through(std::array{Vec<2>{{a[0], a[1]}}, Vec<2>{{b[0], b[1]}}}));
                    }
            }
        plot.panel.groups.push_back(std::move(g));
    }
    return plot;
}

namespace {

constexpr int kCells = 140;  // of stripes, along each parameter

// The parts of a grid of triangles where a function that is linear on each lies in one of the bands
// [2 k, 2 k + 1]: cut triangle by triangle; sides that two parts share are dropped, the others are chained.
class Bands {
public:
    Bands(const std::vector<Vec<2>>& at, const std::vector<double>& values) : at_(at), values_(values) {}

    void add(const std::array<int, 3>& triangle) {
        const auto [lo, hi] = std::minmax({value(triangle[0]), value(triangle[1]), value(triangle[2])});
        for (int level = 2 * int(std::floor(lo / 2)); level <= hi; level += 2) {
            std::vector<int> part;
            for (std::size_t k = 0; k < 3; ++k) add_side(part, triangle[k], triangle[(k + 1) % 3], level);
            if (part.size() < 3) continue;
            for (std::size_t k = 0; k < part.size(); ++k) {
                const std::pair<int, int> side{part[k], part[(k + 1) % part.size()]};
                if (side.first == side.second) continue;
                if (const auto other = sides_.find({side.second, side.first}); other != sides_.end())
                    sides_.erase(other);
                else
                    sides_.insert(side);
            }
        }
    }
    // Each with the holes in it, to which it goes and returns along one line.
    std::vector<Points> regions() {
        std::vector<Points> outer, holes;
        while (!sides_.empty()) {
            Points loop;
            const int first = sides_.begin()->first;
            for (int here = first;;) {
                const auto side = sides_.lower_bound({here, -1});
                if (side == sides_.end() || side->first != here) break;
                loop.push_back(place(here));
                here = side->second;
                sides_.erase(side);
                if (here == first) break;
            }
            (area(loop) > 0 ? outer : holes).push_back(std::move(loop));
        }
        std::vector<Points> out = outer;
        for (const Points& hole : holes) {
            std::size_t best = outer.size();
            for (std::size_t i = 0; i < outer.size(); ++i)
                if (holds(outer[i], hole[0]) && (best == outer.size() || area(outer[i]) < area(outer[best])))
                    best = i;
            if (best == outer.size()) continue;
            Points& to = out[best];
            const Vec<2> gate = to[0];
            to.push_back(gate);
            to.insert(to.end(), hole.begin(), hole.end());
            to.push_back(hole[0]);
            to.push_back(gate);
        }
        return out;
    }

private:
    double value(int i) const { return values_[std::size_t(i)]; }
    // Vertices are those of the grid, then crossings of its sides with levels.
    int crossing(int a, int b, int level) {
        const auto key = std::tuple(std::min(a, b), std::max(a, b), level);
        const auto [found, fresh] = crossings_.try_emplace(key, int(at_.size() + places_.size()));
        if (fresh) {
            const auto [p, q, l] = key;
            const double t = (l - value(p)) / (value(q) - value(p));
            places_.push_back(at_[std::size_t(p)] + t * (at_[std::size_t(q)] - at_[std::size_t(p)]));
        }
        return found->second;
    }
    Vec<2> place(int i) const {
        return std::size_t(i) < at_.size() ? at_[std::size_t(i)] : places_[std::size_t(i) - at_.size()];
    }
    // The part of the side from a on that is in the band, without its end.
    void add_side(std::vector<int>& part, int a, int b, int level) {
        const double f = value(a), g = value(b);
        const auto in = [&](double x) { return x >= level && x < level + 1; };
        if (in(f)) part.push_back(a);
        const auto cut = [&](int l) {
            if ((f < l) != (g < l)) part.push_back(crossing(a, b, l));
        };
        cut(f < g ? level : level + 1);
        cut(f < g ? level + 1 : level);
    }
    static double area(const Points& p) {
        double sum = 0;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec<2>&a = p[i], &b = p[(i + 1) % p.size()];
            sum += a[0] * b[1] - a[1] * b[0];
        }
        return sum / 2;
    }
    static bool holds(const Points& p, const Vec<2>& q) {
        bool odd = false;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec<2>&a = p[i], &b = p[(i + 1) % p.size()];
            if ((a[1] > q[1]) != (b[1] > q[1]))
                odd ^= q[0] < a[0] + (q[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
        }
        return odd;
    }

    const std::vector<Vec<2>>& at_;
    const std::vector<double>& values_;
    std::vector<Vec<2>> places_;
    std::map<std::tuple<int, int, int>, int> crossings_;
    std::set<std::pair<int, int>> sides_;
};

}  // namespace

Plot& stripes(Plot& plot, const Surface3& s, const Eye& eye, const Vec<3>& light, double degrees,
              const Colour& colour) {
    std::vector<Vec<2>> at;
    std::vector<double> angle;
    const auto [u, v] = s.domain();
    for (int i = 0; i <= kCells; ++i)
        for (int j = 0; j <= kCells; ++j) {
            const auto jet = s.jet<1>({u.lo + u.length() * i / kCells, v.lo + v.length() * j / kCells});
            const Vec<3> normal = unit(cross(jet(1, 0), jet(0, 1)));
            at.push_back(eye(jet.value()));
            angle.push_back(std::acos(std::clamp(dot(normal, unit(light)), -1.0, 1.0)) * 180 /
                            std::numbers::pi / degrees);
        }
    Bands bands(at, angle);
    for (int i = 0; i < kCells; ++i)
        for (int j = 0; j < kCells; ++j) {
            const int a = i * (kCells + 1) + j, b = a + kCells + 1;
            // Counter-clockwise in the picture or all clockwise: the sign of the areas tells loops from
            // holes, so it is made the same everywhere.
            for (std::array<int, 3> t : {std::array{a, b, b + 1}, std::array{a, b + 1, a + 1}}) {
                const Vec<2> p = at[std::size_t(t[0])], q = at[std::size_t(t[1])] - p,
                             r = at[std::size_t(t[2])] - p;
                if (q[0] * r[1] - q[1] * r[0] < 0) std::swap(t[1], t[2]);
                bands.add(t);
            }
        }
    DrawnGroup g{"", "stripes", colour, 0, {}, {}, {}};
    for (const Points& region : bands.regions()) {
        g.paths.push_back(line_through(region, true));
        g.paths.back().solid = true;
    }
    plot.panel.groups.push_back(std::move(g));
    return plot;
}

}  // namespace freiform::cli::gallery
