"""``flyby experiment``: test motions that tell how a controller drives, as programs that log."""

from __future__ import annotations

import json as json_text
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import InputError
from . import values
from .console import print_json, print_rich, print_table, progress, warn
from .loading import cell_of, robot_of
from .options import AsJson, CellFile, Force, MotionFile, NoFloor, RobotName
from .outputs import check_folder, check_outputs, write_in

if TYPE_CHECKING:
    from ..core.cell.cell import Cell
    from ..core.program.tool import Tool
    from ..core.robot.model import Robot
    from ..identification.experiment.plan import Experiment, Kind, Plan

PAGE, PICTURE, RECORD = "README.md", "overview.png", ".json"
COLUMNS = (
    ("", "right"),
    ("run", "left"),
    ("moves", "left"),
    ("TCP, mm/s", "right"),
    ("corners", "right"),
    ("turns, °", "left"),
    ("zones, mm", "left"),
    ("motion, s", "right"),
    ("way there", "left"),
    ("gain, nats", "right"),
)


def experiment(
    out: Annotated[Path, typer.Option("--out", help="Folder to write programs and records to.")],
    robot: RobotName = None,
    cell: CellFile = None,
    no_floor: NoFloor = False,
    motion: MotionFile = None,
    tool: Annotated[
        str | None, typer.Option(help="Tool of the cell that is mounted; the flange if unset.")
    ] = None,
    minutes: Annotated[
        float, typer.Option(help="Time at the robot; the most telling runs that fit are chosen.")
    ] = 60.0,
    overhead: Annotated[
        float, typer.Option(help="Seconds that a run takes beside its motion.")
    ] = 60.0,
    postures: Annotated[int, typer.Option(help="How many postures to look for.")] = 3,
    at: Annotated[
        list[str] | None,
        typer.Option(
            "--at", help="A posture instead: axis values in degrees; may be given several times."
        ),
    ] = None,
    angles: Annotated[
        str | None, typer.Option(help="Changes of direction at corners, degrees: 30,90,150.")
    ] = None,
    zones: Annotated[
        str | None, typer.Option(help="Radii of zones, mm; by the robot's reach if unset.")
    ] = None,
    speeds: Annotated[str | None, typer.Option(help="Speeds of the TCP, mm/s.")] = None,
    kinds: Annotated[
        str | None, typer.Option(help="Kinds of moves, such as lines,joints; all if unset.")
    ] = None,
    margin: Annotated[float, typer.Option(help="Degrees that joints keep from limits.")] = 5.0,
    longest: Annotated[float, typer.Option(help="Seconds that one run may last, about.")] = 30.0,
    period: Annotated[
        float | None,
        typer.Option(help="Seconds between logged samples; what the controller takes if unset."),
    ] = None,
    seed: Annotated[int, typer.Option(help="Another one gives another design.")] = 1,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Design test motions for a robot in its cell, and write programs that log themselves."""
    check_folder("--out", out)
    inputs = [path for path in (cell, motion) if path is not None]
    if out.is_dir():
        # Said before the work, not after it: these two are always written.
        there = {f"--out: {name}": out / name for name in (PAGE, PICTURE)}
        check_outputs(there, inputs, force)
    with progress("reading the robot") as say:
        from ..identification.experiment.design import design

        vendor, arm = robot_of(robot, cell, motion)
        where = cell_of((vendor, arm), cell, no_floor=no_floor)
        plan = _plan(
            arm,
            tool=_tool(tool, where, cell),
            minutes=minutes,
            overhead=overhead,
            postures=postures,
            at=at,
            angles=angles,
            zones=zones,
            speeds=speeds,
            kinds=kinds,
            margin=math.radians(margin),
            longest=longest,
            period=period,
            seed=seed,
        )
        made = design(vendor, where, plan, bare=cell is None, say=say)
        say("writing")
        written = write_in("--out", out, _files(made, where, cell), inputs, force)
    if json:
        print_json(_json(made, written))
    else:
        _tell(made, out)


def _tool(name: str | None, cell: Cell, file: Path | None) -> Tool:
    from ..core.program.tool import FLANGE

    if name is None:
        return FLANGE
    if file is None:
        raise InputError(f"--tool {name}: tools are declared in a cell file; give --cell")
    return cell.tool(name)


def _plan(
    robot: Robot,
    *,
    postures: int,
    at: list[str] | None,
    angles: str | None,
    zones: str | None,
    speeds: str | None,
    kinds: str | None,
    **others: Any,
) -> Plan:
    import numpy as np

    from ..identification.experiment.plan import Plan

    given: dict[str, Any] = {}
    if angles is not None:
        given["turns"] = tuple(map(math.radians, values.numbers(angles, "--angles")))
    for name, text in (("radii", zones), ("speeds", speeds)):
        if text is not None:
            option = "--zones" if name == "radii" else "--speeds"
            given[name] = tuple(1e-3 * value for value in values.numbers(text, option))
    if kinds is not None:
        given["kinds"] = _kinds(kinds)
    stands = [np.array(values.configuration(text, "--at", robot)) for text in at or []]
    return Plan(postures=stands or postures, **given, **others)


def _kinds(text: str) -> tuple[Kind, ...]:
    from ..identification.experiment.plan import Kind

    words = text.replace(",", " ").split()
    for word in words:
        if word not in list(Kind):
            raise InputError(f"--kinds {word}: {', '.join(Kind)}")
    return tuple(kind for kind in Kind if kind in words)


def _files(made: Experiment, cell: Cell, file: Path | None) -> dict[Path, bytes]:
    """Everything that is written, by its path in the folder."""
    from ..identification.experiment.page import LOG_SUFFIX, page
    from ..identification.experiment.picture import draw_experiment
    from ..identification.experiment.record import record

    found: dict[Path, bytes] = {}
    for run in made.runs:
        name = run.candidate.name
        for source, text in run.sources.items():
            found[Path(name) / source] = text.encode()
        told = record(run, made.robot, name + LOG_SUFFIX, made.period)
        found[Path(name + RECORD)] = (json_text.dumps(told, indent=1) + "\n").encode()
    found[Path(PAGE)] = page(made, None if file is None else file.name).encode()
    found[Path(PICTURE)] = draw_experiment(cell, made)
    return found


def _tell(made: Experiment, out: Path) -> None:
    from ..identification.experiment.page import described, way

    rows = [
        (
            str(number),
            run.candidate.name,
            *described(run),
            f"{run.duration:.1f}",
            way(run, number == 1),
            f"{run.gain:.2f}",
        )
        for number, run in enumerate(made.runs, 1)
    ]
    print_table(COLUMNS, rows)
    for note in made.notes:
        warn(note)
    print_rich(
        f"{len(made.runs)} runs for {made.robot.name}, {made.seconds / 60:.0f} min at the robot; "
        f"{len(made.skipped)} are not possible, {len(made.unused)} had no time: see {PAGE}",
        f"wrote {out}",
    )


def _json(made: Experiment, written: list[Path]) -> dict[str, Any]:
    """SI units, in the keys."""
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
                "corners": [
                    {"turn_rad": corner.turn, "radius_m": corner.radius}
                    for corner in run.candidate.corners
                ],
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
