"""``flyby paint``: a robot program that leaves an even coat on a part, and the map to prove it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..core.errors import InputError
from .console import print_json, progress, warn
from .options import AsJson, Force, MotionFile, NoFloor, RobotName
from .outputs import check_folder, check_outputs, write_in
from .paint_options import (
    check_signals,
    direction_of,
    drive_of,
    errors_of,
    limits_of,
    plan_of,
    region_of,
    station_of,
    target_of,
)
from .paint_report import pictures_of, report_json, tell

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..problems.paint.coating.coat import Coat
    from ..problems.paint.executable.execute import Executable
    from ..problems.paint.executable.station import Station
    from ..problems.paint.executable.writing import DriveOptions
    from ..problems.paint.painting import Painting
    from ..problems.paint.surface.part import Part

PICTURES = ("thickness.png", "curve.png", "histogram.png", "strokes.png")
FINEST = 0.06
"""Longest edge of the part's triangles by the footprint's radius, so that it is judged finely."""
STEP = 0.3
"""Longest segment by the footprint's radius, where none is given."""


def paint(
    part: Annotated[Path, typer.Argument(help="The part: STL, PLY, OBJ, OFF, GLB or 3MF.")],
    footprint: Annotated[
        Path, typer.Option("--footprint", help="The gun's footprint, or measured strokes (TOML).")
    ],
    target: Annotated[str, typer.Option(help="Thickness wanted, with its unit: 50um.")],
    units: Annotated[
        str | None, typer.Option(help="Of the part's numbers: m, cm, mm, in; as the file says.")
    ] = None,
    view: Annotated[
        str | None,
        typer.Option(help="Direction in which the gun looks at the part, such as 0,0,-1."),
    ] = None,
    facing: Annotated[
        float | None,
        typer.Option(help="Paint only what faces the gun to within so many degrees."),
    ] = None,
    inside: Annotated[
        str | None, typer.Option(help="Paint only what lies in a box: x,y,z,x,y,z in mm.")
    ] = None,
    covered: Annotated[
        str | None, typer.Option(help="Leave out what lies in a box: x,y,z,x,y,z in mm.")
    ] = None,
    sweep: Annotated[float | None, typer.Option(help="Sweep width, mm.")] = None,
    distance: Annotated[
        float | None, typer.Option(help="Of the gun from the part, mm; the footprint's if unset.")
    ] = None,
    overhang: Annotated[float, typer.Option(help="Of sweeps beyond the edge, mm.")] = 100.0,
    step: Annotated[float | None, typer.Option(help="Between waypoints at most, mm.")] = None,
    heading: Annotated[
        str | None, typer.Option(help="Direction of the sweeps; along the longer side if unset.")
    ] = None,
    method: Annotated[str, typer.Option(help="sideways or raster.")] = "sideways",
    coats: Annotated[
        str, typer.Option(help="one, or crossed: two of half the paint, at right angles.")
    ] = "one",
    turns: Annotated[str, typer.Option(help="Whether the gun paints in turns: on, off.")] = "on",
    speed: Annotated[str, typer.Option(help="Least and largest speed, mm/s.")] = "50,800",
    tilt: Annotated[float, typer.Option(help="Of the gun off the normal at most, degrees.")] = 20.0,
    deviation: Annotated[
        float, typer.Option(help="Of waypoints from the first curve at most, mm.")
    ] = 100.0,
    errors: Annotated[
        str | None,
        typer.Option(help="That the coat shall stand: height in mm, footprint's radius in %: 3,2."),
    ] = None,
    points: Annotated[int, typer.Option(help="Of the part on which to optimise.")] = 2600,
    seed: Annotated[int, typer.Option(help="Of the choice of these points.")] = 0,
    robot: RobotName = None,
    cell: Annotated[
        Path | None, typer.Option("--cell", help="Cell file: robot, gun, frames, obstacles.")
    ] = None,
    motion: MotionFile = None,
    tool: Annotated[str | None, typer.Option(help="The gun among the cell's tools.")] = None,
    place: Annotated[
        str | None, typer.Option(help="Pose of the part in the world, as for fk.")
    ] = None,
    frame: Annotated[
        str | None, typer.Option(help="Instead: a frame of the cell that the part stands in.")
    ] = None,
    no_floor: NoFloor = False,
    zone: Annotated[float, typer.Option(help="Zone at the waypoints, mm.")] = 20.0,
    run: Annotated[float, typer.Option(help="Run-in and run-out with the gun off, mm.")] = 50.0,
    signal: Annotated[str | None, typer.Option(help="Output that switches the gun.")] = None,
    flow: Annotated[str | None, typer.Option(help="Output that sets the flow.")] = None,
    delay: Annotated[float, typer.Option(help="From signal to paint, ms.")] = 0.0,
    unproven: Annotated[
        bool, typer.Option("--unproven", help="Write the program even if it is not proven.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder for program and pictures.")
    ] = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Paint a part evenly: first curve, optimisation, program, and the coat as emulated.

    Without --robot or --cell there is no program: curve, thickness and pictures alone.
    """
    inputs = [path for path in (part, footprint, cell, motion) if path is not None]
    check_folder("--out", out)
    if out is not None:
        check_outputs({f"--out: {n}": out / n for n in PICTURES if out.is_dir()}, inputs, force)
    wanted = target_of(target)
    drive = drive_of(zone, run, signal, flow, delay)
    station = station_of(robot, cell, motion, tool, frame, place, no_floor)
    if station is not None:
        check_signals(drive, station)
    with progress("reading the part") as say:
        from ..problems.paint.painting import Wishes
        from ..problems.paint.painting import paint as find
        from ..problems.paint.spray.footprint_file import load_footprint
        from ..problems.paint.surface.loading import load_part

        source = load_footprint(footprint)
        gun = source.footprint
        plan = plan_of(
            gun,
            sweep=sweep,
            distance=distance,
            overhang=overhang,
            step=1e3 * STEP * gun.radius if step is None else step,
            method=method,
            view=view,
            heading=heading,
            coats=coats,
            turns=turns,
        )
        limits = limits_of(plan.distance, speed, tilt, deviation)
        if points < 100:
            raise InputError(f"--points {points}: a number from 100 on")
        shape = _sized(load_part, part, units, direction_of(view, "--view"), FINEST * gun.radius)
        shape = region_of(shape, plan, facing=facing, inside=inside, covered=covered)
        wishes = Wishes(wanted, plan, limits, errors=errors_of(errors), points=points, seed=seed)
        painting = find(shape, gun, wishes, say, _teller(say))
        made = None
        texts: dict[str, str] = {}
        if station is not None:
            say("the robot's way of holding the gun")
            made, texts = _executed(painting, station, drive, limits.speed, say)
        proof = None if made is None else made.certificate
        proven = proof is None or proof.proven
        written: list[Path] = []
        if out is not None:
            say("drawing")
            files = pictures_of(source, painting, made)
            if proven or unproven:
                files = {name: text.encode() for name, text in texts.items()} | files
            named = {Path(name): data for name, data in files.items()}
            written = write_in("--out", out, named, inputs, force)
    if json:
        print_json(report_json(source, painting, made, written))
    else:
        tell(source, painting, made, written)
    if not proven:
        if out is not None and not unproven:
            warn("the program is not written, since it is not proven; --unproven writes it")
        raise typer.Exit(1)


def _sized(
    load: Callable[..., Part],
    file: Path,
    units: str | None,
    view: tuple[float, float, float] | None,
    finest: float,
) -> Part:
    """The part, fine enough; coarse first, so that wrong units are told before it is cut up."""
    from ..problems.paint.surface.loading import PLAUSIBLE_SIZE

    shape = load(file, units, view, longest_edge=1e6)
    doubts = [n for n in shape.notes if "numbers are probably" in n.message]
    if doubts and max(shape.vertices.max(axis=0) - shape.vertices.min(axis=0)) > PLAUSIBLE_SIZE[1]:
        raise InputError(str(doubts[0]))
    return load(file, units, view, longest_edge=finest)


def _teller(say: Callable[[str], None]) -> Callable[..., bool]:
    def tell_round(number: int, iteration: object) -> bool:
        say(f"optimising: round {number + 1} (Ctrl-C ends with the best)")
        return False

    return tell_round


def _executed(
    painting: Painting,
    station: Station,
    drive: DriveOptions,
    speed: tuple[float, float],
    say: Callable[[str], None],
) -> tuple[Executable, dict[str, str]]:
    """The program as read from its text, and the text."""
    from ..problems.paint.executable.execute import execute
    from .emission import written_anew

    texts: dict[str, str] = {}

    def read_back(program: Program) -> Program:
        read, sources = written_anew(station.vendor, station.cell.robot, program)
        texts.update(sources)
        return read

    def tell_round(number: int, coat: Coat) -> bool:
        say(f"as emulated, round {number + 1}: std {1e6 * coat.by_area.std:.2f} µm")
        return False

    made = execute(painting, station, drive, speed, read_back=read_back, progress=tell_round)
    return made, texts
