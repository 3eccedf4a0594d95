"""States on singular configurations that the joints run into, or out of, evenly.

A line that begins where the wrist is straight and lies in the plane of the arm, say: joints and
their rates there are the limits of what they are a little way off, though no inverse of the
Jacobian tells them. Where there is no such limit, where an axis would have to jump, controllers
stop.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.tracking import track
from ..geometry.curves import Samples, TcpCurves
from .tcp_samples import (
    CONVERGED,
    SINGULAR,
    Scratch,
    States,
    aim,
    make_scratch,
    set_places,
    state_at,
)

EVEN = 0.01
"""Share of the joints' way past a singular configuration that they may deviate from an even run."""
ROUNDED = 5e-3
"""rad or m by which axes may jump where a path leaves a singular configuration: what points ask for
that are written with rounding, and controllers spread over a period."""
_EVEN_ENOUGH = (1e-4, 0.0), (EVEN, ROUNDED)
"""Such shares and jumps, in the order in which places beside are looked for."""
FIRST = 1e-3
"""Share of the way on the same curves from which on an even run is looked for: nearer, rounding is
all that tells where an axis is that hardly moves the tool."""


def settle(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    k: int,
    reached: float,
    states: States,
) -> bool:
    """Write the state of a sample that a walk cannot come to, or cannot leave, by itself.

    Args:
        chain, solved, prescribed, curves, samples, states: as in `sample_tcp`.
        k: the sample; row k of the states holds the configuration at ``reached``.
        reached: σ up to which the walk came: that of the sample itself if it cannot leave it.

    Returns:
        Whether the joints run evenly there; nothing is written if they do not.
    """
    at, known = float(samples.sigma[k]), reached == samples.sigma[k]
    onward, behind = _end_of_curves(samples.sigma[k:]), _end_of_curves(samples.sigma[k::-1])
    way = onward - at if known and onward != at else behind - at
    least = FIRST * way
    if abs(reached - at) > abs(least):
        least = reached - at
    near, work = (
        States.zeros(4, states.q.shape[1]),
        make_scratch(states.q.shape[1], len(prescribed), len(chain.joint)),
    )
    return any(
        _settle(
            chain,
            solved,
            prescribed,
            curves,
            samples,
            k,
            least,
            way,
            known,
            share,
            jump,
            states,
            near,
            work,
        )
        for share, jump in _EVEN_ENOUGH
    )


def _end_of_curves(sigma: FloatArray) -> float:
    """Where curves change next, that begin at the first of these samples."""
    same = np.flatnonzero(np.diff(sigma) == 0.0)
    return float(sigma[same[0] if len(same) else -1])


@njit(cache=True, error_model="numpy")
def _settle(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    k: int,
    least: float,
    way: float,
    known: bool,
    share: float,
    jump: float,
    states: States,
    near: States,
    work: Scratch,
) -> bool:
    """`settle`, from a place beside the sample at which the arm is not singular.

    The nearest such place counts from which joints and rates, extrapolated, meet the sample.

    Args:
        least, way: from the sample to the first and to the last place to try, with their sign.
        known: the sample's configuration is given; else it is found.
        share, jump: of the joints' way to the place beside, and rad or m, by which they may deviate
            from an even run.
        near: scratch: where the walk stood, the place beside, what it tells of the sample, and what
            is found there.
        chain, solved, prescribed, curves, samples, k, states, work: as elsewhere.
    """
    set_places(solved, work)
    at, size = samples.sigma[k], states.q.shape[1]
    off = least
    near.q[0] = states.q[k]
    while abs(off) <= abs(way):
        near.q[1] = near.q[0]
        aim(prescribed, curves, samples, k, at + off, near, 1, work)
        track(chain, near.q[1], work.goal_R, work.value[0], solved, near.q[1])
        error, pivots = state_at(
            chain, solved, prescribed, curves, samples, k, at + off, near, 1, work
        )
        if error < CONVERGED and pivots >= SINGULAR:
            longest = 0.0
            for j in range(size):
                longest = max(longest, abs(off * near.dq[1, j]))
                rate = near.dq[1, j] - 0.5 * off * near.ddq[1, j]
                near.q[2, j] = near.q[1, j] - off * rate
            near.q[3] = states.q[k] if known else near.q[2]
            aim(prescribed, curves, samples, k, at, near, 3, work)
            even = track(chain, near.q[3], work.goal_R, work.value[0], solved, near.q[3])[0]
            for j in range(size):
                even = even and abs(near.q[3, j] - near.q[2, j]) <= share * longest + jump
                even = even and abs(off * off * near.ddq[1, j]) <= longest
            if even:
                for j in range(size):
                    states.q[k, j] = near.q[3, j]
                    states.dq[k, j] = near.dq[1, j] - off * near.ddq[1, j]
                    states.ddq[k, j] = near.ddq[1, j]
                states.v[k], states.a[k] = near.v[3], near.a[3]
                return True
        off *= 2.0
    return False
