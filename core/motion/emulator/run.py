"""What came of driving a program."""

from __future__ import annotations

from dataclasses import dataclass

from ...arrays import FloatArray
from ...display import counted, in_line
from ...errors import Note
from ...program.program import Program
from ...program.target import JointTarget
from ..command.trajectory import Trajectory
from ..path.path import Path
from ..timing.timing import Timing


@dataclass(frozen=True)
class Run:
    """Everything that came of driving a program.

    Args:
        program: what was driven.
        path: its geometry.
        timing: its stamp, before any smoothing in time.
        trajectory: what the links do, and the motors, sampled at the controller's period.
        notes: the program's own and all that was found on the way.
    """

    program: Program
    path: Path
    timing: Timing
    trajectory: Trajectory
    notes: tuple[Note, ...]

    def __repr__(self) -> str:
        return in_line(
            f"Run of {self.program.name} on {self.path.route.robot.name}: {self.duration:.3f} s, "
            f"{counted(self.program.moves, 'move')}, {counted(self.notes, 'note')}"
        )

    @property
    def start(self) -> JointTarget:
        """Where the robot stands at first."""
        return self._standing(self.path.route.ends.q[0, 0])

    @property
    def end(self) -> JointTarget:
        """Where the robot stands at last."""
        return self._standing(self.path.route.ends.q[-1, 1])

    def _standing(self, q: FloatArray) -> JointTarget:
        arm = self.path.route.robot.arm_size
        return JointTarget(tuple(map(float, q[:arm])), tuple(map(float, q[arm:])))

    @property
    def duration(self) -> float:
        """Cycle time in s: from the first motion to rest after the last, waits included."""
        return self.trajectory.duration
