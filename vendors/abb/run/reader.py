"""RAPID source → `Program`.

The text is parsed (`syntax.parser`) and executed (`interpreter`) from the entry routine on, as far
as its course follows from the text itself. What is decided here, and where a controller may differ:

- What only the running controller knows (signals, clocks, an operator's answer) is carried along; a
  move that depends on it is driven with its default (`values.defaults`), or left out where its
  target has none. Branches and loops are decided by the rules of
  `core.source.execution.control_flow.flow`.
- Instructions that do not move the robot stay as opaque statements; ``WaitUntil``, ``WaitDI`` and
  their like are stops and taken as satisfied at once. ERROR handlers run for errors that the
  program makes itself (`recovery`); traps do not run. A routine of which nobody has the text is
  stepped over.
- ``AccSet`` scales the joints' accelerations and, by its ramp, the jerk. ``VelSet`` scales the
  programmed speeds and the times of ``\\T``, not the joints' own limits. ``PathAccLim`` with two
  limits takes the smaller one.
- ``\\TLoad`` takes the place of the tool's own load and of the payload.
- A robtarget's configuration counts unless ``ConfJ\\Off`` (joint moves) or ``ConfL\\Off`` holds.
- External axes have no kind in RAPID: a target that uses one needs ``external_axes``.
- A program displacement is worked into the targets, which are then derived.
- ``num`` has double precision; ``AND`` and ``OR`` evaluate all their operands.

Ownership of a move's numbers: see `provenance`. A number given in ``\\V``, ``\\T`` or ``\\Z`` is
the only one of its speed or zone, and belongs to the move.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from ....core.errors import SourceError
from ....core.program.entry_point import ALL, entry_call
from ....core.program.program import Program
from ....core.source.collection import collection_paused
from ....core.source.reading import Files, ReadOptions, read_with
from ....core.source.text.damage import Damage, nothing_driven
from ....core.source.text.files import SourceFile, SourceText, decode
from ..motion.external_axes import axis_kinds
from ..syntax.parser import parse
from ..syntax.tree import Argument, Module
from ..values.data import Globals
from ..values.library import Library
from .entry import choose_entry, entry_arguments, entry_points
from .files import MODULES, PROGRAM, beside, collect, loaded
from .interpreter import Interpreter
from .unreached import passed_by

SUFFIXES = (*MODULES, PROGRAM)

DEFAULTS = ReadOptions()


def read(
    text: str | bytes,
    file: str,
    options: ReadOptions = DEFAULTS,
    *,
    external_axes: Sequence[str] | None = None,
) -> Program:
    """The program in a text of one module or several; see `read_sources`.

    Args:
        text: of the file. Spans count characters of the text without a byte-order mark.
        file: its name, for messages and spans.
        options: see `ReadOptions`.
        external_axes: see `read_sources`.

    Raises:
        SourceError: with line and column: the text is no RAPID, or its motion cannot be known.
    """
    source = SourceFile(file, *decode(text, file))
    return read_with(
        {file: source}, file, options, partial(read_sources, external_axes=external_axes)
    )


def read_file(
    path: str | Path,
    options: ReadOptions = DEFAULTS,
    *,
    external_axes: Sequence[str] | None = None,
) -> Program:
    """The program of a file and of what belongs to it (`files`); see `read_sources`.

    Raises:
        InputError: a file cannot be read.
        SourceError: as `read`.
    """
    files = collect(Path(path), options)
    return read_with(files, str(path), options, partial(read_sources, external_axes=external_axes))


def read_sources(
    files: Files,
    main: str,
    options: ReadOptions,
    *,
    external_axes: Sequence[str] | None = None,
) -> Program:
    """The program that the entry routine of ``main`` drives; no file is opened.

    Args:
        files: by name: the program's, the others that the user named, and those beside it.
        main: a module or a list of modules (``.pgf``).
        options: entry (None for ``main``), robot, answers, limits.
        external_axes: ``"linear"`` (mm) or ``"rotating"`` (degrees) for eax_a, eax_b, …; those of
            the robot if it is given. Without either a target that uses one is refused.

    Raises:
        InputError: a list names a module that is not there.
        SourceError: with line and column: a text is no RAPID, or its motion cannot be known.
    """
    names = loaded(files, main, options)
    try:
        with collection_paused():
            return _program(files, main, names, options, external_axes)
    except RecursionError:
        where = SourceText(files[main].text, main).span(0, 0)
        message = "expressions, blocks and calls are nested too deeply"
        raise SourceError(message, where) from None


def _program(
    files: Files,
    main: str,
    names: Sequence[str],
    options: ReadOptions,
    external_axes: Sequence[str] | None,
) -> Program:
    mended = options.answers.mends
    damages = {name: Damage() for name in names} if mended else {}
    parsed = {name: parse(SourceText(files[name].text, name, damages.get(name))) for name in names}
    data = Globals(
        [module for modules in parsed.values() for module in modules],
        Library(beside(files, main, names), loaded=options.beside is not None, mended=mended),
        mended=mended,
    )
    own: list[Module] = [m for n in names if n == main or main not in parsed for m in parsed[n]]
    name, given = entry_call(options.entry)
    if name == ALL and data.routines.get(ALL) is None:
        return Program((), own[0].text, entries=entry_points(data, own))
    entry, notes = choose_entry(data, own, name, main, given is not None, options.answers.goes_on)
    texts = {name: file.text for name, file in files.items()}
    arguments: tuple[Argument, ...] | None = None
    if given is not None:
        source, arguments = entry_arguments(entry.text, given)
        texts[source.file] = source.text
    run = Interpreter(data, texts, options, external_axes or axis_kinds(options.robot))
    run.run(entry, arguments)
    if run.left_out is not None and not run.out.move_index:
        raise SourceError(f"no move can be driven: {run.left_out.message}", run.left_out.span)
    driven = run.out.move_index > 0
    nothing_driven([*damages.values()], driven)
    spans = [part.statement for part in run.out.parts] if options.answers.goes_on else []
    missed = passed_by(data, entry, run.ran, spans)
    torn = (note for damage in damages.values() for note in damage.notes())
    return Program(
        run.statements(),
        data.module_of(entry).text,
        notes=(*notes, *torn, *run.notes(), *([] if missed is None else [missed])),
        questions=run.course.questions(),
        entries=() if driven else entry_points(data, own, entry),
        calls=tuple(run.out.calls),
        cycle=run.course.cycle,
        sections=run.course.sections.found(run.course.cycle),
    )
