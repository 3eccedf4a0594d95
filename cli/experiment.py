"""``flyby experiment`` and ``flyby record``: programs that log themselves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.display import counted
from ..tasks.experiment import ExperimentOptions, experiment_with
from ..tasks.files.outputs import check_folder, check_outputs, write_in
from ..tasks.read import SourceOptions
from ..tasks.record import RecordOptions, record_with
from .output.console import print_json, print_rich, print_table, progress, warn
from .output.told_robot import read_for_robot
from .parameters import AsJson, Force, ProgramFile, with_options

if TYPE_CHECKING:
    from ..identification.experiment.plan import Experiment
    from ..tasks.results.experiments import DesignedExperiment


@with_options
def experiment(
    options: ExperimentOptions,
    out: Annotated[Path, typer.Option("--out", help="Folder to write programs and records to.")],
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Design test motions for a robot in its cell, and write programs that log themselves."""
    check_folder("--out", out)
    inputs = options.inputs()
    if out.is_dir():
        from ..tasks.results.experiments import PAGE

        # Said before the work, not after it: the page is always written.
        check_outputs({"--out": [out / PAGE]}, inputs, force)
    with progress("reading the robot") as say:
        made = experiment_with(replace(options, report=say))
        say("writing")
        files = {Path(name): data for name, data in made.files.items()}
        written = write_in("--out", out, files, inputs, force)
    if json:
        print_json(_json(made.experiment, written))
    else:
        _tell(made, out)


def _tell(found: DesignedExperiment, out: Path) -> None:
    from ..tasks.results.experiments import COLUMNS, PAGE

    made = found.experiment
    print_table(COLUMNS, found.rows())
    for line in found.topics():
        print_rich(line)
    for note in made.notes:
        warn(note)
    print_rich(
        f"{counted(made.runs, 'run')} for {made.robot.name}, {made.seconds / 60:.0f} min at the "
        f"robot; not possible: {len(made.skipped)}, without time: {len(made.unused)}",
        f"wrote {out}; take {out / PAGE} to the robot",
    )


def _json(made: Experiment, written: list[Path]) -> dict[str, Any]:
    """SI units, in the keys."""
    from ..identification.experiment.record import corner_data, purpose_data

    return {
        "robot": made.robot.name,
        "period_s": made.period,
        "seconds_s": made.seconds,
        "postures_rad": [site.q.tolist() for site in made.sites],
        "runs": [
            {
                "name": run.candidate.name,
                "kind": str(run.candidate.kind),
                "posture": run.candidate.posture + 1,
                "speed_mps": run.candidate.speed,
                "corners": [corner_data(corner) for corner in run.candidate.corners],
                **purpose_data(run),
                "duration_s": run.duration,
                "gain_nats": run.gain,
                "clearance": None if run.certificate is None else run.certificate.message,
                "way_proven": run.way_proven,
            }
            for run in made.runs
        ],
        "precision": [
            {"figure": one.key, "before": one.before, "after": one.after} for one in made.precision
        ],
        "skipped": [{"what": one.what, "reason": one.reason} for one in made.skipped],
        "unused": [{"what": one.what, "reason": one.reason} for one in made.unused],
        "notes": list(made.notes),
        "files": [str(path) for path in written],
    }


@with_options
def record(
    program: ProgramFile,
    source: SourceOptions,
    options: RecordOptions,
    out: Annotated[Path, typer.Option("--out", help="Folder to write the files to.")],
    force: Force = False,
) -> None:
    """Write a program that drives the same moves and logs joints with time on the controller."""
    check_folder("--out", out)
    with progress("reading the program"):
        made = record_with(read_for_robot(program, source, writes=True), options)
        files = {Path(name): data for name, data in made.files.items()}
        written = write_in("--out", out, files, [program, *source.inputs()], force)
    for path in written:
        print_rich(f"wrote {path}")
