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
from ..algebra.matrices import SparseMatrix
from . import active_set_kernels as kernels
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
    return WorkingSet(len(y), kernels.shown(_columns(qp.A), _bounds(qp), d, y, z))


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
        wrong = kernels.different(shown.sides, guess.sides)
        patience = _PATIENCE if wrong < fewest else patience - 1
        if not wrong or not patience or wrong > _MENDED * left:
            break
        fewest = min(fewest, wrong)
        guess = shown
    return found


def _contradictory(found: QpSolution, before: QpSolution) -> bool:
    """Whether more sides are expected to hold than can: nothing else makes multipliers leap so."""
    sizes = kernels.largest(found.y, found.z), kernels.largest(before.y, before.z)
    return bool(sizes[0] > _LEAP * max(1.0, sizes[1]))


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
    matrices = _columns(qp.P), qp.q, _columns(qp.A)
    return float(kernels.error(*matrices, _bounds(qp), found.d, found.y, found.z))


def _of(qp: QuadraticProgram, working: WorkingSet, saddle: Saddle) -> QpSolution | None:
    """The solution of the system of a working set."""
    system = saddle.solve(qp.P, qp.q, qp.A, *kernels.expected(working.sides, _bounds(qp)))
    if system is None:
        return None
    matrices = _columns(qp.P), qp.q, _columns(qp.A)
    z = kernels.bound_multipliers(*matrices, *system, working.sides)
    return QpSolution(QpStatus.SOLVED, *system, z)


def _columns(matrix: SparseMatrix) -> kernels.Columns:
    return matrix.pattern.starts, matrix.pattern.rows, matrix.data


def _bounds(qp: QuadraticProgram) -> kernels.Bounds:
    return qp.lower, qp.upper, qp.d_lower, qp.d_upper
