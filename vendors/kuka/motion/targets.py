"""Positions and axis values of KRL → the core's targets.

Components that a target leaves out keep the robot's present value (KRL's rule). External axes
E1, E2, … are the robot's, in its order; without a robot they must be 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial

from ....core.errors import InputError, LeftOpenError, SourceError, Span
from ....core.program.target import JointTarget, PoseTarget
from ....core.robot.joint import JointKind
from ....core.robot.model import Robot
from ....core.source.text.axis_values import arm_values, cell_axis
from ....core.source.text.quick import quick
from ..values.frames import placed
from ..values.provenance import Sources
from ..values.types import AXES, AXIS_FIELDS, EXTERNAL_FIELDS, FRAME_FIELDS, external_fields
from ..values.values import Placement, Struct, Unknown, Value, find_unknown, left_open, shown
from .configuration import KukaConfiguration
from .position import Position

POSE_NUMBERS = (*FRAME_FIELDS, "s", "t", *EXTERNAL_FIELDS)
"""The numbers of a position, in the order of an origin's numbers."""
AXIS_NUMBERS = (*AXIS_FIELDS, *EXTERNAL_FIELDS)
"""The same of axis values."""
_EXTERNAL_NAMES = frozenset(EXTERNAL_FIELDS)
_ROUNDED_TEXT = 1e-5
"""deg, of numbers in texts."""
_ROUNDED = 0.1
"""deg by which a program may round an axis that the controller sets, without a note."""


@quick(frozen=True, slots=True)
class ReadTarget:
    """A target.

    Args:
        complete: all components, those left out filled in, for `Position`.
        sources: the literals of its numbers.
        filled: some components are the robot's present ones.
        predefined: the datum of the shipped configuration that it is.
        supposed: what it depends on that the text does not say; empty if all of it is known.
    """

    target: PoseTarget | JointTarget
    complete: Struct
    sources: Sources
    filled: bool
    predefined: str | None = None
    supposed: str = ""


class Targets:
    """Makes targets.

    Args:
        robot: for its external axes; None if none is named.
        note: takes a note, once for a kind.
    """

    def __init__(
        self, robot: Robot | None, position: Position, note: Callable[[str, str, Span], None]
    ) -> None:
        self._axes = None if robot is None else robot.external_axes
        self._names = external_fields(robot)
        self._robot = robot
        coupled = () if robot is None else robot.coupled_ranges
        self._kept = [one for one in coupled if one.fixed]
        self._position = position
        self._note = note

    def pose(
        self, value: Struct, placement: Placement, status: bool, via: bool, span: Span
    ) -> ReadTarget:
        """A position.

        Args:
            status: whether S and T count, as they do for PTP.
            via: an auxiliary point: neither S and T nor external axes count.

        Raises:
            SourceError: a component is not known, or no number.
        """
        present = partial(self._position.pose, placement, span)
        numbers, filled = _numbers(value.fields, FRAME_FIELDS, present, span)
        external, outside, kept = ((), {}, False) if via else self._external(value.fields, span)
        complete = Struct("e6pos", {**numbers, **outside})
        configuration = None
        if status and not via:
            configuration = self._configuration(value.fields, complete, span)
        try:
            target = PoseTarget(placed(*numbers.values()), configuration, external, value.label)
        except InputError as error:
            raise SourceError(str(error), span) from None
        sources = Sources.of([value.fields.get(name) for name in POSE_NUMBERS])
        return ReadTarget(target, complete, sources, filled or kept, _predefined(value))

    def joints(self, value: Struct, span: Span) -> ReadTarget:
        """Axis values.

        Raises:
            SourceError: as `pose`.
        """
        present = partial(self._position.axes, span)
        numbers, filled = _numbers(value.fields, AXIS_FIELDS, present, span)
        self._keep(numbers, span)
        external, outside, kept = self._external(value.fields, span)
        try:
            arm = arm_values(self._robot, list(numbers.values()))
            target = JointTarget(arm, external, value.label)
        except InputError as error:
            raise SourceError(str(error), span) from None
        sources = Sources.of([value.fields.get(name) for name in AXIS_NUMBERS])
        complete = Struct("e6axis", {**numbers, **outside})
        return ReadTarget(target, complete, sources, filled or kept, _predefined(value))

    def _keep(self, numbers: dict[str, float], span: Span) -> None:
        """Set the axis by which the controller keeps a sum, as palletisers' A5."""
        for kept in self._kept:
            *others, (name, factor) = kept.terms
            rest = sum(size * numbers[other.lower()] for other, size in others)
            level = (math.degrees(0.5 * (kept.lower + kept.upper)) - rest) / factor
            asked = numbers[name.lower()]
            within = math.degrees(0.5 * (kept.upper - kept.lower)) / abs(factor)
            if abs(asked - level) <= within + _ROUNDED_TEXT:
                continue
            numbers[name.lower()] = level
            if abs(asked - level) > _ROUNDED:
                text = f"{name} goes to {level:g}°, not {asked:g}°: {kept.reason} ($PAL_MODE)"
                self._note("kept", text, span)

    def _configuration(
        self, fields: Mapping[str, Value], complete: Struct, span: Span
    ) -> KukaConfiguration | None:
        found: dict[str, int | None] = {"s": None, "t": None}
        for name in found:
            value = fields.get(name)
            if value is None:
                continue
            if name not in self._names and self._axes is not None and find_unknown(value):
                continue  # $AXIS_ACT.E2 of a robot that has no such axis
            number = _number(name, value, span)
            if number != int(number):
                raise SourceError(f"{name.upper()} is a whole number, not {number:g}", span)
            found[name] = complete.fields[name] = int(number)
        if found["s"] is None and found["t"] is None:
            return None
        try:
            return KukaConfiguration(found["s"], found["t"])
        except InputError as error:
            raise SourceError(str(error), span) from None

    def _external(
        self, fields: Mapping[str, Value], span: Span
    ) -> tuple[tuple[float, ...], dict[str, Value], bool]:
        """External axes in rad and m as far as they are programmed, the same in mm and degrees,
        and whether one of them keeps its present value."""
        if _EXTERNAL_NAMES.isdisjoint(fields):
            return (), {}, False
        given: dict[int, float] = {}
        for name in EXTERNAL_FIELDS:
            value = fields.get(name)
            if value is None:
                continue
            if name not in self._names and self._axes is not None and find_unknown(value):
                continue  # $AXIS_ACT.E2 of a robot that has no such axis
            number = _number(name, value, span)
            if name in self._names:
                given[self._names.index(name)] = number
            elif number != 0:
                self._no_axis(name.upper(), number, span)
        if not given:
            return (), {}, False
        last = max(given)
        kept = any(k not in given for k in range(last + 1))
        for k in range(last + 1):
            if k not in given:
                present = self._position.external(k)
                if not isinstance(present, int | float):
                    raise SourceError(
                        f"the target leaves out {self._names[k].upper()}, and where that axis "
                        "stands is not known",
                        span,
                    )
                given[k] = float(present)
        converted = [
            given[k] / 1000 if axis.joint.kind is JointKind.PRISMATIC else math.radians(given[k])
            for k, axis in zip(range(last + 1), self._axes or (), strict=False)
        ]
        outside: dict[str, Value] = {self._names[k]: given[k] for k in range(last + 1)}
        return tuple(converted), outside, kept

    def _no_axis(self, name: str, number: float, span: Span) -> None:
        """An axis that the robot does not have.

        Raises:
            SourceError: no robot is named.
        """
        if self._axes is None:
            raise SourceError(
                f"external axis {name} is sent to {number:g}, and the text does not say whether "
                "that is mm or degrees: name the robot",
                span,
            )
        has = "no external axes"
        if self._names:
            has = f"{' and '.join(known.upper() for known in self._names)} alone"
        self._note(
            name,
            f"external axis {name} is sent to {number:g} here, but the robot has {has}: the arm "
            f"is driven without it{cell_axis(name, self._robot)}",
            span,
        )


def _numbers(
    fields: Mapping[str, Value],
    names: tuple[str, ...],
    present: Callable[[], Struct | Unknown],
    span: Span,
) -> tuple[dict[str, float], bool]:
    """The components of a target, and whether some of them are the robot's present ones."""
    missing = [name for name in names if name not in fields]
    if missing:
        standing = present()
        if isinstance(standing, Unknown):
            left_out = ", ".join(name.upper() for name in missing)
            raise LeftOpenError(
                f"the target leaves out {left_out}: it keeps {standing.reason}", span
            )
        fields = {**{name: standing.fields[name] for name in missing}, **fields}
    return {name: _number(name, fields[name], span) for name in names}, bool(missing)


def _number(name: str, value: Value, span: Span) -> float:
    if isinstance(value, float) or (isinstance(value, int) and not isinstance(value, bool)):
        return float(value)
    unknown = find_unknown(value)
    if unknown is not None:
        raise left_open(f"{name.upper()} of the target", unknown, span)
    raise SourceError(f"{name.upper()} of the target is a number, not {shown(value)}", span)


def _predefined(value: Struct) -> str | None:
    return value.label if value.shipped else None


def is_axes(value: Struct) -> bool:
    """Whether a structure holds axis values, by its type or its components."""
    if value.type in AXES:
        return True
    return value.type == "" and any(name in value.fields for name in AXIS_FIELDS)
