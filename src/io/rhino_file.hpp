// The objects of a 3DM file with what it says of each.
#pragma once
#include "rhino_geometry.hpp"

#include <freiform/core/colour.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace freiform::rhino {

struct FileObject {
    StoredObject object;         // of version 2 on
    std::optional<BrepOf> brep;  // of version 1: what has been read already
    std::optional<CurveInSpace> curve;
    std::optional<Refusal> why;  // or why it has not
    std::string name, uuid;
    int layer = -1;
    std::optional<Colour> colour;
    bool is_part_of_block = false;
};

struct BlockOf {
    std::string name;
    std::vector<std::string> members;  // by their uuid
};

struct File3dm {
    std::string unit;
    double tolerance = 0;             // 0: not said
    std::vector<std::string> layers;  // no name twice
    std::vector<FileObject> objects;
    std::map<std::string, BlockOf> blocks;  // by their uuid
};

Result<File3dm> parse_3dm(std::string_view bytes);
// What stands after the header of a file of version 1.
Result<File3dm> parse_version1(Bytes b);

// The name of a unit by its number, empty for none.
std::string unit_named(int number);

}  // namespace freiform::rhino
