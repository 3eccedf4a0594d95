"""What the moves of a run are, and which open questions runs may be about."""

from __future__ import annotations

from enum import StrEnum


class Kind(StrEnum):
    """What the moves of a run are; of mixed ones every other leg is of the second sort."""

    LINES = "lines"
    JOINTS = "joints"
    ARCS = "arcs"
    LINES_AND_JOINTS = "lines-joints"
    LINES_AND_ARCS = "lines-arcs"
    TURNS = "turns"
    """Lines along which the tool turns, otherwise before the corner than behind it."""
    LINE_STOPS = "line-stops"
    """Lines of several lengths with stops between them."""
    JOINT_STOPS = "joint-stops"
    SINGLE_AXES = "single-axes"
    """One joint after the other, as fast as the language lets it go."""
    JOINTS_AND_ARCS = "joints-arcs"
    CONTOURS = "contours"
    """Corners of joint moves, zones by shares of the contour (KRL's C_PTP)."""
    UNEQUAL_LINES = "unequal-lines"
    """Corners of lines, the second of which is slower."""
    UNEQUAL_JOINTS = "unequal-joints"
    SHORT_LEGS = "short-legs"
    """Polygons of legs that are too short for their speed."""
    POINT_TURNS = "point-turns"
    """The tool turns where its TCP stands."""
    CORNER_TURNS = "corner-turns"
    """Lines along which the tool turns, as fast as the language lets them go."""
    RESTS = "rests"
    """Lines of several lengths and directions, as fast as the language lets them go."""
    REVERSALS = "reversals"
    """One joint after the other slowly to and fro."""
    CRUISES = "cruises"
    """One of the first three joints after the other at several even speeds, at rest behind each."""

    @property
    def short(self) -> str:
        """For names of programs."""
        return _SHORT[self]

    @property
    def has_corners(self) -> bool:
        """Whether the runs pass fly-by points."""
        return self not in _STOPPING

    @property
    def reaches_speed(self) -> bool:
        """Whether zones are to be whole, and programmed speeds reached outside of them."""
        return self.has_corners and self not in (Kind.SHORT_LEGS, Kind.CORNER_TURNS)


_SHORT = {
    Kind.LINES: "line",
    Kind.JOINTS: "joint",
    Kind.ARCS: "arc",
    Kind.LINES_AND_JOINTS: "linejoint",
    Kind.LINES_AND_ARCS: "linearc",
    Kind.TURNS: "turn",
    Kind.LINE_STOPS: "stopline",
    Kind.JOINT_STOPS: "stopjoint",
    Kind.SINGLE_AXES: "axes",
    Kind.JOINTS_AND_ARCS: "jointarc",
    Kind.CONTOURS: "contour",
    Kind.UNEQUAL_LINES: "unequalline",
    Kind.UNEQUAL_JOINTS: "unequaljoint",
    Kind.SHORT_LEGS: "short",
    Kind.POINT_TURNS: "pointturn",
    Kind.CORNER_TURNS: "cornerturn",
    Kind.RESTS: "rest",
    Kind.REVERSALS: "reversal",
    Kind.CRUISES: "cruise",
}
_STOPPING = (
    *(Kind.LINE_STOPS, Kind.JOINT_STOPS, Kind.SINGLE_AXES),
    *(Kind.POINT_TURNS, Kind.RESTS, Kind.REVERSALS, Kind.CRUISES),
)
DRAGGING = 3
"""Joints, the first ones, that carry the arm, and whose drag runs are about."""
KINDS = tuple(Kind)[: list(Kind).index(Kind.SINGLE_AXES) + 1]
"""Those that a user may ask for; the others belong to a topic."""


class Topic(StrEnum):
    """An open question of the motion model."""

    SHORT_LEGS = "short-legs"
    TURNS = "turns"
    POSTURES = "postures"
    REVERSALS = "reversals"
    BLENDS = "blends"
    DRAG = "drag"
