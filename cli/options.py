"""Options that several commands have, in one wording."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

ProgramFile = Annotated[Path, typer.Argument(help="Program file in its vendor's language.")]
RobotName = Annotated[
    str | None,
    typer.Option("--robot", help="Robot, such as abb/irb6640-180-255 ('flyby robots')."),
]
CellFile = Annotated[
    Path | None, typer.Option("--cell", help="Cell file: robot, base and external axes.")
]
MotionFile = Annotated[
    Path | None,
    typer.Option("--motion", help="How the robot is driven, as 'flyby identify' writes it (TOML)."),
]
Entry = Annotated[str | None, typer.Option("--entry", help="Routine to run.")]
AnswersFile = Annotated[
    Path | None,
    typer.Option("--io", help="Answers to what the program asks of signals and operators (TOML)."),
]
OtherFiles = Annotated[
    list[Path] | None,
    typer.Option("--with", help="A further file of the program; may be given several times."),
]
Start = Annotated[
    str | None,
    typer.Option(
        "--start",
        help="Axis values before the first move, degrees and mm: 0,0,0,0,30,0. "
        "Without it the robot stands at the first target.",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print the report as JSON.")]
Force = Annotated[bool, typer.Option("--force", help="Replace output files.")]
Out = Annotated[Path | None, typer.Option("--out", help="Folder to write the files to.")]

# What an optimisation may change.
WholeCell = Annotated[
    Path | None,
    typer.Option("--cell", help="Cell file: robot, tools, obstacles, clearance."),
]
NoFloor = Annotated[
    bool,
    typer.Option(
        "--no-floor",
        help="Without --cell the plane under the robot's base is an obstacle; this lifts it.",
    ),
]
Kept = Annotated[
    list[str] | None,
    typer.Option(
        "--keep",
        help="A move whose path and speed the process fixes, by its number or by the name of "
        "its speed; may be given several times.",
    ),
]
Freed = Annotated[
    list[str] | None,
    typer.Option(
        "--free",
        help="A stop that may be passed, by the number of its move, or 'all'; may be given "
        "several times.",
    ),
]
Limits = Annotated[
    list[str] | None,
    typer.Option(
        "--limit",
        help="How far a via point may move: MOVE=fixed, MOVE=free, MOVE=box:MM[,DEGREES], "
        "MOVE=joints:DEGREES or MOVE=cone:DEGREES; MOVE may be 'all'.",
    ),
]
Axes = Annotated[
    str | None,
    typer.Option(help="Joints that joint targets may change, such as 2,3; all if unset."),
]
Tilt = Annotated[
    float,
    typer.Option(
        "--tilt",
        help="Degrees by which the tool may be turned at via points; 180 for as it likes. Without "
        "it, what the tool holds stays as it is turned.",
    ),
]
Clearance = Annotated[
    float | None,
    typer.Option("--clearance", help="Clearance to keep, mm; the cell's own if unset."),
]
Predefined = Annotated[
    bool, typer.Option("--predefined", help="Choose among the vendor's predefined zones.")
]
Seed = Annotated[int, typer.Option(help="Of the variations of the path.")]
InPlace = Annotated[bool, typer.Option("--in-place", help="Change the program's own files.")]
