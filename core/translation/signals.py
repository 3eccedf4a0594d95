"""Which signal of one robot is which of the other: the table ``[signals]`` of an answers file::

[signals]
do_gripper = "$OUT[3]"                       # the one, and what it is on the other robot
di_part = ["$IN[7]", "digital_in[0]"]        # or on several others: each language finds its own
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from ..dialect import SignalWords
from ..program.signal import Condition, Joined, Level, SetSignal, SignalAction, WaitSignal


@dataclass(frozen=True)
class SignalMap:
    """Signals that are one.

    Args:
        rows: names of each in all languages.
    """

    rows: tuple[tuple[str, ...], ...] = ()

    @classmethod
    def of(cls, table: Mapping[str, Iterable[str]]) -> SignalMap:
        """From what an answers file says of each signal."""
        return cls(tuple((name, *others) for name, others in table.items()))

    def name(self, name: str, old: SignalWords, new: SignalWords) -> str | None:
        """What a signal of one language is called in another; None if the table does not say it."""
        for row in self.rows:
            others = [one for one in row if _key(name) not in (_key(one), _key(old.spelt(one)))]
            if len(others) < len(row):
                return next(filter(None, map(new.spelt, others)), None)
        return None


def _key(name: str | None) -> str:
    return "".join((name or "").split()).casefold()


def renamed(action: SignalAction, names: Mapping[str, str]) -> SignalAction:
    """An action on signals of other names."""
    if isinstance(action, SetSignal):
        return replace(action, name=names[action.name])
    return WaitSignal(_condition(action.condition, names), action.longest)


def _condition(condition: Condition, names: Mapping[str, str]) -> Condition:
    if isinstance(condition, Level):
        return Level(names[condition.name], condition.on)
    return Joined(tuple(_condition(part, names) for part in condition.parts), condition.every)
