"""``flyby emulate``: drive a program and tell what came of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..core.errors import InputError
from ..core.source.write.options import OpaqueStyle
from .console import print_json, print_rich, progress
from .loading import Source, robot_of, start_of
from .options import (
    AnswersFile,
    AsJson,
    CellFile,
    Entry,
    Force,
    MotionFile,
    OtherFiles,
    ProgramFile,
    RobotName,
    Start,
)
from .outputs import check_outputs, check_plot_name, write_all

if TYPE_CHECKING:
    from ..core.motion.emulator.run import Run
    from ..core.program.program import Program
    from ..core.program.target import JointTarget
    from ..core.robot.model import Robot
    from ..core.vendor import Vendor

LEAST_PERIOD = 1e-5
"""s. A cycle of a minute then makes six million samples."""


@dataclass(frozen=True)
class _Files:
    """Where results go, by option."""

    csv: Path | None
    npz: Path | None
    plot: Path | None
    write: Path | None

    def by_option(self) -> dict[str, Path | None]:
        """The paths by the options that named them."""
        return {f"--{name}": getattr(self, name) for name in self.__dataclass_fields__}


def emulate(
    program: ProgramFile,
    robot: RobotName = None,
    cell: CellFile = None,
    motion: MotionFile = None,
    entry: Entry = None,
    io: AnswersFile = None,
    others: OtherFiles = None,
    start: Start = None,
    period: Annotated[
        float | None, typer.Option(help="Seconds between samples; the controller's own if unset.")
    ] = None,
    csv: Annotated[Path | None, typer.Option(help="Write the trajectory as CSV.")] = None,
    npz: Annotated[Path | None, typer.Option(help="Write the trajectory as NumPy arrays.")] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw path and motion: PNG, PDF or SVG.")
    ] = None,
    write: Annotated[
        Path | None,
        typer.Option(
            help="Write the program anew, all moves in one routine, as it was driven: a file, "
            "beside which further ones are put if the language takes several, or a folder."
        ),
    ] = None,
    opaque: Annotated[
        OpaqueStyle | None,
        typer.Option(
            help="With --write: statements that do not move the robot are kept as they stand "
            "(the default), or become comments."
        ),
    ] = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Drive a program as the robot's controller would: cycle time, path, what limits each move."""
    source = Source.of(program, entry, io, others, start)
    files = _Files(csv, npz, plot, write)
    _check_opaque(opaque, write)
    check_plot_name(plot)
    outputs = files.by_option()
    if write is not None and write.is_dir():
        del outputs["--write"]
    inputs = source.inputs(cell, motion)
    check_outputs(outputs, inputs, replace_existing=force)
    if period is not None and not LEAST_PERIOD <= period < float("inf"):
        raise InputError(f"--period must be at least {LEAST_PERIOD:g} s, not {period}")
    with progress("reading the program") as say:
        vendor, arm = robot_of(robot, cell, motion)
        parsed = source.read(vendor, arm)
        stand = start_of(start, arm)
        say(f"emulating {len(parsed.moves)} moves")
        run = _run(vendor, arm, parsed, stand, period)
        say("writing results")
        made = _write_files(files, vendor, arm, run, inputs, _options(opaque), force)
    _tell(run, arm, as_json=json)
    if not json:
        for path in made:
            print_rich(f"wrote {path}")


def _check_opaque(style: OpaqueStyle | None, write: Path | None) -> None:
    if style is not None and write is None:
        raise InputError(f"--opaque {style} is of the program that --write writes: name its file")


def _options(style: OpaqueStyle | None) -> dict[str, str]:
    """The writer's options; what is not asked for is the writer's own choice."""
    return {} if style is None else {"opaque": style.value}


def _run(
    vendor: Vendor, robot: Robot, program: Program, start: JointTarget | None, period: float | None
) -> Run:
    from ..core.motion.emulator.controller import Controller

    return Controller(vendor, robot).run(program, start, period)


def _write_files(
    files: _Files,
    vendor: Vendor,
    robot: Robot,
    run: Run,
    inputs: Sequence[Path],
    options: Mapping[str, str],
    replace_existing: bool,
) -> list[Path]:
    """Make everything that can fail first, then write; returns what was written."""
    made: dict[Path, bytes] = {}
    if files.csv is not None:
        made[files.csv] = run.trajectory.csv()
    if files.npz is not None:
        made[files.npz] = run.trajectory.npz()
    if files.write is not None:
        sources = _sources(files.write, vendor, robot, run.program, options)
        check_outputs({f"--write: {path.name}": path for path in sources}, inputs, replace_existing)
        made |= {path: text.encode() for path, text in sources.items()}
    if files.plot is not None:
        from ..drawing.run import draw

        made[files.plot] = draw(run, robot, files.plot.suffix.lower()[1:])
    write_all(", ".join(option for option, path in files.by_option().items() if path), made)
    return list(made)


def _sources(
    path: Path, vendor: Vendor, robot: Robot, program: Program, options: Mapping[str, str]
) -> dict[Path, str]:
    """The program's source files by where they go."""
    sources = vendor.write(program, robot, options)
    if path.is_dir():
        return {path / name: text for name, text in sources.items()}
    if len(sources) == 1:
        return {path: next(iter(sources.values()))}
    # Files that belong together are called alike, and often named inside as well.
    sources = vendor.write(replace(program, name=path.stem), robot, options)
    suffixes = [Path(name).suffix for name in sources]
    if path.suffix.lower() not in map(str.lower, suffixes):
        raise InputError(
            f"--write {path}: the program takes several files; the name ends in "
            f"{' or '.join(suffixes)}, or is a folder that exists"
        )
    return {path.with_suffix(Path(name).suffix): text for name, text in sources.items()}


def _tell(run: Run, robot: Robot, *, as_json: bool) -> None:
    from .report import make_report
    from .report_text import print_notes, print_report, report_json

    report = make_report(run, robot)
    if not as_json:
        print_report(report)
        return
    print_json(report_json(report))
    print_notes(report)
