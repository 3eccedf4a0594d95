"""What a user may say about the first curve."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from ....core.errors import InputError
from ...checks import not_negative, positive

Direction = tuple[float, float, float]


class Method(StrEnum):
    """How sweeps are laid on the surface."""

    RASTER = "raster"
    """Parallel lines in a plane, projected (section IV-A)."""
    SIDEWAYS = "sideways"
    """One projected line, walked sideways over the surface (section IV-C)."""


class Gun(StrEnum):
    """Whether it paints."""

    ON = "on"
    OFF = "off"


class Coats(StrEnum):
    """How many coats of sweeps."""

    ONE = "one"
    CROSSED = "crossed"
    """Two, the second at right angles to the first, the gun off on the way between them."""


@dataclass(frozen=True)
class SweepPlan:
    """Sweeps over a part.

    Args:
        sweep_width: m between neighbouring sweeps, w_sweep of the paper.
        distance: m from the surface to the TCP.
        speed: m/s of the TCP, everywhere.
        longest_segment: m, d_max: no segment is longer, and none shorter than half of it unless at
            a sweep's end.
        overhang: m, d_edgeMax: how far sweeps go on beyond the edge of the surface.
        edge_offset: m, d_edgeOffset: normals are not taken nearer to the edge than this; None for a
            sixth of the sweep width.
        smoothing_radius: m, r_cyl: normals are averaged over this radius; None for a quarter of the
            sweep width.
        hole_size: m; holes up to this size are painted over as if they were not there; None for the
            sweep width.
        method: see `Method`.
        view: direction in which the gun looks at the part, the normal of the paper's plane P; None
            for against the mean normal of what is painted.
        heading: direction of the sweeps, seen along the view; None for the longer side of the
            smallest rectangle round the part. Crossed coats begin with it.
        coats: one, or two at right angles; each of two lays half of the paint, at twice the speed.
        turns: whether the gun paints between sweeps.
        gaps: whether it paints where a sweep crosses what is no surface: wider than the overhang.

    Raises:
        InputError: a number out of its range.
    """

    sweep_width: float
    distance: float = 0.25
    speed: float = 0.25
    longest_segment: float = 0.1
    overhang: float = 0.1
    edge_offset: float | None = None
    smoothing_radius: float | None = None
    hole_size: float | None = None
    method: Method = Method.SIDEWAYS
    view: Direction | None = None
    heading: Direction | None = None
    coats: Coats = Coats.ONE
    turns: Gun = Gun.ON
    gaps: Gun = Gun.ON

    def __post_init__(self) -> None:
        for name in ("sweep_width", "distance", "speed", "longest_segment"):
            positive(f"SweepPlan.{name}", getattr(self, name))
        for name in ("overhang", "edge_offset", "smoothing_radius", "hole_size"):
            if getattr(self, name) is not None:
                not_negative(f"SweepPlan.{name}", getattr(self, name))
        for name in ("view", "heading"):
            value = getattr(self, name)
            if value is not None and not 0.0 < float(np.linalg.norm(value)) < math.inf:
                raise InputError(f"SweepPlan.{name} must be a direction, not {value}")

    @property
    def offset(self) -> float:
        """m: d_edgeOffset."""
        return self.sweep_width / 6.0 if self.edge_offset is None else self.edge_offset

    @property
    def smoothing(self) -> float:
        """m: r_cyl."""
        return self.sweep_width / 4.0 if self.smoothing_radius is None else self.smoothing_radius

    @property
    def holes(self) -> float:
        """m: size of holes that are painted over."""
        return self.sweep_width if self.hole_size is None else self.hole_size
