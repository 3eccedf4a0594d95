"""A UR's ``calibration.conf``: how this arm differs from the nominal one of its type.

The controller keeps it beside ``urcontrol.conf``; an INI file of which the section ``[mounting]``
is read:

    [mounting]
    delta_theta = [ 4.6e-08, 1.5e-05, … ]   six of each: rad, m, m, rad
    delta_a = [ … ]
    delta_d = [ … ]
    delta_alpha = [ … ]

They add to the rows of the type's Denavit–Hartenberg table: the frame behind joint i is
Rz(qᵢ + δθᵢ) Tz(dᵢ + δdᵢ) Tx(aᵢ + δaᵢ) Rx(αᵢ + δαᵢ). What a controller has linearised has d of
hundreds of metres along the parallel axes 2, 3 and 4, which cancel.
"""

from __future__ import annotations

import configparser
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import InputError
from ...core.files.reading import read_text
from ...core.robot.model import Robot
from ...core.spatial.pose import Pose

_ROWS = "theta", "a", "d", "alpha"
_LARGEST = 1 << 20
_NUMBER = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*")
_APART = 0.02
"""m by which a calibrated flange is off the nominal one at most: of 608 public programs 604 are off
by 5 mm and less, the others, whose arms are of other types, by 40 mm and more."""


def with_machine_data(robot: Robot, file: Path) -> Robot:
    """The robot as its calibration says it is.

    Args:
        robot: of this type, nominal.
        file: ``calibration.conf``.

    Raises:
        InputError: the file cannot be read, states no calibration, or that of another type of arm.
    """
    deltas = _deltas(file, robot.arm_size)
    frames = [*(joint.placement for joint in robot.joints[1:]), robot.flange]
    moved = [_moved(frame, *row) for frame, row in zip(frames, deltas, strict=True)]
    joints = [
        replace(joint, placement=placement)
        for joint, placement in zip(robot.joints[1:], moved, strict=False)
    ]
    origins = {**robot.origins, "geometry": f"measured: {file.name}, this arm's calibration"}
    made = replace(robot, joints=(robot.joints[0], *joints), flange=moved[-1], origins=origins)
    off = _apart(robot, made)
    if off > _APART:
        raise InputError(
            f"{file}: by its calibration the flange is up to {1e3 * off:.0f} mm from where that of "
            f"a {robot.name} is, {1e3 * _APART:.0f} mm at most are an arm of this type: name "
            "another robot"
        )
    return made


def _deltas(file: Path, count: int) -> FloatArray:
    """(count, 4), of each row of the table: δθ rad, δa m, δd m, δα rad."""
    parser = configparser.ConfigParser(
        interpolation=None, strict=False, inline_comment_prefixes=("#", ";")
    )
    try:
        parser.read_string(read_text(file, _LARGEST))
    except configparser.Error as error:
        reason = str(error).splitlines()[0]
        raise InputError(f"{file}: not a calibration.conf: {reason}") from error
    columns = []
    for name in _ROWS:
        stated = parser.get("mounting", f"delta_{name}", fallback=None)
        if stated is None:
            raise InputError(f"{file}: [mounting] delta_{name} is missing")
        parts = stated.strip().removeprefix("[").removesuffix("]").split(",")
        if len(parts) != count or not all(_NUMBER.fullmatch(part) for part in parts):
            raise InputError(
                f"{file}: [mounting] delta_{name} must be {count} numbers, not {stated.strip()!r}"
            )
        columns.append([float(part) for part in parts])
    return np.array(columns).T


def _moved(frame: Pose, theta: float, a: float, d: float, alpha: float) -> Pose:
    """A frame Rz(θ) Tz(d) Tx(a) Rx(α) with other parameters by these."""
    F = frame.matrix()
    own = math.atan2(F[1, 0], F[0, 0])
    along = math.cos(own) * F[0, 3] + math.sin(own) * F[1, 3]
    twist = math.atan2(F[2, 1], F[2, 2])
    c, s = math.cos(own + theta), math.sin(own + theta)
    ca, sa = math.cos(twist + alpha), math.sin(twist + alpha)
    x = along + a
    return Pose.from_matrix(
        np.array(
            [
                [c, -s * ca, s * sa, x * c],
                [s, c * ca, -c * sa, x * s],
                [0.0, sa, ca, F[2, 3] + d],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )
    )


def _apart(one: Robot, other: Robot) -> float:
    """m by which the flanges are apart at most, at a hundred configurations."""
    q = np.random.default_rng(0).uniform(-math.pi, math.pi, (100, one.arm_size))
    q = np.clip(q, one.limits.lower[: one.arm_size], one.limits.upper[: one.arm_size])
    rest = np.clip(np.zeros(one.size), one.limits.lower, one.limits.upper)[one.arm_size :]
    rows = [np.concatenate([row, rest]) for row in q]
    return max(
        math.dist(one.flange_pose(row).position, other.flange_pose(row).position) for row in rows
    )
