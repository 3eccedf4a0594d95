"""Motions for a player that shows joint values frame by frame: ms and degrees."""

from __future__ import annotations

import numpy as np

from flyby.core.hookspec import ExporterRegister, hookimpl
from flyby.core.motion.emulator.run import Run
from flyby.core.plugins.parts import Exporter

FRAME = 0.04
"""s between frames."""


def export(run: Run) -> bytes:
    """A line a frame: ms, then the axes in degrees, linear ones in mm."""
    made = run.trajectory.resampled(FRAME)
    robot = run.path.route.robot
    lines = ["frame_ms " + " ".join(robot.axis_names)]
    for t, q in zip(made.t, np.degrees(made.q), strict=True):
        lines.append(" ".join([f"{1000 * t:.0f}", *(f"{value:.4f}" for value in q)]))
    return "\n".join([*lines, ""]).encode()


@hookimpl
def flyby_register_exporters(register: ExporterRegister) -> None:
    """Hand over the exporter."""
    register.add(Exporter("playback", "frames for our player", (".playback",), export), api=1)
