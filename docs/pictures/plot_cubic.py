"""Draws docs/pictures/cubic.png: the cubic problem by SQP (above), by a log barrier (below).

After figures 2.3 and 2.4 of the thesis that `flyby.validation.textbook` names. Above: some
iterations, each with the constraints' linearisations there (dotted) and the step that follows.
Below: level curves of the barrier function for falling weights, with the minimisers so far.

Run it as ``python docs/pictures/plot_cubic.py docs/pictures/cubic.png``.
"""

from __future__ import annotations

import sys

import matplotlib
import numpy as np

from flyby.core.sqp import solve
from flyby.validation.textbook import CUBIC_OPTIMUM, CUBIC_START, barrier_path, cubic
from flyby.validation.textbook.cubic import barrier, constraints, jacobian, objective

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes

from flyby.core.arrays import FloatArray

SHOWN = (0, 1, 2, 4)
WEIGHTS = (10.0, 3.0, 1.0, 0.3, 0.1, 0.03, 0.01)
SHOWN_WEIGHTS = (10.0, 1.0, 0.3, 0.03)
X1 = np.linspace(-0.5, 6.0, 240)
X2 = np.linspace(-0.5, 6.0, 240)
COLOURS = ("tab:red", "tab:blue")


def main(file: str) -> None:
    """Write the figure."""
    seen: list[FloatArray] = []
    solve(cubic(), CUBIC_START, callback=lambda at: seen.append(at.x))
    figure, rows = plt.subplots(
        2, 4, figsize=(12, 6.4), layout="constrained", sharex=True, sharey=True
    )
    for axes, number in zip(rows[0], SHOWN, strict=True):
        draw_iteration(axes, seen, number)
    path = dict(zip(WEIGHTS, barrier_path(WEIGHTS), strict=True))
    for axes, weight in zip(rows[1], SHOWN_WEIGHTS, strict=True):
        draw_barrier(axes, path, weight)
    for axes in rows.flat:
        axes.plot(*CUBIC_OPTIMUM, "k*", ms=9, label="optimum")
        axes.set(xlim=(X1[0], X1[-1]), ylim=(X2[0], X2[-1]), aspect="equal")
    for axes in rows[1]:
        axes.set_xlabel("$x_1$")
    for axes in rows[:, 0]:
        axes.set_ylabel("$x_2$")
        axes.legend(loc="lower right", fontsize=7)
    figure.savefig(file, dpi=110)


def draw_iteration(axes: Axes, seen: list[FloatArray], number: int) -> None:
    """The constraints as the subproblem of an iteration sees them."""
    draw_problem(axes)
    levels(axes, objective, np.arange(-2.5, 60.0, 4.0))
    x = seen[number]
    for value, slope, colour in zip(constraints(x), jacobian(x), COLOURS, strict=True):
        # value + slope · (X − x) = 0, solved for X₂
        line = x[1] - (value + slope[0] * (X1 - x[0])) / slope[1]
        axes.plot(X1, line, ":", color=colour, lw=1.6)
    ends = np.array(seen[: number + 2])
    axes.plot(*ends.T, "o-", color="0.45", ms=3, lw=0.8)
    axes.plot(*x, "ko", ms=6, label="iterate")
    axes.plot(*ends[-1], "o", ms=7, mfc="white", mec="k", label="next")
    axes.set_title(f"SQP, iteration {number + 1}", fontsize=10)


def draw_barrier(axes: Axes, path: dict[float, FloatArray], weight: float) -> None:
    """The barrier function of one weight, and the minimisers down to it."""
    draw_problem(axes)
    least = barrier(path[weight], weight)
    levels(axes, lambda x: barrier(x, weight), least + 0.15 * 2.0 ** np.arange(0.0, 9.0))
    sofar = [x for k, x in path.items() if k >= weight]
    axes.plot(*np.array([CUBIC_START, *sofar]).T, "o-", color="0.45", ms=3, lw=0.8)
    axes.plot(*path[weight], "ko", ms=6, label="minimiser")
    axes.set_title(f"barrier, weight {weight:g}", fontsize=10)


def draw_problem(axes: Axes) -> None:
    """The constraints; what is below either curve is forbidden."""
    edges = (X1 / 2.0 - 2.0) ** 3 + 4.0, 4.0 - X1**3
    for edge, colour in zip(edges, COLOURS, strict=True):
        axes.plot(X1, edge, color=colour, lw=1.2)
        axes.fill_between(X1, edge, X2[0], color=colour, alpha=0.12, lw=0)


def levels(axes: Axes, function, values: FloatArray) -> None:  # type: ignore[no-untyped-def]
    """Level curves of a function of (2,)."""
    grid = np.array([[function(np.array([a, b])) for a in X1[::2]] for b in X2[::2]])
    grid = np.where(np.isfinite(grid), grid, np.nan)
    axes.contour(X1[::2], X2[::2], grid, levels=values, colors="0.7", linewidths=0.6)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python docs/pictures/plot_cubic.py FILE.png")
    main(sys.argv[1])
