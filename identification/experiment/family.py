"""What runs at one posture have in common: places, names, speeds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray
from ...core.motion.emulator.controller import Controller
from ...core.motion.emulator.run import Run
from ...core.program.move import Move, MoveC, MoveJ
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import JointTarget
from .kinds import Kind
from .plan import CandidateRun, Plan, PlannedCorner, Skipped
from .postures import Site
from .star import Leg, Star
from .words import Words

APPROACH = 0.25
"""m/s, about, on the way to the start."""
Made = tuple[CandidateRun, Run] | Skipped
"""A run with its emulation, or what is not possible."""


@dataclass(frozen=True)
class RunFamily:
    """Runs at one posture.

    Args:
        words: of the vendor's language.
        controller: that emulates.
        plan: what was asked for.
        radii: of the zones, m, the smallest first.
        number: of the posture, from 0.
        site: the posture.
        reach: of the robot, m.
        random: what is drawn from.
    """

    words: Words
    controller: Controller
    plan: Plan
    radii: tuple[float, ...]
    number: int
    site: Site
    reach: float
    random: np.random.Generator

    def place(self, kind: Kind, speed: float | None = None) -> str:
        """Of a run that is not possible, in words."""
        at = "" if speed is None else f" at {1e3 * speed:.5g} mm/s"
        return f"{kind}{at}, posture {self.number + 1}"

    def name(self, kind: Kind, speed: float | None, number: int | None = None) -> str:
        """Of a program."""
        parts = [f"p{self.number + 1}", kind.short]
        parts += [] if speed is None else [f"v{1e3 * speed:.5g}".replace(".", "d")]
        parts += [] if number is None else [str(number + 1)]
        return "_".join(parts)

    def star(self) -> Star:
        """Round the TCP of the posture."""
        robot, site = self.controller.robot, self.site
        return Star(self.words.vendor, robot, self.plan.tool, site.q, site.plane)

    def speeds(self, speed: float, slopes: FloatArray) -> dict[Leg, Speed]:
        """Of the sorts of legs, at a speed of the TCP in m/s.

        Args:
            speed: m/s.
            slopes: (K, N), change of the joints per m of the TCP's way along the legs.
        """
        path, arc = self.words.path_speed(speed), self.words.path_speed(speed, MoveC)
        joint = self.words.joint_speed(speed, slopes)
        return {Leg.LINE: path, Leg.TURN: path, Leg.ARC: arc, Leg.JOINT: joint}

    def gentle(self, slopes: FloatArray) -> Speed:
        """Of the way to the start."""
        return self.words.joint_speed(APPROACH, slopes)

    def candidate(
        self,
        name: str,
        kind: Kind,
        speed: float | None,
        corners: Sequence[PlannedCorner],
        begin: MoveJ,
        moves: Sequence[Move],
    ) -> CandidateRun:
        """A run that is approached in joints."""
        assert isinstance(begin.target, JointTarget)
        program = Program((begin, *moves), name, begin.target)
        start = np.array(begin.target.joints)
        return CandidateRun(name, kind, self.number, speed, tuple(corners), program, start)


def joint_target(q: FloatArray) -> JointTarget:
    """A configuration (N,) as a target."""
    return JointTarget(tuple(float(value) for value in q))
