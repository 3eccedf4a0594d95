"""Whether what was kept as text can stand in a program of its own.

A program that is written anew has its motions with the numbers that they were driven with; the
assignments, routines and data of the files that it was read from are gone. A statement that was
kept and names one of them would not load, or would mean another value. It is refused.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping

from ...dialect import Mention, Wording
from ...errors import SourceError, Span
from ...program.move import Opaque
from ...program.program import Program
from ..reading import Reading
from .options import as_comments


def check_kept(program: Program, sources: Mapping[str, str], wording: Wording) -> None:
    """Refuse statements that name what only the files have that they were read from.

    Raises:
        SourceError: naming the statement and the name.
    """
    for span, name in without_their_names(program, sources, wording):
        raise SourceError(
            f"this statement is kept as it stands, and names {name!r}, which the new "
            "program does not have as it is here: patch the program's own files, or make "
            f"kept statements comments ({as_comments()})",
            span,
        )


def without_their_names(
    program: Program, sources: Mapping[str, str], wording: Wording
) -> Iterator[tuple[Span | None, str]]:
    """Places of the kept statements that name what only the files have that they were read from,
    each with such a name.

    What is declared beside the program and set nowhere is the controller's own, and stays there.
    What the new files declare counts if the old ones give it one value.
    """
    kept = list(_kept(program))
    reading = program.reading
    if not kept or not isinstance(reading, Reading):
        return
    own = {wording.module(file) for file in _own_files(program, reading)}
    missing: set[str] = set()
    given: Counter[str] = Counter()
    for file, source in reading.files.items():
        for name, mention in _mentions(source.text, wording):
            given[name] += mention is not Mention.USED
            if mention is Mention.ASSIGNED or (
                mention is Mention.DECLARED and wording.module(file) in own
            ):
                missing.add(name)
    texts = [list(_mentions(text, wording)) for text, _ in kept]
    by_kept = {name for text in texts for name, mention in text if mention is not Mention.USED}
    declared = {
        name
        for text in sources.values()
        for name, mention in _mentions(text, wording)
        if mention is not Mention.USED
    }
    missing -= {name for name in declared - by_kept if given[name] == 1}
    for text, (_, span) in zip(texts, kept, strict=True):
        for name, mention in text:
            if mention is not Mention.USED:
                missing.discard(name)
            elif name in missing:
                yield span, name
                break


def _kept(program: Program) -> Iterator[tuple[str, Span | None]]:
    """Texts that are kept, in order, with their places."""
    for statement in program.statements:
        if isinstance(statement, Opaque):
            yield statement.text, statement.span
        else:
            for event in getattr(statement, "events", ()):
                yield event.text, event.span


def _own_files(program: Program, reading: Reading) -> set[str]:
    """The files that the new ones take the place of."""
    spans = [span for _, span in _kept(program)]
    spans += [move.origin.statement for move in program.moves if move.origin is not None]
    return {reading.main, *(span.file for span in spans if span is not None)}


def _mentions(text: str, wording: Wording) -> Iterator[tuple[str, Mention]]:
    for name, mention in wording.mentions(wording.quiet(text)):
        yield wording.folded(name), mention
