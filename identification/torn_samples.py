"""Logs whose samples mix joints of two cycles, put together by the emulated motion.

What reads joints one after the other while the controller goes on gets the first few of one cycle
and the rest of the next. Single samples of this kind deviate from their neighbours
(`logs.cleaning`);
where most are torn, each after another joint, only the path tells: joints from the b-th on are
where the emulated motion is Δ later,

    off = (I − u uᵀ) Δ [0 … 0, q̇_b … q̇_N] + noise,

with off the way from the nearest place of the emulated path to the sample, q̇ its speed there and u
the direction of that. Δ is one number for the log, b each sample's own. As a sample has as many
ways to be explained as it has joints, some of what is left of whole samples goes as well; a log
counts as torn only if more than half goes.

Of other logs few samples may be torn: those that stand out from the samples about them, alone or
two in a row, and by just such a pattern, all with about the same Δ.

Servos that follow at different distances leave the same pattern with one b for all samples, and
that is the emulation's error, not the log's (`elasticity.lag_s`). So a log is whole, too, if lags
that are the same in all samples, one for each joint, explain it about as well.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter

from ..core.arrays import FloatArray, IntArray
from ..core.motion.command.trajectory import Trajectory
from .alignment import Alignment
from .logs.cleaning import CleanLog

EXPLAINED = 0.5
"""Share of the distances from the path that may be left, on average, in a log that counts as torn.
In 39 logs of ABB's and Universal Robots' controllers 0.69 to 1 is left, in three of KUKA's, their
zones fitted, 0.24 to 0.36."""
BEYOND_LAGS = 0.85
"""Share of what lags of the joints leave that may be left, likewise. In those three logs 0.49 to
0.74 is left, of lags in made ones 0.9 and more."""
SHORTEST, LONGEST = 1e-3, 0.02
"""s that two cycles are apart at least, and at most."""
_STEPS = 40
"""Trials of Δ on either side of zero."""
_FINER = 20
_LOOKED_AT = 500
"""Samples that Δ is sought by, at most."""
_ROUNDS = 10
"""Of weighing samples anew, until a mean of distances is least."""
ABOUT = 7
"""Samples in a row whose median says where those about one are; up to three of them may be off."""
SHORTEST_ALONE = 1.5e-3
"""s that two cycles are apart at least for single samples to tell it."""
STANDS_OUT = 10.0
"""How many times what samples are usually off the others about them a torn one is at least."""
FLOOR = 3e-5
"""rad (m), and no less than this: noise at rest."""
LEFT_ALONE = 0.25
"""Share of that which a tear may leave. Of twelve logs of a real IRB 6640 it leaves 0.01 to 0.12 in
nine samples, 4 ms apart, which is a cycle of that controller; of all else that stands out 0.38 and
more."""
ALIKE = 0.3
"""Share of their usual Δ by which those of single samples may differ."""
_NEAR = 1e-3
"""Share of the mean distance below which all samples weigh the same."""
_STILL = 1e-9


@dataclass(frozen=True, eq=False)
class TornSamples:
    """How the samples of a log are torn.

    Args:
        delay: s by which the joints behind the break are read later than those before.
        breaks: (K,), the first joint that is read later, of each sample that the alignment has: 0
            where all are, the number of joints where none is.
        joints: their number.
        left: share of the distances from the path that is left.
    """

    delay: float
    breaks: IntArray
    joints: int
    left: float

    @property
    def count(self) -> int:
        """Samples that are torn."""
        return int(np.count_nonzero((self.breaks > 0) & (self.breaks < self.joints)))


def find_torn(trajectory: Trajectory, alignment: Alignment) -> TornSamples | None:
    """How a log is torn; None if its samples are whole.

    Args:
        trajectory: the emulated motion.
        alignment: of the log with it.
    """
    speed = _speeds(trajectory, alignment)
    direction = speed / np.maximum(np.linalg.norm(speed, axis=1), _STILL)[:, None]
    off = _across(alignment.off, direction)
    # (K, N, N): by the break, what a second between the readings would do.
    late = speed[:, None, :] * np.triu(np.ones((speed.shape[1],) * 2))
    late = _across(late, direction[:, None, :])
    some = np.unique(np.linspace(0, len(off) - 1, _LOOKED_AT).astype(np.int64))
    before = float(np.linalg.norm(off[some], axis=1).mean())
    if before == 0.0:
        return None
    trials = LONGEST * np.linspace(-1.0, 1.0, 2 * _STEPS + 1)
    for _ in range(2):
        left = [_left(off[some], late[some], delay).min(axis=1).mean() for delay in trials]
        best = float(trials[int(np.argmin(left))])
        trials = best + LONGEST / _STEPS * np.linspace(-1.0, 1.0, 2 * _FINER + 1)
    least = float(min(left))
    share = least / before
    if share > EXPLAINED or abs(best) < SHORTEST:
        return _few(off, late)
    if least > BEYOND_LAGS * _left_by_lags(off[some], speed[some], direction[some]):
        return _few(off, late)
    breaks = np.argmin(_left(off, late, best), axis=1).astype(np.int64)
    return TornSamples(best, breaks, off.shape[1], share)


def _few(off: FloatArray, late: FloatArray) -> TornSamples | None:
    """Samples that stand out as torn ones do, of distances (K, N) and ways by the break (K, N, N);
    None if there are none."""
    aside = off - median_filter(off, (ABOUT, 1), mode="nearest")
    size = np.linalg.norm(aside, axis=1)
    out = np.flatnonzero(size > max(STANDS_OUT * float(np.median(size)), FLOOR))
    square = np.maximum(np.sum(late[out] ** 2, axis=2), _STILL**2)
    delays = np.einsum("kn,kbn->kb", aside[out], late[out]) / square
    left = np.linalg.norm(aside[out, None] - delays[:, :, None] * late[out], axis=2)
    left /= size[out, None]
    left[(np.abs(delays) < SHORTEST_ALONE) | (np.abs(delays) > LONGEST)] = np.inf
    # Before the first joint there is no break.
    left[:, 0] = np.inf
    breaks = np.argmin(left, axis=1)
    rows = np.arange(len(out))
    torn = left[rows, breaks] < LEFT_ALONE
    if not torn.any():
        return None
    found = delays[rows, breaks]
    delay = float(np.median(found[torn]))
    torn &= np.abs(found - delay) < ALIKE * abs(delay)
    if not torn.any():
        return None
    rest, size = off.copy(), off.shape[1]
    rest[out[torn]] -= delay * late[out, breaks][torn]
    of_all = np.full(len(off), size, dtype=np.int64)
    of_all[out[torn]] = breaks[torn]
    left_of_all = float(np.linalg.norm(rest, axis=1).mean() / np.linalg.norm(off, axis=1).mean())
    return TornSamples(delay, of_all, size, left_of_all)


def mended(
    log: CleanLog, trajectory: Trajectory, alignment: Alignment, found: TornSamples
) -> CleanLog:
    """The log with all joints of a sample as they were when its first one was read.

    Args:
        log: torn.
        trajectory: the emulated motion, whose speeds say how far joints went meanwhile.
        alignment: of both.
        found: how it is torn.
    """
    q = log.q.copy()
    behind = np.arange(q.shape[1]) >= found.breaks[:, None]
    q[alignment.rows] -= found.delay * behind * _speeds(trajectory, alignment)
    said = (
        f"{found.count} of {len(found.breaks)} samples mix joints of two cycles, "
        f"{1e3 * abs(found.delay):.1f} ms apart: put together by the emulated speeds"
    )
    return replace(log, q=q, notes=(*log.notes, said))


def _left(off: FloatArray, late: FloatArray, delay: float) -> FloatArray:
    """(K, N), how far samples are from the path if torn before each joint."""
    return np.asarray(np.linalg.norm(off[:, None, :] - delay * late, axis=2))


def _left_by_lags(off: FloatArray, speed: FloatArray, direction: FloatArray) -> float:
    """Mean distance from the path (K, N) that is left if each joint lags by a time of its own, the
    same in all samples, such that it is least."""
    each = _across(speed[:, None, :] * np.eye(speed.shape[1]), direction[:, None, :])
    left = np.linalg.norm(off, axis=1)
    for _ in range(_ROUNDS):
        weight = 1.0 / np.maximum(left, max(_NEAR * float(left.mean()), _STILL))
        matrix = np.einsum("k,kij,klj->il", weight, each, each)
        lags = np.linalg.lstsq(matrix, np.einsum("k,kij,kj->i", weight, each, off), rcond=1e-9)[0]
        left = np.linalg.norm(off - lags @ each, axis=1)
    return float(left.mean())


def _across(vectors: FloatArray, direction: FloatArray) -> FloatArray:
    """Vectors without what lies along unit ones."""
    return np.asarray(vectors - np.sum(vectors * direction, -1, keepdims=True) * direction)


def _speeds(trajectory: Trajectory, alignment: Alignment) -> FloatArray:
    """(K, N), emulated speeds of the joints at the places of the samples."""
    speeds = trajectory.dq_motor.T
    return np.stack([np.interp(alignment.time, trajectory.t, dq) for dq in speeds], -1)
