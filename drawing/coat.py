"""Draws a coat of paint: its thickness on the part, how it is spread, how fast the gun drives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import FloatArray
from .style import LIMIT, NOMINAL, SPEED, STYLE, figure_file

if TYPE_CHECKING:
    from matplotlib.axes import Axes


MICRON = 1e-6
SCALE = "RdBu_r"
"""Colours from too thin over right to too thick."""
LIGHT = np.array([0.35, -0.45, 0.82])
ARROWS = 120
"""Nozzle directions that are drawn, at most."""


@dataclass(frozen=True, eq=False)
class Painted:
    """A surface with its coat.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3) triangles that are painted.
        rest: (G, 3) triangles that are not.
        thickness: (V,) m; NaN where nothing is to be painted.
        target: m.
        tolerance: share of the target that the colours reach to.
    """

    vertices: FloatArray
    faces: NDArray[np.int64]
    rest: NDArray[np.int64]
    thickness: FloatArray
    target: float
    tolerance: float = 0.1


@dataclass(frozen=True, eq=False)
class GunCurve:
    """A gun's motion.

    Args:
        position: (W, 3) m.
        nozzle: (W, 3) unit vectors.
        speed: (W-1,) m/s.
        painting: (W-1,) whether the gun is on.
    """

    position: FloatArray
    nozzle: FloatArray
    speed: FloatArray
    painting: NDArray[np.bool_]


def draw_map(surface: Painted, title: str, kind: str) -> bytes:
    """The thickness on the part in space, as a file of the kind ``png``, ``pdf`` or ``svg``.

    The colour bar is centred on the target and ends at the tolerance; what is beyond has its ends'
    colours.
    """
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context({**STYLE, "axes.grid": False}):
        figure = Figure(figsize=(9.5, 6.0), layout="constrained")
        axes = figure.add_subplot(projection="3d")
        colours = _paint_surface(axes, surface)
        bar = figure.colorbar(colours, ax=axes, shrink=0.7, extend="both", pad=0.09)
        bar.set_label(
            f"thickness µm (target {surface.target / MICRON:g} ± {100 * surface.tolerance:g} %)"
        )
        axes.set_title(title)
        return figure_file(figure, kind)


def draw_curve(surface: Painted, curve: GunCurve, title: str, kind: str) -> bytes:
    """The curve over the part with nozzle directions, grey where the gun is off."""
    import matplotlib
    from matplotlib.figure import Figure
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    with matplotlib.rc_context({**STYLE, "axes.grid": False}):
        figure = Figure(figsize=(9.5, 6.0), layout="constrained")
        axes = figure.add_subplot(projection="3d")
        _grey_surface(axes, surface)
        ways = np.stack([curve.position[:-1], curve.position[1:]], axis=1)
        lines = Line3DCollection(ways[curve.painting], cmap="viridis", linewidths=2.0, zorder=5)
        lines.set_array(np.round(1e3 * curve.speed[curve.painting], 2))
        axes.add_collection3d(lines)
        if not curve.painting.all():
            off = Line3DCollection(ways[~curve.painting], colors=NOMINAL, linewidths=1.0, zorder=5)
            axes.add_collection3d(off)
        step = max(1, len(curve.position) // ARROWS)
        at, along = curve.position[::step], curve.nozzle[::step]
        length = 0.06 * float(np.ptp(curve.position, axis=0).max())
        axes.quiver(*at.T, *along.T, length=length, color=LIMIT, linewidth=0.7, zorder=6)
        axes.scatter(*curve.position[:1].T, color=LIMIT, s=25, zorder=7)
        points = np.concatenate([surface.vertices, curve.position])
        _frame(axes, points)
        figure.colorbar(lines, ax=axes, shrink=0.7, pad=0.09).set_label("programmed speed mm/s")
        axes.set_title(title)
        return figure_file(figure, kind)


def draw_spread(
    coats: Mapping[str, tuple[FloatArray, FloatArray]],
    target: float,
    speeds: Mapping[str, tuple[FloatArray, FloatArray]],
    tolerance: float,
    kind: str,
) -> bytes:
    """Histogram of the thickness at each stage, and the speed along the curve.

    Args:
        coats: by stage, thickness (V,) m and areas (V,) m².
        target: m.
        speeds: by stage, time (T,) s and speed (T,) m/s, drawn as steps.
        tolerance: share of the target that is marked.
        kind: of the file.
    """
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(12, 4.2), layout="constrained")
        left, right = figure.subplots(1, 2)
        _histogram(left, coats, target, tolerance)
        for (name, (time, speed)), colour in zip(
            speeds.items(), _COLOURS[-len(speeds) :], strict=True
        ):
            right.plot(time, 1e3 * speed, color=colour, linewidth=1.1, label=name)
        right.set(xlabel="time s", ylabel="speed mm/s", title="speed of the TCP")
        right.set_ylim(bottom=0.0)
        right.legend()
        return figure_file(figure, kind)


def draw_strokes(
    strokes: Sequence[tuple[str, FloatArray, FloatArray, FloatArray]], kind: str
) -> bytes:
    """Cross sections of strokes, measured and by the footprint.

    Args:
        strokes: what to call each, places (p,) m from its middle, thickness (p,) m as measured, and
            as the footprint gives it.
        kind: of the file.
    """
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(7.5, 4.2), layout="constrained")
        axes = figure.subplots()
        for k, (name, across, measured, fitted) in enumerate(strokes):
            colour = _COLOURS[1:][k % 3]
            axes.plot(1e3 * across, measured / MICRON, ".", color=colour, label=f"{name}, measured")
            axes.plot(1e3 * across, fitted / MICRON, color=colour, label="by the footprint")
        axes.set(xlabel="across the stroke mm", ylabel="thickness µm", title="strokes")
        axes.legend()
        return figure_file(figure, kind)


_COLOURS = (NOMINAL, "#7f5fa8", SPEED, "#e08a1e")


def _histogram(
    axes: Axes,
    coats: Mapping[str, tuple[FloatArray, FloatArray]],
    target: float,
    tolerance: float,
) -> None:
    from matplotlib.ticker import NullFormatter, StrMethodFormatter

    values = np.concatenate([thickness for thickness, _ in coats.values()]) / MICRON
    low, high = float(values.min()), float(values.max())
    edges = np.linspace(low, max(high, low + 1e-6), 121)
    for (name, (thickness, areas)), colour in zip(coats.items(), _COLOURS, strict=False):
        share = 100.0 * areas / areas.sum()
        axes.hist(
            thickness / MICRON,
            edges.tolist(),
            weights=share,
            histtype="step",
            color=colour,
            linewidth=1.3,
            label=name,
        )
    wanted = target / MICRON
    axes.axvspan(wanted * (1 - tolerance), wanted * (1 + tolerance), color="#e8efe4", zorder=0)
    axes.axvline(wanted, color=LIMIT, linewidth=0.8)
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_ylim(bottom=0.01)
    axes.set(
        xlabel="thickness µm",
        ylabel="share of the area %",
        title=f"thickness, target ± {100 * tolerance:g} % shaded",
    )
    axes.legend()


def _paint_surface(axes: Any, surface: Painted) -> Any:
    """Triangles coloured by the mean of their corners; returns what a colour bar is made of."""
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    wanted = surface.target / MICRON
    scale = Normalize(wanted * (1 - surface.tolerance), wanted * (1 + surface.tolerance))
    colours = colormaps[SCALE]
    value = surface.thickness[surface.faces].mean(axis=1) / MICRON
    rest = np.full((len(surface.rest), 4), (0.75, 0.75, 0.75, 1.0))
    faces = np.concatenate([surface.faces, surface.rest])
    colour = np.concatenate([colours(scale(value)), rest])
    shade = _shade(surface.vertices, faces)
    colour[:, :3] *= shade[:, None]
    axes.add_collection3d(
        Poly3DCollection(
            surface.vertices[faces], facecolors=colour, edgecolors=colour, linewidths=0.2
        )
    )
    _frame(axes, surface.vertices)
    return ScalarMappable(scale, colours)


def _grey_surface(axes: Any, surface: Painted) -> None:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    faces = np.concatenate([surface.faces, surface.rest])
    grey = np.full((len(faces), 4), (0.86, 0.86, 0.84, 0.9))
    grey[:, :3] *= _shade(surface.vertices, faces)[:, None]
    axes.add_collection3d(
        Poly3DCollection(surface.vertices[faces], facecolors=grey, edgecolors=grey, linewidths=0.2)
    )


def _shade(vertices: FloatArray, faces: NDArray[np.int64]) -> FloatArray:
    """(F,) brightness of triangles under a light; both sides alike."""
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    across = np.cross(b - a, c - a)
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-30)
    return np.asarray(0.8 + 0.2 * np.abs(across @ (LIGHT / np.linalg.norm(LIGHT))))


def _frame(axes: Any, points: FloatArray) -> None:
    from matplotlib.ticker import MaxNLocator

    low, high = points.min(axis=0), points.max(axis=0)
    span = np.maximum(high - low, 0.05 * float((high - low).max()))
    middle = 0.5 * (low + high)
    for name, value, width in zip("xyz", middle, span, strict=True):
        getattr(axes, f"set_{name}lim")(value - 0.52 * width, value + 0.52 * width)
        getattr(axes, f"set_{name}label")(f"{name} m")
        # Few numbers along a short side.
        getattr(axes, f"{name}axis").set_major_locator(
            MaxNLocator(max(1, round(5 * width / span.max())))
        )
    axes.set_box_aspect(span)
    axes.view_init(elev=38, azim=-62)
