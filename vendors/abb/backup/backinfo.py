"""``BACKINFO/backinfo.txt``: the system, its products, and which modules its tasks had loaded.

Heads ``>>NAME:`` with entries below them; lines ``#`` are comments. A task is ``>>TASK1:`` with
``(T_ROB1,program,)`` behind it or below, then a line for each module, ``PROGMOD/main.mod @ main``,
with HIDDEN behind those that the pendant does not show.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from ....core.source.text.files import lines_of

_HEAD = re.compile(r">>\s*(\w+)\s*:?\s*(.*)")
_TASK = re.compile(r"TASK\d+", re.IGNORECASE)
_NAMES = re.compile(r"\(([^,)]*)(?:,([^,)]*))?[^)]*\)")
_MODULE = re.compile(
    r"((?:PROGMOD|SYSMOD)[\\/][^@]*?\.\w+)\s*(?:HIDDEN\s*)?(?:@.*)?", re.IGNORECASE
)
_VERSION = re.compile(r"\s*(RobotWare|RobotControl|BaseWare)\s+(?:OS\s+)?Version\s*:\s*(\S+)", re.I)
_ARM = re.compile(r"\b(?:IRB|CRB)\s?\d{2,5}[^,;<\"]*")
_DRIVES = re.compile(r"\s*Drive System\b", re.IGNORECASE)
_TYPE = re.compile(r"\d{2,5}[A-Z]*-\d[\d.]*/\d[\d.]*")
"""``2600ID-8/2.00``: the type alone, as lists of RobotWare 5 have it behind the series."""


@dataclass(frozen=True, slots=True)
class ListedModule:
    """A module that a task had loaded.

    Args:
        file: below the task's folder: ``PROGMOD/main.mod``.
        line: of the list.
    """

    file: str
    line: int


@dataclass(frozen=True, slots=True)
class ListedTask:
    """A task.

    Args:
        folder: below ``RAPID``: ``TASK1``.
        name: the controller's; ``""`` if it is not stated.
        program: name of the program that was loaded, ``""`` for none.
        modules: in the order in which they are listed.
        line: of the list.
    """

    folder: str
    name: str
    program: str
    modules: tuple[ListedModule, ...]
    line: int


@dataclass(frozen=True, slots=True)
class BackInfo:
    """What the list states.

    Args:
        system: its name.
        version: of the software, as ``RobotWare 6.08.01``; ``""`` if it is not stated.
        arms: products and types that name an arm.
        tasks: in its order.
    """

    system: str = ""
    version: str = ""
    arms: tuple[str, ...] = ()
    tasks: tuple[ListedTask, ...] = ()


def parse_backinfo(text: str) -> BackInfo:
    """What the list states; lines that it should not have are passed over."""
    blocks: list[tuple[int, str, list[tuple[int, str]]]] = []
    for number, line in enumerate(lines_of(text), 1):
        entry = line.strip().lstrip("\ufeff")
        head = _HEAD.fullmatch(entry)
        if head is not None:
            rest = [(number, head[2])] if head[2].strip() else []
            blocks.append((number, head[1].upper(), rest))
        elif entry and not entry.startswith("#") and blocks:
            blocks[-1][2].append((number, entry))
    found: dict[str, list[str]] = {}
    for _, name, entries in blocks:
        found.setdefault(name, []).extend(entry for _, entry in entries)
    products = found.get("PRODUCTS_ID", [])
    versions = [match for match in map(_VERSION.match, products) if match is not None]
    return BackInfo(
        system=next(iter(found.get("SYSTEM_ID", [])), ""),
        version=f"{versions[0][1]} {versions[0][2]}" if versions else "",
        arms=arms_in([*products, *found.get("ROBOT_TYPE", [])]),
        tasks=tuple(_task(*block) for block in blocks if _TASK.fullmatch(block[1])),
    )


def arms_in(lines: list[str]) -> tuple[str, ...]:
    """Names of arms among products: ``IRB 4600-40/2.55``; drives are for several."""
    names: list[str] = []
    for line in lines:
        if _DRIVES.match(line):
            continue
        if _TYPE.fullmatch(line.strip()):
            name = f"IRB {line.strip()}"
            if name not in names and names and name.startswith(names[-1]):
                names.pop()  # the series of this type
            names.append(name)
        names += [found[0].strip() for found in _ARM.finditer(line)]
    return tuple(dict.fromkeys(names))


def _task(line: int, folder: str, entries: list[tuple[int, str]]) -> ListedTask:
    name = program = ""
    modules: dict[str, ListedModule] = {}
    for number, entry in entries:
        names, module = _NAMES.match(entry), _MODULE.fullmatch(entry)
        if module is not None:
            file = module[1].replace("\\", "/")
            modules.setdefault(file.casefold(), ListedModule(file, number))
        elif names is not None and not name:
            name, program = names[1].strip(), (names[2] or "").strip()
    return ListedTask(folder.upper(), name, program, tuple(modules.values()), line)
