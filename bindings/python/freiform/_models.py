"""Solid models and trimmed surfaces."""
from __future__ import annotations

from dataclasses import dataclass
from math import inf, tau
from typing import Any, NamedTuple, Sequence, Union

import numpy as np

from . import _core
from ._base import (Array, ArrayLike, Colour, Interval, IntervalLike, Record, from_header, handles, packed, pair, points_array,
                    unpacked)
from ._meshes import Mesh
from ._patches import Curve, Surface
from ._paths import Path
from ._records import (Approximation, Conic, ConvexHull, EdgeContinuity, FieldValues, Layer, Line, Measure,
                       MeshDeviation, ModelContacts, ModelDistance, ModelFarthest, ModelIntersection, ModelNearest,
                       ModelSection, ModelSummary, NearestFaces, OrientedBox, Repair, Sewing, SolidAlong,
                       SolidInside, SurfaceLine, Tessellation, TightBox)
from ._refusals import Refusal

__all__ = ["Model", "ModelFace", "ModelEdge", "ModelNearestPoints", "ModelNearestQuery", "TrimmedSurface", "inside_loops", "orient_loops"]


class ModelFace(NamedTuple):
    """A face: its name, what its surface is ("plane", "nurbs", ..), whether its normal is reversed, its colour."""

    name: str
    kind: str
    reversed: bool
    colour: Colour | None


class ModelEdge(NamedTuple):
    """An edge: its curve over a range of parameters, the vertices at its ends, its name and colour."""

    curve: Line | Conic | Curve | None
    range: Interval
    start: int
    end: int
    degenerate: bool
    name: str = ""
    colour: Colour | None = None


@from_header("trim/trimmed_surface:TrimmedSurface")
class TrimmedSurface:
    """A surface of which loops of curves in its parameter domain keep a part."""

    __slots__ = ("_c",)
    _c: _core.TrimmedHandle

    def __init__(self, surface: Surface, loops: Sequence[Sequence[Curve]]) -> None:
        self._c = _core.TrimmedHandle(surface._c, [handles(loop, "loop") for loop in loops])

    @classmethod
    def _of(cls, handle: _core.TrimmedHandle) -> TrimmedSurface:
        made = object.__new__(cls)
        made._c = handle
        return made

    @property
    def surface(self) -> Surface:
        return self._c.surface()

    @property
    def loops(self) -> list[list[Curve]]:
        return self._c.loops()

    def inside(self, uv: ArrayLike) -> list[str]:
        """outside, inside or boundary for each pair of parameters; exact."""
        places: list[str] = self._c.inside(np.atleast_2d(points_array(uv)))[0]
        return places

    def tessellate(self, tolerance: float, **options: Any) -> Mesh:
        return Model.assemble([self]).tessellate(tolerance, **options).mesh

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, TrimmedSurface):
            return False
        return (self.surface, self.loops) == (other.surface, other.loops)

    def __hash__(self) -> int:
        return hash((self.surface, repr(self.loops)))

    def __repr__(self) -> str:
        return f"TrimmedSurface({self.surface!r}, {self.loops!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return TrimmedSurface, (self.surface, self.loops)

    def _repr_html_(self) -> str:
        from ._notebook import html_of
        return html_of(self)

    def _repr_png_(self) -> bytes | None:
        from ._notebook import png_of
        return png_of(self)


Faces = Union[Surface, TrimmedSurface]


@from_header("model/model:Model")
class Model:
    """A boundary representation: faces on surfaces, bounded by edges that they share. Made by reading a file, by
    ``assemble``, ``prism`` or ``solid_of_revolution``."""

    __slots__ = ("_c",)
    _c: _core.ModelHandle

    def __init__(self, data: bytes) -> None:
        """From the bytes that to_binary gives."""
        self._c = _core.ModelHandle.from_binary(data)

    @classmethod
    def _of(cls, handle: _core.ModelHandle) -> Model:
        made = object.__new__(cls)
        made._c = handle
        return made

    @classmethod
    @from_header("model/assemble:ModelBuilder")
    def assemble(cls, surfaces: Sequence[Faces], unit: str = "", name: str = "") -> Model:
        """The surfaces as faces of one body; equal boundaries become shared edges."""
        return cls._of(_core.assemble(handles(surfaces, "surfaces"), unit, name))

    @staticmethod
    @from_header("model/swept_solid:prism")
    def prism(path: Path, by: ArrayLike) -> Model:
        """The region that a path bounds, moved along a vector."""
        return _core.prism(path._c, points_array(by))

    @staticmethod
    @from_header("model/swept_solid:solid_of_revolution")
    def solid_of_revolution(path: Path, origin: ArrayLike = (0.0, 0.0, 0.0), direction: ArrayLike = (0.0, 1.0, 0.0),
                            angle: float = tau) -> Model:
        """The region that a path bounds, turned about an axis."""
        return _core.solid_of_revolution(path._c, points_array(origin), points_array(direction), angle)

    @staticmethod
    @from_header("model/swept_solid:solid_along")
    def along(path: Path, rail: Curve, tolerance: float, x_at_start: ArrayLike = (0.0, 0.0, 0.0)) -> SolidAlong:
        """The region that a path bounds, along a rail in the frame that does not turn about it."""
        return _core.solid_along(path._c, rail._c, tolerance, points_array(x_at_start))

    @staticmethod
    @from_header("model/pipe:pipe")
    def pipe(corners: ArrayLike, radius: float, hole: float = 0.0, *, bend: float = 0.0, closed: bool = False) -> Model:
        """A pipe along a polyline of shape (n, 3), whose corners are rounded by arcs of the radius `bend`."""
        return _core.pipe(points_array(corners), radius, hole, bend, closed)

    @classmethod
    def unpacked(cls, text: str) -> Model:
        """From the text that the repr of a model holds."""
        return cls(unpacked(text, "text"))

    def to_binary(self) -> bytes:
        """The whole model, exact to the last bit."""
        return self._c.to_binary()

    @property
    def unit(self) -> str:
        return self._c.unit

    @property
    def vertices(self) -> Array:
        return self._c.vertices()

    @property
    def faces(self) -> list[ModelFace]:
        return [ModelFace(*f) for f in self._c.faces()]

    @property
    def edges(self) -> list[ModelEdge]:
        return [ModelEdge(*e) for e in self._c.edges()]

    @property
    def refused(self) -> list[Refusal]:
        """What of a file is not in the model, and why."""
        return self._c.refused()

    @property
    def approximations(self) -> list[Approximation]:
        """What a reader had to change, with bounds."""
        return self._c.approximations()

    @property
    def layers(self) -> list[Layer]:
        """What programs show and hide together."""
        return self._c.layers()

    @property
    def face_layers(self) -> list[list[int]]:
        """For each face the layers that it is on by itself."""
        return [list(x) for x in self._c.face_layers()]

    @property
    def body_layers(self) -> list[list[int]]:
        """For each body the layers that it is on."""
        return [list(x) for x in self._c.body_layers()]

    @property
    def repairs(self) -> list[Repair]:
        """What a reader was asked to make right."""
        return self._c.repairs()

    @from_header("model/model:ModelSummary")
    def summary(self) -> ModelSummary:
        return _core.model_summary(self._c)

    @from_header("model/bounds:tight_box")
    def bounds(self, accuracy: float = 0.0, max_parts: int = 20000) -> TightBox:
        return _core.model_tight_box(self._c, accuracy, max_parts)

    @from_header("model/bounds:oriented_box")
    def oriented_box(self, accuracy: float, max_parts: int = 20000) -> OrientedBox:
        return _core.model_oriented_box(self._c, accuracy, max_parts)

    @from_header("model/rescale:rescaled")
    def rescale(self, exponent: int) -> Model:
        return _core.model_rescaled(self._c, exponent)

    @from_header("model/rescale:divided")
    def divide(self, by: float) -> Model:
        return _core.model_divided(self._c, by)

    @from_header("model/sew:sew")
    def sew(self, tolerance: float) -> Sewing:
        return _core.model_sew(self._c, tolerance)

    @from_header("model/edge_length:edge_lengths")
    def edge_lengths(self, accuracy: float = 0.0) -> list[Measure]:
        return _core.model_edge_lengths(self._c, accuracy)

    @from_header("model/edge_continuity:edge_continuity")
    def edge_continuity(self, *, gap: float = 0.0, angle: float = 0.0, curvature: float = 0.0,
                        max_parts: int = 2000) -> list[EdgeContinuity]:
        return _core.model_edge_continuity(self._c, gap, angle, curvature, max_parts)

    @from_header("model/inside:inside_solid")
    def inside(self, points: ArrayLike, accuracy: float, max_triangles: int = 20_000_000) -> list[SolidInside]:
        return _core.model_inside(self._c, np.atleast_2d(points_array(points)), accuracy, max_triangles)

    @from_header("model/intersect:intersect")
    def intersect(self, other: Model, tolerance: float, max_pairs: int = 2_000_000) -> ModelIntersection:
        return _core.model_intersect(self._c, other._c, tolerance, max_pairs)

    @from_header("model/bounds:convex_hull")
    def convex_hull(self, tolerance: float, max_parts: int = 20000) -> ConvexHull:
        return _core.model_convex_hull(self._c, tolerance, max_parts)

    @from_header("model/curve_model:IntersectModel")
    def intersect_curve(self, curve: Curve, accuracy: float = 0.0, max_parts: int = 50_000) -> ModelContacts:
        """Where a curve meets the faces."""
        return _core.model_intersect_curve(self._c, curve._c, accuracy, max_parts)

    @from_header("model/curve_model:IntersectModel")
    def intersect_lines(self, points: ArrayLike, directions: ArrayLike, on: IntervalLike = (-inf, inf),
                        accuracy: float = 0.0, max_parts: int = 50_000) -> list[ModelContacts]:
        """Lines, rays (on = (0, inf)) or segments point + t direction with the faces, on all threads."""
        p, d = np.broadcast_arrays(np.atleast_2d(points_array(points)), np.atleast_2d(points_array(directions)))
        return _core.model_intersect_lines(self._c, points_array(p), points_array(d), pair(on), accuracy, max_parts)

    @from_header("model/section:section")
    def section(self, normal: ArrayLike, offset: float, tolerance: float, max_triangles: int = 20_000_000) -> ModelSection:
        """The section by the plane normal . x + offset = 0."""
        return _core.model_section(self._c, points_array(normal), offset, tolerance, max_triangles)

    @from_header("model/deviation:deviation")
    def deviation(self, mesh: Mesh, enough: float = 0.0, max_parts: int = 1_000_000) -> MeshDeviation:
        """How far a mesh and the model are apart."""
        return _core.model_deviation(self._c, mesh._c, enough, max_parts)

    @from_header("model/tessellate:tessellate")
    def tessellate(self, tolerance: float, *, max_edge: float = inf, max_angle: float = inf, max_aspect: float = inf,
                   quads: bool = False, as_planes: bool = False, max_triangles: int = 20_000_000) -> Tessellation:
        """A watertight mesh within a tolerance, with a proof."""
        return _core.tessellate(self._c, tolerance, max_edge, max_angle, max_aspect, quads, as_planes, max_triangles)

    @from_header("model/surface_field:surface_field", "model/surface_field:SurfaceField")
    def surface_field(self, mesh: Mesh, field: str) -> FieldValues:
        """gauss, mean, greatest, least or error at the vertices of a mesh of the model."""
        return _core.surface_field(self._c, mesh._c, field)

    @from_header("model/surface_lines:isolines")
    def isolines(self, mesh: Mesh, count: int | None = None) -> list[SurfaceLine]:
        return _core.isolines(self._c, mesh._c, count)

    @from_header("model/surface_lines:silhouettes")
    def silhouettes(self, mesh: Mesh, eye: ArrayLike) -> list[SurfaceLine]:
        return _core.silhouettes(self._c, mesh._c, points_array(eye))

    def nearest(self, points: ArrayLike, accuracy: float = 0.0, max_parts: int = 20000) -> ModelNearestPoints:
        """The nearest points of the faces, for points of shape (.., 3); for many questions: ModelNearestQuery."""
        return ModelNearestQuery(self).nearest(points, accuracy, max_parts)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Model) and self.to_binary() == other.to_binary()

    def __hash__(self) -> int:
        return hash(self.to_binary())

    def __repr__(self) -> str:
        return f"Model.unpacked({packed(self.to_binary())!r})"

    def __str__(self) -> str:
        return f"<Model of {len(self.faces)} faces>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Model, (self.to_binary(),)

    def __copy__(self) -> Model:
        return self

    def __deepcopy__(self, memo: object) -> Model:
        return self

    def _repr_html_(self) -> str:
        from ._notebook import html_of
        return html_of(self)

    def _repr_png_(self) -> bytes | None:
        from ._notebook import png_of
        return png_of(self)


@dataclass(frozen=True, eq=False, repr=False)
class ModelNearestPoints(Record):
    """The nearest points of a model, one for each of the points asked for: every field is an array. ``nearest[i]`` is that of
    one point.

    No point of any face is nearer than ``lower_bound``; the true distance lies in [lower_bound, distance + point_error]. ``uv``:
    the parameters on the face. ``edge`` and ``vertex``: where the point is on the boundary of its face, else -1; ``t``: the
    parameter of the edge.
    """

    face: Array
    uv: Array
    edge: Array
    vertex: Array
    t: Array
    point: Array
    distance: Array
    point_error: Array
    lower_bound: Array

    def __len__(self) -> int:
        return len(self.distance)

    def __getitem__(self, i: int) -> ModelNearest:
        if self.distance.ndim != 1:
            raise TypeError(f"the answers have the shape {self.distance.shape}: an index is for those of points of shape (n, 3)")
        one = [x[i] for x in self._values()]  # type: ignore[index]
        return ModelNearest(*(x if x.ndim else x.item() for x in one))


@from_header("model/nearest:ModelNearestQuery")
class ModelNearestQuery:
    """The faces of a model, prepared for questions about nearest points."""

    __slots__ = ("_c", "model")

    def __init__(self, model: Model) -> None:
        self.model = model
        self._c = _core.ModelNearestHandle(model._c)

    def nearest(self, points: ArrayLike, accuracy: float = 0.0, max_parts: int = 20000) -> ModelNearestPoints:
        """For points of shape (.., 3): arrays of shape (..)."""
        return ModelNearestPoints(*self._c.nearest(points_array(points), accuracy, max_parts))

    def farthest(self, point: ArrayLike, accuracy: float = 0.0, max_parts: int = 20000) -> ModelFarthest:
        return self._c.farthest(points_array(point), accuracy, max_parts)

    def nearest_faces(self, point: ArrayLike, count: int, radius: float = inf) -> NearestFaces:
        return self._c.nearest_faces(points_array(point), count, radius)

    @from_header("model/distance:least_distance")
    def least_distance(self, other: ModelNearestQuery, accuracy: float = 0.0, max_pairs: int = 200_000) -> ModelDistance:
        return self._c.least_distance(other._c, accuracy, max_pairs)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ModelNearestQuery) and self.model == other.model

    def __hash__(self) -> int:
        return hash(("ModelNearestQuery", self.model))

    def __repr__(self) -> str:
        return f"ModelNearestQuery({self.model!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return ModelNearestQuery, (self.model,)


@from_header("trim/inside:InsideQuery")
def inside_loops(loops: Sequence[Sequence[Curve]], points: ArrayLike, gap: float = 0.0) -> tuple[list[str], Array]:
    """(outside, inside or boundary; winding number) of points of the plane; exact."""
    return _core.inside_loops([handles(loop, "loop") for loop in loops], gap, np.atleast_2d(points_array(points)))


@from_header("trim/loops:orient_loops")
def orient_loops(loops: Sequence[Sequence[Curve]], accuracy: float,
                 gap: float = 0.0) -> tuple[list[list[Curve]], Array, Array]:
    """(loops with the region on their left, depth of each, which were turned)."""
    return _core.orient_loops([handles(loop, "loop") for loop in loops], gap, accuracy)
