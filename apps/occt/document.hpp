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
    double factor = 1;       // lengths are so many times those of the file
    double millimetres = 1;  // of IGES: the unit of the file
    double resolution = 0;   // what the file (IGES) says that its edges may be off by; 0: nothing
    std::vector<Part> parts;
    std::vector<Refusal> refused;                               // what the reader itself left out
    std::function<Attributes(const TopoDS_Shape&)> attributes;  // of a face or solid of a part
};

// How an IGES file is read.
enum class Lengths { as_written, in_millimetres };  // its numbers as if they were millimetres, or as such
enum class Curves { preferred, in_parameters, in_space };  // of boundaries: as the file says, or one kind
struct IgesWay {
    Lengths lengths = Lengths::as_written;
    Curves curves = Curves::preferred;
};

Result<Document> read_document(const std::string& path, Format format, IgesWay way = {});

}  // namespace freiform::occt
