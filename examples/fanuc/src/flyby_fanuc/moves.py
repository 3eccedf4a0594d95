"""Motion instructions: ``L P[1:seam] 500mm/sec CNT50 ACC80 Offset,PR[2] TB .10sec,DO[1]=ON``."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field, replace

from flyby.core.dialect import Orientation
from flyby.core.errors import InputError, SourceError
from flyby.core.program.event import Event
from flyby.core.program.move import Move
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget, Target
from flyby.core.program.tool import FLANGE, WORLD, Tool, WorkObject
from flyby.core.program.zone import FINE, VendorZone, Zone
from flyby.core.source.lines.amounts import Amount, speed_of
from flyby.core.source.lines.expressions import Datum, Expression, parse
from flyby.core.source.lines.forms import FormGrammar, Found
from flyby.core.source.lines.moves import made_move
from flyby.core.source.lines.positions import PositionForm
from flyby.core.source.lines.statements import Drive, Line, Numbers, Situation
from flyby.core.spatial.pose import Pose

from .configuration import FanucConfiguration
from .dialect import CNT, CR

POINT = r"PR?\[(?:[^\[\]]|\[[^\[\]]*\])*\]"
_AMOUNT = r"(?:[\d.]+|A?R\[[^\[\]]*\])"
MOTION = (
    rf"(?P<kind>[JLCA])\s+(?P<point>{POINT})(?:\s+(?P<end>{POINT}))?\s+"
    rf"(?P<pace>(?P<speed>{_AMOUNT})\s*(?P<unit>%|mm/sec|cm/min|inch/min|deg/sec|msec|sec)"
    rf"|max_speed)\s+(?P<zone>FINE|CNT\s*(?P<cnt>{_AMOUNT})"
    r"|CR\s*(?P<cr>[\d.]+)(?:\s*,\s*(?P<behind>[\d.]+))?)(?P<options>(?:\s.*)?)"
)
_OPTION = re.compile(
    rf"\s*(?:ACC\s*(?P<acc>{_AMOUNT})|(?P<inc>INC\b)"
    rf"|(?P<on>Tool_Offset|Offset)(?:\s*,\s*(?P<pr>{POINT}))?"
    r"|(?P<when>TB|TA|DB)\s*(?P<amount>[\d.]+)\s*(?:sec|mm)\s*,\s*(?P<action>.*?)\s*$"
    r"|(?P<plain>PTH|BREAK|COORD|MROT|RTCP|Skip\s*,\s*LBL\[[^\]]*\]|(?:Ind\.)?EV\s*\d+%))",
    re.IGNORECASE,
)
_SECONDS = {"sec": Amount("duration", 1.0)}
JOINT = _SECONDS | {"%": Amount("joint_fraction", 0.01)}
LINE = _SECONDS | {
    "mm/sec": Amount("tcp", 1e-3),
    "deg/sec": Amount("reorientation", math.radians(1)),
}
_READ = {
    **(JOINT | LINE),
    "msec": Amount("duration", 1e-3),
    "cm/min": Amount("tcp", 1e-2 / 60),
    "inch/min": Amount("tcp", 0.0254 / 60),
}
XYZ = PositionForm(Orientation.EULER_ZYX, last_first=True)


@dataclass(frozen=True, slots=True)
class Place:
    """What a position is beside its numbers.

    Args:
        joints: whether they are joint values.
        frame, tool: numbers; None for what is set where it is used.
        configuration: of a pose.
    """

    joints: bool = False
    frame: int | None = None
    tool: int | None = None
    configuration: FanucConfiguration | None = None


@dataclass
class Options:
    """What stands behind the zone.

    Args:
        shifts: ``inc``, ``offset`` and ``tool_offset``, with the position register of the latter;
            None for that of the condition.
    """

    acc: Expression | None = None
    shifts: dict[str, Expression | None] = field(default_factory=dict)
    events: tuple[Event, ...] = ()


def drive(
    grammar: FormGrammar, line: Line, found: Found, kind: str, middle: Found | None = None
) -> Drive:
    """A motion instruction.

    Args:
        kind: ``J``, ``L`` or ``C``.
        middle: the ``A`` that is driven through on the way.
    """
    if middle is None and (kind == "C") != bool(found["end"]):
        raise InputError("C has two positions, J, L and A have one")
    options = _options(line, found)
    speed = grammar.numbers_at(line, found, "pace", "speed")
    if options.acc is not None:
        speed = replace(speed, numbers=(*speed.numbers, options.acc))
    unit = (found["unit"] or "").lower()

    def build(
        target: Numbers, speeds: Numbers, sizes: Numbers, via: Numbers, now: Situation
    ) -> Move:
        frame, tool = _frames(target.kind or Place(), now)
        goes = _target(target, options.shifts, now, (frame, tool))
        share = speeds[-1] / 100 if options.acc is not None else 1.0
        pace = Speed(acceleration_override=share)
        if unit:
            scale = now.setting("OVERRIDE", 100.0) / 100
            number = speeds[0] / scale if unit in ("sec", "msec") else speeds[0] * scale
            pace = speed_of(unit, number, _READ, share)
        through = None if kind != "C" else _pose_target(via)
        zone = _zone(found, sizes)
        return made_move(kind, goes, pace, zone, tool, frame, through, options.events)

    through = middle or (found if found["end"] else None)
    return Drive(
        line.span,
        grammar.point_at(line, found, "end" if found["end"] else "point"),
        speed,
        grammar.numbers_at(line, found, "zone", "cnt", "cr", "behind"),
        build,
        None if through is None else grammar.point_at(line, through, "point"),
    )


def _options(line: Line, found: Found) -> Options:
    told = Options()
    text, at, end = line.source.text, found.start("options"), found.end("options")
    while text[at:end].strip():
        one = _OPTION.match(text, at, end)
        if one is None:
            raise InputError(
                f"the option {text[at:end].strip()!r} is not known: it may move the robot"
            )
        if one["acc"]:
            told.acc = parse(line.source, *one.span("acc"))
        elif one["inc"]:
            told.shifts["inc"] = None
        elif one["on"]:
            register = parse(line.source, *one.span("pr")) if one["pr"] else None
            told.shifts[one["on"].lower()] = register
        elif one["when"]:
            amount, when = float(one["amount"]), one["when"].upper()
            way, lead = (amount / 1000, 0.0) if when == "DB" else (0.0, amount)
            span = line.source.span(*one.span("action"))
            lead = -lead if when == "TA" else lead
            told.events = (Event(one["action"], distance=way, time=lead, span=span),)
        at = one.end()
    return told


def _frames(place: Place, now: Situation) -> tuple[WorkObject, Tool]:
    frame, tool = (
        int(now.setting(word, 0.0)) if number is None else number
        for word, number in (("UFRAME_NUM", place.frame), ("UTOOL_NUM", place.tool))
    )
    user, tcp = (_known(word, n, now) for word, n in (("UFRAME", frame), ("UTOOL", tool)))
    return (
        WORLD if user is None else WorkObject(f"UFRAME[{frame}]", user=user),
        FLANGE if tcp is None else Tool(f"UTOOL[{tool}]", tcp),
    )


def _known(word: str, number: int, now: Situation) -> Pose | None:
    try:
        return XYZ.pose(now.vector(word, number)) if number else None
    except SourceError:
        raise InputError(
            f"{word}[{number}] is not known: put framevar.va of the controller's backup beside the "
            f"program, or answer {word}[{number},1] to {word}[{number},6] in the table [values]"
        ) from None


def _pose_target(numbers: Numbers) -> PoseTarget:
    return PoseTarget(XYZ.pose(numbers), (numbers.kind or Place()).configuration)


def _target(
    numbers: Numbers, shifts: dict[str, Expression | None], now: Situation, frames: tuple
) -> Target:
    """Where a move goes, its increments and offsets included."""
    place = numbers.kind or Place()
    if shifts:
        now.computed("target")
    before = now.before if "inc" in shifts else None
    here = None if before is None else before.target
    if place.joints:
        target = XYZ.target(numbers[:6], True)
        if shifts and (set(shifts) != {"inc"} or not isinstance(here, JointTarget)):
            raise InputError(
                "joint values are counted from joint values that are known, and have no offset: "
                "give the position as a pose"
            )
        if not shifts:
            return target
        pairs = zip(target.joints, here.joints, strict=True)
        return JointTarget(tuple(a + b for a, b in pairs))
    pose = XYZ.pose(numbers)
    if "inc" in shifts:
        if not isinstance(here, PoseTarget) or (before.work_object, before.tool) != frames:
            raise InputError(
                "INC: the position before is no pose in the same frames, or is not known"
            )
        moved = (a + b for a, b in zip(here.pose.position, pose.position, strict=True))
        turned = Pose(quaternion=pose.quaternion) @ Pose(quaternion=here.pose.quaternion)
        pose = Pose(tuple(moved), turned.quaternion)  # type: ignore[arg-type]
    if "offset" in shifts:
        pose = _shift(shifts, "offset", now) @ pose
    if "tool_offset" in shifts:
        pose = pose @ _shift(shifts, "tool_offset", now)
    return PoseTarget(pose, place.configuration)


def _shift(shifts: dict[str, Expression | None], word: str, now: Situation) -> Pose:
    register = shifts[word]
    if isinstance(register, Datum) and register.index is not None:
        number = now.number(register.index)
    else:
        number = now.setting(word.upper(), 0.0)
    if number == 0:
        raise InputError(f"no {word.upper()} CONDITION says by how much")
    return XYZ.pose(now.vector("PR", int(number)))


def _zone(found: Found, sizes: Numbers) -> Zone:
    if not sizes or sizes[0] == 0:
        return FINE
    if found["cnt"]:
        return VendorZone(CNT, sizes[0] / 100)
    return VendorZone(CR, sizes[0] / 1000, sizes[1] / sizes[0] if len(sizes) > 1 else 1.0)
