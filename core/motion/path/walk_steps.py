"""What a walk does at a stretch: prove that the arm keeps its branch, or hop over a singularity.

A walk is three states (`States`): where it stands, where it came from, and its next step.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.lean import inner
from ..geometry.curve_bounds import bound_jerk
from ..geometry.curves import Samples, TcpCurves
from .branch_proof import TubeWork, invert, stays_in_tube
from .singular_samples import EVEN, ROUNDED
from .tcp_samples import CONVERGED, SINGULAR, Scratch, States, columns_at, state_at

HERE, CAME, NEXT = 0, 1, 2
"""Rows of a walk."""


@inner
def copy_row(source: States, i: int, target: States, j: int) -> None:
    for n in range(source.q.shape[1]):
        target.q[j, n] = source.q[i, n]
        target.dq[j, n], target.ddq[j, n] = source.dq[i, n], source.ddq[i, n]
    for n in range(6):
        target.v[j, n], target.a[j, n] = source.v[i, n], source.a[i, n]


@inner
def stand(chain: Chain, q: FloatArray, work: Scratch, tube: TubeWork) -> int:
    """Write the chain's columns at q (N,) into ``work``, and their inverse into ``tube``."""
    columns_at(chain, q, work)
    return int(invert(chain, work.place, work.columns, tube))


@inner
def keeps_branch(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    walk: States,
    step: float,
    jerk: FloatArray,
    by_t: FloatArray,
    work: Scratch,
    tube: TubeWork,
) -> bool:
    """Whether the joints stay in a tube, ``tube.radius``, for ``step`` on from its place.

    Args:
        chain, solved, prescribed, walk, work, tube: as elsewhere.
        step: σ.
        jerk: (2 + m,), bounds of third derivatives by σ; see `bound_jerk`.
        by_t: (3, at least N and 2 + m), scratch.
    """
    rate, bend, third = by_t[0], by_t[1], by_t[2]
    for j in range(walk.q.shape[1]):
        rate[j], bend[j] = step * walk.dq[HERE, j], step * step * walk.ddq[HERE, j]
    for j in range(jerk.size):
        third[j] = abs(step) ** 3 * jerk[j]
    return bool(
        stays_in_tube(chain, solved, prescribed, work.place, work.columns, rate, bend, third, tube)
    )


@inner
def hop_over(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    k: int,
    at: float,
    side: int,
    least: float,
    most: float,
    walk: States,
    jerk: FloatArray,
    taylor: FloatArray,
    by_t: FloatArray,
    work: Scratch,
    tube: TubeWork,
) -> float:
    """Pass a singular configuration that the joints run through evenly.

    Where a path lies in the plane of an arm whose wrist passes its straight posture, say, joints
    and their rates are what they would be without a singularity there, also where the points of
    the path are written with rounding. Nothing can be proven on the place itself; what stands on
    both sides of it has to agree.

    Args:
        at: σ where the walk stands.
        side: sign of the Jacobian's determinant there; beyond the singularity it is the other. 0
            on a singular configuration, beyond which it may be either.
        least: how far to hop at first, with the sign of the way.
        most: and at most.
        chain, solved, prescribed, curves, samples, k, walk, jerk, by_t, work, tube: as in
            `sample_tcp`.

    Returns:
        How far it hopped, the walk then standing there; 0 where joints do not run evenly.
    """
    hop, jump = least, (ROUNDED if side == 0 else 0.0)
    while abs(hop) <= most:
        way = turn = 0.0
        for j in range(walk.q.shape[1]):
            way = max(way, abs(hop * walk.dq[HERE, j]))
            turn = max(turn, abs(hop * hop * walk.ddq[HERE, j]))
            walk.q[NEXT, j] = walk.q[HERE, j] + hop * (
                walk.dq[HERE, j] + 0.5 * hop * walk.ddq[HERE, j]
            )
        if turn > way:
            break
        for j in range(walk.q.shape[1]):
            by_t[0, j] = walk.q[NEXT, j]
        error, met = np.inf, 0.0
        for _ in range(2 if side == 0 else 1):
            # The first finds axes that hardly move the tool, the second their rates.
            error, met = state_at(
                chain, solved, prescribed, curves, samples, k, at + hop, walk, NEXT, work
            )
        even = error < CONVERGED and met >= SINGULAR
        for j in range(walk.q.shape[1]):
            even = even and abs(walk.q[NEXT, j] - by_t[0, j]) <= EVEN * way + jump
            bend = walk.dq[NEXT, j] - walk.dq[HERE, j] - hop * walk.ddq[HERE, j]
            even = even and abs(hop * bend) <= EVEN * way
        if even:
            beyond = States(
                walk.q[NEXT:], walk.dq[NEXT:], walk.ddq[NEXT:], walk.v[NEXT:], walk.a[NEXT:]
            )
            beyond_side = stand(chain, walk.q[NEXT], work, tube)
            even = beyond_side == -side or (side == 0 and beyond_side != 0)
            onward = hop / (64 if side == 0 else 8)
            bound_jerk(curves, samples, k, at + hop + 0.5 * onward, 0.5 * abs(onward), taylor, jerk)
            if even and keeps_branch(
                chain, solved, prescribed, beyond, onward, jerk, by_t, work, tube
            ):
                copy_row(walk, NEXT, walk, HERE)
                return hop
        hop *= 2
    return 0.0
