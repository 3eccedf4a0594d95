"""Program → a TP program as text."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from flyby.core.errors import InputError
from flyby.core.program.event import Event, EventAnchor
from flyby.core.program.move import Move, MoveC, MoveJ, Wait
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget, Target
from flyby.core.program.tool import FLANGE, WORLD
from flyby.core.program.zone import VendorZone, Zone
from flyby.core.source.lines.amounts import stated
from flyby.core.source.write.numbering import Numbering
from flyby.core.source.write.options import OpaqueStyle, WriterOptions
from flyby.core.spatial.pose import Pose

from .configuration import FanucConfiguration
from .dialect import CR, TP
from .moves import JOINT, LINE, XYZ

HEAD = """\
/PROG  {name}
/ATTR
OWNER\t\t= MNEDITOR;
COMMENT\t\t= "by flyby";
DEFAULT_GROUP\t= 1,*,*,*,*;
CONTROL_CODE\t= 00000000 00000000;
/MN
"""
TAIL = "/END\n"
_SCRATCH = 100
"""The position register that frames go through."""
_REMARK = 32
"""Characters of a remark."""


def number(value: float) -> str:
    """Three decimals as controllers write them, more where these do not say it."""
    value = round(value, 9)
    text = f"{value:.3f}"
    if abs(float(text) - value) >= 1e-10:
        return f"{value:.9f}"
    return {"-0.000": "0.000", "-180.000": "180.000"}.get(text, text)


def amount(value: float) -> str:
    """A number of a motion instruction."""
    return f"{round(value, 9):.9f}".rstrip("0").rstrip(".")


def pace_of(move: Move, speed: Speed) -> tuple[str, float] | None:
    """Unit and number of a speed; None for ``max_speed``."""
    return stated(speed, JOINT if isinstance(move, MoveJ) else LINE)


def speed_text(move: Move, speed: Speed) -> str:
    """``500mm/sec``, ``50%``, ``2sec``."""
    found = pace_of(move, speed)
    return "max_speed" if found is None else f"{amount(found[1])}{found[0]}"


def zone_text(zone: Zone) -> str:
    """``FINE``, ``CNT50``, ``CR5,10``."""
    if not isinstance(zone, VendorZone):
        return "FINE"
    size = amount(zone.size / zone.kind.unit)
    if zone.kind == CR and zone.ratio != 1.0:
        return f"CR{size},{amount(zone.size * zone.ratio / zone.kind.unit)}"
    return f"{zone.kind.word}{size}"


def position(index: int, target: Target, frames: tuple[str, str]) -> str:
    """The text of a position."""
    if target.external:
        raise InputError("external axes are not written")
    values = [number(v) for v in XYZ.numbers(target)]
    head = f"P[{index}]{{\n   GP1:\n\tUF : {frames[0]}, UT : {frames[1]},"
    if isinstance(target, JointTarget):
        axes = [f"\tJ{k + 1}= {v:>9} deg" for k, v in enumerate(values)]
    else:
        label = target.configuration
        if label is not None and not isinstance(label, FanucConfiguration):
            raise InputError(f"{label} is no CONFIG: label the target's solution for this robot")
        head += f"\t\tCONFIG : '{label}'," if label is not None else ""
        units = ["mm"] * 3 + ["deg"] * 3
        axes = [f"\t{a} = {v:>9}  {u}" for a, v, u in zip("XYZWPR", values, units, strict=True)]
    return f"{head}\n{','.join(axes[:3])},\n{','.join(axes[3:])}\n}};\n"


@dataclass
class Writer:
    """Writes one program."""

    options: WriterOptions
    before: tuple[str, ...] = ()
    after: tuple[str, ...] = ()
    positions: list[str] = field(default_factory=list)
    setup: list[str] = field(default_factory=list)
    tools: Numbering[Pose] = field(default_factory=lambda: Numbering("tools", 10))
    frames: Numbering[Pose] = field(default_factory=lambda: Numbering("frames", 9))
    _in: tuple[int, int] | None = None

    def text(self, name: str, lines: list[str]) -> str:
        """The whole file."""
        body = [*self.before, *self.setup, *(f"  {one.lstrip()}" for one in lines), *self.after]
        numbered = "".join(f"{k + 1:>4}:{line} ;\n" for k, line in enumerate(body))
        return f"{HEAD.format(name=name)}{numbered}/POS\n{''.join(self.positions)}{TAIL}"

    def wait(self, wait: Wait) -> str:
        """A wait."""
        return f"WAIT {amount(wait.duration)}(sec)"

    def move(self, move: Move) -> Iterator[str]:
        """A motion instruction, and the frames that it is in."""
        frame = self._number(
            self.frames,
            "UFRAME",
            move.work_object.pose,
            move.work_object.name,
            move.work_object == WORLD,
        )
        tool = self._number(self.tools, "UTOOL", move.tool.tcp, move.tool.name, move.tool == FLANGE)
        if self._in != (frame, tool):
            self._in = frame, tool
            yield f"  UFRAME_NUM={frame}"
            yield f"  UTOOL_NUM={tool}"
        goals: list[Target] = (
            [move.target] if not isinstance(move, MoveC) else [move.via, move.target]
        )
        names = []
        for goal in goals:
            self.positions.append(position(len(self.positions) + 1, goal, (str(frame), str(tool))))
            names.append(f"P[{len(self.positions)}]")
        kind = type(move).__name__[-1]
        override = move.speed.acceleration_override
        options = f" ACC{amount(100 * override)}" if override != 1.0 else ""
        if len(move.events) > 1:
            raise InputError("TP does one thing on the way of a move")
        for event in move.events:
            if self.options.opaque is OpaqueStyle.KEEP:
                options += self._event(event)
            else:
                yield from remark(event.text)
        pace, zone = speed_text(move, move.speed), zone_text(move.zone)
        yield f"{kind} {' '.join(names)} {pace} {zone}{options}"

    def _event(self, event: Event) -> str:
        if event.anchor is not EventAnchor.END or (event.distance and event.time):
            raise InputError("TP counts times or distances on the way from the end of a move")
        if event.distance:
            return f" DB {amount(1000 * event.distance)}mm,{event.text}"
        return f" {'TB' if event.time >= 0 else 'TA'} {amount(abs(event.time))}sec,{event.text}"

    def _number(
        self, numbering: Numbering[Pose], word: str, pose: Pose, name: str, none: bool
    ) -> int:
        """The number of a frame or tool; a new one is set before the first move."""
        if none or pose == Pose():
            return 0
        new = pose not in numbering.numbers
        found = numbering.of(pose, name)
        if new:
            index = len(self.positions) + 1
            self.positions.append(position(index, PoseTarget(pose), ("F", "F")))
            self.setup += [f"  PR[{_SCRATCH}]=P[{index}]", f"  {word}[{found}]=PR[{_SCRATCH}]"]
        return found


def remark(kept: str) -> Iterator[str]:
    """Lines of comment."""
    text = " ".join(kept.removeprefix(TP.comment).replace(";", ",").split())
    for at in range(0, len(text), _REMARK):
        yield f"!{text[at : at + _REMARK]}"


def program_name(name: str) -> str:
    """A name that TP takes: 36 letters, digits and ``_`` at most."""
    name = re.sub(r"\W+", "_", name, flags=re.ASCII).upper()[:36]
    return name if name[:1].isalpha() else f"P_{name}"[:36]
