"""``$TOOL``, ``$BASE``, ``$LOAD`` and ``$IPO_MODE`` → tool, work object and load of a move.

With ``$IPO_MODE=#TCP`` the robot carries the work: ``$BASE`` is then the tool that stands still,
``$TOOL`` the frame of the work at the flange, and targets are the tool's pose in that frame.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace

from ....core.door import spelt
from ....core.errors import InputError, SourceError, Span
from ....core.files.toml_text import key_text
from ....core.program.question import QuestionKind
from ....core.program.tool import FLANGE, WORLD, Load, Tool, WorkObject
from ....core.source.execution.course import About, Course
from ....core.spatial.pose import IDENTITY, Pose
from ..values.expected import EXPECTED
from ..values.frames import null_frame, number_or_zero, pose_of
from ..values.scope import Variable
from ..values.types import FRAME_FIELDS
from ..values.values import (
    Choice,
    Pending,
    Placement,
    Struct,
    Unknown,
    find_unknown,
    left_open,
    supposed,
)

Note = Callable[[str, str, Span], None]


_DATUM = re.compile(r"[\w$]+(\[\d+\])?")
_UNSET = {
    "$tool": ("the flange is taken for the TCP", "BAS(#TOOL,1) or $TOOL=TOOL_DATA[1]"),
    "$base": ("the world is taken for the base", "BAS(#BASE,1) or $BASE=BASE_DATA[1]"),
}


class Placements:
    """Makes them of the system variables in force.

    Args:
        course: is asked for frames that no file says.
    """

    def __init__(self, system: Mapping[str, Variable], course: Course, note: Note) -> None:
        self._system = system
        self._course = course
        self._note = note
        self._made: Placement | None = None
        self._supposed = ""

    def changed(self) -> None:
        """A system variable has another value now."""
        self._made = None

    def remark_unset(self, span: Span) -> None:
        """Say what is taken for a tool or base that nobody has set: a pose is driven with them."""
        for name, (taken, remedy) in _UNSET.items():
            if not self._system[name].assigned:
                self._note(
                    f"{name} is set nowhere",
                    f"{name.upper()} is set nowhere before this motion: {taken}, where a "
                    f"controller keeps what was set last; set it, as by {remedy}",
                    span,
                )

    def current(self, span: Span) -> Placement:
        """What holds for a move at ``span``.

        Raises:
            SourceError: a frame is not known.
        """
        if self._made is None:
            self._supposed = ""
            self._made = replace(self._placement(span), supposed=self._supposed)
        return self._made

    def _placement(self, span: Span) -> Placement:
        tool, base = self._frame("$tool", span), self._frame("$base", span)
        load = self._load(span)
        mode = self._system["$ipo_mode"].value
        if not isinstance(mode, Choice) or mode.name not in ("base", "tcp"):
            raise SourceError("$IPO_MODE is neither #BASE nor #TCP", span)
        if mode.name == "base":
            held = Tool(_name(tool, FLANGE.name, "tool"), _pose(tool), load)
            standing = WorkObject(_name(base, WORLD.name, "base"), _pose(base))
            if base.moved_by is not None:
                standing = replace(standing, moved_by=base.moved_by)
            return Placement(held, standing, None)
        fixed = Tool(_name(base, FLANGE.name, "tool"), _pose(base), robot_held=False)
        name = _name(tool, WORLD.name, "base")
        carried = WorkObject(name, _pose(tool), robot_held=True)
        return Placement(fixed, carried, _seen_from(carried.user, load))

    def _frame(self, name: str, span: Span) -> Struct:
        cell = self._system[name]
        value = cell.value
        if cell.supposed:
            self._supposed = self._supposed or f"{name.upper()} depends on {cell.supposed}"
        unknown = None if value is None else find_unknown(value)
        if unknown is not None:
            assert value is not None and not isinstance(value, Pending)
            if unknown.damaged:
                raise left_open(name.upper(), unknown, span)
            self._supposed = self._supposed or f"{name.upper()} depends on {unknown.reason}"
            value = supposed(value)
            taken = isinstance(value, Struct) and find_unknown(value) is None
            self._note(
                f"{name} {unknown.reason}",
                f"{name.upper()} depends on {unknown.reason}, which the text does not say: "
                f"{'what it was before' if taken else 'a frame of zeros'} is taken; name the file "
                f"that says it, or {unknown.answerable}",
                span,
            )
            value = value if taken else null_frame(_datum(unknown.key))
        if not isinstance(value, Struct):
            raise SourceError(f"{name.upper()} is no frame", span)
        self._remark(name, value, span)
        return value

    def _remark(self, name: str, value: Struct, span: Span) -> None:
        missing = [f.upper() for f in FRAME_FIELDS if f not in value.fields]
        what = value.label or name.upper()
        if value.shipped or self._course.lasting(what) is not None:
            self._course.value(what, About(span, QuestionKind.DATUM, *EXPECTED["frame"]))
        if value.shipped:
            self._note(
                what,
                f"{what} is in no $config.dat at hand: a frame of zeros is assumed; answer it "
                f"({spelt('answers')}): [values] {key_text(what)} = …",
                span,
            )
        elif missing and not value.moved_by:
            self._note(what, f"{what} has no {', '.join(missing)}: 0 is assumed", span)

    def _load(self, span: Span) -> Load | None:
        value = self._system["$load"].value
        if isinstance(value, Unknown) and value.damaged:
            raise left_open("$LOAD", value, span)
        if not isinstance(value, Struct) or find_unknown(value) is not None:
            self._note("$LOAD", "$LOAD is not known: no load is assumed", span)
            return None
        mass = value.fields.get("m")
        if not isinstance(mass, int | float) or mass <= 0:
            return None
        frame, inertia = value.fields.get("cm"), value.fields.get("j")
        try:
            centre = pose_of(frame.fields) if isinstance(frame, Struct) else IDENTITY
            moments = inertia.fields if isinstance(inertia, Struct) else {}
            x, y, z = (number_or_zero(moments.get(axis)) for axis in "xyz")
            return Load(float(mass), centre.position, (x, y, z), centre.quaternion, value.label)
        except InputError as error:
            raise SourceError(f"$LOAD: {error}", span) from None


def _datum(key: str) -> str | None:
    """What a frame of zeros is taken for, if that is a datum: it is asked for by its name."""
    return key if _DATUM.fullmatch(key) else None


def _pose(frame: Struct) -> Pose:
    return pose_of(frame.fields)


def _name(frame: Struct, nothing: str, literal: str) -> str:
    """The datum that the frame was read from."""
    if frame.label is not None:
        return frame.label
    zero = all(number_or_zero(frame.fields.get(f)) == 0 for f in FRAME_FIELDS)
    return nothing if zero and frame.moved_by is None else literal


def _seen_from(frame: Pose, load: Load | None) -> Load | None:
    """A load of the flange in a frame at the flange."""
    if load is None:
        return None
    at = frame.inverse() @ Pose(load.centre, load.axes)
    return replace(load, centre=at.position, axes=at.quaternion)
