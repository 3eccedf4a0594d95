"""Draws the plane of two joints: where the arm is free, and the path in it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..core.arrays import FloatArray
from ..core.collision.joint_plane import JointPlane
from ..core.robot.joint import JointKind
from ..core.robot.model import Robot
from .style import STOP, STYLE, figure_file

FREE, NEAR, TOUCHING = "#ffffff", "#f3dfb8", "#b8b2a7"
if TYPE_CHECKING:
    from matplotlib.axes import Axes

EDGE, PATH = "#6b655b", "#1f4e9c"
NAMED = 4
"""Moves to one place up to which all are numbered there."""


def draw_joint_plane(
    plane: JointPlane,
    robot: Robot,
    paths: Sequence[FloatArray],
    waypoints: FloatArray,
    numbers: Sequence[int],
    title: str,
    kind: str,
) -> bytes:
    """A figure of a plane as a file of the kind ``png``, ``pdf`` or ``svg``.

    Args:
        plane: what was measured.
        robot: whose joints they are.
        paths: (T, N) rad or m each, as driven.
        waypoints: (M + 1, N), the start, and where moves end.
        numbers: (M,), of these moves.
        title: above it.
        kind: of the file.
    """
    import matplotlib
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(8, 7.2), layout="constrained")
        axes = figure.add_subplot()
        scale = [_unit(robot, axis) for axis in plane.axes]
        x, y = plane.first * scale[0][1], plane.second * scale[1][1]
        levels, colours = [-1e3, 0.0, plane.clearance, 1e3], [TOUCHING, NEAR, FREE]
        if plane.clearance <= 0.0:
            del levels[2], colours[1]
        axes.contourf(x, y, plane.distance, levels=levels, colors=colours)
        if plane.distance.min() < 0.0 < plane.distance.max():
            axes.contour(x, y, plane.distance, levels=[0.0], colors=EDGE, linewidths=1.0)
        factors = np.array([factor for _, factor in scale])
        for path in paths:
            axes.plot(*(path[:, plane.axes] * factors).T, color=PATH, linewidth=1.8)
        at = waypoints[:, plane.axes] * factors
        axes.plot(*at.T, "o", color=PATH, markerfacecolor="white", markersize=5)
        axes.plot(*at[:1].T, "s", color=STOP, markersize=5)
        axes.set(xlim=x[[0, -1]], ylim=y[[0, -1]], title=title)
        _number(axes, at, numbers)
        for name, axis, (unit, _) in zip("xy", plane.axes, scale, strict=True):
            getattr(axes, f"set_{name}label")(f"{robot.axis_names[axis]}, {unit}")
        handles = [
            Patch(facecolor=TOUCHING, label="touching"),
            Patch(facecolor=NEAR, label=f"nearer than {1e3 * plane.clearance:g} mm"),
            Line2D([], [], color=PATH, label="path as driven"),
        ]
        if plane.clearance <= 0.0:
            del handles[1]
        axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.0, -0.08), ncols=3)
        return figure_file(figure, kind)


def _number(axes: Axes, at: FloatArray, numbers: Sequence[int]) -> None:
    """Write at each place (M + 1, 2) the numbers of the moves that end there."""
    ending: dict[tuple[float, float], list[str]] = {}
    for text, (x, y) in zip(["start", *map(str, numbers)], np.round(at, 1) + 0.0, strict=True):
        ending.setdefault((float(x), float(y)), []).append(text)
    lowest, highest = axes.get_ylim()
    for point, texts in ending.items():
        shown = ", ".join(texts[:NAMED]) + (", …" if len(texts) > NAMED else "")
        # At the upper edge it would run into the title.
        under = point[1] > highest - 0.03 * (highest - lowest)
        by = (5, -11) if under else (5, 5)
        axes.annotate(shown, point, xytext=by, textcoords="offset points", fontsize=8)


def _unit(robot: Robot, axis: int) -> tuple[str, float]:
    joints = [*robot.joints, *(external.joint for external in robot.external_axes)]
    turning = joints[axis].kind is JointKind.REVOLUTE
    return ("°", 180.0 / np.pi) if turning else ("mm", 1e3)
