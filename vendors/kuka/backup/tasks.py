"""What a controller runs: programs that the operator, or a PLC by its number, chooses; submits."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import PurePosixPath

from ....core.backup.backup import BackupEntry, Task
from ....core.backup.contents import listed
from ....core.source.text.files import SourceFile
from .contents import Contents
from .marks import CONFIG, Layout
from .routines import Routine, Routines, routines_in

PROGRAM, SUBMIT, DATA = ".src", ".sub", ".dat"
_ROOMS = ("system", "program", "tp")
"""Folders of R1 in the order in which doubles count, before others."""
_NO_PROGRAMS = frozenset({"mada"})
_CONTROLLERS_OWN = frozenset({"system", "tp"})
"""Folders whose routines the operator does not choose."""
_CELL = "cell"
_COPY = re.compile(r"copy|copia|kopie|backup|\bold\b|_old|\balt\b|_alt|bak\b|\(\d\)", re.IGNORECASE)
_SWITCH = re.compile(r"^[ \t]*SWITCH\b[ \t(]*(\w*)", re.IGNORECASE | re.MULTILINE)
_END = re.compile(r"^[ \t]*(?:DEFAULT|ENDSWITCH)\b", re.IGNORECASE | re.MULTILINE)
_CASE = re.compile(r"^[ \t]*CASE[ \t]+([^\r\n;]+)", re.IGNORECASE | re.MULTILINE)
_CALL = re.compile(r"^[ \t]*([A-Z_][\w$]*)[ \t]*\(", re.IGNORECASE | re.MULTILINE)
_NUMBER = re.compile(r"\d{1,6}")
_COMMENT = re.compile(r";[^\r\n]*")


def source_files(contents: Contents) -> tuple[str, ...]:
    """The files of an archive's programs, each name once, in the order in which they count.

    Names are global over an archive: of a module that several folders hold the first is taken, of
    the system, then of the programs, folders that look like copies last.
    """
    layout = contents.layout
    found: dict[tuple[str, str], str] = {}
    twice: dict[tuple[str, str], list[tuple[str, str]]] = {}
    config_beside = contents.find(layout.controller, CONFIG)
    inside = [name for name in contents.names if _is_source(name, layout)]
    for name in sorted(inside, key=lambda name: _rank(name, layout)):
        place = PurePosixPath(name)
        key = place.stem.casefold(), place.suffix.casefold()
        if key in found:
            twice.setdefault(_relocated(name, found[key]), []).append((name, found[key]))
        else:
            found[key] = name
    if config_beside is not None:
        found.setdefault(("$config", DATA), config_beside)
    for (left, taken), pairs in twice.items():
        contents.notes.add(_left_out(contents, left, taken, pairs))
    return tuple(found.values())


def _relocated(left: str, taken: str) -> tuple[str, str]:
    """The folders by which two files of one name are apart: ``Old`` of ``Old/a/x`` and ``a/x``."""
    one, other = left.split("/")[:-1], taken.split("/")[:-1]
    while one and other and one[-1].casefold() == other[-1].casefold():
        del one[-1], other[-1]
    return "/".join(one), "/".join(other)


def _left_out(contents: Contents, left: str, taken: str, pairs: Sequence[tuple[str, str]]) -> str:
    """What is said of files that are there twice."""
    named = listed(sorted(PurePosixPath(name).name for name, _ in pairs))
    changed = sorted(
        PurePosixPath(name).name for name, other in pairs if not contents.same(name, other)
    )
    differ = f"other text in {listed(changed)}" if changed else "their texts are the same"
    return (
        f"left out of {left or 'the root'}: {named}, which {taken or 'the root'} has as well; "
        f"names are global over an archive ({differ})"
    )


def tasks_of(contents: Contents, files: Sequence[str]) -> tuple[Task, ...]:
    """The tasks of an archive.

    Args:
        files: see `source_files`.
    """
    sources = {name: source for name in files if (source := contents.source(name)) is not None}
    programs = {name: one for name, one in sources.items() if _suffix(name) == PROGRAM}
    made = []
    if programs:
        made.append(_main_task(contents, sources, programs))
    for name, source in sources.items():
        if _suffix(name) == SUBMIT:
            made.append(_submit(name, source, sources))
    return tuple(made)


def _main_task(
    contents: Contents,
    sources: Mapping[str, SourceFile],
    programs: Mapping[str, SourceFile],
) -> Task:
    """The programs that move the robot."""
    routines = Routines(one for source in programs.values() for one in routines_in(source))
    cell = _cell(routines)
    numbers = _numbers(programs[cell.file], routines) if cell is not None else {}
    chosen = bool(numbers) and cell is not None
    entries = _entries(contents.layout, routines, numbers, cell if chosen else None)
    if not entries:
        contents.notes.add("no routine of the programs moves the robot")
    return Task(
        name="R1",
        robot=0,
        files=tuple(sources),
        main=cell.file if chosen and cell is not None else None,
        entry=cell.name if chosen and cell is not None else None,
        entries=entries,
    )


def _entries(
    layout: Layout, routines: Routines, numbers: Mapping[str, str], cell: Routine | None
) -> tuple[BackupEntry, ...]:
    """Routines that move the robot, and that an operator or a PLC can choose."""
    found: dict[str, BackupEntry] = {}
    for routine in sorted(routines.all, key=lambda one: not one.shared):  # a module's own first
        name = routine.name.lower()
        stock = _room(routine.file, layout) in _CONTROLLERS_OWN and name not in numbers
        if routine.gives or (stock and routine is not cell) or name in found:
            continue
        if not routines.moves_robot(routine) or (name == _CELL and cell is None):
            continue
        said = "chooses by program number" if routine is cell else numbers.get(name, "")
        found[name] = BackupEntry(
            routine.name, routine.file, said, routine.parameters, routines.moves(routine)
        )
    return tuple(sorted(found.values(), key=_standing))


def _standing(entry: BackupEntry) -> tuple[bool, int, bool, str]:
    """The cell's own first, then by program number, those that need arguments last."""
    number = _NUMBER.search(entry.comment)
    place = int(number[0]) if number else 0
    return not entry.comment, place, bool(entry.parameters), entry.name.casefold()


def _cell(routines: Routines) -> Routine | None:
    """The routine by which a PLC chooses programs."""
    return routines.named(_CELL)


def _numbers(source: SourceFile, routines: Routines) -> dict[str, str]:
    """Which program numbers ``cell.src`` runs a routine for, of those that are at hand.

    The number is ``PGNO`` as delivered; where no ``SWITCH`` asks for that, it is what an
    integrator has put in its place, and any ``SWITCH`` between numbers counts.
    """
    text = _COMMENT.sub("", source.text)
    found: dict[str, list[str]] = {}
    every = list(_SWITCH.finditer(text))
    switches = [one for one in every if one[1].upper() == "PGNO"] or every
    behind = [*(switch.start() for switch in switches[1:]), len(text)]
    for switch, most in zip(switches, behind, strict=False):
        end = _END.search(text, switch.end(), most)
        part = text[switch.end() : end.start() if end else most]
        cases = list(_CASE.finditer(part))
        stops = [*(case.start() for case in cases[1:]), len(part)]
        for case, stop in zip(cases, stops, strict=False):
            number = " ".join(case[1].split())
            if number.startswith(("#", '"')):
                continue  # a state, and no number
            for name in _CALL.findall(part[case.end() : stop]):
                routine = routines.named(name)
                if routine is not None and routines.moves_robot(routine):
                    found.setdefault(name.lower(), []).append(number)
    return {name: f"program number {', '.join(given)}" for name, given in found.items()}


def _submit(name: str, source: SourceFile, sources: Mapping[str, SourceFile]) -> Task:
    """A program that runs beside those that move the robot."""
    routines = routines_in(source)
    entry = next((one.name for one in routines if one.shared), None)
    return Task(PurePosixPath(name).stem, None, tuple(sources), name, entry)


def _is_source(name: str, layout: Layout) -> bool:
    """Whether a file is one of the programs."""
    inside = layout.inside(name)
    if _suffix(name) not in (PROGRAM, SUBMIT, DATA) or inside is None:
        return False
    folders = [part.casefold() for part in inside.split("/")[:-1]]
    outside = (not layout.robot or name in layout.loose) and folders[:1] in (
        ["c"],
        ["d"],
        ["steu"],
        ["krc"],
    )
    machine = name.casefold().rpartition("/")[2] in ("$machine.dat", "$robcor.dat", "$custom.dat")
    return not outside and not machine and not _NO_PROGRAMS & set(folders)


def _rank(name: str, layout: Layout) -> tuple[bool, int, int, str]:
    room = _room(name, layout)
    order = _ROOMS.index(room) if room in _ROOMS else len(_ROOMS)
    folder = name.rpartition("/")[0]
    return bool(_COPY.search(folder)), order, name.count("/"), name.casefold()


def _room(name: str, layout: Layout) -> str:
    """The folder of R1 that a file is in, lower case; empty for R1 itself."""
    inside = layout.inside(name) or ""
    return inside.partition("/")[0].casefold() if "/" in inside else ""


def _suffix(name: str) -> str:
    return PurePosixPath(name).suffix.casefold()
