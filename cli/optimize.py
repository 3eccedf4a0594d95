"""``flyby optimize``: via points and zones that make a program faster, proven free of collision."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import OptionError
from ..tasks.files.outputs import check_outputs, picture_kind
from ..tasks.files.places import FilePlaces
from ..tasks.files.source_places import place_json
from ..tasks.optimize import CHANGE, OptimizeOptions, optimize_with
from ..tasks.pages.file import check_page
from ..tasks.read import SourceOptions
from ..tasks.setup import setup_of_program, writable_robot
from .output.changed_station import changed_station, is_station, refuse_given
from .output.console import print_json, print_table, progress
from .output.delivery import OtherVendor, deliver
from .output.solution_report import ChangedMove, changed_rows, solution_json, tell_solution
from .output.told_robot import read_for_robot
from .parameters import (
    AsJson,
    CellPlot,
    Force,
    InPlace,
    Out,
    PageFile,
    ProgramFile,
    with_options,
)

if TYPE_CHECKING:
    from ..core.cell.cell import Cell
    from ..core.program.move import Move
    from ..core.program.zone import Zone
    from ..problems.improve.solution import Moved, Solution

COLUMNS = (
    ("move", "right"),
    ("line", "left"),
    ("target", "left"),
    ("height, mm", "right"),
    ("turn, °", "right"),
    ("zone", "left"),
    ("gained, s", "right"),
)


@with_options
def optimize(
    program: ProgramFile,
    source: SourceOptions,
    options: OptimizeOptions,
    other: Annotated[
        str | None,
        typer.Option(
            "--also",
            metavar="NAME",
            help="With --out: code for another vendor's robot as well, such as kuka/kr30-3, as "
            "'flyby translate' writes it.",
        ),
    ] = None,
    release: Annotated[
        list[str] | None,
        typer.Option(
            "--release",
            metavar="ROBOT.OUTPUT",
            help="Of a station: an output that only gives space free, and may be set earlier; may "
            "be given several times.",
        ),
    ] = None,
    out: Out = None,
    in_place: InPlace = False,
    plot: CellPlot = None,
    report: PageFile = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Move via points and size zones so that the program becomes faster, and prove it.

    Only a program that is proven to keep its clearance, as read from the new text, is written. Of a
    station file the programs of all robots change, and robots that would wait drive slower.
    """
    places = FilePlaces(out, in_place, [program, *source.inputs()], force)
    if is_station(program):
        refuse_given([], (), plot=plot, also=other)
        _station(program, source, options, release or (), places, json, report)
        return
    if release:
        raise OptionError("--release names outputs of a station's robots; this is one program")
    places.check()
    check_page(report, places.inputs, force)
    if plot is not None:
        picture_kind(plot, "--plot")
    check_outputs({"--plot": plot}, places.inputs, force)
    _check_places(out, in_place, options.vias, other)
    with progress("reading the program") as say:
        read = read_for_robot(program, source, writes=places.anywhere)
        setup = setup_of_program(read)
        cell = setup.surroundings(read, no_floor=options.no_floor)
        beside = None
        if other is not None and out is not None:
            beside = OtherVendor(setup, writable_robot(other, "--also"), out, places)
            beside.check(read)
        made = optimize_with(read, replace(options, report=say))
        delivery = deliver(made, setup, places, unproven=False)
        if beside is not None:
            delivery = beside.written(delivery)
        delivery = delivery.with_page(report, say, cell)
        if plot is not None:
            say("drawing")
            delivery = delivery.with_picture(plot, cell)
    if json:
        print_json(_json(delivery.made, cell, delivery.written))
    else:
        _tell(program, delivery.made, cell, delivery.written)
    delivery.end(told=not json)


def _station(
    file: Path,
    source: SourceOptions,
    options: OptimizeOptions,
    release: Sequence[str],
    places: FilePlaces,
    json: bool,
    page: Path | None,
) -> None:
    """The programs of all robots of a station."""
    from ..tasks.station.optimize import StationOptimizeOptions, station_optimize_with

    taken = (
        *("keep", "free", "own", "zones_only", "predefined", "tilt", "seed"),
        *("starts", "generations"),
    )
    refuse_given([source, options], taken)
    given = {name: getattr(options, name) for name in taken}
    wanted = StationOptimizeOptions(release=release, **given)
    changed_station(
        file,
        lambda say: station_optimize_with(file, replace(wanted, report=say)),
        places,
        json,
        page,
    )


def _check_places(out: Path | None, in_place: bool, vias: str, other: str | None) -> None:
    if in_place and vias == CHANGE:
        raise OptionError(
            "--in-place and --vias change: with other via points the program is written anew: name "
            "a folder by --out"
        )
    if other is not None and out is None:
        raise OptionError(
            f"--also {other}: its code goes beside the program's own: name a folder by --out"
        )


def _tell(program: Path, made: Solution, cell: Cell, written: Sequence[Path]) -> None:
    print_table(COLUMNS, _rows(program, made))
    tell_solution(program, made, cell, written)


def _rows(program: Path, made: Solution) -> list[tuple[str, ...]]:
    """What has changed, line by line; all moves where their number has."""
    old, new = made.original.moves, made.program.moves
    moved = {point.move: point for point in made.moved}
    changed: list[ChangedMove] = []
    for index, move in enumerate(new):
        before = old[index] if len(old) == len(new) else None
        if before is not None and (before.target, before.zone) == (move.target, move.zone):
            continue
        span = None if before is None else before.statement
        said = _moved(before, move), *_rise_and_turn(moved.get(index)), _zone(before, move)
        changed.append(ChangedMove(index, span, said))
    return [
        (moves, line, *said, gained)
        for moves, line, said, gained in changed_rows(program, changed, made.gained)
    ]


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
    from ..core.program.zone import Radius, zone_shown

    def shown(zone: Zone) -> str:
        return f"{1e3 * zone.tcp:.5g} mm" if isinstance(zone, Radius) else zone_shown(zone)

    new = shown(move.zone)
    if before is None or before.zone == move.zone:
        return new
    return f"{shown(before.zone)} → {new}"


def _json(made: Solution, cell: Cell, written: Sequence[Path]) -> dict[str, Any]:
    moved = {point.move: point for point in made.moved}
    moves = [
        _move_json(index, move, moved.get(index)) | {"gained_s": made.gained.get(index)}
        for index, move in enumerate(made.program.moves)
    ]
    return {**solution_json(made, cell, written), "moves": moves}


def _move_json(index: int, move: Move, moved: Moved | None) -> dict[str, Any]:
    from ..core.program.target import JointTarget
    from ..core.program.zone import Radius

    target = move.target
    joints = list(target.joints) if isinstance(target, JointTarget) else None
    position = None if isinstance(target, JointTarget) else list(target.pose.position)
    span = move.statement
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
