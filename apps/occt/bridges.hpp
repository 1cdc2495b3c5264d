// Loops that the reader leaves periods apart: edges that it adds where parameter curves lie periods apart
// although the edges meet, full turns around the surface that the file knows nothing of; and seams whose two
// sides it takes for one.
#pragma once
#include <freiform/model/model.hpp>

#include <Geom_Surface.hxx>
#include <array>
#include <optional>
#include <vector>

namespace freiform::occt {

// Leaves them out and moves what lies between them by their periods, where they go as far forth as back and
// the loop with them is longer than a period: no face covers its surface twice. Circles at the ends of a
// seam, which look the same, span one period, give or take what the file rounds off: without them nothing is
// left, or windows across the seam, the wrong way around. `period`: of both parameters, 0 for none.
void remove_bridges(Loop& loop, const std::vector<Edge>& edges, const std::array<double, 2>& period);

// The boundary of all of a torus but for windows across its seam: where both sides of the seam, a period
// apart, reach out instead of in, the reader has taken one for the other, and a face would cover the windows
// twice instead of leaving them out. They change their places.
void swap_sides(Loop& loop, const std::vector<Edge>& edges, const std::array<double, 2>& period);

// A surface of two poles whose boundary is its seam and nothing else: the file has the seam twice in one
// place of the parameters, where it encloses nothing.
struct Slit {
    int axis = 0;          // of the parameter that is periodic
    double period = 0;     // of it
    std::size_t turn = 0;  // the first coedge that runs the other way than the one before it
};
// Nothing where the loop is not all of a slit. `close`: points nearer than this are one.
std::optional<Slit> slit_of(const Loop& loop, const std::vector<Edge>& edges, const Handle(Geom_Surface) & s,
                            const std::array<double, 2>& period, double close);

// Whether the loop goes somewhere and back in one place of the parameters.
bool is_slit(const Loop& loop, const std::vector<Edge>& edges, const Handle(Geom_Surface) & s);

// Whether loops, all of which close in the parameters, have more on their right than on their left: they run
// the wrong way, or one that is around the others has been lost.
bool enclose_less_than_nothing(const std::vector<Loop>& loops, const std::vector<Edge>& edges);

}  // namespace freiform::occt
