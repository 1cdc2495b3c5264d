#!/usr/bin/env python3
"""generate.py HEADERS OUT: what the Python package says twice only because two languages do, from the headers.

    OUT/freiform/_records.py   a dataclass for each record (struct) of RECORDS, with the comments of its header
    OUT/freiform/_docs.py      the comment of every declaration, for docstrings
    OUT/records/LAYER/x.hpp    the fields of the same records for convert.hpp

The headers are formatted by clang-format and follow one style, so that lines and braces are grammar enough; what is not
understood is an error, not a guess.
"""
import pathlib
import re
import sys
import textwrap

# Header: records. "A::B as C": a nested struct under a name of its own; "R -x": without the field x.
RECORDS = {
    "core/interval": ["Box"],
    "poly/roots": ["Root", "RealRoots"],
    "basis/polynomial_basis": ["BasisChange -from -to", "ConvertedNumbers", "Converted"],
    "spline/geometry": ["Line", "Conic"],
    "spline/edge": ["SurfaceEdge"],
    "spline/a_frame": ["AFrame"],
    "spline/refine": ["Reduced"],
    "spline/transform": ["Transformed"],
    "spline/weights": ["PositiveForm"],
    "spline/subdivision": ["Extended"],
    "spline/compatible": ["Compatible"],
    "spline/simplex_convert": ["Parts", "ReducedTriangle"],
    "make/made_surface": ["MadeSurface"],
    "make/conic": ["ConicArc", "FoundConic"],
    "make/conic_equation": ["ConicEquation", "ConicForm", "FoundEquation", "FivePointArc"],
    "make/coons": ["CoonsPatch"],
    "make/frame_sweep": ["FrameSweep"],
    "make/graph": ["Graph"],
    "make/named_curve": ["PolynomialCurve"],
    "make/named_surface": ["PolynomialPatch"],
    "make/polynomial_near": ["NearPolynomial"],
    "make/quadric": ["RoundSurface", "SphereInSix", "SphereInEight"],
    "make/revolve": ["RevolvedPolynomial"],
    "make/triangle_joint": ["JoinedTriangle", "PointNormalTriangle"],
    "path/flatten": ["Polyline", "FlattenComparison"],
    "path/path": ["PathSegment", "Subpath", "SubpathOfCurve"],
    "path/simplify": ["SimplifiedPath"],
    "query/bounds": ["TightBox", "Extent"],
    "query/continuity": ["Jump", "SideGeometry", "Continuity", "KnotContinuity", "KnotLine", "Meeting", "CurveJoint"],
    "query/crossings": ["Crossing"],
    "query/distance": ["LeastDistance"],
    "query/features": ["Feature"],
    "query/hull": ["ConvexHull", "LocalHull"],
    "query/implicit": ["Implicit::Term as ImplicitTerm"],
    "query/length": ["Measure", "PlaceAtLength"],
    "query/nearest": ["Nearest", "Farthest", "NearRegion", "NearRegions", "NearFoot", "NearestFeet"],
    "query/oriented_box": ["OrientedBox"],
    "query/reparametrise": ["ArcLengthCurve"],
    "query/self_intersection": ["SelfIntersection"],
    "query/sphere_of": ["FoundSphere"],
    "query/surface_continuity": ["LargestJump", "SurfaceContinuity", "LineContinuity", "SurfaceMeeting", "SurfaceJoint"],
    "query/surface_curvature": ["SurfaceCurvature", "LimitNormal"],
    "query/triangle_joint": ["Deviation", "TriangleJoint"],
    "intersect/contact": ["Contact", "Overlap", "Intersections"],
    "intersect/section": ["SectionBranch", "SectionNode", "Section"],
    "intersect/surface_surface": ["SurfaceBranch", "SurfaceOverlap", "SurfaceNode", "SurfaceIntersection"],
    "fit/interpolate": ["Interpolant"],
    "fit/least_squares": ["FitReport", "Fitted", "FittedSurface"],
    "fit/loft": ["Loft", "GordonSurface"],
    "animate/rotation": ["Quaternion"],
    "animate/motion": ["Motion::State as MotionState", "Trajectory::State as TrajectoryState"],
    "colour/colour_map": ["Oklab"],
    "colour/gradient": ["ColourStop"],
    "colour/mesh_gradient": ["MeshGradient::Grid as MeshGradientGrid"],
    "trim/loops": ["LoopContact"],
    "region/boolean": ["Region", "PathArea"],
    "mesh/triangle_mesh": ["MeshPart", "MeshEdge", "MeshTopology"],
    "mesh/level_lines": ["EdgePlace", "LevelLine", "Outline"],
    "model/model": ["Approximation", "Layer", "ModelSummary", "Repair"],
    "model/deviation": ["FaceDeviation", "MeshDeviation"],
    "model/nearest": ["ModelNearest", "ModelFarthest", "NearestFaces"],
    "model/distance": ["ModelDistance"],
    "model/edge_continuity": ["EdgeContinuity"],
    "model/inside": ["SolidInside"],
    "model/intersect": ["TrimPlace", "FaceBranch", "FaceOverlap", "FaceNode", "ChainLink", "BranchChain", "OpenFaces",
                        "ModelIntersection"],
    "model/curve_model": ["ContactFace", "ModelContact", "OpenContacts", "ModelOverlap", "ModelContacts"],
    "model/tessellate": ["RefusedFace", "FaceReport", "Tessellation -seconds"],
    "model/section": ["ModelSectionLine", "ModelSection"],
    "model/sew": ["SewnEdge", "RemainingGap", "Opening", "Sewing"],
    "model/surface_field": ["FieldValues"],
    "model/swept_solid": ["SolidAlong"],
    "model/surface_lines": ["SurfaceLine", "SurfaceNormal"],
    "io/svg": ["SvgShape", "SvgPicture", "SvgOfDocument"],
    "path/style": ["StrokeStyle"],
    "io/gltf_animation": ["GltfChannel", "GltfAnimation"],
    "font/font": ["FontAxis", "FontInfo", "Glyph", "FontFile"],
    "font/typeset": ["PlacedGlyph", "Typeset"],
}
PATCHES = {"Curve": "Curve", "Surface": "Surface", "Volume": "Volume", "SimplexPatch": "TriangularPatch", "Path": "Path",
           "Model": "Model", "TriangleMesh": "Mesh", "TrimmedSurface": "TrimmedSurface", "BSplineBasis": "Basis"}


def closing(text, start, pairs="<>"):
    depth = 0
    for i in range(start, len(text)):
        depth += (text[i] == pairs[0]) - (text[i] == pairs[1])
        if depth == 0:
            return i
    raise SystemExit(f"generate.py: unbalanced {pairs} in {text!r}")


def arguments(text):
    """The template arguments of A<x, y<z>>, as texts."""
    inside, parts, depth, last = text[text.index("<") + 1:-1], [], 0, 0
    for i, c in enumerate(inside):
        depth += (c in "<(") - (c in ">)")
        if c == "," and depth == 0:
            parts.append(inside[last:i].strip())
            last = i + 1
    return parts + [inside[last:].strip()]


def python_type(t, records):
    """The annotation of a C++ type."""
    t = re.sub(r"\bconst\b|&", "", t).strip().replace("std::", "")
    base = t.split("<")[0]
    simple = {"double": "float", "int": "int", "size_t": "int", "bool": "bool", "string": "str", "Interval": "Interval",
              "Bounded": "Bounded", "Colour": "Colour", "Refusal": "Refusal", "Vec": "Array", "Hom": "Array",
              "PointOf": "Array", "BoundedVec": "tuple[Bounded, ...]", "Net": "Array", "Param": "Array", "P": "Array",
              "filesystem::path": "str", "S": "AnyPatch", "PropertyPath": "str"}
    if base in simple:
        return simple[base]
    if base == "Patch":
        return {"1": "Curve", "2": "Surface", "3": "Volume"}.get(arguments(t)[0], "AnyPatch")
    if base in PATCHES:
        return PATCHES[base]
    if base in ("vector", "span"):
        inner = python_type(arguments(t)[0], records)
        return "Array" if inner in ("Array", "float", "int") and "<array" not in t else f"list[{inner}]"
    if base == "array":
        inner = python_type(arguments(t)[0], records)
        return "Array" if inner in ("Array", "float", "int") else f"tuple[{inner}, ...]"
    if base == "optional":
        return python_type(arguments(t)[0], records) + " | None"
    if base == "variant":
        return " | ".join(dict.fromkeys(python_type(a, records) for a in arguments(t)))
    if base == "CurveGeometry":
        return "Line | Conic | Curve"
    if base in records:
        return base
    if base[:1].isupper():
        return "str"  # an enumeration
    raise SystemExit(f"generate.py: the type {t!r} is not understood")


def comment_before(lines, i):
    """The comment that ends above line i, over `template` and `requires`."""
    i -= 1
    while i >= 0 and re.match(r"(template <|requires)", lines[i].strip()):
        i -= 1
    text = []
    while i >= 0 and lines[i].strip().startswith("//"):
        text.insert(0, lines[i].strip()[2:].removeprefix(" "))
        i -= 1
    return "\n".join(text)


def fields_of(body):
    """(type, name, comment) of the data members of the text between the braces of a struct."""
    found, statement, comment, depth, pending = [], "", "", 0, ""
    rows = body.split("\n")
    for row in rows:
        code, _, remark = row.partition("//")
        code = code.strip()
        if not code:
            if remark:
                if found and pending == "trailing" and row.startswith("     " * 2):
                    found[-1][2] += " " + remark.strip()
                else:
                    comment += " " + remark.strip()
                    pending = ""
            else:
                comment, pending = "", ""
            continue
        statement += " " + code
        depth = statement.count("{") - statement.count("}")
        done = depth == 0 and (code.endswith(";") or code.endswith("}"))
        if not done:
            if remark:
                comment += " " + remark.strip()
            continue
        text, statement = statement.strip().rstrip(";").strip(), ""
        if re.match(r"(struct|enum|class) ", text):
            named = re.search(r"\} (\w+)", text)
            if named and named[1] != "":
                found.append(["", named[1], comment.strip()])
            comment = ""
            continue
        if re.match(r"(using|static|friend|template|explicit|requires|constexpr|operator|typedef)\b", text) or \
                re.match(r"[\w:<>, &*]+\(", text) or re.search(r"\w\(.*\) (const )?\{", text):
            comment = ""
            continue
        flat = re.sub(r"\{[^{}]*\}", "", re.sub(r"\{[^{}]*\}", "", re.sub(r"\{[^{}]*\}", "", text)))
        flat = re.sub(r"=[^,]*", "", flat).strip()
        if "(" in flat:
            comment = ""
            continue
        cut = 0
        if "<" in flat:
            cut = closing(flat, flat.index("<")) + 1
        if cut and not flat[cut:].strip().startswith("::"):
            kind, names = flat[:cut], flat[cut:]
        else:
            kind, _, names = flat.rpartition(" ") if "," not in flat else (flat[:flat.index(" ", 0)], "", flat[flat.index(" "):])
        for name in names.split(","):
            name = name.strip()
            array = re.match(r"(\w+)\[\d+\]$", name)
            found.append([("std::array<%s, 2>" % kind.strip()) if array else kind.strip(), array[1] if array else name,
                          " ".join([comment.strip(), remark.strip()]).strip()])
        comment, pending = "", "trailing"
    return [tuple(f) for f in found]


class Header:
    def __init__(self, root, name):
        self.name = name
        self.text = (root / "freiform" / (name + ".hpp")).read_text()
        self.lines = self.text.split("\n")

    def struct(self, name):
        """(template parameters, base, fields, comment)"""
        outer, _, last = name.rpartition("::")
        from_line = next((i for i, line in enumerate(self.lines) if re.match(r"class %s " % outer, line)), 0) if outer else 0
        for i, line in enumerate(self.lines[from_line:], from_line):
            match = re.match(r"( *)struct %s(?: : ([\w<>:, ]+))? \{" % last, line)
            if not match or ("::" in name) != bool(match[1]):
                continue
            end = i
            while self.lines[end] != match[1] + "};":
                end += 1
            before = self.lines[i - 1]
            template = re.match(r"template <(.*)>$", before.strip())
            return (template[1] if template else "", match[2],
                    fields_of("\n".join(self.lines[i + 1:end])), comment_before(self.lines, i))
        raise SystemExit(f"generate.py: {self.name}.hpp has no struct {name}")

    def documented(self):
        """(name, comment) of what is declared: the comment above it, of several in a row the one above the first."""
        for i, line in enumerate(self.lines):
            if line.strip().startswith("//") or line.startswith("     ") and not line.lstrip().startswith(("Space", "2 >>")):
                continue
            names = re.findall(r"(?:struct|class|enum class) (\w+)", line) or re.findall(r"(\w+)\(", line)
            above = i
            while above > 0 and self.lines[above - 1].strip() and not self.lines[above - 1].strip().startswith("//"):
                above -= 1
            comment = comment_before(self.lines, above)
            if comment and above > 0:
                for name in names:
                    if name not in ("requires", "defined", "sizeof", "if", "return", "for", "while", "static_assert"):
                        yield name, comment

    def head(self):
        """The comment that the file begins with."""
        lines = []
        for line in self.lines:
            if not line.startswith("//"):
                break
            lines.append(line[2:].removeprefix(" "))
        return "\n".join(lines)


def main():
    headers, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    records, order = {}, []
    for name, wanted in RECORDS.items():
        header = Header(headers, name)
        for entry in wanted:
            entry, *without = re.split(r" -", entry)
            cpp, _, python = entry.partition(" as ")
            template, base, fields, comment = header.struct(cpp)
            fields = [f for f in fields if f[1] not in without]
            if any(not f[0] for f in fields):
                raise SystemExit(f"generate.py: {cpp} has a field without a type: {fields}")
            python = python or cpp
            if base and base in records:
                fields = records[base]["fields"] + fields
            records[python] = {"header": name, "cpp": cpp, "template": template, "fields": fields, "comment": comment}
            order.append(python)

    # C++: one file for each header.
    folder = out / "records"
    by_header = {}
    for python in order:
        r = records[python]
        parameters = re.sub(r"\b(Coefficient|Basis)\b", "class", r["template"])
        names = ", ".join(re.sub(r"(class|int|std::size_t) ", "", p.strip()) for p in parameters.split(",")) if parameters else ""
        kind = r["cpp"] + (f"<{names}>" if names else "")
        values = ", ".join(f"to_py(x.{name})" for _, name, _ in r["fields"])
        by_header.setdefault(r["header"], []).append(
            f"template <{r['template']}>\nstruct Fields<{kind}> {{\n"
            f"    static constexpr std::string_view name = \"{python}\";\n"
            f"    static py::tuple of(const {kind}& x) {{ return py::make_tuple({values}); }}\n}};\n")
    for header, parts in by_header.items():
        write(folder / (header + ".hpp"), "#pragma once\n#include \"paths.hpp\"\n#include <freiform/%s.hpp>\n" % header +
              "namespace freiform::python {\n" + "".join(parts) + "}  // namespace freiform::python\n")

    # Python
    text = ['"""Answers of the library: records with what the headers say of them. Generated by generate.py."""',
            "from __future__ import annotations", "", "from dataclasses import dataclass",
            "from typing import TYPE_CHECKING, Union", "",
            "from ._base import Array, Bounded, Colour, Interval, Record", "from ._refusals import Refusal", "",
            "if TYPE_CHECKING:",
            "    from ._basis import Basis", "    from ._meshes import Mesh",
            "    from ._models import Model, TrimmedSurface", "    from ._patches import Curve, Surface, Volume",
            "    from ._paths import Path", "    from ._triangles import TriangularPatch",
            "    AnyPatch = Union[Curve, Surface, Volume]", "", "__all__ = ["]
    text += [f'    "{name}",' for name in order] + ["]", ""]
    for python in order:
        r = records[python]
        lines = [r["comment"]] if r["comment"] else [f"See freiform/{r['header']}.hpp."]
        told = [f"{name}: {comment}" for _, name, comment in r["fields"] if comment]
        doc = "\n\n".join(lines) + ("\n\n" + "\n".join(told) if told else "")
        doc = textwrap.indent(doc.replace("\\", "\\\\").replace('"""', "'''"), "    ").strip()
        text += ["", "@dataclass(frozen=True, eq=False, repr=False)", f"class {python}(Record):", f'    """{doc}', '    """', ""]
        text += [f"    {'from_' if name == 'from' else name}: {python_type(kind, records)}" for kind, name, _ in r["fields"]]
        text.append("")
    write(out / "freiform" / "_records.py", "\n".join(text) + "\n")

    docs = {}
    for path in sorted((headers / "freiform").rglob("*.hpp")):
        name = str(path.relative_to(headers / "freiform"))[:-4]
        header = Header(headers, name)
        docs[f"{name}:"] = [header.head()]
        for declared, comment in header.documented():
            told = docs.setdefault(f"{name}:{declared}", [])
            if comment not in told:
                told.append(comment)
    body = "".join(f"    {key!r}: {chr(10).join(value)!r},\n" for key, value in sorted(docs.items()))
    write(out / "freiform" / "_docs.py",
          '"""What the headers say of their declarations. Generated by generate.py."""\n\nDOCS: dict[str, str] = {\n' + body + "}\n")


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


if __name__ == "__main__":
    main()
