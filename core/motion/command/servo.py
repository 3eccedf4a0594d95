"""How far the servos of one robot let its joints be off what is commanded.

**Friction**, where they begin to move or turn back.

What friction holds follows the way that a joint goes, whatever its speed (P. Dahl, "A solid
friction model", Aerospace Corporation TOR-158(3107-18), 1968): over a way d it comes to the side
that the joint moves to,

    d ż = q̇ − z |q̇|,     −1 ≤ z ≤ 1.

A servo does not know at once. What of it is not made up for is taken as the difference of two such
states, one over a short way and one over a long one: the joint is off by friction · (z_rise −
z_fade), which sets in as it turns back, stays within twice the friction, and fades. Motors and the
links with them are off alike. As it depends on ways alone, it is the same at every speed.

**Transients**, where their velocities change. A servo gives way to a torque that it does not know
of, until its integral part has made up for that: to a step of it within about its integral time,
w. Where the torque is one of inertia, each joint is off by

    transient · (q̇ − (q(t) − q(t − w)) / w),

its velocity less the mean over the last w seconds, which is what an acceleration makes of it
meanwhile. At even speed nothing is left.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import FloatArray
from ..model.point_masses import filled
from ..model.servo import Servo
from .smoothing import JointMotion, Smoothing, States, even_times

_STEP = 2e-3
"""s between the times at which a joint's way is looked at, on which it is taken to go one way."""


class FrictionMemory:
    """What friction remembers of a motion that is worked out stretch by stretch, from rest on.

    Args:
        servo: of the robot.
        smoothing: that the stamped motion goes through.
        size: number of axes.
    """

    def __init__(self, servo: Servo, smoothing: Smoothing, size: int) -> None:
        self._smoothing = smoothing
        self._friction = filled(servo.friction, size)
        self._ways = np.array([servo.rise, servo.fade])
        self._held = np.zeros((2, size))
        self.known_to = 0.0
        """s, up to where the motion is known; before zero it rests."""

    def over(self, stamped: JointMotion, t: FloatArray, states: States) -> States:
        """How far joints are off, with two derivatives in time, (T, N) each.

        Args:
            stamped: the stamped motion, from a window before `known_to` on.
            t: (T,) s, not decreasing.
            states: (T, N) each, of the smoothed motion then.
        """
        even = even_times(self.known_to, max(float(t[-1]), self.known_to), _STEP)
        way = self._smoothing.command(stamped, even)[0]
        held = np.empty((2, *way.shape))
        _fill_held(way, self._ways, self._held, held)
        last = np.clip(np.searchsorted(even, t, "right") - 1, 0, len(even) - 1)
        q, dq, ddq = states
        off = np.zeros_like(q), np.zeros_like(q), np.zeros_like(q)
        for sign, long, at_knots in zip((1.0, -1.0), self._ways, held, strict=True):
            z = _held_after(q - way[last], long, at_knots[last])
            slope = (dq - z * np.abs(dq)) / long
            bend = (ddq - slope * np.abs(dq) - z * np.sign(dq) * ddq) / long
            for made, part in zip(off, (z, slope, bend), strict=True):
                made += sign * self._friction * part
        self.known_to, self._held = float(even[last[-1]]), held[:, last[-1]].copy()
        return off


def friction_at(
    servo: Servo, smoothing: Smoothing, stamped: JointMotion, t: FloatArray, states: States
) -> FloatArray:
    """How far friction sets joints off (T, N) in a motion all of which is known.

    Args:
        servo: of the robot.
        smoothing: that the stamped motion goes through.
        stamped: it.
        t: (T,) s, not decreasing.
        states: (T, N) each, of the smoothed motion then.
    """
    if not servo.rubs or not len(t):
        return np.zeros_like(states[0])
    return FrictionMemory(servo, smoothing, states[0].shape[1]).over(stamped, t, states)[0]


def transient_at(
    servo: Servo,
    smoothing: Smoothing,
    stamped: JointMotion,
    t: FloatArray,
    states: States,
    jerk: FloatArray | None = None,
) -> States:
    """How far joints are off where their velocities change, with two derivatives, (T, N) each.

    Args:
        servo: of the robot.
        smoothing: that the stamped motion goes through.
        stamped: it, from a window and `Servo.transient_time` before the first time on.
        t: (T,) s, not decreasing.
        states: (T, N) each, of the smoothed motion then.
        jerk: (T, N), its third derivative; without, the second of what joints are off is not known.
    """
    if not servo.gives or not len(t):
        return np.zeros_like(states[0]), np.zeros_like(states[0]), np.zeros_like(states[0])
    per, back = filled(servo.transient, states[0].shape[1]), servo.transient_time
    before = smoothing.command(stamped, t - back)
    third = np.full_like(states[0], np.nan) if jerk is None else jerk
    ahead = (states[1], states[2], third)
    made = (
        per * (one - (now - then) / back)
        for one, now, then in zip(ahead, states, before, strict=True)
    )
    return next(made), next(made), next(made)


def friction_bound(servo: Servo, size: int) -> FloatArray:
    """(size,) rad or m, beyond which friction sets no joint off, whatever the motion."""
    return 2.0 * np.abs(filled(servo.friction, size))


def _held_after(step: FloatArray, way: float, before: FloatArray) -> FloatArray:
    """What is held (T, N) after steps to one side, of what was held before."""
    side = np.sign(step)
    return np.asarray(side + (before - side) * np.exp(-np.abs(step) / way))


@njit(cache=True, error_model="numpy")
def _fill_held(q: FloatArray, ways: FloatArray, before: FloatArray, held: FloatArray) -> None:
    """What is held (W, T, N) over each of the ways (W,) along configurations (T, N)."""
    for w in range(ways.size):
        for j in range(q.shape[1]):
            z = before[w, j]
            held[w, 0, j] = z
            for k in range(1, q.shape[0]):
                step = q[k, j] - q[k - 1, j]
                side = np.sign(step)
                z = side + (z - side) * np.exp(-abs(step) / ways[w])
                held[w, k, j] = z
