"""How hard to try."""

from __future__ import annotations

from dataclasses import dataclass

from ....checks import of_kind, positive, whole
from ..motion.scheme import SchemeKind
from .aiming import MOST_TRIALS


@dataclass(frozen=True)
class Effort:
    """Settings of a search.

    Args:
        intervals: of the first grid, roughly.
        scheme: what the motion is between nodes.
        group: intervals that stretch together; None for whole legs between waypoints, which is a
            fixed grid in scaled time where there is one leg.
        tolerance: share by which limits may be exceeded between nodes.
        solver_tolerance: of the KKT conditions and of constraints.
        gain: share of the objective below which an outer iteration counts as the last one.
        outer: outer iterations at most.
        box: rad or m by which joints may move at first in an outer iteration, near obstacles.
        places: on each interval, where distances are linearised.
        slots: pairs of bodies at most whose distance is linearised at a place.
        trials: ways of taking tangents beside the motion that are tried where it is stuck; fewer
            are quicker.
        qp: back end of the SQP solver.

    Raises:
        InputError: a number out of its range.
    """

    intervals: int = 60
    scheme: SchemeKind = SchemeKind.LINEAR
    group: int | None = None
    tolerance: float = 1e-3
    solver_tolerance: float = 1e-5
    gain: float = 2e-4
    outer: int = 60
    box: float = 0.2
    places: int = 2
    slots: int = 3
    trials: int = MOST_TRIALS
    qp: str = "interior_point"

    def __post_init__(self) -> None:
        for name in ("intervals", "outer", "places", "slots"):
            whole(f"Effort.{name}", getattr(self, name), 1)
        whole("Effort.trials", self.trials, 0, MOST_TRIALS)
        if self.group is not None:
            whole("Effort.group", self.group, 1)
        of_kind("Effort.scheme", self.scheme, SchemeKind)
        for name in ("tolerance", "solver_tolerance", "gain", "box"):
            positive(f"Effort.{name}", getattr(self, name))
