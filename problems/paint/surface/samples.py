"""The painted surface as the deposition sees it: points with normals and areas."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import InputError

_UNIT = 1e-6
_LARGEST = 50.0


@dataclass(frozen=True, eq=False)
class SurfaceSamples:
    """Points of a surface that stand for pieces of it.

    Args:
        points: (V, 3), m.
        normals: (V, 3) unit vectors that point out of the surface, towards the paint.
        areas: (V,) m² that each point stands for: a third of its triangles, say.

    Raises:
        InputError: no points, wrong shapes, numbers that are not finite, normals that are not of
            unit length, negative areas or none above zero, or a size that only millimetres taken
            for metres explain.
    """

    points: FloatArray
    normals: FloatArray
    areas: FloatArray

    def __post_init__(self) -> None:
        points = np.array(self.points, dtype=np.float64)
        if points.ndim != 2 or points.shape[1] != 3 or not len(points):
            raise InputError(f"points: expected (V, 3) with V >= 1, not {points.shape}")
        normals = np.array(self.normals, dtype=np.float64)
        areas = np.array(self.areas, dtype=np.float64)
        for name, value, shape in (
            ("points", points, points.shape),
            ("normals", normals, points.shape),
            ("areas", areas, points.shape[:1]),
        ):
            if value.shape != shape:
                raise InputError(f"{name}: expected {shape}, not {value.shape}")
            if not np.isfinite(value).all():
                raise InputError(f"{name}: {int((~np.isfinite(value)).sum())} are not finite")
        if (np.abs(np.linalg.norm(normals, axis=1) - 1.0) > _UNIT).any():
            raise InputError("normals: expected vectors of unit length")
        if (areas < 0.0).any() or not areas.any():
            raise InputError("areas: expected numbers >= 0, some of them above")
        size = float(np.ptp(points, axis=0).max())
        if size > _LARGEST:
            raise InputError(
                f"the surface is {size:g} m long: is it in millimetres? Lengths are in metres here"
            )
        for name, value in (("points", points), ("normals", normals), ("areas", areas)):
            value.flags.writeable = False
            object.__setattr__(self, name, value)

    @property
    def size(self) -> int:
        """Number of points."""
        return len(self.points)

    @property
    def area(self) -> float:
        """Of all of them, m²."""
        return float(self.areas.sum())
