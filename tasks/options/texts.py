"""Numbers as a user types them, degrees and mm, and the same as values: rad and m."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...core.display import counted
from ...core.errors import InputError, OptionError
from ...core.files.tables import LARGEST

if TYPE_CHECKING:
    from ...core.program.target import JointTarget
    from ...core.robot.model import Robot
    from ...core.spatial.pose import Pose

QUATERNION_SLACK = 1e-2
"""By how much a typed quaternion's length may miss 1; it is normalised."""


def numbers(text: str, name: str) -> tuple[float, ...]:
    """Finite numbers separated by commas or blanks.

    Raises:
        InputError: naming ``name`` and what is no number.
    """
    values = []
    for word in text.replace(",", " ").split():
        try:
            value = float(word)
        except ValueError:
            raise OptionError(f"{name}: {word[:40]!r} is no number") from None
        if not math.isfinite(value):
            raise OptionError(f"{name}: {word[:40]} is not finite")
        if abs(value) > LARGEST:
            raise OptionError(f"{name}: must lie within ±{LARGEST:g}, not {value:g}")
        values.append(value)
    return tuple(values)


def several(given: str | Sequence[float], name: str, factor: float = 1.0) -> tuple[float, ...]:
    """Numbers in SI units: as they are, or typed.

    Args:
        given: text, or the numbers.
        name: of the option, for messages.
        factor: of numbers that are typed.

    Raises:
        InputError: one of them is no finite number.
    """
    if isinstance(given, str):
        return tuple(factor * value for value in numbers(given, name))
    return numbers(",".join(repr(_float(value, name)) for value in given), name)


def _float(value: object, name: str) -> float:
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise OptionError(f"{name}: {value!r} is no number") from None


def configuration(given: str | Sequence[float], name: str, robot: Robot) -> tuple[float, ...]:
    """All N values of a configuration in rad and m: as they are, or typed in degrees and mm.

    Raises:
        InputError: not as many numbers as the robot has axes.
    """
    values = several(given, name)
    if len(values) != robot.size:
        raise InputError(
            f"{name}: {robot.name} has {robot.size} axes ({', '.join(robot.axis_names)}); "
            f"{counted(values, 'value')} given"
        )
    if not isinstance(given, str):
        return values
    return tuple(value * scale for value, (_, scale) in zip(values, axis_units(robot), strict=True))


def joint_target(
    given: str | Sequence[float] | JointTarget | None, name: str, robot: Robot
) -> JointTarget | None:
    """Where a robot stands; None where nothing is said of it.

    Raises:
        InputError: see `configuration`.
    """
    from ...core.program.target import JointTarget

    if given is None or isinstance(given, JointTarget):
        return given
    q = configuration(given, name, robot)
    return JointTarget(q[: robot.arm_size], q[robot.arm_size :])


def axis_units(robot: Robot) -> list[tuple[str, float]]:
    """The unit that each axis is shown in, and what it is in rad or m."""
    from ...core.robot.joint import JointKind

    joints = [*robot.joints, *(axis.joint for axis in robot.external_axes)]
    turning = ("°", math.pi / 180)
    return [turning if j.kind is JointKind.REVOLUTE else ("mm", 1e-3) for j in joints]


def pose(given: str | Pose, name: str) -> Pose:
    """A pose: as it is, or x, y, z in mm and a quaternion w, x, y, z, or turns in degrees.

    The turns are rx, ry, rz about the fixed x, then y, then z axis: R = Rz Ry Rx. Both may be
    left out.

    Raises:
        InputError: another number of values, or a quaternion far from unit length.
    """
    from ...core.spatial.pose import Pose

    if isinstance(given, Pose):
        return given
    if not isinstance(given, str):
        raise OptionError(f"{name} is a Pose or text, not {given!r}")
    values = numbers(given, name)
    if len(values) not in (3, 6, 7):
        raise OptionError(
            f"{name}: a pose is x,y,z or x,y,z,rx,ry,rz or x,y,z,qw,qx,qy,qz "
            f"(mm, degrees), not {len(values)} numbers"
        )
    x, y, z = (1e-3 * value for value in values[:3])
    if len(values) == 7:
        norm = math.hypot(*values[3:])
        if abs(norm - 1.0) > QUATERNION_SLACK:
            raise OptionError(f"{name}: the quaternion must have length 1, not {norm:.6g}")
        w, i, j, k = (value / norm for value in values[3:])
        return Pose((x, y, z), (w, i, j, k))
    turned = Pose((x, y, z))
    for axis, angle in reversed(list(enumerate(values[3:]))):
        half = 0.5 * math.radians(angle)
        vector = [0.0, 0.0, 0.0]
        vector[axis] = math.sin(half)
        turned = turned @ Pose(quaternion=(math.cos(half), vector[0], vector[1], vector[2]))
    return turned


def direction(given: str | Sequence[float], name: str) -> tuple[float, float, float]:
    """Three numbers of a direction.

    Raises:
        InputError: they are none.
    """
    found = several(given, name)
    if len(found) != 3 or not any(found):
        raise OptionError(f"{name} {given}: a direction x,y,z such as 0,0,-1")
    x, y, z = found
    return x, y, z


def fixed(value: float, digits: int) -> str:
    """A number with so many decimals, and no minus sign before nothing but zeros."""
    return f"{round(value, digits) + 0.0:.{digits}f}"
