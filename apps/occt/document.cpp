// Idea. STEP and IGES are read twice removed from what they say: the reader scales all lengths to a unit that
// the program chooses. So the unit of a STEP file is looked up first and chosen, and the factor is 1. Where
// another unit than millimetres is chosen the reader takes parameter curves of IGES files wrongly (it looks
// for seams where they are not, and puts edges far from faces), and where numbers are small it loses edges,
// as its tolerances are not relative. So IGES files are read as if their numbers were millimetres, which
// leaves these as they are, or as the millimetres that they are: whoever asks divides by the factor.
#include "reader.hpp"

#include <freiform/io/mesh_file.hpp>

#include <BRepBndLib.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESGraph_Color.hxx>
#include <Interface_Static.hxx>
#include <TopAbs.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <UnitsMethods.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>

namespace freiform::occt {

namespace {

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

std::string label_of(const Handle(Interface_InterfaceModel) & model,
                     const Handle(Standard_Transient) & entity) {
    return text(words(model->StringLabel(entity)), " ", type_of(entity));
}

// One of the eight that the standard numbers, or what another entity says in percent.
std::optional<Colour> colour_of(const Handle(IGESData_IGESEntity) & entity) {
    if (entity->DefColor() == IGESData_DefValue) {
        static constexpr Colour kNumbered[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                               {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
        return kNumbered[std::clamp(entity->RankColor(), 1, 8) - 1];
    }
    if (entity->DefColor() != IGESData_DefReference) return std::nullopt;
    const auto given = Handle(IGESGraph_Color)::DownCast(entity->Color());
    if (given.IsNull()) return std::nullopt;
    Colour out;
    given->RGBIntensity(out.r, out.g, out.b);
    for (double* x : {&out.r, &out.g, &out.b}) *x = std::clamp(*x / 100, 0.0, 1.0);
    return out;
}

// The parts and their attributes, out of what a reader has made.
Document collect(IGESControl_Reader& reader, std::string unit) {
    Document out;
    out.unit = std::move(unit);
    const Handle(Interface_InterfaceModel) model = reader.Model();
    const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
    EntityMap entities;
    for (int i = 1; i <= model->NbEntities(); ++i) {
        const auto entity = Handle(IGESData_IGESEntity)::DownCast(model->Value(i));
        const TopoDS_Shape shape =
            entity.IsNull() ? TopoDS_Shape() : TransferBRep::ShapeResult(process, entity);
        if (shape.IsNull() || shape.ShapeType() > TopAbs_FACE) continue;  // edges have neither
        Entity e{label_of(model, entity), entity->HasName() ? words(entity->NameValue()) : std::string(),
                 colour_of(entity)};
        entities.Bind(shape.Located(TopLoc_Location()), std::move(e));
    }
    for (int i = 1; i <= reader.NbShapes(); ++i) {
        Part part{reader.Shape(i), {}, {}, {}};
        if (const Entity* e = entities.Seek(part.shape.Located(TopLoc_Location())))
            part.name = e->name, part.colour = e->colour;
        if (part.name.empty()) part.name = TopAbs::ShapeTypeToString(part.shape.ShapeType());
        out.parts.push_back(std::move(part));
    }
    out.attributes = [entities](const TopoDS_Shape& shape) {
        const Entity* e = entities.Seek(shape.Located(TopLoc_Location()));
        return e ? Attributes{e->name, e->label, e->colour} : Attributes{};
    };
    Interface_CheckIterator checks = reader.WS()->TransferReader()->LastCheckList();
    if (const std::string why = reasons(checks, model, label_of); !why.empty())
        out.refused.push_back({RefusalKind::unreadable, "file", text("the reader reports: ", why)});
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
    IGESControl_Reader reader;
    const IFSelect_ReturnStatus status = reader.ReadFile(path.c_str());
    const Handle(IGESData_IGESModel) model = Handle(IGESData_IGESModel)::DownCast(reader.Model());
    if (status != IFSelect_RetDone || model.IsNull())
        return unreadable(path, "IGES",
                          model.IsNull() ? "" : reasons(reader.WS()->ModelCheckList(true), model, label_of));
    IGESData_GlobalSection global = model->GlobalSection();
    static constexpr std::string_view kFlags[] = {"",  "IN", "MM",  "",   "FT", "MI",
                                                  "M", "KM", "MIL", "UM", "CM", "UIN"};
    const int flag = global.UnitFlag();
    const std::string named = words(global.UnitName());
    const bool is_named = flag <= 0 || flag >= 12 || flag == 3;
    const LengthUnit unit = unit_of_iges(is_named ? named : std::string(kFlags[flag]));
    UnitsMethods::SetCasCadeLengthUnit(1, UnitsMethods_LengthUnit_Millimeter);
    global.SetCascadeUnit(1);
    if (way.lengths == Lengths::as_written) {
        global.SetUnitFlag(2);
        global.SetUnitName(new TCollection_HAsciiString("MM"));
    }
    model->SetGlobalSection(global);
    reader.TransferRoots();
    Document out = collect(reader, unit.word);
    out.millimetres = unit.millimetres;
    if (way.lengths == Lengths::in_millimetres) out.factor = out.millimetres;
    if (const double r = out.factor * global.Resolution(); r > 0 && r <= kCoarse * size_of(out))
        out.resolution = r;
    if (out.parts.empty())
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
#ifdef FREIFORM_OCCT_STEP
            return read_step(path);
#else
            break;
#endif
        case Format::iges:
            return read_iges(path, way);
        case Format::brep:
            return read_brep(path);
    }
    return refuse(RefusalKind::unsupported, path, "unknown format");
}

}  // namespace freiform::occt
