// The shapes of one representation as a model of its own.
#pragma once
#include "step_geometry.hpp"
#include "step_loops.hpp"

#include <freiform/io/step_read.hpp>
#include <freiform/model/model.hpp>
#include <freiform/model/pipe.hpp>
#include <freiform/model/swept_solid.hpp>
#include <freiform/query/sphere_of.hpp>

#include <functional>
#include <map>
#include <memory>
#include <unordered_map>
#include <unordered_set>

namespace freiform::step {

// Of one item: so that many things on many layers take no memory beyond a multiple of the file.
inline constexpr std::size_t kMostLayers = 64;

// What a file says about colours and layers of its items.
struct Styles {
    std::unordered_map<std::uint32_t, Colour> colours;        // as surfaces
    std::unordered_map<std::uint32_t, Colour> curve_colours;  // as curves
    std::vector<Layer> layers;
    std::unordered_map<std::uint32_t, std::vector<int>> on_layers;  // ascending

    mutable std::size_t left_out = 0;  // layers of lists that would have become longer than kMostLayers

    // Those of one more item among those that are known already, up to kMostLayers.
    void add_layers(std::vector<int>& to, std::uint32_t item) const;
    // The layers on either list, both ascending, up to kMostLayers.
    std::vector<int> joined_layers(const std::vector<int>& a, const std::vector<int>& b) const;
};

struct Part {
    Model model;                           // lengths in the unit of its context
    std::vector<int> approximated;         // the edge that each approximation is about; -1: none
    std::vector<CurveGeometry<3>> curves;  // that bound no face
    std::size_t bytes = 0;                 // an estimate of the memory that it takes
    std::vector<int> loose;                // faces of no shell
    std::vector<int> released;             // edges that were seams, and bound nothing any more
    std::size_t tessellated = 0;           // items of triangles, which are not read here
};

class ShapeReader {
public:
    // `tolerance`: the uncertainty of lengths that the context states.
    ShapeReader(const File& file, const Styles& styles, double angle, double tolerance,
                const StepReadOptions& options)
        : f_(file), styles_(styles), geometry_(file), tolerance_(tolerance), options_(options) {
        segments_left_ = 4 * file.tokens.size();
        items_left_ = 2 * file.tokens.size();
        geometry_.angle = angle;
        geometry_.tolerance = tolerance;
    }
    // An item of a representation. Items that are no shapes are passed over.
    void add(std::uint32_t item);
    Part finish();

    GeometryReader& geometry() { return geometry_; }

private:
    struct EdgeMade {
        int edge = -1;
        bool flipped = false;  // the edge of the model runs from the second vertex to the first
        bool empty = false;    // no longer than the tolerance: left out of loops
        std::uint32_t curve = kMissing;
    };
    // An edge as a loop runs through it.
    struct Oriented {
        std::uint32_t instance, edge;
        std::vector<EdgeMade> made;
        bool along;
    };
    // What one edge of those is made into.
    struct LoopPiece {
        EdgeMade made;
        bool along;
        std::uint32_t of;
        bool twin = false;  // another edge stands for it
    };
    // A segment of a composite curve, as that runs through it.
    struct Segment {
        std::uint32_t instance, curve;  // itself, and the curve that it is a part of
        CurveGeometry<3> shape;
        Interval on;
        bool backward;
        Vec<3> end(bool last) const;
    };
    struct SurfaceMade {
        SurfaceGeometry surface;
        std::unique_ptr<Chart> chart, seamed;
    };

    // What a solid sweeps, in the plane of its frame, or the solids in that frame; `off`: how far that is
    // from what the file says.
    struct SweptRegion {
        RegionLoops loops;
        Placement frame;
        double off = 0;
    };
    struct SweptModel {
        Model model;
        Motion to;
        double off = 0;
    };

    void solid(std::uint32_t item);
    void sheet(std::uint32_t item, std::uint32_t shell, bool solid);
    void set_items(std::uint32_t item);
    void free_curve(std::uint32_t item);
    Result<int> shell(std::uint32_t i, bool closed);
    Result<void> shell_faces(std::uint32_t i, bool forward, Shell& out, int depth);
    // `made_of`: its shells in the file.
    void body_of(std::uint32_t item, std::vector<int> shells, bool solid,
                 const std::vector<std::uint32_t>& made_of);
    int face(std::uint32_t i);
    Result<Face> make_face(std::uint32_t i, std::uint32_t whole, Type type);
    Result<Face> bare_face(std::uint32_t i);
    Result<void> add_boundary_curve(std::uint32_t i, const Chart& chart, LoopBuilder& loops);
    void join_vertices(int a, int b) {
        if (a != b) same_.emplace_back(a, b);
    }
    void merge_vertices();
    Result<EdgeMade> segment_edge(std::uint32_t curve, std::vector<int>& corners);
    Result<void> add_bound(std::uint32_t i, bool forward, const Chart& chart, double size, int loosely,
                           LoopBuilder& loops);
    Result<Face> close_face(Face face, LoopBuilder& loops, const Chart& chart, std::uint32_t i, double size,
                            bool* tangled = nullptr);
    Result<SurfaceMade*> surface(std::uint32_t i);
    // In the direction of the edge; several on a composite curve.
    Result<std::span<const EdgeMade>> edge(std::uint32_t i);
    Result<EdgeMade> make_edge(std::uint32_t i);
    bool is_tiny(const CurveGeometry<3>& c, Interval on) const;
    void tell_ends(std::uint32_t edge, const std::array<int, 2>& vertices, double off);
    // step_composite.cpp
    Result<std::vector<Segment>> segments_of(std::uint32_t composite);
    static double row_size(const std::vector<Segment>& row);
    static std::vector<std::uint32_t> turn_segments(std::vector<Segment>& row, double joint);
    static std::size_t cut_at(std::vector<Segment>& row, const Vec<3>& p, double joint, double& off);
    std::vector<EdgeMade> row_edges(std::vector<Segment> row, std::array<int, 2> ends,
                                    const std::string& name);
    Result<void> close_gaps(std::vector<Segment>& row, double joint, double limit);
    Result<std::vector<EdgeMade>> composite_edge(const Fields& f, std::uint32_t i, bool forward,
                                                 std::uint32_t composite, const std::array<int, 2>& vertices);
    Result<void> free_composite(std::uint32_t composite);
    Result<EdgeMade> straight_edge(int from, int to);
    // step_polygons.cpp
    Result<std::vector<std::uint32_t>> corners_of(std::uint32_t polygon) const;
    Result<std::vector<EdgeMade>> polygon_edges(std::uint32_t polygon, bool forward);
    std::vector<std::vector<Vec<3>>> polygons_of(std::uint32_t face) const;
    static double off_plane(const std::vector<std::vector<Vec<3>>>& polygons, const Vec<3>& origin,
                            const Vec<3>& normal);
    void note_missed_plane(std::uint32_t face);
    std::optional<SurfaceGeometry> own_plane(std::uint32_t face, std::uint32_t surface);
    // step_twins.cpp
    bool are_twins(const EdgeMade& a, const EdgeMade& b) const;
    int twin_of(int edge) const;
    void fold_twins(std::vector<LoopPiece>& loop);
    void merge_twins();
    // step_pcurve.cpp: `ends` are those of the edge, if they are known.
    Result<BoundedCurve> curve_in_space(std::uint32_t i, const std::array<Vec<3>, 2>* ends);
    Result<BoundedCurve> lifted_curve(std::uint32_t pcurve, const std::array<Vec<3>, 2>* ends);
    Result<BoundedCurve> lift_one(const Chart& chart, const CurveGeometry<2>& flat, const BoundedCurve& given,
                                  const std::array<Vec<3>, 2>* ends, std::uint32_t pcurve);
    Result<int> vertex(std::uint32_t i);
    int vertex_at(std::uint32_t point, const Vec<3>& p);
    bool is_beside(double gap, double size) const;
    // `loosely`: 1, an edge beside the surface is followed no closer than it lies beside it; more, by
    // polygons within more and more times the tolerance.
    Result<Use> use_of(const EdgeMade& made, bool forward, const Chart& chart, double size, int loosely = 0);
    Result<Use> use_of(const EdgeMade& made, std::span<const CurveGeometry<3>> images, bool forward,
                       const Chart& chart, double size, int loosely) const;
    std::vector<CurveGeometry<3>> images_of(const EdgeMade& made, const Chart& chart);
    // step_swept.cpp: whether the item is such a solid.
    bool add_swept(std::uint32_t item);
    Result<SweptRegion> swept_region(std::uint32_t i);
    Result<SweptModel> swept_by(const Fields& f, bool turns);
    Result<BoundedCurve> directrix(const Fields& f, std::uint32_t item, std::uint32_t curve);
    Result<std::vector<RailPart>> rail_of(const Fields& f, std::uint32_t item);
    Result<SweptModel> swept_disc(const Fields& f, std::uint32_t item);
    Result<SweptModel> primitive(const Fields& f, Type type);
    void take(std::uint32_t item, SweptModel made);
    // step_repair.cpp: what contradicts itself beyond the tolerance, refused or made right.
    void turn_edges(std::vector<Oriented>& loop);
    // Of the size of a face: gaps between its edges that the last digits of a file leave. They are told.
    static constexpr double kDigits = 1e-4;
    Result<void> close_loop(std::uint32_t loop, std::vector<Use>& uses, const Chart& chart, double size,
                            int loosely);
    bool is_far(double gap, double size) const;
    std::unexpected<Refusal> far_beside(std::string edge, double gap, double size) const;
    Result<void> accept_gap(std::uint32_t edge, const Use& use, const Chart& chart, double size);
    void tell_turn(std::uint32_t face, const LoopBuilder& loops);
    void settle_turned(const Shell& shell);
    double repair_limit(double size) const;
    void repaired(std::uint32_t i, std::string what, double distance) {
        out_.model.repairs.push_back({f_.label(i), std::move(what), distance});
    }
    Result<double> size_of(const Fields& f, std::vector<Vec<3>>& seen, std::vector<int>& used);
    const Chart& chart_of(SurfaceMade& made, std::uint32_t surface, const std::vector<int>& used);
    void tell_seam(std::uint32_t face, const Chart& chart, const std::vector<int>& used);
    double accuracy_for(double size) const;
    struct OtherSphere {
        SurfaceGeometry surface;
        bool inwards = false;  // the normal of the first one looks, and not that of this
        double off = 0;        // how far the first one may be from it
    };
    std::optional<OtherSphere> other_poles(const Chart& chart, const std::vector<int>& used) const;
    std::optional<SurfaceGeometry> other_half(const Chart& chart, const std::vector<int>& used) const;
    void refuse_item(std::uint32_t item, Refusal why);
    void tell_approximated();
    void report(int edge, std::string what, std::optional<double> bound, double estimate);
    std::optional<Colour> colour_of(std::uint32_t i) const;
    void style_edge(Edge& e, std::uint32_t item) const;
    Result<std::uint32_t> whole_of(std::uint32_t i, Type part, int parent) const;

    const File& f_;
    const Styles& styles_;
    GeometryReader geometry_;
    double tolerance_;
    const StepReadOptions& options_;
    Part out_;
    // Faces whose loops were turned, with what was said of it, until those beside them have been asked.
    std::unordered_map<int, std::size_t> turned_;
    std::optional<std::size_t> turned_now_;  // of the face that is being made
    // Likewise, if its surface is one: edges not followed closely are refused, as other poles may do.
    std::optional<FoundSphere> strict_;
    std::map<int, int> twins_, twins_now_;   // edges that others stand for; of the face that is being made
    std::vector<std::pair<int, int>> same_;  // vertices that loops say are one
    std::unordered_map<std::uint32_t, int> vertices_, points_, faces_;
    std::unordered_map<int, std::uint32_t> vertex_of_;  // what the file calls a vertex
    std::unordered_map<std::uint32_t, Result<EdgeMade>> edges_;
    std::unordered_map<std::uint32_t, std::vector<EdgeMade>> rows_;  // of edges on composite curves
    std::size_t segments_left_;  // of composite curves, with their control points
    std::size_t items_left_;     // of sets, each time that one is named
    std::map<std::pair<std::uint32_t, bool>, Result<BoundedCurve>> lifts_;  // of PCURVEs, by unit of angles
    std::unordered_map<std::uint64_t, EdgeMade> straight_;
    std::unordered_set<std::uint32_t> missed_planes_, noted_faces_;
    std::unordered_map<std::uint32_t, std::unique_ptr<SurfaceMade>> surfaces_;
    std::unordered_map<const Chart*, std::uint32_t> charts_;
};

// The sphere that the surface of a chart is, or stands for: a circle that turns about a line through its
// centre is one, and so is a rational spline with poles that lies on one. Nothing for others.
std::optional<FoundSphere> sphere_of(const Chart& chart, double tolerance);

// Of what has its name first; some programs write NONE for none.
std::string name_in(const Fields& f);

// Whether an item of a representation is of triangles, or of what stands beside them.
bool is_tessellated(const File& file, std::uint32_t item);

// A spline that closes, gone on with as far as that parameter; nothing of other curves. `close`: ends nearer
// than this are one.
std::optional<CurveGeometry<3>> continued(const CurveGeometry<3>& curve, double to, double close);

// The surface with a spline that closes continued by whole turns, so that `on` is inside its domain.
// `slack`: of a turn, by which `on` may leave the domain.
SurfaceGeometry unwound(const SurfaceGeometry& surface, const Chart& chart, const Box<2>& on,
                        double slack = 1e-6);

}  // namespace freiform::step
