"""Compiled proofs that inverse kinematics keeps to one of its branches on an interval of σ.

From a known configuration q_m, where the TCP has the pose X(σ_m), the six solved joints follow
from J q' = V. All derivatives here are by t = (σ − σ_m) / h with |t| ≤ 1. Take the tube

    |q_j(t) − q_mj − t q_mj'| ≤ r_j.

In it J(t) = J_m + Σ_m δ_m ∂_mJ + R, with δ the way from q_m, the derivatives those at q_m, and R of
second order, bounded by levers (`flyby.core.robot.kinematics.chain_bounds`). So, entrywise,

    |J_m⁻¹ J − 1| ≤ K = |Σ_m q_m' J_m⁻¹ ∂_mJ| + P,    P = Σ_m r_m |J_m⁻¹ ∂_mJ| + |J_m⁻¹| |R|,

and from J q' = V and J_m q_m'' = A − Σ_m q_m' ∂_mJ q_m' follows, where the spectral radius of K is
below 1,

    |q' − q_m'| ≤ (1 − K)⁻¹ (|q_m''| + P |q_m'| + |J_m⁻¹| max |V''| / 2).

If that stays within r, then q(t) cannot leave the tube (where it left first, it would have gone
farther than its speed allows). As J has no kernel on it, the tube holds one branch of inverse
kinematics: a configuration for the TCP's pose at some t that is found in it is that branch's own
(an orientation that comes back after turning by θ on the way costs 0.6 |θ| in K, since
|J_l⁻¹(θ) − 1| ≤ 0.6 |θ| for |θ| < 1).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba.extending import register_jitable

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_bounds import ColumnBounds, bound_columns, turn_columns
from ...robot.kinematics.lean import inner
from ...robot.kinematics.linear import factor, invert_factors, solve

LEAST = 1e-9
"""rad or m: rounding of configurations from Newton's method."""
_ROUNDS = 6
_WIDER = 1.3


class TubeWork(NamedTuple):
    """Arrays reused from interval to interval.

    Args:
        factors, order: of the square system last solved.
        inverse: (6, 6), J_m⁻¹ of the solved axes.
        rows: (6, 2), lengths of the linear and of the angular halves of its rows.
        K: (6, 6), see above.
        turned: (6, K, K), J_m⁻¹ ∂_mJ: row, m, column.
        sizes: (6, K, K), their absolute values.
        swept: (6, K), |Σ_m q_m' J_m⁻¹ ∂_mJ|.
        by_radius: (6, K), Σ_m r_m |J_m⁻¹ ∂_mJ|.
        rho: (N,), |q_m'| + r.
        radius: (N,), r.
        first, second, third: (N,), bounds of derivatives.
        y: (6,), right sides and solutions.
        bias: (4,), see `bias`.
        bound: of the columns in the tube.
    """

    factors: FloatArray
    order: IntArray
    inverse: FloatArray
    rows: FloatArray
    K: FloatArray
    turned: FloatArray
    sizes: FloatArray
    swept: FloatArray
    by_radius: FloatArray
    rho: FloatArray
    radius: FloatArray
    first: FloatArray
    second: FloatArray
    third: FloatArray
    y: FloatArray
    bias: FloatArray
    bound: ColumnBounds


@register_jitable
def make_tube_work(size: int, joints: int) -> TubeWork:
    """Arrays for N = ``size`` axes and K = ``joints`` joints of a chain."""
    square, rows = np.empty((2, 6, 6)), np.zeros((5, size))
    columns = np.empty((7, joints))
    return TubeWork(
        np.empty((6, 6)),
        np.empty(6, dtype=np.int64),
        square[0],
        np.empty((6, 2)),
        square[1],
        np.empty((6, joints, joints)),
        np.empty((6, joints, joints)),
        np.empty((6, joints)),
        np.empty((6, joints)),
        rows[0],
        rows[1],
        rows[2],
        rows[3],
        rows[4],
        np.empty(6),
        np.empty(4),
        ColumnBounds(
            columns[0], columns[1], columns[2], columns[3], columns[4], columns[5], columns[6]
        ),
    )


@inner
def invert(chain: Chain, place: IntArray, columns: FloatArray, work: TubeWork) -> int:
    """Write J_m⁻¹ of the solved axes and J_m⁻¹ ∂_mJ, given the chain's columns (6, K).

    Returns:
        The sign of the determinant of J_m: 1 or -1, 0 where it is singular.
    """
    work.factors[:, :] = 0.0
    for k in range(chain.joint.size):
        j = place[chain.joint[k]]
        if j >= 0:
            for i in range(6):
                work.factors[i, j] += columns[i, k]
    smallest, _ = factor(work.factors, work.order, 6)
    if not smallest > 0.0:
        return 0
    sign = 1
    for j in range(6):
        if (work.factors[j, j] < 0.0) != (work.order[j] != j):
            sign = -sign
    invert_factors(work.factors, work.order, work.inverse, 6)
    for i in range(6):
        for part in range(2):
            square = 0.0
            for j in range(3 * part, 3 * part + 3):
                square += work.inverse[i, j] ** 2
            work.rows[i, part] = np.sqrt(square)
    turn_columns(chain, columns, work.inverse, work.turned, work.sizes)
    return sign


@inner
def bounded_solution(work: TubeWork, linear: float, angular: float) -> bool:
    """Replace y (6,) by (1 − K)⁻¹ (y + |J_m⁻¹ w|), w any twist of these lengths.

    Returns:
        Whether 1 − K is an M-matrix, as it is when the positive right side gives a positive x:
        then K x < x, so that the spectral radius of K is below 1.
    """
    y = work.y
    for i in range(6):
        y[i] += work.rows[i, 0] * linear + work.rows[i, 1] * angular + 1e-15
        for j in range(6):
            work.factors[i, j] = -work.K[i, j]
        work.factors[i, i] += 1.0
    smallest, _ = factor(work.factors, work.order, 6)
    if not smallest > 0.0:
        return False
    solve(work.factors, work.order, y, 6)
    sound = True
    for i in range(6):
        sound = sound and 0.0 < y[i] < np.inf
    return sound


@inner
def _stays_inside(
    solved: IntArray, work: TubeWork, linear: float, angular: float
) -> tuple[bool, float]:
    """Whether y + K r + |J_m⁻¹ w| ≤ r, w any twist of these lengths: r then bounds the solution.

    As y > 0 here, 1 − K is an M-matrix then; see `bounded_solution`. What is written to
    ``work.first`` but for |q_m'| is the left side.

    Returns:
        That, and the greatest share of r that is K r, times that of the left side up to one: it
        grows with about the square of the tube's length.
    """
    inside, strain, tight = True, 0.0, 0.0
    for i in range(6):
        most = work.y[i] + work.rows[i, 0] * linear + work.rows[i, 1] * angular + 1e-15
        own, radius = 0.0, work.radius[solved[i]]
        for j in range(6):
            own += work.K[i, j] * work.radius[solved[j]]
        most += own
        work.first[solved[i]] = most
        # A comparison that holds for what is not a number, too.
        inside = inside and most < radius
        strain, tight = max(strain, own / radius), max(tight, most / radius)
    return inside, strain * min(tight, 1.0)


@inner
def _bound_changes(
    chain: Chain,
    place: IntArray,
    columns: FloatArray,
    rate: FloatArray,
    bend: FloatArray,
    work: TubeWork,
) -> tuple[float, float]:
    """Write K for the tube ``work.radius``, and add P |q_m'| to y, but for the part with R.

    Returns:
        That part, and what the prescribed axes make beyond first order: a twist of these lengths.
    """
    bound, size, slack = work.bound, chain.joint.size, 0.0
    for j in range(rate.size):
        work.rho[j] = abs(rate[j]) + work.radius[j]
    for k in range(size):
        if not chain.prismatic[k]:
            slack += 0.6 * work.radius[chain.joint[k]]
    if slack > 0.6:
        slack = np.inf
    bound_columns(chain, columns, work.rho, bound)
    for i in range(6):
        for k in range(size):
            work.by_radius[i, k] = 0.0
        for j in range(6):
            work.K[i, j] = 0.0
        for m in range(size):
            reach = work.radius[chain.joint[m]]
            for k in range(size):
                work.by_radius[i, k] += reach * work.sizes[i, m, k]
    twist = spin = 0.0
    for k in range(size):
        axis = chain.joint[k]
        j, speed = place[axis], abs(rate[axis])
        linear, angular = bound.linear_bent[k], bound.angular_bent[k]
        twist += linear * speed
        spin += angular * speed
        if not chain.prismatic[k]:
            angular += slack
        for i in range(6):
            by_radius = work.by_radius[i, k]
            work.y[i] += by_radius * speed
            if j >= 0:
                more = work.rows[i, 0] * linear + work.rows[i, 1] * angular
                work.K[i, j] += work.swept[i, k] + by_radius + more
        if j < 0:
            third = 0.5 * work.third[axis]
            more = abs(bend[axis]) + third
            twist += bound.linear_change[k] * more + bound.linear[k] * third
            spin += bound.angular_change[k] * more + bound.angular[k] * third
    return twist, spin


@inner
def _begin(
    prescribed: IntArray, rate: FloatArray, bend: FloatArray, jerk: FloatArray, work: TubeWork
) -> None:
    """Write the bounds of the prescribed axes; those of the solved ones are not known yet."""
    work.second[:] = 0.0
    for j in range(prescribed.size):
        axis, third = prescribed[j], jerk[2 + j]
        first, second = abs(rate[axis]), abs(bend[axis])
        work.radius[axis] = 0.5 * second + third / 6
        work.first[axis] = first + second + 0.5 * third
        work.second[axis] = second + third
        work.third[axis] = third


@inner
def stays_in_tube(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    place: IntArray,
    columns: FloatArray,
    rate: FloatArray,
    bend: FloatArray,
    jerk: FloatArray,
    at_first: float,
    work: TubeWork,
) -> float:
    """Find a tube that q does not leave, ``work.radius``, and bounds of |q'| in ``work.first``.

    Args:
        chain: K joints over N axes.
        solved, prescribed: the axes (6,) that inverse kinematics solves for, and the others (m,).
        place: (N,), where a solved axis stands among them, -1 for the others.
        columns: (6, K), one column per joint of the chain at q_m.
        rate, bend: (N,), derivatives of q at q_m.
        jerk: (2 + m,), bounds of the third derivatives of place, turn and prescribed axes.
        at_first: share of the fastest joint's way that is taken for the tube's radius to begin
            with. The narrower, the tighter the bounds; the wider, the sooner it is proven.
        work: with the inverse of the solved columns; see `invert`.

    Returns:
        How near the proof came to failing, below 1; inf if no tube was found.
    """
    _begin(prescribed, rate, bend, jerk, work)
    fastest = 0.0
    for i in range(6):
        fastest = max(fastest, abs(rate[solved[i]]))
        for k in range(chain.joint.size):
            work.swept[i, k] = 0.0
        for m in range(chain.joint.size):
            way = rate[chain.joint[m]]
            for k in range(chain.joint.size):
                work.swept[i, k] += work.turned[i, m, k] * way
        for k in range(chain.joint.size):
            work.swept[i, k] = abs(work.swept[i, k])
    for i in range(6):
        work.radius[solved[i]] = _WIDER * abs(bend[solved[i]]) + at_first * fastest + LEAST
    for _ in range(_ROUNDS):
        for i in range(6):
            work.y[i] = abs(bend[solved[i]])
        twist, spin = _bound_changes(chain, place, columns, rate, bend, work)
        linear, angular = 0.5 * jerk[0] + twist, 0.5 * jerk[1] + spin
        inside, strain = _stays_inside(solved, work, linear, angular)
        if inside:
            for i in range(6):
                work.first[solved[i]] += abs(rate[solved[i]])
            return float(strain)
        if not bounded_solution(work, linear, angular):
            return np.inf
        inside = True
        for i in range(6):
            axis = solved[i]
            work.first[axis] = abs(rate[axis]) + work.y[i]
            if work.y[i] > work.radius[axis]:
                inside = False
                work.radius[axis] = _WIDER * work.y[i]
        if inside:
            return float(strain)
    return np.inf
