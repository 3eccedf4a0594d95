"""What TP programs have words for."""

from __future__ import annotations

import re
from collections.abc import Iterator

from flyby.core.dialect import RoutineText, Wording
from flyby.core.source.lines.driving import dialect_of
from flyby.core.source.lines.signals import Signals

from .grammar import Grammar, quiet

_SIGNALS = Signals(
    Grammar,
    digital=("DO", "RO", "F", "SO", "UO"),
    inputs=("DI", "RI", "SI", "UI"),
    analogue=("AO", "GO"),
    pulse="{signal}=PULSE,{time}sec",
    quiet=quiet,
)
_ROUTINE = re.compile(
    r"^/PROG[ \t]+(?P<name>[\w-]+)[^\r\n]*(?P<body>)(?:(?!^/PROG).)*?^/END", re.M | re.S
)


def _routines(text: str) -> Iterator[RoutineText]:
    for found in _ROUTINE.finditer(text):
        yield RoutineText(found["name"], "", found.start(), found.start("body"), found.end())


TP = dialect_of(
    Grammar,
    "!",
    configurations=True,
    length_decimals=3,
    angle_decimals=3,
    fastest=2.0,
    most={"acceleration_override": 1.5},
    outputs=_SIGNALS.outputs(longest_lead=30.0, most=1),
    signals=_SIGNALS.dialect(),
    wording=Wording(
        silent=re.compile(
            r"^[ \t]*\d*:[ \t]*(?:!|//|--eg)[^\r\n]*|'[^'\r\n]*'|(?<=\d):[^\[\]\r\n]*(?=\])", re.M
        ),
        targets=re.compile(r"^[ \t]*(?P<names>P\[\d+[ ]*\])\s*\{", re.M),
        name=re.compile(
            r"\b(?:P|A?R|PR|SR|UFRAME|UTOOL)\[\d+|\b(?:U(?:FRAME|TOOL)_NUM|OVERRIDE)\b"
        ),
        routines=_routines,
    ),
)
