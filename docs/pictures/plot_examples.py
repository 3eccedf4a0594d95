"""Draws the pictures of docs/examples.md from the shipped examples.

Run it as ``python docs/pictures/plot_examples.py docs/pictures``.
"""

from __future__ import annotations

import io
import sys
from pathlib import Path

import matplotlib
from matplotlib.figure import Figure

import flyby
from flyby.drawing.cell import make_cell_figure
from flyby.drawing.run import make_figure
from flyby.drawing.station import make_station_figure
from flyby.drawing.style import STYLE

matplotlib.use("Agg")
EXAMPLES = Path(__file__).parents[2] / "examples"
DPI = 64
"""Of a page; the files are small."""


def abb() -> Figure:
    """A routine of the ABB station, as driven."""
    run = flyby.emulate(flyby.read(EXAMPLES / "station", entry="Pick"))
    return make_figure(run, run.robot)


def kuka() -> Figure:
    """The KUKA archive in its cell, before and after its zones have grown."""
    cell = EXAMPLES / "cell" / "press.toml"
    program = flyby.read(EXAMPLES / "kuka_archive", entry="PRESS", cell=cell)
    made = flyby.zones(program)
    runs = [
        (name, flyby.emulate(one).whole)
        for name, one in (("before", made.original), ("after", made.program))
    ]
    return make_cell_figure(flyby.cell(cell), runs)


def ur() -> Figure:
    """The UR program, as driven on its bench."""
    cell = EXAMPLES / "cell" / "bench.toml"
    run = flyby.emulate(flyby.read(EXAMPLES / "ur_programs", cell=cell))
    return make_figure(run, run.robot)


def station() -> Figure:
    """The four robots that weld studs, on one clock."""
    made = flyby.station(EXAMPLES / "stud_station" / "station.toml", no_proof=True)
    return make_station_figure(made.station, made.run, made.actions)


PICTURES = {"example_abb": abb, "example_kuka": kuka, "example_ur": ur, "example_station": station}


def main(folder: str, names: tuple[str, ...] = tuple(PICTURES)) -> None:
    """Write the pictures."""
    with matplotlib.rc_context(STYLE):
        for name in names:
            buffer = io.BytesIO()
            PICTURES[name]().savefig(buffer, format="png", dpi=DPI, metadata={})
            (Path(folder) / f"{name}.png").write_bytes(buffer.getvalue())


if __name__ == "__main__":
    main(sys.argv[1])
