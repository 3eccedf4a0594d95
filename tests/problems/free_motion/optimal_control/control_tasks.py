"""Small robots whose optimal motions are known, for several test files."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq, fsolve

from flyby.core.registry import find_robot
from flyby.core.robot.inertia import Inertia
from flyby.core.robot.joint import Joint, JointKind
from flyby.core.robot.model import Robot
from flyby.core.spatial.pose import IDENTITY
from flyby.problems.free_motion.optimal_control import ControlLimits, MotionTask, Waypoint

FREE = math.inf
GRAVITY = 9.81
ARM = find_robot("abb/irb6640-180-255")
START = np.radians([0.0, -15.0, 15.0, 0.0, 60.0, 0.0])
END = np.radians([70.0, 20.0, -10.0, 40.0, -50.0, 90.0])
TORQUE = (3000.0, 6000.0, 2500.0, 600.0, 500.0, 200.0)


def cart(acceleration: float = 1.0, velocity: float = 100.0, effort: float | None = None) -> Robot:
    """One kilogram on a rail."""
    rail = Joint(
        "X", IDENTITY, (1, 0, 0), -50, 50, velocity, acceleration, effort, JointKind.PRISMATIC
    )
    return Robot("test/cart", (rail,), links=(Inertia(1.0),), gravity=(0, 0, 0))


def pendulum(torque: float) -> Robot:
    """One kilogram on a massless rod of 1 m, hanging at zero."""
    hinge = Joint("P", IDENTITY, (0, -1, 0), -20, 20, 100.0, 1e6, torque)
    return Robot(
        "test/pendulum", (hinge,), links=(Inertia(1.0, (0, 0, -1)),), gravity=(0, 0, -GRAVITY)
    )


def swing_up(torque: float) -> MotionTask:
    """From hanging to standing."""
    return MotionTask(pendulum(torque), [0.0], [math.pi], limits=ControlLimits(acceleration=[FREE]))


def strong_swing_up(torque: float) -> float:
    """s to stand, with torque that can hold the pendulum anywhere: full push, then full brake.

    By the work done, θ̇² / 2 = τ θ − g (1 − cos θ) on the way up, likewise from the end; the times
    are integrals of dθ / θ̇.
    """

    def up(angle: float) -> float:
        return 2 * (torque * angle - GRAVITY * (1 - math.cos(angle)))

    def down(angle: float) -> float:
        return 2 * (torque * (math.pi - angle) + GRAVITY * (1 + math.cos(angle)))

    switch = brentq(lambda angle: up(angle) - down(angle), 1e-6, math.pi - 1e-6)
    # With u² for the angle the integrands stay finite.
    first = quad(lambda u: 2 * u / math.sqrt(up(u * u)), 0, math.sqrt(switch))[0]
    last = quad(lambda u: 2 * u / math.sqrt(down(math.pi - u * u)), 0, math.sqrt(math.pi - switch))
    return float(first + last[0])


def weak_swing_up(torque: float, switches: tuple[float, float], end: float) -> float:
    """s to stand with torque that cannot: −, + and − between switches found by shooting.

    Args:
        torque: N m.
        switches, end: s, a guess.
    """

    def miss(times: NDArray[np.float64]) -> list[float]:
        state, before, push = np.zeros(2), 0.0, -torque
        for time in times:
            span = (0.0, max(time - before, 1e-9))

            def rate(_t: float, x: NDArray[np.float64], push: float = push) -> list[float]:
                return [x[1], push - GRAVITY * math.sin(x[0])]

            state = solve_ivp(rate, span, state, rtol=1e-8, atol=1e-10).y[:, -1]
            before, push = time, -push
        return [state[0] - math.pi, state[1]]

    # Two switches and the end meet two conditions; which pair is quickest is a search in one of
    # them.
    best = math.inf
    first, second = switches
    for shift in np.linspace(-0.04, 0.04, 17):
        found, _, good, _ = fsolve(
            lambda y, shift=shift: miss(np.array([first + shift, *y])),
            [second, end],
            full_output=True,
        )
        if good == 1 and first + shift < found[0] < found[1]:
            best = min(best, float(found[1]))
    return best


def arm_task(**more: object) -> MotionTask:
    """A wide motion of a real arm under torque limits."""
    given: dict[str, object] = {"limits": ControlLimits(torque=TORQUE), **more}
    return MotionTask(ARM, START, END, **given)  # type: ignore[arg-type]


def middle() -> Waypoint:
    """Beside the straight way of `arm_task`."""
    return Waypoint(0.5 * (START + END) + 0.1)
