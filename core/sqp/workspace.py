"""What one solution leaves to the next of the same structure."""

from __future__ import annotations

from dataclasses import dataclass, field
from threading import Lock

from .algebra.linear import SaddlePatterns
from .algebra.matrices import Sparsity, identity
from .problem.errors import NlpError
from .problem.nlp import NLP
from .problem.patterns import Pattern
from .qp.backends import BackendKind, make_backends
from .qp.subproblems import Subproblems
from .sequential.convexify import Convexifier
from .sequential.elastic import Elastic


@dataclass(slots=True)
class Workspace:
    """Patterns, and everything that is worked out from them once.

    It serves one solution at a time, which holds its lock.

    Args:
        size: n and m of the problem.
        jacobian, hessian: patterns.
        convexifier: makes Hessians convex.
        subproblems: the back ends, set up.
        elastic: elastic subproblems.
        identity: pattern of a diagonal (n, n).
        saddles: symbolic factorisations of the interior point.
        busy: is held while a solution uses it.
    """

    size: tuple[int, int]
    jacobian: Pattern
    hessian: Pattern
    convexifier: Convexifier
    subproblems: Subproblems
    elastic: Elastic
    identity: Sparsity
    saddles: SaddlePatterns = field(default_factory=SaddlePatterns)
    busy: Lock = field(default_factory=Lock)


def make_workspace(
    nlp: NLP, qp: BackendKind | str, fallback: bool, before: Workspace | None = None
) -> Workspace:
    """A new workspace, or the one before where the problem has the same size and no other solution
    uses it; the caller holds it and lets go of ``busy`` when done.

    Args:
        qp, fallback: see `make_backends`.

    Raises:
        NlpError: there is no such back end.
    """
    size = (nlp.n, nlp.m)
    if before is not None and before.size == size and before.busy.acquire(blocking=False):
        try:
            before.subproblems.use(make_backends(qp, fallback, before.subproblems.known))
        except NlpError:
            before.busy.release()
            raise
        before.jacobian.reopen()
        before.hessian.reopen()
        before.convexifier.forget()
        return before
    subproblems = Subproblems(make_backends(qp, fallback))
    made = Workspace(
        size,
        Pattern("jacobian", (nlp.m, nlp.n)),
        Pattern("hessian", (nlp.n, nlp.n), growing=True),
        Convexifier(),
        subproblems,
        Elastic(subproblems),
        identity(nlp.n),
    )
    made.busy.acquire()
    return made
