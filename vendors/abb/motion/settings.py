"""Motion settings: what holds for all moves until it is changed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from ....core.program.arc_orientation import ArcOrientation
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
        path_acceleration, world_acceleration: limits of the TCP's, m/s² (PathAccLim, WorldAccLim).
        override: factor on programmed speeds (VelSet).
        refreshed: another one (SpeedRefresh).
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
    path_acceleration: float | None = None
    world_acceleration: float | None = None
    override: float = 1.0
    refreshed: float = 1.0
    greatest_tcp: float | None = None
    load: Load | None = None
    displacement: Pose | None = None
    offsets: tuple[float, ...] | None = None
    arc: ArcOrientation | str = ArcOrientation.FOLLOWS_ARC

    @property
    def tcp_acceleration(self) -> float | None:
        """The smaller limit of the TCP's acceleration, m/s²; None for none."""
        limits = (self.path_acceleration, self.world_acceleration)
        return min((a for a in limits if a is not None), default=None)

    @property
    def speed_factor(self) -> float:
        """On programmed speeds."""
        return self.override * self.refreshed


@dataclass(slots=True)
class SettingsInForce:
    """The settings that hold now: instructions put others in their place.

    Attributes:
        now: values of them.
        lost: by the name of a setting, why nobody knows what it is: who set it last is damaged.
        supposed: likewise, of one that something is taken for: the program does not say all of it.
    """

    now: Settings = Settings()
    lost: dict[str, str] = field(default_factory=dict)
    supposed: dict[str, str] = field(default_factory=dict)

    def change(self, **settings: object) -> None:
        """Settings that are known from here on."""
        values: dict[str, Any] = dict(settings)
        self.now = replace(self.now, **values)
        for name in settings:
            self.lost.pop(name, None)
            self.supposed.pop(name, None)

    def suppose(self, name: str, value: object, reason: str) -> None:
        """A setting of which something is taken for what the program does not say.

        Args:
            reason: what it depends on; empty if all of it is known.
        """
        self.change(**{name: value})
        if reason:
            self.supposed[name] = reason

    def lose(self, names: Iterable[str], why: str) -> None:
        """From here on nobody knows what these settings are, until they are set again."""
        self.lost |= dict.fromkeys(names, why)

    def lost_of(self, names: Iterable[str]) -> str:
        """Why one of these settings is not known; empty if all are."""
        return _first(self.lost, names)

    def supposed_of(self, names: Iterable[str]) -> str:
        """What one of these settings depends on that the program does not say; empty if nothing."""
        return _first(self.supposed, names)


def _first(reasons: Mapping[str, str], names: Iterable[str]) -> str:
    return next((reasons[name] for name in names if name in reasons), "")
