"""What a user should know about sweeps: where they leave gaps, and what they miss."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from ....core.door import spelt
from ....core.errors import Note
from ..spray.footprint import Footprint
from ..surface.part import Part
from .plan import Method, SweepPlan
from .spacing import Ripple, predicted_ripple, spacings, stroke_radius
from .sweep import Sweep

WIDE = 1.2
"""Spacing by sweep width above which sweeps have drifted apart."""
UNEVEN = 0.10
"""Predicted ripple, as a share of the mean, above which a sweep width leaves gaps."""
MISSED = 0.01
"""Share of the painted area that may be missed without a word."""
STEEPEST = np.cos(np.deg2rad(80.0))
"""Least product of the spray and the inward normal at which paint stays."""


def spacing_notes(
    part: Part, plan: SweepPlan, sweeps: list[Sweep], footprint: Footprint | None
) -> list[Note]:
    apart = spacings(sweeps)
    if len(apart) == 0 or apart.max() <= WIDE * plan.sweep_width:
        return []
    wide = f"{part.name}: sweeps are up to {1e3 * apart.max():.0f} mm apart on the surface"
    wanted = f"{1e3 * plan.sweep_width:.0f} mm are planned"
    advice = (
        "it slopes across them: use the sideways method or another heading"
        if plan.method is Method.RASTER
        else "it is curved in both directions: use another heading, or more than one coat"
    )
    uneven = ""
    if footprint is not None:
        ripple = predicted_ripple(footprint, plan.distance, float(apart.max()))
        uneven = f", which gives ±{100.0 * ripple.half_range:.0f} % there"
    return [Note(f"{wide}, where {wanted}{uneven}; {advice}")]


def ripple_notes(plan: SweepPlan, footprint: Footprint | None, ripple: Ripple | None) -> list[Note]:
    if footprint is None or ripple is None or ripple.half_range <= UNEVEN:
        return []
    width = 1e3 * plan.sweep_width
    if ripple.least <= 0.0:
        return [
            Note(
                f"sweeps {width:.0f} mm apart leave bare strips: a stroke is only "
                f"{2e3 * stroke_radius(footprint, plan.distance):.0f} mm wide; plan them closer"
            )
        ]
    return [
        Note(
            f"sweeps {width:.0f} mm apart at constant speed give a coat between "
            f"{100.0 * ripple.least:.0f} and {100.0 * ripple.most:.0f} % of its mean on a plane; "
            "plan them closer, or let the optimisation move them"
        )
    ]


def missed_area(part: Part, plan: SweepPlan, sweeps: list[Sweep]) -> float:
    """m² to paint that no waypoint is near enough to, or only at a grazing angle.

    Near enough is a sweep width, or where that is less a longest segment.
    """
    point = np.concatenate([sweep.frames.point for sweep in sweeps])
    spray = np.concatenate([sweep.frames.spray for sweep in sweeps])
    rows = np.flatnonzero(part.painted)
    reach = max(plan.sweep_width, plan.longest_segment)
    near: Any = cKDTree(point).query_ball_point(part.vertices[rows], reach)
    lengths = [len(found) for found in near]
    vertex = np.repeat(rows, lengths)
    waypoint = np.concatenate([np.asarray(found, dtype=np.int64) for found in near])
    along = -np.einsum("ij,ij->i", part.normals[vertex], spray[waypoint])
    met = np.zeros(len(part.vertices), dtype=bool)
    met[vertex[along > STEEPEST]] = True
    return float(part.areas[rows][~met[rows]].sum())


def missed_notes(part: Part, plan: SweepPlan, sweeps: list[Sweep]) -> list[Note]:
    missed = missed_area(part, plan, sweeps)
    if missed <= MISSED * part.painted_area:
        return []
    return [
        Note(
            f"{part.name}: {100.0 * missed / part.painted_area:.0f} % of what is to be painted "
            f"({missed:.3g} m²) lies round a corner or farther than a sweep width from all sweeps: "
            "paint it in a coat of its own from another view, or take it from what is painted "
            f"({spelt('facing')}, {spelt('inside')}, {spelt('covered')})"
        )
    ]
