"""The backup that a program file lies in, which knows robot and data."""

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


def backup_round(file: Path, registry: Registry) -> tuple[str, Path] | None:
    """The vendor of the backup that a file lies in, and the folder where that begins.

    Args:
        file: a program that there is.
        registry: whose vendors may have written it.
    """
    whole = Path(os.path.abspath(file))
    above = list(whole.parents)[:MOST_ABOVE]
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


def surrounding_note(file: Path, registry: Registry) -> Note | None:
    """What to do with a file that lies in a backup; None where it lies in none."""
    found = backup_round(file, registry)
    if found is None:
        return None
    vendor, root = found
    near = os.path.relpath(root)
    shown = str(root) if near.startswith("..") else near
    return Note(
        f"{file} lies in a backup of {vendor}, {shown}: {called('emulate', shown)} with "
        f"{given('entry', 'ROUTINE')} takes robot, tools and data from it too"
    )
