"""The variables of an optimisation, and the trajectory that they stand for.

Five numbers a waypoint, its position and two angles, then one a segment, its duration. The nozzle
is the unit vector along −n + t₁ θ₁ + t₂ θ₂, with n the surface's normal and t₁, t₂ square to it:
the length of θ is the tangent of the tilt, so that a limit of the tilt is a circle, and two numbers
do where a quaternion has four, of which the spin about the nozzle would have no effect. All are
counted from a trajectory in units in which a step of 1 matters about alike.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import InputError
from ..spray.trajectory import PaintTrajectory
from .reference import ReferencePlanes

POSITION = 0.02
"""Unit of positions, m."""
ANGLE = 0.1
"""Unit of angles, rad."""
DURATION = 0.2
"""Unit of durations, as a share of what they were."""
_SQUARE = 0.1


@dataclass(frozen=True, eq=False)
class ThicknessVariables:
    """Variables z (n,) round a trajectory, at which z = 0.

    Args:
        start: the trajectory.
        reference: the surface below its waypoints.
        tangents: (W, 2, 3) unit vectors square to the normals and to each other.
        angles: (W, 2) θ at the start.
    """

    start: PaintTrajectory
    reference: ReferencePlanes
    tangents: FloatArray
    angles: FloatArray

    @classmethod
    def of(cls, start: PaintTrajectory, reference: ReferencePlanes) -> ThicknessVariables:
        """The variables round a trajectory.

        Raises:
            InputError: planes of another number, or a nozzle that does not point at the surface.
        """
        if reference.foot.shape != start.position.shape:
            raise InputError(
                f"{len(reference.foot)} planes for {len(start.position)} waypoints: one each is due"
            )
        along = -np.einsum("ij,ij->i", start.nozzle, reference.normal)
        if not (along > _SQUARE).all():
            worst = int(np.argmin(along))
            raise InputError(f"waypoint {worst + 1}: the nozzle does not point at the surface")
        tangents = _tangents(reference.normal)
        angles = np.einsum("ijk,ik->ij", tangents, start.nozzle) / along[:, None]
        return cls(start, reference, tangents, angles)

    @property
    def waypoints(self) -> int:
        """Number of waypoints, W."""
        return len(self.start.position)

    @property
    def segments(self) -> int:
        """Number of segments, S = W - 1."""
        return self.waypoints - 1

    @property
    def size(self) -> int:
        """n = 5 W + S."""
        return 5 * self.waypoints + self.segments

    @property
    def units(self) -> FloatArray:
        """(n,) what a step of 1 is, in m, rad and s."""
        waypoint = np.repeat((POSITION, ANGLE), (3, 2))
        return np.concatenate((np.tile(waypoint, self.waypoints), DURATION * self.start.duration))

    def parts(self, z: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Positions (W, 3), angles (W, 2) and durations (S,) at z."""
        moved = z * self.units
        waypoints = moved[: 5 * self.waypoints].reshape(-1, 5)
        return (
            self.start.position + waypoints[:, :3],
            self.angles + waypoints[:, 3:],
            self.start.duration + moved[5 * self.waypoints :],
        )

    def at(self, position: FloatArray, angles: FloatArray, duration: FloatArray) -> FloatArray:
        """z (n,) of positions, angles and durations."""
        moved = np.concatenate((position - self.start.position, angles - self.angles), axis=1)
        return np.concatenate((moved.ravel(), duration - self.start.duration)) / self.units

    def trajectory(self, z: FloatArray) -> PaintTrajectory:
        """The trajectory at z."""
        position, angles, duration = self.parts(z)
        nozzle, _ = self._directions(angles)
        return replace(self.start, position=position, nozzle=nozzle, duration=duration)

    def turns(self, z: FloatArray) -> FloatArray:
        """(W, 2, 3) derivatives of the nozzle by the two angles, 1/rad."""
        nozzle, length = self._directions(self.parts(z)[1])
        along = np.einsum("ijk,ik->ij", self.tangents, nozzle)
        across = self.tangents - along[:, :, None] * nozzle[:, None, :]
        return np.asarray(across / length[:, None, None])

    def _directions(self, angles: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Nozzles (W, 3), and the lengths (W,) of the vectors they were made from."""
        vectors = np.einsum("ij,ijk->ik", angles, self.tangents) - self.reference.normal
        length = np.linalg.norm(vectors, axis=1)
        return vectors / length[:, None], length


def _tangents(normal: FloatArray) -> FloatArray:
    """Two unit vectors square to each normal (W, 3) and to each other: (W, 2, 3)."""
    axis = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    first = np.cross(normal, axis)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.stack((first, np.cross(normal, first)), axis=1)
