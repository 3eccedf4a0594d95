"""What TP takes a line for; see `flyby.core.source.lines.forms`."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import ClassVar

from flyby.core.errors import InputError
from flyby.core.source.lines.driving import MotionGrammar, Placed
from flyby.core.source.lines.expressions import Datum, Number, Spelling, parse
from flyby.core.source.lines.forms import Found
from flyby.core.source.lines.postures import PostureLabel
from flyby.core.source.lines.program import Said
from flyby.core.source.lines.statements import Line, NumberedPoint, Numbers, Situation
from flyby.core.source.text.files import SourceText

from .moves import MOTION, OPTION, Place, events, moved
from .words import FRAMES, XYZ
from .words import MOTION as MOTION_WORDS

_SECTION = re.compile(r"^[ \t]*/(PROG|ATTR|APPL|MN|POS|END)\b[^\r\n]*", re.M | re.I)
_STATEMENT = re.compile(
    r"^(?P<nested>[ ]{5,}+)?+[ \t]*+\d*+[ \t]*+:[ \t]*+"
    r"(?:(?P<silent>(?:!|//|--eg)[^\r\n]*+)|(?P<text>[^;\r\n]*+);)",
    re.MULTILINE,
)
_LINE = re.compile(r"[^\r\n]+")
_IDLE = re.compile(r"\s*(?:---|\*|!|//|--eg|$)")
_POSITION = re.compile(r"P\[[^\[\]\r\n]*+\]\s*+\{[^{}]*+\}\s*+;")
_COMMENT = re.compile(r"(\[(?:[^\[\]:\r\n]|\[[^\[\]:]*\])+)(:[^\]\r\n]{0,80}+)(?=\])")
_SILENT = (re.compile(r"(?<=\[)()GP\d+:|()\r?\n[ \t]+:"), _COMMENT, _COMMENT)
"""Groups of axes, continued lines, comments in brackets, and in those of their indices."""
_GROUP = re.compile(r"GP1\s*:(?P<body>.*?)(?=GP\d|\}|$)", re.DOTALL | re.IGNORECASE)
_IN_FRAMES = re.compile(r"UF\s*:\s*(\w+)\s*,\s*UT\s*:\s*(\w+)", re.IGNORECASE)
_CONFIG = re.compile(r"CONFIG\s*:\s*'([NF])\s*([LR]\s+)?([UD])\s*([TB])\s*,([^']*)'", re.IGNORECASE)
_COORDINATE = re.compile(r"\b([XYZWPRE]|J\d|E\d)\s*=\s*(-?\s*[\d.]+)\s*(mm|deg)", re.IGNORECASE)
_WHOLE = ("PR", "UFRAME", "UTOOL")


def quiet(text: str) -> str:
    """A text with blanks for what says nothing in brackets and between lines."""
    for silent in _SILENT:
        text = silent.sub(lambda found: (found[1] or "").ljust(len(found[0])), text)
    return text


def lines(source: SourceText) -> Iterator[Line]:
    """Statements and positions of a program.

    Raises:
        SourceError: a line is none.
    """
    read = SourceText(quiet(source.text), source.file)
    sections = list(_SECTION.finditer(read.text))
    starts = [(0, 0, "MN")] if not sections else [(s.start(), s.end(), s[1]) for s in sections]
    ends = [start for start, _, _ in starts[1:]]
    for (start, begin, word), end in zip(starts, [*ends, len(read.text)], strict=True):
        if word.upper() == "PROG":
            yield Line(read, start, begin)
        elif word.upper() == "MN":
            yield from _instructions(read, begin, end)
        elif word.upper() == "POS":
            yield from (Line(read, *p.span()) for p in _POSITION.finditer(read.text, begin, end))


def _instructions(source: SourceText, at: int, end: int) -> Iterator[Line]:
    while (line := _LINE.search(source.text, at, end)) is not None:
        found = _STATEMENT.match(source.text, line.start(), end)
        at = line.end() if found is None else max(line.end(), found.end())
        if found is None and not _IDLE.match(line[0]):
            why = "a line number with ':' should begin it, and ';' should end it"
            raise source.error(why, line.start())
        if found is not None and found["text"] and not found["nested"]:
            start = found.start("text")
            yield Line(source, start, start + len(found["text"].rstrip()))


class Grammar(MotionGrammar):
    """One program's lines."""

    form = XYZ
    words = MOTION_WORDS
    chained = frozenset({"A"})
    override = "OVERRIDE"
    registers = frozenset(
        {"R", "AR", "UFRAME_NUM", "UTOOL_NUM", "OVERRIDE", "OFFSET", "TOOL_OFFSET", *_WHOLE}
    )
    outputs = frozenset({"DO", "RO", "GO", "AO", "F", "SO", "UO"})
    vectors: ClassVar = dict.fromkeys(_WHOLE, 6)
    argument = "AR"
    spelling = Spelling(names=True)
    driving = re.compile(r"[JLCAS]\s+PR?\[|IF\b", re.IGNORECASE)
    stopping = frozenset({"PAUSE"})
    current = frozenset({"LPOS", "JPOS"})
    longest = 400
    forms: ClassVar = {
        "routine": r"/PROG\s+(?P<name>\S+).*",
        "position": _POSITION.pattern,
        "motion": MOTION,
        "label": r"LBL\[\s*(?P<name>\d+)\s*\]",
        "jump": r"JMP\s+LBL\[\s*(?P<name>\d+)\s*\]",
        "call": r"CALL\s+(?P<name>[\w-]+)\s*(?:\((?P<arguments>.*)\))?",
        "harmless": r"PAYLOAD\[.*\]",
        "returned": r"END",
        "end": r"ABORT",
        "opened": r"IF\b(?P<condition>.+?)\s+THEN",
        "when": r"IF\b(?P<condition>.+?)\s*,\s*(?P<action>(?:JMP|CALL)\b.*|[A-Z]+\[.*)",
        "otherwise": r"ELSE",
        "closed": r"ENDIF|ENDFOR",
        "selected": r"SELECT\s+(?P<datum>R\[[^\]]*\])\s*=\s*(?P<value>[^,]+),\s*(?P<action>.*)",
        "case": r"(?:=\s*(?P<value>[^,]+)|ELSE),\s*(?P<action>.*)",
        "counted": r"FOR\s+(?P<counter>R\[[^\]]*\])\s*=\s*(?P<first>.+?)\s+(?:TO|(?P<down>DOWNTO))"
        r"\s+(?P<last>.+)",
        "wait": r"WAIT\s+(?P<time>[^(]+?)\s*\(sec\)",
        "wait.register": r"WAIT\s+(?P<time>[\d.]+|R\[[^\]=<>]*\])",
        "wait.for": r"WAIT\s+(?P<condition>.+?)(?:\s*TIMEOUT\s*,.*)?",
        "assigned.held": r"(?P<target>UFRAME_NUM|UTOOL_NUM|OVERRIDE)(?:\[[^\]]*\])?\s*=\s*"
        r"(?P<value>[^%]+?)\s*%?",
        "assigned.offset": r"(?P<target>(?:TOOL_)?OFFSET)\s+CONDITION\s+PR\[(?P<value>.*)\]",
        "pulsed": r"(?P<target>\w+\[[^=]*?\])\s*=\s*PULSE\s*,\s*(?P<time>[\d.]+)\s*sec",
        "assigned": r"(?P<target>[A-Z]+\[[^=]*?\])\s*=\s*(?P<value>[^=].*)",
    }

    def motion(self, line: Line, found: Found) -> Said:
        """A motion with its options."""
        given = self.options(line, found, "options", OPTION)
        return self.drive(line, found, moved(line, given), events(line, given))

    def placed(self, numbers: Numbers, now: Situation) -> Placed:
        """In the frames of the position, or those that are set."""
        place = numbers.kind or Place()
        goal = XYZ.target(numbers[:6], place.joints, place.configuration)
        return Placed(goal, *FRAMES.both(place.tool, place.frame, now))

    def position(self, line: Line, found: Found) -> Said:
        """``P[1]{GP1: UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0', X = 500.000 mm, …};``"""
        bracket = line.start + line.text.index("{")
        name = parse(line.source, line.start, bracket)
        assert isinstance(name, Datum)
        group = _GROUP.search(line.source.text, bracket, line.end)
        begin, end = (bracket, line.end) if group is None else group.span("body")
        values = {}
        for one in _COORDINATE.finditer(line.source.text, begin, end):
            span = line.source.span(*one.span(2))
            values[one[1].upper()] = Number(span, float(one[2].replace(" ", "")))
        joints = "J1" in values
        axes = [f"J{k}" for k in range(1, 7)] if joints else list("XYZWPR")
        if any(axis not in values for axis in axes):
            raise InputError("six coordinates should stand in it: X to R, or J1 to J6")
        place = _place(line.source.text[begin:end], joints)
        point = replace(name, span=line.span)
        return NumberedPoint(line.span, point, tuple(values[axis] for axis in axes), place)


def _place(own: str, joints: bool) -> Place:
    frames, config = _IN_FRAMES.search(own), _CONFIG.search(own)
    numbers = ("F", "F") if frames is None else frames.groups()
    frame, tool = (None if v.upper() == "F" else int(v) for v in numbers)
    label = None
    if config is not None:
        turns = (*(int(t) for t in re.findall(r"-?\d+", config[5])), 0, 0, 0)[:3]
        label = PostureLabel("".join((config[1], config[3], config[4])).upper(), turns)
    return Place(joints, frame, tool, label)
