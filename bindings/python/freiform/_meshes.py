"""Triangle meshes."""
from __future__ import annotations

import ast
import os
from typing import Any

import numpy as np

from . import _core
from ._base import Array, ArrayLike, from_header, indices, packed, points_array, unpacked
from ._records import LevelLine, MeshEdge, MeshPart, MeshTopology, Outline
from ._refusals import Refusal, UnreadableError

__all__ = ["Mesh", "triangulate"]


@from_header("mesh/triangle_mesh:TriangleMesh")
class Mesh:
    """A triangle mesh. Its arrays are views of the library's memory and cannot be written to.

    ``points`` are shared by all faces; ``triangles`` index vertices, whose points ``vertex_points`` gives;
    ``faces`` index points.
    """

    __slots__ = ("_c",)
    _c: _core.MeshHandle

    def __init__(self, points: ArrayLike, triangles: ArrayLike, unit: str = "") -> None:
        self._c = _core.MeshHandle(points_array(points), indices(triangles, "triangles"), unit)

    @classmethod
    def _of(cls, handle: _core.MeshHandle) -> Mesh:
        made = object.__new__(cls)
        made._c = handle
        return made

    @classmethod
    @from_header("io/mesh_file:read_mesh")
    def read(cls, path: str | os.PathLike[str]) -> Mesh:
        """From a .glb, .stl, .obj, .ply or tessellated .step file."""
        return cls._of(_core.MeshHandle.read(os.fspath(path)))

    @classmethod
    def from_bytes(cls, data: bytes, format: str) -> Mesh:
        return cls._of(_core.MeshHandle.from_bytes(data, format))

    @from_header("io/mesh_file:write_mesh")
    def write(self, path: str | os.PathLike[str]) -> None:
        """To a .glb, .stl, .obj or .ply file, whole or not at all."""
        self._c.write(os.fspath(path))

    def to_bytes(self, format: str) -> bytes:
        """glb, stl, obj or ply."""
        return self._c.to_bytes(format)

    @property
    def points(self) -> Array:
        return self._c.points()

    @property
    def triangles(self) -> Array:
        return self._c.triangles()

    @property
    def vertex_points(self) -> Array:
        return self._c.vertex_points()

    @property
    def normals(self) -> Array:
        """One for each vertex; zero where there is none."""
        return self._c.normals()

    @property
    def uv(self) -> Array:
        """The parameters of each vertex on the surface of its face."""
        return self._c.uv()

    @property
    def faces(self) -> Array:
        """(n, 3) indices into points: what other libraries call faces."""
        corners: Array = self.vertex_points[self.triangles]
        return corners

    @property
    def parts(self) -> list[MeshPart]:
        return self._c.parts()

    @property
    def unit(self) -> str:
        return self._c.unit

    @property
    def __array_interface__(self) -> dict[str, Any]:
        interface: dict[str, Any] = self.points.__array_interface__
        return interface

    def __len__(self) -> int:
        """The number of triangles."""
        return len(self.triangles)

    @from_header("mesh/triangle_mesh:MeshTopology")
    def topology(self) -> MeshTopology:
        return _core.mesh_topology(self._c)

    @from_header("mesh/triangle_mesh:edges")
    def edges(self) -> list[MeshEdge]:
        return _core.mesh_edges(self._c)

    @from_header("mesh/triangle_mesh:smallest_angles")
    def smallest_angles(self) -> Array:
        return _core.mesh_smallest_angles(self._c)

    @from_header("mesh/level_lines:level_lines")
    def level_lines(self, values: ArrayLike, level: float) -> list[LevelLine]:
        return _core.mesh_level_lines(self._c, points_array(values), level)

    @from_header("mesh/level_lines:outlines", "mesh/level_lines:outline_edges")
    def outlines(self, angle: float) -> list[Outline]:
        return _core.mesh_outlines(self._c, angle)

    @from_header("mesh/refine:refined")
    def refine(self, longest: float, max_triangles: int = 10_000_000) -> Mesh:
        return _core.mesh_refined(self._c, longest, max_triangles)

    def nearest(self, points: ArrayLike) -> tuple[Array, Array, Array]:
        """(triangle, distance, point) for each of the points."""
        return _core.mesh_nearest(self._c, np.atleast_2d(points_array(points)))

    @from_header("gpu/render:render")
    def render(self, *, field: ArrayLike | None = None, **options: Any) -> Array:
        """A shaded picture, (height, width, 3) bytes: width, height, view ("iso", "top", "AZIMUTH,ELEVATION", ..),
        perspective, outlines, edges, zebra, isophotes, painting, range, colour, .."""
        picture: Array = _core.render(self._c, False, options, None if field is None else points_array(field))
        return picture

    @from_header("gpu/render:pixel_size")
    def pixel_size(self, **options: Any) -> float:
        return float(_core.pixel_size(self._c, options))

    def render_png(self, *, field: ArrayLike | None = None, **options: Any) -> bytes:
        """The same as PNG."""
        png: bytes = _core.render(self._c, True, options, None if field is None else points_array(field))
        return png

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Mesh):
            return False
        return all(np.array_equal(getattr(self, n), getattr(other, n))
                   for n in ("points", "triangles", "vertex_points", "normals", "uv")) and self.unit == other.unit

    def __hash__(self) -> int:
        return hash((self.points.tobytes(), self.triangles.tobytes(), self.unit))

    @classmethod
    def unpacked(cls, text: str) -> Mesh:
        """From the text that the repr of a mesh holds: all that there is of it, to the last bit."""
        try:
            state = ast.literal_eval(unpacked(text, "text").decode())
            return cls._restored(state)
        except (SyntaxError, TypeError, ValueError, RuntimeError) as why:
            raise why if isinstance(why, Refusal) else UnreadableError("text", "holds no mesh") from None

    def __repr__(self) -> str:
        if len(self) <= 50 and Mesh(self.points, self.faces, self.unit) == self:  # small, and no more than these
            return f"Mesh({self.points.tolist()!r}, {self.faces.tolist()!r}, {self.unit!r})"
        return f"Mesh.unpacked({packed(repr(self._c.state()).encode())!r})"

    def __str__(self) -> str:
        return f"<Mesh of {len(self.points)} points and {len(self)} triangles>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Mesh._restored, (self._c.state(),)

    @staticmethod
    def _restored(state: tuple[Any, ...]) -> Mesh:
        return Mesh._of(_core.MeshHandle.from_state(state))

    def _repr_html_(self) -> str:
        from ._notebook import html_of
        return html_of(self)

    def _repr_png_(self) -> bytes | None:
        from ._notebook import png_of
        return png_of(self)


@from_header("mesh/triangulate:Triangulation")
def triangulate(points: ArrayLike, segments: ArrayLike = ()) -> Array:
    """The constrained Delaunay triangles, (n, 3), inside what the segments (index pairs) enclose; without segments of
    the convex hull."""
    pairs = [(int(a), int(b)) for a, b in indices(segments, "segments").reshape(-1, 2)]
    return _core.triangulate(points_array(points), pairs)
