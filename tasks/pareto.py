"""What can be had between the cycle time of a program and its energy."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.door import spelt
from ..core.errors import InputError, OptionError
from .changes import WaypointOptions, idle_notes, task_of
from .files.texts import ProgramTexts
from .optimize import effort_of
from .options.entries import COUNT, Extent, choice, number, value
from .options.keywords import by_keywords
from .setup import controller_of, with_setup

if TYPE_CHECKING:
    from ..core.motion.model.consumption import Consumption
    from ..core.program.program import Program
    from ..core.robot.model import Robot
    from ..problems.improve.progress import Progress
    from .results.fronts import ProgramFront

SCOPES = ("waypoints", "zones", "speeds")


@dataclass(frozen=True, kw_only=True)
class ParetoOptions(WaypointOptions):
    """Which programs are looked for between time and energy."""

    points: int = number(8, "Durations to look at; two or more.", COUNT, Extent(2))
    change: str = choice(
        "waypoints",
        "What may change: waypoints (with zones and speeds), zones (with speeds) or speeds. "
        "Without a cell it is speeds, with their accelerations.",
        SCOPES,
    )
    motors: str | Path | Consumption | None = value(
        None,
        "Motor figures (TOML): energy is then what the mains give, in J; otherwise it is squared "
        "torque over time.",
        kind=Path,
    )
    starts: int = number(
        1, "Paths to start from; with 1, the program's own alone.", COUNT, Extent(1)
    )


def pareto_with(program: Program, options: ParetoOptions) -> ProgramFront:
    """Find programs from the fastest to the most frugal, each as code of its own.

    In a cell each is proven to keep its clearance, as read from its text.

    Args:
        program: as `flyby.read` gives it.

    Raises:
        InputError: naming the option.
        MotionError: the program cannot be driven.
    """
    from ..problems.improve.energy import EnergyScope, EnergyTask, pareto
    from .results.fronts import ProgramFront

    program, setup = with_setup(program, options)
    if setup.cell is None:
        for name in ("free", "limit", "axes", "tilt", "clearance"):
            if getattr(options, name):
                raise OptionError(
                    f"{spelt(name)} needs a cell ({spelt('cell')}): without one, only speeds change"
                )
    scope = EnergyScope.SPEEDS if setup.cell is None else EnergyScope(options.change)
    wishes = task_of(program, setup, options)
    task = EnergyTask(scope, consumption_of(options.motors, setup.robot), wishes)
    texts = ProgramTexts(setup, program, own=True, anew=True, keep=True)

    def report(state: Progress) -> None:
        options.say(
            f"{state.stage}: {state.done} of {state.total} (Ctrl-C ends with what there is)"
        )

    made = pareto(
        controller_of(program, setup),
        program,
        setup.cell,
        task,
        options.points,
        effort_of(options.starts, None, options.seed),
        setup.vendor.speaks,
        texts.read_back,
        report,
    )
    made = replace(made, notes=(*idle_notes(program, options, wishes), *made.notes))
    return ProgramFront.of(made, program, texts, setup)


pareto = by_keywords(pareto_with, ParetoOptions)


def consumption_of(motors: str | Path | Consumption | None, robot: Robot) -> Consumption:
    """What counts as energy: squared torque over time, or what the user's motors take.

    Raises:
        InputError: the file is unusable, or of a robot with other axes.
    """
    from ..core.motion.model.consumption import SQUARED_TORQUE
    from ..core.motion.model.motors_file import load_motors

    if motors is None:
        return SQUARED_TORQUE
    if not isinstance(motors, str | Path):
        return motors
    made = load_motors(Path(motors))
    if len(made.copper) > robot.size:
        raise InputError(
            f"{spelt('motors')} {motors}: {robot.name} has {robot.size} axes, "
            f"copper_w_per_nm2 has {len(made.copper)} numbers"
        )
    return made
