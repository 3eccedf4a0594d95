"""What a vendor's language has words for: data for translations and checks.

A writer refuses what its language cannot say. A translation asks here first, says it in the
language's own terms, and lists what has no counterpart. A check searches texts by the `Wording`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from enum import StrEnum
from typing import TYPE_CHECKING

from .errors import InputError
from .program.arc_orientation import ArcOrientation
from .program.speed import Speed
from .program.zone import Radius, Zone, ZoneKind

if TYPE_CHECKING:
    from .errors import Note
    from .program.event import Event
    from .program.move import Move
    from .program.signal import Meet, SignalAction
    from .program.world_zone import WorldZone
    from .robot.model import Robot
    from .source.text.files import SourceFile

_VISIBLE = re.compile(r"[^\r\n]")
_GIVEN = re.compile(r"\s*(?:,[^\]\r\n]*)?\]?\s*:?=(?!=)")
_BEGINS = re.compile(r"(?:^|[:;])[^\S\r\n]*\Z")
_LISTED = re.compile(r"(?:\[[^\]]*\]|\{[^}]*\}|[^,\[{])+")
"""One of several names: the commas of its indices part none."""
PACES = ("tcp", "joint_fraction", "joint")
_SPEED_FIELDS = frozenset(field.name for field in fields(Speed)) - {"name"}


class Orientation(StrEnum):
    """The form in which a language says rotations."""

    QUATERNION = "quaternion"
    """Four numbers, rounded to what a controller resolves."""
    EULER_ZYX = "euler zyx"
    """Angles about z, then the new y, then the new x."""
    EULER_ZYZ = "euler zyz"
    """Angles about z, then the new y, then the new z."""
    ROTATION_VECTOR = "rotation vector"
    """Axis times angle."""


@dataclass(frozen=True)
class MoveWords:
    """What can be said of one kind of move.

    Args:
        zones: kinds of zone beside stops, the preferred one first; of zones that only this make
            has, their `ZoneKind`.
        speeds: the numbers of `Speed` that there are words for.
        needs: those of ``speeds`` that must be stated, since the language's own default would be
            taken instead.
        configurations: whether a target's configuration counts.
        exclusive: those of ``speeds`` of which a move states one alone: mm/s, degrees/s or s.

    Raises:
        InputError: a name is no number of `Speed`, or something is needed that cannot be said.
    """

    zones: tuple[type[Zone] | ZoneKind, ...]
    speeds: frozenset[str]
    needs: frozenset[str] = frozenset()
    configurations: bool = True
    exclusive: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        unknown = sorted(self.speeds - _SPEED_FIELDS)
        if unknown:
            raise InputError(f"MoveWords.speeds: Speed has no {unknown[0]!r}")
        unsaid = sorted((self.needs | self.exclusive) - self.speeds)
        if unsaid:
            raise InputError(
                f"MoveWords.needs and exclusive: {unsaid[0]!r} is not among the speeds"
            )


@dataclass(frozen=True)
class ArcRules:
    """Arcs that the language's controllers drive.

    Args:
        longest: rad of an arc.
        least_chord: m from the start to the auxiliary point, and to the end.
        least_angle: rad between the two, seen from the start, below which it is no arc.
        name: of the instruction, for messages.
    """

    longest: float = 2 * math.pi
    least_chord: float = 0.0
    least_angle: float = 0.0
    name: str = "the arc"


@dataclass(frozen=True)
class OutputWords:
    """How an event on the way of a move (`core.program.event.Event`) sets an output.

    Args:
        switch: text of the action that turns a digital output, by its name, on or off.
        level: text of the action that sets an analogue output, by its name, to a value.
        longest_lead: s that an event's time may be at most.
        from_start: whether distances may count from a move's start.
        at_start: whether times may.
        along_joint: whether places on the way of joint moves may have distances.
        both: whether a place may have a distance and a time.
        most: events that one move may have.
    """

    switch: Callable[[str, bool], str]
    level: Callable[[str, float], str]
    longest_lead: float
    from_start: bool = True
    at_start: bool = True
    along_joint: bool = True
    both: bool = True
    most: float = math.inf

    def takes(self, event: Event, move: Move) -> bool:
        """Whether an event has a place that there are words for."""
        from .program.event import EventAnchor
        from .program.move import MoveJ

        if abs(event.time) > self.longest_lead:
            return False
        if event.distance == 0:
            return self.at_start or event.anchor is EventAnchor.END
        if event.time != 0 and not self.both:
            return False
        here = self.from_start or event.anchor is EventAnchor.END
        return here and (self.along_joint or not isinstance(move, MoveJ))


def _as_it_is(text: str) -> str:
    return text


def _no_meeting(text: str) -> Meet | None:
    return None


ZonesOf = Callable[
    ["Mapping[str, SourceFile]", "Robot"], "tuple[tuple[WorldZone, ...], tuple[Note, ...]]"
]


@dataclass(frozen=True)
class SignalWords:
    """How a language sets outputs and waits for signals, in statements of their own.

    Args:
        read: what a statement does with signals; None if that is not known, or nothing.
        said: the statement of an action; None if there is none, as to set an input.
        spelt: a signal as the language spells it; None for what is no name of one.
        example: what a signal of such an action is called, with ``?`` for what the user fills in.
        event: the statement that the text of an event on the way is short for.
        stops: whether the robot stops where an output is set.
        meets: what a statement waits for of other robots' programs; None for nothing. An
            `InputError` says that it couples robots in a way that is not followed.
        zones: world zones that the files of a program have the controller watch for a robot, and
            what is said of those that cannot be followed; None where a language has none.
        together: the id of a move, by its statement, that other robots make with it; None where a
            language has none, and one motion alone is made together behind a meeting.
    """

    read: Callable[[str], SignalAction | None]
    said: Callable[[SignalAction], str | None]
    spelt: Callable[[str], str | None]
    example: Callable[[SignalAction], str]
    event: Callable[[str], str] = _as_it_is
    stops: bool = False
    meets: Callable[[str], Meet | None] = _no_meeting
    together: Callable[[str], str | None] | None = None
    zones: ZonesOf | None = None


@dataclass(frozen=True)
class Pitfall:
    """Words that do not do what they seem to: a zone is asked for, and something switches it off.

    Args:
        words: what stands in the text.
        message: what is so; ``{words}`` stands for the words that were found.
        fix: what to do about it.
        beside: what else must stand somewhere in the files that are driven; None for nothing.
        without: what must stand nowhere in them; None for nothing.
    """

    words: re.Pattern[str]
    message: str
    fix: str
    beside: re.Pattern[str] | None = None
    without: re.Pattern[str] | None = None


@dataclass(frozen=True, slots=True)
class RoutineText:
    """A routine in a text.

    Args:
        name: its name.
        parameters: what stands between the brackets behind it.
        start, body, end: offsets of the whole of it, and of what follows its heading.
    """

    name: str
    parameters: str
    start: int
    body: int
    end: int


@dataclass(frozen=True, slots=True)
class Unsaid:
    """A datum that an instruction depends on, or sets, without naming it.

    Args:
        datum: its name.
        start, end: offsets of the instruction.
        given: whether the instruction sets it.
        source: name of the datum that it is set from; None for the instruction's own operands.
        certain: whether it is set in any case.
    """

    datum: str
    start: int
    end: int
    given: bool = False
    source: str | None = None
    certain: bool = True


class Mention(StrEnum):
    """What a text does with a name."""

    USED = "used"
    DECLARED = "declared"
    """It is given to a datum, routine, parameter or type."""
    ASSIGNED = "assigned"
    """The datum is given a value."""


def _no_routines(_: str) -> Iterator[RoutineText]:
    return iter(())


def _nothing_unsaid(_: str) -> Iterator[Unsaid]:
    return iter(())


def _file_alone(file: str) -> str:
    return file


@dataclass(frozen=True)
class Wording:
    """How a language's text is searched without being read.

    Args:
        silent: comments and strings.
        targets: the declaration of a target; its group ``names`` holds the name, or several with
            commas between them.
        name: any name.
        same_case: whether upper and lower case are the same.
        pitfalls: words that do not do what they seem to.
        heads: of a statement that holds others, what is executed of it itself; it is matched where
            the statement begins. None if such statements stand on lines of their own.
        routines: finds the routines of a text: what is declared in one is seen in it alone.
        module: names the module of a file: what is declared outside of routines is seen in all
            files of one module, before what others declare.
        named: tells of a text without comments and strings what it does with names, in order; names
            of components and arguments are left out. None where only targets are declared, and
            what a sign ``=`` follows at a statement's beginning is given a value.
        unsaid: finds the data that instructions depend on and set without naming them, in a text
            without comments and strings: speeds and zones that hold until they are set again.
        blocks: words that ``open``, ``part`` and ``close`` a block, any ``label``, and what is
            executed on a condition, or for itself alone, but is no block (``once``): groups of
            these names. None if a datum's last setting is not looked for.
    """

    silent: re.Pattern[str]
    targets: re.Pattern[str]
    name: re.Pattern[str]
    same_case: bool = True
    pitfalls: tuple[Pitfall, ...] = ()
    heads: re.Pattern[str] | None = None
    routines: Callable[[str], Iterator[RoutineText]] = _no_routines
    module: Callable[[str], str] = _file_alone
    named: Callable[[str], Iterator[tuple[str, Mention]]] | None = None
    unsaid: Callable[[str], Iterator[Unsaid]] = _nothing_unsaid
    blocks: re.Pattern[str] | None = None

    def __post_init__(self) -> None:
        if "names" not in self.targets.groupindex:
            raise InputError("Wording.targets: the pattern needs a group called 'names'")

    def quiet(self, text: str) -> str:
        """A text with blanks for comments and strings."""
        return self.silent.sub(lambda found: _VISIBLE.sub(" ", found[0]), text)

    def declared(self, text: str) -> Iterator[tuple[str, int]]:
        """Name and offset of every target that a text declares."""
        for found in self.targets.finditer(text):
            for one in _LISTED.finditer(found["names"]):
                name = self.name.search(one[0])
                if name is not None:
                    yield name[0], found.start("names") + one.start() + name.start()

    def mentions(self, text: str) -> Iterator[tuple[str, Mention]]:
        """What a text, as `quiet` leaves it, does with names, in order."""
        if self.named is not None:
            yield from self.named(text)
            return
        declared = {at for _, at in self.declared(text)}
        for found in self.name.finditer(text):
            if found.start() in declared:
                yield found[0], Mention.DECLARED
                continue
            line = text[text.rfind("\n", 0, found.start()) + 1 : found.start()]
            begins = _BEGINS.search(line) and _GIVEN.match(text, found.end())
            yield found[0], Mention.ASSIGNED if begins else Mention.USED

    def folded(self, name: str) -> str:
        """A name as it is compared with others."""
        return name.lower() if self.same_case else name


@dataclass(frozen=True)
class Dialect:
    """What a language can say.

    Args:
        joint: of joint moves.
        line: of lines.
        arc: of arcs.
        pace: the number of `Speed` by which joint moves are driven faster or slower: ``tcp``,
            ``joint_fraction`` or ``joint``.
        comment: what a line of comment begins with.
        zone_parts: whether a zone may be larger for reorientation and external axes than for the
            TCP, and have an angle for pure turns.
        work_objects: whether targets are given in frames; without, they are given in the robot's
            base.
        user_frames: whether a work object has a user frame and an object frame in it.
        stationary_tools: whether the robot may carry the work object to a tool that stands still.
        external_axes: whether targets have external axes.
        tools: whether programs say what the TCP is; without, targets are the flange's.
        loads: whether programs say what tools and parts weigh.
        arc_orientations: how the tool may turn along arcs; empty if there are no arcs.
        orientation: the form in which it says rotations.
        in_si: whether lengths are said in m and angles in rad, not in mm and degrees.
        length_decimals, angle_decimals: decimals that controllers keep of them; None for as many
            as one likes.
        rigid_arcs: whether a tool that follows an arc keeps its orientation to the arc, whatever
            orientation the arc's end has.
        share_step: by what step shares of joint speed and acceleration are said.
        least_acceleration_share: the least share of acceleration that is taken.
        fastest: greatest speed of the TCP that is taken, m/s.
        most: greatest numbers of `Speed` that the maker takes, or lets its robots be driven with,
            by name, in SI units. Lines and arcs that must state an acceleration get no more than
            keeps the joints within that of joint moves.
        path_acceleration: m/s² of lines and arcs that may always be stated, the language's own
            default.
        zones: gives the zones that are known without a declaration, beside stops; called when
            they are needed.
        arcs: which arcs there are.
        wording: how its texts are searched; None if they are not.
        outputs: how outputs are set on the way of a move; None where there is nothing of the kind.
        signals: how outputs are set and signals are waited for; None if that is not known.
        structure: whether its writer takes the option ``structure`` (`StructureStyle`), and so
            writes loops and routines.
    """

    joint: MoveWords
    line: MoveWords
    arc: MoveWords
    pace: str
    comment: str
    zone_parts: bool = False
    work_objects: bool = True
    user_frames: bool = False
    stationary_tools: bool = True
    external_axes: bool = True
    tools: bool = True
    loads: bool = True
    arc_orientations: frozenset[ArcOrientation] = frozenset(ArcOrientation)
    orientation: Orientation = Orientation.QUATERNION
    in_si: bool = False
    length_decimals: int | None = None
    angle_decimals: int | None = None
    rigid_arcs: bool = False
    share_step: float = 0.01
    least_acceleration_share: float = 0.01
    fastest: float = 7.0
    most: Mapping[str, float] = field(default_factory=dict)
    path_acceleration: float = 1.2
    zones: Callable[[], tuple[Radius, ...]] = tuple
    arcs: ArcRules = ArcRules()
    wording: Wording | None = None
    outputs: OutputWords | None = None
    signals: SignalWords | None = None
    structure: bool = False

    def __post_init__(self) -> None:
        if self.pace not in PACES or self.pace not in self.joint.speeds:
            raise InputError(
                f"Dialect.pace is one of {', '.join(PACES)} and among the speeds of joint moves, "
                f"not {self.pace!r}"
            )
        unknown = sorted(self.most.keys() - _SPEED_FIELDS)
        if unknown:
            raise InputError(f"Dialect.most: Speed has no {unknown[0]!r}")

    def words(self, move: Move) -> MoveWords:
        """What can be said of moves of this kind."""
        from .program.move import MoveC, MoveJ

        if isinstance(move, MoveJ):
            return self.joint
        return self.arc if isinstance(move, MoveC) else self.line
