"""Files of programs as scripts: ``.urp`` by what PolyScope would make of them, scripts as they are.

What a file holds shows, never its suffix: a ``.urp`` may be a script that somebody has renamed, and
a script may be packed.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from ....core.display import counted
from ....core.errors import FlybyError, InputError, LeftOpenError, Note, ParseError, SourceError
from ....core.files.reading import read_bytes
from ....core.program.program import Program
from ....core.source.text.files import LARGEST_FILE, MOST_LINES, SourceFile, decode, read_source
from .emission import node_at
from .installation import Installation, read_installation
from .polyscope_x import content_of, script_in
from .program import ROOT, UrProgram, script_of, urp_of
from .script_beside import moved_waypoints
from .xml_file import is_xml, parsed, unpacked

INSTALLATION, SCRIPT = ".installation", ".script"
_NAMED = 4
"""Waypoints that a note names at most."""
POLYSCOPE_X = ".urpx"
_TREE = re.compile(rf"\ufeff?\s*(<\?xml[^>]*>)?\s*<{ROOT}\b")
"""How the text of a tree begins."""


def source_of(path: Path, beside: Sequence[Path] | None) -> tuple[SourceFile, tuple[Note, ...]]:
    """A file as a script.

    Args:
        path: of a program.
        beside: the files that may stand beside it; None to look for them on the disk.

    Returns:
        The script under the file's own name, and what of the program is not in it.

    Raises:
        InputError: the file cannot be read, is damaged, or is no program.
    """
    plain = unpacked(read_bytes(path, LARGEST_FILE), str(path))
    if path.suffix.casefold() == POLYSCOPE_X:
        return SourceFile(str(path), script_in(content_of(plain, str(path)), str(path))), ()
    if not is_xml(plain):
        if max(plain.count(b"\n"), plain.count(b"\r")) > MOST_LINES:
            raise InputError(f"{path}: has more than {MOST_LINES:,} lines: no robot program")
        return SourceFile(str(path), *decode(plain, str(path))), ()
    program = urp_of(parsed(plain, str(path)), str(path))
    installation, notes = installation_beside(path, program, beside)
    source, told = _script(program, installation, str(path), notes)
    return source, (*told, *_stale(path, source.text, beside))


def _stale(path: Path, text: str, beside: Sequence[Path] | None) -> tuple[Note, ...]:
    """That the script beside a tree is of another state."""
    place = path.with_suffix(SCRIPT)
    there = place.is_file() if beside is None else _key(place) in map(_key, beside)
    if not there:
        return ()
    try:
        moved = moved_waypoints(text, read_source(place).text)
    except FlybyError:
        return ()  # it is not this program that is read
    if not moved:
        return ()
    names = ", ".join(moved[:_NAMED]) + (", …" if len(moved) > _NAMED else "")
    said = f"{path}: {counted(moved, 'waypoint')} elsewhere in {place.name} ({names})"
    return (Note(f"{said}: one of the two files is older; {path.name} is read"),)


def source_of_text(text: str, file: str) -> tuple[SourceFile, tuple[Note, ...]]:
    """A text as a script; no other file is looked at.

    Raises:
        InputError: it is a tree that is damaged.
    """
    if _TREE.match(text) is None:
        return SourceFile(file, text), ()
    program = urp_of(parsed(text.encode(), file), file)
    return _script(program, None, file, ())


def _script(
    program: UrProgram, installation: Installation | None, file: str, notes: tuple[Note, ...]
) -> tuple[SourceFile, tuple[Note, ...]]:
    text, told = script_of(program, installation, Path(file).stem)
    return SourceFile(file, text), tuple(
        replace(note, message=f"{file}: {note.message}") for note in (*notes, *told)
    )


def installation_beside(
    path: Path, program: UrProgram, beside: Sequence[Path] | None
) -> tuple[Installation | None, tuple[Note, ...]]:
    """The installation that a program names, if it is at hand.

    Args:
        path: of the program.
        program: it.
        beside: see `source_of`.

    Returns:
        It, and why it is not used.
    """
    for place in installation_places(path, program):
        try:
            if beside is None:
                found = place if place.is_file() else None
            else:
                same = [one for one in beside if _key(one) == _key(place)]
                found = same[0] if same else None
            if found is not None:
                return read_installation(found), ()
        except (InputError, OSError, ValueError) as error:
            return None, (Note(f"its installation is not used: {error}"),)
    return None, ()


def installation_places(path: Path, program: UrProgram) -> list[Path]:
    """Where the installation may be: as the program says, or beside it."""
    names = [program.installation_path, program.installation]
    plain = [name.replace("\\", "/").strip() for name in names if name.strip()]
    relative = [name for name in plain if not name.startswith("/") and "\0" not in name]
    places = [path.parent / f"{name.removesuffix(INSTALLATION)}{INSTALLATION}" for name in relative]
    last = [name.rpartition("/")[2] for name in plain]
    return [*places, *(path.parent / f"{name}{INSTALLATION}" for name in last if "\0" not in name)]


def _key(path: Path) -> str:
    return str(path.absolute().resolve()).casefold()


def named_nodes(program: Program, files: dict[str, SourceFile]) -> Program:
    """The same program, its notes with the nodes that they are about."""
    return replace(program, notes=tuple(_named(note, files) for note in program.notes))


def _named(note: Note, files: dict[str, SourceFile]) -> Note:
    node = None if note.span is None else _node(files, note.span.file, note.span.line)
    return note if node is None else replace(note, message=f"{node}: {note.message}")


def named_error(error: SourceError, files: dict[str, SourceFile]) -> SourceError:
    """The same error with the node that it is about."""
    node = None if error.span is None else _node(files, error.span.file, error.span.line)
    if type(error) not in (SourceError, LeftOpenError, ParseError):
        return error
    return error if node is None else type(error)(f"{node}: {error.message}", error.span)


def _node(files: dict[str, SourceFile], file: str, line: int) -> str | None:
    source = files.get(file)
    return None if source is None else node_at(source.text, line)
