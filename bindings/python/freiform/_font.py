"""Fonts: outlines of glyphs, text."""
from __future__ import annotations

import os
from typing import Any, Mapping, Sequence

from . import _core
from ._base import from_header
from ._paths import Path
from ._records import FontInfo, Glyph, Typeset
from ._refusals import UnavailableError

__all__ = ["Font"]


@from_header("font/font:Font")
class Font:
    """A font: ``Font("DejaVu Sans")`` of those installed, ``Font.read("file.ttf")``, ``Font.from_bytes(data)``."""

    __slots__ = ("_c", "_state", "_made")

    def __init__(self, family: str, axes: Mapping[str, float] | None = None) -> None:
        _available()
        file = _core.font_file(family)
        with open(file.path, "rb") as f:
            self._set(f.read(), file.face, axes, f"({family!r}, {dict(axes or {})!r})")

    def _set(self, data: bytes, face: int, axes: Mapping[str, float] | None, made: str = "") -> None:
        self._state = (data, face, dict(axes or {}))
        self._made = made  # how, where that is shorter than the bytes
        self._c: Any = _core.FontHandle(data, face, list(self._state[2].items()))

    @classmethod
    def from_bytes(cls, data: bytes, face: int = 0, axes: Mapping[str, float] | None = None) -> Font:
        _available()
        made = object.__new__(cls)
        made._set(data, face, axes)
        return made

    @classmethod
    def read(cls, path: str | os.PathLike[str], face: int = 0, axes: Mapping[str, float] | None = None) -> Font:
        with open(path, "rb") as f:
            made = cls.from_bytes(f.read(), face, axes)
        made._made = f".read({os.fspath(path)!r}, {face}, {made._state[2]!r})"
        return made

    @property
    def info(self) -> FontInfo:
        return self._c.info()  # type: ignore[no-any-return]

    @from_header("font/font:glyph")
    def glyph(self, index: int) -> Glyph:
        return self._c.glyph(index)  # type: ignore[no-any-return]

    def index_of(self, character: str) -> int:
        """The glyph of a character; 0: the font has none."""
        return self._c.index_of(character)  # type: ignore[no-any-return]

    def index_named(self, name: str) -> int | None:
        return self._c.index_named(name)  # type: ignore[no-any-return]

    @from_header("font/typeset:typeset", "font/typeset:Typeset")
    def typeset(self, text: str, size: float = 1.0, features: Sequence[str] = (), language: str = "und") -> Typeset:
        return self._c.typeset(text, size, list(features), language)  # type: ignore[no-any-return]

    @from_header("font/typeset:outlines")
    def outlines(self, text: str, size: float = 1.0, features: Sequence[str] = (), language: str = "und") -> list[Path]:
        """The outlines of a text, a path for each glyph."""
        return self._c.outlines(text, size, list(features), language)  # type: ignore[no-any-return]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Font) and self._state == other._state

    def __hash__(self) -> int:
        return hash((self._state[0], self._state[1], tuple(self._state[2].items())))

    def __repr__(self) -> str:
        """By name or file where it was made so: it is the same font as long as these are."""
        return f"Font{self._made or f'.from_bytes{self._state!r}'}"

    def __str__(self) -> str:
        info = self.info
        return f"<Font {info.family} {info.style}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Font._restored, (*self._state, self._made)

    @staticmethod
    def _restored(data: bytes, face: int, axes: Mapping[str, float], made: str) -> Font:
        font = Font.from_bytes(data, face, axes)
        font._made = made
        return font


def _available() -> None:
    if not _core.has_font:
        raise UnavailableError("font", "built without FreeType")
