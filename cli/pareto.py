"""``flyby pareto``: what can be had between the cycle time of a program and its energy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..tasks.files.outputs import (
    check_folder,
    check_outputs,
    picture_kind,
    write_all,
    write_in,
)
from ..tasks.files.source_places import note_json
from ..tasks.pages.file import check_page, write_page
from ..tasks.pareto import ParetoOptions, pareto_with
from ..tasks.read import SourceOptions
from ..tasks.setup import setup_of_program
from .output.console import print_json, print_rich, print_table, progress, warn_of
from .output.told_robot import read_for_robot
from .parameters import AsJson, Force, Out, PageFile, ProgramFile, with_options

if TYPE_CHECKING:
    from ..core.robot.model import Robot
    from ..problems.improve.energy import Front, FrontPoint
    from ..tasks.results.fronts import ProgramFront


@with_options
def pareto(
    program: ProgramFile,
    source: SourceOptions,
    options: ParetoOptions,
    out: Out = None,
    plot: Annotated[Path | None, typer.Option(help="Draw the front: PNG, PDF or SVG.")] = None,
    report: PageFile = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Find programs from the fastest to the most frugal, each as code of its own.

    With --out each gets a folder: point-1 is the fastest. In a cell each is proven to keep its
    clearance, as read from its text.
    """
    inputs = [program, *source.inputs(), *options.inputs()]
    check_folder("--out", out)
    if plot is not None:
        picture_kind(plot, "--plot")
    check_outputs({"--plot": plot}, inputs, force)
    check_page(report, inputs, force)
    with progress("reading the program") as say:
        read = read_for_robot(program, source, writes=out is not None)
        robot = setup_of_program(read).robot
        made = pareto_with(read, replace(options, report=say))
        written = _written(made, out, inputs, force)
        if plot is not None and made.points:
            say("drawing")
            write_all("--plot", {plot: made.picture(picture_kind(plot, "--plot"))})
        if report is not None:
            say("making the page")
        paged = write_page(report, made)
    drawn = plot if made.points else None
    if json:
        print_json(_json(made, robot, written, drawn))
    else:
        _tell(made, written, drawn)
        for path in paged:
            print_rich(f"wrote {path}")
        if out is None:
            print_rich("nothing was written: --out FOLDER writes the programs")
    if not made.proven:
        raise typer.Exit(1)


def _written(
    made: ProgramFront, out: Path | None, inputs: Sequence[Path], force: bool
) -> list[list[Path]]:
    """The files of each program; empty if there is no folder for them."""
    if out is None:
        return []
    files = {Path(name): data for name, data in made.files.items()}
    written = write_in("--out", out, files, inputs, force)
    folders = [out / f"point-{k + 1}" for k in range(len(made.points))]
    return [[path for path in written if path.parent == folder] for folder in folders]


def _tell(made: ProgramFront, written: Sequence[Sequence[Path]], plot: Path | None) -> None:
    print_table(made.columns(), made.rows())
    warn_of(made.notes)
    for paths in written:
        for path in paths:
            print_rich(f"wrote {path}")
    if plot is not None:
        print_rich(f"wrote {plot}")


def _json(
    made: Front, robot: Robot, written: Sequence[Sequence[Path]], plot: Path | None
) -> dict[str, Any]:
    files: list[list[str]] = [[str(path) for path in paths] for paths in written]
    return {
        "robot": robot.name,
        "unit": made.unit,
        "proven": made.proven,
        "given": _point_json(made.given, []),
        "points": [
            _point_json(point, files[k] if files else []) for k, point in enumerate(made.points)
        ],
        "notes": [note_json(note) for note in made.notes],
        "files": [] if plot is None else [str(plot)],
    }


def _point_json(point: FrontPoint, files: list[str]) -> dict[str, Any]:
    proof = point.certificate
    return {
        "time_s": point.duration,
        "energy": point.energy,
        "energy_by_joint": [float(value) for value in point.by_joint],
        "proven": None if proof is None else proof.proven,
        "certificate": None if proof is None else proof.message,
        "files": files,
    }
