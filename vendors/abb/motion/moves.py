"""Move instructions: their forms, and how their arguments become a move.

Arguments: "RAPID Reference Manual", instructions MoveAbsJ, MoveC, MoveJ, MoveL.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace

from ....core.errors import SourceError
from ....core.program.arc_orientation import ArcOrientation
from ....core.program.event import Event
from ....core.program.move import Move, MoveC, MoveJ, MoveL, Wait
from ....core.program.target import JointTarget, PoseTarget
from ....core.source.execution.provenance import MovePart
from ....core.source.execution.transcript import MoveParts
from ..syntax.tree import Invoke
from ..values.arguments import Bound, bind
from ..values.predefined import FOLLOW_TIME, STOP_TIME
from ..values.records import Record
from ..values.scope import Scope
from ..values.types import find_unknown
from .move_arguments import MoveArguments, MovesRun, NotDriven

_COMMON_OPTIONS = ("conc", "v", "t", "z", "inpos", "wobj", "tload", "corr", "id")

MovesHandler = Callable[[MovesRun, Invoke, Scope], None]


@dataclass(frozen=True, slots=True)
class Form:
    """What a move instruction takes.

    Args:
        kind: ``joint``, ``linear``, ``circular``, ``absolute`` or ``external``, which leaves the
            arm where it is.
        names: of its required arguments in order. ``ToPoint`` (``ToJointPos``), ``CirPoint``,
            ``Speed``, ``Zone`` and ``Tool`` are read by `MoveArguments`; without
            ``Zone`` it goes to a stop.
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


def read_move(
    run: MovesRun, form: Form, bound: Bound, scope: Scope, events: tuple[Event, ...] = ()
) -> tuple[Move, MoveParts, Record]:
    """The move of an instruction, the sources of its numbers, and its target as it stands.

    Raises:
        SourceError: a part of it is not declared, not known, or not emulated.
    """
    _note_singularity(run, form, bound)
    reader = MoveArguments(run, scope, bound)
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
    own = _OF_KIND.get(form.kind, ())
    lost = run.settings.lost_of((*_OF_ALL, *own))
    unsettled = f"how {bound.text} is driven depends on {lost}" if lost else reader.unsettled
    if arc is not None:
        assert via is not None and isinstance(target, PoseTarget)
        move: Move = MoveC(target, *common, events=events, via=via, orientation=arc)
    else:
        kind = MoveL if form.kind == "linear" else MoveJ
        move = kind(target, *common, events=events)
    setting = run.settings.supposed_of(own)
    supposed = reader.supposed or (setting and f"the way of {bound.text} depends on {setting}")
    if unsettled or supposed:
        move = replace(move, unsettled=unsettled, supposed=supposed)
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
    stands = _stop_time(run, bound, scope)
    if stands > 0.0:
        run.out.emit(Wait(stands, bound.option_spans["inpos"]))
    return record


def _stop_time(run: MovesRun, bound: Bound, scope: Scope) -> float:
    """s that a stop point (``\\Inpos``) lets the robot stand, where that is known."""
    point = bound.options.get("inpos")  # of some processes a switch
    if point is None:
        return 0.0
    value = run.evaluator.evaluate(point, scope)
    if not isinstance(value, tuple) or find_unknown(value) is not None:
        return 0.0
    kind, _, inside, stop, follow, *_ = value
    least = inside[2] if isinstance(inside, tuple) else 0.0
    stands = {STOP_TIME: stop, FOLLOW_TIME: follow}.get(kind, least)
    return stands if isinstance(stands, float) else 0.0


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
