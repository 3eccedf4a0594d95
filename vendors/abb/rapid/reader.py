"""RAPID source → `Program`.

The text is parsed (`parser`) and executed (`interpreter`) from the entry routine on, as far as its
course follows from the text itself. What is decided here, and where a controller may differ:

- A branch, a loop or a move that depends on what only the running controller knows (signals, the
  robot's position, clocks, an operator's answer) is refused by name. In a plain assignment such a
  value is carried along.
- ``WHILE TRUE`` without a way out is read for one pass; what stands behind it is never reached.
  Other loops may run, up to the limits in `interpreter`.
- Instructions that do not move the robot stay as opaque statements; ``WaitUntil``, ``WaitDI`` and
  their like are stops and taken as satisfied at once. Error handlers and traps do not run. An
  instruction that no table of `instructions` knows is refused, as it might move the robot.
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
from pathlib import Path

from ....core.errors import InputError, Note, SourceError, Span
from ....core.program.program import Program
from ....core.source.text import SourceText, decode
from .globals import Globals
from .interpreter import Interpreter
from .parser import parse
from .scope import unknown_name
from .syntax import Module, Routine

SUFFIXES = (".mod", ".modx", ".prg", ".sys", ".sysx")


def read(
    text: str | bytes,
    file: str,
    entry: str = "main",
    *,
    external_axes: Sequence[str] | None = None,
) -> Program:
    """The program that a routine drives.

    Args:
        text: of one file with one module or several.
        file: its name, for messages and spans. Spans count characters of the text without a
            byte-order mark.
        entry: procedure without parameters; if there is no ``main`` and only one procedure, that.
        external_axes: ``"linear"`` (mm) or ``"rotating"`` (degrees) for eax_a, eax_b, …; without
            it a target that uses an external axis is refused.

    Raises:
        SourceError: with line and column: the text is no RAPID, or its motion cannot be known.
    """
    decoded, _ = decode(text, file)
    source = SourceText(decoded, file)
    try:
        return _program(parse(source), source, entry, external_axes)
    except RecursionError:
        raise SourceError(
            "expressions, blocks and calls are nested too deeply", source.span(0, 0)
        ) from None


def read_file(
    path: str | Path, entry: str = "main", *, external_axes: Sequence[str] | None = None
) -> Program:
    """The program of a file; see `read`.

    Raises:
        InputError: the file cannot be read.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror or error}") from None
    return read(data, str(path), entry, external_axes=external_axes)


def _program(
    modules: tuple[Module, ...],
    source: SourceText,
    entry: str,
    external_axes: Sequence[str] | None,
) -> Program:
    data = Globals(modules)
    routine, notes = _entry(data, entry, source)
    module = next(m for m in modules if any(r is routine for r in m.routines))
    run = Interpreter(data, {source.file: source.text}, external_axes)
    run.run(routine)
    return Program(run.statements(), module.text, notes=(*notes, *run.notes()))


def _entry(data: Globals, entry: str, source: SourceText) -> tuple[Routine, tuple[Note, ...]]:
    callable_ = {
        name: routine
        for name, routine in data.procedures.items()
        if all(p.optional for p in routine.parameters)
    }
    chosen = callable_.get(entry.lower())
    if chosen is not None:
        return chosen, ()
    if entry.lower() == "main" and len(callable_) == 1:
        (only,) = callable_.values()
        message = f"there is no PROC main; the only procedure, {only.text}, is read"
        return only, (Note(message, span=only.span),)
    where = data.modules[0].span if data.modules else Span(source.file, 1, 1, 0, 0)
    if entry.lower() in data.procedures:
        raise SourceError(f"PROC {entry} takes arguments and cannot be the entry", where)
    if not callable_:
        raise SourceError("the module holds no procedure that could be run", where)
    names = [r.text for r in callable_.values()]
    message = unknown_name("procedure", entry, names).split(":")[0]
    raise SourceError(f"{message}: choose one of {', '.join(names)} as the entry", where)
