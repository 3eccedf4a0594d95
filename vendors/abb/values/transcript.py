"""What a run leaves: statements in order, the sources of the moves' numbers, notes."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ....core.errors import Note, Span
from ....core.program.move import Move, Opaque, Wait
from ....core.program.move import Statement as ProgramStatement
from ....core.program.origin import MoveOrigin
from ....core.source.execution.provenance import Part, Reads
from ..syntax.tree import Invoke, Keyword
from .records import Record


@dataclass(frozen=True, slots=True)
class Sources:
    """The parts of a move before all reads of the run are known.

    Args:
        record: the target as a RAPID value.
    """

    statement: Span
    target: Part
    speed: Part
    zone: Part
    via: Part | None
    record: Record


class Output:
    """Collects statements and notes.

    Args:
        texts: source texts by file, from which kept statements are cut.
    """

    def __init__(self, texts: dict[str, str]) -> None:
        self.where = ""
        self._texts = texts
        self._statements: list[ProgramStatement] = []
        self._sources: list[Sources] = []
        self._notes: dict[tuple[str, str], Note] = {}
        self._kept: dict[str, tuple[Note, int]] = {}
        self._quaternions: dict[Span, float] = {}

    @property
    def move_index(self) -> int:
        """Index of the move that is being read, or comes next."""
        return len(self._sources)

    def text_of(self, span: Span) -> str:
        """The text that stands at a place."""
        return self._texts[span.file][span.start : span.end]

    # ------------------------------------------------------------------- statements

    def emit(self, statement: Wait | Opaque) -> None:
        """Put a statement that is no move at the end of the program."""
        self._statements.append(statement)

    def emit_move(self, move: Move, sources: Sources) -> None:
        """Put a move at the end of the program."""
        self._statements.append(move)
        self._sources.append(sources)

    def keep(self, statement: Invoke | Keyword, why: str, stops: bool = False) -> None:
        """Keep a statement as it stands, with one note per kind, at the first of them."""
        span = statement.span
        self.emit(Opaque(self.text_of(span), stops, span))
        if why:
            name = statement.text if isinstance(statement, Invoke) else statement.word.upper()
            self.count(f"{name} is kept and not carried out: {why}", span)

    def statements(self, reads: Reads) -> tuple[ProgramStatement, ...]:
        """What was executed, each move with the origin of its numbers."""
        sources = enumerate(self._sources)
        return tuple(
            statement
            if isinstance(statement, Wait | Opaque)
            else replace(statement, origin=_origin(reads, *next(sources)))
            for statement in self._statements
        )

    # ------------------------------------------------------------------------ notes

    def count(self, message: str, span: Span) -> None:
        """A note, given once with the number of times that it held."""
        first, count = self._kept.get(message.lower(), (Note(message, span=span), 0))
        self._kept[message.lower()] = first, count + 1

    def note_once(self, kind: str, message: str, span: Span) -> None:
        """A note, unless this kind was noted in this routine before."""
        where = f" (in {self.where})" if self.where else ""
        self._notes.setdefault((self.where, kind), Note(message + where, span=span))

    def note_quaternion(self, error: float, span: Span) -> None:
        """A quaternion was scaled to unit length."""
        self._quaternions.setdefault(span, error)

    def notes(self) -> tuple[Note, ...]:
        """What is to be said about the run."""
        notes = list(self._notes.values())
        for note, count in self._kept.values():
            times = f" ({count} times, here first)" if count > 1 else ""
            notes.append(replace(note, message=note.message + times))
        if self._quaternions:
            worst = max(self._quaternions.values())
            first = next(iter(self._quaternions))
            count = len(self._quaternions)
            what = "a quaternion is" if count == 1 else f"{count} quaternions are"
            notes.append(
                Note(f"{what} not of unit length (by {worst:.1g} at most): normalised", span=first)
            )
        return tuple(notes)


def _origin(reads: Reads, index: int, sources: Sources) -> MoveOrigin:
    return MoveOrigin(
        sources.statement,
        reads.origin(sources.target, index),
        reads.origin(sources.speed, index),
        reads.origin(sources.zone, index),
        None if sources.via is None else reads.origin(sources.via, index),
    )
