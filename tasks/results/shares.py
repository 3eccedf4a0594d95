"""What the time of a cell's cycle goes into: motion, waits of the program, devices."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from ...core.display import counted
from ...core.program.move import Opaque, Wait
from ...core.program.program import Program


class DrivenMove(Protocol):
    """What is asked of a `MoveReport`."""

    @property
    def time(self) -> float:
        """s of motion."""

    @property
    def settling(self) -> float:
        """s behind it."""

    @property
    def fault(self) -> object:
        """Why it cannot be driven; None if it can."""


class Driven(Protocol):
    """What is asked of a `Report`."""

    @property
    def moves(self) -> Sequence[DrivenMove]:
        """One for each move of the program."""

    @property
    def parts(self) -> Sequence[tuple[int, int]]:
        """First and last move of what is driven without a gap, from 1."""


@dataclass(frozen=True, slots=True)
class CycleShares:
    """Of one cycle of the loop that production runs in; of the whole program where there is none.

    Args:
        motion: s of motion, with what joints take to settle.
        waiting: s that the program itself waits.
        devices: s that devices take, as the answers say.
        passes: that were read of the loop; 0 where there is none.
        line: of the loop; 0 where there is none.
        length: how many passes of it make the cycle.
        faults: of its moves, which take nobody knows how long.
    """

    motion: float
    waiting: float
    devices: float
    passes: int = 0
    line: int = 0
    length: int = 1
    faults: int = 0

    @property
    def total(self) -> float:
        """s."""
        return self.motion + self.waiting + self.devices

    def __str__(self) -> str:
        parts = {"motion": self.motion, "waits": self.waiting, "devices": self.devices}
        told = ", ".join(
            f"{name} {seconds:.3f} s ({100 * seconds / self.total:.0f} %)"
            for name, seconds in parts.items()
            if seconds
        )
        if not self.passes:
            return told
        which = "" if self.passes == self.length else f", the last of {self.passes}"
        if self.faults:
            which += f", but for {counted(self.faults, 'fault')}"
        what = "one pass" if self.length == 1 else f"{self.length} passes"
        time = "no cycle time" if self.faults else f"cycle time {self.total:.3f} s"
        return f"{time}, {what} of the loop at line {self.line}{which}: {told}"


def standing(program: Program, report: Driven) -> Iterator[tuple[Wait, int]]:
    """The waits that are driven, each with how many moves come before it.

    Behind a fault the robot waits only where it can stand.
    """
    done = 0
    for statement in program.statements:
        if isinstance(statement, Wait):
            if not report.parts or any(a - 1 <= done <= b for a, b in report.parts):
                yield statement, done
        elif not isinstance(statement, Opaque):
            done += 1


def shares(program: Program, report: Driven) -> CycleShares:
    """What the time of a run goes into."""
    cycle = program.cycle
    begin, end = (0, len(report.moves)) if cycle is None else (cycle.begin, cycle.end)
    # What stands behind the last move of a pass stands before the first one of the next, too.
    last = end - 1 if cycle is not None and cycle.passes > cycle.length else end
    waiting, devices = 0.0, 0.0
    for wait, done in standing(program, report):
        if begin <= done <= last:
            waiting += 0.0 if wait.device else wait.duration
            devices += wait.duration if wait.device else 0.0
    motion = sum(move.time + move.settling for move in report.moves[begin:end])
    faults = sum(move.fault is not None for move in report.moves[begin:end])
    if cycle is None:
        return CycleShares(motion, waiting, devices, faults=faults)
    line = cycle.span.line
    return CycleShares(motion, waiting, devices, cycle.passes, line, cycle.length, faults)
