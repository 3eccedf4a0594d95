"""What a run puts out: moves, waits and kept statements in order, and notes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from ....core.errors import Note, Span
from ....core.program.move import Move, Opaque, Wait
from ....core.program.move import Statement as ProgramStatement
from ....core.program.origin import MoveOrigin
from ....core.source.execution.limits import Meter
from ....core.source.execution.provenance import Part, Reads


@dataclass(frozen=True, slots=True)
class Parts:
    """The parts of a move before all reads of the run are known."""

    statement: Span
    target: Part
    speed: Part
    zone: Part
    via: Part | None = None


class Output:
    """Collects it.

    Args:
        text: the text of a place.
        meter: counts moves.

    Attributes:
        parts: of the moves so far.
        continues: the statement that is carried out stands behind a ``CONTINUE``, and does not stop
            the advance run.
    """

    def __init__(self, text: Callable[[Span], str], meter: Meter) -> None:
        self.text = text
        self.parts: list[Parts] = []
        self.continues = False
        self._meter = meter
        self._statements: list[ProgramStatement] = []
        self._notes: dict[str, Note] = {}
        self._kept: dict[str, tuple[Note, int]] = {}

    @property
    def move_index(self) -> int:
        """Index of the move that is being read, or comes next."""
        return len(self.parts)

    def emit(self, statement: Wait | Opaque) -> None:
        """Put a statement that is no move at the end of the program."""
        self._statements.append(statement)

    def emit_move(self, move: Move, parts: Parts) -> None:
        """Put a move at the end of the program.

        Raises:
            SourceError: there are more than the limits allow.
        """
        self._meter.move(parts.statement)
        self._statements.append(move)
        self.parts.append(parts)

    def stop(self, span: Span) -> None:
        """Something stops the advance run, and so the robot, unless ``CONTINUE`` lets it pass."""
        last = self._statements[-1] if self._statements else None
        stands = isinstance(last, Wait) or (isinstance(last, Opaque) and last.stops)
        if last is not None and not stands and not self.continues:
            self.emit(Wait(0.0, span))

    def keep(self, span: Span, name: str, why: str, stops: bool = False) -> None:
        """Keep a statement as it stands, with one note per kind, at the first of them.

        So is the ``CONTINUE`` that lets the robot pass it.

        Args:
            name: of the statement, for the note.
            why: it is not carried out; empty if nothing needs to be said.
            stops: it stops the advance run.
        """
        if stops and self.continues:
            self.emit(Opaque("CONTINUE", span=span))
        self.emit(Opaque(self.text(span), stops and not self.continues, span))
        if why:
            message = f"{name} is kept and not carried out: {why}"
            first, count = self._kept.get(message.lower(), (Note(message, span=span), 0))
            self._kept[message.lower()] = first, count + 1

    def note_once(self, kind: str, message: str, span: Span) -> None:
        """A note, unless this kind was noted before."""
        self._notes.setdefault(kind, Note(message, span=span))

    # ---------------------------------------------------------------------- the whole

    def statements(self, reads: Reads) -> tuple[ProgramStatement, ...]:
        """All of them, each move with the origin of its numbers.

        Args:
            reads: all reads of the run.
        """
        parts = enumerate(self.parts)
        return tuple(
            statement
            if isinstance(statement, Wait | Opaque)
            else replace(statement, origin=_origin(*next(parts), reads))
            for statement in self._statements
        )

    def notes(self) -> tuple[Note, ...]:
        """The notes; of kept statements with how often they were met."""
        kept = (
            replace(note, message=f"{note.message} ({count} times, here first)")
            if count > 1
            else note
            for note, count in self._kept.values()
        )
        return (*self._notes.values(), *kept)


def _origin(index: int, parts: Parts, reads: Reads) -> MoveOrigin:
    return MoveOrigin(
        parts.statement,
        reads.origin(parts.target, index),
        reads.origin(parts.speed, index),
        reads.origin(parts.zone, index),
        None if parts.via is None else reads.origin(parts.via, index),
    )
