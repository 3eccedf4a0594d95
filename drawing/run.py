"""Draws a run: the path of the TCP, its speed, and the joints against their limits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.arrays import FloatArray
from ..core.display import counted
from ..core.driving.driven_program import DrivenProgram
from ..core.robot.model import Robot
from .geometry import PathGeometry, part_geometry, path_geometry, tcp_speed, turning_part
from .style import LIMIT, NOMINAL, SPEED, STOP, STYLE, ZONE, figure_file

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure


NUMBERED = 30
"""Waypoints up to which each is numbered."""
LEAST_SPAN = 0.35
"""Of the box drawn in space: its shortest side over its longest."""


def draw(driven: DrivenProgram, robot: Robot, kind: str) -> bytes:
    """A figure of a driven program as a file of the kind ``png``, ``pdf`` or ``svg``."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        return figure_file(make_figure(driven, robot), kind)


def make_figure(driven: DrivenProgram, robot: Robot) -> Figure:
    """The figure: two views of the path at the left, three curves over time at the right."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(15, 9), layout="constrained")
    halves: Any = figure.subfigures(1, 2, width_ratios=(1.0, 1.15))
    left, right = halves
    runs = [part.run for part in driven.parts]
    part = turning_part(runs)
    parts = [path_geometry(run, robot) if part is None else part_geometry(run) for run in runs]
    _draw_path(left, driven, parts, "" if part is None else f" of {part}")
    speed, position, velocity = right.subplots(3, 1, sharex=True)
    _draw_speed(speed, driven, parts)
    _draw_joints(position, velocity, driven, robot)
    for axes in (speed, position, velocity):
        for begin in driven.begins[1:]:
            axes.axvline(begin, color=LIMIT, linewidth=1.4)
    velocity.set_xlabel("time, s")
    velocity.set_xlim(0.0, driven.duration)
    told = f"cycle time {driven.duration:.3f} s"
    if driven.faults:
        told = f"{driven.duration:.3f} s driven, {counted(driven.faults, 'fault')}"
    figure.suptitle(
        f"{driven.program.name} on {robot.name}: {told}",
        x=0.01,
        ha="left",
        fontweight="bold",
    )
    return figure


def _draw_path(
    figure: SubFigure, driven: DrivenProgram, parts: Sequence[PathGeometry], frame: str
) -> None:
    """The path in space above, and along an axis below, of the world or the frame that is named."""
    grid = figure.add_gridspec(2, 1, height_ratios=(1.0, 1.05), hspace=0.12)
    space = figure.add_subplot(grid[0], projection="3d")
    plane = figure.add_subplot(grid[1])
    _draw_space(space, driven, parts)
    if frame:
        space.set_title(f"path of the TCP, in the frame{frame}, which turns under it")
    view = _view(parts)
    coloured = _draw_plane(plane, driven, parts, view)
    plane.set_xlabel(f"{'xyz'[view[0]]}{frame}, mm")
    plane.set_ylabel(f"{'xyz'[view[1]]}{frame}, mm")
    bar = figure.colorbar(coloured, ax=plane, shrink=0.9, pad=0.02)
    bar.set_label("TCP speed, mm/s")
    bar.outline.set_visible(False)


def _view(parts: Sequence[PathGeometry]) -> tuple[int, int]:
    """The two axes in which most zones lie flat; without zones those of the largest spans."""
    facing = np.zeros(3)
    for geometry in parts:
        legs = np.diff(geometry.waypoints, axis=0)
        legs /= np.maximum(np.linalg.norm(legs, axis=1, keepdims=True), 1e-9)
        normals = np.abs(np.cross(legs[:-1], legs[1:]))[geometry.radius[1:-1] > 0]
        facing += normals.sum(axis=0)
    if not facing.any():
        facing = -np.ptp(np.concatenate([geometry.driven for geometry in parts]), axis=0)
    across, up = (axis for axis in range(3) if axis != int(np.argmax(facing)))
    return across, up


def _draw_space(axes: Any, driven: DrivenProgram, parts: Sequence[PathGeometry]) -> None:
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    points = 1e3 * np.concatenate([geometry.driven for geometry in parts])
    for nominal in _nominal(parts):
        axes.plot(*(1e3 * nominal.T), color=NOMINAL, linestyle=(0, (4, 3)), linewidth=0.8)
    lines = Line3DCollection(_strokes(parts, [0, 1, 2]), linewidth=1.8, cmap="viridis")
    lines.set_array(_stroke_speeds(driven, parts))
    axes.add_collection3d(lines)
    waypoints, radius = _waypoints(parts)
    stops = 1e3 * waypoints[radius == 0]
    axes.scatter(*stops.T, color=STOP, s=10, depthshade=False)
    spans = np.ptp(points, axis=0)
    spans = np.maximum(spans, LEAST_SPAN * spans.max() + 1.0)
    centre = 0.5 * (points.max(axis=0) + points.min(axis=0))
    for name, middle, span in zip("xyz", centre, spans, strict=True):
        getattr(axes, f"set_{name}lim")(middle - 0.55 * span, middle + 0.55 * span)
        getattr(axes, f"set_{name}label")(f"{name}, mm")
        getattr(axes, f"{name}axis").set_major_locator(_ticks(4 if span == spans.max() else 3))
    axes.tick_params(labelsize=7, pad=1)
    axes.set_box_aspect(spans, zoom=0.92)
    axes.set_title("path of the TCP")


def _draw_plane(
    axes: Axes, driven: DrivenProgram, parts: Sequence[PathGeometry], view: tuple[int, int]
) -> Any:
    """The path in two world axes; returns what is coloured by speed."""
    from matplotlib.collections import LineCollection, PatchCollection
    from matplotlib.lines import Line2D
    from matplotlib.patches import Circle

    for nominal in _nominal(parts):
        axes.plot(*(1e3 * nominal[:, view].T), color=NOMINAL, linestyle=(0, (4, 3)), linewidth=0.8)
    waypoints, radii = _waypoints(parts)
    passed = radii > 0
    circles = [
        Circle((float(x), float(y)), float(radius))
        for (x, y), radius in zip(
            1e3 * waypoints[passed][:, view], 1e3 * radii[passed], strict=True
        )
    ]
    axes.add_collection(
        PatchCollection(circles, facecolor=ZONE + "22", edgecolor=ZONE, linewidth=0.8)
    )
    lines = LineCollection(list(_strokes(parts, list(view))), linewidth=1.8, cmap="viridis")
    lines.set_array(_stroke_speeds(driven, parts))
    axes.add_collection(lines)
    stops = 1e3 * waypoints[~passed][:, view]
    axes.plot(*stops.T, "s", color=STOP, markersize=3.5)
    if len(waypoints) <= NUMBERED:
        _number(axes, driven, parts, view)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.08)
    handles = [
        Line2D([], [], color=NOMINAL, linestyle=(0, (4, 3)), linewidth=0.8, label="programmed"),
        Line2D([], [], color=ZONE, marker="o", markerfacecolor="none", linestyle="", label="zone"),
        Line2D([], [], color=STOP, marker="s", markersize=3.5, linestyle="", label="stop"),
    ]
    axes.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 0.99), ncols=3)
    return lines


def _number(
    axes: Axes, driven: DrivenProgram, parts: Sequence[PathGeometry], view: tuple[int, int]
) -> None:
    """Write at each target the numbers of the moves that end there."""
    ending: dict[tuple[float, ...], list[int]] = {}
    for part, geometry in zip(driven.parts, parts, strict=True):
        numbers = [part.first + move + 1 for move in part.run.path.route.moves]
        for number, point in zip(numbers, geometry.waypoints[1:], strict=True):
            ending.setdefault(tuple(np.round(1e3 * point[list(view)], 1)), []).append(number)
    for (x, y), moves in ending.items():
        axes.annotate(
            ", ".join(map(str, moves)),
            (x, y),
            xytext=(5, 5),
            textcoords="offset points",
            fontsize=8,
        )


def _nominal(parts: Sequence[PathGeometry]) -> list[FloatArray]:
    """The programmed paths of all parts."""
    return [points for geometry in parts for points in geometry.nominal]


def _waypoints(parts: Sequence[PathGeometry]) -> tuple[FloatArray, FloatArray]:
    """Waypoints (M, 3) m of all parts, and the radii (M,) m round them."""
    points = np.concatenate([geometry.waypoints for geometry in parts])
    return points, np.concatenate([geometry.radius for geometry in parts])


def _strokes(parts: Sequence[PathGeometry], axes: list[int]) -> FloatArray:
    """Straight pieces (K, 2, D) of the path in mm along some axes; none across a gap."""
    paths = [1e3 * geometry.driven[:, axes] for geometry in parts]
    return np.concatenate([np.stack([p[:-1], p[1:]], axis=1) for p in paths])


def _stroke_speeds(driven: DrivenProgram, parts: Sequence[PathGeometry]) -> FloatArray:
    """mm/s on each of the strokes."""
    speeds = [1e3 * speed for speed in _speeds(driven, parts)]
    return np.concatenate([0.5 * (v[1:] + v[:-1]) for v in speeds])


def _speeds(driven: DrivenProgram, parts: Sequence[PathGeometry]) -> list[FloatArray]:
    """m/s of the TCP at the samples of each part, in the frame that it is drawn in."""
    pairs = zip(driven.parts, parts, strict=True)
    return [tcp_speed(part.run, geometry.driven) for part, geometry in pairs]


def _draw_speed(axes: Axes, driven: DrivenProgram, parts: Sequence[PathGeometry]) -> None:
    trajectory = driven.trajectory
    speed = np.concatenate(_speeds(driven, parts))
    axes.fill_between(trajectory.t, 1e3 * speed, color=SPEED, alpha=0.12, linewidth=0)
    axes.plot(trajectory.t, 1e3 * speed, color=SPEED, linewidth=1.2, label="driven")
    wanted = [driven.program.moves[i].speed.tcp for i in trajectory.move]
    programmed = np.array([np.nan if speed is None else speed for speed in wanted])
    if np.isfinite(programmed).any():
        axes.step(
            trajectory.t,
            1e3 * programmed,
            where="post",
            color=LIMIT,
            linewidth=0.9,
            linestyle=(0, (4, 2)),
            label="programmed",
        )
        # A program at "maximum speed" would press the driven curve to the floor.
        axes.set_ylim(0.0, 1.15e3 * min(np.nanmax(programmed), 1.3 * speed.max() + 1e-3))
    axes.set_title("speed of the TCP, mm/s")
    _legend_above(axes)


def _draw_joints(position: Axes, velocity: Axes, driven: DrivenProgram, robot: Robot) -> None:
    """Positions in % of the range from its middle, velocities in % of their limit."""
    trajectory, limits = driven.trajectory, robot.limits
    middle, half = 0.5 * (limits.upper + limits.lower), 0.5 * (limits.upper - limits.lower)
    for j, name in enumerate(robot.axis_names):
        colour = f"C{j}"
        share = (trajectory.q[:, j] - middle[j]) / half[j]
        position.plot(trajectory.t, 100 * share, color=colour, linewidth=1.2, label=name)
        rate = trajectory.dq[:, j] / limits.velocity[j]
        velocity.plot(trajectory.t, 100 * rate, color=colour, linewidth=1.2)
    for axes in (position, velocity):
        axes.axhline(100, color=LIMIT, linewidth=0.9, linestyle=(0, (4, 2)))
        axes.axhline(-100, color=LIMIT, linewidth=0.9, linestyle=(0, (4, 2)))
        axes.set_ylim(-110, 110)
    position.set_title("joint position, % of the range from its middle")
    velocity.set_title("joint velocity, % of the limit")
    _legend_above(position)


def _legend_above(axes: Axes) -> None:
    axes.legend(
        loc="lower right", bbox_to_anchor=(1.0, 0.99), ncols=8, handlelength=1.4, columnspacing=1.2
    )


def _ticks(count: int) -> Any:
    from matplotlib.ticker import MaxNLocator

    return MaxNLocator(count)
