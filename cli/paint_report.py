"""What ``flyby paint`` says and draws of a painting."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .console import print_rich, print_table, warn
from .places import note_json

if TYPE_CHECKING:
    from ..core.errors import Note
    from ..problems.paint.coating.coat import Coat
    from ..problems.paint.executable.execute import Executable
    from ..problems.paint.painting import Painting
    from ..problems.paint.spray.footprint_file import FootprintSource

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


def coats_of(painting: Painting, made: Executable | None) -> dict[str, Coat]:
    """The coats by stage."""
    coats = {str(stage): coat for stage, coat in painting.coats.items()}
    return coats if made is None else {**coats, "as emulated": made.coat}


def notes_of(
    source: FootprintSource, painting: Painting, made: Executable | None
) -> tuple[Note, ...]:
    """All that a user should know, once."""
    driven = () if made is None else made.notes
    return tuple(dict.fromkeys((*source.notes, *painting.notes, *driven)))


def pictures_of(
    source: FootprintSource, painting: Painting, made: Executable | None
) -> dict[str, bytes]:
    """The pictures by file name."""
    import numpy as np

    from ..drawing.coat import Curve, Painted, draw_curve, draw_map, draw_spread, draw_strokes
    from ..problems.paint.spray.strokes import section

    part, judge = painting.judge.part, painting.judge
    coats = coats_of(painting, made)
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
    curve = painting.best if made is None else made.planned
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
            Curve(curve.position, curve.nozzle, curve.speeds, curve.painting),
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
    if source.strokes:
        pictures["strokes.png"] = draw_strokes(
            [
                (
                    f"{1e3 * s.distance:.0f} mm, {1e3 * s.speed:.0f} mm/s",
                    s.across - s.centre,
                    s.thickness,
                    section(source.footprint, s.across - s.centre, s.distance, s.speed, s.flow),
                )
                for s in source.strokes
            ],
            "png",
        )
    return pictures


def tell(
    source: FootprintSource,
    painting: Painting,
    made: Executable | None,
    written: Sequence[Path],
) -> None:
    """Print the table, notes, the proof and what was written."""
    rows = [(name, *_cells(coat)) for name, coat in coats_of(painting, made).items()]
    print_table(COLUMNS, rows, f"target {painting.judge.target / MICRON:g} µm")
    if source.fit is not None:
        print_rich(
            f"footprint fitted to {len(source.strokes)} strokes: off by "
            f"{source.fit.rms / MICRON:.2g} µm (rms), {source.fit.largest / MICRON:.2g} µm at most"
        )
    gap = painting.speeds.duality_gap
    print_rich(f"speed only: no speeds along the first curve are better by more than {gap:.1g}")
    if painting.interrupted:
        warn("the optimisation was interrupted: this is the best that it had found")
    for note in notes_of(source, painting, made):
        warn(str(note))
    if made is not None:
        tried = ", ".join(f"{std / MICRON:.2f}" for std in made.rounds)
        print_rich(f"as emulated, by round of correction: std {tried} µm")
        if made.certificate is not None:
            say = print_rich if made.certificate.proven else warn
            say(str(made.certificate))
            from ..core.cell.floor import FLOOR, LIFT

            if not made.certificate.proven and FLOOR in made.certificate.message:
                warn(LIFT)
    for path in written:
        print_rich(f"wrote {path}")


def report_json(
    source: FootprintSource,
    painting: Painting,
    made: Executable | None,
    written: Sequence[Path],
) -> dict[str, Any]:
    """The same for ``--json``, in SI units."""
    proof = None if made is None else made.certificate
    return {
        "part": painting.judge.part.name,
        "target_m": painting.judge.target,
        "area_m2": painting.judge.part.painted_area,
        "stages": {name: _figures(coat) for name, coat in coats_of(painting, made).items()},
        "speed_only": {
            "objective_m4": painting.speeds.objective,
            "duality_gap": painting.speeds.duality_gap,
        },
        "footprint_fit": None
        if source.fit is None
        else {"rms_m": source.fit.rms, "largest_m": source.fit.largest},
        "rounds_std_m": None if made is None else list(made.rounds),
        "proven": None if proof is None else proof.proven,
        "certificate": None if proof is None else proof.message,
        "interrupted": painting.interrupted,
        "notes": [note_json(note) for note in notes_of(source, painting, made)],
        "files": [str(path) for path in written],
    }


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


def _figures(coat: Coat) -> Mapping[str, float]:
    spread = coat.by_area
    return {
        "mean_m": spread.mean,
        "std_m": spread.std,
        "min_m": spread.least,
        "max_m": spread.most,
        "within_10_percent": spread.within_10_percent,
        "within_5_percent": spread.within_5_percent,
        "transfer_efficiency": coat.transfer_efficiency,
        "paint_m3": coat.paint,
        "duration_s": coat.duration,
    }
