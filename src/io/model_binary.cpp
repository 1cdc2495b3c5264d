// Idea. One description of each type serves both directions: `describe(archive, x)` names the fields of x in
// order, and an archive either appends them to a string or takes them from one. So the two cannot disagree.
//
// Layout. "FFMODEL" and a zero byte, then the version; then the fields of Model. Numbers are little-endian:
// counts and indices 32 bits, doubles their 64 bits as they are. A string or a list is a count and its items;
// an optional is a byte 0 or 1 and the value; a variant is a byte that names the alternative and the value.
//
// Safety. A count is believed only if the bytes that are left can hold that many of the smallest items, so
// memory in use stays proportional to the input. An offset surface holds a base that is not an offset, so
// that nothing nests deeper than the types do. After the first failure the reader takes nothing more.
#include <freiform/io/model_binary.hpp>

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

namespace freiform {

namespace {

constexpr std::string_view kMagic{"FFMODEL\0", 8};
constexpr std::uint32_t kFormatVersion = 4;

struct Writer {
    static constexpr bool kReading = false;
    std::string bytes;

    template <class U>
    void number(const U& x) {
        for (std::size_t i = 0; i < sizeof x; ++i) bytes += char((x >> (8 * i)) & 0xff);
    }
    bool good() const { return true; }
};

struct Reader {
    static constexpr bool kReading = true;
    std::string_view bytes;
    std::size_t at = 0;
    std::optional<Refusal> failure;

    bool good() const { return !failure; }
    std::size_t left() const { return failure ? 0 : bytes.size() - at; }
    void fail(RefusalKind kind, std::size_t where, std::string message) {
        if (!failure) failure = Refusal{kind, text("byte ", where), std::move(message)};
    }
    template <class U>
    void number(U& x) {
        x = 0;
        if (left() < sizeof x) return fail(RefusalKind::unreadable, at, "the model ends too early");
        for (std::size_t i = 0; i < sizeof x; ++i) x |= U(U(std::uint8_t(bytes[at + i])) << (8 * i));
        at += sizeof x;
    }
};

// Plain fields. The item of a list takes at least this many bytes.
template <class T>
constexpr std::size_t kLeastBytes = 1;
template <>
constexpr std::size_t kLeastBytes<double> = 8;
template <>
constexpr std::size_t kLeastBytes<int> = 4;
template <int D>
constexpr std::size_t kLeastBytes<Vec<D>> = 8 * D;
template <int D>
constexpr std::size_t kLeastBytes<Hom<D>> = 8 * D + 8;
template <>
constexpr std::size_t kLeastBytes<Vertex> = 32;
template <>
constexpr std::size_t kLeastBytes<Edge> = 38;
template <>
constexpr std::size_t kLeastBytes<Coedge> = 26;
template <>
constexpr std::size_t kLeastBytes<Face> = 32;

template <class A>
void describe(A& a, std::uint8_t& x) {
    a.number(x);
}
template <class A>
void describe(A& a, int& x) {
    auto u = std::uint32_t(x);
    a.number(u);
    if constexpr (A::kReading) x = int(u);
}
template <class A>
void describe(A& a, double& x) {
    auto u = std::bit_cast<std::uint64_t>(x);
    a.number(u);
    if constexpr (A::kReading) x = std::bit_cast<double>(u);
}
// A byte below `end`.
template <class A>
int small_number(A& a, int value, int end, std::string_view what) {
    auto x = std::uint8_t(value);
    a.number(x);
    if constexpr (A::kReading) {
        if (a.good() && x >= end) {
            a.fail(RefusalKind::unreadable, a.at - 1, text(what, " is ", int(x), ", expected 0..", end - 1));
            return 0;
        }
    }
    return x;
}
template <class A>
void describe(A& a, bool& x) {
    x = small_number(a, x, 2, "a flag") != 0;
}

template <class A>
std::size_t describe_count(A& a, std::size_t size, std::size_t least_bytes) {
    auto n = std::uint32_t(size);
    a.number(n);
    if constexpr (A::kReading) {
        if (a.good() && n > a.left() / least_bytes) {
            a.fail(RefusalKind::unreadable, a.at - 4,
                   text(n, " items are announced, ", a.left(), " bytes are left"));
            return 0;
        }
        return a.good() ? n : 0;
    }
    return size;
}
template <class A>
void describe(A& a, std::string& s) {
    const std::size_t n = describe_count(a, s.size(), 1);
    if constexpr (A::kReading) {
        s.assign(a.bytes.substr(a.at, n));
        a.at += n;
    } else {
        a.bytes += s;
    }
}
template <class A, Coefficient P>
void describe(A& a, P& p) {
    for (double& x : p.c) describe(a, x);
}
template <class A, class T>
void describe(A& a, std::vector<T>& list) {
    const std::size_t n = describe_count(a, list.size(), kLeastBytes<T>);
    if constexpr (A::kReading) {
        for (std::size_t i = 0; i < n && a.good(); ++i) describe(a, list.emplace_back());
    } else {
        for (T& x : list) describe(a, x);
    }
}
template <class A, class T>
void describe(A& a, std::optional<T>& x) {
    bool has = x.has_value();
    describe(a, has);
    if constexpr (A::kReading) {
        if (has) x.emplace();
    }
    if (has) describe(a, *x);
}

template <class A>
void describe(A& a, Interval& i) {
    describe(a, i.lo);
    describe(a, i.hi);
}
template <class A>
void describe(A& a, Colour& c) {
    for (double* x : {&c.r, &c.g, &c.b, &c.a}) describe(a, *x);
}
template <class A>
void describe(A& a, Refusal& r) {
    r.kind = RefusalKind(small_number(a, int(r.kind), int(RefusalKind::io) + 1, "the kind of a refusal"));
    describe(a, r.where);
    describe(a, r.message);
}
template <class A>
void describe(A& a, Approximation& x) {
    describe(a, x.where);
    describe(a, x.what);
    describe(a, x.bound);
    describe(a, x.estimate);
}

// Splines are valid from construction on, so they are read into parts first.
template <std::size_t N, class P>
void write(Writer& a, const Patch<N, P>& s) {
    for (const BSplineBasis& b : s.bases()) {
        bool closed = b.is_closed();
        int degree = b.degree();
        std::vector<double> knots(b.defining().begin(), b.defining().end());
        describe(a, closed);
        describe(a, degree);
        describe(a, knots);
    }
    std::vector<P> net(s.net().flat().begin(), s.net().flat().end());
    describe(a, net);
}
template <class S, std::size_t N = S::kParams, class P = typename S::Coefficients>
std::optional<S> read_spline(Reader& a) {
    const std::size_t start = a.at;
    std::vector<BSplineBasis> bases;
    Index<N> extent{};
    const auto give_up = [&](const Refusal& r) {
        a.fail(r.kind, start, text("the spline that begins here: ", r.where, ": ", r.message));
        return std::nullopt;
    };
    for (std::size_t d = 0; d < N; ++d) {
        bool closed = false;
        int degree = 0;
        std::vector<double> knots;
        describe(a, closed);
        describe(a, degree);
        describe(a, knots);
        if (!a.good()) return std::nullopt;
        auto basis = closed ? BSplineBasis::periodic(degree, std::move(knots))
                            : BSplineBasis::make(degree, std::move(knots));
        if (!basis) return give_up(basis.error());
        extent[d] = basis->size();
        bases.push_back(std::move(*basis));
    }
    std::vector<P> coefficients;
    describe(a, coefficients);
    if (!a.good()) return std::nullopt;
    auto net = Net<N, P>::make(extent, std::move(coefficients));
    if (!net) return give_up(net.error());
    auto patch = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return S::make({bases[I]...}, std::move(*net));
    }
    (std::make_index_sequence<N>{});
    if (!patch) return give_up(patch.error());
    return std::move(*patch);
}

template <class A, int D>
void describe(A& a, Line<D>& l) {
    describe(a, l.origin);
    describe(a, l.direction);
}
template <class A, int D>
void describe(A& a, Conic<D>& c) {
    c.kind = ConicKind(small_number(a, int(c.kind), 3, "the kind of a conic"));
    for (Vec<D>* v : {&c.centre, &c.x, &c.y}) describe(a, *v);
}
template <class A, int D>
void describe(A& a, CurveGeometry<D>& curve) {
    const int kind = small_number(a, int(curve.index()), 4, "the type of a curve");
    if constexpr (A::kReading) {
        if (kind == 1) curve = Conic<D>{};
        if (kind == 2) {
            if (auto s = read_spline<Curve<Vec<D>>>(a)) curve = std::move(*s);
        } else if (kind == 3) {
            if (auto s = read_spline<Curve<Hom<D>>>(a)) curve = std::move(*s);
        }
    } else {
        if (kind == 2) write(a, std::get<2>(curve));
        if (kind == 3) write(a, std::get<3>(curve));
    }
    if (kind == 0 && curve.index() == 0) describe(a, std::get<0>(curve));
    if (kind == 1) describe(a, std::get<1>(curve));
}

template <class A>
void describe_kind(A& a, SurfaceKind& kind) {
    kind = SurfaceKind(small_number(a, int(kind), int(SurfaceKind::torus) + 1, "the kind of a surface"));
}
template <class A>
void describe(A& a, Extrusion& e) {
    describe_kind(a, e.kind);
    describe(a, e.direction);
    describe(a, e.profile);
}
template <class A>
void describe(A& a, Revolution& r) {
    describe_kind(a, r.kind);
    describe(a, r.origin);
    describe(a, r.axis);
    describe(a, r.profile);
}
template <class A>
void describe(A& a, SurfaceGeometry& surface, int alternatives = 5) {
    const int kind = small_number(a, int(surface.index()), alternatives, "the type of a surface");
    if constexpr (A::kReading) {
        if (kind == 1) surface = Revolution{};
        if (kind == 2) {
            if (auto s = read_spline<Surface<Vec<3>>>(a)) surface = std::move(*s);
        } else if (kind == 3) {
            if (auto s = read_spline<Surface<Hom<3>>>(a)) surface = std::move(*s);
        } else if (kind == 4) {
            OffsetSurface o;
            SurfaceGeometry base;
            describe(a, o.distance);
            describe(a, base, 4);
            o.base = std::make_shared<const SurfaceGeometry>(std::move(base));
            surface = std::move(o);
        }
    } else {
        if (kind == 2) write(a, std::get<2>(surface));
        if (kind == 3) write(a, std::get<3>(surface));
        if (kind == 4) {
            auto& o = std::get<4>(surface);
            SurfaceGeometry base = o.base ? *o.base : SurfaceGeometry{};
            describe(a, o.distance);
            describe(a, base, 4);
        }
    }
    if (kind == 0 && surface.index() == 0) describe(a, std::get<0>(surface));
    if (kind == 1) describe(a, std::get<1>(surface));
}

template <class A, class... Parts>
void describe_parts(A& a, Parts&... parts) {
    (describe(a, parts), ...);
}
template <class A>
void describe(A& a, Vertex& v) {
    describe_parts(a, v.point, v.tolerance);
}
template <class A>
void describe(A& a, Edge& e) {
    describe_parts(a, e.curve, e.degenerate, e.range, e.start, e.end, e.tolerance, e.name, e.colour,
                   e.layers);
}
template <class A>
void describe(A& a, Coedge& c) {
    describe_parts(a, c.edge, c.reversed, c.curve);
}
template <class A>
void describe(A& a, Loop& l) {
    describe_parts(a, l.coedges);
}
template <class A>
void describe(A& a, Face& f) {
    describe_parts(a, f.surface, f.reversed, f.loops, f.tolerance, f.name, f.colour, f.layers);
}
template <class A>
void describe(A& a, FaceUse& f) {
    describe_parts(a, f.face, f.reversed);
}
template <class A>
void describe(A& a, Shell& s) {
    describe_parts(a, s.faces, s.closed);
}
template <class A>
void describe(A& a, Body& b) {
    describe_parts(a, b.shells, b.solid, b.name, b.colour, b.layers);
}
template <class A>
void describe(A& a, Layer& l) {
    describe_parts(a, l.name, l.description);
}
template <class A>
void describe(A& a, Repair& r) {
    describe_parts(a, r.where, r.what, r.distance);
}
template <class A>
void describe(A& a, Model& m) {
    describe_parts(a, m.unit, m.vertices, m.edges, m.faces, m.shells, m.bodies, m.refused, m.approximations,
                   m.layers, m.repairs);
}

}  // namespace

std::string to_binary(const Model& model) {
    Writer out{std::string(kMagic)};
    out.number(kFormatVersion);
    Model copy = model;  // the descriptions serve reading too, so they take what they may change
    describe(out, copy);
    return std::move(out.bytes);
}

Result<Model> from_binary(std::string_view bytes) {
    if (!bytes.starts_with(kMagic))
        return refuse(RefusalKind::unreadable, "byte 0", "does not begin with the magic bytes FFMODEL");
    Reader in{bytes, kMagic.size(), {}};
    std::uint32_t version = 0;
    in.number(version);
    if (in.good() && version != kFormatVersion)
        return refuse(RefusalKind::unsupported, "byte 8",
                      text("version ", version, " of the format, this program knows ", kFormatVersion));
    Model model;
    describe(in, model);
    if (in.left() > 0)
        in.fail(RefusalKind::unreadable, in.at, text(in.left(), " bytes follow the end of the model"));
    if (in.failure) return std::unexpected(std::move(*in.failure));
    return make_model(std::move(model));
}

}  // namespace freiform
