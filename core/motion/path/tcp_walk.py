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
from ...robot.kinematics.chain_kernels import jacobian
from ...robot.kinematics.lean import inner, lean
from ...robot.kinematics.tracking import pose_error, track
from ..geometry.curve_bounds import bound_jerk
from ..geometry.curves import Samples, TcpCurves
from .branch_proof import LEAST, TubeWork, invert, make_tube_work, stays_in_tube
from .singular_samples import EVEN, FIRST, ROUNDED, settle
from .tcp_samples import CONVERGED, SINGULAR, Scratch, States, make_scratch, state_at

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


class _Work(NamedTuple):
    """Arrays that a walk reuses: for `state_at`, for the tube, and its own.

    Row 0 of ``walk`` is where it stands, row 1 its next step.
    """

    pose: Scratch
    tube: TubeWork
    walk: States
    J: FloatArray
    jerk: FloatArray
    by_t: FloatArray
    taylor: FloatArray
    place: IntArray
    joints: IntArray
    centre: FloatArray
    slope: FloatArray


@lru_cache(maxsize=64)
def _work(thread: int, size: int, prescribed: int, joints: int, width: int) -> _Work:
    """For N = ``size`` axes, some of them prescribed, K = ``joints`` and curves of ``width``."""
    return _Work(
        make_scratch(size, prescribed),
        make_tube_work(size, joints),
        States.zeros(2, size),
        np.empty((6, joints)),
        np.empty(2 + prescribed),
        np.empty((3, max(size, 2 + prescribed))),
        np.empty((width, 3)),
        np.empty(size, dtype=np.int64),
        np.arange(joints),
        np.empty(size),
        np.empty(size),
    )


@inner
def _copy(source: FloatArray, target: FloatArray) -> None:
    for j in range(source.size):
        target[j] = source[j]


@inner
def _copy_row(source: States, i: int, target: States, j: int) -> None:
    for n in range(source.q.shape[1]):
        target.q[j, n] = source.q[i, n]
        target.dq[j, n], target.ddq[j, n] = source.dq[i, n], source.ddq[i, n]
    for n in range(6):
        target.v[j, n], target.a[j, n] = source.v[i, n], source.a[i, n]


@inner
def _stand(
    chain: Chain, single: Chain, place: IntArray, q: FloatArray, J: FloatArray, work: TubeWork
) -> int:
    """Write the chain's columns J (6, K) at q (N,), and their inverse into ``work``.

    ``single`` is the chain with a value for each of its joints, whichever axis they belong to.
    """
    for k in range(chain.joint.size):
        work.values[k] = q[chain.joint[k]]
    jacobian(single, work.values, work.R, work.p, J)
    return int(invert(chain, place, J, work))


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


@inner
def _keeps_branch(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    place: IntArray,
    J: FloatArray,
    walk: States,
    step: float,
    jerk: FloatArray,
    by_t: FloatArray,
    work: TubeWork,
) -> bool:
    """Whether the joints stay in a tube, ``work.radius``, for ``step`` on from row 0 of the walk.

    Args:
        chain, solved, prescribed, place, J, walk, work: as elsewhere.
        step: σ.
        jerk: (2 + m,), bounds of third derivatives by σ; see `bound_jerk`.
        by_t: (3, at least N and 2 + m), scratch.
    """
    rate, bend, third = by_t[0], by_t[1], by_t[2]
    for j in range(walk.q.shape[1]):
        rate[j], bend[j] = step * walk.dq[0, j], step * step * walk.ddq[0, j]
    for j in range(jerk.size):
        third[j] = abs(step) ** 3 * jerk[j]
    return bool(stays_in_tube(chain, solved, prescribed, place, J, rate, bend, third, work))


@inner
def _hop(
    chain: Chain,
    single: Chain,
    solved: IntArray,
    prescribed: IntArray,
    place: IntArray,
    curves: TcpCurves,
    samples: Samples,
    k: int,
    at: float,
    side: int,
    least: float,
    most: float,
    walk: States,
    J: FloatArray,
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
        at: σ where the walk stands, in row 0.
        side: sign of the Jacobian's determinant there; beyond the singularity it is the other. 0
            on a singular configuration, beyond which it may be either.
        least: how far to hop at first, with the sign of the way.
        most: and at most.
        chain, single, solved, prescribed, place, curves, samples, k, walk, J, jerk, by_t, work,
            tube: as in `sample_tcp`.

    Returns:
        How far it hopped, row 0 then being there; 0 where joints do not run evenly.
    """
    hop, jump = least, (ROUNDED if side == 0 else 0.0)
    while abs(hop) <= most:
        way = turn = 0.0
        for j in range(walk.q.shape[1]):
            way = max(way, abs(hop * walk.dq[0, j]))
            turn = max(turn, abs(hop * hop * walk.ddq[0, j]))
            walk.q[1, j] = walk.q[0, j] + hop * (walk.dq[0, j] + 0.5 * hop * walk.ddq[0, j])
        if turn > way:
            break
        for j in range(walk.q.shape[1]):
            by_t[0, j] = walk.q[1, j]
        error, met = np.inf, 0.0
        for _ in range(2 if side == 0 else 1):
            # The first finds axes that hardly move the tool, the second their rates.
            error, met = state_at(
                chain, solved, prescribed, curves, samples, k, at + hop, walk, 1, work
            )
        even = error < CONVERGED and met >= SINGULAR
        for j in range(walk.q.shape[1]):
            even = even and abs(walk.q[1, j] - by_t[0, j]) <= EVEN * way + jump
            bend = walk.dq[1, j] - walk.dq[0, j] - hop * walk.ddq[0, j]
            even = even and abs(hop * bend) <= EVEN * way
        if even:
            beyond = States(walk.q[1:], walk.dq[1:], walk.ddq[1:], walk.v[1:], walk.a[1:])
            beyond_side = _stand(chain, single, place, walk.q[1], J, tube)
            even = beyond_side == -side or (side == 0 and beyond_side != 0)
            onward = hop / (64 if side == 0 else 8)
            bound_jerk(curves, samples, k, at + hop + 0.5 * onward, 0.5 * abs(onward), taylor, jerk)
            if even and _keeps_branch(
                chain, solved, prescribed, place, J, beyond, onward, jerk, by_t, tube
            ):
                _copy_row(walk, 1, walk, 0)
                return hop
        hop *= 2
    return 0.0


@njit(cache=True, error_model="numpy")
def _shortfall(chain: Chain, solved: IntArray, q: FloatArray, work: Scratch) -> float:
    """How far (m, rad) the TCP stays from the pose last evaluated, as near as the arm gets."""
    near, R, p, error = np.empty(q.size), np.empty((3, 3)), np.empty(3), np.empty(6)
    if track(chain, q, work.goal_R, work.value[0], solved, near)[0]:
        return 0.0
    jacobian(chain, near, R, p, work.J)
    return float(pose_error(work.goal_R, work.value[0], R, p, error))


def sample_tcp(
    chain: Chain,
    solved: IntArray,
    prescribed: IntArray,
    curves: TcpCurves,
    samples: Samples,
    seed: FloatArray,
    states: States,
    conditioning: FloatArray,
) -> tuple[int, float, float]:
    """Write the states of samples that follow each other along σ, on one branch.

    Args:
        chain: the kinematics.
        solved, prescribed: indices of the axes (6,) and (m,).
        curves: the geometry.
        samples: where; on both sides of a place where curves change there is one.
        seed: (N,), the configuration at the first sample.
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
    work = _work(get_ident(), seed.size, prescribed.size, chain.joint.size, width)
    given = -1
    while True:
        failed, short, reached = _walk(
            chain, solved, prescribed, curves, samples, seed, given, states, conditioning, work
        )
        if failed <= given or short > 0.0:
            break
        if not settle(chain, solved, prescribed, curves, samples, failed, reached, states):
            break
        conditioning[failed] = 0.0
        given = failed
    if short < 0.0:
        short = _shortfall(chain, solved, states.q[failed], work.pose)
    return failed, short, reached


@lean
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
    """`sample_tcp`, with a negative length for how far the TCP stays short, where it is asked.

    Args:
        given: the sample whose state stands already and from which the walk goes on; -1 at first.
    """
    size = seed.size
    work, tube, walk, J = scratch.pose, scratch.tube, scratch.walk, scratch.J
    jerk, by_t, taylor, place = scratch.jerk, scratch.by_t, scratch.taylor, scratch.place
    single = Chain(
        chain.rotation,
        chain.translation,
        chain.axis,
        chain.prismatic,
        scratch.joints,
        chain.sign,
        chain.end_rotation,
        chain.end_translation,
    )
    place[:] = -1
    for j in range(6):
        place[solved[j]] = j
    # From q = centre at ``origin`` on the tube is proven up to ``sure``; curves stay the same up to
    # ``border``.
    centre, slope, reach = scratch.centre, scratch.slope, np.inf
    slope[:] = 0.0
    origin = sure = border = samples.sigma[max(given, 0)]
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
            sure, border = goal, _border(samples, k)
            continue
        whole = goal - at
        _copy_row(states, k - 1, walk, 0)
        pivots = np.inf
        least, hop_at = _FINEST * abs(whole), _HOP * abs(whole)
        while at != goal:
            aim = goal
            if (sure - goal) * whole < 0.0:
                # A tube from where the walk stands, as far as it can be proven.
                _copy(walk.q[0], centre)
                _copy(walk.dq[0], slope)
                origin = at
                side = _stand(chain, single, place, centre, J, tube)
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
                    proven = _keeps_branch(
                        chain, solved, prescribed, place, J, walk, step, jerk, by_t, tube
                    )
                    if not proven:
                        step, at_once = _SHORTER * step, False
                if not proven or (abs(step) < hop_at and min(pivots, conditioning[k - 1]) < _NEAR):
                    hop_at = 0.25 * abs(step)
                    hop = _hop(
                        chain,
                        single,
                        solved,
                        prescribed,
                        place,
                        curves,
                        samples,
                        k,
                        at,
                        side,
                        4 * step,
                        abs(goal - at) if side == 0 else min(256 * abs(step), abs(goal - at)),
                        walk,
                        J,
                        jerk,
                        taylor,
                        by_t,
                        work,
                        tube,
                    )
                    if hop != 0.0:
                        at = goal if hop == goal - at else at + hop
                        pivots, hop_at = 0.0, _HOP * abs(whole)
                    elif not proven:
                        conditioning[k] = min(pivots, conditioning[k - 1])
                        _copy(centre, states.q[k])
                        _copy(centre, walk.q[1])
                        state_at(chain, solved, prescribed, curves, samples, k, goal, walk, 1, work)
                        return k, -1.0, at
                    sure = at
                    continue
                sure = border if step == left else at + step
                if step != left:
                    reach = (_LONGER if at_once else 1.0) * abs(step)
                if (sure - goal) * whole < 0.0:
                    aim = sure
            for j in range(size):
                rate = walk.dq[0, j] + 0.5 * (aim - at) * walk.ddq[0, j]
                walk.q[1, j] = walk.q[0, j] + (aim - at) * rate
            error, met = state_at(chain, solved, prescribed, curves, samples, k, aim, walk, 1, work)
            sound = error < CONVERGED and met >= SINGULAR
            for j in range(size):
                away = abs(walk.q[1, j] - centre[j] - (aim - origin) * slope[j])
                sound = sound and away <= tube.radius[j] + LEAST
            if sound:
                pivots, at = min(pivots, met), aim
                _copy_row(walk, 1, walk, 0)
            else:
                # Newton's method went off: begin again, with a shorter way.
                sure, reach = at, max(0.5 * abs(aim - at), 0.5 * least)
        conditioning[k] = pivots
        _copy_row(walk, 0, states, k)
    return -1, 0.0, samples.sigma[-1]
