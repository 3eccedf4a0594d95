"""Subproblems solved from a guess of what is active, by a primal–dual active-set method.

With the active constraints known a subproblem is one linear system. Its solution shows which of
them push the wrong way, and which others it violates; the next system has those changed
(Hintermüller, Ito and Kunisch, "The primal–dual active set strategy as a semismooth Newton
method", 2003). From the active set of the iteration before, that ends after a system or two; from
elsewhere it may go in circles, and then has no answer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ..algebra.linear import Saddle
from .problem import QpSolution, QpStatus, QuadraticProgram

_MENDED = 60
"""Wrong sides that one more system may be hoped to mend."""
_PATIENCE = 3
_NO_MULTIPLIER = 1e-10
_LEAP, _ON_THE_WAY = 100.0, 1e-9


@dataclass(slots=True)
class WorkingSet:
    """Which sides are expected to hold as equalities.

    Args:
        rows: number of rows, m.
        sides: (m + n,) of rows and bounds: 1 upper side (or equality), -1 lower side, 0 neither.
    """

    rows: int
    sides: NDArray[np.int8]


def shown_by(qp: QuadraticProgram, d: FloatArray, y: FloatArray, z: FloatArray) -> WorkingSet:
    """The sides whose multiplier is larger than their distance."""
    sides = np.concatenate(
        [_sides(qp.A @ d, y, qp.lower, qp.upper), _sides(d, z, qp.d_lower, qp.d_upper)]
    )
    return WorkingSet(len(y), sides)


def pushed_by(qp: QuadraticProgram, y: FloatArray, z: FloatArray) -> WorkingSet:
    """The sides that have a multiplier, and equalities."""
    lower = np.concatenate([qp.lower, qp.d_lower])
    upper = np.concatenate([qp.upper, qp.d_upper])
    both = np.concatenate([y, z])
    least = _NO_MULTIPLIER * max(1.0, float(np.abs(both).max(initial=0.0)))
    above = (lower == upper) | ((both > least) & np.isfinite(upper))
    below = (both < -least) & np.isfinite(lower)
    return WorkingSet(len(y), np.where(above, 1, np.where(below, -1, 0)).astype(np.int8))


def settled(
    qp: QuadraticProgram, guess: WorkingSet, saddle: Saddle, systems: int
) -> QpSolution | None:
    """The last system's solution; None if a system has none.

    Args:
        guess: where to begin.
        saddle: solves the systems.
        systems: how many at most; fewer are solved where the wrong sides do not get fewer. Whether
            the set had come to rest by then, `error` tells.
    """
    found = before = None
    fewest, patience = np.inf, _PATIENCE
    for left in range(systems - 1, -1, -1):
        found = _of(qp, guess, saddle)
        if found is None:
            return None
        if before is not None and _contradictory(found, before):
            fewer = _without_first(qp, guess, before, found)
            if fewer is None:
                break
            guess = fewer
            continue
        before = found
        shown = shown_by(qp, found.d, found.y, found.z)
        wrong = int(np.count_nonzero(shown.sides != guess.sides))
        patience = _PATIENCE if wrong < fewest else patience - 1
        if not wrong or not patience or wrong > _MENDED * left:
            break
        fewest = min(fewest, wrong)
        guess = shown
    return found


def _contradictory(found: QpSolution, before: QpSolution) -> bool:
    """Whether more sides are expected to hold than can: nothing else makes multipliers leap so."""
    return _largest(found) > _LEAP * max(1.0, _largest(before))


def _largest(found: QpSolution) -> float:
    sizes = np.abs(found.y).max(initial=0.0), np.abs(found.z).max(initial=0.0)
    return float(max(sizes))


def _without_first(
    qp: QuadraticProgram, guess: WorkingSet, before: QpSolution, found: QpSolution
) -> WorkingSet | None:
    """The sides but the one whose multiplier is zero first on the way from one solution towards
    that of a system which contradicts itself, as the dual simplex method chooses it; None if none
    is."""
    old = np.concatenate([before.y, before.z])
    way = np.concatenate([found.y, found.z]) - old
    equal = np.concatenate([qp.lower == qp.upper, qp.d_lower == qp.d_upper])
    falls = (guess.sides * way < -_ON_THE_WAY * float(np.abs(way).max())) & ~equal
    if not falls.any():
        return None
    shares = np.full(len(way), np.inf)
    shares[falls] = np.abs(old[falls] / way[falls])
    sides = guess.sides.copy()
    sides[int(np.argmin(shares))] = 0
    return WorkingSet(guess.rows, sides)


def error(qp: QuadraticProgram, found: QpSolution) -> float:
    """Largest violation of the optimality conditions."""
    slope = qp.P @ found.d + qp.q + qp.A.transposed_times(found.y) + found.z
    return max(
        float(np.abs(slope).max(initial=0.0)),
        _error_of_sides(qp.A @ found.d, found.y, qp.lower, qp.upper),
        _error_of_sides(found.d, found.z, qp.d_lower, qp.d_upper),
    )


def _of(qp: QuadraticProgram, working: WorkingSet, saddle: Saddle) -> QpSolution | None:
    rows, bounds = working.sides[: working.rows], working.sides[working.rows :]
    target = np.where(rows > 0, qp.upper, qp.lower)
    values = np.where(bounds > 0, qp.d_upper, qp.d_lower)
    system = saddle.solve(qp.P, qp.q, qp.A, rows != 0, target, bounds != 0, values)
    if system is None:
        return None
    d, y = system
    slope = qp.P @ d + qp.q + qp.A.transposed_times(y)
    return QpSolution(QpStatus.SOLVED, d, y, np.where(bounds != 0, -slope, 0.0))


def _sides(
    value: FloatArray, multiplier: FloatArray, lower: FloatArray, upper: FloatArray
) -> NDArray[np.int8]:
    above = (upper - value < multiplier) | (lower == upper)
    below = value - lower < -multiplier
    return np.where(above, 1, np.where(below, -1, 0)).astype(np.int8)


def _error_of_sides(
    at: FloatArray, multiplier: FloatArray, lower: FloatArray, upper: FloatArray
) -> float:
    outside = np.maximum(at - upper, lower - at)
    gap = np.where(multiplier > 0, np.abs(upper - at), np.abs(at - lower))
    pushing = np.minimum(np.abs(multiplier), gap)
    return float(np.maximum(outside, pushing).max(initial=0.0))
