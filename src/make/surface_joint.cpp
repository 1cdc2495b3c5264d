// Rows of control points that join a surface.
//
// Idea: the derivatives across of the surface at its edge are spline curves along it; put into the power
// series a, b, s of the new parameter they give the derivatives of the neighbour, polynomials again, on every
// piece of the edge. Derivatives of order 0 .. k at a clamped edge determine its first k + 1 rows, and
// polynomials on pieces determine the B-spline coefficients of a row: each is a blossom of one of the pieces.
//
// Notation: p degree across, q along; Q that of the neighbour along; D_j derivative of order j of the
// neighbour.
//
// Method: Taylor: next = s sum_ij previous^(i,j) a^i b^j / (i! j!), truncated after u^k. The polynomial f =
// sum c_j x^j, c_j = D_j / j!, on the first span of a clamped spline of degree n with the knots x_1, x_2, ..
// after the edge has the blossoms f(0, .., 0, x_1, .., x_i) = sum_j c_j e_j(x_1 .. x_i) / C(n, j), e_j
// elementary symmetric: row i depends on the derivatives up to order i alone. With all x equal it is the
// Bezier formula.
//
// Accuracy: everything in numbers of 106 bits, rounded at the end, as for curves (joint.cpp): a determined
// coefficient is the exact one rounded once, as long as cancellation leaves 53 of those bits.
// Cost: O(k^3) products of polynomials of degree Q per piece, O(Q^2) per coefficient.
//
// Why not solve for connection functions that suit given rows of the neighbour: they are quotients, and a row
// that satisfies them exactly has a degree that nobody asked for. Here the functions are given, so rows
// exist.
//
// References: [Farin 2002, ch. 20], [Ye, Liang & Nowacki 1996], [Ramshaw 1989].
#include "joint_rows_detail.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/make/surface_joint.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using detail::is_zero;
using detail::knots_after;

std::size_t order_of(const ShapeFunctions& s) { return s.across.size(); }
int degree_of(const ShapeFunction& f) { return std::max(int(f.size()) - 1, 0); }
bool moves_along(const ShapeFunctions& s) { return !std::ranges::all_of(s.along, is_zero); }
bool is_constant(const ShapeFunctions& s) {
    for (const auto* list : {&s.across, &s.scale})
        for (const ShapeFunction& f : *list)
            if (f.size() > 1) return false;
    return !moves_along(s);
}

Result<void> check(const ShapeFunctions& s, bool rational) {
    const std::size_t k = order_of(s);
    if (k > std::size_t(kMaxDegree))
        return refuse(RefusalKind::unsupported, "across", text("order ", k, " is above ", kMaxDegree));
    const std::pair<const char*, const std::vector<ShapeFunction>*> lists[] = {
        {"across", &s.across}, {"along", &s.along}, {"scale", &s.scale}};
    for (const auto& [name, list] : lists) {
        if (list->size() > k)
            return refuse(RefusalKind::invalid, name,
                          text("has ", list->size(), " functions, the order is ", k));
        for (std::size_t j = 0; j < list->size(); ++j)
            for (std::size_t i = 0; i < (*list)[j].size(); ++i)
                if (!std::isfinite((*list)[j][i]))
                    return refuse(RefusalKind::nonfinite, text(name, "[", j, "][", i, "]"), "is not finite");
    }
    if (k > 0 && (s.across[0].empty() || std::ranges::any_of(s.across[0], [](double x) { return !(x > 0); })))
        return refuse(RefusalKind::invalid, "across[0]",
                      "has a coefficient that is not positive: the neighbour could turn back");
    if (!rational && !s.scale.empty())
        return refuse(RefusalKind::invalid, "scale", "is given for a polynomial surface");
    return {};
}

template <class P>
Result<void> check_edge(const Surface<P>& s, SurfaceEdge edge) {
    if (edge.axis != 0 && edge.axis != 1)
        return refuse(RefusalKind::invalid, "edge.axis", text(edge.axis, " is not 0 or 1"));
    if (s.basis(edge.axis).is_closed())
        return refuse(RefusalKind::no_answer, "edge", "is on a closed axis, where the surface has no edge");
    return {};
}

// The degree along of the neighbour: the highest of what the derivatives of order 1 .. k are made of.
int degree_along(int q, const ShapeFunctions& s) {
    const int k = int(order_of(s));
    // Of the terms of u^m in a^i b^j and s, with the derivative along taken j times.
    int a = 0, b = -1, g = 0;  // degrees per power of u
    for (int m = 1; m <= k; ++m) {
        const auto at = [&](const std::vector<ShapeFunction>& list) {
            return std::size_t(m) <= list.size() ? degree_of(list[std::size_t(m - 1)]) : 0;
        };
        const auto per = [&](int d) { return (d + m - 1) / m; };
        a = std::max(a, per(at(s.across)));
        g = std::max(g, per(at(s.scale)));
        if (std::size_t(m) <= s.along.size() && !is_zero(s.along[std::size_t(m - 1)]))
            b = std::max(b, at(s.along) > 0 ? per(at(s.along) - 1) : -1);
    }
    return q + k * std::max({a, b, g, 0});
}
// The knots that the rows need along the edge: at every break inside, as a multiplicity for degree Q.
template <class P>
Result<std::vector<int>> multiplicities(const Surface<P>& s, SurfaceEdge edge, const ShapeFunctions& shape,
                                        int degree) {
    const BSplineBasis& along = s.basis(1 - edge.axis);
    const auto breaks = along.breaks();
    std::vector<int> out;
    for (std::size_t i = 1; i + 1 < breaks.size(); ++i) {
        const int left =
            along.degree() - along.multiplicity(breaks[i]) - (moves_along(shape) ? int(order_of(shape)) : 0);
        if (left < 0)
            return refuse(RefusalKind::no_answer, text("knot ", breaks[i]),
                          text("leaves ", along.degree() - along.multiplicity(breaks[i]),
                               " continuous derivatives along the edge; with shape functions along it order ",
                               order_of(shape), " needs as many"));
        out.push_back(degree - left);
    }
    return out;
}

}  // namespace

ShapeFunctions ShapeFunctions::parametric(int order) {
    ShapeFunctions s{std::vector<ShapeFunction>(std::size_t(std::max(order, 0))), {}, {}};
    if (order > 0) s.across[0] = {1};
    return s;
}

template <class P>
Result<BSplineBasis> next_basis(const Surface<P>& previous, SurfaceEdge edge, const ShapeFunctions& shape) {
    if (auto ok = check_edge(previous, edge); !ok) return std::unexpected(ok.error());
    if (auto ok = check(shape, Space<P>::kRational); !ok) return std::unexpected(ok.error());
    const BSplineBasis& along = previous.basis(1 - edge.axis);
    if (is_constant(shape)) return along;
    if (along.is_closed())
        return refuse(
            RefusalKind::unsupported, "edge",
            "is closed; shape functions along it, or not constant, need an open edge (restrict_to)");
    const int degree = degree_along(along.degree(), shape);
    if (degree > kMaxDegree)
        return refuse(RefusalKind::unsupported, "shape",
                      text("makes degree ", degree, " along the edge, above ", kMaxDegree));
    const auto more = multiplicities(previous, edge, shape, degree);
    if (!more) return std::unexpected(more.error());
    const auto breaks = along.breaks();
    std::vector<double> knots(std::size_t(degree) + 1, breaks.front());
    for (std::size_t i = 0; i < more->size(); ++i)
        knots.insert(knots.end(), std::size_t((*more)[i]), breaks[i + 1]);
    knots.insert(knots.end(), std::size_t(degree) + 1, breaks.back());
    return BSplineBasis::make(degree, std::move(knots));
}

template <class P>
Result<Surface<P>> next_g(const Surface<P>& previous, SurfaceEdge edge, const ShapeFunctions& shape,
                          const NextRows<P>& next) {
    const auto along = next_basis(previous, edge, shape);
    if (!along) return std::unexpected(along.error());
    const int k = int(order_of(shape)), rows = next.free.extent()[0], n = k + rows;
    if (n > kMaxDegree)
        return refuse(RefusalKind::unsupported, "free",
                      text("order ", k, " and ", rows, " free rows make degree ", n, ", above ", kMaxDegree));
    if (rows > 0 && next.free.extent()[1] != along->size())
        return refuse(RefusalKind::invalid, "free",
                      text("has ", next.free.extent()[1], " columns, the basis along the edge has ",
                           along->size(), " coefficients"));
    auto across = BSplineBasis::bezier(n, next.on);
    if (!across) return refuse_within("on", across.error());
    if (along->is_closed())
        return refuse(RefusalKind::unsupported, "edge",
                      "is closed; next_c joins closed edges, restrict_to cuts");
    Net<2, P> net({n + 1, along->size()});
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < along->size(); ++j) net.view()({k + 1 + i, j}) = next.free.view()({i, j});
    const detail::RowTarget target{{0, End::start}, *along, n, knots_after(*across, End::start, k), false};
    if (auto ok = fill_rows(detail::edge_pieces(previous, edge, k), shape, target, net); !ok)
        return std::unexpected(ok.error());
    return Surface<P>::make({*std::move(across), *along}, std::move(net));
}

template <class P>
Result<Surface<P>> next_c(const Surface<P>& previous, SurfaceEdge edge, int order, const NextRows<P>& next) {
    if (auto ok = check_edge(previous, edge); !ok) return std::unexpected(ok.error());
    const BSplineBasis &across = previous.basis(edge.axis), &along = previous.basis(1 - edge.axis);
    const int rows = next.free.extent()[0], m = across.size();
    if (rows > 0 && next.free.extent()[1] != along.size())
        return refuse(
            RefusalKind::invalid, "free",
            text("has ", next.free.extent()[1], " columns, the edge has ", along.size(), " coefficients"));
    std::vector<Curve<P>> columns;
    const BSplineBasis outwards = edge.end == End::end ? across : reverse(across).basis;
    for (int j = 0; j < along.size(); ++j) {
        Net<1, P> column({m});
        for (int i = 0; i < m; ++i) {
            const int from = edge.end == End::end ? i : m - 1 - i;
            column.flat()[std::size_t(i)] =
                previous.net().view()(edge.axis == 0 ? Index<2>{from, j} : Index<2>{j, from});
        }
        NextPiece<P> piece{next.on, {}, {}};
        for (int i = 0; i < rows; ++i) piece.free.push_back(next.free.view()({i, j}));
        auto c = freiform::next_c(Curve<P>::trusted({outwards}, std::move(column)), order, piece);
        if (!c) return refuse_within(text("column ", j), c.error());
        columns.push_back(*std::move(c));
    }
    const BSplineBasis basis = columns[0].basis();
    Net<2, P> net({basis.size(), along.size()});
    for (int j = 0; j < along.size(); ++j)
        for (int i = 0; i < basis.size(); ++i)
            net.view()({i, j}) = columns[std::size_t(j)].net().flat()[std::size_t(i)];
    return Surface<P>::make({basis, along}, std::move(net));
}

template <class P>
Result<Surface<P>> rejoined(const Surface<P>& previous, SurfaceEdge edge, const Surface<P>& neighbour,
                            SurfaceEdge neighbour_edge, bool against, const ShapeFunctions& shape) {
    const auto wanted = next_basis(previous, edge, shape);
    if (!wanted) return std::unexpected(wanted.error());
    if (auto ok = check_edge(neighbour, neighbour_edge); !ok) return refuse_within("neighbour", ok.error());
    const int axis = 1 - neighbour_edge.axis, k = int(order_of(shape));
    if (wanted->is_closed() || neighbour.basis(axis).is_closed())
        return refuse(RefusalKind::unsupported, "edge", "is closed; cut it open first (restrict_to)");
    const BSplineBasis& across = neighbour.basis(neighbour_edge.axis);
    const auto after = knots_after(across, neighbour_edge.end, k);
    if (across.degree() < k || int(after.size()) < k || knots_after(across, neighbour_edge.end, 1).empty())
        return refuse(RefusalKind::no_answer, "neighbour",
                      text("has degree ", across.degree(), " across the edge, which ",
                           across.degree() < k ? text("order ", k, " exceeds") : "is not clamped there"));
    Result<Surface<P>> out = restrict_to(neighbour, axis, neighbour.basis(axis).domain());
    if (out && out->basis(axis).degree() < wanted->degree())
        out = elevate(*out, axis, wanted->degree() - out->basis(axis).degree());
    if (!out) return refuse_within("neighbour", out.error());
    // Breaks of the surface as parameters of the neighbour; those that agree up to rounding are the same.
    const Interval from = wanted->domain(), to = out->basis(axis).domain();
    const double grant = 8 * 0x1p-53 *
                         (std::max(std::abs(from.lo), std::abs(from.hi)) / from.length() * to.length() +
                          std::max(std::abs(to.lo), std::abs(to.hi)));
    const auto breaks = wanted->breaks();
    std::vector<double> more;
    for (std::size_t i = 1; i + 1 < breaks.size(); ++i) {
        const double x = (breaks[i] - from.lo) / from.length();
        double at = against ? to.hi - x * to.length() : to.lo + x * to.length();
        for (const double t : out->basis(axis).breaks())
            if (std::abs(t - at) <= grant) at = t;
        const int left = wanted->degree() - wanted->multiplicity(breaks[i]),
                  need = out->basis(axis).degree() - left - out->basis(axis).multiplicity(at);
        more.insert(more.end(), std::size_t(std::max(need, 0)), at);
    }
    sort(more);
    if (!more.empty()) out = insert_knots(*out, axis, more);
    if (!out) return refuse_within("neighbour", out.error());
    Net<2, P> net = out->net();
    const detail::RowTarget target{neighbour_edge, out->basis(axis), across.degree(), after, against};
    if (auto ok = fill_rows(detail::edge_pieces(previous, edge, k), shape, target, net); !ok)
        return std::unexpected(ok.error());
    return Surface<P>::make(out->bases(), std::move(net));
}

#define FF_INSTANTIATE_SURFACE_JOINT(P)                                                                  \
    template Result<BSplineBasis> next_basis(const Surface<P>&, SurfaceEdge, const ShapeFunctions&);     \
    template Result<Surface<P>> next_c(const Surface<P>&, SurfaceEdge, int, const NextRows<P>&);         \
    template Result<Surface<P>> next_g(const Surface<P>&, SurfaceEdge, const ShapeFunctions&,            \
                                       const NextRows<P>&);                                              \
    template Result<Surface<P>> rejoined(const Surface<P>&, SurfaceEdge, const Surface<P>&, SurfaceEdge, \
                                         bool, const ShapeFunctions&);
FF_INSTANTIATE_SURFACE_JOINT(Vec<3>)
FF_INSTANTIATE_SURFACE_JOINT(Hom<3>)
#undef FF_INSTANTIATE_SURFACE_JOINT

}  // namespace freiform
