"""Compiled walk along a path of the TCP, on one branch of inverse kinematics from end to end.

As far as can be, `branch_proof` proves of a stretch of the path that the joints, followed from its
middle, cannot leave a tube (`walk_steps`); where the walk stands and samples on that stretch
count only if they are found in it. Stretches that cannot be proven are shortened. So no other
branch is taken for the same one, and where that cannot be decided, at a singular configuration or
next to it, the walk ends.
"""

from __future__ import annotations

from threading import get_ident

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import pose
from ...robot.kinematics.lean import inner, lean
from ...robot.kinematics.tracking import pose_error, track
from ..geometry.curves import Samples, TcpCurves
from .branch_proof import LEAST
from .singular_samples import FIRST, settle
from .tcp_samples import (
    CONVERGED,
    SINGULAR,
    Scratch,
    States,
    set_places,
    state_at,
)
from .walk_steps import (
    CAME,
    HERE,
    NEXT,
    WalkWork,
    copy_row,
    expect,
    first_reach,
    hop_over,
    prove,
    stand,
    walk_work,
)

JOINED = 1e-5
"""rad or m by which configurations of one place may differ: what Newton's method leaves of a pose
given with rounding, near a singularity too."""
_LONGER, _SHORTER = 2.0, 0.6
"""Factors by which a stretch is at most longer than the last, and tried again if not proven."""
_STRAIN = 0.3
"""Of tubes, that stretches are made as long for; it grows with about the square of their length."""
_HOP, _NEAR = 0.2, 0.05
"""Share of the way between two samples, and conditioning, below which a stretch to prove may lie
next to a singular configuration."""
_FINEST = 1e-7
"""Share of the way between two samples below which steps are not shortened any more."""


@inner
def _copy(source: FloatArray, target: FloatArray) -> None:
    for j in range(source.size):
        target[j] = source[j]


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
    work = walk_work(get_ident(), seeds.shape[1], prescribed.size, chain.joint.size, width)
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
    scratch: WalkWork,
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
    scratch: WalkWork,
) -> tuple[int, float, float]:
    """One run; see `_walk_all`.

    Args:
        given: the sample whose state stands already and from which the walk goes on; -1 at first.
    """
    size = seed.size
    work, tube, walk = scratch.pose, scratch.tube, scratch.walk
    jerk, by_t, taylor = scratch.jerk, scratch.by_t, scratch.taylor
    set_places(solved, work)
    # On these curves the walk stood at ``came`` before, or knows where it will; the conditioning
    # there is ``ahead``.
    # About q = centre at ``origin`` the tube is proven up to ``sure``; curves stay the same up to
    # ``border``.
    centre, slope, reach = scratch.centre, scratch.slope, np.inf
    slope[:] = 0.0
    origin = sure = border = came = samples.sigma[max(given, 0)]
    ahead = np.inf
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
            if reach == np.inf:
                reach = first_reach(states.dq[k])
            continue
        whole = goal - at
        copy_row(states, k - 1, walk, HERE)
        pivots = np.inf
        least, hop_at = _FINEST * abs(whole), _HOP * abs(whole)
        while at != goal:
            aim = goal
            if (sure - goal) * whole < 0.0:
                # Nothing is proven of a singular configuration.
                known = k != given + 1 or at != samples.sigma[given]
                left = border - at
                # Even stretches, without a short one at the end.
                parts = np.ceil(abs(left) / reach)
                step = left if parts <= 1.0 else left / parts
                strain = np.inf
                while known and strain == np.inf and (abs(step) > least or step == left):
                    origin, ahead, strain = prove(
                        chain, solved, prescribed, curves, samples, k, came, at, step, scratch
                    )
                    if strain == np.inf:
                        step *= _SHORTER
                proven = strain < np.inf
                if not proven or (abs(step) < hop_at and min(pivots, conditioning[k - 1]) < _NEAR):
                    side = stand(chain, walk.q[HERE], work, tube) if known else 0
                    if side == 0:
                        step = 0.25 * np.copysign(min(abs(whole), FIRST * abs(left)), whole)
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
                        _copy(walk.q[HERE], walk.q[NEXT])
                        state_at(
                            chain, solved, prescribed, curves, samples, k, goal, walk, NEXT, work
                        )
                        return k, -1.0, at
                    sure = at
                    continue
                _copy(walk.q[NEXT], centre)
                _copy(walk.dq[NEXT], slope)
                copy_row(walk, NEXT, walk, CAME)
                came = origin
                sure = border if step == left else at + step
                longer = abs(step) * min(_LONGER, np.sqrt(_STRAIN / strain))
                reach = longer if step != left else max(reach, longer)
                if (sure - goal) * whole < 0.0:
                    aim = sure
            if aim == came:
                copy_row(walk, CAME, walk, NEXT)
                error, met = 0.0, ahead
            else:
                expect(walk, came, at, aim)
                error, met = state_at(
                    chain, solved, prescribed, curves, samples, k, aim, walk, NEXT, work
                )
            sound = error < CONVERGED and met >= SINGULAR
            for j in range(size):
                away = abs(walk.q[NEXT, j] - centre[j] - (aim - origin) * slope[j])
                sound = sound and away <= tube.radius[j] + LEAST
            if sound:
                # What the tube is about tells more than where the walk comes from.
                if (came - at) * whole <= 0.0 or came == aim:
                    came = at
                    copy_row(walk, HERE, walk, CAME)
                pivots, at = min(pivots, met), aim
                copy_row(walk, NEXT, walk, HERE)
            else:
                # Newton's method went off: begin again, with a shorter way.
                sure, came, reach = at, at, max(0.5 * abs(aim - at), 0.5 * least)
        conditioning[k] = pivots
        copy_row(walk, HERE, states, k)
    return -1, 0.0, samples.sigma[-1]
