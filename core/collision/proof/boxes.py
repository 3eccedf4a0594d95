"""Boxes that hold the configurations of a path on intervals, with bounds of their rates."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray


class Boxes(NamedTuple):
    """Enclosures of q on M intervals, derivatives by t from −1 to 1.

    Args:
        q: (M, N), at the middle.
        rate: (M, N), dq/dt at the middle.
        reach: (M, N), bounds of |q − q(0)|.
        first, second: (M, N), bounds of |dq/dt| and |d²q/dt²|.
        conditioning: (M,), smallest over largest pivot of the Jacobian at the middle, 1 where
            no inverse kinematics is needed.
        verified: (M,) bool, whether the bounds hold.
    """

    q: FloatArray
    rate: FloatArray
    reach: FloatArray
    first: FloatArray
    second: FloatArray
    conditioning: FloatArray
    verified: NDArray[np.bool_]

    @staticmethod
    def empty(count: int, size: int) -> Boxes:
        """``count`` boxes to be filled, none of them verified."""
        q, rate, reach, first, second = np.zeros((5, count, size))
        verified = np.zeros(count, dtype=np.bool_)
        return Boxes(q, rate, reach, first, second, np.ones(count), verified)

    @staticmethod
    def at(q: FloatArray) -> Boxes:
        """One box that holds a configuration (N,) alone."""
        box = Boxes.empty(1, len(q))
        box.q[0], box.verified[0] = q, True
        return box
