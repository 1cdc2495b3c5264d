// R33: what fonts store, and what becomes of it.
#include "gallery/gallery.hpp"
#include "gallery/regions.hpp"
#include "gallery/space.hpp"

#include <freiform/model/swept_solid.hpp>
#include <freiform/region/stroke.hpp>

namespace freiform::cli::gallery {

namespace {

// Points that the outline passes, and those that pull; quadratic outlines leave out passed points that halve
// the way between two that pull.
Plot& outline_points(Plot& plot, const Path& path) {
    Points passed, implied, pulling;
    for (const Subpath& s : path.subpaths)
        for (std::size_t i = 0; i < s.segments.size(); ++i) {
            const PathSegment& a = s.segments[i];
            const PathSegment& b = s.segments[(i + 1) % s.segments.size()];
            for (int k = 1; k < a.degree; ++k) {
                const Vec<2>& p = a.points[std::size_t(k)];
                pulling.push_back(p);
                if (k == 1) plot.lines({a.front(), p}, thin(kGrey));
                if (k + 1 == a.degree) plot.lines({p, a.back()}, thin(kGrey));
            }
            const bool between =
                a.degree == 2 && b.degree == 2 &&
                max_abs(0.5 * (a.points[1] + b.points[1]) - a.back()) <= 1e-9 * max_abs(a.back());
            (between ? implied : passed).push_back(a.back());
        }
    plot.dots(pulling, kOrange, 4, true, "control point");
    if (!implied.empty()) plot.dots(implied, kGreen, 3.5, false, "half-way, not stored");
    return plot.dots(passed, kInk, 4, false, "on the outline");
}

// Lines that a spline of higher degree stores as lines again.
Path with_lines(Path path) {
    for (Subpath& s : path.subpaths)
        for (PathSegment& p : s.segments) {
            const Vec<2> way = p.back() - p.front();
            bool straight = p.degree > 1;
            for (int k = 1; k < p.degree; ++k) {
                const Vec<2> at = p.points[std::size_t(k)] - p.front() - (double(k) / p.degree) * way;
                straight = straight && max_abs(at) <= 1e-9 * max_abs(way);
            }
            if (straight) p = {1, {p.front(), p.back()}, 1};
        }
    return path;
}

Path mixed_paths(const Path& a, const Path& b, double share) {
    Path out = a;
    for (std::size_t s = 0; s < a.subpaths.size(); ++s) {
        const Subpath& other = b.subpaths[s];
        out.subpaths[s].start = (1 - share) * a.subpaths[s].start + share * other.start;
        for (std::size_t i = 0; i < other.segments.size(); ++i)
            for (std::size_t k = 0; k < 4; ++k) {
                Vec<2>& p = out.subpaths[s].segments[i].points[k];
                p = (1 - share) * p + share * other.segments[i].points[k];
            }
    }
    return out;
}

Path moved(const Path& path, const Vec<2>& by) { return transformed(path, {{{{1, 0}, {0, 1}}}, by}); }

}  // namespace

Figure letters(const Document& d) {
    const Path light = path_in(d, {"D light", "D light hole"}), bold = path_in(d, {"D bold", "D bold hole"}),
               e = path_in(d, {"e", "e hole"});
    Plot quadratic("quadratic", "quadratic, as in TrueType fonts");
    outline_points(filled(quadratic, with_lines(light), kBlue), with_lines(light));
    Plot cubic("cubic", "cubic, as in CFF fonts");
    outline_points(filled(cubic, with_lines(e), kBlue), with_lines(e));
    Plot weights("weights", "a variable font: control points are mixed");
    const Colour shades[] = {kSky, kGreen, kOrange};
    for (int i = 0; i < 3; ++i)
        filled(weights, moved(mixed_paths(light, bold, i / 2.0), {{700.0 * i, 0}}), shades[i]);
    Plot strokes("strokes", "a letter as a stroke, and grown by a distance");
    StrokeStyle pen;
    pen.width = 14, pen.join = LineJoin::round;
    filled(strokes, sure(stroked(e, pen, {.tolerance = 0.01})).path, kPurple);
    for (const double distance : {22.0, 44.0})
        filled(strokes, sure(grown({moved(e, {{700, 0}})}, {.distance = distance}, {.tolerance = 0.01})).path,
               kGreen);
    filled(strokes, moved(e, {{700, 0}}), kInk);
    Path word = bold;
    for (const Subpath& s : moved(e, {{690, 0}}).subpaths) word.subpaths.push_back(s);
    Plot solid("solid", "a word as watertight solids");
    const Model lifted = sure(prism(loops_of(with_lines(word)), {{0, 0, 160}}));
    together(solid, {{lifted, {kBlue, 1.6, "", {}}}}, eye_at(-104, 62));
    return page("Letters as curves, regions and solids",
                {quadratic.panel, cubic.panel, weights.panel, strokes.panel, solid.panel}, 3, 1280, 860);
}

}  // namespace freiform::cli::gallery
