"""Rules on the text of a program's own files, searched by the vendor's `Wording`.

What a program reads while it runs is only part of its text: whether a name stands anywhere else is
asked of all files that belong to it.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import PurePath

from ..dialect import Pitfall, Wording
from ..program.program import Program
from ..source.reading import Reading
from ..source.text.files import SourceText, unbroken
from .finding import Hit, ProgramSubject


def unused_targets(subject: ProgramSubject) -> Iterator[Hit]:
    """Targets that are declared and whose name stands nowhere else."""
    wording, texts = _searched(subject)
    if wording is None:
        return
    known = _known(texts.values(), wording)
    declared = Counter(
        wording.folded(name) for text in texts.values() for name, _ in wording.declared(text)
    )
    for file, text in _own(texts, subject.program).items():
        source = SourceText(text, file)
        for name, at in wording.declared(text):
            if known[wording.folded(name)] <= declared[wording.folded(name)]:
                yield Hit(
                    f"{name} is a target that no motion uses",
                    "remove it, or use it",
                    span=source.span(at, at + len(name)),
                )


def damaged_text(subject: ProgramSubject) -> Iterator[Hit]:
    """What no controller takes, and was stepped over."""
    for note in subject.program.notes:
        if note.damage:
            yield Hit(note.message, "correct the text", span=note.span)


def _known(texts: Iterable[str], wording: Wording) -> Counter[str]:
    """How often every name stands in the texts."""
    return Counter(
        wording.folded(found[0]) for text in texts for found in wording.name.finditer(text)
    )


def pitfalls(subject: ProgramSubject) -> Iterator[Hit]:
    """Words that do not do what they seem to."""
    wording, texts = _searched(subject)
    if wording is None:
        return
    own = _own(texts, subject.program)
    for pitfall in wording.pitfalls:
        if _applies(pitfall, own):
            for file, text in own.items():
                yield from _found(pitfall, SourceText(text, file))


def _applies(pitfall: Pitfall, texts: Mapping[str, str]) -> bool:
    def stands(words: re.Pattern[str]) -> bool:
        return any(words.search(text) for text in texts.values())

    asked = pitfall.beside is None or stands(pitfall.beside)
    return asked and not (pitfall.without is not None and stands(pitfall.without))


def _found(pitfall: Pitfall, source: SourceText) -> Iterator[Hit]:
    for found in pitfall.words.finditer(source.text):
        message = pitfall.message.format(words=found[0])
        yield Hit(message, pitfall.fix, span=source.span(found.start(), found.end()))


def _searched(subject: ProgramSubject) -> tuple[Wording | None, dict[str, str]]:
    """How to search, and the texts by file with blanks for comments and strings."""
    reading = subject.program.reading
    if subject.wording is None or not isinstance(reading, Reading):
        return None, {}
    quiet, files = subject.wording.quiet, reading.files.items()
    return subject.wording, {name: quiet(unbroken(file.text)) for name, file in files}


def _own(texts: Mapping[str, str], program: Program) -> dict[str, str]:
    """Those files whose motions are driven, and those that are called like them.

    Others are shared with other programs, which may use what this one does not.
    """
    driven = {move.origin.statement.file for move in program.moves if move.origin is not None}
    assert program.reading is not None
    stems = {_stem(file) for file in (*driven, program.reading.main)}
    return {file: text for file, text in texts.items() if _stem(file) in stems}


def _stem(file: str) -> str:
    return str(PurePath(file).with_suffix("")).lower()
