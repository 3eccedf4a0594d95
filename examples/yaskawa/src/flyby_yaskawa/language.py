"""Jobs of Yaskawa controllers (``.jbi``): INFORM instructions and positions."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType

import numpy as np

from flyby.core.dialect import Dialect, MoveWords, Orientation
from flyby.core.errors import InputError, SourceError
from flyby.core.language import Sources
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL, Opaque, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget, Target
from flyby.core.program.tool import FLANGE, Tool
from flyby.core.program.zone import FINE, VendorZone, Zone, ZoneKind
from flyby.core.robot.model import Robot
from flyby.core.source.lines.expressions import Datum, Expression, Number, Operation, Truth
from flyby.core.source.lines.files import with_called
from flyby.core.source.lines.interpreter import run_lines
from flyby.core.source.lines.patcher import patch_lines
from flyby.core.source.lines.program import LineProgram, read_lines
from flyby.core.source.lines.statements import (
    Assign,
    Body,
    Call,
    Drive,
    If,
    Jump,
    Kept,
    Label,
    Line,
    NumberedPoint,
    Numbers,
    Operand,
    Pause,
    Return,
    Routine,
    Situation,
    Statement,
)
from flyby.core.source.patch.edits import Edit
from flyby.core.source.patch.uses import MovePart, Use, UseKind
from flyby.core.source.reading import Files, ReadOptions, read_with
from flyby.core.source.text.files import SourceFile
from flyby.core.source.text.numerals import plain
from flyby.core.source.write.options import OpaqueStyle, PatcherOptions, WriterOptions
from flyby.core.source.write.refusals import check_said
from flyby.core.source.write.statements import lines_of_statements
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import euler_zyx, matrix_from_euler_zyx

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
_POSITION = re.compile(r"(?P<name>[CP]\d+)=(?P<values>[-+.\d, ]+)")
_MOTION = re.compile(
    r"MOV(?P<kind>[JLC])\s+(?P<point>[CP]\d+)(?:\s+(?P<unit>VJ|V|VR)=(?P<speed>[\d.]+))?"
    r"(?:\s+(?P<zone>PL=(?P<level>\d)))?(?:\s+ACC=(?P<acc>\d+))?(?:\s+DEC=(?P=acc))?\s*"
)
_OPERAND = re.compile(r"(?:(?P<word>[BIDR])(?P<number>\d{3})|(?P<signal>IN|OT)#\((?P<index>\d+)\))")
_IF = re.compile(r"(?P<statement>.*?)\s+IF\s+(?P<condition>.*)")
_SIGNS = re.compile(r"(?P<left>\S+?)\s*(?P<sign><>|<=|>=|=|<|>)\s*(?P<right>\S+)")
_CHANGES = {"SET": None, "ADD": "+", "SUB": "-", "MUL": "*", "DIV": "/", "INC": "+", "DEC": "-"}
_CALLED = re.compile(r"\bCALL\s+JOB:([\w-]+)")


@dataclass(frozen=True, slots=True)
class Place:
    """What a position is beside its numbers: ``PULSE``, ``ANGLE``, ``BASE`` …; its tool."""

    type: str
    tool: int


class Grammar:
    """What a line says; it knows the type of the positions before, and how far an arc has come."""

    registers = frozenset("BIDR")
    outputs = frozenset({"OT"})
    vectors: Mapping[str, int] = MappingProxyType({"TOOL": 6, "PULSE": 6})
    argument = ""

    def __init__(self) -> None:
        self._type, self._tool = "", 0
        self._points = 0
        self._before: str | None = None
        self._middle: Operand | None = None

    def statement(self, line: Line) -> Statement | None:
        """One line; what describes the job says nothing."""
        text = line.text
        if text.startswith("//NAME "):
            return Routine(line.span, text.split()[1])
        if text.startswith("/"):
            head, _, value = text.strip("/").partition(" ")
            self._type = value.strip() if head == "POSTYPE" else self._type
            self._tool = int(value) if head == "TOOL" else self._tool
            return None
        if text.startswith("'") or text == "NOP":
            return None
        if (found := _POSITION.fullmatch(text)) is not None:
            return self._position(line, found)
        if (found := _MOTION.fullmatch(line.source.text, line.start, line.end)) is not None:
            return self._motion(line, found)
        if text.startswith("MOV"):
            raise ValueError("a motion is a position, a speed, PL=0 to 4 and ACC")
        if (found := _IF.fullmatch(text)) is not None:
            inner = self.statement(replace(line, end=line.start + found.end("statement")))
            condition = self._condition(line, found["condition"])
            return If(line.span, condition, Body((inner,) if inner else ()))
        return self._instruction(line, text)

    def _instruction(self, line: Line, text: str) -> Statement:
        word, _, rest = text.partition(" ")
        rest, span = rest.strip(), line.span
        if text.startswith("*"):
            return Label(span, text[1:])
        if word == "JUMP" and rest.startswith("*"):
            return Jump(span, rest[1:])
        if word == "CALL" and rest.startswith("JOB:"):
            return Call(span, rest[4:])
        if word in ("END", "RET"):
            return Return(span)
        if word == "TIMER" and rest.startswith("T="):
            return Pause(span, self._operand(line, rest[2:]))
        if word == "WAIT":
            return Pause(span, condition=self._condition(line, rest.partition(" T=")[0]))
        if word == "DOUT" and rest.split()[-1] in ("ON", "OFF"):
            name, value = rest.split()
            return Assign(span, self._datum(line, name), Truth(span, value == "ON"))
        if word in _CHANGES:
            target = self._datum(line, rest.split()[0])
            sign, given = _CHANGES[word], rest.split()[1:]
            value = self._operand(line, given[0]) if given else Number(span, 1.0)
            return Assign(span, target, Operation(span, sign, (target, value)) if sign else value)
        return Kept(span, word, "what it does is not known", word == "PAUSE")

    def _datum(self, line: Line, text: str) -> Datum:
        found = _OPERAND.fullmatch(text)
        if found is None:
            raise ValueError(f"{text} is no variable and no signal that is read")
        word, number = found["word"] or found["signal"], found["number"] or found["index"]
        return Datum(line.span, word, Number(line.span, float(number)))

    def _operand(self, line: Line, text: str) -> Expression:
        if text in ("ON", "OFF"):
            return Truth(line.span, text == "ON")
        if re.fullmatch(r"-?\d+\.?\d*", text):
            return Number(line.span, float(text))
        return self._datum(line, text)

    def _condition(self, line: Line, text: str) -> Expression:
        found = _SIGNS.fullmatch(text.strip())
        if found is None:
            raise ValueError("a comparison should stand here")
        sides = self._operand(line, found["left"]), self._operand(line, found["right"])
        return Operation(line.span, found["sign"], sides)

    def _position(self, line: Line, found: re.Match[str]) -> NumberedPoint:
        numbers = []
        for value in re.finditer(r"[-+.\d]+", found["values"]):
            start = line.start + found.start("values") + value.start()
            span = line.source.span(start, start + len(value[0]))
            numbers.append(Number(span, float(value[0])))
        if len(numbers) != 6:
            raise ValueError("a position has six numbers")
        name = Datum(line.span, found["name"][0], Number(line.span, float(found["name"][1:])))
        return NumberedPoint(line.span, name, tuple(numbers), Place(self._type, self._tool))

    def _motion(self, line: Line, found: re.Match[str]) -> Statement | None:
        """``MOVC``: the first goes to where the arc begins, the next through, then to its end."""
        span = line.source.span(*found.span("point"))
        number = Number(span, float(found["point"][1:]))
        point = Operand(span, point=Datum(span, found["point"][0], number))
        before, self._before = self._before, found["point"]
        if found["kind"] != "C":
            if self._middle is not None:
                raise ValueError("the arc before has no end: MOVC has three positions")
            self._points = 0
            return _drive(line, found, found["kind"], point)
        if before == found["point"] and self._middle is None:
            self._points = 1  # the robot is there
            return None
        self._points += 1
        if self._points == 1:
            return _drive(line, found, "L", point)
        if self._points % 2 == 0:
            self._middle = point
            return None
        middle, self._middle = self._middle, None
        return _drive(line, found, "C", point, middle)


def _drive(
    line: Line, found: re.Match[str], kind: str, point: Operand, middle: Operand | None = None
) -> Drive:
    source = line.source

    def number(name: str) -> tuple[Number, ...]:
        return (Number(source.span(*found.span(name)), float(found[name])),) if found[name] else ()

    def build(target: Numbers, speed: Numbers, zone: Numbers, via: Numbers, now: Situation) -> Move:
        goal, tool = _target(target, now)
        share = speed[-1] / 100 if found["acc"] else 1.0
        fields = {"VJ": ("joint_fraction", 0.01), "V": ("tcp", 1e-3), "VR": _TURN, None: ()}
        unit = fields[found["unit"]]
        stated = {unit[0]: speed[0] * unit[1]} if unit else {}
        pace, passing = Speed(**stated, acceleration_override=share), _zone(zone)
        if kind == "J":
            return MoveJ(goal, pace, passing, tool)
        if not isinstance(goal, PoseTarget):
            raise InputError("lines and arcs to joint values are not emulated: give a pose (BASE)")
        if kind == "L":
            return MoveL(goal, pace, passing, tool)
        through, _ = _target(via, now)
        if not isinstance(through, PoseTarget):
            raise InputError("an arc through joint values is not emulated: give a pose (BASE)")
        turns = ArcOrientation.FIXED_FRAME
        return MoveC(goal, pace, passing, tool, via=through, orientation=turns)

    whole = source.span(*found.span("point"))
    speed = source.span(*found.span("speed")) if found["speed"] else whole
    level = source.span(*found.span("zone")) if found["zone"] else whole
    paces = (*number("speed"), *number("acc"))
    return Drive(
        line.span, point, Operand(speed, paces), Operand(level, number("level")), build, middle
    )


_TURN = ("reorientation", math.radians(1))


def _zone(numbers: Numbers) -> Zone:
    """Without a PL the robot is taken to stop."""
    level = int(numbers[0]) if numbers else 0
    if level > len(LEVELS):
        raise InputError(f"how far PL={level} reaches is not published: PL=0 to {len(LEVELS)} are")
    return VendorZone(PL, LEVELS[level - 1]) if level else FINE


def _target(numbers: Numbers, now: Situation) -> tuple[Target, Tool]:
    place = numbers.kind
    tool = FLANGE
    if place.tool:
        tool = Tool(f"TOOL {place.tool}", _pose(now.vector("TOOL", place.tool)))
    if place.type == "ANGLE":
        return JointTarget(tuple(map(math.radians, numbers))), tool
    if place.type == "PULSE":
        now.computed("target")
        return JointTarget(tuple(map(math.radians, _degrees(numbers, now)))), tool
    if place.type not in ("BASE", "ROBOT"):
        raise InputError(f"positions of type {place.type or '(none)'} are not read: use BASE")
    return PoseTarget(_pose(numbers)), tool


def _degrees(pulses: Numbers, now: Situation) -> tuple[float, ...]:
    """Of pulses; how many a degree has stands in the controller's parameters."""
    try:
        rates = now.vector("PULSE", 1)
    except SourceError:
        raise InputError(
            "how many pulses a degree has is not known: answer PULSE[1,1] to PULSE[1,6] in the "
            "table [values], or convert the job's positions (BASE)"
        ) from None
    return tuple(a / b for a, b in zip(pulses, rates, strict=True))


def _pose(numbers: Numbers) -> Pose:
    matrix = np.eye(4)
    matrix[:3, 3] = [v / 1000 for v in numbers[:3]]
    matrix[:3, :3] = matrix_from_euler_zyx(*(math.radians(v) for v in reversed(numbers[3:6])))
    return Pose.from_matrix(matrix)


def _read(files: Files, main: str, options: ReadOptions) -> Program:
    own: LineProgram | None = None
    for file, source in files.items():
        read = read_lines(source.text, file, Grammar(), "JBI")
        own = read if own is None else own.with_file(read)
    assert own is not None
    return run_lines(own, Grammar(), options)


def _number(value: float) -> str:
    return plain(round(value, 9))


def _numbers(kind: UseKind, part: MovePart, move: Move) -> tuple[float, ...]:
    check_said(move, SPEAKS, "JBI")
    if isinstance(part, Speed):
        shown = ()
        for name, scale in (("tcp", 1e-3), _TURN):
            if getattr(part, name) is not None:
                shown = (getattr(part, name) / scale,)
        if isinstance(move, MoveJ):
            shown = (100 * part.joint_fraction,)
        own = part.acceleration_override
        return (*shown, 100 * own) if own != 1.0 else shown
    if isinstance(part, JointTarget):
        return tuple(map(math.degrees, part.joints))
    if isinstance(part, PoseTarget):
        turns = reversed(euler_zyx(part.pose.matrix()[:3, :3]))
        return (*(1000 * v for v in part.pose.position), *map(math.degrees, turns))
    return (float(_level(part)),)


def _level(zone: Zone) -> int:
    if not isinstance(zone, VendorZone):
        return 0
    if zone.size not in LEVELS:
        raise InputError(f"PL has {len(LEVELS)} sizes, and {1000 * zone.size:g} mm is none of them")
    return LEVELS.index(zone.size) + 1


def _speed(move: Move) -> str:
    if isinstance(move, MoveJ):
        return f"VJ={_number(100 * move.speed.joint_fraction)}"
    if move.speed.tcp is not None:
        return f"V={_number(1000 * move.speed.tcp)}"
    turn = move.speed.reorientation
    return "" if turn is None else f"VR={_number(math.degrees(turn))}"


def _acceleration(speed: Speed) -> str:
    share = _number(100 * speed.acceleration_override)
    return "" if share == "100" else f" ACC={share} DEC={share}"


def _own(use: Use) -> Iterator[Edit]:
    raise InputError("there is no number to change in the job: write it anew")


class Language:
    """Reads, writes and patches jobs."""

    def read(self, text: str, file: str, options: ReadOptions) -> Program:
        """See `flyby.core.language.Reader`."""
        return read_with({file: SourceFile(file, text)}, file, options, _read)

    def read_file(self, path: Path, options: ReadOptions) -> Program:
        """The same of a file, and of the jobs beside it that it calls."""
        files = with_called(path, options, (".jbi",), _CALLED.findall)
        return read_with(files, str(path), options, _read)

    def patch(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Files:
        """See `flyby.core.language.Patcher`."""
        choice = PatcherOptions.of(options, "JBI patcher")
        return patch_lines(program, choice, _numbers, _number, _own)

    def write(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Sources:
        """See `flyby.core.language.Writer`; the option is ``opaque``."""
        kept = WriterOptions.of(options, "JBI writer").opaque is OpaqueStyle.KEEP
        positions: list[str] = []

        def name(target: Target, move: Move) -> str:
            joints = isinstance(target, JointTarget)
            head = "///POSTYPE ANGLE\n///ANGLE" if joints else "///POSTYPE BASE\n///RECTAN"
            numbers = ",".join(map(_number, _numbers(UseKind.TARGET, target, move)))
            positions.append(f"{head}\nC{len(positions):05}={numbers}")
            return f"C{len(positions) - 1:05}"

        def move(move: Move, *_: object) -> Iterator[str]:
            check_said(move, SPEAKS, "JBI")
            said = f"{_speed(move)} PL={_level(move.zone)}{_acceleration(move.speed)}".strip()
            if isinstance(move, MoveC):
                if not positions:
                    raise InputError("an arc begins where a motion before it ends: state a start")
                yield f"MOVC C{len(positions) - 1:05} {said}"
                yield f"MOVC {name(move.via, move)} {said}"
            kind = type(move).__name__[-1]
            yield f"MOV{kind} {name(move.target, move)} {said}"

        def wait(wait: Wait) -> Iterator[str]:
            yield f"TIMER T={_number(wait.duration)}"

        def opaque(statement: Opaque) -> Iterator[str]:
            yield statement.text if kept else f"'{statement.text}"

        lines = lines_of_statements(program, wait, opaque, move)
        job = re.sub(r"\W+", "_", program.name, flags=re.ASCII).upper()[:32]
        head = f"/JOB\n//NAME {job}\n//POS\n///NPOS {len(positions)},0,0,0,0,0\n///TOOL 0\n"
        body = "\n".join([*positions, "//INST", "///ATTR SC,RW", "///GROUP1 RB1", "NOP", *lines])
        return {f"{job}.jbi": f"{head}{body}\nEND\n"}
