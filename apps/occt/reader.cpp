#include "reader.hpp"

#include <Interface_Check.hxx>

namespace freiform::occt {

namespace {

constexpr Unit kUnits[] = {
    {"METRE", "m", 1e3},        {"METER", "m", 1e3},      {"M", "m", 1e3},          {"MILLIMETRE", "mm", 1},
    {"MILLIMETER", "mm", 1},    {"MM", "mm", 1},          {"CENTIMETRE", "cm", 10}, {"CENTIMETER", "cm", 10},
    {"CM", "cm", 10},           {"DECIMETRE", "dm", 100}, {"KILOMETRE", "km", 1e6}, {"KM", "km", 1e6},
    {"MICROMETRE", "um", 1e-3}, {"MICRON", "um", 1e-3},   {"UM", "um", 1e-3},       {"NANOMETRE", "nm", 1e-6},
    {"INCH", "inch", 25.4},     {"IN", "inch", 25.4},     {"FOOT", "ft", 304.8},    {"FT", "ft", 304.8},
    {"YARD", "yd", 914.4},      {"MILE", "mi", 1609344},  {"MI", "mi", 1609344},    {"MIL", "mil", 0.0254},
    {"UIN", "uin", 0.0000254},  {"YD", "yd", 914.4},      {"DM", "dm", 100},        {"NM", "nm", 1e-6},
};

}  // namespace

const Unit* unit_named(std::string_view name) {
    std::string upper;
    for (char c : name)
        if (c != '\'' && c != ' ' && c != '.') upper += char(c >= 'a' && c <= 'z' ? c - 32 : c);
    for (const Unit& u : kUnits)
        if (u.word == upper) return &u;
    return nullptr;
}

std::string words(const Handle(TCollection_HAsciiString) & s) {
    if (s.IsNull() || s->IsEmpty()) return {};
    std::string_view v = s->ToCString();
    while (!v.empty() && v.front() == ' ') v.remove_prefix(1);
    while (!v.empty() && v.back() == ' ') v.remove_suffix(1);
    return std::string(v);
}

std::string type_of(const Handle(Standard_Transient) & entity) {
    std::string type = entity->DynamicType()->Name();
    for (std::string_view prefix : {"StepShape_", "StepGeom_", "IGESSolid_", "IGESGeom_"})
        if (type.starts_with(prefix)) type.erase(0, prefix.size());
    return type;
}

std::string reasons(const Interface_CheckIterator& checks, const Handle(Interface_InterfaceModel) & model,
                    LabelOf& label) {
    std::string out;
    int shown = 0, all = 0;
    Interface_CheckIterator list = checks;
    for (list.Start(); list.More(); list.Next()) {
        const Handle(Interface_Check) check = list.Value();
        for (int i = 1; i <= check->NbFails(); ++i, ++all) {
            if (shown >= 3) continue;
            ++shown;
            if (!out.empty()) out += "; ";
            const int number = list.Number();
            if (!model.IsNull() && number > 0 && number <= model->NbEntities())
                out += text(label(model, model->Value(number)), ": ");
            out += words(check->Fail(i));
        }
    }
    if (all > shown) out += text("; and ", all - shown, " more");
    return out;
}

std::unexpected<Refusal> unreadable(const std::string& path, std::string_view format, std::string why) {
    if (why.empty()) why = "it holds nothing that could be read";
    return refuse(RefusalKind::unreadable, path, text("not a readable ", format, " file: ", why));
}

}  // namespace freiform::occt
