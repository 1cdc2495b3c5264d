// Offsets of splines as splines.
//
// Idea. In each cell of a grid the bicubic Hermite interpolant H of the offset O = S + d n, from its values,
// tangents and twists at the corners: off by about (h^4 O_uuuu + k^4 O_vvvv) / 384. Neighbours share what
// they interpolate along a side, so all cells together are one spline.
//
// Proof. In the cells of a coarser grid polynomials G of degree 5, which interpolate O at the places of
// Chebyshev and Lobatto, are near it as h^6; how near is proven (offset_bound.cpp). The distance of H from G
// is that of their Bernstein coefficients.
//
// Method. How far polynomials are off in the middle of sides says how many parts an interval of a grid needs;
// then all cells are proven, and those that fail are cut further.
//
// Cost. A cell of the coarse grid takes some 50 microseconds, a cell of the fine one 5.
//
// Why two grids: a proof for each cell of the fine one takes three to five times as long in all. Why not G
// for both: what meshes a spline asks about pieces of 16 coefficients sooner than about such of 36.
#include "offset_bound_detail.hpp"
#include "offset_grid_detail.hpp"

#include <freiform/basis/change.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/make/offset_spline.hpp>
#include <freiform/spline/bezier.hpp>
#include <freiform/spline/jet.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kForSides = 0.3;        // of the tolerance, in the middle of a side along each axis
constexpr double kForKnownSides = 0.12;  // likewise, of their part
constexpr int kRounds = 12;
constexpr std::size_t kMostCells = std::size_t(1) << 16, kMostKnown = std::size_t(1) << 14;  // of the grids
constexpr double kKnown = 0.5;  // of the tolerance, for the polynomials of the coarse grid

using namespace detail;

// Of polynomials with weights 1: half of the code, and little more time.
class Maker {
public:
    Maker(Surface<Hom<3>> base, bool is_rational, double distance, double tolerance)
        : base_(std::move(base)), is_rational_(is_rational), distance_(distance), tolerance_(tolerance) {}

    Result<MadeSurface<Vec<3>>> make(const std::array<Interval, 2>& on) {
        if (auto ok = prepare(on); !ok) return std::unexpected(ok.error());
        const auto known = find_known();
        if (!known) return std::unexpected(known.error());
        lines_ = known_lines_;
        for (int round = 0; round < kRounds && cells_of(lines_) <= kMostCells; ++round) {
            if (auto ok = fit(); !ok) return std::unexpected(ok.error());
            if (cut_by_sides(lines_, errors_, kForSides * (tolerance_ - *known), 4)) continue;
            Surface<Vec<3>> made = assembled();
            compare(made);
            const double bound = *known + largest_bound(errors_);
            if (bound <= tolerance_) return MadeSurface<Vec<3>>{std::move(made), bound};
            if (!cut_failed(lines_, errors_, tolerance_ - *known)) break;
        }
        return too_many();
    }

private:
    using Known = std::array<Vec<3>, kNodes * kNodes>;

    std::unexpected<Refusal> too_many() const {
        return refuse(RefusalKind::limit, "tolerance",
                      text(tolerance_, " is not reached with up to ", kMostCells, " pieces"));
    }
    static std::unexpected<Refusal> crease(int axis, double at) {
        return refuse(RefusalKind::unsupported, "base",
                      text("has a crease at ", axis == 0 ? "u = " : "v = ", at));
    }
    static std::unexpected<Refusal> no_normal() {
        return refuse(RefusalKind::ill_conditioned, "base", "has no normal at some place");
    }

    Result<void> prepare(const std::array<Interval, 2>& on) {
        for (int axis = 0; axis < 2; ++axis) {
            auto part = restrict_to(base_, axis, on[std::size_t(axis)]);
            if (!part) return std::unexpected(part.error());
            base_ = *std::move(part);
            const BSplineBasis& basis = base_.basis(axis);
            if (basis.degree() < 1 || basis.degree() > detail::kMostOffsetDegree)
                return refuse(RefusalKind::unsupported, "base",
                              text("is of degree ", basis.degree(), "; 1 to ", detail::kMostOffsetDegree,
                                   " are known"));
            for (const double at : basis.breaks()) {
                const bool inside = basis.domain().lo < at && at < basis.domain().hi;
                const int m = inside ? basis.multiplicity(at) : 0;
                if (m > basis.degree()) return crease(axis, at);
                known_lines_[std::size_t(axis)].push_back({at, inside && m + 1 >= basis.degree()});
            }
        }
        for (const Hom<3>& p : base_.net().flat()) size_ = std::max(size_, max_abs(project(p)));
        size_ += std::abs(distance_);
        return {};
    }

    // Polynomials near the offset in the cells of a coarse grid, each for itself, and what is proven of them.
    Result<double> find_known() {
        for (int round = 0; round < kRounds && cells_of(known_lines_) <= kMostKnown; ++round) {
            Surface<Hom<3>> all = base_;
            for (std::size_t axis = 0; axis < 2; ++axis) {
                std::vector<double> more;
                const auto breaks = all.basis(int(axis)).breaks();
                for (const GridLine& l : known_lines_[axis])
                    if (!std::ranges::binary_search(breaks, l.at)) more.push_back(l.at);
                auto refined = insert_knots(all, int(axis), more);
                if (!refined) return std::unexpected(refined.error());
                all = *std::move(refined);
            }
            pieces_.emplace(all);
            const std::size_t columns = known_lines_[1].size() - 1;
            known_.assign(cells_of(known_lines_), {});
            errors_.assign(known_.size(), {});
            std::vector<char> bad(known_.size(), 0);
            parallel_for(known_.size(), 4, [&](std::size_t k) {
                bad[k] = !interpolate({int(k / columns), int(k % columns)}, known_[k], errors_[k]);
            });
            if (std::ranges::find(bad, 1) != bad.end()) return no_normal();
            if (cut_by_sides(known_lines_, errors_, kForKnownSides * kKnown * tolerance_, kDegree + 1))
                continue;
            parallel_for(known_.size(), 4, [&](std::size_t k) {
                const Index<2> at{int(k / columns), int(k % columns)};
                const NetView<2, const Vec<3>> net{
                    known_[k].data(), {int(kNodes), int(kNodes)}, {std::ptrdiff_t(kNodes), 1}};
                errors_[k].bound = proven(net, pieces_->net(at));
            });
            if (const double bound = largest_bound(errors_); bound <= kKnown * tolerance_) return bound;
            if (!cut_failed(known_lines_, errors_, kKnown * tolerance_)) break;
        }
        return too_many();
    }

    double proven(const NetView<2, const Vec<3>>& h, const NetView<2, const Hom<3>>& base) const {
        if (is_rational_) return offset_bound<Hom<3>>(h, base, distance_, size_);
        std::vector<Vec<3>> net;
        for (int i = 0; i < base.extent[0]; ++i)
            for (int j = 0; j < base.extent[1]; ++j) net.push_back(project(base({i, j})));
        const NetView<2, const Vec<3>> plain{net.data(), base.extent, {base.extent[1], 1}};
        return offset_bound<Vec<3>>(h, plain, distance_, size_);
    }

    std::optional<Vec<3>> offset_at(const Patch<2, Hom<3>, Bernstein>& piece, const Vec<2>& at) const {
        const auto s = piece.template jet<1>({at[0], at[1]});
        const Vec<3> m = cross(s(1, 0), s(0, 1));
        if (!(norm(m) > 0)) return std::nullopt;
        return s.value() + distance_ * unit(m);
    }

    bool interpolate(const Index<2>& at, Known& out, Errors& errors) const {
        const Interpolation& how = interpolation();
        const auto piece = pieces_->piece(at);
        const auto on = pieces_->box(at);
        const auto place = [&](double s, double t) {
            return Vec<2>{{s == 1 ? on[0].hi : on[0].lo + s * on[0].length(),
                           t == 1 ? on[1].hi : on[1].lo + t * on[1].length()}};
        };
        Known value, rows;
        for (std::size_t a = 0; a < kNodes; ++a)
            for (std::size_t b = 0; b < kNodes; ++b) {
                const auto p = offset_at(piece, place(how.node[a], how.node[b]));
                if (!p) return false;
                value[a * kNodes + b] = *p;
            }
        for (std::size_t i = 0; i < kNodes; ++i)
            for (std::size_t b = 0; b < kNodes; ++b) {
                Vec<3> sum{};
                for (std::size_t a = 0; a < kNodes; ++a) sum += how.inverse[i][a] * value[a * kNodes + b];
                rows[i * kNodes + b] = sum;
            }
        for (std::size_t i = 0; i < kNodes; ++i)
            for (std::size_t j = 0; j < kNodes; ++j) {
                Vec<3> sum{};
                for (std::size_t b = 0; b < kNodes; ++b) sum += how.inverse[j][b] * rows[i * kNodes + b];
                out[i * kNodes + j] = sum;
            }
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const auto p = offset_at(piece, axis == 0 ? place(0.5, 0) : place(0, 0.5));
            if (!p) return false;
            Vec<3> sum{};
            for (std::size_t k = 0; k < kNodes; ++k) sum += how.half[k] * out[axis == 0 ? k * kNodes : k];
            errors.off[axis] = norm(sum - *p);
        }
        return true;
    }

    // The cell of the coarse grid that an interval of the fine one lies in.
    std::vector<int> coarse_of(std::size_t axis) const {
        std::vector<int> out;
        int at = 0;
        for (std::size_t i = 0; i + 1 < lines_[axis].size(); ++i) {
            while (known_lines_[axis][std::size_t(at) + 1].at <= lines_[axis][i].at) ++at;
            out.push_back(at);
        }
        return out;
    }

    // Hermite's data in all corners, from both sides of lines across which tangents jump.
    Result<void> fit() {
        std::array<std::vector<std::pair<double, int>>, 2> places;  // with a cell of the coarse grid
        for (std::size_t axis = 0; axis < 2; ++axis) {
            coarse_[axis] = coarse_of(axis);
            corner_[axis].clear();
            const auto& lines = lines_[axis];
            places[axis].push_back({lines[0].at, 0});
            for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
                const int first = int(places[axis].size()) - 1;
                places[axis].push_back({lines[i + 1].at, coarse_[axis][i]});
                corner_[axis].push_back(first);
                if (lines[i + 1].bends && i + 2 < lines.size())
                    places[axis].push_back({lines[i + 1].at, coarse_[axis][i + 1]});
            }
        }
        columns_ = places[1].size();
        corners_.assign(places[0].size() * columns_, {});
        std::vector<char> bad(corners_.size(), 0);
        parallel_for(corners_.size(), 16, [&](std::size_t k) {
            const auto &u = places[0][k / columns_], &v = places[1][k % columns_];
            const auto at = offset_jet(
                pieces_->piece({u.second, v.second}).template jet<3>({u.first, v.first}), distance_);
            bad[k] = !at;
            if (at) corners_[k] = *at;
        });
        if (std::ranges::find(bad, 1) != bad.end()) return no_normal();
        // Normals on both sides of a line are one, whatever its knots allow.
        for (std::size_t axis = 0; axis < 2; ++axis)
            for (std::size_t i = 0; i + 1 < corner_[axis].size(); ++i)
                for (std::size_t k = 0; lines_[axis][i + 1].bends && k < places[1 - axis].size(); ++k) {
                    const std::size_t below = std::size_t(corner_[axis][i]) + 1, above = below + 1;
                    const auto at = [&](std::size_t line) {
                        return corners_[axis == 0 ? line * columns_ + k : k * columns_ + line].value;
                    };
                    if (!(norm(at(below) - at(above)) < tolerance_))
                        return crease(int(axis), lines_[axis][i + 1].at);
                }
        const std::size_t columns = lines_[1].size() - 1;
        errors_.assign(cells_of(lines_), {});
        parallel_for(errors_.size(), 16, [&](std::size_t k) {
            for (std::size_t axis = 0; axis < 2; ++axis)
                errors_[k].off[axis] = off_side(k / columns, k % columns, axis);
        });
        return {};
    }
    const OffsetJet& corner(std::size_t i, std::size_t j, bool right, bool above) const {
        return corners_[std::size_t(corner_[0][i] + right) * columns_ + std::size_t(corner_[1][j] + above)];
    }
    double length(std::size_t axis, std::size_t i) const {
        return lines_[axis][i + 1].at - lines_[axis][i].at;
    }
    // Where the cell lies in that of the coarse grid.
    Interval part_of(std::size_t axis, std::size_t i) const {
        const auto& known = known_lines_[axis];
        const std::size_t k = std::size_t(coarse_[axis][i]);
        const double from = known[k].at, by = known[k + 1].at - from;
        const auto& l = lines_[axis];
        return {(l[i].at - from) / by, l[i + 1].at == known[k + 1].at ? 1 : (l[i + 1].at - from) / by};
    }
    const Known& known_at(std::size_t i, std::size_t j) const {
        return known_[std::size_t(coarse_[0][i]) * (known_lines_[1].size() - 1) + std::size_t(coarse_[1][j])];
    }

    double off_side(std::size_t i, std::size_t j, std::size_t axis) const {
        const OffsetJet &a = corner(i, j, false, false), &b = corner(i, j, axis == 0, axis == 1);
        const Vec<3> slope = axis == 0 ? a.u - b.u : a.v - b.v;
        const Vec<3> here = 0.5 * (a.value + b.value) + (length(axis, axis == 0 ? i : j) / 8) * slope;
        const Interval u = part_of(0, i), v = part_of(1, j);
        Known net = known_at(i, j);
        const Vec<2> at{{axis == 0 ? u.middle() : u.lo, axis == 1 ? v.middle() : v.lo}};
        for (std::size_t k = 0; k < kNodes; ++k) keep_left(Fibre<Vec<3>>{&net[k * kNodes], kNodes, 1}, at[1]);
        keep_left(Fibre<Vec<3>>{&net[kDegree], kNodes, kNodes}, at[0]);
        return norm(here - net.back());
    }

    Vec<3> control(std::size_t i, std::size_t j, std::size_t k, std::size_t l) const {
        const bool right = k > 1, above = l > 1;
        const OffsetJet& c = corner(i, j, right, above);
        const double du = k == 1   ? length(0, i) / 3
                          : k == 2 ? -length(0, i) / 3
                                   : 0,
                     dv = l == 1   ? length(1, j) / 3
                          : l == 2 ? -length(1, j) / 3
                                   : 0;
        return c.value + du * c.u + dv * c.v + (du * dv) * c.uv;
    }

    // At double knots the middle of the two control points beside it is no control point.
    Surface<Vec<3>> assembled() const {
        struct Row {
            std::size_t cell, of;
        };
        std::array<std::vector<Row>, 2> rows;
        std::array<std::vector<double>, 2> knots;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const auto& lines = lines_[axis];
            knots[axis].assign(4, lines.front().at);
            rows[axis].push_back({0, 0});
            for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
                const bool last = i + 2 == lines.size();
                for (const std::size_t k : {1, 2}) rows[axis].push_back({i, k});
                if (last || lines[i + 1].bends) rows[axis].push_back({i, 3});
                knots[axis].insert(knots[axis].end(), last ? 4 : lines[i + 1].bends ? 3 : 2, lines[i + 1].at);
            }
        }
        std::vector<Vec<3>> net;
        net.reserve(rows[0].size() * rows[1].size());
        for (const Row& r : rows[0])
            for (const Row& s : rows[1]) net.push_back(control(r.cell, s.cell, r.of, s.of));
        return Surface<Vec<3>>::trusted(
            {*BSplineBasis::make(3, std::move(knots[0])), *BSplineBasis::make(3, std::move(knots[1]))},
            Net<2, Vec<3>>({int(rows[0].size()), int(rows[1].size())}, std::move(net)));
    }

    // With the polynomial of the coarse grid, by their Bernstein coefficients.
    void compare(const Surface<Vec<3>>& made) {
        const auto h = decompose(made);
        const std::size_t columns = lines_[1].size() - 1;
        const double rounding = kOffsetRounding * 4 * kDegree * size_;
        parallel_for(errors_.size(), 16, [&](std::size_t k) {
            const std::size_t i = k / columns, j = k % columns;
            Known net = known_at(i, j);
            const Interval u = part_of(0, i), v = part_of(1, j);
            const auto keep = [](Fibre<Vec<3>> f, Interval on) {
                if (on.hi < 1) keep_left(f, on.hi);
                if (on.lo > 0) keep_right(f, on.lo / on.hi);
            };
            for (std::size_t r = 0; r < kNodes; ++r) keep({&net[r * kNodes], kNodes, 1}, v);
            for (std::size_t r = 0; r < kNodes; ++r) keep({&net[r], kNodes, kNodes}, u);
            const NetView<2, const Vec<3>> own = h.net({int(i), int(j)});
            std::array<Vec<3>, 4 * kNodes> raised;
            for (std::size_t r = 0; r < 4; ++r)
                raise(
                    [&](std::size_t l) {
                        return own({int(r), int(l)});
                    },
                    [&](std::size_t l) -> Vec<3>& { return raised[r * kNodes + l]; });
            double most = 0;
            for (std::size_t l = 0; l < kNodes; ++l) {
                std::array<Vec<3>, kNodes> column;
                raise([&](std::size_t r) { return raised[r * kNodes + l]; },
                      [&](std::size_t r) -> Vec<3>& { return column[r]; });
                for (std::size_t r = 0; r < kNodes; ++r)
                    most = std::max(most, norm(column[r] - net[r * kNodes + l]));
            }
            errors_[k].bound = (most + rounding) * (1 + 1e-9);
        });
    }
    // From degree 3 to 5.
    template <class From, class To>
    static void raise(const From& c, const To& to) {
        static_assert(kDegree == 5);
        to(0) = c(0), to(5) = c(3);
        to(1) = 0.4 * c(0) + 0.6 * c(1);
        to(2) = 0.1 * c(0) + 0.6 * c(1) + 0.3 * c(2);
        to(3) = 0.3 * c(1) + 0.6 * c(2) + 0.1 * c(3);
        to(4) = 0.6 * c(2) + 0.4 * c(3);
    }

    Surface<Hom<3>> base_;
    bool is_rational_;
    double distance_, tolerance_, size_ = 0;
    Lines known_lines_, lines_;
    std::optional<BezierPieces<2, Hom<3>>> pieces_;  // of the base, over the coarse grid
    std::vector<Known> known_;
    std::array<std::vector<int>, 2> coarse_, corner_;  // of intervals: the coarse one, its first corner
    std::size_t columns_ = 0;
    std::vector<OffsetJet> corners_;
    std::vector<Errors> errors_;
};

// What a spline sweeps along a line is a spline of the same parameters.
std::optional<Surface<Hom<3>>> swept(const Extrusion& e, const Interval& along) {
    const auto* plain = std::get_if<Curve<Vec<3>>>(&e.profile);
    const auto* rational = std::get_if<Curve<Hom<3>>>(&e.profile);
    const auto across = BSplineBasis::bezier(1, along);
    if ((!plain && !rational) || !across) return std::nullopt;
    const Curve<Hom<3>> profile = plain ? to_rational(*plain) : *rational;
    std::vector<Hom<3>> net;
    for (const Hom<3>& p : profile.net().flat())
        for (const double v : {along.lo, along.hi})
            net.push_back(weighted(project(p) + v * e.direction, p.weight()));
    const int rows = int(net.size()) / 2;
    return Surface<Hom<3>>::trusted({profile.basis(), *across}, Net<2, Hom<3>>({rows, 2}, std::move(net)));
}

}  // namespace

Result<MadeSurface<Vec<3>>> offset_spline(const OffsetSurface& offset, const std::array<Interval, 2>& on,
                                          double tolerance) {
    if (!(tolerance > 0) || !std::isfinite(tolerance))
        return refuse(RefusalKind::invalid, "tolerance", text(tolerance, " is not a positive number"));
    if (!std::isfinite(offset.distance))
        return refuse(RefusalKind::nonfinite, "distance", text(offset.distance, " is not a finite number"));
    if (const auto* plain = std::get_if<Surface<Vec<3>>>(&*offset.base))
        return Maker(to_rational(*plain), false, offset.distance, tolerance).make(on);
    if (const auto* rational = std::get_if<Surface<Hom<3>>>(&*offset.base))
        return Maker(*rational, true, offset.distance, tolerance).make(on);
    const auto* extrusion = std::get_if<Extrusion>(&*offset.base);
    if (auto base = extrusion ? swept(*extrusion, on[1]) : std::nullopt) {
        const bool is_rational = std::holds_alternative<Curve<Hom<3>>>(extrusion->profile);
        return Maker(*std::move(base), is_rational, offset.distance, tolerance).make(on);
    }
    return refuse(RefusalKind::unsupported, "base", "is no spline");
}

}  // namespace freiform
