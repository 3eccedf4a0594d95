"""How results show themselves in notebooks: a table, and a small picture of paths as SVG."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING

from .display import shown

if TYPE_CHECKING:
    from .arrays import FloatArray

WIDTH, HEIGHT, MARGIN = 300, 200, 14
"""Pixels of a picture."""
MOST_ROWS = 40
"""Rows that a table shows before it says how many more there are."""
_MOST_POINTS = 400
_COLOURS = ("#1f4e9c", "#e08a1e", "#3a8a4d", "#b3261e")
_CELL = "padding:1px 8px;text-align:"
_UNBROKEN = 32
"""Characters of a cell that stays in one line; longer ones are prose."""


@dataclass(frozen=True)
class PictureCurve:
    """A curve of a picture.

    Args:
        name: what it is; those of one name have one colour.
        points: (P, 3) m in the world, or (P, 2) in any units.
        marks: (M, 3) or (M, 2), points of it that are marked.
    """

    name: str
    points: FloatArray
    marks: FloatArray | None = None


def page(title: str, *parts: str, notes: Iterable[object] = ()) -> str:
    """A result as HTML: its title, tables and pictures, and what the user should know."""
    listed = "".join(f"<li>{_text(note)}</li>" for note in notes)
    below = f"<ul>{listed}</ul>" if listed else ""
    return f"<div><b>{_text(title)}</b>{''.join(parts)}{below}</div>"


def table(columns: Sequence[tuple[str, str]], rows: Sequence[Sequence[str]]) -> str:
    """A table as HTML.

    Args:
        columns: heading and ``left`` or ``right`` of each, as at the command line.
        rows: cells as text; of many the first are shown.
    """
    sides = [side for _, side in columns]
    head = "".join(f'<th style="{_CELL}{side}">{_text(name)}</th>' for name, side in columns)
    body = "".join(f"<tr>{_cells(row, sides)}</tr>" for row in rows[:MOST_ROWS])
    more = len(rows) - MOST_ROWS
    if more > 0:
        body += f'<tr><td colspan="{len(columns)}">… and {more} more</td></tr>'
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def picture(curves: Sequence[PictureCurve], units: str = "m") -> str:
    """Curves as SVG; those in space are seen along the axis along which they reach least."""
    import numpy as np

    every = np.concatenate([curve.points for curve in curves])
    axes, plane = _seen(every)
    low, high = every[:, axes].min(axis=0), every[:, axes].max(axis=0)
    reach = np.maximum(high - low, 1e-9)
    size = np.array([WIDTH, HEIGHT]) - 2 * MARGIN
    # In space both axes have one scale.
    scale = np.full(2, (size / reach).min()) if every.shape[1] == 3 else size / reach

    def placed(points: FloatArray) -> FloatArray:
        at = (points[:, axes] - low) * scale + MARGIN
        at[:, 1] = HEIGHT - at[:, 1]
        return np.asarray(at)

    names = dict.fromkeys(curve.name for curve in curves)
    colours = dict(zip(names, cycle(_COLOURS)))
    drawn = [
        _drawn(placed(_thinned(curve.points)), curve, colours[curve.name], placed)
        for curve in curves
    ]
    legend = "; ".join(
        f'<tspan fill="{colour}">{_text(name)}</tspan>' for name, colour in colours.items()
    )
    told = f"{plane}{reach[0]:.3g} × {reach[1]:.3g} {units}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT + 16}" '
        f'viewBox="0 0 {WIDTH} {HEIGHT + 16}" font-family="sans-serif" font-size="10">'
        f"{''.join(drawn)}"
        f'<text x="{MARGIN}" y="{HEIGHT + 10}">{legend}: {_text(told)}</text></svg>'
    )


def _seen(points: FloatArray) -> tuple[list[int], str]:
    """The two axes that are seen, and their names."""
    import numpy as np

    if points.shape[1] == 2:
        return [0, 1], ""
    hidden = int(np.argmin(np.ptp(points, axis=0)[[1, 0, 2]]))
    hidden = [1, 0, 2][hidden]
    axes = [k for k in range(3) if k != hidden]
    return axes, "".join("xyz"[k] for k in axes) + ", "


def _thinned(points: FloatArray) -> FloatArray:
    step = max(1, len(points) // _MOST_POINTS)
    import numpy as np

    return np.concatenate([points[:-1:step], points[-1:]])


def _drawn(at: FloatArray, curve: PictureCurve, colour: str, placed: object) -> str:
    line = " ".join(f"{x:.1f},{y:.1f}" for x, y in at)
    drawn = f'<polyline fill="none" stroke="{colour}" stroke-width="1.5" points="{line}"/>'
    if curve.marks is not None and callable(placed):
        drawn += "".join(
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2" fill="{colour}"/>'
            for x, y in placed(curve.marks)
        )
    return drawn


def _cells(row: Sequence[str], sides: Sequence[str]) -> str:
    return "".join(
        f'<td style="{_CELL}{side}{_kept(cell)}">{_text(cell)}</td>'
        for cell, side in zip(row, sides, strict=True)
    )


def _kept(cell: str) -> str:
    return ";white-space:nowrap" if len(cell) <= _UNBROKEN else ""


def _text(value: object) -> str:
    return html.escape(shown(str(value))).replace("\n", " ")
