"""Jobs of Yaskawa controllers (``.jbi``): INFORM instructions and positions."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import ClassVar

from flyby.core.dialect import Orientation
from flyby.core.errors import InputError, SourceError
from flyby.core.program.move import Move
from flyby.core.program.target import JointTarget, Target
from flyby.core.program.zone import ZoneKind
from flyby.core.source.lines.amounts import Amount
from flyby.core.source.lines.driving import MotionGrammar, dialect_of
from flyby.core.source.lines.expressions import Number, Operation, Spelling
from flyby.core.source.lines.forms import Found
from flyby.core.source.lines.language import LineLanguage, LineWriter
from flyby.core.source.lines.motions import MotionWords
from flyby.core.source.lines.moves import said
from flyby.core.source.lines.positions import FrameRegisters, Place, Placed, PositionForm
from flyby.core.source.lines.program import Said
from flyby.core.source.lines.signals import Signals
from flyby.core.source.lines.statements import Assign, Line, Numbers, Situation
from flyby.core.source.text.numerals import nine_decimals

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
    share="ACC={number} DEC={number}",
    motion="MOV{kind} {via}{point} {speed} {zone} {share}",
)
XYZ = PositionForm(Orientation.EULER_ZYX, last_first=True)


class Grammar(MotionGrammar):
    """What a line says; it knows the type of the positions before."""

    form = XYZ
    words = MOTION
    chained = frozenset({"C"})
    registers = frozenset("BIDR")
    outputs = frozenset({"OT"})
    frames = FrameRegisters("TOOL")
    vectors: ClassVar = {"PULSE": 6}
    spelling = Spelling(datum=re.compile(r"(?P<word>[BIDRCP]|IN|OT)#?\(?(?P<index>\d+)\)?"))
    driving = re.compile("MOV")
    stopping = frozenset({"PAUSE"})
    forms: ClassVar = {
        "routine": r"//NAME (?P<name>\S+).*",
        "head": r"/+(?P<word>\w+) ?(?P<value>.*)",
        "nothing": r"'.*|NOP",
        "point": r"(?P<name>[CP]\d+)=(?P<values>[-+.\d, ]+)",
        "motion": r"MOV(?P<kind>[JLC])\s+(?P<point>[CP]\d+)"
        r"(?:\s+(?P<pace>(?P<unit>VJ|V|VR)=(?P<speed>[\d.]+)))?"
        r"(?:\s+(?P<zone>PL=(?P<size>\d)))?(?:\s+ACC=(?P<share>\d+))?(?:\s+DEC=(?P=share))?\s*",
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
        self._type, self._tool = "", 0

    def head(self, line: Line, found: Found) -> Said:
        """What describes the job, or the positions that follow."""
        value = found["value"].strip()
        self._type = value if found["word"] == "POSTYPE" else self._type
        self._tool = int(value) if found["word"] == "TOOL" else self._tool
        return None

    def changed(self, line: Line, found: Found) -> Said:
        """``ADD B001 B002``, ``INC B001``"""
        target, sign = self.datum(line, found, "target"), found["sign"].upper()
        value = self.parse(line, found, "value") if found["value"] else Number(line.span, 1.0)
        word = {"ADD": "+", "INC": "+", "MUL": "*", "DIV": "/"}.get(sign, "-")
        return Assign(line.span, target, Operation(line.span, word, (target, value)))

    def kind_of(self, found: Found) -> tuple[str, int]:
        """Of a position: ``PULSE``, ``ANGLE``, ``BASE`` …; its tool."""
        return self._type, self._tool

    def placed(self, numbers: Numbers, now: Situation) -> Placed:
        """Of pulses, in joint values or in the base."""
        kind, tool = numbers.kind
        if kind not in ("PULSE", "ANGLE", "BASE", "ROBOT"):
            raise InputError(f"positions of type {kind or '(none)'} are not read: use BASE")
        if kind == "PULSE":
            now.computed("target")
            numbers = _degrees(numbers, now)
        return super().placed(Numbers.of(numbers, Place(kind in ("PULSE", "ANGLE"), tool, 0)), now)


def _degrees(pulses: Numbers, now: Situation) -> Numbers:
    """Of pulses; how many a degree has stands in the controller's parameters."""
    try:
        rates = now.vector("PULSE", 1)
    except SourceError:
        raise InputError(
            "how many pulses a degree has is not known: answer PULSE[1,1] to PULSE[1,6] in the "
            "table [values], or convert the job's positions (BASE)"
        ) from None
    return Numbers.of(a / b for a, b in zip(pulses, rates, strict=True))


SPEAKS = dialect_of(
    Grammar,
    "'",
    tools=False,
    work_objects=False,
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


class Writer(LineWriter):
    """Writes one job; without a PL the robot is taken to stop."""

    called = "C{number:05}"
    first = 0
    pause = "TIMER T={time}"

    def __init__(self) -> None:
        super().__init__()
        self._last: str | None = None

    def point(self, number: int, target: Target, *beside: str) -> str:
        """See `LineWriter`."""
        joints = isinstance(target, JointTarget)
        head = "///POSTYPE ANGLE\n///ANGLE" if joints else "///POSTYPE BASE\n///RECTAN"
        return f"{head}\nC{number:05}={','.join(map(nine_decimals, XYZ.numbers(target)))}"

    def move(self, move: Move) -> Iterator[str]:
        """Each point has a motion; an arc begins with the one where the robot stands."""
        kind, targets = said(move)
        names = [self.name(target) for target in targets]
        if kind == "C":
            if self._last is None:
                raise InputError("an arc begins where a motion before it ends: state a start")
            names.insert(0, self._last)
        self._last = names[-1]
        yield from (MOTION.text(move, name) for name in names)

    def text(self, name: str, lines: list[str]) -> str:
        """The whole job."""
        count, positions = len(self.points.texts), self.points.texts
        head = f"/JOB\n//NAME {name}\n//POS\n///NPOS {count},0,0,0,0,0\n///TOOL 0\n"
        body = [*positions, "//INST", "///ATTR SC,RW", "///GROUP1 RB1", "NOP", *lines]
        return head + "\n".join([*body, "END", ""])


class Language(LineLanguage):
    """Reads, writes and patches jobs."""

    name = "JBI"
    suffix = ".jbi"
    dialect = SPEAKS
    grammar = Grammar
    writer = Writer
    called = re.compile(r"\bCALL\s+JOB:([\w-]+)")
    longest_name = 32
    capitals = True
