"""Notes on samples of a motion that exceed a limit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..errors import Note

_EXCESS = 1.02
"""Share of a limit from which on it is reported."""


def excesses(
    what: str, share: NDArray[np.float64], axis_names: Sequence[str], moves: NDArray[np.int64]
) -> list[Note]:
    """Moves whose samples, (T, L) shares of limits, exceed a limit."""
    notes = []
    for move in np.unique(moves[share.max(axis=1) > _EXCESS]):
        rows = share[moves == move]
        axis = int(np.argmax(rows.max(axis=0)))
        notes.append(
            Note(
                f"{what} of joint {axis_names[axis]} reaches {100 * rows.max():.0f} % of its limit "
                "between samples of the path; treat the timing of this move with care",
                int(move),
            )
        )
    return notes
