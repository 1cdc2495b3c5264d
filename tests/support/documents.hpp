// A document with everything in it, and reading that must go well, or must not.
#pragma once
#include <freiform/io/document.hpp>

#include <gtest/gtest.h>

namespace freiform::test {

// One object of every type, with every field.
inline constexpr const char* kEverything = R"({"freiform": 1, "unit": "mm", "objects": [
  {"name": "c", "type": "curve", "degree": 2, "knots": [0,0,0,0.5,1,1,1], "points": [[0,0],[1,2],[3,2],[4,0]],
   "weights": [1,0.5,2,1], "closed": false},
  {"type": "curve", "degree": 2, "closed": true, "knots": [0,1,2,4], "points": [[0,0,0],[1,0,0],[0,1,5]]},
  {"type": "curve", "points": [[0.25],[-3]]},
  {"type": "surface", "degrees": [1,2], "knots": [[0,0,1,1],[0,0,0,1,1,1]], "closed": [false,false],
   "points": [[[0,0,0],[0,1,0],[0,2,0]],[[1,0,0],[1,1,1],[1,2,0]]], "weights": [[1,2,1],[1,1,3]]},
  {"type": "volume", "degrees": [1,1,1], "knots": [[0,0,1,1],[0,0,1,1],[0,0,1,1]],
   "points": [[[[0,0,0],[0,0,1]],[[0,1,0],[0,1,1]]],[[[1,0,0],[1,0,1]],[[1,1,0],[1,1,1]]]]},
  {"type": "triangle", "degree": 1, "points": [[0,0,0],[1,0,0],[0,1,0]], "weights": [1,2,3]},
  {"type": "hermite", "points": [[0,0],[1,1],[2,0]], "tangents": [[3,0],[3,3],[0,-3]], "parameters": [0,1,3]},
  {"name": "t", "type": "trimmed", "surface": {"degrees": [1,1], "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]},
   "loops": [[{"degree": 1, "points": [[0,0],[1,0]]}, {"points": [[1,0],[1,1],[0,0]]}],
             [{"type": "ellipse", "centre": [0.7,0.2], "x": [0.1,0], "y": [0,0.1]}]]},
  {"name": "m", "type": "model", "unit": "inch",
   "vertices": [{"point": [1,0,0], "tolerance": 0.5}, {"point": [1,0,2]}, {"point": [0,0,2]}],
   "edges": [{"curve": {"type": "ellipse", "centre": [0,0,0], "x": [1,0,0], "y": [0,1,0]}, "range": [0,6.25],
              "start": 0, "end": 0, "tolerance": 0.125, "name": "e"},
             {"curve": {"type": "line", "origin": [1,0,0], "direction": [0,0,1]}, "range": [0,2], "start": 0, "end": 1},
             {"degenerate": true, "range": [0,1], "start": 2, "end": 2},
             {"curve": {"type": "hyperbola", "centre": [0,0,0], "x": [1,0,0], "y": [0,1,0]}, "range": [0,1], "start": 0, "end": 1},
             {"curve": {"type": "parabola", "centre": [0,0,0], "x": [1,0,0], "y": [0,1,0]}, "range": [0,1], "start": 0, "end": 1},
             {"curve": {"degree": 1, "points": [[0,0,0],[1,2,3]]}, "range": [0,1], "start": 0, "end": 1}],
   "faces": [{"surface": {"type": "extrusion", "profile": {"type": "line", "origin": [0,0,0], "direction": [1,0,0]},
                          "direction": [0,1,0], "kind": "plane"}, "reversed": true, "tolerance": 1, "name": "f",
              "colour": [1,0.5,0,1], "layers": [0,1],
              "loops": [[{"edge": 0, "reversed": true,
                          "curve": {"type": "ellipse", "centre": [0,0], "x": [1,0], "y": [0,1]}}]]},
             {"surface": {"type": "revolution", "profile": {"type": "line", "origin": [1,0,0], "direction": [0,0,1]},
                          "origin": [0,0,0], "axis": [0,0,1], "kind": "cylinder"}},
             {"surface": {"type": "offset", "base": {"degrees": [1,1],
                          "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]}, "distance": -2}}],
   "shells": [{"faces": [{"face": 0}, {"face": 1, "reversed": true}], "closed": true}],
   "bodies": [{"shells": [0], "solid": true, "name": "b", "colour": [0,0,0,0.5], "layers": [1]}],
   "refused": [{"kind": "unsupported", "where": "#12", "message": "why"}],
   "approximations": [{"where": "#13", "what": "a curve", "bound": 1e-9},
                      {"where": "", "what": "another", "estimate": 0.25}],
   "layers": [{"name": "walls", "description": "outside"}, {"name": "2"}],
   "repairs": [{"where": "#14 EDGE_LOOP", "what": "was open", "distance": 0.01}]}
]})";

inline Document must_read(std::string_view text) {
    auto d = read_document(text);
    EXPECT_TRUE(d) << d.error().where << ": " << d.error().message;
    return d ? *d : Document{};
}
inline Refusal must_refuse(std::string_view text) {
    const auto d = read_document(text);
    EXPECT_FALSE(d) << text;
    return d ? Refusal{} : d.error();
}

}  // namespace freiform::test
