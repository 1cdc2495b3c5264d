"""Animation: easings, key frames, rotations, motions along curves."""
from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any, Iterable, Sequence

import numpy as np

from . import _core
from ._base import Array, ArrayLike, Interval, Record, from_header, points_array
from ._patches import Curve
from ._records import GltfAnimation, Measure, MotionState, Quaternion, TrajectoryState

__all__ = ["CubicBezierEasing", "step_easing", "Key", "Track", "RotationTrack", "Motion", "Trajectory", "slerp",
           "turn_about", "rotated", "angle_between", "read_gltf_animations", "to_animated_glb"]

Quaternion4 = tuple[float, float, float, float]


def _times(x: ArrayLike) -> Array:
    return np.ascontiguousarray(x, dtype=np.float64).reshape(np.shape(x))


class _Made:
    """Equality, hash, repr and pickle by the arguments that made an object."""

    __slots__ = ("_arguments",)
    _arguments: tuple[Any, ...]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and repr(self) == repr(other)

    def __hash__(self) -> int:
        return hash(repr(self))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(map(repr, self._arguments))})"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._arguments


@from_header("animate/easing:CubicBezierEasing")
class CubicBezierEasing(_Made):
    """cubic-bezier(x1, y1, x2, y2) of CSS; or by name: ``CubicBezierEasing("ease-in")``."""

    __slots__ = ("_c",)

    def __init__(self, x1: float | str, y1: float = 0.0, x2: float = 1.0, y2: float = 1.0) -> None:
        if isinstance(x1, str):
            self._c, self._arguments = _core.EasingHandle.named(x1), (x1,)
        else:
            self._c, self._arguments = _core.EasingHandle.make(x1, y1, x2, y2), (x1, y1, x2, y2)

    @property
    def handles(self) -> Quaternion4:
        x1, y1, x2, y2 = self._c.handles
        return x1, y1, x2, y2

    def __call__(self, x: ArrayLike) -> Array:
        return self.evaluate(x)[0]

    def evaluate(self, x: ArrayLike) -> tuple[Array, Array]:
        """(values, bounds)."""
        values, bounds = self._c.evaluate(_times(x))
        return values, bounds


@from_header("animate/easing:step_easing")
def step_easing(x: ArrayLike, count: int, jump: str = "end") -> Array:
    """steps(count, jump) of CSS: start, end, neither or both."""
    return _core.step_easing(_times(x), count, jump)


@dataclass(frozen=True, eq=False, repr=False)
@from_header("animate/keys:Between")
class Key(Record):
    """A value at a time, and what happens until the next key: step, linear, hermite, bezier or eased."""

    time: float
    value: Any
    next: str = "linear"
    arriving: Any = None
    leaving: Any = None
    before: tuple[float, Any] | None = None
    after: tuple[float, Any] | None = None
    easing: Quaternion4 | None = None


@from_header("animate/keys:Track", "animate/keys:BeyondKeys")
class Track(_Made):
    """Key frames as a function of time; outside: hold, repeat or mirror. tangents=True: hermite between all keys, with
    the tangents of Catmull and Rom."""

    __slots__ = ("_c",)

    def __init__(self, keys: Sequence[Key], outside: str = "hold", tangents: bool = False) -> None:
        def array(x: Any) -> Any:
            return None if x is None else np.atleast_1d(points_array(x))

        def handle(h: tuple[float, Any] | None) -> Any:
            return None if h is None else (h[0], array(h[1]))

        self._arguments = (list(keys), outside, tangents)
        self._c = _core.TrackHandle([(k.time, array(k.value), k.next, array(k.arriving), array(k.leaving),
                                      handle(k.before), handle(k.after), k.easing) for k in keys], outside, tangents)

    @property
    def times(self) -> Interval:
        return self._c.times()

    def __call__(self, times: ArrayLike) -> Array:
        return self.evaluate(times)[0]

    def evaluate(self, times: ArrayLike) -> tuple[Array, Array]:
        """(values, bounds)."""
        return self._c.evaluate(_times(times))

    def curve(self) -> Curve:
        """The same as a spline over time."""
        return self._c.curve()


@from_header("animate/rotation:RotationTrack")
class RotationTrack(_Made):
    """A curve of rotations, quaternions (x, y, z, w) at times: step, slerp, squad or spline."""

    __slots__ = ("_c",)

    def __init__(self, times: Sequence[float], keys: Sequence[Quaternion4], kind: str = "slerp") -> None:
        self._arguments = ([float(t) for t in times], [tuple(float(x) for x in k) for k in keys], kind)
        self._c = _core.RotationTrackHandle(*self._arguments)

    @property
    def times(self) -> Interval:
        return self._c.times()

    def __call__(self, times: ArrayLike) -> Array:
        """Quaternions: shape times.shape + (4,)."""
        return self._c.evaluate(_times(times))


def _q(q: Sequence[float] | Quaternion) -> list[float]:
    return [q.x, q.y, q.z, q.w] if isinstance(q, Quaternion) else [float(x) for x in q]


@from_header("animate/rotation:slerp")
def slerp(a: Sequence[float] | Quaternion, b: Sequence[float] | Quaternion, t: float) -> Quaternion4:
    return _core.slerp(_q(a), _q(b), t)


@from_header("animate/rotation:turn_about")
def turn_about(axis: ArrayLike, angle: float) -> Quaternion4:
    return _core.turn_about(points_array(axis), angle)


@from_header("animate/rotation:rotated")
def rotated(q: Sequence[float] | Quaternion, v: ArrayLike) -> Array:
    return _core.rotated(_q(q), points_array(v))


@from_header("animate/rotation:angle_between")
def angle_between(a: Sequence[float] | Quaternion, b: Sequence[float] | Quaternion) -> float:
    return _core.angle_between(_q(a), _q(b))


@from_header("animate/motion:Motion")
class Motion(_Made):
    """The distance that was covered at a time: ``Motion.uniform``, ``Motion.limited``, ``Motion.with_speed``,
    ``Motion.along``."""

    __slots__ = ("_c",)

    def __init__(self, how: str, *arguments: Any) -> None:
        self._arguments = (how, *arguments)
        if how == "uniform":
            self._c = _core.MotionHandle.uniform(*arguments)
        elif how == "limited":
            self._c = _core.MotionHandle.limited(*arguments)
        elif how == "along":
            self._c = _core.MotionHandle.along(arguments[0]._c, *arguments[1:])
        else:
            self._c = _core.MotionHandle.with_speed(arguments[0]._c, arguments[1])

    @staticmethod
    def uniform(length: float, duration: float) -> Motion:
        """At constant speed."""
        return Motion("uniform", length, duration)

    @staticmethod
    @from_header("animate/motion:limited")
    def limited(length: float, speed: float, acceleration: float = inf, jerk: float = inf) -> Motion:
        """The fastest motion from rest to rest within limits."""
        return Motion("limited", length, speed, acceleration, jerk)

    @staticmethod
    @from_header("animate/motion:with_speed")
    def with_speed(speed: Curve, accuracy: float) -> Motion:
        """With the speed v(s) where s has been covered."""
        return Motion("with_speed", speed, accuracy)

    @staticmethod
    @from_header("animate/motion:along", "animate/motion:BendLimits")
    def along(curve: Curve, accuracy: float, *, speed: float = inf, acceleration: float = inf,
              across: float = inf, jerk: float = inf) -> Motion:
        """From rest to rest along a curve, slow where it bends; without a limit of the jerk the fastest way."""
        return Motion("along", curve, speed, acceleration, across, jerk, accuracy)

    @property
    def duration(self) -> float:
        return self._c.duration

    @property
    def length(self) -> float:
        return self._c.length

    def __call__(self, time: float) -> MotionState:
        return self._c.at(time)


@from_header("animate/motion:Trajectory", "animate/motion:TrajectoryOptions")
class Trajectory(_Made):
    """A body that moves along a curve; facing: fixed, least_turning or upright."""

    __slots__ = ("_c",)

    def __init__(self, curve: Curve, motion: Motion, accuracy: float, facing: str = "fixed",
                 up: Sequence[float] = (0.0, 0.0, 1.0), facing_accuracy: float = 1e-6) -> None:
        self._arguments = (curve, motion, accuracy, facing, tuple(map(float, up)), facing_accuracy)
        self._c = _core.TrajectoryHandle(curve._c, motion._c, accuracy, facing, points_array(up), facing_accuracy)

    @property
    def duration(self) -> float:
        return self._c.duration

    def length(self) -> Measure:
        return self._c.length()

    def __call__(self, time: float) -> TrajectoryState:
        return self._c.at(time)


@from_header("io/gltf_animation:read_gltf_animations")
def read_gltf_animations(data: bytes, folder: str = "") -> list[GltfAnimation]:
    """The animations of a .glb or .gltf file."""
    return _core.read_gltf_animations(data, folder)


@from_header("io/gltf_animation:to_animated_glb", "io/gltf_animation:GltfMotion")
def to_animated_glb(times: ArrayLike, places: ArrayLike, velocities: ArrayLike,
                    facing: Iterable[Sequence[float] | Quaternion] = (), line: ArrayLike = (), *, name: str = "body",
                    size: float = 1.0) -> bytes:
    """The bytes of a .glb file: a body that is at places (n, 3) at times, moving at velocities (n, 3), turned by
    quaternions (n, 4), and a line (m, 3)."""
    def tuples(x: ArrayLike, width: int) -> Array:
        a = points_array(x)
        return a if a.size else a.reshape(0, width)

    return _core.to_animated_glb(np.atleast_1d(points_array(times)), tuples(places, 3), tuples(velocities, 3),
                                 tuples([_q(q) for q in facing], 4), tuples(line, 3), name, size)
