"""Draws a log beside its emulation: corners, deviation along the path, speed over time."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..core.motion.controller import Run
from ..core.robot.model import Robot
from ..identification.alignment import Alignment
from ..identification.logs import CleanLog
from ..identification.residuals import Residuals
from .plot import DPI, NOMINAL, STYLE, ZONE
from .plot_geometry import PathGeometry, path_geometry, tcp_speed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FloatArray = NDArray[np.float64]

LOGGED, EMULATED = "#b3261e", "#1f4e9c"
MOST_CORNERS = 4
AROUND = 1.4
"""Zone radii around a corner that are drawn."""
SPAN = 5
"""Samples over which the log's speed is taken: stamps of single ones are rounded, or come late."""


def draw_comparison(
    run: Run,
    robot: Robot,
    log: CleanLog,
    alignment: Alignment,
    found: Residuals,
    kind: str,
) -> bytes:
    """A figure as a file of the kind ``png``, ``pdf`` or ``svg``."""
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(15, 11), layout="constrained")
        halves: Any = figure.subfigures(2, 1, height_ratios=(1.0, 1.5))
        corners, below = halves
        _draw_corners(corners, run, path_geometry(run, robot), found)
        place, joints, speed = below.subplots(3, 1)
        _draw_deviation(place, joints, robot, found)
        _draw_speed(speed, run, log, alignment, found)
        figure.suptitle(
            f"{run.program.name} on {robot.name}: log and emulation",
            x=0.01,
            ha="left",
            fontweight="bold",
        )
        buffer = io.BytesIO()
        figure.savefig(buffer, format=kind, dpi=DPI)
    return buffer.getvalue()


def _draw_corners(figure: Any, run: Run, geometry: PathGeometry, found: Residuals) -> None:
    """The corners where the log strays most; without corners the whole path."""
    chosen = _worst_corners(run, geometry, found)
    axes = np.atleast_1d(figure.subplots(1, max(len(chosen), 1)))
    if not chosen:
        first, second = np.argsort(-np.ptp(run.trajectory.position, axis=0))[:2]
        view = np.eye(3)[[first, second]]
        _draw_paths(axes[0], np.zeros(3), view, run.trajectory.position, found.tcp)
        axes[0].set_title("path of the TCP, mm")
    for corner, one in zip(chosen, axes, strict=False):
        _draw_corner(one, corner, run, geometry, found)
    handles, labels = axes[0].get_legend_handles_labels()
    axes[0].legend(handles, labels, loc="best")


def _worst_corners(run: Run, geometry: PathGeometry, found: Residuals) -> list[int]:
    """Waypoints with zones, passed with the tool of the first move, by falling deviation nearby."""
    tool = run.program.moves[0].tool
    if not tool.robot_held:
        return []
    worst: list[tuple[float, int]] = []
    for waypoint in range(1, len(geometry.waypoints) - 1):
        radius = geometry.radius[waypoint]
        driven = run.program.moves[run.path.route.moves[waypoint - 1]].tool == tool
        away = np.linalg.norm(found.tcp - geometry.waypoints[waypoint], axis=1)
        inside = away < AROUND * radius
        if radius > 0 and driven and inside.any():
            worst.append((float(found.path[inside].max()), waypoint))
    return sorted(waypoint for _, waypoint in sorted(worst, reverse=True)[:MOST_CORNERS])


def _draw_corner(
    axes: Axes, waypoint: int, run: Run, geometry: PathGeometry, found: Residuals
) -> None:
    from matplotlib.patches import Circle

    centre, radius = geometry.waypoints[waypoint], float(geometry.radius[waypoint])
    reach = AROUND * radius
    near = _near(run.trajectory.position, centre, reach)
    view = _plane(near, centre)
    for leg in geometry.nominal:
        fine = _near(_refined(leg, radius / 20), centre, reach)
        if len(fine):
            drawn = 1e3 * (fine - centre) @ view.T
            axes.plot(*drawn.T, color=NOMINAL, linestyle=(0, (4, 3)), linewidth=0.8)
    axes.add_patch(Circle((0, 0), 1e3 * radius, facecolor="none", edgecolor=ZONE, linewidth=0.8))
    logged = _near(found.tcp, centre, reach)
    _draw_paths(axes, centre, view, near, logged)
    off = found.path[np.linalg.norm(found.tcp - centre, axis=1) < reach].max()
    move = run.path.route.moves[waypoint - 1] + 1
    axes.set_title(f"corner of move {move}: {1e3 * off:.3f} mm off")
    axes.set_xlabel("mm from the waypoint")


def _draw_paths(
    axes: Axes, centre: FloatArray, view: FloatArray, emulated: FloatArray, logged: FloatArray
) -> None:
    drawn, points = (1e3 * (path - centre) @ view.T for path in (emulated, logged))
    axes.plot(*drawn.T, color=EMULATED, linewidth=1.2, label="emulated")
    axes.plot(*points.T, ".", color=LOGGED, markersize=3, label="logged")
    axes.set_aspect("equal", adjustable="box")


def _plane(points: FloatArray, centre: FloatArray) -> FloatArray:
    """Two axes (2, 3) of the plane in which points lie best, the first from first to last."""
    _, _, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    view = np.asarray(axes[:2])
    view[0] *= np.sign((points[-1] - points[0]) @ view[0]) or 1.0
    # The waypoint above the path that cuts it.
    view[1] *= np.sign((centre - points.mean(axis=0)) @ view[1]) or 1.0
    return view


def _near(points: FloatArray, centre: FloatArray, reach: float) -> FloatArray:
    return np.asarray(points[np.linalg.norm(points - centre, axis=1) < reach])


def _refined(line: FloatArray, step: float) -> FloatArray:
    """A polyline with more points, about a step apart."""
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    count = min(int(length[-1] / step) + 2, 5000)
    at = np.linspace(0.0, length[-1], count)
    return np.stack([np.interp(at, length, column) for column in line.T], axis=-1)


def _draw_deviation(place: Axes, joints: Axes, robot: Robot, found: Residuals) -> None:
    along = 1e3 * found.arc
    place.plot(along, 1e3 * found.path, ".", color=LOGGED, markersize=2.5)
    place.set_title("log's TCP from the emulated path, mm")
    place.set_ylim(bottom=0.0)
    for axis, name in enumerate(robot.axis_names):
        off = np.degrees(found.joint_path[:, axis])
        joints.plot(along, off, ".", color=f"C{axis}", markersize=2.5, label=name)
    joints.set_title("log's joints from the emulated path, °")
    joints.set_xlabel("along the path, mm")
    joints.legend(loc="lower right", bbox_to_anchor=(1.0, 0.99), ncols=8, handlelength=1.0)


def _draw_speed(
    axes: Axes, run: Run, log: CleanLog, alignment: Alignment, found: Residuals
) -> None:
    t = found.t - alignment.offset
    span = min(SPAN, len(t) - 1)
    step = np.linalg.norm(found.tcp[span:] - found.tcp[:-span], axis=1) / (t[span:] - t[:-span])
    middle = 0.5 * (t[span:] + t[:-span])
    axes.plot(middle, 1e3 * step, ".-", color=LOGGED, markersize=2.5, linewidth=0.5, label="logged")
    axes.plot(
        run.trajectory.t, 1e3 * tcp_speed(run), color=EMULATED, linewidth=1.2, label="emulated"
    )
    for hole in log.holes:
        begin, end = hole.begin - alignment.offset, hole.end - alignment.offset
        axes.axvspan(begin, end, color="#e6e6e6", zorder=0)
    axes.set_ylim(0.0, 1.3e3 * max(float(tcp_speed(run).max()), float(np.percentile(step, 99))))
    axes.set_title("speed of the TCP, mm/s")
    axes.set_xlabel("time of the emulation, s")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.99), ncols=2)
