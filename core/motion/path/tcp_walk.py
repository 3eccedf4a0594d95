"""Compiled walk along a path of the TCP, on one branch of inverse kinematics from end to end.

As far as can be, `branch_proof` proves of a stretch of the path that the joints, followed from
where the walk stands, cannot leave a tube; samples on that stretch count only if they are found in
it. Stretches that cannot be proven are halved. So no other branch is taken for the same one, and
where that cannot be decided, at a singular configuration or next to it, the walk ends.
"""

from __future__ import annotations

from functools import lru_cache
from threading import get_ident
from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import pose
from ...robot.kinematics.lean import inner, lean
from ...robot.kinematics.tracking import pose_error, track
from ..geometry.curve_bounds import bound_jerk
from ..geometry.curves import Samples, TcpCurves
from .between_states import joint_at
from .branch_proof import LEAST, TubeWork, make_tube_work
from .singular_samples import FIRST, settle
from .tcp_samples import (
    CONVERGED,
    SINGULAR,
    Scratch,
    States,
    make_scratch,
    set_places,
    state_at,
)
from .walk_steps import CAME, HERE, NEXT, copy_row, hop_over, keeps_branch, stand

JOINED = 1e-5
"""rad or m by which configurations of one place may differ: what Newton's method leaves of a pose
given with rounding, near a singularity too."""
_LONGER, _SHORTER = 1.5, 0.5
"""Factors by which a stretch is tried longer than the last, and again where it is not proven."""
_HOP, _NEAR = 0.2, 0.05
"""Share of the way between two samples, and conditioning, below which a stretch to prove may lie
next to a singular configuration."""
_FINEST = 1e-7
"""Share of the way between two samples below which steps are not halved any more."""


_FORESIGHT = 2.0
"""In multiples of the last step, how far both states at its ends tell best where joints will be."""


class _Work(NamedTuple):
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
def _work(thread: int, size: int, prescribed: int, joints: int, width: int) -> _Work:
    """For N = ``size`` axes, some of them prescribed, K = ``joints`` and curves of ``width``."""
    return _Work(
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
def _copy(source: FloatArray, target: FloatArray) -> None:
    for j in range(source.size):
        target[j] = source[j]


@inner
def _expect(walk: States, came: float, at: float, aim: float) -> None:
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
def _furthest(a: FloatArray, b: FloatArray) -> float:
    """The largest difference of two configurations."""
    most = 0.0
    for j in range(a.size):
        most = max(most, abs(a[j] - b[j]))
    return most


@inner
def _border(samples: Samples, k: int) -> float:
    """σ up to which the curves of sample k go on."""
    border = float(samples.sigma[k])
    for i in range(k + 1, samples.sigma.size):
        if samples.sigma[i] == border:
            break
        border = float(samples.sigma[i])
    return border


@njit(cache=True, error_model="numpy")
def _shortfall(chain: Chain, solved: IntArray, q: FloatArray, work: Scratch) -> float:
    """How far (m, rad) the TCP stays from the pose last evaluated, as near as the arm gets."""
    near, R, p, error = np.empty(q.size), np.empty((3, 3)), np.empty(3), np.empty(6)
    if track(chain, q, work.goal_R, work.value[0], solved, near)[0]:
        return 0.0
    pose(chain, near, R, p)
    return float(pose_error(work.goal_R, work.value[0], R, p, error))


def sample_tcp(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    first: IntArray,
    seeds: FloatArray,
    states: States,
    conditioning: FloatArray,
) -> tuple[int, float, float]:
    """Write the states along R runs of samples that follow each other along σ, each on one branch.

    Args:
        chain: the kinematics.
        solved, prescribed: indices of the axes (6,) and (m,).
        curves: the geometry.
        samples: where; on both sides of a place where curves change there is one.
        first: (R + 1,), the first sample of each run, and where the last one ends.
        seeds: (R, N), the configuration at the first sample of each.
        states: written.
        conditioning: (S,), written: smallest over largest pivot of the Jacobian, the least met
            since the sample before; 0 if a singular configuration was passed on the way.

    Returns:
        (-1, 0, σ of the last sample), or the sample that the walk does not come to, how far (m,
        rad) the TCP stays short of its pose, and the last σ that it does come to; the
        configuration there is then written in the place of the sample's.
    """
    each = (curves.position, curves.turning, curves.prescribed)
    width = max(curve.coefficients.shape[1] for curve in each)
    work = _work(get_ident(), seeds.shape[1], prescribed.size, chain.joint.size, width)
    given = -1
    while True:
        failed, short, reached = _walk_all(
            chain,
            solved,
            prescribed,
            curves,
            samples,
            first,
            seeds,
            given,
            states,
            conditioning,
            work,
        )
        if failed <= given or short > 0.0:
            break
        run = int(np.searchsorted(first, failed, side="right")) - 1
        a, b = map(int, first[run : run + 2])
        own = samples.rows(a, b)
        if not settle(
            chain, solved, prescribed, curves, own, failed - a, reached, states.rows(a, b)
        ):
            break
        conditioning[failed] = 0.0
        given = failed
    if short < 0.0:
        short = _shortfall(chain, solved, states.q[failed], work.pose)
    return failed, short, reached


@lean
def _walk_all(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    first: IntArray,
    seeds: FloatArray,
    given: int,
    states: States,
    conditioning: FloatArray,
    scratch: _Work,
) -> tuple[int, float, float]:
    """`sample_tcp`, with a negative length for how far the TCP stays short, where it is asked.

    Args:
        given: the sample whose state stands already and from which the walk goes on; -1 at first.
    """
    reached = 0.0
    for r in range(seeds.shape[0]):
        a, b = first[r], first[r + 1]
        if given >= b:
            continue
        failed, short, reached = _walk(
            chain,
            solved,
            prescribed,
            curves,
            Samples(
                samples.sigma[a:b],
                samples.position[a:b],
                samples.turning[a:b],
                samples.prescribed[a:b],
            ),
            seeds[r],
            max(given - a, -1),
            States(states.q[a:b], states.dq[a:b], states.ddq[a:b], states.v[a:b], states.a[a:b]),
            conditioning[a:b],
            scratch,
        )
        if failed >= 0:
            return a + failed, short, reached
    return -1, 0.0, reached


@inner
def _walk(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    seed: FloatArray,
    given: int,
    states: States,
    conditioning: FloatArray,
    scratch: _Work,
) -> tuple[int, float, float]:
    """One run; see `_walk_all`.

    Args:
        given: the sample whose state stands already and from which the walk goes on; -1 at first.
    """
    size = seed.size
    work, tube, walk = scratch.pose, scratch.tube, scratch.walk
    jerk, by_t, taylor = scratch.jerk, scratch.by_t, scratch.taylor
    set_places(solved, work)
    # On these curves the walk stood at ``came`` before.
    # From q = centre at ``origin`` on the tube is proven up to ``sure``; curves stay the same up to
    # ``border``.
    centre, slope, reach = scratch.centre, scratch.slope, np.inf
    slope[:] = 0.0
    origin = sure = border = came = samples.sigma[max(given, 0)]
    if given >= 0:
        border = _border(samples, given)
    for k in range(given + 1, samples.sigma.size):
        goal = samples.sigma[k]
        at = samples.sigma[max(k - 1, 0)]
        if goal == at:
            # The same place again, on the curves that begin there.
            _copy(seed if k == 0 else states.q[k - 1], centre)
            _copy(centre, states.q[k])
            error, pivots = state_at(
                chain, solved, prescribed, curves, samples, k, goal, states, k, work
            )
            conditioning[k] = pivots
            apart = _furthest(states.q[k], centre)
            if not (error < CONVERGED and pivots >= SINGULAR and apart <= JOINED):
                _copy(centre, states.q[k])
                return k, (0.0 if pivots < SINGULAR else max(error, apart)), goal
            sure, border, came = goal, _border(samples, k), goal
            continue
        whole = goal - at
        copy_row(states, k - 1, walk, HERE)
        pivots = np.inf
        least, hop_at = _FINEST * abs(whole), _HOP * abs(whole)
        while at != goal:
            aim = goal
            if (sure - goal) * whole < 0.0:
                # A tube from where the walk stands, as far as it can be proven.
                _copy(walk.q[HERE], centre)
                _copy(walk.dq[HERE], slope)
                origin = at
                side = stand(chain, centre, work, tube)
                if k == given + 1 and at == samples.sigma[given]:
                    side = 0
                left = border - at
                step = left if abs(left) <= reach else np.copysign(reach, whole)
                proven, at_once = False, True
                if side == 0:
                    # Nothing is proven of a singular configuration, and next to it little.
                    step = 0.25 * np.copysign(min(abs(whole), FIRST * abs(border - at)), whole)
                while side != 0 and not proven and (abs(step) > least or step == left):
                    bound_jerk(curves, samples, k, at + 0.5 * step, 0.5 * abs(step), taylor, jerk)
                    proven = keeps_branch(
                        chain, solved, prescribed, walk, step, jerk, by_t, work, tube
                    )
                    if not proven:
                        step, at_once = _SHORTER * step, False
                if not proven or (abs(step) < hop_at and min(pivots, conditioning[k - 1]) < _NEAR):
                    hop_at = 0.25 * abs(step)
                    hop = hop_over(
                        chain,
                        solved,
                        prescribed,
                        curves,
                        samples,
                        k,
                        at,
                        side,
                        4 * step,
                        abs(goal - at) if side == 0 else min(256 * abs(step), abs(goal - at)),
                        walk,
                        jerk,
                        taylor,
                        by_t,
                        work,
                        tube,
                    )
                    if hop != 0.0:
                        came = at = goal if hop == goal - at else at + hop
                        pivots, hop_at = 0.0, _HOP * abs(whole)
                    elif not proven:
                        conditioning[k] = min(pivots, conditioning[k - 1])
                        _copy(centre, states.q[k])
                        _copy(centre, walk.q[NEXT])
                        state_at(
                            chain, solved, prescribed, curves, samples, k, goal, walk, NEXT, work
                        )
                        return k, -1.0, at
                    sure = at
                    continue
                sure = border if step == left else at + step
                if step != left:
                    reach = (_LONGER if at_once else 1.0) * abs(step)
                if (sure - goal) * whole < 0.0:
                    aim = sure
            _expect(walk, came, at, aim)
            error, met = state_at(
                chain, solved, prescribed, curves, samples, k, aim, walk, NEXT, work
            )
            sound = error < CONVERGED and met >= SINGULAR
            for j in range(size):
                away = abs(walk.q[NEXT, j] - centre[j] - (aim - origin) * slope[j])
                sound = sound and away <= tube.radius[j] + LEAST
            if sound:
                came, pivots, at = at, min(pivots, met), aim
                copy_row(walk, HERE, walk, CAME)
                copy_row(walk, NEXT, walk, HERE)
            else:
                # Newton's method went off: begin again, with a shorter way.
                sure, reach = at, max(0.5 * abs(aim - at), 0.5 * least)
        conditioning[k] = pivots
        copy_row(walk, HERE, states, k)
    return -1, 0.0, samples.sigma[-1]
