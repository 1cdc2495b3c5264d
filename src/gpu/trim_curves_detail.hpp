// The loops of a face as the fragment stage reads them: essay in trim_curves.cpp.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/model/model.hpp>

#include <vector>

namespace freiform {

// A curve that is monotone in both coordinates of the box of the face, which is [0, 1] x [0, 1].
struct MonotoneCurve {
    std::vector<Hom<2>> net;
    Box<2> box;  // of the ends
};

struct TrimCurves {
    Box<2> box;                           // of the loops, in parameters of the surface
    std::vector<MonotoneCurve> curves;    // empty: the face is the whole box
    std::vector<std::vector<int>> bands;  // of equal height in v: the curves that meet each
};

// Where the box of the loops is, in parameters; without loops the domain of the surface.
Result<Box<2>> parameter_box(const Face& face, const std::vector<Edge>& edges);

// Refuses (limit) more than 100 000 curves, and what rational_pieces refuses; the place names the coedge.
Result<TrimCurves> trim_curves(const Face& face, const std::vector<Edge>& edges);

// Odd-even, of a point of the unit box: the same question as the shader's, in double precision.
bool is_inside(const TrimCurves& trim, const Vec<2>& q);

}  // namespace freiform
