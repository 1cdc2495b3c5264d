// A surface as the boundaries of faces see it: which parameters are periodic, where it shrinks to a point,
// and which parameters a point of it has.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/spline/geometry.hpp>

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

namespace freiform::step {

// The part of a vector across a unit vector.
inline Vec<3> across(const Vec<3>& d, const Vec<3>& axis) { return d - dot(d, axis) * axis; }

// All points with parameter `axis` equal to `at` are one.
struct Pole {
    int axis = 1;
    double at = 0;
    Vec<3> point{};
};

struct Foot {
    Vec<2> at{}, slope{};  // the parameters, and their derivative by that of the curve
    double distance = 0;   // of the point of the surface there
    bool regular = false;  // false: at a pole or a fold, where `slope` means nothing
};

// What is made when it is first asked for, by any thread: of several that make it at once, one is kept.
// Copies make their own.
template <class T>
class Once {
public:
    Once() = default;
    Once(const Once&) {}
    Once& operator=(const Once&) = delete;
    ~Once() { delete made_.load(); }
    const T& get(auto&& make) const {
        if (const T* made = made_.load()) return *made;
        std::unique_ptr<const T> own = make();
        const T* kept = nullptr;
        return made_.compare_exchange_strong(kept, own.get()) ? *own.release() : *kept;
    }

private:
    mutable std::atomic<const T*> made_{nullptr};
};

class Chart {
public:
    // `close`: points nearer than this are one; `seam`: so are opposite sides of a spline.
    Chart(const SurfaceGeometry& surface, double close, double seam = 0);

    const SurfaceGeometry& surface() const { return *s_; }
    // 0: not periodic. Of splines that close, the length of their domain.
    double period(int axis) const { return period_[std::size_t(axis)]; }
    double seam() const { return seam_; }
    // How far apart opposite sides of a spline are, where that is little beside its size; else infinite.
    double apart(int axis) const { return apart_[std::size_t(axis)]; }
    const std::vector<Pole>& poles() const { return poles_; }
    // Whether a parameter curve goes on beyond a pole, where the same points have other parameters.
    bool has_pole_across(const CurveGeometry<2>& curve, Interval on) const;
    // The parameters that cover the surface once; infinite where it does not end.
    const std::array<Interval, 2>& whole() const { return whole_; }
    // Whether parameter `axis` is that of a spline, which has to be unwound where a face crosses its ends.
    bool is_spline(int axis) const { return spline_[std::size_t(axis)]; }
    bool is_sphere() const {
        const auto* s = std::get_if<Revolution>(&*s_);
        return s != nullptr && s->kind == SurfaceKind::sphere;
    }

    // Parameters outside of a spline moved into it.
    Vec<2> wrapped(Vec<2> uv) const;
    // Into splines that do not close, whatever their other parameter does.
    Vec<2> inside(Vec<2> uv) const;
    Vec<3> point(const Vec<2>& uv) const { return jet<0>(*s_, wrapped(uv).c).value(); }
    // Newton's method towards the nearest point, from a guess; `target`: a point and how it moves.
    Foot foot(const Vec<3>& target, const Vec<3>& motion, const Vec<2>& guess) const;
    // Newton's method with steps that are held back where it does not converge: slow, and never further away.
    Vec<2> damped_foot(const Vec<3>& target, const Vec<2>& guess) const;
    // Parameters of the nearest point, or of one that is nearly so.
    Vec<2> locate(const Vec<3>& p) const;
    // The curve in space where parameter `axis` is `at`, as a function of the other one; nothing for offsets.
    std::optional<CurveGeometry<3>> iso(int axis, double at) const;

private:
    void profile_traits(const CurveGeometry<3>& profile, int axis);
    void poles_of(const Revolution& s, double close);
    void poles_of_sides(double stated);
    std::optional<Vec<2>> closed_form(const Vec<3>& p) const;
    struct Sample {
        Vec<2> at;
        Vec<3> point;
    };
    struct Grid {
        std::vector<Sample> samples;
        std::size_t columns;
    };
    std::unique_ptr<Grid> make_grid() const;

    const SurfaceGeometry* s_;
    double close_, seam_;
    std::array<double, 2> period_{}, apart_{kInfinity, kInfinity};
    std::array<Interval, 2> whole_{};
    std::array<bool, 2> spline_{};
    std::vector<Pole> poles_;
    Once<Grid> grid_;
};

}  // namespace freiform::step
