// Banded maps applied to numbers.
//
// Idea: along an axis of a net the map acts on each coordinate of each fibre alone. In row-major order the
// numbers behind one index of the axis are one run, so a row of the result is a sum of weighted runs: one
// loop over neighbouring numbers, whatever the number of axes and coordinates is. Along the last axis a run
// is one coefficient, whose few coordinates are kept in registers.
#include <freiform/basis/band_map.hpp>

#include <algorithm>

namespace freiform {

namespace {

// Rows of runs of `Run` numbers.
template <std::size_t Run>
void apply_short(const BandMap& m, const double* in, double* out) {
    const double* w = m.entry.data();
    for (int i = 0; i < m.rows(); ++i, out += Run) {
        double sum[Run] = {};
        int column = m.first[std::size_t(i)] % m.cols;
        for (int k = 0; k < m.width; ++k, ++w) {
            const double* from = in + std::size_t(column) * Run;
            if (*w != 0)
                for (std::size_t c = 0; c < Run; ++c) sum[c] += *w * from[c];
            if (++column == m.cols) column = 0;
        }
        std::copy_n(sum, Run, out);
    }
}

void apply_long(const BandMap& m, const double* in, double* __restrict out, std::size_t run) {
    const double* w = m.entry.data();
    for (int i = 0; i < m.rows(); ++i, out += run) {
        std::fill_n(out, run, 0.0);
        int column = m.first[std::size_t(i)] % m.cols;
        for (int k = 0; k < m.width; ++k, ++w) {
            const double* from = in + std::size_t(column) * run;
            if (*w != 0)
                for (std::size_t c = 0; c < run; ++c) out[c] += *w * from[c];
            if (++column == m.cols) column = 0;
        }
    }
}

}  // namespace

void BandMap::apply(const double* in, double* out, std::size_t run, std::size_t blocks) const {
    const std::size_t from = std::size_t(cols) * run, to = std::size_t(rows()) * run;
    for (std::size_t b = 0; b < blocks; ++b, in += from, out += to) switch (run) {
            case 1:
                apply_short<1>(*this, in, out);
                break;
            case 2:
                apply_short<2>(*this, in, out);
                break;
            case 3:
                apply_short<3>(*this, in, out);
                break;
            case 4:
                apply_short<4>(*this, in, out);
                break;
            case 5:
                apply_short<5>(*this, in, out);
                break;
            default:
                apply_long(*this, in, out, run);
        }
}

}  // namespace freiform
