// How a model comes about, shape by shape. What the parts of the file share has a place here: a map from
// shapes to indices, what the file states of tolerances, and what will have to be reported.
#pragma once
#include "bridges.hpp"
#include "convert.hpp"

#include <freiform/model/edge_gap.hpp>

#include <Geom_Plane.hxx>
#include <NCollection_DataMap.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>

namespace freiform::occt {

// A coedge under construction: `from` and `to` are vertices in the order of the loop.
struct Piece {
    Coedge coedge;
    int from = -1, to = -1;
    Vec<2> start{}, end{};
};

// A parameter curve whose distance from its edge has to be proven.
struct Suspect {
    Coedge* coedge = nullptr;
    double sampled = 0;  // the largest gap among samples
    bool replaced = false, stretched = false;
    bool is_first = true;  // of its edge
    EdgeGap gap = {};
    bool is_changed() const { return replaced || stretched; }
};

class Converter {
public:
    explicit Converter(const Document& document) : document_(document) {
        out_.model.unit = document.unit;
        out_.model.refused = document.refused;
    }
    void add(const Part& part);
    Conversion finish();

private:
    Result<int> face(const TopoDS_Face& original, const TopLoc_Location& at, const Part& part);
    // `may_be_all`: a slit on a surface that is closed all around means all of it.
    Result<Face> geometry_of(const TopoDS_Face& f, std::string_view where, bool may_be_all = true);
    std::optional<Face> all_of(const TopoDS_Face& f, std::string_view where);
    // retrace.cpp
    bool is_open(const Face& f) const;
    double size_of(const Face& f) const;  // the extent of its edges, from points on them
    Result<Face> retraced(const TopoDS_Face& f);
    Result<Loop> loop_of(std::vector<Piece> pieces, std::vector<Loop>& more);
    Result<Piece> piece(const TopoDS_Edge& e, const TopoDS_Face& f, const Handle(Geom_Plane) & plane);
    Vec<2> end_of(const Coedge& c, bool last) const;  // in the parameters, as the loop runs
    Coedge pole_between(const Coedge& before, const Coedge& after);
    void add_poles(Loop& loop, const Handle(Geom_Surface) & s, double close);
    void open_slit(Loop& loop, const Slit& slit);
    bool is_second_pole(const Piece& p, const std::vector<Piece>& pieces) const;
    Result<int> edge(const TopoDS_Edge& e, const TopoDS_Face& f);
    int vertex(const TopoDS_Vertex& v);
    // Where a degenerate edge is.
    const Vec<3>& vertex_of(const Edge& e) const { return out_.model.vertices[std::size_t(e.start)].point; }
    // A length in the unit of the file, for people.
    double in_file(double length) const { return length / document_.factor; }
    // `bound` may be infinite: then nothing is proven, and the estimate is all there is.
    void report(int edge, std::string what, double bound, double estimate);
    Result<void> check_tolerance(Face& f, std::string_view where);
    bool improve(const Face& f, Coedge& c, double size, double& worst) const;
    EdgeGap gap_of(const DerivativeQuery<2, 3>& surface, const Suspect& suspect, double target) const;
    void tell(const Suspect& suspect, const EdgeGap& gap, std::string_view where);
    int shell(const TopoDS_Shape& s, bool closed, const TopLoc_Location& at, const Part& part);
    void body(const TopoDS_Shape& s, bool solid, const Part& part, const TopLoc_Location& at);

    const Document& document_;
    Conversion out_;
    using IndexMap = NCollection_DataMap<TopoDS_Shape, int, TopTools_ShapeMapHasher>;
    IndexMap vertices_, edges_, faces_;
    std::vector<double> stated_;                   // the tolerance of each edge in the file
    std::vector<int> approximated_;                // the edge that each approximation is about
    std::vector<std::pair<int, bool>> stretched_;  // coedges (edge, reversed) of the face in work
    int free_edges_ = 0;
};

}  // namespace freiform::occt
