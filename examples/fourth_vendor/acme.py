"""ACME: a made-up vendor whose plugin is this file and one robot's TOML beside it.

Its language has one statement a line, numbers in m, rad and s; `flyby.core.source.lines` is its
base::

    POINT P[1] 0.1 -0.3 0.4 0.0 0.9 0.0
    R[1] = 0
    LABEL again
    MOVEJ P[1] SPEED 0.5 - ZONE 0.01
    MOVEL x y z qw qx qy qz SPEED 0.5 1.0 ZONE 0
    MOVEC x y z qw qx qy qz x y z qw qx qy qz SPEED 0.5 1.0 ZONE 0
    R[1] = R[1] + 1
    IF R[1] < 3 JUMP again
    IF DI[1] = ON CALL pick
    DO[2] = ON
    WAIT 0.5
    WAIT DI[2] = ON
    END
    ROUTINE pick
    RETURN

``SPEED`` is that of the TCP and its rate of turn, ``-`` for none; ``ZONE`` the blend's radius, 0
for a stop; of the two poses of ``MOVEC`` the auxiliary one is the first. In the place of the
numbers of a joint move or of one pose a point may stand, and registers in the place of any number.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from flyby.core.errors import InputError
from flyby.core.hookspec import VendorRegister, hookimpl
from flyby.core.language import Sources
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.provenance import Provenance
from flyby.core.motion.model.rules import Overlap
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL, Statement, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget, Target
from flyby.core.program.tool import FLANGE, WORLD
from flyby.core.program.zone import FINE, Radius, Zone
from flyby.core.robot.model import Robot
from flyby.core.source.lines.expressions import Datum, Expression, data_in, parse, parse_all
from flyby.core.source.lines.interpreter import run_lines
from flyby.core.source.lines.patcher import patch_lines
from flyby.core.source.lines.program import Grammar, read_lines, several
from flyby.core.source.lines.statements import (
    Assign,
    Body,
    Call,
    Drive,
    End,
    If,
    Jump,
    Label,
    Line,
    NumberedPoint,
    Numbers,
    Operand,
    Pause,
    Return,
    Routine,
    Situation,
)
from flyby.core.source.lines.statements import Statement as LineStatement
from flyby.core.source.patch.uses import MovePart, UseKind
from flyby.core.source.reading import Files, ReadOptions, read_with
from flyby.core.source.text.files import SourceFile, SourceText, read_source
from flyby.core.source.write.options import PatcherOptions
from flyby.core.spatial.pose import Pose
from flyby.core.vendor import Vendor, lazy_robots

HERE = Path(__file__).parent


def motion() -> MotionModel:
    """Parabolas as everywhere; neighbouring blends shrink until they touch."""
    made_up = Provenance("assumed", "made up for this example")
    return MotionModel(period=0.008, overlap=Overlap.SHRINK, provenance={"*": made_up})


class Acme(Grammar):
    """What ACME takes a line for; see `flyby.core.source.lines.program.Grammar`."""

    registers = frozenset({"R"})
    outputs = frozenset({"DO"})

    def statement(self, line: Line) -> LineStatement | None:
        """One line; a blank one or a comment (``;``) says nothing."""
        word, _, rest = line.text.partition(" ")
        begin = line.end - len(rest.lstrip())
        if word.startswith(";"):
            return None
        if word in ("MOVEJ", "MOVEL", "MOVEC"):
            return _drive(line, word, begin)
        if word in _NAMED and rest.strip():
            return _NAMED[word](line.span, rest.strip())
        if line.text in _ALONE:
            return _ALONE[line.text](line.span)
        if word == "POINT":
            datum, *numbers = parse_all(line.source, begin, line.end)
            if not isinstance(datum, Datum):
                raise ValueError("a point is called P[1]")
            return NumberedPoint(line.span, datum, tuple(numbers))
        if word == "IF":
            return _if(line, begin, self)
        if word == "WAIT":
            found = parse(line.source, begin, line.end)
            is_time = not any(data_in(found)) or (isinstance(found, Datum) and found.word == "R")
            return Pause(line.span, found) if is_time else Pause(line.span, condition=found)
        if "=" in line.text:
            at = line.start + line.text.index("=")
            target = parse(line.source, line.start, at)
            if isinstance(target, Datum) and target.word in self.registers | self.outputs:
                return Assign(line.span, target, parse(line.source, at + 1, line.end))
        raise ValueError(f"unknown word {word}")


_NAMED: dict[str, type[Label | Jump | Call | Routine]] = {
    "LABEL": Label,
    "JUMP": Jump,
    "CALL": Call,
    "ROUTINE": Routine,
}
_ALONE: dict[str, type[Return | End]] = {"RETURN": Return, "END": End}
_THEN = re.compile(r"\s(?=(?:JUMP|CALL|RETURN|END|MOVE[JLC])\b)")
_PARTS = re.compile(r"(.*)\sSPEED\s+(\S+)\s+(\S+)\s+ZONE\s(.*)")
_NUMBERS = {"MOVEL": 7, "MOVEC": 7}


def _if(line: Line, begin: int, grammar: Grammar) -> If:
    then = _THEN.search(line.source.text, begin, line.end)
    if then is None:
        raise ValueError("a statement should follow the condition")
    condition = parse(line.source, begin, then.start())
    inner = several(grammar.statement(replace(line, start=then.end())))
    return If(line.span, condition, Body(inner))


def _drive(line: Line, word: str, begin: int) -> Drive:
    source = line.source
    found = _PARTS.match(source.text, begin, line.end)
    if found is None:
        raise ValueError("SPEED with two numbers and ZONE with one should follow the target")
    places = [*_operands(source, found.start(1), found.end(1), _NUMBERS.get(word))]
    if len(places) != (2 if word == "MOVEC" else 1):
        raise ValueError("the target should be a point, or its numbers")
    given = [k for k in (2, 3) if found[k] != "-"]
    speeds = [n for k in given for n in parse_all(source, found.start(k), found.end(k))]
    speed = Operand(source.span(found.start(2), found.end(3)), tuple(speeds))
    zone = Operand(
        source.span(found.start(4), found.end(4)), parse_all(source, found.start(4), found.end(4))
    )

    def build(target: Numbers, speed: Numbers, zone: Numbers, via: Numbers, _: Situation) -> Move:
        (radius,) = zone
        tcp, turn = (dict(zip(given, speed, strict=True)).get(k) for k in (2, 3))
        pace = Speed(tcp, turn)
        blend: Zone = FINE if radius == 0 else Radius(radius)
        if word == "MOVEJ":
            return MoveJ(JointTarget(tuple(target)), pace, blend)
        if word == "MOVEL":
            return MoveL(_pose(target), pace, blend)
        return MoveC(_pose(target), pace, blend, via=_pose(via))

    via = places[0] if word == "MOVEC" else None
    return Drive(line.span, places[-1], speed, zone, build, via)


def _operands(source: SourceText, start: int, end: int, count: int | None) -> Iterator[Operand]:
    """Points, and as many numbers as a pose has; all numbers are one target if ``count`` is
    None."""
    numbers: list[Expression] = []
    for one in parse_all(source, start, end):
        if isinstance(one, Datum) and one.word == "P":
            yield Operand(one.span, point=one)
            continue
        numbers.append(one)
        if len(numbers) == count:
            yield Operand(source.span(numbers[0].span.start, one.span.end), tuple(numbers))
            numbers = []
    if numbers:
        yield Operand(source.span(numbers[0].span.start, numbers[-1].span.end), tuple(numbers))


def _pose(numbers: Numbers) -> PoseTarget:
    x, y, z, w, i, j, k = numbers
    return PoseTarget(Pose((x, y, z), (w, i, j, k)))


class Language:
    """Reads, writes and patches ACME programs."""

    def read(self, text: str, file: str, options: ReadOptions) -> Program:
        """See `flyby.core.language.Reader`."""
        return read_with({file: SourceFile(file, text)}, file, options, _read)

    def read_file(self, path: Path, options: ReadOptions) -> Program:
        """The same of a file."""
        found = read_source(path)
        return read_with({found.name: found}, found.name, options, _read)

    def write(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Sources:
        """See `flyby.core.language.Writer`; there are no options."""
        if options:
            raise InputError(f"ACME knows no option {sorted(options)[0]!r}")
        return {f"{program.name}.acme": "".join(f"{_line(s)}\n" for s in program.statements)}

    def patch(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Files:
        """See `flyby.core.language.Patcher`."""
        chosen = PatcherOptions.of(options, "ACME patcher")
        return patch_lines(program, chosen, _numbers_of, repr)


def _read(files: Files, main: str, options: ReadOptions) -> Program:
    grammar = Acme()
    return run_lines(read_lines(files[main].text, main, grammar, "ACME"), grammar, options)


def _numbers_of(kind: UseKind, part: MovePart, move: Move) -> tuple[float, ...]:
    _refuse_what_cannot_be_said(move)
    if isinstance(part, Speed):
        return tuple(v for v in (part.tcp, part.reorientation) if v is not None)
    if isinstance(part, JointTarget | PoseTarget):
        return _numbers(part)
    return (part.tcp if isinstance(part, Radius) else 0.0,)


def _line(statement: Statement) -> str:
    if isinstance(statement, Wait):
        return f"WAIT {statement.duration!r}"
    if not isinstance(statement, Move):
        raise InputError("ACME has moves and waits only")
    _refuse_what_cannot_be_said(statement)
    poses = (
        [statement.via, statement.target] if isinstance(statement, MoveC) else [statement.target]
    )
    numbers = " ".join(repr(number) for pose in poses for number in _numbers(pose))
    speeds = (statement.speed.tcp, statement.speed.reorientation)
    tcp, turn = ("-" if speed is None else repr(speed) for speed in speeds)
    radius = statement.zone.tcp if isinstance(statement.zone, Radius) else 0
    return f"{type(statement).__name__.upper()} {numbers} SPEED {tcp} {turn} ZONE {radius!r}"


def _numbers(target: Target) -> tuple[float, ...]:
    if isinstance(target, JointTarget):
        return target.joints
    return (*target.pose.position, *target.pose.quaternion)


def _refuse_what_cannot_be_said(move: Move) -> None:
    if replace(move, tool=FLANGE, work_object=WORLD, load=None) != move:
        raise InputError("ACME knows no tools, work objects or loads")
    if isinstance(move, MoveC) and move.orientation is not ArcOrientation.FOLLOWS_ARC:
        raise InputError("along ACME's arcs the tool follows the arc")
    if isinstance(move, MoveJ) != isinstance(move.target, JointTarget):
        raise InputError("ACME's MOVEJ goes to joint values, the others to poses")
    if move.target.external:
        raise InputError("ACME has no external axes")
    if move.zone not in (FINE, Radius(getattr(move.zone, "tcp", 0.0))):
        raise InputError(f"ACME's zones are a radius and nothing else, not {move.zone}")
    if move.speed != Speed(move.speed.tcp, move.speed.reorientation):
        raise InputError("ACME's speeds are those of the TCP and of its turn, nothing else")


@hookimpl
def flyby_register_vendors(register: VendorRegister) -> None:
    """Hand over ACME."""
    language = Language()
    register.add(
        Vendor(
            name="acme",
            robots=lazy_robots(HERE.glob("*.toml")),
            motion=motion,
            label=lambda robot, q: None,
            reader=language,
            writer=language,
            patcher=language,
            suffixes=(".acme",),
        )
    )
