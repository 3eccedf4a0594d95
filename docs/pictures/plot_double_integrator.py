"""Draws docs/pictures/double_integrator.png: least time from (4, 1) to rest.

After figures 2.5 and 2.6 of the thesis that `validation.textbook` names. Left: 40 nodes in
the
thesis's discretisation over the exact solution. Middle: the same in the plane of place and speed,
with the curve on which the force changes its sign. Right: how both discretisations' times approach
the exact one.

Run it as ``python docs/pictures/plot_double_integrator.py docs/pictures/double_integrator.png``.
"""

from __future__ import annotations

import sys

import matplotlib
import numpy as np

from flyby.core.sqp import solve
from flyby.validation.textbook import DoubleIntegrator, Scheme, minimum_time

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes

START = (4.0, 1.0)
NODES = 40
SIZES = (10, 14, 20, 28, 40, 57, 80, 113, 160, 226, 320)
NAMES = ("place $x_1$", "speed $x_2$", "force $u$")
COLOURS = ("tab:blue", "tab:red", "goldenrod")


def main(file: str) -> None:
    """Write the figure."""
    problem = DoubleIntegrator(NODES, start=START)
    result = solve(problem.nlp(), problem.initial_guess())
    t, states = problem.trajectory(result.x)
    figure, (over_time, plane, error) = plt.subplots(1, 3, figsize=(13, 4.2), layout="constrained")
    exact = minimum_time(*START)
    fine = np.linspace(0.0, exact.time, 2000)
    curve = exact.state(fine)
    for column, (name, colour) in enumerate(zip(NAMES, COLOURS, strict=True)):
        over_time.plot(fine, curve[:, column], color=colour, lw=1.0)
        over_time.plot(t, states[:, column], "o", color=colour, ms=3, label=name)
    over_time.axvline(exact.switch, color="0.5", ls="--", lw=0.8, label="exact switch")
    over_time.set(xlabel="time", title=f"{NODES} nodes: T = {result.objective:.5f}")
    over_time.legend(fontsize=8)
    draw_plane(plane)
    plane.plot(states[:, 0], states[:, 1], "ko", ms=3, label=f"{NODES} nodes")
    plane.plot(curve[:, 0], curve[:, 1], "k", lw=0.8, label="exact")
    plane.legend(fontsize=8, loc="upper right")
    draw_error(error, exact.time)
    figure.savefig(file, dpi=110)


def draw_plane(axes: Axes) -> None:
    """The switching curve x₁ = −x₂|x₂|/2, and where the force is which."""
    speed = np.linspace(-3.2, 3.2, 200)
    curve = -speed * np.abs(speed) / 2.0
    axes.plot(curve, speed, "--", color="0.5", lw=1.2, label="switching curve")
    axes.fill_betweenx(speed, curve, 6.0, color="tab:red", alpha=0.08, lw=0, label="u = −1")
    axes.fill_betweenx(speed, -3.0, curve, color="tab:blue", alpha=0.08, lw=0, label="u = 1")
    axes.set(xlabel=NAMES[0], ylabel=NAMES[1], xlim=(-3, 6), ylim=(-3.2, 3.2))
    axes.set_title("the plane of place and speed")


def draw_error(axes: Axes, exact: float) -> None:
    """Times over the number of nodes."""
    for scheme, mark in ((Scheme.TRAPEZOIDAL, "o-"), (Scheme.CONSTANT_FORCE, "s-")):
        over = []
        for nodes in SIZES:
            problem = DoubleIntegrator(nodes, scheme, START)
            over.append(
                solve(problem.nlp(), problem.initial_guess(), tolerance=1e-9).objective - exact
            )
        axes.loglog(SIZES, over, mark, ms=4, lw=0.8, label=scheme.replace("_", " "))
    nodes = np.array(SIZES, dtype=float)
    axes.loglog(nodes, 8.0 / nodes**2, "k:", lw=0.8, label="falling with 1/N²")
    axes.set(xlabel="nodes N", title=f"time above the exact {exact:.6f}")
    axes.legend(fontsize=8)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python docs/pictures/plot_double_integrator.py FILE.png")
    main(sys.argv[1])
