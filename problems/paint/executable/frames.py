"""Frames of the gun along a trajectory, z along the nozzle."""

from __future__ import annotations

import numpy as np

from ....core.arrays import FloatArray
from ....core.spatial.rotation import matrix_from_rotation_vector
from ..spray.trajectory import PaintTrajectory


def gun_frames(trajectory: PaintTrajectory) -> FloatArray:
    """(W, 3, 3) rotations whose z axis is the nozzle's direction.

    x is along the fan where there is one. Else it is carried along without turning about the
    nozzle: what turns the gun from one waypoint to the next is the shortest rotation.
    """
    z = trajectory.nozzle
    frames = np.empty((len(z), 3, 3))
    if trajectory.fan is not None:
        for w in range(len(z)):
            frames[w] = _framed(z[w], trajectory.fan[w])
        return frames
    frames[0] = _framed(z[0], np.eye(3)[int(np.argmin(np.abs(z[0])))])
    for w in range(1, len(z)):
        axis = np.cross(z[w - 1], z[w])
        sine, cosine = float(np.linalg.norm(axis)), float(z[w - 1] @ z[w])
        factor = np.arctan2(sine, cosine) / sine if sine > 1e-12 else 1.0
        x = matrix_from_rotation_vector(factor * axis) @ frames[w - 1][:, 0]
        frames[w] = _framed(z[w], x)
    return frames


def turned(frames: FloatArray, turns: FloatArray) -> FloatArray:
    """Frames (W, 3, 3) turned about their own z axes by angles (W,) rad."""
    axis = np.zeros((len(turns), 3))
    axis[:, 2] = turns
    return np.asarray(frames @ matrix_from_rotation_vector(axis))


def _framed(z: FloatArray, x: FloatArray) -> FloatArray:
    """The frame with z as it is and x as near to what is given as can be."""
    y = np.cross(z, x)
    y /= np.linalg.norm(y)
    return np.stack([np.cross(y, z), y, z], axis=1)
