"""What was waited for holds afterwards.

A wait is taken as satisfied at once. Where its condition is about the program's own data or outputs
(a flag that another task sets, an output that an interrupt resets), they have the values then that
satisfy it: those that it states, else values that are not known.

What an interrupt's routine writes is not known, as it may run at any time (`SharedDatum`): only
what the program has waited for is, until the program writes it anew.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

from .outputs import Outputs

Node = TypeVar("Node")
"""An expression of the language."""


class SharedDatum(Protocol):
    """A datum that something beside the program's course may write.

    Attributes:
        writer: what does, for messages: ``TRAP stop``; None if nothing does.
        awaited: whether the program has waited for its value, and not written it since.
    """

    writer: str | None
    awaited: bool


def is_open(datum: SharedDatum) -> bool:
    """Whether nobody knows a datum's value, as something beside the program writes it."""
    return datum.writer is not None and not datum.awaited


@dataclass(frozen=True, slots=True)
class ConditionParts(Generic[Node]):
    """What a condition is made of, as far as it tells what its data are.

    Args:
        all_of: parts that hold together: the operands of an AND.
        any_of: parts of which one holds: the operands of an OR.
        negated: what does not hold where the condition does.
        sides: two of which the condition says that they are equal, or are not.
        equal: which of the two it says.
        asks: whether it can only be evaluated once, as it calls what does something.
    """

    all_of: tuple[Node, ...] = ()
    any_of: tuple[Node, ...] = ()
    negated: Node | None = None
    sides: tuple[Node, Node] | None = None
    equal: bool = True
    asks: bool = False


@dataclass(frozen=True, slots=True)
class Supposing(Generic[Node]):
    """What the language supplies.

    Args:
        outputs: what the program has set its outputs to.
        parts: what a condition is made of.
        holds: whether it holds now; None if that is not known.
        equate: gives the datum or output that the first expression names the value of the second,
            or of a truth; False if it names none.
        forget: makes the data unknown that a condition names.
        data: those that a condition names.
    """

    outputs: Outputs
    parts: Callable[[Node], ConditionParts[Node]]
    holds: Callable[[Node], bool | None]
    equate: Callable[[Node, Node | bool], bool]
    forget: Callable[[Node], None]
    data: Callable[[Node], Iterable[SharedDatum]] = lambda _: ()

    def wait(self, condition: Node, truth: bool = True) -> None:
        """`suppose`; data that others write too are known afterwards if that tells their values."""
        shared = [datum for datum in self.data(condition) if is_open(datum)]
        for datum in shared:
            datum.awaited = True
        self.suppose(condition, truth)
        if shared and (self.parts(condition).asks or self.holds(condition) is not truth):
            for datum in shared:
                datum.awaited = False

    def suppose(self, condition: Node, truth: bool = True) -> None:
        """Give data the values with which a condition that does not hold does.

        Args:
            condition: that was waited for.
            truth: what it is afterwards.
        """
        parts = self.parts(condition)
        together: Collection[Node] = parts.all_of if truth else parts.any_of
        if parts.asks:
            # Those of its parts that hold in any case, and can be evaluated again, tell.
            for part in together:
                self.suppose(part, truth)
            if parts.negated is not None:
                self.suppose(parts.negated, not truth)
            return
        mark = self.outputs.mark()
        value = self.holds(condition)
        if value is truth or value is None:
            return
        asked = self.outputs.asked_since(mark)
        if parts.negated is not None:
            self.suppose(parts.negated, not truth)
        elif together:
            for part in together:
                self.suppose(part, truth)
        elif not self._stated(condition, parts, truth):
            self.outputs.forget(asked)
            self.forget(condition)

    def _stated(self, condition: Node, parts: ConditionParts[Node], truth: bool) -> bool:
        """Whether a condition states the value that a datum has: ``flag``, ``n = 1``."""
        if parts.sides is None:
            return self.equate(condition, truth)
        if parts.equal is not truth:
            return False
        first, second = parts.sides
        return self.equate(first, second) or self.equate(second, first)
