"""freiform: curves and surfaces whose answers carry a bound that holds.

    import freiform as ff
    curve = ff.Curve([[0, 0], [1, 2], [3, 2], [4, 0]])
    curve([0, 0.5, 1])                       # points, an array (3, 2)
    ff.nearest(curve, [2, 3]).distance
"""
from __future__ import annotations

from typing import Sequence

from . import _core
from ._animate import *
from ._base import *
from ._basis import *
from ._colour import *
from ._each import *
from ._files import *
from ._fit import *
from ._font import *
from ._gpu import *
from ._make import *
from ._meshes import *
from ._models import *
from ._paths import *
from ._patches import *
from ._queries import *
from ._records import *
from ._refusals import *
from ._triangles import *
from ._version import __version__

from . import (_animate, _base, _basis, _colour, _each, _files, _fit, _font, _gpu, _make, _meshes, _models, _paths, _patches, _queries,
               _records, _refusals, _triangles)

__all__ = ["__version__", "set_max_threads", "max_threads", "instruction_set", "evaluate_grids"]
for _module in (_animate, _base, _basis, _colour, _each, _files, _fit, _font, _gpu, _make, _meshes, _models, _paths, _patches, _queries,
                _records, _refusals, _triangles):
    __all__ += _module.__all__


def set_max_threads(threads: int) -> None:
    """How many threads batches may use; 0: as many as the machine has. Results do not depend on it."""
    _core.set_max_threads(threads)


def max_threads() -> int:
    """What set_max_threads has set; 0: as many as the machine has."""
    return _core.max_threads()


def instruction_set() -> str:
    """What evaluates: base, neon, avx2 or avx512; FREIFORM_ISA chooses."""
    return _core.instruction_set()


@_base.from_header("spline/prepared:evaluate_grids")
def evaluate_grids(patches: Sequence[AnyPatch], *axes: ArrayLike) -> Array:
    """The same grid on many patches of one kind: an array (len(patches), .., D)."""
    handles = _base.handles(patches, "patches")
    return _core.evaluate_grids(handles, [_base.points_array(a) for a in axes])
