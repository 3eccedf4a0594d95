"""Signals in RAPID ("RAPID Reference Manual": SetDO, PulseDO, WaitDI, WaitUntil)."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING

from ...core.dialect import SignalWords
from ...core.program.signal import Level, Meet, SetSignal, SignalAction, WaitSignal
from ...core.source.text.conditions import ConditionWords, NoConditionError

if TYPE_CHECKING:
    from ...core.errors import Note
    from ...core.program.world_zone import WorldZone
    from ...core.robot.model import Robot
    from ...core.source.text.files import SourceFile

_NAME = re.compile(r"[A-Za-z]\w*")
_ON, _OFF = ("1", "high", "true"), ("0", "low", "false")
_VALUE = rf"(?P<value>{'|'.join((*_ON, *_OFF))})"
_INSTRUCTION = re.compile(
    r"\s*(?P<word>Set|Reset|SetDO|SetAO|PulseDO|WaitDI|WaitDO|WaitUntil)\b(?P<rest>.*?);?\s*",
    re.IGNORECASE | re.DOTALL,
)
_OPTION = re.compile(r"\\(?P<name>\w+)(?:\s*:=\s*(?P<value>[^\\,]*))?(?P<end>,)?")
_LEVEL = re.compile(
    r"\s*(?:(?:DInput|DOutput|TestDI|TestDO)\s*\(\s*(?P<asked>[A-Za-z]\w*)\s*\)"
    r"|(?!(?:NOT|AND|OR|TRUE|FALSE)\b)(?P<plain>[A-Za-z]\w*)(?!\w)(?!\s*\())"
    rf"(?:\s*(?P<sign>=|<>)\s*{_VALUE}\b)?",
    re.IGNORECASE,
)
_WAITS = ("maxtime", "pollrate", "inpos", "visualize")
"""Options that do not change what is waited for."""
_PULSE = 0.2
"""s of a pulse without ``\\PLength``."""


def _on(value: str) -> bool:
    return value.casefold() in _ON


def _level(found: re.Match[str]) -> Level:
    on = True if found["value"] is None else _on(found["value"])
    return Level(found["asked"] or found["plain"], on != (found["sign"] == "<>"))


_CONDITIONS = ConditionWords(_LEVEL, _level, "AND", "OR", "NOT")


def read(text: str) -> SignalAction | None:
    """What an instruction does with signals; None if that is not known, or nothing."""
    found = _INSTRUCTION.fullmatch(text)
    if found is None:
        return None
    word = found["word"].casefold()
    options = {o["name"].casefold(): o["value"] for o in _OPTION.finditer(found["rest"])}
    rest = _OPTION.sub(lambda o: o["end"] or "", found["rest"]).strip().strip(",")
    parts = [part.strip() for part in rest.split(",")]
    try:
        return _action(word, parts, rest, options)
    except (NoConditionError, ValueError):
        return None


def _action(
    word: str, parts: list[str], rest: str, options: dict[str, str | None]
) -> SignalAction | None:
    if word.startswith("wait"):
        if options.keys() - set(_WAITS):
            return None
        longest = options.get("maxtime")
        seconds = None if longest is None else float(longest)
        if word == "waituntil":
            return WaitSignal(_CONDITIONS.read(rest), seconds)
        return WaitSignal(_CONDITIONS.read(f"{parts[0]}={parts[1]}"), seconds)
    if not parts or _NAME.fullmatch(parts[0]) is None:
        return None
    if word == "pulsedo" and len(parts) == 1 and not options.keys() - {"plength", "high"}:
        return SetSignal(parts[0], True, float(options.get("plength") or _PULSE))
    if options.keys() - {"sync"}:
        return None
    if word in ("set", "reset") and len(parts) == 1:
        return SetSignal(parts[0], word == "set")
    if word == "setdo" and len(parts) == 2 and parts[1].casefold() in (*_ON, *_OFF):
        return SetSignal(parts[0], _on(parts[1]))
    if word == "setao" and len(parts) == 2:
        return SetSignal(parts[0], float(parts[1]))
    return None


_MEETING = re.compile(
    r"\s*(?P<word>WaitSyncTask|SyncMoveOn|SyncMoveOff)\b\s*(?:\\\w+(?:\s*:=\s*[^\\,;]+)?\s*,?\s*)*"
    r"(?P<label>[A-Za-z]\w*)\b.*",
    re.IGNORECASE | re.DOTALL,
)


def meets(text: str) -> Meet | None:
    """The meeting of MultiMove that an instruction is ("Application manual MultiMove")."""
    found = _MEETING.fullmatch(text)
    if found is None:
        return None
    return Meet(found["label"].casefold(), coordinated=found["word"].casefold() == "syncmoveon")


_ID = re.compile(r"\\ID\s*:=\s*([^\\,;]+)", re.IGNORECASE)


def together(text: str) -> str | None:
    r"""The ``\ID`` of a move that other tasks make at the same time."""
    found = _ID.search(text)
    return None if found is None else "".join(found[1].split()).casefold()


def event(text: str) -> str:
    r"""The instruction that an event's text is short for: ``doGun,1``, ``\DOp:=doGun,1``."""
    found = re.fullmatch(r"\s*(?:\\(?P<kind>[AD])Op\s*:=)?\s*(?P<what>\w+\s*,.*)", text, re.I)
    return text if found is None else f"Set{(found['kind'] or 'D').upper()}O {found['what']};"


def said(action: SignalAction) -> str | None:
    """The instruction; None if there is none."""
    if isinstance(action, WaitSignal):
        if isinstance(action.condition, Level):
            return f"WaitUntil {_level_said(action.condition)};"
        return f"WaitUntil {_CONDITIONS.said(action.condition, _level_said)};"
    if action.pulse is not None:
        return f"PulseDO\\PLength:={action.pulse:g},{action.name};"
    if isinstance(action.value, bool):
        return f"{'Set' if action.value else 'Reset'} {action.name};"
    return f"SetAO {action.name},{action.value:g};"


def _level_said(level: Level) -> str:
    return f"{level.name}={int(level.on)}"


def _zones(
    files: Mapping[str, SourceFile], robot: Robot
) -> tuple[tuple[WorldZone, ...], tuple[Note, ...]]:
    from .world_zones import world_zones  # late: it takes time

    return world_zones(files, robot)


def _spelt(name: str) -> str | None:
    return name if _NAME.fullmatch(name) else None


SIGNALS = SignalWords(
    read,
    said,
    _spelt,
    lambda action: "do?" if isinstance(action, SetSignal) else "di?",
    event,
    meets=meets,
    together=together,
    zones=_zones,
)
