"""Conflicts between robots in sentences, with both program lines."""

from __future__ import annotations

from ..collision.mutual.pair_proof import Conflict, ConflictCause
from .station import RobotStation

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
    first, second = (f"{name}'s {b}" for name, b in zip(robots, conflict.pair, strict=True))
    places = [move_said(station, name, m) for name, m in zip(robots, conflict.moves, strict=True)]
    far = (
        "are not proven to keep clear"
        if conflict.distance is None
        else f"come to {1e3 * conflict.distance:.1f} mm"
        if conflict.distance > 0
        else "collide"
    )
    why = _WHY.get(conflict.cause, f" ({conflict.cause})")
    return f"{first} and {second} {far}{why}: {places[0]} and {places[1]}"


def move_said(station: RobotStation, name: str, move: int) -> str:
    """A robot's move with its line."""
    span = station.members[name].program.moves[move].statement
    where = "" if span is None else f" ({span.file}:{span.line})"
    return f"{name}'s move {move + 1}{where}"
