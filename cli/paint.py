"""``flyby paint``: a robot program that leaves an even coat on a part, and the map to prove it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.display import counted
from ..tasks.files.outputs import check_folder, check_outputs, write_in
from ..tasks.files.source_places import note_json
from ..tasks.pages.file import check_page, write_page
from ..tasks.paint import paint_with
from ..tasks.painting.options import PaintOptions
from .output.console import print_json, print_rich, print_table, progress, warn, warn_of
from .parameters import AsJson, Force, PageFile, with_options

if TYPE_CHECKING:
    from ..problems.paint.coating.coat import Coat
    from ..tasks.results.painted import PaintedPart

PICTURES = ("thickness.png", "curve.png", "histogram.png", "strokes.png")


@with_options
def paint(
    part: Annotated[Path, typer.Argument(help="The part: STL, PLY, OBJ, OFF, GLB or 3MF.")],
    footprint: Annotated[
        Path, typer.Option("--footprint", help="The gun's footprint, or measured strokes (TOML).")
    ],
    options: PaintOptions,
    unproven: Annotated[
        bool, typer.Option("--unproven", help="Write the program even if it is not proven.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder for program and pictures.")
    ] = None,
    report: PageFile = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Paint a part evenly: first curve, optimisation, program, and the coat as emulated.

    Without --robot or --cell there is no program: curve, thickness and pictures alone.
    """
    inputs = [part, footprint, *options.inputs()]
    check_folder("--out", out)
    if out is not None and out.is_dir():
        check_outputs({"--out": [out / name for name in PICTURES]}, inputs, force)
    check_page(report, inputs, force)
    with progress("reading the part") as say:
        found = paint_with(part, footprint, replace(options, report=say))
        written: list[Path] = []
        if out is not None:
            say("drawing")
            files = found.files if found.proven or unproven else found.pictures()
            written = write_in(
                "--out", out, {Path(name): data for name, data in files.items()}, inputs, force
            )
        if report is not None:
            say("making the page")
        written += write_page(report, found)
    if json:
        print_json(_json(found, written))
    else:
        _tell(found, written)
    if not found.proven:
        if out is not None and not unproven:
            warn("the program is not written, since it is not proven; --unproven writes it")
        raise typer.Exit(1)


def _tell(found: PaintedPart, written: Sequence[Path]) -> None:
    """Print the table, notes, the proof and what was written."""
    from ..tasks.results.painted import COLUMNS, MICRON

    source, painting, made = found.source, found.painting, found.made
    print_table(COLUMNS, found.rows(), f"target {painting.judge.target / MICRON:g} µm")
    if source.fit is not None:
        print_rich(
            f"footprint fitted to {counted(source.strokes, 'stroke')}: off by "
            f"{source.fit.rms / MICRON:.2g} µm (rms), {source.fit.largest / MICRON:.2g} µm at most"
        )
    gap = painting.speeds.duality_gap
    print_rich(f"speed only: no speeds along the first curve are better by more than {gap:.1g}")
    if painting.interrupted:
        warn("the optimisation was interrupted: this is the best that it had found")
    warn_of(found.notes)
    if made is not None:
        tried = ", ".join(f"{std / MICRON:.2f}" for std in made.rounds)
        print_rich(f"as emulated, by round of correction: std {tried} µm")
        if made.certificate is not None:
            say = print_rich if made.certificate.proven else warn
            say(str(made.certificate))
            from ..core.cell.floor import FLOOR, lifted

            if not made.certificate.proven and FLOOR in made.certificate.message:
                warn(lifted())
    for path in written:
        print_rich(f"wrote {path}")


def _json(found: PaintedPart, written: Sequence[Path]) -> dict[str, Any]:
    """The same for ``--json``, in SI units."""
    source, painting, made = found.source, found.painting, found.made
    proof = None if made is None else made.certificate
    return {
        "part": painting.judge.part.name,
        "target_m": painting.judge.target,
        "area_m2": painting.judge.part.painted_area,
        "stages": {name: _figures(coat) for name, coat in found.coats.items()},
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
        "notes": [note_json(note) for note in found.notes],
        "files": [str(path) for path in written],
    }


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
