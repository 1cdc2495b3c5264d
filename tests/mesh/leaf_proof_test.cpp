// What leaves keep of how they were accepted holds, and is used where the surface around bends as it asks.
#include "mesh/judge_detail.hpp"
#include "support/random.hpp"

#include <freiform/core/constants.hpp>

#include <gtest/gtest.h>
#include <map>

namespace freiform {
namespace {

using test::must;
using test::Random;

// Gentle but for a bump, so that leaves near it bend less than what is around them.
SurfaceGeometry bump(Random& random) {
    const auto basis = *BSplineBasis::clamped_uniform(3, 12);
    std::vector<Vec<3>> c;
    for (int i = 0; i < 12; ++i)
        for (int k = 0; k < 12; ++k)
            c.push_back({{double(i), k + 0.3 * random.real(-1, 1),
                          0.3 * random.real(-1, 1) + (i == 6 && k == 5 ? 3.0 : 0.0)}});
    return must(Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({12, 12}, c)));
}

const std::vector<Vec<2>> kPolygon{{{0, 0}}, {{9, 0}}, {{9, 7}}, {{0, 9}}};
const std::vector<std::array<int, 2>> kSegments{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
constexpr double kTolerance = 2e-3;

CurvatureTree tree_of(const DerivativeQuery<2, 3>& surface, bool shared = false) {
    return must(CurvatureTree::make(surface, kPolygon, kSegments,
                                    {.tolerance = kTolerance, .is_shared = shared}, 100'000, {true, true}));
}

Vec<3> point(const SurfaceGeometry& s, const Vec<2>& at) { return jet<0>(s, at.c).value(); }

// From a place nearby, by Gauss and Newton.
double distance(const SurfaceGeometry& s, const Vec<3>& p, Vec<2> at) {
    for (int k = 0; k < 30; ++k) {
        const auto j = jet<1>(s, at.c);
        const Vec<3>&u = j.d[1], &v = j.d[2], d = p - j.value();
        const double a = dot(u, u), b = dot(u, v), c = dot(v, v), e = dot(u, d), f = dot(v, d),
                     det = a * c - b * b;
        at += Vec<2>{{(e * c - f * b) / det, (f * a - e * b) / det}};
    }
    return norm(p - point(s, at));
}

struct OneCell {
    Box<2> box;
    const Bending& bends;
    const CurvatureTree::Proof& proof;
    int node;
};
template <class F>
void each_cell(const CurvatureTree& tree, F&& f) {
    for (std::size_t i = 0; i < tree.block_count(); ++i)
        if (const auto b = tree.block(i); b.first_part < 0)
            f(OneCell{b.box, tree.part_bendings(b)[0], tree.proof_of(b.node), b.node});
}

TEST(LeafProof, holds_for_both_halves) {
    Random random(21);
    const SurfaceGeometry s = bump(random);
    const DerivativeQuery<2, 3> surface(s);
    const auto tree = tree_of(surface);
    int wholes = 0, bounds = 0, smaller = 0;
    double most = 0;
    each_cell(tree, [&](const OneCell& cell) {
        const auto& [box, bends, proof, node] = cell;
        wholes += proof.whole < kInfinity, bounds += proof.bound < kInfinity;
        smaller += proof.bound < 0.9 * proof.whole && proof.bound <= kTolerance;
        const Vec<2> size = box.hi - box.lo;
        const auto half = half_of(box, bends.prefers_rising(size));
        for (const bool upper : {false, true}) {
            std::array<Vec<2>, 3> t = half;
            if (upper)
                for (Vec<2>& c : t) c = box.lo + (box.hi - c);
            for (int k = 0; k < 6; ++k) {
                double l[3] = {random.real(0, 1), random.real(0, 1), random.real(0, 1)};
                if (k == 0) l[0] = l[1] = l[2] = 1;
                const double sum = l[0] + l[1] + l[2];
                Vec<2> at{};
                Vec<3> p{};
                for (std::size_t c = 0; c < 3; ++c) at += l[c] / sum * t[c], p += l[c] / sum * point(s, t[c]);
                EXPECT_LE(norm(p - point(s, at)), proof.whole);
                if (!(proof.bound < kInfinity)) continue;
                const double found = distance(s, p, at);
                EXPECT_LE(found, proof.bound);
                most = std::max(most, found / proof.bound);
            }
        }
    });
    EXPECT_GT(wholes, 300);
    EXPECT_GT(bounds, 300);
    EXPECT_GT(smaller, 100) << "what is seen along normals is less";
    EXPECT_GT(most, 0.8) << "bounds that are useful";
}

TEST(LeafProof, counts_where_all_around_bends_as_little_as_it_asks) {
    Random random(22);
    const SurfaceGeometry s = bump(random);
    const DerivativeQuery<2, 3> surface(s);
    const auto tree = tree_of(surface);
    Box<2> face;
    for (const Vec<2>& p : kPolygon) face.add(p);
    const Judge judge(tree, surface, face, kTolerance);
    constexpr double kMark = 1e-30;  // no bound that anything else would say
    int counts = 0, others = 0;
    each_cell(tree, [&](const OneCell& cell) {
        const auto& [box, bends, proof, node] = cell;
        if (!(proof.bound < kInfinity)) return;
        const double found = judge.halves(bends, box, proof.whole, kMark, node);
        if (found != kMark) {
            ++others;
            EXPECT_EQ(found, judge.halves(bends, box, proof.whole, kInfinity, node));
            return;
        }
        ++counts;
        const Vec<2> reach = reach_of(bends, proof.whole);
        for (int k = 0; k < 12; ++k) {
            const Vec<2> at{{random.real(box.lo[0] - reach[0], box.hi[0] + reach[0]),
                             random.real(box.lo[1] - reach[1], box.hi[1] + reach[1])}};
            EXPECT_LE(bend_of_lengths(bends, seen_at(jet<2>(s, at.c), false)),
                      kBeyond * bend_of_lengths(bends, bends.full));
        }
    });
    EXPECT_GT(counts, 200);
    EXPECT_GT(others, 20) << "leaves beside the bump";
}

TEST(LeafProof, is_the_same_where_the_tree_is_grown_in_parts) {
    Random random(23);
    const SurfaceGeometry s = bump(random);
    const DerivativeQuery<2, 3> surface(s);
    const auto proofs = [&](const CurvatureTree& tree) {
        std::map<std::array<double, 2>, std::array<double, 2>> out;
        each_cell(tree, [&](const OneCell& c) {
            out[{c.box.lo[0], c.box.lo[1]}] = {c.proof.whole, c.proof.bound};
        });
        return out;
    };
    const auto alone = proofs(tree_of(surface)), together = proofs(tree_of(surface, true));
    ASSERT_GT(alone.size(), 300u);
    EXPECT_EQ(alone, together);
}

}  // namespace
}  // namespace freiform
