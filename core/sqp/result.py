"""What came of a solution, and what an iteration callback sees."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from .workspace import Workspace

FloatArray = NDArray[np.float64]


class Status(StrEnum):
    """How a solution ended."""

    OPTIMAL = "optimal"
    """KKT residual and constraint violation are within the tolerance."""
    ACCEPTABLE = "acceptable"
    """Rounding, or multipliers too large for the tolerance, allow no better point: residuals are
    within the tolerance relative to the multipliers, or within a thousand times the tolerance."""
    INFEASIBLE = "infeasible"
    """The violation cannot be made smaller from here; the least violated point is given."""
    UNBOUNDED = "unbounded"
    """The objective falls without end along feasible points."""
    ITERATION_LIMIT = "iteration_limit"
    """The iterations ran out, or no step helps any more; the best point seen is given."""
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
        regularisation: what was added to the Hessian's diagonal.
        kind: of step: ``normal``, ``corrected`` (second order), ``elastic``, ``restoration``.
    """

    number: int
    x: FloatArray
    objective: float
    constraint_violation: float
    kkt_residual: float
    step: float = 0.0
    step_length: float = 0.0
    regularisation: float = 0.0
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


@dataclass(frozen=True)
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
            times distance from its bound; unscaled, from the user's own callables at x.
        constraint_violation: largest violation of a constraint or bound, likewise.
        iterations: number of them.
        evaluations: calls of each callable.
        timings: where the time went.
        backend: the QP back end that solved the last subproblem.
        workspace: what a warm start reuses.
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
    workspace: Workspace | None = field(default=None, repr=False, compare=False)

    @property
    def success(self) -> bool:
        """Whether the point is a solution: `Status.OPTIMAL` or `Status.ACCEPTABLE`."""
        return self.status in (Status.OPTIMAL, Status.ACCEPTABLE)
