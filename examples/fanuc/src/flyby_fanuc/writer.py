"""Program → a TP program as text."""

from __future__ import annotations

from collections.abc import Iterator

from flyby.core.program.event import Event
from flyby.core.program.move import Move
from flyby.core.program.target import JointTarget, PoseTarget, Target
from flyby.core.source.lines.language import LineWriter
from flyby.core.source.text.numerals import nine_decimals
from flyby.core.spatial.pose import Pose

from .words import LETTERS, XYZ

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


def _number(value: float) -> str:
    """Three decimals as controllers write them, more where these do not say it."""
    text = f"{round(value, 3) + 0.0:.3f}"  # never "-0.000"
    return text if abs(float(text) - value) < 1e-9 else nine_decimals(value)


class Writer(LineWriter):
    """Writes one program.

    Args:
        before, after: lines of their own.
    """

    pause = "  WAIT {time}(sec)"

    def __init__(self, before: tuple[str, ...] = (), after: tuple[str, ...] = ()) -> None:
        super().__init__()
        self._before, self._after = before, after

    def text(self, name: str, lines: list[str]) -> str:
        """The whole file."""
        return whole(name, [*self._before, *self.setup, *lines, *self._after], self.points.texts)

    def move(self, move: Move) -> Iterator[str]:
        """A motion instruction, and the frames that it is in."""
        frame = self._frame("UFRAME", 9, move.work_object.pose, move.work_object.name)
        tool = self._frame("UTOOL", 10, move.tool.tcp, move.tool.name)
        yield from self.changed("frames", f"  UFRAME_NUM={frame}", f"  UTOOL_NUM={tool}")
        yield self.motion(move, str(frame), str(tool)) + "".join(map(_event, move.events))

    def _frame(self, word: str, most: int, pose: Pose, name: str) -> int:
        def declared(number: int) -> tuple[str, str]:
            index = self.points.of(PoseTarget(pose), "F", "F")
            return f"  PR[{_SCRATCH}]=P[{index}]", f"  {word}[{number}]=PR[{_SCRATCH}]"

        return self.numbered(word, most, pose, name, declared)

    def point(self, number: int, target: Target, *beside: str) -> str:
        """The text of a position in its frame and tool."""
        frame, tool = beside
        values = [_number(v) for v in XYZ.numbers(target)]
        head = f"P[{number}]{{\n   GP1:\n\tUF : {frame}, UT : {tool},"
        if isinstance(target, JointTarget):
            axes = [f"\tJ{k + 1}= {v:>9} deg" for k, v in enumerate(values)]
        else:
            label = LETTERS.written(target.configuration)
            head += f"\t\tCONFIG : '{label}'," if label else ""
            units = ["mm"] * 3 + ["deg"] * 3
            axes = [f"\t{a} = {v:>9}  {u}" for a, v, u in zip("XYZWPR", values, units, strict=True)]
        return f"{head}\n{','.join(axes[:3])},\n{','.join(axes[3:])}\n}};\n"


def _event(event: Event) -> str:
    if event.distance:
        return f" DB {nine_decimals(1000 * event.distance)}mm,{event.text}"
    when = "TB" if event.time >= 0 else "TA"
    return f" {when} {nine_decimals(abs(event.time))}sec,{event.text}"
