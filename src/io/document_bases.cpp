// The bases of a patch of a document: degrees, knots and whether it is closed, per axis.
#include "document_detail.hpp"

namespace freiform::document_detail {

namespace {

// One array per axis; of a curve the array itself.
template <class Read>
auto read_per_axis(std::size_t axes, json::Value v, Read&& read)
    -> Result<std::vector<typename decltype(read(std::declval<json::Value>()))::value_type>> {
    if (axes == 1) {
        auto one = read(v);
        if (!one) return std::unexpected(one.error());
        std::vector<typename decltype(read(std::declval<json::Value>()))::value_type> list;
        list.push_back(std::move(*one));
        return list;
    }
    if (!v.is(json::Kind::array) || v.size() != axes)
        return expected(text("an array of ", axes, ", one entry per parameter"), v);
    return read_list(v, read);
}

struct Axis {
    int degree = -1;  // not given
    bool closed = false;
    std::optional<std::vector<double>> knots;
};

Result<BSplineBasis> make_basis(const Axis& a, int points, std::string_view degree_field,
                                std::string_view knots_field) {
    const auto fail = [&](std::string_view field, std::string message) {
        return refuse(RefusalKind::invalid, std::string(field), std::move(message));
    };
    if (a.closed && a.degree < 0) return fail(degree_field, "is missing; a closed spline needs it");
    if (!a.closed && !a.knots) {
        if (a.degree >= 0 && points != a.degree + 1)
            return fail(degree_field, text("without knots, degree ", a.degree, " needs ", a.degree + 1,
                                           " points, found ", points));
        if (points - 1 > kMaxDegree)
            return refuse(RefusalKind::unsupported, std::string(knots_field),
                          text("without knots, ", points, " points mean a Bezier curve of degree ",
                               points - 1, "; the highest degree is ", kMaxDegree));
        return BSplineBasis::bezier(points - 1);
    }
    std::vector<double> t;
    if (a.knots) {
        t = *a.knots;
        if (!a.closed && a.degree < 0) return fail(degree_field, "is missing; with knots it is needed");
        const long long wanted = a.closed ? points + 1LL : points + a.degree + 1LL;
        if (t.size() != std::size_t(wanted))
            return fail(
                knots_field,
                text(t.size(), a.closed ? " breaks for " : " knots for ", points, " points",
                     a.closed ? ", a closed spline" : text(" of degree ", a.degree), " needs ", wanted));
    } else {
        for (int i = 0; i <= points; ++i) t.push_back(i);
    }
    auto basis = a.closed ? BSplineBasis::periodic(a.degree, std::move(t))
                          : BSplineBasis::make(a.degree, std::move(t));
    if (basis) return basis;
    Refusal r = basis.error();  // its fields are "degree", "knots[i]", "breaks[i]"
    const std::size_t bracket = r.where.find('[');
    const std::string index = bracket == std::string::npos ? "" : r.where.substr(bracket);
    r.where = text(r.where.starts_with("degree") ? degree_field : knots_field, index);
    return std::unexpected(std::move(r));
}

Result<std::array<Axis, 3>> read_axes(const Fields& fields, std::size_t n) {
    std::array<Axis, 3> axes;
    const std::string_view degree = n == 1 ? "degree" : "degrees";
    const auto whole = [](json::Value v) -> Result<int> {
        const auto p = read_int(v);
        if (p && *p < 0) return expected("a degree of at least 0", v);
        return p;
    };
    if (fields.has(degree)) {
        const auto d = fields.get(degree, [&](json::Value v) { return read_per_axis(n, v, whole); });
        if (!d) return std::unexpected(d.error());
        for (std::size_t i = 0; i < n; ++i) axes[i].degree = (*d)[i];
    }
    if (fields.has("closed")) {
        const auto c = fields.get("closed", [&](json::Value v) { return read_per_axis(n, v, read_bool); });
        if (!c) return std::unexpected(c.error());
        for (std::size_t i = 0; i < n; ++i) axes[i].closed = (*c)[i];
    }
    if (fields.has("knots")) {
        auto k = fields.get("knots", [&](json::Value v) { return read_per_axis(n, v, read_numbers); });
        if (!k) return std::unexpected(k.error());
        for (std::size_t i = 0; i < n; ++i) axes[i].knots = std::move((*k)[i]);
    }
    return axes;
}

}  // namespace

Result<std::vector<BSplineBasis>> read_bases(const Fields& fields, std::size_t n, const Index<3>& points) {
    const auto axes = read_axes(fields, n);
    if (!axes) return std::unexpected(axes.error());
    std::vector<BSplineBasis> made;
    for (std::size_t d = 0; d < n; ++d) {
        const std::string index = n == 1 ? "" : text("[", d, "]");
        auto basis = make_basis((*axes)[d], points[d], text(n == 1 ? "degree" : "degrees", index),
                                text("knots", index));
        if (!basis) return std::unexpected(basis.error());
        made.push_back(std::move(*basis));
    }
    return made;
}

}  // namespace freiform::document_detail
