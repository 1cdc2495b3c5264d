// Tolerances. A file promises that the curve of an edge and the images of its parameter curves agree within
// the tolerance of the edge. Samples tell where that may not hold and where a better parameter curve is worth
// its time; whatever is then replaced or raised gets a proven bound (model/edge_gap), and the model says so.
#include "converter.hpp"
#include "refit.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace freiform::occt {

void Converter::report(int edge, std::string what, double bound, double estimate) {
    Approximation a{"", std::move(what), std::nullopt,
                    0};  // `finish` knows the number that the edge will have
    if (std::isfinite(bound))
        a.bound = bound;
    else
        a.estimate = estimate;
    out_.model.approximations.push_back(std::move(a));
    approximated_.push_back(edge);
}

namespace {

// Samples miss the largest value of a smooth function by little: below the tolerance by this factor they are
// believed, of what the file promises.
constexpr double kMargin = 1.5;
// Relative to the size of the face: better parameter curves are looked for from here, and what is this far
// off describes another face.
constexpr double kWorthRefitting = 1e-9, kHopeless = 0.25;

}  // namespace

// Replaces a parameter curve that misses its edge if that helps. `worst`: its gap, before and after.
bool Converter::improve(const Face& f, Coedge& c, double size, double& worst) const {
    const Edge& e = out_.model.edges[std::size_t(c.edge)];
    if (!e.curve || !(worst > kWorthRefitting * size)) return false;
    auto better = refit(f.surface, *e.curve, c.curve, e.range, kWorthRefitting / 10 * size);
    if (!better) return false;
    const double rest = sampled_gap(f.surface, e, vertex_of(e), *better);
    if (!(rest < worst / 2)) return false;
    c.curve = std::move(*better);
    worst = rest;
    return true;
}

EdgeGap Converter::gap_of(const DerivativeQuery<2, 3>& surface, const Suspect& suspect, double target) const {
    const Coedge& c = *suspect.coedge;
    const Edge& e = out_.model.edges[std::size_t(c.edge)];
    const CurveGeometry<3> vertex = Line<3>{vertex_of(e), {}};
    EdgeGapOptions options;
    options.target = suspect.is_changed() ? target : e.tolerance;
    options.factor = suspect.is_changed() ? 1.25 : 1.05;
    return edge_gap(surface, c.curve, e.curve ? *e.curve : vertex, e.range, options);
}

// Lists a parameter curve that was replaced or does not keep the tolerance of the file, with a proven bound
// of its distance from the edge, and raises the tolerance of the edge to it.
void Converter::tell(const Suspect& suspect, const EdgeGap& gap, std::string_view where) {
    const Coedge& c = *suspect.coedge;
    Edge& e = out_.model.edges[std::size_t(c.edge)];
    const double stated = stated_[std::size_t(c.edge)];
    const bool changed = suspect.is_changed();
    const double found = std::max(suspect.sampled, gap.found), estimate = kMargin * found,
                 distance = std::isfinite(gap.bound) ? gap.bound : estimate;
    const bool beyond = distance > stated;
    if (!changed && !beyond) return;
    std::string what;
    if (changed)
        what = text("its parameter curve on ", where,
                    suspect.replaced ? " is replaced by a spline that follows the edge"
                                     : " ends before the edge does and is stretched");
    if (beyond)
        what += text(changed ? ", but " : "", "lies up to ", in_file(found), " beside ",
                     changed ? "it" : where, "; the file says at most ", in_file(stated));
    report(c.edge, std::move(what), gap.bound, estimate);
    e.tolerance = std::max(e.tolerance, distance);
}

double Converter::size_of(const Face& f) const {
    Box<3> box;
    for (const Loop& l : f.loops)
        for (const Coedge& c : l.coedges)
            if (const Edge& e = out_.model.edges[std::size_t(c.edge)]; e.curve)
                for (int i = 0; i <= 8; ++i)
                    box.add(jet<0>(*e.curve, e.range.lo + e.range.length() * i / 8).value());
    return box.diagonal();
}

// Replaces parameter curves that miss their edge, as far as that helps, and raises the tolerances of edges
// that the others do not keep. Refuses the face if one misses by a good part of the size of the face. On
// splines that takes longer than reading: threads share it.
Result<void> Converter::check_tolerance(Face& f, std::string_view where) {
    const double size = size_of(f);
    const bool takes_long = visit_one(
        [](const auto& s) {
            return requires { s.net(); };
        },
        f.surface);
    const auto each = [&](std::span<Suspect> all, auto&& what) {
        parallel_for(all.size(), takes_long ? 1 : all.size(), [&](std::size_t k) { what(all[k]); });
    };
    std::vector<Suspect> suspects;
    for (Loop& l : f.loops)
        for (Coedge& c : l.coedges) suspects.push_back({&c});
    each(suspects, [&](Suspect& s) {
        const Edge& e = out_.model.edges[std::size_t(s.coedge->edge)];
        s.sampled = sampled_gap(f.surface, e, vertex_of(e), s.coedge->curve);
        s.replaced = improve(f, *s.coedge, size, s.sampled);
    });
    for (Suspect& s : suspects) {
        if (size > 0 && !(s.sampled < kHopeless * size))
            return refuse(
                RefusalKind::ill_conditioned, "parameter curve",
                text("misses its edge by ", in_file(s.sampled), "; the face has a size of ", in_file(size)));
        s.stretched = std::find(stretched_.begin(), stretched_.end(),
                                std::pair(s.coedge->edge, s.coedge->reversed)) != stretched_.end();
    }
    std::erase_if(suspects, [&](const Suspect& s) {
        const Edge& e = out_.model.edges[std::size_t(s.coedge->edge)];
        return !s.is_changed() && !(kMargin * s.sampled > e.tolerance);
    });
    if (suspects.empty()) return {};
    const DerivativeQuery<2, 3> surface(f.surface);
    const double target = kWorthRefitting * size;
    // Of an edge that comes twice the second use is asked about with what the first makes of its tolerance.
    std::set<int> seen;
    for (Suspect& s : suspects) s.is_first = seen.insert(s.coedge->edge).second;
    each(suspects, [&](Suspect& s) {
        if (s.is_first) s.gap = gap_of(surface, s, target);
    });
    for (const Suspect& s : suspects) tell(s, s.is_first ? s.gap : gap_of(surface, s, target), where);
    return {};
}

}  // namespace freiform::occt
