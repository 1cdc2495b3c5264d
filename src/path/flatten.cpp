// Flattening: the choice of the method, the way from the number of segments to a tolerance, and the
// comparison of the methods. How each works stands in flatten_adaptive.cpp and flatten_steps.cpp, the bound
// that all share in flatten_detail.hpp.
//
// All is computed with coordinates divided by a power of two (spline/chain.hpp), and multiplied by it
// in the end; so results scale exactly with powers of two.
//
// Adaptive by number: the number of segments falls as the tolerance grows (up to small exceptions), so the
// tolerance is bisected, on a logarithmic scale, for the smallest that needs no more than the given number.
#include "path/flatten_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/wide.hpp>

#include <optional>

namespace freiform {

namespace detail {

namespace {

template <class P>
using FlattenResult = Result<Polyline<Space<P>::kDim>>;

template <class P>
FlattenResult<P> by_number(const Chain<P>& chain, std::size_t wanted) {
    constexpr int kTrials = 24;
    // Nothing of a curve is farther from a chord than this.
    double high = 16 * std::sqrt(double(Space<P>::kDim)), low = 3 * chain.error(11 * chain.degree());
    FlattenResult<P> best = flatten_adaptive(chain, high, std::numeric_limits<std::size_t>::max());
    if (!best || best->segments() > wanted) return best;  // corners ask for more
    const std::size_t most = best->parts.size() + wanted;
    high = std::max(best->bound, low);
    for (int k = 0; k < kTrials && high > low * 1.001; ++k) {
        const double middle = low > 0 ? std::sqrt(low) * std::sqrt(high) : high / 16;
        auto now = flatten_adaptive(chain, middle, most);
        if (now && now->segments() <= wanted) {
            if (now->bound <= best->bound) best = std::move(now);
            high = std::min(middle, best->bound);
        } else {
            low = middle;
        }
    }
    return best;
}

}  // namespace

Result<void> check_options(const FlattenOptions& o) {
    const bool by_tolerance = o.tolerance != 0, by_segments = o.segments != 0;
    if (by_tolerance == by_segments)
        return refuse(RefusalKind::invalid, "tolerance",
                      "either a tolerance or a number of segments must be given, and not both");
    if (by_tolerance && !(o.tolerance > 0 && std::isfinite(o.tolerance)))
        return refuse(RefusalKind::invalid, "tolerance",
                      text("must be a positive finite distance, found ", o.tolerance));
    if (by_segments && o.segments < 1)
        return refuse(RefusalKind::invalid, "segments", text("must be positive, found ", o.segments));
    if (o.polygons && o.method != FlattenMethod::halving)
        return refuse(RefusalKind::invalid, "polygons", "only halving has control polygons to draw");
    return {};
}

namespace {

template <int D>
void to_model_units(Polyline<D>& line, int exponent) {
    if (exponent != 0)
        for (Vec<D>& p : line.points) p = scaled(p, exponent);
    line.bound = std::scalbn(line.bound, exponent) + 4 * std::numeric_limits<double>::denorm_min();
}

// The largest distance of samples of the curve from the polyline, each from the segments around it.
template <class P>
double measured(const Curve<P>& curve, const Polyline<Space<P>::kDim>& line) {
    constexpr int kSamples = 16;
    double most = 0;
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
        const double s = line.parameters[i], t = line.parameters[i + 1];
        if (!(s < t)) continue;
        for (int k = 1; k < kSamples; ++k) {
            const auto x = curve(s + (t - s) * k / kSamples);
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t j = i < 2 ? 0 : i - 2; j <= i + 2 && j + 1 < line.points.size(); ++j)
                least = std::min(least, distance(x, Segment(line.points[j], line.points[j + 1])));
            most = std::max(most, least);
        }
    }
    return most;
}

}  // namespace

}  // namespace detail

template <class P>
static Result<Polyline<Space<P>::kDim>> flattened(const Curve<P>& curve, const FlattenOptions& options) {
    if (auto ok = detail::check_options(options); !ok) return std::unexpected(ok.error());
    const detail::Chain<P> chain(curve);
    const double tolerance = std::scalbn(options.tolerance, -chain.exponent());
    if (options.tolerance > 0 && !(tolerance > 0))
        return detail::below_rounding(chain, tolerance, kUnitRoundoff);
    auto line = [&] {
        switch (options.method) {
            case FlattenMethod::uniform:
            case FlattenMethod::forward:
                return detail::flatten_uniform(chain, options, tolerance);
            case FlattenMethod::halving:
                return detail::flatten_halving(chain, options, tolerance);
            case FlattenMethod::adaptive:
                break;
        }
        return options.segments > 0 ? detail::by_number(chain, std::size_t(options.segments))
                                    : detail::flatten_adaptive(chain, tolerance, options.max_segments);
    }();
    if (line) detail::to_model_units(*line, chain.exponent());
    return line;
}

template <class P>
Result<Polyline<Space<P>::kDim>> flatten(const Curve<P>& curve, const FlattenOptions& options) {
    constexpr int D = Space<P>::kDim;
    if constexpr (detail::kIsWidened<P> && D == 3) {  // of one: by parameters; of two: drawings
        auto line = flattened(detail::widened(curve), options);
        if (!line) return std::unexpected(line.error());
        Polyline<D> out{{}, std::move(line->parameters), std::move(line->parts), line->bound, line->closed};
        for (const auto& p : line->points) out.points.push_back(detail::narrowed<D>(p));
        return out;
    } else {
        return flattened(curve, options);
    }
}

std::string_view name_of(FlattenMethod method) {
    constexpr std::string_view kNames[] = {"adaptive", "uniform", "forward", "halving"};
    return kNames[std::size_t(method)];
}

template <class P>
static Result<std::vector<FlattenComparison>> compared(const Curve<P>& curve, int segments) {
    std::vector<FlattenComparison> rows;
    const auto add = [&](FlattenMethod method, bool polygons) -> Result<void> {
        FlattenOptions options;
        options.method = method;
        options.segments = segments;
        options.polygons = polygons;
        const auto line = flatten(curve, options);
        if (!line) return std::unexpected(line.error());
        rows.push_back({method, polygons, line->segments(), line->bound, detail::measured(curve, *line)});
        return {};
    };
    for (int k = 0; k < 5; ++k)
        if (auto ok = add(FlattenMethod(std::min(k, 3)), k == 4); !ok) return std::unexpected(ok.error());
    return rows;
}

template <class P>
Result<std::vector<FlattenComparison>> compare_flattening(const Curve<P>& curve, int segments) {
    if constexpr (detail::kIsWidened<P> && Space<P>::kDim == 3)
        return compared(detail::widened(curve), segments);
    else
        return compared(curve, segments);
}

#define FF_INSTANTIATE(P)                                                                      \
    template Result<Polyline<Space<P>::kDim>> flatten(const Curve<P>&, const FlattenOptions&); \
    template Result<std::vector<FlattenComparison>> compare_flattening(const Curve<P>&, int);
FF_INSTANTIATE(Vec<1>)
FF_INSTANTIATE(Vec<2>)
FF_INSTANTIATE(Vec<3>)
FF_INSTANTIATE(Vec<4>)
FF_INSTANTIATE(Hom<1>)
FF_INSTANTIATE(Hom<2>)
FF_INSTANTIATE(Hom<3>)
FF_INSTANTIATE(Hom<4>)
#undef FF_INSTANTIATE

}  // namespace freiform
