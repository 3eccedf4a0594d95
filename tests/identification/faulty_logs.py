"""Logs made of an emulated motion, with the faults that real ones have, each known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose

ROBOT = find_robot("ur/ur10e")
HOME = np.array([0.2, -1.4, -1.8, -1.4, 1.5, 0.3])
PERIOD = 0.008


def program(leg: float = 0.2, radius: float = 0.05) -> Program:
    """Two legs with a corner, and back to the start in joints: a path that ends where it began."""
    at = ROBOT.flange_pose(HOME)

    def there(*offset):
        return PoseTarget(Pose(tuple(np.array(at.position) + offset), at.quaternion))

    speed = Speed(tcp=0.25, tcp_acceleration=1.2)
    moves = (
        MoveL(there(leg, 0, 0), speed, Radius(radius)),
        MoveL(there(leg, leg, 0.1), speed, FINE),
        MoveJ(JointTarget(tuple(HOME)), Speed(joint=0.8, joint_acceleration=2.0), FINE),
    )
    return Program(moves, start=JointTarget(tuple(HOME)))


def emulated(told: Program) -> Run:
    """Its motion, densely sampled."""
    return Controller(find_vendor("ur"), ROBOT, MotionModel()).run(told, period=1e-3)


@dataclass(frozen=True, eq=False)
class Faulty:
    """A log and its faults: times (T,), joints (T, 6), indices of torn samples, the hole."""

    t: np.ndarray
    q: np.ndarray
    torn: np.ndarray
    hole: tuple[float, float]


def joints(run: Run, time: np.ndarray) -> np.ndarray:
    """Joints of a motion at times, at rest before and after."""
    trajectory = run.trajectory
    return np.stack([np.interp(time, trajectory.t, column) for column in trajectory.q_motor.T], -1)


def faulty(
    run: Run, seed: int, noise: float = 1e-5, jitter: float = 1e-3, torn: int = 6, rest: float = 0.3
) -> Faulty:
    """A log every 8 ms with noise, jitter of the moments, torn samples and a hole of 0.14 s."""
    rng = np.random.default_rng(seed)
    duration = run.trajectory.duration
    t = np.arange(-rest, duration + rest, PERIOD)
    t = t + np.clip(rng.normal(0, jitter, len(t)), -3 * jitter, 3 * jitter)
    q = joints(run, t)
    late = joints(run, t - PERIOD)
    begin = rng.uniform(0.3, 0.6) * duration
    kept = (t <= begin) | (t >= begin + 0.14)
    t, q, late = t[kept], q[kept], late[kept]
    # Torn samples apart from each other, from the hole, and where the motion is fast enough.
    step = np.abs(q - late)
    fast = np.flatnonzero((np.sort(step, axis=1)[:, -2] > 1e-3) & (np.abs(t - begin - 0.07) > 0.15))
    chosen: list[int] = []
    for k in rng.permutation(fast):
        if len(chosen) < torn and all(abs(k - other) > 6 for other in chosen):
            chosen.append(int(k))
    for k in chosen:
        old = np.argsort(-step[k])[[0, *rng.choice([2, 3, 4], size=1)]]
        q[k, old] = late[k, old]
    gap = np.flatnonzero(np.diff(t) > 0.1)[0]
    hole = (float(t[gap]), float(t[gap + 1]))
    return Faulty(t, q + noise * rng.normal(size=q.shape), np.sort(chosen), hole)
