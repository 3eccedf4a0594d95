"""Speeds again, so that the coat as emulated is as even as the one that was planned.

The emulated thickness is linear in the times that the robot spends on each segment, and those
follow the programmed ones: a few per cent more speed on the program are as much on the robot,
unless it is at its limits. Each round drives the program, solves for the factors of the durations
by least squares, and drives the new one; the best that was driven is kept.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import lsq_linear

from ....core.arrays import BoolArray, FloatArray
from ....core.motion.emulator.controller import Controller
from ....core.program.program import Program
from ..coating.coat import Coat, coat
from ..coating.deposition import Deposition
from ..spray.trajectory import PaintTrajectory
from .emulated import EmulatedPainting, drive
from .spin import GunPosture
from .station import Station
from .writing import DriveOptions, paint_program

ROUNDS = 4
STEP = 0.2
"""Share by which a duration may change in a round."""
ENOUGH = 0.02
"""Rounds end where the squared error falls by less than this share."""
_CALM = 1e-3
"""Weight of differences between neighbouring factors beside relative errors of the thickness."""

Progress = Callable[[int, Coat], bool]
"""Called with the round and the coat as emulated; True ends it."""


@dataclass(frozen=True, eq=False)
class Execution:
    """A program, and what it does.

    Args:
        program: drives it.
        planned: the trajectory as programmed, in the part's frame.
        driven: as emulated.
        coat: as emulated.
        rounds: standard deviation (m) of the coat as emulated in each round, by area.
    """

    program: Program
    planned: PaintTrajectory
    driven: EmulatedPainting
    coat: Coat
    rounds: tuple[float, ...]


def drive_evenly(
    controller: Controller,
    planned: PaintTrajectory,
    posture: GunPosture,
    station: Station,
    options: DriveOptions,
    deposition: Deposition,
    target: float,
    speed: tuple[float, float],
    visible: BoolArray | None = None,
    progress: Progress | None = None,
) -> Execution:
    """The program of a trajectory, its speeds corrected by what the emulator makes of it.

    Args:
        controller: emulates it.
        planned: what to drive, run-in included.
        posture: how the robot holds the gun at its waypoints.
        station, options: see their classes.
        deposition: the surface under the gun.
        target: wanted thickness, m.
        speed: least and largest programmed speed, m/s.
        visible: (V, S) which points each programmed segment sees; None for all.
        progress: see `Progress`; Ctrl-C ends the rounds too.

    Raises:
        MotionError: the robot cannot drive it.
    """
    deposition = Deposition(deposition.samples, deposition.footprint, subpoints=1)
    best: Execution | None = None
    rounds: list[float] = []
    now = planned
    for number in range(ROUNDS + 1):
        try:
            made = _driven(controller, now, posture, station, options, deposition, target, visible)
        except KeyboardInterrupt:
            if best is None:
                raise
            break
        rounds.append(made.coat.by_area.std)
        gained = 1.0 if best is None else 1.0 - made.coat.squared_error / best.coat.squared_error
        best = made if gained > 0.0 or best is None else best
        stopped = progress is not None and progress(number, made.coat)
        if stopped or gained < ENOUGH:
            break
        factors = _factors(deposition, made, target, speed, visible)
        now = now.with_durations(now.duration * factors)
    assert best is not None
    return replace(best, rounds=tuple(rounds))


def _driven(
    controller: Controller,
    planned: PaintTrajectory,
    posture: GunPosture,
    station: Station,
    options: DriveOptions,
    deposition: Deposition,
    target: float,
    visible: BoolArray | None,
) -> Execution:
    """One round: the program of a trajectory, driven and judged."""
    program = paint_program(planned, posture, station, options)
    driven = drive(controller, program, planned, station)
    return Execution(
        program, planned, driven, judged(deposition, driven, target, visible), rounds=()
    )


def judged(
    deposition: Deposition,
    driven: EmulatedPainting,
    target: float,
    visible: BoolArray | None = None,
) -> Coat:
    """The coat that a driven trajectory leaves.

    Args:
        deposition: the surface under the gun, with one sub-point a segment: they are short.
        visible: (V, S) which points each programmed segment sees; None for all.
    """
    return coat(_under(deposition, driven, visible), driven.trajectory, target)


def _factors(
    deposition: Deposition,
    made: Execution,
    target: float,
    speed: tuple[float, float],
    visible: BoolArray | None,
) -> FloatArray:
    """By what (S,) to multiply the durations of the programmed segments."""
    by_segment = _by_segment(deposition, made.driven, visible)
    weights = np.sqrt(deposition.samples.areas / deposition.samples.area) / target
    planned = made.planned
    count = planned.segments
    calm = _CALM * np.diff(np.eye(count), axis=0)
    A = np.concatenate((weights[:, None] * by_segment, calm, _CALM * np.eye(count)))
    off = weights * (target - made.coat.thickness)
    normal, pull = A.T @ A, A[: len(off)].T @ off
    low = np.maximum(-STEP, planned.lengths / speed[1] / planned.duration - 1.0)
    high = np.minimum(STEP, planned.lengths / speed[0] / planned.duration - 1.0)
    low, high = np.minimum(low, -1e-9), np.maximum(high, 1e-9)
    root = np.linalg.cholesky(normal)
    return 1.0 + lsq_linear(root.T, np.linalg.solve(root, pull), (low, high)).x


def _by_segment(
    deposition: Deposition, driven: EmulatedPainting, visible: BoolArray | None
) -> FloatArray:
    """(V, S) m of paint that each programmed segment lays, as it is driven."""
    laid = np.zeros((deposition.samples.size, driven.share.shape[1]))
    for rows in _under(deposition, driven, visible).rate_rows(driven.trajectory):
        laid[rows.points] = rows.values @ driven.share[rows.segments]
    return laid


def _under(
    deposition: Deposition, driven: EmulatedPainting, visible: BoolArray | None
) -> Deposition:
    """The surface under a finely sampled gun."""
    if visible is None:
        return deposition
    return deposition.with_visible(visible[:, driven.segment])
