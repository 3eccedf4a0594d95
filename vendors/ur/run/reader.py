"""URScript source → `Program`.

The text is parsed (`statements`) and executed (`interpreter`) as far as its course follows from
the text itself; `core.source.answers` decides the rest. What is decided here, and where a
controller may differ:

- Statements outside of functions are executed in order. If they neither move the robot nor call a
  function, the file's one program is: the only ``def`` without required parameters that no other
  one calls, or the one named ``main`` or like the file.
- Branches and loops that cannot be decided: see `core.source.execution.flow`.
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

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ....core.errors import Note, SourceError
from ....core.program.entry_point import entry_call
from ....core.source.collection import collection_paused
from ....core.source.reading import Files, ReadOptions, read_with
from ....core.source.text.files import SourceFile
from ..syntax.statements import parse
from ..syntax.texts import Texts
from ..urp.source import named_error, named_nodes, source_of, source_of_text
from .analysis import ScriptTree
from .entry import run_program
from .interpreter import Interpreter

if TYPE_CHECKING:
    from ....core.program.program import Program


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
    """The program of a file; `ReadOptions.others` are executed before it.

    A program's tree (``.urp``) is read as the script that PolyScope would make of it; spans count
    the lines of that script, and messages name the node.

    Raises:
        InputError: a file cannot be read, or is damaged.
        SourceError: see `read`.
    """
    options = options or ReadOptions()
    files: dict[str, SourceFile] = {}
    notes: list[Note] = []
    for one in (*options.others, Path(path)):
        source, told = source_of(one, options.beside)
        files[source.name] = source
        notes += told
    return _read_files(files, str(path), options, notes)


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
    texts = Texts(ordered)
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
    run = Interpreter(texts, ScriptTree(blocks), options)
    return run_program(run, blocks, main, options.entry, call)
