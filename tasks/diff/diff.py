"""Two states of a program or a station, compared."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..options.keywords import by_keywords
from ..read import SourceOptions

if TYPE_CHECKING:
    from .comparing import StateDifference


def diff_with(before: str | Path, after: str | Path, options: SourceOptions) -> StateDifference:
    """What differs between two states of a program or a station.

    Every routine that needs no arguments is driven on both sides; where nobody says which robot,
    what needs none is compared, and the result says why (`StateDifference.undriven`).

    Args:
        before, after: programs, folders or backups.

    Raises:
        FlybyError: one of them cannot be read at all, or of neither can anything be
            read.
    """
    from .comparing import compared

    return compared(Path(before), Path(after), options)


diff = by_keywords(diff_with, SourceOptions)
