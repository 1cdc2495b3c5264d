// Contacts of curves with models.
//
// Idea. Each face lies on a part of its surface (prepared_face_detail.hpp), which is met as a surface; what
// is outside of the loops is dropped. Where the loops pass through the box of parameters of a contact it is
// not decided on which side it is: it is on the boundary, and what neighbours say of the same place is one
// contact with it.
//
// Cost. A test of boxes for each face; a search for those that the curve may meet.
//
// Why not the faces with their loops as barriers of the search? The roots on the surface are few, and proven
// anyway; loops are looked at once for each.
#include "prepared_face_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/model/curve_model.hpp>
#include <freiform/query/checks.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kOnePlace = 0x1p-36;  // of the size of the model

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
                if (at.on.coedge >= 0)
                    one.edge =
                        model.faces[f].loops[std::size_t(at.on.loop)].coedges[std::size_t(at.on.coedge)].edge;
                one.contact.kind = ContactKind::end;
                one.contact.least = 0;
                on_loops.push_back(std::move(one));
            }
        }
        join(std::move(on_loops), out.contacts);
        std::ranges::sort(out.contacts, {},
                          [](const ModelContact& c) { return std::pair(c.contact.at, c.face); });
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
