"""URScript source → `Program`.

The text is parsed (`statements`) and executed (`interpreter`) as far as its course follows from
the text itself; `core.source.answers` decides the rest. What is decided here, and where a
controller may differ:

- Statements outside of functions are executed in order. If they neither move the robot nor call a
  function, the file's one program is: the only ``def`` without required parameters that no other
  one calls, or the one named ``main`` or like the file.
- Branches and loops that cannot be decided: see `core.source.execution.control_flow.flow`.
- A loop that waits for what is not known is left at once and kept, and the robot stops there.
- Calls that leave the robot alone are kept as they stand. Threads: see `threads`. Functions that
  nobody declares are stepped over, with a note.
- Streams of positions, speeds and forces are kept: the robot is taken to stay where it is.
- A move whose target nobody knows is left out, with a note, and the next one is driven. What is
  added to a known target counts as nothing.
- Variables that the program does not declare (of the installation) are not known.
- ``movej`` with a pose, and ``get_inverse_kin`` without ``qnear`` or with the joints that the robot
  starts from, take the solution nearest to where the robot comes from.
- A time ``t`` above zero takes the place of ``a`` and ``v``.
- ``movep`` is a line; its blends are those of the motion model.
- Without ``set_tcp`` the flange is the TCP, with a note.
- ``/`` gives a float; ``and`` and ``or`` leave out what does not matter.

Order of `Origin.numbers`: a pose's six, or six joint values; with ``qnear`` six more. Speed: a, v,
t. Zone: r. What is not written is None; if nothing of a part is, its span is the empty place before
the closing bracket.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from ....core.errors import FlybyError, Note, SourceError
from ....core.program.entry_point import entry_call
from ....core.program.program import Program
from ....core.source.collection import collection_paused
from ....core.source.reading import Files, ReadOptions, read_with
from ....core.source.text.damage import Damage
from ....core.source.text.files import SourceFile
from ..syntax.statements import parse
from ..syntax.texts import Texts
from ..urp.changes.tree_file import TreeFile
from ..urp.script_in_place import script_of_nodes
from ..urp.source import named_error, named_nodes, source_of, source_of_text
from ..values.instructions import driven_by
from .analysis import ScriptTree
from .entry import run_program
from .interpreter import Interpreter
from .libraries import Libraries


def read(text: str, file: str, options: ReadOptions | None = None) -> Program:
    """The program in a text: a script, or the tree of a ``.urp`` as XML.

    Args:
        text: of one file.
        file: its name, for messages and spans.
        options: entry, robot, answers, limits.

    Raises:
        InputError: the tree is damaged.
        SourceError: with line and column: the text is no URScript, or its motion cannot be known.
    """
    source, notes = source_of_text(text, file)
    return _read_files({file: source}, file, options or ReadOptions(), notes)


def read_file(path: str | Path, options: ReadOptions | None = None) -> Program:
    """The program of a file; `ReadOptions.others` and libraries beside it are executed before it.

    A program's tree (``.urp``) is read as the script that PolyScope would make of it; spans count
    the lines of that script, and messages name the node. Where the tree holds no code of some
    nodes, and the script that PolyScope saved with it drives something else, that is read.

    Raises:
        InputError: a file cannot be read, or is damaged.
        SourceError: see `read`.
    """
    options = options or ReadOptions()
    others: dict[str, SourceFile] = {}
    notes: list[Note] = []
    for one in options.others:
        source, told = source_of(one, options.beside)
        others[source.name] = source
        notes += told
    main, told = source_of(Path(path), options.beside)
    script = script_of_nodes(main) if isinstance(main, TreeFile) else None

    def of(source: SourceFile, more: Iterable[Note]) -> Program:
        before, libraries = dict(others), Libraries(Path(path), options.beside)
        while True:
            files = {**before, source.name: source}
            program = _read_files(files, source.name, options, (*notes, *more))
            found = libraries.of(program, files)
            if not found:
                return replace(program, notes=(*libraries.doubts(), *program.notes))
            before = {**found, **before}
            more = (*more, *map(libraries.taken, found))

    if script is None:
        return of(main, told)
    return _fuller(lambda: of(main, told), lambda: of(script.file, (script.note,)))


def _fuller(read_tree: Callable[[], Program], read_script: Callable[[], Program]) -> Program:
    """A program by its tree, if the script that was saved with it drives the same; else by that.

    Raises:
        SourceError: neither can be read; of the tree.
    """
    program: Program | None = None
    failed: SourceError | None = None
    try:
        program = read_tree()
    except SourceError as error:
        failed = error
    with suppress(FlybyError):
        other = read_script()
        if program is None or _drives_else(program, other):
            return other
    if program is None:
        assert failed is not None
        raise failed
    return program


def _drives_else(one: Program, other: Program) -> bool:
    """Whether the moves are not as many, each of its kind; where to follows from the same state."""
    return list(map(type, one.moves)) != list(map(type, other.moves))


def _read_files(
    files: dict[str, SourceFile], main: str, options: ReadOptions, notes: Iterable[Note]
) -> Program:
    try:
        program = named_nodes(read_with(files, main, options, read_sources), files)
    except SourceError as error:
        raise named_error(error, files) from None
    return replace(program, notes=(*notes, *program.notes))


def read_sources(files: Files, main: str, options: ReadOptions) -> Program:
    """The program of files that were read; all but ``main`` are executed before it.

    Raises:
        SourceError: see `read`.
    """
    name, arguments = entry_call(options.entry)
    ordered = [*(f for name, f in files.items() if name != main), files[main]]
    if arguments:
        ordered.insert(0, SourceFile("--entry", f"{name}({arguments})\n"))
    texts = Texts(ordered, Damage() if options.answers.mends else None)
    try:
        with collection_paused():
            return _read(texts, main, replace(options, entry=name), bool(arguments))
    except RecursionError:
        raise SourceError(
            "expressions, blocks and calls are nested too deeply", texts.span(0, 0)
        ) from None


def _read(texts: Texts, main: str, options: ReadOptions, given: bool) -> Program:
    blocks = [parse(texts, which) for which in range(len(texts.sources))]
    call = blocks.pop(0) if given else ()
    run = Interpreter(texts, ScriptTree(blocks, driven_by(options.answers.streams)), options)
    return run_program(run, blocks, main, options.entry, call)
