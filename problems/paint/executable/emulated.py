"""What the gun does when the emulated controller drives the program: zones and timing included."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from ....core.arrays import FloatArray, IntArray
from ....core.errors import Note
from ....core.motion.emulator.controller import Controller
from ....core.motion.emulator.run import Run
from ....core.program.program import Program
from ....core.spatial.rotation import matrix_from_quaternion
from ..spray.trajectory import PaintTrajectory
from .station import Station

PERIOD = 0.02
"""s between samples of the driven motion: 5 mm at usual speeds, against footprints of 0.2 m."""


@dataclass(frozen=True, eq=False)
class EmulatedPainting:
    """A painting trajectory as it is driven.

    Args:
        trajectory: the TCP's motion, finely sampled, in the part's frame.
        share: (T, S) s that each fine segment spends on each programmed one; sparse.
        passed: (S + 1,) s at which the programmed waypoints are passed.
        run: of the emulator.
    """

    trajectory: PaintTrajectory
    share: sparse.csr_array
    passed: FloatArray
    run: Run

    @property
    def segment(self) -> IntArray:
        """(T,) index of the programmed segment that each fine one belongs to, mostly."""
        middle = self.trajectory.times[:-1] + 0.5 * self.trajectory.duration
        offset = float(self.run.trajectory.t[-1]) - self.trajectory.total_duration
        found = np.searchsorted(self.passed, middle + offset, side="right") - 1
        return np.clip(found, 0, len(self.passed) - 2)

    @property
    def notes(self) -> tuple[Note, ...]:
        """What the emulator has to say."""
        return self.run.notes


def drive(
    controller: Controller, program: Program, planned: PaintTrajectory, station: Station
) -> EmulatedPainting:
    """Drive a program as the controller would, and see what the gun does.

    Paint flows from waypoint to waypoint as planned: the delay of the gun is compensated.

    Args:
        controller: emulates it.
        program: made by `paint_program` of ``planned``.
        planned: the trajectory that it drives; its flow counts.
        station: robot, gun and place.

    Raises:
        MotionError: it cannot be driven; the message names the move.
    """
    run = controller.run(program, period=PERIOD)
    passed = _passed(run, planned)
    t = run.trajectory.t
    begin = int(np.searchsorted(t, passed[0], side="right")) - 1
    kept = slice(max(begin, 0), len(t))
    t = t[kept]
    place = station.place.matrix()
    rotation = matrix_from_quaternion(run.trajectory.quaternion[kept])
    position = (run.trajectory.position[kept] - place[:3, 3]) @ place[:3, :3]
    nozzle = rotation[:, :, 2] @ place[:3, :3]
    fan = None if planned.fan is None else rotation[:, :, 0] @ place[:3, :3]
    share = _shares(t, passed)
    duration = np.diff(t)
    flow = (share @ planned.flow) / duration
    return EmulatedPainting(
        PaintTrajectory(position, nozzle, duration, flow, fan), share, passed, run
    )


def _passed(run: Run, planned: PaintTrajectory) -> FloatArray:
    """(W,) s at which the waypoints are passed; those that a controller leaves out are passed
    where their place along the programmed path says."""
    trajectory, route = run.trajectory, run.path.route
    waypoint = run.path.layout.waypoint
    # Move k of the program ends at waypoint k: move 0 goes to the first one.
    moved = trajectory.sigma
    rising = np.concatenate(([True], np.diff(moved) > 0.0))
    at = np.interp(waypoint[1:], moved[rising], trajectory.t[rising])
    index = np.array(route.moves)
    along = np.concatenate(([0.0], np.cumsum(planned.lengths)))
    if index[0] != 0:  # the robot stood at the first waypoint already
        index, at = np.concatenate(([0], index)), np.concatenate(([0.0], at))
    return np.interp(along, along[index], at)


def _shares(t: FloatArray, passed: FloatArray) -> sparse.csr_array:
    """(T, S) s that each interval of t shares with each interval of ``passed``."""
    edges = np.unique(np.concatenate((t, np.clip(passed, t[0], t[-1]))))
    middle, width = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
    fine = np.clip(np.searchsorted(t, middle) - 1, 0, len(t) - 2)
    coarse = np.searchsorted(passed, middle) - 1
    inside = (coarse >= 0) & (coarse < len(passed) - 1)
    shape = (len(t) - 1, len(passed) - 1)
    return sparse.csr_array((width[inside], (fine[inside], coarse[inside])), shape=shape)
