#include "io/mesh_bytes.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/mesh_file.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace freiform {
namespace {

constexpr std::array<std::pair<std::string_view, MeshFormat>, 4> kFormats{
    {{"glb", MeshFormat::glb}, {"stl", MeshFormat::stl}, {"obj", MeshFormat::obj}, {"ply", MeshFormat::ply}}};

// Those of documents and those that the readers of STEP, IGES and 3DM files name.
constexpr std::pair<std::string_view, double> kUnits[] = {
    {"m", 1},
    {"metre", 1},
    {"meter", 1},
    {"mm", 1e-3},
    {"millimetre", 1e-3},
    {"millimeter", 1e-3},
    {"cm", 1e-2},
    {"dm", 1e-1},
    {"km", 1e3},
    {"um", 1e-6},
    {"nm", 1e-9},
    {"in", 0.0254},
    {"inch", 0.0254},
    {"ft", 0.3048},
    {"foot", 0.3048},
    {"yd", 0.9144},
    {"yard", 0.9144},
    {"mil", 2.54e-5},
    {"uin", 2.54e-8},
    {"microinch", 2.54e-8},
    {"mi", 1609.344},
    {"mile", 1609.344},
    {"nautical mile", 1852},
    {"angstrom", 1e-10},
    {"dam", 10},
    {"hm", 100},
    {"Mm", 1e6},
    {"Gm", 1e9},
    {"pt", 0.0254 / 72},
    {"pica", 0.0254 / 6},
    {"au", 149597870700},
    {"ly", 9460730472580800},
    {"pc", 3.0856775814913673e16},
};

std::string lower_case(std::string_view s) {
    std::string out(s);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return out;
}

}  // namespace

std::optional<double> metres_per(std::string_view unit) {
    for (const auto& [name, metres] : kUnits)
        if (unit == name) return metres;
    for (const auto& [name, metres] : kUnits)
        if (lower_case(unit) == name) return metres;
    if (unit.ends_with(" m"))  // what else a STEP file may have is named by its size
        if (const auto x = scan_number<double>(unit.substr(0, unit.size() - 2)); x && *x > 0) return x;
    return std::nullopt;
}

Box<3> box_of(const TriangleMesh& mesh) {
    Box<3> box;
    for (const Vec<3>& p : mesh.points) box.add(p);
    return box;
}

Result<std::vector<FloatPoint>> float_points(const TriangleMesh& mesh, const Placement& placement) {
    constexpr double kMost = std::numeric_limits<float>::max(), kLeast = std::numeric_limits<float>::min();
    const double unit = std::scalbn(1.0, -placement.exponent);
    std::vector<FloatPoint> out(mesh.points.size());
    double largest = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Vec<3> p = mesh.points[i] - placement.centre;
        const double size = max_abs(p) * unit;
        if (size > kMost)
            return refuse(
                RefusalKind::limit, text("points[", i, "]"),
                text("the coordinate ", max_abs(p), " is too large for a float; .obj and .ply hold doubles"));
        largest = std::max(largest, size);
        for (int d = 0; d < 3; ++d) out[i][std::size_t(d)] = float(p[d] * unit);
    }
    if (largest > 0 && largest < kLeast)
        return refuse(RefusalKind::limit, "points",
                      text("no coordinate is larger than ", largest,
                           ", too small for a float; .obj and .ply hold doubles"));
    return out;
}

std::vector<MeshPart> parts_of(const TriangleMesh& mesh) {
    if (!mesh.parts.empty()) return mesh.parts;
    return {MeshPart{"", std::nullopt, 0, int(mesh.triangles.size()), -1, 0}};
}

Result<MeshFormat> mesh_format(std::string_view file_name) {
    const std::size_t dot = file_name.rfind('.');
    const std::string ending =
        lower_case(dot == std::string_view::npos ? file_name : file_name.substr(dot + 1));
    std::string known;
    for (const auto& [name, format] : kFormats) {
        if (ending == name) return format;
        known += text(known.empty() ? "" : ", ", ".", name);
    }
    return refuse(RefusalKind::unsupported, std::string(file_name),
                  text("not the ending of a mesh file (", known, ")"));
}

Result<void> write_mesh(const TriangleMesh& mesh, const std::string& path, std::optional<MeshFormat> format,
                        const MeshWriteOptions& options) {
    if (!format) {
        auto found = mesh_format(path);
        if (!found) return std::unexpected(found.error());
        format = *found;
    }
    const auto bytes = *format == MeshFormat::glb   ? to_glb(mesh, options)
                       : *format == MeshFormat::stl ? to_stl(mesh, options)
                       : *format == MeshFormat::obj ? to_obj(mesh, options)
                                                    : to_ply(mesh, options);
    if (!bytes) return refuse_within(path, bytes.error());
    return write_file(path, *bytes);
}

}  // namespace freiform
