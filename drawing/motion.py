"""Joints over time: positions in their ranges and velocities by their limits."""

from __future__ import annotations

from collections.abc import Mapping

from ..core.motion.command.trajectory import Trajectory
from ..core.robot.model import Robot
from .style import STYLE, figure_file


def draw_motion(motions: Mapping[str, Trajectory], robot: Robot, kind: str) -> bytes:
    """A figure of motions of one robot as a file.

    Args:
        motions: by name; drawn from left to right.
        robot: whose limits count.
        kind: ``png``, ``pdf`` or ``svg``.
    """
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(5.5 * len(motions) + 1.0, 6.0), layout="constrained")
        axes = figure.subplots(2, len(motions), squeeze=False, sharex="col")
        limits = robot.limits
        middle = 0.5 * (limits.upper + limits.lower)
        half = 0.5 * (limits.upper - limits.lower)
        for column, (name, motion) in enumerate(motions.items()):
            upper, lower = axes[0, column], axes[1, column]
            for j, axis in enumerate(robot.axis_names):
                upper.plot(motion.t, 100.0 * (motion.q[:, j] - middle[j]) / half[j], label=axis)
                lower.plot(motion.t, 100.0 * motion.dq[:, j] / limits.velocity[j])
            upper.set_title(name)
            upper.set_ylabel("position, % of half the range")
            lower.set_ylabel("velocity, % of the limit")
            lower.set_xlabel("time, s")
            upper.legend(ncols=3, fontsize=7)
        return figure_file(figure, kind)
