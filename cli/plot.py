"""Draws a run: the path of the TCP, its speed, and the joints against their limits."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..core.motion.controller import Run
from ..core.robot.model import Robot
from .plot_geometry import PathGeometry, path_geometry

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FloatArray = NDArray[np.float64]

DPI = 150
NUMBERED = 30
"""Waypoints up to which each is numbered."""
PATH, NOMINAL, ZONE, STOP = "#1f4e9c", "#8a8a8a", "#e08a1e", "#b3261e"
STYLE = {
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.7,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "svg.hashsalt": "flyby",
}


def draw(run: Run, robot: Robot, kind: str) -> bytes:
    """A figure of a run as a file of the kind ``png``, ``pdf`` or ``svg``."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure = make_figure(run, robot)
        buffer = io.BytesIO()
        figure.savefig(buffer, format=kind, dpi=DPI)
    return buffer.getvalue()


def make_figure(run: Run, robot: Robot) -> Figure:
    """The figure: two views of the path at the left, three curves over time at the right."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(15, 9), layout="constrained")
    left, right = figure.subfigures(1, 2, width_ratios=(1.0, 1.15))
    geometry = path_geometry(run, robot)
    upper, lower = left.subplots(2, 1, height_ratios=_heights(run))
    axes = _best_axes(run.trajectory.position)
    _draw_view(upper, run, geometry, axes[0], axes[1])
    _draw_view(lower, run, geometry, axes[0], axes[2])
    _draw_legend(left)
    speed, position, velocity = right.subplots(3, 1, sharex=True)
    _draw_speed(speed, run)
    _draw_joints(position, velocity, run, robot)
    figure.suptitle(
        f"{run.program.name} on {robot.name}: cycle time {run.duration:.3f} s",
        x=0.01,
        ha="left",
        fontweight="bold",
    )
    return figure
