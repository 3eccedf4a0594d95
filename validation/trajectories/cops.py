"""Trajectory problems of the COPS collection, with its optima (E. Dolan, J. Moré, T. Munson,
"Benchmarking optimization software with COPS 3.0", Argonne 2004), each discretised by the
trapezoidal rule and from the collection's start."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .collocation import Control, Values, straight
from .expressions import cos, exp, sin, sqrt
from .stated import StatedTrajectory, stated

FREE = float("nan")
INF = float("inf")


def goddard_rocket(nodes: int) -> StatedTrajectory:
    """A rocket that is to rise as high as it can; h, v, m and the thrust."""
    h0, m0, g0 = 1.0, 1.0, 1.0
    c = 0.5 * np.sqrt(g0 * h0)
    drag, most, least_mass = 0.5 * 620.0 * m0 / g0, 3.5 * m0 * g0, 0.6 * m0

    def dynamics(x: Values, u: Values, p: Values) -> list[Any]:
        h, v, m = x
        D = drag * v**2 * exp(-500.0 * (h - h0) / h0)
        g = g0 * h0**2 / h**2
        return [v, (u[0] - D) / m - g, -u[0] / c]

    control = Control(
        states=3,
        controls=1,
        parameters=1,
        dynamics=dynamics,
        duration=lambda p: p[0],
        final=lambda x, u, p: -x[0],
        first=(h0, 0.0, m0),
        last=(FREE, FREE, least_mass),
        lower=(h0, 0.0, least_mass, 0.0),
        upper=(INF, INF, m0, most),
        parameter_lower=(1e-3,),
        parameter_upper=(INF,),
    )
    t = np.linspace(0.0, 1.0, nodes)
    start = np.column_stack(
        [np.ones(nodes), t * (1 - t), (least_mass - m0) * t + m0, np.full(nodes, most / 2)]
    )
    return stated(control, start, [1.0], -1.01283)


def hang_glider(nodes: int) -> StatedTrajectory:
    """A glider that is to get as far as it can through an updraft; x, y, their speeds, the lift."""
    mass, gravity, area, density = 100.0, 9.81, 14.0, 1.13
    c0, c1 = 0.034, 0.069662

    def dynamics(x: Values, u: Values, p: Values) -> list[Any]:
        place, _, vx, vy = x
        r = (place / 100.0 - 2.5) ** 2
        w = vy - 2.5 * (1 - r) * exp(-r)
        v = sqrt(vx**2 + w**2)
        D = 0.5 * (c0 + c1 * u[0] ** 2) * density * area * v
        L = 0.5 * u[0] * density * area * v
        return [vx, vy, (-L * w - D * vx) / mass, (L * vx - D * w) / mass - gravity]

    first, last = (0.0, 1000.0, 13.23, -1.288), (FREE, 900.0, 13.23, -1.288)
    control = Control(
        states=4,
        controls=1,
        parameters=1,
        dynamics=dynamics,
        duration=lambda p: p[0],
        final=lambda x, u, p: -x[0],
        first=first,
        last=last,
        lower=(0.0, -INF, 0.0, -INF, 0.0),
        upper=(INF, INF, INF, INF, 1.4),
        parameter_lower=(1e-3,),
        parameter_upper=(INF,),
    )
    start = straight((*first, 0.7), (13.23, 900.0, 13.23, -1.288, 0.7), nodes)
    return stated(control, start, [1.0], -1248.03)


def robot_arm(nodes: int) -> StatedTrajectory:
    """An arm of length 5 that is to turn in minimum time; ρ, θ, φ, their speeds, the forces."""
    length = 5.0

    def dynamics(x: Values, u: Values, p: Values) -> list[Any]:
        rho, _, phi, *speeds = x
        inertia = ((length - rho) ** 3 + rho**3) / 3.0
        turns = inertia * sin(phi) ** 2
        return [*speeds, u[0] / length, u[1] / turns, u[2] / inertia]

    first = (4.5, 0.0, np.pi / 4, 0.0, 0.0, 0.0)
    last = (4.5, 2 * np.pi / 3, np.pi / 4, 0.0, 0.0, 0.0)
    control = Control(
        states=6,
        controls=3,
        parameters=1,
        dynamics=dynamics,
        duration=lambda p: p[0],
        final=lambda x, u, p: p[0],
        first=first,
        last=last,
        lower=(0.0, -np.pi, 0.0, -INF, -INF, -INF, -1.0, -1.0, -1.0),
        upper=(length, np.pi, np.pi, INF, INF, INF, 1.0, 1.0, 1.0),
        parameter_lower=(1e-3,),
        parameter_upper=(INF,),
    )
    start = straight((*first, 0.0, 0.0, 0.0), (*last, 0.0, 0.0, 0.0), nodes)
    start[:, 1] = 2 * np.pi / 3 * np.linspace(0.0, 1.0, nodes) ** 2
    return stated(control, start, [1.0], 9.14093)


def catalyst_mixing(nodes: int) -> StatedTrajectory:
    """The mixing of two catalysts along a reactor; two substances, the share of a catalyst."""

    def dynamics(x: Values, u: Values, p: Values) -> list[Any]:
        a, b = x
        return [u[0] * (10 * b - a), u[0] * (a - 10 * b) - (1 - u[0]) * b]

    control = Control(
        states=2,
        controls=1,
        dynamics=dynamics,
        duration=lambda p: 1.0,
        final=lambda x, u, p: x[0] + x[1] - 1.0,
        first=(1.0, 0.0),
        last=(FREE, FREE),
        lower=(-INF, -INF, 0.0),
        upper=(INF, INF, 1.0),
    )
    start = np.tile([1.0, 0.0, 0.0], (nodes, 1))
    return stated(control, start, [], -4.80556e-2)


def particle_steering(nodes: int) -> StatedTrajectory:
    """A particle under a force of given size that is to be steered in minimum time; its place, its
    speed, the force's direction."""
    force = 100.0

    def dynamics(x: Values, u: Values, p: Values) -> list[Any]:
        return [x[2], x[3], force * cos(u[0]), force * sin(u[0])]

    control = Control(
        states=4,
        controls=1,
        parameters=1,
        dynamics=dynamics,
        duration=lambda p: p[0],
        final=lambda x, u, p: p[0],
        first=(0.0, 0.0, 0.0, 0.0),
        last=(FREE, 5.0, 45.0, 0.0),
        lower=(-INF, -INF, -INF, -INF, -np.pi / 2),
        upper=(INF, INF, INF, INF, np.pi / 2),
        parameter_lower=(1e-3,),
        parameter_upper=(INF,),
    )
    start = straight((0.0, 0.0, 0.0, 0.0, 0.0), (0.0, 5.0, 45.0, 0.0, 0.0), nodes)
    return stated(control, start, [1.0], 0.554577)


COPS: dict[str, Callable[[int], StatedTrajectory]] = {
    "goddard-rocket": goddard_rocket,
    "hang-glider": hang_glider,
    "robot-arm": robot_arm,
    "catalyst-mixing": catalyst_mixing,
    "particle-steering": particle_steering,
}
