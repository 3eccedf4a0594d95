"""What in a log can be trusted: samples on the path, holes, jitter.

A *torn* sample mixes the joints of two cycles. Jitter of the clock, which is no fault of the path,
shifts all joints of a sample together along the motion; so each sample is held against the cubic
through its neighbours, the best common shift in time is taken off, and what is left, against noise
and against how sharply the joints turn nearby, tells a torn or wild sample from a jittered one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import maximum_filter1d, median_filter

from ...core.arrays import BoolArray, FloatArray, IntArray
from ...core.errors import InputError
from ...core.motion.command.trajectory import sample_times
from .run import LoggedRun

HOLE = 3.0
"""Median periods without a sample that make a hole."""
NOISE_FACTOR = 8.0
"""Standard deviations of noise that no sample deviates by."""
TURN_FACTOR = 0.5
"""Share of the second differences nearby that the cubic may be off by: where an acceleration jumps,
it is off by an eighth of them."""
TYPICAL_TURN = 80.0
"""Percentile of second differences over the whole log that is allowed for everywhere: a corner may
begin and end between three samples."""
SLOW = 0.5
"""Share of the fast speeds of a log below which jitter hardly shows, but stops and starts do."""
FLOOR = 2e-5
"""rad (m): no sample is refused for less; the coarsest resolution seen in logs is 2·10⁻⁶ rad."""
_AROUND = 8
_SPAN = 8.0
"""Median periods that four neighbours may span; the cubic knows nothing across a hole."""
BESIDE = 4.0
"""How many times its bound a sample must deviate by beside another that is off the path."""
_SHIFT = 2.0
_ROUNDS = 6
_NORMAL = 1.4826
"""Standard deviation over median absolute deviation of a normal distribution."""


@dataclass(frozen=True)
class Hole:
    """A stretch without samples.

    Args:
        begin, end: s, of the samples before and after it.
    """

    begin: float
    end: float


@dataclass(frozen=True, eq=False)
class CleanLog:
    """A log with what is known of its faults.

    Args:
        t: (T,) s, increasing.
        q: (T, N) rad or m.
        valid: (T,), whether a sample lies on the path that was driven; torn, wild and held ones do
            not.
        period: s, median time between samples.
        jitter: s, standard deviation of that time, robust.
        noise: (N,) rad or m, standard deviation of a joint's samples across the motion, robust.
        torn: indices of samples off the path.
        held: indices of samples that repeat the one before although the robot moves.
        holes: where samples are missing.
        notes: the same in words.
    """

    t: FloatArray
    q: FloatArray
    valid: BoolArray
    period: float
    jitter: float
    noise: FloatArray
    torn: IntArray
    held: IntArray
    holes: tuple[Hole, ...]
    notes: tuple[str, ...]

    def resampled(self, period: float) -> CleanLog:
        """The log every ``period`` s, by cubics through the valid samples (Akima's, modified).

        Samples in holes are not valid. Faults of single samples are gone; noise, which the cubics
        follow, is not.

        Raises:
            InputError: the period is not finite and above zero, or makes too many samples.
        """
        from scipy.interpolate import Akima1DInterpolator

        t = sample_times(self.t[0], self.t[-1], period)
        kept, q = self.t[self.valid], self.q[self.valid]
        curve = Akima1DInterpolator(kept, q, method="makima")
        inside = np.clip(t, kept[0], kept[-1])
        valid = inside == t
        for hole in self.holes:
            valid &= (t <= hole.begin) | (t >= hole.end)
        none = np.zeros(0, dtype=np.int64)
        return replace(
            self, t=t, q=curve(inside), valid=valid, period=period, jitter=0.0, torn=none, held=none
        )


def clean(run: LoggedRun) -> CleanLog:
    """A run's samples with their faults marked.

    Raises:
        InputError: fewer than two samples can be trusted.
    """
    return clean_samples(run.t, run.q, run.notes)


def clean_samples(t: FloatArray, q: FloatArray, notes: tuple[str, ...] = ()) -> CleanLog:
    """See `clean`; t (T,) s must increase, q is (T, N)."""
    if len(t) < 2:
        raise InputError("a log needs at least two samples")
    step = np.diff(t)
    period = float(np.median(step))
    jitter = _NORMAL * float(np.median(np.abs(step - period)))
    held = _held(q)
    valid = np.ones(len(t), dtype=bool)
    valid[held] = False
    noise, torn = _mark_torn(t, q, valid, period)
    if valid.sum() < 2:
        raise InputError("hardly a sample of this log lies on a path with its neighbours")
    gaps = np.flatnonzero(step > HOLE * period)
    holes = tuple(Hole(float(t[k]), float(t[k + 1])) for k in gaps)
    notes = (*notes, *_said(t, held, torn, holes))
    return CleanLog(t, q, valid, period, jitter, noise, torn, held, holes, notes)


def _held(q: FloatArray) -> IntArray:
    """Indices of samples equal to the one before, in the middle of a motion.

    A reader that asks more often than the controller answers, or that missed an answer, repeats
    itself. Moving means: steps before and after, alike in direction and far above the resolution.
    """
    same = np.concatenate([[False], (np.diff(q, axis=0) == 0).all(axis=1)])
    if not same.any():
        return np.zeros(0, dtype=np.int64)
    fresh = np.flatnonzero(~same)
    kept = q[fresh]
    move = np.diff(kept, axis=0)
    length = np.linalg.norm(move, axis=1)
    ahead = np.zeros(len(fresh), dtype=bool)
    # From a fresh sample to the next one and to it from the one before.
    ahead[1:-1] = (
        (np.sum(move[1:] * move[:-1], axis=1) > 0.5 * length[1:] * length[:-1])
        & (length[1:] > 10 * FLOOR)
        & (length[:-1] > 10 * FLOOR)
    )
    owner = np.cumsum(~same) - 1
    return np.flatnonzero(same & ahead[owner])


def _mark_torn(
    t: FloatArray, q: FloatArray, valid: BoolArray, period: float
) -> tuple[FloatArray, IntArray]:
    """Take samples off ``valid`` until the others agree; noise (N,), and the indices."""
    noise: FloatArray | None = None
    torn: list[IntArray] = []
    for _ in range(_ROUNDS):
        rows = np.flatnonzero(valid)
        if len(rows) < 2 * _AROUND:
            break
        # By stamps, and by counting: where samples are taken evenly and stamped as they arrive,
        # the count is the better clock. A sample is off the path only if it is so by both.
        stamps = t[rows] / period
        deviations = [_deviations(clock, q[rows]) for clock in (stamps, rows.astype(float))]
        known = _near(stamps)
        if noise is None:
            noise = np.min([_spread(deviation[known]) for deviation, _ in deviations], axis=0)
        excess = np.min(
            [_excess(deviation, turning, noise) for deviation, turning in deviations], axis=0
        )
        excess[~known] = 0.0
        # Beside samples that are gone already the cubic is coarse: doubt must not creep on.
        excess[2:-2] /= np.where(rows[4:] - rows[:-4] > 4, BESIDE, 1.0)
        # A wild sample spoils the cubics of its neighbours: only the farthest of five goes.
        size = np.min([np.linalg.norm(deviation, axis=1) for deviation, _ in deviations], axis=0)
        size[excess <= 1] = 0.0
        wild = rows[(excess > 1) & (size >= _running_max(size, 2))]
        if len(wild) == 0:
            break
        valid[wild] = False
        torn.append(wild)
    found = np.sort(np.concatenate(torn)) if torn else np.zeros(0, dtype=np.int64)
    return np.zeros(q.shape[1]) if noise is None else noise, found


def _spread(values: FloatArray) -> FloatArray:
    """Standard deviation (N,) of values (T, N) about zero, robust."""
    if len(values) == 0:
        return np.zeros(values.shape[1])
    return np.asarray(_NORMAL * np.median(np.abs(values), axis=0))


def _excess(deviation: FloatArray, turning: FloatArray, noise: FloatArray) -> FloatArray:
    """Greatest share (T,) of its bound by which a joint deviates."""
    bound = NOISE_FACTOR * noise + TURN_FACTOR * turning + FLOOR
    return np.asarray((np.abs(deviation) / bound).max(axis=1))


def _near(clock: FloatArray) -> BoolArray:
    """Which samples (T,) have two neighbours on either side that are near."""
    near = np.zeros(len(clock), dtype=bool)
    near[2:-2] = clock[4:] - clock[:-4] <= _SPAN
    return near


def _deviations(clock: FloatArray, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """How far samples deviate from their neighbours' cubic, and the second differences nearby, both
    (T, N); the clock (T,) runs in periods."""
    deviation = np.zeros_like(q)
    middle = np.arange(2, len(clock) - 2)
    nodes = middle[:, None] + np.array([-2, -1, 1, 2])
    weight, slope = _cubic_weights(clock[nodes] - clock[middle][:, None])
    off = q[middle] - np.einsum("ki,kij->kj", weight, q[nodes])
    speed = np.einsum("ki,kij->kj", slope, q[nodes])
    # A wild sample bends its neighbours' speeds, on either side to the other side; their median is
    # right there, but wrong where a motion begins.
    typical = median_filter(speed, (5, 1), mode="nearest")
    one, two = _shifted(off, speed), _shifted(off, typical)
    nearer = np.linalg.norm(one, axis=1) < np.linalg.norm(two, axis=1)
    deviation[middle] = np.where(nearer[:, None], one, two)
    return deviation, _turning(clock, q)


def _shifted(off: FloatArray, speed: FloatArray) -> FloatArray:
    """What is left of deviations (K, N) after the best shift in time along speeds (K, N)."""
    along = np.sum(off * speed, axis=1) / np.maximum(np.sum(speed * speed, axis=1), 1e-30)
    # A clock is off by a few periods at most; a shift beyond is no jitter.
    return np.asarray(off - np.clip(along, -_SHIFT, _SHIFT)[:, None] * speed)


def _cubic_weights(nodes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Weights (K, 4) that give value and derivative at zero of the cubic through four nodes.

    Lagrange's basis L_i(0) = Π x_j / (x_j − x_i), and its derivative L_i(0) Σ −1 / x_j.
    """
    value, slope = np.ones_like(nodes), np.zeros_like(nodes)
    for i in range(4):
        for j in range(4):
            if i != j:
                value[:, i] *= nodes[:, j] / (nodes[:, j] - nodes[:, i])
                slope[:, i] -= 1.0 / nodes[:, j]
    return value, value * slope


def _turning(clock: FloatArray, q: FloatArray) -> FloatArray:
    """Size (T, N) of second differences among a sample's neighbours, without its own; the same for
    all joints, since a path turns into joints that stood.

    A high quantile: the three that another wild sample spoils do not count. What lies along a fast
    motion is jitter, or a change of speed that a shift in time makes up for.
    """
    rate = np.diff(q, axis=0) / np.diff(clock)[:, None]
    bend, along = np.diff(rate, axis=0), q[2:] - q[:-2]
    square = np.sum(along * along, axis=1)
    share = np.sum(bend * along, axis=1) / np.maximum(square, 1e-30)
    share[square < SLOW**2 * np.percentile(square, 90)] = 0.0
    second = np.zeros_like(q)
    second[1:-1] = np.abs(bend - share[:, None] * along)
    offsets = [k for k in range(-_AROUND, _AROUND + 1) if abs(k) > 1]
    rows = np.clip(np.arange(len(q))[:, None] + np.array(offsets), 0, len(q) - 1)
    around = np.sort(second[rows], axis=1)
    typical = np.percentile(second, TYPICAL_TURN, axis=0)
    return np.repeat(np.maximum(around[:, -4], typical).max(axis=1, keepdims=True), q.shape[1], 1)


def _running_max(values: FloatArray, reach: int) -> FloatArray:
    return np.asarray(maximum_filter1d(values, 2 * reach + 1, mode="nearest"))


def _said(t: FloatArray, held: IntArray, torn: IntArray, holes: tuple[Hole, ...]) -> list[str]:
    said = []
    if len(torn):
        said.append(
            f"{len(torn)} samples off the path of their neighbours, first at {t[torn[0]]:.3f} s"
        )
    if len(held):
        said.append(f"{len(held)} samples repeat the one before, first at {t[held[0]]:.3f} s")
    if holes:
        longest = max(holes, key=lambda hole: hole.end - hole.begin)
        said.append(
            f"{len(holes)} holes, the longest of {longest.end - longest.begin:.3f} s at "
            f"{longest.begin:.3f} s"
        )
    return said
