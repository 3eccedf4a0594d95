"""How far a log deviates from what was emulated for it: in space, and in time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.arrays import FloatArray
from ..core.motion.command.trajectory import Trajectory
from ..core.program.tool import FLANGE, Tool
from ..core.robot.joint import JointKind
from ..core.robot.model import Robot
from .alignment import Alignment
from .logs.cleaning import CleanLog
from .tcp_path import distance_to_polyline, tcp_positions


@dataclass(frozen=True, eq=False)
class Residuals:
    """K samples of a log beside the emulated motion.

    Args:
        t: (K,) s, of the log.
        arc: (K,) m along the emulated path of the TCP, of the place nearest to each sample.
        tcp: (K, 3) m, the log's TCP in the world: where it would be with the motors that are
            logged, if gears were stiff.
        line: (T, 3) m, likewise of the emulated motors, at the samples of the emulation.
        path: (K,) m, its distance from the emulated path of the TCP.
        joint_path: (K, N) rad (m), from the emulated path of joints, time aside.
        joint_time: (K, N) rad (m), from where the emulated motion is at that time, after one
            constant offset.
        joint_clock: (K, N) rad (m), the same after offset and drift: as if the log's clock had run
            as the emulation does.
    """

    t: FloatArray
    arc: FloatArray
    tcp: FloatArray
    line: FloatArray
    path: FloatArray
    joint_path: FloatArray
    joint_time: FloatArray
    joint_clock: FloatArray


def residuals(
    robot: Robot, tool: Tool, trajectory: Trajectory, log: CleanLog, alignment: Alignment
) -> Residuals:
    """The residuals of a log's valid samples between start and end of the motion.

    Controllers log the motors, so it is the emulated motors that logs are held against.

    Args:
        robot: that moved.
        tool: whose TCP is looked at; of a tool that stands still, the flange is.
        trajectory: the emulated motion; its TCP is taken as straight between samples.
        log: the log.
        alignment: of both.
    """
    held = tool if tool.robot_held else FLANGE
    line = tcp_positions(robot, held, trajectory.q_motor)
    q, t = log.q[alignment.rows], log.t[alignment.rows]
    tcp = tcp_positions(robot, held, q)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    expected = joints_at(trajectory, t - alignment.offset)
    drifted = joints_at(trajectory, (t - alignment.origin) / (1.0 + alignment.drift))
    return Residuals(
        t,
        np.interp(alignment.time, trajectory.t, length),
        tcp,
        line,
        distance_to_polyline(tcp, line),
        alignment.off,
        q - expected,
        q - drifted,
    )


def joints_at(trajectory: Trajectory, time: FloatArray) -> FloatArray:
    """Motors (K, N) of a motion at times; they rest before and after."""
    columns = [np.interp(time, trajectory.t, column) for column in trajectory.q_motor.T]
    return np.stack(columns, axis=-1)


@dataclass(frozen=True)
class Figures:
    """The residuals of one run in numbers.

    Args:
        path_max, path_p99, path_rms: m, of the TCP from the emulated path.
        joint_path_max, joint_path_p99, joint_path_rms: rad, greatest over the axes that turn, time
            aside.
        joint_time_max, joint_time_p99, joint_time_rms: the same after one constant offset in time.
        joint_clock_max, joint_clock_p99, joint_clock_rms: the same after offset and drift.
        offset: s, the log's time less the emulated.
        drift: s, that the log falls behind the emulation from start to end beside the offset.
        cycle_time_ratio: emulated over logged time in motion.
    """

    path_max: float
    path_p99: float
    path_rms: float
    joint_path_max: float
    joint_path_p99: float
    joint_path_rms: float
    joint_time_max: float
    joint_time_p99: float
    joint_time_rms: float
    joint_clock_max: float
    joint_clock_p99: float
    joint_clock_rms: float
    offset: float
    drift: float
    cycle_time_ratio: float


def figures(robot: Robot, found: Residuals, alignment: Alignment) -> Figures:
    """Numbers of a run."""
    joints = [*robot.joints, *(axis.joint for axis in robot.external_axes)]
    turns = [joint.kind is not JointKind.PRISMATIC for joint in joints]
    place = np.abs(found.joint_path[:, turns]).max(axis=1, initial=0.0)
    moment = np.abs(found.joint_time[:, turns]).max(axis=1, initial=0.0)
    clock = np.abs(found.joint_clock[:, turns]).max(axis=1, initial=0.0)
    return Figures(
        path_max=float(found.path.max()),
        path_p99=float(np.percentile(found.path, 99)),
        path_rms=_rms(found.path),
        joint_path_max=float(place.max()),
        joint_path_p99=float(np.percentile(place, 99)),
        joint_path_rms=_rms(place),
        joint_time_max=float(moment.max()),
        joint_time_p99=float(np.percentile(moment, 99)),
        joint_time_rms=_rms(moment),
        joint_clock_max=float(clock.max()),
        joint_clock_p99=float(np.percentile(clock, 99)),
        joint_clock_rms=_rms(clock),
        offset=alignment.offset,
        drift=alignment.drift * alignment.moving,
        cycle_time_ratio=alignment.cycle_time_ratio,
    )


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))
