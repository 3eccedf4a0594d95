"""A posture in which an arm can begin whatever it does: in front of its base, flange down."""

from __future__ import annotations

import math
from contextlib import suppress

import numpy as np

from ..arrays import FloatArray
from ..errors import FlybyError
from .kinematics.chain_kernels import jacobians, poses
from .model import Robot
from .posture import elbow_height

_AHEAD = (0.45, 0.55, 0.35, 0.65)
_ABOVE = (0.3, 0.1, 0.5, 0.0)
"""Places of the flange that are tried, as shares of the arm's length."""
_DOWN = [
    np.array([[c, s, 0.0], [s, -c, 0.0], [0.0, 0.0, -1.0]])
    for c, s in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))
]
"""The flange looking down, turned by quarters."""
_GOOD = 2.0
"""Times the least condition number that will do."""


def ready_posture(robot: Robot) -> tuple[float, ...] | None:
    """A configuration (N,) far from singularities, external axes as near zero as can be.

    The flange is in front of the base and looks against the base's z axis. Of the solutions whose
    Jacobian, lengths in units of the arm's, has a condition number of twice the least at most, and
    whose elbow is above, the one is taken with its joints nearest to zero, in whole degrees.

    Returns:
        None where the arm reaches none of the places that are tried.
    """
    size, limits = robot.arm_size, robot.limits
    external = np.clip(0.0, limits.lower[size:], limits.upper[size:])
    length = sum(math.hypot(*robot.joints[k].step.position) for k in robot.along[1:])
    R, p = poses(robot.base_chain, np.concatenate([np.zeros(size), external])[None])
    for above in _ABOVE:
        for ahead in _AHEAD:
            place = p[0] + R[0] @ (ahead * length, 0.0, above * length)
            found = _best(robot, [(R[0] @ down, place) for down in _DOWN], length, external)
            if found is not None:
                return found
    return None


def _best(
    robot: Robot, places: list[tuple[FloatArray, FloatArray]], length: float, external: FloatArray
) -> tuple[float, ...] | None:
    """The solution that is far enough from singularities and nearest to zero."""
    found: list[FloatArray] = []
    for rotation, position in places:
        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = rotation, position
        with suppress(FlybyError):
            found += [one.q for one in robot.inverse(frame, tuple(map(float, external)))]
    if not found:
        return None
    q = np.stack(found)
    scale = np.array([length] * 3 + [1.0] * 3)[:, None]
    conditions = np.linalg.cond(jacobians(robot.arm_chain, q) / scale)
    q = q[conditions <= _GOOD * conditions.min()]
    above = [(elbow_height(robot, one) or 0.0) >= 0.0 for one in q]
    q = q[above] if any(above) else q
    best = q[int(np.argmin(np.abs(q).sum(axis=1)))]
    whole = np.radians(np.round(np.degrees(best)))
    lower, upper = robot.limits.lower[: len(best)], robot.limits.upper[: len(best)]
    return tuple(float(value) + 0.0 for value in (*np.clip(whole, lower, upper), *external))
