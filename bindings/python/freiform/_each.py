"""One question about many objects, on all threads."""
from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Callable, Iterable, TypeVar

from . import _core
from ._refusals import Refusal

if TYPE_CHECKING:
    from typing import Concatenate, ParamSpec
    Arguments = ParamSpec("Arguments")

T = TypeVar("T")
R = TypeVar("R")

__all__ = ["each"]


def each(question: Callable[Concatenate[T, Arguments], R], objects: Iterable[T], *args: Arguments.args,
         **kwargs: Arguments.kwargs) -> list[R]:
    """The answers to a question about each of many objects, in their order: ``each(ff.Curve.length, curves, 1e-9)``,
    ``each(ff.nearest, curves, points)``, ``each(ff.Surface.tessellate, surfaces, 0.01)``.

    The objects are asked on all threads (set_max_threads), since the library computes without the GIL. The refusal of the
    first object that has one is raised; its place begins with ``objects[i]``.
    """
    everything = list(objects)

    def ask(i: int) -> R:
        try:
            return question(everything[i], *args, **kwargs)
        except Refusal as why:
            place = f"objects[{i}]" + (f": {why.where}" if why.where else "")
            raise type(why)(place, why.message) from None

    threads = min(_core.max_threads() or os.cpu_count() or 1, len(everything))
    if threads <= 1:
        return [ask(i) for i in range(len(everything))]
    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(ask, range(len(everything))))
