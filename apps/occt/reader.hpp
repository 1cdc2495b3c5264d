// What reading STEP and reading IGES have in common.
#pragma once
#include "document.hpp"

#include <Interface_CheckIterator.hxx>
#include <Interface_InterfaceModel.hxx>
#include <NCollection_DataMap.hxx>
#include <TCollection_HAsciiString.hxx>

namespace freiform::occt {

// The names of units in files, ours, and their size in millimetres.
struct Unit {
    std::string_view word, ours;
    double millimetres;
};
const Unit* unit_named(std::string_view name);

// What an entity of the file says of the face or solid that was made of it.
struct Entity {
    std::string label, name;
    std::optional<Colour> colour;
};
using EntityMap = NCollection_DataMap<TopoDS_Shape, Entity, TopTools_ShapeMapHasher>;

std::string words(const Handle(TCollection_HAsciiString) & s);
std::string type_of(const Handle(Standard_Transient) & entity);  // without the prefix of its schema

// Of an entity, as messages name it.
using LabelOf = std::string(const Handle(Interface_InterfaceModel) &, const Handle(Standard_Transient) &);
// What the reader says about the file, shortened.
std::string reasons(const Interface_CheckIterator& checks, const Handle(Interface_InterfaceModel) & model,
                    LabelOf& label);
std::unexpected<Refusal> unreadable(const std::string& path, std::string_view format, std::string why);

Result<Document> read_step(const std::string& path);  // document_step.cpp

}  // namespace freiform::occt
