"""Documents, files, drawings."""
from __future__ import annotations

import os
from typing import Any, Iterable, Iterator, Sequence, Union, overload

from . import _core
from ._base import Array, from_header, handles
from ._models import Model, TrimmedSurface
from ._patches import Curve, Surface, Volume
from ._records import Approximation
from ._refusals import InvalidError, Refusal
from ._triangles import TriangularPatch

__all__ = ["Document", "Shape", "read", "parse", "write", "draw", "read_points"]

Shape = Union[Curve, Surface, Volume, TriangularPatch, TrimmedSurface, Model]


@from_header("shape:Document")
class Document(Sequence[Shape]):
    """Objects, as files hold them: a sequence of curves, surfaces, volumes, triangular patches, trimmed surfaces and
    models, with names and a unit."""

    __slots__ = ("_c",)
    _c: _core.DocumentHandle

    def __init__(self, objects: Iterable[Shape] = (), unit: str = "", names: Sequence[str] | None = None) -> None:
        shapes = list(objects)
        given = [""] * len(shapes) if names is None else list(names)
        if len(given) != len(shapes):
            raise InvalidError("names", f"{len(given)} for {len(shapes)} objects")
        self._c = _core.DocumentHandle(list(zip(given, handles(shapes, "objects"))), unit)

    @classmethod
    def _of(cls, handle: _core.DocumentHandle) -> Document:
        made = object.__new__(cls)
        made._c = handle
        return made

    def __len__(self) -> int:
        return self._c.size()

    @overload
    def __getitem__(self, index: int) -> Shape: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Shape]: ...
    def __getitem__(self, index: int | slice) -> Shape | Sequence[Shape]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        i = index + len(self) if index < 0 else index
        if not 0 <= i < len(self):
            raise IndexError(index)
        shape: Shape = self._c.shape(i)
        return shape

    def __iter__(self) -> Iterator[Shape]:
        return (self[i] for i in range(len(self)))

    @property
    def names(self) -> list[str]:
        return [self._c.name(i) for i in range(len(self))]

    @property
    def types(self) -> list[str]:
        """curve, surface, volume, triangle, trimmed, model."""
        return [self._c.type(i) for i in range(len(self))]

    @property
    def unit(self) -> str:
        return self._c.unit

    @property
    def left_out(self) -> list[Refusal]:
        """What of a file has no object, and why."""
        return self._c.left_out()

    def approximations(self, index: int) -> list[Approximation]:
        """What the reader had to change of an object, with bounds."""
        return self._c.approximations(index)

    def to_bytes(self, format: str, tolerance: float = 0.0) -> bytes:
        """json, bpt, step, iges, obj, or svg (of plane curves, within the tolerance)."""
        return self._c.to_bytes(format, tolerance)

    def write(self, path: str | os.PathLike[str], tolerance: float = 0.0) -> None:
        """To a file, whole or not at all; its ending says the format."""
        write(path, self, tolerance=tolerance)

    @from_header("io/scene:scene_of")
    def scene(self) -> Model:
        """All faces as one model."""
        return self._c.scene()

    @from_header("io/drawing:DrawingOptions")
    def draw(self, format: str = "svg", **options: Any) -> bytes:
        """A drawing as svg, pdf or png; options as DrawingOptions: width, height, view, title, axes ("none", "ticks",
        "grid"), control, knots, comb, hull, box, joints, hodograph, basis, construction, tangent, osculating, .."""
        return _core.draw(self._c, format, options)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Document):
            return False
        return (list(self), self.names, self.unit) == (list(other), other.names, other.unit)

    def __hash__(self) -> int:
        return hash((tuple(self), tuple(self.names), self.unit))

    def __repr__(self) -> str:
        return f"Document({list(self)!r}, unit={self.unit!r}, names={self.names!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return Document, (list(self), self.unit, self.names)

    def _repr_svg_(self) -> str | None:
        if "curve" not in self.types or len(set(self.types)) > 1:
            return None
        return self.draw("svg", width=640, height=400).decode()

    def _repr_html_(self) -> str | None:
        from ._notebook import html_of
        return html_of(self) if set(self.types) - {"curve", "volume"} else None

    def _repr_png_(self) -> bytes | None:
        from ._notebook import png_of
        return png_of(self) if set(self.types) - {"curve", "volume"} else None


@from_header("io/read:read_any", "io/exchange:read_with_occt")
def read(path: str | os.PathLike[str], *, format: str | None = None, timeout: float = 0.0, max_bytes: int = 0,
         max_memory: int = 0, reader: str | None = None, repair: bool = False,
         repair_limit: float = 0.0) -> Document:
    """Any file that freiform can read: json, bpt, step, iges, brep, quake3_bsp, quake3_map, svg, obj, bezierview (.bv),
    rhino (.3dm). STEP files by
    ``reader`` "freiform" (the library itself, the default) or "occt" (Open CASCADE in a process of its own).
    ``repair``: what is wrong in a STEP file beyond its tolerance is made right (`Model.repairs`; of 3DM files, too), gaps up to ``repair_limit``."""
    return Document._of(_core.read(os.fspath(path), format, timeout, max_bytes, max_memory, reader, repair, repair_limit))


@from_header("io/step_read:read_step", "io/rhino_read:read_3dm")
def parse(data: str | bytes, format: str | None = None) -> Document:
    """From memory: json, bpt, bezierview, step, rhino, obj, svg, quake3_bsp or quake3_map; without a name as the
    content begins, which obj and bezierview files do not say."""
    return Document._of(_core.parse(data, format))


def write(path: str | os.PathLike[str], what: Shape | Iterable[Shape], *, unit: str = "", tolerance: float = 0.0) -> None:
    """Writes objects to a file, whole or not at all; its ending says the format: json, bpt, step, iges, obj, svg; of
    surfaces and models within the tolerance also the meshes glb, stl and ply."""
    if isinstance(what, Document):
        document = what
    else:
        document = Document([what] if isinstance(what, (Curve, Surface, Volume, TriangularPatch, TrimmedSurface, Model))
                            else what, unit)
    name = os.fspath(path)
    ending = name.rpartition(".")[2].lower()
    if ending in ("glb", "stl", "ply"):
        document.scene().tessellate(tolerance).mesh.write(name)
    else:
        _core.write_file(name, document.to_bytes(ending, tolerance))


def draw(what: Shape | Iterable[Shape], format: str = "svg", **options: Any) -> bytes:
    """A drawing of objects as svg, pdf or png; options as Document.draw."""
    if isinstance(what, Document):
        return what.draw(format, **options)
    if isinstance(what, (Curve, Surface, Volume, TriangularPatch, TrimmedSurface, Model)):
        return Document([what]).draw(format, **options)
    return Document(what).draw(format, **options)


@from_header("io/points:parse_points")
def read_points(path: str | os.PathLike[str]) -> Array:
    """Points from CSV or JSON: (n, D), or a grid (n, m, D)."""
    return _core.read_points(os.fspath(path))
