"""Whether a run is as it was designed: limits, singularities, zones in full, speeds reached."""

from __future__ import annotations

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import FlybyError
from ...core.motion.emulator.controller import Controller
from ...core.motion.emulator.move_figures import zone_reaches
from ...core.motion.emulator.run import Run
from ...core.motion.model.rules import Overlap
from ...core.program.move import MoveJ
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import JointTarget
from ...core.program.tool import WORLD
from ...core.program.zone import Radius
from ...core.robot.kinematics.chain_kernels import jacobians, poses
from ...core.robot.work_chain import work_chain
from .plan import CandidateRun
from .postures import REGULAR, reach_of, regularity

REACHED = 0.98
"""Of the programmed speed that is reached on every leg outside its zones."""
WHOLE = 0.999
"""Of a zone's radius that it reaches."""
_EVERY = 4e-3
"""s between the samples that are looked at."""


class Refused(FlybyError):
    """A run that is not as it was designed.

    Args:
        message: what is amiss.
        longer_legs_help: whether it may be as designed with longer legs.
    """

    def __init__(self, message: str, longer_legs_help: bool = False) -> None:
        super().__init__(message)
        self.longer_legs_help = longer_legs_help


def check(
    controller: Controller, candidate: CandidateRun, margin: float, program: Program | None = None
) -> Run:
    """Emulate a run and look at it.

    Args:
        controller: that drives.
        candidate: what was designed.
        margin: rad or m that joints keep from their limits.
        program: to be driven; None for the candidate's own.

    Returns:
        Its emulation.

    Raises:
        Refused: it is not as designed.
        MotionError: it cannot be driven.
    """
    program = candidate.program if program is None else program
    run = controller.run(program, JointTarget(tuple(map(float, candidate.start))), _EVERY)
    _check_limits(controller, run, margin)
    _check_regular(controller, candidate, run)
    if run.path.route.left_out:
        raise Refused("a waypoint would be left out", longer_legs_help=True)
    if candidate.kind.reaches_speed:
        _check_zones(run)
        _check_speeds(controller, run)
    return run


def _check_limits(controller: Controller, run: Run, margin: float) -> None:
    limits = controller.robot.limits
    room = np.minimum(run.path.q - limits.lower, limits.upper - run.path.q).min(axis=0)
    joint = int(np.argmin(room))
    # Half a thousandth of a degree: targets are rounded.
    if room[joint] < margin - 1e-5:
        name = controller.robot.axis_names[joint]
        raise Refused(f"joint {name} would come nearer to its limit than the margin")


def _check_regular(controller: Controller, candidate: CandidateRun, run: Run) -> None:
    if candidate.speed is None:
        return
    robot, tool = controller.robot, run.program.moves[0].tool
    rows = run.path.q[:: max(1, len(run.path.q) // 200)]
    if regularity(robot, tool, reach_of(robot, tool), rows).min() < 0.5 * REGULAR:
        raise Refused("the path would come too near to a singular posture")


def _check_zones(run: Run) -> None:
    """Every zone that has a radius reaches as far as it is programmed."""
    if run.path.model.overlap is Overlap.SKIP:
        return  # Zones are whole, or smaller because of the speed that they are entered with.
    for reach, move in zip(zone_reaches(run.path), run.path.route.moves, strict=True):
        zone = run.program.moves[move].zone
        if isinstance(zone, Radius) and min(reach) < WHOLE * zone.tcp:
            raise Refused(
                f"the zone of {1e3 * zone.tcp:.5g} mm would reach {1e3 * min(reach):.4g} mm only",
                longer_legs_help=True,
            )


def _check_speeds(controller: Controller, run: Run) -> None:
    """The programmed speed is reached on every leg, outside the zones at its ends."""
    trajectory, program = run.trajectory, run.program
    chain = work_chain(controller.robot, program.moves[0].tool, WORLD)
    q, dq = np.ascontiguousarray(trajectory.q), trajectory.dq
    _, tcp = poses(chain, q)
    rate = np.linalg.norm(np.einsum("tij,tj->ti", jacobians(chain, q)[:, :3], dq), axis=1)
    segment = np.searchsorted(run.path.layout.waypoint, trajectory.sigma, "right") - 1
    ends = np.concatenate([run.path.route.ends.q[:1, 0], run.path.route.ends.q[:, 1]])
    _, points = poses(chain, np.ascontiguousarray(ends))
    radius = [0.0, *(_radius(program, move) for move in run.path.route.moves)]
    for k, move in enumerate(run.path.route.moves):
        on = segment == k
        for end in (k, k + 1):
            on &= np.linalg.norm(tcp - points[end], axis=1) >= radius[end]
        joint = isinstance(program.moves[move], MoveJ)
        share = _share(program.moves[move].speed, joint, rate, dq, controller.robot.limits.velocity)
        top = float(share[on].max(initial=0.0))
        if top < REACHED:
            raise Refused(
                f"the programmed speed would not be reached: {100 * top:.0f} % of it on a leg of "
                f"{1e3 * np.linalg.norm(points[k + 1] - points[k]):.0f} mm",
                longer_legs_help=True,
            )


def _radius(program: Program, move: int) -> float:
    zone = program.moves[move].zone
    return zone.tcp if isinstance(zone, Radius) else 0.0


def _share(
    speed: Speed, joint: bool, rate: FloatArray, dq: FloatArray, velocity: FloatArray
) -> FloatArray:
    """(T,), what is driven as a share of what is programmed."""
    if not joint or speed.tcp is not None:
        assert speed.tcp is not None
        return np.asarray(rate / speed.tcp)
    if speed.joint is not None:
        return np.asarray(np.abs(dq).max(axis=1) / speed.joint)
    return np.asarray((np.abs(dq) / velocity).max(axis=1) / speed.joint_fraction)
