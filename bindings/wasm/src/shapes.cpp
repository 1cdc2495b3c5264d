// Holding shapes: reading them, describing them, writing them.
#include "shapes.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/document.hpp>
#include <freiform/io/json.hpp>
#if FREIFORM_MODELS
#include <freiform/io/file.hpp>
#include <freiform/io/read.hpp>
#endif

#include <memory>

namespace freiform::wasm {

namespace {

std::vector<std::unique_ptr<Held>>& all_held() {
    static std::vector<std::unique_ptr<Held>> all;
    return all;
}

template <class S>
Parts parts_of_patch(const S& s) {
    if constexpr (TensorPatch<S>)
        return {s.bases(), 0, tuples(s.net().flat()), int(S::kParams)};
    else
        return {{}, s.degree(), tuples(std::span(s.coefficients())), 2};
}

Result<Document> read(std::string_view bytes, [[maybe_unused]] std::string_view name) {
#if FREIFORM_MODELS
    if (!name.ends_with(".json")) {
        const std::string path(name);
        files_in_memory()[path] = bytes;
        auto document = read_any(path);
        files_in_memory().erase(path);
        return document;
    }
#endif
    return read_document(bytes);
}

void write_shape(json::Writer& w, const Shape& shape, const Parts& p) {
    w.field("type", type_name(shape)).field("parameters", p.parameters);
    w.field("dimension", p.parameters == 0 ? 3 : p.coefficients.dim());
    w.key("rational").value(p.coefficients.rational ? 1 : 0).key("degrees").begin_array();
    for (const BSplineBasis& b : p.bases) w.value(b.degree());
    if (p.bases.empty() && p.parameters > 0) w.value(p.degree);
    w.end_array().key("size").begin_array();
    for (const BSplineBasis& b : p.bases) w.value(b.size());
    if (p.bases.empty() && p.parameters > 0) w.value(p.coefficients.count());
    w.end_array().key("knots").begin_array();
    for (const BSplineBasis& b : p.bases) w.value(b.defining().size());
    w.end_array().key("closed").begin_array();
    for (const BSplineBasis& b : p.bases) w.value(b.is_closed() ? 1 : 0);
    w.end_array().key("domain").begin_array();
    for (const BSplineBasis& b : p.bases)
        w.begin_array().value(b.domain().lo).value(b.domain().hi).end_array();
    if (p.bases.empty())
        for (int d = 0; d < p.parameters; ++d) w.begin_array().value(0).value(1).end_array();
    w.end_array();
}

// The same patch with these coefficients.
template <class S>
Result<Shape> with_coefficients(const S& s, std::span<const double> points, std::span<const double> weights) {
    if constexpr (TensorPatch<S> || TriangularPatch<S>) {
        using P = typename S::Coefficients;
        constexpr int kDim = Space<P>::kDim;
        using Plain = Vec<kDim>;
        std::vector<Plain> plain(points.size() / std::size_t(kDim));
        for (std::size_t i = 0; i < plain.size(); ++i)
            for (int k = 0; k < kDim; ++k) plain[i][k] = points[i * std::size_t(kDim) + std::size_t(k)];
        const auto made = [&]<class Q>(std::vector<Q> coefficients) -> Result<Shape> {
            if constexpr (TensorPatch<S>) {
                auto patch =
                    Patch<S::kParams, Q>::make(s.bases(), {s.net().extent(), std::move(coefficients)});
                if (!patch) return std::unexpected(patch.error());
                return *std::move(patch);
            } else {
                auto patch = SimplexPatch<2, Q>::make(s.degree(), std::move(coefficients));
                if (!patch) return std::unexpected(patch.error());
                return *std::move(patch);
            }
        };
        if (weights.empty()) return made(std::move(plain));
        auto rational = make_rational<kDim>(plain, weights);
        if (!rational) return std::unexpected(rational.error());
        return made(*std::move(rational));
    } else {
        return refuse(RefusalKind::unsupported, "",
                      "trimmed surfaces and models are not changed by their points");
    }
}

}  // namespace

int hold(Object object) {
    auto& all = all_held();
    std::size_t i = 0;
    while (i < all.size() && all[i]) ++i;
    if (i == all.size()) all.emplace_back();
    all[i] = std::make_unique<Held>(std::move(object));
    return int(i);
}

Held& held(int handle) {
    auto& all = all_held();
    if (handle < 0 || std::size_t(handle) >= all.size() || !all[std::size_t(handle)])
        refuse_to_page("usage", "", "the shape has been freed");
    return *all[std::size_t(handle)];
}

void let_go(int handle) {
    if (auto& all = all_held(); handle >= 0 && std::size_t(handle) < all.size())
        all[std::size_t(handle)].reset();
}

Parts parts_of(const Shape& shape) {
    return visit_one(
        [](const auto& s) -> Parts {
            using S = std::remove_cvref_t<decltype(s)>;
            if constexpr (TensorPatch<S> || TriangularPatch<S>)
                return parts_of_patch(s);
            else if constexpr (std::same_as<S, TrimmedSurface>)
                return visit_one([](const auto& surface) { return parts_of_patch(surface); }, s.surface);
            else
                return {};
        },
        shape);
}

}  // namespace freiform::wasm

using namespace freiform;
using namespace freiform::wasm;

// reply: {"unit", "shapes": [handle], "left_out": [{"where", "message"}]}
FF_EXPORT(document)
void ff_document(const char* bytes, std::size_t size, const char* name, std::size_t name_size) {
    auto document = read({bytes, size}, {name, name_size});
    if (!document) refuse_to_page(document.error());
    json::Writer w;
    w.begin_object().field("unit", document->unit).key("shapes").begin_array();
    for (Object& o : document->objects) w.value(hold(std::move(o)));
    w.end_array().key("left_out").begin_array();
    for (const Refusal& r : document->left_out)
        w.begin_object().field("where", r.where).field("message", r.message).end_object();
    reply().text = w.end_array().end_object().take();
}

// reply: what write_shape says, and as numbers the knots of each parameter, the points, the weights.
FF_EXPORT(describe) void ff_describe(int handle) {
    const Held& h = held(handle);
    const Parts p = parts_of(h.object.shape);
    json::Writer w;
    w.begin_object().field("name", h.object.name);
    write_shape(w, h.object.shape, p);
    reply().text = w.end_object().take();
    std::vector<double>& out = reply().numbers;
    out.clear();
    for (const BSplineBasis& b : p.bases) out.insert(out.end(), b.defining().begin(), b.defining().end());
    const std::size_t count = p.parameters == 0 ? 0 : p.coefficients.count();
    const std::size_t dim = p.parameters == 0 ? 0 : std::size_t(p.coefficients.dim());
    if (h.object.given_points.size() == count * dim)
        out.insert(out.end(), h.object.given_points.begin(), h.object.given_points.end());
    else
        for (std::size_t i = 0; i < count; ++i) {
            const Vec<4> x = p.coefficients.point(i);
            out.insert(out.end(), x.c.begin(), x.c.begin() + long(dim));
        }
    for (std::size_t i = 0; i < count; ++i) out.push_back(p.coefficients.weight(i));
}

FF_EXPORT(with)
int ff_with(int handle, const double* points, std::size_t count, const double* weights,
            std::size_t weight_count) {
    const Held& h = held(handle);
    const Parts p = parts_of(h.object.shape);
    const std::size_t expected =
        p.parameters == 0 ? 0 : p.coefficients.count() * std::size_t(p.coefficients.dim());
    if (expected != 0 && count != expected)
        refuse_to_page("invalid", "points", text("has ", count, " numbers, ", expected, " were expected"));
    if (weight_count != 0 && weight_count != p.coefficients.count())
        refuse_to_page("invalid", "weights",
                       text("has ", weight_count, " numbers, ", p.coefficients.count(), " were expected"));
    auto shape = visit_one(
        [&](const auto& s) {
            return with_coefficients(s, {points, count}, {weights, weight_count});
        },
        h.object.shape);
    if (!shape) refuse_to_page(shape.error());
    Object object{h.object.name, *std::move(shape)};
    object.material = h.object.material;
    if (weight_count != 0) object.given_points.assign(points, points + count);
    return hold(std::move(object));
}

FF_EXPORT(free) void ff_free(int handle) { let_go(handle); }

// reply: the document of these shapes.
FF_EXPORT(write)
void ff_write(const int* handles, std::size_t count, const char* unit, std::size_t unit_size) {
    Document document{{unit, unit_size}, {}};
    for (std::size_t i = 0; i < count; ++i) document.objects.push_back(held(handles[i]).object);
    reply().text = write_document(document);
}
