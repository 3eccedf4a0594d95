"""``flyby optimize``: via points and zones that make a program faster, proven free of collision."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import InputError
from .bystanders import bystander_notes, refuse_bystanders
from .console import print_json, print_rich, print_table, progress
from .emission import Emission
from .installed import registry
from .loading import Source, start_of
from .options import AnswersFile, AsJson, Entry, Force, OtherFiles, Out, ProgramFile, Start
from .outputs import check_outputs, check_plot_name, writing
from .patching import check_places, write_patched
from .places import place_json, short_place
from .solution_report import solution_json, tell_solution
from .task_options import effort_of, task_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..core.cell.cell import Cell
    from ..core.motion.controller import Controller
    from ..core.program.move import Move
    from ..core.program.program import Program
    from ..core.program.zone import Zone
    from ..problems.solution import Solution
    from ..problems.waypoints import Effort, Progress, Task

COLUMNS = (("move", "right"), ("line", "left"), ("target", "left"), ("zone", "left"))
CHANGE = "change"


def optimize(
    program: ProgramFile,
    cell: Annotated[
        Path, typer.Option("--cell", help="Cell file: robot, tools, obstacles, clearance.")
    ],
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
    keep: Annotated[
        list[str] | None,
        typer.Option(
            "--keep",
            help="A move whose path and speed the process fixes, by its number or by the name of "
            "its speed; may be given several times.",
        ),
    ] = None,
    free: Annotated[
        list[str] | None,
        typer.Option(
            "--free",
            help="A stop that may be passed, by the number of its move, or 'all'; may be given "
            "several times.",
        ),
    ] = None,
    limit: Annotated[
        list[str] | None,
        typer.Option(
            "--limit",
            help="How far a via point may move: MOVE=fixed, MOVE=free, MOVE=box:MM[,DEGREES], "
            "MOVE=joints:DEGREES or MOVE=cone:DEGREES; MOVE may be 'all'.",
        ),
    ] = None,
    axes: Annotated[
        str | None,
        typer.Option(help="Joints that joint targets may change, such as 2,3; all if unset."),
    ] = None,
    clearance: Annotated[
        float | None,
        typer.Option("--clearance", help="Clearance to keep, mm; the cell's own if unset."),
    ] = None,
    predefined: Annotated[
        bool, typer.Option("--predefined", help="Choose among the vendor's predefined zones.")
    ] = False,
    vias: Annotated[
        str,
        typer.Option(help="keep: the number of via points stays; change: it may become another."),
    ] = "keep",
    starts: Annotated[
        int | None, typer.Option(help="Paths to start from; more find better routes.")
    ] = None,
    generations: Annotated[
        int | None, typer.Option(help="How often the best path is varied in turn; 0 is quickest.")
    ] = None,
    seed: Annotated[int, typer.Option(help="Of the variations of the path.")] = 0,
    own: Annotated[
        bool,
        typer.Option(
            "--own", help="Moves get data of their own where the text has no place for a change."
        ),
    ] = False,
    out: Out = None,
    in_place: Annotated[
        bool, typer.Option("--in-place", help="Change the program's own files.")
    ] = False,
    plot: Annotated[
        Path | None, typer.Option(help="Draw the cell with both paths: PNG, PDF or SVG.")
    ] = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Move via points and size zones so that the program becomes faster, and prove it.

    Only a program that is proven to keep its clearance, as read from the new text, is written.
    """
    source = Source.of(program, entry, io, others)
    inputs = source.inputs(cell)
    check_places(out, in_place, inputs, force)
    check_plot_name(plot)
    check_outputs({"--plot": plot}, inputs, force)
    if zones_only and (limit or vias == CHANGE):
        raise InputError(
            "--zones-only leaves every point as it is: --limit and --vias change do not go with it"
        )
    if in_place and vias == CHANGE:
        raise InputError(
            "--in-place and --vias change: with other via points the program is written anew: name "
            "a folder by --out"
        )
    with progress("reading the program") as say:
        from ..core.cell.file import load_cell
        from ..core.motion.controller import Controller

        where = load_cell(cell, registry())
        vendor = where.find_vendor(registry())
        parsed = source.read(vendor, where.robot)
        task = task_of(
            parsed,
            where,
            vendor,
            objective=objective,
            keep=keep or [],
            free=free or [],
            limits=limit or [],
            axes=axes,
            clearance=clearance,
            vias=vias,
            predefined=predefined,
            start=start_of(start, where.robot),
        )
        emission = Emission(vendor, where.robot, parsed, own)
        controller = Controller(vendor, where.robot)
        made = _optimized(
            controller,
            parsed,
            where,
            task,
            effort_of(starts, generations, seed),
            emission,
            zones_only,
            say,
        )
        others_concerned = bystander_notes(made, vendor)
        made = replace(made, notes=(*made.notes, *others_concerned))
        written: list[Path] = []
        if made.changed and not (in_place and others_concerned):
            from ..core.source.patching import reading_of

            read = reading_of(parsed).files
            written = write_patched(emission.files, read, out, in_place, inputs, force)
        if plot is not None:
            say("drawing")
            written += _draw(plot, where, controller, made, task)
    if json:
        print_json(_json(made, where, written))
    else:
        _tell(program, made, where, written)
        if made.changed and not (out or in_place):
            print_rich("nothing was written: --in-place or --out FOLDER writes the new program")
    if in_place:
        refuse_bystanders(others_concerned)
    if not made.proven:
        raise typer.Exit(1)


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
    from ..problems.waypoints import optimize_waypoints, optimize_zones

    def report(state: Progress) -> None:
        gained = "" if state.best == 1.0 else f", best so far {100 * state.best:.1f} %"
        say(f"{state.stage}: {state.done} of {state.total}{gained} (Ctrl-C ends with the best)")

    run = optimize_zones if zones_only else optimize_waypoints
    return run(controller, program, cell, task, effort, emission.read_back, report)


def _draw(plot: Path, cell: Cell, controller: Controller, made: Solution, task: Task) -> list[Path]:
    from ..core.motion.trajectory import write_whole
    from ..drawing.cell import draw_cell

    runs = [("before", controller.run(made.original, task.start))]
    if made.changed:
        runs.append(("after", controller.run(made.program, task.start)))
    data = draw_cell(cell, runs, plot.suffix.lower()[1:])
    with writing("--plot", plot):
        write_whole(plot, data)
    return [plot]


def _tell(program: Path, made: Solution, cell: Cell, written: list[Path]) -> None:
    print_table(COLUMNS, _rows(program, made))
    tell_solution(program, made, cell, written)


def _rows(program: Path, made: Solution) -> list[tuple[str, ...]]:
    """What has changed, move by move; all moves where their number has."""
    old, new = made.original.moves, made.program.moves
    rows: list[tuple[str, ...]] = []
    for index, move in enumerate(new):
        before = old[index] if len(old) == len(new) else None
        if before is not None and (before.target, before.zone) == (move.target, move.zone):
            continue
        span = None if before is None or before.origin is None else before.origin.statement
        rows.append(
            (str(index + 1), short_place(program, span), _moved(before, move), _zone(before, move))
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
        return "moved by " + ", ".join(f"{step:.2f}" for step in steps) + " °"
    if isinstance(new, JointTarget) or isinstance(old, JointTarget):
        return "another kind of target"
    shift = [1e3 * (b - a) for a, b in zip(old.pose.position, new.pose.position, strict=True)]
    return "moved by " + ", ".join(f"{step:.2f}" for step in shift) + " mm"


def _zone(before: Move | None, move: Move) -> str:
    from ..core.program.zone import Radius
    from .zones import zone_shown

    def shown(zone: Zone) -> str:
        return f"{1e3 * zone.tcp:.5g} mm" if isinstance(zone, Radius) else zone_shown(zone)

    new = shown(move.zone)
    if before is None or before.zone == move.zone:
        return new
    return f"{shown(before.zone)} → {new}"


def _json(made: Solution, cell: Cell, written: list[Path]) -> dict[str, Any]:
    moves = [_move_json(index, move) for index, move in enumerate(made.program.moves)]
    return {**solution_json(made, cell, written), "moves": moves}


def _move_json(index: int, move: Move) -> dict[str, Any]:
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
        "zone_radius_m": move.zone.tcp if isinstance(move.zone, Radius) else None,
        **place_json(span),
    }
