"""How a gun with an elliptic footprint is held along sweeps: its long axis across them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ....core.arrays import FloatArray
from .projection import SprayFrames


def fan_across(frames: SprayFrames, sweep: NDArray[np.int64]) -> FloatArray:
    """(W, 3) unit vectors of the long axis, square to the spray.

    Along sweeps it points across them; on sweeps to and fro to the same side, so that the gun need
    not be turned round. In turns it goes over from one sweep's to the next one's.

    Args:
        frames: of the waypoints.
        sweep: (W,) number of each waypoint's sweep; -1 in turns, which have a sweep on both sides.
    """
    fan = frames.side
    rows = np.flatnonzero(sweep >= 0)
    before = fan[rows[0]]
    for k in rows:
        if fan[k] @ before < 0.0:
            fan[k] = -fan[k]
        before = fan[k]
    for axis in range(3):
        fan[:, axis] = np.interp(np.arange(len(fan)), rows, fan[rows, axis])
    fan -= np.einsum("ij,ij->i", fan, frames.spray)[:, None] * frames.spray
    return np.asarray(fan / np.linalg.norm(fan, axis=1, keepdims=True))
