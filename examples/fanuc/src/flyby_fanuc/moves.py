"""Motion instructions: ``L P[1:seam] 500mm/sec CNT50 ACC80 Offset,PR[2] TB .10sec,DO[1]=ON``."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from flyby.core.errors import InputError
from flyby.core.program.event import Event
from flyby.core.program.move import Move
from flyby.core.program.target import JointTarget, PoseTarget, Target
from flyby.core.source.lines.expressions import Datum, parse
from flyby.core.source.lines.forms import FormGrammar, Found
from flyby.core.source.lines.moves import counted_on, made_move
from flyby.core.source.lines.postures import PostureLabel
from flyby.core.source.lines.statements import Drive, Line, Numbers, Situation
from flyby.core.spatial.pose import Pose

from .words import FRAMES, MOTION, XYZ

_POINT = r"PR?\[(?:[^\[\]]|\[[^\[\]]*\])*\]"
_AMOUNT = r"(?:[\d.]+|A?R\[[^\[\]]*\])"
MOTION_LINE = (
    rf"(?P<kind>[JLCA])\s+(?P<point>{_POINT})(?:\s+(?P<end>{_POINT}))?\s+"
    rf"(?P<pace>(?P<speed>{_AMOUNT})\s*(?P<unit>%|mm/sec|cm/min|inch/min|deg/sec|msec|sec)"
    rf"|max_speed)\s+(?P<zone>FINE|(?P<word>CNT)\s*(?P<cnt>{_AMOUNT})"
    r"|CR\s*(?P<cr>[\d.]+)(?:\s*,\s*(?P<behind>[\d.]+))?)(?P<options>(?:\s.*)?)"
)
_OPTION = re.compile(
    rf"\s*(?:ACC\s*(?P<acc>{_AMOUNT})|(?P<inc>INC\b)"
    rf"|(?P<tool>Tool_)?(?P<offset>Offset)(?:\s*,\s*(?P<register>{_POINT}))?"
    r"|(?P<when>TB|TA|DB)\s*(?P<amount>[\d.]+)\s*(?:sec|mm)\s*,\s*(?P<action>.*?)\s*$"
    r"|(?P<plain>PTH|BREAK|COORD|MROT|RTCP|Skip\s*,\s*LBL\[[^\]]*\]|(?:Ind\.)?EV\s*\d+%))",
    re.IGNORECASE,
)


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
    given = grammar.options(line, found, "options", _OPTION)
    speed = grammar.numbers_at(line, found, "pace", "speed")
    if "acc" in given:
        speed = replace(speed, numbers=(*speed.numbers, parse(line.source, *given["acc"])))
    register = parse(line.source, *given["register"]) if "register" in given else None
    events = _events(line, given)

    def build(
        target: Numbers, speeds: Numbers, sizes: Numbers, via: Numbers, now: Situation
    ) -> Move:
        place = target.kind or Place()
        frame, tool = (
            int(now.setting(word, 0.0)) if number is None else number
            for word, number in (("UFRAME_NUM", place.frame), ("UTOOL_NUM", place.tool))
        )
        held, user = FRAMES.tool_of(tool, now), FRAMES.work_object_of(frame, now)
        goes: Target = XYZ.target(target[:6], place.joints, place.configuration)
        if "inc" in given:
            now.computed("target")
            goes = counted_on(goes, now.before, held, user)
        if "offset" in given:
            now.computed("target")
            goes = _shifted(goes, _offset(register, "tool" in given, now), "tool" in given)
        through = XYZ.target(via, False, (via.kind or Place()).configuration) if via else None
        scale = now.setting("OVERRIDE", 100.0) / 100
        pace = MOTION.speed_of(kind, found["unit"], speeds, "acc" in given, scale)
        zone = MOTION.zone_of(found["word"] or "CR", sizes)
        return made_move(kind, goes, pace, zone, held, user, through, events)

    through = middle or (found if found["end"] else None)
    return Drive(
        line.span,
        grammar.point_at(line, found, "end" if found["end"] else "point"),
        speed,
        grammar.numbers_at(line, found, "zone", "cnt", "cr", "behind"),
        build,
        None if through is None else grammar.point_at(line, through, "point"),
    )


def _events(line: Line, given: Mapping[str, tuple[int, int]]) -> tuple[Event, ...]:
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
