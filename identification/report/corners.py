"""How far corners are cut: by the controller, and by the emulation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...drawing.geometry import PathGeometry, path_geometry
from ..corners import least_distance
from ..prediction import Prediction

AROUND = 1.4
"""Zone radii round a corner that are looked at."""


@dataclass(frozen=True)
class CutCorner:
    """One waypoint with a zone.

    Args:
        waypoint: index; the one at which the path starts is 0.
        move: index of the move that ends there.
        radius: m, of the zone as far as it reaches.
        logged, emulated: m, the least distance of the TCP from the waypoint.
        off: m, the greatest distance of the log from the emulated path nearby.
    """

    waypoint: int
    move: int
    radius: float
    logged: float
    emulated: float
    off: float


def cut_corners(prediction: Prediction, geometry: PathGeometry | None = None) -> list[CutCorner]:
    """All waypoints with zones of which the log has two samples, in the order of the path.

    Left out are those that are passed with another tool than the first move's, which is the one
    whose TCP residuals are of; none is left where it stands still.
    """
    run, found = prediction.driven, prediction.residuals
    geometry = path_geometry(run, prediction.robot) if geometry is None else geometry
    tool = run.program.moves[0].tool
    if not tool.robot_held:
        return []
    corners = []
    for waypoint in range(1, len(geometry.waypoints) - 1):
        move = run.path.route.moves[waypoint - 1]
        radius, centre = float(geometry.radius[waypoint]), geometry.waypoints[waypoint]
        inside = np.linalg.norm(found.tcp - centre, axis=1) < AROUND * radius
        if radius <= 0 or run.program.moves[move].tool != tool or np.sum(inside) < 2:
            continue
        corners.append(
            CutCorner(
                waypoint,
                move,
                radius,
                least_distance(found.tcp[inside] - centre),
                least_distance(found.line - centre),
                float(found.path[inside].max()),
            )
        )
    return corners
