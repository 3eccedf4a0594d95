"""When two robots may be where at once: by their clocks, at any time, or as interlocks let them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from .handed_part import HandedPart

Together = Callable[[IntArray, IntArray], tuple[NDArray[np.bool_], NDArray[np.bool_]]]
"""Of intervals of two robots: whether both can be passed at once, and at all their places."""


class InTurn(NamedTuple):
    """In which order a part changes hands.

    Args:
        brought: whether the taker comes to it only when the giver stands with it, or has left it.
        held: whether the giver lets go of it only when the taker has it.
        let_go: whether the taker drives off with it only when the giver has let go.
    """

    brought: bool
    held: bool
    let_go: bool


_UNKNOWN = InTurn(brought=False, held=False, let_go=False)


@dataclass(frozen=True)
class Meetings:
    """When two robots may be where at once.

    Args:
        clocks: what makes of own times (L, 2) s of the one, and of the other, the station's.
        apart: s by which the two clocks may be off against each other; infinite for at any time.
        together: of rows (K,) of intervals, whether the two can be there at once, and whether they
            can wherever they are on them; None for always.
        every: whether every pair of moves is looked at; else only the first conflict in time is
            looked for.
        until: s on the station's clock behind which nothing is looked for.
        in_turn: what is known of the order in which a part changes hands.
    """

    clocks: tuple[Callable[[FloatArray], FloatArray], Callable[[FloatArray], FloatArray]]
    apart: float = math.inf
    together: Together | None = None
    every: bool = True
    until: float = math.inf
    in_turn: Callable[[HandedPart], InTurn] = lambda _: _UNKNOWN

    @classmethod
    def at_any_time(cls) -> Meetings:
        """Whatever the two clocks say."""
        return cls((_as_it_is, _as_it_is))


def _as_it_is(own: FloatArray) -> FloatArray:
    return own
