"""Bases of one parameter: knots, and changes of basis as matrices."""
from __future__ import annotations

from typing import Any

import numpy as np

from . import _core
from ._base import Array, ArrayLike, Interval, IntervalLike, from_header, pair, points_array
from ._records import BasisChange, LocalHull, RealRoots
from ._refusals import InvalidError

__all__ = ["Basis", "PolynomialBasis", "change_basis", "convert_coefficients", "real_roots", "orient2d", "orient3d",
           "in_circle", "named_matrix", "kochanek_bartels_matrix"]


@from_header("basis/bspline:BSplineBasis")
class Basis:
    """B-splines of one degree. ``Basis(3, knots)``; closed: ``Basis.periodic(3, breaks)``."""

    __slots__ = ("_c",)
    _c: _core.BasisHandle

    def __init__(self, degree: int, knots: ArrayLike) -> None:
        self._c = _core.BasisHandle.make(degree, points_array(knots))

    @classmethod
    def _of(cls, handle: _core.BasisHandle) -> Basis:
        made = object.__new__(cls)
        made._c = handle
        return made

    @classmethod
    def periodic(cls, degree: int, breaks: ArrayLike) -> Basis:
        """Closed: of size + 1 breaks the first and the last are the same place."""
        return cls._of(_core.BasisHandle.periodic(degree, points_array(breaks)))

    @classmethod
    def clamped_uniform(cls, degree: int, size: int) -> Basis:
        """Knots 0, .., 0, 1, 2, .., n, .., n for so many functions."""
        return cls._of(_core.BasisHandle.clamped_uniform(degree, size))

    @property
    def degree(self) -> int:
        return self._c.degree

    @property
    def size(self) -> int:
        return self._c.size

    @property
    def is_closed(self) -> bool:
        return self._c.is_closed

    @property
    def knots(self) -> Array:
        """All knots; of a closed basis unwound by the degree on both sides."""
        return self._c.knots

    @property
    def defining(self) -> Array:
        """What the basis was made from: the knots, or the breaks of one period."""
        return self._c.defining

    @property
    def domain(self) -> Interval:
        return self._c.domain

    @property
    def breaks(self) -> Array:
        """The distinct knots inside the domain, both ends included."""
        return self._c.breaks

    @property
    @from_header("basis/greville:greville")
    def greville(self) -> Array:
        return self._c.greville

    def multiplicity(self, u: float) -> int:
        return self._c.multiplicity(u)

    def span(self, u: float) -> int:
        """The index s of the non-empty span with t_s <= u < t_{s+1}."""
        return self._c.span(u)

    def collocation(self, at: ArrayLike, derivative: int = 0) -> Array:
        """Row i: the values (or derivatives) of all functions at at[i]."""
        return self._c.collocation(np.atleast_1d(points_array(at)), derivative)

    @from_header("basis/blossom:blossom")
    def blossom(self, span: int, arguments: ArrayLike) -> Array:
        """The polar form of the polynomials of a span at as many arguments as the degree says: the weights of the
        coefficients span - degree .. span, of a closed basis modulo its size."""
        return self._c.blossom(span, np.atleast_1d(points_array(arguments)))

    @from_header("basis/change:insert_knots")
    def insert_knots(self, knots: ArrayLike) -> tuple[Basis, Array]:
        """The new basis and the matrix that takes coefficients to it."""
        return self._c.insert_knots(np.atleast_1d(points_array(knots)))

    @from_header("basis/subdivide:insert_knot")
    def insert_knot(self, u: float) -> tuple[Basis, Array]:
        return self._c.insert_knot(u)

    @from_header("basis/change:elevate")
    def elevate(self) -> tuple[Basis, Array]:
        return self._c.elevate()

    @from_header("basis/change:restrict_to")
    def restrict_to(self, on: IntervalLike) -> tuple[Basis, Array]:
        return self._c.restrict_to(pair(on))

    @from_header("basis/subdivide:extend_to")
    def extend_to(self, on: IntervalLike) -> tuple[Basis, Array]:
        return self._c.extend_to(pair(on))

    @from_header("basis/change:reverse")
    def reverse(self) -> tuple[Basis, Array]:
        return self._c.reverse()

    @from_header("basis/change:differentiate")
    def differentiate(self) -> tuple[Basis, Array]:
        return self._c.differentiate()

    @from_header("basis/change:to_bezier")
    def to_bezier(self) -> tuple[Basis, Array]:
        return self._c.to_bezier()

    @from_header("basis/subdivide:halve_uniform")
    def halve_uniform(self) -> tuple[Basis, Array]:
        return self._c.halve_uniform()

    def local_hulls(self) -> list[LocalHull]:
        """Parts of the domain with the coefficients whose hull contains the curve there."""
        return self._c.local_hulls()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Basis) and self._c.equals(other._c)

    def __hash__(self) -> int:
        return hash((self.degree, self.is_closed, self.defining.tobytes()))

    def __repr__(self) -> str:
        name = "Basis.periodic" if self.is_closed else "Basis"
        return f"{name}({self.degree}, {self.defining.tolist()!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return (Basis.periodic if self.is_closed else Basis), (self.degree, self.defining)


@from_header("basis/polynomial_basis:PolynomialBasis")
class PolynomialBasis:
    """The bases that polynomials are given in: monomial, bernstein, hermite, lagrange, newton, b_spline."""

    __slots__ = ("_c",)
    _c: _core.PolynomialBasisHandle

    def __init__(self, handle: _core.PolynomialBasisHandle) -> None:
        self._c = handle

    @classmethod
    def monomial(cls, degree: int, origin: float = 0.0) -> PolynomialBasis:
        """(t - origin)^n, .., 1: highest power first."""
        return cls(_core.PolynomialBasisHandle.monomial(degree, origin))

    @classmethod
    def bernstein(cls, degree: int, on: IntervalLike = (0.0, 1.0)) -> PolynomialBasis:
        """Bernstein polynomials on an interval."""
        return cls(_core.PolynomialBasisHandle.bernstein(degree, pair(on)))

    @classmethod
    def hermite(cls, degree: int, on: IntervalLike = (0.0, 1.0)) -> PolynomialBasis:
        """Odd degrees: value at lo, at hi, first derivative at lo, at hi, .."""
        return cls(_core.PolynomialBasisHandle.hermite(degree, pair(on)))

    @classmethod
    def lagrange(cls, nodes: ArrayLike) -> PolynomialBasis:
        """Coefficients are the values at the nodes."""
        return cls(_core.PolynomialBasisHandle.lagrange(points_array(nodes)))

    @classmethod
    def newton(cls, nodes: ArrayLike) -> PolynomialBasis:
        """1, t - x_0, (t - x_0)(t - x_1), .."""
        return cls(_core.PolynomialBasisHandle.newton(points_array(nodes)))

    @classmethod
    def uniform_b_spline(cls, degree: int) -> PolynomialBasis:
        """The degree + 1 functions on [0, 1] of knots at the whole numbers."""
        return cls(_core.PolynomialBasisHandle.uniform_b_spline(degree))

    @classmethod
    def b_spline(cls, basis: Basis, span: int) -> PolynomialBasis:
        """The functions of a basis on one of its spans."""
        return cls(_core.PolynomialBasisHandle.b_spline(basis._c, span))

    @property
    def scheme(self) -> str:
        return self._c.scheme

    @property
    def degree(self) -> int:
        return self._c.degree

    @property
    def numbers(self) -> Array:
        """The origin, the ends, the nodes or the knots, as the scheme has them."""
        return self._c.numbers

    def values(self, t: float) -> Array:
        """The functions at t."""
        return self._c.values(t)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, PolynomialBasis) and self._c.equals(other._c)

    def __hash__(self) -> int:
        return hash((self.scheme, self.degree, self.numbers.tobytes()))

    def _arguments(self) -> tuple[str, tuple[Any, ...]]:
        numbers, n = self.numbers.tolist(), self.degree
        if self.scheme == "monomial":
            return "monomial", (n, numbers[0])
        if self.scheme == "bernstein":
            return "bernstein", (n, (numbers[0], numbers[-1]))
        if self.scheme == "hermite":
            return "hermite", (n, (numbers[0], numbers[-1]))
        if self.scheme in ("lagrange", "newton"):
            return self.scheme, (numbers,)
        return "b_spline", (Basis(n, numbers), n)

    def __repr__(self) -> str:
        name, arguments = self._arguments()
        return f"PolynomialBasis.{name}({', '.join(map(repr, arguments))})"

    def __reduce__(self) -> tuple[Any, ...]:
        name, arguments = self._arguments()
        return getattr(PolynomialBasis, name), arguments


@from_header("basis/polynomial_basis:change_basis")
def change_basis(from_: PolynomialBasis, to: PolynomialBasis) -> BasisChange:
    """The matrix of a change of basis, with its condition and bounds."""
    return _core.change_basis(from_._c, to._c)


@from_header("basis/polynomial_basis:convert_coefficients")
def convert_coefficients(from_: PolynomialBasis, to: PolynomialBasis,
                         coefficients: ArrayLike) -> tuple[Array, Array, float]:
    """(coefficients, bounds of their errors, condition)."""
    return _core.convert_coefficients(from_._c, to._c, points_array(coefficients))


@from_header("poly/roots:real_roots")
def real_roots(coefficients: ArrayLike, width: float = 0.0, error: float = 0.0) -> RealRoots:
    """All roots in [0, 1] of the polynomial with these Bernstein coefficients, their number proven."""
    return _core.real_roots(points_array(coefficients), width, error)


@from_header("poly/predicates:orient2d")
def orient2d(a: ArrayLike, b: ArrayLike, c: ArrayLike) -> int:
    """The sign of the area of a triangle; exact."""
    return _core.orient2d(points_array(a), points_array(b), points_array(c))


@from_header("poly/predicates:orient3d")
def orient3d(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike) -> int:
    """On which side of a plane a point is; exact."""
    return _core.orient3d(points_array(a), points_array(b), points_array(c), points_array(d))


@from_header("poly/predicates:in_circle")
def in_circle(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike) -> int:
    """Whether a point is inside a circle; exact."""
    return _core.in_circle(points_array(a), points_array(b), points_array(c), points_array(d))


def named_matrix(name: str) -> Array:
    """The basis matrix M of Q = G M T: monomial, hermite, bezier, catmull-rom or uniform-b-spline."""
    matrix: Array | None = getattr(_core, f"matrix_{name}", None)
    if matrix is None:
        raise InvalidError("name", f"\"{name}\" is none of monomial, hermite, bezier, catmull-rom and uniform-b-spline")
    return matrix.copy()


def kochanek_bartels_matrix(at_p2: tuple[float, float, float], at_p3: tuple[float, float, float]) -> Array:
    """Tension, continuity and bias at the two inner points of (P1, P2, P3, P4)."""
    return _core.kochanek_bartels_matrix(at_p2, at_p3)
