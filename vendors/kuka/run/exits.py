"""How statements leave their block: exceptions that those catch who know where to go on."""

from __future__ import annotations

from ..syntax.tree import Goto
from ..values.values import Value


class Returned(Exception):
    """RETURN, with the value of a function."""

    def __init__(self, value: Value | None) -> None:
        self.value = value


class Jump(Exception):
    """GOTO a label that is not in the block."""

    def __init__(self, goto: Goto) -> None:
        self.goto = goto


class Left(Exception):
    """EXIT of the innermost loop."""


class Finished(Exception):
    """The end of the program."""
