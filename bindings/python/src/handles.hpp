// What Python holds: one handle for each kind of object, whatever its coordinates are.
#pragma once

#include "convert.hpp"

#include <freiform/mesh/triangle_mesh.hpp>
#include <freiform/shape.hpp>
#include <freiform/spline/in_space.hpp>
#include <freiform/spline/prepared.hpp>

#include <mutex>

namespace freiform::python {

template <std::size_t N>
using PatchVariant = std::variant<Patch<N, Vec<1>>, Patch<N, Vec<2>>, Patch<N, Vec<3>>, Patch<N, Vec<4>>,
                                  Patch<N, Hom<1>>, Patch<N, Hom<2>>, Patch<N, Hom<3>>, Patch<N, Hom<4>>>;

// A patch, and what evaluates it: prepared with the first question, then shared by all threads.
template <std::size_t N>
class PatchHandle {
public:
    explicit PatchHandle(PatchVariant<N> p) : patch(std::make_shared<const PatchVariant<N>>(std::move(p))) {}
    std::shared_ptr<const PatchVariant<N>> patch;

    const detail::PreparedNet* prepared() const {
        std::call_once(cache_->once, [&] {
            std::visit(
                [&](const auto& p) {
                    auto net = detail::PreparedNet::make(p.bases(), tuples(p.net().flat()));
                    if (net) cache_->net.emplace(std::move(*net));
                },
                *patch);
        });
        return cache_->net ? &*cache_->net : nullptr;
    }

private:
    struct Cache {
        std::once_flag once;
        std::optional<detail::PreparedNet> net;
    };
    std::shared_ptr<Cache> cache_ = std::make_shared<Cache>();
};
using CurveHandle = PatchHandle<1>;
using SurfaceHandle = PatchHandle<2>;
using VolumeHandle = PatchHandle<3>;

struct TriangleHandle {
    std::variant<Triangle<Vec<1>>, Triangle<Vec<2>>, Triangle<Vec<3>>, Triangle<Vec<4>>, Triangle<Hom<1>>,
                 Triangle<Hom<2>>, Triangle<Hom<3>>, Triangle<Hom<4>>>
        patch;
};
struct TrimmedHandle {
    std::shared_ptr<const TrimmedSurface> surface;
};
struct ModelHandle {
    std::shared_ptr<const Model> model;
};
struct MeshHandle {
    std::shared_ptr<const TriangleMesh> mesh;
};
struct DocumentHandle {
    std::shared_ptr<const Document> document;
};

// The Python object (freiform.Curve, ..) around a handle.
template <class Handle>
py::object in_class(const char* module, const char* name, Handle handle) {
    return attribute(module, name).attr("_of")(py::cast(std::move(handle)));
}
template <std::size_t N, class P>
struct Wrapped<Patch<N, P>> {
    static py::object object(const Patch<N, P>& p) {
        return in_class("freiform._patches",
                        N == 1   ? "Curve"
                        : N == 2 ? "Surface"
                                 : "Volume",
                        PatchHandle<N>(PatchVariant<N>(p)));
    }
};
template <std::size_t N, class P>
struct Wrapped<Patch<N, P, Bernstein>> {
    static py::object object(const Patch<N, P, Bernstein>& p) {
        std::array<BSplineBasis, N> bases = [&]<std::size_t... D>(std::index_sequence<D...>) {
            return std::array<BSplineBasis, N>{detail::spline_basis(p.bases()[D])...};
        }
        (std::make_index_sequence<N>{});
        return Wrapped<Patch<N, P>>::object(Patch<N, P>::trusted(std::move(bases), p.net()));
    }
};
template <class P>
struct Wrapped<SimplexPatch<2, P>> {
    static py::object object(const SimplexPatch<2, P>& p) {
        return in_class("freiform._triangles", "TriangularPatch", TriangleHandle{p});
    }
};
template <>
struct Wrapped<TrimmedSurface> {
    static py::object object(const TrimmedSurface& s) {
        return in_class("freiform._models", "TrimmedSurface",
                        TrimmedHandle{std::make_shared<const TrimmedSurface>(s)});
    }
};
template <>
struct Wrapped<Model> {
    static py::object object(const Model& m) {
        return in_class("freiform._models", "Model", ModelHandle{std::make_shared<const Model>(m)});
    }
};
template <>
struct Wrapped<TriangleMesh> {
    static py::object object(const TriangleMesh& m) {
        return in_class("freiform._meshes", "Mesh", MeshHandle{std::make_shared<const TriangleMesh>(m)});
    }
};
template <>
struct Wrapped<BSplineBasis> {
    static py::object object(const BSplineBasis& b) {
        return attribute("freiform._basis", "Basis").attr("_of")(py::cast(b));
    }
};
template <>
struct Wrapped<BandMap> {  // as a dense matrix
    static py::object object(const BandMap& m) {
        py::array_t<double> a({m.rows(), m.cols});
        std::fill_n(a.mutable_data(), a.size(), 0.0);
        for (int i = 0; i < m.rows(); ++i)
            for (int k = 0; k < m.width; ++k)
                a.mutable_at(i, (m.first[std::size_t(i)] + k) % m.cols) += m.row(i)[std::size_t(k)];
        return a;
    }
};

template <class P>
inline constexpr int dim_of = Space<P>::kDim;
template <class Patch>
using CoefficientOf = typename std::remove_cvref_t<Patch>::Coefficients;

// f(patch) for patches of the dimensions Least .. Most; others are refused.
template <int Least, int Most, class Variant, class F>
py::object visit_dims(const Variant& v, std::string_view where, F&& f) {
    return std::visit(
        [&](const auto& p) -> py::object {
            constexpr int d = dim_of<CoefficientOf<decltype(p)>>;
            if constexpr (d >= Least && d <= Most)
                return f(p);
            else
                reject(RefusalKind::unsupported, std::string(where),
                       text("has ", d, " coordinates; ",
                            Least == Most ? text(Least) : text(Least, " to ", Most), " are needed"));
        },
        v);
}

// The patch with coefficients P: weights 1 and coordinates 0 are added where it has none.
template <class P, std::size_t N>
Patch<N, P> as(const PatchVariant<N>& v, std::string_view where) {
    return std::visit(
        [&](const auto& p) -> Patch<N, P> {
            using Q = CoefficientOf<decltype(p)>;
            if constexpr (std::same_as<P, Q>) {
                return p;
            } else if constexpr (dim_of<P> == 3 && dim_of<Q> < 3 &&
                                 Space<P>::kRational >= Space<Q>::kRational) {
                return as<P, N>(PatchVariant<N>(in_space(p)), where);
            } else if constexpr (dim_of<P> == dim_of<Q> && Space<P>::kRational) {
                return to_rational(p);
            } else {
                reject(RefusalKind::unsupported, std::string(where),
                       text("is ", Space<Q>::kRational ? "rational" : "polynomial", " and has ", dim_of<Q>,
                            " coordinates; ", dim_of<P>, " are needed",
                            Space<P>::kRational ? "" : " and no weights"));
            }
        },
        v);
}

struct Common {
    int dim = 1;
    bool rational = false;
};
template <std::size_t N>
Common common_of(std::span<const PatchHandle<N>> all) {
    Common c;
    for (const auto& h : all)
        std::visit(
            [&](const auto& p) {
                using P = CoefficientOf<decltype(p)>;
                c.dim = std::max(c.dim, dim_of<P>);
                c.rational = c.rational || Space<P>::kRational;
            },
            *h.patch);
    return c;
}

// f(vector of patches) of one kind, that of the most general of them, of Least .. Most dimensions.
template <int Least, int Most, std::size_t N, class F>
py::object with_common(std::span<const PatchHandle<N>> all, std::string_view where, F&& f) {
    const Common c = common_of(all);
    const auto go = [&]<class P>(std::type_identity<P>) -> py::object {
        if constexpr (dim_of<P> >= Least && dim_of<P> <= Most) {
            std::vector<Patch<N, P>> same;
            for (std::size_t i = 0; i < all.size(); ++i)
                same.push_back(as<P, N>(*all[i].patch, text(where, "[", i, "]")));
            return f(std::move(same));
        } else {
            reject(RefusalKind::unsupported, std::string(where),
                   text(dim_of<P>, " coordinates; from ", Least, " to ", Most, " are needed"));
        }
    };
    return with_dimension(c.dim, where, [&](auto d) {
        return c.rational ? go(std::type_identity<Hom<decltype(d)::value>>())
                          : go(std::type_identity<Vec<decltype(d)::value>>());
    });
}

}  // namespace freiform::python
