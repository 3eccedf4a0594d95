"""A star: legs that lead from one fly-by point in all directions of a plane.

The robot goes in along one leg, passes the point, goes out along another, stops at its end, and
comes back along the same leg for the next corner. So corners of all angles follow each other
without any other motion, in a disc as large as the longest leg, and every corner has a stop at
both ends of its legs: neighbouring zones cannot overlap.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

import numpy as np

from ...core.arrays import FloatArray
from ...core.program.arc_orientation import ArcOrientation
from ...core.program.move import Move, MoveC, MoveJ, MoveL
from ...core.program.speed import Speed
from ...core.program.target import JointTarget, PoseTarget
from ...core.program.tool import WORLD, Tool
from ...core.program.zone import FINE, Zone
from ...core.robot.kinematics.chain_kernels import jacobians, poses
from ...core.robot.model import Robot
from ...core.robot.work_chain import work_chain
from ...core.spatial.pose import Pose
from ...core.spatial.rotation import matrix_from_rotation_vector
from ...core.vendor import Vendor

SWEEP = 0.8
"""rad that an arc turns over its whole length."""
TILT = math.radians(20)
"""rad by which the tool is turned at the end of a leg along which it turns."""
_STEPS = 6
"""In which a leg is followed through inverse kinematics."""
_DECIMALS = 5
"""Of positions in m and joints in rad: every language writes them without loss."""


class Leg(StrEnum):
    """The sort of a leg."""

    LINE = "line"
    JOINT = "joint"
    ARC = "arc"
    TURN = "turn"
    SPIN = "spin"
    """No leg: the tool turns at the centre."""


@dataclass(frozen=True)
class Spoke:
    """A leg.

    Args:
        angle: of its direction at the centre, in the star's plane, rad.
        leg: its sort.
        length: m, of the TCP's way; of joint legs by the tangent at the centre; of turns at the
            centre rad.
        number: place in the walk; of turns at the centre the axis, three of which are square to
            each other.
    """

    angle: float
    leg: Leg
    length: float
    number: int = 0


@dataclass(frozen=True)
class Star:
    """A star round the TCP of one posture.

    Args:
        vendor: whose labels the targets have.
        robot: without external axes.
        tool: whose TCP goes along the legs.
        centre: (N,), the posture.
        plane: (3, 3), columns are two directions of the plane and its normal, in the world.
    """

    vendor: Vendor
    robot: Robot
    tool: Tool
    centre: FloatArray
    plane: FloatArray

    @cached_property
    def place(self) -> tuple[FloatArray, FloatArray]:
        """Rotation (3, 3) and position (3,) of the TCP at the centre, in the world."""
        R, p = poses(work_chain(self.robot, self.tool, WORLD), self.centre[None])
        return R[0], p[0]

    @cached_property
    def _jacobian(self) -> FloatArray:
        return np.asarray(jacobians(work_chain(self.robot, self.tool, WORLD), self.centre[None])[0])

    def direction(self, angle: float) -> FloatArray:
        """Unit vector (3,) of a direction in the plane."""
        return np.asarray(self.plane[:, :2] @ [math.cos(angle), math.sin(angle)])

    def slope(self, angle: float) -> FloatArray:
        """(N,), change of the joints per m of the TCP's way in a direction, without turning."""
        way = np.concatenate([self.direction(angle), np.zeros(3)])
        return np.asarray(np.linalg.lstsq(self._jacobian, way, rcond=None)[0])

    def end(self, spoke: Spoke, share: float = 1.0) -> FloatArray:
        """The configuration (N,) at a share of a leg.

        Raises:
            UnreachableError: the leg leaves the robot's reach.
        """
        if spoke.leg is Leg.JOINT:
            step = share * spoke.length * self.slope(spoke.angle)
            return np.asarray(np.round(self.centre + step, _DECIMALS))
        return self._configuration(spoke, share)

    def walk(
        self, legs: Sequence[Leg], turns: Sequence[float], lengths: Sequence[float], first: float
    ) -> list[Spoke]:
        """The legs of a walk with corners of these turns (signed, rad), one more than corners.

        Args:
            legs: sorts, used over and over.
            turns: of the corners.
            lengths: m, that each corner needs of both its legs.
            first: angle of the first leg, rad.
        """
        angles = [first]
        for turn in turns:
            angles.append(angles[-1] + math.pi + turn)
        needs = [max(pair) for pair in zip([0.0, *lengths], [*lengths, 0.0], strict=True)]
        return [
            Spoke(angle, legs[k % len(legs)], length, k)
            for k, (angle, length) in enumerate(zip(angles, needs, strict=True))
        ]

    def approach(self, spoke: Spoke, speed: Speed, share: float = 1.0) -> MoveJ:
        """The joint move to a place on a leg, a stop there."""
        return MoveJ(_joints(self.end(spoke, share)), speed, FINE, self.tool)

    def inward(self, spoke: Spoke, speed: Speed, zone: Zone) -> Move:
        """The move from the end of a leg to the centre."""
        if spoke.leg is Leg.JOINT:
            return MoveJ(_joints(self.centre), speed, zone, self.tool)
        target = self._target(self._centre_pose(), self.centre, spoke.leg)
        return self._along(spoke, target, speed, zone)

    def outward(self, spoke: Spoke, speed: Speed) -> Move:
        """The move from the centre to the end of a leg."""
        if spoke.leg is Leg.JOINT:
            return MoveJ(_joints(self.end(spoke)), speed, FINE, self.tool)
        target = self._target(self._pose(spoke, 1.0), self._configuration(spoke, 1.0), spoke.leg)
        return self._along(spoke, target, speed, FINE)

    def to(self, spoke: Spoke, share: float, speed: Speed, zone: Zone = FINE) -> Move:
        """The move to a place on a straight leg, or beyond the centre (negative shares)."""
        if spoke.leg is Leg.JOINT:
            return MoveJ(_joints(self.end(spoke, share)), speed, zone, self.tool)
        q = self._configuration(spoke, share)
        target = self._target(self._pose(spoke, share), q, spoke.leg)
        return MoveL(target, speed, zone, self.tool)

    def _along(self, spoke: Spoke, target: PoseTarget, speed: Speed, zone: Zone) -> Move:
        if spoke.leg is not Leg.ARC:
            return MoveL(target, speed, zone, self.tool)
        via = self._target(self._pose(spoke, 0.5), self._configuration(spoke, 0.5), spoke.leg)
        # The orientation is the same at both ends, so that both ways of turning are one.
        speaks = self.vendor.speaks
        rigid = speaks is not None and speaks.rigid_arcs
        turning = ArcOrientation.FIXED_FRAME if rigid else ArcOrientation.FOLLOWS_ARC
        return MoveC(target, speed, zone, self.tool, via=via, orientation=turning)

    def _target(self, pose: Pose, q: FloatArray, leg: Leg) -> PoseTarget:
        speaks = self.vendor.speaks
        words = None if speaks is None else (speaks.arc if leg is Leg.ARC else speaks.line)
        labelled = words is None or words.configurations
        return PoseTarget(pose, self.vendor.label(self.robot, q) if labelled else None)

    def _centre_pose(self) -> Pose:
        return _pose(*self.place)

    def _pose(self, spoke: Spoke, share: float) -> Pose:
        """The TCP at a share of a leg of lines or arcs."""
        R, p = self.place
        along = self.direction(spoke.angle)
        way = share * spoke.length
        if spoke.leg is Leg.SPIN:
            axes = (along, self.direction(spoke.angle + 0.5 * math.pi), self.plane[:, 2])
            return _pose(matrix_from_rotation_vector(way * axes[spoke.number % 3]) @ R, p)
        if spoke.leg is Leg.ARC:
            radius = spoke.length / SWEEP
            aside = self.direction(spoke.angle + 0.5 * math.pi)
            swept = way / radius
            step = radius * (math.sin(swept) * along + (1.0 - math.cos(swept)) * aside)
            return _pose(R, p + step)
        if spoke.leg is Leg.TURN:
            # A third of a turn on from leg to leg, about axes that lie in the plane.
            axis = self.direction(spoke.angle + 2.0 * math.pi / 3.0 * spoke.number)
            R = matrix_from_rotation_vector(share * TILT * axis) @ R
        return _pose(R, p + way * along)

    def _configuration(self, spoke: Spoke, share: float) -> FloatArray:
        """The configuration to which the arm comes along a leg, from the centre to a share."""
        q = self.centre
        for part in np.linspace(0.0, share, _STEPS + 1)[1:]:
            flange = self._pose(spoke, float(part)) @ self.tool.tcp.inverse()
            found = [
                turned
                for solution in self.robot.inverse(flange)
                for turned in self.robot.turns(solution.q)
            ]
            q = min(found, key=lambda other: float(np.abs(other - q).max()))
        return q


def _pose(R: FloatArray, p: FloatArray) -> Pose:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = R, np.round(p, _DECIMALS)
    return Pose.from_matrix(matrix)


def _joints(q: FloatArray) -> JointTarget:
    return JointTarget(tuple(float(value) for value in q))
