"""The motions of reference scenes as questions to optimal control, for several benchmarks."""

from __future__ import annotations

import numpy as np

from flyby.core.arrays import FloatArray
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.robot.inertia import carried_inertia
from flyby.problems.free_motion.optimal_control import MotionTask, Surroundings
from flyby.validation.scenes.scene import Scene

Question = tuple[MotionTask, Surroundings, list[FloatArray]]
"""A task, what to keep clear of, and the corners of a free path on its only leg."""


def configurations(program: Program) -> FloatArray:
    """(M + 1, N), start and targets of a program of joint targets."""
    targets = [program.start, *(move.target for move in program.moves)]
    assert all(isinstance(target, JointTarget) for target in targets)
    return np.array([target.joints for target in targets if isinstance(target, JointTarget)])


def questions(scene: Scene) -> list[Question]:
    """Every motion of a scene, begun along its program."""
    around = Surroundings(CollisionScene(scene.cell, scene.tool), scene.cell.clearance)
    load = carried_inertia(scene.tool)
    found = []
    for program in scene.programs:
        q = configurations(program)
        task = MotionTask(
            scene.cell.robot,
            q[0],
            q[-1],
            joints=scene.free,
            tcp=scene.tool.tcp,
            loads=(load,),
        )
        found.append((task, around, [q[1:-1]]))
    return found
