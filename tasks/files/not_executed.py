"""Notes where a changed datum is used by code that was not driven, and so not proven."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...core.door import spelt, switched
from ...core.errors import InputError, Note

if TYPE_CHECKING:
    from ...core.program.program import Program
    from ...core.source.not_executed.search import NotExecuted
    from ...core.vendor import Vendor

_SHOWN = 5
"""Lines that a note names."""


def not_executed_notes(before: Program, after: Program, vendor: Vendor) -> tuple[Note, ...]:
    """Where a new program changes more than what was driven.

    Args:
        before: as it was read.
        after: as it is read from its new text; the same object where nothing has changed.
        vendor: whose language it is.
    """
    from ...core.source.not_executed.search import not_executed

    wording = None if vendor.speaks is None else vendor.speaks.wording
    if wording is None or after is before or _is_anew(before, after):
        return ()
    return tuple(map(_note, not_executed(before, after, wording)))


def refuse_not_executed(notes: Sequence[Note]) -> None:
    """Refuse to put the new program in the place of the old one.

    Raises:
        InputError: there are such places.
    """
    if notes:
        raise InputError(
            f"{switched('in_place')}: nothing was written, since code that was not driven uses "
            f"changed data (see the warnings): {spelt('keep')} these moves, or name a folder by "
            f"{spelt('out')} and look at that code"
        )


def _note(found: NotExecuted) -> Note:
    lines = list(dict.fromkeys(str(place.line) for place in found.places))
    more = f" and {len(lines) - _SHOWN} more" if len(lines) > _SHOWN else ""
    where = f"line{'s' if len(lines) > 1 else ''} {', '.join(lines[:_SHOWN])}{more}"
    return Note(
        f"{found.datum} has changed, and is also used in {where}, which this run has not driven: "
        "nothing is proven of what happens there",
        found.move,
        found.places[0],
    )


def _is_anew(before: Program, after: Program) -> bool:
    """Whether the statements are others: such a program is no change of the old one's files."""
    old, new = before.statements, after.statements
    return [type(s) for s in old] != [type(s) for s in new]
