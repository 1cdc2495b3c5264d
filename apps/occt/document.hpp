// A file as Open CASCADE sees it: parts in their places, with names and colours, in the unit of the file.
#pragma once
#include <freiform/core/colour.hpp>
#include <freiform/core/result.hpp>

#include <TopLoc_Location.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shape.hxx>
#include <functional>
#include <optional>
#include <vector>

namespace freiform::occt {

enum class Format { step, iges, brep };

struct Attributes {
    std::string name;
    std::string entity;  // "#123 ADVANCED_FACE"; empty if the format has no such numbers
    std::optional<Colour> colour;
};

// One instance of a part of an assembly.
struct Part {
    TopoDS_Shape shape;  // as in the part itself
    TopLoc_Location at;
    std::string name;
    std::optional<Colour> colour;
};

struct Document {
    std::string unit;
    std::vector<Part> parts;
    std::vector<Refusal> refused;                               // what the reader itself left out
    std::function<Attributes(const TopoDS_Shape&)> attributes;  // of a face or solid of a part
};

Result<Document> read_document(const std::string& path, Format format);

}  // namespace freiform::occt
