"""Instructions that set what holds for all moves until it is changed.

"RAPID Reference Manual", instructions ConfJ, ConfL, SingArea, AccSet, VelSet, PathAccLim,
WorldAccLim, SpeedRefresh, CirPathMode, GripLoad, PDispSet.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from ....core.errors import SourceError
from ....core.program.arc_orientation import ArcOrientation
from ....core.source.execution.transcript import Transcript
from ....core.spatial.pose import Pose
from ..syntax.tree import Expression, Invoke
from ..values.arguments import Bound, bind
from ..values.evaluator import Evaluator
from ..values.records import UNUSED_AXIS, VMAX
from ..values.scope import Scope
from ..values.types import (
    BOOL,
    EXTJOINT,
    NUM,
    POSE,
    ROBTARGET,
    Type,
    Value,
    answerable,
    find_unknown,
)
from .kinematics import RobotFunctions
from .settings import SettingsInForce
from .targets import Converter

LEAST_ACCELERATION = 20.0
"""Percent: ``AccSet`` takes less as this much."""
LEAST_RAMP = 10.0
"""Percent, likewise for its ramp."""


class SettingsRun(Protocol):
    """What instructions that set motion need of a run."""

    evaluator: Evaluator
    out: Transcript
    settings: SettingsInForce
    convert: Converter
    functions: RobotFunctions


SettingsHandler = Callable[[SettingsRun, Invoke, Scope], None]


def _one_switch(bound: Bound, default: str) -> str:
    if len(bound.options) > 1:
        raise SourceError(f"{bound.text} takes one switch", bound.span)
    return next(iter(bound.options), default)


def _conf(setting: str) -> SettingsHandler:
    """``ConfJ``, ``ConfL``"""

    def change(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
        switch = _one_switch(bind(invoke, (), ("on", "off")), "on")
        run.settings.change(**{setting: switch == "on"})

    return change


def _none(setting: str) -> SettingsHandler:
    """``PDispOff``, ``EOffsOff``"""

    def change(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
        bind(invoke, (), ())
        run.settings.change(**{setting: None})

    return change


def _sing_area(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
    switch = _one_switch(bind(invoke, (), ("wrist", "lockaxis4", "off")), "off")
    run.settings.change(singularity=switch)


def _acc_set(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
    bound = bind(invoke, ("Acc", "Ramp"), ("finepointramp",))
    acceleration = _percent(run, bound, 0, scope)
    ramps = [_number(run, bound, 1, 100.0, scope)]
    if "finepointramp" in bound.options:
        fine = bound.option("finepointramp")
        ramps.append(run.evaluator.number(fine, scope, "AccSet \\FinePointRamp"))
    if not all(0 < ramp <= 100 for ramp in ramps):
        raise SourceError(f"{bound.text}: a ramp is in (0, 100], not {min(ramps):g}", bound.span)
    if len(set(ramps)) > 1:
        run.out.notes.once(
            "finepointramp",
            "AccSet ramps differently towards fine points: the smaller ramp is taken everywhere",
            bound.span,
        )
    share = max(acceleration, LEAST_ACCELERATION) / 100
    ramp = max(min(ramps), LEAST_RAMP) / 100
    run.settings.change(acceleration=share, ramp=ramp)


def _vel_set(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
    bound = bind(invoke, ("Override", "Max"), ())
    override = _percent(run, bound, 0, scope)
    greatest = _number(run, bound, 1, VMAX[0], scope)
    if greatest <= 0:
        raise SourceError(f"VelSet: the greatest speed is above zero, not {greatest:g}", bound.span)
    run.settings.change(override=override / 100, greatest_tcp=greatest)


def _number(run: SettingsRun, bound: Bound, index: int, otherwise: float, scope: Scope) -> float:
    """A num; ``otherwise`` where it is not known."""
    expression = bound.value(index)
    value = run.evaluator.evaluate(expression, scope)
    unknown = find_unknown(value)
    if unknown is None:
        run.evaluator.check(value, NUM, bound.use(index), expression.span)
        assert isinstance(value, float)
        return value
    if unknown.lost:
        raise SourceError(f"{bound.text} depends on {unknown.reason}", bound.span)
    message = f"{bound.text} depends on {unknown.reason}: {otherwise:g} is taken"
    run.evaluator.answers.assumed(expression.span, message + answerable(unknown))
    return otherwise


def _percent(run: SettingsRun, bound: Bound, index: int, scope: Scope) -> float:
    value = _number(run, bound, index, 100.0, scope)
    if not 0 < value <= 100:
        raise SourceError(f"{bound.text}: a percentage is in (0, 100], not {value:g}", bound.span)
    return value


def _path_acc_lim(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
    bound = bind(invoke, ("AccLim", "DecelLim"), ("accmax", "decelmax"))
    limits = []
    for index, option in enumerate(("accmax", "decelmax")):
        on = run.evaluator.known(bound.value(index), scope, BOOL, "PathAccLim")
        if on:
            limit = bound.option(option)
            limits.append(run.evaluator.number(limit, scope, f"PathAccLim \\{option}"))
    if limits and min(limits) <= 0:
        raise SourceError("PathAccLim: a limit is above zero", bound.span)
    if len(limits) == 1 or (limits and limits[0] != limits[1]):
        run.out.notes.once(
            "pathacclim",
            "PathAccLim limits acceleration and deceleration differently: the smaller limit is "
            "taken for both",
            bound.span,
        )
    run.settings.change(path_acceleration=min(limits, default=None))


def _cir_path_mode(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
    modes = ("pathframe", "objectframe", "cirpointori", "wrist45", "wrist46", "wrist56")
    switch = _one_switch(bind(invoke, (), modes), "pathframe")
    known = {
        "pathframe": ArcOrientation.FOLLOWS_ARC,
        "objectframe": ArcOrientation.FIXED_FRAME,
    }
    run.settings.change(arc=known.get(switch, switch))


def _grip_load(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
    bound = bind(invoke, ("Load",), ())
    expression = bound.value(0)
    unknown = find_unknown(run.evaluator.evaluate(expression, scope))
    load = None
    if unknown is None:
        load = run.convert.load(run.evaluator, expression, scope)
    elif unknown.lost:
        raise SourceError(f"GripLoad depends on {unknown.reason}", invoke.span)
    else:
        message = f"GripLoad: the payload is {unknown.reason}; none is taken"
        run.out.notes.once("payload", message, invoke.span)
    run.settings.change(load=load)


def _pdisp_set(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
    bound = bind(invoke, ("DispFrame",), ())
    frame, open_ = _taken(run, bound.value(0), scope, POSE, "PDispSet")
    _suppose(run, "displacement", run.convert.pose(frame, bound.span), open_)


def _pdisp_on(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
    r"""``PDispOn [\Rot] [\ExeP,] ProgPoint, Tool [\WObj]``

    The displacement takes the programmed point to the executed one, which is the present position
    unless it is given; without ``\Rot`` by a shift alone.
    """
    bound = bind(invoke, ("ProgPoint", "Tool"), ("rot", "exep", "wobj"))
    programmed, open_ = _point(run, bound.value(0), scope)
    if "exep" in bound.options:
        executed, other = _point(run, bound.option("exep"), scope)
        open_ = open_ or other
    else:
        record = run.functions.present_robtarget(
            run.evaluator, bound.value(1), bound.options.get("wobj"), scope, invoke
        )
        executed = run.convert.pose(record[:2], bound.span)
    shift = tuple(e - p for e, p in zip(executed.position, programmed.position, strict=True))
    displacement = Pose((shift[0], shift[1], shift[2]))
    if "rot" in bound.options:
        displacement = executed @ programmed.inverse()
    _suppose(run, "displacement", displacement, open_)


def _point(run: SettingsRun, expression: Expression, scope: Scope) -> tuple[Pose, str]:
    value, open_ = _taken(run, expression, scope, ROBTARGET, "PDispOn")
    assert isinstance(value, tuple)
    return run.convert.pose(value[:2], expression.span), open_


def _taken(
    run: SettingsRun, expression: Expression, scope: Scope, type_: Type, use: str
) -> tuple[Value, str]:
    """A value, or what is taken for it, and what it depends on that the program does not say."""
    value = run.evaluator.evaluate(expression, scope)
    unknown = find_unknown(value)
    taken = run.evaluator.assumed(value, type_, use, expression.span)
    run.evaluator.check(taken, type_, use, expression.span)
    return taken, "" if unknown is None else unknown.reason


def _suppose(run: SettingsRun, name: str, value: object, open_: str) -> None:
    """A setting that the path depends on.

    Args:
        open_: what the program does not say of it; empty for nothing.
    """
    run.settings.suppose(name, value, open_ or run.evaluator.course.supposed)


def _eoffs_set(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
    bound = bind(invoke, ("EAxOffs",), ())
    offsets, open_ = _taken(run, bound.value(0), scope, EXTJOINT, "EOffsSet")
    assert isinstance(offsets, tuple)
    _suppose(run, "offsets", offsets, open_)


def _eoffs_on(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
    r"""``EOffsOn [\ExeP,] ProgPoint``: the difference of external axes between the two points."""
    bound = bind(invoke, ("ProgPoint",), ("exep",))
    programmed, open_ = _taken(run, bound.value(0), scope, ROBTARGET, "EOffsOn")
    if "exep" in bound.options:
        executed, other = _taken(run, bound.option("exep"), scope, ROBTARGET, "EOffsOn")
        open_ = open_ or other
    else:
        executed = run.functions.present_robtarget(run.evaluator, None, None, scope, invoke)
    assert isinstance(programmed, tuple) and isinstance(executed, tuple)
    pairs = zip(executed[3], programmed[3], strict=True)
    offsets = tuple(e - p if max(abs(e), abs(p)) < UNUSED_AXIS else 0.0 for e, p in pairs)
    _suppose(run, "offsets", offsets, open_)


def _world_acc_lim(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
    r"""``WorldAccLim \On := limit`` (m/s²) or ``\Off``"""
    bound = bind(invoke, (), ("on", "off"))
    limit = None
    if "off" not in bound.options:
        limit = run.evaluator.number(bound.option("on"), scope, "WorldAccLim \\On")
        if limit <= 0:
            raise SourceError("WorldAccLim: the limit is above zero", bound.span)
        run.out.notes.once(
            "worldacclim",
            "WorldAccLim limits the TCP's acceleration in the world; it is taken as one along the "
            "path, as PathAccLim's",
            bound.span,
        )
    run.settings.change(world_acceleration=limit)


def _speed_refresh(run: SettingsRun, invoke: Invoke, scope: Scope) -> None:
    """``SpeedRefresh percent``: from the move under way on; here from the next one."""
    bound = bind(invoke, ("Override",), ())
    percent = _number(run, bound, 0, 100.0, scope)
    if not 0 <= percent <= 100:
        raise SourceError(f"SpeedRefresh takes 0 to 100 percent, not {percent:g}", bound.span)
    if percent == 0:
        why = "it holds the robot until another one comes; it is taken as not there"
        run.out.notes.count(f"SpeedRefresh 0: {why}", bound.span)
        return
    run.settings.change(refreshed=percent / 100)


SETTINGS: dict[str, SettingsHandler] = {
    "confj": _conf("check_joint"),
    "confl": _conf("check_linear"),
    "singarea": _sing_area,
    "accset": _acc_set,
    "velset": _vel_set,
    "pathacclim": _path_acc_lim,
    "cirpathmode": _cir_path_mode,
    "gripload": _grip_load,
    "pdispset": _pdisp_set,
    "pdispoff": _none("displacement"),
    "pdispon": _pdisp_on,
    "eoffsset": _eoffs_set,
    "eoffson": _eoffs_on,
    "eoffsoff": _none("offsets"),
    "worldacclim": _world_acc_lim,
    "speedrefresh": _speed_refresh,
}
_DISPLACED = ("displacement",)
_OFFSET = ("offsets",)
SETS: dict[str, tuple[str, ...]] = {
    "confj": ("check_joint",),
    "confl": ("check_linear",),
    "singarea": ("singularity",),
    "accset": ("acceleration", "ramp"),
    "velset": ("override", "greatest_tcp"),
    "pathacclim": ("path_acceleration",),
    "cirpathmode": ("arc",),
    "gripload": ("load",),
    **dict.fromkeys(("pdispset", "pdispoff", "pdispon"), _DISPLACED),
    **dict.fromkeys(("eoffsset", "eoffson", "eoffsoff"), _OFFSET),
    "worldacclim": ("world_acceleration",),
    "speedrefresh": ("refreshed",),
}
"""Names of the settings that each sets: nobody knows them behind one that is damaged."""
