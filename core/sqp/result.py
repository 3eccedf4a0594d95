"""What came of a solution, and what an iteration callback sees."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING

from ..arrays import FloatArray

if TYPE_CHECKING:
    from .workspace import Workspace


class Status(StrEnum):
    """How a solution ended."""

    OPTIMAL = "optimal"
    """KKT residual and constraint violation are within the tolerance."""
    ACCEPTABLE = "acceptable"
    """Rounding stopped the iteration short of the tolerance: every residual is within it beside the
    size of what it is the difference of, violations are within it or rounding themselves, and
    steepest descent promises nothing more."""
    INFEASIBLE = "infeasible"
    """The sum of violations is stationary, and nothing near by is less violated: the point is
    given. Another start may do better, unless the problem is convex."""
    UNBOUNDED = "unbounded"
    """The objective falls without end along feasible points."""
    ITERATION_LIMIT = "iteration_limit"
    """The iterations ran out, no step helps any more, or no back end solves a subproblem, which may
    be so at once; the best point seen is given."""
    INTERRUPTED = "interrupted"
    """The callback or the keyboard ended it; the best point seen is given."""
    CALLABLE_ERROR = "callable_error"
    """A callable gave NaN or infinity where no shorter step helps; the message names it."""


@dataclass(frozen=True, slots=True)
class Iteration:
    """The state at the beginning of an iteration, for callbacks and drawings.

    Args:
        number: from 0.
        x: (n,).
        objective: f(x).
        constraint_violation: largest violation of a constraint or bound.
        kkt_residual: see `Result`.
        step: largest change of a variable in the step that led here.
        step_length: share of the subproblem's step that was taken.
        shift: the most by which an entry of the Hessian's diagonal was raised, to make it convex.
        kind: of step: ``normal``, ``corrected`` (second order), ``elastic``, ``restoration``,
            ``descent`` (the steepest, where no model's step helped), ``active_set`` (the last
            digits of an interior point).
    """

    number: int
    x: FloatArray
    objective: float
    constraint_violation: float
    kkt_residual: float
    step: float = 0.0
    step_length: float = 0.0
    shift: float = 0.0
    kind: str = ""


@dataclass(frozen=True, slots=True)
class Timings:
    """Where the time went, s of wall clock.

    Args:
        total: all of it.
        callables: in the user's callables.
        subproblems: in the QP back ends.
    """

    total: float
    callables: float
    subproblems: float


@dataclass(frozen=True, eq=False)
class Result:
    """A solution.

    The Lagrangian is f + multipliers·c + bound_multipliers·x; at a solution its gradient is zero,
    with multipliers ≥ 0 at upper and ≤ 0 at lower bounds.

    Args:
        x: (n,) the point.
        objective: f(x); 0 without an objective.
        status: how it ended.
        message: the same in a sentence.
        multipliers: (m,) of the constraints.
        bound_multipliers: (n,) of the bounds.
        kkt_residual: largest of |∇f + Jᵀλ + ν|, of a multiplier's wrong sign and of multiplier
            times distance from its bound, where a distance beyond 1 counts as 1; unscaled, from
            the user's own callables at x.
        constraint_violation: largest violation of a constraint or bound, likewise.
        iterations: number of them.
        evaluations: calls of each callable.
        timings: where the time went.
        backend: the QP back end that solved the last subproblem.
        method: ``interior_point``, ``sqp``, or both in turn.
        workspace: what a warm start reuses; it stays behind where a result is copied or pickled.
    """

    x: FloatArray
    objective: float
    status: Status
    message: str
    multipliers: FloatArray
    bound_multipliers: FloatArray
    kkt_residual: float
    constraint_violation: float
    iterations: int
    evaluations: dict[str, int] = field(repr=False)
    timings: Timings = field(repr=False)
    backend: str = ""
    method: str = ""
    workspace: Workspace | None = field(default=None, repr=False)

    def __getstate__(self) -> dict[str, object]:
        return {**self.__dict__, "workspace": None}

    @property
    def success(self) -> bool:
        """Whether the point is a solution: `Status.OPTIMAL` or `Status.ACCEPTABLE`."""
        return self.status in (Status.OPTIMAL, Status.ACCEPTABLE)
