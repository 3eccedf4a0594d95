"""The arguments of one move instruction: its target, and how it is driven."""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol

from ....core.errors import SourceError, Span
from ....core.program.move import Move
from ....core.program.question import QuestionKind
from ....core.program.speed import Speed
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.tool import WORLD, Load, Tool, WorkObject
from ....core.program.zone import FINE, Zone
from ....core.source.execution.course import Course
from ....core.source.execution.provenance import MovePart
from ....core.source.execution.transcript import MoveParts, Transcript
from ..syntax.tree import Expression, Invoke, Name
from ..values.arguments import Bound
from ..values.defaults import default_of, nominal
from ..values.evaluator import Evaluator
from ..values.located import Located
from ..values.provenance import Literal, source_of_literal
from ..values.records import PER_METRE, Record
from ..values.scope import Scope
from ..values.types import (
    JOINTTARGET,
    NUM,
    ROBTARGET,
    SPEEDDATA,
    TOOLDATA,
    WOBJDATA,
    ZONEDATA,
    Type,
    Unknown,
    Value,
    answerable,
    find_unknown,
)
from .position import Position
from .settings import SettingsInForce
from .targets import Converter, named_by_number, points_nowhere, undeclared


class MovesRun(Protocol):
    """What instructions that move the robot need of a run."""

    evaluator: Evaluator
    out: Transcript
    settings: SettingsInForce
    convert: Converter
    position: Position
    course: Course

    def emit_move(self, move: Move, parts: MoveParts) -> None:
        """Put a move at the end of the program."""

    def leave_out(self, invoke: Invoke, why: str) -> None:
        """Step over a move that cannot be driven."""


class NotDriven(Exception):
    """A move whose target nobody knows; the message says why."""


Common = tuple[Speed, Zone, Tool, WorkObject, Load | None]
"""What every move has beside its target."""


_LEFT_OUT = {
    "corr": "corrections from a sensor come at run time: the move is driven as it is programmed",
    "id": "moves that other robots make at the same time (MultiMove) are not at hand: this robot "
    "drives alone, at its own speed",
}
"""What an option asks for that is not emulated."""


class MoveArguments:
    """Reads the arguments of one move instruction.

    Args:
        run: gives their values.
        scope: where they stand.
        bound: the arguments by name.
    """

    def __init__(self, run: MovesRun, scope: Scope, bound: Bound) -> None:
        self.run = run
        self.scope = scope
        self.bound = bound
        self.record: Record = ()
        self.unsettled = ""
        self.supposed = ""
        for option, why in _LEFT_OUT.items():
            if option in bound.options:
                run.out.notes.count(f"\\{option.upper()}: {why}", bound.option_spans[option])

    def pose_target(self, name: str, follow: bool) -> tuple[PoseTarget, MovePart]:
        """A robtarget and what its numbers are made of.

        Args:
            name: of the argument.
            follow: whether its configuration data are kept to.

        Raises:
            NotDriven: nobody knows where it is.
        """
        self._refuse_not_known("displacement", "offsets")
        expression = self.bound.named(name)
        found = self._found(expression, "target", ROBTARGET)
        target = self.run.convert.pose_target(
            found.value, _datum_name(found, expression), follow, expression.span
        )
        self.record = _record(found.value)
        settings = self.run.settings.now
        moved = settings.displacement is not None or settings.offsets is not None
        source = None if moved else found.source
        if source is None and found.source is not None:
            self.run.evaluator.reads.by_expression(found.source, self.run.out.move_index)
        return target, _part_of(expression.span, source)

    def joint_target(self, arm_stays: bool) -> tuple[JointTarget, MovePart]:
        """A jointtarget and what its numbers are made of.

        Args:
            arm_stays: external axes move alone.

        Raises:
            NotDriven: nobody knows where it is.
        """
        if arm_stays and self.run.convert.external.lacking:
            raise NotDriven(
                f"{self.bound.text} moves external axes alone, and "
                f"{self.run.convert.external.lacking}"
            )
        expression = self.bound.named("ToJointPos")
        found = self._found(expression, "target", JOINTTARGET)
        name = _datum_name(found, expression)
        offsets = "useeoffs" in self.bound.options or (
            not arm_stays and "noeoffs" not in self.bound.options
        )
        self._refuse_not_known(*(("offsets",) if offsets else ()))
        value = self._with_arm(found.value) if arm_stays else found.value
        target = self.run.convert.joint_target(value, name, offsets, expression.span)
        self.record = _record(value)
        moved = arm_stays or (offsets and self.run.settings.now.offsets is not None)
        return target, _part_of(expression.span, None if moved else found.source)

    def _refuse_not_known(self, *settings: str) -> None:
        use = f"the target of {self.bound.text}"
        lost = self.run.settings.lost_of(settings)
        if lost:
            raise NotDriven(f"{use} depends on {lost}")
        self._suppose(use, self.run.settings.supposed_of(settings))

    def _suppose(self, use: str, reason: str) -> None:
        """What the path of the move depends on is taken for something."""
        if reason:
            self.supposed = self.supposed or f"{use} depends on {reason}"

    def _with_arm(self, value: Value) -> Value:
        """A jointtarget with the arm's present joint values."""
        present = self.run.position.jointtarget()
        if present is None:
            raise SourceError(
                f"{self.bound.text} leaves the arm where it is, and its joint values are not known "
                "here: name the robot, or use MoveAbsJ before",
                self.bound.span,
            )
        return (present[0], _record(value)[1])

    def common(self) -> tuple[Common, MovePart, MovePart]:
        """What every move has, and what its speed and zone are made of."""
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
        return (speed, zone, tool, work_object, load), speed_part, zone_part

    def _found(self, expression: Expression, kind: str, type_: Type) -> Located:
        evaluator = self.run.evaluator
        named = expression if isinstance(expression, Name) and not expression.path else None
        if named is not None:
            fixed = evaluator.fixed_value(named, type_, self.scope)
            if fixed is not None:
                return fixed
        use = f"the {kind} of {self.bound.text}"
        self.run.course.supposed = ""
        found = evaluator.locate(expression, self.scope)
        if type_ is not SPEEDDATA:
            self._suppose(use, self.run.course.supposed)
        if isinstance(expression, Name) and not expression.path and found.cell is None:
            answer = evaluator.answers.ask(expression.span, type_, kind=QuestionKind.DATUM)
            if answer is not None:
                found = Located(answer, None, None, type=type_)
        unknown = find_unknown(found.value) if found.open else None
        if unknown is not None:
            if isinstance(expression, Name) and found.cell is None and not expression.path:
                reason = undeclared(kind, expression, type_, self.scope)
                known = named_by_number(expression.name, type_)
                unknown = Unknown(reason, expression.span, expression.text, known)
                found = replace(found, value=unknown)
                if known is not None:
                    self.run.course.withdraw(expression.text)
            if nominal(found.value, type_) is None:
                kind_ = evaluator.answers.kind_of(unknown, expression.span)
                answer = evaluator.answers.ask(expression.span, type_, kind=kind_)
                if answer is not None:
                    return Located(answer, None, None, type=type_)
                if isinstance(expression, Name):
                    unknown = replace(unknown, key=evaluator.text(expression.span))
                raise NotDriven(f"{use} depends on {unknown.reason}{answerable(unknown)}")
            value = evaluator.assumed(found.value, type_, use, expression.span)
            found = replace(found, value=value, cell=None)
            if type_ is not SPEEDDATA:
                self._suppose(use, unknown.reason)
        if type_ is ROBTARGET and found.source is None and points_nowhere(found.value):
            answer = evaluator.answers.ask(expression.span, type_, kind=QuestionKind.DATUM)
            if answer is not None:
                return Located(answer, None, None, type=type_)
            text = evaluator.text(expression.span)
            raise NotDriven(
                f"{use} is made of numbers that nothing at hand sets (its orientation is "
                f"[0,0,0,0]): they come at run time{answerable(Unknown('', expression.span, text))}"
            )
        evaluator.check_located(found, type_, use, expression.span)
        if named is not None:
            evaluator.keep_fixed(found)
        return found

    def _settled(self, expression: Expression, kind: str, type_: Type) -> Located:
        """A value that says how the move is driven and not where to: where nobody knows it, the
        move keeps its target."""
        try:
            return self._found(expression, kind, type_)
        except NotDriven as error:
            self.unsettled = self.unsettled or str(error)
            value = default_of(type_)
            assert value is not None
            return Located(value, None, None, type=type_)

    def _tool(self) -> Tool:
        if "Tool" not in self.bound.names:
            return self.run.position.tool
        expression = self.bound.named("Tool")
        return self.run.convert.tool(self._found(expression, "tool", TOOLDATA), expression)

    def _work_object(self) -> WorkObject:
        if "Tool" not in self.bound.names:
            return self.run.position.work_object
        if "wobj" not in self.bound.options:
            return WORLD
        expression = self.bound.option("wobj")
        found = self._found(expression, "work object", WOBJDATA)
        return self.run.convert.work_object(found, expression)

    def _loads(self, tool: Tool) -> tuple[Tool, Load | None]:
        """``\\TLoad`` is tool and payload in one, unless it is ``load0``."""
        if "tload" in self.bound.options:
            expression = self.bound.option("tload")
            total = self.run.convert.load(self.run.evaluator, expression, self.scope)
            if total is not None:
                return replace(tool, load=total), None
        return tool, self.run.settings.now.load

    def _option(self, name: str) -> float | None:
        if name not in self.bound.options:
            return None
        use, evaluator = f"{self.bound.text} \\{name.upper()}", self.run.evaluator
        expression = self.bound.option(name)
        self.run.course.supposed = ""
        value = evaluator.evaluate(expression, self.scope)
        unknown = find_unknown(value)
        if name == "z":
            self._suppose(use, self.run.course.supposed)
        if unknown is not None and unknown.lost:
            self.unsettled = self.unsettled or f"{use} depends on {unknown.reason}"
            return None
        if unknown is not None:
            evaluator.answers.assumed(
                expression.span,
                f"{use} depends on {unknown.reason}: it is left out{answerable(unknown)}",
            )
            if name == "z":
                self._suppose(use, unknown.reason)
            return None
        evaluator.check(value, NUM, use, expression.span)
        assert isinstance(value, float)
        return value

    def _speed(self) -> tuple[Speed, MovePart]:
        expression = self.bound.named("Speed")
        found = self._settled(expression, "speed", SPEEDDATA)
        assert isinstance(found.value, tuple)
        name = _datum_name(found, expression)
        speed = self.run.convert.speed(
            found.value, name, self._option("v"), self._option("t"), expression.span
        )
        part = self._part(found, expression, ("v", "t"))
        settings = self.run.settings.now
        limit = settings.greatest_tcp
        capped = limit is not None and speed.tcp is not None and speed.tcp >= limit / PER_METRE
        if settings.speed_factor == 1.0 and not capped:
            return speed, part
        # Under VelSet the number in the text is not the speed: derived.
        for source in filter(None, part.sources):
            self.run.evaluator.reads.by_expression(source, self.run.out.move_index)
        return speed, MovePart(part.span)

    def _zone(self) -> tuple[Zone, MovePart]:
        if "Zone" not in self.bound.names:
            return FINE, MovePart(self.bound.span)
        expression = self.bound.named("Zone")
        found = self._settled(expression, "zone", ZONEDATA)
        part = self._part(found, expression, ("z", "inpos"))
        if "inpos" in self.bound.options:
            return FINE, part
        assert isinstance(found.value, tuple)
        name = _datum_name(found, expression)
        zone = self.run.convert.zone(found.value, name, self._option("z"), expression.span)
        return zone, part

    def _part(self, found: Located, expression: Expression, options: tuple[str, ...]) -> MovePart:
        """A speed or zone; a number in an option at the move is the move's own."""
        given = [name for name in options if name in self.bound.options]
        if not given:
            own = found.cell is not None and found.predefined is not None
            name = found.cell.name if found.cell is not None and own else None
            return _part_of(expression.span, found.source, name)
        last = max((self.bound.option_spans[name] for name in given), key=lambda s: s.end)
        whole = expression.span._replace(end=last.end)
        value = self.bound.options[given[0]] if len(given) == 1 else None
        literal = source_of_literal(value, None) if value is not None else None
        if isinstance(value, Name):
            literal = self.run.evaluator.locate(value, self.scope).source
        return _part_of(whole, literal)


def _record(value: Value) -> Record:
    assert isinstance(value, tuple)
    return value


def _part_of(span: Span, source: Literal | None, predefined: str | None = None) -> MovePart:
    return MovePart(span, () if source is None else (source,), predefined)


def _datum_name(found: Located, expression: Expression) -> str | None:
    """The name of a datum that has its declared value."""
    cell = found.cell
    if cell is None or not isinstance(expression, Name) or expression.path:
        return None
    unchanged = cell.constant or found.predefined is not None or found.source is not None
    return cell.name if unchanged else None
