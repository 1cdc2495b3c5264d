// Gradient meshes.
//
// Pictures. A grid of cells is so fine that its chords are within a tenth of a pixel of the surface (by
// second differences of control points) and mixing colours within cells does not show. Corners are rounded to
// 2^-8 of a sample once, and whether a sample is in a triangle is then decided in whole numbers; of a sample
// on an edge the triangle is the one that is to its right or above it, so that each belongs to exactly one of
// two neighbours.
//
// References: the PDF specification, shadings of types 6 and 7.
#include <freiform/colour/mesh_gradient.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace freiform {

namespace {

Vec<4> coefficient(const Colour& c, ColourSpace space) {
    const Vec<3> x = coordinates(c, space);
    return {{x[0], x[1], x[2], c.a}};
}

// Of oklch: each hue the turn nearest to that of the one before in its row, rows to the row before.
void unwind(std::vector<Vec<4>>& net, int columns) {
    for (std::size_t i = 1; i < net.size(); ++i) {
        const double before = net[i % std::size_t(columns) ? i - 1 : i - std::size_t(columns)][2];
        net[i][2] = before + std::remainder(net[i][2] - before, kTwoPi);
    }
}

Result<Surface<Vec<4>>> colour_surface(const std::array<BSplineBasis, 2>& bases,
                                       std::span<const Colour> colours, ColourSpace space) {
    std::vector<Vec<4>> net;
    for (std::size_t i = 0; i < colours.size(); ++i) {
        const Colour& c = colours[i];
        for (const double x : {c.r, c.g, c.b, c.a})
            if (!(x >= 0 && x <= 1))
                return refuse(RefusalKind::invalid, text("colours[", i, "]"),
                              text("a component is ", x, ", not between 0 and 1"));
        net.push_back(coefficient(c, space));
    }
    if (space == ColourSpace::oklch) unwind(net, bases[1].size());
    return Surface<Vec<4>>::make(bases, Net<2, Vec<4>>({bases[0].size(), bases[1].size()}, std::move(net)));
}

// Breaks of both, each interval in n parts.
std::vector<double> divided(const BSplineBasis& a, const BSplineBasis& b, int n) {
    std::vector<double> breaks = a.breaks(), out;
    const std::vector<double> more = b.breaks();
    breaks.insert(breaks.end(), more.begin(), more.end());
    sort(breaks);
    breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
        for (int k = 0; k < n; ++k) out.push_back(breaks[i] + (breaks[i + 1] - breaks[i]) * k / n);
    out.push_back(breaks.back());
    return out;
}

double largest_difference(const Colour& a, const Colour& b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b), std::abs(a.a - b.a)});
}
Colour mean(const Colour& a, const Colour& b) {
    return {(a.r + b.r) / 2, (a.g + b.g) / 2, (a.b + b.b) / 2, (a.a + b.a) / 2};
}

}  // namespace

Result<MeshGradient> MeshGradient::make(const Surface<Vec<2>>& surface, std::span<const Colour> colours,
                                        ColourSpace space) {
    if (colours.size() != surface.net().flat().size())
        return refuse(RefusalKind::invalid, "colours",
                      text(colours.size(), " for ", surface.net().flat().size(), " control points"));
    auto c = colour_surface(surface.bases(), colours, space);
    if (!c) return std::unexpected(c.error());
    return MeshGradient(surface, *std::move(c), space);
}

Result<MeshGradient> MeshGradient::tensor(std::span<const Vec<2>, 16> p, std::span<const Colour, 4> corners,
                                          ColourSpace space) {
    static constexpr std::size_t kOrder[16] = {0, 1, 2, 3, 11, 12, 13, 4, 10, 15, 14, 5, 9, 8, 7, 6};
    std::vector<Vec<2>> net;
    for (const std::size_t i : kOrder) net.push_back(p[i]);
    auto surface = Surface<Vec<2>>::make({*BSplineBasis::bezier(3), *BSplineBasis::bezier(3)},
                                         Net<2, Vec<2>>({4, 4}, std::move(net)));
    if (!surface) return std::unexpected(surface.error());
    const std::array<Colour, 4> ordered = {corners[0], corners[1], corners[3], corners[2]};
    auto c = colour_surface({*BSplineBasis::bezier(1), *BSplineBasis::bezier(1)}, ordered, space);
    if (!c) return std::unexpected(c.error());
    return MeshGradient(*std::move(surface), *std::move(c), space);
}

Result<MeshGradient> MeshGradient::coons(std::span<const Vec<2>, 12> b, std::span<const Colour, 4> corners,
                                         ColourSpace space) {
    std::array<Vec<2>, 16> p;
    std::ranges::copy(b, p.begin());
    // The inner point beside the corner b[i]; its neighbours, the corners next to it, the far thirds of the
    // opposite sides, the opposite corner.
    for (std::size_t k = 0; k < 4; ++k) {
        const auto at = [&](std::size_t step) { return b[(3 * k + step) % 12]; };
        p[12 + k] = (1.0 / 9) * (-4.0 * at(0) + 6.0 * (at(1) + at(11)) - 2.0 * (at(3) + at(9)) +
                                 3.0 * (at(4) + at(8)) - at(6));
    }
    return tensor(p, corners, space);
}

Box<2> MeshGradient::box() const {
    Box<2> box;
    for (const Vec<2>& p : surface_.net().flat()) box.add(p);
    return box;
}

Colour MeshGradient::colour(double u, double v) const {
    const Vec<4> x = colours_(u, v);
    return colour_at({{x[0], x[1], x[2]}}, x[3], space_);
}

MeshGradient::Grid MeshGradient::grid(int cells) const {
    const std::vector<double> us = divided(surface_.basis(0), colours_.basis(0), cells),
                              vs = divided(surface_.basis(1), colours_.basis(1), cells);
    Grid out{int(us.size()), int(vs.size()), {}, {}};
    for (const double u : us)
        for (const double v : vs) out.points.push_back(surface_(u, v)), out.colours.push_back(colour(u, v));
    return out;
}

int MeshGradient::cells_for(double tolerance, Mixing mixing) const {
    for (int n = 1; n < 256; n *= 2) {
        const Grid g = grid(2 * n);
        const auto at = [&](int i, int j) {
            return g.colours[std::size_t(i) * std::size_t(g.columns) + std::size_t(j)];
        };
        double off = 0;
        for (int i = 0; i + 2 < g.rows; i += 2)
            for (int j = 0; j + 2 < g.columns; j += 2) {
                const Colour a = mean(at(i, j), at(i + 2, j)), b = mean(at(i, j + 2), at(i + 2, j + 2)),
                             c = mean(at(i, j), at(i, j + 2)), d = mean(at(i + 2, j), at(i + 2, j + 2));
                const Colour middle =
                    mixing == Mixing::triangles ? mean(at(i, j), at(i + 2, j + 2)) : mean(a, b);
                off =
                    std::max({off, largest_difference(middle, at(i + 1, j + 1)),
                              largest_difference(a, at(i + 1, j)), largest_difference(b, at(i + 1, j + 2)),
                              largest_difference(c, at(i, j + 1)), largest_difference(d, at(i + 2, j + 1))});
            }
        if (off <= tolerance) return n;
    }
    return 256;
}

Result<std::vector<MeshGradient::Piece>> MeshGradient::pieces(int cells) const {
    for (int axis = 0; axis < 2; ++axis)
        if (surface_.basis(axis).degree() > 3)
            return refuse(RefusalKind::unsupported, "surface",
                          text("its degree is ", surface_.basis(axis).degree(), "; pieces are bicubic"));
    const std::vector<double> us = divided(surface_.basis(0), colours_.basis(0), cells),
                              vs = divided(surface_.basis(1), colours_.basis(1), cells);
    std::vector<Piece> out;
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
        const auto row = restrict_to(surface_, 0, {us[i], us[i + 1]});
        if (!row) return std::unexpected(row.error());
        for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
            const auto cell = restrict_to(*row, 1, {vs[j], vs[j + 1]});
            if (!cell) return std::unexpected(cell.error());
            auto raised = elevate(*cell, 0, 3 - cell->basis(0).degree());
            if (raised) raised = elevate(*raised, 1, 3 - raised->basis(1).degree());
            if (!raised) return std::unexpected(raised.error());
            Piece p;
            const auto net = raised->net().flat();
            for (std::size_t a = 0; a < 4; ++a)
                for (std::size_t b = 0; b < 4; ++b) p.net[a][b] = net[4 * a + b];
            for (std::size_t a = 0; a < 2; ++a)
                for (std::size_t b = 0; b < 2; ++b) p.corner[a][b] = colour(us[i + a], vs[j + b]);
            out.push_back(p);
        }
    }
    return out;
}

namespace {

constexpr int kAcross = 4;  // samples of a pixel in each direction
constexpr std::int64_t kSteps = 256;

struct Corner2 {
    std::int64_t x = 0, y = 0;  // in steps of samples, y up
    Colour colour;
};

// Of one band of rows of samples.
class Band {
public:
    Band(int width, int from, int to, const Colour& ground) : width_(width), from_(from), to_(to) {
        samples_.assign(std::size_t(width) * std::size_t(to - from), ground);
    }
    void paint(Corner2 a, Corner2 b, Corner2 c) {
        std::int64_t twice = cross(a, b, c);
        if (twice == 0) return;
        if (twice < 0) std::swap(b, c), twice = -twice;
        const auto [x_lo, x_hi] = std::minmax({a.x, b.x, c.x});
        const auto [y_lo, y_hi] = std::minmax({a.y, b.y, c.y});
        const auto first = [](std::int64_t v, std::int64_t least) { return std::max(least, v / kSteps - 1); };
        const std::int64_t i_end = std::min<std::int64_t>(width_, x_hi / kSteps + 2),
                           j_end = std::min<std::int64_t>(to_, y_hi / kSteps + 2);
        for (std::int64_t j = first(y_lo, from_); j < j_end; ++j)
            for (std::int64_t i = first(x_lo, 0); i < i_end; ++i) {
                const Corner2 s{i * kSteps + kSteps / 2, j * kSteps + kSteps / 2, {}};
                const std::int64_t wa = cross(b, c, s), wb = cross(c, a, s), wc = cross(a, b, s);
                if (wa < owned(b, c) || wb < owned(c, a) || wc < owned(a, b)) continue;
                const double p = double(wa) / double(twice), q = double(wb) / double(twice), r = 1 - p - q;
                const auto mix = [&](double Colour::*m) {
                    return p * a.colour.*m + q * b.colour.*m + r * c.colour.*m;
                };
                const double o = mix(&Colour::a);
                Colour& at = samples_[std::size_t(j - from_) * std::size_t(width_) + std::size_t(i)];
                for (double Colour::*m : {&Colour::r, &Colour::g, &Colour::b})
                    at.*m = o * mix(m) + (1 - o) * at.*m;
            }
    }
    // The mean of the samples of a pixel.
    Colour pixel(int x, int row) const {
        Colour sum{0, 0, 0, 1};
        for (int j = 0; j < kAcross; ++j)
            for (int i = 0; i < kAcross; ++i) {
                const Colour& c = samples_[std::size_t(row * kAcross + j) * std::size_t(width_) +
                                           std::size_t(x * kAcross + i)];
                sum.r += c.r, sum.g += c.g, sum.b += c.b;
            }
        const double n = kAcross * kAcross;
        return {sum.r / n, sum.g / n, sum.b / n, 1};
    }

private:
    static std::int64_t cross(const Corner2& a, const Corner2& b, const Corner2& c) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    }
    // Of a point on the edge from a to b, counter-clockwise: does it belong to this side? 0 if so, else 1.
    static std::int64_t owned(const Corner2& a, const Corner2& b) {
        return b.y < a.y || (b.y == a.y && b.x > a.x) ? 0 : 1;
    }
    int width_, from_, to_;
    std::vector<Colour> samples_;
};

// Cells so that chords are within a tenth of a pixel.
int cells_of_chords(const Surface<Vec<2>>& s, double pixels) {
    const BezierPieces<2, Vec<2>> pieces(s);
    double bend = 0;
    for (int i = 0; i < pieces.extent()[0]; ++i)
        for (int j = 0; j < pieces.extent()[1]; ++j) {
            const auto net = pieces.net({i, j});
            const int p = pieces.degree(0), q = pieces.degree(1);
            for (int a = 0; a <= p; ++a)
                for (int b = 0; b <= q; ++b) {
                    if (a + 2 <= p)
                        bend = std::max(
                            bend, p * (p - 1) * norm(net({a + 2, b}) - 2.0 * net({a + 1, b}) + net({a, b})));
                    if (b + 2 <= q)
                        bend = std::max(
                            bend, q * (q - 1) * norm(net({a, b + 2}) - 2.0 * net({a, b + 1}) + net({a, b})));
                    if (a < p && b < q)
                        bend = std::max(bend, p * q *
                                                  norm(net({a + 1, b + 1}) - net({a + 1, b}) -
                                                       net({a, b + 1}) + net({a, b})));
                }
        }
    return int(std::clamp(std::ceil(std::sqrt(bend * pixels / 8 * 4 / 0.1)), 1.0, 256.0));
}

}  // namespace

Result<Image> picture_of(std::span<const MeshGradient> meshes, const Box<2>& box, int width,
                         const Colour& ground) {
    FF_REQUIRE(width >= 1 && width <= 16384);
    const Vec<2> size = box.hi - box.lo;
    if (!(size[0] > 0 && size[1] > 0 && is_finite(size)))
        return refuse(RefusalKind::invalid, "box", "it has no area");
    const double scale = width / size[0], rows = std::ceil(size[1] * scale - 1e-9);
    if (!(rows * width <= double(1 << 26)))
        return refuse(RefusalKind::limit, "width",
                      text("the picture would have ", rows, " rows of ", width, " pixels"));
    Image out{width, std::max(1, int(rows)), {}};
    out.rgb.resize(3 * std::size_t(out.width) * std::size_t(out.height));
    std::vector<MeshGradient::Grid> grids;
    for (const MeshGradient& m : meshes)
        grids.push_back(m.grid(std::max(cells_of_chords(m.surface(), scale),
                                        m.cells_for(1.0 / 512, MeshGradient::Mixing::triangles))));
    const double steps = scale * kAcross * double(kSteps), far = 1e8;  // products stay below 2^63
    constexpr int kRows = 32;
    for (int from = 0; from < out.height; from += kRows) {
        const int to = std::min(from + kRows, out.height);
        Band band(out.width * kAcross, from * kAcross, to * kAcross, ground);
        for (const auto& g : grids) {
            const auto corner = [&](int i, int j) {
                const std::size_t k = std::size_t(i) * std::size_t(g.columns) + std::size_t(j);
                const Vec<2> p = steps * (g.points[k] - box.lo);
                return Corner2{std::llround(std::clamp(p[0], -far, far)),
                               std::llround(std::clamp(p[1], -far, far)), g.colours[k]};
            };
            for (int i = 0; i + 1 < g.rows; ++i)
                for (int j = 0; j + 1 < g.columns; ++j) {
                    const Corner2 a = corner(i, j), b = corner(i, j + 1), c = corner(i + 1, j + 1),
                                  d = corner(i + 1, j);
                    const auto [lo, hi] = std::minmax({a.y, b.y, c.y, d.y});
                    if (hi / kSteps < from * kAcross - 1 || lo / kSteps > to * kAcross + 1) continue;
                    band.paint(a, b, c), band.paint(a, c, d);
                }
        }
        for (int row = from; row < to; ++row)
            for (int x = 0; x < out.width; ++x) {
                const Colour c = band.pixel(x, row - from);
                unsigned char* at = &out.rgb[3 * (std::size_t(out.height - 1 - row) * std::size_t(out.width) +
                                                  std::size_t(x))];
                at[0] = (unsigned char)std::lround(255 * c.r), at[1] = (unsigned char)std::lround(255 * c.g),
                at[2] = (unsigned char)std::lround(255 * c.b);
            }
    }
    return out;
}

}  // namespace freiform
