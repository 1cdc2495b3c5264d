"""Refusals: one exception class for each kind, with the place and the sentence of the library."""
from __future__ import annotations

from typing import Any

__all__ = ["Refusal", "InvalidError", "NonFiniteError", "OutOfDomainError", "UnreadableError", "UnsupportedError",
           "UnavailableError", "LimitError", "NotConvergedError", "IllConditionedError", "NoAnswerError", "IoError"]


class Refusal(Exception):
    """What the library answers where there is no honest answer: ``kind``, ``where`` and ``message``."""

    kind: str = "refusal"

    def __init__(self, where: str, message: str) -> None:
        super().__init__(where, message)
        self.where = where
        self.message = message

    def __str__(self) -> str:
        return f"{self.where}: {self.message}" if self.where else self.message

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self.args == getattr(other, "args", None)

    def __hash__(self) -> int:
        return hash((self.kind, self.args))

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.where, self.message)


class InvalidError(Refusal, ValueError):
    """The data contradict themselves: counts that disagree, knots that decrease, zero weights."""

    kind = "invalid"


class NonFiniteError(Refusal, ValueError):
    """NaN or infinity where a number is needed."""

    kind = "nonfinite"


class OutOfDomainError(Refusal, ValueError):
    """A parameter outside the domain of the object."""

    kind = "out_of_domain"


class UnreadableError(Refusal, ValueError):
    """A file is not of the format that it claims to be, or damaged."""

    kind = "unreadable"


class UnsupportedError(Refusal, ValueError):
    """Well-formed, but outside what this version handles."""

    kind = "unsupported"


class UnavailableError(Refusal, RuntimeError):
    """An optional component was not built or not found."""

    kind = "unavailable"


class LimitError(Refusal, RuntimeError):
    """A limit on size, time or memory was reached; the message names the number needed."""

    kind = "limit"


class NotConvergedError(Refusal, ArithmeticError):
    """An iteration ended at its backstop."""

    kind = "not_converged"


class IllConditionedError(Refusal, ArithmeticError):
    """There is no honest answer in double precision."""

    kind = "ill_conditioned"


class NoAnswerError(Refusal, ValueError):
    """The question is well-formed and has no answer."""

    kind = "no_answer"


class IoError(Refusal, OSError):
    """Reading or writing failed."""

    kind = "io"

    def __init__(self, where: str, message: str) -> None:
        Refusal.__init__(self, where, message)

    def __str__(self) -> str:
        return Refusal.__str__(self)


_KINDS: dict[str, type[Refusal]] = {c.kind: c for c in Refusal.__subclasses__()}


def refusal_of(kind: str, where: str, message: str) -> Refusal:
    return _KINDS[kind](where, message)
