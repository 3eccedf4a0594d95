"""What a user asks of an optimisation, from the options' text."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from ..core.errors import InputError
from . import values

if TYPE_CHECKING:
    from ..core.cell.cell import Cell
    from ..core.program.program import Program
    from ..core.program.target import JointTarget
    from ..core.vendor import Vendor
    from ..problems.improve.rounding import Rounding
    from ..problems.improve.waypoints import Effort, PointLimit, Task, ViaCount

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
    tilt: float,
    clearance: float | None,
    vias: str,
    predefined: bool,
    start: JointTarget | None,
) -> Task:
    """The task that the options describe; see `flyby optimize --help` for their forms.

    Raises:
        InputError: naming the option.
    """
    from ..problems.improve.waypoints import Free, Task
    from ..problems.improve.zones.sizes import pattern_for

    by_move, for_all = _limits(program, limits)
    kept = [move_index(program, text, "--keep") for text in keep if text.isdecimal()]
    speeds = [_speed(program, text) for text in keep if not text.isdecimal()]
    held = {*kept, *(i for i, move in enumerate(program.moves) if move.speed.name in speeds)}
    return Task(
        time_weight=_weight(objective),
        keep=kept,
        keep_speeds=speeds,
        limits=by_move,
        limit=for_all or Free(),
        axes=None if axes is None else _axes(axes, cell.robot.arm_size),
        tilt=_tilt(tilt),
        clearance=clearance_of(clearance),
        freed=freed_stops(program, free, {*held, *(i - 1 for i in held)}),
        pattern=pattern_for(vendor.speaks),
        rounding=rounding_of(vendor, predefined),
        vias=_vias(vias),
        start=start,
    )


def effort_of(starts: int | None, generations: int | None, seed: int) -> Effort:
    """How hard to search.

    Raises:
        InputError: a number out of its range.
    """
    from ..problems.improve.waypoints import Effort

    for option, value, least in (
        ("--starts", starts, 1),
        ("--generations", generations, 0),
        ("--seed", seed, 0),
    ):
        if value is not None and value < least:
            raise InputError(f"{option} {value}: a number from {least} on")
    usual = Effort(seed=seed)
    return Effort(
        starts=usual.starts if starts is None else starts,
        generations=usual.generations if generations is None else generations,
        seed=seed,
    )


def clearance_of(millimetres: float | None) -> float | None:
    """``--clearance`` in m; None for the cell's own.

    Raises:
        InputError: it is no distance.
    """
    if millimetres is None:
        return None
    if not 0.0 <= millimetres < math.inf:
        raise InputError(f"--clearance {millimetres:g}: a distance in mm, zero or more")
    return 1e-3 * millimetres


def rounding_of(vendor: Vendor, predefined: bool) -> Rounding:
    """How new numbers are written in a vendor's language.

    Args:
        vendor: whose language it is.
        predefined: whether zones are to be chosen from the vendor's own.

    Raises:
        InputError: the vendor has no zones of its own.
    """
    from ..problems.improve.rounding import Rounding

    known = () if vendor.speaks is None or not predefined else vendor.speaks.zones()
    if predefined and not known:
        raise InputError(f"--predefined: {vendor.name} has no predefined zones")
    return Rounding.of(vendor.speaks, known)


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


def _tilt(degrees: float) -> float:
    if not 0.0 <= degrees <= 180.0:
        raise InputError(f"--tilt {degrees:g}: degrees from 0 to 180")
    return math.radians(degrees)


def _vias(text: str) -> ViaCount:
    from ..problems.improve.waypoints import ViaCount

    try:
        return ViaCount(text)
    except ValueError:
        raise InputError(f"--vias {text}: {' or '.join(ViaCount)}") from None


def _axes(text: str, count: int) -> list[int]:
    words = text.replace(",", " ").split()
    if not words or not all(word.isdecimal() and 1 <= int(word) <= count for word in words):
        raise InputError(
            f"--axes {text or repr(text)}: numbers of joints from 1 to {count}, such as 2,3"
        )
    return [int(word) - 1 for word in words]


def freed_stops(program: Program, free: Sequence[str], kept: Collection[int]) -> list[int]:
    """Indices of the stops that may be passed.

    Args:
        program: the program.
        free: as ``--free`` gives them.
        kept: indices of the moves whose zones are to stay; ``all`` leaves them out.

    Raises:
        InputError: naming the option.
    """
    from ..problems.improve.zones.points import passable_stops

    if ALL in free:
        return [i for i in passable_stops(program) if i not in kept]
    wrong = [text for text in free if not text.isdecimal()]
    if wrong:
        raise InputError(f"--free {wrong[0]}: the number of a move, or {ALL!r}")
    freed = [move_index(program, text, "--free") for text in free]
    for i in freed:
        if i in kept:
            raise InputError(f"--free {i + 1}: --keep has this stop stay; give one of them")
    return freed


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
        elif which.isdecimal():
            by_move[move_index(program, which, "--limit")] = limit
        else:
            raise InputError(f"--limit {text}: {_LIMITS}")
    return by_move, for_all


def _limit(how: str, text: str) -> PointLimit:
    from ..problems.improve.waypoints import Box, Cone, Fixed, Free

    kind, _, sizes = how.partition(":")
    option = f"--limit {text}"
    numbers = values.numbers(sizes, option) if sizes else ()
    if any(number < 0.0 for number in numbers):
        raise InputError(f"{option}: ranges are zero or more")
    if kind == "cone" and any(number >= 180.0 for number in numbers):
        raise InputError(f"{option}: a cone's angle is below 180°")
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
    raise InputError(f"{option}: {_LIMITS}")


def _speed(program: Program, name: str) -> str:
    """The name of a speed of the program."""
    known = {move.speed.name for move in program.moves if move.speed.name is not None}
    if name not in known:
        names = ", ".join(sorted(known)) or "none that has a name"
        raise InputError(f"--keep {name or repr(name)}: a move's number, or a speed ({names})")
    return name


_LIMITS = (
    "MOVE=fixed, MOVE=free, MOVE=box:MM, MOVE=box:MM,DEGREES, MOVE=joints:DEGREES or "
    "MOVE=cone:DEGREES; MOVE is a number, or 'all'"
)
_MOST_JOINTS = 7
