"""Derivatives of residuals, carried on from where they were evaluated.

Derivatives of a run by all parameters cost as many emulations as there are parameters, its
residuals one. So derivatives are carried from point to point by Broyden's update (Mathematics of
Computation 19, 1965), which makes them agree with how residuals did change on the way, until they
foretell the next change too badly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray
from .loss import square_root

MISS = 0.25
"""Share of the residuals' change that derivatives may miss and be carried on."""


@dataclass(frozen=True, eq=False)
class RunDerivatives:
    """Residuals of a run and their derivatives, at one point.

    Args:
        values: (R,), weighted.
        jacobian: (R, n), by the variables.
    """

    values: FloatArray
    jacobian: FloatArray


def carried(
    known: Sequence[RunDerivatives], step: FloatArray, values: Sequence[FloatArray]
) -> list[RunDerivatives] | None:
    """What is known at one point, at another; None where derivatives no longer hold.

    Args:
        known: of each run.
        step: (n,) to the other point.
        values: (R,) of each run there.
    """
    missed = changed = 0.0
    made = []
    for one, then in zip(known, values, strict=True):
        weight = square_root(then)[1]
        change = then - one.values
        miss = change - one.jacobian @ step
        missed += float(np.sum((weight * miss) ** 2))
        changed += float(np.sum((weight * change) ** 2))
        # What a run has no part in stays so.
        own = np.where(np.any(one.jacobian != 0.0, axis=0), step, 0.0)
        long = float(own @ own)
        jacobian = one.jacobian
        if long > 0.0:
            jacobian = jacobian + np.outer(miss / long, own)
        made.append(RunDerivatives(then, jacobian))
    return made if missed <= MISS**2 * changed else None
