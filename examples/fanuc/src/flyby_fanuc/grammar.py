"""What TP takes a line for; see `flyby.core.source.lines.program.Grammar`."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType

from flyby.core.source.lines.expressions import Datum, Number, Operation, data_in, parse
from flyby.core.source.lines.statements import (
    Assign,
    AssignAll,
    Body,
    Call,
    Close,
    End,
    If,
    Jump,
    Kept,
    Label,
    Line,
    NumberedPoint,
    Open,
    Otherwise,
    Pause,
    Return,
    Routine,
    Statement,
)
from flyby.core.source.text.files import SourceText

from .configuration import FanucConfiguration
from .moves import MOTION, Place, drive

_SECTION = re.compile(
    r"^[ \t]*/(PROG|ATTR|APPL|MN|POS|END)\b[^\r\n]*", re.MULTILINE | re.IGNORECASE
)
_STATEMENT = re.compile(
    r"^(?P<nested>[ ]{5,}+)?+[ \t]*+\d*+[ \t]*+:"
    r"(?P<text>[ \t]*+(?:!|//|--eg)[^\r\n]*+|[^;\r\n]*+;)",
    re.MULTILINE,
)
_LINE = re.compile(r"[^\r\n]+")
_POSITION = re.compile(r"P\[[^\[\]\r\n]*+\]\s*+\{[^{}]*+\}\s*+;")
_SILENT = (
    re.compile(r"(?<=\[)()(GP\d+:)|()(\r?\n[ \t]+:)"),
    re.compile(r"(\[(?:[^\[\]:\r\n]|\[[^\[\]:]*\])+)(:[^\]\r\n]{0,80}+)(?=\])"),
)
"""Groups of axes, continued lines, comments in brackets."""
_GROUP = re.compile(r"GP1\s*:(?P<body>.*?)(?=GP\d|\}|$)", re.DOTALL | re.IGNORECASE)
_IN_FRAMES = re.compile(r"UF\s*:\s*(\w+)\s*,\s*UT\s*:\s*(\w+)", re.IGNORECASE)
_CONFIG = re.compile(r"CONFIG\s*:\s*'([NF])\s*([LR]\s+)?([UD])\s*([TB])\s*,([^']*)'", re.IGNORECASE)
_COORDINATE = re.compile(r"\b([XYZWPRE]|J\d|E\d)\s*=\s*(-?\s*[\d.]+)\s*(mm|deg)", re.IGNORECASE)
_THEN = re.compile(r"\s*,\s*(?=(?:JMP|CALL)\b)|\s*,\s*(?=[A-Z]+\[)|\s+(?=THEN\b)", re.IGNORECASE)
_CONDITION_OF_OFFSET = ("OFFSET CONDITION", "TOOL_OFFSET CONDITION")
_LONGEST = 400
_WHOLE = ("PR", "UFRAME", "UTOOL")


def lines(source: SourceText) -> Iterator[Line]:
    """Statements and positions of a program, with blanks for comments in brackets."""
    text = source.text
    for silent in (*_SILENT, _SILENT[-1]):  # comments stand in indices, too
        text = silent.sub(_blanked, text)
    quiet = SourceText(text, source.file)
    sections = list(_SECTION.finditer(text))
    ends = [section.start() for section in sections[1:]]
    if not sections:
        yield from _instructions(quiet, 0, len(text))
    for section, end in zip(sections, [*ends, len(text)], strict=False):
        begin, word = section.end(), section[1].upper()
        if word == "PROG":
            yield Line(quiet, section.start(), section.end())
        elif word == "MN":
            yield from _instructions(quiet, begin, end)
        elif word == "POS":
            for found in _POSITION.finditer(text, begin, end):
                yield Line(quiet, *found.span())


def _blanked(found: re.Match[str]) -> str:
    kept = found[1] or ""
    return kept + " " * (len(found[0]) - len(kept))


def _instructions(source: SourceText, at: int, end: int) -> Iterator[Line]:
    while (line := _LINE.search(source.text, at, end)) is not None:
        found = _STATEMENT.match(source.text, line.start(), end)
        at = line.end() if found is None else max(line.end(), found.end())
        if found is None and line[0].strip() and not line[0].strip().startswith(("---", "*")):
            yield Line(source, line.start(), line.end())
        elif found is not None and not found["nested"]:
            yield Line(source, found.start("text"), found.end("text"))


class Grammar:
    """One program's lines; of SELECT and of arcs by ``A`` it knows what stood before."""

    registers = frozenset(
        {"R", "AR", "PR", "UFRAME", "UTOOL", "UFRAME_NUM", "UTOOL_NUM", "OVERRIDE"}
        | set(_CONDITION_OF_OFFSET)
    )
    outputs = frozenset({"DO", "RO", "GO", "AO", "F", "SO", "UO"})
    vectors: Mapping[str, int] = MappingProxyType(dict.fromkeys(_WHOLE, 6))
    argument = "AR"

    def __init__(self) -> None:
        self._selected: Datum | None = None
        self._middle: re.Match[str] | None = None
        self._points = 0

    def statement(self, line: Line) -> Statement | None:
        """One line; a comment says nothing."""
        text = line.text
        if text.upper().startswith("/PROG"):
            return Routine(line.span, text.split()[1])
        if _POSITION.match(text):
            return _position(line)
        said = text.strip()
        if said.startswith(("!", "//", "--eg")) or said in (";", ""):
            return None
        if not said.endswith(";"):
            raise ValueError("a line number with ':' should begin it, and ';' should end it")
        start = line.start + len(text) - len(text.lstrip())
        end = line.start + len(text.rstrip().rstrip(";").rstrip())
        return self.said(replace(line, start=start, end=max(start, end)))

    def said(self, line: Line) -> Statement | None:
        """A statement without what stands round it."""
        if line.end - line.start > _LONGEST:
            raise ValueError(f"a statement has {_LONGEST} characters at most")
        text = line.source.text
        moved = MOTION.fullmatch(text, line.start, line.end)
        if moved is not None:
            return self._motion(line, moved)
        if re.match(r"[JLCAS]\s+PR?\[", line.text):
            raise ValueError("a motion is a position, a speed, FINE, CNT or CR, and options")
        for pattern, make in _FORMS:
            found = pattern.fullmatch(text, line.start, line.end)
            if found is not None:
                return make(self, line, found)
        word = re.match(r"[\w.$]+", line.text)
        name = word[0] if word else line.text[:12]
        return Kept(line.span, name, "what it does is not known", name.upper() == "PAUSE")

    def _motion(self, line: Line, found: re.Match[str]) -> Statement | None:
        """Of arcs by ``A`` the first goes to where they begin, the next through, then to an end."""
        if found["kind"].upper() != "A":
            if self._middle is not None:
                raise ValueError("the arc before has no end: arcs by A have three positions")
            self._points = 0
            return drive(line, found)
        self._points += 1
        if self._points == 1:
            return drive(line, found, "L")
        if self._points % 2 == 0:
            self._middle = found
            return None
        middle, self._middle = self._middle, None
        return drive(line, found, "C", middle)

    def if_(self, line: Line, found: re.Match[str]) -> Statement:
        """``IF R[1]=1,JMP LBL[2]``, ``IF (DI[1]) THEN``"""
        at = line.start + len("IF")
        then = list(_THEN.finditer(line.source.text, at, line.end))
        if not then:
            raise ValueError("THEN, or a comma and an action should follow the condition")
        condition = parse(line.source, at, then[0].start())
        if line.source.text[then[0].end() : line.end].strip().upper() == "THEN":
            return Open(line.span, condition)
        return If(line.span, condition, Body((self._action(line, then[0].end()),)))

    def select(self, line: Line, found: re.Match[str]) -> Statement:
        """``SELECT R[1]=1,JMP LBL[1]``, and the lines of the other cases."""
        datum = parse(line.source, *found.span("datum"))
        if not isinstance(datum, Datum):
            raise ValueError("a register should stand behind SELECT")
        self._selected = datum
        then = Body((self._action(line, found.start("action")),))
        return If(line.span, self._equal(line, found), then)

    def case(self, line: Line, found: re.Match[str]) -> Statement:
        """``=2,CALL PICK`` and ``ELSE,JMP LBL[9]``"""
        if self._selected is None:
            raise ValueError("no SELECT stands before it")
        condition = self._equal(line, found) if found["value"] else None
        return Otherwise(line.span, condition, self._action(line, found.start("action")))

    def _equal(self, line: Line, found: re.Match[str]) -> Operation:
        value = parse(line.source, *found.span("value"))
        assert self._selected is not None
        return Operation(line.span, "=", (self._selected, value))

    def _action(self, line: Line, start: int) -> Statement:
        action = self.said(replace(line, start=start))
        if action is None:
            raise ValueError("an action should follow the condition")
        return action

    def call(self, line: Line, found: re.Match[str]) -> Statement:
        """``CALL PICK(1,R[2])``"""
        given = found["given"] or ""
        at, arguments = found.start("given"), []
        for part in given.split(",") if given.strip() else []:
            if not part.strip().startswith("'"):
                arguments.append(parse(line.source, at, at + len(part)))
            at += len(part) + 1
        return Call(line.span, found["name"], tuple(arguments))

    def loop(self, line: Line, found: re.Match[str]) -> Statement:
        """``FOR R[1]=1 TO 5``"""
        counter, first, last = (
            parse(line.source, *found.span(n)) for n in ("counter", "first", "last")
        )
        if not isinstance(counter, Datum):
            raise ValueError("a register should count")
        step = 1 if found["way"].upper() == "TO" else -1
        return Open(line.span, counter=counter, first=first, last=last, step=step)

    def wait(self, line: Line, found: re.Match[str]) -> Statement:
        """``WAIT 1.00(sec)``, ``WAIT DI[1]=ON TIMEOUT,LBL[2]``"""
        if found["time"]:
            return Pause(line.span, parse(line.source, *found.span("time")))
        condition = parse(line.source, *found.span("condition"))
        alone = isinstance(condition, Datum) and condition.word == "R"
        if alone or not any(data_in(condition)):
            return Pause(line.span, condition)
        return Pause(line.span, condition=condition)

    def setting(self, line: Line, found: re.Match[str]) -> Statement:
        """``UFRAME_NUM=1``, ``OVERRIDE=50%``, ``OFFSET CONDITION PR[1]``"""
        word = " ".join(found["word"].upper().split())
        value = parse(line.source, *found.span("value"))
        if word in _CONDITION_OF_OFFSET:
            if not isinstance(value, Datum) or value.index is None:
                raise ValueError("a position register should stand here")
            value = value.index
        return Assign(line.span, Datum(line.span, word, None), value)

    def assign(self, line: Line, found: re.Match[str]) -> Statement:
        """``R[1]=R[1]+1``, ``DO[2]=ON``, ``PR[1]=P[2]+PR[3]``, ``PR[1,2]=50``"""
        target = parse(line.source, *found.span("target"))
        assert isinstance(target, Datum)
        if target.word not in self.registers | self.outputs or found["value"].upper().startswith(
            "PULSE"
        ):
            return Kept(line.span, target.word, "it does not move the robot")
        if target.word in _WHOLE and target.element is None:
            return _all(line, found, target)
        value = parse(line.source, *found.span("value"))
        return Assign(line.span, target, value)


def _all(line: Line, found: re.Match[str], target: Datum) -> AssignAll:
    if re.fullmatch(r"[LJ]POS", found["value"].strip(), re.IGNORECASE):
        return AssignAll(line.span, target, (), "where the running robot is")
    terms, at = [], found.start("value")
    for part in re.finditer(r"([-+]?)\s*((?:PR?|UFRAME|UTOOL)\[[^\]]*\])\s*", found["value"]):
        datum = parse(line.source, at + part.start(2), at + part.end(2))
        assert isinstance(datum, Datum)
        terms.append((-1.0 if part[1] == "-" else 1.0, datum))
    if not terms:
        raise ValueError("positions and position registers should stand here")
    return AssignAll(line.span, target, tuple(terms))


def _position(line: Line) -> NumberedPoint:
    """``P[1]{GP1: UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0', X = 500.000 mm, …};``"""
    text = line.text
    bracket = line.start + text.index("{")
    body = text[text.index("{") :]
    name = parse(line.source, line.start, bracket)
    if not isinstance(name, Datum):
        raise ValueError("a position is called P[1]")
    name = replace(name, span=line.span)
    group = _GROUP.search(body)
    own, offset = (body, 0) if group is None else (group["body"], group.start("body"))
    values = {}
    for one in _COORDINATE.finditer(own):
        start = bracket + offset + one.start(2)
        span = line.source.span(start, start + len(one[2]))
        values[one[1].upper()] = Number(span, float(one[2].replace(" ", "")))
    frames = _IN_FRAMES.search(own)
    uf, ut = (
        (None if v.upper() == "F" else int(v) for v in frames.groups()) if frames else (None, None)
    )
    joints = "J1" in values
    axes = [f"J{k}" for k in range(1, 7)] if joints else list("XYZWPR")
    if any(axis not in values for axis in axes):
        raise ValueError("six coordinates should stand in it: X to R, or J1 to J6")
    config = _CONFIG.search(own)
    label = None
    if config is not None:
        turns = (*(int(t) for t in re.findall(r"-?\d+", config[5])), 0, 0, 0)[:3]
        label = FanucConfiguration("".join((config[1], config[3], config[4])).upper(), turns)
    numbers = tuple(values[axis] for axis in axes)
    return NumberedPoint(line.span, name, numbers, Place(joints, uf, ut, label))


def _forms() -> list:
    def form(pattern: str) -> re.Pattern[str]:
        return re.compile(pattern, re.IGNORECASE | re.DOTALL)

    return [
        (form(r"LBL\[\s*(\d+)\s*\]"), lambda g, line, m: Label(line.span, m[1])),
        (form(r"JMP\s+LBL\[\s*(\d+)\s*\]"), lambda g, line, m: Jump(line.span, m[1])),
        (form(r"CALL\s+(?P<name>[\w-]+)\s*(?:\((?P<given>.*)\))?"), Grammar.call),
        (
            form(r"PAYLOAD\[.*\]"),
            lambda g, line, m: Kept(line.span, "PAYLOAD", "its mass stands on the controller"),
        ),
        (form(r"END"), lambda g, line, m: Return(line.span)),
        (form(r"ABORT"), lambda g, line, m: End(line.span)),
        (form(r"IF\b.*"), Grammar.if_),
        (form(r"ELSE"), lambda g, line, m: Otherwise(line.span)),
        (form(r"ENDIF|ENDFOR"), lambda g, line, m: Close(line.span)),
        (
            form(r"SELECT\s+(?P<datum>R\[[^\]]*\])\s*=\s*(?P<value>[^,]+),\s*(?P<action>.*)"),
            Grammar.select,
        ),
        (form(r"(?:=\s*(?P<value>[^,]+)|ELSE),\s*(?P<action>.*)"), Grammar.case),
        (
            form(
                r"FOR\s+(?P<counter>R\[[^\]]*\])\s*=\s*(?P<first>.+?)\s+(?P<way>TO|DOWNTO)\s+(?P<last>.+)"
            ),
            Grammar.loop,
        ),
        (
            form(r"WAIT\s+(?:(?P<time>[^(]+?)\s*\(sec\)|(?P<condition>.+?)(?:\s*TIMEOUT\s*,.*)?)"),
            Grammar.wait,
        ),
        (
            form(
                r"(?P<word>UFRAME_NUM|UTOOL_NUM|OVERRIDE)(?:\[[^\]]*\])?\s*=\s*(?P<value>[^%]+?)\s*%?"
            ),
            Grammar.setting,
        ),
        (form(r"(?P<word>(?:TOOL_)?OFFSET\s+CONDITION)\s+(?P<value>PR\[.*\])"), Grammar.setting),
        (form(r"(?P<target>[A-Z]+\[[^=]*?\])\s*=\s*(?P<value>[^=].*)"), Grammar.assign),
    ]


_FORMS = _forms()
