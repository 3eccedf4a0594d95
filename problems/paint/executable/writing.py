"""A painting trajectory as a program: lines with zones, a speed each, outputs on the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ....core.errors import InputError
from ....core.program.event import Event, EventAnchor
from ....core.program.move import MoveJ, MoveL, Statement
from ....core.program.program import Program
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.zone import FINE
from ....core.source.write.approach import approach_speed
from ....core.spatial.pose import Pose
from ..spray.signals import GunSignals, gun_events
from ..spray.trajectory import PaintTrajectory
from .spin import GunPosture
from .station import Station

APPROACH = 0.5
"""m/s or share of the joints' speeds on the way to where the curve begins."""


@dataclass(frozen=True, slots=True)
class DriveOptions:
    """How a trajectory is driven.

    Args:
        zone: radius at the waypoints between its ends, m; 0 to stop at each.
        run_in: m that the robot drives along the first and the last segment's direction before and
            after them with the gun off, to be up to speed; 0 to start and end where paint does.
        signals: outputs of the gun; None where the program leaves it alone.
        name: of the program.
    """

    zone: float = 0.02
    run_in: float = 0.05
    signals: GunSignals | None = None
    name: str = "paint"

    def __post_init__(self) -> None:
        for name in ("zone", "run_in"):
            if not 0.0 <= getattr(self, name) < 10.0:
                raise InputError(f"{name}: zero or more metres are needed")


def with_run_in(trajectory: PaintTrajectory, length: float) -> PaintTrajectory:
    """The trajectory with a segment before and one after it, straight on, with the gun off.

    Args:
        length: of each, m; 0 for none.
    """
    if length == 0.0:
        return trajectory
    step = np.diff(trajectory.position, axis=0) / trajectory.lengths[:, None]
    speeds = trajectory.speeds
    first, last = trajectory.position[0], trajectory.position[-1]
    fan = trajectory.fan
    return PaintTrajectory(
        np.concatenate(
            ([first - length * step[0]], trajectory.position, [last + length * step[-1]])
        ),
        trajectory.nozzle[[0, *range(len(trajectory.nozzle)), -1]],
        np.concatenate(([length / speeds[0]], trajectory.duration, [length / speeds[-1]])),
        np.concatenate(([0.0], trajectory.flow, [0.0])),
        None if fan is None else fan[[0, *range(len(fan)), -1]],
    )


def paint_program(
    trajectory: PaintTrajectory, posture: GunPosture, station: Station, options: DriveOptions
) -> Program:
    """The program that drives a trajectory, one line a segment.

    Args:
        trajectory: in the part's frame.
        posture: how the robot holds the gun at its waypoints.
        station: robot, gun and place.
        options: zones, outputs.

    Raises:
        InputError: the vendor's language cannot say what the gun needs.
    """
    robot = station.cell.robot
    events = _events(trajectory, station, options)
    start = JointTarget(tuple(map(float, posture.joints[0])))
    statements: list[Statement] = [
        MoveJ(
            start,
            approach_speed(station.vendor.speaks, robot, APPROACH),
            FINE,
            station.gun,
            station.target_frame,
        )
    ]
    zone = station.zone(options.zone) if options.zone > 0.0 else FINE
    targets = _targets(trajectory, posture, station)
    count = trajectory.segments
    for k, speed in enumerate(trajectory.speeds):
        label = station.vendor.label(robot, posture.joints[k + 1])
        statements.append(
            MoveL(
                PoseTarget(targets[k + 1], label),
                station.speed(float(speed)),
                FINE if k == count - 1 else zone,
                station.gun,
                station.target_frame,
                events=events[k],
            )
        )
    return Program(tuple(statements), options.name, start)


def _events(
    trajectory: PaintTrajectory, station: Station, options: DriveOptions
) -> list[tuple[Event, ...]]:
    """The events of each line: at its target, of the first one also at its start."""
    if options.signals is None:
        return [()] * trajectory.segments
    at = gun_events(trajectory, options.signals, station.vendor)
    at_start = tuple(replace(event, anchor=EventAnchor.START, time=0.0) for event in at[0])
    return [at_start + at[1], *at[2:]] if trajectory.segments > 1 else [at_start + at[1]]


def _targets(trajectory: PaintTrajectory, posture: GunPosture, station: Station) -> Sequence[Pose]:
    """Poses (W,) of the TCP in the frame of the targets."""
    to_part = np.linalg.inv(station.place.matrix())[:3, :3]
    poses = []
    for position, rotation in zip(trajectory.position, posture.rotation, strict=True):
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = to_part @ rotation, position
        poses.append(station.to_targets @ Pose.from_matrix(matrix))
    return poses
