"""Draws a log beside its emulation: corners, deviation along the path, speed and acceleration."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...core.motion.controller import Run
from ...core.robot.model import Robot
from ...drawing.geometry import PathGeometry, path_geometry, tcp_speed
from ...drawing.style import DPI, NOMINAL, STYLE, ZONE
from ..prediction import Prediction
from ..residuals import Residuals
from .corners import AROUND, CutCorner, cut_corners

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FloatArray = NDArray[np.float64]

LOGGED, EMULATED = "#b3261e", "#1f4e9c"
MOST_CORNERS = 4
SPAN = 9
"""Samples over which the log's speed and acceleration are taken."""


def draw_prediction(prediction: Prediction, kind: str) -> bytes:
    """A figure as a file of the kind ``png``, ``pdf`` or ``svg``."""
    import matplotlib
    from matplotlib.figure import Figure

    robot, found = prediction.robot, prediction.residuals
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(15, 13), layout="constrained")
        halves: Any = figure.subfigures(2, 1, height_ratios=(1.0, 2.0))
        corners, below = halves
        _draw_corners(corners, prediction)
        place, joints, speed, acceleration = below.subplots(4, 1)
        _draw_deviation(place, joints, robot, found)
        _draw_profiles(speed, acceleration, prediction)
        figure.suptitle(
            f"{prediction.name} on {robot.name}: log and emulation",
            x=0.01,
            ha="left",
            fontweight="bold",
        )
        buffer = io.BytesIO()
        figure.savefig(buffer, format=kind, dpi=DPI)
    return buffer.getvalue()


def _draw_corners(figure: Any, prediction: Prediction) -> None:
    """The corners where the log strays most; without corners the whole path."""
    run, found = prediction.driven, prediction.residuals
    geometry = path_geometry(run, prediction.robot)
    worst = sorted(cut_corners(prediction, geometry), key=lambda corner: -corner.off)
    chosen = sorted(worst[:MOST_CORNERS], key=lambda corner: corner.waypoint)
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


def _draw_corner(
    axes: Axes, corner: CutCorner, run: Run, geometry: PathGeometry, found: Residuals
) -> None:
    from matplotlib.patches import Circle

    centre, radius = geometry.waypoints[corner.waypoint], corner.radius
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
    axes.set_title(f"corner of move {corner.move + 1}: {1e3 * corner.off:.3f} mm off")
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


def _draw_profiles(speed: Axes, acceleration: Axes, prediction: Prediction) -> None:
    found, offset = prediction.residuals, prediction.alignment.offset
    t, logged_speed, logged_acceleration = tcp_profiles(found.t - offset, found.tcp)
    made = prediction.driven.trajectory
    emulated_speed = tcp_speed(prediction.driven)
    velocity = np.gradient(made.position, made.t, axis=0)
    emulated = np.linalg.norm(np.gradient(velocity, made.t, axis=0), axis=1)
    for axes, log, ours, unit, scale in (
        (speed, logged_speed, emulated_speed, "speed of the TCP, mm/s", 1e3),
        (acceleration, logged_acceleration, emulated, "acceleration of the TCP, m/s²", 1.0),
    ):
        axes.plot(t, scale * log, ".-", color=LOGGED, markersize=2.5, linewidth=0.5, label="logged")
        axes.plot(made.t, scale * ours, color=EMULATED, linewidth=1.2, label="emulated")
        for hole in prediction.log.holes:
            axes.axvspan(hole.begin - offset, hole.end - offset, color="#e6e6e6", zorder=0)
        axes.set_ylim(0.0, 1.3 * scale * max(float(ours.max()), float(np.percentile(log, 99))))
        axes.set_title(unit)
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.99), ncols=2)
    acceleration.set_xlabel("time of the emulation, s")


def tcp_profiles(t: FloatArray, tcp: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Times, speeds in m/s and accelerations in m/s² (K − `SPAN` + 1,) of positions (K, 3).

    Of the parabola that suits `SPAN` neighbouring samples best: differences of single ones are
    ruled by how stamps are rounded, or late.
    """
    span = min(SPAN, len(t))
    if span < 3:
        return t, np.zeros(len(t)), np.zeros(len(t))
    times = np.lib.stride_tricks.sliding_window_view(t, span)
    points = np.lib.stride_tricks.sliding_window_view(tcp, span, axis=0).swapaxes(1, 2)
    middle = times.mean(axis=1)
    away = (times - middle[:, None])[..., None] ** np.arange(3)
    fitted = np.linalg.pinv(away) @ (points - points[:, :1])
    speed, acceleration = (np.linalg.norm(fitted[:, k], axis=1) for k in (1, 2))
    return middle, speed, 2.0 * acceleration
