"""Colours: maps, gradients, gradient meshes."""
from __future__ import annotations

from typing import Sequence, Union

from . import _core
from ._animate import _Made, _times
from ._base import Array, ArrayLike, Colour, Interval, from_header
from ._patches import Curve, Surface
from ._records import Box, ColourStop, Oklab

__all__ = ["ColourLike", "colour", "hex_of", "to_oklab", "oklab_distance", "colour_map", "Gradient", "MeshGradient"]

ColourLike = Union[Colour, str, Sequence[float]]


@from_header("colour/gradient:colour_named")
def colour(c: ColourLike) -> Colour:
    """A colour from "#rrggbb", or from three or four components."""
    if isinstance(c, str):
        named: Colour = _core.colour_named(c)
        return named
    return Colour(*map(float, c))


def _rgba(c: ColourLike) -> list[float]:
    return list(colour(c))


@from_header("colour/gradient:hex_of")
def hex_of(c: ColourLike) -> str:
    return _core.hex_of(_rgba(c))


@from_header("colour/colour_map:Oklab")
def to_oklab(c: ColourLike) -> Oklab:
    return _core.to_oklab(_rgba(c))


def oklab_distance(a: ColourLike, b: ColourLike) -> float:
    """How far apart two colours look."""
    return _core.oklab_distance(_rgba(a), _rgba(b))


@from_header("colour/colour_map:MapKind")
def colour_map(t: ArrayLike, kind: str = "sequential") -> Array:
    """Numbers in [0, 1] as colours: shape t.shape + (4,)."""
    return _core.colour_map(kind, _times(t))


@from_header("colour/gradient:Gradient", "colour/gradient:ColourSpace", "colour/gradient:GradientOptions")
class Gradient(_Made):
    """Colours along a parameter, mixed in srgb, linear, oklab or oklch; way: lines, smooth or near."""

    __slots__ = ("_c",)

    def __init__(self, stops: Sequence[tuple[float, ColourLike]], space: str = "oklab", way: str = "lines",
                 longer_hue: bool = False) -> None:
        all_stops = [(float(at), tuple(_rgba(c))) for at, c in stops]
        self._arguments = (all_stops, space, way, longer_hue)
        self._c = _core.GradientHandle(all_stops, space, way, longer_hue)

    def __call__(self, t: ArrayLike) -> Array:
        """Colours: shape t.shape + (4,)."""
        return self._c.evaluate(_times(t))

    @property
    def domain(self) -> Interval:
        return self._c.domain()

    def curve(self) -> Curve:
        """Coordinates and opacity over the domain."""
        return self._c.curve()

    def stops_in_srgb(self, tolerance: float) -> list[ColourStop]:
        return self._c.stops_in_srgb(tolerance)


@from_header("colour/mesh_gradient:MeshGradient")
class MeshGradient(_Made):
    """A plane surface with a colour at every control point."""

    __slots__ = ("_c",)

    def __init__(self, surface: Surface, colours: Sequence[ColourLike], space: str = "srgb") -> None:
        self._arguments = (surface, [tuple(_rgba(c)) for c in colours], space)
        self._c = _core.MeshGradientHandle(surface._c, self._arguments[1], space)

    def colour(self, u: float, v: float) -> Colour:
        return self._c.colour(u, v)

    @property
    def box(self) -> Box:
        return self._c.box()

    def picture(self, width: int) -> Array:
        """(height, width, 3) bytes."""
        return self._c.picture(width)
