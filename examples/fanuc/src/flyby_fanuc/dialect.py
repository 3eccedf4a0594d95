"""What TP programs have words for."""

from __future__ import annotations

import re
from collections.abc import Iterator

from flyby.core.dialect import Dialect, MoveWords, RoutineText, Wording
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.source.lines.signals import Signals

from .grammar import Grammar, quiet
from .words import CNT, CR, XYZ

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


_LINE = MoveWords(
    (CNT, CR),
    frozenset({"tcp", "reorientation", "acceleration_override", "duration"}),
    exclusive=frozenset({"tcp", "reorientation", "duration"}),
)
TP = Dialect(
    joint=MoveWords(
        (CNT, CR),
        frozenset({"joint_fraction", "acceleration_override", "duration"}),
        frozenset({"joint_fraction"}),
        exclusive=frozenset({"joint_fraction", "duration"}),
    ),
    line=_LINE,
    arc=_LINE,
    pace="joint_fraction",
    comment="!",
    stationary_tools=False,
    external_axes=False,
    loads=False,
    arc_orientations=frozenset({ArcOrientation.FIXED_FRAME}),
    orientation=XYZ.orientation,
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
