"""Program → a URScript that a controller runs: data in, text out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ....core.errors import InputError
from ....core.language import Sources
from ....core.program.move import Move, Opaque, Wait
from ....core.program.places import Destination
from ....core.program.program import Program
from ....core.robot.model import Robot
from ....core.source.text.files import lines_of
from ....core.source.text.names import Names
from ....core.source.write.options import OpaqueStyle, StructureStyle, as_comments, chosen
from ....core.source.write.statements import lines_of_statements
from ..syntax.names import NAME_RULES
from .declarations import Line
from .formatting import comment, number
from .instructions import Phrases
from .options import ScriptOptions
from .structure import Structure

SUFFIX = ".script"
_STEP = "  "


def write(program: Program, robot: Robot, options: Mapping[str, str]) -> Sources:
    """The one file of a program: ``def name(): … end``; lines end with LF, all is ASCII.

    Targets are written in the robot's base, whatever work object they had; numbers are the
    shortest decimals that are the program's own doubles. Names from the source are kept where
    they are legal and unique. ``Program.start`` has no place in URScript: the robot starts from
    where it stands.

    Raises:
        InputError: URScript does not drive the robot, or an option is unknown.
        MotionError: URScript cannot say a move; it is named by number.
    """
    script = body(program, robot, chosen(ScriptOptions, options, "URScript writer"))
    return {script.name + SUFFIX: script.text()}


@dataclass(frozen=True, slots=True)
class Script:
    """The parts of a script before they become one text."""

    name: str
    declarations: list[str]
    statements: list[str]

    def text(self) -> str:
        """The whole text."""
        lines = [
            "# Written by flyby.",
            f"def {self.name}():",
            *indented([*self.declarations, *self.statements]),
            "end",
            "",
        ]
        return "\n".join(lines)


def body(program: Program, robot: Robot, options: ScriptOptions, *taken: str) -> Script:
    """The script of a program.

    Args:
        robot: in whose base poses are given.
        taken: names that the program's data may not have.

    Raises:
        InputError, MotionError: as `write`.
    """
    phrases = Phrases(robot, program, options.shares)
    names = Names(NAME_RULES, taken)
    name = names.claim(program.name, "program")
    structure = Structure(names, phrases)
    lines = _lines(program, phrases, options, structure)
    given = phrases.declarations.names(Names(NAME_RULES, [*taken, name, *structure.taken]))

    def texts(lines: list[Line]) -> list[str]:
        return ["".join(p if isinstance(p, str) else given[p] for p in line) for line in lines]

    functions = [
        line
        for called, body in structure.routines.items()
        for line in (structure.head(called), *indented(texts(body)), "end")
    ]
    declared = phrases.declarations.lines(given)
    return Script(name, [*declared, *functions], texts(lines))


def _lines(
    program: Program, phrases: Phrases, options: ScriptOptions, structure: Structure
) -> list[Line]:
    style = options.opaque

    def wait(statement: Wait) -> list[Line]:
        return [(f"sleep({number(statement.duration)})",)]

    def move(statement: Move, index: int, places: tuple[Destination, ...]) -> list[Line]:
        before = [*_events(statement, style), *structure.held.changes(statement)]
        moved = not all(place.fixed for place in places)
        frame = statement.work_object
        points = [structure.placed(place, frame) for place in places] if moved else []
        return [*((line,) for line in before), phrases.move(statement, points)]

    kept = structure if options.structure is StructureStyle.KEEP else None
    return lines_of_statements(program, wait, lambda o: _opaque(o, style), move, kept)


def _opaque(statement: Opaque, style: OpaqueStyle) -> list[Line]:
    if style is OpaqueStyle.COMMENT:
        return [(line,) for line in comment(statement.text)]
    return [("\n".join(lines_of(statement.text)),)]


def _events(move: Move, style: OpaqueStyle) -> list[str]:
    """What happens along a move: URScript has no words for it."""
    if move.events and style is OpaqueStyle.KEEP:
        raise InputError(
            f"URScript has no actions along a move ({move.events[0].text!r}): take them away, or "
            f"make them comments ({as_comments()})"
        )
    return [line for event in move.events for line in comment(f"on the way: {event.text}")]


def indented(lines: list[str]) -> list[str]:
    """Lines inside the function."""
    # Only the first line of a statement of several lines moves: the rest is the user's.
    return [_STEP + line for line in lines]
