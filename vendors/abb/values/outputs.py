"""Outputs: what the program has set them to is known to it afterwards.

Signals are taken as apart from each other: which of them are cross-connected, or bits of a group,
is in the controller's configuration.
"""

from __future__ import annotations

from typing import Protocol

from ....core.source.execution.outputs import Outputs
from ....core.source.text.lexer import words
from ..syntax.tree import Expression
from .scope import Scope
from .types import Value

READING = words("doutput aoutput goutput goutputdnum")
"""Functions that give what an output holds."""
WRITING = words("set reset setdo setao setgo pulsedo invertdo wzdoset")
"""Instructions that write an output, their first required argument but for ``WZDOSet``."""


class Signals(Protocol):
    """Knows which signal an expression means."""

    outputs: Outputs

    def signal(self, expression: Expression | None, scope: Scope) -> str | None:
        """See `Evaluator.signal`."""


def write(evaluator: Signals, signal: Expression, value: Value | None, scope: Scope) -> None:
    """An output gets a value; None for one that is not certain."""
    name = evaluator.signal(signal, scope)
    if name is None:
        evaluator.outputs.forget()  # it may be any of them
    else:
        evaluator.outputs.write(name, value if isinstance(value, float) else None)


def held(evaluator: Signals, signal: Expression, scope: Scope) -> float | None:
    """What the program has set an output to; None if that is not known."""
    name = evaluator.signal(signal, scope)
    return None if name is None else evaluator.outputs.value(name)
