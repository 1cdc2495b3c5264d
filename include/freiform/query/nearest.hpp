// The point of curves, surfaces and volumes that is nearest to a given one: the nearest of all, with a lower
// bound that proves it.
#pragma once
#include <freiform/spline/patch.hpp>
#include <freiform/spline/simplex.hpp>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace freiform {

template <int D>
struct Nearest {
    std::size_t object = 0;      // which of the objects, in the order in which they were given
    std::array<double, 3> at{};  // its parameters there: one of a curve, two of surfaces and triangles
    Vec<D> point{};
    double distance = 0;  // to `point`
    // bound: how far `point` may be from the object (rounding; the object itself comes within it).
    double point_error = 0;
    // bound: no point of any object is nearer than this. The true distance lies in
    // [lower_bound, distance + point_error].
    double lower_bound = 0;
};

template <int D>
struct Farthest {
    std::size_t object = 0;
    std::array<double, 3> at{};
    Vec<D> point{};
    double distance = 0;     // to `point`
    double point_error = 0;  // as of Nearest
    // bound: no point of any object is farther than this. The largest distance lies in
    // [distance - point_error, upper_bound].
    double upper_bound = 0;
};

// Some points of one object that hang together, as a box of parameters, and the nearest of them.
template <int D>
struct NearRegion {
    std::size_t object = 0;
    std::array<Interval, 3> box{};  // contains the region; may contain more
    std::array<double, 3> at{};     // of a point of the object in the box, the nearest that was seen:
    Vec<D> point{};
    double distance = 0, point_error = 0;
    // Not just about one point: at least a sixteenth of a Bezier piece, along some axis, is within the radius
    // or nearer to it than rounding can tell. Of an arc about its centre, and a radius that is its own, all
    // of it.
    bool stretch = false;
};
template <int D>
struct NearRegions {
    // No point of any object within the radius is outside of these boxes. Nearest first.
    std::vector<NearRegion<D>> regions;
    bool complete = true;  // false: max_parts ended the search, and boxes are larger than asked for
};

// A foot: a point of an object that has none nearer beside it. Ends, borders and corners can be feet.
template <int D>
struct NearFoot {
    Nearest<D> foot;                // lower_bound: of the object over the box
    std::array<Interval, 3> box{};  // contains its parameters
    bool stretch = false;           // as of NearRegion: all of a stretch of points is as near
};
template <int D>
struct NearestFeet {
    std::vector<NearFoot<D>> feet;  // nearest first
    // bound: every foot that is in none of the boxes, and not beside one of `feet`, is at least so far;
    // infinite: there is no other.
    double others = 0;
    bool complete = true;  // false: max_parts ended the search, and nearer feet than `others` may be missing
};

struct NearestOptions {
    // A distance: how far lower_bound may stay below `distance`. With 0 the search goes on until rounding
    // ends it; what remains is what the answer says, distance + point_error - lower_bound. An estimate of
    // that, from measurements: 1e-11 of the object's size and less,
    // with uneven weights 5e-10 of the distance. Points nearer than `point_error` have the
    // lower bound 0.
    double accuracy = 0;
    // A backstop: parts of pieces that are looked at for one answer. Reached, `lower_bound` is what was
    // proven until then. Ordinary points need a few dozen; points with a continuum of feet in no direction of
    // the parameters need many.
    int max_parts = 20000;
};

namespace detail {
struct NearestSource;
class NearestTree;
}  // namespace detail

// What NearestQuery is made from: the Bezier pieces of one object.
class NearestObject {
public:
    template <std::size_t N, class P>
    static NearestObject of(const Patch<N, P>& patch);
    // A triangle as the tensor product surface that has its corner 1 as a degenerate edge; `at` is (u, v) of
    // the triangle.
    template <class P>
    static NearestObject of(const SimplexPatch<2, P>& triangle);

    const detail::NearestSource& source() const { return *source_; }

private:
    std::shared_ptr<const detail::NearestSource> source_;
};

// Prepared objects; const, to be asked from many threads.
class NearestQuery {
public:
    // Refuses no objects, objects with different numbers of coordinates, and (limit) what needs more than
    // max_bytes of memory: pieces x (2 p + 1)(2 q + 1) x (D + 2) numbers.
    static Result<NearestQuery> make(std::span<const NearestObject> objects,
                                     std::size_t max_bytes = std::size_t(2) << 30);

    int coordinates() const;
    const detail::NearestTree& tree() const { return *tree_; }

    // Many points, in parallel. REQUIRES out.size() == points.size(), D == coordinates(). Refuses, before any
    // output, points that are not finite (with the index), a negative accuracy and max_parts < 1.
    //   auto q = NearestQuery::make(std::array{NearestObject::of(curve)});
    //   auto done = q->nearest<3>(points, out);
    template <int D>
    Result<void> nearest(std::span<const Vec<D>> points, std::span<Nearest<D>> out,
                         const NearestOptions& options = {}) const;
    // One point.
    template <int D>
    Result<Nearest<D>> nearest(const Vec<D>& point, const NearestOptions& options = {}) const;

    // The farthest points, with the same refusals. `accuracy`: how far upper_bound may stay above `distance`.
    //   auto far = q->farthest<3>(point);   // far->distance <= far->upper_bound
    template <int D>
    Result<void> farthest(std::span<const Vec<D>> points, std::span<Farthest<D>> out,
                          const NearestOptions& options = {}) const;
    template <int D>
    Result<Farthest<D>> farthest(const Vec<D>& point, const NearestOptions& options = {}) const;

    // The `count` nearest feet. Feet of one object nearer to each other than 2^-26 of the size of all objects
    // are one. A point is left out only where the distance decreases from it; that the others are feet is an
    // estimate where knots, seams or poles meet. Refuses what nearest() refuses, and a count below 1.
    //   auto all = q->feet<3>(point, 4);   // all->feet[1].foot.distance
    template <int D>
    Result<NearestFeet<D>> feet(const Vec<D>& point, int count, const NearestOptions& options = {}) const;

    // All that is within `radius` of the point. Boxes are cut until their sides are `finest` of a Bezier
    // piece (0: as short as doubles allow), so that regions nearer to each other than that may be one. A
    // region that runs through the seam of a closed object, or a pole, comes as several. Refuses what
    // nearest() refuses, a negative radius and `finest` outside [0, 1].
    template <int D>
    Result<NearRegions<D>> within(const Vec<D>& point, double radius, double finest = 0x1p-5,
                                  const NearestOptions& options = {}) const;
    // What is as near as `found`, the answer of nearest() for the point, as far as that is known: all within
    // distance + point_error. More than one region, or a stretch: the nearest point is one of many. The
    // nearest point is known no better than found.distance - found.lower_bound.
    template <int D>
    Result<NearRegions<D>> as_near(const Vec<D>& point, const Nearest<D>& found,
                                   const NearestOptions& options = {}) const;

private:
    template <int D, class Answer, class Ask>
    Result<void> each_point(std::span<const Vec<D>> points, std::span<Answer> out,
                            const NearestOptions& options, Ask&& ask) const;
    std::shared_ptr<const detail::NearestTree> tree_;
};

}  // namespace freiform
