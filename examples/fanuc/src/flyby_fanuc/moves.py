"""Motion instructions: ``L P[1:seam] 500mm/sec CNT50 ACC80 Offset,PR[2] TB .10sec,DO[1]=ON``."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

from flyby.core.errors import InputError, SourceError
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.event import Event
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget, Target
from flyby.core.program.tool import FLANGE, WORLD, Tool, WorkObject
from flyby.core.program.zone import FINE, VendorZone, Zone
from flyby.core.source.lines.expressions import Datum, parse
from flyby.core.source.lines.statements import Drive, Line, Numbers, Operand, Situation
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import euler_zyx, matrix_from_euler_zyx

from .configuration import FanucConfiguration
from .dialect import CNT, CR

POINT = r"PR?\[(?:[^\[\]]|\[[^\[\]]*\])*\]"
_AMOUNT = r"(?:[\d.]+|A?R\[[^\[\]]*\])"
MOTION = re.compile(
    rf"(?P<kind>[JLCA])\s+(?P<point>{POINT})(?:\s+(?P<end>{POINT}))?\s+"
    rf"(?P<pace>(?P<speed>{_AMOUNT})\s*(?P<unit>%|mm/sec|cm/min|inch/min|deg/sec|msec|sec)|max_speed)\s+"
    rf"(?P<zone>FINE|CNT\s*(?P<cnt>{_AMOUNT})|CR\s*(?P<cr>[\d.]+)(?:\s*,\s*(?P<behind>[\d.]+))?)"
    r"(?P<options>(?:\s.*)?)",
    re.IGNORECASE | re.DOTALL,
)
_OPTION = re.compile(
    rf"\s*(?:ACC\s*(?P<acc>{_AMOUNT})|(?P<inc>INC\b)|(?P<on>Tool_Offset|Offset)(?:\s*,\s*(?P<pr>{POINT}))?"
    r"|(?P<when>TB|TA|DB)\s*(?P<amount>[\d.]+)\s*(?:sec|mm)\s*,\s*(?P<action>.*?)\s*$"
    r"|(?P<plain>PTH|BREAK|COORD|MROT|RTCP|Skip\s*,\s*LBL\[[^\]]*\]|(?:Ind\.)?EV\s*\d+%))",
    re.IGNORECASE,
)
UNITS = {
    **{"mm/sec": ("tcp", 1e-3), "cm/min": ("tcp", 1e-2 / 60), "inch/min": ("tcp", 0.0254 / 60)},
    **{"deg/sec": ("reorientation", math.radians(1)), "sec": ("duration", 1.0)},
    **{"msec": ("duration", 1e-3), "%": ("joint_fraction", 0.01)},
}
_HARMLESS = "PTH BREAK COORD MROT RTCP Skip EV"
_FREE = 1e-12


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


def pose_of(numbers: Numbers) -> Pose:
    """A pose of X, Y, Z in mm and W, P, R in degrees: Rz(R) Ry(P) Rx(W)."""
    matrix = np.eye(4)
    matrix[:3, 3] = [v / 1000 for v in numbers[:3]]
    matrix[:3, :3] = matrix_from_euler_zyx(*(math.radians(v) for v in reversed(numbers[3:6])))
    return Pose.from_matrix(matrix)


def numbers_of(target: Target) -> tuple[float, ...]:
    """The numbers of a position: mm and degrees."""
    if isinstance(target, JointTarget):
        return tuple(math.degrees(v) for v in target.joints)
    turns = reversed(euler_zyx(target.pose.matrix()[:3, :3]))
    return (*(1000 * v for v in target.pose.position), *map(math.degrees, turns))


def drive(
    line: Line, found: re.Match[str], arc: str = "", middle: re.Match[str] | None = None
) -> Drive:
    """A motion instruction.

    Args:
        arc: what an ``A`` is driven as.
        middle: the ``A`` that is driven through on the way.
    """
    source = line.source

    def operand(of: re.Match[str], name: str) -> Operand:
        span = source.span(*of.span(name))
        datum = parse(source, *of.span(name))
        assert isinstance(datum, Datum)
        return Operand(span, point=datum)

    kind = arc or found["kind"].upper()
    if middle is None and (kind == "C") != bool(found["end"]):
        raise ValueError("C has two positions, J, L and A have one")
    options = _options(line, found)
    amounts = [found.span("speed")] if found["speed"] else []
    amounts += [options["acc"]] if "acc" in options else []
    speed = Operand(
        source.span(*found.span("pace")), tuple(parse(source, *span) for span in amounts)
    )
    sized = [name for name in ("cnt", "cr", "behind") if found[name]]
    zone = Operand(
        source.span(*found.span("zone")), tuple(parse(source, *found.span(n)) for n in sized)
    )
    unit = (found["unit"] or "").lower()

    def build(
        target: Numbers, speeds: Numbers, sizes: Numbers, via: Numbers, now: Situation
    ) -> Move:
        place = target.kind or Place()
        frame, tool = _frames(place, now)
        goes = _target(target, place, options, now, (frame, tool))
        override = now.setting("OVERRIDE", 100.0) / 100
        pace = _speed(unit, speeds, override, "acc" in options)
        if override != 1.0:
            now.computed("speed")
        events = options["events"]
        if kind == "J":
            return MoveJ(goes, pace, _zone(sized, sizes), tool, frame, events=events)
        if not isinstance(goes, PoseTarget):
            raise InputError("the position has joint values, which L and C are not emulated to")
        if kind == "L":
            return MoveL(goes, pace, _zone(sized, sizes), tool, frame, events=events)
        return MoveC(
            goes,
            pace,
            _zone(sized, sizes),
            tool,
            frame,
            events=events,
            via=PoseTarget(pose_of(via), (via.kind or Place()).configuration),
            orientation=ArcOrientation.FIXED_FRAME,
        )

    last = operand(found, "end" if found["end"] else "point")
    through = middle or (found if found["end"] else None)
    via_point = None if through is None else operand(through, "point")
    return Drive(line.span, last, speed, zone, build, via_point)


def _options(line: Line, found: re.Match[str]) -> dict:
    """What stands behind the zone: spans, and events."""
    told: dict = {"events": ()}
    text, at, end = line.source.text, found.start("options"), found.end("options")
    while text[at:end].strip():
        one = _OPTION.match(text, at, end)
        if one is None:
            raise ValueError(
                f"the option {text[at:end].strip()!r} is not known: it may move the robot"
            )
        if one["acc"]:
            told["acc"] = one.span("acc")
        elif one["inc"]:
            told["inc"] = True
        elif one["on"]:
            told[one["on"].lower()] = parse(line.source, *one.span("pr")) if one["pr"] else None
        elif one["when"]:
            amount = float(one["amount"])
            lead = {"TB": amount, "TA": -amount}.get(one["when"].upper(), 0.0)
            way = amount / 1000 if one["when"].upper() == "DB" else 0.0
            event = Event(
                one["action"], distance=way, time=lead, span=line.source.span(*one.span("action"))
            )
            told["events"] = (event,)
        at = one.end()
    return told


def _frames(place: Place, now: Situation) -> tuple[WorkObject, Tool]:
    frame, tool = (
        int(now.setting(word, 0.0)) if number is None else number
        for word, number in (("UFRAME_NUM", place.frame), ("UTOOL_NUM", place.tool))
    )
    poses = []
    for word, number in (("UFRAME", frame), ("UTOOL", tool)):
        try:
            numbers = now.vector(word, number) if number else None
        except SourceError:
            raise InputError(
                f"{word}[{number}] is not known: put framevar.va of the controller's backup beside "
                f"the program, or answer {word}[{number},1] to {word}[{number},6] in the table "
                "[values]"
            ) from None
        poses.append(None if numbers is None else pose_of(numbers))
    return (
        WORLD if poses[0] is None else WorkObject(f"UFRAME[{frame}]", user=poses[0]),
        FLANGE if poses[1] is None else Tool(f"UTOOL[{tool}]", poses[1]),
    )


def _target(numbers: Numbers, place: Place, options: dict, now: Situation, frames: tuple) -> Target:
    """Where a move goes, its increments and offsets included."""
    shifts = [key for key in ("inc", "offset", "tool_offset") if key in options]
    if shifts:
        now.computed("target")
    if place.joints:
        values = tuple(math.radians(v) for v in numbers[:6])
        if shifts == ["inc"]:
            if now.before is None or not isinstance(now.before.target, JointTarget):
                raise InputError(
                    "INC of joint values: the position before has none, or is not known"
                )
            pairs = zip(values, now.before.target.joints, strict=True)
            return JointTarget(tuple(a + b for a, b in pairs))
        if shifts:
            raise InputError(
                "an offset of joint values is not emulated: give the position as a pose"
            )
        return JointTarget(values)
    pose = pose_of(numbers)
    if "inc" in options:
        before = now.before
        same = before is not None and (before.work_object, before.tool) == frames
        if not same or not isinstance(before.target, PoseTarget):
            raise InputError(
                "INC: the position before is no pose in the same frames, or is not known"
            )
        here = before.target.pose
        moved = (a + b for a, b in zip(here.position, pose.position, strict=True))
        turned = Pose(quaternion=pose.quaternion) @ Pose(quaternion=here.quaternion)
        pose = Pose(tuple(moved), turned.quaternion)  # type: ignore[arg-type]
    if "offset" in options:
        pose = _shift(options["offset"], "OFFSET CONDITION", now) @ pose
    if "tool_offset" in options:
        pose = pose @ _shift(options["tool_offset"], "TOOL_OFFSET CONDITION", now)
    return PoseTarget(pose, place.configuration)


def _shift(register: Datum | None, condition: str, now: Situation) -> Pose:
    if register is not None and register.index is not None:
        number = now.number(register.index)
    else:
        number = now.setting(condition, 0.0)
    if number == 0:
        raise InputError(f"no {condition} says by how much")
    return pose_of(now.vector("PR", int(number)))


def _zone(sized: list[str], sizes: Numbers) -> Zone:
    if not sized:
        return FINE
    if sized[0] == "cnt":
        return FINE if sizes[0] == 0 else VendorZone(CNT, sizes[0] / 100)
    ratio = sizes[1] / sizes[0] if len(sizes) > 1 and sizes[0] else 1.0
    return FINE if sizes[0] == 0 else VendorZone(CR, sizes[0] / 1000, ratio)


def _speed(unit: str, numbers: Numbers, override: float, stated: bool) -> Speed:
    """The speed of a move; ``stated``: whether its last number is that of ACC."""
    acceleration = numbers[-1] / 100 if stated else 1.0
    if not unit:
        return Speed(acceleration_override=acceleration)
    name, scale = UNITS[unit]
    value = numbers[0] * scale
    value = value / override if name == "duration" else value * override
    return Speed(**{name: value}, acceleration_override=acceleration)
