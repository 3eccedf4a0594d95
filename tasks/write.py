"""Programs and results as files: new ones, or the user's own with other numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from ..core.errors import InputError
from .files.outputs import check_outputs, write_all, write_in
from .files.places import FilePlaces
from .files.texts import OWN
from .options.door import spelt, switched
from .options.entries import TaskOptions, choice, switch, value
from .options.keywords import by_keywords
from .setup import RobotOptions, Setup, with_setup

if TYPE_CHECKING:
    from ..core.language import Sources
    from ..core.program.program import Program

OPAQUE = ("keep", "comment")


@runtime_checkable
class WithFiles(Protocol):
    """A result that is put into a folder: names in it, and what the files hold."""

    @property
    def files(self) -> Mapping[str, bytes]:
        """Contents by path in the folder."""
        ...


@dataclass(frozen=True, kw_only=True)
class WriteOptions(RobotOptions):
    """How files are written."""

    opaque: str | None = choice(
        None,
        "Statements that do not move the robot are kept as they stand (the default), or become "
        "comments.",
        OPAQUE,
    )
    unproven: bool = switch("Write a result even if its clearance is not proven.")
    force: bool = switch("Replace output files.")


def write_with(
    what: Program | WithFiles, out: str | Path, options: WriteOptions
) -> tuple[Path, ...]:
    """Write a program as new files, or the files of a result.

    What is written has been read back: a program's text drives the moves that the program holds,
    and a solution's text is the one that its proof is of.

    Args:
        what: a program, written anew with all its moves in one routine, or what another task has
            made: a `Solution`, a translation, a recording, an experiment, a painting.
        out: a folder, which is made if it is missing, or of a program the file's name, beside
            which further ones are put if the language takes several.

    Returns:
        The files.

    Raises:
        InputError: the result is not proven, or a file must not be written; then none is.
        FlybyError: the language cannot say what the program holds.
    """
    from ..core.program.program import Program

    out = Path(out)
    if not isinstance(what, Program):
        if getattr(what, "proven", True) is False and not options.unproven:
            raise InputError(
                f"it is not proven to keep its clearance: {switched('unproven')} writes it"
            )
        files = {Path(name): data for name, data in what.files.items()}
        return tuple(write_in(spelt("out"), out, files, _read(what), options.force))
    program, setup = with_setup(what, options)
    folder = out.suffix.lower() not in setup.vendor.suffixes
    chosen = {} if options.opaque is None else {"opaque": options.opaque}
    files = sources_by_path(program, setup, out, chosen, folder=folder, option=spelt("out"))
    check_outputs(
        {f"{spelt('out')}: {path.name}": path for path in files},
        _read(program),
        options.force,
        out if folder else None,
    )
    write_all(spelt("out"), files, out if folder else None)
    return tuple(files)


write = by_keywords(write_with, WriteOptions)


def sources_by_path(
    program: Program,
    setup: Setup,
    path: Path,
    options: Mapping[str, str],
    *,
    folder: bool,
    option: str,
) -> dict[Path, bytes]:
    """A program's new files by where they go.

    Args:
        program: as it is to be driven.
        setup: the robot.
        path: a folder, or a file's name.
        options: of the writer.
        folder: which of them.
        option: that names the path, for messages.

    Raises:
        InputError: the program takes several files, and the name says of none of them.
    """
    sources = setup.vendor.write(program, setup.robot, options)
    if folder:
        return _encoded({path / name: text for name, text in sources.items()})
    if len(sources) == 1:
        return _encoded({path: next(iter(sources.values()))})
    # Files that belong together are called alike, and often named inside as well.
    sources = setup.vendor.write(replace(program, name=path.stem), setup.robot, options)
    suffixes = [Path(name).suffix for name in sources]
    if path.suffix.lower() not in map(str.lower, suffixes):
        raise InputError(
            f"{option} {path}: the program takes several files; the name ends in "
            f"{' or '.join(suffixes)}, or is a folder that exists"
        )
    return _encoded({path.with_suffix(Path(name).suffix): text for name, text in sources.items()})


def _encoded(texts: Mapping[Path, str]) -> dict[Path, bytes]:
    return {path: text.encode() for path, text in texts.items()}


def texts_as_files(sources: Sources) -> dict[str, bytes]:
    """Texts of source files as the files of a result."""
    return {name: text.encode() for name, text in sources.items()}


def _read(what: object) -> list[Path]:
    """The files that a program, or a result's program, was read from: they are not written to."""
    from ..core.program.program import Program
    from ..core.source.reading import Reading

    program = what if isinstance(what, Program) else getattr(what, "original", None)
    reading = getattr(program, "reading", None)
    return [Path(name) for name in reading.files] if isinstance(reading, Reading) else []


@dataclass(frozen=True, kw_only=True)
class PatchOptions(TaskOptions):
    """How the user's own files are changed."""

    out: str | Path | None = value(
        None, "Folder to write the files to, with all that they run with.", kind=Path
    )
    own: bool = switch("Moves get data of their own where the text has no place for a change.")
    in_place: bool = switch("Change the program's own files.")
    force: bool = switch("Replace output files.")


def patch_with(program: Program, options: PatchOptions) -> tuple[Path, ...]:
    """Write the user's own files with the targets, zones and speeds that a program has now.

    Every other byte stays. The files are read again first: they give the changed program, or
    nothing is written.

    Args:
        program: as `flyby.read` gave it, then changed.

    Returns:
        The files.

    Raises:
        InputError: no place is named, or two are, or a file must not be written.
        FlybyError: a change has no place in the text.
    """
    program, setup = with_setup(program, RobotOptions())
    places = FilePlaces(
        None if options.out is None else Path(options.out),
        options.in_place,
        _read(program),
        options.force,
    )
    places.check()
    if not places.anywhere:
        raise InputError(
            f"where do the files go? Name a folder by {spelt('out')}, or give "
            f"{switched('in_place')}"
        )
    from ..core.source.patch.edits import reading_of

    files = setup.vendor.patch(program, setup.robot, OWN if options.own else {})
    if options.out is None and not files:
        return ()
    return tuple(places.write(files, reading_of(program).again({})))


patch = by_keywords(patch_with, PatchOptions)
