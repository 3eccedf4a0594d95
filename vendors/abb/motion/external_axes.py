"""External axes in targets: which the robot has, and what becomes of those that it has not."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ....core.door import spelt
from ....core.errors import InputError, SourceError, Span
from ....core.source.execution.transcript import Notes
from ..values.records import ARM_AXES, AXIS_KINDS, PER_METRE, SEVENTH, UNUSED_AXIS, arm_axes
from .settings import SettingsInForce

if TYPE_CHECKING:
    from ....core.robot.model import Robot

TEACHING = 0.05
"""mm or degrees: points that are taught on a standing axis differ by less."""


class ExternalAxes:
    """Makes the values of a robot's external axes of those in targets.

    Args:
        kinds: ``"linear"`` or ``"rotating"`` for eax_a, eax_b, … of the robot; None if the robot
            is not known.
        robot: None if it is not known.
    """

    def __init__(
        self,
        settings: SettingsInForce,
        notes: Notes,
        kinds: Sequence[str] | None,
        robot: Robot | None,
    ) -> None:
        for kind in kinds or ():
            if kind not in AXIS_KINDS:
                raise InputError(f"an external axis is one of {AXIS_KINDS}, not {kind!r}")
        self._settings = settings
        self._notes = notes
        self._kinds = kinds
        self._robot = robot
        self._standing: dict[int, float] = {}  # values of axes that the robot has not

    @property
    def lacking(self) -> str:
        """What a robot without external axes lacks, to move them; empty if it has some."""
        if self._kinds is None or self._kinds:
            return ""
        return f"the robot has no external axes{cell_axis('eax_a', self._robot)}"

    @property
    def has_seventh(self) -> bool:
        """Whether eax_a is of the arm itself, which has seven axes."""
        return arm_axes(self._kinds or ()) > ARM_AXES

    def with_seventh(
        self, extax: Sequence[float], span: Span, offsets: bool = True
    ) -> tuple[float | None, tuple[float, ...]]:
        """What eax_a says of an arm with seven axes (None if nothing), and the external axes.

        Args:
            extax, span, offsets: as of `values`, and so the errors.
        """
        found = self.values(extax, span, offsets)
        if not self.has_seventh or not found:
            return None, found
        return found[0], found[1:]

    def values(self, extax: Sequence[float], span: Span, offsets: bool = True) -> tuple[float, ...]:
        """External axes in rad and m, in the robot's order, as far as they are programmed.

        Args:
            extax: as the target states them, mm or degrees.
            span: of the target.
            offsets: whether those in force (EOffsSet) are added.

        Raises:
            SourceError: one has no value and a later one has, or the robot has it not and it is
                moved.
        """
        used = [abs(v) < UNUSED_AXIS for v in extax]
        shift = self._settings.now.offsets
        if offsets and shift is not None:
            pairs = zip(extax, shift, used, strict=True)
            extax = [v + s if counts and abs(s) < UNUSED_AXIS else v for v, s, counts in pairs]
        if not any(used):
            return ()
        if self._kinds is None:
            return self._of_unknown_robot(extax, used, span)
        count = len(self._kinds)
        for number in range(count, len(extax)):
            if used[number]:
                self._stands(number, extax[number], span)
        last = max((i for i in range(count) if used[i]), default=-1)
        if not all(used[: last + 1]):
            raise SourceError(
                "an external axis without a value (9E9) stands before one that has a value: give "
                "it a value",
                span,
            )
        kinds = self._kinds
        return tuple(
            extax[i] / PER_METRE if kinds[i] == "linear" else math.radians(extax[i])
            for i in range(last + 1)
        )

    def _stands(self, number: int, value: float, span: Span) -> None:
        """An axis that the robot has not, which must stay where it is."""
        axis = f"eax_{'abcdef'[number]}"
        stands = self._standing.setdefault(number, value)
        if abs(value - stands) > TEACHING:
            assert self._kinds is not None
            raise SourceError(
                f"external axis {axis} is moved from {stands:g} to {value:g}, and the robot has "
                f"{len(self._kinds)} external axes{cell_axis(axis, self._robot)}; if the arm has "
                "seven axes, name it (IRB 14050, YuMi left, YuMi right): eax_a is one of them",
                span,
            )
        if value != 0:
            self._notes.once(
                f"external axis {number}",
                f"external axis {axis} is sent to {value:g}, and the robot has none of that "
                "number: it is taken to stand there throughout, and left out; what it would carry, "
                f"the arm or the work, is taken to stand where it is without it"
                f"{cell_axis(axis, self._robot)}",
                span,
            )

    def _of_unknown_robot(
        self, extax: Sequence[float], used: Sequence[bool], span: Span
    ) -> tuple[float, ...]:
        for number, value in enumerate(extax):
            if used[number] and value != 0:
                raise SourceError(
                    f"external axis eax_{'abcdef'[number]} is sent to {value:g}, and the text does "
                    "not say whether that is mm or degrees: tell the reader the robot's axes "
                    "(external_axes=('linear',) or ('rotating',))",
                    span,
                )
        self._notes.once(
            "external axes",
            "external axes are sent to 0 everywhere; they are taken as not there (9E9 says so)",
            span,
        )
        return ()


def cell_axis(name: str, robot: Robot | None) -> str:
    """What to write into a cell file for an external axis, to stand at the end of a message."""
    arm = "vendor/robot" if robot is None else robot.name
    return (
        f'; to drive it, give a cell file ({spelt("cell")}): robot = "{arm}", '
        f'[external_axis.{name}] with role = "table" or "track", kind = "revolute" or '
        '"prismatic", axis, pose, range, speed and acceleration'
    )


def axis_kinds(robot: Robot | None) -> tuple[str, ...] | None:
    """How RAPID counts what an extjoint states of the robot, eax_a first; None without a robot."""
    if robot is None:
        return None
    from ....core.robot.joint import JointKind  # late: it takes time

    axes = [axis.joint.kind for axis in robot.external_axes]
    own = (SEVENTH,) if robot.arm_size == ARM_AXES + 1 else ()
    return *own, *("linear" if kind is JointKind.PRISMATIC else "rotating" for kind in axes)
