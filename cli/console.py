"""What the command line prints, and where: results on stdout, all else on stderr."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from ..core.display import shown

WIDE = 160
"""Columns of a table that goes into a file or a pipe."""


def print_json(value: object) -> None:
    """Print a value as JSON, keys in their order."""
    print(json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False))


def print_rich(*parts: Any) -> None:
    """Print Rich tables and texts."""
    from rich.console import Console

    console = Console(highlight=False, markup=False, emoji=False)
    if not console.is_terminal:
        console.width = WIDE
    for part in parts:
        console.print(shown(part) if isinstance(part, str) else part)


def print_table(
    columns: Sequence[tuple[str, str]], rows: Sequence[Sequence[str]], title: str | None = None
) -> None:
    """Print a table.

    Args:
        columns: heading and ``left`` or ``right`` of each.
        rows: cells; what stands in brackets is text, not markup.
        title: above the table.
    """
    from rich.box import SIMPLE_HEAD
    from rich.table import Table
    from rich.text import Text

    table = Table(box=SIMPLE_HEAD, title=title, title_justify="left", pad_edge=False)
    for heading, justify in columns:
        numeric = justify == "right"
        table.add_column(
            heading,
            justify="right" if numeric else "left",
            no_wrap=numeric,
            overflow="fold",
        )
    for row in rows:
        table.add_row(*(Text(shown(cell)) for cell in row))
    print_rich(table)


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
