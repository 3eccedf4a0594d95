"""What of a move a language has no words for, as its `Dialect` says."""

from __future__ import annotations

from dataclasses import fields

from ...dialect import Dialect, MoveWords, OutputWords
from ...errors import InputError
from ...program.move import Move, MoveC
from ...program.speed import Speed
from ...program.tool import FLANGE, WORLD
from ...program.zone import Fine, Radius, Zone, kind_of, kind_word, zone_word

_FREE = Speed()
_PARTS = ("angle", "external_linear", "external_angular")


def check_said(move: Move, dialect: Dialect, name: str) -> None:
    """Refuse a move that a language cannot say.

    Args:
        dialect: of the language.
        name: of the language, for messages.

    Raises:
        InputError: naming what there are no words for, and what to do.
    """
    words = dialect.words(move)
    _check_zone(move.zone, words, dialect, name)
    _check_speed(move.speed, words, name)
    if move.tool.tcp != FLANGE.tcp and not dialect.tools:
        raise InputError(f"{name} has no tools: give targets of the flange")
    if move.work_object != WORLD and not dialect.work_objects:
        raise InputError(f"{name} has no work objects: give targets in the robot's base")
    stands = not move.tool.robot_held or move.work_object.robot_held
    if (stands or move.work_object.moved_by) and not dialect.stationary_tools:
        raise InputError(f"{name} has no tools that stand still, and no frames that are moved")
    if move.load is not None and not dialect.loads:
        raise InputError(f"{name} states no loads in programs: take Move.load away")
    if move.tool.load is not None and not dialect.loads:
        raise InputError(f"{name} states no loads in programs: take Tool.load away")
    if move.target.external and not dialect.external_axes:
        raise InputError(f"{name} has no external axes")
    if isinstance(move, MoveC) and not dialect.arc_orientations:
        raise InputError(f"{name} has no arcs: use lines")
    if isinstance(move, MoveC) and move.orientation not in dialect.arc_orientations:
        only = " or ".join(sorted(f"ArcOrientation.{one.name}" for one in dialect.arc_orientations))
        raise InputError(f"along {name}'s arcs the tool turns otherwise: use {only}")
    _check_events(move, dialect.outputs, name)


def _check_zone(zone: Zone, words: MoveWords, dialect: Dialect, name: str) -> None:
    if isinstance(zone, Fine):
        return
    if kind_of(zone) not in words.zones:
        known = " or ".join(map(kind_word, words.zones))
        raise InputError(f"{name} has no zone by {zone_word(zone)} here: use {known or 'stops'}")
    if isinstance(zone, Radius) and not dialect.zone_parts:
        if zone.tcp == 0:
            raise InputError(f"a zone of radius 0 is a stop in {name}: make it fine")
        try:
            zone.with_one_distance()
        except InputError as error:
            raise InputError(f"{name} has one radius for all: {error}") from None
        for part in _PARTS:
            if getattr(zone, part) != 0:
                raise InputError(f"{name}'s zones have no Radius.{part}: set it to 0")


def _check_events(move: Move, outputs: OutputWords | None, name: str) -> None:
    if move.events and outputs is None:
        raise InputError(f"{name} switches nothing on the way of a move (Move.events)")
    if outputs is None:
        return
    if len(move.events) > outputs.most:
        raise InputError(f"{name} does no more than {outputs.most:g} thing on the way of a move")
    for event in move.events:
        if not outputs.takes(event, move):
            raise InputError(
                f"{name} has no words for where, or when, {event.text!r} is done on the way"
            )


def _check_speed(speed: Speed, words: MoveWords, name: str) -> None:
    stated = [
        field.name
        for field in fields(speed)
        if field.name != "name" and getattr(speed, field.name) != getattr(_FREE, field.name)
    ]
    for field in stated:
        if field not in words.speeds:
            known = ", ".join(f"Speed.{one}" for one in sorted(words.speeds))
            raise InputError(f"{name} has no words for Speed.{field} here: it says {known}")
    for field in sorted(words.needs):
        if getattr(speed, field) is None:
            raise InputError(f"{name} needs Speed.{field}: without it a default would be taken")
    alone = [field for field in stated if field in words.exclusive]
    if len(alone) > 1:
        told = " and ".join(f"Speed.{field}" for field in alone)
        raise InputError(f"{name} says one speed of a move, not {told}")
