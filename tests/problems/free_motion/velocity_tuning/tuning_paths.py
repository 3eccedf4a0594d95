"""Paths for the tests of velocity tuning."""

from __future__ import annotations

from functools import cache

import numpy as np

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.timing.stamping import StampLimits, joint_limits
from flyby.core.motion.timing.timing import Timing
from flyby.core.program.program import Program
from flyby.core.program.zone import Radius
from flyby.problems.free_motion.velocity_tuning import FixedPath, Rigid
from flyby.validation.scenes.scene import with_zone
from flyby.validation.scenes.two_joints import two_joints

FAST = 1e3


def graded(distance: float, count: int) -> np.ndarray:
    """Knots that crowd at both ends: x of a motion from rest is a power of the way."""
    z = np.linspace(0.0, 1.0, count + 1)
    return distance * z**2 * (3.0 - 2.0 * z)


def slider(
    distance: float,
    count: int = 200,
    inertia: float = 1.0,
    held: float = 0.0,
    velocity: float = FAST,
    acceleration: float = FAST,
) -> FixedPath:
    """One joint, q = σ, from rest to rest: torque = inertia · q̈ + held."""
    spacing = np.diff(graded(distance, count))
    one = np.ones((count, 2, 1))
    limits = joint_limits(
        spacing,
        one,
        0.0 * one,
        np.array([velocity]),
        np.array([-acceleration]),
        np.array([acceleration]),
    )
    ceiling = limits.ceiling.copy()
    ceiling[[0, -1]] = 0.0
    limits = StampLimits(spacing, limits.a, limits.b, limits.lower, limits.upper, ceiling)
    return FixedPath(limits, one, 0.0 * one, Rigid(inertia * one, 0.0 * one, held * one))


@cache
def scene() -> tuple[Controller, Program, Timing, FixedPath]:
    """The two-joint scene with zones at its via points."""
    made = two_joints()
    controller = made.controller()
    program = with_zone(made.programs[0], Radius(0.1))
    timing = controller.stamp(program, controller.plan(program))
    return controller, program, timing, FixedPath.of(controller, program, timing)
