"""``flyby free`` and ``flyby tune``: motions that no program language stands in the way of."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..tasks.files.outputs import check_outputs, picture_kind, write_all
from ..tasks.free_motion.free_motion import FreeMotionOptions, free_motion_with
from ..tasks.free_motion.tune import TuneOptions, tune_with
from ..tasks.read import SourceOptions
from .output.console import print_json, print_rich, print_table, progress, warn, warn_of
from .output.told_robot import read_for_robot
from .parameters import AsJson, Force, ProgramFile, with_options

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..tasks.results.motions import FreeMotion, TunedMotion

Csv = Annotated[Path | None, typer.Option("--csv", help="Write the motion as CSV.")]
Plot = Annotated[Path | None, typer.Option("--plot", help="Draw the joints: PNG, PDF or SVG.")]


@with_options
def free(
    start: Annotated[
        str, typer.Option("--start", help="Axis values at rest, degrees and mm: 0,0,0,0,30,0.")
    ],
    goal: Annotated[str, typer.Option("--goal", help="Axis values to come to rest at.")],
    options: FreeMotionOptions,
    csv: Csv = None,
    plot: Plot = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Find how fast the robot could move if no program language stood in the way.

    What is found is a sampled motion, no robot code. The exit status is 1 if it is not proven to
    keep its clearance.
    """
    _check(csv, plot, options.inputs(), force)
    with progress("reading the robot") as say:
        found = free_motion_with(start, goal, replace(options, report=say))
        written = _write(found, csv, plot)
    optimum = found.optimum
    proof = optimum.certificate
    if json:
        print_json(
            {
                "robot": found.robot.name,
                "time_s": found.duration,
                "first_time_s": optimum.first.duration,
                "energy": found.energy,
                "unit": found.consumption.unit,
                "largest_share_of_a_limit": optimum.audit.used,
                "converged": optimum.converged,
                "proven": None if proof is None else proof.proven,
                "certificate": None if proof is None else proof.message,
                "notes": [str(note) for note in found.notes],
                "files": [str(path) for path in written],
            }
        )
    else:
        _tell(found, written)
        if proof is not None:
            (print_rich if proof.proven else warn)(str(proof))
    warn_of(found.notes)
    if not found.proven:
        raise typer.Exit(1)


@with_options
def tune(
    program: ProgramFile,
    source: SourceOptions,
    options: TuneOptions,
    csv: Csv = None,
    plot: Plot = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Find how fast the path of a program could be passed, with a speed of its own everywhere.

    What is found is a sampled motion, no robot code: a program has one speed a move.
    """
    _check(csv, plot, [program, *source.inputs(), *options.inputs()], force)
    with progress("reading the program") as say:
        found = tune_with(read_for_robot(program, source), replace(options, report=say))
        written = _write(found, csv, plot)
    if json:
        print_json(
            {
                "program": found.program.name,
                "robot": found.robot.name,
                "programmed_time_s": found.before,
                "time_s": found.duration,
                "energy": found.energy,
                "unit": found.tuned.task.objective.consumption.unit,
                "way": str(found.tuned.way),
                "limits": [{"name": name, "share": share} for name, share in found.limits()],
                "files": [str(path) for path in written],
            }
        )
        return
    _tell(found, written)


def _check(csv: Path | None, plot: Path | None, inputs: Sequence[Path], force: bool) -> None:
    if plot is not None:
        picture_kind(plot, "--plot")
    check_outputs({"--csv": csv, "--plot": plot}, inputs, force)


def _write(found: FreeMotion | TunedMotion, csv: Path | None, plot: Path | None) -> list[Path]:
    made: dict[Path, bytes] = {}
    if csv is not None:
        made[csv] = found.trajectory.csv()
    if plot is not None:
        made[plot] = found.picture(picture_kind(plot, "--plot"))
    write_all("--csv and --plot", made)
    return list(made)


def _tell(found: FreeMotion | TunedMotion, written: Sequence[Path]) -> None:
    from ..tasks.results.motions import COLUMNS

    print_table(COLUMNS, found.rows())
    print_rich(repr(found)[1:-1])
    for path in written:
        print_rich(f"wrote {path}")
