// Extrusions: a plane profile along a line, with its ends cut across or along other planes, open or capped.
//
// In the frame X, Y, T of the path a point (x, y) of the profile is, at an end P with the normal n of its
// plane (local, T without one), P + x X + y Y - (n_x x + n_y y) / n_z T. Every piece of the profile, whose
// pieces do not go on smoothly in general, is a wall of its own.
#include "rhino_geometry.hpp"

#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::rhino {

namespace {

// Twice the area, of the polygon through some places of each piece: for its sign.
double area_of(const CurveInSpace& c) {
    double area = 0;
    Vec<3> last = c.end(false);
    for (const Piece& p : c.pieces)
        for (int i = 1; i <= 64; ++i) {
            const Vec<3> x = jet<0>(p.shape, p.on.lo + p.on.length() * i / 64).value();
            area += last[0] * x[1] - last[1] * x[0];
            last = x;
        }
    return area;
}

// Splines are cut at their corners.
Result<CurveInSpace> smooth_pieces(const CurveInSpace& c) {
    CurveInSpace out;
    for (const Piece& p : c.pieces) {
        std::vector<double> corners;
        visit_one(
            [&](const auto& g) {
                if constexpr (requires { g.net(); })
                    for (const double t : g.basis().breaks())
                        if (p.on.lo < t && t < p.on.hi && g.basis().multiplicity(t) >= g.basis().degree())
                            corners.push_back(t);
            },
            p.shape);
        if (corners.empty()) {
            out.pieces.push_back(p);
            continue;
        }
        corners.push_back(p.on.hi);
        double from = p.on.lo;
        for (const double t : corners) {
            const CurveInSpace own{{{p.shape, p.on, p.on}}};
            auto part = part_of(own, {from, t});
            if (!part) return part;
            out.pieces.insert(out.pieces.end(), part->pieces.begin(), part->pieces.end());
            from = t;
        }
    }
    return out;
}

struct End {
    Vec<3> at{};
    std::array<Vec<3>, 3> axes;  // images of x, y and nothing
    Vec<3> normal{};
};

class ExtrusionMaker {
public:
    ExtrusionMaker(const std::array<End, 2>& ends, const Vec<3>& along) : ends_(ends), along_(along) {}

    // Walls around one profile; its edges at both ends for the caps.
    Result<void> add(const CurveInSpace& profile, bool closed) {
        const auto pieces = smooth_pieces(profile);
        if (!pieces) return std::unexpected(pieces.error());
        const int n = int(pieces->pieces.size()), corners = closed ? n : n + 1;
        const int vertex = int(b.vertices.size()), edge = int(b.edges.size());
        for (int i = 0; i < corners; ++i)
            for (const End& e : ends_) {
                const CurveInSpace& p = *pieces;
                const Vec<3> x = i < n ? p.pieces[std::size_t(i)].end(false) : p.end(true);
                b.vertices.push_back(e.at + x[0] * e.axes[0] + x[1] * e.axes[1]);
            }
        const auto at = [&](int i, int end) { return vertex + 2 * (i % corners) + end; };
        const auto add_edge = [&](CurveInSpace c, int from, int to) {
            b.curves.push_back(std::move(c));
            b.edges.push_back({{int(b.curves.size()) - 1, {}, false}, {from, to}});
        };
        // Of piece i: below at 2 i, above at 2 i + 1; then the edges along the path.
        std::vector<CurveInSpace> below;
        for (int i = 0; i < n; ++i)
            for (int end = 0; end < 2; ++end) {
                const End& e = ends_[std::size_t(end)];
                CurveInSpace c = mapped(CurveInSpace{{pieces->pieces[std::size_t(i)]}}, {e.at, e.axes});
                if (end == 0) below.push_back(c);
                add_edge(std::move(c), at(i, end), at(i + 1, end));
            }
        for (int i = 0; i < corners; ++i)
            add_edge(segment(b.vertices[std::size_t(at(i, 0))], b.vertices[std::size_t(at(i, 1))]), at(i, 0),
                     at(i, 1));
        std::array<LoopOf, 2> around;
        for (int i = 0; i < n; ++i) {
            const int low = edge + 2 * i, right = edge + 2 * n + (i + 1) % corners, left = edge + 2 * n + i;
            b.surfaces.emplace_back(Swept{below[std::size_t(i)], along_, false});
            b.faces.push_back({int(b.surfaces.size()) - 1,
                               false,
                               {{{{low, false}, {right, false}, {low + 1, true}, {left, true}}}}});
            for (int end = 0; end < 2; ++end) around[std::size_t(end)].trims.push_back({low + end, false});
        }
        for (std::size_t end = 0; end < 2; ++end) rims[end].push_back(std::move(around[end]));
        return {};
    }

    void cap(std::size_t end) {
        const End& e = ends_[end];
        const Vec<3> x = e.axes[0], y = cross(e.normal, x);
        b.surfaces.emplace_back(PlaneInSpace{e.at, x, y, {}});
        b.faces.push_back({int(b.surfaces.size()) - 1, end == 0, rims[end]});
    }

    BrepOf b;
    std::array<std::vector<LoopOf>, 2> rims;

private:
    std::array<End, 2> ends_;
    Vec<3> along_;
};

}  // namespace

Result<BrepOf> read_extrusion(StoredObject o) {
    Bytes& outer = o.data;
    Bytes b = outer.chunk().body;
    b.skip(4);
    const int minor = b.i32();
    auto object = object_in(b);
    if (!object) return std::unexpected(object.error());
    const auto profile = read_curve(*object);
    if (!profile) return std::unexpected(profile.error());
    // A row of profiles that do not go on into each other stands as one curve, too.
    std::vector<CurveInSpace> profiles{*profile};
    const Vec<3> from = b.point(), to = b.point();
    const Interval part = b.interval();
    const Vec<3> up = b.point();
    const std::array<bool, 2> is_cut{b.u8() != 0, b.u8() != 0};
    const std::array<Vec<3>, 2> cut{b.point(), b.point()};
    b.interval();
    const bool transposed = b.u8() != 0;
    const int count = minor >= 1 ? b.i32() : 1;
    std::array<bool, 2> capped{true, true};
    if (minor >= 2) capped = {b.u8() != 0, b.u8() != 0};
    if (b.failed() || outer.failed()) return ends_early(b, "an extrusion");
    constexpr int kKnownMinor = 3;        // what newer programs write behind may have chunks
    if (minor == kKnownMinor) b.chunk();  // triangles
    if (minor <= kKnownMinor)
        if (auto ok = b.check_sum(); !ok) return std::unexpected(ok.error());
    if (count > 1) {
        if (object->of.kind != Kind::poly_curve)
            return refuse(RefusalKind::invalid, text("byte ", b.at()),
                          text("an extrusion of ", count, " profiles has ", object->of.name));
        profiles.clear();
        Bytes row = object->data;
        int of = 0;
        row.version(of);
        if (row.count(8) != count)
            return refuse(RefusalKind::invalid, text("byte ", b.at()),
                          text("an extrusion of ", count, " profiles has another number of them"));
        row.skip(2 * 4 + 6 * 8);
        row.skip(8 * std::size_t(row.count(8)));
        for (int i = 0; i < count; ++i) {
            auto one = object_in(row);
            if (!one) return std::unexpected(one.error());
            auto c = read_curve(*one);
            if (!c) return std::unexpected(c.error());
            profiles.push_back(std::move(*c));
        }
    }
    const Vec<3> path = to - from, t = (1 / norm(path)) * path;
    const Vec<3> flat = up - dot(up, t) * t, y = (1 / norm(flat)) * flat, x = cross(y, t);
    if (!is_finite(t) || !is_finite(y) || !(part.lo < part.hi))
        return refuse(RefusalKind::invalid, text("byte ", b.at()),
                      "an extrusion without a path, or without an up");
    std::array<End, 2> ends;
    for (std::size_t i = 0; i < 2; ++i) {
        End& e = ends[i];
        e.at = from + (i == 0 ? part.lo : part.hi) * path;
        const Vec<3>& n = cut[i];
        const bool slanted = is_cut[i] && n[2] > 0;
        e.axes = {x, y, Vec<3>{}};
        e.normal = t;
        if (slanted) {
            e.axes = {x - (n[0] / n[2]) * t, y - (n[1] / n[2]) * t, Vec<3>{}};
            e.normal = n[0] * x + n[1] * y + n[2] * t;
        }
    }
    ExtrusionMaker maker(ends, path);
    bool closed = true;
    for (std::size_t i = 0; i < profiles.size(); ++i) {
        CurveInSpace& p = profiles[i];
        // The outer one runs counter-clockwise, holes run clockwise.
        const bool is_closed = closes(p);
        if (is_closed && (area_of(p) < 0) == (i == 0)) p = backwards(p);
        closed = closed && is_closed;
        if (auto ok = maker.add(p, is_closed); !ok) return std::unexpected(ok.error());
    }
    if (closed)
        for (std::size_t end = 0; end < 2; ++end)
            if (capped[end]) maker.cap(end);
    // Walls that are half of nothing may have been turned.
    if (transposed && !(closed && capped[0] && capped[1]))
        for (FaceOf& f : maker.b.faces) f.reversed = !f.reversed;
    return std::move(maker.b);
}

}  // namespace freiform::rhino
