"""Values with the places that they were read from, and who carries out what an expression calls."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from ....core.errors import Span
from ..syntax.tree import Call, MethodCall, Run
from .provenance import Sources
from .scope import Scope
from .values import Solution, Value


@dataclass(frozen=True, slots=True)
class Located:
    """A value together with the places of the text that it was read from.

    Args:
        name: of the variable, if it holds what stands in the text.
    """

    value: Value
    sources: Sources = ()
    name: str | None = None


NOTHING = Located(None)
"""What a call returns that returns nothing."""


class Host(Protocol):
    """Who carries out what an expression calls."""

    def call(self, call: Call, scope: Scope) -> Located:
        """The value of a function."""
        ...

    def method(self, call: MethodCall, scope: Scope) -> Value:
        """The value of a method."""
        ...

    def start_thread(self, run: Run, scope: Scope) -> Value:
        """Start a thread; its handle."""
        ...

    def joints(self, solution: Solution) -> Value:
        """The numbers of an inverse-kinematics solution."""
        ...

    def work(self, amount: int, span: Span) -> None:
        """Count what copying a list of so many elements costs."""
        ...
