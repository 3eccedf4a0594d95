"""Figures of a coat: how even it is, and what it cost."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import InputError
from ..spray.trajectory import PaintTrajectory
from .deposition import Deposition


@dataclass(frozen=True, slots=True)
class Spread:
    """How a thickness is spread over a surface; lengths in m, shares of 1.

    Args:
        mean, std: with the weights of the points.
        least, most: of all points.
        within_10_percent, within_5_percent: share of the weight that lies so near to the target.
    """

    mean: float
    std: float
    least: float
    most: float
    within_10_percent: float
    within_5_percent: float


@dataclass(frozen=True, eq=False)
class Coat:
    """A coat of paint on a surface.

    Args:
        thickness: (V,) m.
        areas: (V,) that each point stands for, m².
        target: wanted thickness, m.
        paint: volume that left the gun, m³.
        duration: of the motion, s.
    """

    thickness: FloatArray
    areas: FloatArray
    target: float
    paint: float
    duration: float

    def __post_init__(self) -> None:
        if not self.target > 0.0:
            raise InputError(f"target: a thickness above zero is needed, not {self.target!r} m")

    @cached_property
    def by_area(self) -> Spread:
        """Every square metre counts alike."""
        return _spread(self.thickness, self.areas, self.target)

    @cached_property
    def by_point(self) -> Spread:
        """Every point counts alike, whatever it stands for."""
        return _spread(self.thickness, np.ones(len(self.areas)), self.target)

    @property
    def deposited(self) -> float:
        """Volume on the surface, m³."""
        return float(self.areas @ self.thickness)

    @property
    def transfer_efficiency(self) -> float:
        """Share of the paint that is on the surface."""
        return self.deposited / self.paint if self.paint > 0.0 else 0.0

    @property
    def squared_error(self) -> float:
        """∫ (thickness − target)² over the surface, m⁴."""
        return float(self.areas @ (self.thickness - self.target) ** 2)

    @property
    def rms_error(self) -> float:
        """Root of the mean squared error over the surface, m; counts the mean's too."""
        return math.sqrt(self.squared_error / float(self.areas.sum()))


def coat(deposition: Deposition, trajectory: PaintTrajectory, target: float) -> Coat:
    """The coat that a trajectory leaves.

    Args:
        target: wanted thickness, m.
    """
    return Coat(
        deposition.thickness(trajectory),
        deposition.samples.areas,
        target,
        paint_used(deposition, trajectory),
        trajectory.total_duration,
    )


def paint_used(deposition: Deposition, trajectory: PaintTrajectory) -> float:
    """Volume that leaves the gun, m³."""
    return float(trajectory.duration @ trajectory.flow) * deposition.footprint.rate


def _spread(thickness: FloatArray, weights: FloatArray, target: float) -> Spread:
    weights = weights / weights.sum()
    mean = float(weights @ thickness)
    off = np.abs(thickness - target)
    # A tolerance of 1e-12 of the target: what is exactly at a limit is within it.
    slack = 1e-12 * target
    return Spread(
        mean,
        float(np.sqrt(weights @ (thickness - mean) ** 2)),
        float(thickness.min()),
        float(thickness.max()),
        max(0.0, 1.0 - float(weights[off > 0.10 * target + slack].sum())),
        max(0.0, 1.0 - float(weights[off > 0.05 * target + slack].sum())),
    )
