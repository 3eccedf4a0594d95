"""From what is known at the end of a solution to its status and message."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto

from .problem.optimality import OptimalityResiduals
from .result import Status

_UNBOUNDED = 1e20
_FAR = 1e8


class Ending(Enum):
    """What made a solution end."""

    CONVERGED = auto()
    NO_STEP = auto()
    """No model's step makes progress."""
    NO_MODEL = auto()
    """No back end solves a subproblem."""
    STATIONARY_VIOLATION = auto()
    """The violation is stationary at the best point, and nothing near by is less violated."""
    AWAY = auto()
    """The objective or a variable has left the range of sensible numbers."""
    LIMIT = auto()
    CALLBACK = auto()
    KEYBOARD = auto()


@dataclass(frozen=True, slots=True)
class Evidence:
    """What is known at the end.

    Args:
        at: residuals at the best point.
        tolerance: of the residuals.
        objective: at the best point.
        first_objective: at the first feasible point.
        farthest: largest variable of the best point.
        first_farthest: of the start.
        closed: whether every variable has two finite bounds.
        gain: what a step of steepest descent from the best point promises to lower the objective
            by, within the linearised constraints; infinite where that is not known.
        trouble: of the callables, where their having no value kept the last steps from being taken.
        boxed: whether the user limits steps.
        iterations: number of them.
    """

    at: OptimalityResiduals
    tolerance: float
    objective: float
    first_objective: float
    farthest: float
    first_farthest: float
    closed: bool
    gain: float
    trouble: str
    boxed: bool
    iterations: int

    @property
    def feasible(self) -> bool:
        """Whether the best point is, as far as rounding allows."""
        return self.at.violation <= self.tolerance or self.at.violation_is_rounding

    def falls_below(self, multiple: float) -> bool:
        """Whether the objective has fallen, along feasible points, by a large multiple of what it
        was, where bounds do not forbid it to go on."""
        fallen = self.objective < -multiple * max(1.0, abs(self.first_objective))
        return self.feasible and not self.closed and fallen

    @property
    def far(self) -> bool:
        """Whether a variable has grown beyond all sense."""
        return not self.closed and is_far(self.farthest, self.first_farthest)

    @property
    def away(self) -> bool:
        """Whether going on makes no sense."""
        return self.far or self.falls_below(_UNBOUNDED)


def is_far(size: float, first: float) -> bool:
    """Whether the size of a point is beyond all sense, beside that of the start."""
    return size > _UNBOUNDED * max(1.0, first)


def is_low(objective: float) -> bool:
    """Whether an objective is so low that a problem may be unbounded."""
    return objective < -_UNBOUNDED


def near(at: OptimalityResiduals, tolerance: float) -> bool:
    """Whether residuals are as small as arithmetic may allow: each beside what it is the difference
    of; no variable's slope is excused by another one's multiplier."""
    return at.relative <= tolerance


def nothing_to_gain(gain: float, objective: float, tolerance: float) -> bool:
    """Whether what steepest descent promises is too little to count."""
    return gain <= tolerance * max(1.0, abs(objective))


def verdict(ending: Ending, known: Evidence) -> tuple[Status, str]:
    """Status and message of a solution."""
    at = known.at
    if ending is Ending.CALLBACK:
        return Status.INTERRUPTED, "interrupted by the callback"
    if ending is Ending.KEYBOARD:
        return Status.INTERRUPTED, "interrupted from the keyboard"
    if at.within(known.tolerance):
        return Status.OPTIMAL, "residuals are within the tolerance"
    if ending is Ending.STATIONARY_VIOLATION and not at.violation_is_rounding:
        return Status.INFEASIBLE, (
            f"the violation is stationary at {at.violation:.3g}: no step from here makes it smaller"
        )
    if ending is Ending.LIMIT:
        return _limit(f"{known.iterations} iterations did not reach the tolerance")
    if ending is Ending.AWAY:
        if known.falls_below(_UNBOUNDED):
            return _unbounded(known)
        if known.far and known.feasible and known.objective < known.first_objective:
            return Status.UNBOUNDED, (
                f"a variable grows beyond 1e20 while the objective falls to {known.objective:.3g}"
            )
        return _limit("a variable grows beyond 1e20")
    return _stopped(ending, known)


def _stopped(ending: Ending, known: Evidence) -> tuple[Status, str]:
    """The verdict where nothing helps any more."""
    at = known.at
    if known.falls_below(_FAR) and known.farthest > _FAR * max(1.0, known.first_farthest):
        return _unbounded(known)
    gained = nothing_to_gain(known.gain, known.objective, known.tolerance)
    if known.feasible and near(at, known.tolerance) and gained:
        return Status.ACCEPTABLE, (
            f"rounding stops the iteration at a KKT residual of {at.kkt:.2g} and a violation of "
            f"{at.violation:.2g}"
        )
    if known.trouble:
        return Status.CALLABLE_ERROR, known.trouble
    if ending is Ending.NO_MODEL:
        return _limit("no back end could solve a subproblem")
    what = "makes progress" if known.feasible else "lowers the violation"
    return _limit(
        f"no step that step_box allows {what}"
        if known.boxed
        else f"no step {what}: are the derivatives right?"
    )


def _limit(message: str) -> tuple[Status, str]:
    return Status.ITERATION_LIMIT, message


def _unbounded(known: Evidence) -> tuple[Status, str]:
    return Status.UNBOUNDED, f"the objective falls to {known.objective:.3g} along feasible points"
