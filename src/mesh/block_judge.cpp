#include "block_judge_detail.hpp"

namespace freiform {

namespace {

struct BlockJudge {
    const CurvatureTree& tree;
    const Judge& judge;
    double tolerance;
    const CurvatureTree::Block& block;

    double within(double bound) const { return bound <= tolerance ? bound : kInfinity; }

    // Of a cell of this size in the box, `plain` of whose triangles' corners are plain.
    double bound(const Bending& at, const Box<2>& box, const Vec<2>& cell, double error, int plain) const {
        return within(judge.cell(at, box, cell, error, plain, block.node).bound);
    }

    double halves(const Bending& at, const Box<2>& box, const Vec<2>& cell, double error) const {
        if (tree.is_all_plain() || !at.knows_middle()) return kInfinity;
        return within(judge.cells(at, box, cell, error, block.node).bound);
    }

    JudgedBlock leaf() const {
        const Bending& at = tree.part_bendings(block)[0];
        const Vec<2> size = block.box.hi - block.box.lo, cell = kCellRounding * size;
        const double error = judge.cell_error(at, block.box, cell);
        double of_halves = error;
        const auto& proof = tree.proof_of(block.node);
        if (at.knows_middle() && error > tolerance)
            of_halves = std::min(
                error, proof.whole < kInfinity ? proof.whole : judge.whole_halves_error(at, block.box));
        JudgedBlock out;
        out.flat = within(error), out.flat_halves = within(of_halves);
        if (tree.is_all_plain()) return out;
        if (at.knows_middle())
            out.halves = within(judge.halves(at, block.box, of_halves, proof.bound, block.node));
        if (!std::isfinite(out.halves)) out.halves = out.usual = of_leaf(at, error, 0);
        if (std::isfinite(out.halves)) out.footless = of_leaf(at, error, 1);
        return out;
    }

    double of_leaf(const Bending& at, double error, int plain) const {
        return within(judge.leaf(at, block.box, error, plain, block.node).bound);
    }
    double usual_of_leaf() const {
        const Bending& at = tree.part_bendings(block)[0];
        const Vec<2> cell = kCellRounding * (block.box.hi - block.box.lo);
        return of_leaf(at, judge.cell_error(at, block.box, cell), 0);
    }

    // Of the first cell of each part, as if corners were plain where a foot is not needed.
    JudgedBlock parts() const {
        const Vec<2> cell = kCellRounding * BlockGrid(block.box, block.halves).largest_cell();
        const bool all_plain = tree.is_all_plain();
        const BlockGrid parts(block.box, block.parts);
        const Bending* at = tree.part_bendings(block).data();
        JudgedBlock out{0, 0, kInfinity, 0};
        for (int i = 0; i < parts.cells(0); ++i)
            for (int j = 0; j < parts.cells(1); ++j, ++at) {
                const Box<2> box{parts.at(i, j), parts.at(i + 1, j + 1)};
                const double error = judge.cell_error(*at, box, cell);
                const double usual = bound(*at, box, cell, error, all_plain ? 3 : 0);
                out.usual = std::max(out.usual, usual);
                out.halves =
                    std::max(out.halves, std::isfinite(usual) ? usual : halves(*at, box, cell, error));
                if (!std::isfinite(out.halves)) return out;
                if (!all_plain && std::isfinite(out.footless))
                    out.footless = std::max(out.footless, bound(*at, box, cell, error, 1));
            }
        return out;
    }
};

}  // namespace

double usual_of_leaf(const CurvatureTree& tree, const Judge& judge, double tolerance,
                     const CurvatureTree::Block& leaf) {
    return BlockJudge{tree, judge, tolerance, leaf}.usual_of_leaf();
}

JudgedBlock judged_block(const CurvatureTree& tree, const Judge& judge, double tolerance,
                         const CurvatureTree::Block& block) {
    const BlockJudge judged{tree, judge, tolerance, block};
    return block.first_part < 0 ? judged.leaf() : judged.parts();
}

}  // namespace freiform
