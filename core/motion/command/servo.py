"""How far the servos of one robot let its joints be off what is commanded.

**Friction**, where they begin to move or turn back.

What friction holds follows the way that a joint goes, whatever its speed (P. Dahl, "A solid
friction model", Aerospace Corporation TOR-158(3107-18), 1968): over a way d it comes to the side
that the joint moves to,

    d ż = q̇ − z |q̇|,     −1 ≤ z ≤ 1.

A servo does not know at once, and makes up for it within its integral time, w. So the joint is off
by friction · (z − mean of z, weighed by e^(−age / w)), which sets in as it turns back, stays within
twice the friction, and fades. Motors and the links with them are off alike.

**Drag**, where they run fast. Friction grows with speed, too, and no servo makes up for all of it.
It shows late: a joint is off by drag times

    q̇³ / (q̇² + v²)     a delay D before,

v being the speed about which it sets in. So a joint comes up to where drag has it, and to rest, D
after what is commanded.
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
_SMALL = 1e-6
"""Share of a time below which means are worked out by their first terms."""
_DRAG_STEP, _ASIDE = 4e-3, 20
"""s between the times from which the second derivative of drag is taken, by a cubic spline; and how
many of them count beside those that are asked for."""


class FrictionMemory:
    """What friction remembers of a motion that is worked out stretch by stretch, from rest on.

    Args:
        servo: of the robot.
        smoothing: that the stamped motion goes through.
        size: number of axes.
    """

    def __init__(self, servo: Servo, smoothing: Smoothing, size: int) -> None:
        self._smoothing = smoothing
        self._servo = servo
        self._friction = filled(servo.friction, size)
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
        rise, fade = self._servo.rise, self._servo.fade
        even = even_times(self.known_to, max(float(t[-1]), self.known_to), _STEP)
        way = self._smoothing.command(stamped, even)[0]
        held = np.empty((2, *way.shape))
        _fill_held(way, rise, _STEP / fade, self._held, held)
        last = np.clip(np.searchsorted(even, t, "right") - 1, 0, len(even) - 1)
        share = (t - even[last])[:, None] / fade
        q, dq, ddq = states
        z, mean = _held_after(q - way[last], rise, share, held[:, last])
        slope = (dq - z * np.abs(dq)) / rise
        bend = (ddq - slope * np.abs(dq) - z * np.sign(dq) * ddq) / rise
        gone = (z - mean) / fade
        self.known_to, self._held = float(even[last[-1]]), held[:, last[-1]].copy()
        return (
            self._friction * (z - mean),
            self._friction * (slope - gone),
            self._friction * (bend - (slope - gone) / fade),
        )


def drag_at(servo: Servo, smoothing: Smoothing, stamped: JointMotion, t: FloatArray) -> States:
    """How far drag sets joints off, with two derivatives in time, (T, N) each.

    Args:
        servo: of the robot.
        smoothing: that the stamped motion goes through.
        stamped: it, from `drag_reach` and a window before the first time on.
        t: (T,) s, not decreasing.
    """
    begin = max(float(t[0]) - drag_reach(servo), 0.0)
    end = max(float(t[-1]) - servo.drag_delay, begin) + _ASIDE * _DRAG_STEP
    even = even_times(begin, end, _DRAG_STEP)
    then = t - servo.drag_delay
    _, dq, ddq = smoothing.command(stamped, then)
    per = filled(servo.drag, dq.shape[1])
    known = _dragged(smoothing.command(stamped, even)[1], servo.drag_speed)
    bend = JointMotion.through(even, known).at(then)[2]
    slope = _dragged_slope(dq, servo.drag_speed) * ddq
    return per * _dragged(dq, servo.drag_speed), per * slope, per * bend


def drag_reach(servo: Servo) -> float:
    """s before a time from when on drag has to know the motion."""
    return servo.drag_delay + _ASIDE * _DRAG_STEP if any(servo.drag) else 0.0


def offsets_at(
    servo: Servo, smoothing: Smoothing, stamped: JointMotion, t: FloatArray, states: States
) -> FloatArray:
    """How far servos let joints be off (T, N) in a motion all of which is known.

    Args:
        servo: of the robot.
        smoothing: that the stamped motion goes through.
        stamped: it.
        t: (T,) s, not decreasing.
        states: (T, N) each, of the smoothed motion then.
    """
    off = np.zeros_like(states[0])
    if not len(t):
        return off
    if any(servo.friction):
        memory = FrictionMemory(servo, smoothing, off.shape[1])
        off += memory.over(stamped, t, states)[0]
    if any(servo.drag):
        speed = smoothing.command(stamped, t - servo.drag_delay)[1]
        off += filled(servo.drag, off.shape[1]) * _dragged(speed, servo.drag_speed)
    return off


def time_to_rest(servo: Servo) -> float:
    """s after the end of what is commanded by which joints rest, but for what friction holds."""
    return servo.drag_delay if any(servo.drag) else 0.0


def friction_bound(servo: Servo, size: int) -> FloatArray:
    """(size,) rad or m, beyond which friction sets no joint off, whatever the motion."""
    return 2.0 * np.abs(filled(servo.friction, size))


def drag_bound(servo: Servo, fastest: FloatArray) -> FloatArray:
    """(…, N) rad or m, beyond which drag sets no joint off that was never faster (…, N)."""
    per = np.abs(filled(servo.drag, fastest.shape[-1]))
    return np.asarray(per * _dragged(np.abs(fastest), servo.drag_speed))


def _dragged(speed: FloatArray, v: float) -> FloatArray:
    square = speed * speed
    return np.asarray(speed * square / (square + v * v))


def _dragged_slope(speed: FloatArray, v: float) -> FloatArray:
    """Its derivative by the speed."""
    square, bent = speed * speed, v * v
    return np.asarray(square * (square + 3.0 * bent) / (square + bent) ** 2)


def _held_after(
    step: FloatArray, way: float, share: FloatArray, before: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """What is held, and its mean, (T, N) each, after steps to one side, which take shares (T, 1) of
    the time that the mean looks back, of both (2, T, N) before."""
    side, part = np.sign(step), np.abs(step) / way
    kept, apart = np.exp(-share), share - part
    left, z = before[0] - side, np.exp(-part)
    with np.errstate(invalid="ignore", divide="ignore"):
        between = np.where(np.abs(apart) > _SMALL, (z - kept) / apart, kept)
    mean = kept * before[1] + (1.0 - kept) * side + left * share * between
    return np.asarray(side + left * z), np.asarray(mean)


@njit(cache=True, error_model="numpy")
def _fill_held(
    q: FloatArray, way: float, share: float, before: FloatArray, held: FloatArray
) -> None:
    """What friction holds, and its mean, (2, T, N), along configurations (T, N)."""
    kept = np.exp(-share)
    for j in range(q.shape[1]):
        z, mean = before[0, j], before[1, j]
        held[0, 0, j], held[1, 0, j] = z, mean
        for k in range(1, q.shape[0]):
            step = q[k, j] - q[k - 1, j]
            side, part = np.sign(step), abs(step) / way
            left, less = z - side, np.exp(-part)
            between = (less - kept) / (share - part) if abs(share - part) > _SMALL else kept
            mean = kept * mean + (1.0 - kept) * side + left * share * between
            z = side + left * less
            held[0, k, j], held[1, k, j] = z, mean
