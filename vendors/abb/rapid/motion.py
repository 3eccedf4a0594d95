"""The move instructions: MoveJ, MoveL, MoveC, MoveAbsJ.

Arguments: "RAPID Reference Manual", instructions MoveAbsJ, MoveC, MoveJ, MoveL.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ....core.errors import SourceError, Span
from ....core.program.move import ArcOrientation, Move, MoveC, MoveJ, MoveL
from ....core.program.speed import Speed
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.tool import WORLD, Load, Tool, WorkObject
from ....core.program.zone import FINE, Zone
from ....core.source.provenance import Part
from .arguments import Bound, bind
from .convert import undeclared
from .evaluator import Located
from .literals import MM
from .provenance import Literal, source_of_literal
from .scope import Scope
from .syntax import Expression, Invoke, Name
from .types import (
    JOINTTARGET,
    ROBTARGET,
    SPEEDDATA,
    TOOLDATA,
    WOBJDATA,
    ZONEDATA,
    Type,
)

if TYPE_CHECKING:
    from .interpreter import Interpreter

OPTIONS = ("conc", "v", "t", "z", "inpos", "wobj", "tload", "corr", "id")


@dataclass(frozen=True, slots=True)
class Sources:
    """The parts of a move before all reads of the run are known."""

    statement: Span
    target: Part
    speed: Part
    zone: Part
    via: Part | None = None


@dataclass(frozen=True, slots=True)
class _Common:
    """What every move has, converted."""

    speed: Speed
    zone: Zone
    tool: Tool
    work_object: WorkObject
    load: Load | None
    speed_part: Part
    zone_part: Part


class _MoveReader:
    """Reads one move instruction.

    Args:
        at: index of the first required argument that is the speed.
    """

    def __init__(self, run: Interpreter, scope: Scope, bound: Bound, at: int) -> None:
        self.run = run
        self.scope = scope
        self.bound = bound
        self.at = at
        _refuse_options(bound)

    def pose_target(self, index: int, follow: bool) -> tuple[PoseTarget, Part]:
        expression = self.bound.value(index)
        found = self._found(expression, "target", ROBTARGET)
        target = self.run.convert.pose_target(
            found.value, _datum_name(found, expression), follow, expression.span
        )
        source = found.source if self.run.settings.displacement is None else None
        if source is None and found.source is not None:
            self.run.evaluator.reads.by_expression(found.source, self.run.move_index)
        return target, _part_of(expression.span, source)

    def joint_target(self) -> tuple[JointTarget, Part]:
        expression = self.bound.value(0)
        found = self._found(expression, "target", JOINTTARGET)
        name = _datum_name(found, expression)
        target = self.run.convert.joint_target(found.value, name, expression.span)
        return target, _part_of(expression.span, found.source)

    def common(self) -> _Common:
        tool = self._tool()
        work_object = self._work_object()
        if tool.robot_held == work_object.robot_held:
            raise SourceError(
                f"one of tool {tool.name} and work object {work_object.name} is held by the robot "
                "(robhold) and the other stands still; here both are alike",
                self.bound.span,
            )
        tool, load = self._loads(tool)
        speed, speed_part = self._speed()
        zone, zone_part = self._zone()
        return _Common(speed, zone, tool, work_object, load, speed_part, zone_part)

    def _found(self, expression: Expression, kind: str, type_: Type) -> Located:
        found = self.run.evaluator.locate(expression, self.scope)
        if isinstance(expression, Name) and found.cell is None:
            raise undeclared(kind, expression, type_, self.scope)
        use = f"the {kind} of {self.bound.text}"
        self.run.evaluator.check_located(found, type_, use, expression.span)
        return found

    def _tool(self) -> Tool:
        expression = self.bound.value(self.at + 2)
        return self.run.convert.tool(self._found(expression, "tool", TOOLDATA), expression)

    def _work_object(self) -> WorkObject:
        if "wobj" not in self.bound.options:
            return WORLD
        expression = self.bound.option("wobj")
        found = self._found(expression, "work object", WOBJDATA)
        return self.run.convert.work_object(found, expression)

    def _loads(self, tool: Tool) -> tuple[Tool, Load | None]:
        """``\\TLoad`` is tool and payload in one, unless it is ``load0``."""
        if "tload" in self.bound.options:
            expression = self.bound.option("tload")
            total = self.run.convert.load(expression, self.scope)
            if total is not None:
                return replace(tool, load=total), None
        return tool, self.run.settings.load

    def _option(self, name: str) -> float | None:
        if name not in self.bound.options:
            return None
        use = f"{self.bound.text} \\{name.upper()}"
        return self.run.number(self.bound.option(name), self.scope, use)

    def _speed(self) -> tuple[Speed, Part]:
        expression = self.bound.value(self.at)
        found = self._found(expression, "speed", SPEEDDATA)
        assert isinstance(found.value, tuple)
        name = _datum_name(found, expression)
        speed = self.run.convert.speed(
            found.value, name, self._option("v"), self._option("t"), expression.span
        )
        part = self._part(found, expression, ("v", "t"))
        settings = self.run.settings
        limit = settings.greatest_tcp
        capped = limit is not None and speed.tcp is not None and speed.tcp >= limit * MM
        if settings.override == 1.0 and not capped:
            return speed, part
        # Under VelSet the number in the text is not the speed: derived.
        for source in filter(None, part.sources):
            self.run.evaluator.reads.by_expression(source, self.run.move_index)
        return speed, Part(part.span)

    def _zone(self) -> tuple[Zone, Part]:
        expression = self.bound.value(self.at + 1)
        found = self._found(expression, "zone", ZONEDATA)
        part = self._part(found, expression, ("z", "inpos"))
        if "inpos" in self.bound.options:
            return FINE, part
        assert isinstance(found.value, tuple)
        name = _datum_name(found, expression)
        zone = self.run.convert.zone(found.value, name, self._option("z"), expression.span)
        return zone, part

    def _part(self, found: Located, expression: Expression, options: tuple[str, ...]) -> Part:
        """A speed or zone; a number in an option at the move is the move's own."""
        given = [name for name in options if name in self.bound.options]
        if not given:
            own = found.cell is not None and found.predefined is not None
            name = found.cell.name if found.cell is not None and own else None
            return _part_of(expression.span, found.source, name)
        last = max((self.bound.option_spans[name] for name in given), key=lambda s: s.end)
        whole = replace(expression.span, end=last.end)
        value = self.bound.options[given[0]] if len(given) == 1 else None
        literal = source_of_literal(value, None) if value is not None else None
        if isinstance(value, Name):
            literal = self.run.evaluator.locate(value, self.scope).source
        return _part_of(whole, literal)


def _part_of(span: Span, source: Literal | None, predefined: str | None = None) -> Part:
    return Part(span, () if source is None else (source,), predefined)


def _refuse_options(bound: Bound) -> None:
    reasons = {
        "corr": "corrections from sensors come at run time",
        "id": "synchronised robots (MultiMove) are not emulated",
    }
    for option, reason in reasons.items():
        if option in bound.options:
            raise SourceError(
                f"{bound.text} \\{option.upper()}: {reason}; take the argument out",
                bound.option_spans[option],
            )


def _datum_name(found: Located, expression: Expression) -> str | None:
    """The name of a datum that has its declared value."""
    cell = found.cell
    if cell is None or not isinstance(expression, Name) or expression.path:
        return None
    unchanged = cell.constant or found.predefined is not None or found.source is not None
    return cell.name if unchanged else None


def _check_singularity(run: Interpreter, invoke: Invoke) -> None:
    mode = run.settings.singularity
    if mode != "off":
        name = {"wrist": "Wrist", "lockaxis4": "LockAxis4"}[mode]
        raise SourceError(
            f"{invoke.text} under SingArea \\{name} bends the orientation near singularities, "
            "which is not emulated: use SingArea \\Off and targets away from singularities",
            invoke.span,
        )


def _sources(statement: Span, common: _Common, target: Part, via: Part | None = None) -> Sources:
    return Sources(statement, target, common.speed_part, common.zone_part, via)


def _move_joint(run: Interpreter, invoke: Invoke, scope: Scope) -> None:
    reader = _MoveReader(run, scope, bind(invoke, ("ToPoint", "Speed", "Zone", "Tool"), OPTIONS), 1)
    target, part = reader.pose_target(0, run.settings.check_joint)
    common = reader.common()
    _emit(run, MoveJ(target, *_fields(common)), _sources(invoke.span, common, part))


def _move_linear(run: Interpreter, invoke: Invoke, scope: Scope) -> None:
    _check_singularity(run, invoke)
    reader = _MoveReader(run, scope, bind(invoke, ("ToPoint", "Speed", "Zone", "Tool"), OPTIONS), 1)
    target, part = reader.pose_target(0, run.settings.check_linear)
    common = reader.common()
    _emit(run, MoveL(target, *_fields(common)), _sources(invoke.span, common, part))


def _move_circular(run: Interpreter, invoke: Invoke, scope: Scope) -> None:
    _check_singularity(run, invoke)
    names = ("CirPoint", "ToPoint", "Speed", "Zone", "Tool")
    reader = _MoveReader(run, scope, bind(invoke, names, OPTIONS), 2)
    arc = run.settings.arc
    if not isinstance(arc, ArcOrientation):
        raise SourceError(
            f"MoveC under CirPathMode \\{arc} is not emulated: use \\PathFrame or \\ObjectFrame",
            invoke.span,
        )
    via, via_part = reader.pose_target(0, run.settings.check_linear)
    target, part = reader.pose_target(1, run.settings.check_linear)
    common = reader.common()
    move = MoveC(target, *_fields(common), via=via, orientation=arc)
    _emit(run, move, _sources(invoke.span, common, part, via_part))


def _move_absolute(run: Interpreter, invoke: Invoke, scope: Scope) -> None:
    names = ("ToJointPos", "Speed", "Zone", "Tool")
    reader = _MoveReader(run, scope, bind(invoke, names, (*OPTIONS, "noeoffs")), 1)
    target, part = reader.joint_target()
    common = reader.common()
    _emit(run, MoveJ(target, *_fields(common)), _sources(invoke.span, common, part))


def _fields(common: _Common) -> tuple[Speed, Zone, Tool, WorkObject, Load | None]:
    return common.speed, common.zone, common.tool, common.work_object, common.load


def _emit(run: Interpreter, move: Move, sources: Sources) -> None:
    reads = run.evaluator.reads
    for part in (sources.target, sources.speed, sources.zone, sources.via):
        for source in filter(None, part.sources if part is not None else ()):
            reads.by_move(source, run.move_index)
    run.emit_move(move, sources)


MOVES = {
    "movej": _move_joint,
    "movel": _move_linear,
    "movec": _move_circular,
    "moveabsj": _move_absolute,
}
