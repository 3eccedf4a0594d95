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
from flyby.core.program.move import Move, MoveC, MoveJ, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, Target
from flyby.core.program.tool import FLANGE, Tool
from flyby.core.program.zone import FINE, VendorZone, Zone, ZoneKind
from flyby.core.source.lines.amounts import Amount, speed_of, stated
from flyby.core.source.lines.expressions import Datum, Number, Operation, Spelling, parse_all
from flyby.core.source.lines.forms import FormGrammar, Found
from flyby.core.source.lines.language import LineLanguage
from flyby.core.source.lines.moves import ArcPoints, made_move
from flyby.core.source.lines.positions import PositionForm
from flyby.core.source.lines.program import Said
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
from flyby.core.source.patch.uses import MovePart, UseKind
from flyby.core.source.text.numerals import nine_decimals
from flyby.core.source.write.options import WriterOptions

LEVELS = (0.0125, 0.025, 0.05, 0.1)
"""m, of PL=1 to PL=4 as operator's manuals of the DX controllers have them."""
PL = ZoneKind("PL", None, largest=LEVELS[-1], unit=1e-3, sizes=LEVELS)
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
)
JOINT = {"VJ": Amount("joint_fraction", 0.01)}
LINE = {"V": Amount("tcp", 1e-3), "VR": Amount("reorientation", math.radians(1))}
XYZ = PositionForm(Orientation.EULER_ZYX, last_first=True)


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
        r"(?:\s+(?P<unit>VJ|V|VR)=(?P<speed>[\d.]+))?"
        r"(?:\s+PL=(?P<level>\d))?(?:\s+ACC=(?P<acc>\d+))?(?:\s+DEC=(?P=acc))?\s*",
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
        pace = self.numbers_at(line, found, "speed" if found["speed"] else "point", "speed", "acc")
        zone = self.numbers_at(line, found, "level" if found["level"] else "point", "level")
        return Drive(line.span, point, pace, zone, _build(kind, found), middle)


def _build(kind: str, found: Found) -> Build:
    def build(target: Numbers, speed: Numbers, zone: Numbers, via: Numbers, now: Situation) -> Move:
        share = speed[-1] / 100 if found["acc"] else 1.0
        pace = Speed(acceleration_override=share)
        if found["unit"]:
            pace = speed_of(found["unit"], speed[0], JOINT | LINE, share)
        goal, tool = _target(target, now)
        through = _target(via, now)[0] if kind == "C" else None
        return made_move(kind, goal, pace, _zone(zone), tool, via=through)

    return build


def _zone(numbers: Numbers) -> Zone:
    """Without a PL the robot is taken to stop."""
    level = int(numbers[0]) if numbers else 0
    if level > len(LEVELS):
        raise InputError(f"how far PL={level} reaches is not published: PL=0 to {len(LEVELS)} are")
    return VendorZone(PL, LEVELS[level - 1]) if level else FINE


def _target(numbers: Numbers, now: Situation) -> tuple[Target, Tool]:
    place, tool = numbers.kind, FLANGE
    if place.tool:
        tool = Tool(f"TOOL {place.tool}", XYZ.pose(now.vector("TOOL", place.tool)))
    if place.type == "PULSE":
        now.computed("target")
        return XYZ.target(_degrees(numbers, now), True), tool
    if place.type not in ("ANGLE", "BASE", "ROBOT"):
        raise InputError(f"positions of type {place.type or '(none)'} are not read: use BASE")
    return XYZ.target(numbers, place.type == "ANGLE"), tool


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


def _level(zone: Zone) -> int:
    if not isinstance(zone, VendorZone):
        return 0
    if zone.size not in LEVELS:
        raise InputError(f"PL has {len(LEVELS)} sizes, and {1000 * zone.size:g} mm is none of them")
    return LEVELS.index(zone.size) + 1


def _pace(move: Move, speed: Speed) -> tuple[str, float] | None:
    return stated(speed, JOINT if isinstance(move, MoveJ) else LINE)


@dataclass
class Writer:
    """Writes one job."""

    positions: list[str] = field(default_factory=list)

    def move(self, move: Move) -> Iterator[str]:
        """The instructions of a move."""
        said = [f"PL={_level(move.zone)}"]
        if (pace := _pace(move, move.speed)) is not None:
            said.insert(0, f"{pace[0]}={nine_decimals(pace[1])}")
        share = nine_decimals(100 * move.speed.acceleration_override)
        said += [] if share == "100" else [f"ACC={share} DEC={share}"]
        words = " ".join(said)
        if isinstance(move, MoveC):
            if not self.positions:
                raise InputError("an arc begins where a motion before it ends: state a start")
            yield f"MOVC C{len(self.positions) - 1:05} {words}"
            yield f"MOVC {self._name(move.via)} {words}"
        yield f"MOV{type(move).__name__[-1]} {self._name(move.target)} {words}"

    def _name(self, target: Target) -> str:
        joints = isinstance(target, JointTarget)
        head = "///POSTYPE ANGLE\n///ANGLE" if joints else "///POSTYPE BASE\n///RECTAN"
        name = f"C{len(self.positions):05}"
        numbers = ",".join(map(nine_decimals, XYZ.numbers(target)))
        self.positions.append(f"{head}\n{name}={numbers}")
        return name

    def wait(self, wait: Wait) -> str:
        """The instruction of a wait."""
        return f"TIMER T={nine_decimals(wait.duration)}"

    def text(self, name: str, lines: list[str]) -> str:
        """The whole job."""
        head = f"/JOB\n//NAME {name}\n//POS\n///NPOS {len(self.positions)},0,0,0,0,0\n///TOOL 0\n"
        body = [*self.positions, "//INST", "///ATTR SC,RW", "///GROUP1 RB1", "NOP", *lines]
        return head + "\n".join([*body, "END", ""])


class Language(LineLanguage):
    """Reads, writes and patches jobs."""

    name = "JBI"
    suffix = ".jbi"
    dialect = SPEAKS
    positions = XYZ
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

    def settings_of(self, kind: UseKind, part: MovePart, move: Move) -> tuple[float, ...]:
        """The numbers at a motion: a speed, and a share of acceleration if stated; a level."""
        if not isinstance(part, Speed):
            return (float(_level(part)),)
        pace, share = _pace(move, part), part.acceleration_override
        shown = () if pace is None else (pace[1],)
        return shown if share == 1.0 else (*shown, 100 * share)
