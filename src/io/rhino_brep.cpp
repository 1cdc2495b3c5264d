// Polysurfaces: faces on surfaces, with loops of trims on edges that they share.
//
// Curves in parameters are hints: their parameter is not that of the edge, and a face has new ones made from
// its edges and its surface (docs/step.md). They say which of several places of a surface is meant.
#include "rhino_geometry.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace freiform::rhino {

namespace {

// Arrays that may have no object in a place.
Result<std::vector<std::optional<StoredObject>>> objects(Bytes& b, std::string_view what) {
    Bytes list = b.chunk().body;
    int minor = 0;
    list.version(minor);
    const int n = list.count(4);
    std::vector<std::optional<StoredObject>> all;
    for (int i = 0; i < n; ++i) {
        all.emplace_back();
        if (list.i32() != 1) continue;
        Chunk c = list.chunk();
        if (list.failed()) break;
        auto o = object_in(std::move(c));
        if (!o) return std::unexpected(o.error());
        all.back() = std::move(*o);
    }
    if (b.failed() || list.failed()) return ends_early(list, what);
    if (auto ok = list.check_sum(); !ok) return std::unexpected(ok.error());
    return all;
}

// Arrays of numbers, `each` bytes at least.
struct List {
    Bytes b;
    int count = 0;
};
Result<List> list_of(Bytes& b, std::size_t each, std::string_view what) {
    List l{b.chunk().body};
    if (b.failed()) return ends_early(b, what);
    if (auto ok = l.b.check_sum(); !ok) return std::unexpected(ok.error());
    int minor = 0;
    l.b.version(minor);
    l.count = l.b.count(each);
    return l;
}

struct Trim {
    TrimOf use;
    int type = 0;
};

// With every number inside of what it counts.
Result<BrepOf> finished(BrepOf b, const Bytes& bytes) {
    const auto outside = [](int i, std::size_t n) { return i < 0 || std::size_t(i) >= n; };
    for (std::size_t e = 0; e < b.edges.size(); ++e) {
        if (outside(b.edges[e].along.curve, b.curves.size()))
            return invalid(bytes,
                           text("edge ", e, ": curve ", b.edges[e].along.curve, " of ", b.curves.size()));
        for (const int v : b.edges[e].vertex)
            if (outside(v, b.vertices.size()))
                return invalid(bytes, text("edge ", e, ": vertex ", v, " of ", b.vertices.size()));
    }
    for (std::size_t f = 0; f < b.faces.size(); ++f) {
        const FaceOf& face = b.faces[f];
        if (outside(face.surface, b.surfaces.size()))
            return invalid(bytes, text("face ", f, ": surface ", face.surface, " of ", b.surfaces.size()));
        for (const LoopOf& l : face.loops)
            for (const TrimOf& t : l.trims)
                if (outside(t.edge, b.edges.size()))
                    return invalid(bytes, text("face ", f, ": edge ", t.edge, " of ", b.edges.size()));
    }
    return b;
}

Result<BrepOf> read_version3(Bytes& bytes) {
    BrepOf b;
    // Curves in parameters say where to look for the edge, and no more: those that cannot be read are none.
    const auto images = objects(bytes, "the list of curves in parameters");
    if (!images) return std::unexpected(images.error());
    for (const auto& o : *images) {
        auto c = o ? read_curve(*o) : Result<CurveInSpace>(std::unexpected(Refusal{}));
        b.images.push_back(c ? std::optional(std::move(*c)) : std::nullopt);
    }
    const auto curves = objects(bytes, "the list of curves");
    if (!curves) return std::unexpected(curves.error());
    // An edge knows its curve by its number, also where there is none.
    std::vector<int> number;
    for (const auto& o : *curves) {
        number.push_back(o ? int(b.curves.size()) : -1);
        if (!o) continue;
        auto c = read_curve(*o);
        if (!c) return std::unexpected(c.error());
        b.curves.push_back(std::move(*c));
    }
    const auto surfaces = objects(bytes, "the list of surfaces");
    if (!surfaces) return std::unexpected(surfaces.error());
    for (const auto& o : *surfaces)
        b.surfaces.push_back(o ? read_surface(*o) : refuse(RefusalKind::invalid, "", "has no surface"));
    auto vertices = list_of(bytes, 4 + 24 + 4 + 8, "the list of vertices");
    if (!vertices) return std::unexpected(vertices.error());
    for (int i = 0; i < vertices->count; ++i) {
        vertices->b.i32();
        b.vertices.push_back(vertices->b.point());
        vertices->b.indices();
        vertices->b.f64();
    }
    if (vertices->b.failed()) return ends_early(vertices->b, "the list of vertices");
    auto edges = list_of(bytes, 12 + 16 + 8 + 4 + 8, "the list of edges");
    if (!edges) return std::unexpected(edges.error());
    // Old programs write no parameters of the edge itself.
    const auto read_edges = [&](Bytes from, bool has_domain) {
        b.edges.clear();
        for (int i = 0; i < edges->count; ++i) {
            EdgeOf e;
            from.i32();
            const int c = from.i32();
            e.along.curve = c >= 0 && std::size_t(c) < number.size() ? number[std::size_t(c)] : -1;
            e.along.backward = from.i32() != 0;
            e.along.part = from.interval();
            for (int& v : e.vertex) v = from.i32();
            from.indices();
            from.f64();
            if (has_domain) from.interval();
            b.edges.push_back(e);
        }
        return !from.failed() && from.left() == 0;
    };
    const bool has_domains = read_edges(edges->b, true);
    if (!has_domains && !read_edges(edges->b, false)) return ends_early(edges->b, "the list of edges");
    auto trims = list_of(bytes, 132, "the list of trims");
    if (!trims) return std::unexpected(trims.error());
    std::vector<Trim> all;
    for (int i = 0; i < trims->count; ++i) {
        Bytes& t = trims->b;
        Trim x;
        t.i32();
        x.use.image.curve = t.i32();
        x.use.image.part = t.interval();
        x.use.edge = t.i32();
        t.skip(2 * 4);
        x.use.reversed = t.i32() != 0;
        x.type = t.i32();
        t.skip(2 * 4 + 2 * 8 + 2 * 8);
        // Of old programs these bytes are two points.
        x.use.image.backward = t.u8() == 1 && has_domains;
        t.skip(31 + 2 * 8);
        all.push_back(x);
    }
    if (trims->b.failed()) return ends_early(trims->b, "the list of trims");
    auto loops = list_of(bytes, 4 + 4 + 4 + 4, "the list of loops");
    if (!loops) return std::unexpected(loops.error());
    struct LoopHere {
        std::vector<int> trims;
        int type = 0;
        bool used = false;
    };
    std::vector<LoopHere> rows;
    for (int i = 0; i < loops->count; ++i) {
        loops->b.i32();
        LoopHere l;
        l.trims = loops->b.indices();
        l.type = loops->b.i32();
        loops->b.i32();
        rows.push_back(std::move(l));
    }
    if (loops->b.failed()) return ends_early(loops->b, "the list of loops");
    auto faces = list_of(bytes, 4 + 4 + 4 + 4 + 4, "the list of faces");
    if (!faces) return std::unexpected(faces.error());
    for (int i = 0; i < faces->count; ++i) {
        faces->b.i32();
        FaceOf f;
        const std::vector<int> of = faces->b.indices();
        f.surface = faces->b.i32();
        f.reversed = faces->b.i32() != 0;
        faces->b.i32();
        if (faces->b.failed()) break;
        for (const int l : of) {
            if (l < 0 || std::size_t(l) >= rows.size())
                return invalid(faces->b, text("face ", i, ": loop ", l, " of ", rows.size()));
            LoopHere& row = rows[std::size_t(l)];
            if (std::exchange(row.used, true))
                return invalid(faces->b, text("face ", i, ": loop ", l, " has been used before"));
            constexpr int kCurveOnSurface = 4, kPointOnSurface = 5;
            if (row.type == kCurveOnSurface || row.type == kPointOnSurface) continue;
            LoopOf loop;
            for (const int t : row.trims) {
                if (t < 0 || std::size_t(t) >= all.size())
                    return invalid(faces->b, text("loop ", l, ": trim ", t, " of ", all.size()));
                const Trim& trim = all[std::size_t(t)];
                constexpr int kSingular = 4;
                if (trim.type != kSingular || trim.use.edge >= 0) loop.trims.push_back(trim.use);
            }
            f.loops.push_back(std::move(loop));
        }
        b.faces.push_back(std::move(f));
    }
    if (faces->b.failed()) return ends_early(faces->b, "the list of faces");
    return finished(std::move(b), bytes);
}

// Trimmed surfaces of version 2 of the format.
Result<BrepOf> read_version2(Bytes& bytes) {
    const int faces = bytes.count(1), edges = bytes.count(1);
    bytes.count(1);
    const int trims = bytes.count(1);
    bytes.skip(4 + 6 * 8);
    if (bytes.failed()) return ends_early(bytes, "a trimmed surface");
    for (int i = 0; i < trims; ++i)
        if (auto c = read_poly_curve(bytes, 0); !c) return std::unexpected(c.error());
    BrepOf b;
    for (int i = 0; i < edges; ++i) {
        auto c = read_poly_curve(bytes, 0);
        if (!c) return std::unexpected(c.error());
        b.curves.push_back(std::move(*c));
        b.edges.push_back({{i, {}, false}, {-1, -1}});
    }
    for (int i = 0; i < faces; ++i) {
        auto s = read_nurbs_surface(bytes);
        if (!s) return std::unexpected(s.error());
        b.surfaces.push_back(std::move(*s));
    }
    struct TrimHere {
        int twin = -1, edge = -1;
        bool reversed = false;
    };
    std::vector<TrimHere> all(static_cast<std::size_t>(trims));
    std::vector<std::vector<std::vector<int>>> rows(static_cast<std::size_t>(faces));
    for (int i = 0; i < faces; ++i) {
        bytes.skip(8);
        FaceOf f{i, bytes.i32() != 0, {}};
        bytes.skip(4 + 6 * 8);
        const int loops = bytes.count(8);
        for (int l = 0; l < loops; ++l) {
            bytes.skip(4 + 4 + 4 * 8);
            const int count = bytes.count(8);
            std::vector<int> row;
            for (int k = 0; k < count; ++k) {
                const int index = bytes.i32();
                TrimHere t;
                t.twin = bytes.i32();
                bytes.u8();
                t.edge = bytes.i32();
                t.reversed = bytes.i32() != 0;
                bytes.skip(8 + 16);
                if (bytes.failed()) return ends_early(bytes, "a trimmed surface");
                if (index < 0 || index >= trims) return invalid(bytes, text("trim ", index, " of ", trims));
                all[std::size_t(index)] = t;
                row.push_back(index);
            }
            rows[std::size_t(i)].push_back(std::move(row));
        }
        b.faces.push_back(std::move(f));
    }
    if (bytes.failed()) return ends_early(bytes, "a trimmed surface");
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (const auto& row : rows[i]) {
            LoopOf loop;
            for (const int t : row) {
                const TrimHere& own = all[std::size_t(t)];
                int edge = own.edge;
                if (edge < 0 && own.twin >= 0 && own.twin < trims) edge = all[std::size_t(own.twin)].edge;
                if (edge >= 0) loop.trims.push_back({edge, own.reversed});
            }
            b.faces[i].loops.push_back(std::move(loop));
        }
    for (const FaceOf& f : b.faces)
        for (const LoopOf& l : f.loops)
            for (const TrimOf& t : l.trims)
                if (t.edge >= edges) return invalid(bytes, text("edge ", t.edge, " of ", edges));
    find_vertices(b);
    return finished(std::move(b), bytes);
}

}  // namespace

void find_vertices(BrepOf& b) {
    std::vector<int> same(2 * b.edges.size());
    std::iota(same.begin(), same.end(), 0);
    const auto root = [&](int i) {
        while (same[std::size_t(i)] != i) i = same[std::size_t(i)] = same[std::size_t(same[std::size_t(i)])];
        return i;
    };
    const auto end = [](const TrimOf& t, bool last) { return 2 * t.edge + (last != t.reversed ? 1 : 0); };
    for (const FaceOf& f : b.faces)
        for (const LoopOf& l : f.loops)
            for (std::size_t i = 0; i < l.trims.size(); ++i) {
                const TrimOf& next = l.trims[(i + 1) % l.trims.size()];
                const int a = root(end(l.trims[i], true)), z = root(end(next, false));
                same[std::size_t(std::max(a, z))] = std::min(a, z);
            }
    std::vector<int> number(same.size(), -1);
    for (std::size_t e = 0; e < b.edges.size(); ++e)
        for (int last = 0; last < 2; ++last) {
            const int r = root(int(2 * e) + last);
            if (number[std::size_t(r)] < 0) {
                number[std::size_t(r)] = int(b.vertices.size());
                b.vertices.push_back(b.curves[std::size_t(b.edges[e].along.curve)].end(
                    (last == 1) != b.edges[e].along.backward));
            }
            b.edges[e].vertex[std::size_t(last)] = number[std::size_t(r)];
        }
}

bool BrepOf::is_solid() const {
    std::vector<int> uses(edges.size(), 0);
    for (const FaceOf& f : faces) {
        if (f.loops.empty()) return false;
        for (const LoopOf& l : f.loops)
            for (const TrimOf& t : l.trims) ++uses[std::size_t(t.edge)];
    }
    return !faces.empty() && std::all_of(uses.begin(), uses.end(), [](int n) { return n == 2 || n == 0; });
}

Result<BrepOf> read_brep(StoredObject o) {
    int minor = 0;
    const int major = o.data.version(minor);
    if (major == 3) return read_version3(o.data);
    if (major == 2) return read_version2(o.data);
    return refuse(RefusalKind::unsupported, text("byte ", o.data.at()),
                  text("is a polysurface of version ", major, ".", minor, "; 2 and 3 are read"));
}

}  // namespace freiform::rhino
