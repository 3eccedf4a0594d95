"""The numbers of a move's part as they stand in its literal, one by one.

A part of a move (target, auxiliary point, speed, zone) has the numbers of its RAPID record, left to
right. Each knows what it is to be read as, so that it can be written as the shortest decimal that
comes back unchanged, and left alone where the text already says it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from ....core.errors import InputError
from ....core.program.speed import Speed
from ....core.program.target import Configuration, JointTarget, PoseTarget
from ....core.program.zone import Fine, Radius
from ....core.source.patch.uses import MovePart
from ....core.source.text.numerals import shortest
from ..motion.configuration import AbbConfiguration
from ..syntax.lexer import number_value
from ..values.records import (
    ARM_AXES,
    EXTERNAL_AXES,
    MM,
    NO_AXIS,
    UNUSED_AXIS,
    arm_axes,
    extax_values,
    metres,
)

ZONE_NUMBERS = 6
JOINT_NUMBERS = 12


@dataclass(frozen=True, slots=True)
class LiteralNumber:
    """One number of a literal.

    Args:
        value: as the core has it; None where the text may say what it likes.
        guess: the same in RAPID's unit, but for rounding.
        convert: RAPID's number to the core's, as the reader does it.
        read: what the number in its place comes to, if that is not ``convert``.
        kept: the core's value has not changed: the text stays, whatever it says.
    """

    value: float | None
    guess: float
    convert: Callable[[float], float]
    read: Callable[[float], float] | None = None
    kept: bool = False

    @property
    def text(self) -> str:
        """The shortest decimal that is read as the value."""
        if self.value is None or abs(self.guess) >= UNUSED_AXIS:
            return "0" if self.value is None else "9E9"
        return shortest(self.value, self.guess, self.convert)

    def text_for(self, present: str) -> str:
        """The text to stand where ``present`` stands: the same if it says the value already."""
        if self.kept or self.value is None:
            return present
        if (self.read or self.convert)(_number(present)) == self.value:
            return present
        return self.text


def numbers_of(
    new: MovePart, old: MovePart | None, axis_kinds: Sequence[str]
) -> tuple[LiteralNumber, ...]:
    """The numbers of a part.

    Args:
        new: what the literal is to say; not a stop point, which has no numbers.
        old: what it says now; None for a literal that is not there yet.
        axis_kinds: ``"linear"`` or ``"rotating"`` for eax_a, eax_b, …

    Raises:
        InputError: RAPID cannot say it.
    """
    if isinstance(new, PoseTarget):
        return _pose_numbers(new, old if isinstance(old, PoseTarget) else None, axis_kinds)
    if isinstance(new, JointTarget):
        axes = arm_axes(axis_kinds)
        if len(new.joints) != axes:
            raise InputError(f"a jointtarget has {axes} arm axes, not {len(new.joints)}")
        return (*map(_degrees, new.joints[:ARM_AXES]), *_extax(new, axis_kinds))
    if isinstance(new, Speed):
        return _speed_numbers(new)
    if isinstance(new, Radius):
        return _zone_numbers(new)
    raise InputError(f"RAPID has no zone by {type(new).__name__}: give it a radius (TCP distance)")


def record_text(new: MovePart, axis_kinds: Sequence[str]) -> str:
    """The literal of a part that is declared anew."""
    if isinstance(new, Fine):
        return "[TRUE,0,0,0,0,0,0]"
    texts = [number.text for number in numbers_of(new, None, axis_kinds)]
    if isinstance(new, Radius):
        return f"[FALSE,{','.join(texts)}]"
    if isinstance(new, Speed):
        return f"[{','.join(texts)}]"
    groups = (3, 4, 4, 6) if isinstance(new, PoseTarget) else (6, 6)
    rest = iter(texts)
    return "[" + ",".join(f"[{','.join(next(rest) for _ in range(n))}]" for n in groups) + "]"


def in_millimetres(value: float) -> LiteralNumber:
    """A length in m, or a speed in m/s."""
    return LiteralNumber(value, value / MM, _metres)


def as_it_is(value: float) -> LiteralNumber:
    """A number without a unit, or one that has the same unit on both sides."""
    return LiteralNumber(value, value, _same)


def _number(text: str) -> float:
    sign, digits = (-1.0, text[1:].strip()) if text.startswith("-") else (1.0, text)
    return sign * number_value(digits)


def _metres(value: float) -> float:
    return metres((value, 0.0, 0.0))[0]


def _same(value: float) -> float:
    return value


def _degrees(value: float) -> LiteralNumber:
    return LiteralNumber(value, math.degrees(value), math.radians)


def _pose_numbers(
    new: PoseTarget, old: PoseTarget | None, axis_kinds: Sequence[str]
) -> tuple[LiteralNumber, ...]:
    # A quaternion is of unit length as a whole: all four change, or none.
    kept = old is not None and old.pose.quaternion == new.pose.quaternion
    rotation = [LiteralNumber(v, v, _same, kept=kept) for v in new.pose.quaternion]
    return (
        *map(in_millimetres, new.pose.position),
        *rotation,
        *_configuration(new.configuration),
        *_extax(new, axis_kinds),
    )


def _configuration(configuration: Configuration | None) -> list[LiteralNumber]:
    if configuration is None:
        return [LiteralNumber(None, 0.0, _same)] * 4
    if not isinstance(configuration, AbbConfiguration):
        raise InputError(f"{configuration} is no confdata: label the target for this robot")
    return list(map(as_it_is, configuration.record))


def _extax(target: PoseTarget | JointTarget, kinds: Sequence[str]) -> list[LiteralNumber]:
    values = extax_values(target, kinds)
    if len(values) > len(kinds):
        raise InputError(
            f"the target has {len(values)} external axes, but the robot that the program was read "
            f"for has {len(kinds)}: read it again with its robot named"
        )
    # Where no axis is programmed some texts say 9E9 and others 0; both are read alike, but for the
    # arm angle.
    free = LiteralNumber(UNUSED_AXIS, UNUSED_AXIS, _same, read=_unused)
    unstated = LiteralNumber(UNUSED_AXIS, UNUSED_AXIS, _same)
    if arm_axes(kinds) > ARM_AXES and not values:
        values = (None,)
    used = [
        (free if kind == NO_AXIS else unstated)
        if value is None
        else (in_millimetres(value) if kind == "linear" else _degrees(value))
        for value, kind in zip(values, kinds, strict=False)
    ]
    return [*used, *[free] * (EXTERNAL_AXES - len(used))]


def _unused(value: float) -> float:
    return UNUSED_AXIS if value == 0 or abs(value) >= UNUSED_AXIS else value


def _speed_numbers(speed: Speed) -> tuple[LiteralNumber, ...]:
    if speed.tcp is None or speed.reorientation is None:
        raise InputError("a speeddata states the speeds of TCP and reorientation: give both")
    return (
        in_millimetres(speed.tcp),
        _degrees(speed.reorientation),
        in_millimetres(speed.external_linear or 0.0),
        _degrees(speed.external_angular or 0.0),
    )


def _zone_numbers(zone: Radius) -> tuple[LiteralNumber, ...]:
    for what, size in (("reorientation", zone.reorientation), ("external", zone.external)):
        if size < zone.tcp:
            raise InputError(
                f"Radius.{what} is {size / MM:g} mm and the TCP's {zone.tcp / MM:g} mm: the "
                "controller makes it at least as large; say so in the program, or take "
                "zone.resized(tcp)"
            )

    def widened(value: float) -> float:
        return max(zone.tcp, _metres(value))

    return (
        in_millimetres(zone.tcp),
        LiteralNumber(zone.reorientation, zone.reorientation / MM, _metres, widened),
        LiteralNumber(zone.external, zone.external / MM, _metres, widened),
        _degrees(zone.angle),
        in_millimetres(zone.external_linear),
        _degrees(zone.external_angular),
    )


def with_radius(zone: Radius, tcp: float) -> Radius:
    r"""The zone under ``\Z``: no part of it is smaller than the TCP's radius."""
    return replace(
        zone,
        tcp=tcp,
        reorientation=max(tcp, zone.reorientation),
        external=max(tcp, zone.external),
        name=None,
    )
