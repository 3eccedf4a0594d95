"""Programs of one statement a line: what the statements are, and lines put together to routines.

A language says what a line is (`Grammar`); the statements here are what it can say. A condition
before a statement makes it an `If` of that one statement; `blocks` makes one of the lines between
``IF`` and ``ENDIF``, and loops of those between ``FOR`` and ``ENDFOR``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

from ...errors import Span
from ...program.move import Move
from ...program.signal import SignalAction
from ..text import nodes
from ..text.files import SourceText
from .expressions import Datum, Expression


class Numbers(tuple[float, ...]):
    """The numbers of a part of a move.

    Attributes:
        kind: what the point that they are of is beside them (`NumberedPoint.kind`); of numbers that
            settings hold, the unit of each.
    """

    kind: Any = None

    @classmethod
    def of(cls, values: Iterable[float], kind: Any = None) -> Numbers:
        """Numbers with a kind."""
        made = cls(values)
        made.kind = kind
        return made


class Situation(Protocol):
    """What a move may depend on beside its own numbers."""

    @property
    def before(self) -> Move | None:
        """The move before, if that is known."""
        ...

    def number(self, datum: Expression) -> float:
        """What an expression is now.

        Raises:
            SourceError: it is not known.
        """
        ...

    def setting(self, word: str, default: float) -> float:
        """What the datum that there is once was set to.

        Raises:
            SourceError: it is not known.
        """
        ...

    def vector(self, word: str, number: int | None) -> Numbers:
        """The numbers of a datum that has several: those of ``PR[2]``; of one that there is once,
        its number is None.

        Raises:
            SourceError: they are not known.
        """
        ...

    def note(self, message: str) -> None:
        """Say something about this line to who reads the program, once for all its passes."""
        ...

    def computed(self, *parts: str) -> None:
        """These parts (``target``, ``speed``, ``zone``, ``via``) of the move are not what the text
        states: no number of it can be changed for them."""
        ...


@dataclass(frozen=True, slots=True)
class Line:
    """A line that is not blank.

    Args:
        source: the file.
        start, end: offsets of its first character that is no blank, and behind its last.
    """

    source: SourceText
    start: int
    end: int

    @property
    def text(self) -> str:
        """The line, without the blanks round it."""
        return self.source.text[self.start : self.end]

    @property
    def span(self) -> Span:
        """Where it stands."""
        return self.source.span(self.start, self.end)


@dataclass(frozen=True, slots=True)
class Operand:
    """A part of a move: a point, or numbers at the move or held by settings.

    Args:
        span: of it; of the whole move where that says nothing of it.
        numbers: one expression each; empty if it is a point. A datum stands for what it was set
            to: a register, a setting (`core.source.lines.settings`).
        point: the point.
        kind: of a position that is no point, what it is beside its numbers.
    """

    span: Span
    numbers: tuple[Expression, ...] = ()
    point: Datum | None = None
    kind: Any = None


Build = Callable[[Numbers, Numbers, Numbers, Numbers, Situation], Move]
"""A move of the numbers of its target, speed, zone and auxiliary point, and of what else is so."""


@dataclass(frozen=True, slots=True)
class Drive:
    """A move.

    Args:
        build: the move from the numbers of its target, speed, zone and auxiliary point, and from
            what else is so; of what it refuses (`InputError`) the line is named.
        via: the auxiliary point of an arc.
    """

    span: Span
    target: Operand
    speed: Operand
    zone: Operand
    build: Build
    via: Operand | None = None


@dataclass(frozen=True, slots=True)
class Assign:
    """``R[1] = R[1] + 1``, ``DO[2] = ON``

    Args:
        said: of an output, the statement alone, where its line says several; None for the line,
            which is kept once for all of them then.
    """

    span: Span
    target: Datum
    value: Expression
    said: str | None = None


@dataclass(frozen=True, slots=True)
class Set:
    """``SPEED 30 MM/S ALWAYS``: numbers that the moves behind it have.

    Args:
        names: under which they are kept; a datum of the first is the setting's word.
        values: a number for each.
        unit: that stands behind the number.
        once: whether they hold for the next move alone.
        place: of all that stands behind the word, where that is one literal.
    """

    span: Span
    names: tuple[str, ...]
    values: tuple[Expression, ...]
    unit: str = ""
    once: bool = False
    place: Span | None = None


@dataclass(frozen=True, slots=True)
class AssignAll:
    """``PR[1] = P[2] + PR[3]``, ``TOOL 1 = (0, 0, 100, 0, 0, 0)``: all numbers of a datum that has
    several.

    Args:
        terms: a sign, and a datum, a point or numbers each; none if nobody knows what it becomes
            (the position of the running robot).
        reason: what it depends on then.
    """

    span: Span
    target: Datum
    terms: tuple[tuple[float, Operand], ...]
    reason: str = ""


class Label(nodes.Label):
    """Where jumps lead."""

    __slots__ = ()


class Jump(nodes.Goto):
    """A jump to a label of the same routine."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class If:
    """Statements that are carried out if a condition holds, and others if not."""

    span: Span
    condition: Expression
    then: Body
    otherwise: Body | None = None

    @property
    def blocks(self) -> tuple[Body, ...]:
        """The statements, and the others."""
        return (self.then,) if self.otherwise is None else (self.then, self.otherwise)


@dataclass(frozen=True, slots=True)
class Call:
    """A call of a routine with what its arguments are."""

    span: Span
    routine: str
    arguments: tuple[Expression, ...] = ()


@dataclass(frozen=True, slots=True)
class Return:
    """The routine ends."""

    span: Span


@dataclass(frozen=True, slots=True)
class End:
    """The program ends."""

    span: Span


@dataclass(frozen=True, slots=True)
class Pause:
    """The robot waits for a time, s, or until a condition holds; ``said``: as of `Assign`."""

    span: Span
    time: Expression | None = None
    condition: Expression | None = None
    said: str | None = None


@dataclass(frozen=True, slots=True)
class Kept:
    """What is kept as it stands and not carried out.

    Args:
        name: of the instruction, for the note.
        why: it is not carried out.
        stops: whether the robot stops at it.
        signal: what it does with a signal, if that is known.
        said: as of `Assign`.
    """

    span: Span
    name: str
    why: str
    stops: bool = False
    signal: SignalAction | None = None
    said: str | None = None


@dataclass(frozen=True, slots=True)
class NumberedPoint:
    """A point with a number, or with a name alone.

    Args:
        datum: its word and number; the index of one that is called by its name is None.
        numbers: of it.
        kind: what it is beside its numbers: in which frames, joints or a pose.
    """

    span: Span
    datum: Datum
    numbers: tuple[Expression, ...]
    kind: Any = None


@dataclass(frozen=True, slots=True)
class Routine:
    """The lines from here on are another routine's."""

    span: Span
    name: str


@dataclass(frozen=True, slots=True)
class Open:
    """A block begins; its `If` has the statements that follow.

    Args:
        condition: of a block that is carried out if it holds.
        counter, last, step: of one that is repeated: what counts from ``first`` to ``last``.
        repeats: whether it is repeated while the condition holds; without one, until that of its
            `Close` does.
    """

    span: Span
    condition: Expression | None = None
    counter: Datum | None = None
    first: Expression | None = None
    last: Expression | None = None
    step: float = 1.0
    repeats: bool = False


@dataclass(frozen=True, slots=True)
class Otherwise:
    """What is done if the condition before does not hold.

    Args:
        condition: of it, in turn; None for none.
        then: what is done; None if the lines up to `Close` say that.
    """

    span: Span
    condition: Expression | None = None
    then: Statement | None = None


@dataclass(frozen=True, slots=True)
class Close:
    """A block ends.

    Args:
        until: of one that is repeated, what ends it.
    """

    span: Span
    until: Expression | None = None


Statement = (
    Drive
    | Assign
    | AssignAll
    | Set
    | Open
    | Otherwise
    | Close
    | Label
    | Jump
    | If
    | Call
    | Return
    | End
    | Pause
    | Kept
    | NumberedPoint
    | Routine
)


@dataclass(frozen=True, eq=False)
class Body:
    """Statements in order.

    Args:
        name: of a routine's, as it is declared.
    """

    statements: tuple[Statement, ...] = ()
    name: str = ""

    @cached_property
    def labels(self) -> Mapping[str, int]:
        """Index of each label."""
        return {s.name: i for i, s in enumerate(self.statements) if isinstance(s, Label)}
