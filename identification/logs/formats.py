"""Logs that are known by their columns.

| name | columns | written by |
|---|---|---|
| plain | ``t``, ``q1_motor`` … (else ``q1`` …) in s, rad and m | ``flyby record``, ``flyby emulate --csv`` |
| rtde | ``timestamp``, ``actual_q_0`` … (else ``target_q_0`` …) in s and rad | ``record.py`` of Universal Robots' RTDE client, ``ur_rtde`` |
| cjointt | ``timestamp``, ``J1`` … in s and degrees | loggers in RAPID that write ``CJointT`` |
| egm | ``TIMESTAMP``, ``R_FB_POS_RJ1`` …, ``R_FB_POS_EJ1`` … in ms, degrees and mm | ``abb_libegm`` |
| rsi | ``IPOC``, ``A1`` … or ``AIPos_A1`` …, ``E1`` … in ms, degrees and mm | loggers of KUKA's robot sensor interface |
| trace | ``Zeit [s]`` or ``Time [s]``, ``AxisPos_CmdIpo1 [°]`` … | KUKA's trace, exported as text |
"""  # noqa: E501

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence

from ...core.errors import InputError
from ...core.robot.joint import JointKind
from ...core.robot.model import Robot
from .columns import Columns

RADIAN, DEGREE = 1.0, math.pi / 180
Recogniser = Callable[[Sequence[str], Robot], Columns | None]


def recognise(names: Sequence[str], robot: Robot, file: str) -> Columns:
    """The columns of the first known form of log that the names fit.

    Args:
        names: of the table's columns.
        robot: whose log it is.
        file: for messages.

    Raises:
        InputError: none fits.
    """
    for known in FORMATS.values():
        columns = known(names, robot)
        if columns is not None:
            return columns
    shown = ", ".join(names[:8]) + (", …" if len(names) > 8 else "")
    raise InputError(
        f"{file}:1: no known form of log has the columns {shown or '(none are named)'}: a log "
        "needs columns t, q1, q2, …; or name its columns of time and joints in a file of columns"
    )


def _plain(names: Sequence[str], robot: Robot) -> Columns | None:
    if "t" not in names or "q1" not in names:
        return None
    # Of an emulation that tells motors from links the motors are what a controller would log.
    motor = "_motor" if "q1_motor" in names else ""
    count = _counted(names, rf"q(\d+){motor}")
    axes = tuple(f"q{k}{motor}" for k in range(1, count + 1))
    return Columns(axes, (1.0,) * count, "t")


def _rtde(names: Sequence[str], robot: Robot) -> Columns | None:
    if "timestamp" not in names:
        return None
    for kind in ("actual_q", "target_q"):
        if f"{kind}_0" in names:
            count = _counted(names, rf"{kind}_(\d+)") + 1
            axes = tuple(f"{kind}_{k}" for k in range(count))
            return Columns(axes, (RADIAN,) * count, "timestamp")
    return None


def _cjointt(names: Sequence[str], robot: Robot) -> Columns | None:
    if "timestamp" not in names or "J1" not in names:
        return None
    count = _counted(names, r"J(\d+)")
    return Columns(tuple(f"J{k}" for k in range(1, count + 1)), (DEGREE,) * count, "timestamp")


def _egm(names: Sequence[str], robot: Robot) -> Columns | None:
    if "TIMESTAMP" not in names or "R_FB_POS_RJ1" not in names:
        return None
    return _with_external(robot, "TIMESTAMP", "R_FB_POS_RJ", "R_FB_POS_EJ")


def _rsi(names: Sequence[str], robot: Robot) -> Columns | None:
    if "IPOC" not in names:
        return None
    for arm, external in (("A", "E"), ("AIPos_A", "EIPos_E"), ("AIPos.A", "EIPos.E")):
        if f"{arm}1" in names:
            return _with_external(robot, "IPOC", arm, external)
    return None


def _with_external(robot: Robot, time: str, arm: str, external: str) -> Columns:
    """Columns of a stream that counts ms; all six external axes are in it, used or not."""
    axes = [f"{arm}{k}" for k in range(1, robot.arm_size + 1)]
    axes += [f"{external}{k}" for k in range(1, len(robot.external_axes) + 1)]
    return Columns(tuple(axes), axis_scales(robot), time, 1e-3)


def axis_scales(robot: Robot) -> tuple[float, ...]:
    """rad in a degree for the axes that turn, m in a mm for those that slide."""
    joints = [*robot.joints, *(axis.joint for axis in robot.external_axes)]
    return tuple(1e-3 if j.kind is JointKind.PRISMATIC else DEGREE for j in joints)


_CHANNEL = re.compile(r"(AxisPos_[A-Za-z]+)(\d+)\s*(?:\[(.*)\])?")


def _trace(names: Sequence[str], robot: Robot) -> Columns | None:
    """Of several kinds of positions the first in the file."""
    time = next((name for name in names if re.match(r"(Zeit|Time)\b", name)), None)
    channels = [match for match in map(_CHANNEL.fullmatch, names) if match]
    if time is None or not channels:
        return None
    kind = channels[0][1]
    ours = {int(match[2]): match for match in channels if match[1] == kind}
    axes = tuple(ours[k][0] if k in ours else f"{kind}{k}" for k in range(1, robot.size + 1))
    scales = [
        RADIAN if k in ours and ours[k][3] == "rad" else scale
        for k, scale in enumerate(axis_scales(robot), 1)
    ]
    return Columns(axes, tuple(scales), time, 1e-3 if "[ms]" in time else 1.0)


def _counted(names: Sequence[str], pattern: str) -> int:
    """The greatest number among names of a pattern; a gap below it is a missing column."""
    found = [match for name in names if (match := re.fullmatch(pattern, name))]
    return max((int(match[1]) for match in found if len(match[1]) <= 2), default=0)


FORMATS: dict[str, Recogniser] = {
    "plain": _plain,
    "rtde": _rtde,
    "cjointt": _cjointt,
    "egm": _egm,
    "rsi": _rsi,
    "trace": _trace,
}
