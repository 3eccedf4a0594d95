"""A program in its cell: the parts that it carries, and how near all of it comes to the rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

from ...core.errors import InputError
from ..setup import Setup, start_of

if TYPE_CHECKING:
    from ...core.collision.clearance import MoveClearance
    from ...core.driving.driven_program import DrivenPart
    from ...core.errors import Note
    from ...core.handling.handling import Handling
    from ...core.program.program import Program
    from ...core.program.tool import Load
    from ...problems.improve.solution import Solution

Made = TypeVar("Made", bound="Solution")


@dataclass(frozen=True)
class CellCourse:
    """What a program does in its cell.

    Args:
        program: its moves carry the parts that are held.
        given: as it was read.
        setup: its robot and cell.
        handling: of the cell's parts; None for no cell, or one without parts.
        notes: what there is to say of the parts.
        counted: whether programs that are made of it may have other moves, not only as many.
    """

    program: Program
    given: Program
    setup: Setup
    handling: Handling | None = None
    notes: tuple[Note, ...] = ()
    counted: bool = False

    @classmethod
    def of(cls, program: Program, setup: Setup) -> CellCourse:
        """Follow the parts of the setup's cell through a program.

        Raises:
            InputError: a statement both takes a part and lets go of it, or a mesh cannot be used.
        """
        if setup.cell is None or not setup.cell.parts:
            return cls(program, program, setup)
        from ...core.handling.handling import handling_of
        from ...core.handling.loads import with_loads

        handling = handling_of(program, setup.cell, start_of(program))
        loaded, notes = with_loads(program, handling)
        return cls(loaded, program, setup, handling, (*handling.notes, *notes))

    @property
    def handled(self) -> tuple[int, ...]:
        """Indices of the moves at whose targets parts are taken or released."""
        return () if self.handling is None else self.handling.targets

    def loaded(self, program: Program) -> Program:
        """The program, changed, with the parts that it carries.

        Raises:
            InputError: its moves may be others, and its text does not say any more what takes a
                part.
        """
        if self.handling is None:
            return program
        if self.counted:
            made = CellCourse.of(program, self.setup)
            _check_taken(self.handling, made.handling)
            return made.program
        return _with_loads(program, [move.load for move in self.program.moves])

    def unloaded(self, program: Program) -> Program:
        """What `loaded` has made, without the parts."""
        if self.handling is None:
            return program
        pairs = list(zip(self.program.moves, self.given.moves, strict=True))
        if not self.counted:
            return _with_loads(program, [given.load for _, given in pairs])
        # Moves come and go, but none with a load of its own.
        known = {(loaded.tool, loaded.load): given.load for loaded, given in pairs}
        return _with_loads(
            program, [known.get((move.tool, move.load), move.load) for move in program.moves]
        )

    def given_back(self, found: Made) -> Made:
        """What an improvement of the loaded program found, without the parts."""
        program = self.unloaded(found.program) if found.changed else self.given
        notes = (*self.notes, *found.notes)
        return replace(found, original=self.given, program=program, notes=notes)

    def clearances(
        self, setup: Setup, parts: Sequence[DrivenPart]
    ) -> tuple[tuple[MoveClearance, ...], tuple[Note, ...]]:
        """How near each driven move comes, and what is not known of it; nothing without a cell.

        Raises:
            InputError: a mesh cannot be used.
        """
        if setup.cell is None:
            return (), ()
        from ...core.collision.clearance import ClearanceMeter

        meter = ClearanceMeter(setup.cell, self.program, self.handling)
        found = [move for part in parts for move in meter.over(part.run.path, part.first)]
        return tuple(found), tuple(meter.notes)


def _check_taken(given: Handling, made: Handling | None) -> None:
    """Both take the same parts, and let go of them, in the same order."""
    turns = [(change.name, change.taken) for change in given.changes]
    now = [] if made is None else [(change.name, change.taken) for change in made.changes]
    if turns != now:
        names = ", ".join(dict.fromkeys(name for name, taken in turns if (name, taken) not in now))
        raise InputError(
            f"written anew, the program does not say any more where {names or 'parts'} are taken "
            "or released: name a signal or a statement that it carries out as attach and release "
            "in the cell file, and no line"
        )


def _with_loads(program: Program, loads: Sequence[Load | None]) -> Program:
    moves = zip(program.moves, loads, strict=True)
    return program.with_moves(tuple(replace(move, load=load) for move, load in moves))
