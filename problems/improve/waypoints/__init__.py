"""Via points and zones that make a program faster: `optimize_waypoints`."""

from .optimize import optimize_waypoints
from .options import Effort, Freedom, ViaCount, WaypointTask
from .point_limits import Fixed, Free, PointBox, PointCone, PointLimit

__all__ = [
    "Effort",
    "Fixed",
    "Free",
    "Freedom",
    "PointBox",
    "PointCone",
    "PointLimit",
    "ViaCount",
    "WaypointTask",
    "optimize_waypoints",
]
