"""What a user asks of an optimisation, from the options' text."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..core.errors import InputError
from . import values

if TYPE_CHECKING:
    from ..core.cell.cell import Cell
    from ..core.program.program import Program
    from ..core.program.target import JointTarget
    from ..core.vendor import Vendor
    from ..problems.waypoints import Effort, PointLimit, Task, ViaCount

ALL = "all"


def task_of(
    program: Program,
    cell: Cell,
    vendor: Vendor,
    *,
    objective: str,
    keep: Sequence[str],
    free: Sequence[str],
    limits: Sequence[str],
    axes: str | None,
    clearance: float | None,
    vias: str,
    start: JointTarget | None,
) -> Task:
    """The task that the options describe; see `flyby optimize --help` for their forms.

    Raises:
        InputError: naming the option.
    """
    from ..problems.waypoints import Free, Task
    from ..problems.zones.sizes import pattern_for

    by_move, for_all = _limits(program, limits)
    numbers = [text for text in keep if text.isdecimal()]
    return Task(
        time_weight=_weight(objective),
        keep=[move_index(program, text, "--keep") for text in numbers],
        keep_speeds=[text for text in keep if not text.isdecimal()],
        limits=by_move,
        limit=for_all or Free(),
        axes=None if axes is None else _axes(axes, cell.robot.arm_size),
        clearance=None if clearance is None else 1e-3 * clearance,
        freed=freed_stops(program, free),
        pattern=pattern_for(vendor.speaks),
        vias=_vias(vias),
        start=start,
    )


def effort_of(starts: int | None, generations: int | None, seed: int) -> Effort:
    """How hard to search.

    Raises:
        InputError: a number out of its range.
    """
    from ..problems.waypoints import Effort

    usual = Effort(seed=seed)
    return Effort(
        starts=usual.starts if starts is None else starts,
        generations=usual.generations if generations is None else generations,
        seed=seed,
    )


def move_index(program: Program, text: str, option: str) -> int:
    """Index of the move with a number as people count.

    Raises:
        InputError: naming the option.
    """
    count = len(program.moves)
    if not text.isdecimal() or not 1 <= int(text) <= count:
        raise InputError(f"{option} {text}: the program has moves 1 to {count}")
    return int(text) - 1


def _weight(text: str) -> float:
    known = {"time": 1.0, "energy": 0.0}
    if text in known:
        return known[text]
    try:
        weight = float(text)
    except ValueError:
        weight = math.nan
    if not 0.0 <= weight <= 1.0:
        raise InputError(f"--objective {text}: time, energy or a weight between 0 and 1")
    return weight


def _vias(text: str) -> ViaCount:
    from ..problems.waypoints import ViaCount

    try:
        return ViaCount(text)
    except ValueError:
        raise InputError(f"--vias {text}: {' or '.join(ViaCount)}") from None


def _axes(text: str, count: int) -> list[int]:
    words = text.replace(",", " ").split()
    for word in words:
        if not word.isdecimal() or not 1 <= int(word) <= count:
            raise InputError(f"--axes {text}: numbers of joints from 1 to {count}, such as 2,3")
    return [int(word) - 1 for word in words]


def freed_stops(program: Program, free: Sequence[str]) -> list[int]:
    """Indices of the stops that may be passed.

    Raises:
        InputError: naming the option.
    """
    from ..problems.zones.points import passable_stops

    if ALL in free:
        return passable_stops(program)
    wrong = [text for text in free if not text.isdecimal()]
    if wrong:
        raise InputError(f"--free {wrong[0]}: the number of a move, or {ALL!r}")
    return [move_index(program, text, "--free") for text in free]


def _limits(
    program: Program, texts: Sequence[str]
) -> tuple[dict[int, PointLimit], PointLimit | None]:
    """Limits by move, and the one for all others."""
    by_move: dict[int, PointLimit] = {}
    for_all: PointLimit | None = None
    for text in texts:
        which, _, how = text.partition("=")
        limit = _limit(how, text)
        if which == ALL:
            for_all = limit
        else:
            by_move[move_index(program, which, "--limit")] = limit
    return by_move, for_all


def _limit(how: str, text: str) -> PointLimit:
    from ..problems.waypoints import Box, Cone, Fixed, Free

    kind, _, sizes = how.partition(":")
    option = f"--limit {text}"
    numbers = values.numbers(sizes, option) if sizes else ()
    match kind, len(numbers):
        case "fixed", 0:
            return Fixed()
        case "free", 0:
            return Free()
        case "box", 1 | 2:
            edge = 1e-3 * numbers[0]
            turn = math.radians(numbers[1]) if len(numbers) == 2 else None
            return Box(position=(edge, edge, edge), turn=turn)
        case "joints", 1:
            return Box(joints=(math.radians(numbers[0]),) * _MOST_JOINTS)
        case "cone", 1:
            return Cone(math.radians(numbers[0]))
    raise InputError(
        f"{option}: MOVE=fixed, MOVE=free, MOVE=box:MM, MOVE=box:MM,DEGREES, MOVE=joints:DEGREES "
        "or MOVE=cone:DEGREES"
    )


_MOST_JOINTS = 7
