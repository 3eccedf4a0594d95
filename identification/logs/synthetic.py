"""Logs that a known motion model would have left, with the faults that real ones have.

What a fit is worth shows where the truth is known.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import InputError
from ...core.motion.emulator.controller import Controller
from ...core.program.program import Program
from .run import LoggedRun

_FINE = 2.5e-4
"""s between the samples of the motion that a log is read from."""
_BETWEEN_TORN = 6
"""Samples that are sound between two torn ones."""


@dataclass(frozen=True)
class Faults:
    """What is wrong with a log.

    Args:
        period: s between samples.
        noise: rad (m), standard deviation of each joint.
        jitter: s, standard deviation of the moments that samples are taken at; stamps are true.
        stamp: s, standard deviation of stamps beside the moments.
        torn: samples that mix the joints of two cycles.
        hole: s without a sample, once; 0 for none.
        offset: s, of the log's clock.
        rest: s before and after the motion.
    """

    period: float = 0.004
    noise: float = 1e-5
    jitter: float = 3e-4
    stamp: float = 0.0
    torn: int = 0
    hole: float = 0.0
    offset: float = 0.0
    rest: float = 0.1

    def __post_init__(self) -> None:
        if not self.period > 0:
            raise InputError(f"a log's period must be above zero, not {self.period}")


SOUND = Faults(noise=0.0, jitter=0.0)


def synthetic_run(
    controller: Controller, program: Program, name: str, faults: Faults, seed: int
) -> LoggedRun:
    """A log of a program, as a controller would have left it.

    Args:
        controller: with the model that is the truth.
        program: what is driven.
        name: of the run.
        faults: of the log.
        seed: of the random numbers.

    Raises:
        MotionError: the program cannot be driven.
    """
    rng = np.random.default_rng(seed)
    trajectory = controller.run(program, period=_FINE).trajectory

    def joints(t: FloatArray) -> FloatArray:
        return np.stack([np.interp(t, trajectory.t, column) for column in trajectory.q_motor.T], -1)

    count = int((trajectory.duration + 2 * faults.rest) / faults.period)
    most = 0.4 * faults.period
    shift = np.clip(rng.normal(0.0, 1.0, count) * faults.jitter, -most, most)
    t: FloatArray = faults.period * np.arange(count) - faults.rest + shift
    if faults.hole > 0:
        begin = rng.uniform(0.2, 0.7) * trajectory.duration
        t = t[(t < begin) | (t > begin + faults.hole)]
    q = _torn(joints(t), joints(t - faults.period), faults.torn, rng)
    q = q + faults.noise * rng.normal(size=q.shape)
    stamps = t + faults.offset + np.clip(rng.normal(0.0, 1.0, len(t)) * faults.stamp, -most, most)
    return LoggedRun(name, controller.robot.name, True, program, stamps, q)


def _torn(q: FloatArray, late: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
    """Joints (T, N) in which some samples have some joints of the cycle before."""
    q = q.copy()
    moving = np.flatnonzero(np.linalg.norm(q - late, axis=1) > 1e-4)
    chosen: list[int] = []
    for k in rng.permutation(moving):
        if len(chosen) < count and all(abs(k - other) > _BETWEEN_TORN for other in chosen):
            chosen.append(int(k))
    for k in chosen:
        old = rng.choice(q.shape[1], size=q.shape[1] // 2, replace=False)
        q[k, old] = late[k, old]
    return q
