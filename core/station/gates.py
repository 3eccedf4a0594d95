"""PLC logic that is small enough to write down: gates on signals, latches, counters, timers."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class GateKind(StrEnum):
    """What a gate makes of its inputs."""

    AND = "and"
    OR = "or"
    LATCH = "latch"
    COUNTER = "counter"
    TIMER = "timer"


@dataclass(frozen=True, slots=True)
class Input:
    """A signal that a gate looks at.

    Args:
        name: ``robot.signal`` or ``plc.gate``.
        on: whether it counts when it is on; else when it is off (``not …``).
    """

    name: str
    on: bool = True

    @classmethod
    def read(cls, text: str) -> Input:
        """From ``left.doInside`` or ``not left.doInside``."""
        words = text.split(maxsplit=1)
        if len(words) == 2 and words[0].casefold() == "not":
            return cls(words[1].strip(), False)
        return cls(text.strip())


@dataclass(frozen=True, slots=True)
class Gate:
    """One output of the PLC, called ``plc.NAME``.

    Args:
        kind: see `GateKind`.
        inputs: of AND and OR all; of a latch what sets it; of a counter what is counted, at each
            rise; of a timer what has to be on for a while.
        resets: what sets a latch back, which wins, or a counter to zero.
        least: of a counter the number from which on it is on.
        delay: of a timer, s that its input is on before it is.
    """

    kind: GateKind
    inputs: tuple[Input, ...]
    resets: tuple[Input, ...] = ()
    least: int = 1
    delay: float = 0.0
