"""Range, speed and acceleration of each axis.

Of axis i, external ones from 7 on, in degrees (mm, if it is linear):

- range: ``$SOFTN_END[i]`` to ``$SOFTP_END[i]``;
- speed: ``$VEL_AXIS_MA[i]`` motor turns per minute through the gear ``$RAT_MOT_AX[i]``, {N turns of
  the motor, D of the axis, or of 1000 mm}: 6 · $VEL_AXIS_MA · D / |N| degrees/s;
- acceleration: ``$AXIS_JERK[i]`` · ``$DEF_FLT_PTP`` / 20 (degrees/s³, s), inferred: it is what is
  published of a KR 6 R900 for all axes, and within 7 % of what is of two larger arms. KR C2, which
  has no such datum, comes to full speed within ``$RAISE_TIME[i]`` ms, unless its dynamic model says
  otherwise (``$ADAP_ACC``): by how much it does is not published.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.errors import InputError
from ..data_list import DataList, numbers_of
from .assumed import SPREAD
from .geometry import AXES, LINEAR

RULE = "$AXIS_JERK · $DEF_FLT_PTP / 20, inferred"
RULE_C2 = "full speed within $RAISE_TIME"
RULE_SPREAD = {RULE: 1.07, RULE_C2: SPREAD}
"""Factor by which accelerations are off: at most, of the three arms of which they are published; of
a KR C2, of which none are, as where nothing is stated."""


class AxisLimits(NamedTuple):
    """Of one axis, rad or m; None for an acceleration that is not stated."""

    lower: float
    upper: float
    velocity: float
    acceleration: float | None


def axis_limits(data: DataList, i: int) -> AxisLimits:
    """Those of axis i, from 1.

    Raises:
        InputError: one is missing, or makes no sense.
    """
    linear = is_linear(data, i)
    unit = 1e-3 if linear else math.pi / 180.0
    gear = numbers_of(data.struct("$RAT_MOT_AX", i))
    turns, one = gear.get("N", 0.0), gear.get("D", 0.0)
    turn = 1000.0 if linear else 360.0
    ratio = turn / 60.0 * abs(one / turns) if turns else 0.0
    speed = ratio * data.number("$VEL_AXIS_MA", i)
    lower, upper = data.number("$SOFTN_END", i), data.number("$SOFTP_END", i)
    if not (0.0 < unit * speed < math.inf and lower < upper):
        raise InputError(
            f"{data.name}: speed or range of {axis_name(i)} makes no sense: {speed:g} "
            f"{'mm' if linear else 'degrees'}/s, from {lower:g} to {upper:g}"
        )
    return AxisLimits(unit * lower, unit * upper, unit * speed, _acceleration(data, i, unit, speed))


def _acceleration(data: DataList, i: int, unit: float, speed: float) -> float | None:
    if data.has("$AXIS_JERK", i) and data.has("$DEF_FLT_PTP"):
        value = data.number("$AXIS_JERK", i) * 1e-3 * data.number("$DEF_FLT_PTP") / 20.0
    elif data.has("$RAISE_TIME", i) and data.number("$RAISE_TIME", i) > 0.0:
        value = speed / (1e-3 * data.number("$RAISE_TIME", i))
    else:
        return None
    return unit * value if 0.0 < unit * value < math.inf else None


def acceleration_rule(data: DataList) -> str:
    """By what rule accelerations of the arm are made of its data."""
    return RULE if data.has("$AXIS_JERK", 1) and data.has("$DEF_FLT_PTP") else RULE_C2


def is_linear(data: DataList, i: int) -> bool:
    """Whether an axis is driven in mm."""
    return data.has("$AXIS_TYPE", i) and data.number("$AXIS_TYPE", i) == LINEAR


def axis_name(i: int) -> str:
    """A1…A6, E1…E6."""
    return f"A{i}" if i <= AXES else f"E{i - AXES}"
