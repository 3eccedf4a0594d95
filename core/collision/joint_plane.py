"""Two joints of a robot varied in its cell, the others held: where it is free, and where it is not.

A point of the plane is a posture of the arm, an obstacle becomes the region of the postures that
touch it, and a path is a curve that keeps out of that: the configuration space of T. Lozano-Pérez,
"Spatial Planning: A Configuration Space Approach" (IEEE Trans. Computers C-32(2), 1983), drawn for
two joints as in figure 3.3 of D. Gleeson, "Trajectory Optimization including Robot Controller
Emulation" (thesis, Chalmers 2025).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from .scene.scene import CollisionScene

_BEYOND = 0.05
"""m beyond the clearance that is looked at, so that the edges of regions are smooth."""


@dataclass(frozen=True, eq=False)
class JointPlane:
    """How near the arm comes, over a grid of two joints.

    Args:
        axes: indices of the two joints.
        held: (N,) rad or m, where all others stand.
        first, second: (G,) and (H,), values of the two.
        distance: (H, G) m, the least, negative where bodies overlap; what is much farther than the
            clearance counts as the farthest that was looked at.
        clearance: m that is to be kept.
    """

    axes: tuple[int, int]
    held: FloatArray
    first: FloatArray
    second: FloatArray
    distance: FloatArray
    clearance: float

    @property
    def free(self) -> float:
        """Share of the plane in which nothing touches."""
        return float((self.distance > 0.0).mean())


def joint_plane(
    scene: CollisionScene,
    held: FloatArray,
    axes: tuple[int, int],
    window: FloatArray,
    steps: int,
    clearance: float,
) -> JointPlane:
    """Measure a plane of two joints.

    Args:
        scene: the cell with the tool.
        held: (N,) rad or m.
        axes: indices of the joints that vary.
        window: (2, 2), lower and upper end of each.
        steps: values of each joint.
        clearance: m that is to be kept.
    """
    first, second = (np.linspace(low, high, steps) for low, high in window)
    q = np.tile(held, (steps * steps, 1))
    q[:, axes[0]] = np.tile(first, steps)
    q[:, axes[1]] = np.repeat(second, steps)
    least = scene.clearance(q, clearance + _BEYOND).reshape(steps, steps)
    return JointPlane(axes, held, first, second, least, clearance)
