"""What one solution leaves to the next of the same structure."""

from __future__ import annotations

from dataclasses import dataclass

from .convexify import Convexifier
from .elastic import Elastic
from .nlp import NLP
from .patterns import Pattern
from .qp.problem import Backend
from .qp.subproblems import Subproblems


@dataclass(slots=True)
class Workspace:
    """Patterns, and everything that is worked out from them once.

    It serves one solution at a time.

    Args:
        size: n and m of the problem.
        jacobian, hessian: patterns.
        convexifier: makes Hessians convex.
        subproblems: the back ends, set up.
        elastic: elastic subproblems.
    """

    size: tuple[int, int]
    jacobian: Pattern
    hessian: Pattern
    convexifier: Convexifier
    subproblems: Subproblems
    elastic: Elastic


def make_workspace(
    nlp: NLP, backends: tuple[Backend, ...], before: Workspace | None = None
) -> Workspace:
    """A new workspace, or the one before where the problem has the same size."""
    size = (nlp.n, nlp.m)
    if before is not None and before.size == size:
        before.jacobian.reopen()
        before.hessian.reopen()
        before.convexifier.forget()
        before.subproblems.use(backends)
        return before
    subproblems = Subproblems(backends)
    return Workspace(
        size,
        Pattern("jacobian", (nlp.m, nlp.n)),
        Pattern("hessian", (nlp.n, nlp.n), growing=True),
        Convexifier(),
        subproblems,
        Elastic(subproblems),
    )
