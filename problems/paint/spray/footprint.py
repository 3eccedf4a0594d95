"""The footprint: how fast paint grows on a flat plate under a gun that stands still.

The gun is a point source behind the TCP that sends paint into a cone. On the plane at the reference
distance, square to the nozzle, the coat grows at f(r); elsewhere the cone's rays carry the same
paint (D. Gleeson et al., "Generating Optimized Trajectories for Robotic Spray Painting", IEEE
Transactions on Automation Science and Engineering 19(3), 2022, section V-B).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from ....core.arrays import FloatArray
from ....core.errors import InputError


@dataclass(frozen=True, eq=False)
class Footprint:
    """A profile f(r), and the cone that projects it.

    f is the cubic Hermite spline through ``knots``, ``values`` and ``slopes``: continuous with its
    first derivative, flat at the centre, and flat and zero at the rim. With an ``aspect`` a the
    radius is r = √(x² + a² y²), x along the fan's long axis.

    Args:
        knots: (k,) radii at the reference distance, m, from 0 to the rim R; k >= 2.
        values: (k,) growth of the coat at nominal flow, m/s.
        slopes: (k,) its derivative by r, 1/s.
        reference_distance: of the plane from the TCP, m.
        source_distance: of the point source behind the TCP, m.
        aspect: long axis over short axis of the footprint, >= 1.

    Raises:
        InputError: knots that do not rise from 0, a profile that is negative somewhere, not flat
            at the centre, or not flat and zero at the rim; distances that leave no cone.
    """

    knots: FloatArray
    values: FloatArray
    slopes: FloatArray
    reference_distance: float
    source_distance: float
    aspect: float = 1.0

    def __post_init__(self) -> None:
        arrays = {}
        for name in ("knots", "values", "slopes"):
            array = np.array(getattr(self, name), dtype=np.float64)
            if array.ndim != 1 or len(array) < 2 or not np.isfinite(array).all():
                raise InputError(f"{name}: expected at least two finite numbers")
            arrays[name] = array
        knots, values, slopes = arrays["knots"], arrays["values"], arrays["slopes"]
        if not len(knots) == len(values) == len(slopes):
            raise InputError("knots, values and slopes: expected equally many")
        if knots[0] != 0.0 or not (np.diff(knots) > 0.0).all():
            raise InputError("knots: expected radii that rise from 0")
        if slopes[0] != 0.0 or slopes[-1] != 0.0 or values[-1] != 0.0:
            raise InputError("a footprint is flat at the centre, and flat and zero at the rim")
        if not values.max() > 0.0:
            raise InputError("values: expected one above zero")
        if not (math.isfinite(self.aspect) and self.aspect >= 1.0):
            raise InputError(f"aspect: expected a number >= 1, not {self.aspect!r}")
        source = self.source_distance + self.reference_distance
        if not (math.isfinite(source) and source > 0.0 and self.reference_distance > 0.0):
            raise InputError("the plane of reference has to lie before the TCP and the source")
        for name, array in arrays.items():
            array.flags.writeable = False
            object.__setattr__(self, name, array)
        lowest = float(self(np.linspace(0.0, self.radius, 1001)).min())
        if lowest < -1e-6 * values.max():
            raise InputError(f"the profile falls to {lowest:g} m/s: paint cannot be taken away")

    @classmethod
    def of_cone(
        cls,
        knots: ArrayLike,
        values: ArrayLike,
        reference_distance: float,
        near_radius: float,
        near_distance: float = 0.0,
        *,
        slopes: ArrayLike | None = None,
        aspect: float = 1.0,
    ) -> Self:
        """A footprint whose cone is given by two circles: the rim at the reference distance, and a
        nearer one.

        Args:
            knots, values: as of the class.
            reference_distance: m from the TCP.
            near_radius: of the cone at ``near_distance``, m.
            near_distance: m from the TCP.
            slopes: as of the class; None for zero at every knot, as at peaks.
            aspect: as of the class.

        Raises:
            InputError: as the class, and for a cone that does not widen.
        """
        radii = np.asarray(knots, dtype=np.float64)
        rim = float(radii[-1])
        if not math.isfinite(reference_distance):
            raise InputError(f"reference_distance: a finite number, not {reference_distance!r}")
        if not (reference_distance > near_distance and rim > near_radius > 0.0):
            raise InputError(
                f"the cone has to widen: radius {near_radius:g} m at {near_distance:g} m, "
                f"{rim:g} m at {reference_distance:g} m"
            )
        opening = (rim - near_radius) / (reference_distance - near_distance)
        return cls(
            radii,
            np.asarray(values, dtype=np.float64),
            np.zeros(len(radii)) if slopes is None else np.asarray(slopes, dtype=np.float64),
            reference_distance,
            near_radius / opening - near_distance,
            aspect,
        )

    @property
    def radius(self) -> float:
        """R of the rim at the reference distance along the long axis, m."""
        return float(self.knots[-1])

    @property
    def reach(self) -> float:
        """Distance of the plane of reference from the source, m."""
        return self.source_distance + self.reference_distance

    @property
    def rate(self) -> float:
        """Volume that leaves the gun, and arrives on a plane that meets the whole cone, m³/s.

        It is ∫ f(r) 2πr dr over the aspect, in closed form.
        """
        width = np.diff(self.knots)
        powers = np.arange(4)
        first = (self.coefficients * width[:, None] ** (powers + 2) / (powers + 2)).sum(axis=1)
        zeroth = (self.coefficients * width[:, None] ** (powers + 1) / (powers + 1)).sum(axis=1)
        moment = float((first + self.knots[:-1] * zeroth).sum())
        return 2.0 * math.pi * moment / self.aspect

    @property
    def coefficients(self) -> FloatArray:
        """(k-1, 4) of each piece in powers 0 to 3 of the distance from its first knot."""
        h = np.diff(self.knots)
        rise = np.diff(self.values) / h
        first, last = self.slopes[:-1], self.slopes[1:]
        return np.stack(
            (
                self.values[:-1],
                first,
                (3.0 * rise - 2.0 * first - last) / h,
                (first + last - 2.0 * rise) / h**2,
            ),
            axis=1,
        )

    def __call__(self, r: ArrayLike) -> FloatArray:
        """f at radii of any shape, m/s; 0 beyond the rim."""
        radii = np.asarray(r, dtype=np.float64)
        piece = np.searchsorted(self.knots[1:-1], radii, side="right")
        t = radii - self.knots[piece]
        c = self.coefficients[piece]
        value = c[..., 0] + t * (c[..., 1] + t * (c[..., 2] + t * c[..., 3]))
        return np.where(radii < self.radius, value, 0.0)

    def scaled(self, factor: float) -> Self:
        """The footprint of another nominal flow."""
        if not (math.isfinite(factor) and factor > 0.0):
            raise InputError(f"factor: expected a number above zero, not {factor!r}")
        return replace(self, values=self.values * factor, slopes=self.slopes * factor)

    def with_height_error(self, error: float) -> Self:
        """What arrives where the gun is farther away than it is thought to be.

        Args:
            error: m along the nozzle; negative for nearer.
        """
        return replace(
            self,
            source_distance=self.source_distance + error,
            reference_distance=self.reference_distance - error,
        )

    def with_radius_error(self, error: float) -> Self:
        """The same paint spread wider.

        Args:
            error: share by which all radii are larger; negative for smaller.
        """
        wider = 1.0 + error
        return replace(
            self,
            knots=self.knots * wider,
            values=self.values / wider**2,
            slopes=self.slopes / wider**3,
        )


def ring(
    radius: float,
    *,
    centre: float = 0.1,
    peak_at: float = 0.6,
    peak: float = 1.0,
    reference_distance: float = 0.25,
    near_radius: float = 0.035,
) -> Footprint:
    """The ring of a rotary bell: a dip in the centre, a peak on a circle, nothing at the rim.

    Args:
        radius: of the rim at the reference distance, m.
        centre, peak: growth there, m/s.
        peak_at: radius of the peak as a share of the rim's.
        reference_distance: m from the TCP.
        near_radius: of the cone at the TCP, m.
    """
    knots = np.array([0.0, peak_at * radius, radius])
    return Footprint.of_cone(knots, (centre, peak, 0.0), reference_distance, near_radius)
