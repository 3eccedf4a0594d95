"""What can be had between fast and frugal: programs none of which is worse than another in both."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from ....core.arrays import FloatArray
from ....core.collision.proof.verdict import Certificate
from ....core.errors import Note
from ....core.motion.emulator.controller import Controller
from ....core.motion.emulator.run import Run
from ....core.motion.model.consumption import Consumption
from ....core.motion.timing.energy import energy_by_joint
from ....core.program.program import Program


@dataclass(frozen=True, eq=False)
class FrontPoint:
    """One program that was written, read back and, in a cell, proven.

    Args:
        program: as read back from its text.
        duration: cycle time, s.
        energy: of the consumption.
        by_joint: (N,), what each joint takes of it.
        certificate: of the program; None without a cell.
    """

    program: Program
    duration: float
    energy: float
    by_joint: FloatArray
    certificate: Certificate | None = None

    @property
    def proven(self) -> bool:
        """Whether nothing is left to prove: true without a cell."""
        return self.certificate is None or self.certificate.proven

    @classmethod
    def of(
        cls,
        controller: Controller,
        run: Run,
        consumption: Consumption,
        certificate: Certificate | None,
    ) -> FrontPoint:
        """The figures of a driven program."""
        made = controller.energy(run.program, run.timing, consumption)
        return cls(
            run.program,
            run.timing.duration,
            made.value,
            energy_by_joint(run.timing, made),
            certificate,
        )


@dataclass(frozen=True, eq=False)
class Front:
    """Programs by rising duration and falling energy.

    Args:
        given: the program that was given.
        points: the programs.
        unit: of the energies.
        notes: what was found on the way.
    """

    given: FrontPoint
    points: tuple[FrontPoint, ...]
    unit: str
    notes: tuple[Note, ...] = ()

    @property
    def proven(self) -> bool:
        """Whether there are programs, and each is proven to keep its clearance (in a cell)."""
        return bool(self.points) and all(point.proven for point in self.points)


def without_dominated(
    points: Iterable[FrontPoint], worth: float = 0.0, near: float = 0.0
) -> tuple[FrontPoint, ...]:
    """Those that no other is both as fast and as frugal as, fastest first.

    Args:
        points: to choose from.
        worth: share of the energy that a slower program must save to count.
        near: share of the time within which programs take equally long: of these the most frugal
            one is kept.
    """
    kept: list[FrontPoint] = []
    fastest = -math.inf
    for point in sorted(points, key=lambda p: (p.duration, p.energy)):
        if kept and kept[-1].energy - point.energy <= worth * abs(kept[-1].energy):
            continue
        if point.duration <= fastest * (1.0 + near):
            kept[-1] = point
        else:
            kept.append(point)
            fastest = point.duration
    return tuple(kept)
