"""Speeds and zones in the terms of a vendor's language."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import FloatArray
from ...core.dialect import Dialect, MoveWords
from ...core.errors import InputError
from ...core.program.move import MoveC, MoveJ, MoveL
from ...core.program.speed import Speed
from ...core.program.zone import Radius, Zone
from ...core.robot.model import Robot
from ...core.vendor import Vendor

RAMP = 0.25
"""s in which the programmed speed is reached where the language states accelerations."""
LEAST_TCP_ACCELERATION, LEAST_JOINT_ACCELERATION = 1.2, 1.4
"""m/s² and rad/s², the defaults of URScript's movel and movej ("Script Directory")."""
JOINT_SHARE = 0.9
"""Of a joint's acceleration limit that is programmed at most."""
FASTEST = 7.0
"""m/s, where a language sets no bound."""
LEAST_SPEED = 5e-4
"""m/s of the TCP that is programmed at least."""
REORIENTATION, EXTERNAL_LINEAR, EXTERNAL_ANGULAR = math.radians(500), 5.0, math.radians(1000)
"""rad/s, m/s and rad/s, as in RAPID's predefined speeds; said where there are words for them."""


@dataclass(frozen=True)
class Words:
    """What is said in a vendor's language.

    Args:
        vendor: whose language.
        robot: that is driven.

    Raises:
        InputError: the language has no recorder, does not drive the robot, or has no zones with a
            radius.
    """

    vendor: Vendor
    robot: Robot

    def __post_init__(self) -> None:
        self.vendor.check_written(self.robot)
        if self.vendor.recorder is None:
            raise InputError(
                f"{self.vendor.name} has no recorder: there is nothing that writes its programs "
                "so that they log themselves"
            )
        if self.vendor.reader is None:
            raise InputError(
                f"{self.vendor.name} has no reader: what is written could not be checked"
            )
        without = [k.__name__ for k in (MoveJ, MoveL, MoveC) if not self._has_radius(k)]
        if without:
            raise InputError(
                f"{self.vendor.name}'s language has no zone with a radius for {without[0]}: "
                "corners cannot be designed for it"
            )

    def _has_radius(self, kind: type[MoveJ | MoveL | MoveC]) -> bool:
        words = self.of(kind)
        return words is None or Radius in words.zones

    def of(self, kind: type[MoveJ | MoveL | MoveC]) -> MoveWords | None:
        """What can be said of a kind of move; None for everything."""
        speaks = self.vendor.speaks
        if speaks is None:
            return None
        return {MoveJ: speaks.joint, MoveL: speaks.line, MoveC: speaks.arc}[kind]

    def zone(self, radius: float) -> Zone:
        """The zone of a radius, m: the predefined one where there is one."""
        speaks = self.vendor.speaks
        if speaks is None or not speaks.zone_parts:
            return Radius(radius).with_one_distance()
        for known in speaks.zones():
            if math.isclose(known.tcp, radius, rel_tol=1e-9):
                return known
        # Graded as the predefined ones are.
        angle = math.radians(0.15 * 1e3 * radius)
        return Radius(radius, 1.5 * radius, 1.5 * radius, angle, 1.5 * radius, angle)

    @property
    def top(self) -> float:
        """m/s, the greatest speed of the TCP that the language takes."""
        return FASTEST if self.vendor.speaks is None else self.vendor.speaks.fastest

    def path_speed(
        self,
        speed: float,
        kind: type[MoveL | MoveC] = MoveL,
        slopes: FloatArray | None = None,
    ) -> Speed:
        """Of lines and arcs, at a speed of the TCP in m/s.

        Args:
            speed: m/s.
            kind: of moves.
            slopes: (K, N), change of the joints per m of the TCP's way, where a stated
                acceleration need not reach the speed, but is to keep the joints within theirs.

        Raises:
            InputError: the language takes no such speed.
        """
        self._check(speed)
        words = self.of(kind)
        said = frozenset({"reorientation"}) if words is None else words.speeds
        accelerated = words is not None and "tcp_acceleration" in words.needs
        ramp = _ramp(speed, LEAST_TCP_ACCELERATION)
        if slopes is not None:
            ramp = max(LEAST_TCP_ACCELERATION, min(ramp, self._along(slopes)))
        return Speed(
            tcp=speed,
            reorientation=REORIENTATION if "reorientation" in said else None,
            external_linear=EXTERNAL_LINEAR if "external_linear" in said else None,
            external_angular=EXTERNAL_ANGULAR if "external_angular" in said else None,
            tcp_acceleration=ramp if accelerated else None,
        )

    def _along(self, slopes: FloatArray) -> float:
        """m/s² of the TCP that keep the joints within what joint moves are accelerated by."""
        return round(self._joint_acceleration() / float(np.abs(slopes).max()), 1)

    def joint_speed(self, speed: float, slopes: FloatArray) -> Speed:
        """Of joint moves, at which the TCP reaches a speed, m/s, in the quickest direction.

        Args:
            speed: m/s.
            slopes: (K, N), change of the joints per m of the TCP's way in each direction.

        Raises:
            InputError: the language takes no such speed.
        """
        self._check(speed)
        speaks = self.vendor.speaks
        pace = "tcp" if speaks is None else speaks.pace
        if pace == "tcp":
            return self.path_speed(speed)
        if pace == "joint_fraction":
            share = speed * float(np.abs(slopes / self.robot.limits.velocity).max(axis=1).min())
            step = (0.0 if speaks is None else speaks.share_step) or 1e-3
            return Speed(joint_fraction=min(1.0, max(step, round(share / step) * step)))
        return self._leading(speed * float(np.abs(slopes).max(axis=1).min()))

    def fastest(self) -> Speed:
        """Of joint moves that shall reach the joints' own limits."""
        speaks = self.vendor.speaks
        if speaks is None or speaks.pace == "tcp":
            return self.path_speed(self.top)
        if speaks.pace == "joint_fraction":
            return Speed(joint_fraction=1.0)
        return self._leading(float(self.robot.limits.velocity.min()))

    def joint_alone(self, joint: int, rate: float, lever: float) -> Speed:
        """Of a joint move of one joint, at a rate in rad/s, or the least that the language takes.

        Args:
            joint: counted from 0.
            rate: rad/s.
            lever: m, of the TCP about the joint.
        """
        speaks = self.vendor.speaks
        pace = "tcp" if speaks is None else speaks.pace
        if pace == "tcp":
            # The tool turns as fast as the joint, wherever the TCP is.
            speed = self.path_speed(max(LEAST_SPEED, round(rate * lever, 4)))
            return speed if speed.reorientation is None else replace(speed, reorientation=rate)
        if pace == "joint_fraction":
            share = rate / float(self.robot.limits.velocity[joint])
            step = (0.0 if speaks is None else speaks.share_step) or 1e-3
            return Speed(joint_fraction=min(1.0, max(step, round(share / step) * step)))
        return self._leading(rate)

    def _leading(self, rate: float) -> Speed:
        """Of joint moves by the leading joint's speed, rad/s."""
        rate = round(min(rate, float(self.robot.limits.velocity.min())), 4)
        acceleration = min(_ramp(rate, LEAST_JOINT_ACCELERATION), self._joint_acceleration())
        return Speed(joint=rate, joint_acceleration=acceleration)

    def _joint_acceleration(self) -> float:
        """rad/s² that are programmed at most."""
        most = JOINT_SHARE * float(self.robot.limits.acceleration.min())
        if self.vendor.speaks is not None:
            most = min(most, self.vendor.speaks.most.get("joint_acceleration", most))
        return most

    def _check(self, speed: float) -> None:
        speaks: Dialect | None = self.vendor.speaks
        if speaks is not None and speed > speaks.fastest:
            raise InputError(
                f"{self.vendor.name}'s language takes {1e3 * speaks.fastest:.5g} mm/s at most, not "
                f"{1e3 * speed:.5g} mm/s"
            )


def _ramp(speed: float, least: float) -> float:
    return max(least, round(speed / RAMP, 1))
