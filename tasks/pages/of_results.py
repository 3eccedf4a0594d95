"""The page of any result that has one."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from ...core.errors import InputError

if TYPE_CHECKING:
    from ...drawing.page.content import (
        Page,
    )

BUILDERS = {
    "ChangedStation": "changed_station_page",
    "Comparison": "comparison_page",
    "DrivenStation": "station_page",
    "Findings": "findings_page",
    "IdentifiedModel": "identified_page",
    "PaintedPart": "painted_page",
    "ProgramFront": "front_page",
    "Run": "run_page",
    "Solution": "solution_page",
    "StateDifference": "difference_page",
    "Translation": "translation_page",
}
"""By the class of a result: the module here whose function of the same name makes its page."""


def page_of(result: Any, **context: Any) -> Page:
    """What the page of a result shows.

    Args:
        result: what a task returns.
        context: what the result does not know itself; see the function that makes its page.

    Raises:
        InputError: there is none of such a result.
    """
    for kind in type(result).__mro__:
        name = BUILDERS.get(kind.__name__)
        if name is not None:
            made: Page = getattr(import_module(f".{name}", __package__), name)(result, **context)
            return made
    known = ", ".join(sorted(BUILDERS))
    raise InputError(f"there is no page of {type(result).__name__}; there are of {known}")


def page_bytes(result: Any, **context: Any) -> bytes:
    """The file of the page of a result; see `page_of`.

    Raises:
        InputError: there is none of such a result.
    """
    from ...drawing.page.html import page_html

    return page_html(page_of(result, **context))
