"""Numbers, intervals, colours, and what all records have in common."""
from __future__ import annotations

import base64
import dataclasses
import zlib
from typing import Any, Callable, Iterable, NamedTuple, Sequence, TypeVar, Union

import numpy as np
import numpy.typing as npt

from ._docs import DOCS
from ._refusals import InvalidError, UnreadableError

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
    if isinstance(x, list):
        return [plain(y) for y in x]
    if type(x) is tuple:
        return tuple(plain(y) for y in x)
    return x.tolist() if isinstance(x, np.ndarray) else x


def same(a: object, b: object) -> bool:
    """Equality where arrays count as equal if shapes and all numbers are."""
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return np.array_equal(np.asarray(a), np.asarray(b))
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    return bool(a == b)


def packed(data: bytes) -> str:
    """Bytes as a text without quotes, for a repr that can be evaluated."""
    return base64.b85encode(zlib.compress(data, 1)).decode()


def unpacked(text: str, where: str) -> bytes:
    """What was packed. What is no such text is refused."""
    try:
        return zlib.decompress(base64.b85decode(text))
    except (ValueError, zlib.error):
        raise UnreadableError(where, "is not what a repr holds") from None


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


def numbers(x: ArrayLike, where: str = "numbers") -> Array:
    """An array of doubles; arrays of doubles as they are. What holds no real numbers is refused."""
    if type(x) is np.ndarray and x.dtype == np.float64:
        return x
    if np.ma.is_masked(x):  # type: ignore[no-untyped-call]
        raise InvalidError(where, "has masked values")
    try:
        a = np.asarray(x)
        if a.dtype.kind in "biuf":
            return a.astype(np.float64)
        if a.dtype.kind == "O" and not any(v is None for v in a.flat):
            return a.astype(np.float64)
    except (TypeError, ValueError):
        raise InvalidError(where, "is no array of numbers: rows of different lengths, or something else among them") from None
    raise InvalidError(where, f"holds {a.dtype} and not real numbers" if a.dtype.kind != "O" else "holds None")


def points_array(points: ArrayLike, where: str = "points") -> Array:
    """Doubles in C order."""
    return np.ascontiguousarray(numbers(points, where))


def rows(points: ArrayLike, where: str = "points") -> Array:
    """Points, one in each row."""
    a = points_array(points, where)
    if a.ndim != 2:
        raise InvalidError(where, f"has the shape {a.shape}; points are an array (n, D), as numpy.c_[x, y] makes it")
    if not 1 <= a.shape[1] <= 4:
        raise InvalidError(where, f"has the shape {a.shape}: points have 1 to 4 coordinates"
                           + (", one point in each row: transpose it" if 1 <= a.shape[0] <= 4 else ""))
    return a


def indices(x: ArrayLike, where: str) -> Array:
    """int32 in C order; numbers that are none are refused."""
    a = numbers(x, where)
    if a.size and not (np.all(a == np.rint(a)) and np.all(np.abs(a) < 2**31)):
        raise InvalidError(where, "holds numbers that are no indices")
    return np.ascontiguousarray(a, dtype=np.int32)


def vector(x: ArrayLike, size: int) -> Array:
    """The first coordinates, the others 0."""
    a = np.zeros(size)
    given = numbers(x, "vector")
    if given.ndim != 1 or given.size > size:
        raise InvalidError("vector", f"has the shape {given.shape}; up to {size} coordinates are needed")
    a[: given.size] = given
    return a


def pair(on: IntervalLike) -> tuple[float, float]:
    ends = numbers(on, "interval")
    if ends.shape != (2,):
        raise InvalidError("interval", f"{on!r} is not a pair of numbers (lo, hi)")
    return float(ends[0]), float(ends[1])


def handles(objects: Iterable[Any], where: str) -> list[Any]:
    """What the library knows of objects of this package."""
    given = list(objects)
    for i, x in enumerate(given):
        if not hasattr(x, "_c"):
            raise InvalidError(f"{where}[{i}]", f"is of the type {type(x).__name__}, which is none of freiform's")
    return [x._c for x in given]
