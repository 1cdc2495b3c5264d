"""Every public header, and every function that it declares, is reached from Python or named here with the reason."""
import functools
import importlib.util
import re

import pytest
from conftest import ROOT

# Not by sys.path: beside it lie the package's sources, without what is built.
_spec = importlib.util.spec_from_file_location("generate", ROOT / "bindings" / "python" / "generate.py")
generate = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(generate)

HEADERS = ROOT / "include" / "freiform"

# Headers that no binding needs.
ARITHMETIC = "numbers and algorithms that the library computes with; Python has its own, or sees the answers"
CPP = "what C++ programs build algorithms from; Python calls the algorithms"
FIGURE = "parts of figures of C++ programs; drawings come from draw()"
HEADER_EXCEPTIONS = {
    "core/double_double": ARITHMETIC, "poly/arc_index": ARITHMETIC, "poly/determinant": ARITHMETIC,
    "poly/exact": ARITHMETIC, "poly/form": ARITHMETIC, "poly/integer": ARITHMETIC, "poly/integer_roots": ARITHMETIC,
    "poly/series": ARITHMETIC, "path/forward_differences": ARITHMETIC,
    "core/constants": CPP, "core/decimal": CPP, "core/scan": CPP, "core/sort": CPP, "core/tuples": CPP,
    "core/visit": CPP, "core/heap": "of the whole process, which is the interpreter's",
    "core/utf8": CPP,
    "make/boolean_sum": CPP,
    "mesh/chord_triangles": CPP, "mesh/face_mesh": CPP, "mesh/grid": CPP, "mesh/normal_cone": CPP,
    "mesh/segment_box": CPP, "mesh/visibility": CPP, "model/edge_gap": CPP, "query/checks": CPP,
    "query/hull_search": CPP, "query/pair_search": CPP, "spline/apex": CPP, "spline/chain": CPP,
    "spline/derivative_bounds": CPP, "spline/repeated_jets": CPP, "spline/hull_box": CPP, "spline/jet": CPP, "io/json": CPP, "io/colour_bar": FIGURE, "io/figure": FIGURE, "io/paper": FIGURE,
    "io/exchange": "read() calls it", "io/face_by_edges": CPP, "spline/wide": CPP,
    "intersect/curve_part": CPP, "make/image_curve": CPP,
    "model/spline_faces": CPP, "path/path_data": CPP,
}
# Headers that come with others that are included.
THROUGH = {"core/image", "core/vec", "core/view", "basis/band_map", "basis/bspline", "basis/change", "fit/parameters",
           "spline/patch", "spline/simplex", "spline/simplex_construction", "trim/inside", "trim/trimmed_surface"}
# Functions of headers that are bound.
FUNCTION_EXCEPTIONS = {
    "abs": "numpy",
    "append_text": "for C++",
    "basis_functions": "named_matrix(..) @ powers",
    "blossom_step": "a step of Basis.blossom",
    "derivative_step": "a step of Basis.collocation",
    "weights_in_span": "Basis.collocation",
    "box_axes": "a step of oriented_box",
    "box_of_part": "of surfaces as models have them; Model.bounds",
    "cardinal_matrix": "kochanek_bartels_matrix((tension, 0, 0), ..)",
    "check": "models are checked when they are read",
    "check_line": "intersect_lines refuses what it refuses",
    "check_loops": "TrimmedSurface and orient_loops refuse what it refuses",
    "clamped": "numpy.clip",
    "closest": "for messages",
    "closest_point": "Mesh.nearest",
    "colour_at": "of colours: Gradient",
    "composed": "the product of two matrices",
    "conjugate": "of quaternions: numpy",
    "control_nets": "Surface.points",
    "count_of": "for C++",
    "cross": "numpy",
    "curve_of_curves": "Surface.iso",
    "distances_from_model": "Model.deviation, Model.nearest",
    "dot": "numpy",
    "has_only_triangles": "Mesh.read says so by what it gives",
    "read_step_mesh": "Mesh.read",
    "each_fibre": "for C++",
    "edge_at": "for C++",
    "elevation_error": "a bound within algorithms",
    "elliptic_arc": "Path('A ..')",
    "equidistant": "numpy.linspace",
    "exp": "of rotations: numpy",
    "files_in_memory": "of WebAssembly",
    "flatten_on": "TrimmedSurface.tessellate",
    "format_of_content": "a step of read()",
    "format_of_name": "a step of read()",
    "from_axes": "three axes: numpy and turn_about",
    "grid_derivatives": "a step of bicubic_through",
    "hull_around": "hull_of_points",
    "inverted": "series of one variable: numpy",
    "is_between": "orient2d",
    "is_line_or_circle": "of curves as models have them",
    "isoline_levels": "Model.isolines chooses them",
    "joined": "for C++",
    "keep_left": "Curve.split",
    "keep_right": "Curve.split",
    "lane_riesenfeld": "Basis.halve_uniform is the same map",
    "largest_tolerance": "of a file's model; Sewing.tolerance",
    "limits": "of surfaces within models",
    "log": "of rotations: numpy",
    "make_model": "models come from readers",
    "max_abs": "numpy",
    "meetings": "joints",
    "metres_per": "units of files",
    "next_basis": "what next_g asks of free rows; its refusal says the size",
    "next_hermite": "hermite() with k * curve(t, 1)",
    "norm": "numpy",
    "object_label": "for messages of programs",
    "off_sphere": "Surface.sphere(..).off",
    "outline_edges": "Mesh.outlines",
    "paint_over": "of pictures of programs",
    "panels_of": "see io/figure",
    "parse_number_lines": "numpy.loadtxt",
    "parse_points": "read_points",
    "part_of": "a step of joints",
    "png_of": "pictures as arrays",
    "power_derivatives": "numpy",
    "powers": "numpy",
    "predicted_triangles": "an estimate that tessellate() makes itself",
    "product": "numpy",
    "read_file": "open()",
    "read_number_lines": "numpy.loadtxt",
    "real_roots_of_sums": "exact sums of doubles: real_roots with an error",
    "rebase": "for C++",
    "refinement_error": "a bound within algorithms",
    "remove_unfinished_files": "for signal handlers of programs",
    "reversed_across": "a step of surface_joint",
    "reversed_along": "a step of surface_joint",
    "scaled": "numpy",
    "scene_with_owners": "Document.scene",
    "segments_cross": "orient2d",
    "side_after": "a step of continuity",
    "side_before": "a step of continuity",
    "split_error": "a bound within algorithms",
    "sqrt": "numpy",
    "squad": "RotationTrack(kind='squad')",
    "surface_normals": "Mesh.normals",
    "to_text": "repr",
    "translated": "of parameter curves within models; Curve.transform moves curves",
    "transposed": "numpy",
    "uniform_subdivision": "Basis.halve_uniform gives its matrix",
    "unit_box": "for C++",
    "usual_range": "numpy.quantile",
    "revolution": "of surfaces as models have them; revolve",
}


@functools.lru_cache
def sources():
    text = "".join(p.read_text() for p in sorted((ROOT / "bindings" / "python" / "src").glob("*.[ch]pp")))
    return text, set(re.findall(r"\w+", text)) | set(re.findall(r"\w+", repr(generate.RECORDS)))


def headers():
    return sorted(str(p.relative_to(HEADERS))[:-4] for p in HEADERS.rglob("*.hpp"))


def declared(name):
    """Free functions of namespace freiform that a header declares: at the beginning of a line, not in detail."""
    text = re.sub(r"namespace detail \{.*?\n\}  // namespace detail", "", (HEADERS / f"{name}.hpp").read_text(), flags=re.S)
    if "namespace freiform::detail" in text:
        return set()
    found = set()
    for line in text.split("\n"):
        if re.match(r"(class|struct|//|#|using|template|requires|concept|namespace|\}|static_assert|enum)", line):
            continue
        match = re.match(r"(?:inline |constexpr |\[\[nodiscard\]\] )*[A-Za-z][\w:<>, *&]*? [*&]?(\w+)\(", line)
        if match and match[1] != "operator":
            found.add(match[1])
    return found


@pytest.mark.parametrize("name", headers())
def test_a_header_is_bound_or_named_with_a_reason(name):
    text, words = sources()
    included = f"<freiform/{name}.hpp>" in text or f'"records/{name}.hpp"' in text
    if name in HEADER_EXCEPTIONS:
        assert not included or name in THROUGH, "it is bound: take it off the list"
        return
    assert included or name in THROUGH, "neither bound nor named"
    missing = {f for f in declared(name) if f not in words and f not in FUNCTION_EXCEPTIONS}
    assert not missing


def test_no_exception_names_what_is_not_there():
    assert set(HEADER_EXCEPTIONS) | THROUGH <= set(headers())
    everything = set().union(*(declared(n) for n in headers()))
    assert set(FUNCTION_EXCEPTIONS) <= everything
