"""The PLC of a station on its clock: what its gates are, as signals change."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..errors import InputError
from .station import (
    Gate,
    GateKind,
    Input,
    signal_key,
)

PLC = "plc"
"""What gates are outputs of."""
ROUNDS = 64
"""Changes of gates within one instant after which they are said to swing."""


@dataclass
class Plc:
    """Gates with what they remember.

    Args:
        gates: by name.
        levels: of all signals by their keys; gates read and write them.
    """

    gates: Mapping[str, Gate]
    levels: dict[str, bool]
    _counts: dict[str, int] = field(default_factory=dict)
    _before: dict[str, bool] = field(default_factory=dict)
    _since: dict[str, float] = field(default_factory=dict)

    def settle(self, now: float) -> tuple[list[tuple[str, bool]], list[float]]:
        """Let gates change until none does.

        Args:
            now: s.

        Returns:
            the changes in their order, by key, and when timers have to be looked at again, s.

        Raises:
            InputError: they never come to rest.
        """
        changes: list[tuple[str, bool]] = []
        later: list[float] = []
        for _ in range(ROUNDS):
            changed = False
            for name, gate in self.gates.items():
                key = signal_key(f"{PLC}.{name}")
                level = self._level(name, gate, now, later)
                if level != self.levels.get(key, False):
                    self.levels[key] = level
                    changes.append((key, level))
                    changed = True
            if not changed:
                return changes, later
        swinging = ", ".join(sorted({key for key, _ in changes[-len(self.gates) :]}))
        raise InputError(f"the logic of {swinging} never comes to rest: it depends on itself")

    def _holds(self, one: Input) -> bool:
        return self.levels.get(signal_key(one.name), False) == one.on

    def _level(self, name: str, gate: Gate, now: float, later: list[float]) -> bool:
        match gate.kind:
            case GateKind.AND:
                return all(map(self._holds, gate.inputs))
            case GateKind.OR:
                return any(map(self._holds, gate.inputs))
            case GateKind.LATCH:
                if any(map(self._holds, gate.resets)):
                    return False
                own = self.levels.get(signal_key(f"{PLC}.{name}"), False)
                return own or any(map(self._holds, gate.inputs))
            case GateKind.COUNTER:
                return self._counted(name, gate)
            case GateKind.TIMER:
                return self._timed(name, gate, now, later)

    def _counted(self, name: str, gate: Gate) -> bool:
        on = any(map(self._holds, gate.inputs))
        if on and not self._before.get(name, False):
            self._counts[name] = self._counts.get(name, 0) + 1
        self._before[name] = on
        if any(map(self._holds, gate.resets)):
            self._counts[name] = 0
        return self._counts.get(name, 0) >= gate.least

    def _timed(self, name: str, gate: Gate, now: float, later: list[float]) -> bool:
        if not any(map(self._holds, gate.inputs)):
            self._since.pop(name, None)
            return False
        since = self._since.setdefault(name, now)
        due = since + gate.delay
        if now >= due - 1e-9:
            return True
        later.append(due)
        return False
