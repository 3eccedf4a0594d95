"""A backup by its path: unpacked if it is an archive, found by what marks it, opened by its vendor.

The files in it show which controller wrote it, never its own name: a backup may stand
further down, beside others, a README and pictures.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from ...core.door import called
from ...core.errors import InputError, Note
from ...core.files.archive import is_archive, unpack

if TYPE_CHECKING:
    from ...core.backup.backup import Backup
    from ...core.language import BackupOpener
    from ...core.registry import Registry

MOST_FILES = 100_000
"""Below one folder. A station has some thousands; what has more is a disk."""
_NAMED = 4
"""Programs that a note names at most."""
_TEXTS = frozenset({".txt"})
"""What programs may end with, and nearly all files that do so are none."""
_ARCHIVE = (".zip", ".rspag")
"""Pack & Go files of RobotStudio are zip files."""
_OTHER_ARCHIVES = (".7z", ".rar", ".tar", ".tar.gz", ".tgz", ".tar.xz")
_NOT_ENTERED = frozenset({".git", ".svn", ".hg", "__pycache__", "node_modules", ".venv"})


@dataclass(frozen=True)
class _Found:
    """Where a backup begins, and who opens it."""

    vendor: str
    opener: BackupOpener
    root: str

    @property
    def depth(self) -> int:
        return len(PurePosixPath(self.root).parts)


def find_backup(path: str | Path, registry: Registry, marked: bool = False) -> Backup | None:
    """The backup in a folder, an archive or a file; None if there is none.

    Args:
        path: what a controller or its tools have written, or a folder with that in it somewhere.
        registry: whose vendors may have written it, and where its robots are looked up.
        marked: whether programs alone are none.

    Raises:
        InputError: the path does not exist, there are several backups, or nothing can be read,
            as nobody knows how its controller keeps it.
    """
    source = Path(path)
    if not os.path.lexists(source):
        raise InputError(f"{source}: there is no such file or folder")
    notes: tuple[Note, ...] = ()
    folder, unpacked = source, None
    if source.is_dir():
        names = names_below(source)
    elif is_archive(source):
        unpacked, notes = unpack(source)
        folder = unpacked
        names = names_below(folder)
    else:
        folder, names = source.parent, [source.name]
    found = _nearest(source, _found(names, registry))
    if found is None and not marked and (unpacked is not None or source.is_dir()):
        found = _programs_alone(names, registry)
    if found is None and source.is_dir() and not marked and (packed := _packed(folder, names)):
        opened = find_backup(packed, registry)
        note = Note(f"{source}: the backup is that in {packed.relative_to(folder)}")
        return opened and replace(opened, notes=(note, *opened.notes))
    if found is None:
        _refuse_unreadable(source, names, registry)
        return None
    notes = (*notes, *_outside(source, found, names, registry))
    backup = found.opener.open(source, folder / found.root, registry.find_robot)
    return replace(backup, notes=(*notes, *backup.notes), unpacked=unpacked)


def _packed(folder: Path, names: Sequence[str]) -> Path | None:
    """The only archive below a folder."""
    archives = [folder / name for name in names if name.casefold().endswith(_ARCHIVE)]
    return archives[0] if len(archives) == 1 and is_archive(archives[0]) else None


def _refuse_unreadable(source: Path, names: Sequence[str], registry: Registry) -> None:
    """Refuse what is known to be of a controller whose files nobody can read, by its cause."""
    if _programs(names, registry):
        return
    for vendor in registry.vendors.values():
        if vendor.backups is not None:
            why = vendor.backups().unreadable_in([source.name, *names])
            if why is not None:
                raise InputError(f"{source}: {why}")


def no_backup(path: str | Path, registry: Registry) -> InputError:
    """That there is none, to be raised."""
    kinds = ", ".join(sorted(v.name for v in registry.vendors.values() if v.backups))
    folder = Path(path).is_dir()
    what = "folder" if folder else "file"
    names = names_below(Path(path)) if folder else [Path(path).name]
    of = {name for vendors in _programs(names, registry).values() for name in vendors}
    if of and not folder and Path(path).suffix.casefold() not in _TEXTS:
        return InputError(
            f"{path}: is a program, and no backup: {called('emulate', str(path))} drives it; name "
            "the folder that it lies in, or the backup around it, to see what is there"
        )
    if len(of) > 1:
        return InputError(
            f"{path}: programs of {' and '.join(sorted(of))} are in this {what}, and no backup: "
            "name a folder with those of one, or a program"
        )
    packed = [name for name in names if name.casefold().endswith(_ARCHIVE)]
    which = f": {', '.join(packed[:_NAMED])}, perhaps" if packed else ""
    others = [name for name in names if name.casefold().endswith(_OTHER_ARCHIVES)]
    if others:
        which = f"; archives other than zip have to be unpacked: {', '.join(others[:_NAMED])}"
    return InputError(
        f"{path}: no backup is in this {what}: nothing in it marks one of a controller of "
        f"{kinds}; name the folder or archive that the controller has written{which}"
    )


def _found(names: Sequence[str], registry: Registry) -> Iterator[_Found]:
    """Every backup among files."""
    for vendor in registry.vendors.values():
        if vendor.backups is None:
            continue
        opener, left = vendor.backups(), list(names)
        while left and (root := opener.root_in(left)) is not None:
            yield _Found(vendor.name, opener, root)
            inside = f"{root}/" if root else ""
            left = [name for name in left if not name.startswith(inside)]


def _programs_alone(names: Sequence[str], registry: Registry) -> _Found | None:
    """Programs of one vendor that no backup marks."""
    programs = _programs(names, registry)
    sure = {n: of for n, of in programs.items() if PurePosixPath(n).suffix.casefold() not in _TEXTS}
    for vendor in registry.vendors.values():
        if vendor.backups is None or not all(
            vendor.name in of for of in (sure or programs).values()
        ):
            continue
        opener = vendor.backups()
        root = opener.programs_in(names) if programs else None
        if root is not None:
            return _Found(vendor.name, opener, root)
    return None


def _programs(names: Sequence[str], registry: Registry) -> dict[str, set[str]]:
    """Vendors whose programs files may be, of those that may be one."""
    of = {
        name: {
            v.name
            for v in registry.vendors.values()
            if PurePosixPath(name).suffix.casefold() in v.suffixes
        }
        for name in names
    }
    return {name: vendors for name, vendors in of.items() if vendors}


def _outside(
    source: Path, found: _Found, names: Sequence[str], registry: Registry
) -> Iterator[Note]:
    """Programs that stand beside a backup, and are no part of it."""
    if not found.root:
        return
    others = [
        name
        for name, vendors in _programs(names, registry).items()
        if found.vendor in vendors
        and not name.startswith(f"{found.root}/")
        and PurePosixPath(name).suffix.casefold() not in _TEXTS
    ]
    if others:
        more = f" and {len(others) - _NAMED} more" if len(others) > _NAMED else ""
        yield Note(
            f"{source}: the backup in {found.root} is taken; left out is what stands outside it: "
            f"{', '.join(others[:_NAMED])}{more}"
        )


def _nearest(source: Path, found: Iterator[_Found]) -> _Found | None:
    """The one that begins furthest out.

    Raises:
        InputError: several do.
    """
    all_found = list(found)
    least = min((one.depth for one in all_found), default=0)
    nearest = [one for one in all_found if one.depth == least]
    if len(nearest) > 1:
        told = ", ".join(f"{one.root or source.name} ({one.vendor})" for one in nearest[:12])
        more = f" and {len(nearest) - 12} more" if len(nearest) > 12 else ""
        raise InputError(f"{source}: holds several backups; name one of them: {told}{more}")
    return nearest[0] if nearest else None


def names_below(folder: Path) -> list[str]:
    """The files below a folder, links passed over.

    Raises:
        InputError: there are more than any station has.
    """
    names = list(islice(_walked(folder), MOST_FILES + 1))
    if len(names) > MOST_FILES:
        raise InputError(
            f"{folder}: more than {MOST_FILES:,} files are below it: name the backup's own folder"
        )
    return names


def _walked(folder: Path) -> Iterator[str]:
    for above, folders, files in os.walk(folder):
        folders[:] = sorted(one for one in folders if one not in _NOT_ENTERED)
        inside = Path(above).relative_to(folder)
        for name in sorted(files):
            place = inside / name
            if not (folder / place).is_symlink():
                yield place.as_posix()
