"""What joints do between samples of a path: the quintic that meets both samples' derivatives."""

from __future__ import annotations

from ...robot.kinematics.lean import inner
from .tcp_samples import States

_ROUNDED = 1e-14
"""rad or m, and share of a joint's value, by which positions may be off: rounding, and what inverse
kinematics leave."""


@inner
def step_of(states: States, s: int, j: int, length: float) -> float:
    """How far joint j goes from sample s to the next.

    Where that is a few rounded digits of the positions, the derivatives say it better: of samples a
    nanometre apart, as in zones of micrometres, what the positions are off would count 1e18 times
    in the second derivative.
    """
    q0, q1 = states.q[s, j], states.q[s + 1, j]
    rates = 0.5 * (states.dq[s, j] + states.dq[s + 1, j])
    bend = (states.ddq[s + 1, j] - states.ddq[s, j]) / 12.0
    step: float = length * (rates - length * bend)
    way: float = q1 - q0
    return step if abs(way - step) <= _ROUNDED * (1.0 + abs(q0)) else way


@inner
def joint_at(states: States, s: int, j: int, length: float, z: float) -> tuple[float, float, float]:
    """q of joint j and two derivatives with respect to ℓ, at a share z behind sample s.

    The quintic in ℓ that meets both samples' derivatives, ``length`` of ℓ apart. Beyond them, where
    z is no share, it is what they let expect.
    """
    d = step_of(states, s, j, length)
    v0, v1 = states.dq[s, j], states.dq[s + 1, j]
    a0, a1 = states.ddq[s, j], states.ddq[s + 1, j]
    # What they are weighed by is the same for all joints: compilers take it out of loops.
    y, z2, z3, square = 1.0 - z, z * z, z * z * z, length * length
    by_v0, by_v1 = z * (1 + z2 * (-6 + z * (8 - 3 * z))), z3 * (-4 + z * (7 - 3 * z))
    by_a0, by_a1 = 0.5 * z2 * (y * y * y), 0.5 * z3 * (y * y)
    q = states.q[s, j] + z3 * (10 + z * (6 * z - 15)) * d
    q += length * by_v0 * v0 + length * by_v1 * v1 + square * by_a0 * a0 + square * by_a1 * a1
    by_v0, by_v1 = 1 + z2 * (-18 + z * (32 - 15 * z)), z2 * (-12 + z * (28 - 15 * z))
    by_a0, by_a1 = z * (y * y) * (1 - 2.5 * z), z2 * y * (1.5 - 2.5 * z)
    slope = 30 * z2 * (y * y) / length * d + by_v0 * v0 + by_v1 * v1
    slope += length * by_a0 * a0 + length * by_a1 * a1
    by_v0, by_v1 = z * (-36 + z * (96 - 60 * z)), z * (-24 + z * (84 - 60 * z))
    by_a0, by_a1 = y * (1 + z * (10 * z - 8)), z * (3 + z * (10 * z - 12))
    bend = 60 * z * y * (1 - 2 * z) / square * d + by_v0 / length * v0 + by_v1 / length * v1
    return q, slope, bend + by_a0 * a0 + by_a1 * a1
