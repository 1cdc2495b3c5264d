// From patches to numbers, and the batch.
#include "query/nearest_detail.hpp"

#include <freiform/basis/named.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/query/checks.hpp>
#include <freiform/query/nearest.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <tuple>

namespace freiform {

namespace {

template <class P>
void append(std::vector<double>& out, const P& p) {
    for (int k = 0; k < Space<P>::kDim; ++k) out.push_back(p[k]);
    out.push_back(Space<P>::weight(p));
}

template <int D>
Vec<D> first_of(const std::array<double, detail::kMostCoords>& x) {
    Vec<D> v;
    for (int k = 0; k < D; ++k) v[k] = x[std::size_t(k)];
    return v;
}

}  // namespace

template <std::size_t N, class P>
NearestObject NearestObject::of(const Patch<N, P>& patch) {
    auto s = std::make_shared<detail::NearestSource>();
    s->params = int(N);
    s->coords = Space<P>::kDim;
    s->rational = Space<P>::kRational;
    const BezierPieces<N, P> pieces(patch);
    for (int d = 0; d < int(N); ++d) {
        s->degree[std::size_t(d)] = pieces.degree(d);
        s->roundings += 6 * pieces.degree(d);  // chain.hpp
    }
    each_index(pieces.extent(), [&](const Index<N>& at) {
        const auto box = pieces.box(at);
        auto& b = s->boxes.emplace_back();
        for (std::size_t d = 0; d < N; ++d) b[d] = box[d];
        const auto net = pieces.net(at);
        each_index(net.extent, [&](const Index<N>& i) { append(s->coefficients, net(i)); });
    });
    NearestObject o;
    o.source_ = std::move(s);
    return o;
}

// With t1 = 1 - u, t2 = u (1 - v), t3 = u v row i of the triangle (n - i = its power of t1) is a curve of
// degree i in v, raised to degree n: each step is a convex combination of two, three roundings.
template <class P>
NearestObject NearestObject::of(const SimplexPatch<2, P>& triangle) {
    auto s = std::make_shared<detail::NearestSource>();
    const int n = triangle.degree();
    s->params = 2;
    s->coords = Space<P>::kDim;
    s->rational = Space<P>::kRational;
    s->triangle = true;
    s->degree = {n, n, 0};
    s->roundings = 4 * n;
    s->boxes.push_back({Interval{0, 1}, Interval{0, 1}, Interval{}});
    for (int i = 0; i <= n; ++i) {
        std::vector<P> row;
        for (int k = 0; k <= i; ++k) row.push_back(triangle.coefficient(i - k, k));
        for (int m = i; m < n; ++m) {
            row.push_back(row.back());
            for (int k = m; k > 0; --k) {
                const double share = double(k) / (m + 1);
                row[std::size_t(k)] = share * row[std::size_t(k) - 1] + (1 - share) * row[std::size_t(k)];
            }
        }
        for (const P& p : row) append(s->coefficients, p);
    }
    NearestObject o;
    o.source_ = std::move(s);
    return o;
}

Result<NearestQuery> NearestQuery::make(std::span<const NearestObject> objects, std::size_t max_bytes) {
    if (objects.empty()) return refuse(RefusalKind::invalid, "objects", "there are none");
    std::vector<const detail::NearestSource*> sources;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        sources.push_back(&objects[i].source());
        if (sources[i]->coords != sources[0]->coords)
            return refuse(
                RefusalKind::invalid, text("objects[", i, "]"),
                text("has ", sources[i]->coords, " coordinates, objects[0] has ", sources[0]->coords));
    }
    auto tree = detail::NearestTree::make(std::move(sources), max_bytes);
    if (!tree) return std::unexpected(tree.error());
    NearestQuery q;
    q.tree_ = std::make_shared<const detail::NearestTree>(*std::move(tree));
    return q;
}

int NearestQuery::coordinates() const { return tree_->coords(); }

template <int D, class Answer, class Ask>
Result<void> NearestQuery::each_point(std::span<const Vec<D>> points, std::span<Answer> out,
                                      const NearestOptions& options, Ask&& ask) const {
    FF_REQUIRE(out.size() == points.size());
    FF_REQUIRE(D == coordinates());
    if (auto ok = detail::check_points<D>(points, options.accuracy, options.max_parts); !ok) return ok;
    constexpr std::size_t kChunk = 64;
    parallel_for((points.size() + kChunk - 1) / kChunk, 1, [&](std::size_t c) {
        detail::NearestTree::Scratch scratch;
        for (std::size_t i = c * kChunk; i < std::min(points.size(), (c + 1) * kChunk); ++i)
            ask(points[i].c.data(), scratch, out[i]);
    });
    return {};
}

template <int D>
Result<void> NearestQuery::nearest(std::span<const Vec<D>> points, std::span<Nearest<D>> out,
                                   const NearestOptions& options) const {
    return each_point<D>(points, out, options, [&](const double* p, auto& scratch, Nearest<D>& n) {
        const auto f = tree_->find(p, options.accuracy, options.max_parts, scratch);
        n = {f.object, {f.at[0], f.at[1], f.at[2]}, first_of<D>(f.point), f.distance, f.point_error, f.bound};
    });
}

template <int D>
Result<void> NearestQuery::farthest(std::span<const Vec<D>> points, std::span<Farthest<D>> out,
                                    const NearestOptions& options) const {
    return each_point<D>(points, out, options, [&](const double* p, auto& scratch, Farthest<D>& n) {
        const auto f = tree_->find_farthest(p, options.accuracy, options.max_parts, scratch);
        n = {f.object, {f.at[0], f.at[1], f.at[2]}, first_of<D>(f.point), f.distance, f.point_error, f.bound};
    });
}

template <int D>
Result<Nearest<D>> NearestQuery::nearest(const Vec<D>& point, const NearestOptions& options) const {
    Nearest<D> out;
    if (auto done = nearest<D>(std::span(&point, 1), std::span(&out, 1), options); !done)
        return std::unexpected(done.error());
    return out;
}

template <int D>
Result<Farthest<D>> NearestQuery::farthest(const Vec<D>& point, const NearestOptions& options) const {
    Farthest<D> out;
    if (auto done = farthest<D>(std::span(&point, 1), std::span(&out, 1), options); !done)
        return std::unexpected(done.error());
    return out;
}

template <int D>
Result<NearRegions<D>> NearestQuery::within(const Vec<D>& point, double radius, double finest,
                                            const NearestOptions& options) const {
    if (!(radius >= 0))
        return refuse(RefusalKind::invalid, "radius",
                      text("is ", radius, ", a distance that is not negative is expected"));
    if (!(finest >= 0 && finest <= 1))
        return refuse(RefusalKind::invalid, "finest", text("is ", finest, ", expected 0 to 1"));
    NearRegions<D> all;
    const auto done = each_point<D>(
        std::span(&point, 1), std::span(&all, 1), options,
        [&](const double* p, auto& scratch, NearRegions<D>& out) {
            const auto cells = tree_->cells(p, radius, finest, options.max_parts, scratch, out.complete);
            for (const auto& region : detail::regions_of(cells)) {
                const auto f = tree_->found(region, p);
                out.regions.push_back({region.object,
                                       {region.box[0], region.box[1], region.box[2]},
                                       {f.at[0], f.at[1], f.at[2]},
                                       first_of<D>(f.point),
                                       f.distance,
                                       f.point_error,
                                       region.stretch});
            }
            sort(out.regions, {},
                 [](const NearRegion<D>& r) { return std::tuple(r.distance, r.object, r.at); });
        });
    if (!done) return std::unexpected(done.error());
    return all;
}

template <int D>
Result<NearRegions<D>> NearestQuery::as_near(const Vec<D>& point, const Nearest<D>& found,
                                             const NearestOptions& options) const {
    return within<D>(point, found.distance + found.point_error, 0, options);
}

template <int D>
Result<NearestFeet<D>> NearestQuery::feet(const Vec<D>& point, int count,
                                          const NearestOptions& options) const {
    if (count < 1) return refuse(RefusalKind::invalid, "count", text("is ", count, ", expected 1 or more"));
    NearestFeet<D> all;
    const auto done =
        each_point<D>(std::span(&point, 1), std::span(&all, 1), options,
                      [&](const double* p, auto& scratch, NearestFeet<D>& out) {
                          for (const auto& [f, box, stretch] :
                               tree_->feet(p, count, options.max_parts, scratch, out.others, out.complete))
                              out.feet.push_back({{f.object,
                                                   {f.at[0], f.at[1], f.at[2]},
                                                   first_of<D>(f.point),
                                                   f.distance,
                                                   f.point_error,
                                                   f.bound},
                                                  {box[0], box[1], box[2]},
                                                  stretch});
                      });
    if (!done) return std::unexpected(done.error());
    return all;
}

#define FF_INSTANTIATE(P)                                         \
    template NearestObject NearestObject::of(const Patch<1, P>&); \
    template NearestObject NearestObject::of(const Patch<2, P>&); \
    template NearestObject NearestObject::of(const Patch<3, P>&); \
    template NearestObject NearestObject::of(const SimplexPatch<2, P>&);
FF_INSTANTIATE(Vec<1>)
FF_INSTANTIATE(Vec<2>)
FF_INSTANTIATE(Vec<3>)
FF_INSTANTIATE(Vec<4>)
FF_INSTANTIATE(Hom<1>)
FF_INSTANTIATE(Hom<2>)
FF_INSTANTIATE(Hom<3>)
FF_INSTANTIATE(Hom<4>)

#define FF_DIMENSION(D)                                                                                     \
    template Result<void> NearestQuery::nearest<D>(std::span<const Vec<D>>, std::span<Nearest<D>>,          \
                                                   const NearestOptions&) const;                            \
    template Result<Nearest<D>> NearestQuery::nearest<D>(const Vec<D>&, const NearestOptions&) const;       \
    template Result<void> NearestQuery::farthest<D>(std::span<const Vec<D>>, std::span<Farthest<D>>,        \
                                                    const NearestOptions&) const;                           \
    template Result<Farthest<D>> NearestQuery::farthest<D>(const Vec<D>&, const NearestOptions&) const;     \
    template Result<NearestFeet<D>> NearestQuery::feet<D>(const Vec<D>&, int, const NearestOptions&) const; \
    template Result<NearRegions<D>> NearestQuery::within<D>(const Vec<D>&, double, double,                  \
                                                            const NearestOptions&) const;                   \
    template Result<NearRegions<D>> NearestQuery::as_near<D>(const Vec<D>&, const Nearest<D>&,              \
                                                             const NearestOptions&) const;
FF_DIMENSION(1)
FF_DIMENSION(2)
FF_DIMENSION(3)
FF_DIMENSION(4)
#undef FF_INSTANTIATE
#undef FF_DIMENSION

}  // namespace freiform
