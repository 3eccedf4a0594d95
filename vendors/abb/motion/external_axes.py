"""External axes in targets: which the robot has, and what becomes of those that it has not."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ....core.errors import InputError, SourceError, Span
from ....core.source.execution.transcript import Notes
from ....core.source.text.axis_values import cell_axis
from ..values.records import (
    ARM_AXES,
    AXIS_KINDS,
    EXTERNAL_AXES,
    NO_AXIS,
    PER_METRE,
    SEVENTH,
    UNUSED_AXIS,
    arm_axes,
)
from .settings import SettingsInForce

if TYPE_CHECKING:
    from ....core.robot.joint import ExternalAxis
    from ....core.robot.model import Robot

LETTERS = "abcdef"
"""Of eax_a to eax_f."""
_NAMES = tuple(f"eax_{letter}" for letter in LETTERS)
TEACHING = 0.05
"""mm or degrees: points that are taught on a standing axis differ by less."""


class ExternalAxes:
    """Makes the values of a robot's external axes of those in targets.

    Args:
        kinds: ``"linear"`` or ``"rotating"`` for eax_a, eax_b, … of the robot, ``"none"`` for one
            that it has not and that stands before one that it has; None if the robot is not known.
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
        kinds = self._kinds
        places = [place for place, kind in enumerate(kinds) if kind != NO_AXIS]
        for number in range(len(extax)):
            if used[number] and number not in places:
                self._stands(number, extax[number], span)
        last = max((place for place in places if used[place]), default=-1)
        driven = [place for place in places if place <= last]
        for place in driven:
            if not used[place]:
                self._left_out(place, used.index(True, place), span)
        return tuple(
            extax[i] / PER_METRE if kinds[i] == "linear" else math.radians(extax[i]) for i in driven
        )

    def _left_out(self, place: int, behind: int, span: Span) -> None:
        """An axis of the robot that has no value, and the next one that has.

        Raises:
            SourceError: always.
        """
        none, given = (f"eax_{LETTERS[number]}" for number in (place, behind))
        raise SourceError(
            f"external axis {none} has no value (9E9), and {given} behind it has: give it a value, "
            "or, if the robot has no such axis, say in the cell file which ones it has: "
            f"[external_axis.…] with number = {behind + 1} is {given}",
            span,
        )

    def _stands(self, number: int, value: float, span: Span) -> None:
        """An axis that the robot has not, which must stay where it is."""
        axis = f"eax_{LETTERS[number]}"
        stands = self._standing.setdefault(number, value)
        if abs(value - stands) > TEACHING:
            assert self._kinds is not None
            raise SourceError(
                f"external axis {axis} is moved from {stands:g} to {value:g}, and the robot has "
                f"{_those(self._kinds)}{cell_axis(axis, self._robot)}{_arm_of_seven(number)}",
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
                    f"external axis eax_{LETTERS[number]} is sent to {value:g}, and the text does "
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


def _those(kinds: Sequence[str]) -> str:
    """The external axes that a robot has, in words."""
    names = [f"eax_{LETTERS[place]}" for place, kind in enumerate(kinds) if kind != NO_AXIS]
    return ", ".join(names) + " only" if names else "0 external axes"


def _arm_of_seven(number: int) -> str:
    if number != 0:
        return ""
    return (
        "; if the arm has seven axes, name it (IRB 14050, YuMi left, YuMi right): eax_a is one of "
        "them"
    )


def tables(robot: Robot | None) -> str:
    """The external axes that carry work objects, in words; empty if there is none."""
    axes = () if robot is None else robot.external_axes
    return " or ".join(axis.name for axis in axes if axis.role == "table")


def axis_kinds(robot: Robot | None) -> tuple[str, ...] | None:
    """How RAPID counts what an extjoint states of the robot, eax_a first; None without a robot."""
    if robot is None:
        return None
    from ....core.robot.joint import JointKind  # late: it takes time

    kinds = [SEVENTH] if robot.arm_size == ARM_AXES + 1 else []
    for axis in robot.external_axes:
        place = _place(axis)
        if place is not None:
            if not len(kinds) <= place < EXTERNAL_AXES:
                raise InputError(
                    f"external axis {axis.name} is eax_{LETTERS[place]} of targets, or behind it, "
                    "and so is one before it: let external axes stand in the order of their places"
                    if place < EXTERNAL_AXES
                    else f"external axis {axis.name} has the number {place + 1}: RAPID has six"
                )
            kinds += [NO_AXIS] * (place - len(kinds))
        kinds.append("linear" if axis.joint.kind is JointKind.PRISMATIC else "rotating")
    return tuple(kinds)


def _place(axis: ExternalAxis) -> int | None:
    """The place of an axis in an extjoint, from 0, by its number or a name as ``eax_b``."""
    if axis.number is not None:
        return axis.number - 1
    name = axis.name.casefold()
    return LETTERS.index(name[-1]) if name in _NAMES else None
