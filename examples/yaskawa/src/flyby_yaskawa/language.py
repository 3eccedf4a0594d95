"""Jobs of Yaskawa controllers (``.jbi``): INFORM instructions and positions."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import ClassVar

from flyby.core.dialect import Dialect, MoveWords, Orientation
from flyby.core.errors import InputError, SourceError
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import Move, Wait
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget, Target
from flyby.core.program.zone import ZoneKind
from flyby.core.source.lines.amounts import Amount
from flyby.core.source.lines.expressions import Datum, Number, Operation, Spelling, parse_all
from flyby.core.source.lines.forms import FormGrammar, Found
from flyby.core.source.lines.frames import FrameRegisters
from flyby.core.source.lines.language import LineLanguage
from flyby.core.source.lines.motions import MotionWords
from flyby.core.source.lines.moves import ArcPoints, made_move, said
from flyby.core.source.lines.positions import PositionForm
from flyby.core.source.lines.program import Said
from flyby.core.source.lines.signals import Signals
from flyby.core.source.lines.statements import (
    Assign,
    Build,
    Drive,
    Line,
    NumberedPoint,
    Numbers,
    Operand,
    Situation,
)
from flyby.core.source.text.numerals import nine_decimals
from flyby.core.source.write.numbering import PointNumbers
from flyby.core.source.write.options import WriterOptions

LEVELS = (0.0125, 0.025, 0.05, 0.1)
"""m, of PL=1 to PL=4 as operator's manuals of the DX controllers have them."""
PL = ZoneKind("PL", None, largest=LEVELS[-1], unit=1e-3, sizes=LEVELS)
MOTION = MotionWords(
    joint={"VJ": Amount("joint_fraction", 0.01)},
    line={"V": Amount("tcp", 1e-3), "VR": Amount("reorientation", math.radians(1))},
    zones={"PL": PL},
    stop=None,
    speed="{unit}={number}",
    zone="{word}={numbers}",
)
XYZ = PositionForm(Orientation.EULER_ZYX, last_first=True)
FRAMES = FrameRegisters(XYZ, "TOOL")


@dataclass(frozen=True, slots=True)
class Place:
    """What a position is beside its numbers: ``PULSE``, ``ANGLE``, ``BASE`` …; its tool."""

    type: str
    tool: int


class Grammar(FormGrammar):
    """What a line says; it knows the type of the positions before, and how far an arc has come."""

    registers = frozenset("BIDR")
    outputs = frozenset({"OT"})
    vectors: ClassVar = {"TOOL": 6, "PULSE": 6}
    spelling = Spelling(datum=re.compile(r"(?P<word>[BIDR]|IN|OT)#?\(?(?P<index>\d+)\)?"))
    driving = re.compile("MOV")
    stopping = frozenset({"PAUSE"})
    forms: ClassVar = {
        "routine": r"//NAME (?P<name>\S+).*",
        "head": r"/+(?P<word>\w+) ?(?P<value>.*)",
        "nothing": r"'.*|NOP",
        "position": r"(?P<name>[CP])(?P<number>\d+)=(?P<values>[-+.\d, ]+)",
        "motion": r"MOV(?P<kind>[JLC])\s+(?P<point>[CP]\d+)"
        r"(?:\s+(?P<pace>(?P<unit>VJ|V|VR)=(?P<speed>[\d.]+)))?"
        r"(?:\s+(?P<zone>PL=(?P<level>\d)))?(?:\s+ACC=(?P<acc>\d+))?(?:\s+DEC=(?P=acc))?\s*",
        "when": r"(?P<action>(?!MOV).*?)\s+IF\s+(?P<condition>.*)",
        "label": r"\*(?P<name>\S+)",
        "jump": r"JUMP\s+\*(?P<name>\S+)",
        "call": r"CALL JOB:(?P<name>[\w-]+)",
        "returned": r"END|RET",
        "wait": r"TIMER\s+T=(?P<time>.*)",
        "wait.for": r"WAIT\s+(?P<condition>.*?)(?:\s+T=.*)?",
        "assigned.out": r"DOUT\s+(?P<target>OT#\(\d+\))\s+(?P<value>ON|OFF)",
        "assigned": r"SET\s+(?P<target>\S+)\s+(?P<value>\S+)",
        "changed": r"(?P<sign>ADD|SUB|MUL|DIV|INC|DEC)\s+(?P<target>\S+)(?:\s+(?P<value>\S+))?",
    }

    def __init__(self) -> None:
        super().__init__()
        self._type, self._tool, self._before = "", 0, ""
        self._arc: ArcPoints[Operand] = ArcPoints()

    def head(self, line: Line, found: Found) -> Said:
        """What describes the job, or the positions that follow."""
        self._type = found["value"].strip() if found["word"] == "POSTYPE" else self._type
        self._tool = int(found["value"]) if found["word"] == "TOOL" else self._tool
        return None

    def changed(self, line: Line, found: Found) -> Said:
        """``ADD B001 B002``, ``INC B001``"""
        target, sign = self.datum(line, found, "target"), found["sign"].upper()
        value = self.parse(line, found, "value") if found["value"] else Number(line.span, 1.0)
        word = {"ADD": "+", "INC": "+", "MUL": "*", "DIV": "/"}.get(sign, "-")
        return Assign(line.span, target, Operation(line.span, word, (target, value)))

    def position(self, line: Line, found: Found) -> Said:
        """``C00001=400.000,0.000,…``"""
        name = Datum(line.span, found["name"], Number(line.span, float(found["number"])))
        numbers = parse_all(line.source, *found.span("values"))
        if len(numbers) != 6:
            raise InputError("a position has six numbers")
        return NumberedPoint(line.span, name, numbers, Place(self._type, self._tool))

    def motion(self, line: Line, found: Found) -> Said:
        """``MOVC``: the first goes to where the arc begins, the next through, then to its end."""
        span = line.source.span(*found.span("point"))
        number = Number(span, float(found["point"][1:]))
        point = Operand(span, point=Datum(span, found["point"][0], number))
        before, self._before = self._before, found["point"]
        kind, middle = found["kind"], None
        if kind != "C":
            self._arc.end()
        elif before == found["point"] and self._arc.open:
            self._arc.begin()
            return None
        else:
            kind, middle = self._arc.add(point)
        if not kind:
            return None
        pace = self.numbers_at(line, found, "pace", "speed", "acc")
        zone = self.numbers_at(line, found, "zone", "level")
        return Drive(line.span, point, pace, zone, _build(kind, found), middle)


def _build(kind: str, found: Found) -> Build:
    def build(target: Numbers, speed: Numbers, zone: Numbers, via: Numbers, now: Situation) -> Move:
        goal, through = _target(target, now), _target(via, now) if kind == "C" else None
        pace = MOTION.speed_of(kind, found["unit"], speed, bool(found["acc"]))
        tool = FRAMES.tool_of(target.kind.tool, now)
        return made_move(kind, goal, pace, MOTION.zone_of("PL", zone), tool, via=through)

    return build


def _target(numbers: Numbers, now: Situation) -> Target:
    place = numbers.kind
    if place.type == "PULSE":
        now.computed("target")
        return XYZ.target(_degrees(numbers, now), True)
    if place.type not in ("ANGLE", "BASE", "ROBOT"):
        raise InputError(f"positions of type {place.type or '(none)'} are not read: use BASE")
    return XYZ.target(numbers, place.type == "ANGLE")


def _degrees(pulses: Numbers, now: Situation) -> list[float]:
    """Of pulses; how many a degree has stands in the controller's parameters."""
    try:
        rates = now.vector("PULSE", 1)
    except SourceError:
        raise InputError(
            "how many pulses a degree has is not known: answer PULSE[1,1] to PULSE[1,6] in the "
            "table [values], or convert the job's positions (BASE)"
        ) from None
    return [a / b for a, b in zip(pulses, rates, strict=True)]


_LINE_WORDS = MoveWords(
    (PL,),
    frozenset({"tcp", "reorientation", "acceleration_override"}),
    exclusive=frozenset({"tcp", "reorientation"}),
    configurations=False,
)
SPEAKS = Dialect(
    joint=MoveWords(
        (PL,),
        frozenset({"joint_fraction", "acceleration_override"}),
        frozenset({"joint_fraction"}),
        configurations=False,
    ),
    line=_LINE_WORDS,
    arc=_LINE_WORDS,
    arc_orientations=frozenset({ArcOrientation.FIXED_FRAME}),
    pace="joint_fraction",
    comment="'",
    tools=False,
    work_objects=False,
    loads=False,
    stationary_tools=False,
    external_axes=False,
    orientation=Orientation.EULER_ZYX,
    fastest=1.5,
    most={"acceleration_override": 1.0},
    signals=Signals(
        Grammar,
        digital=("OT",),
        inputs=("IN",),
        written="{word}#({number})",
        switch="DOUT {signal} {value}",
    ).dialect(),
)


def _position(number: int, target: Target) -> str:
    joints = isinstance(target, JointTarget)
    head = "///POSTYPE ANGLE\n///ANGLE" if joints else "///POSTYPE BASE\n///RECTAN"
    return f"{head}\nC{number:05}={','.join(map(nine_decimals, XYZ.numbers(target)))}"


@dataclass
class Writer:
    """Writes one job."""

    _positions: PointNumbers = field(default_factory=lambda: PointNumbers(_position, first=0))
    _last: int | None = None

    def move(self, move: Move) -> Iterator[str]:
        """The instructions of a move; without a PL the robot is taken to stop."""
        words = f"{MOTION.speed_text(move)} {MOTION.zone_text(move)}".strip()
        share = nine_decimals(100 * move.speed.acceleration_override)
        words += "" if share == "100" else f" ACC={share} DEC={share}"
        kind, targets = said(move)
        numbers = [self._positions.of(target) for target in targets]
        if kind == "C":
            if self._last is None:
                raise InputError("an arc begins where a motion before it ends: state a start")
            numbers.insert(0, self._last)
        self._last = numbers[-1]
        yield from (f"MOV{kind} C{number:05} {words}" for number in numbers)

    def wait(self, wait: Wait) -> str:
        """The instruction of a wait."""
        return f"TIMER T={nine_decimals(wait.duration)}"

    def text(self, name: str, lines: list[str]) -> str:
        """The whole job."""
        count, positions = len(self._positions.texts), self._positions.texts
        head = f"/JOB\n//NAME {name}\n//POS\n///NPOS {count},0,0,0,0,0\n///TOOL 0\n"
        body = [*positions, "//INST", "///ATTR SC,RW", "///GROUP1 RB1", "NOP", *lines]
        return head + "\n".join([*body, "END", ""])


class Language(LineLanguage):
    """Reads, writes and patches jobs."""

    name = "JBI"
    suffix = ".jbi"
    dialect = SPEAKS
    positions = XYZ
    motion = MOTION
    called = re.compile(r"\bCALL\s+JOB:([\w-]+)")

    def grammar(self) -> Grammar:
        """See `LineLanguage`."""
        return Grammar()

    def writer(self, options: WriterOptions) -> Writer:
        """See `LineLanguage`."""
        return Writer()

    def file_name(self, program: Program) -> str:
        """A name of 32 signs at most."""
        return super().file_name(program).upper()[:32]
