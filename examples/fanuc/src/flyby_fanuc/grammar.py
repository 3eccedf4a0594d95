"""What TP takes a line for; see `flyby.core.source.lines.forms`."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import ClassVar

from flyby.core.errors import InputError
from flyby.core.program.event import Event
from flyby.core.program.target import JointTarget
from flyby.core.source.lines.driving import MotionGrammar
from flyby.core.source.lines.expressions import Number, Spelling, parse
from flyby.core.source.lines.forms import Found
from flyby.core.source.lines.moves import counted_on
from flyby.core.source.lines.positions import Placed
from flyby.core.source.lines.program import Said
from flyby.core.source.lines.statements import Line, NumberedPoint, Situation

from .words import COORDINATE, FRAMES, LETTERS, MOTION, MOVED, OPTION, POSITION, XYZ

_OFFSETS = frozenset({"OFFSET", "TOOL_OFFSET"})


class Grammar(MotionGrammar):
    """One program's lines."""

    form = XYZ
    words = MOTION
    chained = frozenset({"A"})
    override = "OVERRIDE"
    frames = FRAMES
    registers = frozenset({"R", "AR", "OVERRIDE", *_OFFSETS})
    outputs = frozenset({"DO", "RO", "GO", "AO", "F", "SO", "UO"})
    vectors: ClassVar = {"PR": 6}
    argument = "AR"
    spelling = Spelling(names=True)
    driving = re.compile(r"[JLCAS]\s+PR?\[|IF\b", re.IGNORECASE)
    stopping = frozenset({"PAUSE"})
    current = frozenset({"LPOS", "JPOS"})
    longest = 400
    forms: ClassVar = {
        "routine": r"/PROG\s+(?P<name>\S+).*",
        "position": POSITION,
        "motion": MOVED,
        "label": r"LBL\[\s*(?P<name>\d+)\s*\]",
        "jump": r"JMP\s+LBL\[\s*(?P<name>\d+)\s*\]",
        "call": r"CALL\s+(?P<name>[\w-]+)\s*(?:\((?P<arguments>.*)\))?",
        "harmless": r"PAYLOAD\[.*\]",
        "returned": r"END",
        "end": r"ABORT",
        "opened": r"IF\b(?P<condition>.+?)\s+THEN",
        "when": r"IF\b(?P<condition>.+?)\s*,\s*(?P<action>(?:JMP|CALL)\b.*|[A-Z]+\[.*)",
        "otherwise": r"ELSE",
        "closed": r"ENDIF|ENDFOR",
        "selected": r"SELECT\s+(?P<datum>R\[[^\]]*\])\s*=\s*(?P<value>[^,]+),\s*(?P<action>.*)",
        "case": r"(?:=\s*(?P<value>[^,]+)|ELSE),\s*(?P<action>.*)",
        "counted": r"FOR\s+(?P<counter>R\[[^\]]*\])\s*=\s*(?P<first>.+?)\s+(?:TO|(?P<down>DOWNTO))"
        r"\s+(?P<last>.+)",
        "wait": r"WAIT\s+(?P<time>[^(]+?)\s*\(sec\)",
        "wait.register": r"WAIT\s+(?P<time>[\d.]+|A?R\[[^\]=<>]*\])",
        "wait.for": r"WAIT\s+(?P<condition>.+?)(?:\s*TIMEOUT\s*,.*)?",
        "assigned.held": r"(?P<target>UFRAME_NUM|UTOOL_NUM|OVERRIDE)(?:\[[^\]]*\])?\s*=\s*"
        r"(?P<value>[^%]+?)\s*%?",
        "assigned.offset": r"(?P<target>(?:TOOL_)?OFFSET)\s+CONDITION\s+PR\[(?P<value>.*)\]",
        "pulsed": r"(?P<target>\w+\[[^=]*?\])\s*=\s*PULSE\s*,\s*(?P<time>[\d.]+)\s*sec",
        "assigned": r"(?P<target>[A-Z]+\[[^=]*?\])\s*=\s*(?P<value>[^=].*)",
    }

    def motion(self, line: Line, found: Found) -> Said:
        """A motion with what ``INC`` and offsets make of where it goes, and with ``TB`` and ``TA``
        before and after its end, s, ``DB`` before it, mm."""
        given = self.options(line, found, "options", OPTION)
        named = parse(line.source, *given["register"]) if "register" in given else None
        word = "TOOL_OFFSET" if "of_tool" in given else "OFFSET"

        def moved(placed: Placed, now: Situation) -> Placed:
            goal = placed.target
            if "inc" in given or "offset" in given:
                now.computed("target")
            if "inc" in given:
                goal = counted_on(goal, now.before, placed.tool, placed.work_object)
            if "offset" in given:
                register = now.number(named.index) if named else now.setting(word, 0.0)  # type: ignore
                if register == 0:
                    raise InputError(f"no {word} CONDITION says by how much")
                shift = XYZ.pose(now.vector("PR", int(register)))
                if isinstance(goal, JointTarget):
                    raise InputError("joint values have no offset: give the position as a pose")
                pose = goal.pose @ shift if "of_tool" in given else shift @ goal.pose
                goal = replace(goal, pose=pose)
            return replace(placed, target=goal)

        events: tuple[Event, ...] = ()
        if "when" in given:
            parts = (line.source.text[slice(*given[one])] for one in ("when", "amount", "action"))
            when, amount, action = parts
            size = {"DB": 1e-3, "TA": -1.0}.get(when.upper(), 1.0) * float(amount)
            place = "distance" if when.upper() == "DB" else "time"
            events = (Event(action, span=line.source.span(*given["action"]), **{place: size}),)
        return self.drive(line, found, moved, events)

    def position(self, line: Line, found: Found) -> Said:
        """A position with its frame and tool, and its configuration."""
        values = {}
        for one in COORDINATE.finditer(line.source.text, *found.span("values")):
            span = line.source.span(*one.span(2))
            values[one[1].upper()] = Number(span, float(one[2].replace(" ", "")))
        joints = "J1" in values
        axes = [f"J{k}" for k in range(1, 7)] if joints else list("XYZWPR")
        if any(axis not in values for axis in axes):
            raise InputError("six coordinates should stand in it: X to R, or J1 to J6")
        label = LETTERS.read(found["config"]) if found["config"] else None
        place = replace(self.kind_of(found), joints=joints, configuration=label)
        point = replace(self.datum(line, found, "name"), span=line.span)
        numbers = tuple(values[axis] for axis in axes)
        return NumberedPoint(line.span, point, numbers, place)
