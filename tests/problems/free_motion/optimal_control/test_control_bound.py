"""What the free robot's time says of programs: averages come on top of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import Radius
from flyby.problems.free_motion.optimal_control import (
    MotionEffort,
    MotionTask,
    Surroundings,
    optimize,
)
from flyby.validation.scenes.scene import PARABOLAS, with_zone
from flyby.validation.scenes.two_joints import two_joints

SCENE = two_joints()
AVERAGES = (0.06, 0.04)


def test_averages_keep_limits_and_come_on_top_of_the_free_time() -> None:
    program = with_zone(SCENE.programs[0], Radius(0.12))
    plain = SCENE.controller(PARABOLAS).run(program, period=0.001)
    averaged = SCENE.controller(replace(PARABOLAS, smoothing=AVERAGES)).run(program, period=0.001)
    assert averaged.trajectory.t[-1] == pytest.approx(
        plain.trajectory.t[-1] + sum(AVERAGES), abs=2e-3
    )
    free = list(SCENE.free)
    limits = [SCENE.cell.robot.joints[j] for j in free]
    # Means of what is within limits: they are motions that the free robot may choose too.
    for run in (plain, averaged):
        velocity, acceleration = (
            np.abs(part[:, free]).max(axis=0) for part in (run.trajectory.dq, run.trajectory.ddq)
        )
        assert (velocity <= [1.005 * joint.velocity for joint in limits]).all()
        assert (acceleration <= [1.005 * joint.acceleration for joint in limits]).all()

    targets = [program.start, *(move.target for move in program.moves)]
    q = np.array([target.joints for target in targets if isinstance(target, JointTarget)])
    around = Surroundings(CollisionScene(SCENE.cell, SCENE.tool), SCENE.cell.clearance)
    task = MotionTask(SCENE.cell.robot, q[0], q[-1], joints=SCENE.free, tcp=SCENE.tool.tcp)
    found = optimize(task, around, MotionEffort(intervals=40), vias=[q[1:-1]])
    assert found.certificate is not None
    assert found.certificate.clearance >= SCENE.cell.clearance
    assert found.time < plain.timing.duration
    assert found.time + sum(AVERAGES) < averaged.trajectory.t[-1]
