"""What a program may be changed in, as users say it: options of all improvements."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeVar

from ..core.door import spelt, switched
from ..core.errors import InputError, Note, OptionError
from .files.not_executed import not_executed_notes
from .options import texts
from .options.entries import ANGLE, COUNT, DISTANCE, NOT_NEGATIVE, Extent, number, value
from .options.idle import ALL, idle_freed, idle_kept, idle_limits
from .options.moves import NAMED, is_named, listed_names, moves_named, moves_to, targets
from .setup import RobotOptions, Setup, like, start_of

if TYPE_CHECKING:
    from ..core.dialect import SignalWords
    from ..core.handling.handling import Handling
    from ..core.program.program import Program
    from ..core.vendor import Vendor
    from ..problems.improve.rounding import Rounding
    from ..problems.improve.solution import Solution
    from ..problems.improve.waypoints import PointLimit, WaypointTask
    from .files.texts import ProgramTexts

Made = TypeVar("Made", bound="Solution")


@dataclass(frozen=True, kw_only=True)
class ChangeOptions(RobotOptions):
    """What must stay and what must be kept; of every program that is changed in a cell."""

    clearance: float | None = number(
        None, "Clearance to keep, {unit}; the cell's own if unset.", DISTANCE, NOT_NEGATIVE
    )
    free: Sequence[int | str] = value(
        (),
        "A stop that may be passed: the number of its move, line:44, the name of its target, or "
        "'all'; or an output, which is then on along no process, so that points on the way may "
        "change; may be given several times.",
        several=True,
    )
    keep: Sequence[int | str] = value(
        (),
        "A move whose path and speed the process fixes: its number, line:44, the name of its "
        "target or of its speed; may be given several times.",
        several=True,
    )


@dataclass(frozen=True, kw_only=True)
class WaypointOptions(ChangeOptions):
    """How far via points may move, and how long it is searched."""

    limit: Sequence[str] | Mapping[int | str, PointLimit] = value(
        (),
        "How far a via point may move: MOVE=fixed, MOVE=free, MOVE=box:MM[,DEGREES], "
        "MOVE=joints:DEGREES or MOVE=cone:DEGREES; MOVE is a number, line:44, the name of a target "
        "or 'all'.",
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
    handling: Handling | None = None,
) -> WaypointTask:
    """The task that options describe.

    Args:
        program: that is to be changed.
        setup: its robot.
        options: what stays and what moves.
        objective: see `weight`.
        vias: ``keep`` or ``change``.
        predefined: whether zones are chosen among the vendor's own.
        handling: of the cell's parts; None for a cell without.

    Raises:
        InputError: naming the option.
    """
    from ..problems.improve.waypoints import Free, ViaCount, WaypointTask
    from ..problems.improve.zones.sizes import pattern_for

    by_move, for_all = _limits(program, options.limit)
    kept, speeds = kept_moves(program, options.keep)
    handled = targets_of(handling)
    process = process_of(program, setup, options.free, handled)
    return WaypointTask(
        time_weight=weight(objective, spelt("objective")),
        keep=kept,
        keep_speeds=speeds,
        process=process,
        limits=by_move,
        limit=for_all or Free(),
        axes=None if options.axes is None else joint_indices(options.axes, setup.robot.arm_size),
        tilt=options.tilt,
        clearance=options.clearance,
        freed=freed_stops(
            program,
            setup,
            options.free,
            with_begins({*kept, *at_speeds(program, speeds)}),
            handled,
            with_begins(process),
        ),
        pattern=pattern_for(setup.vendor.speaks),
        rounding=rounding_of(setup.vendor, predefined),
        vias=ViaCount(vias),
        start=start_of(program),
        handling=handling,
    )


def targets_of(handling: Handling | None) -> tuple[int, ...]:
    """Indices of the moves at whose targets parts are taken or released; none without parts."""
    return () if handling is None else handling.targets


def idle_notes(
    program: Program,
    setup: Setup,
    options: WaypointOptions,
    task: WaypointTask,
    told: Sequence[Note] = (),
) -> list[Note]:
    """Notes on options that change nothing of what is done.

    Args:
        program, setup: what was improved.
        options, task: as asked.
        told: notes of the search, which say what stays.
    """
    from ..core.program.target import JointTarget
    from ..core.program.zone import Fine
    from ..problems.improve.waypoints.changeable import STAYS

    moves = program.moves
    passed = {i for i, move in enumerate(moves) if not isinstance(move.zone, Fine)}
    passed |= set(task.freed)
    notes = idle_kept(program, options.keep, passed, path=True)
    notes += idle_freed(program, options.free, outputs_at_work(program, setup))
    still = [note.message.partition(f"{STAYS}: ") for note in told]
    stay = {
        note.move: why
        for note, (part, found, why) in zip(told, still, strict=True)
        if found and part in ("", "its target ") and note.move is not None
    }
    notes += idle_limits(program, options.limit, passed, stay)
    by_joints = any(isinstance(moves[i].target, JointTarget) for i in passed)
    if options.axes is not None and not by_joints:
        why = "no via point is given by joint values"
        notes.append(Note(f"{spelt('axes')} has no effect: {why}"))
    return notes


def delivered(made: Made, read_back: ProgramTexts, setup: Setup, idle: Sequence[Note] = ()) -> Made:
    """A solution with its texts, its robot, and notes on code that was not executed.

    Args:
        made: as an optimisation hands it out.
        read_back: that has read its program back last.
        setup: its robot.
        idle: notes on options that had no effect.
    """
    made = replace(made, notes=(*idle, *made.notes))
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


def with_begins(moves: Iterable[int]) -> set[int]:
    """Indices of moves, and of those that end where they begin."""
    return {near for i in moves for near in (i - 1, i)}


def process_of(
    program: Program, setup: Setup, free: Sequence[int | str], handled: Collection[int]
) -> dict[int, str]:
    """Outputs by the indices of the moves that are taken for work, as they are on along them.

    Args:
        program: the program.
        setup: its robot, which says how its language sets outputs.
        free: what may change: stops, and outputs that are no process.
        handled: indices of the moves at whose targets parts are taken or released; what is switched
            there holds them.
    """
    from ..problems.improve.process_paths import along_process, process_paths

    paths = process_paths(program, _words(setup))
    holding = [p.output for p in paths if {p.on, p.off} & set(handled)]
    return along_process(paths, {name.casefold() for name in (*map(str, free), *holding)})


def outputs_at_work(program: Program, setup: Setup) -> frozenset[str]:
    """Names of the outputs that are on along a path that is taken for work."""
    from ..problems.improve.process_paths import process_paths

    return frozenset(path.output.casefold() for path in process_paths(program, _words(setup)))


def _words(setup: Setup) -> SignalWords | None:
    speaks = setup.vendor.speaks
    return None if speaks is None else speaks.signals


def freed_stops(
    program: Program,
    setup: Setup,
    free: Sequence[int | str],
    kept: Collection[int],
    handled: Collection[int] = (),
    process: Collection[int] = (),
) -> list[int]:
    """Indices of the stops that may be passed.

    Args:
        program: the program.
        setup: its robot.
        free: moves by number, line or target, or ``all``; and outputs, which name no stops.
        kept: indices of the moves whose zones are to stay; ``all`` leaves them out.
        handled: of those at whose targets parts are taken or released; likewise.
        process: of those that a process begins, ends or passes at; only ``all`` leaves them out.

    Raises:
        InputError: naming the option.
    """
    from ..problems.improve.process_paths import outputs_of
    from ..problems.improve.zones.points import passable_stops

    if ALL in free:
        return [i for i in passable_stops(program) if i not in {*kept, *handled, *process}]
    freed: list[int] = []
    outputs = outputs_of(program, _words(setup)) if free else ()
    for text in free:
        if str(text).casefold() in map(str.casefold, outputs):
            continue
        try:
            named = moves_named(program, text, "free")
        except InputError as error:
            known = f"; outputs that it sets: {listed_names(outputs)}" if outputs else ""
            raise type(error)(f"{error}{known}") from None
        for i in named:
            if i in handled:
                raise OptionError(
                    f"{spelt('free')} {text}: a part of the cell is taken or released there, so "
                    "the robot stops"
                )
            if i in kept:
                raise OptionError(
                    f"{spelt('free')} {text}: {spelt('keep')} has this stop stay; give one of them"
                )
            freed.append(i)
    return list(dict.fromkeys(freed))


def _limits(
    program: Program, given: Sequence[str] | Mapping[int | str, PointLimit]
) -> tuple[dict[int, PointLimit], PointLimit | None]:
    """Limits by move, and the one for all others."""
    if isinstance(given, Mapping):
        by_name = {name: limit for name, limit in given.items() if name != ALL}
        named = [(i, v) for k, v in by_name.items() for i in moves_named(program, k, "limit")]
        return dict(named), given.get(ALL)
    by_move: dict[int, PointLimit] = {}
    for_all: PointLimit | None = None
    for text in given:
        which, _, how = text.partition("=")
        limit = _limit(how, text)
        if which == ALL:
            for_all = limit
        else:
            by_move |= dict.fromkeys(moves_named(program, which, "limit"), limit)
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


def at_speeds(program: Program, speeds: Collection[str]) -> list[int]:
    """Indices of the moves at speeds of these names."""
    return [i for i, move in enumerate(program.moves) if move.speed.name in speeds]


def kept_moves(program: Program, given: Sequence[int | str]) -> tuple[list[int], list[str]]:
    """Moves and speeds that are kept: a name is a speed's, a target's, or both.

    Raises:
        InputError: naming the option.
    """
    moves: list[int] = []
    speeds: list[str] = []
    known = list(dict.fromkeys(m.speed.name for m in program.moves if m.speed.name is not None))
    for text in map(str, given):
        if not is_named(text):
            by_target = moves_to(program.moves, text)
            if text in known:
                speeds.append(text)
            elif not by_target:
                raise InputError(
                    f"{spelt('keep')} {text or repr(text)}: {NAMED}, or a speed "
                    f"({listed_names(known)}); targets: {listed_names(targets(program.moves))}"
                )
            moves += by_target
        else:
            moves += moves_named(program, text, "keep")
    return list(dict.fromkeys(moves)), speeds


_LIMITS = (
    "MOVE=fixed, MOVE=free, MOVE=box:MM, MOVE=box:MM,DEGREES, MOVE=joints:DEGREES or "
    "MOVE=cone:DEGREES; MOVE is a number, line:44, the name of a target, or 'all'"
)
_MOST_JOINTS = 7
