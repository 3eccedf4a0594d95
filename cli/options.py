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
