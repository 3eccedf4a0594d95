"""A program as far as it can be driven: parts without a gap, and the faults between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate

from ..display import counted, in_line
from ..errors import FaultCause, MotionError, Note, Span
from ..motion.command.trajectory import Trajectory, joined
from ..motion.emulator.run import Run
from ..program.move import Wait
from ..program.program import Program

_NAMED = 10
"""Faults that an error names; `flyby emulate` lists all."""


@dataclass(frozen=True, slots=True)
class Fault:
    """A move that cannot be driven.

    Args:
        move: its index in the program.
        cause: in one word.
        message: what is wrong, by how much, and what would cure it.
        span: where it stands in the source.
    """

    move: int
    cause: FaultCause
    message: str
    span: Span | None

    def __str__(self) -> str:
        return str(MotionError(self.message, self.move, self.span))


def refusal(faults: Sequence[Fault]) -> MotionError:
    """The error of a program with faults, where it can only be used as a whole.

    Args:
        faults: at least one; a line in a loop is named once, with its first.
    """
    lines: dict[Span | int, list[Fault]] = {}
    for fault in faults:
        lines.setdefault(fault.span or fault.move, []).append(fault)
    (first, *again), *others = lines.values()
    rest = [alike[0] for alike in others]
    message = first.message
    if again or rest:
        of_line = [f"{len(again)} in this line"] if again else []
        named = [_named(alike) for alike in others[:_NAMED]]
        more = [f"and {counted(len(rest) - _NAMED, 'more line')}"] if len(rest) > _NAMED else []
        message += f". {counted(len(faults) - 1, 'further move')} cannot be driven: "
        message += "; ".join([*of_line, *named, *more])
        other = next((fault for fault in rest if fault.cause is not first.cause), None)
        if other is not None:
            message += f". Move {other.move + 1}: {other.message}"
    return MotionError(message, first.move, first.span, first.cause)


def _named(alike: Sequence[Fault]) -> str:
    """The faults of a line in some words."""
    first = alike[0]
    line = "" if first.span is None else f", line {first.span.line}"
    times = f", {len(alike)} times" if len(alike) > 1 else ""
    return f"move {first.move + 1}{line} ({first.cause}{times})"


@dataclass(frozen=True, repr=False)
class DrivenPart:
    """Moves in a row that are driven without a gap.

    Args:
        first: index of the first of them in the whole program.
        run: of a program of these moves alone, whose indices count from there.
    """

    first: int
    run: Run

    def __repr__(self) -> str:
        count = len(self.run.program.moves)
        return in_line(
            f"Part: moves {self.first + 1} to {self.first + count}, {self.run.duration:.3f} s"
        )


@dataclass(frozen=True, repr=False)
class DrivenProgram:
    """What came of driving a program past all moves that cannot be driven.

    Behind a fault the robot stands where the move should have ended, or, where it cannot stand
    there, at the next target; no time is claimed for how it came there.

    Args:
        program: what was driven.
        parts: in their order; one of all moves where nothing is at fault, none of a program that
            moves nothing.
        faults: in the order of moves.
    """

    program: Program
    parts: tuple[DrivenPart, ...]
    faults: tuple[Fault, ...]

    @classmethod
    def faultless(cls, run: Run) -> DrivenProgram:
        """A program of which every move was driven."""
        return cls(run.program, (DrivenPart(0, run),), ())

    def __repr__(self) -> str:
        told = [f"{self.duration:.3f} s", counted(self.program.moves, "move")]
        if self.faults:
            told.append(counted(self.faults, "fault"))
        return in_line(f"Program {self.program.name}, driven: {', '.join(told)}")

    @property
    def duration(self) -> float:
        """s, of all parts together; of a program that moves nothing, of its waits."""
        if not self.parts:
            return sum(s.duration for s in self.program.statements if isinstance(s, Wait))
        return sum(part.run.duration for part in self.parts)

    def refuse_standing(self) -> None:
        """Refuse what only a motion has: a trajectory, a picture.

        Raises:
            MotionError: the program moves nothing.
        """
        if not self.parts:
            raise MotionError(
                f"program {self.program.name!r} moves nothing: there is no trajectory"
            )

    @property
    def begins(self) -> tuple[float, ...]:
        """s, when each part begins on the clock of all."""
        lengths = [part.run.duration for part in self.parts]
        return tuple(accumulate(lengths, initial=0.0))[:-1]

    @cached_property
    def trajectory(self) -> Trajectory:
        """All parts, one after the other; the clock stands still across gaps.

        Raises:
            MotionError: the program moves nothing.
        """
        self.refuse_standing()
        return joined([part.run.trajectory for part in self.parts], [p.first for p in self.parts])

    @cached_property
    def notes(self) -> tuple[Note, ...]:
        """The program's own and all that was found on the way, each with its place in the source.

        Faults are no notes.
        """
        moves, found = self.program.moves, list(self.program.notes)
        for part in self.parts:
            for note in part.run.notes:
                move = None if note.move is None else part.first + note.move
                found.append(Note(note.message, move, note.span))
        spans = [
            moves[note.move].statement if note.span is None and note.move is not None else note.span
            for note in found
        ]
        placed = zip(found, spans, strict=True)
        return tuple(dict.fromkeys(Note(note.message, note.move, span) for note, span in placed))
