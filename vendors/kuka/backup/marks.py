"""Where a KUKA archive begins among files, and where its parts are: by what marks them.

    am.ini                    name, serial number, version
    KRC/R1/Program, TP        programs
    KRC/R1/System             $config.dat, routines of the controller
    KRC/R1/Mada               $machine.dat, $robcor.dat: the robot
    KRC/STEU/Mada             $machine.dat: the rest
    C/                        files of the operating system, templates: no programs

Often only ``R1`` and ``STEU`` are there, or ``R1``, or a part of that; or just programs, with a
``$config.dat`` beside them or without.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

MACHINE, MODEL, CONFIG = "$machine.dat", "$robcor.dat", "$config.dat"
_ROBOT, _CONTROLLER, _ABOVE = "r1", "steu", "krc"
_VKRC = frozenset({"folgen", "ups", "makros"})
"""Folders of R1 in which controllers of Volkswagen's kind (VKRC, with the VW System Software) keep
programs: ``Folge1.src``, ``UP99.src``, ``Makro0.src``. Source: headers of such programs,
robot-forum.com, thread 34305."""
_IIQKA = re.compile("iiqka|iiqworks", re.IGNORECASE)
_PROJECT = ".wvs"
_ROOMS = frozenset({"program", "system", "mada", "tp"}) | _VKRC
_SOURCES = (".src", ".sub", ".dat")
_PROGRAMS = ".src"


@dataclass(frozen=True, slots=True)
class Layout:
    """Where the parts of an archive are, below its root.

    Args:
        robot: the folder R1, or what stands for it; ``""`` for the root itself.
        controller: the folder STEU; None if there is none.
        copies: other folders R1, which are left out.
        loose: programs and data lists beside R1 that are taken as parts of it: there is the
            ``$config.dat`` that R1 lacks.
    """

    robot: str
    controller: str | None
    copies: tuple[str, ...] = ()
    loose: tuple[str, ...] = ()

    def inside(self, name: str) -> str | None:
        """A file's place in R1; None if it is no part of it."""
        if name in self.loose:
            above = _above(self.robot)
            return name[len(above) + 1 if above else 0 :]
        if not _inside(name, self.robot):
            return None
        return name[len(self.robot) + 1 if self.robot else 0 :]


def root_in(names: Sequence[str]) -> str | None:
    """The folder in which an archive begins; see `core.language.BackupOpener.root_in`."""
    return min((root for name in names for root in _roots(name)), key=_order, default=None)


def programs_in(names: Sequence[str]) -> str | None:
    """The folder of programs that nothing else marks; see `core.language.BackupOpener.programs_in`.

    That of a ``$config.dat`` where programs are in it or below, the outermost one first; else what
    holds all programs.
    """
    programs = [name for name in names if name.casefold().endswith(_PROGRAMS)]
    if not programs:
        return None
    beside = {_above(name) for name in names if _last(name) == CONFIG}
    having = [one for one in beside if any(_inside(name, one) for name in programs)]
    if having:
        return min(having, key=_order)
    return posixpath.commonpath([_above(name) for name in programs])


def layout_of(names: Sequence[str]) -> Layout:
    """Where the parts of an archive are."""
    robots = sorted({one for name in names for one in _folders(name, _ROBOT)}, key=_beginning)
    steu = sorted({one for name in names for one in _folders(name, _CONTROLLER)}, key=_beginning)
    robot = robots[0] if robots else _lone(names)
    copies = [one for one in robots[1:] if not _inside(one, robot)]
    beside = [one for one in steu if _above(one) == _above(robot)]
    loose = _loose(names, robot, (*robots, *steu)) if robots else ()
    return Layout(robot, next(iter((*beside, *steu)), None), tuple(copies), loose)


def _loose(names: Sequence[str], robot: str, folders: Sequence[str]) -> tuple[str, ...]:
    """What stands beside R1 as if in it, where the ``$config.dat`` does that R1 has not."""
    above = _above(robot)
    known = [name for name in names if _last(name) == CONFIG]
    if any(_inside(name, robot) for name in known):
        return ()
    places = [f"{above}/{room}".strip("/") for room in ("", "system")]
    if not any(_above(name).casefold() in map(str.casefold, places) for name in known):
        return ()
    return tuple(
        name
        for name in names
        if name.casefold().endswith(_SOURCES)
        and _inside(name, above)
        and not any(_inside(name, folder) for folder in folders)
    )


def vkrc_programs(names: Sequence[str], layout: Layout) -> frozenset[str]:
    """The programs of a VKRC, in folders that no other controller has."""
    inside = f"{layout.robot}/" if layout.robot else ""
    found = []
    for name in names:
        room, inner, _ = name[len(inside) :].partition("/")
        if name.startswith(inside) and inner and room.casefold() in _VKRC:
            found.append(name)
    return frozenset(found)


def of_workvisual(names: Sequence[str]) -> str | None:
    """The first project of WorkVisual, a form of its own; None for none."""
    return next((name for name in names if name.casefold().endswith(_PROJECT)), None)


def of_iiqka(names: Sequence[str]) -> str | None:
    """The first file or folder that calls itself one of iiQKA.OS or its iiQWorks; None for none.

    What is in them is not public: their names are all that is gone by.
    """
    called = (part for name in names for part in name.split("/"))
    return next((part for part in called if _IIQKA.search(part)), None)


def _roots(name: str) -> Iterator[str]:
    """Where an archive would begin that a file belongs to."""
    for marked in (_ROBOT, _CONTROLLER):
        for folder in _folders(name, marked):
            yield _outside(folder)
    parts = name.split("/")
    low = [part.casefold() for part in parts]
    if low[-1] == MACHINE:
        inside = len(low) > 1 and low[-2] == "mada"
        yield "/".join(parts[: -2 if inside else -1])
    if low[-2:] == ["system", CONFIG]:
        yield "/".join(parts[:-2])


def _folders(name: str, marked: str) -> Iterator[str]:
    """Folders R1, or STEU, that a file lies in and makes one of an archive."""
    parts = name.split("/")
    low = [part.casefold() for part in parts]
    if not low[-1].endswith(_SOURCES):
        return
    for k, part in enumerate(low[:-1]):
        if part == marked and (low[k + 1] in _ROOMS or low[k + 1].startswith(("cell.", "$"))):
            yield "/".join(parts[: k + 1])


def _lone(names: Sequence[str]) -> str:
    """The folder that stands for R1 where none is called so: the one that holds Mada or System."""
    found = {
        "/".join(name.split("/")[:-2])
        for name in names
        if name.casefold().rpartition("/")[0].rpartition("/")[2] in ("mada", "system")
        and name.casefold().endswith(_SOURCES)
    }
    outside = [one for one in found if _last(one) != _CONTROLLER]
    return min(outside, key=_order, default="")


def _outside(folder: str) -> str:
    """Where the archive of a folder R1 or STEU begins."""
    above = _above(folder)
    return _above(above) if _last(above) == _ABOVE else above


def _beginning(folder: str) -> tuple[int, str]:
    return _order(_outside(folder))


def _order(folder: str) -> tuple[int, str]:
    return folder.count("/") + bool(folder), folder.casefold()


def _above(folder: str) -> str:
    return folder.rpartition("/")[0]


def _last(folder: str) -> str:
    return folder.rpartition("/")[2].casefold()


def _inside(folder: str, other: str) -> bool:
    return not other or folder.startswith(f"{other}/")
