"""Signals in KRL: ``$OUT[1]=TRUE``, ``PULSE``, ``WAIT FOR`` ("Quickguide KRL-Syntax")."""

from __future__ import annotations

import re

from ...core.dialect import SignalWords
from ...core.errors import InputError
from ...core.program.signal import Level, Meet, SetSignal, SignalAction, WaitSignal
from ...core.source.text.conditions import ConditionWords, NoConditionError

_SIGNAL = r"\$?[A-Za-z_]\w*(?:\s*\[\s*\d+\s*\])?"
_SET = re.compile(
    rf"\s*(?P<name>{_SIGNAL})\s*=\s*(?:(?P<value>TRUE|FALSE)|(?P<number>[-+]?\d*\.?\d+))\s*", re.I
)
_PULSE = re.compile(
    rf"\s*PULSE\s*\(\s*(?P<name>{_SIGNAL})\s*,\s*(?P<value>TRUE|FALSE)\s*,\s*(?P<time>[\d.]+)\s*\)\s*",
    re.IGNORECASE,
)
_WAIT = re.compile(r"\s*WAIT\s+FOR\b(?P<condition>.*)", re.IGNORECASE | re.DOTALL)
_LEVEL = re.compile(
    rf"\s*(?!(?:NOT|AND|OR|EXOR|TRUE|FALSE)\b)(?P<name>{_SIGNAL})(?![\w\[])(?!\s*\()"
    r"(?:\s*(?P<sign>==|<>)\s*(?P<value>TRUE|FALSE)\b)?",
    re.IGNORECASE,
)
_INPUT = re.compile(r"\$(?:AN)?IN\[.*", re.IGNORECASE)
_NUMBERED = re.compile(r"\$(?:(?:AN)?(?:IN|OUT)|FLAG)\[\d+\]", re.IGNORECASE)


def _true(value: str) -> bool:
    return value.casefold() == "true"


def _level(found: re.Match[str]) -> Level:
    on = True if found["value"] is None else _true(found["value"])
    return Level(_spelt_close(found["name"]), on != (found["sign"] == "<>"))


_CONDITIONS = ConditionWords(_LEVEL, _level, "AND", "OR", "NOT")


def read(text: str) -> SignalAction | None:
    """What a statement does with signals; None if that is not known, or nothing."""
    if (found := _SET.fullmatch(text)) is not None:
        value = float(found["number"]) if found["number"] else _true(found["value"])
        return SetSignal(_spelt_close(found["name"]), value)
    if (found := _PULSE.fullmatch(text)) is not None and _true(found["value"]):
        return SetSignal(_spelt_close(found["name"]), True, float(found["time"]))
    if (found := _WAIT.fullmatch(text)) is not None:
        try:
            return WaitSignal(_CONDITIONS.read(found["condition"]))
        except NoConditionError:
            return None
    return None


_COUPLED = re.compile(r"\s*SYNCCMD\s*\(\s*#(?P<kind>\w+)", re.IGNORECASE)
_MEETING = re.compile(
    r"\s*SYNCCMD\s*\(\s*#(?P<kind>ProgSync|MotionSync)\s*,\s*\"(?P<label>[^\"]+)\"\s*,"
    r"\s*(?P<mask>\d+|'B[01]+'|'H[0-9A-F]+')\s*\)\s*",
    re.IGNORECASE,
)


def meets(text: str) -> Meet | None:
    """The meeting of RoboTeam that a statement is; bit i of its mask is the (i + 1)-th robot.

    Raises:
        InputError: robots are coupled in another way than by common starts and durations.
    """
    found = _MEETING.fullmatch(text)
    if found is None:
        coupled = _COUPLED.match(text)
        if coupled is None:
            return None
        raise InputError(
            f"SYNCCMD(#{coupled['kind']}, …): robots meet by #ProgSync and #MotionSync with label "
            "and mask; other couplings, such as a base that follows another robot, are not "
            "followed: leave these motions out of the programs of the station"
        )
    mask = found["mask"].strip("'").upper()
    bases = {"B": 2, "H": 16}
    bits = int(mask[1:], bases[mask[0]]) if mask[0] in bases else int(mask)
    parties = tuple(k for k in range(bits.bit_length()) if bits >> k & 1)
    coordinated = found["kind"].casefold() == "motionsync"
    return Meet(found["label"].casefold(), parties or None, coordinated)


def said(action: SignalAction) -> str | None:
    """The statement; None if there is none."""
    if isinstance(action, WaitSignal):
        return f"WAIT FOR {_CONDITIONS.said(action.condition, _level_said)}"
    if _INPUT.fullmatch(action.name):
        return None
    if action.pulse is not None:
        return f"PULSE({action.name},TRUE,{action.pulse:g})"
    if isinstance(action.value, bool):
        return f"{action.name}={'TRUE' if action.value else 'FALSE'}"
    return f"{action.name}={action.value:g}"


def _level_said(level: Level) -> str:
    return level.name if level.on else f"NOT {level.name}"


def _spelt_close(name: str) -> str:
    return "".join(name.split())


def _spelt(name: str) -> str | None:
    close = _spelt_close(name)
    return close.upper() if _NUMBERED.fullmatch(close) else None


SIGNALS = SignalWords(
    read,
    said,
    _spelt,
    lambda action: "$OUT[?]" if isinstance(action, SetSignal) else "$IN[?]",
    stops=True,
    meets=meets,
)
