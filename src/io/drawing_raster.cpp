// A pixel is covered as far as its centre is inside the stroke or disc, over a ramp of one pixel. Of one path
// the largest coverage counts, so that joints and crossings are not darker; the next path is laid over it.
#include "io/drawing_detail.hpp"

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr std::size_t kMostPixels = std::size_t(1) << 26;
constexpr double kRasterChord = 0.05;  // pixels, of cubics and quadratics
constexpr int kMostChords = 4096;

class Canvas {
public:
    Canvas(int width, int height)
        : width_(width),
          height_(height),
          rgb_(3 * std::size_t(width) * std::size_t(height), 255),
          cover_(std::size_t(width) * std::size_t(height), 0) {}

    void stroke(const DrawnPath& path, double width, const Colour& colour) {
        Vec<2> from = path.start;
        for (const DrawnSegment& s : path.segments) {
            draw_segment(from, s, width / 2);
            from = s.points[std::size_t(s.degree - 1)];
        }
        if (path.closed) line(from, path.start, width / 2);
        flush(colour);
    }

    void disc(const DrawnDisc& d, double width, const Colour& colour) {
        line(d.centre, d.centre, d.radius + (d.hollow ? width / 2 : 0));
        flush(colour);
        if (!d.hollow) return;
        line(d.centre, d.centre, d.radius - width / 2);
        flush({1, 1, 1, 1});
    }

    std::vector<unsigned char> finish() && { return std::move(rgb_); }

private:
    void draw_segment(const Vec<2>& from, const DrawnSegment& s, double half) {
        std::array<Vec<2>, 4> b{from};
        std::copy(s.points.begin(), s.points.end(), b.begin() + 1);
        double bend = 0;  // |C''| <= degree (degree - 1) max |second difference|
        for (std::size_t i = 0; i + 2 <= std::size_t(s.degree); ++i)
            bend = std::max(bend, s.degree * (s.degree - 1) * norm(b[i] - 2 * b[i + 1] + b[i + 2]));
        const int n =
            std::max(1, int(std::min<double>(kMostChords, std::ceil(std::sqrt(bend / 8 / kRasterChord)))));
        Vec<2> a = from;
        for (int i = 1; i <= n; ++i) {
            std::array<Vec<2>, 4> c = b;
            const double t = double(i) / n;
            for (int r = s.degree; r > 0; --r)
                for (std::size_t k = 0; k < std::size_t(r); ++k) c[k] = (1 - t) * c[k] + t * c[k + 1];
            line(a, c[0], half);
            a = c[0];
        }
    }

    // Row by row, the part of the line that is near enough to the row.
    void line(const Vec<2>& a, const Vec<2>& b, double half) {
        if (!is_finite(a) || !is_finite(b)) return;
        const double reach = half + 0.5;
        const int first = row(std::min(a[1], b[1]) - reach, height_),
                  last = row(std::max(a[1], b[1]) + reach, height_);
        const Vec<2> d = b - a;
        const double dd = dot(d, d);
        for (int y = first; y <= last && y < height_; ++y) {
            double s = 0, t = 1;
            if (d[1] != 0) {
                const double lo = (y + 0.5 - reach - a[1]) / d[1], hi = (y + 0.5 + reach - a[1]) / d[1];
                s = std::clamp(std::min(lo, hi), 0.0, 1.0);
                t = std::clamp(std::max(lo, hi), 0.0, 1.0);
            }
            const double xs = a[0] + s * d[0], xt = a[0] + t * d[0];
            const int left = row(std::min(xs, xt) - reach, width_),
                      right = row(std::max(xs, xt) + reach, width_);
            for (int x = left; x <= right && x < width_; ++x) {
                const Vec<2> p = Vec<2>{{x + 0.5, y + 0.5}} - a;
                const double at = dd > 0 ? std::clamp(dot(p, d) / dd, 0.0, 1.0) : 0;
                cover(x, y, std::clamp(reach - norm(p - at * d), 0.0, 1.0));
            }
        }
    }

    static int row(double x, int count) { return int(std::clamp(std::floor(x), 0.0, double(count))); }

    void cover(int x, int y, double part) {
        const auto c = static_cast<unsigned char>(std::lround(255 * part));
        const std::size_t i = std::size_t(y) * std::size_t(width_) + std::size_t(x);
        if (c <= cover_[i]) return;
        if (cover_[i] == 0) touched_.push_back(i);
        cover_[i] = c;
    }

    void flush(const Colour& colour) {
        const std::array<double, 3> c{255 * colour.r, 255 * colour.g, 255 * colour.b};
        for (const std::size_t i : touched_) {
            const double part = cover_[i] / 255.0;
            for (std::size_t k = 0; k < 3; ++k) {
                unsigned char& byte = rgb_[3 * i + k];
                byte = static_cast<unsigned char>(std::lround(byte + part * (c[k] - byte)));
            }
            cover_[i] = 0;
        }
        touched_.clear();
    }

    int width_, height_;
    std::vector<unsigned char> rgb_, cover_;
    std::vector<std::size_t> touched_;
};

}  // namespace

Result<std::vector<unsigned char>> to_pixels(const Drawing& d) {
    const std::size_t pixels = std::size_t(std::max(0, d.width)) * std::size_t(std::max(0, d.height));
    if (pixels == 0 || pixels > kMostPixels)
        return refuse(
            RefusalKind::limit, "size",
            text(d.width, " x ", d.height, " pixels; from 1 to ", kMostPixels, " in all are drawn"));
    Canvas canvas(d.width, d.height);
    for (const DrawnGroup& g : d.groups) {
        for (const DrawnPath& path : g.paths) canvas.stroke(path, g.width, g.colour);
        for (const DrawnDisc& disc : g.discs) canvas.disc(disc, g.width, g.colour);
    }
    return std::move(canvas).finish();
}

}  // namespace freiform
