"""``flyby optimize``: via points and zones that make a program faster, proven free of collision."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import InputError
from .console import print_json, print_table, progress
from .delivery import deliver
from .emission import Emission
from .loading import Source, cell_of, robot_of, start_of
from .options import (
    AnswersFile,
    AsJson,
    Axes,
    Clearance,
    Entry,
    Force,
    Freed,
    InPlace,
    Kept,
    Limits,
    MotionFile,
    NoFloor,
    OtherFiles,
    Out,
    Predefined,
    ProgramFile,
    RobotName,
    Seed,
    Start,
    Tilt,
    WholeCell,
)
from .other_vendor import OtherVendor
from .outputs import check_outputs, check_plot_name, write_all
from .patching import Places
from .places import place_json, short_place
from .solution_report import solution_json, tell_solution
from .task_options import effort_of, task_of
from .translation import party_for

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..core.cell.cell import Cell
    from ..core.motion.emulator.controller import Controller
    from ..core.program.move import Move
    from ..core.program.program import Program
    from ..core.program.zone import Zone
    from ..problems.improve.solution import Moved, Solution
    from ..problems.improve.waypoints import Effort, Progress, Task

COLUMNS = (
    ("move", "right"),
    ("line", "left"),
    ("target", "left"),
    ("height, mm", "right"),
    ("turn, °", "right"),
    ("zone", "left"),
)
CHANGE = "change"


def optimize(
    program: ProgramFile,
    cell: WholeCell = None,
    robot: RobotName = None,
    motion: MotionFile = None,
    entry: Entry = None,
    io: AnswersFile = None,
    others: OtherFiles = None,
    start: Start = None,
    objective: Annotated[
        str,
        typer.Option(
            help="time, energy, or a weight w between 0 and 1: w · time + (1 − w) · energy, each "
            "as a share of what the program takes now."
        ),
    ] = "time",
    zones_only: Annotated[
        bool, typer.Option("--zones-only", help="Change zones alone; every point stays.")
    ] = False,
    keep: Kept = None,
    free: Freed = None,
    limit: Limits = None,
    axes: Axes = None,
    tilt: Tilt = 0.0,
    clearance: Clearance = None,
    no_floor: NoFloor = False,
    predefined: Predefined = False,
    vias: Annotated[
        str,
        typer.Option(
            help="keep: the number of via points stays; change: idle ones go, and others come "
            "where they pay."
        ),
    ] = "keep",
    starts: Annotated[
        int | None, typer.Option(help="Paths to start from; more find better routes.")
    ] = None,
    generations: Annotated[
        int | None, typer.Option(help="How often the best path is varied in turn; 0 is quickest.")
    ] = None,
    seed: Seed = 0,
    own: Annotated[
        bool,
        typer.Option(
            "--own", help="Moves get data of their own where the text has no place for a change."
        ),
    ] = False,
    other: Annotated[
        str | None,
        typer.Option(
            "--vendor",
            metavar="NAME",
            help="With --out: code for another vendor's robot as well, such as kuka/kr30-3, as "
            "'flyby translate' writes it.",
        ),
    ] = None,
    out: Out = None,
    in_place: InPlace = False,
    plot: Annotated[
        Path | None, typer.Option(help="Draw the cell with both paths: PNG, PDF or SVG.")
    ] = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Move via points and size zones so that the program becomes faster, and prove it.

    Only a program that is proven to keep its clearance, as read from the new text, is written.
    """
    source = Source.of(program, entry, io, others, start)
    places = Places(out, in_place, source.inputs(cell, motion), force)
    places.check()
    check_plot_name(plot)
    check_outputs({"--plot": plot}, places.inputs, force)
    _check_options(zones_only, bool(limit) or tilt != 0.0, vias == CHANGE, in_place)
    if other is not None and out is None:
        raise InputError(
            f"--vendor {other}: its code goes beside the program's own: name a folder by --out"
        )
    with progress("reading the program") as say:
        from ..core.motion.emulator.controller import Controller

        vendor, arm = robot_of(robot, cell, motion)
        parsed = source.read(vendor, arm)
        tools = dict.fromkeys(move.tool for move in parsed.moves)
        where = cell_of((vendor, arm), cell, tools, no_floor=no_floor)
        if vias == CHANGE:  # a search takes long: what cannot be written anew is refused before it
            vendor.write(parsed, where.robot)
        beside = None
        if other is not None and out is not None:
            beside = OtherVendor((vendor, where.robot), party_for(other, "--vendor"), out, places)
            beside.check(parsed)
        task = task_of(
            parsed,
            where,
            vendor,
            objective=objective,
            keep=keep or [],
            free=free or [],
            limits=limit or [],
            axes=axes,
            tilt=tilt,
            clearance=clearance,
            vias=vias,
            predefined=predefined,
            start=start_of(start, where.robot),
        )
        effort = effort_of(starts, generations, seed)
        emission = Emission(vendor, where.robot, parsed, own)
        controller = Controller(vendor, where.robot)
        made = _optimized(controller, parsed, where, task, effort, emission, zones_only, say)
        delivery = deliver(made, vendor, emission.files, places, unproven=False)
        if beside is not None:
            delivery = beside.written(delivery)
        if plot is not None:
            say("drawing")
            drawn = _draw(plot, where, controller, made, task)
            delivery = replace(delivery, written=[*delivery.written, *drawn])
    if json:
        print_json(_json(delivery.made, where, delivery.written))
    else:
        _tell(program, delivery.made, where, delivery.written)
    delivery.end(told=not json)


def _check_options(zones_only: bool, limited: bool, other_vias: bool, in_place: bool) -> None:
    if zones_only and (limited or other_vias):
        raise InputError(
            "--zones-only leaves every point as it is: --limit, --tilt and --vias change do not go "
            "with it"
        )
    if in_place and other_vias:
        raise InputError(
            "--in-place and --vias change: with other via points the program is written anew: name "
            "a folder by --out"
        )


def _optimized(
    controller: Controller,
    program: Program,
    cell: Cell,
    task: Task,
    effort: Effort,
    emission: Emission,
    zones_only: bool,
    say: Callable[[str], None],
) -> Solution:
    from ..problems.improve.waypoints import optimize_waypoints, optimize_zones

    def report(state: Progress) -> None:
        gained = "" if state.best == 1.0 else f", best so far {100 * state.best:.1f} %"
        say(f"{state.stage}: {state.done} of {state.total}{gained} (Ctrl-C ends with the best)")

    run = optimize_zones if zones_only else optimize_waypoints
    return run(controller, program, cell, task, effort, emission.read_back, report)


def _draw(plot: Path, cell: Cell, controller: Controller, made: Solution, task: Task) -> list[Path]:
    from ..drawing.cell import draw_cell

    runs = [("before", controller.run(made.original, task.start))]
    if made.changed:
        runs.append(("after", controller.run(made.program, task.start)))
    data = draw_cell(cell, runs, plot.suffix.lower()[1:])
    write_all("--plot", {plot: data})
    return [plot]


def _tell(program: Path, made: Solution, cell: Cell, written: Sequence[Path]) -> None:
    print_table(COLUMNS, _rows(program, made))
    tell_solution(program, made, cell, written)


def _rows(program: Path, made: Solution) -> list[tuple[str, ...]]:
    """What has changed, move by move; all moves where their number has."""
    old, new = made.original.moves, made.program.moves
    moved = {point.move: point for point in made.moved}
    rows: list[tuple[str, ...]] = []
    for index, move in enumerate(new):
        before = old[index] if len(old) == len(new) else None
        if before is not None and (before.target, before.zone) == (move.target, move.zone):
            continue
        span = None if before is None or before.origin is None else before.origin.statement
        rows.append(
            (
                str(index + 1),
                short_place(program, span),
                _moved(before, move),
                *_rise_and_turn(moved.get(index)),
                _zone(before, move),
            )
        )
    return rows


def _moved(before: Move | None, move: Move) -> str:
    """How far a target has been moved, or where it is."""
    import math

    from ..core.program.target import JointTarget

    new = move.target
    if before is None:
        return new.name or "via point"
    old = before.target
    if old == new:
        return "stays"
    if isinstance(new, JointTarget) and isinstance(old, JointTarget):
        steps = [math.degrees(b - a) for a, b in zip(old.joints, new.joints, strict=True)]
        return "moved by " + ", ".join(map(_hundredths, steps)) + " °"
    if isinstance(new, JointTarget) or isinstance(old, JointTarget):
        return "another kind of target"
    shift = [1e3 * (b - a) for a, b in zip(old.pose.position, new.pose.position, strict=True)]
    return "moved by " + ", ".join(map(_hundredths, shift)) + " mm"


def _hundredths(value: float) -> str:
    # No minus in front of nothing.
    return f"{round(value, 2) + 0.0:.2f}"


def _rise_and_turn(point: Moved | None) -> tuple[str, str]:
    """How far what the tool holds is raised and turned."""
    import math

    if point is None:
        return "", ""
    # Rounding of joints turns it by less than this.
    turn = math.degrees(point.turn)
    return f"{1e3 * point.rise:+.1f}", f"{turn:.2f}" if turn >= 0.005 else "0"


def _zone(before: Move | None, move: Move) -> str:
    from ..core.program.zone import Radius
    from .zones import zone_shown

    def shown(zone: Zone) -> str:
        return f"{1e3 * zone.tcp:.5g} mm" if isinstance(zone, Radius) else zone_shown(zone)

    new = shown(move.zone)
    if before is None or before.zone == move.zone:
        return new
    return f"{shown(before.zone)} → {new}"


def _json(made: Solution, cell: Cell, written: Sequence[Path]) -> dict[str, Any]:
    moved = {point.move: point for point in made.moved}
    moves = [
        _move_json(index, move, moved.get(index)) for index, move in enumerate(made.program.moves)
    ]
    return {**solution_json(made, cell, written), "moves": moves}


def _move_json(index: int, move: Move, moved: Moved | None) -> dict[str, Any]:
    from ..core.program.target import JointTarget
    from ..core.program.zone import Radius

    target = move.target
    joints = list(target.joints) if isinstance(target, JointTarget) else None
    position = None if isinstance(target, JointTarget) else list(target.pose.position)
    span = None if move.origin is None else move.origin.statement
    return {
        "move": index + 1,
        "joints_rad": joints,
        "position_m": position,
        "moved_m": None if moved is None else moved.distance,
        "rise_m": None if moved is None else moved.rise,
        "turn_rad": None if moved is None else moved.turn,
        "zone_radius_m": move.zone.tcp if isinstance(move.zone, Radius) else None,
        **place_json(span),
    }
