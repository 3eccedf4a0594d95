"""Draws a cell with the paths of one or two runs: what stands there, the arm, the TCP's traces."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
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
ELEVATION, AZIMUTH = 24.0, -62.0
"""Degrees, from where the space is seen."""
LIGHT = np.array([0.3, -0.5, 0.8]) / np.linalg.norm([0.3, -0.5, 0.8])
GHOSTS = 25
"""Places of the tool that are drawn as lines."""
HAZE = 0.6
"""How much lighter than the nearest the farthest is drawn in a plane."""
NAMED = "#5c5850"
"""Of the names of obstacles."""
HIDDEN, VEIL = 0.7, 0.06
"""Share of the traces behind an obstacle from which on it is drawn as a veil; how dense that is."""
FLAT = 0.1
"""A view whose shorter side is less of the longer one shows nothing."""
MARGIN = 0.2
"""Share of the traces' largest span that is drawn around them."""


def _camera() -> FloatArray:
    """(3, 3), directions to the right, up and towards who looks at the space."""
    up, round_z = np.radians(ELEVATION), np.radians(AZIMUTH)
    towards = np.array([np.cos(up) * np.cos(round_z), np.cos(up) * np.sin(round_z), np.sin(up)])
    right = np.array([-np.sin(round_z), np.cos(round_z), 0.0])
    return np.array([right, np.cross(towards, right), towards])


CAMERA = _camera()


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
    _draw_space(figure.add_subplot(grid[:, 0], projection="3d"), cell, runs, solids)
    for row, (view, window) in enumerate(zip(views, windows, strict=True)):
        axes = figure.add_subplot(grid[row, 1])
        _label_plane(axes, solids, _draw_plane(axes, cell, runs, solids, view), view, window)
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


def _draw_space(
    axes: Any, cell: Cell, runs: Sequence[tuple[str, Run]], solids: Mapping[str, FloatArray]
) -> None:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    _, run = runs[-1]
    tool = run.program.moves[run.path.route.moves[0]].tool
    arm = robot_triangles(cell, tool.name, run.path.q[0])
    traces = np.concatenate([traced.trajectory.position for _, traced in runs])
    corners = np.concatenate(
        [arm.reshape(-1, 3), _seen(_joined(solids, set(solids)), traces), traces]
    )
    low, high = corners.min(axis=0), corners.max(axis=0)
    solids = {name: _cut(solid, low, high) for name, solid in solids.items()}
    before = {name for name, solid in solids.items() if _hides(solid, traces, CAMERA)}
    things, veils = _joined(solids, set(solids) - before), _joined(solids, before)
    drawn = ((things, OBSTACLE, 1.0), (arm, ARM, 0.3), (veils, OBSTACLE, VEIL))
    for order, (solid, tone, alpha) in enumerate(drawn):
        if len(solid):
            shaded = np.insert(_shaded(solid, tone), 3, alpha, axis=1)
            faces = Poly3DCollection(1e3 * solid, facecolors=shaded, linewidth=0, zorder=order)
            axes.add_collection3d(faces)
    for (label, traced), colour in zip(runs, COLOURS, strict=False):
        points = 1e3 * traced.trajectory.position
        text = f"{label}: {traced.duration:.3f} s"
        axes.plot(*points.T, color=colour, linewidth=1.8, label=text, zorder=10)
    show_space(axes, corners)
    for name, solid in solids.items():
        if len(solid):
            points = 1e3 * solid.reshape(-1, 3)
            at = [*points.mean(axis=0)[:2], points[:, 2].max()]
            axes.text(*at, name, fontsize=7, color=NAMED, ha="center", va="bottom", zorder=11)


def _cut(solid: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """What is left of triangles (F, 3, 3) within a box (3,) to (3,) m."""
    inside = ((solid.max(axis=1) >= low) & (solid.min(axis=1) <= high)).all(axis=1)
    return np.asarray(np.clip(solid[inside], low, high))


def _joined(solids: Mapping[str, FloatArray], names: Collection[str]) -> FloatArray:
    """The triangles (F, 3, 3) m of some obstacles."""
    return np.concatenate(
        [np.zeros((0, 3, 3)), *(solids[name] for name in solids if name in names)]
    )


def _hides(solid: FloatArray, traces: FloatArray, frame: FloatArray) -> bool:
    """Whether an obstacle stands between who looks and much of the traces.

    Args:
        solid: (F, 3, 3) m.
        traces: (T, 3) m.
        frame: (3, 3), its rows the directions to the right, up and towards who looks.
    """
    if not len(solid):
        return False
    points, seen = solid.reshape(-1, 3) @ frame.T, traces @ frame.T
    low, high = points.min(axis=0), points.max(axis=0)
    behind = ((seen[:, :2] >= low[:2]) & (seen[:, :2] <= high[:2])).all(axis=1)
    return bool((behind & (seen[:, 2] < high[2])).mean() > HIDDEN)


def show_space(axes: Any, corners: FloatArray, zoom: float = 1.0) -> None:
    """Show the space that holds some points (P, 3) m, with axes in mm and a legend."""
    axes.computed_zorder = False  # the traces are seen through everything
    lowest, highest = 1e3 * corners.min(axis=0), 1e3 * corners.max(axis=0)
    for axis, low, high in zip("xyz", lowest, highest, strict=True):
        getattr(axes, f"set_{axis}lim")(low, high)
        getattr(axes, f"set_{axis}label")(f"{axis}, mm")
    axes.set_box_aspect(highest - lowest, zoom=zoom)
    axes.view_init(elev=ELEVATION, azim=AZIMUTH)
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
    solids: Mapping[str, FloatArray],
    view: tuple[int, int],
) -> Collection[str]:
    """The traces on what stands below them, seen along the third axis; returns the names of the
    obstacles that are seen."""
    from matplotlib.collections import LineCollection, PolyCollection

    (towards,) = {0, 1, 2} - set(view)
    # Seen from above, from the front (against y) and from ahead (against x).
    side = -1.0 if towards == 1 else 1.0
    frame = np.array([np.eye(3)[view[0]], np.eye(3)[view[1]], side * np.eye(3)[towards]])
    traces = np.concatenate([run.trajectory.position for _, run in runs])
    before = {name for name, solid in solids.items() if _hides(solid, traces, frame)}
    for name in before:
        flat = 1e3 * solids[name][:, :, view]
        axes.add_collection(PolyCollection(list(flat), facecolors=[(*OBSTACLE, 0.02)], linewidth=0))
    things = _joined(solids, set(solids) - before)
    nearness = side * things[:, :, towards].mean(axis=1)
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
    return set(solids) - before


def _label_plane(
    axes: Axes,
    solids: Mapping[str, FloatArray],
    names: Collection[str],
    view: tuple[int, int],
    window: FloatArray,
) -> None:
    """Write the names of some obstacles in the middle of what a window (2, 2) mm shows of them."""
    for name in names:
        solid = solids[name]
        points = np.clip(1e3 * solid.reshape(-1, 3)[:, view], window[:, 0], window[:, 1])
        low, high = points.min(axis=0), points.max(axis=0)
        if (high - low).min() > 0.0:
            x, y = 0.5 * (low + high)
            axes.text(x, y, name, fontsize=8, color=NAMED, ha="center", va="center", zorder=6)


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
    """A trace with its waypoints: filled where it stops, open where it passes, with the zone round
    it."""
    from matplotlib.collections import PatchCollection
    from matplotlib.patches import Circle

    geometry = path_geometry(run, cell.robot)
    points = 1e3 * run.trajectory.position[:, view]
    axes.plot(*points.T, color=colour, linewidth=1.8, label=label, zorder=4)
    waypoints = 1e3 * geometry.waypoints[:, view]
    stops = geometry.radius == 0
    passed = zip(waypoints[~stops], 1e3 * geometry.radius[~stops], strict=True)
    zones = [Circle((float(x), float(y)), float(radius)) for (x, y), radius in passed]
    axes.add_collection(
        PatchCollection(zones, facecolor=colour + "0c", edgecolor=colour + "90", linewidth=0.7)
    )
    axes.plot(*waypoints[stops].T, "s", color=colour, markersize=4, zorder=5)
    axes.plot(
        *waypoints[~stops].T, "o", color=colour, markerfacecolor="white", markersize=4.5, zorder=5
    )


def _shaded(triangles: FloatArray, colour: FloatArray) -> FloatArray:
    """A colour (F, 3) for each triangle by how it stands to the light."""
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    return np.asarray(colour * (0.78 + 0.22 * (normal @ LIGHT))[:, None])
