"""One look for all pictures."""

from __future__ import annotations

from typing import Any

DPI = 150
NOMINAL, ZONE, STOP, LIMIT, SPEED = "#8a8a8a", "#e08a1e", "#b3261e", "#b3261e", "#1f4e9c"
STYLE: dict[str, Any] = {
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.7,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "svg.hashsalt": "flyby",
}
