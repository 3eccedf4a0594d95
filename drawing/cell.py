"""Draws a cell with the paths of one or two runs: what stands there, the arm, the TCP's traces."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.arrays import FloatArray
from ..core.cell.cell import Cell
from ..core.motion.emulator.run import Run
from .geometry import path_geometry
from .solids import obstacle_triangles, robot_triangles, skeleton
from .style import STYLE, figure_file

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


COLOURS = ("#b3261e", "#1f4e9c")
"""Of the first and the second trace."""
OBSTACLE, ARM = np.array([0.72, 0.70, 0.66]), np.array([0.95, 0.62, 0.25])
LIGHT = np.array([0.3, -0.5, 0.8]) / np.linalg.norm([0.3, -0.5, 0.8])
GHOSTS = 25
"""Places of the tool that are drawn as lines."""
HAZE = 0.6
"""How much lighter than the nearest the farthest is drawn in a plane."""
FLAT = 0.1
"""A view whose shorter side is less of the longer one shows nothing."""
MARGIN = 0.2
"""Share of the traces' largest span that is drawn around them."""


def draw_cell(cell: Cell, runs: Sequence[tuple[str, Run]], kind: str) -> bytes:
    """A picture of a cell and runs in it as a file of the kind ``png``, ``pdf`` or ``svg``.

    Args:
        cell: robot and obstacles.
        runs: one or two, each with what to call it (``before``, ``after``).
        kind: of the file.
    """
    import matplotlib

    with matplotlib.rc_context(STYLE):
        return figure_file(make_cell_figure(cell, runs), kind)


def make_cell_figure(cell: Cell, runs: Sequence[tuple[str, Run]]) -> Figure:
    """The figure: the cell in space at the left, the traces in world planes at the right."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(15, 8.5), layout="constrained")
    views = _views(runs)
    windows = [_window(runs, view) for view in views]
    tall = [float(np.divide(*np.diff(window, axis=1)[::-1, 0])) for window in windows]
    grid = figure.add_gridspec(len(views), 2, width_ratios=(1.0, 1.15), height_ratios=tall)
    start = runs[0][1].path.q[0]
    solids = obstacle_triangles(cell, start)
    things = np.concatenate([np.zeros((0, 3, 3)), *solids.values()])
    _draw_space(figure.add_subplot(grid[:, 0], projection="3d"), cell, runs, things)
    for row, (view, window) in enumerate(zip(views, windows, strict=True)):
        axes = figure.add_subplot(grid[row, 1])
        _draw_plane(axes, cell, runs, things, view)
        axes.set(xlim=window[0], ylim=window[1])
    name = runs[0][1].program.name
    figure.suptitle(f"{name} on {cell.robot.name}", x=0.01, ha="left", fontweight="bold")
    return figure


def _views(runs: Sequence[tuple[str, Run]]) -> list[tuple[int, int]]:
    """One or two pairs of world axes in which the traces spread most."""
    spans = np.ptp(np.concatenate([run.trajectory.position for _, run in runs]), axis=0)
    pairs = sorted(combinations(range(3), 2), key=lambda pair: -spans[pair[0]] * spans[pair[1]])
    flat = [min(spans[[*pair]]) < FLAT * max(spans[[*pair]]) for pair in pairs]
    return pairs[:1] if flat[1] else pairs[:2]


def _window(runs: Sequence[tuple[str, Run]], view: tuple[int, int]) -> FloatArray:
    """Lower and upper end (2, 2) mm of both axes of a view: the traces and a margin."""
    traces = np.concatenate([run.trajectory.position for _, run in runs])
    margin = MARGIN * float(np.ptp(traces, axis=0).max())
    ends = np.stack([traces.min(axis=0) - margin, traces.max(axis=0) + margin], axis=1)
    return np.asarray(1e3 * ends[[*view]])


def _draw_space(axes: Any, cell: Cell, runs: Sequence[tuple[str, Run]], things: FloatArray) -> None:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    _, run = runs[-1]
    tool = run.program.moves[run.path.route.moves[0]].tool
    arm = robot_triangles(cell, tool.name, run.path.q[0])
    for order, (solid, tone, alpha) in enumerate(((things, OBSTACLE, 1.0), (arm, ARM, 0.3))):
        if len(solid):
            shaded = np.insert(_shaded(solid, tone), 3, alpha, axis=1)
            faces = Poly3DCollection(1e3 * solid, facecolors=shaded, linewidth=0, zorder=order)
            axes.add_collection3d(faces)
    for (label, traced), colour in zip(runs, COLOURS, strict=False):
        points = 1e3 * traced.trajectory.position
        text = f"{label}: {traced.duration:.3f} s"
        axes.plot(*points.T, color=colour, linewidth=1.8, label=text, zorder=10)
    traces = np.concatenate([traced.trajectory.position for _, traced in runs])
    corners = np.concatenate([arm.reshape(-1, 3), _seen(things, traces), traces])
    show_space(axes, corners)


def show_space(axes: Any, corners: FloatArray, zoom: float = 1.0) -> None:
    """Show the space that holds some points (P, 3) m, with axes in mm and a legend."""
    axes.computed_zorder = False  # the traces are seen through everything
    lowest, highest = 1e3 * corners.min(axis=0), 1e3 * corners.max(axis=0)
    for axis, low, high in zip("xyz", lowest, highest, strict=True):
        getattr(axes, f"set_{axis}lim")(low, high)
        getattr(axes, f"set_{axis}label")(f"{axis}, mm")
    axes.set_box_aspect(highest - lowest, zoom=zoom)
    axes.view_init(elev=24, azim=-62)
    axes.tick_params(labelsize=7, pad=1)
    axes.legend(loc="upper left")


def _seen(things: FloatArray, traces: FloatArray) -> FloatArray:
    """Corners of the triangles no farther from the traces than these spread, for the limits."""
    span = float(np.ptp(traces, axis=0).max())
    low, high = traces.min(axis=0) - span, traces.max(axis=0) + span
    points = things.reshape(-1, 3)
    return np.clip(points, low, high)


def _draw_plane(
    axes: Axes,
    cell: Cell,
    runs: Sequence[tuple[str, Run]],
    things: FloatArray,
    view: tuple[int, int],
) -> None:
    """The traces on what stands below them, seen along the third axis."""
    from matplotlib.collections import LineCollection, PolyCollection

    (towards,) = {0, 1, 2} - set(view)
    # Seen from above, from the front (against y) and from ahead (against x).
    nearness = (-1.0 if towards == 1 else 1.0) * things[:, :, towards].mean(axis=1)
    order = np.argsort(nearness)
    solid = things[order]
    haze = HAZE * np.linspace(1.0, 0.0, len(solid))[:, None]
    shaded = _shaded(solid, OBSTACLE) * (1.0 - haze) + haze
    corners = list(1e3 * solid[:, :, view])
    axes.add_collection(PolyCollection(corners, facecolors=shaded, linewidth=0, antialiased=False))
    bones = 1e3 * _bones(cell, runs[-1][1])
    axes.add_collection(LineCollection(list(bones[:, :, view]), colors=[(*ARM, 0.4)], linewidth=2))
    for (label, run), colour in zip(runs, COLOURS, strict=False):
        _draw_trace(axes, cell, label, run, colour, view)
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlabel(f"{'xyz'[view[0]]}, mm")
    axes.set_ylabel(f"{'xyz'[view[1]]}, mm")


def _bones(cell: Cell, run: Run) -> FloatArray:
    """The tool as lines (GHOSTS, 2, 3) m from the flange to its tip, at even steps of time."""
    trajectory = run.trajectory
    tip = run.program.moves[run.path.route.moves[0]].tool.tcp
    times = np.linspace(0.0, run.duration, GHOSTS)
    rows = np.searchsorted(trajectory.t, times).clip(max=len(trajectory.t) - 1)
    return skeleton(cell.robot, tip, trajectory.q[rows])[:, -2:]


def _draw_trace(
    axes: Axes, cell: Cell, label: str, run: Run, colour: str, view: tuple[int, int]
) -> None:
    """A trace with its waypoints: filled where it stops, open where it passes."""
    geometry = path_geometry(run, cell.robot)
    points = 1e3 * run.trajectory.position[:, view]
    axes.plot(*points.T, color=colour, linewidth=1.8, label=label, zorder=4)
    waypoints = 1e3 * geometry.waypoints[:, view]
    stops = geometry.radius == 0
    axes.plot(*waypoints[stops].T, "s", color=colour, markersize=4, zorder=5)
    axes.plot(
        *waypoints[~stops].T, "o", color=colour, markerfacecolor="white", markersize=4.5, zorder=5
    )


def _shaded(triangles: FloatArray, colour: FloatArray) -> FloatArray:
    """A colour (F, 3) for each triangle by how it stands to the light."""
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    return np.asarray(colour * (0.78 + 0.22 * (normal @ LIGHT))[:, None])
