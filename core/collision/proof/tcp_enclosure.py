"""Compiled, verified enclosures of q(σ) where inverse kinematics makes it.

About the configuration at an interval's middle a tube is found that q(σ) does not leave (see
`flyby.core.motion.path.branch_proof`). It holds one branch of inverse kinematics:
configurations at the interval's ends that are found in it are that branch's own, and neighbouring
intervals join up.
Second and third derivatives follow from J q'' = A − J̇ q' and one derivative more.

All derivatives here are by t = (σ − σ_m) / half in [−1, 1].
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...motion.geometry.curve_bounds import jerk_bounds
from ...motion.geometry.curves import Samples, TcpCurves
from ...motion.path.branch_proof import (
    LEAST,
    TubeWork,
    bounded_solution,
    invert,
    make_tube_work,
    stays_in_tube,
)
from ...motion.path.tcp_samples import (
    CONVERGED,
    SINGULAR,
    States,
    make_scratch,
    set_places,
    state_at,
)
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_bounds import bias
from ...robot.kinematics.chain_kernels import jacobians
from .boxes import Boxes

_AT_FIRST = 0.03
"""Share of the fastest joint's way that tubes are tried to be as wide as; see `stays_in_tube`."""


@njit(cache=True, error_model="numpy")
def _bound_higher(
    chain: Chain, solved: IntArray, place: IntArray, order: int, twist: FloatArray, work: TubeWork
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
    if not bounded_solution(work, linear, angular):
        return False
    for i in range(6):
        target[solved[i]] = work.y[i]
    return True


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
    work = make_tube_work(size, chain.joint.size)
    place = np.full(size, -1, dtype=np.int64)
    for j in range(6):
        place[solved[j]] = j
    acceleration = np.empty(2)
    for m in range(rows.size):
        row = rows[m]
        if not boxes.verified[row]:
            continue
        boxes.verified[row] = False
        rate, bend = states.dq[m], states.ddq[m]
        for part in range(2):
            i = 3 * part
            a = states.a[m, i] ** 2 + states.a[m, i + 1] ** 2 + states.a[m, i + 2] ** 2
            acceleration[part] = np.sqrt(a) + jerk[m, part]
        if not (
            invert(chain, place, columns[m], work) != 0
            and stays_in_tube(
                chain, solved, prescribed, place, columns[m], rate, bend, jerk[m], _AT_FIRST, work
            )
            < np.inf
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
                middle = states.q[m, j] + (2 * end - 1) * rate[j]
                if not abs(ends[m, end, j] - middle) <= work.radius[j] + LEAST:
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
    errors = np.empty(count)
    work = make_scratch(states.q.shape[1], prescribed.size, chain.joint.size)
    set_places(solved, work)
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
    boxes.verified[rows] = (errors < CONVERGED) & (pivots >= SINGULAR)
    step = half[:, None]
    by_t = States(
        states.q, step * states.dq, step**2 * states.ddq, step * states.v, step**2 * states.a
    )
    jerk = step**3 * jerk_bounds(curves, samples, half)
    single = chain._replace(joint=np.arange(len(chain.joint)))
    columns = jacobians(single, np.ascontiguousarray(states.q[:, chain.joint]))
    _verify(chain, solved, prescribed, columns, by_t, jerk, ends, rows, boxes)
