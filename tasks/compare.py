"""How well the emulator predicts a log."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.display import counted
from ..core.door import called, spelt
from ..core.errors import InputError, OptionError
from .catalogue import registry
from .options.entries import value
from .options.guessed_robot import read_or_guess
from .options.keywords import by_keywords
from .options.texts import joint_target
from .read import SourceOptions
from .setup import Setup, setup_of, setup_of_program

if TYPE_CHECKING:
    from ..core.motion.model.rules import ArcTurn
    from ..core.program.program import Program
    from ..identification.logs import LoggedRun
    from ..identification.prediction import Prediction
    from ..identification.time_scale import TimeScale
    from .results.comparison import Comparison

RECORD = ".json"


@dataclass(frozen=True, kw_only=True)
class CompareOptions(SourceOptions):
    """A log, and how the program is read that it is held against."""

    log: str | Path | None = value(
        None, "Log of a run; of a record it is the one that it names.", kind=Path, typed=False
    )
    columns: str | Path | None = value(
        None, "Names the log's columns and their units (TOML).", kind=Path
    )


def compare_with(program: Program | str | Path, options: CompareOptions) -> Comparison:
    """Hold a controller's log against the emulation of its program: in space and in time.

    Args:
        program: as `flyby.read` gives it, its file, or the record of a run (JSON).

    Raises:
        InputError: no log is named, it cannot be read, or is another program's.
    """
    setup, run = _load(program, options)
    options.say(f"emulating {counted(run.program.moves, 'move')}")
    found, scale = _compared(setup, run, options)
    from .results.comparison import Comparison

    stated = setup.vendor.motion_of(setup.robot).arc_turn
    logged = [*run.notes, *found.log.notes[len(run.notes) :]]
    where = program if isinstance(program, str | Path) else run.name
    named = where if options.log is None else options.log
    notes = (*(f"{named}: {note}" for note in logged), *_told(found, scale, stated))
    return Comparison(run, found, scale, notes)


compare = by_keywords(compare_with, CompareOptions)


def _load(program: Program | str | Path, options: CompareOptions) -> tuple[Setup, LoggedRun]:
    """The robot with its vendor, and the run."""
    from ..identification.logs import LoggedRun, load_columns, load_run, read_samples

    mapped = None if options.columns is None else load_columns(Path(options.columns))
    if isinstance(program, str | Path) and Path(program).suffix.lower() == RECORD:
        if options.log is not None or mapped is not None:
            raise InputError(f"{program}: a record of a run names its log; give no other")
        run = load_run(Path(program), registry().find_robot)
        named = options.robot is not None or options.cell is not None
        setup = setup_of(options if named else replace(options, robot=run.robot))
        if setup.robot.name != run.robot:
            raise InputError(f"{program}: the run is one of {run.robot}, not of {setup.robot.name}")
        return setup, run
    if options.log is None:
        name = program if isinstance(program, str | Path) else program.name
        behind = "Name it behind" if spelt("log") != "log" else "Give log= for"
        raise OptionError(f"which log? {behind} {name}")
    if isinstance(program, str | Path):
        program = read_or_guess(program, options)
    setup = setup_of_program(program)
    log = Path(options.log)
    samples = read_samples(log, setup.robot, mapped)
    robot = setup.robot.name
    return setup, LoggedRun(log.stem, robot, None, program, samples.t, samples.q, samples.notes)


def _compared(
    setup: Setup, run: LoggedRun, options: CompareOptions
) -> tuple[Prediction, TimeScale | None]:
    """The log beside its emulation, and what alone explains its times."""
    from ..core.motion.emulator.controller import Controller
    from ..identification.logs import clean
    from ..identification.prediction import predict
    from ..identification.time_scale import time_scale

    start = joint_target(options.start, spelt("start"), setup.robot)
    try:
        log = clean(run)
    except InputError as error:
        raise InputError(f"{run.name}: {error}") from error
    program = run.program if start is None else replace(run.program, start=start)
    controller = Controller(setup.vendor, setup.robot)
    found = predict(controller, run.name, program, log)
    scale = time_scale(controller, found) if run.timed else None
    return found, scale if scale is not None and scale.alone else None


def _told(compared: Prediction, scale: TimeScale | None, turn: ArcTurn) -> list[str]:
    told = [] if scale is None else [f"{compared.name}: {scale.told}"]
    if compared.turn is not None and compared.turn is not turn:
        told.append(
            f'{compared.name}: along arcs the tool turns as arc.turn = "{compared.turn}" says, '
            f'not "{turn}" as the motion model does: so it was emulated. '
            f"{called('identify')} writes it"
        )
    return told
