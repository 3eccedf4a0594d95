"""What is in a folder of programs and installations, or in one of these files, put together.

Each program is a task of its own. The arm is the one that the programs' own kinematics describe;
what is declared for all programs comes from the installation that most of them name.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import Any

from ....core.backup.backup import Backup, BackupEntry, BackupRobot, Task
from ....core.errors import InputError, Note
from ....core.files.archive import is_archive
from ....core.robot.model import Robot
from ....core.spatial.pose import IDENTITY
from ..urp.installation import Installation, JointLimits
from ..urp.kinematics import DhTable
from .arms import Stated, Types, backup_robot
from .contents import PASSED_OVER, Contents, Found, marked_below, read_contents
from .declared import frames_of, homes_of, signals_of, tools_of

VENDOR = "ur"
_FASTEST = 100.0
"""m/s, beyond which a limit is none."""
_NAMED = 6
"""Files that a note names at most."""


def opened(source: Path, root: Path, find_robot: Callable[[str], Robot]) -> Backup:
    """The backup in a folder, or one file; see `BackupOpener.open`."""
    alone = source.is_file() and not is_archive(source)
    contents = read_contents(root, [source.name] if alone else marked_below(root))
    if not contents.programs and not contents.installations:
        told = str(contents.notes[0]) if contents.notes else "it holds no program"
        why = told.removeprefix(PASSED_OVER)
        raise InputError(f"{source}: nothing of it can be read: {why}")
    return _backup(source, contents, Types(find_robot))


@dataclass(frozen=True)
class _Arm:
    """What tells robots of a folder apart."""

    table: DhTable | None
    serial: str
    limits: JointLimits | None = None
    mounting: tuple[float, float] = (0.0, 0.0)


def _backup(source: Path, contents: Contents, types: Types) -> Backup:
    main = _main_installation(contents)
    doubts: list[str] = []
    robots, indices = _robots(contents, main, types, doubts)
    declared = contents.installations.get(main or "", Installation())
    notes = [*contents.notes, *_told(contents, main), *map(Note, dict.fromkeys(doubts))]
    motion = _motion(contents, notes)
    base = next((one.robot.base for one in robots if one.robot is not None), IDENTITY)
    return Backup(
        source=source,
        root=contents.root,
        vendor=VENDOR,
        controller=" and ".join(dict.fromkeys(one.written or "UR" for one in robots)) or "UR",
        version=_version(contents, declared),
        robots=robots,
        tasks=_tasks(contents, indices),
        tools=tools_of(declared),
        frames=frames_of(declared, base),
        homes=homes_of(declared),
        signals=signals_of(declared),
        motion=motion,
        notes=tuple(notes),
    )


def _motion(contents: Contents, notes: list[Note]) -> dict[str, tuple[Any, str]]:
    """What limits of safety say of how fast the arm is driven: the controller is taken to slow down
    where the TCP would be faster, and not to stop."""
    used = {one.installation for one in contents.programs if one.installation}
    stated = {
        installation.tcp_speed: name
        for name, installation in contents.installations.items()
        if name in used or not used
    }
    speeds = [one for one in stated if one is not None and 0.0 < one < _FASTEST]
    if len(stated) > 1 and speeds:
        told = " and ".join("none" if one is None else f"{one:g} m/s" for one in stated)
        notes.append(Note(f"the greatest speed of the TCP is not held: installations say {told}"))
    if len(stated) != 1 or not speeds:
        return {}
    (speed,) = speeds
    said = f"published: {stated[speed]}, limits of safety: maxTcpSpeed {speed:g} m/s"
    return {"limit.tcp_speed": (speed, said)}


def _main_installation(contents: Contents) -> str | None:
    """The installation that most programs use; of as many the first."""
    used = Counter(one.installation for one in contents.programs if one.installation)
    if used:
        return used.most_common(1)[0][0]
    return next(iter(contents.installations), None)


def _robots(
    contents: Contents, main: str | None, types: Types, doubts: list[str]
) -> tuple[tuple[BackupRobot, ...], list[int]]:
    """The robots of a folder, and which one each program moves.

    A program that says nothing of its arm is one of the robot that most others are of.
    """
    stated = [_stated(contents, one, main) for one in contents.programs]
    if not stated and main is not None:
        stated = [(_arm(None, "", contents.installations[main]), main, main)]
    known = Counter(arm for arm, _, _ in stated if arm.table is not None or arm.serial)
    usual = known.most_common(1)[0][0] if known else None
    made: dict[_Arm, BackupRobot] = {}
    indices: list[int] = []
    for arm, file, used in stated:
        if arm.table is None and not arm.serial and usual is not None:
            arm = usual
        if arm not in made:
            said = Stated(arm.table, arm.serial, file)
            made[arm] = backup_robot(said, contents.installations.get(used or ""), types, doubts)
        indices.append(list(made).index(arm))
    return _named_apart(tuple(made.values())), indices


def _stated(contents: Contents, found: Found, main: str | None) -> tuple[_Arm, str, str | None]:
    """What a program says of its arm, or else its installation; the file; the installation."""
    used = found.installation or (main if found.tree is None else None)
    installation = contents.installations.get(used or "")
    table = None if found.tree is None else found.tree.table
    serial = "" if found.tree is None else found.tree.serial
    arm = _arm(table, serial, installation)
    return arm, found.name if table is not None else str(used or found.name), used


def _arm(table: DhTable | None, serial: str, installation: Installation | None) -> _Arm:
    if installation is None:
        return _Arm(table, serial)
    return _Arm(
        installation.table if table is None else table,
        serial or installation.serial,
        installation.limits,
        (installation.tilt, installation.turn),
    )


def _named_apart(robots: tuple[BackupRobot, ...]) -> tuple[BackupRobot, ...]:
    """Robots of one number, of other kinematics or installations, with a count behind it."""
    seen: Counter[str] = Counter()
    named = []
    for one in robots:
        seen[one.unit] += 1
        count = seen[one.unit]
        named.append(one if count == 1 else replace(one, unit=f"{one.unit}_{count}"))
    return tuple(named)


def _tasks(contents: Contents, indices: Sequence[int]) -> tuple[Task, ...]:
    stems = Counter(PurePosixPath(one.name).stem.casefold() for one in contents.programs)
    tasks = []
    for found, index in zip(contents.programs, indices, strict=False):
        path = PurePosixPath(found.name)
        name = path.stem if stems[path.stem.casefold()] == 1 else found.name
        files = dict.fromkeys(filter(None, (found.name, found.installation, found.script)))
        robot = None if found.moves == 0 else index
        tasks.append(Task(name, robot, tuple(files), found.name, entries=_entries(found)))
    return tuple(tasks)


def _entries(found: Found) -> tuple[BackupEntry, ...]:
    if found.entry is None:
        return ()
    return (BackupEntry(found.entry, found.name, moves=found.moves),)


def _version(contents: Contents, declared: Installation) -> str:
    saved = [one.tree.saved_in for one in contents.programs if one.tree is not None]
    return max(saved, key=_parts, default="") or declared.version


def _parts(version: str) -> tuple[int, ...]:
    return tuple(int(part) if part.isdecimal() else 0 for part in version.split("."))


def _told(contents: Contents, main: str | None) -> list[Note]:
    """What is not taken from the folder."""
    notes = []
    others = [name for name in contents.installations if name != main]
    if others and main is not None:
        notes.append(
            Note(
                f"TCPs, features and signals are those of {main}, which most programs name; not "
                f"listed are those of {_listed(others)}"
            )
        )
    missing = {
        one.tree.installation
        for one in contents.programs
        if one.tree is not None and one.installation is None and one.tree.installation
    }
    if missing:
        notes.append(
            Note(
                f"not at hand: {_listed([f'{name}.installation' for name in sorted(missing)])}; "
                "programs that name it take the TCP that their waypoints were taught with"
            )
        )
    return notes


def _listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return f"{', '.join(names[:_NAMED])}{more}"
