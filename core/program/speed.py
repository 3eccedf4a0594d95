"""How fast a move may be driven."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from ..errors import InputError


@dataclass(frozen=True, slots=True)
class Speed:
    """The programmed limits of a move; None leaves a quantity to the robot's own limits.

    Args:
        tcp: speed of the TCP in the work object, m/s.
        reorientation: rate of turn of the tool in the work object, rad/s.
        external_linear: linear external axes, m/s.
        external_angular: rotating external axes, rad/s.
        joint: speed of the leading joint, rad/s (URScript ``movej`` v).
        joint_fraction: share of each joint's own maximum speed, in (0, 1] (KRL ``$VEL_AXIS``).
        tcp_acceleration: change of the TCP's speed along the path, m/s².
        reorientation_acceleration: the same of the rate of turn, rad/s².
        joint_acceleration: acceleration of the leading joint, rad/s² (URScript ``movej`` a).
        joint_acceleration_fraction: share of each joint's own maximum, in (0, 1] (RAPID
            ``AccSet``, KRL ``$ACC_AXIS``).
        acceleration_override: what the accelerations are multiplied by that the program does not
            state, the joints' and the TCP's alike; may be above 1 (FANUC ``ACC150``).
        jerk_fraction: share of the controller's own jerk, in (0, 1] (RAPID ``AccSet`` ramp).
        duration: time in s that the move takes, overriding the speeds (RAPID ``\\T``,
            URScript t).
        name: a vendor's predefined or declared name (``v500``), kept for the writer.

    Raises:
        InputError: a value is not finite and above zero, or a fraction above 1.
    """

    tcp: float | None = None
    reorientation: float | None = None
    external_linear: float | None = None
    external_angular: float | None = None
    joint: float | None = None
    joint_fraction: float = 1.0
    tcp_acceleration: float | None = None
    reorientation_acceleration: float | None = None
    joint_acceleration: float | None = None
    joint_acceleration_fraction: float = 1.0
    acceleration_override: float = 1.0
    jerk_fraction: float = 1.0
    duration: float | None = None
    name: str | None = None

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name == "name" or value is None:
                continue
            if not (math.isfinite(value) and value > 0):
                raise InputError(f"Speed.{field.name} must be above zero, not {value}")
            if "fraction" in field.name and value > 1:
                raise InputError(f"Speed.{field.name} is at most 1, not {value}")


def speed_shown(speed: Speed) -> str:
    """The limit that is programmed, in the units of the shop floor."""
    if speed.duration is not None:
        return f"in {speed.duration:.4g} s"
    if speed.name is not None:
        return speed.name
    if speed.tcp is not None:
        return f"{1e3 * speed.tcp:.5g} mm/s"
    if speed.joint is not None:
        return f"{math.degrees(speed.joint):.4g}°/s"
    return f"{100 * speed.joint_fraction:.3g} % of the joints' speed"
