"""Motion settings: what holds for all moves until it is changed."""

from __future__ import annotations

from dataclasses import dataclass

from ....core.program.move import ArcOrientation
from ....core.program.tool import Load
from ....core.spatial.pose import Pose


@dataclass(frozen=True, slots=True)
class Settings:
    """Motion settings, with the values that they have at the start of a program.

    Args:
        check_joint, check_linear: whether joint and TCP moves obey a target's configuration.
        singularity: ``off``, ``wrist`` or ``lockaxis4``.
        acceleration: share of the robot's own, in (0, 1].
        ramp: share of the robot's own jerk, in (0, 1].
        tcp_acceleration: limit, m/s².
        override: factor on programmed speeds.
        greatest_tcp: limit on the TCP's speed, mm/s.
        load: carried by the gripper.
        displacement: program displacement, in the object frame.
        offsets: of external axes, as an extjoint.
        arc: how the tool turns on an arc; a mode's name if it has no equivalent.
    """

    check_joint: bool = True
    check_linear: bool = True
    singularity: str = "off"
    acceleration: float = 1.0
    ramp: float = 1.0
    tcp_acceleration: float | None = None
    override: float = 1.0
    greatest_tcp: float | None = None
    load: Load | None = None
    displacement: Pose | None = None
    offsets: tuple[float, ...] | None = None
    arc: ArcOrientation | str = ArcOrientation.FOLLOWS_ARC


@dataclass(slots=True)
class SettingsInForce:
    """The settings that hold now: instructions put others in their place."""

    now: Settings = Settings()
