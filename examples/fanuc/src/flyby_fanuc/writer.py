"""Program → a TP program as text."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from flyby.core.errors import InputError
from flyby.core.program.event import Event
from flyby.core.program.move import Move, Wait
from flyby.core.program.target import JointTarget, PoseTarget, Target
from flyby.core.source.lines.moves import said
from flyby.core.source.lines.postures import PostureLabel
from flyby.core.source.text.numerals import nine_decimals
from flyby.core.source.write.numbering import Numbering, PointNumbers
from flyby.core.spatial.pose import Pose

from .words import MOTION, XYZ

_HEAD = """\
/PROG  {name}
/ATTR
OWNER\t\t= MNEDITOR;
COMMENT\t\t= "by flyby";
DEFAULT_GROUP\t= 1,*,*,*,*;
CONTROL_CODE\t= 00000000 00000000;
/MN
"""
_SCRATCH = 100
"""The position register that frames go through."""


def whole(name: str, lines: list[str], positions: list[str]) -> str:
    """A file of its lines and positions."""
    numbered = "".join(f"{k:>4}:{line} ;\n" for k, line in enumerate(lines, 1))
    return f"{_HEAD.format(name=name)}{numbered}/POS\n{''.join(positions)}/END\n"


def program_name(name: str) -> str:
    """A name that TP takes: 36 letters, digits and ``_`` at most."""
    name = re.sub(r"\W+", "_", name, flags=re.ASCII).upper()[:36]
    return name if name[:1].isalpha() else f"P_{name}"[:36]


def _number(value: float) -> str:
    """Three decimals as controllers write them, more where these do not say it."""
    text = f"{round(value, 3) + 0.0:.3f}"  # never "-0.000"
    return text if abs(float(text) - value) < 1e-9 else nine_decimals(value)


def _position(index: int, target: Target, frame: str, tool: str) -> str:
    """The text of a position."""
    values = [_number(v) for v in XYZ.numbers(target)]
    head = f"P[{index}]{{\n   GP1:\n\tUF : {frame}, UT : {tool},"
    if isinstance(target, JointTarget):
        axes = [f"\tJ{k + 1}= {v:>9} deg" for k, v in enumerate(values)]
    else:
        label = target.configuration
        if label is not None and not isinstance(label, PostureLabel):
            raise InputError(f"{label} is no CONFIG: label the target's solution for this robot")
        head += f"\t\tCONFIG : '{label}'," if label is not None else ""
        units = ["mm"] * 3 + ["deg"] * 3
        axes = [f"\t{a} = {v:>9}  {u}" for a, v, u in zip("XYZWPR", values, units, strict=True)]
    return f"{head}\n{','.join(axes[:3])},\n{','.join(axes[3:])}\n}};\n"


@dataclass
class Writer:
    """Writes one program.

    Args:
        before, after: lines of their own.
    """

    before: tuple[str, ...] = ()
    after: tuple[str, ...] = ()
    _positions: PointNumbers = field(default_factory=lambda: PointNumbers(_position))
    _setup: list[str] = field(default_factory=list)
    _tools: Numbering[Pose] = field(default_factory=lambda: Numbering("tools", 10))
    _frames: Numbering[Pose] = field(default_factory=lambda: Numbering("frames", 9))
    _in: tuple[int, int] | None = None

    def text(self, name: str, lines: list[str]) -> str:
        """The whole file."""
        body = [*self.before, *self._setup, *lines, *self.after]
        return whole(name, body, self._positions.texts)

    def wait(self, wait: Wait) -> str:
        """A wait."""
        return f"  WAIT {nine_decimals(wait.duration)}(sec)"

    def move(self, move: Move) -> Iterator[str]:
        """A motion instruction, and the frames that it is in."""
        frame = self._number("UFRAME", self._frames, move.work_object.pose, move.work_object.name)
        tool = self._number("UTOOL", self._tools, move.tool.tcp, move.tool.name)
        if self._in != (frame, tool):
            self._in = frame, tool
            yield f"  UFRAME_NUM={frame}"
            yield f"  UTOOL_NUM={tool}"
        _, goals = said(move)
        points = (f"P[{self._positions.of(g, str(frame), str(tool))}]" for g in goals)
        yield MOTION.text(move, *points) + "".join(map(_event, move.events))

    def _number(self, word: str, numbering: Numbering[Pose], pose: Pose, name: str) -> int:
        """The number of a frame or tool; a new one is set before the first move."""
        if pose == Pose():
            return 0
        new = pose not in numbering.numbers
        found = numbering.of(pose, name)
        if new:
            index = self._positions.of(PoseTarget(pose), "F", "F")
            self._setup += [f"  PR[{_SCRATCH}]=P[{index}]", f"  {word}[{found}]=PR[{_SCRATCH}]"]
        return found


def _event(event: Event) -> str:
    if event.distance:
        return f" DB {nine_decimals(1000 * event.distance)}mm,{event.text}"
    when = "TB" if event.time >= 0 else "TA"
    return f" {when} {nine_decimals(abs(event.time))}sec,{event.text}"
