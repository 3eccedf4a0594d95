"""The interior point's iteration, compiled.

With sides s_k = ±(bound − value) ≥ 0 and their multipliers z_k ≥ 0, a step solves

    P Δd + Aᵀ Δy = −(P d + q + Aᵀ y)   A Δd − δ Δy = b − A d   s_k Δz_k + z_k Δs_k = μ − s_k z_k

to first order, with ρ Δd and δ Δz_k added likewise: the proximal terms of Schwan, Jiang, Kuhn and
Jones, "PIQP: a proximal interior-point quadratic programming solver" (2023). They vanish with the
step, so that the solution is exact, and make every system quasi-definite: rows may depend on each
other, and P may be singular. Sides are eliminated, which leaves one system of the size of variables
and rows. Predictor and corrector are Mehrotra's (Nocedal and Wright, section 16.6).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import FloatArray
from ..algebra.ldl import Factors, substitute
from ..algebra.linear import EntryIndices
from .interior_point_scaling import Scaled, values
from .interior_point_state import (
    InteriorPointResiduals,
    Iterate,
    proves_infeasible,
    proves_unbounded,
    residuals,
)
from .interior_point_system import System, factorised, make_system, solved

SOLVED, INEXACT, INFEASIBLE, UNBOUNDED, FAILED = range(5)

_RHO = 1e-12
_DELTA = 1e-10
_SAFE_RHO, _SAFE_DELTA = 1e-8, 1e-7
"""Where a pivot cancels to zero."""
_START_RHO, _START_DELTA = 1e-8, 1e-2
_WARM = 0.3
_TO_BOUNDARY, _NEARLY = 0.99, 0.9999
_FLOOR = 0.1
_LEAST_CENTRE = 1e-8
_PATIENCE = 12
_BETTER = 0.7
_ENOUGH = 1e-6


@njit(cache=True, error_model="numpy")
def minimise(
    qp: Scaled,
    factors: Factors,
    places: EntryIndices,
    guess: FloatArray,
    accuracy: float,
    iterations: int,
    d: FloatArray,
    y: FloatArray,
) -> tuple[int, int]:
    """Solve a subproblem.

    Args:
        qp: the subproblem.
        factors, places: of its pattern.
        guess: (n + m,) multipliers of bounds and rows to begin with, scaled; (0,) for none.
        accuracy: of residuals and products, in proportion to the size of multipliers and values.
        iterations: at most.
        d: (n,) the solution is written there, scaled.
        y: (n + m,) the multipliers of bounds and rows.

    Returns:
        How it ended, and the number of iterations.
    """
    n, m, sides = len(qp.q), len(qp.target), len(qp.place)
    system = make_system(qp, factors, places)
    point = Iterate(np.zeros(n), np.zeros(n + m), np.ones(sides), np.ones(sides))
    if len(guess):
        _start_from(qp, guess, point)
    elif not _start(qp, system, point):
        return FAILED, 0
    at = InteriorPointResiduals(np.zeros(n + m), np.zeros(n), np.zeros(m), np.zeros(sides))
    best, patience = np.inf, _PATIENCE
    for count in range(iterations + 1):
        left, gap = residuals(qp, point, at)
        if not np.isfinite(left):
            break
        if left < best:
            patience = _PATIENCE if left < _BETTER * best else patience - 1
            best = left
            d[:] = point.d
            y[:] = point.y
        else:
            patience -= 1
        if left <= accuracy:
            return SOLVED, count
        if patience <= 0 or count == iterations:
            break
        if count >= 2:
            if proves_infeasible(qp, point):
                return INFEASIBLE, count
            if proves_unbounded(qp, point, at):
                return UNBOUNDED, count
        if not _step(qp, point, at, system, _FLOOR * accuracy * gap / max(1, sides)):
            break
    return INEXACT if best <= _ENOUGH else FAILED, count


# ------------------------------------------------------------------------------- where to begin


@njit(cache=True, error_model="numpy")
def _start(qp: Scaled, system: System, point: Iterate) -> bool:
    """The least-squares solution with all sides as soft targets, slacks and multipliers shifted
    until they are positive."""
    n = len(qp.q)
    weight, right = system.weight, system.right
    weight[:] = 0.0
    system.push[:] = 0.0
    for k in range(len(qp.place)):
        weight[qp.place[k]] += 1.0
        system.push[qp.place[k]] -= qp.bound[k]
    for j in range(n):
        right[j] = 0.0 if qp.fixed[j] else -qp.q[j] - system.push[j]
    for i in range(len(qp.target)):
        pull = weight[n + i]
        right[n + i] = qp.target[i] if pull == 0.0 else -system.push[n + i] / pull
    if not factorised(qp, system, _START_RHO, _START_DELTA):
        return False
    substitute(system.factors, right, system.step, system.work)
    point.d[:] = system.step[:n]
    values(qp, point.d, system.change)
    for i in range(len(qp.target)):
        if qp.equal[i]:
            point.y[n + i] = system.step[n + i]
    lowest, highest = 0.0, 0.0
    for k in range(len(qp.place)):
        gap = qp.sign[k] * (qp.bound[k] - system.change[qp.place[k]])
        point.slack[k] = gap
        lowest, highest = min(lowest, gap), max(highest, gap)
    for k in range(len(qp.place)):
        gap = point.slack[k]
        point.slack[k] = gap + 1.0 - lowest
        point.multiplier[k] = 1.0 + highest - gap
    return True


@njit(cache=True, error_model="numpy")
def _start_from(qp: Scaled, guess: FloatArray, point: Iterate) -> None:
    """d = 0 with known multipliers; slacks and multipliers moved away from zero."""
    n = len(qp.q)
    for i in range(len(qp.target)):
        if qp.equal[i]:
            point.y[n + i] = guess[n + i]
    for k in range(len(qp.place)):
        slack = max(qp.sign[k] * qp.bound[k], _WARM)
        pull = max(qp.sign[k] * guess[qp.place[k]], _WARM / slack)
        point.multiplier[k] = pull
        point.slack[k] = max(slack, _WARM / pull)


# ------------------------------------------------------------------------------------- one step


@njit(cache=True, error_model="numpy")
def _step(
    qp: Scaled, point: Iterate, at: InteriorPointResiduals, system: System, floor: float
) -> bool:
    """A predictor, a corrector and the step; False if the factorisation breaks down.

    Args:
        floor: products are not made smaller than this.
    """
    sides = len(qp.place)
    slack, multiplier = point.slack, point.multiplier
    _weigh(qp, point, system)
    if not factorised(qp, system, _RHO, _DELTA) and not factorised(
        qp, system, _SAFE_RHO, _SAFE_DELTA
    ):
        return False
    before = 0.0
    for k in range(sides):
        product = slack[k] * multiplier[k]
        before += product
        system.product[k] = -product
    length = 1.0
    if sides:
        length = _direction(qp, point, at, system, 0)
        after = 0.0
        for k in range(sides):
            after += (slack[k] + length * system.slack[k]) * (
                multiplier[k] + length * system.multiplier[k]
            )
        centre = min(1.0, max(_LEAST_CENTRE, (max(after, 0.0) / before) ** 3))
        target = max(centre * before / sides, floor)
        for k in range(sides):
            system.product[k] += target - system.slack[k] * system.multiplier[k]
    length = _direction(qp, point, at, system, 1)
    if length < 1.0:
        length *= min(_NEARLY, max(_TO_BOUNDARY, 1.0 - before / sides))
    for j in range(len(qp.q)):
        point.d[j] += length * system.step[j]
    for i in range(len(qp.q), len(system.step)):
        point.y[i] += length * system.step[i]
    for k in range(sides):
        slack[k] += length * system.slack[k]
        multiplier[k] += length * system.multiplier[k]
    return True


@njit(cache=True, error_model="numpy")
def _weigh(qp: Scaled, point: Iterate, system: System) -> None:
    """The sides' share of the diagonal."""
    system.weight[:] = 0.0
    for k in range(len(qp.place)):
        z = point.multiplier[k]
        system.weight[qp.place[k]] += z / (point.slack[k] + _DELTA * z)


@njit(cache=True, error_model="numpy")
def _direction(
    qp: Scaled, point: Iterate, at: InteriorPointResiduals, system: System, refinements: int
) -> float:
    """The step for the sides' products to gain ``system.product``; how far it may go."""
    n = len(qp.q)
    push, right, weight = system.push, system.right, system.weight
    push[:] = 0.0
    for k in range(len(qp.place)):
        z = point.multiplier[k]
        gain = (system.product[k] - z * at.primal[k]) / (point.slack[k] + _DELTA * z)
        push[qp.place[k]] += qp.sign[k] * gain
    for j in range(n):
        right[j] = 0.0 if qp.fixed[j] else -at.dual[j] - push[j]
    for i in range(len(qp.target)):
        pull = weight[n + i]
        if qp.equal[i]:
            right[n + i] = at.miss[i]
        else:
            right[n + i] = 0.0 if pull == 0.0 else -push[n + i] / pull
    solved(qp, system, refinements)
    values(qp, system.step, system.change)
    length = 1.0
    for k in range(len(qp.place)):
        s, z = point.slack[k], point.multiplier[k]
        r = at.primal[k] - qp.sign[k] * system.change[qp.place[k]]
        dz = (system.product[k] - z * r) / (s + _DELTA * z)
        ds = r + _DELTA * dz
        system.slack[k], system.multiplier[k] = ds, dz
        if s + length * ds < 0.0:
            length = -s / ds
        if z + length * dz < 0.0:
            length = -z / dz
    return length
