"""How fast corners are driven that are blended in time: so that their own parameter runs evenly.

A corner that is planned as a quintic in time (`geometry.timed_blends`) is passed with s = t / T, so
that σ̇ = 1 / (T ds/dσ). Here this is a ceiling on σ̇², which meets the speeds of both legs at its
edges. Joints accelerate by more than is programmed meanwhile; their limits count `ROOM` times.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ..geometry.corners import POSITION
from ..geometry.curves import Curves, parameter_slopes, pull_parameter_slopes
from ..geometry.layout import Layout
from ..geometry.pieces import Pieces

TIMED = -5
"""What stands for a row in `limits.PathLimits.binding` where the ceiling is that of such a zone."""
ROOM = 2.5
"""What joints' limits of acceleration count in such zones: of 3000 random corners whose time is
reckoned with 1.2 times the acceleration, the greatest takes 2.4."""


@dataclass
class TimedGradient:
    """Gradient with respect to corners that are blended in time.

    Args:
        sigma: (S,), of the samples.
        window: (M − 1, 4), of the corners' curves.
        duration: (M − 1,), of T.
        blends: (M − 1, 4), of their rates and bends.
    """

    sigma: FloatArray
    window: FloatArray
    duration: FloatArray
    blends: FloatArray

    @classmethod
    def zeros(cls, samples: int, corners: int) -> TimedGradient:
        """A gradient to add to."""
        shapes = samples, (corners, 4), corners, (corners, 4)
        return cls(*(np.zeros(shape) for shape in shapes))


class TimedZones(NamedTuple):
    """The zones that are blended in time, at Q samples.

    Args:
        knot, sample, corner: (Q,) each.
        duration: (Q,) s, T.
        window: (Q, 4), of the corner's curve.
        sigma: (Q,).
        slope: (Q,), ds/dσ.
        timed: (P,) bool, pieces inside such zones.
    """

    knot: IntArray
    sample: IntArray
    corner: IntArray
    duration: FloatArray
    window: FloatArray
    sigma: FloatArray
    slope: FloatArray
    timed: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]

    @classmethod
    def of(cls, layout: Layout, pieces: Pieces, sigma: FloatArray, joint: Curves) -> TimedZones:
        """Those of a path.

        Args:
            layout, pieces: of the path.
            sigma: (S,), of its samples.
            joint: its curves of joint space.
        """
        blends = layout.corners.timed
        if not blends:
            return cls.none(len(pieces.segment))
        corners = np.array(sorted(blends), dtype=np.int64)
        timed = np.zeros(len(pieces.segment), dtype=bool)
        owner = np.zeros(len(pieces.segment), dtype=np.int64)
        extents = layout.extent[corners, POSITION]
        zones = pieces.around(layout.waypoint[corners + 1], extents)
        for i, (first, _, last) in zip(corners, zones, strict=True):
            timed[first : last + 1], owner[first : last + 1] = True, i
        piece = pieces.sample_pieces
        sample = np.flatnonzero(timed[piece])
        corner = owner[piece[sample]]
        duration = np.array([blends[int(i)].duration.value for i in corner])
        window = joint.window[len(layout.segments.scale) + corner]
        slope = parameter_slopes(window, sigma[sample])
        knot = sample - piece[sample]
        return cls(knot, sample, corner, duration, window, sigma[sample], slope, timed)

    @classmethod
    def none(cls, pieces: int) -> TimedZones:
        """Of a path of so many pieces that has no such zone."""
        index, number = np.zeros(0, dtype=np.int64), np.zeros(0)
        timed = np.zeros(pieces, dtype=bool)
        return cls(index, index, index, number, np.zeros((0, 4)), number, number, timed)

    @property
    def rate(self) -> FloatArray:
        """(Q,), σ̇ per s."""
        return 1.0 / (self.duration * self.slope)

    def lower(self, ceiling: FloatArray, binding: IntArray) -> None:
        """Lower ceilings (K + 1,) to how fast the zones are driven, noting where that binds."""
        if not len(self.knot):
            return
        x = self.rate**2
        lower = x < ceiling[self.knot]
        knot = self.knot[lower]
        ceiling[knot] = x[lower]
        binding[knot] = np.stack(
            [self.sample[lower], np.full(len(knot), TIMED), self.corner[lower]], -1
        )

    def pull(self, ceiling_bar: FloatArray, binding: IntArray, out: TimedGradient) -> None:
        """Reverse of `lower`: adds to the gradient."""
        if not len(self.knot):
            return
        bound = binding[self.knot]
        bars = np.where(
            (bound[:, 1] == TIMED) & (bound[:, 0] == self.sample), ceiling_bar[self.knot], 0.0
        )
        bars *= -2.0 * self.rate**2
        np.add.at(out.duration, self.corner, bars / self.duration)
        window_bar, sigma_bar = pull_parameter_slopes(self.window, self.sigma, bars / self.slope)
        np.add.at(out.window, self.corner, window_bar)
        out.sigma[self.sample] += sigma_bar
