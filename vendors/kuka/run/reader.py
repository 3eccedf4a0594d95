"""KRL source → `Program`.

The text is parsed (`parser`) and executed (`interpreter`) from the entry routine on, as far as its
course follows from the text itself. What is decided here, and where a controller may differ:

- The entry is the ``DEF`` that is called like its file, which a controller selects; else the only
  one that moves the robot and that no other calls. If it takes arguments, they have no values, as
  on a controller that is sent there by hand.
- Branches and loops that only the running controller decides, and loops that nothing in the program
  ends, follow the rules of `core.source.execution.control_flow.flow`. Clocks and inputs are not
  known even after they were set.
- Of a ``SWITCH`` with cases that nobody knows, a known one that fits is taken.
- ``BAS(…)``, the functions of inline forms and the folds' data are carried out natively
  (`basis`, `inline`). Initialisations of technology packages, I/O and messages stay as opaque
  statements (`instructions`). The call of a routine that is in no file at hand is refused, as it
  might move the robot.
- Reading an input, a clock or the robot's position, setting an output and ``WAIT`` stop the
  advance run, and so the robot, unless ``CONTINUE`` stands before them.
- INT has 32 bits, REAL double precision; ``AND`` and ``OR`` evaluate both operands.
- ``LIN_REL`` and ``PTP_REL`` go on from the last target; A, B and C turn about the axes of the
  base, with ``#TOOL`` about those of the tool.
- Interrupts are kept and do not run.

Ownership of a move's numbers: see `core.source.provenance`. Numbers of an origin stand in this
order: position X…C, S, T, E1…E6; axis values A1…A6, E1…E6; speed of PTP ``$VEL_AXIS[1…6]``,
``$ACC_AXIS[1…6]``; of LIN and CIRC ``$VEL.CP ORI1 ORI2``, ``$ACC.CP ORI1 ORI2``; zone the one
component of ``$APO`` that counts.
"""

from __future__ import annotations

import re

from ....core.errors import EntryError, Note, SourceError, Span, UnknownNameError
from ....core.program.entry_point import ALL, entry_call, listed, without_caller
from ....core.program.program import Program
from ....core.source.collection import collection_paused
from ....core.source.reading import Files, ReadOptions
from ....core.source.text.damage import nothing_driven
from ....core.source.text.files import SourceText
from ..syntax.parser import parse
from ..syntax.tree import Expression, Invoke, Routine
from ..values.library import Library, suffix_of
from .interpreter import Interpreter
from .suffixes import COMPANIONS

_VKRC = re.compile(r"(?im)^&PARAM[ \t]+TPVW_VERSION|^[^\r\n]*;[^\r\n]*%MKUKATPVW\b")
"""In the head of a program, or at its inline forms."""


def read_sources(files: Files, main: str, options: ReadOptions) -> Program:
    """The program that the main file's entry drives. No file is opened.

    Args:
        files: source files by name.
        main: name of the one with the entry.
        options: entry, robot, answers, limits.

    Raises:
        SourceError: with line and column: the text is no KRL, or its motion cannot be known.
    """
    start = Span(main, 1, 1, 0, 0)
    if suffix_of(main) == ".dat":
        raise SourceError(COMPANIONS[".dat"], start)
    with collection_paused():
        library = Library(files, main, options.answers.mends)
        name, given = entry_call(options.entry)
        if name == ALL and ALL not in library.main.routines:
            points = Interpreter(library, options).entry_points(library.main_unit.routines)
            return Program((), library.main.stem, entries=points)
        run = Interpreter(library, options)
        try:
            entry, notes = _entry(library, run, name, start, given is not None)
        except UnknownNameError as error:
            points = run.entry_points(library.main_unit.routines)
            raise SourceError(
                f"there is no DEF '{error.name}': choose as the entry one of {listed(points)}; all "
                "drives each of them",
                start,
            ) from None
        arguments = _arguments(library, entry, given)
        try:
            run.run(entry, arguments)
        except RecursionError:
            raise SourceError(
                "expressions, blocks and calls are nested too deeply", entry.span
            ) from None
        nothing_driven(library.damages, run.driven)
        program = Program(
            run.statements(),
            entry.text,
            notes=(*notes, *_of_vkrc(files, start), *run.notes()),
            questions=run.course.questions(),
            entries=() if run.driven else run.entry_points(library.main_unit.routines, entry),
            calls=run.calls(),
            cycle=run.course.cycle,
            sections=run.course.sections.found(run.course.cycle),
        )
        run.forget()
        return program


def _of_vkrc(files: Files, start: Span) -> tuple[Note, ...]:
    """What is said of programs of Volkswagen's controllers."""
    if not any(_VKRC.search(file.text) for file in files.values()):
        return ()
    message = (
        "this is a program of a VKRC (VW System Software): what its inline forms say of speed "
        "and approximation (VB, VE, ACC, Genau) is set by Volkswagen's own routines, which are "
        "not carried out; the times are not those of the robot"
    )
    return (Note(message, span=start),)


def _arguments(library: Library, entry: Routine, text: str | None) -> tuple[Expression | None, ...]:
    """The arguments that a user gives to the entry.

    Raises:
        SourceError: they are no arguments in KRL.
    """
    if not text:
        return ()
    source = SourceText(f"DEF entry()\n{entry.text}({text})\nEND\n", "--entry")
    library.texts[source.file] = source.text
    found = parse(source).routines[0].body.statements
    if len(found) != 1 or not isinstance(found[0], Invoke):
        raise SourceError(f"'{text}' are no arguments", source.span(0, 0))
    return found[0].call.arguments


def _entry(
    library: Library, run: Interpreter, wanted: str | None, start: Span, given: bool
) -> tuple[Routine, tuple[Note, ...]]:
    """The routine to run.

    Raises:
        UnknownNameError: there is none of that name.
        EntryError: none is called like the file, and several may be meant.
        SourceError: the file holds no program.
    """
    routines = library.main_unit.routines
    if not routines:
        raise SourceError(
            "the file holds data (DEFDAT) and no DEF: read the .src that it belongs to", start
        )
    if wanted is not None:
        found = library.main.routines.get(wanted.lower())
        if found is None:
            raise UnknownNameError("entry (DEF)", wanted, [r.text for r in routines])
        return found, () if given else _open_arguments(found)
    named = library.main.routines.get(library.main.stem)
    if named is not None and named.returns is None:
        return named, _open_arguments(named)
    selectable = [r for r in routines if r.returns is None]
    if not selectable:
        raise SourceError(
            "the file holds functions (DEFFCT) and no DEF: read a program that calls them",
            routines[0].span,
        )
    if len(routines) == 1:
        return routines[0], _open_arguments(routines[0])
    roots = run.roots(selectable) or selectable[:1]
    roots = [r for r in roots if not r.parameters] or roots
    if len(roots) > 1:
        raise EntryError(
            "no DEF is called like the file, and none of those that move the robot calls the "
            f"others: choose as the entry one of {listed(run.entry_points(routines))}; all drives "
            "each of them",
            start,
        )
    (first,) = roots
    message = f"no DEF is called like the file; {first.text}, which no other calls, is read"
    return first, (Note(message, span=first.span), *_open_arguments(first))


def _open_arguments(entry: Routine) -> tuple[Note, ...]:
    """What is said of an entry that nobody calls with arguments."""
    if not entry.parameters:
        return ()
    names = (parameter.text for parameter in entry.parameters)
    return (Note(without_caller(entry.text, names), span=entry.span),)
