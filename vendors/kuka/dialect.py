"""What KRL has words for ($VEL, $ACC, $VEL_AXIS, $ACC_AXIS, $APO, $ADVANCE)."""

from __future__ import annotations

import re

from ...core.dialect import Dialect, MoveWords, Orientation, OutputWords, Pitfall, Wording
from ...core.program.zone import Angle, ContourFraction, Radius

_NAME = r"[^\W\d][\w$]*"
_DECLARED = rf"{_NAME}(?:[ \t]*\[[^\]\r\n]*\])?"
_ASKS = re.compile(r"\bC_(?:DIS|PTP|ORI|VEL|SPL)\b", re.IGNORECASE)

_WORDING = Wording(
    silent=re.compile(r';[^\r\n]*|"[^"\r\n]*"'),
    targets=re.compile(
        r"^[ \t]*(?:decl[ \t]+)?(?:const[ \t]+)?(?:e6pos|e6axis|pos|axis)[ \t]+"
        rf"(?P<names>{_DECLARED}(?:[ \t]*,[ \t]*{_DECLARED})*)",
        re.IGNORECASE | re.MULTILINE,
    ),
    name=re.compile(rf"{_NAME}|\$[\w$]+"),
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

_PATH = MoveWords(
    (Radius, Angle),
    frozenset({"tcp", "reorientation", "tcp_acceleration", "reorientation_acceleration"}),
    frozenset({"tcp"}),
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
    wording=_WORDING,
    outputs=OutputWords(_switch, _level, longest_lead=1.0),
)
