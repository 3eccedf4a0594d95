"""A text of lines and cells: which character divides them, which line names them."""

from __future__ import annotations

import contextlib
import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.arrays import FloatArray, IntArray
from ...core.errors import InputError
from .text import lines_of, read_text

DELIMITERS = (";", "\t", ",")
"""Looked for in this order, since a semicolon or a tab leaves the comma to the decimals."""
_LARGEST = 1e30
"""Nanoseconds since 1970 are fewer; squares of larger numbers overflow."""
_EXCEL = re.compile(r"sep=(.)")
"""A first line that spreadsheets write and hide."""


@dataclass(frozen=True, eq=False)
class Table:
    """Named columns of text.

    Args:
        file: for messages.
        names: of the columns; empty if the first line holds numbers.
        head: line of the names, or of the first sample.
        rows: cells of each sample.
        lines: (T,) line of each sample.
        decimal_comma: whether numbers may be written with a comma.
        notes: what was left out.
    """

    file: str
    names: tuple[str, ...]
    head: int
    rows: tuple[Sequence[str], ...]
    lines: IntArray
    decimal_comma: bool
    notes: tuple[str, ...] = ()

    def index(self, column: str | int) -> int:
        """Place of a column that is given by its name, or by its number from 1.

        Raises:
            InputError: there is none, or there are several.
        """
        if isinstance(column, int):
            width = len(self.names) or len(self.rows[0])
            if not 1 <= column <= width:
                raise InputError(f"{self.file}:{self.head}: there is no column {column}")
            return column - 1
        found = self.names.count(column)
        if found == 1:
            return self.names.index(column)
        what = "is missing" if found == 0 else f"stands {found} times in the header"
        shown = ", ".join(self.names[:12]) or "none is named"
        raise InputError(f"{self.file}:{self.head}: column {column!r} {what}; columns: {shown}")

    def numbers(self, columns: Sequence[str | int]) -> FloatArray:
        """The numbers (T, C) of columns.

        Raises:
            InputError: naming line and column.
        """
        places = [self.index(column) for column in columns]
        twice = [c for c, place in zip(columns, places, strict=True) if places.count(place) > 1]
        if twice:
            raise InputError(f"{self.file}: column {twice[0]!r} is asked for twice")
        values = np.empty((len(self.rows), len(places)))
        for k, row in enumerate(self.rows):
            for j, place in enumerate(places):
                values[k, j] = self._number(row, place, k, columns[j])
        return values

    def _number(self, row: Sequence[str], place: int, k: int, column: str | int) -> float:
        where = f"{self.file}:{self.lines[k]}"
        if place >= len(row):
            raise InputError(f"{where}: the line has no column {column!r}")
        cell = row[place]
        try:
            value = float(cell.replace(",", ".") if self.decimal_comma else cell)
        except ValueError:
            raise InputError(f"{where}: column {column!r}: {cell[:40]!r} is no number") from None
        if not abs(value) <= _LARGEST:
            raise InputError(
                f"{where}: column {column!r}: {cell[:40]!r} is not finite, or beyond any quantity; "
                "delete the line, if the others are sound"
            )
        return value


def read_table(path: Path, delimiter: str | None = None) -> Table:
    """The table in a text file.

    Lines that begin with ``#`` are comments, but the first line of the file may name the columns
    behind one. A last line that breaks off is left out.

    Args:
        path: the file.
        delimiter: between cells; None to find it (semicolon, tab, comma, else spaces).

    Raises:
        InputError: there is no table.
    """
    return parse_table(read_text(path), str(path), delimiter)


def parse_table(text: str, file: str, delimiter: str | None = None) -> Table:
    """See `read_table`."""
    numbered = [(k, line) for k, line in enumerate(lines_of(text), 1) if line.strip()]
    if not numbered:
        raise InputError(f"{file}: an empty log")
    told = _EXCEL.fullmatch(numbered[0][1].strip())
    if told is not None:
        numbered, delimiter = numbered[1:], delimiter or told[1]
    if not numbered:
        raise InputError(f"{file}: an empty log")
    head, first = numbered[0]
    delimiter = _delimiter(first) if delimiter is None else delimiter
    names = _cells(first.lstrip("# \t") if first.startswith("#") else first, delimiter)
    body = [(k, line) for k, line in numbered[1:] if not line.lstrip().startswith("#")]
    if _all_numbers(names):
        names, body = [], [(head, first), *body]
    rows = [_cells(line, delimiter) for _, line in body]
    notes: tuple[str, ...] = ()
    if len(rows) > 1 and len(rows[-1]) < len(rows[-2]):
        rows, body = rows[:-1], body[:-1]
        notes = ("the last line breaks off and is left out",)
    _check_width(names, rows, body, file, delimiter)
    lines = np.array([k for k, _ in body], dtype=np.int64)
    commas = delimiter != "," or '"' in text
    return Table(file, tuple(names), head, tuple(rows), lines, commas, notes)


def _check_width(
    names: Sequence[str],
    rows: Sequence[Sequence[str]],
    body: Sequence[tuple[int, str]],
    file: str,
    delimiter: str,
) -> None:
    """Refuse a line with more cells than there are names; empty ones at its end do not count.

    Raises:
        InputError: naming the line.
    """
    if not names:
        return
    for (line, _), row in zip(body, rows, strict=True):
        if len(row) > len(names) and any(row[len(names) :]):
            commas = ": with decimal commas, divide by semicolons" if delimiter == "," else ""
            raise InputError(
                f"{file}:{line}: the line has {len(row)} cells, the header {len(names)}{commas}"
            )


def _delimiter(line: str) -> str:
    return next((d for d in DELIMITERS if d in line), " ")


def _cells(line: str, delimiter: str) -> list[str]:
    cells = line.split() if delimiter == " " else line.split(delimiter)
    if delimiter != " " and '"' in line:
        # What stands in quotes may hold delimiters; a cell too long for a table is none of quotes.
        with contextlib.suppress(csv.Error):
            cells = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True))
    return [cell.strip().strip('"').strip() for cell in cells]


def _all_numbers(cells: Sequence[str]) -> bool:
    try:
        [float(cell.replace(",", ".")) for cell in cells if cell]
    except ValueError:
        return False
    return any(cells)
