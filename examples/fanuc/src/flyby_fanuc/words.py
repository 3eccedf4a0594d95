"""The words of TP's motions, positions and signals."""

from __future__ import annotations

import math
import re

from flyby.core.dialect import Orientation
from flyby.core.program.zone import ZoneKind
from flyby.core.source.lines.amounts import Amount
from flyby.core.source.lines.motions import MotionWords
from flyby.core.source.lines.positions import FrameRegisters, PositionForm
from flyby.core.source.lines.postures import PostureLetters

CNT = ZoneKind("CNT")
"""The next move begins when braking has come down to a share of the speed."""
CR = ZoneKind("CR", None, largest=1.0, unit=1e-3, step=1e-3)
"""Distances before and behind the point, mm."""
_SECONDS = {"sec": Amount("duration", 1.0), "msec": Amount("duration", 1e-3)}
MOTION = MotionWords(
    joint={**_SECONDS, "%": Amount("joint_fraction", 0.01)},
    line={
        **_SECONDS,
        "mm/sec": Amount("tcp", 1e-3),
        "cm/min": Amount("tcp", 1e-2 / 60),
        "inch/min": Amount("tcp", 0.0254 / 60),
        "deg/sec": Amount("reorientation", math.radians(1)),
    },
    zones={"CNT": CNT, "CR": CR},
    unstated="max_speed",
    share="ACC{number}",
    motion="{kind} {via}{point} {speed} {zone} {share}",
)
XYZ = PositionForm(Orientation.EULER_ZYX, last_first=True)
FRAMES = FrameRegisters(
    "UTOOL", "UFRAME", "framevar.va of the controller's backup", ("UTOOL_NUM", "UFRAME_NUM")
)
LETTERS = PostureLetters(wrist="NF", elbow="UD", shoulder="TB", turning=(3, 4, 5))
"""``CONFIG : 'N U T, 0, 0, 0'``: no flip is J5 below zero; the order of the turns is that of
FANUC's remote motion interface (``Turn4, Turn5, Turn6``)."""

_POINT = r"PR?\[(?:[^\[\]]|\[[^\[\]]*\])*\]"
_AMOUNT = r"(?:[\d.]+|A?R\[[^\[\]]*\])"
MOVED = (
    rf"(?P<kind>[JLCA])\s+(?:(?P<via>{_POINT})\s+(?=PR?\[))?(?P<point>{_POINT})\s+"
    rf"(?P<pace>(?P<speed>{_AMOUNT})\s*(?P<unit>%|mm/sec|cm/min|inch/min|deg/sec|msec|sec)"
    rf"|max_speed)\s+(?P<zone>FINE|(?P<word>CNT(?!\s*[\d.]+\s*,)|CR)\s*(?P<size>{_AMOUNT})"
    rf"(?:\s*,\s*(?P<behind>[\d.]+))?)(?=(?:.*?\sACC\s*(?P<share>{_AMOUNT}))?)"
    r"(?P<options>(?:\s.*)?)"
)
"""``L P[1:seam] 500mm/sec CNT50 ACC80 Offset,PR[2] TB .10sec,DO[1]=ON``."""
OPTION = re.compile(
    rf"\s*(?:ACC\s*{_AMOUNT}|(?P<inc>INC\b)"
    rf"|(?P<of_tool>Tool_)?(?P<offset>Offset)(?:\s*,\s*(?P<register>{_POINT}))?"
    r"|(?P<when>TB|TA|DB)\s*(?P<amount>[\d.]+)\s*(?:sec|mm)\s*,\s*(?P<action>.*?)\s*$"
    r"|(?P<plain>PTH|BREAK|COORD|MROT|RTCP|Skip\s*,\s*LBL\[[^\]]*\]|(?:Ind\.)?EV\s*\d+%))",
    re.IGNORECASE,
)
POSITION = (
    r"(?P<name>P\[[^\[\]\r\n]*+\])\s*+\{(?:\s*+GP1\s*+:)?"
    r"\s*+(?:UF\s*+:\s*+(?P<frame>\w+)\s*+,\s*+UT\s*+:\s*+(?P<tool>\w+)\s*+,?+)?"
    r"\s*+(?:CONFIG\s*+:\s*+'(?P<config>[^'{}]*+)'\s*+,?+)?"
    r"(?P<values>(?:(?!GP\d)[^{}])*+)[^{}]*+\}\s*+;"
)
"""``P[1]{GP1: UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0', X = 500.000 mm, …};``"""
COORDINATE = re.compile(r"\b([XYZWPR]|J\d)\s*=\s*(-?\s*[\d.]+)\s*(?:mm|deg)", re.IGNORECASE)

_COMMENT = re.compile(r"(\[(?:[^\[\]:\r\n]|\[[^\[\]:]*\])+)(:[^\]\r\n]{0,80}+)(?=\])")
_SILENT = (re.compile(r"(?<=\[)()GP\d+:|()\r?\n[ \t]+:"), _COMMENT, _COMMENT)
"""Groups of axes, continued lines, comments in brackets, and in those of their indices."""
PIECES = re.compile(
    r"^[ \t]*+/(?:ATTR|APPL)\b(?:(?!^[ \t]*+/).)*+|^[ \t]*+/(?:MN|POS|END)\b[^\r\n]*+"
    r"|^[ ]{5,}+[ \t]*+\d*+:[^\r\n]*+|^[ \t]*+(?:\d*+:)?[ \t]*+(?:---|\*|!|//|--eg)[^\r\n]*+"
    r"|^[ \t]*+(?:\d*+:[ \t]*+(?=[^;\r\n]*+;)|(?=/PROG\b|P\[[^\]\r\n]*+\]\s*+\{))"
    rf"(?P<text>/PROG\b[^\r\n]*+|{re.sub(r'P<.*?>', ':', POSITION)}|[^;\r\n]*+);?",
    re.IGNORECASE | re.MULTILINE | re.DOTALL,
)


def quiet(text: str) -> str:
    """A text with blanks for what says nothing in brackets and between lines."""
    for silent in _SILENT:
        text = silent.sub(lambda found: (found[1] or "").ljust(len(found[0])), text)
    return text
