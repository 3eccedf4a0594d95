"""Program → a RAPID module that a controller loads: data in, text out."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from ....core.errors import InputError, MotionError
from ....core.program.move import Move, MoveC, Opaque, Wait
from ....core.program.program import Program
from .arcs import check_arc
from .formatting import Names
from .numbers import number
from .operands import Operands
from .options import OpaqueStyle, RapidOptions, ZoneStyle
from .phrases import Line, Settings, move_line

ENTRY = "main"
SUFFIX = ".mod"
_STEP = "  "


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


def write(program: Program, options: RapidOptions) -> str:
    """The text of a complete module; lines end with LF.

    Names from the source are kept where they are legal and unique. Numbers are those that the
    controller's single precision holds: reading the text gives the program but for that rounding,
    and writing what was read gives the same text. ``Program.start`` has no place in RAPID: the
    robot starts from where it stands.

    Raises:
        MotionError: RAPID cannot say a move; it is named by number.
    """
    operands = Operands(options)
    lines = _body(program, operands, options)
    module = module_name(program)
    names = operands.declarations.names(Names(module, ENTRY))
    texts = ["".join(p if isinstance(p, str) else names[p] for p in line) for line in lines]
    return "\n".join(
        [
            f"MODULE {module}",
            *_indented(_header(options)),
            *_indented(operands.declarations.lines(names)),
            "",
            *_indented([f"PROC {ENTRY}()", *_indented(texts), "ENDPROC"]),
            "ENDMODULE",
            "",
        ]
    )


def module_name(program: Program) -> str:
    """The program's name, or one near to it that RAPID takes for a module beside ``main``."""
    if program.name.casefold() == ENTRY:
        return "MainModule"
    return Names(ENTRY).claim(program.name, "Module")


def _header(options: RapidOptions) -> list[str]:
    lines = ["! Written by flyby."]
    if options.zones is ZoneStyle.PREDEFINED:
        lines.append("! Zones are the largest predefined ones within the program's own radii.")
    return lines


def _body(program: Program, operands: Operands, options: RapidOptions) -> list[Line]:
    """The instructions of the entry routine."""
    settings = Settings()
    lines: list[Line] = []
    moves: list[Move] = []
    for statement in program.statements:
        if isinstance(statement, Wait):
            lines.append(_wait(statement))
        elif isinstance(statement, Opaque):
            lines.append((_opaque(statement, options.opaque),))
        else:
            lines += _move(statement, moves, settings, operands)
            moves.append(statement)
    return lines


def _wait(wait: Wait) -> Line:
    """``WaitTime Time`` in s (WaitTime)."""
    return (f"WaitTime {number(wait.duration)};",)


def _opaque(statement: Opaque, style: OpaqueStyle) -> str:
    text = "\n".join(statement.text.splitlines())
    if style is OpaqueStyle.KEEP:
        return text
    return textwrap.indent(text, "! ", lambda line: True)


def _move(move: Move, before: list[Move], settings: Settings, operands: Operands) -> list[Line]:
    """The move, with the settings that must change before it."""
    try:
        if isinstance(move, MoveC):
            check_arc(before[-1] if before else None, move)
        return [*settings.changes(move, operands), move_line(move, operands)]
    except InputError as error:
        span = move.origin.statement if move.origin is not None else None
        raise MotionError(str(error), len(before), span) from None


def _indented(lines: Iterable[str]) -> list[str]:
    # Only the first line of an opaque statement moves: the rest is the user's.
    return [_STEP + line for line in lines]
