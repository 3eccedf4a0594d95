"""Motion instructions: ``L P[1:seam] 500mm/sec CNT50 ACC80 Offset,PR[2] TB .10sec,DO[1]=ON``."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from flyby.core.errors import InputError
from flyby.core.program.event import Event
from flyby.core.program.target import JointTarget, PoseTarget, Target
from flyby.core.source.lines.driving import Moved, Placed
from flyby.core.source.lines.expressions import Datum, parse
from flyby.core.source.lines.moves import counted_on
from flyby.core.source.lines.postures import PostureLabel
from flyby.core.source.lines.statements import Line, Situation
from flyby.core.spatial.pose import Pose

from .words import XYZ

_POINT = r"PR?\[(?:[^\[\]]|\[[^\[\]]*\])*\]"
_AMOUNT = r"(?:[\d.]+|A?R\[[^\[\]]*\])"
MOTION = (
    rf"(?P<kind>[JLCA])\s+(?:(?P<via>{_POINT})\s+(?=PR?\[))?(?P<point>{_POINT})\s+"
    rf"(?P<pace>(?P<speed>{_AMOUNT})\s*(?P<unit>%|mm/sec|cm/min|inch/min|deg/sec|msec|sec)"
    rf"|max_speed)\s+(?P<zone>FINE|(?P<word>CNT(?!\s*[\d.]+\s*,)|CR)\s*(?P<size>{_AMOUNT})"
    rf"(?:\s*,\s*(?P<behind>[\d.]+))?)(?=(?:.*?\sACC\s*(?P<share>{_AMOUNT}))?)"
    r"(?P<options>(?:\s.*)?)"
)
OPTION = re.compile(
    rf"\s*(?:ACC\s*{_AMOUNT}|(?P<inc>INC\b)"
    rf"|(?P<tool>Tool_)?(?P<offset>Offset)(?:\s*,\s*(?P<register>{_POINT}))?"
    r"|(?P<when>TB|TA|DB)\s*(?P<amount>[\d.]+)\s*(?:sec|mm)\s*,\s*(?P<action>.*?)\s*$"
    r"|(?P<plain>PTH|BREAK|COORD|MROT|RTCP|Skip\s*,\s*LBL\[[^\]]*\]|(?:Ind\.)?EV\s*\d+%))",
    re.IGNORECASE,
)
Given = Mapping[str, tuple[int, int]]
"""Where the parts of a motion's options stand in the text."""


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
    configuration: PostureLabel | None = None


def moved(line: Line, given: Given) -> Moved:
    """What ``INC`` and offsets make of where a motion goes."""
    register = parse(line.source, *given["register"]) if "register" in given else None

    def changed(placed: Placed, now: Situation) -> Placed:
        goal = placed.target
        if "inc" in given or "offset" in given:
            now.computed("target")
        if "inc" in given:
            goal = counted_on(goal, now.before, placed.tool, placed.work_object)
        if "offset" in given:
            goal = _shifted(goal, _offset(register, "tool" in given, now), "tool" in given)
        return replace(placed, target=goal)

    return changed


def events(line: Line, given: Given) -> tuple[Event, ...]:
    """``TB`` and ``TA`` before and after the end, s; ``DB`` before it, mm."""
    if "when" not in given:
        return ()
    when, amount, action = (
        line.source.text[slice(*given[part])] for part in ("when", "amount", "action")
    )
    number, span = float(amount), line.source.span(*given["action"])
    if when.upper() == "DB":
        return (Event(action, distance=number / 1000, span=span),)
    return (Event(action, time=-number if when.upper() == "TA" else number, span=span),)


def _offset(register: object, of_tool: bool, now: Situation) -> Pose:
    """What a position register holds: the one that is named, or that of the condition."""
    word = "TOOL_OFFSET" if of_tool else "OFFSET"
    named = isinstance(register, Datum) and register.index is not None
    number = now.number(register.index) if named else now.setting(word, 0.0)  # type: ignore
    if number == 0:
        raise InputError(f"no {word} CONDITION says by how much")
    return XYZ.pose(now.vector("PR", int(number)))


def _shifted(target: Target, offset: Pose, of_tool: bool) -> Target:
    if isinstance(target, JointTarget):
        raise InputError("joint values have no offset: give the position as a pose")
    assert isinstance(target, PoseTarget)
    return replace(target, pose=target.pose @ offset if of_tool else offset @ target.pose)
