"""What the command line prints, and where: results on stdout, all else on stderr."""

from __future__ import annotations

import json
import os
import shutil
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any
from unicodedata import combining, east_asian_width

from ...core.display import alike, shown
from ...core.errors import Note
from ...core.files.archive import named_as_packed

WIDE = 180
"""Columns of a table that goes into a file or a pipe."""
TOLD_EVERY = 30.0
"""s between lines that tell of long work where nobody looks."""
_BETWEEN = 3
"""Blanks between columns."""
_DRAWN_ANYWAY = ("FORCE_COLOR", "TTY_COMPATIBLE", "TTY_INTERACTIVE")
"""Variables that tell Rich to write as to a terminal."""


def print_json(value: object) -> None:
    """Print a value as JSON, keys in their order."""
    print(named_as_packed(json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False)))


def print_rich(*texts: str) -> None:
    """Print texts, each from the beginning of a line."""
    for text in texts:
        _print(_shown(text))


def _shown(text: str) -> str:
    """A text on one line, with files of archives called by the archives' names."""
    return shown(named_as_packed(text))


def _print(text: str, style: str = "", *, whole: bool = False) -> None:
    """Print on stdout; in a terminal styled, and broken between words unless it is to be whole."""
    if _plain(sys.stdout):
        print(text)
        return
    from rich.console import Console
    from rich.text import Text

    Console(highlight=False).print(Text(text, style), soft_wrap=whole)


def _plain(stream: Any) -> bool:
    """Whether text goes to a file or a pipe as it is. Rich is not even imported then."""
    if stream is not None and stream.isatty():
        return False
    return not any(os.environ.get(name) for name in _DRAWN_ANYWAY)


def print_table(
    columns: Sequence[tuple[str, str]], rows: Sequence[Sequence[str]], title: str | None = None
) -> None:
    """Print a table; one that is wider than the terminal in parts, so that nothing is cut.

    Args:
        columns: heading and ``left`` or ``right`` of each.
        rows: cells.
        title: above the table.
    """
    room = WIDE if _plain(sys.stdout) else shutil.get_terminal_size().columns
    made = [
        _Column(heading, justify == "right", [_shown(row[k]) for row in rows])
        for k, (heading, justify) in enumerate(columns)
    ]
    named = (k for k in range(1, len(columns)) if all(any(row[:k]) for row in rows))
    parts = _parts(made, next(named, 1), room)
    for part in parts:
        if title is not None:
            _print(_shown(title), "italic")
        for line, style in _lines(part, len(rows), room):
            _print(line, style, whole=True)
    if len(parts) > 1:
        told = f"the table is in {len(parts)} parts, as it does not fit into {room} columns; "
        print_rich(*_broken(f"{told}--json has it whole", room))


@dataclass(frozen=True)
class _Column:
    """Heading and cells; those of numbers stay in one line, texts are broken where they must."""

    heading: str
    numbers: bool
    cells: Sequence[str]

    def widest(self) -> int:
        """Columns of the terminal that it takes if nothing is broken."""
        return max(_width(line) for cell in self._all() for line in cell.split("\n"))

    def narrowest(self) -> int:
        """Columns of the terminal that it takes at the least."""
        if self.numbers:
            return self.widest()
        return max((_width(word) for cell in self._all() for word in cell.split()), default=1)

    def _all(self) -> list[str]:
        return [self.heading, *self.cells]


def _width(text: str) -> int:
    """Columns of the terminal that a text takes."""
    if text.isascii():
        return len(text)
    wide = sum(east_asian_width(sign) in "WF" for sign in text)
    return len(text) + wide - sum(combining(sign) > 0 for sign in text)


def _parts(columns: Sequence[_Column], key: int, room: int) -> list[list[_Column]]:
    """Which columns stand side by side: all if they fit, else as many as do.

    Args:
        columns: of the table.
        key: how many name the rows; each part begins with those.
        room: columns of the terminal.
    """
    names = list(columns[:key])
    parts = [names]
    for column in columns[key:]:
        wider = [*parts[-1], column]
        needed = _together([one.narrowest() for one in wider])
        if needed <= room or parts[-1] == names:
            parts[-1] = wider
        else:
            parts.append([*names, column])
    return parts


def _together(widths: Sequence[int]) -> int:
    """Columns of the terminal that a table takes, with a blank at both ends."""
    return sum(widths) + _BETWEEN * (len(widths) - 1) + 2


def _lines(columns: Sequence[_Column], rows: int, room: int) -> Iterator[tuple[str, str]]:
    """The lines of a table, each with its style."""
    widths = _fitting(columns, room)
    whole = _together(widths)

    def row(cells: Sequence[str], *, low: bool) -> Iterator[str]:
        broken = [_broken(cell, width) for cell, width in zip(cells, widths, strict=True)]
        height = max(map(len, broken))
        for at in range(height):
            placed = []
            for lines, column, width in zip(broken, columns, widths, strict=True):
                line = at - (height - len(lines) if low else 0)
                text = lines[line] if 0 <= line < len(lines) else ""
                blanks = " " * (width - _width(text))
                placed.append(blanks + text if column.numbers else text + blanks)
            yield f" {(_BETWEEN * ' ').join(placed)} "

    yield " " * whole, ""
    for line in row([column.heading for column in columns], low=True):
        yield line, "bold"
    yield f" {'─' * (whole - 2)} ", ""
    for k in range(rows):
        for line in row([column.cells[k] for column in columns], low=False):
            yield line, ""
    yield " " * whole, ""


def _fitting(columns: Sequence[_Column], room: int) -> list[int]:
    """Widths of columns: of those of text, the widest give way until all fit."""
    widths = [column.widest() for column in columns]
    # Where not even the narrowest fit, words are broken.
    least = [width if column.numbers else 1 for column, width in zip(columns, widths, strict=True)]
    for floors in ([column.narrowest() for column in columns], least):
        while _together(widths) > room:
            spare = [k for k, floor in enumerate(floors) if widths[k] > floor]
            if not spare:
                break
            widths[max(spare, key=lambda k: widths[k])] -= 1
    return widths


def _broken(text: str, width: int) -> list[str]:
    """A text in lines no wider than ``width``, between words where it can be."""
    if "\n" not in text and _width(text) <= width:
        return [text]
    lines = []
    for line in text.split("\n"):
        filled = ""
        for word in line.split(" "):
            longer = f"{filled} {word}" if filled else word
            if _width(longer) <= width:
                filled = longer
                continue
            if filled:
                lines.append(filled)
            filled = ""
            for sign in word:
                if filled and _width(filled + sign) > width:
                    lines.append(filled)
                    filled = ""
                filled += sign
        lines.append(filled)
    return lines


def warn(message: str) -> None:
    """Print a warning."""
    _complain("warning", "yellow", message)


def warn_of(notes: Iterable[Note]) -> None:
    """Print warnings, those that say the same of several places in one line: the first, and how
    many there are."""
    for same in alike(notes, lambda note: note.message):
        more = f" (and {len(same) - 1} like it)" if len(same) > 1 else ""
        warn(f"{same[0]}{more}")


def complain_of_fault(message: str) -> None:
    """Print what cannot be driven."""
    _complain("fault", "bold red", message)


def fail(message: str) -> None:
    """Print an error."""
    _complain("error", "bold red", message)


def _complain(label: str, style: str, message: str) -> None:
    if _plain(sys.stderr):
        print(f"{label}: {_shown(message)}", file=sys.stderr)
        return
    from rich.console import Console
    from rich.text import Text

    text = Text.assemble((f"{label}: ", style), _shown(message))
    Console(stderr=True, highlight=False).print(text, soft_wrap=True)


@contextmanager
def progress(message: str) -> Iterator[Callable[[str], None]]:
    """Show a line that moves while work goes on; where nobody looks, a line now and then.

    Yields:
        What changes the message.
    """
    if not sys.stderr.isatty():
        told = time.monotonic()

        def tell(message: str) -> None:
            nonlocal told
            if time.monotonic() - told > TOLD_EVERY:
                told = time.monotonic()
                print(_shown(message), file=sys.stderr, flush=True)

        yield tell
        return
    from rich.console import Console

    with Console(stderr=True).status(message) as status:
        yield lambda message: status.update(message)
