"""What a walk does at a stretch: prove that the arm keeps its branch, or hop over a singularity.

A walk is three states (`States`): where it stands, where it came from, and its next step. Stretches
are proven about their middle: a tube there reaches as far back as it does on, twice as long as one
about where the walk stands. That the walk stands in it says that both are of one branch.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.lean import inner
from ..geometry.curve_bounds import bound_jerk
from ..geometry.curves import Samples, TcpCurves
from .between_states import joint_at
from .branch_proof import LEAST, TubeWork, invert, make_tube_work, stays_in_tube
from .singular_samples import EVEN, ROUNDED
from .tcp_samples import (
    CONVERGED,
    SINGULAR,
    Scratch,
    States,
    columns_at,
    make_scratch,
    state_at,
)

HERE, CAME, NEXT = 0, 1, 2
"""Rows of a walk."""
_AT_FIRST, _WELL = 0.06, 0.05
"""Share of the fastest joint's way that tubes are tried to be as wide as, see `stays_in_tube`, and
the conditioning below which they are narrower in proportion: there joints turn each other's axes
the more."""
_ON_SAMPLE = 0.1
"""Share of a stretch by which its middle is moved to be at a sample."""
_FIRST_WAY = 0.1
"""rad or m that the fastest joint goes on the first stretch of a run."""
_FORESIGHT = 2.0
"""In multiples of the last step, how far both states at its ends tell best where joints will be."""


class WalkWork(NamedTuple):
    """Arrays that a walk reuses: for `state_at`, for the tube, and its own.

    Rows of ``walk`` are where it stands, where it came from, and its next step.
    """

    pose: Scratch
    tube: TubeWork
    walk: States
    jerk: FloatArray
    by_t: FloatArray
    taylor: FloatArray
    centre: FloatArray
    slope: FloatArray


@lru_cache(maxsize=64)
def walk_work(thread: int, size: int, prescribed: int, joints: int, width: int) -> WalkWork:
    """For N = ``size`` axes, some of them prescribed, K = ``joints`` and curves of ``width``."""
    return WalkWork(
        make_scratch(size, prescribed, joints),
        make_tube_work(size, joints),
        States.zeros(3, size),
        np.empty(2 + prescribed),
        np.empty((3, max(size, 2 + prescribed))),
        np.empty((width, 3)),
        np.empty(size),
        np.empty(size),
    )


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
    conditioning: float,
    step: float,
    jerk: FloatArray,
    by_t: FloatArray,
    work: Scratch,
    tube: TubeWork,
) -> float:
    """Prove that joints stay in a tube, ``tube.radius``, for ``step`` to both sides of a walk's
    next step; returns what `stays_in_tube` does.

    Args:
        chain, solved, prescribed, walk, work, tube: as elsewhere.
        conditioning: of the Jacobian there.
        step: σ.
        jerk: (2 + m,), bounds of third derivatives by σ; see `bound_jerk`.
        by_t: (3, at least N and 2 + m), scratch.
    """
    rate, bend, third = by_t[0], by_t[1], by_t[2]
    for j in range(walk.q.shape[1]):
        rate[j], bend[j] = step * walk.dq[NEXT, j], step * step * walk.ddq[NEXT, j]
    for j in range(jerk.size):
        third[j] = abs(step) ** 3 * jerk[j]
    width = _AT_FIRST * min(1.0, conditioning / _WELL)
    given = work.place, work.columns, rate, bend, third, width
    return float(stays_in_tube(chain, solved, prescribed, *given, tube))


@inner
def expect(walk: States, came: float, at: float, aim: float) -> None:
    """Write what the last states let expect of the joints at ``aim`` as the next step.

    Args:
        walk: stands at ``at``, and came from ``came`` if that is another place.
        came, at, aim: σ, on the same curves.
    """
    step, last = aim - at, at - came
    known = last != 0.0 and abs(step) <= _FORESIGHT * abs(last)
    for j in range(walk.q.shape[1]):
        if known:
            walk.q[NEXT, j], _, _ = joint_at(walk, HERE, j, -last, -step / last)
        else:
            rate = walk.dq[HERE, j] + 0.5 * step * walk.ddq[HERE, j]
            walk.q[NEXT, j] = walk.q[HERE, j] + step * rate


@inner
def first_reach(rate: FloatArray) -> float:
    """σ of the first stretch of a run, given how fast joints are (N,)."""
    fastest = 0.0
    for j in range(rate.size):
        fastest = max(fastest, abs(rate[j]))
    return _FIRST_WAY / fastest if fastest > 0.0 else np.inf


@inner
def _middle(samples: Samples, k: int, at: float, step: float) -> float:
    """About the middle of a step from ``at``, at a sample behind k where one is near."""
    middle = at + 0.5 * step
    for i in range(k, samples.sigma.size):
        off = samples.sigma[i] - middle
        if abs(off) <= _ON_SAMPLE * abs(step):
            return float(samples.sigma[i])
        if off * step > 0.0:
            break
    return middle


@inner
def prove(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    k: int,
    came: float,
    at: float,
    step: float,
    scratch: WalkWork,
) -> tuple[float, float, float]:
    """Prove a tube about a place in the middle of a step, on whose branch the walk stands.

    Args:
        came, at: as in `expect`.
        step: from ``at``, on the curves of sample k.
        chain, solved, prescribed, curves, samples, scratch: as in `sample_tcp`.

    Returns:
        The place, the conditioning there, and how near the proof came to failing; inf if it did.
        The state there is the walk's next step.
    """
    work, tube, walk = scratch.pose, scratch.tube, scratch.walk
    middle = _middle(samples, k, at, step)
    expect(walk, came, at, middle)
    error, met = state_at(chain, solved, prescribed, curves, samples, k, middle, walk, NEXT, work)
    if not (error < CONVERGED and met >= SINGULAR):
        return middle, met, np.inf
    invert(chain, work.place, work.columns, tube)
    half = 0.5 * abs(step)
    bound_jerk(curves, samples, k, at + 0.5 * step, half, scratch.taylor, scratch.jerk)
    half = np.copysign(half + abs(middle - at - 0.5 * step), step)
    strain = keeps_branch(
        chain, solved, prescribed, walk, met, half, scratch.jerk, scratch.by_t, work, tube
    )
    for j in range(walk.q.shape[1]):
        away = abs(walk.q[HERE, j] - walk.q[NEXT, j] - (at - middle) * walk.dq[NEXT, j])
        if not away <= tube.radius[j] + LEAST:
            strain = np.inf
    return middle, met, strain


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
            beyond_side = stand(chain, walk.q[NEXT], work, tube)
            even = beyond_side == -side or (side == 0 and beyond_side != 0)
            onward = hop / (64 if side == 0 else 8)
            bound_jerk(curves, samples, k, at + hop + 0.5 * onward, 0.5 * abs(onward), taylor, jerk)
            if even and np.inf > keeps_branch(
                chain, solved, prescribed, walk, met, onward, jerk, by_t, work, tube
            ):
                copy_row(walk, NEXT, walk, HERE)
                return hop
        hop *= 2
    return 0.0
