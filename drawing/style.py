"""One look for all pictures, and one way into a file."""

from __future__ import annotations

import io
import warnings
from typing import TYPE_CHECKING, Any

from ..core.display import shown

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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
    "text.parse_math": False,  # names hold what they hold, $ as well
}
_UNDATED = {"png": None, "pdf": {"CreationDate": None}, "svg": {"Date": None}}


def figure_file(figure: Figure, kind: str) -> bytes:
    """A figure as a file of the kind ``png``, ``pdf`` or ``svg``: the same figure, the same bytes.

    Text is drawn as it stands; characters that are none show as the sign for that.
    """
    from matplotlib.text import Text

    for text in figure.findobj(Text):
        text.set_text(shown(text.get_text()))
    buffer = io.BytesIO()
    with warnings.catch_warnings():
        # A name may hold letters that the font has not; they show as boxes.
        warnings.filterwarnings("ignore", r"Glyph .* missing from")
        figure.savefig(buffer, format=kind, dpi=DPI, metadata=_UNDATED[kind])
    return buffer.getvalue()
