"""How much of a turn of the tool counts where its two parts are limited, each for itself.

A controller may take a turn apart into a *swivel*, which takes the tool's x axis the shortest way,
and a *rotation* about that axis (KUKA: ``ORI1``, ``ORI2``). With θ the whole turn and nₓ its axis's
part along the tool's x,

    swivel = 2 asin(√(1 − nₓ²) sin θ/2),    rotation = 2 |atan2(nₓ sin θ/2, cos θ/2)|,

and a limit holds for the greater of both, which is κ θ with κ ≤ 1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_NO_TURN = 1e-9
"""rad; smaller turns count whole."""


def turn_shares(turn: FloatArray) -> FloatArray:
    """κ (M,) of turns given as rotation vectors (M, 3) in the tool's axes."""
    return _shares(turn)[0]


def pull_turn_shares(turn: FloatArray, bar: FloatArray) -> FloatArray:
    """Reverse of `turn_shares`: gradient (M, 3) with respect to the turns."""
    return bar[:, None] * _shares(turn)[1]


def _shares(turn: FloatArray) -> tuple[FloatArray, FloatArray]:
    """κ and its derivative (M, 3); at a tie, that of the rotation."""
    whole = np.linalg.norm(turn, axis=1)
    turns = whole > _NO_TURN
    size = np.where(turns, whole, 1.0)
    axis = np.where(turns[:, None], turn / size[:, None], [0.0, 1.0, 0.0])
    along, across = axis[:, 0], np.hypot(axis[:, 1], axis[:, 2])
    sine, cosine = np.sin(0.5 * size), np.cos(0.5 * size)
    # tan(rotation / 2) = along tan(θ / 2); sin(swivel / 2) = across sin(θ / 2).
    rotation = 2.0 * np.arctan2(np.abs(along) * sine, cosine)
    swivel = 2.0 * np.arcsin(np.minimum(across * sine, 1.0))
    greater = swivel > rotation
    part = np.where(greater, swivel, rotation)
    square = cosine**2 + along**2 * sine**2  # cos² of half the swivel
    root = np.sqrt(np.maximum(square, _NO_TURN**2))
    by_size = np.where(greater, across * cosine / root, np.abs(along) / square)
    by_along = np.where(
        greater,
        -2.0 * along * sine / (np.maximum(across, _NO_TURN) * root),
        2.0 * np.sign(along) * sine * cosine / square,
    )
    share = np.where(turns, part / size, 1.0)
    along_slope = (np.array([1.0, 0.0, 0.0]) - along[:, None] * axis) / size[:, None]
    slope = ((by_size - part / size) / size)[:, None] * axis
    slope += (by_along / size)[:, None] * along_slope
    return share, np.where(turns[:, None], slope, 0.0)
