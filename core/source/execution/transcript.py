"""What a run leaves: statements in order, the sources of the moves' numbers, notes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from ...display import counted
from ...errors import InputError, LeftOpenError, Note, ParseError, SourceError, Span, StopError
from ...program.call import Call
from ...program.move import Move, MoveJ, Opaque, Statement, Wait
from ...program.origin import MoveOrigin
from ...program.speed import Speed
from ...program.target import PoseTarget
from ...spatial.pose import Pose
from ..text.quick import quick
from .course import AnswerError, Course
from .limits import EndlessError
from .provenance import MovePart, Reads
from .streams import Stream, Streaming

_SHOWN = 4
"""Names that a note on kept statements lists."""
STEPLESS = (
    "STEP is zero: the counter stands still, and the controller never leaves the loop; of its "
    "passes at most one is read, and what stands behind it"
)
"""What is said of a ``FOR`` that counts by nothing."""


@quick(frozen=True, slots=True)
class MoveParts:
    """The parts of a move before all reads of the run are known.

    Args:
        statement: the motion instruction.
        target, speed, zone: of the move.
        via: of an arc.
    """

    statement: Span
    target: MovePart
    speed: MovePart
    zone: MovePart
    via: MovePart | None = None


@dataclass
class _Group:
    """Statements of one kind: the place of the first, and how often each name came."""

    span: Span
    counts: dict[str, int] = field(default_factory=dict)


class Notes:
    """What is to be said about a run: one note for a kind of thing.

    Attributes:
        where: the routine that runs, in which a kind is noted once: ``PROC pick``; empty for once
            in the program.
    """

    def __init__(self) -> None:
        self.where = ""
        self._once: dict[tuple[str, str], Note] = {}
        self._counted: dict[str, tuple[Note, int]] = {}
        self._groups: dict[str, _Group] = {}

    def once(self, kind: str, message: str, span: Span) -> None:
        """A note, unless one of this kind was taken before."""
        where = f" (in {self.where})" if self.where else ""
        self._once.setdefault((self.where, kind), Note(message + where, span=span))

    def count(self, message: str, span: Span, *, damage: bool = False) -> None:
        """A note, given once with the number of times that it held.

        Args:
            damage: see `Note`.
        """
        new = Note(message, span=span, damage=damage)
        first, count = self._counted.get(message.lower(), (new, 0))
        self._counted[message.lower()] = first, count + 1

    def group(self, kind: str, name: str, span: Span) -> None:
        """A statement was kept and not carried out; one note for all that do the same.

        Args:
            kind: what such statements do: "set outputs".
            name: of the instruction.
        """
        counts = self._groups.setdefault(kind, _Group(span)).counts
        counts[name] = counts.get(name, 0) + 1

    def notes(self) -> tuple[Note, ...]:
        """All notes, those about kept statements last."""
        notes = list(self._once.values())
        for note, count in self._counted.values():
            times = f" ({count} times, here first)" if count > 1 else ""
            notes.append(replace(note, message=note.message + times))
        for kind, group in self._groups.items():
            count = sum(group.counts.values())
            names = list(group.counts)
            shown = ", ".join(names[:_SHOWN]) + (", …" if len(names) > _SHOWN else "")
            times = "" if count == 1 else f" ({count} statements, here first)"
            message = f"statements that {kind} are kept and not carried out: {shown}{times}"
            notes.append(Note(message, span=group.span))
        return tuple(notes)


class Transcript:
    """Collects what a run goes through.

    Args:
        text_of: the text that stands at a place, from which kept statements are cut.
        course: says how long the robot stands at them, and whether programs go on.

    Attributes:
        calls: of the program's own routines, see `called`.
        left_out: why motions were left out, see `leave_out`.
        streaming: what a run does about moves that a computer sends.
    """

    def __init__(self, text_of: Callable[[Span], str], course: Course) -> None:
        self.text_of = text_of
        self._course = course
        self.notes = Notes()
        self.parts: list[MoveParts] = []
        self.calls: list[Call] = []
        self.left_out: list[LeftOpenError] = []
        self.streaming = Streaming()
        self._statements: list[Statement] = []
        course.sections.statements = self._statements

    @property
    def move_index(self) -> int:
        """Index of the move that is being read, or comes next."""
        return len(self.parts)

    @property
    def stopped(self) -> bool:
        """Whether the robot stands: nothing was carried out yet, or the last statement stops it."""
        last = self._statements[-1] if self._statements else None
        return last is None or isinstance(last, Wait) or (isinstance(last, Opaque) and last.stops)

    def emit(self, statement: Wait | Opaque) -> None:
        """Put a statement that is no move at the end of the program."""
        self._statements.append(statement)

    def emit_move(self, move: Move, parts: MoveParts) -> None:
        """Put a move at the end of the program."""
        self._statements.append(move)
        self.parts.append(parts)

    def replace_last_move(self, move: Move) -> None:
        """Put a move in the place of the last one, which has turned out to go further."""
        moves = (k for k, s in enumerate(self._statements) if not isinstance(s, Wait | Opaque))
        self._statements[max(moves)] = move

    def called(self, span: Span) -> None:
        """A routine of the program is entered by the call at a place."""
        self.calls.append(Call(self.text_of(span), len(self._statements), span))

    def stop(self) -> None:
        """The robot stops at the last statement, which is kept."""
        last = self._statements[-1]
        if isinstance(last, Opaque):
            self._statements[-1] = replace(last, stops=True)

    def keep(
        self,
        span: Span,
        name: str,
        why: str,
        stops: bool = False,
        device: bool = False,
        said: str | None = None,
    ) -> bool:
        """Keep a statement as it stands, with one note per kind, at the first of them.

        Args:
            span: of the statement.
            name: of the instruction, for the note.
            why: it is not carried out; empty for no note.
            stops: whether the robot stops at it.
            device: whether it is taken as a device's, which may take its time.
            said: the statement, where more stands at its place.

        Returns:
            Whether the robot is driven at it by what a computer sends.
        """
        text = self.text_of(span) if said is None else said
        stream = self._course.stream(text, span)
        self.emit(Opaque(text, stops or stream is not None, span))
        if stream is not None:
            self._drive(stream, span)
            return True
        stands = self.pause(text, span, listed=stops or device)
        if why and not stands:  # of what the user has said how long it takes, nothing is left out
            self.notes.count(f"{name} is kept and not carried out: {why}", span)
        return False

    def _drive(self, stream: Stream, span: Span) -> None:
        """The robot follows what is sent to it at a statement."""
        try:
            moves = stream.moves(span, self.streaming.robot)
        except SourceError as error:
            if not self.leaves_open(error, span):
                raise
            self.streaming.lost(span)
            return
        part = MovePart(span)
        for move in moves:
            self.emit_move(move, MoveParts(span, part, part, part))
            self.streaming.driven(move, span)
        self.notes.once(
            f"stream {span.file} {span.start}",
            f"{stream.file} is driven here: {counted(moves, 'joint move')} in "
            f"{stream.times[-1] - stream.times[0]:.4g} s, the first to where it begins",
            span,
        )

    def leave_out(self, span: Span, error: LeftOpenError) -> None:
        """Keep a motion whose target nobody knows, and go on from the next."""
        if self.leaves_open(error, span):
            return
        # Its traceback would hold all of the run.
        self.left_out.append(error.with_traceback(None))
        self.emit(Opaque(self.text_of(span), True, span))
        self.notes.count(f"the motion is left out: {error.message}", span)

    def check_driven(self) -> None:
        """Refuse a program of which no motion is left, or none but to one place.

        Where programs go on behind what nobody knows, the first that was left out is its only move.

        Raises:
            LeftOpenError: of the first that was left out.
        """
        goals = [s.target for s in self._statements if not isinstance(s, Wait | Opaque)]
        strict = not self._course.answers.goes_on
        one_place = all(goal == goals[0] for goal in goals)
        if self.left_out and (not goals or (strict and one_place)):
            first = self.left_out[0]
            assert first.span is not None
            if not self.leaves_open(first, first.span):
                raise first

    def wait(self, duration: float, name: str, below_zero: str, span: Span) -> None:
        """The robot stands for the time that a program says.

        Args:
            duration: s; one below zero is none, with a note.
            name: of the statement.
            below_zero: what a controller makes of a time below zero.
            span: of the statement.

        Raises:
            SourceError: it is no number that is finite.
        """
        if duration < 0:
            self.notes.count(f"{name} of {duration:g} s: {below_zero}; no wait is taken", span)
        try:
            self.emit(Wait(max(0.0, duration), span))
        except InputError as error:
            raise SourceError(f"{name}: {error}", span) from None

    def pause(self, text: str, span: Span, listed: bool = True) -> float:
        """The robot stands for as long as the user says that a statement takes.

        Args:
            text: of the statement.
            span: of it.
            listed: whether it is listed among the program's questions.

        Returns:
            s; 0 where nobody says it.
        """
        duration = self._course.pause(text, span, listed)
        if duration:
            self.emit(Wait(duration, span, device=True))
        return duration

    def leaves_open(self, error: SourceError, span: Span, ends: bool = False) -> bool:
        """A move cannot be read: it stays in the program, open, where programs go on behind such.

        Args:
            error: why.
            span: of the move.
            ends: whether it is no move at all, and the program ends there.

        Returns:
            Whether the program goes on behind it; nobody knows where the robot stands then.
        """
        if not self._course.answers.goes_on or isinstance(
            error, AnswerError | EndlessError | ParseError
        ):
            return False
        message = str(error).removeprefix(f"{error.span}: ")
        if error.span is not None and error.span.line != span.line:
            message = f"line {error.span.line}: {message}"
        stops = isinstance(error, StopError)
        if stops:
            message += ": the controller stops the program here"
        target = PoseTarget(Pose(), name="the program ends" if ends else "not known")
        part = MovePart(span)
        self.emit_move(
            MoveJ(target, Speed(joint_fraction=1.0), open=message, stops=stops),
            MoveParts(span, part, part, part),
        )
        return True

    def stops(self, error: StopError) -> bool:
        """The program ends with an error of the controller, behind what was driven: as a move that
        stays open.

        Returns:
            Whether it ends so; else, as it has moved nothing or programs do not go on, it is to be
            refused.
        """
        if error.span is None or not self.parts:
            return False
        return self.leaves_open(error, error.span, ends=True)

    def statements(self, reads: Reads) -> tuple[Statement, ...]:
        """What was carried out, each move with the origin of its numbers.

        Args:
            reads: all reads of the run.
        """
        parts = enumerate(self.parts)
        return tuple(
            statement
            if isinstance(statement, Wait | Opaque)
            else replace(statement, origin=_origin(reads, *next(parts)))
            for statement in self._statements
        )


def _origin(reads: Reads, index: int, parts: MoveParts) -> MoveOrigin:
    return MoveOrigin(
        parts.statement,
        reads.origin(parts.target, index),
        reads.origin(parts.speed, index),
        reads.origin(parts.zone, index),
        None if parts.via is None else reads.origin(parts.via, index),
    )
