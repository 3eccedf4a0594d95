"""One run of a robot, as it was logged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.program.program import Program

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LoggedRun:
    """One run.

    Args:
        name: of the file.
        robot: name in the catalogues.
        real: whether a robot moved, not a virtual controller; None if nobody said.
        program: what it was told.
        t: (T,) s, increasing.
        q: (T, N), joints in rad, linear axes in m.
        notes: what the record says of its own uncertainties, and what the reader left out.
    """

    name: str
    robot: str
    real: bool | None
    program: Program
    t: FloatArray
    q: FloatArray
    notes: tuple[str, ...] = ()
