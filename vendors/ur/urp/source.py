"""Files of programs as scripts: ``.urp`` by what PolyScope would make of them, scripts as they are.

What a file holds shows, never its suffix: a ``.urp`` may be a script that somebody has renamed, and
a script may be packed.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from ....core.display import counted
from ....core.errors import FlybyError, InputError, LeftOpenError, Note, ParseError, SourceError
from ....core.files.reading import read_bytes
from ....core.program.program import Program
from ....core.source.text.files import LARGEST_FILE, MOST_LINES, SourceFile, decode, read_source
from .changes.code_files import code_files
from .changes.tree_file import PackedScript, PolyScopeXFile, TreeFile
from .emission import node_at
from .file_names import INSTALLATION, POLYSCOPE_X, SCRIPT
from .installation import Installation, read_installation
from .polyscope_x import content_of, script_in
from .program import ROOT, UrProgram, script_of, urp_of
from .script_beside import moved_waypoints
from .xml_file import is_xml, parsed, unpacked

_NAMED = 4
"""Waypoints that a note names at most."""
_TREE = re.compile(rf"\ufeff?\s*+(?:<\?xml[^>]*+>)?\s*+<{ROOT}\b")
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
    data = read_bytes(path, LARGEST_FILE)
    plain = unpacked(data, str(path))
    if path.suffix.casefold() == POLYSCOPE_X:
        text = script_in(content_of(plain, str(path)), str(path))
        return PolyScopeXFile(str(path), text, packed=data), ()
    if not is_xml(plain):
        if max(plain.count(b"\n"), plain.count(b"\r")) > MOST_LINES:
            raise InputError(f"{path}: has more than {MOST_LINES:,} lines: no robot program")
        text, codec = decode(plain, str(path))
        return PackedScript(str(path), text, codec, data), ()
    program = urp_of(parsed(plain, str(path)), str(path))
    installation, notes = installation_beside(path, program, beside)
    source, told = _script(program, installation, str(path), data, notes)
    source = replace(source, code=code_files(program.root, path))
    script = _script_beside(path, beside)
    if script is None:
        return source, told
    return replace(source, beside=script), (*told, *_stale(path, source.text, script))


def _script_beside(path: Path, beside: Sequence[Path] | None) -> SourceFile | None:
    """The script that PolyScope has saved beside a tree; None if none can be read."""
    place = path.with_suffix(SCRIPT)
    there = place.is_file() if beside is None else _key(place) in map(_key, beside)
    with suppress(FlybyError):
        return read_source(place) if there else None
    return None  # it is not this program that is read


def _stale(path: Path, text: str, script: SourceFile) -> tuple[Note, ...]:
    """That the script beside a tree is of another state."""
    moved = moved_waypoints(text, script.text)
    if not moved:
        return ()
    names = ", ".join(moved[:_NAMED]) + (", …" if len(moved) > _NAMED else "")
    said = f"{path}: {counted(moved, 'waypoint')} elsewhere in {Path(script.name).name} ({names})"
    return (Note(f"{said}: one of the two files is older; {path.name} is read"),)


def source_of_text(text: str, file: str) -> tuple[SourceFile, tuple[Note, ...]]:
    """A text as a script; no other file is looked at.

    Raises:
        InputError: it is a tree that is damaged.
    """
    if _TREE.match(text) is None:
        return SourceFile(file, text), ()
    data = text.encode()
    return _script(urp_of(parsed(data, file), file), None, file, data, ())


def _script(
    program: UrProgram,
    installation: Installation | None,
    file: str,
    data: bytes,
    notes: tuple[Note, ...],
) -> tuple[TreeFile, tuple[Note, ...]]:
    script = script_of(program, installation, Path(file).stem)
    source = TreeFile(
        file,
        script.text,
        packed=data,
        program=program,
        installation=installation,
        literals=script.literals,
    )
    return source, tuple(
        replace(note, message=f"{file}: {note.message}") for note in (*notes, *script.notes)
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
