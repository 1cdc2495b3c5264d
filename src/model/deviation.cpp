// Idea. The distance from a triangle is a convex function, so over a flat part of a face it is largest at a
// corner. A part is cut finer until its bound is `enough`, or where more than that was found somewhere,
// hardly above the largest distance found: branch and bound, the part with the largest bound first.
//
// Bounds of the distance of a part from the mesh: mesh_side.cpp.
//
// Work. All faces get the same share of the parts; what some leave of it is shared out again among those
// whose bounds are above their goals, in rounds. Within a round no face knows of another, so threads do not
// matter. Each round leaves at most half of the faces or about half of the parts, so there are few.
//
// Cost. One bound of derivatives and one nearest triangle for each part. Parts are needed where the bound of
// the part is above the goal: until their error is below it, and along boundaries until the chords of the
// boundary in them are nearly on one line, which clips them (FaceParts::clipped).
//
// References. [Guthe Borodin Klein 2005] refine what may hold the largest distance, from triangles to
// triangles.
//
// Why not samples alone: they say how far apart mesh and model are at least, and nothing about what lies
// between.
#include "face_parts_detail.hpp"
#include "mesh_side_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/model/deviation.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace freiform {

namespace {

constexpr double kNearEnough = 1.1;       // a bound above what was found by this is left
constexpr std::size_t kFirstParts = 256;  // of a face, before anything is judged
constexpr std::size_t kBoundaryPoints = 512;
constexpr double kLeastSag = 1e-6;      // of the size of model and mesh: how well boundaries are known
constexpr double kLeastGoal = 0x1p-36;  // likewise: bounds need not be smaller
constexpr double kBoundaryCounts = 1.0 / 12;
constexpr int kMostSteps = 8;  // of samples along a side of a triangle of the mesh

// The parts of one face, the one with the largest key first.
class Search {
public:
    explicit Search(const FaceParts& parts) : parts_(&parts) {}

    std::size_t seen() const { return seen_; }
    double stuck() const { return stuck_; }  // the largest key of parts that cannot be cut
    double top() const { return heap_.empty() ? 0 : heap_.front().key; }
    const std::vector<FacePart>& parts() const { return heap_; }

    // key(part) >= 0 of every part that is made.
    template <class Key>
    void start(Key&& key) {
        if (auto all = parts_->whole()) push(std::move(*all), key);
    }
    // Cuts the part with the largest key until that is at most `goal()`, or `most` parts have been seen.
    template <class Key, class Goal>
    void refine(std::size_t most, Key&& key, Goal&& goal) {
        while (!heap_.empty() && seen_ < most && top() > goal()) {
            std::ranges::pop_heap(heap_, {}, &FacePart::key);
            const FacePart part = std::move(heap_.back());
            heap_.pop_back();
            auto halves = parts_->halves(part);
            if (halves.empty() && !can_be_halved(part)) {
                stuck_ = std::max(stuck_, part.key);
                kept_.push_back(part);
            }
            for (FacePart& half : halves) push(std::move(half), key);
        }
    }
    // The largest key of all parts that there are now.
    double largest() const { return std::max(top(), stuck_); }
    const std::vector<FacePart>& kept() const { return kept_; }

private:
    static bool can_be_halved(const FacePart& p) {
        for (int d = 0; d < 2; ++d)
            if (const double m = p.box.side(d).middle(); p.box.lo[d] < m && m < p.box.hi[d]) return true;
        return false;
    }
    template <class Key>
    void push(FacePart part, Key& key) {
        ++seen_;
        part.key = key(part);
        heap_.push_back(std::move(part));
        std::ranges::push_heap(heap_, {}, &FacePart::key);
    }

    const FaceParts* parts_;
    std::vector<FacePart> heap_, kept_;  // kept_: as small as doubles allow
    double stuck_ = 0;
    std::size_t seen_ = 0;
};

// What is found about one face.
struct Looked {
    std::optional<FaceParts> parts;
    std::optional<Search> search;
    FaceDeviation answer;
};

class Judge {
public:
    Judge(const Model& model, const TriangleMesh& mesh, const DeviationOptions& options)
        : model_(model), options_(options), side_(mesh) {
        Box<3> box = side_.box();
        for (const Vertex& v : model.vertices) box.add(v.point);
        size_ = box.diagonal();
        share_ = std::max<std::size_t>(options.max_parts / std::max<std::size_t>(model.faces.size(), 1), 64);
    }
    Result<MeshDeviation> run();

private:
    void first_look(std::size_t f);
    void from_mesh(MeshDeviation& out) const;
    double key(Looked& l, FacePart& part) const;
    // `found`: the largest distance of all faces. Beyond its share a face that is stuck is left there.
    double goal(const Looked& l, double found) const {
        const double most = std::max(found, l.answer.measured), stuck = l.search->stuck();
        const double wanted =
            std::max(most > options_.enough ? kNearEnough * most : options_.enough, kLeastGoal * size_);
        return stuck > wanted && l.search->seen() >= share_ ? kNearEnough * stuck : wanted;
    }
    void take(Looked& l, const Vec<3>& x, double distance) const {
        if (distance > l.answer.measured) l.answer.measured = distance, l.answer.at = x;
    }

    const Model& model_;
    const DeviationOptions& options_;
    MeshSide side_;
    double size_ = 0;
    std::size_t share_ = 0;
    std::vector<Looked> looked_;
    std::vector<std::optional<Refusal>> refused_;
};

double Judge::key(Looked& l, FacePart& part) const {
    if (!part.crossing) {
        const Vec<3> x = l.parts->value(0.5 * (part.box.lo + part.box.hi));
        const auto found = side_.tree().nearest(x);
        take(l, x, found.distance);
        return side_.bound(part.corner, part.error, found);
    }
    std::array<Vec<3>, 12> corners;
    std::size_t n = 0;
    for (const ClippedTriangle& t : l.parts->clipped(part))
        for (const Vec<3>& p : t.corners()) corners[n++] = p;
    if (n == 0) return 0;  // all of it is beyond the boundary
    const auto all = std::span(corners).first(n);
    return side_.bound(all, part.error, side_.tree().nearest(mean_of(all)));
}

void Judge::first_look(std::size_t f) {
    Looked& l = looked_[f];
    l.answer.face = int(f);
    l.answer.name = model_.faces[f].name;
    auto parts =
        FaceParts::make(model_.faces[f], model_.edges, std::max(options_.enough / 32, kLeastSag * size_));
    if (!parts) {
        refused_[f] = parts.error();
        return;
    }
    l.parts = std::move(*parts);
    const auto& points = l.parts->region().points();
    const std::size_t stride = points.size() / kBoundaryPoints + 1;
    for (std::size_t i = 0; i < points.size(); i += stride) {
        const Vec<3> x = l.parts->value(points[i]);
        take(l, x, side_.tree().nearest(x).distance);
    }
    l.search.emplace(*l.parts);
    const auto of = [&](FacePart& p) { return key(l, p); };
    l.search->start(of);
    l.search->refine(std::min(kFirstParts, share_), of, [&] { return options_.enough; });
}

// A model as triangles. Each is within `error` of its face; those that the boundary of the face crosses stick
// out by at most `overhang`.
struct Soup {
    std::vector<Triangle3> triangles;
    double error = 0, overhang = 0;
    std::size_t parts = 0;
};

// `boundary`: how much a length that sticks out counts against an error of the same length.
Soup soup_of(const FaceParts& parts, double accuracy, double boundary, std::size_t most) {
    Search search(parts);
    const auto key = [&](FacePart& p) { return p.error + boundary * parts.overhang(p); };
    search.start(key);
    search.refine(most, key, [&] { return accuracy; });
    Soup out;
    out.parts = search.seen();
    for (const auto* list : {&search.parts(), &search.kept()})
        for (FacePart p : *list) {
            for (const ClippedTriangle& t : parts.clipped(p))
                for (std::size_t k = 2; k < std::size_t(t.size); ++k)
                    out.triangles.push_back({t.corner[0], t.corner[k - 1], t.corner[k]});
            out.error = std::max(out.error, p.error);
            out.overhang = std::max(out.overhang, parts.overhang(p));
        }
    return out;
}

Soup soup_of(std::span<const FaceParts* const> faces, double accuracy, double boundary, std::size_t most) {
    std::vector<Soup> of(faces.size());
    const std::size_t share = std::max<std::size_t>(most / std::max<std::size_t>(faces.size(), 1), 64);
    parallel_for(faces.size(), 1,
                 [&](std::size_t f) { of[f] = soup_of(*faces[f], accuracy, boundary, share); });
    Soup out;
    for (const Soup& s : of) {
        out.triangles.insert(out.triangles.end(), s.triangles.begin(), s.triangles.end());
        out.error = std::max(out.error, s.error);
        out.overhang = std::max(out.overhang, s.overhang);
        out.parts += s.parts;
    }
    return out;
}

void Judge::from_mesh(MeshDeviation& out) const {
    std::vector<const FaceParts*> faces;
    for (const Looked& l : looked_)
        if (l.parts) faces.push_back(&*l.parts);
    const double accuracy = std::max({out.measured / 8, options_.enough / 16, 1e-9 * size_});
    Soup soup = soup_of(faces, accuracy, kBoundaryCounts, options_.max_parts);
    out.accuracy = soup.error;
    out.overhang = soup.overhang;
    out.parts += soup.parts;
    if (soup.triangles.empty()) return;
    const TriangleTree tree(std::move(soup.triangles));
    const auto& all = side_.tree().triangles();
    std::vector<std::pair<double, Vec<3>>> worst(all.size(), {-1.0, Vec<3>{}});
    parallel_for(all.size(), 256, [&](std::size_t i) {
        const Triangle3& t = all[i];
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, norm(t[(k + 1) % 3] - t[k]));
        const int n = int(std::clamp(std::ceil(longest / size_ * 300), 2.0, double(kMostSteps)));
        for (int a = 0; a <= n; ++a)
            for (int b = 0; a + b <= n; ++b) {
                const Vec<3> x = t[0] + (double(a) / n) * (t[1] - t[0]) + (double(b) / n) * (t[2] - t[0]);
                if (const double d = tree.nearest(x).distance; d > worst[i].first) worst[i] = {d, x};
            }
    });
    for (const auto& [d, x] : worst)
        if (d > out.mesh_measured) out.mesh_measured = d, out.mesh_at = x;
}

Result<MeshDeviation> Judge::run() {
    looked_.resize(model_.faces.size());
    refused_.resize(model_.faces.size());
    std::atomic<std::size_t> done{0};
    std::atomic<bool> stop{false};
    const auto tell = [&](bool finished) {
        const std::size_t now = done += finished;
        if (options_.progress && !options_.progress(double(now) / (2.0 * double(looked_.size()))))
            stop = true;
    };
    parallel_for(looked_.size(), 1, [&](std::size_t f) {
        if (!stop) first_look(f), tell(true);
    });
    double found = 0;
    // Of a face whose bound is above its goal; goals never fall.
    const auto open = [&](const Looked& l) { return l.search->top() > goal(l, found); };
    for (std::vector<Looked*> rest; !stop;) {
        for (const Looked& l : looked_) found = std::max(found, l.answer.measured);
        std::size_t used = 0;
        rest.clear();
        for (Looked& l : looked_) {
            if (!l.search) continue;
            used += l.search->seen();
            if (open(l)) rest.push_back(&l);
        }
        if (rest.empty() || used + rest.size() > options_.max_parts) break;
        const std::size_t share = (options_.max_parts - used) / rest.size();
        done = 2 * looked_.size() - rest.size();
        parallel_for(rest.size(), 1, [&](std::size_t i) {
            Looked& l = *rest[i];
            if (stop) return;
            l.search->refine(
                l.search->seen() + share, [&](FacePart& p) { return key(l, p); },
                [&] { return goal(l, found); });
            tell(!open(l));
        });
    }
    if (stop) return refuse(RefusalKind::limit, "progress", "stopped by the caller");
    MeshDeviation out;
    for (std::size_t f = 0; f < looked_.size(); ++f) {
        if (refused_[f]) {
            out.refused.push_back(
                {refused_[f]->kind, text("faces[", f, "].", refused_[f]->where), refused_[f]->message});
            continue;
        }
        FaceDeviation& a = looked_[f].answer;
        a.bound = looked_[f].search->largest();
        if (out.worst < 0 || a.measured > out.measured) out.worst = int(out.faces.size());
        out.faces.push_back(a);
        out.measured = std::max(out.measured, a.measured);
        out.bound = std::max(out.bound, a.bound);
        out.parts += looked_[f].search->seen();
    }
    from_mesh(out);
    return out;
}

}  // namespace

Result<MeshDeviation> deviation(const Model& model, const TriangleMesh& mesh,
                                const DeviationOptions& options) {
    if (!std::isfinite(options.enough) || options.enough < 0)
        return refuse(RefusalKind::invalid, "enough", text(options.enough, " is not a distance"));
    if (mesh.triangles.empty()) return refuse(RefusalKind::invalid, "mesh", "has no triangles");
    if (model.faces.empty()) return refuse(RefusalKind::invalid, "model", "has no faces");
    return Judge(model, mesh, options).run();
}

Result<std::vector<double>> distances_from_model(const Model& model, std::span<const Vec<3>> points,
                                                 double accuracy, std::size_t max_parts) {
    if (!(accuracy > 0) || !std::isfinite(accuracy))
        return refuse(RefusalKind::invalid, "accuracy", text(accuracy, " is not a positive distance"));
    std::vector<FaceParts> parts;
    for (const Face& face : model.faces)
        if (auto p = FaceParts::make(face, model.edges, accuracy / 8)) parts.push_back(std::move(*p));
    std::vector<const FaceParts*> faces;
    for (const FaceParts& p : parts) faces.push_back(&p);
    // The rest: boundaries are known to accuracy / 8.
    Soup soup = soup_of(faces, 0.7 * accuracy, 1, max_parts);
    if (soup.triangles.empty()) return refuse(RefusalKind::no_answer, "model", "has no face to measure from");
    const TriangleTree tree(std::move(soup.triangles));
    std::vector<double> out(points.size());
    parallel_for(points.size(), 256, [&](std::size_t i) { out[i] = tree.nearest(points[i]).distance; });
    return out;
}

}  // namespace freiform
