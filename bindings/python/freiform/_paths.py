"""Plane paths, and the regions that they bound."""
from __future__ import annotations

from typing import Any, Sequence

from . import _core
from ._base import ArrayLike, from_header, points_array
from ._patches import Curve
from ._records import PathArea, Region, SimplifiedPath, Subpath, SvgPicture
from ._refusals import InvalidError

__all__ = ["Path", "combine", "region_of", "read_svg_picture"]


@from_header("path/path:Path", "path/path:Subpath", "path/path:parse_path_data")
class Path:
    """A plane path: chains of lines, Bezier curves and elliptic arcs. ``Path("M 0 0 C 1 0 2 1 2 2 Z")``."""

    __slots__ = ("_c",)
    _c: _core.PathHandle

    def __init__(self, data: str = "") -> None:
        if not isinstance(data, str):
            raise InvalidError("data", "is no text as SVG has it; Path.of_curve, Path.from_subpaths make paths from other things")
        self._c = _core.PathHandle(data)

    @classmethod
    def _of(cls, handle: _core.PathHandle) -> Path:
        made = object.__new__(cls)
        made._c = handle
        return made

    @staticmethod
    def from_subpaths(subpaths: Sequence[Subpath]) -> Path:
        """From subpaths as the property gives them."""
        return _core.PathHandle.from_subpaths([(points_array(s.start), s.closed, [
            (g.degree, points_array(g.points), g.weight) for g in s.segments]) for s in subpaths])

    @staticmethod
    @from_header("path/path:subpath_of")
    def of_curve(curve: Curve, tolerance: float) -> tuple[Path, float]:
        """A curve as a path: (path, bound of what was approximated)."""
        return _core.PathHandle.of_curve(curve._c, tolerance)

    @staticmethod
    def ellipse(centre: ArrayLike, rx: float, ry: float | None = None) -> Path:
        """A whole ellipse (a circle without ry), in four quarters."""
        return _core.PathHandle.ellipse(points_array(centre), rx, rx if ry is None else ry)

    @property
    def data(self) -> str:
        """The path data of SVG; lines and Bezier curves are read back as the same numbers."""
        return self._c.data()

    @property
    def subpaths(self) -> list[Subpath]:
        return self._c.subpaths()

    def curves(self) -> list[Curve]:
        """Each subpath as one curve."""
        return self._c.curves()

    def transform(self, linear: ArrayLike, offset: ArrayLike = (0.0, 0.0)) -> Path:
        return self._c.transformed(points_array(linear), points_array(offset))

    @from_header("path/simplify:simplified")
    def simplify(self, tolerance: float, corner: float = 0.1) -> SimplifiedPath:
        """Fewer segments within a distance."""
        return self._c.simplified(tolerance, corner)

    @from_header("region/boolean:region_of")
    def region(self, tolerance: float, rule: str = "nonzero") -> Region:
        """What the path fills, as loops that do not cross."""
        return _core.region_of(self._c, rule, tolerance)

    @from_header("region/stroke:stroked")
    def stroke(self, width: float, tolerance: float, *, cap: str = "butt", join: str = "miter", miter_limit: float = 4.0,
               dashes: Sequence[float] = (), dash_offset: float = 0.0) -> Region:
        """The outline of a stroke."""
        return _core.stroked(self._c, width, cap, join, miter_limit, list(dashes), dash_offset, tolerance)

    @from_header("region/stroke:dashed")
    def dashed(self, dashes: Sequence[float], accuracy: float, dash_offset: float = 0.0) -> Path:
        return _core.dashed(self._c, list(dashes), dash_offset, accuracy)

    @from_header("region/stroke:OffsetStyle")
    def grow(self, distance: float, tolerance: float, *, rule: str = "nonzero", join: str = "round",
             miter_limit: float = 4.0) -> Region:
        """The region made larger (or smaller, where the distance is negative)."""
        return _core.grown(self._c, rule, distance, join, miter_limit, tolerance)

    @from_header("region/boolean:PathArea")
    def area(self) -> PathArea:
        """The integral of the winding number, with a bound."""
        return _core.signed_area(self._c)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Path) and self.subpaths == other.subpaths

    def __hash__(self) -> int:
        return hash(("Path", repr(self.subpaths)))

    def __repr__(self) -> str:
        if all(g.weight <= 1 for s in self.subpaths for g in s.segments) and Path(self.data) == self:
            return f"Path({self.data!r})"
        return f"Path.from_subpaths({self.subpaths!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return Path.from_subpaths, (self.subpaths,)

    def _repr_svg_(self) -> str | None:
        from ._files import Document
        curves = self.curves()
        return Document(curves).draw("svg", width=640, height=400).decode() if curves else None


@from_header("region/boolean:combine")
def combine(a: Path, b: Path, operation: str, tolerance: float, *, rules: tuple[str, str] = ("nonzero", "nonzero")) -> Region:
    """union, intersection, difference or exclusion of two regions."""
    return _core.combine(a._c, rules[0], b._c, rules[1], operation, tolerance)


def region_of(path: Path, tolerance: float, rule: str = "nonzero") -> Region:
    """As Path.region."""
    return path.region(tolerance, rule)


@from_header("io/svg:read_svg")
def read_svg_picture(svg: str | bytes) -> SvgPicture:
    """The shapes of a drawing in SVG with their styles."""
    return _core.read_svg_picture(svg)
