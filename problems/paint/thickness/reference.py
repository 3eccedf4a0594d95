"""The surface below each waypoint, from which distance and tilt of the gun are measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import InputError
from ..spray.trajectory import PaintTrajectory

_UNIT = 1e-6


@dataclass(frozen=True, eq=False)
class ReferencePlanes:
    """A plane for each waypoint: that of the surface, or of its smooth extension beyond an edge.

    Args:
        foot: (W, 3) a point on each plane, m.
        normal: (W, 3) unit vectors out of the surface.

    Raises:
        InputError: wrong shapes, or normals that are not of unit length.
    """

    foot: FloatArray
    normal: FloatArray

    def __post_init__(self) -> None:
        foot = np.array(self.foot, dtype=np.float64)
        normal = np.array(self.normal, dtype=np.float64)
        if foot.ndim != 2 or foot.shape[1] != 3 or normal.shape != foot.shape:
            raise InputError(f"foot and normal: expected (W, 3), not {foot.shape}, {normal.shape}")
        if not (np.abs(np.linalg.norm(normal, axis=1) - 1.0) <= _UNIT).all():
            raise InputError("normal: expected vectors of unit length")
        for name, value in (("foot", foot), ("normal", normal)):
            value.flags.writeable = False
            object.__setattr__(self, name, value)

    @classmethod
    def below(cls, trajectory: PaintTrajectory, distance: float) -> ReferencePlanes:
        """What lies square below the nozzle: for an initial curve that keeps its distance.

        Args:
            distance: of the TCP from the surface, m.
        """
        return cls(trajectory.position + distance * trajectory.nozzle, -trajectory.nozzle)

    def distance(self, trajectory: PaintTrajectory) -> FloatArray:
        """Distance (W,) of the TCP from the planes, m."""
        return np.asarray(np.einsum("ij,ij->i", trajectory.position - self.foot, self.normal))

    def tilt(self, trajectory: PaintTrajectory) -> FloatArray:
        """Angle (W,) of the nozzle off the planes' normals, rad."""
        along = -np.einsum("ij,ij->i", trajectory.nozzle, self.normal)
        off = np.linalg.norm(trajectory.nozzle + along[:, None] * self.normal, axis=1)
        return np.asarray(np.arctan2(off, along))
