// bench-tessellate-occt FILE|hills|hills-with-holes --relative R [--diagonal D] [--repetitions N]
// [--times-only] [--sew]
//
// The same as bench-tessellate with the mesher of Open CASCADE: deflection R times the diagonal, 0.5 radians,
// one thread, faces as the file has them (joined before with --sew). Also prints the diagonal, in
// millimetres.
#include "hills_face.hpp"
#include "occt_curve.hpp"
#include "report_fields.hpp"

#include <freiform/core/text.hpp>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom2dConvert.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Circle.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <IGESControl_Reader.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <Standard_Version.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <iostream>

namespace {

using namespace freiform;
using namespace freiform::bench;

TopoDS_Shape made(const HillsFace& face) {
    const Handle(Geom_Surface) surface = surface_of(face.surface);
    BRepBuilderAPI_MakeFace maker(surface, 0, 1, 0, 1, 1e-7);
    for (const HillsFace::Hole& hole : face.holes) {
        const Handle(Geom2d_Curve) circle =
            new Geom2d_Circle(gp_Ax2d(gp_Pnt2d(hole.u, hole.v), gp_Dir2d(1, 0)), hole.radius, false);
        const Handle(Geom2d_Curve) spline = Geom2dConvert::CurveToBSplineCurve(circle);
        maker.Add(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(spline, surface).Edge()).Wire());
    }
    TopoDS_Shape shape = maker.Face();
    BRepLib::BuildCurves3d(shape);
    BRepLib::SameParameter(shape, 1e-6);
    return shape;
}

TopoDS_Shape read(const std::string& file) {
    if (const auto face = hills_face(file)) return made(*face);
    TopoDS_Shape shape;
    const std::string ending = file.substr(file.rfind('.') + 1);
    const auto transfer = [&](auto reader) {
        if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) return;
        reader.TransferRoots();
        shape = reader.OneShape();
    };
    if (ending == "iges" || ending == "igs")
        transfer(IGESControl_Reader());
    else if (ending == "step" || ending == "stp")
        transfer(STEPControl_Reader());
    else
        BRepTools::Read(shape, file.c_str(), BRep_Builder());
    return shape;
}

Point point(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

std::vector<FaceTriangles> look(const TopTools_IndexedMapOfShape& faces, int& without) {
    std::vector<FaceTriangles> out;
    for (int i = 1; i <= faces.Extent(); ++i) {
        const TopoDS_Face& face = TopoDS::Face(faces(i));
        TopLoc_Location place;
        const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, place);
        FaceTriangles f;
        if (mesh.IsNull()) {
            ++without;
            out.push_back(std::move(f));
            continue;
        }
        for (int n = 1; n <= mesh->NbNodes(); ++n) {
            f.points.push_back(point(mesh->Node(n).Transformed(place.Transformation())));
            if (mesh->HasUVNodes()) f.uv.push_back({mesh->UVNode(n).X(), mesh->UVNode(n).Y()});
        }
        for (int t = 1; t <= mesh->NbTriangles(); ++t) {
            std::array<int, 3> c{};
            mesh->Triangle(t).Get(c[0], c[1], c[2]);
            f.triangles.push_back({c[0] - 1, c[1] - 1, c[2] - 1});
        }
        f.surface = [s = GeomAdaptor_Surface(BRep_Tool::Surface(face))](double u, double v) {
            return point(s.Value(u, v));
        };
        out.push_back(std::move(f));
    }
    return out;
}

int run(const Arguments& a) {
    // What the readers say about files goes nowhere: standard output is for the result.
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
    TopoDS_Shape shape = read(a.file);
    if (shape.IsNull()) {
        std::cout << "{\"refusal\": \"the file has no shape\"}" << std::endl;
        return 3;
    }
    if (a.sew) {  // as the other program does, within the largest tolerance of the file
        TopTools_IndexedMapOfShape edges;
        TopExp::MapShapes(shape, TopAbs_EDGE, edges);
        double most = 0;
        for (int i = 1; i <= edges.Extent(); ++i)
            most = std::max(most, BRep_Tool::Tolerance(TopoDS::Edge(edges(i))));
        BRepBuilderAPI_Sewing sewing(most);
        sewing.Add(shape);
        sewing.Perform();
        shape = sewing.SewedShape();
    }
    BRepTools::Clean(shape);
    Bnd_Box box;
    BRepBndLib::AddOptimal(shape, box, false, false);
    const double diagonal = a.diagonal > 0 ? a.diagonal : std::sqrt(box.SquareExtent()),
                 tolerance = a.relative * diagonal;

    // Throwing the old triangles away is no part of the work, so the clock runs for the mesher alone.
    std::vector<Seconds> times;
    const auto mesh = [&](bool threads) {
        times.clear();
        const double start = now().wall;
        while (int(times.size()) < a.repetitions && (times.size() < 2 || now().wall - start < 3)) {
            BRepTools::Clean(shape);
            for (const Seconds& s :
                 repeat(1, 0, [&] { BRepMesh_IncrementalMesh(shape, tolerance, false, 0.5, threads); }))
                times.push_back(s);
        }
        return times;
    };
    const std::vector<Seconds> one = mesh(false), two = mesh(true);

    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    json::Writer w;
    w.begin_object()
        .field("version", OCC_VERSION_COMPLETE)
        .field("tolerance", tolerance)
        .field("diagonal", diagonal);
    w.field("faces", faces.Extent());
    write_times(w, "one_thread", one);
    write_times(w, "two_threads", two);
    if (!a.times_only) {
        int without = 0;
        write_measured(w, look(faces, without), tolerance, diagonal);
        w.field("faces_without_mesh", without);
    }
    w.end_object();
    std::cout << w.text() << std::endl;
    return 0;
}

}  // namespace

int main(int count, char** values) {
    const std::optional<Arguments> a = parse(count, values);
    if (!a) {
        std::cerr << "usage: bench-tessellate-occt FILE|hills|hills-with-holes --relative R [--diagonal D] "
                     "[--repetitions N] "
                     "[--times-only] [--sew]\n";
        return 2;
    }
    try {
        return run(*a);
    } catch (const Standard_Failure& e) {
        json::Writer w;
        w.begin_object().field("refusal", e.GetMessageString()).end_object();
        std::cout << w.text() << std::endl;
        return 3;
    }
}
