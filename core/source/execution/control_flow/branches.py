"""Which branch is taken where a condition is not known, see `flow`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Generic

from ....errors import InputError, SourceError, Span
from ..course import Course
from .analysis import Analysis
from .steps import Block, Exit


@dataclass(frozen=True, slots=True)
class TakenBranch(Generic[Block]):
    """The branch that is taken.

    Args:
        block: None for nothing.
        skipped: branches that could have been taken as well.
        supposed: what depends on it, for messages; empty where the user says that it is taken.
    """

    block: Block | None
    skipped: tuple[Block, ...]
    supposed: str


@dataclass(frozen=True, slots=True)
class Skip(Generic[Block]):
    """A branch that was not taken, as its condition is not known.

    Args:
        number: of all branches that were not taken.
        routine: that it stands in, by its number.
        loop: the innermost that it stands in, by its number.
    """

    block: Block
    reason: str
    number: int
    routine: int
    loop: int


@dataclass(slots=True)
class ActiveBlocks:
    """Which routines and loops are under way.

    Attributes:
        routine, loop: the innermost, by their numbers; 0 for none.
        depth: how many routines.
    """

    routine: int = 0
    loop: int = 0
    depth: int = 0
    _numbers: int = 0

    def number(self) -> int:
        """Of a routine or loop that begins."""
        self._numbers += 1
        return self._numbers


class Branches(Generic[Block]):
    """Chooses branches, and remembers those that were not taken.

    Args:
        analysis: of the program's statements.
        course: has the user's answers, and remembers what was decided.
        nesting: of the run.

    Attributes:
        skips: how many branches were not taken.
    """

    def __init__(self, analysis: Analysis[Block], course: Course, nesting: ActiveBlocks) -> None:
        self._analysis = analysis
        self._course = course
        self.nesting = nesting
        self.skips = 0
        self._skipped: dict[int, Skip[Block]] = {}  # by the block's id, each with its last time

    def choose(
        self,
        span: Span,
        reason: str,
        blocks: Sequence[Block],
        otherwise: Block | None,
        possible: Sequence[bool] | None = None,
    ) -> TakenBranch[Block]:
        """The branch that is taken where a condition is not known.

        Args:
            span: of the condition.
            reason: what it depends on.
            blocks: the branches.
            otherwise: of ELSE; None if there is none.
            possible: for each branch, and for none of them, whether it is not ruled out; None if
                nothing is.

        Raises:
            SourceError: the user's answer names a branch that there is not.
        """
        may = [True] * (len(blocks) + 1) if possible is None else [*possible]
        written = [*blocks, *([] if otherwise is None else [otherwise])]
        try:
            answer = self._course.answered_branch(span, len(written))
        except InputError as error:
            raise SourceError(str(error), span) from None
        answered = answer is not None
        if answer is None:
            answer, why = self._rule(blocks, otherwise, may)
            self._course.decided(span, f"the condition depends on {reason}: {why}")
        self._course.branch(span, reason, answer, len(written), answered)
        chosen = otherwise if answer == 0 else written[answer - 1]
        skipped = tuple(
            block for block, able in zip(written, may, strict=False) if able and block is not chosen
        )
        for block in skipped:
            self.skips += 1
            nesting = self.nesting
            self._skipped[id(block)] = Skip(
                block, reason, self.skips, nesting.routine, nesting.loop
            )
        supposed = "" if answered else f"the branch at {span.file}:{span.line} ({reason})"
        return TakenBranch(chosen, skipped, supposed)

    def _rule(
        self, blocks: Sequence[Block], otherwise: Block | None, may: Sequence[bool]
    ) -> tuple[int, str]:
        """The number of the branch that is taken, 0 for none, and why."""
        ask = self._analysis
        written = [*blocks, *([] if otherwise is None else [otherwise])]
        ways = [
            (number, self._leads_to(block), ask.moves(block))
            for number, (block, able) in enumerate(zip(written, may, strict=False), 1)
            if able
        ]
        count = len(written)
        for number, leads, moves in ways:
            if leads is None and moves:
                return (
                    number,
                    f"branch {number} of {count}, the first that moves the robot, is taken",
                )
        for number, leads, _ in ways:
            if leads is None and ask.sent(written[number - 1]):
                return number, (
                    f"branch {number} of {count}, the first in which a computer moves the robot, "
                    "is taken"
                )
        if may[-1] and (otherwise is None or self._leads_to(otherwise) is None):
            away = next((number for number, leads, _ in ways if leads is not None), None)
            if away is None:
                return 0, "no branch that moves the robot: taken as not fulfilled"
            return 0, (
                f"branch {away} of {count} leads elsewhere: taken as not fulfilled, and other "
                "moves may be driven if it is"
            )
        for number, leads, _ in ways:
            if leads is None:
                return number, f"branch {number} of {count}, the first that comes back, is taken"
        number, _, _ = min(ways, key=lambda way: (way[1], not way[2], way[0]))
        return number, f"all lead elsewhere: branch {number} of {count} is taken"

    def _leads_to(self, block: Block) -> Exit | None:
        """Where a block leads; None if the program goes on behind it, or behind a call."""
        leads = self._analysis.leads_to(block)
        return None if leads is Exit.ROUTINE and self.nesting.depth > 1 else leads

    def open_in(self, body: Block, since: int) -> Iterator[Skip[Block]]:
        """Branches in a loop's body that were not taken since it began.

        Args:
            since: ``skips`` as it was then.
        """
        inside: frozenset[int] | None = None
        for skip in self._skipped.values():
            if skip.number > since:
                inside = inside or self._analysis.blocks_in(body)
                if id(skip.block) in inside:
                    yield skip
