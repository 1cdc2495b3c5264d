// Idea. STEP and IGES are read twice removed from what they say: the reader scales all lengths to a unit that
// the program chooses. So the unit of a STEP file is looked up first and chosen, and the factor is 1. Where
// another unit than millimetres is chosen the reader takes parameter curves of IGES files wrongly (it looks
// for seams where they are not, and puts edges far from faces), and where numbers are small it loses edges,
// as its tolerances are not relative. So IGES files are read as if their numbers were millimetres, which
// leaves these as they are, or as the millimetres that they are: whoever asks divides by the factor.
#include "document.hpp"

#include <freiform/io/mesh_file.hpp>

#include <BRepBndLib.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_Static.hxx>
#include <NCollection_DataMap.hxx>
#include <Quantity_ColorRGBA.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <UnitsMethods.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>

namespace freiform::occt {

namespace {

// The names of units in STEP and IGES files, ours, and their size in millimetres.
struct Unit {
    std::string_view word, ours;
    double millimetres;
};
constexpr Unit kUnits[] = {
    {"METRE", "m", 1e3},        {"METER", "m", 1e3},      {"M", "m", 1e3},          {"MILLIMETRE", "mm", 1},
    {"MILLIMETER", "mm", 1},    {"MM", "mm", 1},          {"CENTIMETRE", "cm", 10}, {"CENTIMETER", "cm", 10},
    {"CM", "cm", 10},           {"DECIMETRE", "dm", 100}, {"KILOMETRE", "km", 1e6}, {"KM", "km", 1e6},
    {"MICROMETRE", "um", 1e-3}, {"MICRON", "um", 1e-3},   {"UM", "um", 1e-3},       {"NANOMETRE", "nm", 1e-6},
    {"INCH", "inch", 25.4},     {"IN", "inch", 25.4},     {"FOOT", "ft", 304.8},    {"FT", "ft", 304.8},
    {"YARD", "yd", 914.4},      {"MILE", "mi", 1609344},  {"MI", "mi", 1609344},    {"MIL", "mil", 0.0254},
    {"UIN", "uin", 0.0000254},  {"YD", "yd", 914.4},      {"DM", "dm", 100},        {"NM", "nm", 1e-6},
};
const Unit* unit_named(std::string_view name) {
    std::string upper;
    for (char c : name)
        if (c != '\'' && c != ' ' && c != '.') upper += char(c >= 'a' && c <= 'z' ? c - 32 : c);
    for (const Unit& u : kUnits)
        if (u.word == upper) return &u;
    return nullptr;
}

// Of a name that no table has it is the name itself, whose size nobody knows; without a name it is mm.
struct LengthUnit {
    std::string word;
    double millimetres;
};
LengthUnit unit_of_iges(const std::string& name) {
    if (const Unit* u = unit_named(name.empty() ? "MM" : std::string_view(name)))
        return {std::string(u->ours), u->millimetres};
    std::string word = name;
    for (char& c : word) c = c >= 'A' && c <= 'Z' ? char(c + 32) : c;
    const double millimetres = 1000 * metres_per(word).value_or(1e-3);
    return {std::move(word), millimetres};
}

std::string utf8(const TCollection_ExtendedString& s) {
    std::string out(std::size_t(s.LengthOfCString()) + 1, '\0');
    Standard_PCharacter p = out.data();
    out.resize(std::size_t(std::max(0, s.ToUTF8CString(p))));
    return out;
}
std::string name_of_label(const TDF_Label& label) {
    Handle(TDataStd_Name) name;
    return label.FindAttribute(TDataStd_Name::GetID(), name) ? utf8(name->Get()) : std::string();
}

template <class Where>
std::optional<Colour> colour_of(const Handle(XCAFDoc_ColorTool) & tool, const Where& where) {
    Quantity_ColorRGBA c;
    for (XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen})
        if (tool->GetColor(where, type, c)) {
            Colour out;
            c.GetRGB().Values(out.r, out.g, out.b, Quantity_TOC_sRGB);
            out.a = c.Alpha();
            for (double* x : {&out.r, &out.g, &out.b, &out.a}) *x = std::clamp(*x, 0.0, 1.0);
            return out;
        }
    return std::nullopt;
}

// The tree of an assembly, flattened: every leaf with the product of the places on the way to it.
void flatten(const TDF_Label& root, const Handle(XCAFDoc_ColorTool) & colours, std::vector<Part>& parts) {
    struct Visit {
        TDF_Label label;
        TopLoc_Location at;
        std::string name;
        std::optional<Colour> colour;
        int depth;
    };
    std::vector<Visit> open{{root, {}, {}, {}, 0}};
    while (!open.empty()) {
        Visit v = std::move(open.back());
        open.pop_back();
        if (v.depth > 1000) continue;
        TDF_Label label = v.label;
        if (XCAFDoc_ShapeTool::IsReference(label)) {
            if (!v.colour) v.colour = colour_of(colours, label);  // an outer instance overrides an inner one
            v.name = name_of_label(label);
            v.at = v.at * XCAFDoc_ShapeTool::GetLocation(label);
            if (!XCAFDoc_ShapeTool::GetReferredShape(v.label, label)) continue;
        }
        if (auto name = name_of_label(label); !name.empty()) v.name = std::move(name);
        if (!v.colour) v.colour = colour_of(colours, label);
        if (XCAFDoc_ShapeTool::IsAssembly(label)) {
            TDF_LabelSequence components;
            XCAFDoc_ShapeTool::GetComponents(label, components);
            for (int i = components.Length(); i >= 1; --i)
                open.push_back({components(i), v.at, v.name, v.colour, v.depth + 1});
        } else if (TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label); !shape.IsNull()) {
            parts.push_back({shape, v.at, v.name, v.colour});
        }
    }
}

struct Entity {
    std::string label, name;
};
using EntityMap = NCollection_DataMap<TopoDS_Shape, Entity, TopTools_ShapeMapHasher>;

std::string words(const Handle(TCollection_HAsciiString) & s) {
    if (s.IsNull() || s->IsEmpty()) return {};
    std::string_view v = s->ToCString();
    while (!v.empty() && v.front() == ' ') v.remove_prefix(1);
    while (!v.empty() && v.back() == ' ') v.remove_suffix(1);
    return std::string(v);
}

std::string entity_label(const Handle(Interface_InterfaceModel) & model,
                         const Handle(Standard_Transient) & entity) {
    std::string type = entity->DynamicType()->Name();
    for (std::string_view prefix : {"StepShape_", "StepGeom_", "IGESSolid_", "IGESGeom_"})
        if (type.starts_with(prefix)) type.erase(0, prefix.size());
    const auto step = Handle(StepData_StepModel)::DownCast(model);
    const int number = step.IsNull() ? 0 : step->IdentLabel(entity);
    if (number > 0) return text("#", number, " ", type);
    return text(words(model->StringLabel(entity)), " ", type);
}

// What the reader says about the file, shortened.
std::string reasons(const Interface_CheckIterator& checks, const Handle(Interface_InterfaceModel) & model) {
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
                out += text(entity_label(model, model->Value(number)), ": ");
            out += words(check->Fail(i));
        }
    }
    if (all > shown) out += text("; and ", all - shown, " more");
    return out;
}

struct Session {
    Handle(TDocStd_Document) document;
    Handle(XSControl_WorkSession) session;
};

// The parts and their attributes, out of a document that a reader has filled.
Document collect(const Session& s, std::string unit) {
    Document out;
    out.unit = std::move(unit);
    const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(s.document->Main());
    const Handle(XCAFDoc_ColorTool) colours = XCAFDoc_DocumentTool::ColorTool(s.document->Main());
    TDF_LabelSequence free;
    shapes->GetFreeShapes(free);
    for (int i = 1; i <= free.Length(); ++i) flatten(free(i), colours, out.parts);

    const Handle(Interface_InterfaceModel) model = s.session->Model();
    const Handle(Transfer_TransientProcess) process = s.session->TransferReader()->TransientProcess();
    EntityMap entities;  // made now: the reader empties its tables when it goes
    for (int i = 1; i <= model->NbEntities(); ++i) {
        const Handle(Standard_Transient) entity = model->Value(i);
        const TopoDS_Shape shape = TransferBRep::ShapeResult(process, entity);
        if (shape.IsNull() || (shape.ShapeType() != TopAbs_FACE && shape.ShapeType() != TopAbs_SOLID))
            continue;
        Entity e{entity_label(model, entity), {}};
        if (auto item = Handle(StepRepr_RepresentationItem)::DownCast(entity); !item.IsNull())
            e.name = words(item->Name());
        if (auto iges = Handle(IGESData_IGESEntity)::DownCast(entity); !iges.IsNull() && iges->HasName())
            e.name = words(iges->NameValue());
        entities.Bind(shape.Located(TopLoc_Location()), std::move(e));
    }
    // The labels that the tools of the document refer to live as long as the document.
    out.attributes = [colours, entities, document = s.document](const TopoDS_Shape& shape) {
        Attributes a;
        a.colour = colour_of(colours, shape);
        if (const Entity* e = entities.Seek(shape.Located(TopLoc_Location()))) {
            a.entity = e->label;
            a.name = e->name;
        }
        return a;
    };
    Interface_CheckIterator checks = s.session->TransferReader()->LastCheckList();
    if (const std::string why = reasons(checks, model); !why.empty())
        out.refused.push_back({RefusalKind::unreadable, "file", text("the reader reports: ", why)});
    return out;
}

void set_unit(const Handle(TDocStd_Document) & document, double millimetres) {
    UnitsMethods::SetCasCadeLengthUnit(millimetres, UnitsMethods_LengthUnit_Millimeter);
    XCAFDoc_DocumentTool::SetLengthUnit(document, millimetres, UnitsMethods_LengthUnit_Millimeter);
}

Handle(TDocStd_Document) new_document() {
    Handle(TDocStd_Document) document;
    XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
    return document;
}

std::unexpected<Refusal> unreadable(const std::string& path, std::string_view format, std::string why) {
    if (why.empty()) why = "it holds nothing that could be read";
    return refuse(RefusalKind::unreadable, path, text("not a readable ", format, " file: ", why));
}

Result<Document> read_step(const std::string& path) {
    STEPCAFControl_Reader reader;
    reader.SetLayerMode(false);
    reader.SetPropsMode(false);
    reader.SetGDTMode(false);
    reader.SetMatMode(false);
    reader.SetViewMode(false);
    const IFSelect_ReturnStatus status = reader.ReadFile(path.c_str());
    const Handle(XSControl_WorkSession) session = reader.Reader().WS();
    const Handle(Interface_InterfaceModel) model = session->Model();
    if (status != IFSelect_RetDone || model.IsNull())
        return unreadable(path, "STEP", model.IsNull() ? "" : reasons(session->ModelCheckList(true), model));
    TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
    reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
    const Unit* unit = lengths.IsEmpty() ? nullptr : unit_named(lengths.First().ToCString());
    const Unit& chosen = unit != nullptr ? *unit : *unit_named("MM");
    const Handle(TDocStd_Document) document = new_document();
    set_unit(document, chosen.millimetres);
    Handle(TDocStd_Document) target = document;
    const bool done = reader.Transfer(target);
    Document out = collect({target, session}, std::string(chosen.ours));
    if (!done || out.parts.empty())
        return unreadable(
            path, "STEP",
            text(model->NbEntities(), " entities, but none that makes a shape",
                 out.refused.empty() ? "" : "; ", out.refused.empty() ? "" : out.refused.front().message));
    return out;
}

// The longest side of the box of all parts, 0 if they are empty.
double size_of(const Document& document) {
    Bnd_Box box;
    for (const Part& part : document.parts) BRepBndLib::AddClose(part.shape.Moved(part.at), box);
    if (box.IsVoid()) return 0;
    const gp_XYZ side = box.CornerMax().XYZ() - box.CornerMin().XYZ();
    return std::max({side.X(), side.Y(), side.Z()});
}

constexpr double kCoarse = 1e-3;  // of the size: resolutions that are larger are none

Result<Document> read_iges(const std::string& path, IgesWay way) {
    constexpr int kPreferred = 0, kInParameters = -2, kInSpace = 3;
    Interface_Static::SetIVal("read.surfacecurve.mode", way.curves == Curves::preferred       ? kPreferred
                                                        : way.curves == Curves::in_parameters ? kInParameters
                                                                                              : kInSpace);
    IGESCAFControl_Reader reader;
    reader.SetLayerMode(false);
    const IFSelect_ReturnStatus status = reader.ReadFile(path.c_str());
    const Handle(IGESData_IGESModel) model = Handle(IGESData_IGESModel)::DownCast(reader.Model());
    if (status != IFSelect_RetDone || model.IsNull())
        return unreadable(path, "IGES",
                          model.IsNull() ? "" : reasons(reader.WS()->ModelCheckList(true), model));
    IGESData_GlobalSection global = model->GlobalSection();
    static constexpr std::string_view kFlags[] = {"",  "IN", "MM",  "",   "FT", "MI",
                                                  "M", "KM", "MIL", "UM", "CM", "UIN"};
    const int flag = global.UnitFlag();
    const std::string named = words(global.UnitName());
    const bool is_named = flag <= 0 || flag >= 12 || flag == 3;
    const LengthUnit unit = unit_of_iges(is_named ? named : std::string(kFlags[flag]));
    const Handle(TDocStd_Document) document = new_document();
    set_unit(document, 1);
    global.SetCascadeUnit(1);
    if (way.lengths == Lengths::as_written) {
        global.SetUnitFlag(2);
        global.SetUnitName(new TCollection_HAsciiString("MM"));
    }
    model->SetGlobalSection(global);
    Handle(TDocStd_Document) target = document;
    const bool done = reader.Transfer(target);
    Document out = collect({target, reader.WS()}, unit.word);
    out.millimetres = unit.millimetres;
    if (way.lengths == Lengths::in_millimetres) out.factor = out.millimetres;
    if (const double r = out.factor * global.Resolution(); r > 0 && r <= kCoarse * size_of(out))
        out.resolution = r;
    if (!done || out.parts.empty())
        return unreadable(path, "IGES", text(model->NbEntities(), " entities, but none that makes a shape"));
    return out;
}

Result<Document> read_brep(const std::string& path) {
    Document out;
    TopoDS_Shape shape;
    if (!BRepTools::Read(shape, path.c_str(), BRep_Builder()) || shape.IsNull())
        return unreadable(path, "BREP", "");
    out.parts.push_back({shape, {}, {}, {}});
    out.attributes = [](const TopoDS_Shape&) { return Attributes{}; };
    return out;
}

}  // namespace

Result<Document> read_document(const std::string& path, Format format, IgesWay way) {
    switch (format) {
        case Format::step:
            return read_step(path);
        case Format::iges:
            return read_iges(path, way);
        case Format::brep:
            return read_brep(path);
    }
    return refuse(RefusalKind::unsupported, path, "unknown format");
}

}  // namespace freiform::occt
