"""The same motion takes the same energy, whichever part of the package is asked."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.consumption import (
    SQUARED_TORQUE,
    Consumption,
    Motors,
    SquaredTorque,
)
from flyby.core.motion.timing.energy import energy_by_joint
from flyby.core.motion.timing.timing import Timing
from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.program.tool import Load, Tool
from flyby.core.program.zone import FINE
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.inertia import carried_inertia
from flyby.core.spatial.pose import IDENTITY
from flyby.problems.free_motion import optimal_control as free
from flyby.problems.free_motion.velocity_tuning import (
    FixedPath,
    Tuned,
    TuningObjective,
    TuningTask,
    Way,
)

TOOL = Tool("gun", IDENTITY, Load(60.0, (0.1, 0.0, 0.2)))
START, END = np.radians([0, -10, 0, 0, 30, 0]), np.radians([0, 45, 25, 0, 30, 0])
COPPER = (2e-5, 1e-5, 3e-5, 1e-4, 1e-4, 2e-4)
CONSUMPTIONS = [
    SQUARED_TORQUE,
    SquaredTorque((0.0, 2.0)),
    Motors(COPPER),
    Motors(COPPER, 0.4),
    Motors(COPPER, 1.0),
    Motors((), 0.0),
]


@cache
def driven() -> tuple[Controller, Program, Timing]:
    """Down and up again on a joint line of an arm that has a weight in its hand."""
    moves = tuple(MoveJ(JointTarget(tuple(q)), Speed(tcp=1.0), FINE, TOOL) for q in (END, START))
    program = Program(moves, start=JointTarget(tuple(START)))
    controller = Controller(find_vendor("abb"), find_robot("abb/irb6640-180-255"))
    return controller, program, controller.stamp(program, controller.plan(program))


def as_polynomials(timing: Timing, q: np.ndarray, dq: np.ndarray, joints: list[int]) -> free.Motion:
    """On a joint line joints accelerate constantly from knot to knot."""
    steps = (timing.end - timing.begin)[:, None]
    change = (dq[:, 1] - dq[:, 0]) * steps / 2.0
    assert np.allclose(q[:, 0] + dq[:, 0] * steps + change, q[:, 1], atol=1e-9)
    coefficients = np.stack([q[:, 0], dq[:, 0] * steps, change], axis=1)[:, :, joints]
    knots = np.concatenate([[0.0], np.cumsum(steps)])
    return free.Motion(knots, coefficients, timing.interval_segments)


@pytest.mark.parametrize("consumption", CONSUMPTIONS, ids=str)
@pytest.mark.parametrize("joints", [range(6), [1, 2]], ids=["all joints", "two joints"])
def test_programs_tuned_paths_and_free_motions(consumption: Consumption, joints: range) -> None:
    controller, program, timing = driven()
    program_energy = controller.energy(program, timing, consumption)
    path = FixedPath.of(controller, program, timing)
    tuned = Tuned(
        TuningTask(path, objective=TuningObjective(0.5, consumption)), timing.stamp.x, Way.SWEEPS
    )
    assert tuned.energy == pytest.approx(program_energy.value, rel=1e-9)
    size = max(np.abs(tuned.energy_by_joint).sum(), abs(tuned.energy))
    by_joint = energy_by_joint(timing, program_energy)
    assert tuned.energy_by_joint == pytest.approx(by_joint, abs=1e-9 * size)

    motion = as_polynomials(timing, *program_energy.motion[:2], list(joints))
    task = free.MotionTask(
        controller.robot,
        START,
        START,
        waypoints=(free.Waypoint(END, stop=True),),
        loads=(carried_inertia(TOOL),),
        joints=tuple(joints),
    )
    # The program's integral is the trapezium rule.
    found = free.energy_of(task, motion, consumption)
    assert found == pytest.approx(program_energy.value, abs=2e-3 * size)
    found_by_joint = free.energy_by_joint(task, motion, consumption)
    assert found_by_joint == pytest.approx(tuned.energy_by_joint, abs=2e-3 * size)
