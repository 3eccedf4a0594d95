"""What programs do with signals: outputs set, and signals waited for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Level:
    """A digital signal that is on or off.

    Args:
        name: of the signal.
        on: which of the two.
    """

    name: str
    on: bool


@dataclass(frozen=True, slots=True)
class Joined:
    """Conditions of which all hold, or one.

    Args:
        parts: two or more.
        every: whether all must hold.
    """

    parts: tuple[Condition, ...]
    every: bool


Condition = Level | Joined


@dataclass(frozen=True, slots=True)
class SetSignal:
    """An output gets a value.

    Args:
        name: of the output.
        value: true or false, or of an analogue output a number in the language's unit.
        pulse: s after which it changes back; None for it stays.
    """

    name: str
    value: bool | float
    pulse: float | None = None


@dataclass(frozen=True, slots=True)
class WaitSignal:
    """The program waits until a condition holds.

    Args:
        condition: of what.
        longest: s after which it goes on, or complains; None for never.
    """

    condition: Condition
    longest: float | None = None


SignalAction = SetSignal | WaitSignal


def names(action: SignalAction) -> Iterator[str]:
    """The signals of an action."""
    if isinstance(action, SetSignal):
        yield action.name
    else:
        yield from (level.name for level in levels(action.condition))


def levels(condition: Condition) -> Iterator[Level]:
    """The signals of a condition."""
    if isinstance(condition, Level):
        yield condition
    else:
        for part in condition.parts:
            yield from levels(part)


def negated(condition: Condition) -> Condition:
    """What holds when a condition does not."""
    if isinstance(condition, Level):
        return Level(condition.name, not condition.on)
    return Joined(tuple(map(negated, condition.parts)), not condition.every)


@dataclass(frozen=True, slots=True)
class Meet:
    """The program waits until others are at their meetings of the same name.

    Args:
        label: of the meeting.
        parties: indices of the robots that meet, in the station's order; None for all that have a
            meeting of the name.
        coordinated: whether the controller times the moves behind it with the others'.
    """

    label: str
    parties: tuple[int, ...] | None = None
    coordinated: bool = False
