"""RAPID values → the core's values, with the place named in every refusal."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, TypeVar

from ....core.errors import InputError, Note, SourceError, Span
from ....core.program.speed import Speed
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.tool import Load, Tool, WorkObject
from ....core.program.zone import FINE, Zone
from ....core.source.execution.scopes import alike
from ....core.source.execution.transcript import Notes
from ....core.source.text.axis_values import arm_values, cell_axis
from ....core.spatial.pose import IDENTITY, Pose, Quaternion
from ..syntax.tree import Expression, Name
from ..values.evaluator import Evaluator
from ..values.located import Located
from ..values.records import (
    LOAD0,
    PER_METRE,
    UNUSED_AXIS,
    VMAX,
    Record,
    carried,
    check_speed,
    load_value,
    metres,
    standing,
    tool_value,
    work_object_value,
    zone_value,
)
from ..values.scope import Scope, unknown_name
from ..values.types import (
    LOADDATA,
    ORIENT,
    POSE,
    SPEEDDATA,
    TOOLDATA,
    WOBJDATA,
    ZONEDATA,
    RecordType,
    Type,
    Value,
)
from .configuration import AbbConfiguration
from .external_axes import ExternalAxes, tables
from .settings import SettingsInForce

if TYPE_CHECKING:
    from ....core.robot.model import Robot

NORM_TOLERANCE = 0.05
"""A quaternion whose length is off by more is a mistake, no rounding."""
ROUNDED = 1e-3
"""What three written decimals leave of it: more is worth a correction."""
EXACT = 1e-6
"""What a `Pose` takes as it stands, and `records` does: reading and writing keep the digits."""
ROUNDING = 2e-5
"""What five written decimals leave of a quaternion's unit length: not worth a note."""

UNDEFINED_MASS = -1.0
_ROBOT = "rob_"
"""What names of arms begin with, among mechanical units."""

T = TypeVar("T")


class Converter:
    """Makes targets, speeds, zones, tools and frames of RAPID values.

    Args:
        external_axes: ``"linear"`` or ``"rotating"`` for eax_a, eax_b, … of the robot; None if
            the robot is not known.
        robot: None if it is not known.
    """

    def __init__(
        self,
        settings: SettingsInForce,
        notes: Notes,
        external_axes: Sequence[str] | None,
        robot: Robot | None = None,
    ) -> None:
        self._settings = settings
        self._notes = notes
        self._robot = robot
        self._quaternions: dict[Span, float] = {}
        self._made: dict[tuple[object, ...], object] = {}
        self.external = ExternalAxes(settings, notes, external_axes, robot)

    def notes(self) -> tuple[Note, ...]:
        """What is to be said about quaternions that had to be scaled to unit length."""
        if not self._quaternions:
            return ()
        worst = max(self._quaternions.values())
        first, count = next(iter(self._quaternions)), len(self._quaternions)
        what = "a quaternion is" if count == 1 else f"{count} quaternions are"
        message = f"{what} not of unit length (by {worst:.1g} at most): normalised"
        if worst > ROUNDED:
            message += "; a controller may refuse them: write them with five digits, or NOrient"
        return (Note(message, span=first),)

    # ------------------------------------------------------- tools, frames, loads

    def tool(self, found: Located, expression: Expression) -> Tool:
        """A tooldata."""
        name = self._name(found, expression, "tool")
        value = self._with_load(found.value, name, expression.span)
        return self._cached(
            ("tool", name, value),
            lambda: self._made_of(tool_value, value, TOOLDATA, name, expression.span),
        )

    def _with_load(self, value: Value, name: str, span: Span) -> Value:
        """A tooldata whose load is defined: a new tool has the mass -1 until somebody weighs it."""
        assert isinstance(value, tuple)
        if value[2][0] != UNDEFINED_MASS:
            return value
        message = f"the load of tool {name} is not defined (mass -1): none is taken"
        self._notes.once(f"load of {name}", message, span)
        return (*value[:2], LOAD0)

    def work_object(self, found: Located, expression: Expression) -> WorkObject:
        """A wobjdata."""
        value, name = found.value, self._name(found, expression, "wobj")
        assert isinstance(value, tuple)
        if not value[1] and not value[2]:
            raise SourceError(
                "ufprog is FALSE, so a mechanical unit moves the work object, but ufmec names none",
                expression.span,
            )
        followed = value[1] or self._carries(value[2])
        if not followed:
            self._notes.once(
                f"carrier of {name}",
                f"work object {name} is moved by {value[2]}, which is no axis of this robot "
                f"{self._unit_in_words(value[2])}",
                expression.span,
            )

        def make(record: Record, name: str) -> WorkObject:
            made = work_object_value(record, name)
            if not followed:
                return standing(made)
            if made.moved_by is not None and made.user != IDENTITY:
                self._notes.once(
                    f"user frame of {name}",
                    f"the uframe of work object {name} does not count, as {made.moved_by} moves it "
                    "(ufprog FALSE): the controller takes the frame of that unit",
                    expression.span,
                )
            return carried(made)

        return self._cached(
            ("work object", name, value),
            lambda: self._made_of(make, value, WOBJDATA, name, expression.span),
        )

    def _unit_in_words(self, unit: str) -> str:
        """What a mechanical unit may be that the robot has not, and what is to be done."""
        stands = "it is taken to stand where it is declared"
        if unit.casefold().startswith(_ROBOT):
            return (
                f"(another robot, by its name): {stands}; paths in a frame that another robot "
                "moves are not driven yet, so what these moves do is not known"
            )
        own = tables(self._robot)
        cell = f"; if {own} carries it, call that axis so in the cell file" if own else ""
        cell = cell or cell_axis(unit, self._robot)
        return f"(a conveyor, or a unit of another task): {stands}{cell}"

    def _carries(self, unit: str) -> bool:
        """Whether the robot has an external axis of that name, or nobody knows."""
        robot = self._robot
        return robot is None or any(axis.name == unit for axis in robot.external_axes)

    def load(self, evaluator: Evaluator, expression: Expression, scope: Scope) -> Load | None:
        """A loaddata; None for ``load0``."""
        value = evaluator.known(expression, scope, LOADDATA, "the load")
        record = self._units(value, LOADDATA, expression.span)
        name = expression.text if isinstance(expression, Name) else None
        with_name: Load | None = self._guard(expression.span, lambda: load_value(record, name))
        return with_name

    def pose(self, value: Value, span: Span) -> Pose:
        """A pose."""
        record = self._units(value, POSE, span)
        return self._guard(span, lambda: Pose(metres(record[0]), _quaternion(record[1])))

    def _made_of(
        self,
        make: Callable[[Record, str], T],
        value: Value,
        type_: RecordType,
        name: str,
        span: Span,
    ) -> T:
        record = self._units(value, type_, span)
        return self._guard(span, lambda: make(record, name))

    def _cached(self, key: tuple[object, ...], make: Callable[[], T]) -> T:
        """One value for equal data, made once: programs repeat few tools, speeds and zones."""
        if key not in self._made:
            self._made[key] = make()
        return self._made[key]  # type: ignore[return-value]

    @staticmethod
    def _name(found: Located, expression: Expression, otherwise: str) -> str:
        if isinstance(expression, Name) and not expression.path:
            return found.cell.name if found.cell is not None else expression.text
        return otherwise if found.source is None or not found.source.datum else found.source.datum

    # ------------------------------------------------------------ speeds and zones

    def speed(
        self,
        record: Record,
        name: str | None,
        tcp: float | None,
        duration: float | None,
        span: Span,
    ) -> Speed:
        """A speeddata under the settings in force.

        Args:
            record: ``[v_tcp, v_ori, v_leax, v_reax]``.
            tcp: ``\\V`` in mm/s, None if absent.
            duration: ``\\T`` in s, None if absent.
        """
        key = ("speed", record, name, tcp, duration, self._settings.now)
        return self._cached(key, lambda: self._speed(record, name, tcp, duration, span))

    def _speed(
        self,
        record: Record,
        name: str | None,
        tcp: float | None,
        duration: float | None,
        span: Span,
    ) -> Speed:
        settings = self._settings.now
        self._guard(span, lambda: check_speed(record, tcp, duration))
        v_tcp, v_ori, v_leax, v_reax = record
        programmed = (v_tcp if tcp is None else tcp, v_ori, v_leax, v_reax)
        scaled = [v * settings.speed_factor for v in programmed]
        if settings.greatest_tcp is not None:
            scaled[0] = min(scaled[0], settings.greatest_tcp)
        changed = duration is not None or tuple(scaled) != record
        # Zero speeds of external axes are common where there are none.
        linear, angular = scaled[2:]
        return self._guard(
            span,
            lambda: Speed(
                tcp=scaled[0] / PER_METRE,
                reorientation=math.radians(scaled[1]),
                external_linear=linear / PER_METRE if linear != 0 else None,
                external_angular=math.radians(angular) if angular != 0 else None,
                tcp_acceleration=settings.tcp_acceleration,
                joint_acceleration_fraction=settings.acceleration,
                jerk_fraction=settings.ramp,
                duration=None if duration is None else duration / settings.speed_factor,
                name=None if changed else name,
            ),
        )

    def zone(self, record: Record, name: str | None, tcp: float | None, span: Span) -> Zone:
        """A zonedata.

        The zones of reorientation and external axes are at least as large as the TCP's
        ("RAPID Reference Manual", zonedata).

        Args:
            tcp: ``\\Z`` in mm, None if absent.
        """
        if record[0]:
            return FINE
        radius = record[1] if tcp is None else tcp
        widened = (False, radius, max(radius, record[2]), max(radius, record[3]), *record[4:])
        kept = name if tcp is None or tcp == record[1] else None
        key = ("zone", widened, kept)
        return self._cached(key, lambda: self._guard(span, lambda: zone_value(widened, kept)))

    # -------------------------------------------------------------------- targets

    def pose_target(self, value: Value, name: str | None, follow: bool, span: Span) -> PoseTarget:
        """A robtarget.

        Args:
            follow: whether its configuration counts for the move.
        """
        assert isinstance(value, tuple)
        trans, orient, robconf, extax = value
        rot = self._unit(orient, span)
        configuration = self._configuration(robconf, span) if follow else None
        arm_angle, external = self.external.with_seventh(extax, span)
        pose = self._guard(span, lambda: Pose(metres(trans), _quaternion(rot)))
        displacement = self._settings.now.displacement
        if displacement is not None:
            pose = displacement @ pose
        return PoseTarget(pose, configuration, external, name, arm_angle)

    def joint_target(
        self, value: Value, name: str | None, offsets: bool, span: Span
    ) -> JointTarget:
        """A jointtarget.

        Args:
            offsets: whether offsets of external axes count for the move.
        """
        assert isinstance(value, tuple)
        robax, extax = value
        for number, degrees in enumerate(robax):
            if abs(degrees) >= UNUSED_AXIS:
                raise SourceError(f"axis {number + 1} of the arm has no value (9E9)", span)
        joints = arm_values(self._robot, robax)
        seventh, external = self.external.with_seventh(extax, span, offsets)
        if self.external.has_seventh and seventh is None:
            raise SourceError("axis 7 of the arm, eax_a, has no value (9E9)", span)
        own = () if seventh is None else (seventh,)
        return self._guard(span, lambda: JointTarget((*joints, *own), external, name))

    def _configuration(self, robconf: Sequence[float], span: Span) -> AbbConfiguration:
        if any(v != int(v) for v in robconf):
            raise SourceError(f"a confdata has whole numbers, not {list(robconf)}", span)
        cf1, cf4, cf6, cfx = (int(v) for v in robconf)
        seven = self.external.has_seventh
        return self._guard(span, lambda: AbbConfiguration(cf1, cf4, cf6, cfx, seven=seven))

    # -------------------------------------------------------------------- helpers

    def _units(self, value: Value, type_: RecordType, span: Span) -> Record:
        """A record whose quaternions are of unit length."""
        assert isinstance(value, tuple)
        if type_ is ORIENT:
            return self._unit(value, span)
        return tuple(
            self._units(part, component, span) if isinstance(component, RecordType) else part
            for part, component in zip(value, type_.components.values(), strict=True)
        )

    def _unit(self, orient: Record, span: Span) -> Record:
        length = math.sqrt(sum(v * v for v in orient))
        error = abs(length - 1.0)
        if not error <= NORM_TOLERANCE:
            shown = ",".join(f"{v:g}" for v in orient)
            raise SourceError(
                f"an orientation is a quaternion of length 1, but [{shown}] has {length:.4g}: "
                "correct it, or normalise it with NOrient",
                span,
            )
        if error > ROUNDING:
            self._quaternions.setdefault(span, error)
        return orient if error <= EXACT else tuple(v / length for v in orient)

    @staticmethod
    def _guard(span: Span, make: Callable[[], T]) -> T:
        try:
            return make()
        except InputError as error:
            raise SourceError(str(error), span) from None


def _quaternion(orient: Record) -> Quaternion:
    w, x, y, z = orient
    return (w, x, y, z)


_ALIKE = 0.85
"""Share of its letters in which a name is like another one by mistake."""


def undeclared(kind: str, name: Name, type_: Type, scope: Scope) -> str:
    """That a datum of a move is not declared, with the nearest of its type.

    Raises:
        SourceError: it looks like one of them, mistyped; names that differ in their numbers do not.
    """
    known: list[str] = []
    for inner in scope.outwards():
        known += [cell.name for cell in inner.cells.values() if cell.type == type_]
    otherwise = "declare it, name the file that declares it, or put it beside this one"
    message = unknown_name(kind, name.text, known, otherwise)
    mistyped = alike(name.name, tuple(other.lower() for other in known), 1, _ALIKE)
    if mistyped and _DIGITS.sub("", mistyped[0]) != _DIGITS.sub("", name.name):
        raise SourceError(message, name.span)
    return message


_DIGITS = re.compile(r"[0-9]+")
_BY_NUMBER = re.compile(r"(?P<kind>[vz])(?P<number>[0-9]{1,4})")


def points_nowhere(target: Value) -> bool:
    """Whether a robtarget has an orientation of zeros, as its numbers were never set."""
    return isinstance(target, tuple) and len(target) == 4 and target[1] == (0.0, 0.0, 0.0, 0.0)


def named_by_number(name: str, type_: Type) -> Record | None:
    """What a speed or zone that nobody declares says by its name: ``v250``, ``z25``."""
    found = _BY_NUMBER.fullmatch(name)
    if found is None or type_ is not {"v": SPEEDDATA, "z": ZONEDATA}[found["kind"]]:
        return None
    number = float(found["number"])
    if type_ is SPEEDDATA:
        return (number, *VMAX[1:])
    around = 1.5 * number
    return (False, number, around, around, around / 10, around, around / 10)
