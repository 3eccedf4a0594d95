"""How every improvement of a program is found: solve, round, write and read back, verify.

What is verified is the program that a controller reads: driven by the emulator, and proven to keep
its clearance. Where that fails, the improvement says what is tried next (smaller zones, a wider
margin, a part put back), until a program holds or none is left.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from ...core.collision.proof.certificate import SceneOf, certify
from ...core.collision.proof.verdict import Certificate
from ...core.errors import MotionError
from ...core.motion.emulator.controller import Controller
from ...core.motion.emulator.run import Run
from ...core.program.program import Program
from ...core.program.target import JointTarget
from .start_check import check_start

Beside = Callable[[Run], Certificate | None]
"""Of a driven program that keeps clear of its own cell: why it must not run beside the programs of
other robots; None if it may."""
RESOLUTION = 1e-5
"""m to which the clearance that there is is proven, for the table before and after."""


@dataclass(frozen=True)
class ProgramFeasibility:
    """What a program has to stand: it can be driven, and keeps its clearance.

    Args:
        controller: drives it.
        scenes: the cell with each tool; None without a cell, and then nothing is proven.
        clearance: m to keep.
        residual: m by which the real robot may deviate from the emulated one.
        start: where the robot stands; None for the program's own start.
        resolution: m to which the clearance that there is is proven; None to prove just the one
            to keep, which is quicker.
        beside: what other robots say of it; None where there are none.
    """

    controller: Controller
    scenes: SceneOf | None
    clearance: float
    residual: float = 0.0
    start: JointTarget | None = None
    resolution: float | None = RESOLUTION
    beside: Beside | None = None

    def given(self, program: Program) -> tuple[Run, Certificate | None]:
        """The program that is to be improved, driven and proven.

        Raises:
            MotionError: it cannot be driven, collides, or keeps less clearance than is wanted.
        """
        run = self.controller.run(program, self.start)
        certificate = self.certificate(run)
        if self.scenes is not None and certificate is not None:
            check_start(self.controller, run, self.scenes, certificate, self.residual)
        return run, certificate

    def verified(self, program: Program) -> tuple[Run | None, Certificate | None]:
        """The program driven and proven; (None, None) if it cannot be driven."""
        try:
            run = self.controller.run(program, self.start)
        except MotionError:
            return None, None
        return run, self.certificate(run)

    def certificate(self, run: Run) -> Certificate | None:
        """Of a driven program; None without a cell."""
        if self.scenes is None:
            return None
        made = certify(
            self.controller,
            run,
            self.scenes,
            self.clearance,
            self.residual,
            resolution=self.resolution,
        )
        if self.beside is None or not made.proven:
            return made
        return self.beside(run) or made


class Improvement(Protocol):
    """An improvement on its way to a program that holds."""

    def rounded(self) -> Program | None:
        """The next program to verify, solved and rounded as its language says it; None to end."""
        ...

    def undrivable(self, error: MotionError) -> None:
        """The program cannot be driven: the next one is another."""
        ...

    def accepted(self, run: Run, certificate: Certificate | None) -> bool:
        """Whether the driven program is what was wanted; if not, the next one is another."""
        ...


def solve_round_verify(
    feasibility: ProgramFeasibility, improvement: Improvement
) -> tuple[Run, Certificate | None] | None:
    """The first program of an improvement that it accepts, driven and proven; None if none is."""
    while (program := improvement.rounded()) is not None:
        try:
            run = feasibility.controller.run(program, feasibility.start)
        except MotionError as error:
            improvement.undrivable(error)
            continue
        certificate = feasibility.certificate(run)
        if improvement.accepted(run, certificate):
            return run, certificate
    return None
