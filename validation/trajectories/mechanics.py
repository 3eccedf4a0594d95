"""Trajectories of machines: pendulums that swing up, a car that parks, an arm among obstacles."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .collocation import Collocation, Control, Values, straight
from .expressions import cos, sin, tan
from .stated import StatedTrajectory, stated

INF = float("inf")


def cart_pole(nodes: int, swing: float = 1.0) -> StatedTrajectory:
    """A pole on a cart is to swing up in 2 s with least effort (M. Kelly, "An introduction to
    trajectory optimization", SIAM Review 2017, section 6); cart, angle, their speeds, the force.

    Args:
        swing: multiple of the turn in the straight guess.
    """
    m1, m2, length, g = 1.0, 0.3, 0.5, 9.81

    def dynamics(x: Values, u: Values, p: Values) -> list[Any]:
        _, q, v, w = x
        s, c = sin(q), cos(q)
        below = m1 + m2 * s**2
        cart = (length * m2 * s * w**2 + u[0] + m2 * g * c * s) / below
        pole = -(length * m2 * c * s * w**2 + u[0] * c + (m1 + m2) * g * s) / (length * below)
        return [v, w, cart, pole]

    control = Control(
        states=4,
        controls=1,
        dynamics=dynamics,
        duration=lambda p: 2.0,
        running=lambda x, u, p: u[0] ** 2,
        first=(0.0, 0.0, 0.0, 0.0),
        last=(1.0, np.pi, 0.0, 0.0),
        lower=(-2.0, -INF, -INF, -INF, -20.0),
        upper=(2.0, INF, INF, INF, 20.0),
    )
    start = straight((0, 0, 0, 0, 0), (1.0, swing * np.pi, 0, 0, 0), nodes)
    return stated(control, start, [], scheme=Collocation.HERMITE_SIMPSON)


def double_pendulum(nodes: int, push: float = 0.0) -> StatedTrajectory:
    """A double pendulum of two rods of length and mass 1 is to swing up in minimum time; two
    angles from below, their speeds, two torques.

    Args:
        push: torque in the guess.
    """
    g, most = 9.81, (8.0, 8.0)

    def dynamics(x: Values, u: Values, p: Values) -> list[Any]:
        a, b, va, vb = x
        c, s = cos(a - b), sin(a - b)
        first = u[0] - u[1] - s * vb**2 - 2 * g * sin(a)
        second = u[1] + s * va**2 - g * sin(b)
        below = 2 - c**2
        return [va, vb, (first - c * second) / below, (2 * second - c * first) / below]

    control = Control(
        states=4,
        controls=2,
        parameters=1,
        dynamics=dynamics,
        duration=lambda p: p[0],
        running=lambda x, u, p: 1.0 + 1e-3 * (u[0] ** 2 + u[1] ** 2),
        first=(0.0, 0.0, 0.0, 0.0),
        last=(np.pi, np.pi, 0.0, 0.0),
        lower=(-INF, -INF, -INF, -INF, -most[0], -most[1]),
        upper=(INF, INF, INF, INF, *most),
        parameter_lower=(0.1,),
        parameter_upper=(20.0,),
    )
    start = straight((0, 0, 0, 0, push, push), (np.pi, np.pi, 0, 0, push, push), nodes)
    return stated(control, start, [2.0])


def car_parking(nodes: int) -> StatedTrajectory:
    """A car is to drive backwards into a gap beside it in minimum time; place, heading, speed and
    steering angle, their rates. Its rear corner keeps out of the car behind, a disc."""

    def dynamics(x: Values, u: Values, p: Values) -> list[Any]:
        _, _, heading, speed, steer = x
        return [
            speed * cos(heading),
            speed * sin(heading),
            speed * tan(steer) / 2.5,
            u[0],
            u[1],
        ]

    def clear(x: Values, u: Values, p: Values) -> list[Any]:
        return [(x[0] + 4.5) ** 2 + (x[1] + 2.5) ** 2]

    control = Control(
        states=5,
        controls=2,
        parameters=1,
        dynamics=dynamics,
        duration=lambda p: p[0],
        final=lambda x, u, p: p[0],
        path=clear,
        path_lower=(2.0,),
        path_upper=(INF,),
        first=(1.0, 1.5, 0.0, 0.0, 0.0),
        last=(-1.0, -2.0, 0.0, 0.0, 0.0),
        lower=(-INF, -INF, -INF, -2.0, -0.6, -1.0, -1.0),
        upper=(INF, INF, INF, 2.0, 0.6, 1.0, 1.0),
        parameter_lower=(0.1,),
        parameter_upper=(100.0,),
    )
    start = straight((1.0, 1.5, 0, 0, 0, 0, 0), (-1.0, -2.0, 0, 0, 0, 0, 0), nodes)
    return stated(control, start, [8.0])


def two_link_arm(nodes: int, bend: float = 0.0) -> StatedTrajectory:
    """An arm of two links of length 1 is to move in minimum time past two discs, which points along
    both links keep out of; two angles, their speeds, their accelerations.

    Args:
        bend: of the elbow in the middle of the guess, rad.
    """
    discs = ((1.2, 0.9, 0.25), (-0.3, 1.5, 0.3))

    def clear(x: Values, u: Values, p: Values) -> list[Any]:
        a, b = x[0], x[0] + x[1]
        elbow = (cos(a), sin(a))
        rows = []
        for share in (0.5, 1.0):
            rows.append((share * elbow[0], share * elbow[1]))
            rows.append((elbow[0] + share * cos(b), elbow[1] + share * sin(b)))
        return [(px - cx) ** 2 + (py - cy) ** 2 - r**2 for px, py in rows for cx, cy, r in discs]

    control = Control(
        states=4,
        controls=2,
        parameters=1,
        dynamics=lambda x, u, p: [x[2], x[3], u[0], u[1]],
        duration=lambda p: p[0],
        final=lambda x, u, p: p[0],
        path=clear,
        path_lower=(0.0,) * 8,
        path_upper=(INF,) * 8,
        first=(0.0, 0.0, 0.0, 0.0),
        last=(np.pi, 0.3, 0.0, 0.0),
        lower=(-INF, -3.0, -3.0, -3.0, -5.0, -5.0),
        upper=(INF, 3.0, 3.0, 3.0, 5.0, 5.0),
        parameter_lower=(0.1,),
        parameter_upper=(20.0,),
    )
    start = straight((0, 0, 0, 0, 0, 0), (np.pi, 0.3, 0, 0, 0, 0), nodes)
    start[:, 1] += bend * np.sin(np.pi * np.linspace(0.0, 1.0, nodes))
    return stated(control, start, [2.0])


MECHANICS: dict[str, Callable[[int], StatedTrajectory]] = {
    "cart-pole": cart_pole,
    "double-pendulum": double_pendulum,
    "car-parking": car_parking,
    "two-link-arm": two_link_arm,
}
