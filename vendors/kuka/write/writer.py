"""Program → the ``.src`` and ``.dat`` that a KUKA controller loads: data in, text out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from ....core.errors import InputError
from ....core.program.event import Event
from ....core.program.move import Move, MoveJ
from ....core.program.places import Destination
from ....core.program.program import Program
from ....core.program.target import JointTarget, PoseTarget
from ....core.robot.model import Robot
from ....core.source.text.files import lines_of
from ....core.source.text.names import Names
from ....core.source.write.declarations import NewDatum
from ....core.source.write.options import OpaqueStyle, StructureStyle, chosen
from ....core.source.write.statements import lines_of_statements
from ..motion.configuration import KukaConfiguration, label
from ..syntax.names import NAME_RULES
from .declarations import DataList
from .formatting import ARM_AXES
from .instructions import Line, Phrases, stated_positions, trigger
from .numbers import number
from .options import KrlOptions
from .speeds import check_external
from .structure import Structure

HEADER = ("&ACCESS RVP", "&REL 1")
INI = (
    ";FOLD INI",
    "  ;FOLD BASISTECH INI",
    "    BAS (#INITMOV,0 )",
    "  ;ENDFOLD (BASISTECH INI)",
    "  ;FOLD USER INI",
    "    ;Make your modifications here",
    "  ;ENDFOLD (USER INI)",
    ";ENDFOLD (INI)",
)
EXTERNALS = (
    ";FOLD EXTERNAL DECLARATIONS",
    "  ;FOLD BASISTECH EXT",
    "    EXT BAS (BAS_COMMAND :IN,REAL :IN )",
    "    DECL INT SUCCESS",
    "  ;ENDFOLD (BASISTECH EXT)",
    "  ;FOLD USER EXT",
    "    ;Make your modifications here",
    "  ;ENDFOLD (USER EXT)",
    ";ENDFOLD (EXTERNAL DECLARATIONS)",
)


@dataclass(frozen=True, slots=True)
class TextAround:
    """What stands round the statements of a program.

    Args:
        main: the lines of the program's own routine, of its statements.
    """

    header: Sequence[str] = ()
    main: Callable[[list[str]], list[str]] = list


def write(program: Program, robot: Robot, options: Mapping[str, str]) -> dict[str, str]:
    """The texts of the ``.src`` and its ``.dat``, by file name; lines end with LF.

    Names from the source are kept where they are legal and free. Tools, bases and loads are
    declared in the ``.dat``, whatever numbers they have on the controller. ``Program.start`` has
    no place in KRL: the robot starts from where it stands.

    A joint move to a pose without S and T is written without them: the controller then keeps the
    Status and turns the shortest way. As long as nothing before it has stated a configuration,
    that would be undefined, and the S and T are written that the emulator drives to.

    Args:
        robot: whose external axes and configurations they are.
        options: ``opaque`` (``keep``, ``comment``); see `KrlOptions`.

    Raises:
        InputError: an option is unknown, or the robot is no six-axis arm.
        MotionError: KRL cannot say a move; it is named by number.
    """
    return compose(program, robot, chosen(KrlOptions, options, "KRL writer"), TextAround())


def compose(
    program: Program, robot: Robot, options: KrlOptions, around: TextAround
) -> dict[str, str]:
    """As `write`, with what shall stand round the program's own statements."""
    if robot.arm_size != ARM_AXES:
        raise InputError(f"KRL drives arms of {ARM_AXES} axes; {robot.name} has {robot.arm_size}")
    module = module_name(program)
    data = DataList()
    phrases = Phrases(robot, data, stated_positions(program, robot))
    structure = Structure(phrases, module)
    lines = _Body(program, phrases, options, structure).lines()
    names = data.names(Names(NAME_RULES, [module, *structure.taken]))

    def texts(lines: Sequence[Line]) -> list[str]:
        named = ((names[p] if isinstance(p, NewDatum) else p for p in line) for line in lines)
        return ["".join(parts) for parts in named]

    declared = structure.declared()
    whole = [*around.header, *declared, *INI, "", *around.main(texts(lines))]
    further = [
        line
        for name, body in structure.routines.items()
        for line in ("", *structure.head(name), *texts(body), "END")
    ]
    return {
        f"{module}.src": source_text(f"{module}( )", whole, further),
        f"{module}.dat": _data(module, data, names),
    }


def module_name(program: Program) -> str:
    """The program's name, or one near to it that KRL takes."""
    return Names(NAME_RULES).claim(program.name, "PROG")


def source_text(routine: str, body: Sequence[str], further: Sequence[str] = ()) -> str:
    """A file with a routine, given by its name and parameters, and further ones of its own."""
    lines = [*HEADER, "&COMMENT Written by flyby", f"DEF {routine}", *body, "END", *further]
    return "\n".join(lines) + "\n"


def _data(module: str, data: DataList, names: dict[NewDatum, str]) -> str:
    lines = [*HEADER, f"DEFDAT {module}", *EXTERNALS, *data.lines(names), "ENDDAT"]
    return "\n".join(lines) + "\n"


class _Body:
    """The statements of a program, from the first to the last."""

    def __init__(
        self, program: Program, phrases: Phrases, options: KrlOptions, structure: Structure
    ) -> None:
        self._program = program
        self._phrases = phrases
        self._options = options
        self._structure = structure
        self._defined = False

    def lines(self) -> list[Line]:
        """All of them, each with what must be set before it."""
        return lines_of_statements(
            self._program,
            lambda wait: [(f"WAIT SEC {number(wait.duration)}",)],
            lambda opaque: self._opaque(opaque.text),
            self._move,
            self._structure if self._options.structure is StructureStyle.KEEP else None,
        )

    def _opaque(self, text: str) -> list[Line]:
        keep = self._options.opaque is OpaqueStyle.KEEP
        return [(line if keep else f"; {line}",) for line in lines_of(text)]

    def _move(self, move: Move, index: int, places: tuple[Destination, ...]) -> list[Line]:
        check_external(move.speed, self._phrases.robot)
        move = self._with_status(move, index)
        lines: list[Line] = []
        for variable, line in self._phrases.settings(move):
            if self._structure.held.get(variable) != line:
                self._structure.held[variable] = line
                lines.append(line)
        for event in move.events:
            lines += self._event(event, move)
        ahead, points = self._points(move, places)
        return [*ahead, *lines, self._phrases.motion(move, points)]

    def _points(
        self, move: Move, places: tuple[Destination, ...]
    ) -> tuple[list[Line], list[str | NewDatum]]:
        """Where loops and routines move a move on to, and the lines that put that together."""
        if all(place.fixed for place in places):
            return [], []
        ahead: list[Line] = []
        points: list[str | NewDatum] = []
        for number_, place in enumerate(places):
            passed = number_ > 0 or not isinstance(move, MoveJ)
            lines, point = self._structure.placed(place, number_, passed)
            ahead += lines
            points.append(point)
        return ahead, points

    def _event(self, event: Event, move: Move) -> list[Line]:
        if self._options.opaque is OpaqueStyle.COMMENT:
            return self._opaque(event.text)
        return [(trigger(event, move),)]

    def _with_status(self, move: Move, index: int) -> Move:
        """The move; S and T that the first one must state are found if it does not."""
        target = move.target
        if self._defined or not isinstance(move, MoveJ):
            return move
        self._defined = True
        if isinstance(target, JointTarget) or _defines(target):
            return move
        return replace(move, target=replace(target, configuration=self._found(move, index)))

    def _found(self, move: Move, index: int) -> KukaConfiguration | None:
        from ....core.motion.path.commanded_position import Standing

        robot = self._phrases.robot
        standing = Standing(robot, label, self._program.start)
        for earlier in self._program.moves[:index]:
            standing.moved(earlier)
        return label(robot, standing.solve(move))


def _defines(target: PoseTarget) -> bool:
    configuration = target.configuration
    if not isinstance(configuration, KukaConfiguration):
        return configuration is not None
    return configuration.status is not None and configuration.turn is not None
