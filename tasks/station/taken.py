"""What programs of a station are taken to do where neither a file nor the station says it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from ...core.errors import Note
from ..setup import setup_of_program

if TYPE_CHECKING:
    from ...core.errors import Span
    from ...core.station.actions import Action
    from ...core.station.station import StationRobot


def taken_notes(member: StationRobot, actions: Sequence[Action]) -> Iterator[Note]:
    """What a user should know of how a program was read, beyond what the station carries out."""
    from ...core.program.question import QuestionKind
    from ...core.source.execution.answers_text import grouped

    program, name = member.program, member.name
    for note in program.notes:
        if not note.asked and not carried_out(member, actions, note.span):
            yield Note(f"{name}: {note}", damage=note.damage)
    # Signals and waits for them are the station's own matter.
    others = {QuestionKind.SIGNAL, QuestionKind.PAUSE}
    awaited = {(a.span.file, a.span.line) for a in actions if a.span is not None}
    asked = [
        question
        for question in program.questions
        if not question.answered
        and question.kind not in others
        and (question.span.file, question.span.line) not in awaited
    ]
    if asked:
        yield Note(
            f"{name}: not known: {'; '.join(grouped(asked))}: what is said here, and proven, is of "
            "the program as it is taken to run; a file says it otherwise (answers = of the "
            "station file, written by `flyby ask`)"
        )


def carried_out(member: StationRobot, actions: Sequence[Action], span: Span | None) -> bool:
    """Whether the station does what a program by itself leaves open at a place: signals, with which
    moves of others one is made together, and what turns its work object."""
    from ...core.source.reading import Reading

    if span is not None and span in {action.span for action in actions}:
        return True
    reading = member.program.reading
    if span is None or not isinstance(reading, Reading) or span.file not in reading.files:
        return False
    text = reading.files[span.file].text[span.start : span.end]
    speaks = setup_of_program(member.program).vendor.speaks
    words = None if speaks is None else speaks.signals
    if words is not None and words.together is not None and words.together(text) is not None:
        return True
    turned = {axis for moves in member.carried for axis in moves.axes.values()}
    frames = (move.work_object for move in member.program.moves)
    return text.casefold() in {f.name.casefold() for f in frames if f.moved_by in turned}
