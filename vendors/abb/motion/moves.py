"""Move instructions: their forms, and how their arguments become a move.

Arguments: "RAPID Reference Manual", instructions MoveAbsJ, MoveC, MoveJ, MoveL.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Protocol

from ....core.errors import SourceError, Span
from ....core.program.arc_orientation import ArcOrientation
from ....core.program.event import Event
from ....core.program.move import Move, MoveC, MoveJ, MoveL
from ....core.program.question import QuestionKind
from ....core.program.speed import Speed
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.tool import WORLD, Load, Tool, WorkObject
from ....core.program.zone import FINE, Zone
from ....core.source.execution.course import Course
from ....core.source.execution.provenance import MovePart
from ....core.source.execution.transcript import MoveParts, Transcript
from ..syntax.tree import Expression, Invoke, Name
from ..values.arguments import Bound, bind
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

_COMMON_OPTIONS = ("conc", "v", "t", "z", "inpos", "wobj", "tload", "corr", "id")


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


MovesHandler = Callable[[MovesRun, Invoke, Scope], None]


@dataclass(frozen=True, slots=True)
class Form:
    """What a move instruction takes.

    Args:
        kind: ``joint``, ``linear``, ``circular``, ``absolute`` or ``external``, which leaves the
            arm where it is.
        names: of its required arguments in order. ``ToPoint`` (``ToJointPos``), ``CirPoint``,
            ``Speed``, ``Zone`` and ``Tool`` are read here; without ``Zone`` it goes to a stop.
        options: of its own.
    """

    kind: str
    names: tuple[str, ...]
    options: tuple[str, ...] = ()


TO_POINT = ("ToPoint", "Speed", "Zone", "Tool")
OVER_POINT = ("CirPoint", "ToPoint", "Speed", "Zone", "Tool")
TO_JOINTS = ("ToJointPos", "Speed", "Zone", "Tool")

FORMS = {
    "movej": Form("joint", TO_POINT),
    "movel": Form("linear", TO_POINT),
    "movec": Form("circular", OVER_POINT),
    "moveabsj": Form("absolute", TO_JOINTS, ("noeoffs",)),
}


class NotDriven(Exception):
    """A move whose target nobody knows; the message says why."""


Common = tuple[Speed, Zone, Tool, WorkObject, Load | None]
"""What every move has beside its target."""


class _MoveReader:
    """Reads one move instruction."""

    def __init__(self, run: MovesRun, scope: Scope, bound: Bound) -> None:
        self.run = run
        self.scope = scope
        self.bound = bound
        self.record: Record = ()
        self.unsettled = ""
        for option, why in _LEFT_OUT.items():
            if option in bound.options:
                run.out.notes.count(f"\\{option.upper()}: {why}", bound.option_spans[option])

    def pose_target(self, name: str, follow: bool) -> tuple[PoseTarget, MovePart]:
        self._refuse_lost("displacement", "offsets")
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
        self._refuse_lost(*(("offsets",) if offsets else ()))
        target = self.run.convert.joint_target(
            self._with_arm(found.value) if arm_stays else found.value,
            name,
            offsets,
            expression.span,
        )
        self.record = _record(found.value)
        moved = arm_stays or (offsets and self.run.settings.now.offsets is not None)
        return target, _part_of(expression.span, None if moved else found.source)

    def _refuse_lost(self, *settings: str) -> None:
        lost = self.run.settings.lost_of(settings)
        if lost:
            raise NotDriven(f"the target of {self.bound.text} depends on {lost}")

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
        found = evaluator.locate(expression, self.scope)
        if isinstance(expression, Name) and not expression.path and found.cell is None:
            answer = evaluator.answers.ask(expression.span, type_, kind=QuestionKind.DATUM)
            if answer is not None:
                found = Located(answer, None, None, type=type_)
        use = f"the {kind} of {self.bound.text}"
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
        value = evaluator.evaluate(expression, self.scope)
        unknown = find_unknown(value)
        if unknown is not None and unknown.lost:
            self.unsettled = self.unsettled or f"{use} depends on {unknown.reason}"
            return None
        if unknown is not None:
            evaluator.answers.assumed(
                expression.span,
                f"{use} depends on {unknown.reason}: it is left out{answerable(unknown)}",
            )
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


_OF_ALL = (
    "override",
    "refreshed",
    "greatest_tcp",
    "acceleration",
    "ramp",
    "path_acceleration",
    "world_acceleration",
    "load",
)
"""Settings that say how every move is driven, and not where to."""
_OF_KIND = {
    "joint": ("check_joint",),
    "linear": ("check_linear",),
    "circular": ("check_linear", "arc"),
}
"""Those of some moves."""
_LEFT_OUT = {
    "corr": "corrections from a sensor come at run time: the move is driven as it is programmed",
    "id": "moves that other robots make at the same time (MultiMove) are not at hand: this robot "
    "drives alone, at its own speed",
}
"""What an option asks for that is not emulated."""


def _datum_name(found: Located, expression: Expression) -> str | None:
    """The name of a datum that has its declared value."""
    cell = found.cell
    if cell is None or not isinstance(expression, Name) or expression.path:
        return None
    unchanged = cell.constant or found.predefined is not None or found.source is not None
    return cell.name if unchanged else None


def read_move(
    run: MovesRun, form: Form, bound: Bound, scope: Scope, events: tuple[Event, ...] = ()
) -> tuple[Move, MoveParts, Record]:
    """The move of an instruction, the sources of its numbers, and its target as it stands.

    Raises:
        SourceError: a part of it is not declared, not known, or not emulated.
    """
    _note_singularity(run, form, bound)
    reader = _MoveReader(run, scope, bound)
    settings = run.settings.now
    follow = settings.check_joint if form.kind == "joint" else settings.check_linear
    arc = _arc_orientation(run, bound) if form.kind == "circular" else None
    via: PoseTarget | None = None
    via_part: MovePart | None = None
    target: PoseTarget | JointTarget
    try:
        if form.kind in ("absolute", "external"):
            target, part = reader.joint_target(form.kind == "external")
        else:
            if arc is not None:
                via, via_part = reader.pose_target("CirPoint", follow)
            target, part = reader.pose_target("ToPoint", follow)
    except NotDriven:
        with suppress(NotDriven, SourceError):  # what else is not known is asked at once, too
            reader.common()
        raise
    common, speed_part, zone_part = reader.common()
    parts = MoveParts(bound.span, part, speed_part, zone_part, via_part)
    lost = run.settings.lost_of((*_OF_ALL, *_OF_KIND.get(form.kind, ())))
    unsettled = f"how {bound.text} is driven depends on {lost}" if lost else reader.unsettled
    if arc is not None:
        assert via is not None and isinstance(target, PoseTarget)
        move: Move = MoveC(
            target, *common, events=events, unsettled=unsettled, via=via, orientation=arc
        )
    else:
        kind = MoveL if form.kind == "linear" else MoveJ
        move = kind(target, *common, events=events, unsettled=unsettled)
    return move, parts, reader.record


def bind_move(invoke: Invoke, form: Form) -> Bound:
    """The arguments of a move instruction."""
    return bind(invoke, form.names, (*_COMMON_OPTIONS, *form.options))


def drive(
    run: MovesRun,
    form: Form,
    invoke: Invoke,
    scope: Scope,
    events: tuple[Event, ...] = (),
    bound: Bound | None = None,
) -> Record | None:
    """Carry a move instruction out.

    Args:
        bound: its arguments, if somebody has bound them already.

    Returns:
        Its target; None if nobody knows it: then the move is left out.
    """
    if bound is None:
        bound = bind_move(invoke, form)
    try:
        move, parts, record = read_move(run, form, bound, scope, events)
    except NotDriven as left_out:
        run.leave_out(invoke, str(left_out))
        return None
    reads = run.evaluator.reads
    for part in (parts.target, parts.speed, parts.zone, parts.via):
        for source in filter(None, part.sources if part is not None else ()):
            reads.by_move(source, run.out.move_index)
    run.emit_move(move, parts)
    run.position.moved(move, parts.statement, record)
    return record


def _plain(run: MovesRun, invoke: Invoke, scope: Scope) -> None:
    drive(run, FORMS[invoke.name], invoke, scope)


def _note_singularity(run: MovesRun, form: Form, bound: Bound) -> None:
    mode = run.settings.now.singularity
    if mode == "off" or form.kind not in ("linear", "circular"):
        return
    turned = {
        "wrist": "\\Wrist lets the controller turn the tool a little off between the points",
        "lockaxis4": "\\LockAxis4 keeps axis 4 in place, and turns the tool for it",
    }
    run.out.notes.once(
        "singularity",
        f"SingArea {turned[mode]}; it is emulated as \\Off, with the programmed orientation",
        bound.span,
    )


def _arc_orientation(run: MovesRun, bound: Bound) -> ArcOrientation:
    arc = run.settings.now.arc
    if isinstance(arc, ArcOrientation):
        return arc
    run.out.notes.once(
        "arc",
        f"CirPathMode \\{arc} is not emulated: the tool turns on arcs as with \\PathFrame",
        bound.span,
    )
    return ArcOrientation.FOLLOWS_ARC


MOVES: dict[str, MovesHandler] = dict.fromkeys(FORMS, _plain)
