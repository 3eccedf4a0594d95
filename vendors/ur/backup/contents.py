"""The files of UR controllers in a folder: programs and installations, read."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from ....core.errors import FlybyError, InputError, Note
from ....core.files.reading import read_bytes
from ....core.source.text.files import LARGEST_FILE
from ..urp.file_names import INSTALLATION, POLYSCOPE_X, PROGRAM, SCRIPT
from ..urp.installation import Installation, read_installation
from ..urp.polyscope_x import content_of, installation_in, script_in
from ..urp.program import UrProgram, urp_of
from ..urp.source import installation_places
from ..urp.xml_file import is_xml, parsed, unpacked
from .marks import MARKS

PASSED_OVER = "passed over: "
MOST_FILES = 20_000
"""Programs and installations that are looked at; a folder of a robot has some hundreds."""


@dataclass(frozen=True)
class Found:
    """A program.

    Args:
        name: its file, below the root.
        tree: None if it is a script.
        installation: name of the one that it uses; None if that is not at hand.
        script: the one that PolyScope has saved beside it; None if there is none.
        moves: whether it moves the robot.
    """

    name: str
    tree: UrProgram | None
    installation: str | None
    moves: bool
    script: str | None = None


@dataclass
class Contents:
    """What is read of a folder.

    Attributes:
        programs: in the order of their names.
        installations: by their file below the root.
        notes: what cannot be read.
    """

    root: Path
    programs: list[Found] = field(default_factory=list)
    installations: dict[str, Installation] = field(default_factory=dict)
    notes: list[Note] = field(default_factory=list)


def read_contents(root: Path, names: Sequence[str]) -> Contents:
    """What files hold.

    Args:
        root: the folder.
        names: of files below it.
    """
    contents = Contents(root)
    for name in names:
        if _suffix(name) == INSTALLATION:
            _guarded(contents, name, _add_installation)
    for name in names:
        if _suffix(name) in (PROGRAM, POLYSCOPE_X):
            _guarded(contents, name, _add_program)
    return contents


def marked_below(root: Path) -> list[str]:
    """Programs and installations below a folder, links passed over.

    Raises:
        InputError: there are more than any robot has.
    """
    found: list[str] = []
    for name in _walked(root):
        if _suffix(name) in MARKS:
            found.append(name)
            if len(found) > MOST_FILES:
                raise InputError(f"{root}: more than {MOST_FILES:,} programs are below it")
    return found


def _walked(root: Path) -> Iterator[str]:
    for above, folders, files in os.walk(root):
        folders[:] = sorted(one for one in folders if not one.startswith("."))
        for name in sorted(files):
            path = Path(above) / name
            if not path.is_symlink():
                yield path.relative_to(root).as_posix()


def _suffix(name: str) -> str:
    return PurePosixPath(name).suffix.casefold()


def _guarded(contents: Contents, name: str, add: Callable[[Contents, str], None]) -> None:
    try:
        add(contents, name)
    except FlybyError as error:
        told = str(error).replace(f"{contents.root}{os.sep}", "")
        contents.notes.append(Note(f"{PASSED_OVER}{told}"))


def _add_installation(contents: Contents, name: str) -> None:
    contents.installations[name] = read_installation(contents.root / name)


def _add_program(contents: Contents, name: str) -> None:
    path = contents.root / name
    plain = unpacked(read_bytes(path, LARGEST_FILE), str(path))
    if _suffix(name) == POLYSCOPE_X:
        content = content_of(plain, str(path))
        moves = "move" in script_in(content, str(path))
        contents.installations[name] = installation_in(content)
        contents.programs.append(Found(name, None, name, moves))
        return
    if not is_xml(plain):
        contents.programs.append(Found(name, None, None, b"move" in plain))
        return
    tree = urp_of(parsed(plain, str(path)), str(path))
    script = path.with_suffix(SCRIPT)
    beside = PurePosixPath(name).with_suffix(SCRIPT).as_posix() if script.is_file() else None
    installation = _installation(contents, path, tree)
    contents.programs.append(Found(name, tree, installation, _moves(tree), beside))


def _installation(contents: Contents, path: Path, tree: UrProgram) -> str | None:
    """The file of the installation that a program names, below the root; as ``..`` above it."""
    known = {_key(contents.root / name): name for name in contents.installations}
    for place in installation_places(path, tree):
        found = known.get(_key(place))
        if found is not None:
            return found
        if place.is_file():
            name = Path(os.path.relpath(place, contents.root)).as_posix()
            _guarded(contents, name, _add_installation)
            return name if name in contents.installations else None
    return None


def _key(path: Path) -> str:
    return os.path.abspath(path).casefold()


def _moves(tree: UrProgram) -> bool:
    """Whether a node moves the robot, or a script in the tree may."""
    nodes = tree.root.iter("Move", "SafeHome", "Script", "CallSubProgram")
    return any(next(node.iterancestors("SuppressedNode"), None) is None for node in nodes)
