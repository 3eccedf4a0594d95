"""How far the servos of one robot let its joints be off what is commanded.

**Friction**, where they begin to move or turn back.

What friction holds follows the way that a joint goes, whatever its speed (P. Dahl, "A solid
friction model", Aerospace Corporation TOR-158(3107-18), 1968): over a way d it comes to the side
that the joint moves to,

    d ż = q̇ − z |q̇|,     −1 ≤ z ≤ 1.

A servo does not know at once, and makes up for it within its integral time, w. So the joint is off
by friction · (z − mean of z, weighed by e^(−age / w)), which sets in as it turns back, stays within
twice the friction, and fades. Motors and the links with them are off alike.

**Drag**, where they run fast. Friction grows with speed, too, and no servo makes up for all of it:
a joint comes to be off by drag times

    q̇ |q̇| / (|q̇| + v),

v being the speed about which it sets in, averaged by e^(−age / T): after a while at even speed, and
hardly at slow ones.

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
_SMALL = 1e-6
"""Share of a time below which means are worked out by their first terms."""


class FrictionMemory:
    """What friction and drag remember of a motion that is worked out stretch by stretch, from rest
    on.

    Args:
        servo: of the robot.
        smoothing: that the stamped motion goes through.
        size: number of axes.
    """

    def __init__(self, servo: Servo, smoothing: Smoothing, size: int) -> None:
        self._smoothing = smoothing
        self._servo = servo
        self._friction, self._drag = filled(servo.friction, size), filled(servo.drag, size)
        self._held = np.zeros((3, size))
        self.known_to = 0.0
        """s, up to where the motion is known; before zero it rests."""

    def over(self, stamped: JointMotion, t: FloatArray, states: States) -> States:
        """How far joints are off, with two derivatives in time, (T, N) each.

        Args:
            stamped: the stamped motion, from a window before `known_to` on.
            t: (T,) s, not decreasing.
            states: (T, N) each, of the smoothed motion then.
        """
        servo = self._servo
        even = even_times(self.known_to, max(float(t[-1]), self.known_to), _STEP)
        way, speed, _ = self._smoothing.command(stamped, even)
        drawn = _dragged(speed, servo.drag_speed)
        held = np.empty((3, *way.shape))
        coming = _weights(np.array(_STEP), servo.drag_time)
        weights = np.array([float(weight) for weight in coming])
        _fill_held(way, drawn, servo.rise, _STEP / servo.fade, weights, self._held, held)
        last = np.clip(np.searchsorted(even, t, "right") - 1, 0, len(even) - 1)
        since = (t - even[last])[:, None]
        q, dq, ddq = states
        z, mean = _held_after(q - way[last], servo.rise, since / servo.fade, held[:2, last])
        slope = (dq - z * np.abs(dq)) / servo.rise
        bend = (ddq - slope * np.abs(dq) - z * np.sign(dq) * ddq) / servo.rise
        gone = (z - mean) / servo.fade
        kept, begun, ended = _weights(since, servo.drag_time)
        pull = _dragged(dq, servo.drag_speed)
        drag = kept * held[2, last] + begun * drawn[last] + ended * pull
        rate = (pull - drag) / servo.drag_time
        jerk = (_pulled(dq, servo.drag_speed) * ddq - rate) / servo.drag_time
        self.known_to, self._held = float(even[last[-1]]), held[:, last[-1]].copy()
        return (
            self._friction * (z - mean) + self._drag * drag,
            self._friction * (slope - gone) + self._drag * rate,
            self._friction * (bend - (slope - gone) / servo.fade) + self._drag * jerk,
        )


def friction_at(
    servo: Servo, smoothing: Smoothing, stamped: JointMotion, t: FloatArray, states: States
) -> FloatArray:
    """How far friction and drag set joints off (T, N) in a motion all of which is known.

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


def drag_bound(servo: Servo, fastest: FloatArray) -> FloatArray:
    """(…, N) rad or m, beyond which drag sets no joint off that was never faster (…, N)."""
    per = np.abs(filled(servo.drag, fastest.shape[-1]))
    return np.asarray(per * _dragged(np.abs(fastest), servo.drag_speed))


def _dragged(speed: FloatArray, v: float) -> FloatArray:
    size = np.abs(speed)
    return np.asarray(speed * size / (size + v))


def _pulled(speed: FloatArray, v: float) -> FloatArray:
    """Its derivative by the speed."""
    size = np.abs(speed)
    return np.asarray(size * (size + 2.0 * v) / (size + v) ** 2)


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


def _weights(since: FloatArray, time: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """In a mean of what goes straight since times: of the mean before, the first and the last."""
    share = since / time
    gone = -np.expm1(-share)
    with np.errstate(invalid="ignore", divide="ignore"):
        ended = np.where(share > _SMALL, 1.0 - gone / share, 0.5 * share)
    return 1.0 - gone, gone - ended, ended


@njit(cache=True, error_model="numpy")
def _fill_held(
    q: FloatArray,
    drawn: FloatArray,
    way: float,
    share: float,
    weights: FloatArray,
    before: FloatArray,
    held: FloatArray,
) -> None:
    """What friction holds, its mean, and the mean of what drags, (3, T, N), along configurations
    and what drags (T, N)."""
    kept = np.exp(-share)
    for j in range(q.shape[1]):
        z, mean, drag = before[0, j], before[1, j], before[2, j]
        held[0, 0, j], held[1, 0, j], held[2, 0, j] = z, mean, drag
        for k in range(1, q.shape[0]):
            step = q[k, j] - q[k - 1, j]
            side, part = np.sign(step), abs(step) / way
            left, less = z - side, np.exp(-part)
            between = (less - kept) / (share - part) if abs(share - part) > _SMALL else kept
            mean = kept * mean + (1.0 - kept) * side + left * share * between
            z = side + left * less
            drag = weights[0] * drag + weights[1] * drawn[k - 1, j] + weights[2] * drawn[k, j]
            held[0, k, j], held[1, k, j], held[2, k, j] = z, mean, drag
