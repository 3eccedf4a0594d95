"""The methods, and which of them a solution begins with."""

from __future__ import annotations

from enum import StrEnum

from .options import Options
from .problem.errors import NlpError
from .problem.hessians import HessianKind
from .problem.nlp import NLP

_LARGE = 60
"""Variables and constraints from which on a problem counts as large."""


class SolverMethod(StrEnum):
    """How a problem is solved."""

    AUTO = "auto"
    """The interior point for large problems without a warm start or a box round the step, if there
    are second derivatives; else sequential quadratic programming. Depends on nothing else."""
    INTERIOR_POINT = "interior_point"
    """The primal–dual interior point. Where it ends without a solution, sequential quadratic
    programming goes on from the best point, and finds out why."""
    SQP = "sqp"
    """Sequential quadratic programming. Where its steps creep, and neither a box round the step nor
    an approximate Hessian speaks against it, the interior point goes on."""


def chosen(
    wanted: SolverMethod | str, nlp: NLP, kind: HessianKind, options: Options
) -> SolverMethod:
    """The method that a solution begins with.

    Raises:
        NlpError: there is no such method, or it cannot do what the options ask for.
    """
    try:
        method = SolverMethod(wanted)
    except ValueError:
        raise NlpError(f"method: one of {', '.join(SolverMethod)}, not {wanted!r}") from None
    if method is SolverMethod.INTERIOR_POINT and options.step_box is not None:
        raise NlpError("step_box needs method 'sqp' or 'auto': an interior point takes no box")
    if kind is HessianKind.LBFGS:
        if method is SolverMethod.SQP or options.step_box is not None:
            raise NlpError(
                "hessian_kind 'lbfgs' needs the interior point: neither method 'sqp' nor step_box"
            )
        return SolverMethod.INTERIOR_POINT
    if method is not SolverMethod.AUTO:
        return method
    cold = options.warm_start is None and options.step_box is None
    large = nlp.n + nlp.m >= _LARGE and kind is not HessianKind.BFGS
    return SolverMethod.INTERIOR_POINT if cold and large else SolverMethod.SQP
