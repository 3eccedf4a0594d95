"""Program → a RAPID module that a controller loads: data in, text out."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from ....core.errors import InputError, MotionError
from ....core.program.move import Move, MoveC, Opaque, Wait
from ....core.program.program import Program
from ....core.source.text.files import lines_of
from ....core.source.text.names import Names
from ....core.source.write.options import OpaqueStyle
from .arc_limits import check_arc
from .events import Events
from .formatting import NAME_RULES
from .instructions import Line, WrittenSettings, move_line
from .numbers import number
from .operands import Operands
from .options import RapidOptions, ZoneStyle

ENTRY = "main"
SUFFIX = ".mod"
_STEP = "  "


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What stands in a module beside the program itself; lines without their indentation.

    Args:
        header: comments at the head.
        data: declarations.
        before, after: instructions of the entry routine, before and after the program's.
        routines: further routines.
        names: that these lines declare, and the program's data must not have.
    """

    header: tuple[str, ...] = ()
    data: tuple[str, ...] = ()
    before: tuple[str, ...] = ()
    after: tuple[str, ...] = ()
    routines: tuple[str, ...] = ()
    names: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class RapidWriter:
    """Writes a program as the one file of its module.

    Args:
        options: how.
    """

    options: RapidOptions = field(default_factory=RapidOptions)

    def write(self, program: Program) -> Mapping[str, str]:
        """The module's text by its file name; see `write`."""
        return {module_name(program) + SUFFIX: write(program, self.options)}


def write(program: Program, options: RapidOptions, around: Surroundings = Surroundings()) -> str:
    """The text of a complete module; lines end with LF.

    Names from the source are kept where they are legal and unique. Numbers are those that the
    controller's single precision holds: reading the text gives the program but for that rounding,
    and writing what was read gives the same text. ``Program.start`` has no place in RAPID: the
    robot starts from where it stands.

    Args:
        program: what to say.
        options: how.
        around: what else the module holds.

    Raises:
        MotionError: RAPID cannot say a move; it is named by number.
    """
    operands = Operands(options)
    lines = _body(program, operands, options)
    module = module_name(program)
    names = operands.declarations.names(Names(NAME_RULES, [module, ENTRY, *around.names]))
    texts = ["".join(p if isinstance(p, str) else names[p] for p in line) for line in lines]
    main = [*around.before, *texts, *around.after]
    return "\n".join(
        [
            f"MODULE {module}",
            *_indented([*_header(options), *around.header]),
            *_indented([*around.data, *operands.declarations.lines(names)]),
            "",
            *_indented([f"PROC {ENTRY}()", *_indented(main), "ENDPROC"]),
            *_indented(around.routines),
            "ENDMODULE",
            "",
        ]
    )


def module_name(program: Program) -> str:
    """The program's name, or one near to it that RAPID takes for a module beside ``main``."""
    if program.name.casefold() == ENTRY:
        return "MainModule"
    return Names(NAME_RULES, [ENTRY]).claim(program.name, "Module")


def _header(options: RapidOptions) -> list[str]:
    lines = ["! Written by flyby."]
    if options.zones is ZoneStyle.PREDEFINED:
        lines.append("! Zones are the largest predefined ones within the program's own radii.")
    return lines


def _body(program: Program, operands: Operands, options: RapidOptions) -> list[Line]:
    """The instructions of the entry routine."""
    settings = WrittenSettings()
    events = Events(operands, options.opaque)
    lines: list[Line] = []
    moves: list[Move] = []
    for statement in program.statements:
        if isinstance(statement, Wait):
            lines.append(_wait(statement))
        elif isinstance(statement, Opaque):
            lines += _opaque(statement, options.opaque)
        else:
            lines += _move(statement, moves, settings, events, operands)
            moves.append(statement)
    return lines


def _wait(wait: Wait) -> Line:
    """``WaitTime Time`` in s (WaitTime)."""
    return (f"WaitTime {number(wait.duration)};",)


def _opaque(statement: Opaque, style: OpaqueStyle) -> list[Line]:
    """The statement, or a comment and what is left of it: the stop.

    ``WaitRob \\InPos`` waits until the robot stands at the point before (WaitRob).
    """
    text = "\n".join(lines_of(statement.text))
    if style is OpaqueStyle.KEEP:
        return [(text,)]
    comment = textwrap.indent(text, "! ", lambda line: True)
    return [(comment,), *([("WaitRob \\InPos;",)] if statement.stops else [])]


def _move(
    move: Move, before: list[Move], settings: WrittenSettings, events: Events, operands: Operands
) -> list[Line]:
    """The move, with the settings that must change before it."""
    try:
        if isinstance(move, MoveC):
            check_arc(before[-1] if before else None, move)
        said = events.of(move)
        changes = settings.changes(move, operands)
        return [*changes, *said.before, move_line(move, said, operands)]
    except InputError as error:
        span = move.origin.statement if move.origin is not None else None
        raise MotionError(str(error), len(before), span) from None


def _indented(lines: Iterable[str]) -> list[str]:
    # Only the first line of an opaque statement moves: the rest is the user's.
    return [_STEP + line if line else line for line in lines]
