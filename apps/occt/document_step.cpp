// STEP files, as Open CASCADE reads them: its libraries for them take longer to load than most files to read,
// so they are in a program of their own (main.cpp).
#include "reader.hpp"

#include <Interface_Check.hxx>
#include <Quantity_ColorRGBA.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
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

std::string label_of(const Handle(Interface_InterfaceModel) & model,
                     const Handle(Standard_Transient) & entity) {
    const auto step = Handle(StepData_StepModel)::DownCast(model);
    const int number = step.IsNull() ? 0 : step->IdentLabel(entity);
    if (number > 0) return text("#", number, " ", type_of(entity));
    return text(words(model->StringLabel(entity)), " ", type_of(entity));
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
        Entity e{label_of(model, entity), {}, {}};
        if (auto item = Handle(StepRepr_RepresentationItem)::DownCast(entity); !item.IsNull())
            e.name = words(item->Name());
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
    if (const std::string why = reasons(checks, model, label_of); !why.empty())
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

}  // namespace

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
        return unreadable(path, "STEP",
                          model.IsNull() ? "" : reasons(session->ModelCheckList(true), model, label_of));
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

}  // namespace freiform::occt
