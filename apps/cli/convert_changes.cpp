#include "convert_changes.hpp"

#include "input.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/io/document.hpp>
#include <freiform/spline/bezier.hpp>
#include <freiform/spline/refine.hpp>
#include <freiform/spline/simplex_convert.hpp>

#include <algorithm>
#include <functional>

namespace freiform::cli {

namespace {

constexpr std::string_view kAxisNames = "uvw";

// The library's functions for patches of any kind, on shapes. REQUIRES a curve, surface or volume.
template <class F>
Result<Shape> with_patch(const Shape& shape, F&& change) {
    return visit_one(
        [&](const auto& s) -> Result<Shape> {
            if constexpr (TensorPatch<std::remove_cvref_t<decltype(s)>>) {
                auto converted = change(s);
                if (!converted) return std::unexpected(std::move(converted.error()));
                return Result<Shape>(std::in_place, *std::move(converted));
            } else {
                return shape;
            }
        },
        shape);
}

Result<Shape> with_knots(const Shape& shape, int axis, std::span<const double> knots) {
    return with_patch(shape, [&](const auto& s) { return insert_knots(s, axis, knots); });
}
Result<Shape> elevated(const Shape& shape, int axis, int by) {
    return with_patch(shape, [&](const auto& s) { return elevate(s, axis, by); });
}
Result<Shape> restricted(const Shape& shape, int axis, const Interval& on) {
    return with_patch(shape, [&](const auto& s) { return restrict_to(s, axis, on); });
}
Result<Shape> reversed(const Shape& shape, int axis) {
    return with_patch(shape, [&](const auto& s) { return Result<Shape>(std::in_place, reverse(s, axis)); });
}
Result<Shape> reduced(const Shape& shape, int axis, double tolerance, double& bound, int& removed) {
    return with_patch(shape, [&](const auto& s) -> Result<std::remove_cvref_t<decltype(s)>> {
        auto thin = remove_knots(s, axis, tolerance);
        if (!thin) return std::unexpected(std::move(thin.error()));
        bound = thin->bound, removed = thin->removed;
        return std::move(thin->patch);
    });
}

template <std::size_t N, class P>
void add_bezier_pieces(const Patch<N, P>& patch, const std::string& suffix, Pieces& all) {
    const auto pieces = decompose(patch);
    const bool one = count_of(pieces.extent()) == 1;
    each_index(pieces.extent(), [&](const Index<N>& at) {
        const auto piece = pieces.piece(at);
        auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
            return std::array<BSplineBasis, N>{
                *BSplineBasis::bezier(piece.basis(int(I)).degree(), piece.basis(int(I)).domain())...};
        }
        (std::make_index_sequence<N>{});
        std::string name = suffix;
        if (!one)
            for (const int i : at) name += text(".", i);
        all.push_back({std::move(name), Patch<N, P>::trusted(std::move(bases), piece.net())});
    });
}

class Changes {
public:
    Changes(const ConvertArguments& options, const Shape& patch)
        : o_(options), axes_(bases_of(patch).size()) {
        all_.pieces.push_back({"", patch});
    }

    Result<Changed> run() {
        if (!o_.axis.empty() && axis_or(0) >= axes_)
            return refuse(
                RefusalKind::no_answer, "--axis",
                text("the object has ", axes_, axes_ == 1 ? " parameter" : " parameters", ", no ", o_.axis));
        Result<void> ok;
        if (!o_.knots.empty()) ok = insert();
        if (ok && o_.elevate) ok = elevate_all();
        if (ok && o_.reduce) ok = reduce();
        if (ok && o_.split) ok = split();
        if (ok && o_.reverse)
            ok = each("--reverse", [&](const Shape& s) { return reversed(s, int(axis_or(0))); });
        if (!ok) return std::unexpected(ok.error());
        if (o_.to_bezier || o_.to_triangles) to_bezier();
        if (o_.to_triangles) ok = to_triangle_pairs();
        if (!ok) return std::unexpected(ok.error());
        return std::move(all_);
    }

private:
    std::size_t axis_or(std::size_t otherwise) const {
        return o_.axis.empty() ? otherwise : kAxisNames.find(o_.axis[0]);
    }

    // The library calls wrong numbers invalid; here they are questions without an answer.
    static std::unexpected<Refusal> about(std::string_view option, Refusal r) {
        if (r.kind == RefusalKind::invalid || r.kind == RefusalKind::unsupported)
            r.kind = RefusalKind::no_answer;
        return refuse_within(option, std::move(r));
    }

    Result<void> each(std::string_view option, const std::function<Result<Shape>(const Shape&)>& change) {
        for (ConvertedPiece& piece : all_.pieces) {
            auto converted = change(piece.shape);
            if (!converted) return about(option, converted.error());
            piece.shape = *std::move(converted);
        }
        return {};
    }

    Result<void> insert() {
        std::vector<double> sorted = o_.knots;
        sort(sorted.begin(), sorted.end());
        return each("--insert-knots", [&](const Shape& s) { return with_knots(s, int(axis_or(0)), sorted); });
    }

    Result<void> elevate_all() {
        Result<void> ok;
        for (std::size_t d = 0; d < axes_ && ok; ++d)
            if (o_.axis.empty() || axis_or(0) == d)
                ok = each("--elevate", [&](const Shape& s) { return elevated(s, int(d), *o_.elevate); });
        return ok;
    }

    // Each axis may use what the ones before have left of the tolerance, so that the sum stays within it.
    Result<void> reduce() {
        for (std::size_t d = 0; d < axes_; ++d) {
            if (!o_.axis.empty() && axis_or(0) != d) continue;
            double bound = 0;
            int removed = 0;
            Shape& shape = all_.pieces[0].shape;
            auto thin = reduced(shape, int(d), std::max(*o_.reduce - all_.bound, 0.0), bound, removed);
            if (!thin) return about("--reduce", thin.error());
            shape = *std::move(thin);
            all_.bound = bound == 0 ? all_.bound : std::nextafter(all_.bound + bound, 1e308);
            all_.removed += removed;
        }
        return {};
    }

    Result<void> split() {
        Pieces halves;
        const std::size_t axis = axis_or(0);
        for (const ConvertedPiece& piece : all_.pieces) {
            const Interval on = bases_of(piece.shape)[axis].domain();
            if (!(on.lo < *o_.split && *o_.split < on.hi))
                return refuse(RefusalKind::out_of_domain, "--split",
                              text(*o_.split, " is not inside the domain [", on.lo, ", ", on.hi, "]"));
            int k = 0;
            for (const Interval half : {Interval{on.lo, *o_.split}, Interval{*o_.split, on.hi}}) {
                auto s = restricted(piece.shape, int(axis), half);
                if (!s) return about("--split", s.error());
                halves.push_back({text(piece.suffix, k++ == 0 ? ".a" : ".b"), *std::move(s)});
            }
        }
        all_.pieces = std::move(halves);
        return {};
    }

    // Bezier patches as their two halves.
    Result<void> to_triangle_pairs() {
        Pieces all;
        double worst = 0;
        for (const ConvertedPiece& piece : all_.pieces) {
            const auto done = visit_one(
                [&](const auto& s) -> Result<void> {
                    if constexpr (TensorPatch<std::remove_cvref_t<decltype(s)>>)
                        if constexpr (std::remove_cvref_t<decltype(s)>::kParams == 2) {
                            auto two = to_triangles(BezierPieces(s).piece({0, 0}));
                            if (!two) return about("--to-triangles", two.error());
                            for (std::size_t i = 0; i < 2; ++i)
                                all.push_back(
                                    {text(piece.suffix, i == 0 ? ".a" : ".b"), std::move(two->parts[i])});
                            worst = std::max(worst, two->bound);
                            return {};
                        }
                    return refuse(RefusalKind::no_answer, "--to-triangles", "is for surfaces");
                },
                piece.shape);
            if (!done) return done;
        }
        all_.pieces = std::move(all);
        if (worst > 0) all_.bound = std::nextafter(all_.bound + worst, 1e308);
        return {};
    }

    void to_bezier() {
        Pieces all;
        for (const ConvertedPiece& piece : all_.pieces)
            visit_one(
                [&](const auto& s) {
                    if constexpr (TensorPatch<std::remove_cvref_t<decltype(s)>>)
                        add_bezier_pieces(s, piece.suffix, all);
                },
                piece.shape);
        all_.pieces = std::move(all);
    }

    const ConvertArguments& o_;
    std::size_t axes_;
    Changed all_;
};

// A triangle is a Bezier patch already. It is cut from a corner to the opposite edge: u and v run along those
// of the axes, w from u = 1 to v = 1.
template <class P>
Result<Changed> changed_triangle(const Triangle<P>& s, const ConvertArguments& o) {
    if (!o.knots.empty())
        return refuse(RefusalKind::no_answer, "--insert-knots", "is a triangle, which has no knots");
    if (!o.axis.empty() && !o.split)
        return refuse(RefusalKind::no_answer, "--axis", "is a triangle; there, it is for --split");
    Result<Triangle<P>> out = s;
    for (int i = 0; i < o.elevate.value_or(0) && out; ++i) out = elevate(*out);
    if (!out) return refuse(RefusalKind::no_answer, "--elevate", out.error().message);
    double bound = 0;
    while (o.reduce && out->degree() > 1) {
        auto lower = reduce_degree(*out, std::max(*o.reduce - bound, 0.0));
        if (!lower) break;
        out = std::move(lower->patch);
        bound = std::nextafter(bound + lower->bound, 1e308);
    }
    std::vector<std::pair<std::string, Triangle<P>>> parts{{"", *out}};
    if (o.split) {
        if (!(*o.split > 0 && *o.split < 1))
            return refuse(RefusalKind::out_of_domain, "--split", text(*o.split, " is not inside (0, 1)"));
        const int edge = o.axis == "v" ? 1 : o.axis == "w" ? 0 : 2;
        auto two = split_edge(*out, edge, edge == 1 ? 1 - *o.split : *o.split);
        parts = {{".a", std::move(two[edge == 1])}, {".b", std::move(two[edge != 1])}};
    }
    Changed all;
    double cut_bound = 0;
    for (auto& [suffix, part] : parts) {
        if (o.reverse) part = reversed(part);
        if (!o.to_surfaces) {
            all.pieces.push_back({suffix, std::move(part)});
            continue;
        }
        auto three = to_three_surfaces(part);
        if (!three) return refuse_within("--to-surfaces", three.error());
        for (std::size_t i = 0; i < 3; ++i)
            all.pieces.push_back({text(suffix, ".", i), std::move(three->parts[i])});
        cut_bound = std::max(cut_bound, three->bound);
    }
    all.bound = cut_bound > 0 ? std::nextafter(bound + cut_bound, 1e308) : bound;
    return all;
}

}  // namespace

Result<Changed> converted(const Shape& shape, const ConvertArguments& options) {
    const std::string_view type = type_name(shape);
    if (type == "trimmed" || type == "model")
        return refuse(
            RefusalKind::no_answer, "",
            text("is a ", type, "; the options that change a shape are for curves, surfaces and volumes"));
    return visit_one(
        [&](const auto& s) -> Result<Changed> {
            if constexpr (TriangularPatch<std::remove_cvref_t<decltype(s)>>)
                return changed_triangle(s, options);
            else
                return Changes(options, shape).run();
        },
        shape);
}

}  // namespace freiform::cli
