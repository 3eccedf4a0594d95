"""Who else names a datum that is to change: code of the same files that was not driven.

Ownership (see `provenance`) follows from what a run reads. Another branch, or a routine that this
run does not call, may use the same datum: it would drive to the changed point too, and nothing has
been proven of it. So the text is searched for the names of changed data, and for every place it is
asked whether it has been executed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from ..dialect import Wording
from ..errors import Span
from ..program.move import Move
from ..program.origin import Origin
from ..program.program import Program
from .patching import changed_moves, reading_of
from .reading import Reading
from .text import SourceText
from .uses import Kind


@dataclass(frozen=True, slots=True)
class Bystander:
    """A datum that changes, and where code names it that was not driven.

    Args:
        datum: its name.
        move: index of the first move that it changes for.
        places: in the text.
    """

    datum: str
    move: int
    places: tuple[Span, ...]


def bystanders(before: Program, after: Program, wording: Wording) -> tuple[Bystander, ...]:
    """The data that a change of a program's files concerns beyond what was driven.

    Names are searched for in the file where the datum stands and in those that declare nothing of
    the same name; comments and strings do not count. The program is read once more, to learn
    which statements are executed.

    Args:
        before: as its reader made it.
        after: as it is read from its changed text. A move that has got data of its own there
            leaves the old ones to the others.
        wording: how the language's texts are searched.

    Raises:
        InputError: the program was not read from source files, or statements were added, removed
            or put in another order.
    """
    changed = _changed_data(before, after)
    if not changed:
        return ()
    reading = reading_of(before)
    executed = _executed(before, reading)
    texts = {name: wording.quiet(file.text) for name, file in reading.files.items()}
    found: list[Bystander] = []
    for datum, (move, number) in changed.items():
        places = tuple(
            place
            for place in _named(datum, number, texts, wording)
            if not _is_executed(place, executed)
        )
        if places:
            found.append(Bystander(datum, move, places))
    return tuple(found)


def _changed_data(before: Program, after: Program) -> dict[str, tuple[int, Span]]:
    """The first move that reads each changed datum, and the place of its first number."""
    found: dict[str, tuple[int, Span]] = {}
    for index, old, new in changed_moves(before, after):
        for kind in Kind:
            origin: Origin | None = getattr(old.origin, kind, None)
            if origin is None or origin.datum is None or not _same_datum(origin, new, kind):
                continue
            numbers = [span for span in origin.numbers if span is not None]
            if numbers and getattr(old, kind) != getattr(new, kind):
                found.setdefault(_name(origin.datum), (index, numbers[0]))
    return found


def _same_datum(old: Origin, new: Move, kind: Kind) -> bool:
    origin: Origin | None = getattr(new.origin, kind, None)
    return origin is not None and origin.datum == old.datum


def _name(datum: str) -> str:
    """A datum's own name, without module, index or field."""
    return datum.replace("{", "[").split("[")[0].split(":")[-1].split(".")[0].strip()


def _executed(program: Program, reading: Reading) -> Mapping[str, set[tuple[int, int, int]]]:
    """First line, start and end of every executed statement, by file."""
    found: defaultdict[str, set[tuple[int, int, int]]] = defaultdict(set)

    def executed(span: Span) -> None:
        found[span.file].add((span.line, span.start, span.end))

    reading.read(reading.files, reading.main, replace(reading.options, executed=executed))
    for move in program.moves:
        if move.origin is not None:
            # All lines of a motion instruction, where of a block only the first one is executed.
            span = move.origin.statement
            found[span.file].update((line, span.start, span.end) for line in _lines(span, reading))
    return found


def _lines(span: Span, reading: Reading) -> range:
    text = reading.files[span.file].text[span.start : span.end]
    return range(span.line, span.line + len(text.splitlines()))


def _is_executed(place: Span, executed: Mapping[str, set[tuple[int, int, int]]]) -> bool:
    return any(
        line == place.line and start <= place.start and place.end <= end
        for line, start, end in executed.get(place.file, ())
    )


def _named(datum: str, number: Span, texts: Mapping[str, str], wording: Wording) -> Iterator[Span]:
    """Where a name stands, but for its own declaration."""
    folded = wording.folded(datum)
    for file, text in texts.items():
        names = wording.name.finditer(text)
        places = [found.start() for found in names if wording.folded(found[0]) == folded]
        if file == number.file:
            own = max((at for at in places if at < number.start), default=None)
            places = [at for at in places if at != own]
        elif any(wording.folded(name) == folded for name, _ in wording.declared(text)):
            continue
        source = SourceText(text, file)
        yield from (source.span(at, at + len(datum)) for at in places)
