"""A positioner: tables that a program of their own turns, and no arm."""

from __future__ import annotations

from collections.abc import Sequence

from ..robot.joint import ExternalAxis, held_joint
from ..robot.model import Robot
from ..spatial.pose import IDENTITY

_ARM = 6
"""Joints that targets of joint values have places for."""


def positioner(vendor: str, axes: Sequence[ExternalAxis]) -> Robot:
    """A robot of external axes alone: where programs state the joints of an arm it has none.

    Args:
        vendor: whose controller drives them.
        axes: the external axes.

    Raises:
        InputError: two share a name, or one stands on another that is not there.
    """
    joints = tuple(held_joint(f"J{k + 1}", IDENTITY, (0.0, 0.0, 1.0)) for k in range(_ARM))
    return Robot(f"{vendor}/positioner", joints, external_axes=tuple(axes))
