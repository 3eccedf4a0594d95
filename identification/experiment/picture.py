"""Draws an experiment: the runs in the cell and in their planes, and what they would tell."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.arrays import FloatArray
from ...core.cell.cell import Cell
from ...drawing.cell import show_space
from ...drawing.solids import obstacle_triangles, robot_triangles
from ...drawing.style import STYLE, figure_file
from .kinds import Kind
from .plan import Designed, Experiment
from .postures import Site

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


OBSTACLE, ARM = "#b8b3a8", "#f2a043"
LABELS = 190.0
"""Points of height that labels of figures have."""
MOST_PANELS = 6
"""Postures that are drawn in their planes."""
TILTED = 0.02
"""Share of its spread by which a run may leave the plane and still be drawn in it."""


def draw_experiment(cell: Cell, experiment: Experiment) -> bytes:
    """The picture as PNG.

    Args:
        cell: that it was designed for.
        experiment: the runs.
    """
    import matplotlib

    with matplotlib.rc_context(STYLE):
        return figure_file(_figure(cell, experiment), "png")


def _figure(cell: Cell, experiment: Experiment) -> Figure:
    from matplotlib.figure import Figure

    flat = [number for number in range(len(experiment.sites)) if _flat_runs(experiment, number)]
    shown = flat[:MOST_PANELS] or [0]
    figure = Figure(figsize=(16, 9.5), layout="constrained")
    halves: Any = figure.subfigures(1, 2, width_ratios=(1.0, 1.15))
    space, right = halves
    colours = _colours(experiment)
    _draw_space(space.add_subplot(projection="3d"), cell, experiment, colours)
    upper, lower = right.subfigures(2, 1, height_ratios=(1.2, 1.0))
    row = upper.subplots(1, len(shown), squeeze=False)[0]
    for number, axes in zip(shown, row, strict=True):
        _draw_plane(axes, experiment, number, colours)
    counts, precision = lower.subplots(1, 2, width_ratios=(1.0, 1.1))
    _draw_counts(counts, experiment)
    _draw_precision(precision, experiment)
    figure.suptitle(
        f"{len(experiment.runs)} runs of {experiment.robot.name}: "
        f"{experiment.seconds / 60:.0f} min at the robot",
        x=0.01,
        ha="left",
        fontweight="bold",
    )
    return figure


def _colours(experiment: Experiment) -> dict[str, str]:
    driven = {run.candidate.kind for run in experiment.runs}
    return {str(kind): f"C{k % 10}" for k, kind in enumerate(one for one in Kind if one in driven)}


def _draw_space(axes: Any, cell: Cell, experiment: Experiment, colours: dict[str, str]) -> None:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    tool = experiment.plan.tool.name
    arms = [robot_triangles(cell, tool, site.q) for site in experiment.sites]
    things = np.concatenate(
        [np.zeros((0, 3, 3)), *obstacle_triangles(cell, experiment.sites[0].q).values()]
    )
    for solid, colour, alpha in ((things, OBSTACLE, 0.8), *((arm, ARM, 0.1) for arm in arms)):
        if len(solid):
            faces = Poly3DCollection(1e3 * solid, facecolors=colour, linewidth=0, alpha=alpha)
            axes.add_collection3d(faces)
    seen: set[str] = set()
    for run in experiment.runs:
        kind = str(run.candidate.kind)
        points = 1e3 * run.run.trajectory.position
        label = None if kind in seen else kind
        seen.add(kind)
        axes.plot(*points.T, color=colours[kind], linewidth=0.9, label=label, zorder=10)
    traces = np.concatenate([run.run.trajectory.position for run in experiment.runs])
    corners = np.concatenate([*(arm.reshape(-1, 3) for arm in arms), traces])
    show_space(axes, corners, zoom=0.95)


def _draw_plane(axes: Axes, experiment: Experiment, number: int, colours: dict[str, str]) -> None:
    """The corners of one posture, seen square to their plane."""
    for run, points in _flat_runs(experiment, number):
        axes.plot(*points.T, color=colours[str(run.candidate.kind)], linewidth=0.9)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_title(f"posture {number + 1}, in its plane, mm", fontsize=9)
    axes.tick_params(labelsize=7)


def _flat_runs(experiment: Experiment, number: int) -> list[tuple[Designed, FloatArray]]:
    """The runs at a posture that lie in its plane, with their points (T, 2) mm there."""
    here = [run for run in experiment.runs if run.candidate.posture == number]
    points = ((run, _in_plane(run, experiment.sites[number], experiment)) for run in here)
    return [(run, flat) for run, flat in points if flat is not None]


def _in_plane(run: Designed, site: Site, experiment: Experiment) -> FloatArray | None:
    """The TCP's path (T, 2) mm about the posture; None if it leaves the plane by much."""
    if not run.candidate.kind.has_corners:
        return None
    tip = experiment.robot.flange_pose(site.q) @ experiment.plan.tool.tcp
    away = 1e3 * (run.run.trajectory.position - np.array(tip.position)) @ site.plane
    spread = float(np.abs(away[:, :2]).max())
    flat = float(np.abs(away[:, 2]).max()) <= max(TILTED * spread, 1.0)
    curved = str(run.candidate.kind).endswith("joints")
    return np.asarray(away[:, :2]) if flat or curved else None


def _draw_counts(axes: Axes, experiment: Experiment) -> None:
    """How many corners there are of each zone at each speed."""
    passing = [run for run in experiment.runs if run.candidate.corners]
    speeds = sorted({run.candidate.speed or 0.0 for run in passing})
    radii = sorted({corner.radius for run in passing for corner in run.candidate.corners})
    if not radii:
        axes.set_axis_off()
        return
    counts = np.zeros((len(radii), len(speeds)), dtype=int)
    for run in passing:
        for corner in run.candidate.corners:
            counts[radii.index(corner.radius), speeds.index(run.candidate.speed or 0.0)] += 1
    axes.imshow(
        counts, cmap="Blues", vmin=0, vmax=1.6 * counts.max(), aspect="auto", origin="lower"
    )
    for (i, j), count in np.ndenumerate(counts):
        axes.text(j, i, str(count), ha="center", va="center")
    axes.set_xticks(range(len(speeds)), [f"{1e3 * speed:.4g}" for speed in speeds])
    axes.set_yticks(range(len(radii)), [f"{1e3 * radius:.4g}" for radius in radii])
    axes.set_xlabel("speed of the TCP, mm/s")
    axes.set_ylabel("zone, mm")
    axes.set_title("corners")
    axes.grid(visible=False)


def _draw_precision(axes: Axes, experiment: Experiment) -> None:
    """What would be left of the doubt about each figure."""
    share = [100 * one.after / one.before for one in experiment.precision]
    places = np.arange(len(share))
    axes.barh(places, share, color="#1f4e9c")
    labels = [
        one.key.replace("joint_acceleration_scale", "joint_acc") for one in experiment.precision
    ]
    axes.set_yticks(places, labels, fontsize=min(7.0, LABELS / len(labels)))
    axes.invert_yaxis()
    axes.set_xlim(0, 100)
    axes.set_xlabel("standard deviation, % of that before")
    axes.set_title("what the logs would leave open")
