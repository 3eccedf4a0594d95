"""Draws a front: energy over cycle time, and what each joint takes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...drawing.style import STYLE, figure_file

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ...problems.improve.energy import Front

_LINE, _GIVEN = "#1f4e9c", "#b3261e"
_JOINTS = ("#8a8a8a", "#1f4e9c", "#e08a1e", "#3a8a4d", "#8a4d9c", "#4d9c9c", "#9c7a4d")
_LEAST = 0.005
"""Share of the whole energy below which a joint gets no line."""


_FAR = 0.5
"""Spans of the front beyond which the given program is named instead of drawn."""


def draw_front(front: Front, names: Sequence[str], kind: str) -> bytes:
    """A figure of a front as a file of the kind ``png``, ``pdf`` or ``svg``."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        return figure_file(make_figure(front, names), kind)


def make_figure(front: Front, names: Sequence[str]) -> Figure:
    """The figure: the front at the left, joints at the right."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11, 4.8), layout="constrained")
    left, right = figure.subplots(1, 2, sharex=False)
    _draw_energy(left, front)
    _draw_joints(right, front, names)
    return figure


def _draw_energy(axes: Axes, front: Front) -> None:
    given = front.given
    time = np.array([point.duration for point in front.points])
    share = np.array([100.0 * point.energy / given.energy for point in front.points])
    # Between two programs nothing better than the faster one is known.
    axes.step(time, share, where="post", color=_LINE, linewidth=0.8, alpha=0.5)
    axes.plot(time, share, "o", color=_LINE, label="programs")
    for k, (t, e) in enumerate(zip(time, share, strict=True)):
        axes.annotate(str(k + 1), (t, e), xytext=(4, 4), textcoords="offset points", fontsize=8)
    if given.duration <= time[-1] + _FAR * np.ptp(time):
        axes.plot(given.duration, 100.0, "s", color=_GIVEN, zorder=1, label="as given")
    else:
        axes.plot([], [], "s", color=_GIVEN, label=f"as given: {given.duration:.3f} s, 100 %")
    whole = f" (100 % are {1e-3 * given.energy:.3g} kJ)" if front.unit == "J" else " (as torque²)"
    axes.set_title(f"time and energy{whole}")
    axes.set_xlabel("cycle time, s")
    axes.set_ylabel("energy, % of the given program's")
    axes.margins(x=0.08, y=0.12)  # numbers stand beside their points
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, 0.5 * (low + high) - 1.0), max(high, 0.5 * (low + high) + 1.0))
    axes.legend()


def _draw_joints(axes: Axes, front: Front, names: Sequence[str]) -> None:
    time = [point.duration for point in front.points]
    given = front.given.by_joint
    for j, name in enumerate(names):
        if abs(given[j]) < _LEAST * np.abs(given).sum():
            continue
        share = [100.0 * point.by_joint[j] / given[j] for point in front.points]
        axes.plot(time, share, "o-", color=_JOINTS[j % len(_JOINTS)], markersize=4, label=name)
    axes.set_title("energy of each joint")
    axes.set_xlabel("cycle time, s")
    axes.set_ylabel("% of the given program's")
    axes.legend()
