"""What a program may be changed in, as users say it: options of all improvements."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeVar

from ..core.door import at_command_line, spelt, switched
from ..core.errors import InputError, OptionError
from .files.not_executed import not_executed_notes
from .options import texts
from .options.entries import ANGLE, COUNT, DISTANCE, NOT_NEGATIVE, Extent, number, value
from .setup import RobotOptions, Setup, like, start_of

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..core.vendor import Vendor
    from ..problems.improve.rounding import Rounding
    from ..problems.improve.solution import Solution
    from ..problems.improve.waypoints import PointLimit, WaypointTask
    from .files.texts import ProgramTexts

Made = TypeVar("Made", bound="Solution")

ALL = "all"


@dataclass(frozen=True, kw_only=True)
class ChangeOptions(RobotOptions):
    """What must stay and what must be kept; of every program that is changed in a cell."""

    clearance: float | None = number(
        None, "Clearance to keep, {unit}; the cell's own if unset.", DISTANCE, NOT_NEGATIVE
    )
    free: Sequence[int | str] = value(
        (),
        "A stop that may be passed, by the number of its move, or 'all'; may be given several "
        "times.",
        several=True,
    )
    keep: Sequence[int | str] = value(
        (),
        "A move whose path and speed the process fixes, by its number or by the name of its speed; "
        "may be given several times.",
        several=True,
    )


@dataclass(frozen=True, kw_only=True)
class WaypointOptions(ChangeOptions):
    """How far via points may move, and how long it is searched."""

    limit: Sequence[str] | Mapping[int | str, PointLimit] = value(
        (),
        "How far a via point may move: MOVE=fixed, MOVE=free, MOVE=box:MM[,DEGREES], "
        "MOVE=joints:DEGREES or MOVE=cone:DEGREES; MOVE may be 'all'.",
        several=True,
    )
    axes: str | Sequence[int] | None = value(
        None, "Joints that joint targets may change, such as 2,3; all if unset."
    )
    tilt: float = number(
        0.0,
        "By how much the tool may be turned at via points, {unit}; half a turn for as it likes. "
        "Without it, what the tool holds stays as it is turned.",
        ANGLE,
        Extent(0.0, 180.0),
    )
    seed: int = number(0, "Of the variations of the path.", COUNT, Extent(0))


def task_of(
    program: Program,
    setup: Setup,
    options: WaypointOptions,
    *,
    objective: float | str = "time",
    vias: str = "keep",
    predefined: bool = False,
) -> WaypointTask:
    """The task that options describe.

    Args:
        program: that is to be changed.
        setup: its robot.
        options: what stays and what moves.
        objective: see `weight`.
        vias: ``keep`` or ``change``.
        predefined: whether zones are chosen among the vendor's own.

    Raises:
        InputError: naming the option.
    """
    from ..problems.improve.waypoints import Free, ViaCount, WaypointTask
    from ..problems.improve.zones.sizes import pattern_for

    by_move, for_all = _limits(program, options.limit)
    keep = list(map(str, options.keep))
    kept = [move_index(program, text, "keep") for text in keep if text.isdecimal()]
    speeds = [_speed(program, text) for text in keep if not text.isdecimal()]
    held = {*kept, *(i for i, move in enumerate(program.moves) if move.speed.name in speeds)}
    return WaypointTask(
        time_weight=weight(objective, spelt("objective")),
        keep=kept,
        keep_speeds=speeds,
        limits=by_move,
        limit=for_all or Free(),
        axes=None if options.axes is None else joint_indices(options.axes, setup.robot.arm_size),
        tilt=options.tilt,
        clearance=options.clearance,
        freed=freed_stops(program, options.free, {*held, *(i - 1 for i in held)}),
        pattern=pattern_for(setup.vendor.speaks),
        rounding=rounding_of(setup.vendor, predefined),
        vias=ViaCount(vias),
        start=start_of(program),
    )


def delivered(made: Made, read_back: ProgramTexts, setup: Setup) -> Made:
    """A solution with its texts, its robot, and notes on code that was not executed.

    Args:
        made: as an optimisation hands it out.
        read_back: that has read its program back last.
        setup: its robot.
    """
    if not made.changed:
        return made
    noted = not_executed_notes(made.original, made.program, setup.vendor)
    return replace(
        made,
        program=like(made.program, made.original, setup),
        notes=(*made.notes, *noted),
        texts=read_back.last,
    )


def weight(objective: Any, name: str) -> float:
    """The weight of time against energy: ``time``, ``energy`` or a number between 0 and 1.

    Raises:
        InputError: it is none of these.
    """
    known = {"time": 1.0, "energy": 0.0}
    if isinstance(objective, str) and objective in known:
        return known[objective]
    try:
        found = float(objective)
    except (TypeError, ValueError):
        found = math.nan
    if not 0.0 <= found <= 1.0:
        raise OptionError(f"{name} {objective}: time, energy or a weight between 0 and 1")
    return found


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
        raise InputError(f"{switched('predefined')}: {vendor.name} has no predefined zones")
    return Rounding.of(vendor.speaks, known)


def move_index(program: Program, text: int | str, option: str) -> int:
    """Index of the move with a number as people count.

    Raises:
        InputError: naming the option.
    """
    count = len(program.moves)
    if not str(text).isdecimal() or not 1 <= int(text) <= count:
        raise InputError(f"{spelt(option)} {text}: the program has moves 1 to {count}")
    return int(text) - 1


def joint_indices(given: str | Sequence[int], count: int) -> list[int]:
    """Indices of joints by their numbers from 1.

    Raises:
        OptionError: it names no joints; naming the option.
        InputError: the robot has no such joint; likewise.
    """
    text = given if isinstance(given, str) else ",".join(map(str, given))
    words = text.replace(",", " ").split()
    said = f"{spelt('axes')} {text or repr(text)}: numbers of joints from 1 to {count}, such as 2,3"
    if not words or not all(word.isdecimal() for word in words):
        raise OptionError(said)
    if not all(1 <= int(word) <= count for word in words):
        raise InputError(said)
    return [int(word) - 1 for word in words]


def freed_stops(program: Program, free: Sequence[int | str], kept: Collection[int]) -> list[int]:
    """Indices of the stops that may be passed.

    Args:
        program: the program.
        free: numbers of moves, or ``all``.
        kept: indices of the moves whose zones are to stay; ``all`` leaves them out.

    Raises:
        InputError: naming the option.
    """
    from ..problems.improve.zones.points import passable_stops

    if ALL in free:
        return [i for i in passable_stops(program) if i not in kept]
    wrong = [text for text in free if not str(text).isdecimal()]
    if wrong:
        once = "; once for each move" if at_command_line() and "," in str(wrong[0]) else ""
        raise OptionError(f"{spelt('free')} {wrong[0]}: the number of a move, or {ALL!r}{once}")
    freed = [move_index(program, text, "free") for text in free]
    for i in freed:
        if i in kept:
            raise OptionError(
                f"{spelt('free')} {i + 1}: {spelt('keep')} has this stop stay; give one of them"
            )
    return freed


def _limits(
    program: Program, given: Sequence[str] | Mapping[int | str, PointLimit]
) -> tuple[dict[int, PointLimit], PointLimit | None]:
    """Limits by move, and the one for all others."""
    if isinstance(given, Mapping):
        named = {move_index(program, k, "limit"): v for k, v in given.items() if k != ALL}
        return named, given.get(ALL)
    by_move: dict[int, PointLimit] = {}
    for_all: PointLimit | None = None
    for text in given:
        which, _, how = text.partition("=")
        limit = _limit(how, text)
        if which == ALL:
            for_all = limit
        elif which.isdecimal():
            by_move[move_index(program, which, "limit")] = limit
        else:
            raise OptionError(f"{spelt('limit')} {text}: {_LIMITS}")
    return by_move, for_all


def _limit(how: str, text: str) -> PointLimit:
    from ..problems.improve.waypoints import Fixed, Free, PointBox, PointCone

    kind, _, sizes = how.partition(":")
    option = f"{spelt('limit')} {text}"
    numbers = texts.numbers(sizes, option) if sizes else ()
    if any(number < 0.0 for number in numbers):
        raise OptionError(f"{option}: ranges are zero or more")
    if kind == "cone" and any(number >= 180.0 for number in numbers):
        raise OptionError(f"{option}: a cone's angle is below 180°")
    match kind, len(numbers):
        case "fixed", 0:
            return Fixed()
        case "free", 0:
            return Free()
        case "box", 1 | 2:
            edge = 1e-3 * numbers[0]
            turn = math.radians(numbers[1]) if len(numbers) == 2 else None
            return PointBox(position=(edge, edge, edge), turn=turn)
        case "joints", 1:
            return PointBox(joints=(math.radians(numbers[0]),) * _MOST_JOINTS)
        case "cone", 1:
            return PointCone(math.radians(numbers[0]))
    raise OptionError(f"{option}: {_LIMITS}")


def _speed(program: Program, name: str) -> str:
    """The name of a speed of the program."""
    known = {move.speed.name for move in program.moves if move.speed.name is not None}
    if name not in known:
        names = ", ".join(sorted(known)) or "none that has a name"
        raise InputError(
            f"{spelt('keep')} {name or repr(name)}: a move's number, or a speed ({names})"
        )
    return name


_LIMITS = (
    "MOVE=fixed, MOVE=free, MOVE=box:MM, MOVE=box:MM,DEGREES, MOVE=joints:DEGREES or "
    "MOVE=cone:DEGREES; MOVE is a number, or 'all'"
)
_MOST_JOINTS = 7
