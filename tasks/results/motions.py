"""Motions that are no programs: of the free robot, and along a given path."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...core.errors import Note
from ...core.motion.command.trajectory import Trajectory
from ...core.motion.model.consumption import SQUARED_TORQUE, Consumption
from ...core.motion.timing.timing import Timing
from ...core.notebook import PictureCurve, page, picture, table
from ...core.program.program import Program
from ...core.robot.model import Robot
from ...drawing.motion import draw_motion
from ...problems.free_motion.optimal_control import Optimum
from ...problems.free_motion.velocity_tuning import Tuned

COLUMNS = (("", "left"), ("unit", "left"), ("value", "right"))
PERIOD = 0.004
"""s between samples of a free motion."""


@dataclass(frozen=True)
class FreeMotion:
    """The best motion found between two configurations.

    Args:
        optimum: with its limits, its audit and its proof.
        consumption: what energy is.
    """

    optimum: Optimum
    consumption: Consumption = SQUARED_TORQUE

    @property
    def robot(self) -> Robot:
        """That moves."""
        return self.optimum.task.robot

    @property
    def duration(self) -> float:
        """s."""
        return self.optimum.time

    @property
    def energy(self) -> float | None:
        """Of all axes; None where the robot's inertias are not known."""
        return self.optimum.energy(self.consumption) if self.robot.links else None

    @property
    def proven(self) -> bool:
        """Whether the clearance is proven, if there is one to keep."""
        return self.optimum.proven

    @property
    def notes(self) -> tuple[Note, ...]:
        """What the user should know."""
        return self.optimum.notes

    @cached_property
    def trajectory(self) -> Trajectory:
        """Samples of all joints and the TCP in the world."""
        return self.optimum.trajectory(PERIOD)

    @property
    def files(self) -> dict[str, bytes]:
        """The samples."""
        return {"motion.csv": self.trajectory.csv()}

    def rows(self) -> list[tuple[str, ...]]:
        """Figures of the motion, and of the one that the search began with."""
        used = 100.0 * self.optimum.audit.used
        rows: list[tuple[str, ...]] = [
            ("time", "s", f"{self.duration:.4f}"),
            ("time of the first motion", "s", f"{self.optimum.first.duration:.4f}"),
            ("largest share of a limit", "%", f"{used:.2f}"),
        ]
        if self.energy is not None:
            rows.append(("energy", self.consumption.unit, f"{self.energy:.5g}"))
        return rows

    def picture(self, kind: str = "svg") -> bytes:
        """Joints over time, as a file of the kind ``png``, ``pdf`` or ``svg``."""
        return draw_motion({"free motion": self.trajectory}, self.robot, kind)

    def __repr__(self) -> str:
        proof = self.optimum.certificate
        said = "" if proof is None else (", proven" if proof.proven else ", not proven")
        return f"<Free motion of {self.robot.name}: {self.duration:.4f} s{said}>"

    def _repr_html_(self) -> str:
        drawn = picture([PictureCurve("path of the TCP", self.trajectory.position)])
        return page(repr(self)[1:-1], table(COLUMNS, self.rows()), drawn, notes=self.notes)


@dataclass(frozen=True)
class TunedMotion:
    """The best motion along the path of a program.

    Args:
        program: whose path it is.
        robot: that moves.
        tuned: speeds, torques and what limits them, interval by interval.
        timing: of the program as it is emulated, before any smoothing in time.
        trajectory: the motion, sampled.
    """

    program: Program
    robot: Robot
    tuned: Tuned
    timing: Timing
    trajectory: Trajectory

    @property
    def duration(self) -> float:
        """s, without waits."""
        return self.tuned.duration

    @property
    def before(self) -> float:
        """s that the program takes on the same path, without waits."""
        return float((self.timing.end - self.timing.begin).sum())

    @property
    def energy(self) -> float | None:
        """Of the objective's consumption; None where the robot's inertias are not known."""
        return self.tuned.energy if self.robot.links else None

    @property
    def files(self) -> dict[str, bytes]:
        """The samples."""
        return {"motion.csv": self.trajectory.csv()}

    def limits(self) -> list[tuple[str, float]]:
        """Each limit that counts and the share of the time for which it does, longest first."""
        names = np.array(self.tuned.active)
        steps = self.tuned.steps
        shares = {name: float(steps[names == name].sum() / steps.sum()) for name in set(names)}
        return sorted(shares.items(), key=lambda item: (-item[1], item[0]))

    def rows(self) -> list[tuple[str, ...]]:
        """Figures of the motion."""
        consumption = self.tuned.task.objective.consumption
        rows: list[tuple[str, ...]] = [
            ("time as programmed", "s", f"{self.before:.4f}"),
            ("time", "s", f"{self.duration:.4f}"),
            ("largest excess of a limit", "%", f"{100.0 * self.tuned.excess:.2g}"),
        ]
        if self.energy is not None:
            rows.append(("energy", consumption.unit, f"{self.energy:.5g}"))
        return rows + [(name, "% of the time", f"{100 * s:.1f}") for name, s in self.limits()]

    def picture(self, kind: str = "svg") -> bytes:
        """Joints over time, as a file of the kind ``png``, ``pdf`` or ``svg``."""
        return draw_motion({"tuned": self.trajectory}, self.robot, kind)

    def __repr__(self) -> str:
        return (
            f"<Path of {self.program.name} on {self.robot.name}: {self.before:.4f} s → "
            f"{self.duration:.4f} s, {self.tuned.way.said}>"
        )

    def _repr_html_(self) -> str:
        drawn = picture([PictureCurve("path of the TCP", self.trajectory.position)])
        return page(repr(self)[1:-1], table(COLUMNS, self.rows()), drawn)
