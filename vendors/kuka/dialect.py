"""What KRL has words for ($VEL, $ACC, $VEL_AXIS, $ACC_AXIS, $APO, $ADVANCE)."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import PurePath

from ...core.dialect import (
    Dialect,
    Mention,
    MoveWords,
    Orientation,
    OutputWords,
    Pitfall,
    RoutineText,
    Wording,
)
from ...core.program.zone import Angle, ContourFraction, Radius
from .settings_in_force import unsaid
from .signals import SIGNALS
from .zone_kinds import C_VEL

_NAME = r"[^\W\d][\w$]*"
_DECLARED = rf"{_NAME}(?:[ \t]*\[[^\]\r\n]*\])?"
_ASKS = re.compile(r"\bC_(?:DIS|PTP|ORI|VEL|SPL)\b", re.IGNORECASE)

_ROUTINE = re.compile(
    r"^[ \t]*(?:GLOBAL[ \t]+)?DEF(?:FCT[ \t]+[^\r\n(]*?)?[ \t]+(?P<name>[\w$]+)[ \t]*"
    r"\((?P<parameters>[^)]*)\)(?P<body>).*?^[ \t]*END(?:FCT)?[ \t]*$",
    re.IGNORECASE | re.MULTILINE | re.DOTALL,
)


def _routines(text: str) -> Iterator[RoutineText]:
    for found in _ROUTINE.finditer(text):
        places = found.start(), found.end("body"), found.end()
        yield RoutineText(found["name"], found["parameters"], *places)


def _module(file: str) -> str:
    """A ``.src`` and its ``.dat`` are one module."""
    return str(PurePath(file).with_suffix("")).casefold()


_TYPES = frozenset(
    ["int", "real", "bool", "char", "frame", "pos", "e6pos", "axis", "e6axis", "load", "signal"]
).union(["enum", "struc"])
_DECLARING = re.compile(
    r"[ \t]*(?P<words>(?:(?:DECL|GLOBAL|CONST)[ \t]+)*)(?P<type>\w+)[ \t]+"
    r"(?P<names>[^\W\d][^=\r\n]*)",
    re.IGNORECASE,
)
_HEAD = re.compile(
    r"[ \t]*(?:GLOBAL[ \t]+)?DEF(?:DAT|FCT[ \t]+[^(]*?)?[ \t]+(?P<name>[\w$]+)[ \t]*"
    r"(?:\((?P<parameters>[^)]*))?",
    re.IGNORECASE,
)
_SET = re.compile(
    r"[ \t]*(?:FOR[ \t]+)?(?P<name>[^\W\d][\w$]*)(?:[ \t]*\[[^\]]*\]|\.\w+)*[ \t]*=(?!=)",
    re.IGNORECASE,
)
_USED = re.compile(r"(?<![\w$.#])[^\W\d][\w$]*")
_INDEXED = re.compile(r"\[[^\]]*\]")


def _named(text: str) -> Iterator[tuple[str, Mention]]:
    for line in text.splitlines():
        head, declaring, given = (p.match(line) for p in (_HEAD, _DECLARING, _SET))
        at = 0
        if head is not None:
            names = [head["name"], *_USED.findall(re.sub(r":\w+", "", head["parameters"] or ""))]
            yield from ((name, Mention.DECLARED) for name in names)
            continue
        if declaring is not None and _declares(declaring):
            at = declaring.end()
            names = _USED.findall(_INDEXED.sub("", declaring["names"]))
            one = declaring["type"].lower() in ("signal", "enum", "struc")
            yield from ((name, Mention.DECLARED) for name in names[: 1 if one else None])
        elif given is not None:
            at = given.end()
            yield given["name"], Mention.ASSIGNED
        yield from ((name, Mention.USED) for name in _USED.findall(line, at))


def _declares(line: re.Match[str]) -> bool:
    kind = line["type"].lower()
    return kind in _TYPES or (kind != "interrupt" and "decl" in line["words"].lower())


_WORDING = Wording(
    silent=re.compile(r';[^\r\n]*|"[^"\r\n]*"'),
    targets=re.compile(
        r"^[ \t]*(?:decl[ \t]+)?(?:global[ \t]+)?(?:const[ \t]+)?(?:e6pos|e6axis|pos|axis)[ \t]+"
        rf"(?P<names>{_DECLARED}(?:[ \t]*,[ \t]*{_DECLARED})*)",
        re.IGNORECASE | re.MULTILINE,
    ),
    name=re.compile(rf"{_NAME}|\$[\w$]+"),
    heads=re.compile(
        r"IF\b[^\r\n]*?\bTHEN\b|(?:FOR|WHILE|REPEAT|LOOP|SWITCH)\b[^\r\n]*", re.IGNORECASE
    ),
    routines=_routines,
    module=_module,
    named=_named,
    unsaid=unsaid,
    blocks=re.compile(
        r"^[ \t]*(?:(?P<open>IF|FOR|WHILE|REPEAT|LOOP|SWITCH)\b|(?P<part>ELSE|CASE|DEFAULT)\b"
        r"|(?P<close>END(?:IF|FOR|WHILE|LOOP|SWITCH)|UNTIL)\b|(?P<label>\w+[ \t]*:(?!=)))"
        r"|\b(?P<once>(?:TRIGGER|INTERRUPT|WITH)\b[^\r\n]*)",
        re.IGNORECASE | re.MULTILINE,
    ),
    pitfalls=(
        Pitfall(
            re.compile(
                r"\$APO\.C(?:DIS|PTP|ORI|VEL)[ \t]*=[ \t]*(?!0*\.?0*[ \t]*$)[^\r\n]*?(?=[ \t]*$)",
                re.IGNORECASE | re.MULTILINE,
            ),
            "{words} is set, but no motion asks for it: the robot stops at every point",
            "write C_DIS (after PTP C_PTP) behind the motions that are to be passed, or take "
            "it out",
            without=_ASKS,
        ),
        Pitfall(
            re.compile(r"\$ADVANCE[ \t]*=[ \t]*0(?![\d.])", re.IGNORECASE),
            "{words}: there is no advance run, and nothing is approximated while it is so",
            "set $ADVANCE to 1 or more (3 is usual), or program exact stops",
            beside=_ASKS,
        ),
    ),
)

_MOST = {
    "tcp_acceleration": 10.0,
    "reorientation": math.radians(400),
    "reorientation_acceleration": math.radians(1000),
}
"""m/s², rad/s and rad/s²: $ACC_MA and $VEL_MA of the machine data that KR C4 come with. A program
that sets more stops with an error."""

_PATH = MoveWords(
    (Radius, Angle, C_VEL),
    frozenset({"tcp", "reorientation", "tcp_acceleration", "reorientation_acceleration"}),
    frozenset({"tcp"}),
    configurations=False,  # LIN and CIRC keep the Status, whatever S and T say
)


def _switch(name: str, on: bool) -> str:
    """``$OUT[5]=TRUE`` by the output's number, ``gun=TRUE`` by its declared name."""
    return f"{f'$OUT[{name}]' if name.isdecimal() else name}={'TRUE' if on else 'FALSE'}"


def _level(name: str, value: float) -> str:
    """``$ANOUT[1]=0.5``; analogue outputs take shares of 10 V."""
    return f"{f'$ANOUT[{name}]' if name.isdecimal() else name}={value:.6g}"


KRL = Dialect(
    joint=MoveWords(
        # C_DIS on PTP (KSS 8.2 and newer) takes fractions of a mm, C_PTP whole percents.
        (Radius, ContourFraction),
        frozenset({"joint_fraction", "joint_acceleration_fraction"}),
        frozenset({"joint_fraction"}),
    ),
    line=_PATH,
    arc=_PATH,
    pace="joint_fraction",
    comment="; ",
    orientation=Orientation.EULER_ZYX,
    fastest=3.0,
    most=_MOST,
    wording=_WORDING,
    outputs=OutputWords(_switch, _level, 1.0, from_start=False, along_joint=False),
    signals=SIGNALS,
    structure=True,
)
