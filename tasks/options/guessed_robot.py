"""The robot of a program that is to be driven where nobody says which it is.

It is the one that the text names, or its folder; else an arm of the catalogue that can take all
places of the program, the first of them that drives it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.door import given, spelt
from ...core.errors import EntryError, FlybyError, InputError, Note, OptionError
from ...core.files.reading import read_bytes
from ...core.program.entry_point import ALL
from ...core.source.text.files import LARGEST_FILE, refuse_no_text
from ..backup.opening import task_of
from ..fitting import said_to_fit
from ..read import SourceOptions, backup_in, read_undriven, read_with, robot_around, vendor_of
from ..setup import setup_of, start_of

if TYPE_CHECKING:
    from ...core.backup.backup import Backup
    from ...core.program.program import Program
    from ...core.robot.arm_list import Listed

_TRIED = 12
"""Arms that are driven, over all sizes that can take the places; fewer by a long program."""
_TRIED_MOVES = 600
"""Moves that are driven so."""
_USUAL = 6
"""Axes."""
_LONGEST = 400
"""Moves of a program that is driven by several arms to choose one."""
_WORDS = 6
_FOLDERS = 3


def with_robot(
    source: str | Path,
    options: SourceOptions,
    *,
    writes: bool = False,
    option: str = "robot",
    gives_way: bool = False,
) -> tuple[SourceOptions, tuple[Note, ...]]:
    """Options that name a robot where something tells of one, and what is to be said of that.

    Args:
        writes: whether a program is written, which is right for its own robot alone: then somebody
            has to say which it is.
        option: that says it.
        gives_way: whether configurations of which an arm that is no more than guessed does not
            drive all may give way to the nearest: they are those of another arm.

    Raises:
        FlybyError: what is named is no program; it is to be said which robot it is.
    """
    if options.robot is not None or options.cell is not None:
        return options, ()
    backup = backup_in(source, options)
    if backup is not None and _says_its_robot(backup, options):
        return options, ()
    own = robot_around(source)
    if own is not None and own.robot is not None:
        said = f"{own.robot.name} is taken, which is the robot of the backup around {source}"
        return replace(options, robot=own.robot), (Note(said),)
    if own is not None and own.written:
        why = "; ".join(own.lacks)
        way = "" if spelt(option) in why else f"; {spelt(option)} names one that will do"
        raise OptionError(f"{source} lies in a backup, whose robot is {own.written}: {why}{way}")
    found = _guessed(source, options)
    if found is None:
        return options, ()
    arm, why, faults = found
    if writes:
        raise OptionError(
            f"which robot is {source} for? What is written is right for that one alone: say it, "
            f"{given(option, arm.name)} if it is this one: {why}"
        )
    said = (
        f"nobody says which robot it is: {arm.name} is taken: {why}; {spelt('robot')} says another"
    )
    options = replace(options, robot=arm.name)
    if gives_way and faults and options.configuration is None:
        nearest = replace(options, configuration="nearest")
        if _faults(source, nearest, faults, placing=False) < faults:
            said += (
                "; no arm that was tried drives it by its configurations: those that contradict "
                "their pose or path give way to the nearest"
            )
            options = nearest
    return options, (Note(said),)


def read_or_guess(source: str | Path, options: SourceOptions) -> Program:
    """The program of a source, for the robot that is named or else for one that it may be for.

    Raises:
        FlybyError: as `read_with`; nothing tells of a robot.
    """
    options, notes = with_robot(source, options)
    program = read_with(source, options)
    return replace(program, notes=(*notes, *program.notes))


def _says_its_robot(backup: Backup, options: SourceOptions) -> bool:
    """Whether a backup names the robot of the task that is read, or that task is yet to be named:
    what reads it says so."""
    try:
        index = task_of(backup, options.task, options.entry).robot
    except FlybyError:
        return True
    robot = backup.robots[index] if index is not None and index < len(backup.robots) else None
    return robot is not None and (robot.robot is not None or bool(robot.written))


def _guessed(source: str | Path, options: SourceOptions) -> tuple[Listed, str, int] | None:
    """An arm, why it is taken, and how many faults are known that it drives the program with."""
    from ...core.driving.fitting_arms import TakenPlaces
    from ...core.registry import all_listed

    if isinstance(source, str) and ("\n" in source or not source):
        return None
    path = Path(source)
    program: Program | None = None
    try:
        vendor = vendor_of(source, options)
    except FlybyError:
        return None  # what reads it says why
    if path.is_file():
        refuse_no_text(path)
    try:
        program, options = _undriven(source, options)
    except FlybyError:
        if not path.is_file():
            return None
    arms = [arm for arm in all_listed(vendor) if arm.refused is None]
    places = TakenPlaces((), ()) if program is None else TakenPlaces.of(program)
    assumed = ""
    if program is not None and not places.count:
        places = TakenPlaces.of(program, assumed=True)
        assumed = ", with its unknown tools and frames as they are assumed"
    for text, named in _mentioned(path, program, arms):
        fit = places.taken_by(vendor, named) if places.count else []
        return (*fit, *named)[0], f"{text!r} stands in its text or folder", 0
    if program is None or not places.count:
        middle, seven = _middle(arms), [arm for arm in arms if arm.axes == _USUAL + 1]
        if program is None or middle is None or not seven or not 0 < len(program.moves) <= _LONGEST:
            return middle
        # A seventh axis may be written as one beside the arm: what its values are, that arm knows.
        best, _ = _first_that_drives(source, options, ([middle[0], *seven], []), 1 + len(seven))
        if best is middle[0]:
            return middle
        return best, "it has a seventh axis, which targets name", 0
    fit = places.taken_by(vendor, arms)
    why = f"{said_to_fit(fit, places.count)}{assumed}"
    if not fit:
        fit, why = places.most_taken_by(vendor, arms)[:_TRIED], "none can take all its places"
    elif not places.flanges:  # postures tell nothing of the size
        fit = [arm for arm in fit if arm.axes == _USUAL] or fit
        mean = sorted(arm.reach or 0.0 for arm in fit)[len(fit) // 2]
        fit.sort(key=lambda arm: abs((arm.reach or 0.0) - mean))
        why = f"{why}, it with a middle reach of them"
    # Those go first that reach as well what hangs on unknown frames, as it is taken for.
    more = TakenPlaces.of(program, assumed=True)
    reach = more.taken_by(vendor, fit) if more.flanges and not assumed else []
    if len(program.moves) > _LONGEST:
        return (*reach, *fit)[0], why, 0
    count = max(2, min(_TRIED, _TRIED_MOVES // len(program.moves)))
    best, faults = _first_that_drives(source, options, (reach or fit, fit), count)
    return best, why, faults


def _middle(arms: list[Listed]) -> tuple[Listed, str, int] | None:
    """An arm for a program that says no place, or cannot be read, so that it says why."""
    known = [arm for arm in arms if arm.axes == _USUAL and arm.reach is not None]
    if not known:
        return None
    middle = sorted(known, key=lambda arm: (arm.reach, arm.name))[len(known) // 2]
    return middle, "one of middle reach, as the program says no place by which to tell", 0


def _undriven(source: str | Path, options: SourceOptions) -> tuple[Program, SourceOptions]:
    """A program for no robot, and how it is read; of one that drives nothing as it begins, the
    routine that drives most."""
    try:
        program = read_undriven(source, options)
    except EntryError:
        program = None
    if options.entry is not None and program is None:
        raise InputError(f"{source} has no such entry")
    if program is not None and (program.moves or options.entry is not None):
        return program, options
    begun = {entry.name for entry in program.entries if entry.begun} if program else set()
    routines = read_undriven(source, replace(options, entry=ALL)).entries
    moving = [routine for routine in routines if routine.moves and routine.name not in begun]
    moving = [routine for routine in moving if not routine.parameters] or moving
    if not moving:
        raise InputError(f"{source} drives nothing")
    options = replace(options, entry=max(moving, key=lambda routine: routine.moves).name)
    return read_undriven(source, options), options


def _first_that_drives(
    source: str | Path, options: SourceOptions, arms: tuple[list[Listed], list[Listed]], count: int
) -> tuple[Listed, int]:
    """The arm of some that drives a program without a fault, or with the fewest; and how many.

    Args:
        arms: those that are tried with unknown frames as they are taken for; and, if none of them
            will do, those with these frames put to where they drive the program.
        count: how many of them.
    """
    from ...core.driving.past_faults import ENOUGH

    best, least = arms[0][0], ENOUGH
    for tried, placing in zip(arms, (False, True), strict=True):
        for arm in tried[:: max(1, len(tried) // count)][:count]:
            faults = _faults(source, replace(options, robot=arm.name), least, placing)
            if faults < least:
                best, least = arm, faults
            if not faults:
                return best, 0
    return best, least


def _faults(source: str | Path, options: SourceOptions, most: int, placing: bool) -> int:
    """How many moves an arm cannot drive of those of which anybody knows where they go; ``most`` of
    as many or more.

    Args:
        placing: whether it is asked with the program's unknown frames put to where it can; with
            none, as many as may be.
    """
    from ...core.driving.fitting_frames import LONGEST, frames_that_fit, placed
    from ...core.driving.past_faults import count_faults
    from ...core.motion.emulator.controller import Controller
    from ...core.program.assumed_places import assumed_places

    setup = setup_of(options)
    program = read_with(source, options)
    controller, start = Controller(setup.vendor, setup.robot), start_of(program)
    if placing:
        if len(program.moves) > LONGEST or not assumed_places(program):
            return most
        program = placed(program, frames_that_fit(controller, program, start))
    known = sum(bool(move.open) for move in program.moves)
    return max(0, count_faults(controller, program, start, most + known) - known)


def _mentioned(
    path: Path, program: Program | None, arms: list[Listed]
) -> Iterator[tuple[str, list[Listed]]]:
    """Arms that the program's files and folders name, and the words, the plainest first."""
    from ...core.robot.model_names import matching
    from ...core.source.reading import Reading

    reading = None if program is None else program.reading
    texts = [file.text for file in reading.files.values()] if isinstance(reading, Reading) else []
    if not texts:
        texts = [read_bytes(path, LARGEST_FILE).decode("utf-8", "replace")]
    folders = path.resolve().parts[-_FOLDERS - 1 : -1]
    makes = sorted({make[0] for arm in arms if (make := re.match(r"[A-Z]+", arm.model))})
    name = re.compile(
        rf"(?<![A-Za-z0-9])(?:{'|'.join(makes)})[ _-]?\d[\w./-]*(?:[ ][\w./-]+){{0,{_WORDS}}}",
        re.IGNORECASE,
    )
    found: dict[str, list[Listed]] = {}
    for text in (*texts, *folders):
        for match in name.finditer(text):
            words = re.split(r"[ ]+", match[0].replace("_", " "))
            for count in range(len(words), 0, -1):
                said = " ".join(words[:count])
                named = matching(said, arms)
                if named:
                    found.setdefault(said, named)
                    break
    yield from sorted(found.items(), key=lambda item: len(item[1]))
