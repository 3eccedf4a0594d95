"""The signals of EIO.cfg."""

from __future__ import annotations

from ....core.backup.backup import Signal, SignalKind
from ....core.backup.contents import BackupNotes, listed
from .cfg import Parameters, Record

_KINDS = {
    "DI": SignalKind.DIGITAL_INPUT,
    "DO": SignalKind.DIGITAL_OUTPUT,
    "AI": SignalKind.ANALOG_INPUT,
    "AO": SignalKind.ANALOG_OUTPUT,
    "GI": SignalKind.GROUP_INPUT,
    "GO": SignalKind.GROUP_OUTPUT,
}


def signals_of(eio: Parameters, notes: BackupNotes) -> tuple[Signal, ...]:
    """Its signals, each name once; those of no known kind are noted and left out."""
    found: dict[str, Signal] = {}
    unknown: list[Record] = []
    for record in eio.section("EIO_SIGNAL"):
        kind = _KINDS.get((record.text("signaltype") or "").upper())
        if kind is None or not record.name:
            unknown.append(record)
        else:
            signal = Signal(record.name, kind, _address(record))
            found.setdefault(record.name.casefold(), signal)
    if unknown:
        names = listed(record.name or "one without a name" for record in unknown)
        message = f"signals of no known kind are left out: {names}"
        notes.add(message, unknown[0].file, unknown[0].line)
    return tuple(found.values())


def _address(record: Record) -> str | None:
    """Device and map, as RobotWare 6 and 7 call them; unit and map of RobotWare 5."""
    device = record.text("device") or record.text("unit")
    place = record.text("devicemap") or record.text("unitmap")
    return " ".join(filter(None, (device, place))) or None
