// The shapes of a document as our model.
#pragma once
#include "document.hpp"

#include <freiform/model/model.hpp>

#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

namespace freiform::occt {

struct Conversion {
    Model model;
    int doubts = 0;                  // places where a wire seems to be read wrongly
    std::vector<TopoDS_Face> faces;  // what model.faces[i] was made from, in its place, oriented forward
    std::vector<TopoDS_Edge> edges;  // what model.edges[i] was made from, in its place
};

Conversion convert(const Document& document);

}  // namespace freiform::occt
