"""What the command line prints, and where: results on stdout, all else on stderr."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ..core.display import shown

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

UNBOUNDED = 10_000
WIDE = 180
"""Columns of a table that goes into a file or a pipe."""


def print_json(value: object) -> None:
    """Print a value as JSON, keys in their order."""
    print(json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False))


def print_rich(*parts: Any) -> None:
    """Print Rich tables and texts."""
    console = _console()
    for part in parts:
        console.print(shown(part) if isinstance(part, str) else part)


def _console() -> Console:
    from rich.console import Console

    console = Console(highlight=False, markup=False, emoji=False)
    if not console.is_terminal:
        console.width = WIDE
    return console


def print_table(
    columns: Sequence[tuple[str, str]], rows: Sequence[Sequence[str]], title: str | None = None
) -> None:
    """Print a table; one that is wider than the terminal in parts, so that nothing is cut.

    Args:
        columns: heading and ``left`` or ``right`` of each.
        rows: cells; what stands in brackets is text, not markup.
        title: above the table.
    """
    console = _console()
    parts = _parts(columns, rows, console)
    for part in parts:
        console.print(_table(part, columns, rows, title))
    if len(parts) > 1:
        print_rich(
            f"the table is in {len(parts)} parts, as it does not fit into {console.width} columns; "
            "--json has it whole"
        )


def _parts(
    columns: Sequence[tuple[str, str]], rows: Sequence[Sequence[str]], console: Console
) -> list[list[int]]:
    """Which columns stand side by side: all if they fit, else as many as do.

    Each part begins with the columns that name every row.
    """
    from rich.measure import Measurement

    options = console.options.update(width=UNBOUNDED)
    named = (k for k in range(1, len(columns)) if all(any(row[:k]) for row in rows))
    key = list(range(next(named, 1)))
    parts = [key]
    for column in range(len(key), len(columns)):
        wider = [*parts[-1], column]
        needed = Measurement.get(console, options, _table(wider, columns, rows)).minimum
        if needed <= console.width or parts[-1] == key:
            parts[-1] = wider
        else:
            parts.append([*key, column])
    return parts


def _table(
    chosen: Sequence[int],
    columns: Sequence[tuple[str, str]],
    rows: Sequence[Sequence[str]],
    title: str | None = None,
) -> Table:
    """The chosen columns of a table."""
    from rich.box import SIMPLE_HEAD
    from rich.cells import cell_len
    from rich.table import Table
    from rich.text import Text

    table = Table(box=SIMPLE_HEAD, title=title, title_justify="left", pad_edge=False)
    for k, (heading, justify) in ((k, columns[k]) for k in chosen):
        numeric = justify == "right"
        lines = [*heading.split("\n"), *(shown(row[k]) for row in rows)] if numeric else []
        table.add_column(
            heading,
            justify="right" if numeric else "left",
            no_wrap=numeric,
            min_width=max(map(cell_len, lines), default=None),
            overflow="fold",
        )
    for row in rows:
        table.add_row(*(Text(shown(row[k])) for k in chosen))
    return table


def warn(message: str) -> None:
    """Print a warning."""
    _complain("warning", "yellow", message)


def fail(message: str) -> None:
    """Print an error."""
    _complain("error", "bold red", message)


def _complain(label: str, style: str, message: str) -> None:
    from rich.console import Console
    from rich.text import Text

    text = Text.assemble((f"{label}: ", style), shown(message))
    Console(stderr=True, highlight=False).print(text, soft_wrap=True)


@contextmanager
def progress(message: str) -> Iterator[Callable[[str], None]]:
    """Show a line that moves while work goes on, if someone is looking.

    Yields:
        What changes the message.
    """
    if not sys.stderr.isatty():
        yield lambda message: None
        return
    from rich.console import Console

    with Console(stderr=True).status(message) as status:
        yield lambda message: status.update(message)
