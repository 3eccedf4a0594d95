"""How far a search of programs has come."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Progress:
    """How far the work has come, for a progress bar.

    Args:
        stage: what is being done, in words.
        done, total: searches, or programs, of this stage.
        best: lowest objective of a block that is proven so far, in shares of the input's; 1 if
            none is proven yet, or none is wanted.
    """

    stage: str
    done: int
    total: int
    best: float = 1.0


Report = Callable[[Progress], bool | None]
"""Called with progress; True ends the work with what has been found."""
