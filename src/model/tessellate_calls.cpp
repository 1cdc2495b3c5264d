// What callers ask for: options checked, hopeless demands refused, and models of any size brought to a size
// where products of a few lengths neither overflow nor vanish. Powers of two do that without rounding, so the
// mesh is that of the model as it was.
#include "copies_detail.hpp"
#include "tessellator_detail.hpp"
#include "triangle_budget_detail.hpp"

#include <freiform/model/rescale.hpp>
#include <freiform/model/tessellate.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace freiform {

namespace {

Result<void> check_options(const TessellateOptions& options) {
    if (!std::isfinite(options.tolerance))
        return refuse(RefusalKind::nonfinite, "tolerance",
                      text(options.tolerance, " is not a finite number"));
    if (!(options.tolerance > 0))
        return refuse(RefusalKind::invalid, "tolerance", text(options.tolerance, " is not positive"));
    if (!(options.max_edge > 0))
        return refuse(RefusalKind::invalid, "max_edge", text(options.max_edge, " is not positive"));
    if (!(options.max_angle > 0))
        return refuse(RefusalKind::invalid, "max_angle", text(options.max_angle, " is not positive"));
    if (!(options.max_aspect > 1))
        return refuse(RefusalKind::invalid, "max_aspect", text(options.max_aspect, " is not above 1"));
    return {};
}

}  // namespace

namespace {

constexpr int kFarExponent = 256;

// The power of two that brings the vertices near 1, if they are so large or small that products of a few
// lengths overflow or vanish; else 0.
int far_exponent(const Model& model) {
    double most = 0;
    for (const Vertex& v : model.vertices) most = std::max(most, max_abs(v.point));
    const int exponent = most > 0 && std::isfinite(most) ? std::ilogb(most) : 0;
    return std::abs(exponent) > kFarExponent ? exponent : 0;
}

// Back from a model times 2^-exponent. Bounds of what is subnormal grow by its rounding.
Tessellation scaled_back(Tessellation t, int exponent) {
    const double rounding = exponent < -std::numeric_limits<double>::digits - kFarExponent
                                ? 4 * std::numeric_limits<double>::denorm_min()
                                : 0;
    for (Vec<3>& p : t.mesh.points)
        for (double& x : p.c) x = std::ldexp(x, exponent);
    const auto scale = [&](double& bound) { bound = std::ldexp(bound, exponent) + rounding; };
    scale(t.error_bound), scale(t.boundary_gap);
    for (FaceReport& f : t.faces) scale(f.error_bound), scale(f.boundary_gap);
    return t;
}

std::vector<Result<Tessellation>> tessellate_far(const Model& model,
                                                 std::span<const TessellateOptions> options, int exponent) {
    const auto near = rescaled(model, -exponent);
    if (!near) return {options.size(), std::unexpected(near.error())};
    std::vector<TessellateOptions> scaled(options.begin(), options.end());
    for (TessellateOptions& o : scaled) {
        o.tolerance = std::max(std::ldexp(o.tolerance, -exponent), std::numeric_limits<double>::denorm_min());
        o.max_edge = std::ldexp(o.max_edge, -exponent);
    }
    auto all = tessellate(*near, scaled);
    for (auto& t : all)
        if (t) t = scaled_back(std::move(*t), exponent);
    return all;
}

}  // namespace

namespace {

constexpr double kCopiesApart = 0x1p-21;  // of the tolerance

// What tessellations of one model share.
struct Shared {
    std::optional<SharedWork> work;
    Result<Tessellation> run(const Model& model, const TessellateOptions& how, std::vector<double> sizes,
                             const StandIns* stand_ins) {
        if (!work) work.emplace(model);
        return Tessellator(model, *work, how, std::move(sizes), stand_ins).run();
    }
};

// In the order of the faces of originals_of.
template <class T>
std::vector<T> of_originals(std::span<const T> of_faces, const Copies& copies) {
    std::vector<T> out;
    for (std::size_t f = 0; f < of_faces.size(); ++f)
        if (copies.faces[f].of < 0) out.push_back(of_faces[f]);
    return out;
}

// The meshes of a model, or of what stands for it. Copies are looked for once.
class Meshes {
public:
    Meshes(const Model& given, const Model& model, const StandIns* stand_ins)
        : given_(given), model_(model), stand_ins_(stand_ins) {}

    Result<Tessellation> make(const TessellateOptions& how) {
        auto sizes = face_sizes(model_, how);
        if (auto ok = check_budget(model_, how, sizes); !ok) return std::unexpected(ok.error());
        const auto start = std::chrono::steady_clock::now();
        // Normals of copies are not bounded, only what is seen of them in distances.
        const bool may_copy = !std::isfinite(how.max_angle) && model_.faces.size() > 1;
        if (may_copy && !copies_) copies_ = copies_in(given_);
        if (!may_copy || !copies_->any() || copies_->apart() > kCopiesApart * how.tolerance)
            return whole_.run(model_, how, std::move(sizes), stand_ins_);
        if (!reduced_) {
            reduced_ = originals_of(model_, *copies_);
            if (stand_ins_)
                reduced_stand_ins_.faces = of_originals<std::optional<StandIn>>(stand_ins_->faces, *copies_);
        }
        TessellateOptions inner = how;  // what is moved is rounded
        inner.max_edge *= 1 - 0x1p-40;
        inner.tolerance *= 1 - 0x1p-20;
        auto few = originals_.run(*reduced_, inner, of_originals<double>(sizes, *copies_),
                                  stand_ins_ ? &reduced_stand_ins_ : nullptr);
        auto all = few ? with_copies(given_, *copies_, std::move(*few), how) : std::move(few);
        if (all)
            all->seconds.total =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return all;
    }

private:
    const Model &given_, &model_;
    const StandIns* stand_ins_;
    Shared whole_, originals_;
    std::optional<Copies> copies_;
    std::optional<Model> reduced_;
    StandIns reduced_stand_ins_;
};

}  // namespace

std::vector<Result<Tessellation>> tessellate(const Model& model, std::span<const TessellateOptions> options) {
    const bool fine = std::all_of(options.begin(), options.end(),
                                  [](const TessellateOptions& o) { return check_options(o).has_value(); });
    if (const int exponent = far_exponent(model); exponent != 0 && fine)
        return tessellate_far(model, options, exponent);
    Meshes given(model, model, nullptr);
    std::vector<Result<Tessellation>> all;
    for (const TessellateOptions& how : options) {
        if (auto ok = check_options(how); !ok) {
            all.push_back(std::unexpected(ok.error()));
            continue;
        }
        // For each tolerance anew: what may stand for a face depends on it.
        const StandIns stand_ins = stand_ins_for(model, how, true);
        if (!stand_ins.standing) {
            all.push_back(given.make(how));
            continue;
        }
        auto t = Meshes(model, *stand_ins.standing, &stand_ins).make(how);
        // What is refused as what stands for it may be meshed as it is given.
        if (t && std::ranges::any_of(t->refused, [&](const RefusedFace& r) {
                return stand_ins.faces[std::size_t(r.face)].has_value();
            }))
            t = given.make(how);
        all.push_back(std::move(t));
    }
    for (auto& t : all)
        if (t) turn_outwards(model, *t);
    return all;
}

Result<Tessellation> tessellate(const Model& model, const TessellateOptions& options) {
    return std::move(tessellate(model, std::span(&options, 1)).front());
}

}  // namespace freiform
