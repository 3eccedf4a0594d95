"""Statements as the rules for branches and loops see them, whatever the language.

A language hands over its blocks as they are, and for each the `Step` of every statement in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Generic, Protocol, TypeVar

Block = TypeVar("Block")
"""What a language takes for a block of statements; told apart by identity."""

NOTHING: frozenset[str] = frozenset()
PLACE = "(where the robot stands)"
"""Among names of data: the robot's present position, which every move writes."""


class Exit(IntEnum):
    """Where a statement leads that does not go on with the next one, the nearest first."""

    PASS = 1
    """To the next pass of its loop: ``continue``."""
    LOOP = 2
    """Out of its loop: ``EXIT``, ``break``."""
    JUMP = 3
    """To a label."""
    ROUTINE = 4
    """Out of its routine: ``RETURN``."""
    PROGRAM = 5
    """To the end of the program: ``EXIT``, ``halt``."""


@dataclass(frozen=True, slots=True)
class Step(Generic[Block]):
    """One statement.

    Args:
        moves: it moves the robot itself, or nobody knows whether it does.
        sent: what a computer sends moves the robot while it runs, and is not at hand.
        reads: names of the data that its own expressions read; of a statement with blocks in it:
            its conditions.
        writes: names of the data that it may write itself, arguments by reference among them.
        sets: names of the settings that it changes for the moves behind it.
        made_of: names of the data that what it writes is made of.
        outputs: names of the outputs that it may write itself; None for any of them.
        calls: bodies of the program's routines that it calls.
        asks: whether routines of the program have a part in ``reads`` or ``made_of``.
        exit: where it leads, if not to the next statement.
        halts: whether the program stands there until an operator lets it go on: such a branch is
            for what went wrong, and is taken last.
        label: that a jump leads to.
        mark: a label that stands here.
        inner: the blocks in it.
        loop: whether they are run again and again.
        exhaustive: whether one of them is run whatever holds (an IF with ELSE).
    """

    moves: bool = False
    sent: bool = False
    reads: frozenset[str] = NOTHING
    writes: frozenset[str] = NOTHING
    sets: frozenset[str] = NOTHING
    made_of: frozenset[str] = NOTHING
    outputs: frozenset[str] | None = NOTHING
    calls: tuple[Block, ...] = ()
    asks: bool = False
    exit: Exit | None = None
    halts: bool = False
    label: str | None = None
    mark: str | None = None
    inner: tuple[Block, ...] = ()
    loop: bool = False
    exhaustive: bool = False


class Tree(Protocol[Block]):
    """The statements of a language."""

    def steps(self, block: Block) -> Sequence[Step[Block]]:
        """The statements of a block, in order."""
        ...

    def own(self, block: Block) -> frozenset[str]:
        """Names of the data that a routine keeps to itself, by its body; none of other blocks."""
        ...
