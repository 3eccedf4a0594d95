"""Which files belong to a RAPID program."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path, PureWindowsPath

from ....core.errors import FlybyError, InputError
from ....core.source.reading import Files, ReadOptions
from ....core.source.text.files import SourceFile, read_source

MODULES = (".mod", ".modx", ".prg", ".sys", ".sysx")
PROGRAM = ".pgf"
"""A list of the modules of a program, in XML."""

MOST_BESIDE = 200
"""Files beside a program that are looked at; a folder with more is an archive."""

_MODULE = re.compile(r"^[ \t]*MODULE[ \t]+(\w+)", re.IGNORECASE | re.MULTILINE)
_LISTED = re.compile(r"<Module>\s*([^<]*?)\s*</Module>", re.IGNORECASE)


def collect(path: Path, options: ReadOptions) -> dict[str, SourceFile]:
    """The file itself, the others that the user names, and what stands beside it.

    Beside a program stand the modules of its folder, its list (``.pgf``), and, as in a backup,
    the folder ``SYSMOD`` next to ``PROGMOD``. Those that are no text are left out, and old copies:
    no controller loads a module beside another one of its name.

    Raises:
        InputError: a file that the user or a list names cannot be read.
    """
    main = read_source(path)
    files = {main.name: main}
    named = [path, *options.others]
    for other in options.others:
        files.setdefault(str(other), read_source(other))
    for listing in [p for p in named if p.suffix.lower() == PROGRAM]:
        for name in listed(files[str(listing)]):
            _add_listed(listing, name, files, named)
    known = {_resolved(p) for p in named}
    around = _beside(path) if options.beside is None else options.beside
    modules = {name for file in files.values() for name in _modules_in(file)}
    for beside in around:
        if _resolved(beside) not in known:
            try:
                file = read_source(beside)
            except FlybyError:
                continue  # nobody has named it
            if modules.isdisjoint(_modules_in(file)):
                files[str(beside)] = file
    return files


def loaded(files: Files, main: str, options: ReadOptions) -> list[str]:
    """Names of the files that are part of the program from the beginning, ``main`` first.

    Raises:
        InputError: a list names no module, or one that is not there.
    """
    names: list[str] = []
    for name in (main, *map(str, options.others)):
        if name not in files:
            raise InputError(f"{name} is not among the files: {', '.join(files)}")
        names += _modules_of(name, files) if _is_list(name) else [name]
    return list(dict.fromkeys(names))


def beside(files: Files, main: str, names: Iterable[str]) -> dict[str, SourceFile]:
    """Files that may be taken in when a name is missed.

    Where a list beside the program names the program's file, only the modules that it names, and
    system modules, belong to it.
    """
    rest = {n: f for n, f in files.items() if n not in set(names) and not _is_list(n)}
    own = _base(main)
    for name, file in files.items():
        members = {_base(m) for m in listed(file)} if _is_list(name) else set()
        if own in members:
            return {n: f for n, f in rest.items() if _base(n) in members or is_system(n)}
    return rest


def listed(program: SourceFile) -> list[str]:
    """Module files that a ``.pgf`` names."""
    return [str(PureWindowsPath(name).name) for name in _LISTED.findall(program.text)]


def _modules_of(listing: str, files: Files) -> list[str]:
    names = listed(files[listing])
    if not names:
        raise InputError(f"{listing} lists no module: <Module>name.mod</Module> is expected")
    found = []
    for name in names:
        matches = [f for f in files if _base(f) == name.casefold() and not _is_list(f)]
        if not matches:
            raise InputError(f"{listing} lists {name}, which is not at hand")
        found.append(matches[0])
    return found


def _add_listed(listing: Path, name: str, files: dict[str, SourceFile], named: list[Path]) -> None:
    for path in listing.parent.iterdir():
        if path.name.casefold() == name.casefold():
            files.setdefault(str(path), read_source(path))
            named.append(path)
            return
    raise InputError(f"{listing} lists {name}, which does not stand beside it")


def _beside(path: Path) -> list[Path]:
    folders = [path.parent]
    if path.resolve().parent.name.upper() == "PROGMOD":
        folders.append(path.parent / ".." / "SYSMOD")
    found: list[Path] = []
    for folder in folders:
        try:
            entries = sorted(folder.iterdir())
        except OSError:
            continue
        found += [p for p in entries if p.suffix.lower() in (*MODULES, PROGRAM) and p.is_file()]
    return found[:MOST_BESIDE]


def _resolved(path: Path) -> Path:
    try:
        return path.resolve()
    except OSError:
        return path


def _modules_in(file: SourceFile) -> set[str]:
    return {name.lower() for name in _MODULE.findall(file.text)}


def _is_list(name: str) -> bool:
    return name.lower().endswith(PROGRAM)


def is_system(name: str) -> bool:
    """Whether a file is a system module's, by its name."""
    return name.lower().endswith((".sys", ".sysx"))


def _base(name: str) -> str:
    return PureWindowsPath(name).name.casefold()
