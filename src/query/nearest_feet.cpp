// Feet: all places where the distance from q has a local minimum, the nearest first.
//
// Idea. Over a part of a piece let the squared distance d lie in [a, b], and F_c = (d - c) W^2, a polynomial
// whose coefficients are linear in c. A local minimum with the value c is one of F_c, because F_c is zero
// there and not negative beside it. So a part is
//   - too far: all coefficients of F_T are positive, T that of the farthest of the feet that were asked for;
//   - monotone: the first differences of F_a and of F_b along an axis have one sign, clear of rounding, and
//   so
//     have those of all F_c between, which are averages of the two. Then a local minimum can only be on the
//     face at the lower end, which is left, with one parameter less;
//   - bent down: F_a and F_b are concave along an axis, or the Hessians of all averages of the two have a
//     negative eigenvalue in the plane of two axes. Then a local minimum is on one of the faces that end
//     these axes;
//   - convex: the Hessians of F_a and F_b are positive definite, and so are those between. If x is a local
//     minimum and c its value, then it is the only one of F_c, so that d > c elsewhere: there is one at most,
//     and Newton's iteration finds the point that is nearest on the part;
//   - flat: all coefficients of F_c are within rounding for c of its middle: as near everywhere;
//   - or halved, along the axis along which F changes most.
// Nothing else leaves the search, so that no foot nearer than T is missed. What parts leave are candidates:
// the nearest point of a part may lie on its side, with a nearer one beyond. So in every piece that contains
// the candidate, at its parameters, beyond a seam or at a pole, the derivatives of d are asked for; where one
// leads down, clear of rounding, the candidate is no foot.
//
// Notation and accuracy: nearest_search.cpp. Here T = 0 in F, so that M = (|N| + |q'| W)^2 also bounds b W^2
// or is replaced by that.
//
// Cost. A few dozen parts for each piece that is not too far. Why not within(): a region may hold several
// feet, and how far one must look for k of them is not known before.
//
// References. As nearest_search.cpp; sublevel sets of F_c decide as in [Johnson Cohen 1998] boxes do.
#include "query/nearest_blocks_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace freiform::detail {

namespace {

constexpr double kOnePoint = 0x1p-26;   // of the size of all objects: feet nearer to each other are one
constexpr double kLevel = 0x1p-28;      // a slope that rounding of the foot may leave, as a cosine
constexpr double kLongFoot = 1.0 / 16;  // of a piece: NearRegion::stretch
constexpr double kNone = std::numeric_limits<double>::infinity();

struct FootCandidate {
    int piece = 0;
    std::uint32_t object = 0;
    NearestTree::Parameters at{};  // in the piece
    std::array<Interval, kMostParams> box{};
    NearestTree::Coords point{};
    double square = 0, lower = 0;  // of the distance; of the lower bound
    bool flat = false, stretch = false;
    std::array<bool, kMostParams> on_side{};  // of the part: what is beyond decides
};

}  // namespace

template <int D>
struct NearestFeetSearch : NearestBlocks<D> {
    using Base = NearestBlocks<D>;
    using Head = typename Base::Head;
    using Parameters = NearestTree::Parameters;
    using Coords = NearestTree::Coords;
    using Base::heads, Base::piece, Base::seen, Base::tree;
    std::size_t count;
    int parts_left;
    NearestTree::Scratch weight_scratch{};
    NearestBlocks<D> weights{Base::tree, weight_scratch};  // W^2, over the same parts
    std::vector<FootCandidate> feet{};                     // by their distance
    double others = kNone;                                 // squared: what was left out is at least so far
    std::vector<double> low{}, high{}, level{};

    double threshold() const { return feet.size() < count ? kNone : feet[count - 1].square; }
    void leave(double square) { others = std::min(others, std::max(square, 0.0)); }

    // F - c W^2 on the part at the top.
    NearestForm form_at(double c, std::vector<double>& out) {
        NearestForm form = Base::top_form();
        const double* w = piece->rational ? weights.block(heads.size() - 1) : nullptr;
        out.resize(std::size_t(form.count));
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = form.f[i] - (w ? c * w[i] : c);
        form.f = out.data();
        return form;
    }

    // What the least and the largest squared distance over the part are certainly not below and above.
    struct Range {
        double least, most, eps, lightest;
    };
    Range range(const Head& h) {
        const NearestForm form = Base::top_form();
        double light = 1, heavy = 1;
        if (piece->rational) {
            const double* w = weights.block(heads.size() - 1);
            const auto [l, m] = std::minmax_element(w, w + form.count);
            const double off = (Base::rounding + 2 * h.roundings) * kUnitRoundoff;
            const double heaviest = piece->heaviest * piece->heaviest;
            light = std::max(*l - off * heaviest, piece->lightest * piece->lightest);
            heavy = std::min(*m + off * heaviest, heaviest * (1 + 4 * kUnitRoundoff));
        }
        Base::magnitude = Base::reach * Base::reach;
        const double eps = Base::error_of(h);
        const double a = std::max(0.0, (form.least().value - eps) / heavy * (1 - 4 * kUnitRoundoff));
        const double b = std::max(a, (form.most().value + eps) / light * (1 + 4 * kUnitRoundoff));
        Base::magnitude = std::max(Base::magnitude, b * piece->heaviest * piece->heaviest);
        return {a, b, Base::error_of(h), light};
    }

    void search_piece(int i) {
        Base::look_at(i);
        Base::push_whole(0);
        weights.look_at(i);
        if (piece->rational) weights.push_weights();
        while (!heads.empty()) {
            const Head h = heads.back();
            const Range on = range(h);
            const double t = threshold();
            if (on.least > t || (t < kNone && form_at(t, level).least().value > on.eps) || parts_left <= 0) {
                leave(parts_left <= 0 ? on.least : t);
                pop();
                continue;
            }
            --parts_left;
            const NearestForm below = form_at(on.least, low), above = form_at(on.most, high);
            if (keep_lower_face(below, above, on.eps)) continue;
            const bool convex = is_point(h) || (below.convex(on.eps) && above.convex(on.eps));
            if (!convex && keep_faces(below, above, on.eps)) continue;
            if (convex && end_in_foot(h, on, false)) continue;
            const std::optional<std::size_t> axis =
                !convex && is_flat(h, on.eps) ? std::nullopt : axis_to_halve(below, h);
            if (!axis) {
                end_in_foot(h, on, true);
                continue;
            }
            Base::halve(*axis);
            if (piece->rational) weights.halve(*axis);
        }
    }
    void pop() {
        heads.pop_back();
        if (piece->rational) weights.heads.pop_back();
    }
    static bool is_point(const Head& h) { return h.count == 1; }

    // Whether the part is monotone along an axis, and so only its face at the lower end is left.
    bool keep_lower_face(const NearestForm& below, const NearestForm& above, double eps) {
        for (std::size_t d = 0; d < std::size_t(piece->params); ++d) {
            if (below.degree[d] == 0) continue;
            const Interval a = below.slope(int(d)), b = above.slope(int(d));
            const bool falls = a.hi < -4 * eps && b.hi < -4 * eps;
            if (!falls && !(a.lo > 4 * eps && b.lo > 4 * eps)) continue;
            Base::keep_face(d, falls);
            if (piece->rational) weights.keep_face(d, falls);
            return true;
        }
        return false;
    }
    // Whether a local minimum is possible on faces only, which are then left.
    bool keep_faces(const NearestForm& below, const NearestForm& above, double eps) {
        std::vector<std::size_t> axes;
        for (std::size_t d = 0; d < std::size_t(piece->params) && axes.empty(); ++d)
            if (below.degree[d] > 0 && below.concave_along(int(d), eps) && above.concave_along(int(d), eps))
                axes = {d};
        for (std::size_t d = 0; d < std::size_t(piece->params) && axes.empty(); ++d)
            for (std::size_t e = 0; e < d && axes.empty(); ++e)
                if (below.degree[d] > 0 && below.degree[e] > 0 && below.is_saddle(above, int(d), int(e), eps))
                    axes = {d, e};
        if (axes.empty()) return false;
        const std::size_t at = heads.size() - 1, faces = 2 * axes.size();
        for (std::size_t k = 1; k < faces; ++k) {
            Base::copy_top();
            if (piece->rational) weights.copy_top();
        }
        for (std::size_t k = 0; k < faces; ++k) {
            Base::keep_face(axes[k / 2], k % 2 == 1, at + k);
            if (piece->rational) weights.keep_face(axes[k / 2], k % 2 == 1, at + k);
        }
        return true;
    }
    bool is_flat(const Head& h, double eps) {
        Parameters middle{};
        for (std::size_t d = 0; d < std::size_t(piece->params); ++d) middle[d] = 0.5 * (h.lo[d] + h.hi[d]);
        const NearestForm form = form_at(seen.square_at(middle), level);
        const double room = 64 * (1 + Base::largest_degree()) * eps;
        return form.least().value >= -room && form.most().value <= room;
    }
    std::optional<std::size_t> axis_to_halve(const NearestForm& form, const Head& h) const {
        std::optional<std::size_t> axis;
        double most = -1;
        for (std::size_t d = 0; d < std::size_t(piece->params); ++d) {
            const double middle = h.lo[d] + (h.hi[d] - h.lo[d]) / 2;
            if (h.degree[d] == 0 || !(middle > h.lo[d] && middle < h.hi[d])) continue;
            const Interval slope = form.slope(int(d));
            const double change = std::max(-slope.lo, slope.hi) * h.degree[d];
            if (change > most) most = change, axis = d;
        }
        return axis;
    }

    // False: the part is convex, but Newton's iteration did not come to where it is least.
    bool end_in_foot(const Head& h, const Range& on, bool flat) {
        FootCandidate c;
        c.flat = flat;
        c.piece = Base::index;
        c.object = piece->object;
        c.at = Base::top_form().place(Base::top_form().least().at, h.lo, h.hi);
        c.square = seen.descend(h.lo, h.hi, c.at);
        c.lower = on.least;
        if (!is_point(h)) {
            const NearestForm form = form_at(c.square, level);
            const double fall =
                flat ? form.least().value - on.eps : form.below_tangent(Base::in_block(c.at, h), on.eps);
            if (!flat && !(fall > -32 * (1 + Base::largest_degree()) * on.eps)) return false;
            c.lower =
                std::max(c.lower, c.square + std::min(fall, 0.0) / on.lightest * (1 + 8 * kUnitRoundoff));
        }
        for (std::size_t d = 0; d < std::size_t(piece->params); ++d) {
            c.stretch = c.stretch || (flat && h.hi[d] - h.lo[d] >= kLongFoot);
            c.on_side[d] = !(h.lo[d] < c.at[d] && c.at[d] < h.hi[d]);
        }
        c.box = tree.box_of(Base::index, h.lo, h.hi);
        c.point = point_of(Base::index, c.at);
        pop();
        if (flat || is_foot(c)) insert(c);
        return true;
    }
    Coords point_of(int i, const Parameters& at) const {
        const NearestTree::Piece& p = tree.pieces_[std::size_t(i)];
        const LocalJet j = SeenPiece<D>{&p, tree.numbers_.data() + p.coefficients, {}}.jet(at);
        Coords x{};
        for (std::size_t k = 0; k < std::size_t(D); ++k) x[k] = p.centre[k] + j.value[k];
        return x;
    }
    static double between(const Coords& a, const Coords& b) {
        double s = 0;
        for (std::size_t k = 0; k < std::size_t(D); ++k) s += (a[k] - b[k]) * (a[k] - b[k]);
        return std::sqrt(s);
    }

    // Keeps feet that are one point, or flat parts that touch, as one.
    void insert(FootCandidate c) {
        for (std::size_t i = 0; i < feet.size();) {
            const FootCandidate& f = feet[i];
            bool one = f.object == c.object && between(f.point, c.point) <= kOnePoint * tree.largest_;
            bool touch = f.object == c.object && (f.flat || c.flat);
            for (std::size_t d = 0; d < kMostParams; ++d) touch = touch && f.box[d].overlaps(c.box[d]);
            if (!one && !touch) {
                ++i;
                continue;
            }
            FootCandidate all = f.square <= c.square ? f : c;
            all.lower = std::min(f.lower, c.lower);
            all.flat = f.flat || c.flat;
            all.stretch = f.stretch || c.stretch;
            if (touch)
                for (std::size_t d = 0; d < kMostParams; ++d) all.box[d] = hull(f.box[d], c.box[d]);
            c = all;
            feet.erase(feet.begin() + std::ptrdiff_t(i));
            i = 0;  // the hull may touch what came before
        }
        const auto by = [](const FootCandidate& f) { return std::tuple(f.square, f.object, f.piece, f.at); };
        feet.insert(std::ranges::upper_bound(feet, by(c), {}, by), c);
    }

    // Whether no derivative leads down from the point of a piece into it, clear of rounding; along `axes`.
    bool rises_from(int i, const Parameters& at, const std::array<bool, kMostParams>& axes) const {
        const NearestTree::Piece& p = tree.pieces_[std::size_t(i)];
        SeenPiece<D> here{&p, tree.numbers_.data() + p.coefficients, {}};
        for (std::size_t k = 0; k < std::size_t(D); ++k) here.local[k] = Base::q[k] - p.centre[k];
        const LocalJet j = here.jet(at);
        const double away = std::sqrt(here.square(j)), noise = 64 * kUnitRoundoff * tree.largest_;
        for (std::size_t d = 0; d < std::size_t(p.params); ++d) {
            if (!axes[d]) continue;
            double slope = 0, speed = 0, bend = 0;  // of half the square of the distance
            for (std::size_t k = 0; k < std::size_t(D); ++k) {
                slope += (j.value[k] - here.local[k]) * j.first[d][k];
                speed += j.first[d][k] * j.first[d][k];
                bend += (j.value[k] - here.local[k]) * j.second[d][d][k];
            }
            bend += speed;
            // Derivatives are known but for their rounding, which is all there is of some at doubled ends.
            const double level_slope = std::sqrt(speed) * (kLevel * away + noise) + noise * away;
            if ((at[d] < 1 && slope < -level_slope) || (at[d] > 0 && slope > level_slope)) return false;
            // Level, and it bends down: a foot there would be shallower than squares of distances are known.
            if (std::abs(slope) <= level_slope && bend < -(kLevel * speed + noise * away)) return false;
        }
        return true;
    }

    // In all pieces of the object that contain the point: at its parameters, at those beyond a seam, at
    // poles.
    bool is_foot(const FootCandidate& c) const {
        const NearestTree::Piece& own = tree.pieces_[std::size_t(c.piece)];
        const double same = 64 * kUnitRoundoff * tree.largest_ + tree.slip_;
        Parameters place{};
        for (std::size_t d = 0; d < std::size_t(own.params); ++d)
            place[d] = tree.in_domain(own.domain[d], c.at[d]);
        for (int i = 0; i < int(tree.pieces_.size()); ++i) {
            const NearestTree::Piece& p = tree.pieces_[std::size_t(i)];
            if (p.object != c.object) continue;
            if (!rises_beside(i, p, place, c, same)) return false;
        }
        return true;
    }
    // `place` or, across a seam, the same point at the other end of the domain; poles.
    bool rises_beside(int i, const NearestTree::Piece& p, const Parameters& place, const FootCandidate& c,
                      double same) const {
        Parameters at{};
        bool here = true;
        for (std::size_t d = 0; d < std::size_t(p.params); ++d) {
            const Interval on = p.domain[d];
            // Only the two ends of the domain can be one place; which these are, the point says.
            if (on.contains(place[d]))
                at[d] = i == c.piece ? c.at[d] : std::clamp((place[d] - on.lo) / on.length(), 0.0, 1.0);
            else if (c.at[d] == 0 || c.at[d] == 1)
                at[d] = 1 - c.at[d];
            else
                here = false;
        }
        // Beyond a jump is another point.
        if (here && (i == c.piece || between(point_of(i, at), c.point) <= same) &&
            !rises_from(i, at, c.on_side))
            return false;
        return rises_at_poles(i, p, c, same);
    }
    // Faces of a surface that are the one point c: an estimate, at a few places along it.
    bool rises_at_poles(int i, const NearestTree::Piece& p, const FootCandidate& c, double same) const {
        if (p.params != 2) return true;
        for (std::size_t d = 0; d < 2; ++d)
            for (const double end : {0.0, 1.0}) {
                Parameters at{};
                at[d] = end;
                bool pole = true;
                for (const double x : {0.0, 0.5, 1.0}) {
                    at[1 - d] = x;
                    pole = pole && between(point_of(i, at), c.point) <= same;
                }
                for (int k = 0; pole && k <= 8; ++k) {
                    at[1 - d] = k / 8.0;
                    if (!rises_from(i, at, {true, true})) return false;
                }
            }
        return true;
    }

    void run() {
        auto& stack = Base::scratch.nodes;
        stack.assign(1, {Base::box_distance(tree.nodes_[0]), 0});
        while (!stack.empty()) {
            const auto [distance, at] = stack.back();
            stack.pop_back();
            const NearestTree::Node& node = tree.nodes_[std::size_t(at)];
            if (distance > threshold() || parts_left <= 0) {
                leave(std::min(distance, threshold()));
            } else if (node.count > 0) {
                search_piece(node.first);
            } else {
                std::pair<double, int> l{Base::box_distance(tree.nodes_[std::size_t(at) + 1]), at + 1},
                    r{Base::box_distance(tree.nodes_[std::size_t(node.right)]), node.right};
                if (l.first < r.first) std::swap(l, r);
                stack.push_back(l);
                stack.push_back(r);
            }
        }
        for (std::size_t i = count; i < feet.size(); ++i) leave(feet[i].lower);
        if (feet.size() > count) feet.resize(count);
    }
};

std::vector<NearestFootFound> NearestTree::feet(const double* point, int count, int max_parts,
                                                Scratch& scratch, double& others, bool& complete) const {
    std::vector<NearestFootFound> out;
    with_coords([&](auto d) {
        NearestFeetSearch<d> s{{*this, scratch}, std::size_t(count), max_parts};
        s.look_from(point);
        s.run();
        const auto bound = [&](double square) {
            if (s.far > s.kFar) return multiplied_down(s.far / 2 - largest_);
            const double root = std::sqrt(std::max(square, 0.0)) * (1 - 4 * kUnitRoundoff);
            return multiplied_down(root - s.lost());
        };
        for (const FootCandidate& c : s.feet) {
            NearestFound f = found_at<d>(c.piece, c.at, point);
            f.bound = std::min(bound(c.lower), f.distance);
            out.push_back({f, c.box, c.stretch});
        }
        others = s.others == kNone ? kNone : bound(s.others);
        complete = s.parts_left > 0;
    });
    return out;
}

}  // namespace freiform::detail
