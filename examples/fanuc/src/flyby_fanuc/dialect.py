"""What TP programs have words for."""

from __future__ import annotations

import re
from collections.abc import Iterator

from flyby.core.dialect import (
    Dialect,
    Mention,
    MoveWords,
    Orientation,
    OutputWords,
    RoutineText,
    SignalWords,
    Wording,
)
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.signal import Level, SetSignal, SignalAction, WaitSignal
from flyby.core.program.zone import ZoneKind
from flyby.core.source.text.conditions import ConditionWords, NoConditionError

CNT = ZoneKind("CNT")
"""The next move begins when braking has come down to a share of the speed."""
CR = ZoneKind("CR", None, largest=1.0, unit=1e-3, step=1e-3)
"""Distances before and behind the point, mm."""

_SET = re.compile(r"(?P<name>[DRFA]O?\[\d+\])\s*=\s*\(?(?:(?P<value>ON|OFF)|(?P<number>[\d.]+))\)?")
_PULSE = re.compile(r"(?P<name>[DR]O\[\d+\])\s*=\s*PULSE\s*,\s*(?P<time>[\d.]+)\s*sec")
_WAIT = re.compile(r"WAIT\s+(?P<condition>.*[\[(].*)")
_LEVEL = re.compile(
    r"\s*(?P<not>!?)\s*(?P<name>(?:[DRSU][IO]|F)\[\d+\])"
    r"(?:\s*(?P<sign>=|<>)\s*\(?(?P<value>ON|OFF)\)?)?"
)
_NAME = re.compile(r"(?P<word>[DRSU][IO]|F|A[IO])\s*\[?\s*(?P<number>\d+)\s*\]?", re.IGNORECASE)
_COMMENT = re.compile(r"(?<=\d):[^\]\r\n]*(?=\])")


def _level(found: re.Match[str]) -> Level:
    on = found["value"] != "OFF"
    return Level(found["name"], (on != (found["sign"] == "<>")) != bool(found["not"]))


_CONDITIONS = ConditionWords(_LEVEL, _level, "AND", "OR", "NOT")


def _read(text: str) -> SignalAction | None:
    said = _COMMENT.sub("", text).strip()
    if (found := _SET.fullmatch(said)) is not None:
        value = float(found["number"]) if found["number"] else found["value"] == "ON"
        return SetSignal(found["name"], value)
    if (found := _PULSE.fullmatch(said)) is not None:
        return SetSignal(found["name"], True, float(found["time"]))
    if (found := _WAIT.fullmatch(said)) is not None:
        try:
            return WaitSignal(_CONDITIONS.read(found["condition"]))
        except NoConditionError:
            return None
    return None


def _said(action: SignalAction) -> str | None:
    if isinstance(action, WaitSignal):
        if action.longest is not None:
            return None
        text = _CONDITIONS.said(action.condition, lambda s: f"{s.name}={'ON' if s.on else 'OFF'}")
        return f"WAIT {text if _LEVEL.fullmatch(text) else f'({text})'}"
    if isinstance(action.value, bool):
        if action.pulse is not None:
            return f"{action.name}=PULSE,{action.pulse:g}sec" if action.value else None
        return f"{action.name}={'ON' if action.value else 'OFF'}"
    return f"{action.name}={action.value:g}"


def _spelt(name: str) -> str | None:
    found = _NAME.fullmatch(name.strip())
    return None if found is None else f"{found['word'].upper()}[{found['number']}]"


def _example(action: SignalAction) -> str:
    if isinstance(action, WaitSignal):
        return "DI[?]"
    return "DO[?]" if isinstance(action.value, bool) else "AO[?]"


_ROUTINE = re.compile(
    r"^/PROG[ \t]+(?P<name>[\w-]+)[^\r\n]*(?P<body>)(?:(?!^/PROG).)*?^/END", re.M | re.S
)
_DATUM = re.compile(
    r"\b(?:P|PR|R|UFRAME|UTOOL|AR|SR)\[[^\[\],:]*|\b(?:UFRAME_NUM|UTOOL_NUM|OVERRIDE)"
)
_GIVEN = re.compile(r"\s*(?:\]|,\s*\d+[^\]]*\]|:[^\]]*\])?\s*(?P<sign>=(?!=)|\{)")
_STATEMENT = re.compile(r":\s*$|^\s*$")


def _routines(text: str) -> Iterator[RoutineText]:
    for found in _ROUTINE.finditer(text):
        yield RoutineText(found["name"], "", found.start(), found.start("body"), found.end())


def _named(text: str) -> Iterator[tuple[str, Mention]]:
    """Data by word and number; an assignment is one that begins a statement."""
    for found in _DATUM.finditer(text):
        name = found[0].rstrip() + "]" if "[" in found[0] else found[0]
        given = _GIVEN.match(text, found.end())
        before = text[
            max(text.rfind("\n", 0, found.start()), text.rfind(";", 0, found.start()))
            + 1 : found.start()
        ]
        if given is None or not _STATEMENT.search(before):
            yield name, Mention.USED
        else:
            yield name, Mention.DECLARED if given["sign"] == "{" else Mention.ASSIGNED


_JOINT = frozenset({"joint_fraction", "acceleration_override", "duration"})
_LINE = frozenset({"tcp", "reorientation", "acceleration_override", "duration"})
_ONE = frozenset({"tcp", "reorientation", "duration"})
TP = Dialect(
    joint=MoveWords(
        (CNT, CR),
        _JOINT,
        frozenset({"joint_fraction"}),
        exclusive=frozenset({"joint_fraction", "duration"}),
    ),
    line=MoveWords((CNT, CR), _LINE, exclusive=_ONE),
    arc=MoveWords((CNT, CR), _LINE, exclusive=_ONE),
    pace="joint_fraction",
    comment="!",
    stationary_tools=False,
    external_axes=False,
    loads=False,
    arc_orientations=frozenset({ArcOrientation.FIXED_FRAME}),
    orientation=Orientation.EULER_ZYX,
    length_decimals=3,
    angle_decimals=3,
    fastest=2.0,
    most={"acceleration_override": 1.5},
    outputs=OutputWords(
        lambda name, on: f"{name}={'ON' if on else 'OFF'}",
        lambda name, value: f"{name}={value:g}",
        longest_lead=30.0,
        from_start=False,
        both=False,
        most=1,
    ),
    signals=SignalWords(_read, _said, _spelt, _example, stops=False),
    wording=Wording(
        silent=re.compile(
            r"^[ \t]*\d*:[ \t]*(?:!|//|--eg)[^\r\n]*|'[^'\r\n]*'|(?<=\d):[^\[\]\r\n]*(?=\])", re.M
        ),
        targets=re.compile(r"^[ \t]*(?P<names>P\[\d+[ ]*\])\s*\{", re.M),
        name=re.compile(r"\bPR?\[\d+"),
        same_case=True,
        routines=_routines,
        named=_named,
    ),
)
