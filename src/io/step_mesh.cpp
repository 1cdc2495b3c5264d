// Tessellated items (AP242) as a mesh: the triangles of a file, each face where the assembly has it.
//
// Two tables. A face has a list of coordinates, and perhaps a table of its own, pnindex, whose entries count
// into those; triangles, strips and fans count into the table, or into the coordinates where there is none.
// All count from 1. Normals belong to the entries: none, one for all, or one for each.
//
// An item that is repositioned (a complex instance) has a placement: the frame that it, and what it contains,
// is in.
//
// Cost. A face is read once, and keeps only the points that it uses; a place of it costs its triangles. How
// often lists may name items is limited, so that those that repeat each other take no more than linear time
// and memory.
//
// References: ISO 10303-42:2014, 11 (tessellated shape).
#include "mesh_builder.hpp"
#include "step_walk.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/io/step_read.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace freiform {

namespace step {

namespace {

// Places of the fields; -1: it has no such field.
struct FaceFields {
    Type type;
    int index, triangles, strips, fans;
};
constexpr FaceFields kFaces[] = {{Type::TRIANGULATED_FACE, 5, 6, -1, -1},
                                 {Type::COMPLEX_TRIANGULATED_FACE, 5, -1, 6, 7},
                                 {Type::TRIANGULATED_SURFACE_SET, 4, 5, -1, -1},
                                 {Type::COMPLEX_TRIANGULATED_SURFACE_SET, 4, -1, 5, 6}};

const FaceFields* face_fields(const File& f, std::uint32_t i) {
    for (const FaceFields& k : kFaces)
        if (f.is(i, k.type)) return &k;
    return nullptr;
}

// With the points that its triangles use.
struct TriangleFace {
    std::uint32_t instance = 0;
    std::string name;
    std::vector<Vec<3>> points, normals;  // as many normals, or none
    std::vector<std::array<int, 3>> triangles;
};

using Corners = std::vector<std::array<int, 3>>;

// A face of an item, in the frame of that number.
struct FaceUsed {
    const TriangleFace* face;
    std::size_t frame;
};

class TriangleReader {
public:
    TriangleReader(const File& file, const MeshReadOptions& options)
        : f_(file), builder_(options), steps_(8 * std::uint64_t(file.tokens.size()) + 1000) {}

    Result<TriangleMesh> run() {
        structure_ = structure_of(f_);
        const Context* context = context_of_model(structure_);
        const double length = context ? context->length : 1;
        if (auto ok = each_place(structure_, length, 10'000'000, [this](const Place& p) { return place(p); });
            !ok)
            return std::unexpected(ok.error());
        if (!any_)
            return refuse(RefusalKind::no_answer, "file",
                          text("the file has ", f_.instances.size(), " instances, but no triangles"));
        return builder_.finish(context ? context->unit : "");
    }

private:
    Result<void> place(const Place& p) {
        const Node& node = structure_.nodes[p.node];
        if (const auto at = per_node_.find(p.node); at == per_node_.end()) {
            std::vector<FaceUsed> all;
            for (const std::uint32_t item : node.items)
                if (auto ok = collect(item, all); !ok) return ok;
            per_node_.emplace(p.node, std::move(all));
        }
        for (const FaceUsed& u : per_node_[p.node])
            if (auto ok = put(*u.face, p, u.frame == 0 ? p.at : p.at * frames_[u.frame]); !ok) return ok;
        return {};
    }

    // The faces of an item, in their order, with a stack of our own.
    Result<void> collect(std::uint32_t item, std::vector<FaceUsed>& all) {
        std::vector<std::pair<std::uint32_t, std::size_t>> todo{{item, 0}};
        while (!todo.empty()) {
            auto [i, frame] = todo.back();
            todo.pop_back();
            if (f_.is(i, Type::REPOSITIONED_TESSELLATED_ITEM)) {
                const auto moved = frame_of(i, frame);
                if (!moved) return std::unexpected(moved.error());
                frame = *moved;
            }
            if (face_fields(f_, i) != nullptr) {
                if (f_.type(i) == Type::unknown)
                    return refuse(RefusalKind::unsupported, f_.label(i),
                                  "is a complex instance of triangles");
                const auto made = face(i);
                if (!made) return std::unexpected(made.error());
                all.push_back({*made, frame});
                continue;
            }
            std::uint32_t list = kMissing;
            for (const Type t :
                 {Type::TESSELLATED_SOLID, Type::TESSELLATED_SHELL, Type::TESSELLATED_GEOMETRIC_SET})
                if (list == kMissing) list = f_.part(i, t);
            if (list != kMissing) {  // a part of a complex instance has no name
                const auto ids = Fields(f_, i, list).references(f_.type(i) == Type::unknown ? 0 : 1, "items");
                if (!ids) return std::unexpected(ids.error());
                if (ids->size() > steps_)
                    return refuse(RefusalKind::invalid, f_.label(item), "contains itself");
                steps_ -= ids->size();
                for (auto id = ids->rbegin(); id != ids->rend(); ++id) todo.push_back({*id, frame});
            } else if (is_tessellated(f_, i) && !has_no_area(i)) {
                return refuse(RefusalKind::unsupported, f_.label(i),
                              f_.type(i) == Type::CUBIC_BEZIER_TRIANGULATED_FACE
                                  ? "is of curved triangles, which are not read"
                                  : "is of triangles of a type that is not read");
            }
        }
        return {};
    }

    Result<std::size_t> frame_of(std::uint32_t i, std::size_t outer) {
        const Fields f(f_, i, f_.part(i, Type::REPOSITIONED_TESSELLATED_ITEM));
        const auto at = f.reference(f.size() - 1, "location");
        if (!at) return std::unexpected(at.error());
        const auto p = GeometryReader(f_).placement(*at);
        if (!p) return std::unexpected(p.error());
        frames_.push_back(frames_[outer] * motion_to(*p));
        return frames_.size() - 1;
    }

    // Edges, curves and points.
    bool has_no_area(std::uint32_t i) const {
        const Instance& x = f_.instances[i];
        for (std::uint32_t k = x.first; k + 1 < x.first + x.tokens; k += 2 + f_.tokens[k + 1].size) {
            const std::string_view name = f_.text_of(f_.tokens[k]);
            for (const std::string_view word : {"EDGE", "CURVE", "POINT", "VERTEX", "WIRE"})
                if (name.starts_with("TESSELLATED_") && name.find(word) != name.npos) return true;
        }
        return false;
    }

    Result<const std::vector<Vec<3>>*> coordinates(std::uint32_t i) {
        if (const auto known = coordinates_.find(i); known != coordinates_.end()) return &known->second;
        const auto f = Fields::of(f_, i, Type::COORDINATES_LIST, 3);
        if (!f) return std::unexpected(f.error());
        const auto count = f->integer(1, "number of points");
        if (!count) return std::unexpected(count.error());
        auto rows = triples(*f, 2, "coordinates");
        if (!rows) return std::unexpected(rows.error());
        if (std::size_t(*count) != rows->size())
            return f->refused(text("says that it has ", *count, " points, and has ", rows->size()),
                              RefusalKind::invalid);
        return &coordinates_.emplace(i, std::move(*rows)).first->second;
    }

    static Result<std::vector<Vec<3>>> triples(const Fields& f, int i, std::string_view what) {
        const auto rows = f.rows(i, what);
        if (!rows) return std::unexpected(rows.error());
        std::vector<Vec<3>> all;
        all.reserve(rows->size());
        for (const std::uint32_t row : *rows) {
            const auto x = f.numbers_at(row, what);
            if (!x) return std::unexpected(x.error());
            if (x->size() != 3)
                return f.refused(text("one of its ", what, " has ", x->size(), " numbers; 3 are expected"));
            all.push_back({{(*x)[0], (*x)[1], (*x)[2]}});
        }
        return all;
    }

    // The entries of the table that a list counts into: `most` of them.
    static Result<std::vector<int>> entries(const Fields& f, std::uint32_t list, int most,
                                            std::string_view what) {
        const auto numbers = f.numbers_at(list, what);
        if (!numbers) return std::unexpected(numbers.error());
        std::vector<int> all;
        all.reserve(numbers->size());
        for (const double x : *numbers) {
            if (!(x >= 1 && x <= most) || x != std::floor(x))
                return f.refused(
                    text("one of its ", what, " is ", x, "; a whole number from 1 to ", most, " is expected"),
                    RefusalKind::invalid);
            all.push_back(int(x) - 1);
        }
        return all;
    }

    // A strip turns every second triangle around; where it repeats an entry, it only goes on from there.
    static Result<void> add_row(const Fields& f, const std::vector<int>& row, const FaceFields& where,
                                int field, Corners& to) {
        const bool plain = field == where.triangles, strip = field == where.strips;
        if (row.size() < 3 || (plain && row.size() != 3))
            return f.refused(text("one of its triangles, strips or fans has ", row.size(), " corners"),
                             RefusalKind::invalid);
        for (std::size_t k = 2; k < row.size(); ++k) {
            std::array<int, 3> t{row[k - 2], row[k - 1], row[k]};
            if (!strip) t[0] = row[0];
            if (strip && k % 2 == 1) std::swap(t[0], t[1]);
            if (plain || (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])) to.push_back(t);
        }
        return {};
    }

    Result<const TriangleFace*> face(std::uint32_t i) {
        if (const auto known = faces_.find(i); known != faces_.end()) return known->second.get();
        const FaceFields& where = *face_fields(f_, i);
        const auto f = Fields::of(f_, i, where.type, std::max(where.triangles, where.fans) + 1);
        if (!f) return std::unexpected(f.error());
        const auto list = f->reference(1, "coordinates");
        if (!list) return std::unexpected(list.error());
        const auto points = coordinates(*list);
        if (!points) return std::unexpected(points.error());
        const int all = int((*points)->size());
        const auto count = f->integer(2, "number of points");
        const auto index =
            f->is(where.index, TokenKind::list)
                ? entries(*f, f->list(where.index), all, "indices of points")
                : Result<std::vector<int>>(f->expected(where.index, "indices of points", "a list"));
        const auto normals = triples(*f, 3, "normals");
        for (const auto* bad : {count ? nullptr : &count.error(), index ? nullptr : &index.error(),
                                normals ? nullptr : &normals.error()})
            if (bad != nullptr) return std::unexpected(*bad);
        const int own = index->empty() ? all : int(index->size());
        if (*count != own)
            return f->refused(text("says that it has ", *count, " points, and has ", own),
                              RefusalKind::invalid);
        if (normals->size() > 1 && int(normals->size()) != own)
            return f->refused(text("has ", normals->size(), " normals for ", own, " points"),
                              RefusalKind::invalid);
        Corners corners;
        for (const int field : {where.triangles, where.strips, where.fans}) {
            if (field < 0) continue;
            const auto rows = f->rows(field, "triangles");
            if (!rows) return std::unexpected(rows.error());
            for (const std::uint32_t row : *rows) {
                const auto at = entries(*f, row, own, "corners");
                if (!at) return std::unexpected(at.error());
                if (auto ok = add_row(*f, *at, where, field, corners); !ok)
                    return std::unexpected(ok.error());
            }
        }
        auto made = compact(corners, *index, **points, *normals);
        made->instance = i;
        made->name = f->string(0);
        if (made->name == "NONE") made->name.clear();
        return faces_.emplace(i, std::move(made)).first->second.get();
    }

    // Only the points that triangles use.
    static std::unique_ptr<TriangleFace> compact(const Corners& corners, const std::vector<int>& index,
                                                 const std::vector<Vec<3>>& points,
                                                 const std::vector<Vec<3>>& normals) {
        auto face = std::make_unique<TriangleFace>();
        std::vector<int> used;
        used.reserve(3 * corners.size());
        for (const auto& t : corners) used.insert(used.end(), t.begin(), t.end());
        sort(used);
        used.erase(std::ranges::unique(used).begin(), used.end());
        for (const int k : used) {
            face->points.push_back(points[std::size_t(index.empty() ? k : index[std::size_t(k)])]);
            if (!normals.empty()) face->normals.push_back(normals[normals.size() == 1 ? 0 : std::size_t(k)]);
        }
        for (auto t : corners) {
            for (int& k : t) k = int(std::ranges::lower_bound(used, k) - used.begin());
            face->triangles.push_back(t);
        }
        return face;
    }

    Result<void> put(const TriangleFace& face, const Place& p, const Motion& by) {
        if (face.triangles.empty()) return {};
        any_ = true;
        if (!builder_.room_for(face.triangles.size()))
            return refuse(RefusalKind::limit, f_.label(face.instance), "has more triangles than are allowed");
        const auto colour = structure_.styles.colours.find(face.instance);
        builder_.begin_part(face.name.empty() ? p.name : face.name, colour != structure_.styles.colours.end()
                                                                        ? std::optional(colour->second)
                                                                        : p.colour);
        std::vector<int> vertices;
        for (std::size_t k = 0; k < face.points.size(); ++k) {
            const Vec<3> at = by.point(face.points[k]);
            if (!is_finite(at))
                return refuse(RefusalKind::nonfinite, f_.label(face.instance),
                              "has a point beyond the largest double");
            const Vec<3> normal = face.normals.empty() ? Vec<3>{} : by.turned(face.normals[k]);
            vertices.push_back(builder_.vertex(builder_.point(at), normal));
        }
        for (const auto& t : face.triangles) {
            std::array<int, 3> at{};
            for (std::size_t k = 0; k < 3; ++k)
                at[k] = vertices[std::size_t(t[by.mirrored && k > 0 ? 3 - k : k])];
            if (auto ok = builder_.triangle(f_.label(face.instance), at[0], at[1], at[2]); !ok) return ok;
        }
        return {};
    }

    const File& f_;
    Structure structure_;
    MeshBuilder builder_;
    std::uint64_t steps_;
    bool any_ = false;
    std::unordered_map<std::uint32_t, std::vector<Vec<3>>> coordinates_;
    std::unordered_map<std::uint32_t, std::unique_ptr<TriangleFace>> faces_;
    std::unordered_map<std::uint32_t, std::vector<FaceUsed>> per_node_;
    std::vector<Motion> frames_{Motion{}};  // the first one: none
};

}  // namespace

bool is_tessellated(const File& f, std::uint32_t i) {
    const Instance& x = f.instances[i];
    for (std::uint32_t k = x.first; k + 1 < x.first + x.tokens; k += 2 + f.tokens[k + 1].size) {
        const std::string_view name = f.text_of(f.tokens[k]);
        if (name.starts_with("TESSELLATED_") || name.find("TRIANGULATED_") != name.npos) return true;
    }
    return false;
}

}  // namespace step

bool has_only_triangles(std::string_view bytes) {
    if (bytes.find("TRIANGULATED_") == bytes.npos) return false;
    const auto file = step::parse(bytes);
    if (!file) return false;
    const step::Structure structure = step::structure_of(*file);
    bool any = false;
    for (const step::Node& n : structure.nodes) {
        if (!n.replicas.empty()) return false;
        for (const std::uint32_t i : n.items) {
            if (!step::is_tessellated(*file, i)) return false;
            any = true;
        }
    }
    return any;
}

Result<TriangleMesh> read_step_mesh(std::string_view bytes, const MeshReadOptions& options) {
    const auto file = step::parse(bytes);
    if (!file) return std::unexpected(file.error());
    return step::TriangleReader(*file, options).run();
}

}  // namespace freiform
