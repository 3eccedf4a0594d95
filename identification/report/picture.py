"""Draws a log beside its emulation: corners, deviation along the path, speed and acceleration."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.arrays import FloatArray
from ...core.robot.model import Robot
from ...drawing.geometry import PathGeometry, path_geometry
from ...drawing.style import NOMINAL, STOP, STYLE, ZONE, figure_file
from ..prediction import Prediction
from ..residuals import Residuals
from .corners import AROUND, CutCorner, cut_corners

if TYPE_CHECKING:
    from matplotlib.axes import Axes


LOGGED, EMULATED = "#b3261e", "#1f4e9c"
WIDTH = 15
"""Inches."""
CORNERS_IN_A_ROW, MOST_CORNERS = 4, 8
MAGNIFIED = 0.3
"""Zone radii that the greatest deviation in a corner is drawn as, about."""
MOST_POINTS = 400
"""Of a path in a corner, where its deviation is drawn."""
SPAN = 9
"""Samples over which the log's speed and acceleration are taken."""


def draw_prediction(prediction: Prediction, kind: str) -> bytes:
    """A figure as a file of the kind ``png``, ``pdf`` or ``svg``."""
    import matplotlib
    from matplotlib.figure import Figure

    robot, found = prediction.robot, prediction.residuals
    geometry = path_geometry(prediction.driven, robot)
    corners = cut_corners(prediction, geometry)
    rows = -(-min(max(len(corners), 1), MOST_CORNERS) // CORNERS_IN_A_ROW)
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH, 3.6 * rows + 8.0), layout="constrained")
        halves: Any = figure.subfigures(2, 1, height_ratios=(3.6 * rows, 8.0))
        above, below = halves
        if corners:
            _draw_corners(above, rows, corners, prediction, geometry)
        else:
            _draw_whole_path(above.subplots(), prediction, geometry)
        place, joints, speed, acceleration = below.subplots(4, 1)
        _draw_deviation(place, joints, robot, found)
        _draw_profiles(speed, acceleration, prediction)
        figure.suptitle(
            f"{prediction.name} on {robot.name}: log and emulation",
            x=0.01,
            ha="left",
            fontweight="bold",
        )
        return figure_file(figure, kind)


def _draw_corners(
    figure: Any,
    rows: int,
    corners: list[CutCorner],
    prediction: Prediction,
    geometry: PathGeometry,
) -> None:
    """The corners where the log deviates most."""
    worst = sorted(corners, key=lambda corner: -corner.off)[:MOST_CORNERS]
    columns = -(-len(worst) // rows)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for one in axes[len(worst) :]:
        one.set_axis_off()
    for corner, one in zip(sorted(worst, key=lambda c: c.waypoint), axes, strict=False):
        _draw_corner(one, corner, prediction, geometry)
    axes[0].legend(loc="best")
    if len(corners) > len(worst):
        figure.suptitle(
            f"the {len(worst)} of {len(corners)} corners where the log deviates most", fontsize=9
        )


def _draw_whole_path(axes: Axes, prediction: Prediction, geometry: PathGeometry) -> None:
    made = prediction.residuals.line
    across = np.argsort(-np.ptp(made, axis=0))[:2]
    _draw_paths(axes, np.zeros(3), np.eye(3)[across], made, prediction.residuals.tcp)
    stops = 1e3 * geometry.waypoints[:, across]
    axes.plot(*stops.T, "s", color=STOP, fillstyle="none", markersize=5, label="waypoints")
    axes.set_title("path of the TCP")
    axes.set_xlabel(f"{'xyz'[across[0]]}, mm")
    axes.set_ylabel(f"{'xyz'[across[1]]}, mm")
    axes.legend(loc="best")


def _draw_corner(
    axes: Axes, corner: CutCorner, prediction: Prediction, geometry: PathGeometry
) -> None:
    from matplotlib.patches import Circle

    centre, radius = geometry.waypoints[corner.waypoint], corner.radius
    reach = AROUND * radius
    driven = prediction.residuals.line
    near, further = (_near(driven, centre, far) for far in (reach, 1.1 * reach))
    logged = _near(prediction.residuals.tcp, centre, reach)
    view = _plane(near, centre)
    for leg in geometry.nominal:
        fine = _near(_refined(leg, radius / 20), centre, reach)
        if len(fine):
            drawn = 1e3 * (fine - centre) @ view.T
            axes.plot(*drawn.T, color=NOMINAL, linestyle=(0, (4, 3)), linewidth=0.8)
    axes.add_artist(Circle((0, 0), 1e3 * radius, facecolor="none", edgecolor=ZONE, linewidth=0.8))
    _draw_paths(axes, centre, view, near, logged)
    times = _draw_magnified(axes, centre, view, further, logged, MAGNIFIED * radius)
    thin = f" (thin: × {times:g})" if times > 1 else ""
    axes.set_title(f"corner of move {corner.move + 1}: {1e3 * corner.off:.3f} mm off{thin}")
    axes.set_xlabel("mm from the waypoint")
    axes.set_ylabel("mm")


def _draw_paths(
    axes: Axes, centre: FloatArray, view: FloatArray, emulated: FloatArray, logged: FloatArray
) -> None:
    drawn, points = (1e3 * (path - centre) @ view.T for path in (emulated, logged))
    axes.plot(*drawn.T, color=EMULATED, linewidth=1.2, zorder=3, label="emulated")
    axes.plot(*points.T, ".", color=LOGGED, markersize=3, label="logged")
    # The whole frame is used, with one scale in both directions.
    axes.set_aspect("equal", adjustable="datalim")


def _draw_magnified(
    axes: Axes,
    centre: FloatArray,
    view: FloatArray,
    emulated: FloatArray,
    logged: FloatArray,
    size: float,
) -> float:
    """The log as it would be if it were so many times as far from the emulation; how many."""
    path = emulated[:: -(-len(emulated) // MOST_POINTS)]
    points = logged[:: -(-len(logged) // MOST_POINTS)]
    if len(path) < 2:
        return 1.0
    feet = _nearest(points, path)
    off = float(np.linalg.norm(points - feet, axis=1).max())
    times = _round_factor(size / max(off, 1e-7))
    if times > 1:
        drawn = 1e3 * (feet + times * (points - feet) - centre) @ view.T
        axes.plot(*drawn.T, color=LOGGED, linewidth=0.7, alpha=0.7)
    return times


def _nearest(points: FloatArray, line: FloatArray) -> FloatArray:
    """The points (K, 3) of a polyline (P, 3) that are nearest to points (K, 3)."""
    steps = np.diff(line, axis=0)
    away = points[:, None] - line[None, :-1]
    share = np.einsum("kpx,px->kp", away, steps) / np.maximum((steps**2).sum(axis=1), 1e-18)
    at = np.clip(share, 0.0, 1.0)[..., None] * steps
    best = ((away - at) ** 2).sum(axis=2).argmin(axis=1)
    return np.asarray(line[best] + at[np.arange(len(points)), best])


def _round_factor(value: float) -> float:
    """The greatest of 1, 2, 5, 10, 20, … that is no greater; at most a million."""
    power = 10.0 ** math.floor(math.log10(min(max(value, 1.0), 1e6)))
    return max(step * power for step in (1, 2, 5) if step * power <= max(value, 1.0))


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
    # Seen as the log is: over as many samples, as far apart.
    at = np.arange(0.0, made.t[-1], np.median(np.diff(found.t)))
    tcp = np.stack([np.interp(at, made.t, column) for column in found.line.T], axis=-1)
    at, emulated_speed, emulated = tcp_profiles(at, tcp)
    for axes, log, ours, unit, scale in (
        (speed, logged_speed, emulated_speed, "speed of the TCP, mm/s", 1e3),
        (acceleration, logged_acceleration, emulated, "acceleration of the TCP, m/s²", 1.0),
    ):
        axes.plot(t, scale * log, ".-", color=LOGGED, markersize=2.5, linewidth=0.5, label="logged")
        axes.plot(at, scale * ours, color=EMULATED, linewidth=1.2, label="emulated")
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
