// A model as buffers of texels. The layout is in docs/gpu.md.
//
// Idea. A face is rational Bezier pieces, so the card can evaluate it wherever it likes. How finely it has to
// be is decided per picture, by one number: with `density` pixels of a unit divided by the allowed pixels, a
// piece takes ceil(sqrt(bend density)) cells in each direction (surface_bends.cpp).
//
// Accuracy. Coefficients are floats about a point of the face, so that positions are within some 2^-21 of its
// size (the sum of tens of products of relative error 2^-24) and the pieces of a face agree on their common
// sides to the bit. Derivatives are differences of coefficients: the direction of a normal is off by about
// 2^-22 times the degree times the size of the face in sizes of the piece.
//
// Why not coefficients about each piece: the sum with its
// point would be rounded differently on both sides of a boundary.
#include "gpu/outward_detail.hpp"
#include "gpu/surface_bends_detail.hpp"
#include "gpu/surface_seams_detail.hpp"
#include "gpu/trim_curves_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/gpu/surfaces.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr std::size_t kMostTexels = std::size_t(1) << 24;  // their numbers are floats
constexpr int kMostSamples = 32;                           // of a piece in each direction, to find the extent

struct BuiltPiece {
    int first = 0, face = 0;
    Index<2> degree{};
    std::array<ParameterMap, 2> map;
    bool trimmed = false;
    double distance = 0;
    std::array<double, 2> bend{};  // model units
};

struct BuiltFace {
    Vec<3> centre{};
    bool reversed = false;
    int outward = 0;  // as outward_sides() has it
    Colour colour;
    SurfacePieces pieces;
    TrimCurves trim;
};

// Does a curve of the loops come into the part of the box that a piece covers?
enum class PieceCover { outside, crossed, inside };
PieceCover cover_of(const TrimCurves& trim, const Box<2>& part) {
    constexpr double kBeside = 0x1p-20;
    if (trim.curves.empty()) return PieceCover::inside;
    for (const MonotoneCurve& c : trim.curves)
        if (c.box.lo[0] <= part.hi[0] + kBeside && c.box.hi[0] >= part.lo[0] - kBeside &&
            c.box.lo[1] <= part.hi[1] + kBeside && c.box.hi[1] >= part.lo[1] - kBeside)
            return PieceCover::crossed;
    return is_inside(trim, 0.5 * (part.lo + part.hi)) ? PieceCover::inside : PieceCover::outside;
}

class BufferBuilder {
public:
    BufferBuilder(const Model& model, std::span<const TriangularFace> triangles,
                  const SurfaceBufferOptions& options)
        : model_(model),
          triangles_(triangles),
          options_(options),
          body_colour_(model.faces.size(), options.colour) {}

    Result<SurfaceBuffers> run();

private:
    Result<void> add_face(std::size_t index);
    void add_extent(const Face& face, const BuiltFace& built, const std::vector<BuiltPiece>& own);
    void add_triangle(const TriangularFace& triangle);
    void find_outward();
    void place();
    std::array<float, 4> texel(const Hom<3>& h, const Vec<3>& centre, double heaviest) const;
    void write_coefficients();
    void write_trim(BuiltFace& face, std::array<float, 4>& record);
    void write_records();
    void write_seams();
    Vec<3> scene(const Vec<3>& p) const { return (1 / out_.size) * (p - out_.middle); }
    std::array<float, 3> floats(const Vec<3>& p) const { return {float(p[0]), float(p[1]), float(p[2])}; }

    const Model& model_;
    std::span<const TriangularFace> triangles_;
    const SurfaceBufferOptions& options_;
    std::vector<Colour> body_colour_;
    std::vector<BuiltFace> faces_;
    std::vector<BuiltPiece> pieces_;
    std::vector<std::vector<Hom<3>>> triangle_nets_;
    std::vector<EdgeSeam> seams_;
    std::vector<FacePoint> points_;
    SurfaceBuffers out_;
};

// Points from which the surface is seen to reach as far as it does, within the tolerance of edges.
void BufferBuilder::add_extent(const Face& face, const BuiltFace& built, const std::vector<BuiltPiece>& own) {
    for (const BuiltPiece& p : own) {
        std::array<int, 2> n{};
        for (const std::size_t d : {std::size_t(0), std::size_t(1)})
            n[d] = int(std::clamp(std::ceil(std::sqrt(p.bend[d] / options_.edge_tolerance)), 1.0,
                                  double(kMostSamples)));
        for (int i = 0; i <= n[0]; ++i)
            for (int j = 0; j <= n[1]; ++j) {
                const Vec<2> uv{{p.map[0](double(i) / n[0]), p.map[1](double(j) / n[1])}};
                if (p.trimmed) {
                    Vec<2> q;
                    for (int k = 0; k < 2; ++k)
                        q[k] = (uv[k] - built.trim.box.lo[k]) / (built.trim.box.hi[k] - built.trim.box.lo[k]);
                    if (!is_inside(built.trim, q)) continue;
                }
                const Vec<3> at = jet<0>(face.surface, uv.c).value();
                out_.extent.push_back(at);
                points_.push_back({p.face, at, nullptr, uv});
            }
    }
}

Result<void> BufferBuilder::add_face(std::size_t index) {
    const Face& face = model_.faces[index];
    if (face.loops.empty()) return refuse(RefusalKind::unsupported, "loops", "the face has no boundary");
    auto trim = trim_curves(face, model_.edges);
    if (!trim) return std::unexpected(trim.error());
    auto pieces = rational_pieces(face.surface, {trim->box.side(0), trim->box.side(1)});
    if (!pieces) return std::unexpected(pieces.error());
    const std::size_t columns = pieces->u.size(), rows = pieces->v.size();
    const auto bends = bends_of(face, *pieces);
    for (const auto& side : bends)
        for (const double b : side)
            if (!std::isfinite(b))
                return refuse(RefusalKind::unsupported, "surface", "its second derivatives have no bound");
    std::vector<BuiltPiece> own;
    Box<3> box;
    for (std::size_t i = 0; i < columns; ++i)
        for (std::size_t j = 0; j < rows; ++j) {
            Box<2> part{{{pieces->u[i].on.lo, pieces->v[j].on.lo}},
                        {{pieces->u[i].on.hi, pieces->v[j].on.hi}}};
            for (int k = 0; k < 2; ++k) {
                const double from = trim->box.lo[k], by = trim->box.hi[k] - from;
                part.lo[k] = (part.lo[k] - from) / by, part.hi[k] = (part.hi[k] - from) / by;
            }
            const PieceCover cover = cover_of(*trim, part);
            if (cover == PieceCover::outside) continue;
            own.push_back({int(i * rows + j),
                           int(index),
                           pieces->degree,
                           {pieces->u[i], pieces->v[j]},
                           cover == PieceCover::crossed,
                           pieces->distance,
                           {bends[0][i], bends[1][j]}});
            for (const Hom<3>& h : pieces->nets[i * rows + j].flat()) box.add(project(h));
        }
    faces_.push_back({0.5 * (box.lo + box.hi), face.reversed, 0, face.colour.value_or(body_colour_[index]),
                      std::move(*pieces), std::move(*trim)});
    add_extent(face, faces_.back(), own);
    pieces_.insert(pieces_.end(), own.begin(), own.end());
    return {};
}

void BufferBuilder::add_triangle(const TriangularFace& triangle) {
    const int n = triangle.patch.degree();
    const auto net = triangle.patch.coefficients();
    Box<3> box;
    for (const Hom<3>& h : net) box.add(project(h));
    const double bend = bend_of(triangle.patch);
    pieces_.push_back({int(triangle_nets_.size()), int(faces_.size()), {n, -1}, {}, false, 0, {bend, bend}});
    faces_.push_back({0.5 * (box.lo + box.hi), false, 0, triangle.colour.value_or(options_.colour), {}, {}});
    triangle_nets_.emplace_back(net.begin(), net.end());
    for (EdgeSeam& s : seams_of(triangle.patch, int(faces_.size()) - 1, options_.edge_tolerance))
        seams_.push_back(std::move(s));
    for (int i = 0; i <= kMostSamples / 2; ++i)
        for (int j = 0; i + j <= kMostSamples / 2; ++j)
            out_.extent.push_back(triangle.patch(2.0 * i / kMostSamples, 2.0 * j / kMostSamples));
}

// REQUIRES that faces_ are those of the model.
void BufferBuilder::find_outward() {
    for (const EdgeSeam& s : seams_)
        for (std::size_t i = 0; i < s.points.size(); ++i)
            points_.push_back({s.face, s.points[i], &s.normals[i], {}});
    const std::vector<int> sides = outward_sides(model_, points_);
    for (std::size_t f = 0; f < sides.size(); ++f) faces_[f].outward = sides[f];
}

// The middle and the size of the scene.
void BufferBuilder::place() {
    for (const EdgeSeam& s : seams_) out_.extent.insert(out_.extent.end(), s.points.begin(), s.points.end());
    Box<3> box;
    for (const Vec<3>& p : out_.extent) box.add(p);
    for (int d = 0; d < 3; ++d) out_.middle[d] = box.lo[d] / 2 + box.hi[d] / 2;
    Vec<3> half;
    for (int d = 0; d < 3; ++d) half[d] = box.hi[d] / 2 - box.lo[d] / 2;
    out_.size = max_abs(half) > 0 ? max_abs(half) : 1;
}

std::array<float, 4> BufferBuilder::texel(const Hom<3>& h, const Vec<3>& centre, double heaviest) const {
    const double w = h.weight() / heaviest;
    const Vec<3> p = w * (scene(project(h)) - centre);
    return {float(p[0]), float(p[1]), float(p[2]), float(w)};
}

void BufferBuilder::write_coefficients() {
    for (BuiltFace& f : faces_)  // as floats see it
        f.centre = [c = floats(scene(f.centre))] { return Vec<3>{{c[0], c[1], c[2]}}; }();
    std::vector<double> heaviest(faces_.size(), 0.0);
    const auto each = [&](const BuiltPiece& p) -> std::span<const Hom<3>> {
        if (p.degree[1] < 0) return triangle_nets_[std::size_t(p.first)];
        return faces_[std::size_t(p.face)].pieces.nets[std::size_t(p.first)].flat();
    };
    for (const BuiltPiece& p : pieces_)
        for (const Hom<3>& h : each(p))
            heaviest[std::size_t(p.face)] = std::max(heaviest[std::size_t(p.face)], h.weight());
    for (BuiltPiece& p : pieces_) {
        const auto net = each(p);
        p.first = int(out_.texels.size());
        for (const Hom<3>& h : net)
            out_.texels.push_back(
                texel(h, faces_[std::size_t(p.face)].centre, heaviest[std::size_t(p.face)]));
    }
}

void BufferBuilder::write_trim(BuiltFace& face, std::array<float, 4>& record) {
    if (face.trim.curves.empty()) return;
    std::vector<int> first;
    for (const MonotoneCurve& c : face.trim.curves) {
        first.push_back(int(out_.texels.size()));
        double heaviest = 0;
        for (const Hom<2>& h : c.net) heaviest = std::max(heaviest, h.weight());
        for (const Hom<2>& h : c.net)
            out_.texels.push_back(
                {float(h[0] / heaviest), float(h[1] / heaviest), float(h.weight() / heaviest), 0});
    }
    std::vector<std::array<float, 4>> bands;
    for (const auto& band : face.trim.bands) {
        bands.push_back({float(out_.texels.size()), float(band.size()), 0, 0});
        for (const int i : band) {
            const MonotoneCurve& c = face.trim.curves[std::size_t(i)];
            out_.texels.push_back(
                {float(c.box.lo[0]), float(c.box.hi[0]), float(c.box.lo[1]), float(c.box.hi[1])});
            out_.texels.push_back({float(first[std::size_t(i)]), float(c.net.size() - 1), 0, 0});
        }
    }
    record = {float(out_.texels.size()), float(bands.size()), 0, 0};
    out_.texels.insert(out_.texels.end(), bands.begin(), bands.end());
}

void BufferBuilder::write_records() {
    std::vector<std::array<float, 4>> trims(faces_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f) write_trim(faces_[f], trims[f]);
    out_.pieces = int(out_.texels.size());
    for (const BuiltPiece& p : pieces_) {
        out_.texels.push_back({float(p.first), float(p.face), float(p.degree[0]), float(p.degree[1])});
        std::array<float, 4> map{};
        const Box<2>& box = faces_[std::size_t(p.face)].trim.box;
        if (p.degree[1] >= 0)
            for (const std::size_t d : {std::size_t(0), std::size_t(1)}) {
                const double by = box.hi[int(d)] - box.lo[int(d)];
                const Interval on = p.map[d].on;
                map[2 * d] = float(((p.map[d].bow == 0 ? on.lo : on.middle()) - box.lo[int(d)]) / by);
                map[2 * d + 1] = float((p.map[d].bow == 0 ? on.length() : 1) / by);
            }
        out_.texels.push_back(map);
        out_.texels.push_back({float(p.map[0].bow), float(p.map[1].bow), float(p.distance / out_.size),
                               p.trimmed ? 1.0f : 0.0f});
        const std::array bend{float(p.bend[0] / out_.size), float(p.bend[1] / out_.size)};
        out_.texels.push_back({bend[0], bend[1], 0, 0});
        out_.bends.push_back(bend);
        ++(p.degree[1] < 0 ? out_.triangles : out_.tensor_pieces);
    }
    out_.faces = int(out_.texels.size());
    out_.face_count = int(faces_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f) {
        const auto c = floats(faces_[f].centre);
        const Colour& k = faces_[f].colour;
        out_.texels.push_back({c[0], c[1], c[2], faces_[f].reversed ? -1.0f : 1.0f});
        out_.texels.push_back({float(k.r), float(k.g), float(k.b), float(k.a)});
        out_.texels.push_back({trims[f][0], trims[f][1], float(faces_[f].outward), 0});
    }
}

void BufferBuilder::write_seams() {
    const auto byte = [](double x) { return std::uint8_t(std::lround(255 * x)); };
    for (const EdgeSeam& s : seams_) {
        const auto bytes = [&](int face) -> std::array<std::uint8_t, 4> {
            const BuiltFace& f = faces_[std::size_t(face)];
            return {byte(f.colour.r), byte(f.colour.g), byte(f.colour.b), outward_byte(f.outward)};
        };
        for (std::size_t i = 1; i < s.points.size(); ++i) {
            out_.seams.push_back({floats(scene(s.points[i - 1])), floats(scene(s.points[i])),
                                  floats(scene(s.edge[i - 1])), floats(scene(s.edge[i])),
                                  floats(s.normals[i - 1]), floats(s.normals[i]), floats(s.others[i - 1]),
                                  floats(s.others[i]), bytes(s.face), bytes(s.other)});
            if (s.outline) out_.outlines.push_back({floats(scene(s.edge[i - 1])), floats(scene(s.edge[i]))});
        }
    }
}

Result<SurfaceBuffers> BufferBuilder::run() {
    if (!(options_.edge_tolerance > 0 && std::isfinite(options_.edge_tolerance)))
        return refuse(RefusalKind::invalid, "edge_tolerance",
                      text(options_.edge_tolerance, " is not a positive distance"));
    for (const Body& b : model_.bodies)
        if (b.colour)
            for (const int s : b.shells)
                for (const FaceUse& u : model_.shells[std::size_t(s)].faces)
                    body_colour_[std::size_t(u.face)] = *b.colour;
    for (std::size_t f = 0; f < model_.faces.size(); ++f)
        if (auto ok = add_face(f); !ok)
            return refuse_within(
                text("face ", f, model_.faces[f].name.empty() ? "" : " ", model_.faces[f].name), ok.error());
    seams_ = seams_of(model_, options_.edge_tolerance);
    find_outward();
    for (const TriangularFace& t : triangles_) {
        if (t.patch.degree() < 1)
            return refuse(RefusalKind::no_answer, "triangles", "a triangle of degree 0 is a point");
        add_triangle(t);
    }
    if (pieces_.empty()) return refuse(RefusalKind::no_answer, "model", "there is no face to draw");
    std::size_t texels = 4 * pieces_.size() + 3 * faces_.size();
    for (const BuiltFace& f : faces_) {
        for (const auto& net : f.pieces.nets) texels += net.flat().size();
        for (const auto& band : f.trim.bands) texels += 1 + 2 * band.size();
        for (const MonotoneCurve& c : f.trim.curves) texels += c.net.size();
    }
    if (texels > kMostTexels)
        return refuse(RefusalKind::limit, "model",
                      text("needs ", texels, " texels, more than ", kMostTexels));
    place();
    write_coefficients();
    write_records();
    write_seams();
    out_.edge_tolerance = options_.edge_tolerance / out_.size;
    return std::move(out_);
}

}  // namespace

Result<SurfaceBuffers> surface_buffers(const Model& model, std::span<const TriangularFace> triangles,
                                       const SurfaceBufferOptions& options) {
    return BufferBuilder(model, triangles, options).run();
}

}  // namespace freiform
