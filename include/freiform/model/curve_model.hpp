// Where curves, lines and rays meet the faces of a model.
#pragma once
#include <freiform/intersect/curve_part.hpp>
#include <freiform/model/model.hpp>

namespace freiform {

// A face that a contact is on, with the parameters there.
struct ContactFace {
    int face = -1;
    std::array<double, 2> uv{};
};

// contact.at: the parameter of the curve, then those of `face`. Kind `end`: on the boundary of the face, or
// so near to it that the parameters do not tell; it counts 0 to 1 times then.
struct ModelContact {
    Contact<3, 3> contact;
    int face = -1;
    int edge = -1;  // of the model, that kind `end` is on; -1: a segment between two of them
    std::vector<ContactFace> others;  // what else has the same place on its boundary: neighbours, a seam
};

// A face of which something is not known: over boxes of (t, u, v), or all, with the reason.
struct OpenContacts {
    int face = -1;
    std::vector<std::array<Interval, 3>> boxes;
    std::optional<Refusal> reason;
};

// The curve runs in a plane face over this interval of its parameter.
struct ModelOverlap {
    int face = -1;
    Interval on;     // its ends are ends of the curve, or within 2^-36 of the size of the model of a loop
    double gap = 0;  // bound: how far the curve is from the plane there
};

struct ModelContacts {
    std::vector<ModelContact> contacts;  // ordered by the parameter of the curve
    std::vector<ModelOverlap> overlaps;  // ordered by the face
    std::vector<OpenContacts> open;
};

// A model ready to be met by many. Const and safe to share between threads.
class IntersectModel {
public:
    explicit IntersectModel(const Model& model);

    // All faces. Contacts inside a face are as for its surface (curve_surface.hpp), and that they are inside
    // is proven: no curve of its loops meets their box of parameters, and the odd-even rule holds in its
    // middle, exactly. Those on the boundary are one where their boxes of t overlap, or their points are
    // within their gaps, the tolerances of the edges and 2^-36 of the size of the model. A line or polynomial
    // curve that runs in a plane face overlaps it; one that runs in another face is left open there. Refuses
    // what intersections with surfaces refuse. REQUIRES spans of one size.
    Result<void> intersect(std::span<const StraightLine> lines, std::span<ModelContacts> out,
                           const IntersectOptions& options = {}) const;
    Result<ModelContacts> intersect(const Curve<Hom<3>>& curve, const IntersectOptions& options = {}) const;

    // Analytic faces are searched as splines: bound of how far these are from them, the largest.
    double search_bound() const;

private:
    struct Prepared;
    std::shared_ptr<const Prepared> prepared_;
};

}  // namespace freiform
