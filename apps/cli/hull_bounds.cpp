#include "hull_bounds.hpp"

#include "nearest_objects.hpp"

#include <freiform/io/bpt.hpp>
#include <freiform/io/mesh_file.hpp>
#include <freiform/model/bounds.hpp>
#include <freiform/query/oriented_box.hpp>

namespace freiform::cli {

namespace {

constexpr double kAccuracyOfSize = 1e-7;
constexpr std::string_view kAccepted =
    "--oriented and --hull are for curves, surfaces, volumes and triangles in the plane or in space, trimmed "
    "surfaces and models";

template <std::size_t N>
void write_numbers(json::Writer& w, std::string_view key, const std::vector<std::array<double, N>>& rows) {
    w.key(key).begin_array();
    for (const auto& row : rows) w.array(row);
    w.end_array();
}

class Hulls {
public:
    Hulls(const Input& input, const HullsAsked& asked) : input_(input), asked_(asked) {
        w_.begin_object().field("file", shown(input.file)).field("unit", input.document->unit);
        w_.key("objects").begin_array();
    }

    Result<void> add(std::size_t i) {
        const Shape& shape = input_.object(i).shape;
        w_.new_line(1).begin_object().field("index", i).field("name", input_.object(i).name);
        w_.field("type", type_name(shape));
        plain_ += text(object_label(*input_.document, i), ":\n");
        const auto* own = std::get_if<Model>(&shape);
        const auto* trimmed = std::get_if<TrimmedSurface>(&shape);
        const auto done = own ? add_model(*own, i) : trimmed ? add_trimmed(*trimmed, i) : add_patch(i);
        w_.end_object();
        return done;
    }
    std::string json() {
        w_.end_array().end_object();
        return w_.take() + "\n";
    }
    std::string plain() { return std::move(plain_); }
    const TriangleMesh& mesh() const { return mesh_; }

private:
    std::unexpected<Refusal> not_taken() const {
        return refuse(RefusalKind::no_answer, "", std::string(kAccepted));
    }

    Result<void> add_trimmed(const TrimmedSurface& t, std::size_t i) {
        const auto model = model_of_trimmed(t);
        if (!model) return std::unexpected(model.error());
        return add_model(*model, i);
    }
    Result<void> add_model(const Model& model, std::size_t i) {
        if (asked_.oriented) {
            const double size = summary(model).box.diagonal();
            const auto box = oriented_box(model, asked_.accuracy.value_or(kAccuracyOfSize * size));
            if (!box) return std::unexpected(box.error());
            write_box(*box);
        }
        if (asked_.hull) {
            const auto hull = convex_hull(model, *asked_.hull);
            if (!hull) return std::unexpected(hull.error());
            write_hull(*hull, i);
        }
        return {};
    }
    Result<void> add_patch(std::size_t i) {
        ObjectSet one;
        if (auto done = add_object(input_, i, "", one); !done) return done;
        if (one.coordinates != 2 && one.coordinates != 3) return not_taken();
        const auto query = NearestQuery::make(one.objects);
        if (!query) return std::unexpected(query.error());
        return one.coordinates == 2 ? add_query<2>(*query, i) : add_query<3>(*query, i);
    }
    template <int D>
    Result<void> add_query(const NearestQuery& query, std::size_t i) {
        if (asked_.oriented) {
            const double size = control_box(input_.object(i).shape).diagonal;
            const auto box = oriented_box<D>(query, asked_.accuracy.value_or(kAccuracyOfSize * size));
            if (!box) return std::unexpected(box.error());
            write_box(*box);
        }
        if (!asked_.hull) return {};
        const auto hull = convex_hull<D>(query, *asked_.hull);
        if (!hull) return std::unexpected(hull.error());
        write_hull(*hull, i);
        return {};
    }
    template <int D>
    void write_hull(const ConvexHull<D>& hull, std::size_t i) {
        w_.key("hull").begin_object();
        std::vector<std::array<double, D>> points;
        for (const Vec<D>& p : hull.points) points.push_back(p.c);
        write_numbers(w_, "points", points);
        w_.key("facets").begin_array();
        for (const auto& f : hull.facets) w_.array(f);
        w_.end_array().field("bound", hull.slack).end_object();
        plain_ += text("  hull: ", hull.points.size(), " points, ", hull.facets.size(),
                       D == 2 ? " sides" : " triangles", ", at most ", hull.slack, " too large\n");
        if constexpr (D == 3) add_mesh(hull, input_.object(i).name);
    }
    void add_mesh(const ConvexHull<3>& hull, const std::string& name) {
        const int first = int(mesh_.points.size());
        MeshPart part;
        part.name = name;
        part.first = int(mesh_.triangles.size());
        for (const Vec<3>& p : hull.points) {
            mesh_.vertices.push_back({int(mesh_.points.size())});
            mesh_.points.push_back(p);
        }
        for (const auto& [a, b, c] : hull.facets)
            mesh_.triangles.push_back({first + a, first + b, first + c});
        part.count = int(hull.facets.size());
        mesh_.parts.push_back(part);
        mesh_.unit = input_.document->unit;
    }
    template <int D>
    void write_box(const OrientedBox<D>& box) {
        std::vector<std::array<double, D>> axes;
        std::vector<std::array<double, 2>> range;
        for (const Vec<D>& a : box.axes) axes.push_back(a.c);
        for (const Interval& r : box.range) range.push_back({r.lo, r.hi});
        w_.key("oriented_box").begin_object();
        write_numbers(w_, "axes", axes);
        write_numbers(w_, "range", range);
        w_.key("middle").array(box.middle().c).key("half").array(box.half().c).field("volume", box.volume());
        w_.field("bound", box.slack).end_object();
        std::string sides;
        for (const Interval& r : box.range) sides += text(sides.empty() ? "" : " x ", r.length());
        plain_ += text("  oriented box: ", sides, ", each side within ", box.slack, ", about ",
                       listed_numbers(box.middle().c), "\n");
        for (const Vec<D>& a : box.axes) plain_ += text("    axis ", listed_numbers(a.c), "\n");
    }

    const Input& input_;
    HullsAsked asked_;
    json::Writer w_;
    std::string plain_;
    TriangleMesh mesh_;
};

}  // namespace

Result<void> answer_hulls(Context& context, const Input& input, const HullsAsked& asked) {
    Hulls hulls(input, asked);
    for (const std::size_t i : input.chosen)
        if (auto done = hulls.add(i); !done) return refuse_within(input.label(i), done.error());
    const std::string& target = context.to.empty() ? context.output : context.to;
    if (const auto format = mesh_format(target); asked.hull && format && !context.output.empty()) {
        if (hulls.mesh().triangles.empty())
            return refuse(RefusalKind::no_answer, shown(input.file),
                          "has no hull in space: no mesh is written");
        if (auto done = write_mesh(hulls.mesh(), context.output, *format); !done) return done;
        if (context.output == "-") return {};
        context.output.clear();  // the report goes to standard output
    }
    return emit(context, context.json ? hulls.json() : hulls.plain());
}

}  // namespace freiform::cli
