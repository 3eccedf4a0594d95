"""Outputs that others wait for, set as early as is proven: their statements move up in the text.

A statement moves before a move that is driven earlier, line and all; the program is read again, and
taken if it is proven beside the others as well as before, and the station ends earlier. Places
between moves are all that is tried: triggers on the way would be earlier still. It moves past
statements that are carried out, and nothing else: past the word of a block, it would be carried out
on another condition, or another number of times. An output may also say that something has been
done, which no proof knows of: those that only give space free are named.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from ....core.collision.proof.certificate import SceneOf
from ....core.collision.proof.verdict import Certificate
from ....core.errors import FlybyError
from ....core.motion.emulator.run import Run
from ....core.program.move import Move, Opaque
from ....core.program.program import Program
from ....core.program.signal import SetSignal
from ....core.program.target import JointTarget
from ....core.source.patch.edits import reading_of
from ....core.source.reading import Files
from ....core.station.actions import Action
from ....core.station.station import signal_key
from ..solve_round_verify import ProgramFeasibility
from .feasibility import StationFeasibility

_MOST = 8
"""Moves by which a statement moves up, at most."""
_WORTH = 1e-3
"""s that the station must end earlier."""


@dataclass(frozen=True)
class EarlierReleases:
    """How one robot's outputs come earlier.

    Args:
        feasibility: of the station.
        name: of the robot.
        scenes: its cell with each tool.
        start: where the robot stands; None for the program's own start.
        reread: the program as it is read from its files with others of these texts.
        outputs: keys of the outputs that may come earlier: they only give space free.
        quiet: blanks out what is comment in a text of the program's language.
    """

    feasibility: StationFeasibility
    name: str
    scenes: SceneOf
    start: JointTarget | None
    reread: Callable[[Program, Files], Program]
    outputs: frozenset[str]
    quiet: Callable[[str], str]

    def run(self) -> Iterator[tuple[Run, Certificate, Files]]:
        """Programs that were taken over, one after the other, with the files that changed."""
        done = 0
        while True:
            actions = self._own()
            if done >= len(actions):
                return
            found = self._earlier(actions[done], self._first(actions[done]))
            done += 1
            if found is not None:
                yield found

    def _own(self) -> list[Action]:
        """Outputs that others wait for, set by statements of their own."""
        return [
            action
            for action in self.feasibility.state.ordered[self.name]
            if isinstance(action.does, SetSignal)
            and action.span is not None
            and signal_key(f"{self.name}.{action.does.name}") in self.outputs
        ]

    def _first(self, action: Action) -> int:
        """The first move that the action may stand before."""
        before = [
            other.move
            for other in self.feasibility.state.ordered[self.name]
            if other.time <= action.time and other is not action
        ]
        return max([-1, *before]) + 1

    def _earlier(self, action: Action, first: int) -> tuple[Run, Certificate, Files] | None:
        """With an action before the earliest move at which that is proven."""
        member = self.feasibility.state.station.members[self.name]
        held = ProgramFeasibility(
            member.controller,
            self.scenes,
            member.cell.clearance,
            start=self.start,
            beside=self.feasibility.beside(self.name),
        )
        for index in range(max(first, action.move - _MOST), action.move + 1):
            made = self._moved(member.program, action, index)
            if made is None:
                continue
            program, files = made
            try:
                run = member.controller.run(member.carrying(program), self.start)
            except FlybyError:
                continue
            if self.feasibility.duration_with(self.name, run) > (
                self.feasibility.state.duration - _WORTH
            ):
                return None  # Later ones gain even less.
            certificate = held.certificate(run)
            if (
                certificate is not None
                and certificate.proven
                and self.feasibility.take(self.name, run)
            ):
                return run, certificate, files
        return None

    def _moved(self, program: Program, action: Action, index: int) -> tuple[Program, Files] | None:
        """The program with an action's line before that of a move; None where that is another."""
        span, place = action.span, program.moves[index].statement
        assert span is not None
        if place is None or place.file != span.file or place.start >= span.start:
            return None
        file = reading_of(program).files[span.file]
        begin, end = _line(file.text, span.start, span.end)
        at, _ = _line(file.text, place.start, place.start)
        line = file.text[begin:end]
        alone = file.text[begin : span.start] + self.quiet(file.text[span.end : end])
        if not line.endswith("\n") or alone.replace(";", "").strip():
            return None
        if self._left(program, span.file, file.text, at, end):
            return None
        changed = {span.file: file.edited([(at, at, line), (begin, end, "")])}
        try:
            read = self.reread(program, changed)
        except FlybyError:
            return None
        return (read, changed) if _same(program, read) else None

    def _left(self, program: Program, file: str, text: str, begin: int, end: int) -> str:
        """What a stretch of a text holds beside comments and statements that are carried out."""
        left = self.quiet(text[begin:end])
        for statement in program.statements:
            span = statement.statement if isinstance(statement, Move) else statement.span
            if span is not None and span.file == file and begin <= span.start <= span.end <= end:
                first, last = span.start - begin, span.end - begin
                left = left[:first] + " " * (last - first) + left[last:]
        return left.replace(";", "").strip()


def _line(text: str, begin: int, end: int) -> tuple[int, int]:
    """Offsets of the lines that a stretch of text is on, their end included."""
    first = text.rfind("\n", 0, begin) + 1
    last = text.find("\n", end)
    return first, len(text) if last < 0 else last + 1


def _same(one: Program, other: Program) -> bool:
    """Whether two programs are the same but for the order of their statements."""
    if [m.target for m in one.moves] != [m.target for m in other.moves]:
        return False
    texts = [
        sorted(s.text for s in program.statements if isinstance(s, Opaque))
        for program in (one, other)
    ]
    return texts[0] == texts[1]
