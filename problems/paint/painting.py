"""The whole way from a part to an even coat: first curve, best speeds, full optimisation, judged
at every stage on the part itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np

from ...core.arrays import BoolArray
from ...core.errors import InputError, Note
from .coating.coat import Coat, coat
from .coating.deposition import Deposition
from .coating.reach import check_reach
from .coating.sight import sight
from .initial.curve import InitialCurve, initial_curve
from .initial.plan import SweepPlan
from .spray.footprint import Footprint
from .spray.trajectory import PaintTrajectory
from .surface.part import Part
from .surface.resolution import coarsened
from .thickness.optimize import optimize
from .thickness.options import OuterLoop, PaintLimits, PaintWeights
from .thickness.reference import ReferencePlanes
from .thickness.robust import NO_ERRORS, PaintErrors
from .thickness.round import Progress
from .thickness.speeds import SpeedSolution, best_speeds

POINTS = 2600
"""Of the part, on which it is optimised."""


class PaintingStage(StrEnum):
    """What has been done to a trajectory."""

    START = "start"
    """The first curve, at the one speed that gives the target on average."""
    SPEED = "speed only"
    FULL = "full"
    DRIVEN = "as emulated"


@dataclass(frozen=True)
class Wishes:
    """A coat that is wanted.

    Args:
        target: thickness, m.
        plan: of the first curve; its speed is only where to begin.
        limits, weights, loop, errors: of the optimisation.
        points: of the part, on which it is optimised; it is judged on all of them.
        seed: of their choice.
    """

    target: float
    plan: SweepPlan
    limits: PaintLimits = field(default_factory=PaintLimits)
    weights: PaintWeights = field(default_factory=PaintWeights)
    loop: OuterLoop = field(default_factory=lambda: OuterLoop(rounds=12, enough=0.05))
    errors: PaintErrors = NO_ERRORS
    points: int = POINTS
    seed: int = 0

    def __post_init__(self) -> None:
        if not 0.0 < self.target < 0.01:
            raise InputError(f"a coat of {self.target:g} m: thickness is in metres here")


class Judge:
    """Judges trajectories on all of a part, with what the gun does not see.

    Args:
        part: the part.
        footprint: of the gun.
        target: m.
    """

    def __init__(self, part: Part, footprint: Footprint, target: float) -> None:
        self.part = part
        self.target = target
        self.deposition = Deposition(part.samples, footprint)

    @property
    def footprint(self) -> Footprint:
        return self.deposition.footprint

    def visible(self, trajectory: PaintTrajectory) -> BoolArray | None:
        """(V, S) what each segment sees; None where nothing stands in the way."""
        seen = sight(self.part, self.footprint, trajectory)
        return None if seen.all() else seen

    def coat(self, trajectory: PaintTrajectory) -> Coat:
        """The coat that a trajectory leaves on all of the part."""
        visible = self.visible(trajectory)
        return coat(self.deposition.with_visible(visible), trajectory, self.target)


@dataclass(frozen=True, eq=False)
class Painting:
    """A part, its coat, and how it came about.

    Args:
        judge: of all coats.
        coarse: the same of the points on which it was optimised.
        curve: the first one.
        trajectories: at each stage, the start first.
        coats: what they leave on all of the part.
        speeds: of the stage of speeds only, with its certificate.
        interrupted: whether the user ended the optimisation.
        notes: what the user should know.
    """

    judge: Judge
    coarse: Judge
    curve: InitialCurve
    trajectories: dict[PaintingStage, PaintTrajectory]
    coats: dict[PaintingStage, Coat]
    speeds: SpeedSolution
    interrupted: bool
    notes: tuple[Note, ...]

    @property
    def best(self) -> PaintTrajectory:
        """The trajectory of the last stage."""
        return list(self.trajectories.values())[-1]


def paint(
    part: Part,
    footprint: Footprint,
    wishes: Wishes,
    say: Callable[[str], None] = lambda text: None,
    progress: Progress | None = None,
) -> Painting:
    """The most even coat that is found for a part.

    Args:
        part: at the resolution at which it is judged.
        footprint: of the gun.
        wishes: what is wanted.
        say: called with what is being done.
        progress: see `optimize`.

    Raises:
        InputError: the part cannot be painted as planned, or no speed comes near to the target.
    """
    say("first curve")
    curve = initial_curve(part, wishes.plan, footprint)
    few = coarsened(part, wishes.points, wishes.seed)
    judge, coarse = (Judge(one, footprint, wishes.target) for one in (part, few))
    visible = coarse.visible(curve.trajectory)
    seen = coarse.deposition.with_visible(visible)
    start = at_mean(seen, curve.trajectory, wishes)
    low, high = wishes.limits.speed
    check_reach(seen, start, wishes.target, (low, high))
    say("best speeds")
    speeds = best_speeds(seen, start, wishes.target, low, high)
    found = optimize(
        coarse.deposition,
        start,
        wishes.target,
        ReferencePlanes.below(start, wishes.plan.distance),
        limits=wishes.limits,
        weights=wishes.weights,
        loop=wishes.loop,
        errors=wishes.errors,
        sight=None if visible is None else lambda now: sight(few, footprint, now),
        progress=progress,
    )
    say("judging")
    trajectories = {
        PaintingStage.START: start,
        PaintingStage.SPEED: speeds.trajectory,
        PaintingStage.FULL: found.trajectory,
    }
    coats = {stage: judge.coat(trajectory) for stage, trajectory in trajectories.items()}
    notes = tuple(dict.fromkeys((*curve.notes, *speeds.notes)))
    return Painting(judge, coarse, curve, trajectories, coats, speeds, found.interrupted, notes)


def at_mean(deposition: Deposition, trajectory: PaintTrajectory, wishes: Wishes) -> PaintTrajectory:
    """The trajectory at the one speed, within its limits, that comes nearest to the target on
    average.

    Raises:
        InputError: no paint gets onto the part.
    """
    samples = deposition.samples
    mean = float(samples.areas @ deposition.thickness(trajectory)) / samples.area
    if not mean > 0.0:
        raise InputError("no paint gets onto the part: check the gun's distance and the footprint")
    factor = wishes.target / mean
    low, high = wishes.limits.speed
    speeds = np.clip(trajectory.speeds / factor, low, high)
    return replace(trajectory, duration=np.maximum(trajectory.lengths / speeds, 1e-3))
