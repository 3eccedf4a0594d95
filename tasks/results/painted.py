"""A painted part: its coats by stage, the program, and how it shows itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.errors import Note
from ...core.notebook import PictureCurve as Shown
from ...core.notebook import page, picture, table
from ...drawing.coat import GunCurve, Painted, draw_curve, draw_map, draw_spread, draw_strokes
from ...problems.paint.coating.coat import Coat
from ...problems.paint.executable.execute import Executable
from ...problems.paint.executable.station import Station
from ...problems.paint.painting import Painting
from ...problems.paint.spray.footprint_file import FootprintSource
from ...problems.paint.spray.strokes import section

COLUMNS = (
    ("", "left"),
    ("mean µm", "right"),
    ("std µm", "right"),
    ("min µm", "right"),
    ("max µm", "right"),
    ("±10 %", "right"),
    ("±5 %", "right"),
    ("transfer %", "right"),
    ("paint ml", "right"),
    ("time s", "right"),
)
TOLERANCE = 0.1
"""Share of the target to which colours reach."""
MICRON, MILLILITRE = 1e-6, 1e-6


@dataclass(frozen=True)
class PaintedPart:
    """What came of painting a part.

    Args:
        source: of the footprint.
        painting: the gun's motion and the coats without a robot.
        made: the program with its coat as emulated; None without a robot.
        texts: of the program, read back, by file name.
        inputs: the files that it was made from; they are not written over.
        station: robot, gun and the part's place; None without a robot.
    """

    source: FootprintSource
    painting: Painting
    made: Executable | None
    texts: Mapping[str, str]
    inputs: tuple[Path, ...] = ()
    station: Station | None = None

    @property
    def coats(self) -> dict[str, Coat]:
        """The coats by stage; the last one is what to expect."""
        coats = {str(stage): coat for stage, coat in self.painting.coats.items()}
        return coats if self.made is None else {**coats, "as emulated": self.made.coat}

    @property
    def proven(self) -> bool:
        """Whether the program is proven to keep its clearance; true where there is none."""
        proof = None if self.made is None else self.made.certificate
        return proof is None or proof.proven

    @property
    def notes(self) -> tuple[Note, ...]:
        """All that a user should know, once."""
        driven = () if self.made is None else self.made.notes
        return tuple(dict.fromkeys((*self.source.notes, *self.painting.notes, *driven)))

    @property
    def files(self) -> dict[str, bytes]:
        """The program, if there is one, and the pictures."""
        return {name: text.encode() for name, text in self.texts.items()} | self.pictures()

    def rows(self) -> list[tuple[str, ...]]:
        """A row for the coat of each stage."""
        return [(name, *_cells(coat)) for name, coat in self.coats.items()]

    def pictures(self) -> dict[str, bytes]:
        """Map, curve, spread and strokes drawn, by file name."""
        made = self.made

        part, judge = self.painting.judge.part, self.painting.judge
        coats = self.coats
        stage, last = list(coats.items())[-1]
        thickness = np.full(len(part.vertices), np.nan)
        thickness[part.painted] = last.thickness
        chosen = part.painted_faces
        surface = Painted(
            part.vertices,
            part.faces[chosen],
            part.faces[~chosen],
            thickness,
            judge.target,
            TOLERANCE,
        )
        curve = self.painting.best if made is None else made.planned
        spread = last.by_area
        title = (
            f"{part.name}, {stage}: {spread.mean / MICRON:.2f} ± {spread.std / MICRON:.2f} µm, "
            f"{spread.least / MICRON:.1f} to {spread.most / MICRON:.1f} µm"
        )
        speeds = {"programmed": (np.repeat(curve.times, 2)[1:-1], np.repeat(curve.speeds, 2))}
        if made is not None:
            driven = made.driven.trajectory
            speeds["as emulated"] = (driven.times[:-1] + 0.5 * driven.duration, driven.speeds)
        pictures = {
            "thickness.png": draw_map(surface, title, "png"),
            "curve.png": draw_curve(
                surface,
                GunCurve(curve.position, curve.nozzle, curve.speeds, curve.painting),
                f"{part.name}: {curve.total_length:.1f} m, {curve.total_duration:.1f} s",
                "png",
            ),
            "histogram.png": draw_spread(
                {name: (coat.thickness, coat.areas) for name, coat in coats.items()},
                judge.target,
                speeds,
                TOLERANCE,
                "png",
            ),
        }
        if self.source.strokes:
            pictures["strokes.png"] = draw_strokes(
                [
                    (
                        f"{1e3 * s.distance:.0f} mm, {1e3 * s.speed:.0f} mm/s",
                        s.across - s.centre,
                        s.thickness,
                        section(
                            self.source.footprint, s.across - s.centre, s.distance, s.speed, s.flow
                        ),
                    )
                    for s in self.source.strokes
                ],
                "png",
            )
        return pictures

    def __repr__(self) -> str:
        stage, coat = list(self.coats.items())[-1]
        spread = coat.by_area
        return (
            f"<Painting of {self.painting.judge.part.name}, {stage}: "
            f"{spread.mean / MICRON:.1f} ± {spread.std / MICRON:.1f} µm>"
        )

    def _repr_html_(self) -> str:
        best = self.painting.best if self.made is None else self.made.planned
        drawn = picture([Shown("gun", best.nozzle)])
        return page(repr(self)[1:-1], table(COLUMNS, self.rows()), drawn, notes=self.notes)


def _cells(coat: Coat) -> tuple[str, ...]:
    spread = coat.by_area
    lengths = (spread.mean, spread.std, spread.least, spread.most)
    shares = (spread.within_10_percent, spread.within_5_percent, coat.transfer_efficiency)
    return (
        *(f"{value / MICRON:.2f}" for value in lengths),
        *(f"{100.0 * value:.1f}" for value in shares),
        f"{coat.paint / MILLILITRE:.1f}",
        f"{coat.duration:.1f}",
    )
