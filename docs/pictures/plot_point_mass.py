"""Draws docs/pictures/point_mass.png: the point mass in the maze, jumped, guided, and proven.

After figures 3.5 and 3.6 of the thesis that `validation.textbook` names. Above: circles
avoided at the nodes only, from the straight line (dotted): whatever the number of nodes, the
wall is passed between two of them. Below: the thesis's remedy, a guess along a free way
(dotted); and rows that hold all along each interval. "Proven free" is to a depth of 1e-4. A
cross marks where the proof found the motion deeper in a circle.

Run it as ``python docs/pictures/plot_point_mass.py docs/pictures/point_mass.png``.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import matplotlib
import numpy as np

from flyby.core.sqp import solve
from flyby.validation.textbook import MAZE, Avoidance, PointMass, Scene, prove_free

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import Circle

TOUCH = 1e-4
"""How far into a circle the proof lets the motion go: an optimum touches the circles, to the
solver's tolerance."""


def main(file: str, counts: Sequence[int] = (20, 40, 100)) -> None:
    """Write the figure, and print what it shows; the first row has this many nodes."""
    line, way = (MAZE.start, MAZE.goal), MAZE.way
    shown = (
        *(("samples only, from the line", nodes, Avoidance.SAMPLES, line) for nodes in counts),
        ("samples only, along a free way", 20, Avoidance.SAMPLES, way),
        ("chords, along a free way", 20, Avoidance.CHORDS, way),
        ("Bernstein, along a free way", 20, Avoidance.BERNSTEIN, way),
    )
    figure, rows = plt.subplots(
        2, 3, figsize=(11, 7.6), layout="constrained", sharex=True, sharey=True
    )
    for axes, (name, nodes, avoidance, guess) in zip(rows.flat, shown, strict=True):
        problem = PointMass(MAZE, nodes, avoidance)
        result = solve(problem.nlp(), problem.through(guess))
        arcs = problem.arcs(result.x)
        proof = prove_free(arcs, MAZE, -TOUCH)
        draw_scene(axes, MAZE)
        axes.plot(*np.array(guess).T, "k:", lw=0.9)
        axes.plot(*arcs.points(20).T, color="tab:blue", lw=1.4)
        axes.plot(*problem.places(result.x).T, "o", color="tab:blue", ms=3)
        if not proof.free:
            axes.plot(*proof.place, "kx", ms=10, mew=2.5)
        outcome = (
            f"proven free to {TOUCH:g}" if proof.free else f"hits, {-proof.clearance:.2g} deep"
        )
        axes.set_title(f"{name}, n = {nodes}\nT = {result.objective:.3f}, {outcome}", fontsize=9)
        print(f"{name}, n = {nodes}: {result.status}, T = {result.objective:.4f}, {outcome}")
    figure.savefig(file, dpi=110)


def draw_scene(axes: Axes, scene: Scene) -> None:
    """Circles, start, goal and the square."""
    for x, y, radius in scene.circles:
        axes.add_patch(Circle((x, y), radius, color="tab:red", alpha=0.35, lw=0))
    axes.plot(*np.array([scene.start, scene.goal]).T, "ko", ms=6)
    margin = 0.2
    axes.set(
        xlim=(scene.lower[0] - margin, scene.upper[0] + margin),
        ylim=(scene.lower[1] - margin, scene.upper[1] + margin),
        aspect="equal",
    )


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python docs/pictures/plot_point_mass.py FILE.png")
    main(sys.argv[1])
