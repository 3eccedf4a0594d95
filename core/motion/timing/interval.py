"""What is driven within one interval of a stamped path.

Between samples x = (dℓ/dt)² is linear in ℓ: ℓ̈ is constant, and ℓ a parabola in time.
"""

from __future__ import annotations

from ...arrays import FloatArray
from ...robot.kinematics.lean import lean
from ..path.tcp_samples import States


@lean
def progress(
    begin: float, end: float, spacing: float, x0: float, x1: float, t: float
) -> tuple[float, float]:
    """The share of an interval that is behind at time t, 0 to 1, and dℓ/dt there.

    Args:
        begin, end: s, when it is entered and left.
        spacing: ℓ of it.
        x0, x1: (dℓ/dt)² at its ends.
        t: s; before and after, what holds at the nearer end.
    """
    change = (x1 - x0) / (2 * spacing)
    tau = min(max(t - begin, 0.0), end - begin)
    # From the nearer end, so that arrival at a stop is exact.
    if 2 * tau <= end - begin:
        start = x0**0.5
        step = tau * (start + 0.5 * change * tau)
        return min(max(step / spacing, 0.0), 1.0), start + change * tau
    left = end - begin - tau
    arrival = x1**0.5
    step = spacing - left * (arrival - 0.5 * change * left)
    return min(max(step / spacing, 0.0), 1.0), x0**0.5 + change * tau


@lean
def joint_at(states: States, s: int, j: int, length: float, z: float) -> tuple[float, float, float]:
    """q of joint j and two derivatives with respect to ℓ, at a share z behind sample s.

    The quintic in ℓ that meets both samples' derivatives, ``length`` of ℓ apart.
    """
    p0, v0, a0 = states.q[s, j], length * states.dq[s, j], length**2 * states.ddq[s, j]
    p1, v1 = states.q[s + 1, j], length * states.dq[s + 1, j]
    a1 = length**2 * states.ddq[s + 1, j]
    d = p1 - p0
    c3 = 10 * d - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1
    c4 = -15 * d + 8 * v0 + 7 * v1 + 1.5 * a0 - a1
    c5 = 6 * d - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1
    q = p0 + z * (v0 + z * (0.5 * a0 + z * (c3 + z * (c4 + z * c5))))
    slope = v0 + z * (a0 + z * (3 * c3 + z * (4 * c4 + z * 5 * c5)))
    bend = a0 + z * (6 * c3 + z * (12 * c4 + z * 20 * c5))
    return q, slope / length, bend / length**2


@lean
def sigma_at(sigma: FloatArray, rate: FloatArray, s: int, length: float, z: float) -> float:
    """σ at a share z behind sample s: the cubic with slopes dσ/dℓ = 1 / rate at both samples."""
    rise = sigma[s + 1] - sigma[s]
    lead, tail = length / rate[s] - rise, rise - length / rate[s + 1]
    place: float = sigma[s] + z * (rise + (1 - z) * ((1 - z) * lead + z * tail))
    return place
