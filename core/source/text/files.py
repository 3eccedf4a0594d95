"""Source files as text, and places in them."""

from __future__ import annotations

import codecs
import re
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Self

from ...errors import InputError, Note, ParseError, SourceError, Span
from ...files.reading import read_bytes
from .damage import Damage

_WIDE = {"utf-16-le": codecs.BOM_UTF16_LE, "utf-16-be": codecs.BOM_UTF16_BE}
"""Codecs of two bytes a character, by the mark that their files begin with."""
_SPAN = partial(tuple.__new__, Span)
"""A span of its parts, without the function of its class in between: every node has one."""
_PACKED = b"\x1f\x8b"
"""How files packed by gzip begin."""
_CONTROLS = bytes({*range(32), 127} - set(b"\t\n\f\r\x1a"))
"""Characters that no editor writes."""
_MOST_ODD = 0.02
"""Share of them in a text that is damaged."""
LARGEST_FILE = 20_000_000
"""Bytes. The largest programs seen have two million; what is larger is no program."""
MOST_LINES = 500_000
"""The longest programs seen have some 40 000."""


@dataclass(frozen=True, slots=True)
class SourceFile:
    """A source file as text, with the codec that turns it back into the same bytes.

    Args:
        name: as the user named it, for messages and spans.
        text: without a byte-order mark; ends of line as they stand in the file.
        codec: of Python's, such as ``utf-8``, ``utf-8-sig``, ``cp1252``, ``utf-16-le`` (whose files
            begin with a mark).
    """

    name: str
    text: str
    codec: str = "utf-8"

    @property
    def data(self) -> bytes:
        """The file's bytes.

        Raises:
            InputError: the text holds a character that the codec has not.
        """
        try:
            return _WIDE.get(self.codec, b"") + self.text.encode(self.codec)
        except UnicodeEncodeError as error:
            character = self.text[error.start]
            raise InputError(
                f"{self.name}: {character!r} cannot be written in the file's encoding, {self.codec}"
            ) from None

    def edited(self, stretches: Sequence[tuple[int, int, str]]) -> Self:
        """The same file with other text at some places.

        Args:
            stretches: from where, to before where, and the text that takes the place of that; in
                order, none overlapping.

        Raises:
            InputError: the file's own format has no place for one of them.
        """
        parts, at = [], 0
        for start, end, text in stretches:
            parts += [self.text[at:start], text]
            at = end
        return replace(self, text="".join([*parts, self.text[at:]]))


def read_source(path: Path) -> SourceFile:
    """A source file from disk; see `decode`.

    Raises:
        InputError: the file cannot be read, or is too large for a program.
        SourceError: its bytes are no text.
    """
    return source_of(read_bytes(path, LARGEST_FILE), str(path))


def refuse_no_text(path: Path) -> None:
    """Refuse a file that is empty, or whose bytes are no text; packed files are not looked into.

    Raises:
        InputError: it cannot be read, or holds no text.
    """
    data = read_bytes(path, LARGEST_FILE)
    if not data.strip():
        raise InputError(f"{path} is empty: no program stands in it")
    if data.startswith((_PACKED, *_WIDE.values())):
        return
    odd = len(data) - len(data.translate(None, _CONTROLS))
    if b"\0" in data or odd > _MOST_ODD * len(data):
        raise InputError(f"{path} is binary: no text of a program stands in it")


def source_of(data: bytes, name: str) -> SourceFile:
    """A source file of its bytes; see `decode`.

    Raises:
        InputError: it has too many lines for a program.
        SourceError: its bytes are no text.
    """
    if max(data.count(b"\n"), data.count(b"\r")) > MOST_LINES:
        raise InputError(f"{name}: has more than {MOST_LINES:,} lines: no robot program")
    return SourceFile(name, *decode(data, name))


def decode(source: str | bytes, file: str) -> tuple[str, str]:
    """The text of a source file, and the codec that turns the text back into the same bytes.

    Files come as UTF-8, with or without a byte-order mark, and as Windows code page 1252, which
    RobotStudio and older controllers write; in a few others (comments in GBK, say) every byte is
    kept as one Latin-1 character, which changes nothing outside comments and strings. Editors of
    Windows save UTF-16 too, which begins with a mark; `wide_file` says that controllers do not
    read it.

    Raises:
        SourceError: the bytes begin as UTF-16 does, and are none.
    """
    if isinstance(source, str):
        return source, "utf-8"
    for codec, mark in _WIDE.items():
        if source.startswith(mark):
            try:
                return source[len(mark) :].decode(codec), codec
            except UnicodeDecodeError:
                raise SourceError(
                    "the file begins as UTF-16 does and is cut off or damaged; save it as UTF-8",
                    Span(file, 1, 1, 0, 0),
                ) from None
    if source.startswith(codecs.BOM_UTF8):
        candidates = ["utf-8-sig", "latin-1"]
    else:
        candidates = ["utf-8", "cp1252", "latin-1"]
    for codec in candidates[:-1]:
        try:
            return source.decode(codec), codec
        except UnicodeDecodeError:
            continue
    return source.decode("latin-1"), "latin-1"


class SourceText:
    """A text that knows the line and column of every offset, as editors count them: ends of line
    are LF, CR LF or CR.

    Attributes:
        damage: what is wrong in it and stepped over; None where an error ends its reading.
    """

    def __init__(self, text: str, file: str, damage: Damage | None = None) -> None:
        self.text = text
        self.file = file
        self.damage = damage
        self._lines = _line_starts(text)
        self._row = 0

    def span(self, start: int, end: int) -> Span:
        """The stretch of characters from ``start`` to before ``end``."""
        lines, row = self._lines, self._row
        if not (lines[row] <= start and (row + 1 == len(lines) or start < lines[row + 1])):
            row = self._row = bisect_right(lines, start) - 1  # places asked for are often near
        return _SPAN((self.file, row + 1, start - lines[row] + 1, start, end))

    def error(self, message: str, start: int, end: int | None = None) -> SourceError:
        """An error at ``start``, to be raised."""
        return ParseError(message, self.span(start, start if end is None else end))


def unbroken(text: str) -> str:
    """A text with blanks for the carriage returns that end no line; offsets stay as they are.

    LF and CR LF end a statement or a comment; CR does in a text without LF. Nothing else does: no
    form feed, no NEL, no line separator of Unicode.
    """
    return _STRAY.sub(" ", text) if "\r" in text and "\n" in text else text


def wide_file(file: SourceFile) -> Note | None:
    """A note on an encoding that controllers do not read."""
    if file.codec not in _WIDE:
        return None
    message = "the file is UTF-16, which controllers do not read: save it as UTF-8 for them"
    return Note(message, span=Span(file.name, 1, 1, 0, 0))


def stray_return(file: SourceFile) -> Note | None:
    """A note on the first carriage return that ends no line, where editors show one."""
    text = file.text
    found = _TELLING.search(text) if "\r" in text and "\n" in text else None
    if found is None:
        return None
    return Note(
        "a carriage return without a line feed ends no line here: what follows it in a comment is "
        "comment, where an editor may show a line of its own; save the file with one kind of line "
        "end",
        span=SourceText(text, file.name).span(found.start(), found.start()),
    )


def lines_of(text: str) -> list[str]:
    """The lines of a text, without their ends."""
    return _END_OF_LINE.split(unbroken(text))


_END_OF_LINE = re.compile(r"\r\n?|\n")
_STRAY = re.compile(r"\r(?!\n)")
_TELLING = re.compile(r"\r(?!\r*\n)")
"""CR CR LF, which file transfers make of CR LF, looks like an empty line at most."""


def _line_starts(text: str) -> list[int]:
    return [0, *(found.end() for found in _END_OF_LINE.finditer(text))]
