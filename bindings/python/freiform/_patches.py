"""Curves, surfaces and volumes, as the other modules see them."""
from typing import Union

from ._curves import ArcLength, Curve, Derivative, Implicit
from ._surfaces import Surface, Volume

__all__ = ["Curve", "Surface", "Volume", "Derivative", "ArcLength", "Implicit", "AnyPatch"]

AnyPatch = Union[Curve, Surface, Volume]
