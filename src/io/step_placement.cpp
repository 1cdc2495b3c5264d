// Points, directions, placements, transformations.
//
// A frame is made of unit vectors, from an axis and a direction that need not be orthogonal; one that is
// already of length 1 and orthogonal within rounding is taken as it stands, so that what was written with
// full precision comes back with the same bits.
#include "step_geometry.hpp"

#include <freiform/core/constants.hpp>

#include <cmath>

namespace freiform::step {

namespace {

// Unit length, but not touched if it already has it.
Vec<3> normalised(const Vec<3>& d) { return norm(d) == 1 ? d : unit(d); }

// Some vector across z, as the standard chooses it.
Vec<3> first_axis(const Vec<3>& z) {
    const Vec<3> d = std::abs(z[0]) == 1 && z[1] == 0 && z[2] == 0 ? Vec<3>{{0, 1, 0}} : Vec<3>{{1, 0, 0}};
    return unit(d - dot(d, z) * z);
}

Placement frame(const Vec<3>& o, const Vec<3>& z, std::optional<Vec<3>> toward) {
    Placement p;
    p.o = o, p.z = z;
    p.x = first_axis(z);
    if (toward) {
        const double skew = dot(*toward, z);
        if (const Vec<3> x = *toward - skew * z; norm(x) > 1e-9)
            p.x = std::abs(skew) <= 4 * kUnitRoundoff ? *toward : unit(x);
    }
    p.y = cross(p.z, p.x);
    return p;
}

}  // namespace

Result<Vec<3>> GeometryReader::triple(const Fields& f, int i, std::string_view what) const {
    const auto c = f.numbers(i, what);
    if (!c) return std::unexpected(c.error());
    if (c->empty() || c->size() > 3) return f.refused(text("has ", c->size(), " coordinates"));
    Vec<3> p{};
    for (std::size_t k = 0; k < c->size(); ++k) p[int(k)] = (*c)[k];
    return p;
}

Result<Vec<3>> GeometryReader::point(std::uint32_t i) const {
    const auto f = Fields::of(f_, i, Type::CARTESIAN_POINT, 1);
    if (!f) return std::unexpected(f.error());
    return triple(*f, f->size() - 1, "coordinates");  // a part of a complex instance has no name
}

Result<Vec<3>> GeometryReader::direction(std::uint32_t i) const {
    const auto f = Fields::of(f_, i, Type::DIRECTION, 2);
    if (!f) return std::unexpected(f.error());
    const auto d = triple(*f, 1, "ratios");
    if (!d) return d;
    if (max_abs(*d) == 0) return f->refused("is a direction of length 0", RefusalKind::invalid);
    return normalised(*d);
}

Result<Vec<3>> GeometryReader::vector(std::uint32_t i) const {
    const auto f = Fields::of(f_, i, Type::VECTOR, 3);
    if (!f) return std::unexpected(f.error());
    const auto at = f->reference(1, "orientation");
    if (!at) return std::unexpected(at.error());
    const auto length = f->number(2, "magnitude");
    if (!length) return std::unexpected(length.error());
    const auto ratios = Fields::of(f_, *at, Type::DIRECTION, 2);
    if (!ratios) return std::unexpected(ratios.error());
    const auto d = triple(*ratios, 1, "ratios");
    if (!d) return d;
    if (max_abs(*d) == 0) return ratios->refused("is a direction of length 0", RefusalKind::invalid);
    if (!(*length > 0)) return f->refused(text("has the magnitude ", *length), RefusalKind::invalid);
    return norm(*d) == *length ? *d : *length * unit(*d);
}

Result<Placement> GeometryReader::placement(std::uint32_t i) const {
    const bool single = f_.is(i, Type::AXIS1_PLACEMENT), flat = f_.is(i, Type::AXIS2_PLACEMENT_2D);
    const auto f = Fields::of(f_, i,
                              single ? Type::AXIS1_PLACEMENT
                              : flat ? Type::AXIS2_PLACEMENT_2D
                                     : Type::AXIS2_PLACEMENT_3D,
                              2);
    if (!f) return std::unexpected(f.error());
    const auto at = f->reference(1, "location");
    if (!at) return std::unexpected(at.error());
    const auto o = point(*at);
    if (!o) return std::unexpected(o.error());
    Vec<3> z{{0, 0, 1}};
    std::optional<Vec<3>> x;
    for (int k = 2; k <= (single || flat ? 2 : 3); ++k) {
        if (f->is_omitted(k)) continue;
        const bool axis = k == 2 && !flat;  // one in the plane has its first direction there
        const auto d = f->reference(k, axis ? "axis" : "reference direction");
        if (!d) return std::unexpected(d.error());
        const auto v = direction(*d);
        if (!v) return std::unexpected(v.error());
        if (axis)
            z = *v;
        else
            x = *v;
    }
    return frame(*o, z, x);
}

Result<GeometryReader::Operator> GeometryReader::transformation(std::uint32_t i) const {
    const std::uint32_t list = f_.part(i, Type::CARTESIAN_TRANSFORMATION_OPERATOR_3D);
    if (list == kMissing) {
        const auto p = placement(i);
        if (!p) return std::unexpected(p.error());
        return Operator{*p, 1};
    }
    // The last five: axis1, axis2, origin, scale, axis3; names come before them.
    const Fields f(f_, i, list);
    if (f.size() < 5) return f.refused("has fewer than five values");
    const int k = f.size() - 5;
    std::array<std::optional<Vec<3>>, 3> axis;
    const auto read = [&](int field, int which) -> Result<void> {
        if (f.is_omitted(field)) return {};
        const auto d = f.reference(field, "axis");
        if (!d) return std::unexpected(d.error());
        const auto v = direction(*d);
        if (!v) return std::unexpected(v.error());
        axis[std::size_t(which)] = *v;
        return {};
    };
    for (const auto& [field, which] : {std::pair(k, 0), std::pair(k + 1, 1), std::pair(k + 4, 2)})
        if (auto ok = read(field, which); !ok) return std::unexpected(ok.error());
    const auto at = f.reference(k + 2, "origin");
    if (!at) return std::unexpected(at.error());
    const auto o = point(*at);
    if (!o) return std::unexpected(o.error());
    Operator made;
    if (!f.is_omitted(k + 3)) {
        const auto s = f.number(k + 3, "scale");
        if (!s) return std::unexpected(s.error());
        if (!(*s > 0)) return f.refused(text("has the scale ", *s), RefusalKind::invalid);
        made.scale = *s;
    }
    made.to = frame(*o, axis[2].value_or(Vec<3>{{0, 0, 1}}), axis[0]);
    if (axis[1] && dot(*axis[1], made.to.y) < 0) made.to.y = -made.to.y;
    return made;
}

}  // namespace freiform::step
