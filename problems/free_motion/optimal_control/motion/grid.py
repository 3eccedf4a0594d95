"""The grid in scaled time: intervals, the legs that they belong to, and how they may stretch."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .....core.arrays import FloatArray, IntArray


@dataclass(frozen=True)
class Grid:
    """K intervals that share the duration.

    Intervals of one group keep their proportions; each group's stretch is a variable, unless there
    is only one. So one group is a fixed grid in scaled time, one for each leg lets waypoints be
    passed when it suits, and one for each interval is an entirely free grid.

    Args:
        width: (K,), shares of the duration as long as all stretches are 1; they sum to 1.
        group: (K,), from 0, rising.
        leg: (K,), the leg between waypoints that each interval belongs to, rising.
    """

    width: FloatArray
    group: IntArray
    leg: IntArray

    @classmethod
    def even(cls, widths: FloatArray, leg: IntArray) -> Grid:
        """A grid with these widths (K,), scaled to a sum of 1; each leg (K,) is a group."""
        return cls(widths / widths.sum(), leg, leg)

    def __len__(self) -> int:
        return len(self.width)

    @property
    def groups(self) -> int:
        """Number of groups."""
        return int(self.group[-1]) + 1

    def split(self, parts: IntArray) -> Grid:
        """The grid with its intervals cut into ``parts`` (K,) equal ones each."""
        return Grid(
            np.repeat(self.width / parts, parts),
            np.repeat(self.group, parts),
            np.repeat(self.leg, parts),
        )

    def stretched(self, stretch: FloatArray) -> Grid:
        """The same grid with stretches (G,) taken into its widths."""
        width = self.width * stretch[self.group]
        return replace(self, width=width / width.sum())

    def freed(self, size: int) -> Grid:
        """The same intervals in groups of up to ``size`` neighbours on one leg."""
        start = np.searchsorted(self.leg, self.leg)
        inside = (np.arange(len(self)) - start) // size
        key = self.leg * (len(self) + 1) + inside
        return replace(self, group=np.unique(key, return_inverse=True)[1].astype(np.int64))
