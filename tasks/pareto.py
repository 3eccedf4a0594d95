"""What can be had between the cycle time of a program and its energy."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ..core.door import spelt
from ..core.errors import OptionError
from .changes import WaypointOptions, idle_notes, task_of
from .files.texts import ProgramTexts
from .motors import MotorOptions
from .optimize import effort_of
from .options.entries import COUNT, Extent, choice, number
from .options.keywords import by_keywords
from .results.cell_course import CellCourse
from .setup import controller_of, with_setup

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..problems.improve.energy import FrontPoint
    from ..problems.improve.progress import Progress
    from .results.fronts import ProgramFront

SCOPES = ("waypoints", "zones", "speeds")


@dataclass(frozen=True, kw_only=True)
class ParetoOptions(MotorOptions, WaypointOptions):
    """Which programs are looked for between time and energy."""

    points: int = number(8, "Durations to look at; two or more.", COUNT, Extent(2))
    change: str = choice(
        "waypoints",
        "What may change: waypoints (with zones and speeds), zones (with speeds) or speeds. "
        "Without a cell it is speeds, with their accelerations.",
        SCOPES,
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
    course = CellCourse.of(program, setup)
    wishes = task_of(program, setup, options, handling=course.handling)
    task = EnergyTask(scope, options.consumption(setup.robot), wishes)
    texts = ProgramTexts(setup, program, own=True, anew=True, keep=True)
    read: list[tuple[Program, Program]] = []

    def read_back(changed: Program) -> Program:
        own = texts.read_back(course.unloaded(changed))
        read.append((course.loaded(own), own))
        return read[-1][0]

    def report(state: Progress) -> None:
        options.say(
            f"{state.stage}: {state.done} of {state.total} (Ctrl-C ends with what there is)"
        )

    made = pareto(
        controller_of(program, setup),
        course.program,
        setup.cell,
        task,
        options.points,
        effort_of(options.starts, None, options.seed),
        setup.vendor.speaks,
        read_back,
        report,
    )
    own = {id(loaded): program for loaded, program in read}

    def given_back(point: FrontPoint) -> FrontPoint:
        known = own.get(id(point.program))
        return replace(point, program=known or course.unloaded(point.program))

    idle = idle_notes(program, setup, options, wishes, made.notes)
    made = replace(
        made,
        given=given_back(made.given),
        points=tuple(map(given_back, made.points)),
        notes=(*idle, *course.notes, *made.notes),
    )
    return ProgramFront.of(made, program, texts, setup)


pareto = by_keywords(pareto_with, ParetoOptions)
