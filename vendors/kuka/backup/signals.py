"""Signals that data lists declare: ``SIGNAL CLAMP $OUT[12]``, ``SIGNAL PART $IN[1] TO $IN[8]``."""

from __future__ import annotations

import re
from collections.abc import Iterable

from ....core.backup.backup import Signal, SignalKind
from ....core.source.text.files import SourceFile

_SIGNAL = re.compile(
    r"^[ \t]*(?:(?:DECL|GLOBAL)[ \t]+)*SIGNAL[ \t]+([\w$]+)[ \t]+\$(IN|OUT|ANIN|ANOUT)[ \t]*"
    r"\[[ \t]*(\d{1,6})[ \t]*\](?:[ \t]*TO[ \t]*\$(?:IN|OUT)[ \t]*\[[ \t]*(\d{1,6})[ \t]*\])?",
    re.IGNORECASE | re.MULTILINE,
)
_ONE = {
    "IN": SignalKind.DIGITAL_INPUT,
    "OUT": SignalKind.DIGITAL_OUTPUT,
    "ANIN": SignalKind.ANALOG_INPUT,
    "ANOUT": SignalKind.ANALOG_OUTPUT,
}
_MANY = {"IN": SignalKind.GROUP_INPUT, "OUT": SignalKind.GROUP_OUTPUT}


def signals_in(sources: Iterable[SourceFile]) -> tuple[Signal, ...]:
    """The signals of some lists, each name once."""
    found: dict[str, Signal] = {}
    for source in sources:
        for name, side, first, last in _SIGNAL.findall(source.text):
            side = side.upper()
            wide = bool(last) and last != first and side in _MANY
            kind = _MANY[side] if wide else _ONE[side]
            address = f"${side}[{int(first)}]" + (f" to ${side}[{int(last)}]" if wide else "")
            found.setdefault(name.upper(), Signal(name, kind, address))
    return tuple(found.values())
