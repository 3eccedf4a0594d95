"""Runs of a motion model that is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.blend import Blend
from flyby.core.motion.model.elasticity import Carried, Elasticity
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.identification.fit import PreparedRun, prepare
from flyby.identification.logs import LoggedRun
from flyby.identification.logs.synthetic import Faults, synthetic_run

VENDOR = find_vendor("abb")
ROBOT = find_robot("abb/irb6640-180-255")
HOME = np.array([0.3, 0.3, 0.4, 0.6, -0.5, -0.5])
START = replace(
    MotionModel(),
    tcp=Blend(beta=(0.0,)),
    smoothing=(0.03, 0.03),
    settling=0.05,
    elasticity=Elasticity((5e-5, 5e-5), (Carried(5, (2e-5, 2e-5)),)),
    joint_acceleration_scale=(1.0,) * 6,
)
TRUTH = replace(
    START,
    tcp=Blend(beta=(-0.5,)),
    smoothing=(0.04, 0.04),
    elasticity=Elasticity((5e-5, 1.2e-4), (Carried(5, (5e-5, 2e-5)),)),
    joint_acceleration_scale=(1.3, 1.0, 1.0, 1.0, 1.0, 1.0),
)
USUAL = Faults()
TRUE_VALUES = {
    "blend.tcp.beta[0]": -0.5,
    "time.smoothing_s[*]": 0.04,
    "elasticity.own_s2[1]": 1.2e-4,
    "elasticity.carried[0].lead_s2_per_m2[0]": 5e-5,
    "limit.joint_acceleration_scale[0]": 1.3,
}


def program(radius: float, speed: float, lift: float = 0.1) -> Program:
    """A line with a corner, and back to the start in joints."""
    at = ROBOT.flange_pose(HOME)

    def there(*offset: float) -> PoseTarget:
        return PoseTarget(Pose(tuple(np.array(at.position) + offset), at.quaternion))

    told = Speed(tcp=speed, reorientation=2.0)
    zone = FINE if radius == 0.0 else Radius(radius, radius, radius, 0.05)
    moves = (
        MoveL(there(0.0, -0.25, 0.0), told, zone),
        MoveL(there(0.2, -0.35, lift), told, FINE),
        MoveJ(JointTarget(tuple(HOME)), told, FINE),
    )
    return Program(moves, start=JointTarget(tuple(HOME)))


def logged(
    radius: float = 0.03,
    speed: float = 0.5,
    seed: int = 0,
    faults: Faults = USUAL,
    model: MotionModel = TRUTH,
    lift: float = 0.1,
) -> LoggedRun:
    """A log of the truth."""
    name = f"z{1e3 * radius:.0f}_v{1e3 * speed:.0f}_{seed}"
    told = program(radius, speed, lift)
    return synthetic_run(Controller(VENDOR, ROBOT, model), told, name, faults, seed)


def ready(run: LoggedRun, model: MotionModel = START) -> PreparedRun:
    """The run as a fit begins with it."""
    return prepare(run, VENDOR, ROBOT, model)
