"""Draws the pictures of docs/guides/free_motion.md: joints, speeds and torques against limits,
and the TCP's trace in the cell.

    python docs/pictures/plot_optimal_control.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.program.target import JointTarget
from flyby.core.registry import find_robot
from flyby.core.robot.inertia import carried_inertia
from flyby.problems.free_motion.optimal_control import (
    ControlLimits,
    MotionEffort,
    MotionObjective,
    MotionTask,
    Optimum,
    Surroundings,
    optimize,
)
from flyby.problems.free_motion.optimal_control.motion.result import sampled_trajectory
from flyby.validation.scenes.two_joints import BOX_LOWER, BOX_UPPER, two_joints

SAMPLES = 800
TORQUE = (3000.0, 6000.0, 2500.0, 600.0, 500.0, 200.0)
START, END = (0.0, -15.0, 15.0, 0.0, 60.0, 0.0), (70.0, 20.0, -10.0, 40.0, -50.0, 90.0)


def free_motion(weight: float) -> Optimum:
    """A wide motion of an IRB 6640 under torque limits."""
    task = MotionTask(
        find_robot("abb/irb6640-180-255"),
        np.radians(START),
        np.radians(END),
        limits=ControlLimits(torque=TORQUE),
        objective=MotionObjective(weight),
    )
    return optimize(task, effort=MotionEffort(intervals=60))


def round_the_box() -> Optimum:
    """The scene of two joints."""
    scene = two_joints()
    program = scene.programs[0]
    targets = [program.start, *(move.target for move in program.moves)]
    q = np.array([target.joints for target in targets if isinstance(target, JointTarget)])
    around = Surroundings(CollisionScene(scene.cell, scene.tool), scene.cell.clearance)
    task = MotionTask(
        scene.cell.robot,
        q[0],
        q[-1],
        joints=scene.free,
        tcp=scene.tool.tcp,
        loads=(carried_inertia(scene.tool),),
    )
    return optimize(task, around, MotionEffort(intervals=70), vias=[q[1:-1]])


def draw_limits(found: list[tuple[str, Optimum]], file: Path) -> None:
    """Joints, speeds, accelerations and torques, as shares of their limits; torques in N m where
    they have none."""
    figure, axes = plt.subplots(4, len(found), figsize=(5.2 * len(found), 9.5), squeeze=False)
    for column, (title, optimum) in zip(axes.T, found, strict=True):
        t = np.linspace(0.0, optimum.time, SAMPLES)
        limits, moving = optimum.limits, optimum.task.moving
        middle, half = 0.5 * (limits.lower + limits.upper), 0.5 * (limits.upper - limits.lower)
        torque, most = optimum.torque(t)[:, moving], limits.torque[moving]
        limited = bool(np.isfinite(most).all())
        rows = [
            ("position in its range", (optimum.motion.at(t) - middle) / half),
            ("speed / limit", optimum.motion.at(t, 1) / limits.velocity),
            ("acceleration / limit", optimum.motion.at(t, 2) / limits.acceleration),
            ("torque / limit", torque / most) if limited else ("torque in N m, no limit", torque),
        ]
        for axis, (name, values) in zip(column, rows, strict=True):
            for line, joint in zip(values.T, moving, strict=True):
                label = optimum.task.robot.axis_names[joint]
                axis.plot(t, line, lw=1.1, color=f"C{joint}", label=label)
            if limited or axis is not column[-1]:
                for side in (-1, 1):
                    axis.axhline(side, color="0.4", lw=0.8, ls="--")
                axis.set_ylim(-1.15, 1.15)
            axis.set_ylabel(name)
            axis.grid(alpha=0.25)
        column[0].set_title(f"{title}: {optimum.time:.3f} s", pad=24)
        column[0].legend(
            ncols=6, fontsize=8, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False
        )
        column[-1].set_xlabel("time in s")
    _save(figure, file)


def draw_trace(optimum: Optimum, file: Path) -> None:
    """The TCP of the first guess and of the optimum beside the box."""
    figure, axis = plt.subplots(figsize=(7, 4.6))
    edges = BOX_UPPER[0] - BOX_LOWER[0], BOX_UPPER[2] - BOX_LOWER[2]
    axis.add_patch(plt.Rectangle((BOX_LOWER[0], BOX_LOWER[2]), *edges, color="0.75", label="box"))
    first = sampled_trajectory(optimum.task, optimum.first, 0.004)
    axis.plot(*first.position[:, [0, 2]].T, color="C1", lw=1, label=f"start, {first.t[-1]:.2f} s")
    best = optimum.trajectory(0.004)
    axis.plot(*best.position[:, [0, 2]].T, color="C0", label=f"optimum, {optimum.time:.3f} s")
    nodes = np.searchsorted(best.t, optimum.motion.knots).clip(0, len(best.t) - 1)
    axis.plot(*best.position[nodes][:, [0, 2]].T, ".", color="C0", ms=4, label="nodes")
    assert optimum.certificate is not None
    axis.set_title(f"TCP in the plane y = 0; {optimum.certificate}", fontsize=10)
    axis.set_xlabel("x in m")
    axis.set_ylabel("z in m")
    axis.set_aspect("equal")
    axis.legend(fontsize=8)
    axis.grid(alpha=0.25)
    _save(figure, file)


def _save(figure: Any, file: Path) -> None:
    figure.tight_layout()
    figure.savefig(file, dpi=110, bbox_inches="tight")
    plt.close(figure)


def main() -> None:
    """Draw all."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("docs")
    box = round_the_box()
    draw_trace(box, folder / "optimal_control_trace.png")
    pairs = [("time alone", free_motion(1.0)), ("half time, half energy", free_motion(0.5))]
    draw_limits([*pairs, ("two joints round a box", box)], folder / "optimal_control_limits.png")


if __name__ == "__main__":
    main()
