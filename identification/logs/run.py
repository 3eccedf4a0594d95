"""One run of a robot, as it was logged."""

from __future__ import annotations

from dataclasses import dataclass

from ...core.arrays import FloatArray
from ...core.program.program import Program


@dataclass(frozen=True, eq=False)
class LoggedRun:
    """One run.

    Args:
        name: of the file.
        robot: name in the catalogues.
        real: whether a robot moved, not a virtual controller; None if nobody said.
        program: that it drove.
        t: (T,) s, increasing.
        q: (T, N), joints in rad, linear axes in m.
        notes: what the record says of its own uncertainties, and what the reader left out.
        source: whose clock stamped the log; runs of one source share it.
        timed: whether the program's speeds are those that were driven; where they were guessed
            afterwards, the log shows the path and not its timing.
        zones_known: whether the program's zones are; where they were inferred from the log, it
            shows the form of corners and not their size.
    """

    name: str
    robot: str
    real: bool | None
    program: Program
    t: FloatArray
    q: FloatArray
    notes: tuple[str, ...] = ()
    source: str = ""
    timed: bool = True
    zones_known: bool = True
