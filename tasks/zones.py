"""Every zone of a program as large as obstacles and rules let it be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .changes import (
    ChangeOptions,
    at_speeds,
    delivered,
    freed_stops,
    kept_moves,
    outputs_at_work,
    process_of,
    rounding_of,
    with_begins,
)
from .files.texts import ProgramTexts
from .options.entries import switch, value
from .options.idle import ALL, idle_freed, idle_kept
from .options.keywords import by_keywords
from .results.cell_course import CellCourse
from .setup import CellOptions, controller_of, start_of, with_setup

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..problems.improve.solve_round_verify import Beside
    from ..problems.improve.zones.maximize import ZoneSolution


@dataclass(frozen=True, kw_only=True)
class ZoneOptions(ChangeOptions, CellOptions):
    """How zones are made larger."""

    keep: Sequence[int | str] = value(
        (),
        "A move whose zone stays: its number, line:44, the name of its target or of its speed; "
        "may be given several times.",
        several=True,
    )
    predefined: bool = switch("Choose among the vendor's predefined zones.")
    own: bool = switch("Moves that share one datum, or compute their zone, get one of their own.")


def zones_with(program: Program, options: ZoneOptions) -> ZoneSolution:
    """Make zones as large as they can be without collision, and prove the new program.

    Args:
        program: as `flyby.read` gives it.

    Returns:
        The new program, read back from its text, with its proof, or why there is none.

    Raises:
        InputError: naming the option.
        MotionError: the program cannot be driven, or collides as it is.
    """
    return zones_beside(program, options, None)


zones = by_keywords(zones_with, ZoneOptions)


def zones_beside(program: Program, options: ZoneOptions, beside: Beside | None) -> ZoneSolution:
    """The same beside other robots.

    Args:
        program, options: see `zones_with`.
        beside: what the other robots say of a program; None where there are none.
    """
    from ..core.program.zone import Fine
    from ..problems.improve.zones.maximize import maximize_zones
    from ..problems.improve.zones.options import ZoneTask
    from ..problems.improve.zones.sizes import pattern_for

    program, setup = with_setup(program, options)
    cell = setup.surroundings(program, no_floor=options.no_floor)
    course = CellCourse.of(program, setup)
    moves, speeds = kept_moves(program, options.keep)
    kept = {*moves, *at_speeds(program, speeds)}
    process = process_of(program, setup, options.free, course.handled)
    wanted = ZoneTask(
        clearance=options.clearance,
        freed=freed_stops(program, setup, options.free, kept, course.handled, with_begins(process)),
        pattern=pattern_for(setup.vendor.speaks),
        kept=sorted({*kept, *course.handled}),
        process=process,
        apart=options.own,
        rounding=rounding_of(setup.vendor, options.predefined),
        start=start_of(program),
        beside=beside,
        handling=course.handling,
    )
    texts = ProgramTexts(setup, program, own=options.own)
    controller = controller_of(program, setup)

    def read_back(changed: Program) -> Program:
        return course.loaded(texts.read_back(course.unloaded(changed)))

    found = maximize_zones(controller, course.program, cell, wanted, read_back, options.say)
    able = {i for i, move in enumerate(program.moves) if not isinstance(move.zone, Fine)}
    able |= set(freed_stops(program, setup, options.free, ())) if ALL in options.free else set()
    idle = idle_kept(program, options.keep, able, path=False)
    idle += idle_freed(program, options.free, outputs_at_work(program, setup))
    return delivered(course.given_back(found), texts, setup, idle)
