"""The moves of a routine on both sides, laid side by side."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from difflib import SequenceMatcher

from ..program.move import Move
from ..program.speed import Speed, speed_shown
from ..program.target import JointTarget
from ..program.zone import Radius, Zone, zone_shown
from .data import target_difference, target_text
from .differences import Difference, Differing

_DIGITS = 6
"""Of m and rad: numbers that agree so far are one place."""


def move_differences(
    routine: str, before: Sequence[Move], after: Sequence[Move]
) -> Iterator[Difference]:
    """Moves that were added, removed, or are driven otherwise.

    Moves belong together if they are of one kind and go to one point, by its name or its numbers;
    of what stands in the same place between those, one kind to another point is a changed target.

    Args:
        routine: name of the routine, for the differences' names.
        before, after: its moves in the order of execution.
    """
    before, after = _once(before), _once(after)
    for olds, news, together in _stretches(before, after):
        if together:
            for a, c in zip(olds, news, strict=True):
                yield from _changed(_called(routine, c + 1), before[a], after[c])
            continue
        for k in olds:
            text, name = move_text(before[k]), _called(routine, k + 1)
            yield Difference(Differing.MOVE, name, text, "", span=before[k].statement)
        for k in news:
            text, name = move_text(after[k]), _called(routine, k + 1)
            yield Difference(Differing.MOVE, name, "", text, span=after[k].statement)


def move_pairs(before: Sequence[Move], after: Sequence[Move]) -> list[tuple[int, int]]:
    """Indices of moves that belong together on both sides, both rising: see `move_differences`."""
    return [
        pair
        for olds, news, together in _stretches(before, after)
        if together
        for pair in zip(olds, news, strict=True)
    ]


def _stretches(
    before: Sequence[Move], after: Sequence[Move]
) -> Iterator[tuple[range, range, bool]]:
    """Indices of moves in a row on both sides, and whether they belong together one by one."""
    keys = [[move_key(move) for move in side] for side in (before, after)]
    matcher = SequenceMatcher(None, keys[0], keys[1], autojunk=False)
    for what, a, b, c, d in matcher.get_opcodes():
        alike = b - a == d - c and all(map(_same_kind, before[a:b], after[c:d]))
        yield range(a, b), range(c, d), what == "equal" or alike


def _once(moves: Sequence[Move]) -> list[Move]:
    """Moves without those that a loop has driven already, from the same line to the same place."""
    found: dict[object, Move] = {}
    for move in moves:
        found.setdefault((move.statement, move_key(move)), move)
    return list(found.values())


def _changed(name: str, old: Move, new: Move) -> Iterator[Difference]:
    span = new.statement
    if old.target.name is None or old.target.name != new.target.name:
        # Of points that keep their names the data are compared.
        found = target_difference(Differing.TARGET, name, old.target, new.target, span)
        if found is not None:
            yield found
    if _unnamed_zone(old.zone) != _unnamed_zone(new.zone):
        one, other = _zone_text(old.zone), _zone_text(new.zone)
        more = ", of other figures" if one == other else ""
        yield Difference(Differing.ZONE, name, one, f"{other}{more}", span=span)
    if replace(old.speed, name=None) != replace(new.speed, name=None):
        shown = _speed_text(old.speed), _speed_text(new.speed)
        yield Difference(Differing.SPEED, name, *shown, span=span)
    for subject, one, other in (
        (Differing.MOVE_TOOL, old.tool.name, new.tool.name),
        (Differing.MOVE_FRAME, old.work_object.name, new.work_object.name),
        (Differing.MOVE_LOAD, _load(old), _load(new)),
    ):
        if one.casefold() != other.casefold():
            yield Difference(subject, name, one, other, span=span)


def _unnamed_zone(zone: Zone) -> Zone:
    return replace(zone, name=None) if isinstance(zone, Radius) else zone


def _zone_text(zone: Zone) -> str:
    """A zone by its name, with its radius."""
    if isinstance(zone, Radius) and zone.name is not None:
        return f"{zone.name} ({1e3 * zone.tcp:.5g} mm)"
    return zone_shown(zone)


def _speed_text(speed: Speed) -> str:
    """A speed with all that it limits."""
    parts = {
        "reorientation": (speed.reorientation, math.degrees(1.0), "°/s"),
        "TCP acceleration": (speed.tcp_acceleration, 1e3, " mm/s²"),
        "joint acceleration": (speed.joint_acceleration, math.degrees(1.0), "°/s²"),
    }
    own = speed_shown(speed)
    if speed.name is not None and speed.tcp is not None:
        own = f"{speed.name} ({1e3 * speed.tcp:.5g} mm/s)"
    more = [
        f"{what} {scale * value:.4g}{unit}"
        for what, (value, scale, unit) in parts.items()
        if value is not None
    ]
    share = speed.joint_acceleration_fraction
    return ", ".join([own, *more]) + ("" if share == 1.0 else f", acceleration {100 * share:.3g} %")


def _load(move: Move) -> str:
    if move.load is None:
        return "none"
    return move.load.name or f"{move.load.mass:g} kg"


def _same_kind(old: Move, new: Move) -> bool:
    return type(old) is type(new)


def move_key(move: Move) -> tuple[str, ...]:
    """What a move is known again by: its kind and its point."""
    kind = move.kind
    target = move.target
    if target.name is not None:
        return kind, target.name.casefold()
    if move.open:
        return kind, "?"
    if isinstance(target, JointTarget):
        return kind, *(f"{value:.{_DIGITS}f}" for value in target.joints)
    numbers = (*target.pose.position, *target.pose.quaternion)
    return kind, *(f"{value + 0.0:.{_DIGITS}f}" for value in numbers)


def move_text(move: Move) -> str:
    """A move in a line: kind, point, speed, zone, tool, frame."""
    where = move.target.name or ("nobody knows where" if move.open else target_text(move.target))
    return (
        f"{move.kind} {where}, {speed_shown(move.speed)}, {zone_shown(move.zone)}, "
        f"{move.tool.name}, {move.work_object.name}"
    )


def _called(routine: str, number: int) -> str:
    return f"{routine}, move {number}"
