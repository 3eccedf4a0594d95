"""``flyby pareto``: what can be had between the cycle time of a program and its energy."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import InputError
from .console import print_json, print_rich, print_table, progress, warn
from .front_files import FrontFiles
from .installed import registry
from .loading import Source, robot_of, start_of
from .options import (
    AnswersFile,
    AsJson,
    Axes,
    CellFile,
    Clearance,
    Entry,
    Force,
    Freed,
    Kept,
    Limits,
    MotionFile,
    OtherFiles,
    Out,
    ProgramFile,
    RobotName,
    Seed,
    Start,
    Tilt,
)
from .outputs import check_folder, check_outputs, check_plot_name, write_all
from .places import note_json
from .task_options import effort_of, task_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..core.cell.cell import Cell
    from ..core.motion.model.consumption import Consumption
    from ..core.program.program import Program
    from ..core.robot.model import Robot
    from ..core.vendor import Vendor
    from ..problems.improve.energy import Front, Point, Progress, Scope
    from ..problems.improve.waypoints import Task as Wishes


def pareto(
    program: ProgramFile,
    robot: RobotName = None,
    cell: CellFile = None,
    motion: MotionFile = None,
    entry: Entry = None,
    io: AnswersFile = None,
    others: OtherFiles = None,
    start: Start = None,
    points: Annotated[int, typer.Option(help="Durations to look at; two or more.")] = 8,
    change: Annotated[
        str,
        typer.Option(
            help="What may change: waypoints (with zones and speeds), zones (with speeds) or "
            "speeds. Without a cell it is speeds, with their accelerations."
        ),
    ] = "waypoints",
    motors: Annotated[
        Path | None,
        typer.Option(
            help="Motor figures (TOML): energy is then what the mains give, in J; otherwise it is "
            "squared torque over time."
        ),
    ] = None,
    keep: Kept = None,
    free: Freed = None,
    limit: Limits = None,
    axes: Axes = None,
    tilt: Tilt = 0.0,
    clearance: Clearance = None,
    starts: Annotated[
        int, typer.Option(help="Paths to start from; with 1, the program's own alone.")
    ] = 1,
    seed: Seed = 0,
    out: Out = None,
    plot: Annotated[Path | None, typer.Option(help="Draw the front: PNG, PDF or SVG.")] = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Find programs from the fastest to the most frugal, each as code of its own.

    With --out each gets a folder: point-1 is the fastest. In a cell each is proven to keep its
    clearance, as read from its text.
    """
    source = Source.of(program, entry, io, others, start)
    inputs = [*source.inputs(cell, motion), *([motors] if motors else [])]
    check_folder("--out", out)
    check_plot_name(plot)
    check_outputs({"--plot": plot}, inputs, force)
    scope = _scope(change, cell)
    effort = effort_of(starts, None, seed)
    with progress("reading the program") as say:
        from ..core.motion.emulator.controller import Controller
        from ..problems.improve.energy import Task as EnergyTask
        from ..problems.improve.energy import pareto as find

        vendor, arm = robot_of(robot, cell, motion)
        where = _cell(cell)
        parsed = source.read(vendor, arm)
        wishes = _wishes(
            parsed, where, vendor, arm, keep, free, limit, axes, tilt, clearance, start
        )
        task = EnergyTask(scope, _consumption(motors, arm), wishes)
        files = FrontFiles(vendor, arm, parsed)
        made = find(
            Controller(vendor, arm),
            parsed,
            where,
            task,
            points,
            effort,
            vendor.speaks,
            files.read_back,
            _teller(say),
        )
        written = files.write(out, [p.program for p in made.points], inputs, force)
        if plot is not None and made.points:
            say("drawing")
            _draw(plot, made, arm)
    drawn = plot if made.points else None
    if json:
        print_json(_json(made, arm, written, drawn))
    else:
        _tell(made, arm, written, drawn)
        if out is None:
            print_rich("nothing was written: --out FOLDER writes the programs")
    if not made.proven:
        raise typer.Exit(1)


def _scope(text: str, cell: Path | None) -> Scope:
    from ..problems.improve.energy import Scope

    try:
        return Scope(text) if cell is not None else Scope.SPEEDS
    except ValueError:
        raise InputError(f"--change {text}: {', '.join(Scope)}") from None


def _cell(file: Path | None) -> Cell | None:
    if file is None:
        return None
    from ..core.cell.file import load_cell

    return load_cell(file, registry())


def _wishes(
    program: Program,
    cell: Cell | None,
    vendor: Vendor,
    robot: Robot,
    keep: list[str] | None,
    free: list[str] | None,
    limit: list[str] | None,
    axes: str | None,
    tilt: float,
    clearance: float | None,
    start: str | None,
) -> Wishes:
    from ..core.cell.cell import Cell

    shapes = {
        "--free": free,
        "--limit": limit,
        "--axes": axes,
        "--tilt": tilt,
        "--clearance": clearance,
    }
    for option, value in shapes.items():
        if cell is None and value:
            raise InputError(f"{option} needs a cell (--cell): without one, only speeds change")
    return task_of(
        program,
        cell or Cell(robot=robot, vendor=vendor.name),
        vendor,
        objective="time",
        keep=keep or [],
        free=free or [],
        limits=limit or [],
        axes=axes,
        tilt=tilt,
        clearance=clearance,
        vias="keep",
        predefined=False,
        start=start_of(start, robot),
    )


def _consumption(motors: Path | None, robot: Robot) -> Consumption:
    from ..core.motion.model.consumption import SQUARED_TORQUE
    from ..core.motion.model.motors_file import load_motors

    if motors is None:
        return SQUARED_TORQUE
    made = load_motors(motors)
    if len(made.copper) > robot.size:
        raise InputError(
            f"--motors {motors}: {robot.name} has {robot.size} axes, "
            f"copper_w_per_nm2 has {len(made.copper)} numbers"
        )
    return made


def _teller(say: Callable[[str], None]) -> Callable[[Progress], None]:
    def tell(state: Progress) -> None:
        say(f"{state.stage}: {state.done} of {state.total} (Ctrl-C ends with what there is)")

    return tell


def _draw(plot: Path, made: Front, robot: Robot) -> None:
    from .plot_front import draw_front

    data = draw_front(made, robot.axis_names, plot.suffix.lower()[1:])
    write_all("--plot", {plot: data})


# ------------------------------------------------------------------------- telling


def _tell(made: Front, robot: Robot, written: Sequence[Sequence[Path]], plot: Path | None) -> None:
    joints = [j for j, value in enumerate(made.given.by_joint) if abs(value) > 0.0]
    columns = [
        ("point", "right"),
        ("time s", "right"),
        ("%", "right"),
        (f"energy {made.unit}", "right"),
        ("%", "right"),
        *((f"{robot.axis_names[j]} %", "right") for j in joints),
        ("clearance", "left"),
    ]
    rows = [("given", *_row(made.given, made.given, joints))]
    rows += [(str(k + 1), *_row(made.given, p, joints)) for k, p in enumerate(made.points)]
    print_table(columns, rows)
    for note in made.notes:
        warn(str(note))
    for paths in written:
        for path in paths:
            print_rich(f"wrote {path}")
    if plot is not None:
        print_rich(f"wrote {plot}")


def _row(given: Point, point: Point, joints: Sequence[int]) -> tuple[str, ...]:
    def change(value: float, before: float) -> str:
        # What motors take is negative where more comes back.
        return "" if point is given else f"{100.0 * (value - before) / abs(before):+.1f}"

    proof = point.certificate
    return (
        f"{point.duration:.4f}",
        change(point.duration, given.duration),
        f"{point.energy:.5g}",
        change(point.energy, given.energy),
        *(change(point.by_joint[j], given.by_joint[j]) for j in joints),
        "" if proof is None else ("proven" if proof.proven else "not proven"),
    )


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


def _point_json(point: Point, files: list[str]) -> dict[str, Any]:
    proof = point.certificate
    return {
        "time_s": point.duration,
        "energy": point.energy,
        "energy_by_joint": [float(value) for value in point.by_joint],
        "proven": None if proof is None else proof.proven,
        "certificate": None if proof is None else proof.message,
        "files": files,
    }
