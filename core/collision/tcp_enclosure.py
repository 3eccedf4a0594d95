"""Compiled, verified enclosures of q(σ) where inverse kinematics makes it.

On an interval about σ_m the TCP's pose is X(σ) and the six solved joints follow from J q' = V.
Take a box |q_j − q_mj| ≤ ρ_j about the configuration at the middle. In it the columns of J differ
from those at the middle by no more than

    |δv_k| ≤ Σ_m ρ_m Λ_max(m,k),    |δs_k| ≤ Σ_{m<k} ρ_m,

Λ_k being the farthest that the TCP gets from axis k: a joint turns the columns of the joints
behind it, and the levers of those before it. So |J_m⁻¹ J(q) − 1| ≤ K entrywise, and where the
spectral radius of K is below 1,

    |q'| ≤ (1 − K)⁻¹ y,    y ≥ |J_m⁻¹ V(σ)|.

If that times the half width stays within ρ, then q(σ) cannot leave the box (where it left first,
it would have gone farther than its speed allows): the box is an enclosure. As J has no kernel on
it, the box holds one branch of inverse kinematics: configurations at the interval's ends that are
found in it are that branch's own, and neighbouring intervals join up (an orientation that comes
back after turning by θ on the way costs 0.6 |θ| in K, since |J_l⁻¹(θ) − 1| ≤ 0.6 |θ| for |θ| < 1).
Second and third derivatives follow from J q'' = A − J̇ q' and one derivative more.

All derivatives here are by t = (σ − σ_m) / half in [−1, 1].
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..motion.tcp_samples import SINGULAR, Samples, States, TcpCurves, make_scratch, state_at
from ..robot.chain import Chain
from ..robot.chain_kernels import jacobians
from ..robot.linear import factor, solve
from .boxes import Boxes
from .chain_bounds import Columns, bias, bound_columns
from .curve_bounds import jerk_bounds

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_CONVERGED = 1e-9
_ROUNDS = 6
_WIDER = 1.3
_LEAST = 1e-9
"""rad or m: rounding of configurations from Newton's method."""


class _Work(NamedTuple):
    """Arrays reused from interval to interval.

    Args:
        factors, order: of the square system last solved.
        inverse: (6, 6), J_m⁻¹ of the solved axes.
        K: (6, 6), see above.
        rho: (N,), the box.
        first, second, third: (N,), bounds of derivatives.
        y: (6,), right sides and solutions.
        bias: (4,), see `bias`.
        bound: of the columns on the box.
    """

    factors: FloatArray
    order: IntArray
    inverse: FloatArray
    K: FloatArray
    rho: FloatArray
    first: FloatArray
    second: FloatArray
    third: FloatArray
    y: FloatArray
    bias: FloatArray
    bound: Columns


@njit(cache=True, error_model="numpy")
def _make_work(size: int, joints: int) -> _Work:
    square, rows = np.empty((2, 6, 6)), np.zeros((4, size))
    columns = np.empty((5, joints))
    return _Work(
        np.empty((6, 6)),
        np.empty(6, dtype=np.int64),
        square[0],
        square[1],
        rows[0],
        rows[1],
        rows[2],
        rows[3],
        np.empty(6),
        np.empty(4),
        Columns(columns[0], columns[1], columns[2], columns[3], columns[4]),
    )


@njit(cache=True, error_model="numpy")
def _invert(chain: Chain, place: IntArray, columns: FloatArray, work: _Work) -> bool:
    """Write J_m⁻¹ of the solved axes, given the chain's columns (6, K)."""
    work.factors[:, :] = 0.0
    for k in range(chain.joint.size):
        j = place[chain.joint[k]]
        if j >= 0:
            for i in range(6):
                work.factors[i, j] += columns[i, k]
    smallest, _ = factor(work.factors, work.order)
    if not smallest > 0.0:
        return False
    for j in range(6):
        work.y[:] = 0.0
        work.y[j] = 1.0
        solve(work.factors, work.order, work.y)
        for i in range(6):
            work.inverse[i, j] = work.y[i]
    return True


@njit(cache=True, error_model="numpy")
def _row_lengths(inverse: FloatArray, i: int) -> tuple[float, float]:
    """Lengths of the linear and of the angular half of a row of J_m⁻¹."""
    return (
        np.sqrt(inverse[i, 0] ** 2 + inverse[i, 1] ** 2 + inverse[i, 2] ** 2),
        np.sqrt(inverse[i, 3] ** 2 + inverse[i, 4] ** 2 + inverse[i, 5] ** 2),
    )


@njit(cache=True, error_model="numpy")
def _bounded_solution(work: _Work, linear: float, angular: float) -> bool:
    """Replace y (6,) by (1 − K)⁻¹ (y + |J_m⁻¹ w|), w any twist of these lengths.

    Returns:
        Whether 1 − K is an M-matrix, as it is when the positive right side gives a positive x:
        then K x < x, so that the spectral radius of K is below 1.
    """
    y = work.y
    for i in range(6):
        a, b = _row_lengths(work.inverse, i)
        y[i] += a * linear + b * angular + 1e-15
        for j in range(6):
            work.factors[i, j] = -work.K[i, j]
        work.factors[i, i] += 1.0
    smallest, _ = factor(work.factors, work.order)
    if not smallest > 0.0:
        return False
    solve(work.factors, work.order, y)
    sound = True
    for i in range(6):
        sound = sound and 0.0 < y[i] < np.inf
    return sound


@njit(cache=True, error_model="numpy")
def _bound_changes(
    chain: Chain, place: IntArray, columns: FloatArray, work: _Work
) -> tuple[float, float]:
    """Write K for the box ``work.rho``.

    Returns:
        How much the prescribed axes' part J_p q_p' differs from that at the middle.
    """
    bound_columns(chain, columns, work.rho, work.bound)
    work.K[:, :] = 0.0
    twist = spin = 0.0
    for k in range(chain.joint.size):
        axis = chain.joint[k]
        linear, angular = work.bound.linear_change[k], work.bound.angular_change[k]
        j = place[axis]
        if j < 0:
            twist += linear * work.first[axis] + work.bound.linear[k] * work.second[axis]
            spin += angular * work.first[axis] + work.bound.angular[k] * work.second[axis]
            continue
        for i in range(6):
            a, b = _row_lengths(work.inverse, i)
            work.K[i, j] += a * linear + b * angular
    return twist, spin


@njit(cache=True, error_model="numpy")
def _stays_in_box(
    chain: Chain,
    solved: IntArray,
    place: IntArray,
    columns: FloatArray,
    rate: FloatArray,
    bend: FloatArray,
    change: FloatArray,
    work: _Work,
) -> bool:
    """Find a box that q does not leave; bounds of its rates stand in ``work.first`` then.

    Args:
        chain, solved, place, columns, work: as elsewhere.
        rate, bend: (N,), derivatives of q by t at the middle.
        change: (2,), how much linear and angular V differ from those at the middle.
    """
    for i in range(6):
        axis = solved[i]
        work.rho[axis] = _WIDER * (abs(rate[axis]) + 0.5 * abs(bend[axis])) + _LEAST
    for _ in range(_ROUNDS):
        twist, spin = _bound_changes(chain, place, columns, work)
        for i in range(6):
            work.y[i] = abs(rate[solved[i]])
        if not _bounded_solution(work, change[0] + twist, change[1] + spin):
            return False
        inside = True
        for i in range(6):
            axis = solved[i]
            work.first[axis] = work.y[i]
            if work.y[i] > work.rho[axis]:
                inside = False
                work.rho[axis] = _WIDER * work.y[i]
        if inside:
            return True
    return False


@njit(cache=True, error_model="numpy")
def _bound_higher(
    chain: Chain, solved: IntArray, place: IntArray, order: int, twist: FloatArray, work: _Work
) -> bool:
    """Write bounds of the solved axes' second (``order`` 0) or third (1) derivatives.

    ``twist`` (2,) bounds the linear and angular derivative of V that belongs to them.
    """
    bias(chain, work.bound.lever, work.first, work.second, work.bias)
    linear, angular = twist[0] + work.bias[2 * order], twist[1] + work.bias[2 * order + 1]
    target = work.second if order == 0 else work.third
    for k in range(chain.joint.size):
        axis = chain.joint[k]
        if place[axis] < 0:
            linear += (work.bound.linear[k] + work.bound.linear_change[k]) * target[axis]
            angular += (work.bound.angular[k] + work.bound.angular_change[k]) * target[axis]
    work.y[:] = 0.0
    if not _bounded_solution(work, linear, angular):
        return False
    for i in range(6):
        target[solved[i]] = work.y[i]
    return True


@njit(cache=True, error_model="numpy")
def _begin(
    prescribed: IntArray, rate: FloatArray, bend: FloatArray, jerk: FloatArray, work: _Work
) -> None:
    """Write the bounds of the prescribed axes; those of the solved ones are not known yet."""
    work.second[:] = 0.0
    for j in range(prescribed.size):
        axis, third = prescribed[j], jerk[2 + j]
        first, second = abs(rate[axis]), abs(bend[axis])
        work.rho[axis] = first + 0.5 * second + third / 6
        work.first[axis] = first + second + 0.5 * third
        work.second[axis] = second + third
        work.third[axis] = third


@njit(cache=True, error_model="numpy")
def _verify(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    columns: FloatArray,
    states: States,
    jerk: FloatArray,
    ends: FloatArray,
    rows: IntArray,
    boxes: Boxes,
) -> None:
    """Write the boxes of intervals whose middles are known.

    Args:
        chain, solved, prescribed: as in `enclose`.
        columns: (M, 6, K), one column per joint of the chain at the middles.
        states: M, at the middles, derivatives by t.
        jerk: (M, 2 + m), bounds of the third derivatives of place, turn and prescribed axes by t.
        ends, rows, boxes: as in `enclose`.
    """
    size = states.q.shape[1]
    work = _make_work(size, chain.joint.size)
    place = np.full(size, -1, dtype=np.int64)
    for j in range(6):
        place[solved[j]] = j
    change, acceleration = np.empty(2), np.empty(2)
    for m in range(rows.size):
        row = rows[m]
        if not boxes.verified[row]:
            continue
        boxes.verified[row] = False
        rate, bend = states.dq[m], states.ddq[m]
        for part in range(2):
            i = 3 * part
            a = states.a[m, i] ** 2 + states.a[m, i + 1] ** 2 + states.a[m, i + 2] ** 2
            change[part] = np.sqrt(a) + 0.5 * jerk[m, part]
            acceleration[part] = np.sqrt(a) + jerk[m, part]
        _begin(prescribed, rate, bend, jerk[m], work)
        if not (
            _invert(chain, place, columns[m], work)
            and _stays_in_box(chain, solved, place, columns[m], rate, bend, change, work)
            and _bound_higher(chain, solved, place, 0, acceleration, work)
            and _bound_higher(chain, solved, place, 1, jerk[m], work)
        ):
            continue
        inside = True
        for j in range(size):
            first, second, third = abs(rate[j]), abs(bend[j]), work.third[j]
            boxes.rate[row, j] = rate[j]
            boxes.reach[row, j] = min(work.first[j], first + 0.5 * second + third / 6)
            boxes.first[row, j] = min(work.first[j], first + second + 0.5 * third)
            boxes.second[row, j] = min(work.second[j], second + third)
            for end in range(2):
                if abs(ends[m, end, j] - states.q[m, j]) > work.rho[j] + _LEAST:
                    inside = False
        boxes.verified[row] = inside


@njit(cache=True, error_model="numpy")
def _find_middles(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    states: States,
    conditioning: FloatArray,
) -> FloatArray:
    """Write the states of M samples, each from its own guess in ``states.q``.

    Returns:
        (M,), the pose error left at each.
    """
    count = samples.sigma.size
    work, errors = make_scratch(states.q.shape[1], prescribed.size), np.empty(count)
    for m in range(count):
        errors[m], conditioning[m] = state_at(
            chain, solved, prescribed, curves, samples, m, samples.sigma[m], states, m, work
        )
    return errors


def enclose(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    half: FloatArray,
    guess: FloatArray,
    ends: FloatArray,
    rows: IntArray,
    boxes: Boxes,
) -> None:
    """Enclose q on intervals of σ.

    Args:
        chain: from the work object to the TCP, K joints.
        solved, prescribed: indices of the axes (6,) and (m,).
        curves: the TCP's path.
        samples: the intervals' middles and their curves, (M,).
        half: (M,), half widths.
        guess: (M, N), configurations near those at the middles.
        ends: (M, 2, N), configurations at the ends; an enclosure that does not hold them is none.
        rows: (M,), where the results go.
        boxes: written.
    """
    states = States.zeros(len(rows), guess.shape[1])
    states.q[:] = guess
    pivots = np.empty(len(rows))
    errors = _find_middles(chain, solved, prescribed, curves, samples, states, pivots)
    boxes.q[rows], boxes.conditioning[rows] = states.q, pivots
    boxes.verified[rows] = (errors < _CONVERGED) & (pivots >= SINGULAR)
    step = half[:, None]
    by_t = States(
        states.q, step * states.dq, step**2 * states.ddq, step * states.v, step**2 * states.a
    )
    jerk = step**3 * jerk_bounds(curves, samples, half)
    single = chain._replace(joint=np.arange(len(chain.joint)))
    columns = jacobians(single, np.ascontiguousarray(states.q[:, chain.joint]))
    _verify(chain, solved, prescribed, columns, by_t, jerk, ends, rows, boxes)
