#include "document_detail.hpp"

#include <algorithm>
#include <cmath>

namespace freiform::document_detail {

std::unexpected<Refusal> expected(std::string_view what, json::Value found, std::string where) {
    std::string is(json::name_of(found.kind()));
    if (found.is(json::Kind::array)) is = text("an array of ", found.size());
    if (found.is(json::Kind::number)) is = text("the number ", found.number());
    if (found.is(json::Kind::boolean)) is = found.boolean() ? "true" : "false";
    if (found.is(json::Kind::string)) is = text("\"", found.string().substr(0, 40), "\"");
    return refuse(RefusalKind::invalid, std::move(where), text("expected ", what, ", found ", is));
}

Result<double> read_number(json::Value v) {
    if (!v.is(json::Kind::number)) return expected("a number", v);
    if (!std::isfinite(v.number()))
        return refuse(RefusalKind::nonfinite, "", "the number is beyond the range of double, about 1.8e308");
    return v.number();
}

Result<int> read_int(json::Value v) {
    if (!v.is(json::Kind::number)) return expected("a whole number", v);
    const double x = v.number();
    if (!(std::abs(x) <= 0x7fffffff) || x != std::trunc(x)) return expected("a whole number below 2^31", v);
    return int(x);
}

Result<bool> read_bool(json::Value v) {
    if (!v.is(json::Kind::boolean)) return expected("true or false", v);
    return v.boolean();
}

Result<std::string> read_string(json::Value v) {
    if (!v.is(json::Kind::string)) return expected("a string", v);
    return v.string();
}

Result<std::vector<double>> read_numbers(json::Value v) { return read_list(v, read_number); }

Result<std::optional<Colour>> read_colour(json::Value v) {
    const auto c = read_numbers(v);
    if (!c) return std::unexpected(c.error());
    if (c->size() != 3 && c->size() != 4) return expected("3 or 4 numbers between 0 and 1", v);
    for (std::size_t i = 0; i < c->size(); ++i)
        if (!((*c)[i] >= 0 && (*c)[i] <= 1))
            return refuse(RefusalKind::invalid, text("[", i, "]"), text("expected 0 to 1, found ", (*c)[i]));
    return Colour{(*c)[0], (*c)[1], (*c)[2], c->size() == 4 ? (*c)[3] : 1};
}

Result<Fields> Fields::read(json::Value v, std::string_view what, std::span<const std::string_view> allowed) {
    if (!v.is(json::Kind::object)) return expected(text(what, " (an object)"), v);
    Fields f(v);
    for (json::Member m : v.members()) {
        if (std::find(allowed.begin(), allowed.end(), m.key) == allowed.end()) {
            const std::string meant = did_you_mean(m.key, allowed);
            return refuse(RefusalKind::invalid, m.key.substr(0, 64),
                          text(what, " has no such field",
                               meant.empty() ? text("; it may have ", listed(allowed)) : meant));
        }
        f.members_.push_back(std::move(m));
    }
    return f;
}

const json::Value* Fields::find(std::string_view key) const {
    for (const json::Member& m : members_)
        if (m.key == key) return &m.value;
    return nullptr;
}

Result<json::Value> Fields::get(std::string_view key) const {
    const json::Value* v = find(key);
    if (!v) return refuse(RefusalKind::invalid, std::string(key), "is missing");
    return *v;
}

Result<std::string> read_type(json::Value v, std::string_view otherwise,
                              std::span<const std::string_view> known) {
    if (!v.is(json::Kind::object)) return expected("an object", v);
    for (const json::Member& m : v.members()) {
        if (m.key != "type") continue;
        auto type = read_string(m.value);
        if (!type) return refuse_within("type", type.error());
        if (std::find(known.begin(), known.end(), *type) == known.end())
            return expected(text(listed(known), did_you_mean(*type, known)), m.value, "type");
        return type;
    }
    if (otherwise.empty())
        return refuse(RefusalKind::invalid, "type", text("is missing; expected ", listed(known)));
    return std::string(otherwise);
}

}  // namespace freiform::document_detail
