"""Via points and zones that make a program faster: `optimize_zones`, `optimize_waypoints`."""

from .multistart import Progress
from .optimize import optimize_waypoints, optimize_zones
from .options import Effort, ViaCount, WaypointTask
from .point_limits import Box, Cone, Fixed, Free, PointLimit

__all__ = [
    "Box",
    "Cone",
    "Effort",
    "Fixed",
    "Free",
    "PointLimit",
    "Progress",
    "ViaCount",
    "WaypointTask",
    "optimize_waypoints",
    "optimize_zones",
]
