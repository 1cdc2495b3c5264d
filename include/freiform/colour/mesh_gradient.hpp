// Plane surfaces with a colour at every control point: gradient meshes.
#pragma once
#include <freiform/colour/gradient.hpp>
#include <freiform/core/image.hpp>
#include <freiform/core/interval.hpp>

#include <array>

namespace freiform {

// Points and colours are splines of the same parameters; where the surface folds, what has the larger u, then
// the larger v, is in front, as in PDF.
class MeshGradient {
public:
    // A colour for each control point, in the order of the net. Refuses counts that disagree, components
    // outside [0, 1].
    static Result<MeshGradient> make(const Surface<Vec<2>>& surface, std::span<const Colour> colours,
                                     ColourSpace space = ColourSpace::srgb);
    // The bilinear Coons patch of a boundary of four cubics in a ring, twelve points p[0] .. p[11], p[0]
    // where u = v = 0, p[3] where v = 1, p[6] where both are 1; with colours at p[0], p[3], p[6], p[9]: what
    // PDF calls type
    // 6. Type 7 has sixteen points, the last four inside, in the same turn.
    static Result<MeshGradient> coons(std::span<const Vec<2>, 12> boundary,
                                      std::span<const Colour, 4> corners,
                                      ColourSpace space = ColourSpace::srgb);
    static Result<MeshGradient> tensor(std::span<const Vec<2>, 16> points, std::span<const Colour, 4> corners,
                                       ColourSpace space = ColourSpace::srgb);

    const Surface<Vec<2>>& surface() const { return surface_; }
    Box<2> box() const;
    Vec<2> point(double u, double v) const { return surface_(u, v); }
    Colour colour(double u, double v) const;

    // Corners of cells of equal parameters, n[0] x n[1] for each Bezier piece: vertex (i, j) is number i *
    // columns + j. Neighbouring cells share their corners, so no picture of them has cracks.
    struct Grid {
        int rows = 0, columns = 0;
        std::vector<Vec<2>> points;
        std::vector<Colour> colours;
    };
    Grid grid(int cells) const;
    // Bicubic pieces with colours at their four corners, between which sRGB is mixed bilinearly; `cells` x
    // `cells` for each Bezier piece. Exact but for rounding in the points; degrees above 3 are refused
    // (unsupported).
    struct Piece {
        std::array<std::array<Vec<2>, 4>, 4> net;  // [u][v]
        std::array<std::array<Colour, 2>, 2> corner;
    };
    Result<std::vector<Piece>> pieces(int cells) const;
    // So many cells for each Bezier piece that mixing sRGB within them is off by at most `tolerance` in a
    // component, as seen at the middles of cells and edges: an estimate. A power of two, at most 256.
    // Triangles are those on both sides of the diagonal from the smallest parameters to the largest.
    enum class Mixing { bilinear, triangles };
    int cells_for(double tolerance, Mixing mixing = Mixing::bilinear) const;

private:
    MeshGradient(Surface<Vec<2>> surface, Surface<Vec<4>> colours, ColourSpace space)
        : surface_(std::move(surface)), colours_(std::move(colours)), space_(space) {}
    Surface<Vec<2>> surface_;
    Surface<Vec<4>> colours_;
    ColourSpace space_;
};

// A picture of the meshes, each in front of those before, on `ground`. `width` pixels across the box, which
// is shown with y up; 4 x 4 samples in each pixel, each in at most one triangle of a mesh (those of an edge
// are of its lower or left side), so that nothing shines through joints. REQUIRES width from 1 to 16384.
Result<Image> picture_of(std::span<const MeshGradient> meshes, const Box<2>& box, int width,
                         const Colour& ground = {1, 1, 1, 1});

}  // namespace freiform
