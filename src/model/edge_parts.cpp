// How the parts of an edge share the work.
//
// Method: every smooth piece of an edge is cut at the kinks of its curves and begun with as many equal parts
// as samples of its curvature ask for. The bound of a part (edge_error.cpp) says how many parts it needs;
// errors fall with the square of the length, so the square root of error / tolerance is the number of chords
// that the part asks for. Of these first parts a few are asked. An edge that is alike all along, as a circle,
// gets equal parts. Where what they ask for is near to what they may, a last pass goes from part to part and
// makes up for each one's surprise in those behind it. Elsewhere, and where there are few parts, all are
// moved before so that each gets an equal share of the sum, rounded up, and the last pass follows where some
// still exceed, or fewer seem to do. Parts that exceed even so are cut. Where much of what was shared out is
// not needed in the end, neighbours that keep the demands together are joined.
//
// Cost: 1.4 to 1.6 bounds for each part of the models of bench/REPORT.md; two or three of edges that bend
// unevenly.
//
// Why not more passes: bounds jump where parts reach over knots, so demands of moved parts differ by some
// hundredths each time, and twelve passes found hardly fewer parts.
#include "edge_mesh_detail.hpp"

#include <freiform/mesh/face_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace freiform {

namespace {

constexpr double kConeOfAngle =
    0.375;  // of the angle, what half a cone along a segment may have: triangles reach farther
constexpr double kFull = 0.97;       // of what a part may ask for: what is aimed at
constexpr double kPartsAtOnce = 16;  // of a part at a time: bounds over long ones are too large

// Whether parts ask for the same.
bool is_near(double a, double b) {
    constexpr double kAlike = 0x1p-9;
    return std::abs(a - b) <= kAlike * std::max(a, b);
}

}  // namespace

// How many chords the part between a and b asks for: up to 1 if its own keeps the demands.
EdgeMesher::Part EdgeMesher::part(int edge, double a, double b, const EdgeDemands& demands) const {
    const bool turns = std::isfinite(demands.angle), degenerate = model_.edges[std::size_t(edge)].degenerate;
    const SegmentError err = error(edge, a, b, demands.tolerance, kConeOfAngle * demands.angle);
    const double length = degenerate || !(std::isfinite(demands.longest) || turns)
                              ? 0
                              : norm(position(edge, b) - position(edge, a));
    const double bound = err.polyline + err.sliver;
    // Normals turn twice as much over the segment as over the cone's half.
    const bool is_short =
        !turns || !(length > angle_floor(demands.tolerance, demands.angle, edges_[std::size_t(edge)].size));
    const double turn = is_short ? 0 : err.turn / (kConeOfAngle * demands.angle);
    const double needs = std::max({std::sqrt(std::max(bound, err.triangle) / demands.tolerance),
                                   length / demands.longest, std::min(turn, 2.0)});
    return {a, b, std::isnan(needs) ? kInfinity : needs, bound};
}

// The ends of `count` parts with equal shares of what the old ones ask for.
std::vector<double> EdgeMesher::shared_out(std::span<const Part> parts, int count) {
    constexpr double kEven = 0x1p-10;  // of the mean: what every part asks for at least
    double sum = 0;
    for (const Part& p : parts) sum += std::min(p.needs, kPartsAtOnce);
    const double least = sum > 0 ? kEven * sum / double(parts.size()) : 1;
    const auto share = [&](const Part& p) { return std::min(p.needs, kPartsAtOnce) + least; };
    sum += least * double(parts.size());
    std::vector<double> ends{parts.front().a};
    double before = 0;
    std::size_t i = 0;
    for (int k = 1; k < count; ++k) {
        const double at = sum * k / count;
        while (i + 1 < parts.size() && before + share(parts[i]) < at) before += share(parts[i++]);
        const Part& p = parts[i];
        ends.push_back(p.a + (p.b - p.a) * std::clamp((at - before) / share(p), 0.0, 1.0));
    }
    ends.push_back(parts.back().b);
    return ends;
}

// The last pass: parts one after the other, each as long as those of the passes before make believe and cut
// short where it exceeds. What is left is shared out anew each time, so what one is short of is made up by
// all. Where those before are a guess, what the last parts asked for beside it is believed of the next, too.
// Nothing where more than `most` would be needed; some parts may exceed the demands.
std::vector<EdgeMesher::Part> EdgeMesher::advanced(int edge, std::span<const Part> known, bool guessed,
                                                   int least, const EdgeDemands& demands,
                                                   std::size_t most) const {
    constexpr int kTries = 4;
    constexpr double kShorter = 0.3;     // shorter parts ask for less than their length says: by this power
    constexpr double kLatest = 2.0 / 3;  // how much the last part says of the ratio
    constexpr double kFarOff = 4;        // the most that the ratio is
    std::vector<double> left(known.size() + 1, 0.0);  // what the parts from here on ask for
    for (std::size_t i = known.size(); i-- > 0;)
        left[i] = left[i + 1] + std::max(std::min(known[i].needs, kPartsAtOnce), 0x1p-10);
    const double end = known.back().b;
    double ratio = guessed ? std::min(1.0, std::pow(left.front() / double(known.size()), -kShorter)) : 1;
    std::vector<Part> out;
    std::size_t i = 0;
    for (double a = known.front().a; a < end;) {
        while (i + 1 < known.size() && known[i].b <= a) ++i;
        const double rest =
            left[i + 1] + (left[i] - left[i + 1]) * (known[i].b - a) / (known[i].b - known[i].a);
        const double count =
            std::max({std::ceil(ratio * rest / kFull), double(least) - double(out.size()), 1.0});
        if (double(out.size()) + count > double(most)) return {};
        const double after = rest - rest / count;
        std::size_t k = i;
        while (k + 1 < known.size() && left[k + 1] > after) ++k;
        const double share = (after - left[k + 1]) / (left[k] - left[k + 1]);
        double b = count == 1 ? end : known[k].b - (known[k].b - known[k].a) * std::clamp(share, 0.0, 1.0);
        for (int tries = 0;; ++tries) {
            if (!(a < b)) return {};
            const Part p = part(edge, a, b, demands);
            if (guessed && tries == 0)
                ratio = std::clamp(ratio + kLatest * (p.needs * count / rest - ratio), 1 / kFarOff, kFarOff);
            if (p.needs <= 1 || tries == kTries) {
                out.push_back(p);
                break;
            }
            b = a + (b - a) * (kFull / std::min(p.needs, kPartsAtOnce));
        }
        a = b;
    }
    return out;
}

// The parts between the ends. Of many some are asked, and those between ask for what is between theirs; where
// the first two ask for the same, all do. Bounds of parts that are not asked are not known.
std::vector<EdgeMesher::Part> EdgeMesher::pilots(int edge, std::span<const double> ends,
                                                 const EdgeDemands& demands) const {
    constexpr std::size_t kFew = 5;
    constexpr double kSecond = 0.4;  // where no symmetry of closed curves repeats the first
    const std::size_t last = ends.size() - 2;
    const auto ask = [&](std::size_t i) { return part(edge, ends[i], ends[i + 1], demands); };
    std::vector<Part> out{ask(0)};
    if (last < kFew) {
        for (std::size_t i = 1; i <= last; ++i) out.push_back(ask(i));
        return out;
    }
    const auto guess_up_to = [&](std::size_t at, double needs) {
        const std::size_t before = out.size() - 1;
        const double from = std::min(out.back().needs, kPartsAtOnce),
                     step = (std::min(needs, kPartsAtOnce) - from) / double(at - before);
        for (std::size_t i = before + 1; i < at; ++i)
            out.push_back({ends[i], ends[i + 1], from + step * double(i - before), kInfinity});
    };
    const std::size_t second = std::size_t(kSecond * double(last));
    const Part middle = ask(second);
    const bool alike = is_near(out.front().needs, middle.needs);
    guess_up_to(second, middle.needs);
    out.push_back(middle);
    const Part end = alike ? Part{ends[last], ends[last + 1], middle.needs, kInfinity} : ask(last);
    guess_up_to(last, end.needs);
    out.push_back(end);
    return out;
}

// As many equal parts as keep the demands, of a piece all parts of which ask for the same. Nothing where they
// turn out not to, or to be too many.
std::vector<EdgeMesher::Part> EdgeMesher::all_equal(int edge, std::span<const Part> known, double count,
                                                    const EdgeDemands& demands, std::size_t most) const {
    constexpr int kTries = 3;
    constexpr double kAlike = 0.9;  // of what one asks for, all do
    for (int tries = 0; tries < kTries && count <= double(most); ++tries) {
        const bool same = count == double(known.size());
        std::vector<double> ends = shared_out(known, int(count));
        if (same)
            for (std::size_t i = 0; i < known.size(); ++i) ends[i] = known[i].a;
        std::vector<Part> out;
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
            if (!(ends[i] < ends[i + 1])) return {};
            out.push_back(same && known[i].bound < kInfinity ? known[i]
                                                             : part(edge, ends[i], ends[i + 1], demands));
            if (!(out.back().needs <= 1)) break;
        }
        const Shares s = shares_of(out);
        if (s.most <= 1) return s.least >= kAlike * s.most ? out : std::vector<Part>{};
        if (out.size() > 1) return {};
        count = std::max(std::ceil(count * std::min(s.most, kPartsAtOnce)), count + 1);
    }
    return {};
}

EdgeMesher::Shares EdgeMesher::shares_of(std::span<const Part> parts) {
    Shares out;
    for (const Part& p : parts) {
        out.sum += std::min(p.needs, kPartsAtOnce);
        out.most = std::max(out.most, p.needs);
        out.least = std::min(out.least, p.needs);
        out.known = out.known && p.bound < kInfinity;
    }
    return out;
}

// Parts of a smooth piece that share the work, close to as few as will do; some may exceed the demands.
std::vector<EdgeMesher::Part> EdgeMesher::equal_parts(int edge, Interval on, int least,
                                                      const EdgeDemands& demands,
                                                      std::size_t max_segments) const {
    constexpr int kPasses = 4;
    constexpr double kNear = 1.25;    // so little more than it may: what parts ask for is believed
    constexpr double kGuess = 2;      // and so little, what pilots ask for
    constexpr double kMany = 9;       // parts: of fewer one too many costs more than another pass
    constexpr double kUsed = 0.88;    // of what parts may ask for: those made after pilots are kept
    constexpr double kLonger = 1.15;  // what bounds ask for beside curvature, as a rule; where there are
    constexpr double kSome = 8;       // more than this
    const double curved = estimate(edge, on, demands.tolerance),
                 estimated = curved > kSome ? kLonger * curved : curved;
    const int begin = std::max(least, int(std::ceil(std::min(estimated, double(max_segments)))));
    std::vector<double> ends;
    for (int k = 0; k <= begin; ++k) ends.push_back(k == begin ? on.hi : on.lo + on.length() * k / begin);
    const auto increasing = [&] {
        return std::adjacent_find(ends.begin(), ends.end(), std::greater_equal{}) == ends.end();
    };
    if (!increasing()) ends = {on.lo, on.hi};
    std::vector<Part> now = pilots(edge, ends, demands), best;
    bool guessed = true;
    for (int pass = 1;; ++pass) {
        Shares s = shares_of(now);
        if (guessed && s.most <= kGuess && now.size() > 1 && is_near(s.least, s.most)) {
            auto equal = all_equal(edge, now, std::max(std::ceil(s.sum * (1 - 1e-9)), double(least)), demands,
                                   max_segments);
            if (!equal.empty()) return equal;
        }
        if (guessed && s.most <= kGuess && s.sum >= kMany) {
            auto first = advanced(edge, now, true, least, demands, max_segments);
            if (!first.empty()) {
                now = std::move(first);
                s = shares_of(now);
                if (s.sum >= kUsed * double(now.size())) return now;
                s.sum /= kFull;  // fewer are tried, but not too few
            }
        }
        if (s.most <= 1 && s.known) best = now;
        const double count = std::max(std::ceil(s.sum * (1 - 1e-9)), double(least));
        if (!best.empty() && (count >= double(best.size()) || s.sum >= kFull * double(best.size())))
            return best;
        if (count > double(max_segments) || (!guessed && s.most <= kNear) || pass == kPasses) break;
        ends = shared_out(now, int(count));
        if (!increasing()) break;
        guessed = false;
        now.clear();
        for (std::size_t i = 0; i + 1 < ends.size(); ++i)
            now.push_back(part(edge, ends[i], ends[i + 1], demands));
    }
    std::vector<Part> last =
        advanced(edge, now, false, least, demands, best.empty() ? max_segments : best.size() - 1);
    if (!last.empty()) return last;
    if (!best.empty()) return best;
    for (Part& p : now)
        if (p.bound == kInfinity) p = part(edge, p.a, p.b, demands);
    return now;
}

// Neighbours that keep the demands together become one. Equal parts are asked for with the worst of the
// curve's second derivatives; where that is large over a short way alone (a turn within a short knot span,
// as in curves that follow others) it is cut off in the end, and what was shared out for it is left over.
std::vector<EdgeMesher::Part> EdgeMesher::joined(int edge, std::vector<Part> parts, double longest,
                                                 const EdgeDemands& demands) const {
    constexpr double kUsed = 0.5;  // of what parts may ask for: where more is used, few can be joined
    double sum = 0;
    for (const Part& p : parts) sum += p.needs;
    if (!(sum < kUsed * double(parts.size()))) return parts;
    std::vector<Part> out;
    for (std::size_t i = 0; i < parts.size();) {
        Part best = parts[i];
        std::size_t next = i + 1;
        const auto longer = [&](std::size_t end) {
            if (end > parts.size() || parts[end - 1].b - best.a > longest) return false;
            const Part p = part(edge, best.a, parts[end - 1].b, demands);
            if (!(p.needs <= 1)) return false;
            best = p;
            next = end;
            return true;
        };
        std::size_t step = 1;
        while (longer(next + step)) step *= 2;
        while (step /= 2) longer(next + step);
        out.push_back(best);
        i = next;
    }
    return out;
}

}  // namespace freiform
