"""Conflicts between robots in sentences, with both program lines."""

from __future__ import annotations

from ..collision.mutual.conflict import Conflict, ConflictCause
from .station import RobotStation

_HANDS = {
    ConflictCause.EARLY,
    ConflictCause.DROPPED,
    ConflictCause.TORN,
    ConflictCause.OWN_CELL,
}
_WHY = {
    ConflictCause.NEAR: "",
    ConflictCause.DEVIATION: ", too little for what smoothing in time may add",
}
"""What is said of a conflict's cause behind its distance."""


def conflict_said(station: RobotStation, robots: tuple[str, str], conflict: Conflict) -> str:
    """Which bodies come how near on which moves.

    Args:
        station: the robots with their programs.
        robots: the two.
        conflict: of the two.
    """
    if conflict.cause in _HANDS:
        return _handed_said(station, robots, conflict)
    first, second = (f"{name}'s {b}" for name, b in zip(robots, conflict.pair, strict=True))
    places = [move_said(station, name, m) for name, m in zip(robots, conflict.moves, strict=True)]
    far = (
        "are not proven to keep clear"
        if conflict.distance is None
        else f"come to {1e3 * conflict.distance:.1f} mm"
        if conflict.distance > 0
        else "collide"
    )
    if conflict.cause is ConflictCause.CARRIED:
        return f"{first} and {second}, moved together ({' and '.join(places)}): {conflict.why}"
    why = _WHY.get(conflict.cause, f" ({conflict.cause})")
    return f"{first} and {second} {far}{why}: {places[0]} and {places[1]}"


def _handed_said(station: RobotStation, robots: tuple[str, str], conflict: Conflict) -> str:
    """What may go wrong while a part changes hands."""
    names = set(zip(robots, conflict.pair, strict=True))
    declared = next(
        each
        for each in station.hand_overs
        if names == {(each.giver, each.given), (each.taker, each.taken)}
    )
    moves = dict(zip(robots, conflict.moves, strict=True))
    giver, taker = (
        move_said(station, name, moves[name]) for name in (declared.giver, declared.taker)
    )
    what = f"{declared.giver}.{declared.given}"
    match conflict.cause:
        case ConflictCause.EARLY:
            return (
                f"{declared.taker} may come for {what} before {declared.giver} stands with it: "
                f"{giver} and {taker}; {declared.taker} has to wait, before it drives there, for a "
                f"signal that {declared.giver} sets behind its move"
            )
        case ConflictCause.DROPPED:
            return (
                f"{declared.giver} may let go of {what} before {declared.taker} has it, and it "
                f"lies on nothing there: {giver} and {taker}; {declared.giver} has to wait, before "
                f"it lets go, for a signal that {declared.taker} sets behind the statement that "
                "takes it"
            )
        case ConflictCause.TORN:
            return (
                f"{declared.taker} may drive off with {what} before {declared.giver} has let go: "
                f"{giver} and {taker}; {declared.taker} has to wait, before that move, for a "
                f"signal that {declared.giver} sets behind the statement that lets go"
            )
        case _:
            return f"at the hand-over of {what} ({giver} and {taker}): {conflict.why}"


def move_said(station: RobotStation, name: str, move: int) -> str:
    """A robot's move with its line."""
    span = station.members[name].program.moves[move].statement
    where = "" if span is None else f" ({span.file}:{span.line})"
    return f"{name}'s move {move + 1}{where}"
