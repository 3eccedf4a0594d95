"""Programs of one statement a line: lines put together to routines."""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import islice
from pathlib import PurePath
from types import MappingProxyType
from typing import Any

from ...errors import FlybyError, InputError, PluginFault, SourceError, Span
from ..text.files import SourceText, unbroken
from .blocks import nested
from .expressions import Datum, Value
from .settings import Settings
from .statements import Body, Kept, Label, Line, NumberedPoint, Numbers, Routine, Statement

_LINE = re.compile(r"[^\r\n]+")
_ENOUGH = 200
"""Lines that show a language."""


Said = Statement | Sequence[Statement] | None
"""What a line says: one statement, several, or nothing."""


Initial = Mapping[tuple[str, int | None], Numbers | Value]
"""What registers hold, by word and number; the number of one that there is once is None."""


_WORDS = frozenset(
    {"registers", "vectors", "initial", "outputs", "argument"}
    | {"joints", "chained", "paired", "current", "override"}
)
"""What of a grammar names data, or kinds of points and motions."""


def _folded(given: Any) -> Any:
    """Words as data are called: in capitals."""
    if isinstance(given, re.Pattern):
        return re.compile(given.pattern, given.flags | re.IGNORECASE)
    if isinstance(given, str):
        return given.upper()
    if isinstance(given, tuple):  # a word and a number
        return given[0].upper(), given[1]
    if isinstance(given, Mapping):
        return {_folded(word): value for word, value in given.items()}
    return frozenset(map(_folded, given)) if isinstance(given, set | frozenset) else given


def _is_held(key: Any, held: Any) -> bool:
    """Whether a row of `Initial` is one."""
    named = isinstance(key, tuple) and len(key) == 2 and isinstance(key[0], str)
    return named and isinstance(held, int | float | Numbers)


class Grammar:
    """What a language takes a line for. Upper and lower case of its words are the same.

    Attributes:
        registers: words of data that the program itself sets and reads, one number each; or what
            they are like, where names of variables are.
        vectors: words of those that have several numbers, and how many.
        initial: what registers hold before the program sets them; their words need not stand
            among the others.
        outputs: words of outputs; all other words are asked of the answers.
        argument: word of the registers that hold a routine's arguments.
        settings: what holds for the moves behind it until it is set again.
    """

    registers: Container[str] | re.Pattern[str] = frozenset()
    vectors: Mapping[str, int] = MappingProxyType({})
    initial: Initial = MappingProxyType({})
    outputs: Container[str] = frozenset()
    argument: str = ""
    settings: Settings = Settings()

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        for name, given in list(vars(cls).items()):
            if name in _WORDS:
                setattr(cls, name, _folded(given))
        wrong = [key for key, held in cls.initial.items() if not _is_held(key, held)]
        if wrong:
            raise InputError(
                f"{cls.__qualname__}.initial: {wrong[0]!r} is no word and number that hold one: "
                f'write {{("{wrong[0] if isinstance(wrong[0], str) else "R"}", None): 100.0}} of a '
                'register that there is once, {("R", 1): 0.0} of one with a number'
            )

    def holds(self, word: str) -> bool:
        """Whether data of a word are what the program has set them to."""
        if isinstance(self.registers, re.Pattern):
            known = self.registers.fullmatch(word) is not None
        else:
            known = word in self.registers
        others = {*self.vectors, *(one for one, _ in self.initial)}
        return known or word in others or word in self.settings

    def statement(self, line: Line) -> Said:
        """What a line says; None for nothing, a comment.

        Raises:
            InputError: it says nothing that there is; the line is named by the caller. All else
                is the grammar's own fault (`PluginFault`).
        """
        raise NotImplementedError

    def ended(self) -> None:
        """The text ends here.

        Raises:
            InputError: something in it has only begun.
        """


@dataclass(frozen=True)
class LineProgram:
    """The routines of some files.

    Args:
        file: the name of the first.
        texts: of the files, by name.
        routines: by `routine_key`; the lines before the first named one are called "", and need
            not be there.
        points: points by file and `point_key`.
        data: what registers hold at first.
        own: keys of the routines of the first file that have names, in order.
    """

    file: str
    texts: Mapping[str, str]
    routines: Mapping[str, Body]
    points: Mapping[tuple[str, str, int | None], NumberedPoint] = field(default_factory=dict)
    data: Initial = field(default_factory=dict)
    own: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "routines", {"": Body(), **self.routines})

    def text_of(self, span: Span) -> str:
        """The text that stands at a place."""
        return self.texts[span.file][span.start : span.end]

    def with_file(self, other: LineProgram) -> LineProgram:
        """The same with the routines of another file; of two of one name the first counts. Lines
        of that file that stand in no routine are one that is called as the file is."""
        unnamed = {routine_key(PurePath(other.file).stem): other.routines[""]}
        return replace(
            self,
            texts={**other.texts, **self.texts},
            routines={
                **(unnamed if other.routines[""].statements else {}),
                **other.routines,
                **self.routines,
            },
            points={**other.points, **self.points},
            data={**other.data, **self.data},
        )


def plain_lines(source: SourceText, comment: str = "") -> Iterator[Line]:
    """The lines of a text that are not blank.

    Args:
        comment: what begins a comment behind a statement, outside of quotes; ``""`` for none.
    """
    sign = re.escape(comment) or "(?!)"
    quotes = "|".join(f"{q}[^{q}]*{q}" for q in "\"'" if not comment.startswith(q))
    spoken = re.compile(rf"(?:{quotes}|(?!{sign}).)*")
    for found in _LINE.finditer(source.text):
        said = spoken.match(found[0])
        words = "" if said is None else said[0].strip()
        if words:
            start = found.start() + len(found[0]) - len(found[0].lstrip())
            yield Line(source, start, start + len(words))


def pieces(source: SourceText, pattern: re.Pattern[str]) -> Iterator[Line]:
    """The statements of a text in which a line is not one: the group ``text`` of what fits.

    Raises:
        SourceError: something fits nowhere.
    """
    at, text = 0, source.text
    for found in (*pattern.finditer(text), None):
        left = text[at : found.start() if found else len(text)]
        if left.strip():
            start = at + len(left) - len(left.lstrip())
            words = " ".join(left.split())[:40]
            raise source.error(
                f"{words!r} is no statement: what begins or ends one is missing", start
            )
        if found is not None:
            at, words = found.end(), (found["text"] or "").rstrip()
            if words:
                yield Line(source, found.start("text"), found.start("text") + len(words))


def read_lines(
    text: str,
    file: str,
    grammar: Grammar,
    name: str,
    lines: Callable[[SourceText], Iterable[Line]] = plain_lines,
) -> LineProgram:
    """The routines of a text.

    Args:
        text: of the file.
        file: its name, for messages.
        grammar: of the language.
        name: of the language, for messages.
        lines: what of the text is one statement each.

    Raises:
        SourceError: a line is no statement, or a routine, label or point is there twice.
    """
    source = SourceText(unbroken(text), file)
    routines: dict[str, list[Statement]] = {"": []}
    points: dict[tuple[str, str, int | None], NumberedPoint] = {}
    own, labels, names = routines[""], set[str](), {"": ""}
    for line, statement in _statements(source, grammar, name, lines):
        if isinstance(statement, Routine):
            key = routine_key(statement.name)
            if key in routines:
                raise SourceError(f"there are two routines {statement.name}", line.span)
            names[key] = statement.name
            own, labels = routines.setdefault(key, []), set()
        elif isinstance(statement, NumberedPoint):
            point = file, *point_key(statement.datum)
            if point in points:
                raise SourceError(f"there are two points {line.text.split()[0]}", line.span)
            points[point] = statement
        else:
            if isinstance(statement, Label) and statement.name in labels:
                raise SourceError(f"there are two labels {statement.name}", line.span)
            labels |= {statement.name} if isinstance(statement, Label) else set()
            own.append(statement)
    bodies = {key: Body(tuple(nested(said)), names[key]) for key, said in routines.items()}
    named = tuple(key for key in bodies if key)
    return LineProgram(file, {file: text}, bodies, points, own=named)


def routine_key(name: str) -> str:
    """Under which a routine, or the file of one, is found: in lower case, a number without zeros
    before it (``CALL 12`` is of ``0012.JOB``)."""
    return (name.lstrip("0") or "0") if name.isdecimal() else name.lower()


def point_key(datum: Datum) -> tuple[str, int | None]:
    """Under which a point is found, that has a written number or none.

    Raises:
        SourceError: its number is computed.
    """
    if datum.index is None:
        return datum.word, None
    value = getattr(datum.index, "value", None)
    if isinstance(value, bool) or not isinstance(value, float) or not value.is_integer():
        raise SourceError("a point that is defined has a whole number", datum.span)
    return datum.word, int(value)


def _statements(
    source: SourceText,
    grammar: Grammar,
    name: str,
    lines: Callable[[SourceText], Iterable[Line]],
) -> Iterator[tuple[Line, Statement]]:
    every = list(lines(source))
    for number, line in enumerate(every, 1):
        try:
            said = several(grammar.statement(line))
            if number == len(every):
                grammar.ended()
        except InputError as error:
            text = " ".join(source.text[line.start : line.end].split())
            raise SourceError(f"{text!r} is no {name} statement: {error}", line.span) from None
        except FlybyError:
            raise
        except Exception as error:
            raise PluginFault.of(f"{line.text!r}: the grammar", error, line.span) from error
        yield from ((line, one) for one in said)


def mostly_said(
    text: str, grammar: Grammar, lines: Callable[[SourceText], Iterable[Line]] = plain_lines
) -> bool:
    """Whether a language takes more of the lines of a text's beginning for statements, or comments,
    than it refuses and keeps."""
    known = every = 0
    try:
        for line in islice(lines(SourceText(unbroken(text), "")), _ENOUGH):
            every += 1
            with suppress(FlybyError):
                said = several(grammar.statement(line))
                known += not any(isinstance(one, Kept) for one in said)
    except FlybyError:  # the text is none of its files
        return False
    return 2 * known > every


def several(said: Said) -> tuple[Statement, ...]:
    """What a line says, as statements."""
    if said is None:
        return ()
    return tuple(said) if isinstance(said, Sequence) else (said,)
