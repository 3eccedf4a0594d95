"""What a solution has, whichever method makes its steps."""

from __future__ import annotations

from dataclasses import dataclass

from .options import Options
from .problem.hessians import HessianSource
from .problem.scaled import ScaledProblem
from .progress import SolutionProgress
from .workspace import Workspace


@dataclass(frozen=True, slots=True)
class Given:
    """What a method gets.

    Args:
        problem: the problem, whose scale is chosen.
        hessian: of its Lagrangian.
        workspace: what is kept from one solution to the next.
        options: of the solution.
        progress: takes note of what is done, and judges.
    """

    problem: ScaledProblem
    hessian: HessianSource
    workspace: Workspace
    options: Options
    progress: SolutionProgress
