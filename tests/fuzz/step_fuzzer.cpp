// Any bytes as a STEP file: a model whose indices hold, or a refusal that says something; with repairs for
// half of the files; and the triangles of the file, likewise.
//
// Half of the mutations are of bytes. The others know the grammar: they put one parameter of the file where
// another one stands, change references, numbers and flags for ones that files have, and move statements.
#include "bytes.hpp"

#include <freiform/io/step_read.hpp>

#include <algorithm>
#include <random>
#include <string>
#include <string_view>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max);

namespace {

using Random = std::minstd_rand;

std::size_t below(Random& r, std::size_t n) { return n == 0 ? 0 : r() % n; }

struct Piece {
    std::size_t begin = 0, end = 0;
};

// Parameters of statements: what stands between commas and brackets, strings whole.
std::vector<Piece> parameters(std::string_view s) {
    std::vector<Piece> out;
    std::size_t begin = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (s[i] == '\'') quoted = !quoted;
        if (quoted || std::string_view("(),;=\n").find(s[i]) == std::string_view::npos) continue;
        if (begin < i) out.push_back({begin, i});
        begin = i + 1;
    }
    return out;
}

// Whole lists, brackets included.
std::vector<Piece> lists(std::string_view s) {
    std::vector<Piece> out;
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (s[i] == '(') open.push_back(i);
        if (s[i] != ')' || open.empty()) continue;
        out.push_back({open.back(), i + 1});
        open.pop_back();
    }
    return out;
}

std::vector<Piece> statements(std::string_view s) {
    std::vector<Piece> out;
    std::size_t begin = 0;
    for (std::size_t i = s.find(';'); i != std::string_view::npos; i = s.find(';', i + 1))
        out.push_back({begin, i + 1}), begin = i + 1;
    return out;
}

constexpr std::string_view kValues[] = {"0.",      "1.",    "-1.",        "1.E-300", "1.E308",
                                        "-0.",     "1.E-9", "360.",       "6.28319", "1.E-5",
                                        "$",       "*",     ".T.",        ".F.",     "()",
                                        "((),())", "0",     "1",          "25",      "-1",
                                        "1000000", "''",    "'\\X2\\D8'", "1.E15",   "3.14159265358979",
                                        "0.5",     "#1",    "NAN"};
constexpr std::string_view kNames[] = {"PLANE",
                                       "CYLINDRICAL_SURFACE",
                                       "CONICAL_SURFACE",
                                       "SPHERICAL_SURFACE",
                                       "TOROIDAL_SURFACE",
                                       "LINE",
                                       "CIRCLE",
                                       "ELLIPSE",
                                       "HYPERBOLA",
                                       "PARABOLA",
                                       "FACE_BOUND",
                                       "FACE_OUTER_BOUND",
                                       "EDGE_LOOP",
                                       "VERTEX_LOOP",
                                       "POLY_LOOP",
                                       "CLOSED_SHELL",
                                       "OPEN_SHELL",
                                       "ORIENTED_FACE",
                                       "ADVANCED_FACE",
                                       "TRIMMED_CURVE",
                                       "OFFSET_SURFACE",
                                       "SURFACE_OF_REVOLUTION",
                                       "SURFACE_OF_LINEAR_EXTRUSION",
                                       "B_SPLINE_CURVE_WITH_KNOTS",
                                       "DEGENERATE_TOROIDAL_SURFACE",
                                       "RECTANGULAR_TRIMMED_SURFACE",
                                       "CURVE_BOUNDED_SURFACE",
                                       "MAPPED_ITEM",
                                       "OFFSET_CURVE_3D",
                                       "PCURVE",
                                       "SURFACE_CURVE",
                                       "COMPOSITE_CURVE",
                                       "COMPOSITE_CURVE_SEGMENT",
                                       "COMPOSITE_CURVE_ON_SURFACE",
                                       "GEOMETRIC_CURVE_SET",
                                       "REPOSITIONED_TESSELLATED_ITEM"};

void mutate(std::string& s, Random& r) {
    const auto replace = [&](const Piece& p, const std::string& by) {
        s.replace(p.begin, p.end - p.begin, by);
    };
    const auto text_of = [&](const Piece& p) { return s.substr(p.begin, p.end - p.begin); };
    const std::size_t what = below(r, 8);
    const auto all = what < 4 ? parameters(s) : what < 6 ? lists(s) : statements(s);
    if (all.empty()) return;
    const Piece at = all[below(r, all.size())], other = all[below(r, all.size())];
    switch (what) {
        case 0:
            return replace(at, std::string(kValues[below(r, std::size(kValues))]));
        case 1: {  // another one of the same kind
            for (int tries = 0; tries < 30; ++tries) {
                const Piece p = all[below(r, all.size())];
                if (s[p.begin] == s[at.begin]) return replace(at, text_of(p));
            }
            return;
        }
        case 2: {  // a digit, an exponent, the sign
            std::string t = text_of(at);
            const std::size_t k = below(r, t.size());
            if (t[k] >= '0' && t[k] <= '9')
                t[k] = char('0' + below(r, 10));
            else if (t[k] == '.')
                t = "-" + t;
            return replace(at, t);
        }
        case 3: {
            for (const Piece& p : all)
                if (s[p.begin] >= 'A' && s[p.begin] <= 'Z' && p.begin >= at.begin)
                    return replace(p, std::string(kNames[below(r, std::size(kNames))]));
            return;
        }
        case 4:
            return replace(at, text_of(other));
        case 5:
            return replace(at, text_of(at).substr(0, at.end - at.begin - 1) + "," +
                                   text_of(other).substr(1));  // one list after the other
        case 6:
            return replace(at, at.begin == other.begin ? "" : text_of(at) + text_of(other));
        default:
            return replace(at, text_of(other));
    }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max,
                                               unsigned seed) {
    Random r(seed | 1u);
    if (below(r, 2) == 0) return LLVMFuzzerMutate(data, size, max);
    std::string s(reinterpret_cast<const char*>(data), size);
    for (std::size_t k = 1 + below(r, 4); k > 0; --k) mutate(s, r);
    if (s.size() > max) s.resize(max);
    std::copy(s.begin(), s.end(), data);
    return s.size();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace freiform;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const auto within = [](int i, const auto& list) { return i >= 0 && std::size_t(i) < list.size(); };
    if (const auto mesh = read_step_mesh(bytes, {.max_triangles = 100'000})) {
        for (const auto& triangle : mesh->triangles)
            for (const int corner : triangle) demand(within(corner, mesh->vertices));
        for (const MeshVertex& vertex : mesh->vertices) demand(within(vertex.point, mesh->points));
    } else {
        demand(!mesh.error().message.empty());
    }
    // Which of the two is of the bytes alone, so that a finding stays one.
    const bool repair = size > 0 && data[size / 2] % 2 == 1;
    // Other files are the same bytes but for their end, so that they are no cycle.
    int others = 0;
    const auto open = [&](const std::string&) -> Result<std::string> {
        if (++others > 20) return refuse(RefusalKind::io, "", "there is no such file");
        return text(bytes, others);
    };
    const auto model = read_step(bytes, {.memory_bytes = 64 << 20, .repair = repair, .open = open});
    if (!model) {
        demand(!model.error().message.empty());
        return 0;
    }
    demand(repair || model->repairs.empty());
    for (const Edge& e : model->edges)
        demand(within(e.start, model->vertices) && within(e.end, model->vertices) &&
               e.range.lo <= e.range.hi);
    for (const Face& f : model->faces)
        for (const Loop& l : f.loops)
            for (const Coedge& c : l.coedges) demand(within(c.edge, model->edges));
    return 0;
}
