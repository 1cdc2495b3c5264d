// Version 1 has no tables: objects, and what is said of the whole file, stand one after the other, and inside
// of an object what is said of it before its numbers. Trims have a curve in space where they are the first
// ones on their edge; which trims share one, lists of pairs say for those of one face and of one shell.
#include "rhino_file.hpp"

#include <algorithm>

namespace freiform::rhino {

namespace {

namespace v1 {
constexpr std::uint32_t kUnits = 0x02000010, kLayer = 0x00400010, kLayerName = 0x00400011;
constexpr std::uint32_t kCurve = 0x00010008, kFace = 0x00010004, kShell = 0x00010003, kSpline = 0x00010009;
constexpr std::uint32_t kSurface = 0x00010007, kTrim = 0x00010006, kLoop = 0x00010005;
constexpr std::uint32_t kNumbers = 0x00000100;  // of each, added to its type
constexpr std::uint32_t kPoint = 0x00100001, kMesh = 0x00100015;
constexpr std::uint32_t kForeignCurve = 0x00020008, kForeignSurface = 0x00020009, kForeignBrep = 0x0002000B;
constexpr std::uint32_t kName = 0x02000001, kOnLayer = 0xA0000001;
}  // namespace v1

// The numbers of an object of this type, which come after all that is said of it.
Result<Bytes> numbers_in(Bytes b, std::uint32_t type, std::string_view what) {
    while (b.left() > 0) {
        Chunk c = b.chunk();
        if (b.failed()) break;
        if (c.type == (type | v1::kNumbers)) return c.body;
    }
    return ends_early(b, what);
}

Result<Bytes> child(Bytes& b, std::uint32_t type, std::string_view what) {
    while (b.left() > 0) {
        Chunk c = b.chunk();
        if (b.failed()) break;
        if (c.type == type) return c.body;
    }
    return ends_early(b, what);
}

// Points with weights stand beside these, not multiplied by them.
void multiply(SplineNumbers& n) {
    const auto width = std::size_t(n.dim) + 1;
    for (std::size_t i = 0; i + width <= n.points.size(); i += width)
        for (std::size_t k = 0; k + 1 < width; ++k) n.points[i + k] *= n.points[i + width - 1];
}

Result<CurveInSpace> read_spline(Bytes body) {
    auto numbers = numbers_in(body, v1::kSpline, "a curve");
    if (!numbers) return std::unexpected(numbers.error());
    Bytes& b = *numbers;
    SplineNumbers n;
    n.dim = b.u8();
    n.rational = b.u8() != 0;
    n.order[0] = b.u8();
    n.size[0] = b.get<std::uint16_t>();
    b.skip(2);
    if (b.failed() || n.dim < 2 || n.dim > 3) return invalid(b, text("a curve of ", n.dim, " coordinates"));
    b.skip(2 * 8 * std::size_t(n.dim));
    // Ends whose knots are one have it once.
    const int clamped = n.order[0] > 2 ? b.u8() : 0, knots = n.order[0] + n.size[0] - 2;
    if (n.order[0] < 2 || n.size[0] < n.order[0])
        return invalid(b, text("a curve of order ", n.order[0], " with ", n.size[0], " points"));
    std::vector<double>& k = n.knots[0];
    k.push_back(b.f64());
    while (clamped % 2 == 1 && int(k.size()) < n.order[0] - 1) k.push_back(k[0]);
    while (int(k.size()) < (clamped >= 2 ? n.size[0] : knots) && !b.failed()) k.push_back(b.f64());
    while (int(k.size()) < knots && !b.failed()) k.push_back(k.back());
    n.points.resize(std::size_t(n.size[0]) * std::size_t(n.dim + (n.rational ? 1 : 0)));
    for (double& x : n.points) x = b.f64();
    if (b.failed()) return ends_early(b, "a curve");
    if (n.order[0] == 2 && n.size[0] == 2 && k[0] > k[1])
        for (double& x : k) x = -x;
    if (n.rational) multiply(n);
    auto c = spline_curve(n);
    if (!c) return refuse_within(text("byte ", b.at()), c.error());
    return c;
}

Result<CurveInSpace> read_row(Bytes body) {
    auto numbers = numbers_in(body, v1::kCurve, "a curve");
    if (!numbers) return std::unexpected(numbers.error());
    Bytes& b = *numbers;
    const int dim = b.u8();
    b.u8();
    const int count = b.get<std::uint16_t>();
    b.skip(2 * 8 * std::size_t(dim));
    CurveInSpace out;
    for (int i = 0; i < count; ++i) {
        auto spline = child(b, v1::kSpline, "a curve");
        if (!spline) return std::unexpected(spline.error());
        auto c = read_spline(*spline);
        if (!c) return c;
        Piece p = std::move(c->pieces[0]);
        // They go on from the parameter where the one before ends.
        const double from = out.pieces.empty() ? p.of.lo : out.pieces.back().of.hi;
        p.of = {from, from + p.of.length()};
        out.pieces.push_back(std::move(p));
    }
    if (out.pieces.empty()) return invalid(b, "a curve of no segments");
    return out;
}

Result<SurfaceInSpace> read_spline_surface(Bytes body) {
    auto numbers = numbers_in(body, v1::kSurface, "a surface");
    if (!numbers) return std::unexpected(numbers.error());
    Bytes& b = *numbers;
    SplineNumbers n;
    n.dim = b.u8();
    b.u8();
    for (int& x : n.order) x = b.u8() + 1;
    for (std::size_t i = 0; i < 2; ++i) n.size[i] = n.order[i] - 1 + b.get<std::uint16_t>();
    const int of_u = b.u8(), of_v = b.u8(), kind = of_v == 1 || of_v == 2 ? of_v : of_u;
    n.rational = kind != 0;
    b.skip(4 + 2 * 8 * std::size_t(n.dim));
    if (b.failed() || n.dim < 2 || n.dim > 3) return invalid(b, text("a surface of ", n.dim, " coordinates"));
    for (std::size_t i = 0; i < 2; ++i) {
        n.knots[i].resize(std::size_t(b.counted(n.order[i] + n.size[i] - 2, 8)));
        for (double& x : n.knots[i]) x = b.f64();
    }
    const int width = n.dim + (n.rational ? 1 : 0);
    const long long points = (long long)(n.size[0]) * n.size[1];
    if (b.failed() || points > (long long)(b.left() / 8) / width) return ends_early(b, "a surface");
    n.points.resize(std::size_t(points) * std::size_t(width));
    for (double& x : n.points) x = b.f64();
    if (kind == 1) multiply(n);
    auto s = spline_surface(n);
    if (!s) return refuse_within(text("byte ", b.at()), s.error());
    return s;
}

class BrepReader {
public:
    Result<BrepOf> face(Bytes body) {
        if (auto ok = add_face(body); !ok) return std::unexpected(ok.error());
        return finish();
    }
    Result<BrepOf> shell(Bytes body) {
        auto numbers = numbers_in(body, v1::kShell, "a polysurface");
        if (!numbers) return std::unexpected(numbers.error());
        Bytes& b = *numbers;
        b.i32();
        const int faces = b.count(8);
        b.skip(6 * 8);
        const std::vector<int> pairs = read_pairs(b);
        for (int i = 0; i < faces; ++i) {
            auto f = child(b, v1::kFace, "a polysurface");
            if (!f) return std::unexpected(f.error());
            if (auto ok = add_face(*f); !ok) return std::unexpected(ok.error());
        }
        std::vector<std::size_t> mated;
        for (std::size_t t = 0; t < trims_.size(); ++t)
            if (trims_[t].kind == Kind::mated) mated.push_back(t);
        glue(mated, pairs);
        return finish();
    }

private:
    enum class Kind { singular, boundary, mated, seam };
    struct Trim {
        TrimOf use;
        Kind kind = Kind::singular;
    };

    static std::vector<int> read_pairs(Bytes& b) {
        std::vector<int> pairs(std::size_t(b.count(2)));
        for (int& p : pairs) p = b.get<std::int16_t>();
        return pairs;
    }

    // Trims that are pairs share the edge that one of them has.
    void glue(const std::vector<std::size_t>& trims, const std::vector<int>& pairs) {
        if (trims.size() != pairs.size()) return;
        for (std::size_t i = 0; i < trims.size(); ++i) {
            if (pairs[i] < 0 || std::size_t(pairs[i]) >= trims.size()) continue;
            int& edge = trims_[trims[i]].use.edge;
            if (edge < 0) edge = trims_[trims[std::size_t(pairs[i])]].use.edge;
        }
    }

    Result<void> add_face(Bytes body) {
        auto numbers = numbers_in(body, v1::kFace, "a face");
        if (!numbers) return std::unexpected(numbers.error());
        Bytes& b = *numbers;
        FaceOf f;
        f.reversed = b.i32() != 0;
        b.i32();
        const int loops = b.i32() / 2;
        b.skip(6 * 8);
        const std::vector<int> pairs = read_pairs(b);
        auto s = child(b, v1::kSurface, "a face");
        if (!s) return std::unexpected(s.error());
        auto surface = read_spline_surface(*s);
        if (!surface) return std::unexpected(surface.error());
        f.surface = int(b_.surfaces.size());
        b_.surfaces.emplace_back(std::move(*surface));
        const std::size_t first = trims_.size();
        std::vector<std::vector<std::size_t>> rows;
        for (int i = 0; i < loops; ++i) {
            auto l = child(b, v1::kLoop, "a face");
            if (!l) return std::unexpected(l.error());
            if (auto ok = add_loop(*l, rows); !ok) return ok;
        }
        std::vector<std::size_t> seams;
        for (std::size_t t = first; t < trims_.size(); ++t)
            if (trims_[t].kind == Kind::seam) seams.push_back(t);
        glue(seams, pairs);
        rows_.push_back(std::move(rows));
        b_.faces.push_back(std::move(f));
        return {};
    }

    Result<void> add_loop(Bytes body, std::vector<std::vector<std::size_t>>& rows) {
        auto numbers = numbers_in(body, v1::kLoop, "a loop");
        if (!numbers) return std::unexpected(numbers.error());
        Bytes& b = *numbers;
        const int count = b.count(8);
        b.skip(4 + 4 * 8);
        rows.emplace_back();
        for (int i = 0; i < count; ++i) {
            auto t = child(b, v1::kTrim, "a loop");
            if (!t) return std::unexpected(t.error());
            if (auto ok = add_trim(*t); !ok) return ok;
            rows.back().push_back(trims_.size() - 1);
        }
        return {};
    }

    Result<void> add_trim(Bytes body) {
        auto numbers = numbers_in(body, v1::kTrim, "a trim");
        if (!numbers) return std::unexpected(numbers.error());
        Bytes& b = *numbers;
        const int flags = b.u8();
        Trim t;
        t.use.reversed = b.i32() != 0;
        b.skip(2 * 4 + 2 * 8);
        t.kind = (flags & 2) != 0   ? Kind::seam
                 : (flags & 4) != 0 ? Kind::mated
                 : (flags & 1) != 0 ? Kind::boundary
                                    : Kind::singular;
        auto flat = child(b, v1::kCurve, "a trim");
        if (!flat) return std::unexpected(flat.error());
        auto image = read_row(*flat);
        t.use.image.curve = int(b_.images.size());
        b_.images.push_back(image ? std::optional(std::move(*image)) : std::nullopt);
        if ((flags & 1) != 0) {
            auto space = child(b, v1::kCurve, "a trim");
            if (!space) return std::unexpected(space.error());
            auto c = read_row(*space);
            if (!c) return std::unexpected(c.error());
            t.use.edge = int(b_.edges.size());
            b_.edges.push_back({{int(b_.curves.size()), {}, false}, {-1, -1}});
            b_.curves.push_back(std::move(*c));
        }
        trims_.push_back(std::move(t));
        return {};
    }

    BrepOf finish() {
        for (std::size_t f = 0; f < rows_.size(); ++f)
            for (const auto& row : rows_[f]) {
                LoopOf loop;
                for (const std::size_t t : row)
                    if (trims_[t].use.edge >= 0) loop.trims.push_back(trims_[t].use);
                b_.faces[f].loops.push_back(std::move(loop));
            }
        find_vertices(b_);
        return std::move(b_);
    }

    BrepOf b_;
    std::vector<Trim> trims_;
    std::vector<std::vector<std::vector<std::size_t>>> rows_;  // trims, of loops, of faces
};

std::string layer_name(Bytes b) {
    std::string name;
    while (b.left() > 0) {
        Chunk c = b.chunk();
        if (b.failed()) break;
        if (c.type == v1::kLayerName) name = c.body.narrow_string();
    }
    return name;
}

void read_attributes(Bytes b, std::uint32_t numbers, const std::vector<int>& layers, FileObject& o) {
    while (b.left() > 0) {
        Chunk c = b.chunk();
        if (b.failed() || c.type == numbers) return;
        if (c.type == v1::kName) o.name = c.body.narrow_string();
        if (c.type == v1::kOnLayer && c.value >= 0 && std::size_t(c.value) < layers.size())
            o.layer = layers[std::size_t(c.value)];
    }
}

}  // namespace

Result<File3dm> parse_version1(Bytes b) {
    File3dm out;
    // They are counted as they come.
    std::vector<int> layers;
    std::map<std::string, int> by_name;
    for (Bytes at = b; at.left() > 0;) {
        Chunk c = at.chunk();
        if (at.failed()) break;
        if (c.type != v1::kLayer) continue;
        const std::string name = layer_name(c.body);
        const auto [known, fresh] = by_name.emplace(name, int(out.layers.size()));
        if (fresh) out.layers.push_back(name);
        layers.push_back(name.empty() ? -1 : known->second);
    }
    while (b.left() > 0) {
        const std::size_t at = b.at();
        Chunk c = b.chunk();
        if (b.failed())
            return refuse(RefusalKind::unreadable, text("byte ", at),
                          "the file ends too early, or this is no part of a 3DM file");
        FileObject o;
        const auto keep = [&](auto made, auto& to) {
            if (made)
                to = std::move(*made);
            else
                o.why = made.error();
            read_attributes(c.body, c.type | v1::kNumbers, layers, o);
            out.objects.push_back(std::move(o));
        };
        const auto leave_out = [&](Kind kind, std::string_view what) {
            o.object.of = {kind, what};
            out.objects.push_back(std::move(o));
        };
        switch (c.type) {
            case v1::kUnits:
                c.body.i32();
                out.unit = unit_named(c.body.i32());
                if (const double t = c.body.f64(); t > 0 && !c.body.failed()) out.tolerance = t;
                break;
            case v1::kCurve:
                keep(read_row(c.body), o.curve);
                break;
            case v1::kFace:
                keep(BrepReader().face(c.body), o.brep);
                break;
            case v1::kShell:
                keep(BrepReader().shell(c.body), o.brep);
                break;
            case v1::kPoint:
                leave_out(Kind::bare, "point");
                break;
            case v1::kMesh:
                leave_out(Kind::left_out, "mesh");
                break;
            case v1::kForeignCurve:
                leave_out(Kind::bare, "curve of another program");
                break;
            case v1::kForeignSurface:
                leave_out(Kind::left_out, "surface of another program");
                break;
            case v1::kForeignBrep:
                leave_out(Kind::left_out, "polysurface of another program");
                break;
            default:
                break;
        }
    }
    return out;
}

}  // namespace freiform::rhino
