"""The file that a command's page goes into."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ..files.outputs import check_outputs, page_name, write_all

OPTION = "--report"


def check_page(file: Path | None, inputs: Iterable[Path], replace_existing: bool) -> None:
    """Refuse a page's file before work begins; None is fine.

    Raises:
        InputError: it has another name than pages have, or cannot or must not be written.
    """
    if file is not None:
        page_name(file, OPTION)
        check_outputs({OPTION: file}, inputs, replace_existing)


def write_page(file: Path | None, result: Any, **context: Any) -> list[Path]:
    """Write the page of a result, if it has a file; returns what was written.

    Args:
        file: None for nothing.
        result, context: see `flyby.tasks.pages.of_results.page_of`.

    Raises:
        InputError: there is no page of such a result, or the file cannot be written.
    """
    if file is None:
        return []
    from .of_results import page_bytes

    write_all(OPTION, {file: page_bytes(result, **context)})
    return [file]
