"""Signals in URScript: ``set_standard_digital_out``, loops that wait ("Script Directory").

They are called ``digital_out[1]``, ``digital_in[1]``, ``configurable_digital_out[1]``,
``tool_digital_out[0]``, ``analog_out[0]``.
"""

from __future__ import annotations

import re

from ...core.dialect import SignalWords
from ...core.program.signal import Level, SetSignal, SignalAction, WaitSignal, negated
from ...core.source.text.conditions import ConditionWords, NoConditionError

_TOOL_FIRST = 8
"""Functions without a kind number the tool's signals from here on."""
_SET = re.compile(
    r"\s*set_(?P<kind>standard_|configurable_|tool_)?(?P<what>digital|analog)_out\s*\(\s*"
    r"(?P<index>\d+)\s*,\s*(?:(?P<value>True|False)|(?P<number>\d*\.?\d+))\s*\)\s*"
)
_WAIT = re.compile(
    r"\s*while\s*(?P<condition>.*?)\s*:\s*(?:sync\(\s*\)|sleep\([\d.\s]*\))?\s*end\s*", re.DOTALL
)
_LEVEL = re.compile(
    r"\s*get_(?P<kind>standard_|configurable_|tool_)?digital_(?P<way>in|out)\s*\(\s*"
    r"(?P<index>\d+)\s*\)(?:\s*(?P<sign>==|!=)\s*(?P<value>True|False)\b)?"
)
_NAME = re.compile(
    r"(?:(?P<kind>standard|configurable|tool)[ _]+)?(?:(?P<what>digital|analog)[ _]+)?"
    r"(?P<way>in|out)(?:put)?\s*\[?\s*(?P<index>\d+)\s*\]?",
    re.IGNORECASE,
)


def _name(kind: str | None, what: str, index: int) -> str:
    if kind is None and what.startswith("digital") and index >= _TOOL_FIRST:
        kind, index = "tool_", index - _TOOL_FIRST
    return f"{'' if kind in (None, 'standard_') else kind}{what}[{index}]"


def _level(found: re.Match[str]) -> Level:
    name = _name(found["kind"], f"digital_{found['way']}", int(found["index"]))
    on = found["value"] != "False"
    return Level(name, on != (found["sign"] == "!="))


_CONDITIONS = ConditionWords(_LEVEL, _level, "and", "or", "not")


def read(text: str) -> SignalAction | None:
    """What a statement does with signals; None if that is not known, or nothing."""
    if (found := _SET.fullmatch(text)) is not None:
        name = _name(found["kind"], f"{found['what']}_out", int(found["index"]))
        if found["what"] == "digital":
            return None if found["value"] is None else SetSignal(name, found["value"] == "True")
        return None if found["number"] is None else SetSignal(name, float(found["number"]))
    if (found := _WAIT.fullmatch(text)) is not None:
        try:
            return WaitSignal(negated(_CONDITIONS.read(found["condition"])))
        except NoConditionError:
            return None
    return None


def said(action: SignalAction) -> str | None:
    """The statement; None if there is none."""
    if isinstance(action, WaitSignal):
        condition = _CONDITIONS.said(negated(action.condition), _level_said)
        return f"while {condition}:\n  sync()\nend"
    if action.pulse is not None:
        return None
    kind, what, index = _parts(action.name)
    if not what.endswith("_out"):
        return None
    value = str(action.value) if isinstance(action.value, bool) else f"{action.value:g}"
    return f"set_{kind}{what}({index}, {value})"


def _level_said(level: Level) -> str:
    kind, what, index = _parts(level.name)
    return f"{'' if level.on else 'not '}get_{kind}{what}({index})"


def _parts(name: str) -> tuple[str, str, str]:
    """``standard_``, ``digital_out`` and the number of a signal."""
    found = _NAME.fullmatch(name)
    assert found is not None
    return f"{found['kind'] or 'standard'}_", f"{found['what']}_{found['way']}", found["index"]


def _spelt(name: str) -> str | None:
    found = _NAME.fullmatch(name.strip())
    if found is None or not (found["kind"] or found["what"]):
        return None
    kind = None if found["kind"] is None else f"{found['kind'].lower()}_"
    return _name(kind, f"{found['what'] or 'digital'}_{found['way']}".lower(), int(found["index"]))


SIGNALS = SignalWords(
    read,
    said,
    _spelt,
    lambda action: "digital_out[?]" if isinstance(action, SetSignal) else "digital_in[?]",
)
