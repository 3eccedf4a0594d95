"""How hard to try."""

from __future__ import annotations

from dataclasses import dataclass

from ....checks import of_kind, positive, whole
from ..motion.scheme import SchemeKind
from .aiming import MOST_TRIALS


@dataclass(frozen=True)
class MotionEffort:
    """Settings of a search.

    Args:
        intervals: of the first grid, roughly.
        scheme: what the motion is between nodes.
        group: intervals that stretch together; None for whole legs between waypoints, which is a
            fixed grid in scaled time where there is one leg.
        tolerance: share by which limits may be exceeded between nodes.
        gain: share of the objective below which an outer iteration counts as the last one.
        outer: outer iterations at most.
        box: rad or m by which joints may move at first in an outer iteration, near obstacles.
        trials: ways of taking tangents beside the motion that are tried where it is stuck; fewer
            are quicker.

    Raises:
        InputError: a number out of its range.
    """

    intervals: int = 60
    scheme: SchemeKind = SchemeKind.LINEAR
    group: int | None = None
    tolerance: float = 1e-3
    gain: float = 2e-4
    outer: int = 60
    box: float = 0.2
    trials: int = MOST_TRIALS

    def __post_init__(self) -> None:
        for name in ("intervals", "outer"):
            whole(f"MotionEffort.{name}", getattr(self, name), 1)
        whole("MotionEffort.trials", self.trials, 0, MOST_TRIALS)
        if self.group is not None:
            whole("MotionEffort.group", self.group, 1)
        of_kind("MotionEffort.scheme", self.scheme, SchemeKind)
        for name in ("tolerance", "gain", "box"):
            positive(f"MotionEffort.{name}", getattr(self, name))
