"""How the tool turns along an arc: beside moves, as plugins state it before anything is driven."""

from __future__ import annotations

from enum import StrEnum


class ArcOrientation(StrEnum):
    """How the tool turns along an arc."""

    FOLLOWS_ARC = "follows_arc"
    """Turned at a constant rate relative to the arc's tangent (RAPID, KRL ``#PATH``)."""
    FIXED_FRAME = "fixed_frame"
    """Interpolated from start to end in the work object (URScript mode 0, KRL ``#BASE``)."""
