// Contacts of curves with models.
//
// Idea. Each face lies on a part of its surface (prepared_face_detail.hpp), which is met as a surface; what
// is outside of the loops is dropped. Where the loops pass through the box of parameters of a contact it is
// not decided on which side it is: it is on the boundary, and what neighbours say of the same place is one
// contact with it.
//
// What runs in a plane is not found by roots: the search leaves a long box in which nothing is proven. A
// plane is S = O + u U + v V, splines with evenly spaced control points included, so the parameters of
// control points are those of the curve's image, the difference of both is a mean of those of the control
// points, and the loops clip the image.
//
// Cost. A test of boxes for each face; a search for those that the curve may meet.
//
// Why not the faces with their loops as barriers of the search? The roots on the surface are few, and proven
// anyway; loops are looked at once for each.
#include "prepared_face_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/model/curve_model.hpp>
#include <freiform/query/checks.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kOnePlace = 0x1p-36;  // of the size of the model
constexpr double kLong = 0x1p-20;      // of the size: no place but a stretch

Curve<Hom<3>> part_of(const StraightLine& line, const Interval& on) {
    const auto end = [&](double t) { return weighted(line.point + t * line.direction, 1); };
    return Curve<Hom<3>>::trusted({*BSplineBasis::bezier(1, on)},
                                  Net<1, Hom<3>>({2}, {end(on.lo), end(on.hi)}));
}
const Curve<Hom<3>>& part_of(const Curve<Hom<3>>& curve, const Interval&) { return curve; }
double length_over(const StraightLine& line, const Interval& on) {
    return on.length() * norm(line.direction);
}
double length_over(const Curve<Hom<3>>& curve, const Interval& on) {  // of a chord, or two
    const Vec<3> middle = curve(on.middle());
    return norm(middle - curve(on.lo)) + norm(curve(on.hi) - middle);
}

// The plane o + a u + b v that the surface is over the same parameters (a, b), within `off`, rounding
// included. Splines of any degree are one where their control points lie as evenly as the means of knots at
// which linear functions have theirs; `off` is how far one is from there.
struct Evenly {
    Vec<3> o{}, u{}, v{};
    double off = 0;
};

// Of each basis function: the mean of its inner knots; none of degree 0.
std::vector<double> means_of_knots(const BSplineBasis& basis) {
    const auto& knots = basis.knots();
    const std::size_t p = std::size_t(basis.degree());
    std::vector<double> out;
    if (p == 0) return out;
    for (std::size_t i = 0; i + p + 1 < knots.size(); ++i) {
        double sum = 0;
        for (std::size_t k = 1; k <= p; ++k) sum += knots[i + k];
        out.push_back(sum / double(p));
    }
    return out;
}

std::optional<Evenly> evenly(const SurfaceGeometry& surface) {
    Evenly out;
    double scale = 0;
    const auto differ = [&](const Vec<3>& p, double a, double b) {
        out.off = std::max(out.off, norm(p - (out.o + a * out.u + b * out.v)));
        scale = std::max(
            {scale, max_abs(p), max_abs(out.o), std::abs(a) * max_abs(out.u), std::abs(b) * max_abs(out.v)});
    };
    if (const auto* e = std::get_if<Extrusion>(&surface)) {
        out.v = e->direction;
        if (const auto* line = std::get_if<Line<3>>(&e->profile)) {
            out.o = line->origin, out.u = line->direction;
            return out;
        }
        const auto* spline = std::get_if<Curve<Vec<3>>>(&e->profile);
        if (!spline) return std::nullopt;
        const auto points = spline->net().flat();
        const auto at = means_of_knots(spline->basis());
        if (at.size() != points.size()) return std::nullopt;  // closed, or of degree 0
        out.u = (1 / (at.back() - at.front())) * (points.back() - points.front());
        out.o = points.front() - at.front() * out.u;
        for (std::size_t i = 0; i < at.size(); ++i) differ(points[i], at[i], 0);
    } else if (const auto* s = std::get_if<Surface<Vec<3>>>(&surface)) {
        const auto points = s->net().flat();
        const auto a = means_of_knots(s->basis(0)), b = means_of_knots(s->basis(1));
        const std::size_t n = b.size();
        if (a.size() * n != points.size()) return std::nullopt;
        out.u = (1 / (a.back() - a.front())) * (points[(a.size() - 1) * n] - points[0]);
        out.v = (1 / (b.back() - b.front())) * (points[n - 1] - points[0]);
        out.o = points[0] - a.front() * out.u - b.front() * out.v;
        for (std::size_t i = 0; i < a.size(); ++i)
            for (std::size_t k = 0; k < n; ++k) differ(points[i * n + k], a[i], b[k]);
    } else {
        return std::nullopt;
    }
    out.off += 64 * kUnitRoundoff * scale;
    return out;
}

struct MetFace {
    PreparedFace face;
    IntersectPart part;
};

// May the line meet the box? Wider by roundings of all numbers.
bool may_meet(const StraightLine& line, const Box<3>& box) {
    const double scale = std::max(box.scale(), max_abs(line.point)), more = 0x1p-40 * scale;
    Interval t = line.on;
    for (int k = 0; k < 3; ++k) {
        const double d = line.direction[k], lo = box.lo[k] - line.point[k] - more,
                     hi = box.hi[k] - line.point[k] + more;
        if (d == 0) {
            if (lo > 0 || hi < 0) return false;
            continue;
        }
        const double p = std::min(lo / d, hi / d), q = std::max(lo / d, hi / d);
        t = {std::max(t.lo, p - 0x1p-40 * std::abs(p)), std::min(t.hi, q + 0x1p-40 * std::abs(q))};
    }
    return t.lo <= t.hi;
}
bool may_meet(const Curve<Hom<3>>& curve, const Box<3>& box) {
    Box<3> own;
    for (const Vec<3>& p : points(curve)) own.add(p);
    const double more = 0x1p-40 * std::max(own.scale(), box.scale());
    for (int k = 0; k < 3; ++k)
        if (own.lo[k] > box.hi[k] + more || box.lo[k] > own.hi[k] + more) return false;
    return true;
}

}  // namespace

struct IntersectModel::Prepared {
    std::vector<std::optional<MetFace>> faces;
    std::vector<OpenContacts> open;
    Model model;
    double size = 0;

    template <class Line>
    Result<ModelContacts> meet(const Line& line, const IntersectOptions& options) const {
        ModelContacts out;
        out.open = open;
        std::vector<ModelContact> on_loops;
        for (std::size_t f = 0; f < faces.size(); ++f) {
            if (!faces[f] || !may_meet(line, faces[f]->part.box())) continue;
            auto found = faces[f]->part.intersect(line, options);
            if (!found) return std::unexpected(found.error());
            const FaceLoops& loops = faces[f]->face.loops;
            if (auto in_face = runs_in(int(f), line, *found)) {
                out.overlaps.insert(out.overlaps.end(), in_face->begin(), in_face->end());
                std::erase_if(found->contacts, [&](const Contact<3, 3>& c) { return is_long(line, c); });
                found->undecided.clear();
            }
            std::erase_if(found->undecided, [&](const auto& box) {
                return loops.place({{{box[1].lo, box[2].lo}}, {{box[1].hi, box[2].hi}}}).place ==
                       Place::outside;
            });
            if (!found->undecided.empty()) out.open.push_back({int(f), std::move(found->undecided), {}});
            for (Contact<3, 3>& c : found->contacts) {
                const Box<2> uv{{{c.box[1].lo, c.box[2].lo}}, {{c.box[1].hi, c.box[2].hi}}};
                const FaceLoops::Where at = loops.place(uv);
                if (at.place == Place::outside) continue;
                ModelContact one{std::move(c), int(f), -1, {}};
                if (at.place == Place::inside) {
                    out.contacts.push_back(std::move(one));
                    continue;
                }
                if (is_long(line, one.contact)) {
                    const Interval on = one.contact.box[0];
                    out.open.push_back(
                        {int(f),
                         {one.contact.box},
                         Refusal{RefusalKind::ill_conditioned, text("faces[", f, "]"),
                                 text("over [", on.lo, ", ", on.hi,
                                      "] of its parameter the curve runs along the face, at most ",
                                      one.contact.gap, " away in the middle")}});
                    continue;
                }
                if (at.on.coedge >= 0)
                    one.edge =
                        model.faces[f].loops[std::size_t(at.on.loop)].coedges[std::size_t(at.on.coedge)].edge;
                one.contact.kind = ContactKind::end;
                one.contact.least = 0;
                on_loops.push_back(std::move(one));
            }
        }
        join(std::move(on_loops), out.contacts);
        sort(out.contacts, {}, [](const ModelContact& c) { return std::pair(c.contact.at, c.face); });
        return out;
    }

    template <class Line>
    bool is_long(const Line& line, const Contact<3, 3>& c) const {
        return c.least == 0 && length_over(line, c.box[0]) > kLong * size;
    }
    // Where the curve runs in the plane of a face and within its loops, if it runs there at all.
    template <class Line>
    std::optional<std::vector<ModelOverlap>> runs_in(int face, const Line& line,
                                                     const Intersections<3, 3>& found) const {
        const auto plane = evenly(model.faces[std::size_t(face)].surface);
        if (!plane || !(plane->off <= kOnePlace * size)) return std::nullopt;
        std::optional<Interval> on;
        const auto take = [&](const Interval& t) { on = on ? hull(*on, t) : t; };
        for (const Contact<3, 3>& c : found.contacts)
            if (is_long(line, c)) take(c.box[0]);
        for (const auto& box : found.undecided) take(box[0]);
        if (!on || !(on->lo < on->hi)) return std::nullopt;
        const Curve<Hom<3>>& curve = part_of(line, *on);
        const auto at = [&](double a, double b) { return plane->o + a * plane->u + b * plane->v; };
        const Vec<3>&o = plane->o, &u = plane->u, &v = plane->v, n = cross(u, v);
        double gap = 0;
        std::vector<Vec<2>> image;
        for (const Hom<3>& p : curve.net().flat()) {
            if (p.weight() != curve.net().flat()[0].weight()) return std::nullopt;  // the image is rational
            const Vec<3> x = project(p), d = x - o;
            image.push_back({{dot(cross(d, v), n) / dot(n, n), dot(cross(u, d), n) / dot(n, n)}});
            const double scale = max_abs(x) + max_abs(o) + std::abs(image.back()[0]) * max_abs(u) +
                                 std::abs(image.back()[1]) * max_abs(v);
            gap = std::max(gap, norm(at(image.back()[0], image.back()[1]) - x) + 64 * kUnitRoundoff * scale +
                                    plane->off);
        }
        if (!(gap <= kOnePlace * size)) return std::nullopt;
        const int count = int(image.size());
        const auto clipped = faces[std::size_t(face)]->face.loops.clip(
            Curve<Vec<2>>::trusted({curve.basis()}, Net<1, Vec<2>>({count}, std::move(image))),
            kOnePlace * size);
        if (!clipped) return std::nullopt;
        std::vector<ModelOverlap> out;
        for (const ClippedPart& part : *clipped)
            if (length_over(line, part.on) > kLong * size) out.push_back({face, part.on, gap});
        return out;
    }

    // One for each place.
    void join(std::vector<ModelContact> on_loops, std::vector<ModelContact>& to) const {
        const std::size_t first = to.size();
        for (ModelContact& c : on_loops) {
            const auto same =
                std::find_if(to.begin() + std::ptrdiff_t(first), to.end(), [&](const ModelContact& o) {
                    double slack = kOnePlace * size + c.contact.gap + o.contact.gap;
                    for (const int e : {c.edge, o.edge})
                        if (e >= 0) slack += model.edges[std::size_t(e)].tolerance;
                    return c.contact.box[0].overlaps(o.contact.box[0]) ||
                           norm(c.contact.point - o.contact.point) <= slack;
                });
            if (same == to.end())
                to.push_back(std::move(c));
            else
                same->others.push_back({c.face, {c.contact.at[1], c.contact.at[2]}});
        }
    }
};

IntersectModel::IntersectModel(const Model& model) {
    auto all = std::make_shared<Prepared>();
    all->model = model;
    Box<3> box;
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        auto face = PreparedFace::make(model, model.faces[f]);
        auto part = face ? IntersectPart::make(face->part) : std::unexpected(face.error());
        if (part) {
            box.add(face->box);
            all->faces.push_back(MetFace{std::move(*face), std::move(*part)});
        } else {
            all->open.push_back({int(f), {}, part.error()});
            all->faces.push_back(std::nullopt);
        }
    }
    all->size = box.is_empty() ? 0 : box.diagonal();
    prepared_ = std::move(all);
}

double IntersectModel::search_bound() const {
    double most = 0;
    for (const auto& f : prepared_->faces)
        if (f) most = std::max(most, f->part.search_bound());
    return most;
}

Result<ModelContacts> IntersectModel::intersect(const Curve<Hom<3>>& curve,
                                                const IntersectOptions& options) const {
    if (auto ok = detail::check_accuracy(options.accuracy); !ok) return std::unexpected(ok.error());
    return prepared_->meet(curve, options);
}

Result<void> IntersectModel::intersect(std::span<const StraightLine> lines, std::span<ModelContacts> out,
                                       const IntersectOptions& options) const {
    FF_REQUIRE(lines.size() == out.size());
    if (auto ok = detail::check_accuracy(options.accuracy); !ok) return ok;
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (auto ok = check_line(lines[i], i); !ok) return ok;
    std::vector<std::optional<Refusal>> refused(lines.size());
    constexpr std::size_t kChunk = 16;
    parallel_for((lines.size() + kChunk - 1) / kChunk, 4, [&](std::size_t chunk) {
        for (std::size_t i = chunk * kChunk; i < std::min(lines.size(), (chunk + 1) * kChunk); ++i) {
            auto found = prepared_->meet(lines[i], options);
            if (found)
                out[i] = std::move(*found);
            else
                refused[i] = found.error();
        }
    });
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (refused[i]) return refuse_within(text("lines[", i, "]"), *refused[i]);
    return {};
}

}  // namespace freiform
