"""What RAPID has words for ("RAPID Reference Manual": speeddata, zonedata, AccSet, PathAccLim)."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...core.dialect import (
    Dialect,
    Mention,
    MoveWords,
    OutputWords,
    RoutineText,
    Wording,
)
from ...core.program.zone import Radius
from .motion.arcs import ARCS
from .signals import SIGNALS

_SPEEDS = frozenset(
    {
        "tcp",
        "reorientation",
        "external_linear",
        "external_angular",
        "tcp_acceleration",
        "joint_acceleration_fraction",
        "jerk_fraction",
        "duration",
    }
)

_ROUTINE = re.compile(
    r"\b(?:PROC|FUNC\s+\w+|TRAP)\s+(?P<name>\w+)\s*(?:\((?P<parameters>[^)]*)\))?(?P<body>)"
    r".*?\bEND(?:PROC|FUNC|TRAP)\b",
    re.IGNORECASE | re.DOTALL,
)


def _routines(text: str) -> Iterator[RoutineText]:
    for found in _ROUTINE.finditer(text):
        places = found.start(), found.end("body"), found.end()
        yield RoutineText(found["name"], found["parameters"] or "", *places)


_GIVEN = re.compile(
    # A declaration's name; the parameters of a routine; a name that is given a value; any other.
    r"\b(?:(?:VAR|PERS|CONST|ALIAS|FUNC)\s+\w+|PROC|TRAP|RECORD|MODULE|FOR)\s+(?P<declared>\w+)"
    r"(?:\s*\((?P<parameters>[^)]*)\))?"
    r"|[.\\]\s*\w+"
    r"|(?<![\w.\\])(?P<assigned>[^\W\d]\w*)(?=(?:\s*\{[^}]*\}|\s*\.\s*\w+)*\s*:=)"
    r"|(?P<used>[^\W\d]\w*)",
    re.IGNORECASE,
)


def _named(text: str) -> Iterator[tuple[str, Mention]]:
    for found in _GIVEN.finditer(text):
        for mention in Mention:
            if found[mention] is not None:
                yield found[mention], mention
        for parameter in re.findall(
            r"(\w+)\s*(?:\{[^}]*\}\s*)?(?=[,|\\]|$)", found["parameters"] or ""
        ):
            yield parameter, Mention.DECLARED


_WORDING = Wording(
    silent=re.compile(r'![^\r\n]*|"[^"\r\n]*"'),
    targets=re.compile(
        r"\b(?:const|pers|var)\s+(?:robtarget|jointtarget)\s+(?P<names>\w+)", re.IGNORECASE
    ),
    name=re.compile(r"[^\W\d]\w*"),
    heads=re.compile(
        # What a compact IF executes has no sign before it.
        r"IF\b(?:[^;]*?\bTHEN\b)?|(?:WHILE|FOR)\b[^;]*?\bDO\b|TEST\b[^;]*?(?=\b(?:CASE|DEFAULT)\b)",
        re.IGNORECASE,
    ),
    routines=_routines,
    named=_named,
    blocks=re.compile(
        r"(?P<once>\bIF\b(?:(?!\bTHEN\b)[^;])*;)|\b(?P<close>END(?:IF|WHILE|FOR|TEST))\b"
        r"|\b(?P<part>ELSEIF\b[^;]*?\bTHEN|ELSE|CASE|DEFAULT|ERROR[ \t]*$|UNDO|BACKWARD)\b"
        r"|\b(?P<open>THEN|DO|TEST)\b|(?P<label>^[ \t]*(?!DEFAULT\b)\w+[ \t]*:(?!=))",
        re.IGNORECASE | re.MULTILINE,
    ),
)

_MOVE = MoveWords((Radius,), _SPEEDS, frozenset({"tcp"}))


def _zones() -> tuple[Radius, ...]:
    """z0 to z200; imported late, since it takes time."""
    from .values.predefined import ZONES, zone

    found = (zone(name) for name in ZONES)
    return tuple(one for one in found if isinstance(one, Radius))


_OUTPUTS = OutputWords(
    switch=lambda name, on: f"{name},{int(on)}",
    level=lambda name, value: f"\\AOp:={name},{value:.6g}",
    longest_lead=0.5,  # TriggIO \Time
)

RAPID = Dialect(
    joint=_MOVE,
    line=_MOVE,
    arc=_MOVE,
    pace="tcp",
    comment="! ",
    zone_parts=True,
    user_frames=True,
    least_acceleration_share=0.2,
    fastest=7.0,
    zones=_zones,
    arcs=ARCS,
    wording=_WORDING,
    outputs=_OUTPUTS,
    signals=SIGNALS,
    structure=True,
)
