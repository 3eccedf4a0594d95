"""The backup that a program, or a folder with programs, lies in, which knows robot and data."""

from __future__ import annotations

import os
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.door import called, given
from ...core.errors import InputError, Note
from .finding import names_below

if TYPE_CHECKING:
    from ...core.registry import Registry

MOST_BESIDE = 5000
"""Files near a program that are looked at, in each folder above it."""
MOST_ABOVE = 8
"""Folders above a program in which a backup may begin."""
_MOST_NEAR = 4
"""Of them those where it may do so by what else is there (``RAPID/TASK1/PROGMOD`` has three above):
what is further away is seldom of the same robot."""


def backup_round(path: Path, registry: Registry) -> tuple[str, Path] | None:
    """The vendor of the backup that a program lies in, and the folder where that begins.

    Args:
        path: a program that there is, or a folder: then a backup that lies in it does not count.
        registry: whose vendors may have written it.
    """
    given_path = Path(os.path.abspath(path))
    whole = given_path if path.is_file() else _first_program(given_path, registry)
    if whole is None:
        return None
    above = [one for one in whole.parents if one in given_path.parents][:MOST_ABOVE]
    for vendor in registry.vendors.values():
        if vendor.backups is None or whole.suffix.lower() not in vendor.suffixes:
            continue
        opener = vendor.backups()
        with suppress(OSError, InputError):
            marked = [one for one in above if opener.root_in([_inside(whole, one)]) == ""]
            beside = above[:_MOST_NEAR]
            near = (one for one in beside if opener.root_in(_near(whole, one)) == "")
            root = marked[-1] if marked else next(near, None)
            if root is not None and opener.root_in(names_below(root)) == "":
                return vendor.name, root
    return None


def _first_program(folder: Path, registry: Registry) -> Path | None:
    """A program below a folder."""
    suffixes = {suffix for vendor in registry.vendors.values() for suffix in vendor.suffixes}
    with suppress(OSError, InputError):
        for name in names_below(folder):
            if Path(name).suffix.lower() in suffixes:
                return folder / name
    return None


def _near(file: Path, folder: Path) -> list[str]:
    """A file, and those in a folder above it and in the folders there, as named from it."""
    found = [_inside(file, folder)]
    folders = [folder, *(Path(one.path) for one in _entries(folder) if one.is_dir())]
    for one in folders:
        found += [_inside(Path(f.path), folder) for f in _entries(one) if f.is_file()]
        if len(found) > MOST_BESIDE:
            break
    return found


def _entries(folder: Path) -> list[os.DirEntry[str]]:
    """What is in a folder, links passed over; nothing of one that may not be read."""
    with suppress(OSError), os.scandir(folder) as entries:
        return [one for one in islice(entries, MOST_BESIDE) if not one.is_symlink()]
    return []


def _inside(file: Path, folder: Path) -> str:
    return file.relative_to(folder).as_posix()


def surrounding_note(path: Path, registry: Registry) -> Note | None:
    """What to do with what lies in a backup; None where it lies in none."""
    found = backup_round(path, registry)
    if found is None:
        return None
    vendor, root = found
    near = os.path.relpath(root)
    shown = str(root) if near.startswith("..") else near
    return Note(
        f"{path} lies in a backup of {vendor}, {shown}: {called('emulate', shown)} with "
        f"{given('entry', 'ROUTINE')} takes robot, tools and data from it too"
    )
