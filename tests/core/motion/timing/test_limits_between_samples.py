"""Limits of joints and TCP on a finer grid than the one that was stamped."""

from __future__ import annotations

import numpy as np
import pytest

from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.model.blend import TANGENT_ARC, Blend
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius

POINTS = 20
SMOOTH = Blend(alpha=(0, 0, 0, 10, -15, 6))
MODELS = {
    "parabola": MotionModel(),
    "quintic": MotionModel(tcp=SMOOTH, joint=SMOOTH, orientation=SMOOTH),
    "arc": MotionModel(tcp=TANGENT_ARC, tcp_acceleration=2.0),
}
SPEEDS = {
    "slow": Speed(tcp=0.1, reorientation=1.0),
    "programmed": Speed(tcp=0.5, tcp_acceleration=1.5, reorientation=3.0, joint=1.0),
    "flat out": Speed(tcp=7.0, reorientation=20.0),
}


def program(arm, speed, shares) -> Program:
    zones = [Radius(s * arm.leg, 1.5 * s * arm.leg, 1.5 * s * arm.leg, 0.2 * s) for s in shares]
    t = arm.target
    moves = (
        MoveL(t((1, 0, 0)), speed, zones[0]),
        MoveL(t((1, 1, 0), (0, 0.3, 0.1)), speed, zones[1]),
        MoveC(t((0, 1, 0.4), (0.2, 0.1, 0)), speed, zones[2], via=t((0.6, 1.4, 0.1))),
        MoveJ(arm.joints([0.2, 0.1, -0.1, 0.2, 0.1, 0.3]), speed, zones[3]),
        MoveJ(t((0, 0.5, 0.5)), speed, zones[0]),
        MoveL(t((0, 0, 0.8), (0.2, 0, 0)), speed, FINE),
    )
    return Program(moves, start=arm.start)


def excess(arm, run, speed) -> tuple[float, float, float]:
    """Worst share of joint velocity, joint acceleration and TCP speed between the samples."""
    timing, limits = run.timing, arm.robot.limits
    share = (np.arange(POINTS) + 0.5) / POINTS
    t = (timing.begin + np.outer(share, timing.end - timing.begin)).T.ravel()
    _, dq, ddq = timing.states_at(t)
    q = timing.states_at(t)[0]
    owner = np.repeat(timing.interval_segments, POINTS)
    J = arm.robot.jacobian(q)
    speed_tcp = np.linalg.norm(np.einsum("kij,kj->ki", J[:, :3], dq), axis=1)
    joint_moves = np.isin(owner, [3, 4]) if speed.joint else np.zeros(len(t), bool)
    velocity = np.where(joint_moves[:, None], np.minimum(limits.velocity, speed.joint or 9e9), 1.0)
    velocity = np.where(joint_moves[:, None], velocity, limits.velocity)
    return (
        float((np.abs(dq) / velocity).max()),
        float((np.abs(ddq) / limits.acceleration).max()),
        float(speed_tcp.max() / speed.tcp),
    )


SHARES = ([0.05] * 4, [0.25] * 4, [0.3, 0.03, 0.1, 0.2])
HELD = 1.005
# Accelerations are rows at samples alone; what is left falls fourfold with each halving.
LEFT = 1.10
DENSE = {"parabola": 1.005, "arc": 1.005, "quintic": 1.01}


def worst(arm, name, pace, sampling) -> float:
    speed, controller = SPEEDS[pace], arm.controller(MODELS[name])
    controller.sampling = sampling
    runs = [controller.run(program(arm, speed, shares)) for shares in SHARES]
    return max(max(excess(arm, run, speed)) for run in runs)


@pytest.mark.parametrize("name", sorted(MODELS))
@pytest.mark.parametrize("pace", sorted(SPEEDS))
def test_limits_hold_between_dense_samples(arm, name, pace) -> None:
    assert worst(arm, name, pace, Sampling(blend=64, least=16)) <= DENSE[name]


@pytest.mark.parametrize("name", sorted(MODELS))
@pytest.mark.parametrize("pace", sorted(SPEEDS))
def test_the_default_sampling_holds_speeds_and_notes_accelerations(arm, name, pace) -> None:
    speed = SPEEDS[pace]
    for shares in SHARES:
        run = arm.controller(MODELS[name]).run(program(arm, speed, shares))
        joints, acceleration, tcp = excess(arm, run, speed)
        assert max(joints, tcp) <= HELD
        assert acceleration <= LEFT
        noted = [note for note in run.notes if "acceleration of joint" in note.message]
        assert noted or acceleration <= HELD


def test_something_always_limits(arm) -> None:
    """Where neither joint nor TCP were at a limit the stamp would be slower than it may."""
    speed = SPEEDS["programmed"]
    run = arm.controller().run(program(arm, speed, [0.2] * 4))
    rows = run.timing.path_limits.rows
    x, u = run.timing.stamp.x, np.diff(run.timing.stamp.x) / (2 * rows.spacing)
    used = x / rows.ceiling.clip(1e-300)
    at_speed = np.maximum(used[:-1], used[1:]) > 0.999
    load = np.abs(rows.a * u[:, None, None] + rows.b * np.stack([x[:-1], x[1:]], 1)[..., None])
    pulling = (load / rows.upper).max(axis=(1, 2)) > 0.999
    assert np.mean(at_speed | pulling) > 0.97
