// What is made of a tessellation for the copies of its faces. Accuracy: a moved mesh is off by what the mesh
// was, times 1 + skew, and by what the copy and the moved original are apart; moving rounds by a few units of
// the coordinates, which kRounding of copies.cpp has room for.
#include "copies_detail.hpp"
#include "tessellator_detail.hpp"

#include <algorithm>
#include <span>
#include <unordered_map>

namespace freiform {

namespace {

class Expander {
public:
    Expander(const Model& model, const Copies& copies, const Tessellation& in)
        : model_(model), copies_(copies), in_(in), points_(copies.motions.size()) {}

    Tessellation run() {
        out_.mesh.unit = in_.mesh.unit;
        out_.mesh.points = in_.mesh.points;
        out_.seconds = in_.seconds;
        const std::size_t faces = model_.faces.size();
        std::vector<int> part(faces, -1), refusal(faces, -1), original;
        for (std::size_t f = 0; f < faces; ++f)
            if (copies_.faces[f].of < 0) original.push_back(int(f));
        for (std::size_t i = 0; i < in_.faces.size(); ++i)
            part[std::size_t(original[std::size_t(in_.faces[i].face)])] = int(i);
        for (std::size_t i = 0; i < in_.refused.size(); ++i)
            refusal[std::size_t(original[std::size_t(in_.refused[i].face)])] = int(i);
        const auto colours = body_colours(model_);
        for (std::size_t f = 0; f < faces; ++f) {
            const int of = copies_.faces[f].of < 0 ? int(f) : copies_.faces[f].of;
            if (const int r = refusal[std::size_t(of)]; r >= 0)
                refuse_face(int(f), in_.refused[std::size_t(r)].reason);
            else
                add(int(f), std::size_t(part[std::size_t(of)]), colours[f]);
        }
        out_.quads = 0;
        for (const FaceReport& r : out_.faces) {
            out_.quads += r.quads;
            out_.error_bound = std::max(out_.error_bound, r.error_bound);
            out_.boundary_gap = std::max(out_.boundary_gap, r.boundary_gap);
        }
        out_.topology = topology(out_.mesh);
        return std::move(out_);
    }

private:
    // Edges that a reason names are those of the original.
    void refuse_face(int face, Refusal reason) {
        if (const int of = copies_.faces[std::size_t(face)].of; of >= 0)
            reason.message = text("a copy of faces[", of, "]: ", reason.message);
        out_.refused.push_back({face, model_.faces[std::size_t(face)].name, std::move(reason)});
    }

    // The point of the mesh that the motion makes of one of the originals'.
    int point(int motion, int of) {
        if (motion < 0) return of;
        auto& moved = points_[std::size_t(motion)];
        const auto [it, fresh] = moved.try_emplace(of, int(out_.mesh.points.size()));
        if (fresh)
            out_.mesh.points.push_back(
                copies_.motions[std::size_t(motion)](in_.mesh.points[std::size_t(of)]));
        return it->second;
    }

    void add(int face, std::size_t of, const Colour* body) {
        const FaceCopy& copy = copies_.faces[std::size_t(face)];
        const MeshPart& from = in_.mesh.parts[of];
        MeshPart part = from;
        part.face = face;
        part.first = int(out_.mesh.triangles.size());
        part.name = model_.faces[std::size_t(face)].name;
        part.colour = model_.faces[std::size_t(face)].colour;
        if (!part.colour && body) part.colour = *body;
        const auto triangles =
            std::span(in_.mesh.triangles).subspan(std::size_t(from.first), std::size_t(from.count));
        int least = int(in_.mesh.vertices.size()), end = 0;  // vertices of a part are neighbours
        for (const auto& t : triangles)
            for (const int v : t) least = std::min(least, v), end = std::max(end, v + 1);
        const int shift = int(out_.mesh.vertices.size()) - least;
        for (int v = least; v < end; ++v) {
            MeshVertex x = in_.mesh.vertices[std::size_t(v)];
            x.point = point(copy.motion, x.point);
            if (copy.of >= 0) x.normal = copies_.motions[std::size_t(copy.motion)].turned(x.normal);
            out_.mesh.vertices.push_back(x);
        }
        for (const auto& t : triangles)
            out_.mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
        out_.mesh.parts.push_back(std::move(part));
        FaceReport report = in_.faces[of];
        report.face = face;
        if (copy.of >= 0) {
            const double grow = 1 + copies_.motions[std::size_t(copy.motion)].skew;
            report.error_bound = grow * report.error_bound + copy.apart;
            report.boundary_gap = grow * report.boundary_gap + copy.apart;
        }
        out_.faces.push_back(report);
    }

    const Model& model_;
    const Copies& copies_;
    const Tessellation& in_;
    std::vector<std::unordered_map<int, int>> points_;  // by motion
    Tessellation out_;
};

}  // namespace

Result<Tessellation> with_copies(const Model& model, const Copies& copies, Tessellation originals,
                                 const TessellateOptions& options) {
    std::vector<long long> triangles(model.faces.size(), 0);
    long long total = 0;
    std::size_t kept = 0, next = 0;
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        if (copies.faces[f].of < 0) {
            if (next < originals.faces.size() && originals.faces[next].face == int(kept))
                triangles[f] = originals.faces[next++].triangles;
            ++kept;
        } else {
            triangles[f] = triangles[std::size_t(copies.faces[f].of)];
        }
        total += triangles[f];
    }
    if (total > options.max_triangles)
        return refuse(
            RefusalKind::limit, "max_triangles",
            text("more than ", options.max_triangles, " triangles are needed within ", options.tolerance));
    return Expander(model, copies, originals).run();
}

}  // namespace freiform
