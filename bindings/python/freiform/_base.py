"""Numbers, intervals, colours, and what all records have in common."""
from __future__ import annotations

import dataclasses
from typing import Any, Callable, Iterable, NamedTuple, Sequence, TypeVar, Union

import numpy as np
import numpy.typing as npt

from ._docs import DOCS

__all__ = ["Array", "ArrayLike", "Interval", "Bounded", "Colour", "Record"]

Array = npt.NDArray[Any]
ArrayLike = npt.ArrayLike
F = TypeVar("F", bound=Callable[..., Any])


class Interval(NamedTuple):
    """A closed interval of the real line."""

    lo: float
    hi: float

    @property
    def length(self) -> float:
        return self.hi - self.lo

    @property
    def middle(self) -> float:
        return self.lo + (self.hi - self.lo) / 2


class Bounded(NamedTuple):
    """A number and a bound of its error: |value - exact| <= bound."""

    value: float
    bound: float

    def __float__(self) -> float:
        return self.value


class Colour(NamedTuple):
    """A display colour: sRGB-encoded components and opacity, each in [0, 1]."""

    r: float
    g: float
    b: float
    a: float = 1.0


IntervalLike = Union[Interval, tuple[float, float], Sequence[float]]


def plain(x: object) -> object:
    """Arrays, also those in lists, as nested lists: for a repr that can be evaluated and has all digits."""
    if type(x) in (list, tuple):
        return type(x)(map(plain, x))  # type: ignore[call-overload]
    return x.tolist() if isinstance(x, np.ndarray) else x


def same(a: object, b: object) -> bool:
    """Equality where arrays count as equal if shapes and all numbers are."""
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return np.array_equal(np.asarray(a), np.asarray(b))
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    return bool(a == b)


class Record:
    """An answer with named fields. Records are compared by their fields; their repr can be evaluated."""

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Record) or type(self) is not type(other):
            return False
        return all(same(x, y) for x, y in zip(self._values(), other._values()))

    def __hash__(self) -> int:
        return hash((type(self).__name__, repr(self)))

    def __repr__(self) -> str:
        fields = dataclasses.fields(self)
        return f"{type(self).__name__}({', '.join(f'{f.name}={plain(getattr(self, f.name))!r}' for f in fields)})"

    def _values(self) -> Iterable[object]:
        return [getattr(self, f.name) for f in dataclasses.fields(self)]


def from_header(*keys: str) -> Callable[[F], F]:
    """Adds to a docstring what the headers say of these declarations ("make/revolve:revolve"); of what has no comment of
    its own, what the header says of itself."""

    def add(function: F) -> F:
        parts = [(function.__doc__ or "").rstrip()] + [DOCS.get(key) or DOCS[key.partition(":")[0] + ":"] for key in keys]
        function.__doc__ = "\n\n".join(p for p in parts if p)
        return function

    return add


def points_array(points: ArrayLike) -> Array:
    return np.ascontiguousarray(points, dtype=np.float64)


def vector(x: ArrayLike, size: int) -> Array:
    """The first coordinates, the others 0."""
    a = np.zeros(size)
    given = np.asarray(x, dtype=np.float64)
    a[: given.size] = given
    return a


def pair(on: IntervalLike) -> tuple[float, float]:
    lo, hi = on
    return float(lo), float(hi)
