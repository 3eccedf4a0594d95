"""Speeds and approximations as the settings and words that KRL has for them.

``$VEL.CP`` is in m/s, ``$VEL.ORI1`` in degrees/s, ``$VEL_AXIS`` in percent, ``$APO.CDIS`` in mm
("Quickguide KRL-Syntax"; KUKA.PLC mxAutomation Logix 1.0, approximate positioning).
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from ....core.errors import InputError
from ....core.program.move import Move, MoveJ
from ....core.program.speed import Speed
from ....core.program.zone import Angle, ContourFraction, Fine, Radius, VendorZone, Zone, zone_word
from ....core.robot.joint import JointKind
from ....core.robot.model import Robot
from ..zone_kinds import C_VEL
from .formatting import MM
from .numbers import number

Setting = tuple[str, str]
"""A variable, and the statement that sets it."""


def speed_settings(move: Move) -> Iterator[Setting]:
    """What a move's speed sets.

    Raises:
        InputError: KRL cannot say it.
    """
    if isinstance(move, MoveJ):
        yield from _axis_speeds(move.speed)
    else:
        yield from _path_speeds(move.speed)


def zone_settings(zone: Zone) -> Iterator[Setting]:
    """The variable of ``$APO`` that a zone reads; none for a stop point.

    Raises:
        InputError: KRL cannot say it.
    """
    if isinstance(zone, Radius):
        _check_radius(zone)
        yield "$APO.CDIS", f"$APO.CDIS={number(zone.tcp / MM)}"
    elif isinstance(zone, ContourFraction):
        yield "$APO.CPTP", f"$APO.CPTP={number(100 * zone.fraction)}"
    elif isinstance(zone, Angle):
        yield "$APO.CORI", f"$APO.CORI={number(math.degrees(zone.angle))}"
    elif isinstance(zone, VendorZone):
        yield "$APO.CVEL", f"$APO.CVEL={number(100 * zone.size)}"


def approximation(move: Move) -> str:
    """The words after a motion that let it pass its point.

    Raises:
        InputError: the zone is none that KRL's motion of this kind takes.
    """
    kinds: dict[type[Zone], str] = {
        Fine: "",
        Radius: " C_DIS",
        ContourFraction: " C_PTP",
        Angle: " C_ORI",
        VendorZone: " C_VEL",
    }
    takes: tuple[type[Zone], ...] = (Fine, Radius, ContourFraction)
    if not isinstance(move, MoveJ):
        takes = (Fine, Radius, Angle, VendorZone)
    foreign = isinstance(move.zone, VendorZone) and move.zone != C_VEL.sized(move.zone.size)
    if foreign or not isinstance(move.zone, takes):
        names = " or ".join(f"{kinds[kind].strip()} ({kind.__name__})" for kind in takes[1:])
        raise InputError(
            f"KRL's {'PTP' if isinstance(move, MoveJ) else 'LIN and CIRC'} is approximated by "
            f"{names}, not by {zone_word(move.zone)}"
        )
    return kinds[type(move.zone)]


def _check_radius(zone: Radius) -> None:
    """``C_DIS`` is one distance, of the TCP, and begins reorientation and external axes with it."""
    try:
        zone.with_one_distance()
    except InputError as error:
        raise InputError(
            f"KRL's C_DIS has one distance for TCP, reorientation and external axes: {error}"
        ) from None
    for what in ("angle", "external_linear", "external_angular"):
        if getattr(zone, what) != 0:
            raise InputError(
                f"KRL's C_DIS has no zone for moves without way of the TCP (Radius.{what}): "
                "take it away, or approximate by an angle (C_ORI)"
            )


def _axis_speeds(speed: Speed) -> Iterator[Setting]:
    """``$VEL_AXIS`` and ``$ACC_AXIS`` of all axes, set by the controller's own routine ``BAS``.

    They are whole percents on the controller, which rounds others.
    """
    _refuse(speed, _NOT_OF_PTP)
    velocity = _positive(100 * speed.joint_fraction, "$VEL_AXIS")
    acceleration = _positive(100 * speed.joint_acceleration_fraction, "$ACC_AXIS")
    yield "$VEL_AXIS", f"BAS(#VEL_PTP,{velocity})"
    yield "$ACC_AXIS", f"BAS(#ACC_PTP,{acceleration})"


def _path_speeds(speed: Speed) -> Iterator[Setting]:
    """``$VEL`` and ``$ACC``; what is left to the robot gets the machine's own maximum."""
    _refuse(speed, _NOT_OF_CP)
    turning, turning_up = map(_degrees, (speed.reorientation, speed.reorientation_acceleration))
    for variable, value in (
        ("VEL.CP", speed.tcp),
        ("VEL.ORI1", turning),
        ("VEL.ORI2", turning),
        ("ACC.CP", speed.tcp_acceleration),
        ("ACC.ORI1", turning_up),
        ("ACC.ORI2", turning_up),
    ):
        kind, _, component = variable.partition(".")
        own = f"${kind}_MA.{component}"
        text = own if value is None else _positive(value, f"${variable}")
        yield f"${variable}", f"${variable}={text}"


def _positive(value: float, variable: str) -> str:
    text = number(value)
    if text == "0":
        raise InputError(f"{variable} of {value:g} is too small to be written")
    return text


def _degrees(value: float | None) -> float | None:
    return None if value is None else math.degrees(value)


_NOT_IN_KRL = {
    "joint": "a joint speed in rad/s: give Speed.joint_fraction",
    "joint_acceleration": "a joint acceleration in rad/s²: give Speed.joint_acceleration_fraction",
    "duration": "the time that a move takes: give its speed",
}
_NOT_OF_PTP = _NOT_IN_KRL | {
    "tcp": "the TCP's speed along a PTP: give Speed.joint_fraction, or make it a linear move",
    "reorientation": "the rate of turn along a PTP: give Speed.joint_fraction",
    "tcp_acceleration": "the TCP's acceleration along a PTP: give "
    "Speed.joint_acceleration_fraction",
    "reorientation_acceleration": "the acceleration of turning along a PTP: give "
    "Speed.joint_acceleration_fraction",
}
_NOT_OF_CP = _NOT_IN_KRL | {
    "joint_fraction": "the joints' speeds along LIN and CIRC: give Speed.tcp",
    "joint_acceleration_fraction": "the joints' accelerations along LIN and CIRC: give "
    "Speed.tcp_acceleration",
}
_FREE = Speed()


def _refuse(speed: Speed, words: dict[str, str]) -> None:
    if speed.acceleration_override != 1:
        raise InputError(
            "KRL has no words for an override of all accelerations (Speed.acceleration_override): "
            "state a share of the joints' or the TCP's acceleration"
        )
    if speed.jerk_fraction != 1:
        raise InputError("KRL has no words for a share of the jerk (Speed.jerk_fraction)")
    for field, what in words.items():
        if getattr(speed, field) != getattr(_FREE, field):
            raise InputError(f"KRL has no words for {what} (Speed.{field})")


def check_external(speed: Speed, robot: Robot) -> None:
    """Refuse speeds of external axes that the robot has; KRL states them in percent of theirs.

    Raises:
        InputError: naming the speed.
    """
    kinds = {axis.joint.kind is JointKind.PRISMATIC for axis in robot.external_axes}
    for field, linear in (("external_linear", True), ("external_angular", False)):
        if linear in kinds and getattr(speed, field) is not None:
            raise InputError(
                f"KRL states speeds of external axes in percent of each one's own, not in "
                f"{'m/s' if linear else 'rad/s'} (Speed.{field}): take it away"
            )
