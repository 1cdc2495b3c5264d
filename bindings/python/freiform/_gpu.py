"""Surfaces for graphics cards."""
from __future__ import annotations

from typing import Any, Sequence, Union

import numpy as np

from . import _core
from ._base import Array, ArrayLike, from_header, points_array
from ._models import Model
from ._patches import Surface
from ._refusals import OutOfDomainError, InvalidError, UnavailableError
from ._triangles import TriangularPatch

__all__ = ["SurfaceBuffers", "SurfaceEvaluator", "SurfaceRenderer", "shader_source"]

Patches = Sequence[Union[TriangularPatch, tuple[TriangularPatch, str]]]


def _need_opengl() -> None:
    if not hasattr(_core, "shader_source"):
        raise UnavailableError("gpu", "built without OpenGL")


@from_header("gpu/surfaces:surface_buffers", "gpu/surfaces:SurfaceBuffers")
class SurfaceBuffers:
    """What shaders read of a model, and of triangular patches beside it (each alone or with its colour "#rrggbb").
    Arrays are views of the library's memory and cannot be written to; those of floats can be copied to a card as they are."""

    __slots__ = ("_c", "_arguments")
    _c: _core.SurfaceBuffersHandle

    def __init__(self, model: Model, edge_tolerance: float, triangles: Patches = (), colour: str = "") -> None:
        _need_opengl()
        pairs = []
        for i, given in enumerate(triangles):
            patch, own = given if isinstance(given, tuple) else (given, "")
            if not isinstance(patch, TriangularPatch):
                raise InvalidError(f"triangles[{i}]", "is no TriangularPatch, nor one with its colour")
            pairs.append((patch, own))
        self._arguments = (model, edge_tolerance, tuple(pairs), colour)
        self._c = _core.SurfaceBuffersHandle(model._c, edge_tolerance, [(p._c, own) for p, own in pairs], colour)

    @property
    def middle(self) -> Array:
        """Where the scene has its origin, in model units."""
        return self._c.middle()

    @property
    def size(self) -> float:
        return self._c.size

    @property
    def texels(self) -> Array:
        """(n, 4) floats: coefficients, curves of loops, records of pieces and faces."""
        return self._c.texels()

    @property
    def pieces(self) -> int:
        return self._c.pieces

    @property
    def faces(self) -> int:
        return self._c.faces

    @property
    def tensor_pieces(self) -> int:
        return self._c.tensor_pieces

    @property
    def triangles(self) -> int:
        return self._c.triangles

    @property
    def face_count(self) -> int:
        return self._c.face_count

    @property
    def edge_tolerance(self) -> float:
        return self._c.edge_tolerance

    @property
    def bends(self) -> Array:
        """(pieces, 2) floats."""
        return self._c.bends()

    @property
    @from_header("gpu/surfaces:SeamSegment")
    def seams(self) -> Array:
        """A structured array: from, to, edge_from, edge_to, normal_from, .., colour, other_colour."""
        return self._c.seams()

    @property
    def outlines(self) -> Array:
        """(n, 2, 3) floats: the ends of segments of edges."""
        return self._c.outlines()

    @property
    def extent(self) -> Array:
        """(n, 3), in model units: points to fit a view to."""
        return self._c.extent()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SurfaceBuffers) and self._arguments == other._arguments

    def __hash__(self) -> int:
        return hash(self._arguments)

    def __repr__(self) -> str:
        return f"SurfaceBuffers{self._arguments!r}"

    def __str__(self) -> str:
        return f"<SurfaceBuffers of {self.face_count} faces in {self.tensor_pieces + self.triangles} pieces>"

    def __reduce__(self) -> tuple[Any, ...]:
        return SurfaceBuffers, self._arguments


@from_header("gpu/surfaces:shader_source")
def shader_source(shader: str, dialect: str = "gl430") -> str:
    """patch_vertex, patch_control, patch_evaluation, triangle_evaluation, grid_vertex, surface_fragment, seam_vertex,
    seam_fragment, evaluate_float or evaluate_double, for gl430 or gles300."""
    _need_opengl()
    return _core.shader_source(shader, dialect)


class _OnCard:
    """What is made of its arguments, and has an OpenGL context."""

    __slots__ = ("_c", "_arguments")
    _arguments: tuple[Any, ...]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and isinstance(other, _OnCard) and self._arguments == other._arguments

    def __hash__(self) -> int:
        return hash((type(self).__name__, self._arguments))

    def __repr__(self) -> str:
        return f"{type(self).__name__}{self._arguments!r}"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._arguments


@from_header("gpu/surfaces:SurfaceRenderer")
class SurfaceRenderer(_OnCard):
    """Pipelines: "tessellation" (OpenGL 4.3), "grid" (OpenGL ES 3.0)."""

    __slots__ = ()
    _c: _core.SurfaceRendererHandle

    def __init__(self, buffers: SurfaceBuffers, pipeline: str = "tessellation") -> None:
        _need_opengl()
        self._arguments = (buffers, pipeline)
        self._c = _core.SurfaceRendererHandle(buffers._c, pipeline)

    def draw(self, deviation: float = 0.2, **options: Any) -> Array:
        """A shaded picture, (height, width, 3) bytes, of triangles within `deviation` pixels of the surfaces. Options as of
        Mesh.render, without fields and edges of triangles."""
        return self._c.draw(deviation, options)

    @from_header("gpu/surfaces:SurfaceVertex")
    def triangles(self, deviation: float = 0.2, **options: Any) -> Array:
        """The triangles of that picture, (n, 3), a structured array: position, normal, at, piece. Of the pipeline
        "tessellation"."""
        if self._arguments[1] != "tessellation":
            raise InvalidError("pipeline", "has no triangles to give: only \"tessellation\" has")
        return self._c.triangles(deviation, options)


@from_header("gpu/surfaces:SurfaceEvaluator")
class SurfaceEvaluator(_OnCard):
    """A surface that a compute shader evaluates, in "single" precision or "twice" that."""

    __slots__ = ()
    _c: _core.SurfaceEvaluatorHandle

    def __init__(self, surface: Surface, precision: str = "single") -> None:
        _need_opengl()
        self._arguments = (surface, precision)
        self._c = _core.SurfaceEvaluatorHandle(surface._c, precision)

    def __call__(self, uv: ArrayLike) -> Array:
        """Points at pairs of parameters, (n, 2)."""
        points: Array = self._c.evaluate(self._checked(uv), False)[0]
        return points

    def with_normals(self, uv: ArrayLike) -> tuple[Array, Array]:
        """The points, and the unit normals there."""
        points, normals = self._c.evaluate(self._checked(uv), True)
        return points, normals

    def _checked(self, uv: ArrayLike) -> Array:
        at = np.atleast_2d(points_array(uv))
        if at.ndim != 2 or at.shape[1] != 2:
            raise InvalidError("uv", f"has the shape {at.shape}; pairs of parameters are an array (n, 2)")
        for axis, on in enumerate(self._arguments[0].domain):
            bad = np.flatnonzero(~((at[:, axis] >= on.lo) & (at[:, axis] <= on.hi)))
            if len(bad):
                raise OutOfDomainError(f"uv[{bad[0]}]", f"{at[bad[0], axis]} is outside [{on.lo}, {on.hi}]")
        return at
