// Intersections of models.
//
// Idea. Each face lies on a part of its surface, a little larger than its loops, so that the borders of the
// part play no role; two parts are intersected as surfaces (surface_surface.hpp), and branches are clipped by
// the loops of both faces (face_loops.cpp).
//
// Method. Faces are paired by boxes of their parts. Where both clips keep a stretch of a branch it stays; a
// closed branch that is cut somewhere else than at its seam is joined there again. Ends at edges are joined
// to chains (branch_chains.cpp), overlaps are clipped by the loops (face_overlaps.cpp). Nodes stay unless all
// their cells are outside of a face: no loop meets the cell, and its middle is outside.
//
// Cost. A search for each pair of faces whose boxes overlap.
//
// Why not faces as they are, with their loops carried into splines? Loops in angles have no such spline.
#include "branch_chains_detail.hpp"
#include "face_overlaps_detail.hpp"
#include "prepared_face_detail.hpp"

#include <freiform/model/intersect.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

// A cubic spline as its Bezier pieces, a part of it, and two after each other.
template <int D>
Curve<Vec<D>> part_of_curve(const Curve<Vec<D>>& c, Interval on) {
    if (c.domain()[0] == on) return c;
    auto part = restrict_to(c, 0, on);
    return part ? std::move(*part) : c;
}
template <int D>
Curve<Vec<D>> joined_curves(const Curve<Vec<D>>& a, const Curve<Vec<D>>& b, double shift) {
    std::vector<double> knots(a.basis().knots().begin(), a.basis().knots().end() - 1);
    std::vector<Vec<D>> net(a.net().flat().begin(), a.net().flat().end());
    const auto other = b.net().flat();
    const bool jump = !(other[0] == net.back());
    if (jump) knots.push_back(knots.back());
    net.insert(net.end(), other.begin() + (jump ? 0 : 1), other.end());
    const auto more = b.basis().knots();
    for (std::size_t i = 4; i < more.size(); ++i) knots.push_back(more[i] + shift);
    const int n = int(net.size());
    return Curve<Vec<D>>::trusted({*BSplineBasis::make(3, std::move(knots))},
                                  Net<1, Vec<D>>({n}, std::move(net)));
}

class ModelMeeting {
public:
    ModelMeeting(const Model& a, const Model& b, const SurfaceIntersectOptions& options)
        : models_{&a, &b}, options_(options) {}

    Result<ModelIntersection> all() {
        if (!(options_.tolerance > 0) || !std::isfinite(options_.tolerance))
            return refuse(RefusalKind::invalid, "tolerance",
                          text(options_.tolerance, " is not a length > 0"));
        std::array<std::vector<std::optional<PreparedFace>>, 2> faces;
        for (std::size_t s = 0; s < 2; ++s)
            for (std::size_t f = 0; f < models_[s]->faces.size(); ++f) {
                auto one = PreparedFace::make(*models_[s], models_[s]->faces[f]);
                if (!one)
                    out_.open.push_back({{s == 0 ? int(f) : -1, s == 1 ? int(f) : -1}, {}, one.error()});
                faces[s].push_back(one ? std::optional(std::move(*one)) : std::nullopt);
            }
        for (std::size_t i = 0; i < faces[0].size(); ++i)
            for (std::size_t j = 0; j < faces[1].size(); ++j)
                if (faces[0][i] && faces[1][j] && !are_apart(faces[0][i]->box, faces[1][j]->box)) {
                    faces_ = {int(i), int(j)};
                    meet({&*faces[0][i], &*faces[1][j]});
                }
        out_.chains = chains_of(out_.branches, models_, options_.tolerance);
        return std::move(out_);
    }

private:
    static bool are_apart(const Box<3>& a, const Box<3>& b) {
        for (int k = 0; k < 3; ++k)
            if (a.lo[k] > b.hi[k] || b.lo[k] > a.hi[k]) return true;
        return false;
    }
    void leave_open(const Refusal& reason) { out_.open.push_back({faces_, {}, reason}); }

    void meet(const std::array<const PreparedFace*, 2>& face) {
        auto found = intersect(face[0]->part, face[1]->part, options_);
        if (!found) return leave_open(found.error());
        out_.search_bound = std::max(out_.search_bound, found->search_bound[0] + found->search_bound[1]);
        std::vector<int> node(found->nodes.size(), -1);
        for (std::size_t i = 0; i < node.size(); ++i) {
            if (!may_touch(face, found->nodes[i].cells)) continue;
            node[i] = int(out_.nodes.size());
            out_.nodes.push_back({std::move(found->nodes[i]), faces_, {}});
            clip_overlaps(face, out_.nodes.back());
        }
        for (const SurfaceBranch& b : found->branches) {
            std::array<std::vector<ClippedPart>, 2> parts;
            bool known = true;
            for (std::size_t s = 0; s < 2 && known; ++s) {
                auto clipped = face[s]->loops.clip(s == 0 ? b.at_a : b.at_b, options_.tolerance);
                if (!clipped) leave_open(clipped.error());
                known = clipped.has_value();
                if (known) parts[s] = std::move(*clipped);
            }
            if (known) take(b, parts, node);
        }
        std::erase_if(found->undecided, [&](const auto& box) { return !may_touch(face, {box}); });
        if (!found->undecided.empty()) out_.open.push_back({faces_, found->undecided, {}});
    }
    void clip_overlaps(const std::array<const PreparedFace*, 2>& face, FaceNode& node) {
        std::vector<SurfaceOverlap> kept;
        for (SurfaceOverlap& o : node.overlaps) {
            if (o.is_affine) {
                auto region = face_overlap({&face[0]->loops, &face[1]->loops}, o, options_.tolerance);
                if (!region)
                    leave_open(region.error());
                else if (!*region)
                    continue;
                else
                    node.regions.push_back(std::move(**region));
            }
            kept.push_back(std::move(o));
        }
        if (kept.empty() && !node.overlaps.empty()) node.kind = SurfaceNodeKind::along;  // borders at most
        node.overlaps = std::move(kept);
    }
    // Of some box, is a part in both faces, as far as is known?
    static bool may_touch(const std::array<const PreparedFace*, 2>& face,
                          const std::vector<std::array<Interval, 4>>& boxes) {
        const auto may_hold = [](const PreparedFace& f, const Box<2>& box) {
            for (std::size_t i = 0; i < f.region.size(); ++i)
                if (f.region.meets(box, i)) return true;
            return f.loops.is_empty() || f.region.is_inside(0.5 * (box.lo + box.hi));
        };
        return std::ranges::any_of(boxes, [&](const std::array<Interval, 4>& b) {
            return may_hold(*face[0], {{{b[0].lo, b[1].lo}}, {{b[0].hi, b[1].hi}}}) &&
                   may_hold(*face[1], {{{b[2].lo, b[3].lo}}, {{b[2].hi, b[3].hi}}});
        });
    }

    struct Stretch {
        Interval on;
        std::array<int, 2> ends{kAtBorder, kAtBorder};
        std::array<TrimPlace, 2> trims{};
        std::array<bool, 2> along{};
    };
    void take(const SurfaceBranch& b, const std::array<std::vector<ClippedPart>, 2>& parts,
              const std::vector<int>& node) {
        const Interval all = b.curve.domain()[0];
        std::vector<Stretch> kept;
        for (const ClippedPart& p : parts[0])
            for (const ClippedPart& q : parts[1]) {
                const Interval on{std::max(p.on.lo, q.on.lo), std::min(p.on.hi, q.on.hi)};
                if (!(on.lo < on.hi)) continue;
                Stretch s{on, {}, {}, {p.along, q.along}};
                for (std::size_t e = 0; e < 2; ++e) {
                    const bool of_p = (e == 0 ? p.on.lo == on.lo : p.on.hi == on.hi) && p.ends[e];
                    const bool of_q = (e == 0 ? q.on.lo == on.lo : q.on.hi == on.hi) && q.ends[e];
                    s.ends[e] = b.ends[e];
                    if (s.ends[e] >= 0) s.ends[e] = node[std::size_t(s.ends[e])];  // outside: a border, too
                    if (of_p || of_q) {
                        s.ends[e] = kAtTrim;
                        s.trims[e] = place(of_p ? 0 : 1, of_p ? *p.ends[e] : *q.ends[e]);
                    }
                }
                kept.push_back(s);
            }
        const bool round =
            b.closed && kept.size() > 1 && kept.front().on.lo == all.lo && kept.back().on.hi == all.hi;
        const bool whole = b.closed && kept.size() == 1 && kept[0].on == all;
        for (std::size_t i = round ? 1 : 0; i < kept.size(); ++i) {
            const Stretch& s = kept[i];
            FaceBranch f{part_of_branch(b, s.on), faces_, s.trims, s.along};
            f.ends = s.ends, f.closed = whole;
            if (b.node >= 0) f.node = node[std::size_t(b.node)];
            if (whole) f.ends = b.ends;
            if (round && i + 1 == kept.size()) {
                const Stretch& rest = kept.front();
                const SurfaceBranch more = part_of_branch(b, rest.on);
                const double shift = all.length();
                f.curve = joined_curves(f.curve, more.curve, shift);
                f.at_a = joined_curves(f.at_a, more.at_a, shift);
                f.at_b = joined_curves(f.at_b, more.at_b, shift);
                f.ends[1] = rest.ends[1], f.trims[1] = rest.trims[1];
                for (std::size_t k = 0; k < 2; ++k) f.along_trim[k] = f.along_trim[k] || rest.along[k];
            }
            out_.branches.push_back(std::move(f));
        }
    }
    TrimPlace place(int side, const ClippedPart::End& at) const {
        const Model& m = *models_[std::size_t(side)];
        const Face& f = m.faces[std::size_t(faces_[std::size_t(side)])];
        const int edge =
            at.coedge < 0 ? -1 : f.loops[std::size_t(at.loop)].coedges[std::size_t(at.coedge)].edge;
        return {side, at.loop, at.coedge, edge};
    }
    static SurfaceBranch part_of_branch(const SurfaceBranch& b, Interval on) {
        SurfaceBranch out = b;
        out.curve = part_of_curve(b.curve, on);
        out.at_a = part_of_curve(b.at_a, on), out.at_b = part_of_curve(b.at_b, on);
        return out;
    }

    std::array<const Model*, 2> models_;
    SurfaceIntersectOptions options_;
    std::array<int, 2> faces_{};
    ModelIntersection out_;
};

}  // namespace

Result<ModelIntersection> intersect(const Model& a, const Model& b, const SurfaceIntersectOptions& options) {
    return ModelMeeting(a, b, options).all();
}

}  // namespace freiform
