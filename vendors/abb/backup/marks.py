"""Where an ABB backup begins among files: by what marks it, never by its name."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterable, Sequence

from ..language import SUFFIXES

CONFIGURATIONS = ("sys", "moc", "eio", "proc", "mmc", "sio")
"""Topics of system parameters, each a file of its own: ``SYSPAR/MOC.cfg``."""

_BACKINFO = re.compile(r"(?:(.*)/)?backinfo/backinfo\.txt", re.IGNORECASE | re.DOTALL)
_TASK = re.compile(r"(?:(.*?)/)?rapid/task\d+/(?:progmod|sysmod)/[^/]+", re.IGNORECASE | re.DOTALL)
_MODULES = re.compile(
    r"(?:(.*?)/)??(?:task\d+/)?(?:progmod|sysmod)/[^/]+", re.IGNORECASE | re.DOTALL
)
_CONFIGURATION = re.compile(
    rf"(?:(.*)/)?({'|'.join(CONFIGURATIONS)})\.cfg", re.IGNORECASE | re.DOTALL
)
_SYSPAR = re.compile(r"(?:(.*)/)?syspar", re.IGNORECASE | re.DOTALL)


def root_in(names: Sequence[str]) -> str | None:
    """The folder in which a backup begins; see `BackupOpener.root_in`.

    The marks, the surest first: ``BACKINFO/backinfo.txt``; ``RAPID/TASKn`` with modules;
    a folder of system parameters (``MOC.cfg``, or several topics). Of several backups the outermost
    is taken, as a controller's own disk may hold older ones, and of those beside each other the
    first by name.
    """
    for found in (_found(_BACKINFO, names), _found(_TASK, names), _of_parameters(names)):
        if found:
            return _outermost(found)
    return None


def nested_in(names: Sequence[str]) -> list[str]:
    """The folders of further backups below one that begins at the root."""
    return sorted(filter(None, _found(_BACKINFO, names)), key=str.casefold)


def modules_in(names: Sequence[str]) -> str | None:
    """The folder that holds a part of a backup, copied without what marks it; see
    `BackupOpener.programs_in`.

    That of ``TASKn`` folders, or of ``PROGMOD`` and ``SYSMOD``, the outermost, the first by name;
    else what holds all modules.
    """
    part = _outermost(_found(_MODULES, names))
    modules = [name for name in names if name.casefold().endswith(SUFFIXES)]
    if part is not None or not modules:
        return part
    return posixpath.commonpath([posixpath.dirname(name) for name in modules])


def _outermost(roots: Iterable[str]) -> str | None:
    def order(root: str) -> tuple[int, str]:
        return root.count("/") + bool(root), root.casefold()

    return min(roots, key=order, default=None)


def _found(mark: re.Pattern[str], names: Iterable[str]) -> list[str]:
    return [found[1] or "" for found in map(mark.fullmatch, names) if found is not None]


def _of_parameters(names: Iterable[str]) -> list[str]:
    """Folders that hold system parameters; those of folders called SYSPAR that lie below them."""
    topics: dict[str, set[str]] = {}
    for found in filter(None, map(_CONFIGURATION.fullmatch, names)):
        topics.setdefault(found[1] or "", set()).add(found[2].lower())
    roots = []
    for folder, held in topics.items():
        if "moc" in held or len(held) > 1:
            named = _SYSPAR.fullmatch(folder)
            roots.append(folder if named is None else named[1] or "")
    return roots
