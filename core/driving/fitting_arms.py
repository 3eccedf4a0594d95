"""Which arms can take all places that a program says, where nobody says which robot it is for.

A place is a posture of a joint move, or a pose of the flange. Poses that hang on what nobody knows
(a tool, a frame), or on a unit that moves the work, are left out.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..errors import FlybyError
from ..program.move import Move, MoveC
from ..program.program import Program
from ..program.target import Configuration, JointTarget, Target
from ..robot.arm_list import Listed
from ..robot.model import Robot
from ..spatial.pose import Pose
from ..vendor import Vendor

_MOST = 40
"""Poses that are tried, evenly over the program's own."""
_LABELLED = 8
"""Poses of these whose configurations are compared."""


@dataclass(frozen=True, slots=True)
class TakenPlaces:
    """Where a program sends a robot.

    Args:
        postures: joint values of the arm, rad or m.
        flanges: poses of the flange in the world, and which configuration is programmed there.
    """

    postures: tuple[tuple[float, ...], ...]
    flanges: tuple[tuple[Pose, Configuration | None], ...]

    @classmethod
    def of(cls, program: Program, *, assumed: bool = False) -> TakenPlaces:
        """The places of a program that are known; none if external axes have a part in them.

        Args:
            assumed: whether those count as well that hang on a tool or frame that nobody knows, as
                it is taken for.
        """
        asked = {q.key.casefold() for q in program.questions if not q.answered}
        unknown = set() if assumed else asked
        postures: dict[tuple[float, ...], None] = {}
        flanges: dict[tuple[float, ...], tuple[Pose, Configuration | None]] = {}
        for move in program.moves:
            targets: list[Target] = [move.target]
            if isinstance(move, MoveC):
                targets.append(move.via)
            if move.open or any(target.external for target in targets):
                continue
            for target in targets:
                if isinstance(target, JointTarget):
                    postures[target.joints] = None
                elif _carried(move, unknown):
                    pose = move.work_object.pose @ target.pose @ move.tool.tcp.inverse()
                    key = tuple(np.round((*pose.position, *pose.quaternion), 6))
                    flanges.setdefault(key, (pose, target.configuration))
        # The furthest first: most arms that are too small miss it.
        found = sorted(flanges.values(), key=lambda place: -np.linalg.norm(place[0].position))
        step = max(1, -(-len(found) // _MOST))
        return cls(tuple(postures), tuple(found[::step]))

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.postures) + len(self.flanges)

    def missed_by(self, vendor: Vendor, robot: Robot) -> bool:
        """Whether a robot cannot take one of them; nobody says of one on a track or at a table."""
        return not robot.external_axes and self._fit(vendor, robot) is None

    def taken_by(self, vendor: Vendor, arms: Iterable[Listed]) -> list[Listed]:
        """The arms of a vendor that can take all of them: first those that have the most of the
        programmed configurations there, of these the smallest."""
        fits = []
        for arm in arms:
            if arm.refused is None and arm.axes in (None, 4, 5, 6):
                robot = vendor.robot(arm.name.removeprefix(f"{vendor.name}/"))
                fit = self._fit(vendor, robot)
                if fit is not None:
                    fits.append((-fit, arm.reach or np.inf, arm.name, arm))
        return [arm for *_, arm in sorted(fits, key=lambda item: item[:3])]

    def most_taken_by(self, vendor: Vendor, arms: Iterable[Listed]) -> list[Listed]:
        """Arms, those first that can take the most of them, of these the smallest."""
        step = max(1, len(self.flanges) // _LABELLED)
        single = [TakenPlaces((joints,), ()) for joints in self.postures[:_LABELLED]]
        single += [TakenPlaces((), (flange,)) for flange in self.flanges[::step]]

        def missed(arm: Listed) -> tuple[int, float, str]:
            robot = vendor.robot(arm.name.removeprefix(f"{vendor.name}/"))
            taken = sum(place._fit(vendor, robot) is not None for place in single)
            return -taken, arm.reach or np.inf, arm.name

        return sorted((arm for arm in arms if arm.axes in (4, 5, 6)), key=missed)

    def _fit(self, vendor: Vendor, robot: Robot) -> int | None:
        """How many of the compared configurations a robot has; None if it misses a place."""
        if any(len(joints) != robot.arm_size for joints in self.postures):
            return None
        if robot.external_axes or robot.arm_size > 6:
            return None
        limits = robot.limits
        for joints in self.postures:
            q = np.array(joints)
            if np.any(q < limits.lower - _EDGE) or np.any(q > limits.upper + _EDGE):
                return None
        matched = 0
        labelled = max(1, len(self.flanges) // _LABELLED)
        for number, (pose, configuration) in enumerate(self.flanges):
            try:
                solutions = robot.inverse(pose)
            except FlybyError:
                return None
            if configuration is not None and number % labelled == 0:
                turned = (q for solution in solutions for q in robot.turns(solution.q))
                labels = (vendor.label(robot, q) for q in turned)
                matched += any(lb is not None and not configuration.mismatch(lb) for lb in labels)
        return matched


_EDGE = 1e-6
"""rad or m by which a posture may lie beyond a limit, as texts round."""


def _carried(move: Move, unknown: set[str]) -> bool:
    """Whether it is known where a move sends the flange."""
    tool, frame = move.tool, move.work_object
    if not tool.robot_held or frame.robot_held or frame.moved_by or frame.not_followed:
        return False
    return unknown.isdisjoint((tool.name.casefold(), frame.name.casefold()))
