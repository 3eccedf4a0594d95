"""Via points and zones that make a program faster, proven free of collision."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ..core.door import given
from ..core.errors import OptionError
from .changes import WaypointOptions, delivered, idle_notes, task_of, weight
from .files.texts import ProgramTexts, written_anew
from .options.entries import COUNT, Extent, choice, number, switch, value
from .options.keywords import by_keywords
from .results.cell_course import CellCourse
from .setup import CellOptions, controller_of, with_setup

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..problems.improve.progress import Progress
    from ..problems.improve.solution import Solution
    from ..problems.improve.solve_round_verify import Beside
    from ..problems.improve.waypoints import Effort

CHANGE = "change"


@dataclass(frozen=True, kw_only=True)
class OptimizeOptions(WaypointOptions, CellOptions):
    """How a program is made faster."""

    objective: float | str = value(
        "time",
        "time, energy, or a weight w between 0 and 1: w · time + (1 − w) · energy, each as a share "
        "of what the program takes now.",
        weight,
    )
    zones_only: bool = switch("Change zones alone; every point stays.")
    predefined: bool = switch("Choose among the vendor's predefined zones.")
    vias: str = choice(
        "keep",
        "keep: the number of via points stays; change: idle ones go, and others come where they "
        "save enough.",
        ("keep", CHANGE),
    )
    starts: int | None = number(
        None, "Paths to start from; more find better routes.", COUNT, Extent(1)
    )
    generations: int | None = number(
        None,
        "How often the best path is varied in turn; 0 is quickest.",
        COUNT,
        Extent(0),
    )
    own: bool = switch("Moves get data of their own where the text has no place for a change.")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.zones_only and (self.limit or self.tilt != 0.0 or self.vias == CHANGE):
            raise OptionError(
                f"{self.spelt('zones_only')} leaves every point as it is: {self.spelt('limit')}, "
                f"{self.spelt('tilt')} and {given('vias', CHANGE)} do not go with it"
            )


def optimize_with(program: Program, options: OptimizeOptions) -> Solution:
    """Move via points and size zones so that the program becomes faster, and prove it.

    Args:
        program: as `flyby.read` gives it.

    Returns:
        The new program, read back from its text, with figures before and after and the proof that
        it keeps its clearance; the program that was given where nothing better was found.

    Raises:
        InputError: naming the option.
        MotionError: the program cannot be driven, or collides as it is.
    """
    return optimize_beside(program, options, None)


optimize = by_keywords(optimize_with, OptimizeOptions)


def optimize_beside(program: Program, options: OptimizeOptions, beside: Beside | None) -> Solution:
    """The same beside other robots.

    Args:
        program, options: see `optimize_with`.
        beside: what the other robots say of a program; None where there are none.
    """
    from ..problems.improve.waypoints import Freedom, optimize_waypoints

    program, setup = with_setup(program, options)
    cell = setup.surroundings(program, no_floor=options.no_floor)
    course = replace(CellCourse.of(program, setup), counted=options.vias == CHANGE)
    if course.counted:  # what cannot be written anew is refused before the search
        course.loaded(written_anew(setup, program)[0])
    task = task_of(
        program,
        setup,
        options,
        objective=options.objective,
        vias=options.vias,
        predefined=options.predefined,
        handling=course.handling,
    )
    texts = ProgramTexts(setup, program, own=options.own)

    def report(state: Progress) -> None:
        gained = "" if state.best == 1.0 else f", best so far {100 * state.best:.1f} %"
        options.say(
            f"{state.stage}: {state.done} of {state.total}{gained} (Ctrl-C ends with the best)"
        )

    task = replace(task, beside=beside)
    if options.zones_only:
        task = replace(task, freedom=Freedom.ZONES)
    controller = controller_of(program, setup)
    effort = effort_of(options.starts, options.generations, options.seed)

    def read_back(changed: Program) -> Program:
        return course.loaded(texts.read_back(course.unloaded(changed)))

    found = optimize_waypoints(controller, course.program, cell, task, effort, read_back, report)
    idle = idle_notes(program, setup, options, task, found.notes)
    return delivered(course.given_back(found), texts, setup, idle)


def effort_of(starts: int | None, generations: int | None, seed: int) -> Effort:
    """How hard to search; None for what is usual."""
    from ..problems.improve.waypoints import Effort

    usual = Effort(seed=seed)
    return Effort(
        starts=usual.starts if starts is None else starts,
        generations=usual.generations if generations is None else generations,
        seed=seed,
    )
