"""Where a robot does not keep up with the speeds that a coat needs."""

from __future__ import annotations

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import Note
from ..coating.coat import Coat
from ..spray.trajectory import PaintTrajectory
from .stretch import Stretch, describe

WORSE = 0.01
"""Root-mean-square error, as a share of the target, by which a coat may be worse without a word."""
LATE = 1.1
"""Ratio of driven and programmed time from which on a segment counts as late."""


def lag_notes(
    planned: PaintTrajectory, took: FloatArray, coat: Coat, wanted: Coat
) -> tuple[Note, ...]:
    """Why a coat is farther from its target as emulated than as planned, in its mean or evenness.

    Args:
        planned: as programmed.
        took: (S,) s that its segments take as emulated.
        coat: as emulated.
        wanted: as planned.
    """
    off, planned_off = coat.rms_error, wanted.rms_error
    if off - planned_off <= WORSE * coat.target:
        return ()
    head = (
        f"as emulated the coat is worse than planned: {1e6 * off:.2f} µm off the target (root mean "
        f"square) against {1e6 * planned_off:.2f} µm"
    )
    late = np.flatnonzero(took > LATE * planned.duration)
    if len(late) == 0:
        return (Note(f"{head}; smaller zones follow the curve more closely"),)
    ends = np.flatnonzero(np.diff(late) > 1)
    runs = np.split(late, ends + 1)
    worst = max(runs, key=lambda run: float((took - planned.duration)[run].sum()))
    ratio = float(took[worst].sum() / planned.duration[worst].sum())
    stretch = Stretch(int(worst[0]), int(worst[-1]) + 1)
    return (
        Note(
            f"{head}; the robot takes {ratio:.2g} times as long as programmed on "
            f"{describe(planned, stretch)}: a lower largest speed, larger zones or another place "
            "of the part let it keep up"
        ),
    )
