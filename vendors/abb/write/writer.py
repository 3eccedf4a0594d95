"""Program → a RAPID module that a controller loads: data in, text out."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from ....core.program.move import Move, MoveC, Opaque, Wait
from ....core.program.places import Destination
from ....core.program.program import Program
from ....core.source.text.files import lines_of
from ....core.source.text.names import Names
from ....core.source.write.options import OpaqueStyle, StructureStyle
from ....core.source.write.statements import lines_of_statements
from .arc_limits import check_arc
from .events import Events
from .formatting import NAME_RULES
from .instructions import Line, move_line
from .numbers import number
from .operands import Operands
from .options import RapidOptions, ZoneStyle
from .structure import Structure

ENTRY = "main"
SUFFIX = ".mod"
_STEP = "  "


@dataclass(frozen=True, slots=True)
class TextAround:
    """What stands in a module beside the program itself; lines without their indentation.

    Args:
        main: the instructions of the entry routine, of the program's own.
        names: that these lines declare, and the program's data must not have.
    """

    header: tuple[str, ...] = ()
    data: tuple[str, ...] = ()
    main: Callable[[list[str]], list[str]] = list
    routines: tuple[str, ...] = ()
    names: tuple[str, ...] = ()


def write(program: Program, options: RapidOptions, around: TextAround = TextAround()) -> str:
    """The text of a complete module; lines end with LF.

    Names from the source are kept where they are legal and unique. Numbers are those that the
    controller's single precision holds: reading the text gives the program but for that rounding,
    and writing what was read gives the same text. ``Program.start`` has no place in RAPID: the
    robot starts from where it stands.

    Raises:
        MotionError: RAPID cannot say a move; it is named by number.
    """
    operands = Operands(options)
    module = module_name(program)
    taken = [module, ENTRY, *around.names]
    structure = Structure(operands, *taken)
    lines = _body(program, operands, options, structure)
    names = operands.declarations.names(Names(NAME_RULES, [*taken, *structure.taken]))

    def texts(lines: list[Line]) -> list[str]:
        return ["".join(p if isinstance(p, str) else names[p] for p in line) for line in lines]

    main = around.main(texts(lines))
    routines = [
        line
        for name, body in structure.routines.items()
        for line in ("", structure.head(name), *_indented(texts(body)), "ENDPROC")
    ]
    return "\n".join(
        [
            f"MODULE {module}",
            *_indented([*_header(options), *around.header]),
            *_indented([*around.data, *operands.declarations.lines(names)]),
            "",
            *_indented([f"PROC {ENTRY}()", *_indented(main), "ENDPROC"]),
            *_indented([*routines, *around.routines]),
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


def _body(
    program: Program, operands: Operands, options: RapidOptions, structure: Structure
) -> list[Line]:
    """The instructions of the entry routine; those of others are the structure's."""
    events = Events(operands, options.opaque)
    moves = program.moves

    def wait(statement: Wait) -> list[Line]:
        """``WaitTime Time`` in s (WaitTime)."""
        return [(f"WaitTime {number(statement.duration)};",)]

    def move(statement: Move, index: int, places: tuple[Destination, ...]) -> list[Line]:
        if isinstance(statement, MoveC):
            check_arc(moves[index - 1] if index else None, statement)
        said = events.of(statement)
        changes = structure.held.changes(statement, operands)
        moved = not all(place.fixed for place in places)
        points = [structure.placed(place) for place in places] if moved else []
        return [*changes, *said.before, move_line(statement, said, operands, points)]

    kept = structure if options.structure is StructureStyle.KEEP else None
    return lines_of_statements(program, wait, lambda o: _opaque(o, options.opaque), move, kept)


def _opaque(statement: Opaque, style: OpaqueStyle) -> list[Line]:
    """The statement, or a comment and what is left of it: the stop.

    ``WaitRob \\InPos`` waits until the robot stands at the point before (WaitRob).
    """
    text = "\n".join(lines_of(statement.text))
    if style is OpaqueStyle.KEEP:
        return [(text,)]
    comment = textwrap.indent(text, "! ", lambda line: True)
    return [(comment,), *([("WaitRob \\InPos;",)] if statement.stops else [])]


def _indented(lines: Iterable[str]) -> list[str]:
    # Only the first line of an opaque statement moves: the rest is the user's.
    return [_STEP + line if line else line for line in lines]
