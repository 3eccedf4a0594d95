"""Where a move goes: a pose of the TCP in the work object, or joint values."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from ..errors import InputError
from ..spatial.pose import Pose


@runtime_checkable
class Configuration(Protocol):
    """A vendor's label for an inverse-kinematics solution (ABB confdata, KUKA S and T).

    It knows its own vendor's rules, so that the core can ask without knowing them.
    """

    @property
    def hint(self) -> bool:
        """Whether it only says where to look first: the nearest solution is taken, however far."""
        ...

    def admits(self, label: Configuration) -> bool:
        """Whether the controller drives to a solution of this label: to that of least mismatch,
        where it may choose."""
        ...

    def mismatch(self, label: Configuration) -> float:
        """How far ``label``, the label of a solution, is from this one, 0 for a match.

        Undefined parts (a turn that was not programmed) count as matching.
        """
        ...


@dataclass(frozen=True, slots=True)
class PoseTarget:
    """A pose of the TCP in the work object.

    Args:
        pose: TCP in the work object's frame.
        configuration: which inverse-kinematics solution; None for the one nearest to the
            configuration before.
        external: external axes, rad or m, in the robot's order; axes beyond the tuple keep
            their value.
        name: name of the datum in the source, kept for the writer.
        arm_angle: rad, of an arm with seven axes (`core/robot/arm_angle.py`); None where the
            program states none: the third axis keeps its value.
    """

    pose: Pose
    configuration: Configuration | None = None
    external: tuple[float, ...] = ()
    name: str | None = None
    arm_angle: float | None = None

    def __post_init__(self) -> None:
        if not all(map(math.isfinite, self.external)):
            raise InputError(f"external axis values must be finite, not {self.external}")
        if self.arm_angle is not None and not math.isfinite(self.arm_angle):
            raise InputError(f"an arm angle must be finite, not {self.arm_angle}")


@dataclass(frozen=True, slots=True)
class JointTarget:
    """Joint values.

    Args:
        joints: the arm's joints in rad (m if prismatic).
        external: as in `PoseTarget`.
        name: name of the datum in the source.
    """

    joints: tuple[float, ...]
    external: tuple[float, ...] = ()
    name: str | None = None

    def __post_init__(self) -> None:
        if not all(map(math.isfinite, (*self.joints, *self.external))):
            raise InputError(f"joint values must be finite, not {self.joints} {self.external}")


Target = PoseTarget | JointTarget


def target_shown(target: Target) -> str:
    """A target by its name; one without by its position in mm, or its values in rad and m."""
    if target.name is not None:
        return target.name
    if isinstance(target, PoseTarget):
        return f"{', '.join(f'{1e3 * x:z.1f}' for x in target.pose.position)} mm"
    return f"joints {', '.join(f'{q:z.4g}' for q in (*target.joints, *target.external))}"
