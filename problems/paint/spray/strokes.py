"""Cross sections of straight strokes: measured ones, and those that a footprint gives.

With the gun square to a plate at distance h, and s = (source + h) / (source + reference) the size
of the footprint there,

    thickness(y) = flow / (speed · s) · G(y / s),   G(η) = ∫ f(√(ξ² + η²)) dξ.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ....core.arrays import FloatArray
from ....core.errors import InputError
from ...checks import positive
from .footprint import Footprint

_NODES = 16
_THICKEST = 0.01


@dataclass(frozen=True, eq=False)
class Stroke:
    """A measured cross section of a straight stroke on a flat plate, square to the gun.

    Args:
        across: (p,) places across the stroke from anywhere, m; p >= 4, rising.
        thickness: (p,) m.
        distance: of the TCP from the plate, m.
        speed: of the TCP, m/s.
        flow: share of the nominal flow.

    Raises:
        InputError: wrong shapes or signs, no paint, or a thickness that only micrometres taken
            for metres explain.
    """

    across: FloatArray
    thickness: FloatArray
    distance: float
    speed: float
    flow: float = 1.0

    def __post_init__(self) -> None:
        across = np.array(self.across, dtype=np.float64)
        thickness = np.array(self.thickness, dtype=np.float64)
        if across.ndim != 1 or len(across) < 4 or thickness.shape != across.shape:
            raise InputError("a stroke needs at least four places and as many thicknesses")
        if not (np.isfinite(across).all() and np.isfinite(thickness).all()):
            raise InputError("a stroke's places and thicknesses have to be finite numbers")
        if not (np.diff(across) > 0.0).all():
            raise InputError("across: expected places that rise")
        if not thickness.max() > 0.0:
            raise InputError("a stroke without paint says nothing of the footprint")
        if thickness.max() > _THICKEST:
            raise InputError(
                f"a coat of {thickness.max():g} m: is it in µm? Lengths are in metres here"
            )
        for name in ("distance", "speed", "flow"):
            positive(name, getattr(self, name))
        for name, array in (("across", across), ("thickness", thickness)):
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @property
    def centre(self) -> float:
        """Centre of gravity of the section, m."""
        weights = np.maximum(self.thickness, 0.0)
        moment = float(np.trapezoid(weights * self.across, self.across))
        return moment / float(np.trapezoid(weights, self.across))

    @property
    def rate(self) -> float:
        """Volume that left the gun at nominal flow in a second, m³/s."""
        volume = float(np.trapezoid(self.thickness, self.across))
        return volume * self.speed / self.flow

    @property
    def asymmetry(self) -> float:
        """Root mean square of half the difference between the sides, as a share of the peak."""
        y = self.across - self.centre
        mirrored = np.interp(-y, y, self.thickness, left=0.0, right=0.0)
        off = 0.5 * (self.thickness - mirrored)
        return float(np.sqrt(np.mean(off**2)) / self.thickness.max())


def section(
    footprint: Footprint, across: ArrayLike, distance: float, speed: float, flow: float = 1.0
) -> FloatArray:
    """Thickness (p,) of a stroke of a symmetric footprint at places (p,) from its middle, m.

    Args:
        distance: of the TCP from the plate, m.
        speed: of the TCP, m/s.
        flow: share of the nominal flow.

    Raises:
        InputError: an elliptic footprint, whose strokes depend on how it is turned.
    """
    if footprint.aspect != 1.0:
        raise InputError("sections are of symmetric footprints only")
    size = spread(footprint, distance)
    radii, weights = chord_nodes(footprint.knots, np.asarray(across, dtype=np.float64) / size)
    return np.asarray((weights * footprint(radii)).sum(axis=1) * flow / (speed * size))


def spread(footprint: Footprint, distance: float) -> float:
    """Size of the footprint at a distance of the TCP, as a share of that at the reference."""
    return (footprint.source_distance + distance) / footprint.reach


def chord_nodes(knots: FloatArray, offset: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Radii and weights (p, q) by which functions that are smooth between knots are integrated
    along whole chords.

    Args:
        knots: (k,) radii from 0 to the rim, m.
        offset: (p,) distances of the chords from the centre, m.
    """
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    ends = np.sqrt(np.maximum(knots[None, :] ** 2 - offset[:, None] ** 2, 0.0))
    middle, half = 0.5 * (ends[:, 1:] + ends[:, :-1]), 0.5 * (ends[:, 1:] - ends[:, :-1])
    along = middle[:, :, None] + half[:, :, None] * nodes
    radii = np.sqrt(along**2 + offset[:, None, None] ** 2)
    shares = 2.0 * half[:, :, None] * weights
    return radii.reshape(len(offset), -1), shares.reshape(len(offset), -1)
