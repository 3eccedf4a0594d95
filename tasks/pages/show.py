"""Results as a page in a browser: cell, program and clock in one file."""

from __future__ import annotations

import re
import tempfile
import webbrowser
from pathlib import Path
from typing import Any

from ..files.outputs import page_name
from .of_results import page_bytes


def report(result: Any, file: str | Path) -> Path:
    """Write a result as a page to look at in a browser: one HTML file that needs no network.

    Args:
        result: what a task returns: a run, a changed program, ….
        file: to write; its name ends in ``.html``. One that exists is replaced.

    Returns:
        The file.

    Raises:
        InputError: there is no page of such a result, or the file cannot be written.
    """
    from ...core.files.writing import write_file

    path = Path(file)
    page_name(path, "file")
    write_file(path, page_bytes(result))
    return path


def show(result: Any) -> Path | None:
    """Show a result: in a notebook in a frame, else in the browser.

    Returns:
        The file that the browser opens, in a temporary folder; None in a notebook.

    Raises:
        InputError: there is no page of such a result.
    """
    made = page_bytes(result)
    if _in_notebook():
        from IPython.display import HTML, display

        from ...drawing.page.html import page_frame

        display(HTML(page_frame(made)))
        return None
    path = temporary_page(made, "flyby")
    open_page(path)
    return path


def temporary_page(page: bytes, name: str) -> Path:
    """A page as a file in a folder of its own among temporary files."""
    from ...core.files.writing import write_file

    plain = re.sub(r"[^\w.-]+", "_", name).strip("._") or "page"
    path = Path(tempfile.mkdtemp(prefix="flyby-")) / f"{plain[:80]}.html"
    write_file(path, page)
    return path


def open_page(path: Path) -> bool:
    """Open a page in the user's browser; False where none is found."""
    try:
        return webbrowser.open(path.resolve().as_uri())
    except webbrowser.Error:
        return False


def _in_notebook() -> bool:
    try:
        from IPython import get_ipython
    except ImportError:
        return False
    shell = get_ipython()
    return shell is not None and type(shell).__name__ == "ZMQInteractiveShell"
