"""Draws docs/pictures/blends.png: one corner in each blend, and how fast.

Run it as ``python docs/pictures/plot_blends.py docs/pictures/blends.png``.
"""

from __future__ import annotations

import sys
from dataclasses import replace

import matplotlib
import numpy as np

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.model.blend import TANGENT_ARC, Blend
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ZONE = 0.06
HOME = JointTarget((0.0, 0.2, 0.3, 0.0, 0.9, 0.0))
BLENDS = {
    "α = s (parabola)": Blend(),
    "α = 3s² − 2s³": Blend(alpha=(0, 0, 3, -2)),
    "α = 10s³ − 15s⁴ + 6s⁵": Blend(alpha=(0, 0, 0, 10, -15, 6)),
    "α = s, β = 4 s²(1 − s)²": Blend(beta=(4.0,)),
    "tangent arc": TANGENT_ARC,
}


def main(file: str) -> None:
    """Write the figure."""
    robot = find_robot("abb/irb1600-6-145")
    at = robot.flange_pose(np.array(HOME.joints))
    leg = 0.12

    def target(x: float, y: float) -> PoseTarget:
        return PoseTarget(replace(at, position=tuple(np.add(at.position, (x, y, 0.0)))))

    speed = Speed(tcp=0.4, reorientation=3.0, tcp_acceleration=3.0)
    moves = MoveL(target(leg, 0), speed, Radius(ZONE)), MoveL(target(leg, leg), speed, FINE)
    program = Program(moves, start=HOME)
    figure, (shape, pace) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
    corner = np.array(at.position[:2]) + np.array([leg, 0.0])
    for name, blend in BLENDS.items():
        model = MotionModel(tcp=blend, period=0.001)
        controller = Controller(find_vendor("abb"), robot, model, Sampling(blend=64))
        made = controller.run(program).trajectory
        x, y = 1e3 * (made.position[:, :2] - corner).T
        shape.plot(x, y)
        along = np.linalg.norm(np.gradient(made.position, made.t, axis=0), axis=1)
        pace.plot(made.t, 1e3 * along, label=f"{name}: {made.duration:.3f} s")
    turn = np.linspace(0, 2 * np.pi, 200)
    radius = 1e3 * ZONE
    shape.plot(radius * np.cos(turn), radius * np.sin(turn), "k:", lw=0.8, label="zone")
    shape.plot([-1e3 * leg, 0, 0], [0, 0, 1e3 * leg], "k--", lw=0.8, label="programmed")
    shape.set(xlabel="x from the waypoint, mm", ylabel="y, mm", xlim=(-75, 20), ylim=(-25, 75))
    shape.set_aspect("equal")
    shape.legend(fontsize=7, loc="lower left")
    pace.set(xlabel="time, s", ylabel="TCP speed, mm/s", ylim=(0, None))
    pace.legend(fontsize=7)
    figure.savefig(file, dpi=120)


if __name__ == "__main__":
    main(sys.argv[1])
