"""How fast axes, TCP and tool move per unit of the path parameter, and how that changes.

Of a sample these are, for each of N axes, q' and q''; for the TCP |p'| and p' · p'' / |p'|, the
change of its speed along the path; for the tool's turn likewise.
"""

from __future__ import annotations

import math

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import inner
from ..path.tcp_samples import States

_STILL = 1e-9
"""Rates (m or rad per unit) below which the TCP or the tool does not move."""


@inner
def rates(states: States, k: int, axes: int, rate: FloatArray, bend: FloatArray) -> None:
    """Write the rates (N + 2) at sample k, and how they change."""
    for j in range(axes):
        rate[j], bend[j] = states.dq[k, j], states.ddq[k, j]
    for part in range(2):
        square = mixed = 0.0
        for i in range(3 * part, 3 * part + 3):
            square += states.v[k, i] * states.v[k, i]
            mixed += states.v[k, i] * states.a[k, i]
        size = math.sqrt(square)
        if size > _STILL:
            rate[axes + part], bend[axes + part] = size, mixed / size
        else:
            rate[axes + part] = bend[axes + part] = 0.0


@inner
def bind(binding: IntArray, knot: int, sample: int, code: int, index: int) -> None:
    """Note what binds at a knot."""
    # One by one: an assignment to the row would be compiled with all that NumPy says of shapes.
    binding[knot, 0], binding[knot, 1], binding[knot, 2] = sample, code, index


@inner
def pull_rates(
    states: States, k: int, axes: int, rate_bar: FloatArray, bend_bar: FloatArray, out: States
) -> None:
    """Reverse of `rates`."""
    for j in range(axes):
        out.dq[k, j] += rate_bar[j]
        out.ddq[k, j] += bend_bar[j]
    for part in range(2):
        square = mixed = 0.0
        for i in range(3 * part, 3 * part + 3):
            square += states.v[k, i] * states.v[k, i]
            mixed += states.v[k, i] * states.a[k, i]
        size = math.sqrt(square)
        if size <= _STILL:
            continue
        by_rate, by_bend = rate_bar[axes + part] / size, bend_bar[axes + part] / size
        by_rate -= by_bend * mixed / square
        for i in range(3 * part, 3 * part + 3):
            out.v[k, i] += by_rate * states.v[k, i] + by_bend * states.a[k, i]
            out.a[k, i] += by_bend * states.v[k, i]


@inner
def sideways(states: States, k: int) -> float:
    """Length of what of the TCP's p'' is across its path."""
    square = mixed = bend = 0.0
    for i in range(3):
        square += states.v[k, i] * states.v[k, i]
        mixed += states.v[k, i] * states.a[k, i]
        bend += states.a[k, i] * states.a[k, i]
    if square <= _STILL**2:
        return 0.0
    return math.sqrt(max(bend - mixed * mixed / square, 0.0))


@inner
def pull_sideways(states: States, k: int, bar: float, out: States) -> None:
    """Reverse of `sideways` where it is above zero."""
    square = mixed = 0.0
    for i in range(3):
        square += states.v[k, i] * states.v[k, i]
        mixed += states.v[k, i] * states.a[k, i]
    size = sideways(states, k)
    for i in range(3):
        across = (states.a[k, i] - mixed / square * states.v[k, i]) / size
        out.a[k, i] += bar * across
        out.v[k, i] -= bar * mixed / square * across
