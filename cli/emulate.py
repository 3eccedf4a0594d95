"""``flyby emulate``: drive a program and tell what came of it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..core.errors import InputError
from . import values
from .console import print_json, print_rich, progress
from .installed import check_language, registry, vendor_of
from .outputs import check_outputs, writing

if TYPE_CHECKING:
    from ..core.motion.controller import Run
    from ..core.program.program import Program
    from ..core.program.target import JointTarget
    from ..core.robot.model import Robot
    from ..core.vendor import Vendor

LEAST_PERIOD = 1e-5
"""s. A cycle of a minute then makes six million samples."""
PLOT_FORMATS = (".png", ".pdf", ".svg")


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
    program: Annotated[Path, typer.Argument(help="Program file in its vendor's language.")],
    robot: Annotated[
        str | None, typer.Option(help="Robot, such as abb/irb6640-180-255 ('flyby robots').")
    ] = None,
    cell: Annotated[
        Path | None, typer.Option(help="Cell file: robot, base and external axes.")
    ] = None,
    entry: Annotated[str | None, typer.Option(help="Routine to run.")] = None,
    start: Annotated[
        str | None,
        typer.Option(
            help="Axis values before the first move, degrees and mm: 0,0,0,0,30,0. "
            "Without it the robot stands at the first target."
        ),
    ] = None,
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
        typer.Option(help="Write the program anew, all moves in one routine, as it was driven."),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print the report as JSON.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace output files.")] = False,
) -> None:
    """Drive a program as the robot's controller would: cycle time, path, what limits each move."""
    files = _Files(csv, npz, plot, write)
    inputs = [program] if cell is None else [program, cell]
    _check_plot(plot)
    check_outputs(files.by_option(), inputs, replace_existing=force)
    if period is not None and not LEAST_PERIOD <= period < float("inf"):
        raise InputError(f"--period must be at least {LEAST_PERIOD:g} s, not {period}")
    with progress("reading the program") as say:
        vendor, arm = _robot(robot, cell)
        check_language(vendor, program)
        parsed = vendor.read_file(program, entry, arm)
        stand = None if start is None else _stand(start, arm)
        say(f"emulating {len(parsed.moves)} moves")
        run = _run(vendor, arm, parsed, stand, period)
        say("writing results")
        _write_files(files, vendor, arm, run)
    _tell(run, arm, as_json=json)
    if not json:
        for path in filter(None, files.by_option().values()):
            print_rich(f"wrote {path}")


def _check_plot(path: Path | None) -> None:
    if path is not None and path.suffix.lower() not in PLOT_FORMATS:
        raise InputError(f"--plot {path}: the name must end in {', '.join(PLOT_FORMATS)}")


def _robot(name: str | None, cell: Path | None) -> tuple[Vendor, Robot]:
    if cell is None:
        if name is None:
            raise InputError("which robot? Give --robot ('flyby robots' lists them) or --cell")
        return vendor_of(name), registry().find_robot(name)
    from ..core.cell.file import load_cell

    loaded = load_cell(cell, registry())
    if name is not None and name != loaded.robot.name:
        raise InputError(f"--robot {name}: the cell {cell} has a {loaded.robot.name}")
    return registry().find_vendor(loaded.vendor), loaded.robot


def _stand(text: str, robot: Robot) -> JointTarget:
    from ..core.program.target import JointTarget

    q = values.configuration(text, "--start", robot)
    return JointTarget(q[: robot.arm_size], q[robot.arm_size :])


def _run(
    vendor: Vendor, robot: Robot, program: Program, start: JointTarget | None, period: float | None
) -> Run:
    from ..core.motion.controller import Controller

    return Controller(vendor, robot).run(program, start, period)


def _write_files(files: _Files, vendor: Vendor, robot: Robot, run: Run) -> None:
    """Make everything that can fail first, then write."""
    from ..core.motion.trajectory import write_whole

    made: list[tuple[str, Path, bytes]] = []
    if files.write is not None:
        made.append(("--write", files.write, _source(vendor, robot, run.program)))
    if files.plot is not None:
        from .plot import draw

        made.append(("--plot", files.plot, draw(run, robot, files.plot.suffix.lower()[1:])))
    for option, path, data in made:
        with writing(option, path):
            write_whole(path, data)
    if files.csv is not None:
        with writing("--csv", files.csv):
            run.trajectory.save_csv(files.csv)
    if files.npz is not None:
        with writing("--npz", files.npz):
            run.trajectory.save_npz(files.npz)


def _source(vendor: Vendor, robot: Robot, program: Program) -> bytes:
    sources = vendor.write(program, robot)
    if len(sources) != 1:
        raise InputError(
            f"--write: the program takes several files ({', '.join(sources)}); "
            "this command writes one"
        )
    (text,) = sources.values()
    return text.encode()


def _tell(run: Run, robot: Robot, *, as_json: bool) -> None:
    from .report import make_report
    from .report_text import print_notes, print_report, report_json

    report = make_report(run, robot)
    if not as_json:
        print_report(report)
        return
    print_json(report_json(report))
    print_notes(report)
