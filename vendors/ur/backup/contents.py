"""The files of UR controllers in a folder: programs and installations, read."""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from ....core.backup.contents import listed
from ....core.errors import FlybyError, InputError, Note
from ....core.files.reading import read_bytes
from ....core.source.text.files import LARGEST_FILE, decode
from ..urp.changes.code_files import COPY
from ..urp.expressions import function_name
from ..urp.file_names import INSTALLATION, POLYSCOPE_X, PROGRAM, SCRIPT
from ..urp.installation import Installation, read_installation
from ..urp.nodes import left_out, listed_nodes, runs
from ..urp.polyscope_x import content_of, installation_in, script_in
from ..urp.program import UrProgram, is_of_old_polyscope, urp_of
from ..urp.source import installation_places
from ..urp.xml_file import Element, is_xml, parsed, unpacked
from .marks import MARKS

PASSED_OVER = "passed over: "
_MOVING = "Waypoint", "CircleMove", "MoveDirection", "SafeHome"
_MOVE = re.compile(r"^[ \t]*(?:move[jlpc]|optimovej|optimovel)[ \t]*\(", re.MULTILINE)
_FUNCTION = re.compile(r"^[ \t]*def[ \t]+(\w+)[ \t]*\([ \t]*\)", re.MULTILINE)
_NO_TEXT = re.compile(r"[\x00-\x08\x0e-\x1a\x1c-\x1f]")
"""Characters that no script has."""
MOST_FILES = 20_000
"""Programs and installations that are looked at; a folder of a robot has some hundreds."""


@dataclass(frozen=True)
class Found:
    """A program.

    Args:
        name: its file, below the root.
        tree: None if it is a script.
        installation: name of the one that it uses; None if that is not at hand.
        moves: statements that move the robot; None where nobody can count them.
        entry: the function that it is; None if that is not known.
        script: the one that PolyScope has saved beside it; None if there is none.
    """

    name: str
    tree: UrProgram | None
    installation: str | None
    moves: int | None
    entry: str | None
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
        names: of files below it; scripts count where no tree is among them.
    """
    contents = Contents(root)
    for name in names:
        if _suffix(name) == INSTALLATION:
            _guarded(contents, name, _add_installation)
    trees = [name for name in names if _suffix(name) in (PROGRAM, POLYSCOPE_X)]
    scripts = [name for name in names if _suffix(name) == SCRIPT]
    for name in trees or scripts:
        _guarded(contents, name, _add_program)
    if trees:
        _note_left_out(contents, trees, scripts)
    return contents


def _note_left_out(contents: Contents, trees: Sequence[str], scripts: Sequence[str]) -> None:
    """Scripts that PolyScope has saved of no tree, and that no tree runs."""
    saved = {PurePosixPath(name).stem.casefold() for name in trees}
    own = [name for name in scripts if PurePosixPath(name).stem.casefold() not in saved]
    if not own:
        return
    run = " ".join(
        str(text).casefold()
        for one in contents.programs
        if one.tree is not None
        for node in one.tree.root.iter("Script")
        for text in (*node.itertext(), *(v for part in node.iter() for v in part.attrib.values()))
    )
    left = [name for name in own if PurePosixPath(name).name.casefold() not in run]
    if left:
        told = f"{listed(left)}: left out, as no program is called so or runs it: name it by itself"
        contents.notes.append(Note(told))


def marked_below(root: Path) -> list[str]:
    """Programs, scripts and installations below a folder, links passed over.

    Raises:
        InputError: there are more than any robot has.
    """
    found: list[str] = []
    for name in _walked(root):
        if _suffix(name) in (*MARKS, SCRIPT):
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
        script = PurePosixPath(name).with_suffix(SCRIPT)
        if _suffix(name) == PROGRAM and (contents.root / script).is_file():
            told = f"{told}: {script.name} beside it is read in its place"
            contents.notes.append(Note(told))
            _guarded(contents, script.as_posix(), add)
            return
        contents.notes.append(Note(f"{PASSED_OVER}{told}"))


def _add_installation(contents: Contents, name: str) -> None:
    contents.installations[name] = read_installation(contents.root / name)


def _add_program(contents: Contents, name: str) -> None:
    path = contents.root / name
    plain = unpacked(read_bytes(path, LARGEST_FILE), str(path))
    if _suffix(name) == POLYSCOPE_X:
        content = content_of(plain, str(path))
        text = script_in(content, str(path))
        contents.installations[name] = installation_in(content)
        _add_script(contents, name, text, name)
        return
    if not is_xml(plain):
        text = decode(plain, str(path))[0]
        if not text.strip() or _NO_TEXT.search(text):
            what = "is neither a program's tree nor a script" if text.strip() else "is empty"
            raise InputError(f"{path}: {what}: copy it from the controller again")
        _add_script(contents, name, text)
        return
    script = path.with_suffix(SCRIPT)
    beside = PurePosixPath(name).with_suffix(SCRIPT).as_posix() if script.is_file() else None
    root = parsed(plain, str(path))
    if beside is not None and is_of_old_polyscope(root):
        told = f"{name}: is of before PolyScope 3.0: {script.name} beside it is read in its place"
        contents.notes.append(Note(told))
        _add_program(contents, beside)
        return
    tree = urp_of(root, str(path))
    installation = _installation(contents, path, tree)
    entry = function_name(path.stem)
    lacks = left_out(root)
    if lacks:
        contents.notes.append(Note(f"{name}: {_lacking(lacks, beside)}"))
    contents.programs.append(Found(name, tree, installation, _moves(tree), entry, beside))


def _lacking(kinds: Counter[str], script: str | None) -> str:
    """What becomes of nodes whose code a tree does not hold."""
    told = listed_nodes(kinds)
    if script is not None:
        return f"nodes whose code is in {PurePosixPath(script).name} alone: {told}"
    return (
        f"nodes of which nothing is carried out: {told}; their code is in the .script that "
        "PolyScope saves beside the program"
    )


def _add_script(contents: Contents, name: str, text: str, installation: str | None = None) -> None:
    functions = _FUNCTION.findall(text)
    own = [one for one in (function_name(Path(name).stem), "main") if one in functions]
    entry = next(iter(own or functions[:1] if own or len(functions) == 1 else ()), None)
    moves = len(_MOVE.findall(text))
    contents.programs.append(Found(name, None, installation, moves, entry))


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


def _moves(tree: UrProgram) -> int | None:
    """How many nodes move the robot; None if only scripts or other programs may."""
    count = sum(1 for node in tree.root.iter(*_MOVING) if runs(node) and _in_program(node))
    copies = filter(runs, tree.root.iter(COPY))
    count += sum(len(_MOVE.findall(str(copy.text or ""))) for copy in copies)
    if count:
        return count
    others = any(map(runs, tree.root.iter("Script", "CallSubProgram")))
    return None if others else 0


def _in_program(node: Element) -> bool:
    """Whether an element is a node, and not a point of one."""
    above = node.getparent()
    return above is not None and above.tag == "children"
