"""Motions of the usual form: a language names the parts, and gets moves of them.

Tools and frames that have numbers stand in registers (`FrameRegisters`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any, ClassVar

from ...dialect import Dialect, MoveWords
from ...errors import InputError
from ...program.arc_orientation import ArcOrientation
from ...program.event import Event
from ...program.move import Move
from ...program.target import PoseTarget, Target
from ...program.zone import FINE, Zone
from ...spatial.pose import IDENTITY, Pose
from ..patch.uses import UseKind
from .amounts import Amount, overridden
from .expressions import Datum, Expression, Number, Operation, parse_all
from .forms import FormGrammar, Found
from .motions import MotionWords
from .moves import ArcPoints, made_move, said_beside, said_otherwise
from .positions import FrameRegisters, Place, Placed, PositionForm
from .program import Initial, Said, several
from .statements import (
    AssignAll,
    Drive,
    Label,
    Line,
    NumberedPoint,
    Numbers,
    Operand,
    Situation,
    Statement,
)

_SHARE = "acceleration_override"


Moved = Callable[[Placed, Situation], Placed]
"""What an option of a motion makes of where it goes."""


def approached(distance: Expression, unit: float = 1e-3) -> Moved:
    """Back against the tool's z from where a motion goes (``APPRO p1, 50``).

    Args:
        distance: in the unit of the text.
        unit: m of one of it.
    """

    def moved(placed: Placed, now: Situation) -> Placed:
        now.computed("target")
        return replace(placed, target=_back(placed.target, unit * now.number(distance)))

    return moved


def _back(target: Target, distance: float) -> Target:
    """A pose, ``distance`` m against its own z.

    Raises:
        InputError: it is none.
    """
    if not isinstance(target, PoseTarget):
        raise InputError("joint values have no z to stand back along: give the position as a pose")
    return replace(target, pose=target.pose @ Pose((0.0, 0.0, -distance)), name=None)


def _there(placed: Placed, now: Situation) -> Placed:
    return placed


class MotionGrammar(FormGrammar):
    """A grammar whose motions and points are data, too.

    The form ``motion`` has the groups ``kind`` and ``point``, and of these those that the language
    has: ``via``, the auxiliary point of an arc; ``pace``, the words of a speed, in it its ``speed``
    and ``unit``, and ``share``, one of acceleration in %; ``zone``, the words of a zone, in it its
    ``word``, ``size`` and ``behind``; ``tool`` and ``frame``, the numbers of those that it names;
    ``step``, its own number, where jumps lead. What settings set needs no group, and counts where
    a motion says nothing of it itself; ``flying`` has the word by which it says whether a zone that
    they set counts, or nothing. The form ``point`` has ``name``, ``values`` and ``kind``; the form
    ``framed``, of a tool or frame that is set, ``word`` and ``place`` or ``values``. An arc's
    auxiliary point that stands on a line of its own is the form ``via``, with ``point``.
    ``approach`` and ``depart`` are motions that end a ``distance`` against the tool's z from their
    ``point``, and from where the robot stands.

    Attributes:
        form: of positions.
        words: of speeds and zones that motions state; None where settings say all.
        kinds: ``J``, ``L`` or ``C`` by the ``kind`` of a motion, the one that is written first; of
            others it is the last letter.
        chained: kinds of arcs that have one point a line, the first of which is where they begin
            (`ArcPoints`).
        paired: kinds of arcs of two lines: the first is what they go through, the second their end.
        joints: kinds of points that are joint values.
        inline: a position at the motion itself, with the groups ``kind`` and ``values``.
        written_inline: how such a pose, and such joint values, are written, of their ``numbers``:
            ``TRANS({numbers})``; ``""`` for neither. Patches put them in.
        count: numbers of a position.
        current: what stands for the numbers of where the running robot is, in capitals.
        override: word of the register that holds the override of speeds in %, of motions and of
            settings.
        frames: tools and frames.
        unit: m of one of the distances of ``approach`` and ``depart``.
    """

    form: PositionForm
    words: MotionWords | None = None
    kinds: ClassVar[Mapping[str, str]] = {}
    chained: frozenset[str] = frozenset()
    paired: frozenset[str] = frozenset()
    joints: frozenset[str] = frozenset()
    inline: re.Pattern[str] = re.compile(r"(?!)(?P<kind>)(?P<values>)")
    written_inline: tuple[str, str] = ("", "")
    count: int = 6
    current: frozenset[str] = frozenset()
    override: str = ""
    frames: FrameRegisters | None = None
    helpers: ClassVar[frozenset[str]] = FormGrammar.helpers | {
        "placed",
        "place",
        "kind_of",
        "drive",
    }
    unit: float = 1e-3

    @classmethod
    def amounts(cls) -> Iterator[Amount]:
        """What the numbers of its speeds are."""
        if cls.words is not None:
            yield from (*cls.words.joint.values(), *cls.words.line.values())
        for one in cls.settings:
            yield from (*one.joint.values(), *one.line.values(), *one.more)

    def __init__(self) -> None:
        super().__init__()
        self._arc = ArcPoints()
        self._kinds = {word.upper(): letter for word, letter in self.kinds.items()}
        self._via: tuple[Line, Operand] | None = None
        self._beside: dict[str, str] = {}  # of the line of an arc's auxiliary point
        if (held := self.frames) is not None:
            none = Numbers.of(self.form.numbers(IDENTITY))
            words = [word.upper() for word in (held.tool, held.frame) if word]
            first: Initial = {(word, None): none for word in words}
            first = {(word.upper(), None): 0.0 for word in held.chosen} if held.numbered else first
            self.vectors = {**self.vectors, **dict.fromkeys(words, len(none))}
            self.initial = {**first, **self.initial}

    # ------------------------------------------------------- what a language may say otherwise

    def placed(self, numbers: Numbers, now: Situation) -> Placed:
        """Where the numbers of a point are; `numbers.kind` is that of the point."""
        kind = numbers.kind
        place = kind if isinstance(kind, Place) else Place(kind in self.joints)
        goal = self.form.target(numbers[: self.count], place.joints, place.configuration)
        frames = self.frames
        return Placed(goal, *(() if frames is None else frames.both(self.form, place, now)))

    def kind_of(self, found: Found) -> object:
        """What a point is beside its numbers: its ``kind``; where tools and frames have numbers, a
        `Place` with those of ``tool`` and ``frame``, as far as it names them."""
        given = found.groupdict()
        kind = (given.get("kind") or "").upper() or None
        if self.frames is None or not self.frames.numbered:
            return kind
        tool, frame = (given.get(one) or "" for one in ("tool", "frame"))
        numbers = (int(one) if one.isdecimal() else None for one in (tool, frame))
        return Place(kind in self.joints, next(numbers), next(numbers))

    # --------------------------------------------------------------------------- its forms

    def framed(self, line: Line, found: Found) -> Said:
        """A tool or frame ``word``, else the tool, becomes a ``place``, ``values``, or none."""
        given, tool = found.groupdict(), self.frames.tool if self.frames is not None else ""
        datum = Datum(line.span, (given.get("word") or tool).upper(), None)
        if given.get("place"):
            place = self.place(line, found, "place")
        elif given.get("values"):
            place = self._at(line, found)
        else:
            zero = (Number(line.span, one) for one in self.form.numbers(IDENTITY))
            place = Operand(line.span, tuple(zero))
        return AssignAll(line.span, datum, ((1.0, place),))

    def assigned(self, line: Line, found: Found) -> Statement:
        """A ``target`` becomes a ``value``; all numbers of one that has several become ``values``
        (and their ``kind``), or what a position at the motion itself would be, or those of data,
        their sums and differences."""
        target, value = self.datum(line, found, "target"), found.groupdict().get("value") or ""
        if target.word not in self.vectors or target.element is not None:
            return super().assigned(line, found)
        if value.strip().upper() in self.current:
            return AssignAll(line.span, target, (), "where the running robot is")
        if found.groupdict().get("values"):
            return AssignAll(line.span, target, ((1.0, self._at(line, found)),))
        if self._inline(line, found, "value") is not None:
            return AssignAll(line.span, target, ((1.0, self.place(line, found, "value")),))
        return AssignAll(line.span, target, tuple(_terms(self.parse(line, found, "value"))))

    def point(self, line: Line, found: Found) -> NumberedPoint:
        """A point's ``name`` and ``values``."""
        name, numbers = self.datum(line, found, "name"), self._values(line, found)
        return NumberedPoint(line.span, name, numbers, self.kind_of(found))

    def ended(self) -> None:
        """See `Grammar`: an arc has an end."""
        if self._via is not None:
            raise InputError("an arc has no end: only what it goes through is stated")
        self._arc.end("")

    def motion(self, line: Line, found: Found) -> Said:
        """A motion, of those on one line each, at its ``step``; see `drive`."""
        step = found.groupdict().get("step")
        labels = (Label(line.span, step.upper()),) if step else ()
        return (*labels, *several(self.drive(line, found)))

    def via(self, line: Line, found: Found) -> Said:
        """The ``point`` that the arc on the next line goes through."""
        self._via = line, self.place(line, found, "point")
        self._beside = said_beside(found)
        return None

    def approach(self, line: Line, found: Found) -> Said:
        """A motion to a ``distance`` before its ``point``."""
        return self.drive(line, found, approached(self.parse(line, found, "distance"), self.unit))

    def depart(self, line: Line, found: Found) -> Said:
        """A motion back by a ``distance`` from where the robot stands."""
        distance = Operand(line.span, (self.parse(line, found, "distance"),))
        return self.drive(line, found, back=distance)

    def drive(
        self,
        line: Line,
        found: Found,
        moved: Moved = _there,
        events: tuple[Event, ...] = (),
        via: Operand | None = None,
        back: Operand | None = None,
    ) -> Drive | None:
        """The motion of a line; None where an arc's other points are still to come.

        Args:
            moved: what its options make of where it goes.
            events: on its way.
            via: the auxiliary point of an arc, where another line states it.
            back: by how much it goes back from where the robot stands, in place of a point.
        """
        said = found["kind"].upper()
        point = self.place(line, found, "point") if back is None else back
        kind = self._kinds.get(said, said[-1])
        given, beside = found.groupdict(), said_beside(found)
        if said in self.paired and self._via is None and via is None:
            self._via, self._beside = (line, point), beside
            return None
        via = self.place(line, found, "via") if given.get("via") else via
        if self._via is not None:
            (first, via), self._via = self._via, None
            line = replace(line, start=first.start)
        fixed = moved is _there and point.point is not None and not self.holds(point.point.word)
        called = found["point"] if fixed else ""
        if said in self.chained:
            kind, via = self._arc.add(point, called)
        else:
            self._arc.end(called)
            if kind not in ("J", "L", "C"):
                raise InputError(f"{said} is no kind of motion that `kinds` has")
            if (kind == "C") != (via is not None):
                raise InputError("an arc has two points, other motions have one")
        before, self._beside = self._beside, {} if kind else beside
        if not kind:
            return None
        other = said_otherwise(before, beside) if kind == "C" else ""
        held = self._held(found)
        unit = given.get("unit") or ""
        speed = self._stated(line, found, UseKind.SPEED, "pace", "speed", "share")
        zone = self._stated(line, found, UseKind.ZONE, "zone", "size", "behind")

        def build(
            target: Numbers, paces: Numbers, sizes: Numbers, through: Numbers, now: Situation
        ) -> Move:
            if back is not None:
                goal = self._gone(target, now)
            else:
                goal = moved(self._with(self.placed(target, now), held, now), now)
            if other:
                now.note(other)
            middle = self.placed(through, now).target if kind == "C" else None
            settings, joint = self.settings, kind == "J"
            if self.words is None or not self._says(found, UseKind.SPEED):
                pace = settings.speed(paces, joint)
            else:
                told = unit if beside["speed"] else None
                pace = self.words.speed_of(kind, told, paces, bool(beside["share"]))
            if self.override:
                pace = overridden(pace, now.setting(self.override, 100.0) / 100, joint)
            if settings.flying and not found["flying"]:
                near: Zone = FINE
            elif self.words is None or not self._says(found, UseKind.ZONE):
                near = settings.zone_of(sizes, joint)
            else:
                near = self.words.zone_of(beside["word"] or None, sizes)
            return made_move(
                kind, goal.target, pace, near, goal.tool, goal.work_object, middle, events
            )

        return Drive(line.span, point, speed, zone, build, via)

    def _held(self, found: Found) -> Place | None:
        """The tool and the frame that a motion itself names; None where that is not numbers."""
        given = found.groupdict()
        place = self.kind_of(found) if given.get("tool") or given.get("frame") else None
        return place if isinstance(place, Place) else None

    def _with(self, placed: Placed, held: Place | None, now: Situation) -> Placed:
        """With the tool and the frame that a motion names, in place of those of its point."""
        if held is None or self.frames is None:
            return placed
        tool, frame = self.frames.both(self.form, held, now)
        return replace(
            placed,
            tool=placed.tool if held.tool is None else tool,
            work_object=placed.work_object if held.frame is None else frame,
        )

    def _gone(self, distance: Numbers, now: Situation) -> Placed:
        """A distance back from where the robot stands."""
        now.computed("target")
        if now.before is None or not isinstance(now.before.target, PoseTarget):
            raise InputError("where the robot stands is no pose that the text states")
        goal = _back(now.before.target, self.unit * distance[0])
        return Placed(goal, now.before.tool, now.before.work_object)

    def place(self, line: Line, found: Found, group: str) -> Operand:
        """The position in a group, by name or by its numbers."""
        own = self._inline(line, found, group)
        return self.point_at(line, found, group) if own is None else self._at(line, own)

    def _inline(self, line: Line, found: Found, group: str) -> Found | None:
        """The position that stands in a group by its numbers, if one does."""
        text, (start, end) = found[group], found.span(group)
        start += len(text) - len(text.lstrip())
        return self.inline.fullmatch(line.source.text, start, end - len(text) + len(text.rstrip()))

    def _at(self, line: Line, found: Found) -> Operand:
        """The position of the numbers in ``values``."""
        span = line.source.span(*found.span())
        return Operand(span, self._values(line, found), kind=self.kind_of(found))

    def _values(self, line: Line, found: Found) -> tuple[Expression, ...]:
        numbers = parse_all(line.source, *found.span("values"), self.spelling)
        if len(numbers) != self.count:
            raise InputError(f"a position has {self.count} numbers, not {len(numbers)}")
        return numbers

    def _stated(self, line: Line, found: Found, kind: UseKind, *groups: str) -> Operand:
        if kind is UseKind.ZONE and self.settings.flying:
            told = found["flying"] is not None
            span = line.source.span(*found.span("flying")) if told else line.span
            return self.settings.operand(span, kind) if found["flying"] else Operand(span)
        if not self._says(found, kind):
            return self.settings.operand(line.span, kind)
        known = [group for group in groups if group in found.re.groupindex]
        if not known:  # no motion says anything of it
            return Operand(line.span)
        whole, *numbers = known
        alone = [] if kind is UseKind.ZONE and "word" in found.re.groupindex else [whole]
        given = (group for group in numbers or alone if found[group])
        span = line.source.span(*found.span(whole)) if found[whole] else line.span
        return Operand(span, tuple(self.parse(line, found, group) for group in given))

    def _says(self, found: Found, kind: UseKind) -> bool:
        """Whether a motion states its speed, or zone, itself."""
        group = "speed" if kind is UseKind.SPEED else "zone"
        held = self.settings.sets(kind) and not found.groupdict().get(group)
        return self.words is not None and not held


def _terms(value: Expression, sign: float = 1.0) -> Iterator[tuple[float, Operand]]:
    """The data of a sum, each with its sign."""
    if isinstance(value, Datum):
        yield sign, Operand(value.span, point=value)
    elif isinstance(value, Operation) and value.word in "+-":
        *first, last = value.operands
        for one in first:
            yield from _terms(one, sign)
        yield from _terms(last, -sign if value.word == "-" else sign)
    else:
        raise InputError("positions and registers of several numbers should stand here")


def dialect_of(
    grammar: type[MotionGrammar], comment: str, *, configurations: bool = False, **others: Any
) -> Dialect:
    """What a language has words for, by what its motions and settings say.

    Joint moves must state what paces them, lines and arcs their speed if there is one number alone
    that says it, beside accelerations. Arcs turn the tool evenly; there are no loads, stationary
    tools and external axes.

    Args:
        comment: what a line of comment begins with.
        configurations: whether a target's configuration counts.
        others: see `core.dialect.Dialect`; they go before what is derived.
    """
    pace = others.get("pace", "joint_fraction")
    line = _move_words(grammar, False, configurations)
    joint = _move_words(grammar, True, configurations)
    made: dict[str, Any] = {
        "joint": replace(joint, needs=frozenset({pace})),
        "line": line,
        "arc": line,
        "pace": pace,
        "arc_orientations": frozenset({ArcOrientation.FIXED_FRAME}),
        "loads": False,
        "stationary_tools": False,
        "external_axes": False,
        "orientation": grammar.form.orientation,
        "in_si": grammar.form.in_si,
    }
    return Dialect(comment=comment, **{**made, **others})


def _move_words(grammar: type[MotionGrammar], joint: bool, configurations: bool) -> MoveWords:
    words, settings = grammar.words, grammar.settings
    stated: set[str] = set()
    if words is not None:
        stated = {one.name for one in (words.joint if joint else words.line).values()}
    held = settings.speeds(joint)
    speeds = (stated | held) - {_SHARE}
    paces = {name for name in speeds if "acceleration" not in name and "jerk" not in name}
    shared = {_SHARE} if _SHARE in held or (words is not None and words.share) else set()
    zones = (*(words.zones.values() if words is not None else ()), *settings.zones)
    return MoveWords(
        zones,
        frozenset(speeds | shared),
        frozenset(paces) if len(paces) == 1 else frozenset(),
        configurations=configurations,
        exclusive=frozenset(stated - {_SHARE}),
    )
