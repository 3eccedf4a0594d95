"""Programs and results as files: new ones, or the user's own with other numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from ..core.door import spelt, switched
from ..core.errors import FlybyError, InputError, OptionError
from ..core.files.reading import read_bytes
from ..core.source.text.files import LARGEST_FILE
from .files.not_executed import not_executed_notes, refuse_not_executed
from .files.outputs import check_outputs, write_all, write_in
from .files.places import FilePlaces
from .files.texts import OWN
from .options.entries import TaskOptions, choice, switch, value
from .options.keywords import by_keywords
from .setup import RobotOptions, Setup, with_setup
from .translate import written

if TYPE_CHECKING:
    from ..core.language import Sources
    from ..core.program.program import Program
    from ..core.source.reading import Files
    from ..core.translation.translate import Translation
    from ..core.vendor import Vendor
    from ..problems.improve.solution import Solution

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
        "Statements that do not move the robot are kept as they stand, or become comments; by "
        "default those do that cannot stand in the new program.",
        OPAQUE,
    )
    unproven: bool = switch("Write a result even if its clearance is not proven.")
    force: bool = switch("Replace output files.")


def write_with(
    what: Program | Translation | WithFiles, out: str | Path, options: WriteOptions
) -> tuple[Path, ...]:
    """Write a program as new files, or the files of a result.

    What is written has been read back: a program's text drives the moves that the program holds,
    and a solution's text is the one that its proof is of.

    Args:
        what: a program, written anew with all its moves in one routine, a translation, with the
            loops and routines that it keeps, or what another task has made: a `Solution`, a
            recording, an experiment, a painting.
        out: a folder, which is made if it is missing, or of a program the file's name, beside
            which further ones are put if the language takes several.

    Returns:
        The files.

    Raises:
        InputError: the result is not proven, or a file must not be written; then none is.
        FlybyError: the language cannot say what the program holds.
    """
    from ..core.program.program import Program
    from ..core.translation.translate import Translation

    out, inputs = Path(out), _read(what)
    chosen = {} if options.opaque is None else {"opaque": options.opaque}
    if isinstance(what, Translation):
        written(what)  # refuses what the new robot cannot drive
        chosen |= what.options
        what = what.program
    if not isinstance(what, Program):
        if not isinstance(what, WithFiles):
            raise InputError(
                f"expected a program or what a task has made of one, not {type(what).__name__}"
            )
        if getattr(what, "proven", True) is False and not options.unproven:
            raise InputError(
                f"it is not proven to keep its clearance: {switched('unproven')} writes it"
            )
        files = {Path(name): data for name, data in what.files.items()}
        return tuple(write_in(spelt("out"), out, files, inputs, options.force))
    program, setup = with_setup(what, options)
    folder = out.suffix.lower() not in setup.vendor.suffixes
    files = sources_by_path(program, setup, out, chosen, folder=folder, option=spelt("out"))
    made = out if folder else None
    check_outputs({spelt("out"): files}, inputs, options.force, made)
    write_all(spelt("out"), files, made)
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
    sources = _sources(program, setup, options)
    if folder:
        return _encoded({path / name: text for name, text in sources.items()})
    if len(sources) == 1:
        return _encoded({path: next(iter(sources.values()))})
    # Files that belong together are called alike, and often named inside as well.
    sources = _sources(replace(program, name=path.stem), setup, options)
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
    """The files that a program, or a result's programs, were read from, a program's main one first.

    They are not written to.
    """
    from ..core.source.reading import Reading

    given = getattr(what, "given", None)
    programs = what, *(getattr(what, name, None) for name in ("original", "program"))
    found: list[str] = []
    for program in (*programs, getattr(given, "program", None)):
        reading = getattr(program, "reading", None)
        if isinstance(reading, Reading):
            found += [reading.main, *reading.files]
    return [*map(Path, dict.fromkeys(found)), *getattr(what, "inputs", ())]


@dataclass(frozen=True, kw_only=True)
class PatchOptions(TaskOptions):
    """How the user's own files are changed."""

    out: str | Path | None = value(
        None, "Folder to write the files to, with all that they run with.", kind=Path
    )
    own: bool = switch("Moves get data of their own where the text has no place for a change.")
    in_place: bool = switch("Change the program's own files.")
    force: bool = switch("Replace output files.")


def patch_with(what: Program | Solution, options: PatchOptions) -> tuple[Path, ...]:
    """Write the user's own files with the targets, zones and speeds that a program has now.

    Every other byte stays. The files are read again first: they give the changed program, or
    nothing is written. In place, nothing is written either where code that was not executed uses
    what has changed.

    Args:
        what: a program as `flyby.read` gave it, then changed; or what an optimisation made of one,
            which is written with the text that its proof is of.

    Returns:
        The files; none where nothing has changed.

    Raises:
        InputError: no place is named, or two are, a file must not be written, or a solution is not
            proven, or its program cannot be in the place of the old one.
        FlybyError: a change has no place in the text.
    """
    from ..core.program.program import Program

    original: Any = what if isinstance(what, Program) else getattr(what, "original", what)
    original, setup = with_setup(original, RobotOptions())
    places = FilePlaces(
        None if options.out is None else Path(options.out),
        options.in_place,
        _read(original),
        options.force,
    )
    places.check()
    if not places.anywhere:
        raise OptionError(
            f"where do the files go? Name a folder by {spelt('out')}, or give "
            f"{switched('in_place')}"
        )
    if isinstance(what, Program):
        before, after, files = _changed(original, setup, options)
    else:
        before, after, files = what.original, what.program, _proven_texts(what, options)
    if options.in_place:
        refuse_not_executed(not_executed_notes(before, after, setup.vendor))
    if not files and options.out is None:
        return ()
    return tuple(places.write(files, replace(before, setup=setup)))  # that knows the backup


patch = by_keywords(patch_with, PatchOptions)


def _changed(
    program: Program, setup: Setup, options: PatchOptions
) -> tuple[Program, Program, Files]:
    """A program as its files give it, as they give it once changed, and the files that change."""
    from ..core.source.patch.edits import reading_of

    reading = reading_of(program)
    files = setup.vendor.patch(program, setup.robot, OWN if options.own else {})
    if options.in_place and not files:
        for name, file in reading.files.items():
            if Path(name).is_file() and read_bytes(name, LARGEST_FILE) != file.data:
                raise InputError(
                    f"{switched('in_place')}: {name} holds something else than what this program "
                    "was read from, such as a text that an optimisation has made: give its "
                    "solution, not the program alone"
                )
    return reading.again({}), reading.again(files), files


def _proven_texts(made: Solution, options: PatchOptions) -> Files:
    """The texts of a solution that may take the place of its files."""
    if not made.changed:
        return {}
    if options.own:
        raise InputError(
            f"{switched('own')} is of programs: a solution has the text that its proof is of"
        )
    if not made.proven:
        raise InputError(
            "it is not proven to keep its clearance: flyby.write with unproven=True writes it"
        )
    old, new = ([type(s) for s in p.statements] for p in (made.original, made.program))
    if old != new:
        raise InputError(
            "its moves are others: it was written anew, and flyby.write puts it into a folder"
        )
    return made.texts


def _sources(program: Program, setup: Setup, options: Mapping[str, str]) -> Sources:
    """A program's new files; unless the user says otherwise, what was kept and cannot stand in them
    becomes comments: what names data of the old files alone, or all of it if that does not do.

    Raises:
        InputError: a tool or work object of the program is not known.
        FlybyError: the language cannot say what the program holds.
    """
    from ..core.program.assumed_places import refuse_assumed

    refuse_assumed(program)
    vendor, robot = setup.vendor, setup.robot
    try:
        return vendor.write(program, robot, options)
    except FlybyError:
        if "opaque" in options or not _keeps(program):
            raise
    try:
        return vendor.write(_commented(program, vendor), robot, options)
    except FlybyError:
        return vendor.write(program, robot, {**options, "opaque": "comment"})


def _keeps(program: Program) -> bool:
    from ..core.program.move import Opaque

    return any(
        isinstance(statement, Opaque) or getattr(statement, "events", ())
        for statement in program.statements
    )


def _commented(program: Program, vendor: Vendor) -> Program:
    """A program whose kept statements are comments where they name data of its old files."""
    from ..core.program.move import Opaque
    from ..core.source.write.kept import without_their_names

    speaks = vendor.speaks
    if speaks is None or speaks.wording is None:
        return program
    named = {span for span, _ in without_their_names(program, {}, speaks.wording)}

    def commented(text: str) -> str:
        return "\n".join(f"{speaks.comment}{line.strip()}" for line in text.splitlines())

    return replace(
        program,
        statements=tuple(
            replace(s, text=commented(s.text)) if isinstance(s, Opaque) and s.span in named else s
            for s in program.statements
        ),
    )
