"""World zones that a program has the controller watch ("RAPID Reference Manual": WZBoxDef,
WZCylDef, WZSphDef, WZHomeJointDef, WZLimJointDef, WZDOSet).

They are mostly set up in a routine that runs when the controller starts, and that no program calls.
So they are looked for in all modules, and followed as far as their corners are constants.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

from ...core.errors import Note, SourceError
from ...core.source.text.axis_values import arm_values
from ...core.source.text.files import SourceFile, SourceText
from .syntax import tree
from .syntax.parser import parse

if TYPE_CHECKING:
    from ...core.program.world_zone import WorldZone
    from ...core.robot.model import Robot

Vector = tuple[float, ...]
_SHAPES = ("wzboxdef", "wzcyldef", "wzsphdef", "wzhomejointdef", "wzlimjointdef")
_MILLIMETRE = 1e-3
_HIGH = ("1", "high", "true")


class _NotKnownError(Exception):
    """A value that is no constant."""


def world_zones(
    files: Mapping[str, SourceFile], robot: Robot
) -> tuple[tuple[WorldZone, ...], tuple[Note, ...]]:
    """The zones that modules set up, without the name of their robot.

    Args:
        files: of the program, by name.
        robot: whose axes joint spaces are of.

    Returns:
        the zones, and what is said of those that cannot be followed.
    """
    if not any("wzdoset" in file.text.casefold() for file in files.values()):
        return (), ()
    modules: list[tree.Module] = []
    for name, file in files.items():
        with suppress(SourceError):
            modules += parse(SourceText(file.text, name))
    shared = _values([one for m in modules for one in m.declarations if not one.local])
    zones: list[WorldZone] = []
    notes: list[Note] = []
    for module in modules:
        for routine in module.routines:
            data = {**shared, **_values([*module.declarations, *routine.declarations])}
            for found in _in_routine(routine, data, robot):
                if isinstance(found, Note):
                    notes.append(found)
                else:
                    zones.append(found)
    return tuple(zones), tuple(notes)


def _values(declarations: Sequence[tree.Declaration]) -> dict[str, tree.Expression]:
    return {one.name: one.value for one in declarations if one.value is not None}


def _in_routine(
    routine: tree.Routine, data: Mapping[str, tree.Expression], robot: Robot
) -> Iterator[WorldZone | Note]:
    """The zones of a routine; a shape that is defined again is the last one before it is used."""
    shapes: dict[str, WorldZone | str] = {}
    for statement in routine.body.walk():
        if not isinstance(statement, tree.Invoke):
            continue
        plain = [one.value for one in statement.arguments if one.option is None]
        options = {one.option for one in statement.arguments}
        if statement.name in _SHAPES and plain and isinstance(plain[0], tree.Name):
            try:
                made = _shape(statement.name, [_number(one, data) for one in plain[1:]], robot)
                shapes[plain[0].name] = replace(made, inside="outside" not in options)
            except _NotKnownError as error:
                shapes[plain[0].name] = str(error)
        elif statement.name == "wzdoset":
            yield from _zone(statement, plain, options, shapes)


def _zone(
    statement: tree.Invoke,
    plain: Sequence[tree.Expression | None],
    options: set[str | None],
    shapes: Mapping[str, WorldZone | str],
) -> Iterator[WorldZone | Note]:
    names = [one for one in plain if isinstance(one, tree.Name)]
    if len(names) < 3:
        yield Note("WZDOSet: what it watches is not known", None, statement.span)
        return
    _, shape, signal = names[:3]
    known = shapes.get(shape.name, f"{shape.text} is not defined in this routine")
    if isinstance(known, str):
        yield Note(
            f"{signal.text}: the zone that sets it is not followed: {known}", None, statement.span
        )
        return
    value = plain[-1]
    on = value.text if isinstance(value, tree.Name) else str(int(getattr(value, "value", 1)))
    set_to = on.casefold() in _HIGH
    name = f"{shape.text} ({statement.span.file}:{statement.span.line})"
    yield replace(known, name=name, signal=signal.text, inside=set_to == known.inside)
    if "before" in options:
        yield Note(
            f"{signal.text}: how long before the robot is in {shape.text} the controller sets it "
            "(\\Before) is not known: it is set when it is there",
            None,
            statement.span,
        )


def _number(
    value: tree.Expression | None, data: Mapping[str, tree.Expression], deep: int = 8
) -> float | Vector | tuple[Vector, ...]:
    """A constant as plain numbers.

    Raises:
        _NotKnownError: it is none.
    """
    match value:
        case tree.Number(value=number):
            return float(number)
        case tree.Packed(value=numbers):
            return numbers  # type: ignore[return-value]
        case tree.Name(path=()) if value.name in data and deep:
            return _number(data[value.name], data, deep - 1)
        case tree.Name():
            raise _NotKnownError(f"{value.text} is no constant of these modules")
    raise _NotKnownError("its corners are calculated")


def _shape(kind: str, values: Sequence[object], robot: Robot) -> WorldZone:
    """A space, in SI units.

    Raises:
        _NotKnownError: its numbers are not those of such a space.
    """
    from ...core.program.world_zone import WorldZone

    space = WorldZone("", "", "")
    match kind, values:
        case "wzboxdef", [tuple() as low, tuple() as high]:
            return replace(space, box=(_point(low), _point(high)))
        case "wzsphdef", [tuple() as centre, float() as radius]:
            return replace(space, ball=(_point(centre), radius * _MILLIMETRE))
        case "wzcyldef", [tuple() as foot, float() as radius, float() as height]:
            sizes = radius * _MILLIMETRE, height * _MILLIMETRE
            return replace(space, cylinder=(_point(foot), *sizes))
        case (("wzhomejointdef" | "wzlimjointdef"), [tuple() as one, tuple() as other]):
            first, second = _arm(one), _arm(other)
            if kind == "wzhomejointdef":
                first, second = (
                    [a - b for a, b in zip(first, second, strict=True)],
                    [a + b for a, b in zip(first, second, strict=True)],
                )
            return replace(space, axes=_ranges(first, second, robot))
    raise _NotKnownError("its numbers are not those of such a space")


def _point(values: Sequence[object]) -> tuple[float, float, float]:
    if len(values) != 3 or not all(isinstance(one, float | int) for one in values):
        raise _NotKnownError("a corner has three numbers")
    x, y, z = (float(one) * _MILLIMETRE for one in values)  # type: ignore[arg-type]
    return x, y, z


def _arm(target: Sequence[object]) -> list[float]:
    axes = target[0] if target else None
    if not isinstance(axes, tuple):
        raise _NotKnownError("a joint target has the arm's axes first")
    return [float(one) for one in axes]


def _ranges(
    low: Sequence[float], high: Sequence[float], robot: Robot
) -> tuple[tuple[int, float, float], ...]:
    """Ranges of the robot's joints, rad or m."""
    ends = zip(arm_values(robot, low), arm_values(robot, high), strict=True)
    return tuple((index, min(a, b), max(a, b)) for index, (a, b) in enumerate(ends))
