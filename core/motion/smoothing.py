"""The moving average that a controller puts over its commanded joints.

With a window of length T the command at time t is the mean of the stamped joints over [t − T, t]:
the motion ends T later, no joint exceeds the limits that held before, a joint with acceleration
limit a strays at most a T²/24 from the middle of the window, and its jerk stays within 2 a / T.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def window_for_jerk(jerk: float) -> float:
    """Window in s that holds a jerk limit given as a multiple of acceleration per second.

    A mean over T of accelerations within ±a changes by at most 2 a / T per second.
    """
    return 2.0 / jerk


def moving_average(
    t: FloatArray, q: FloatArray, dq: FloatArray, window: float, at: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mean over the last ``window`` seconds of a motion that rests before and after.

    Args:
        t: (S,) s, increasing.
        q, dq: (S, N), positions and velocities; cubic between samples.
        window: s, above zero.
        at: (T,) s.

    Returns:
        Positions, velocities and accelerations (T, N).
    """
    # Imported here: it takes longer than all else that a start of the command line needs.
    from scipy.interpolate import CubicHermiteSpline

    lead, tail = t[0] - window - 1.0, t[-1] + window + 1.0
    times = np.concatenate([[lead], t, [tail]])
    held = np.concatenate([q[:1], q, q[-1:]])
    rates = np.concatenate([np.zeros_like(q[:1]), dq, np.zeros_like(q[:1])])
    motion = CubicHermiteSpline(times, held, rates)
    integral = motion.antiderivative()
    velocity = motion.derivative()
    now, then = np.clip(at, lead, tail), np.clip(at - window, lead, tail)
    return (
        np.asarray((integral(now) - integral(then)) / window),
        np.asarray((motion(now) - motion(then)) / window),
        np.asarray((velocity(now) - velocity(then)) / window),
    )
