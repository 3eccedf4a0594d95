"""A program in its cell: the parts that it carries, and how near all of it comes to the rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ..setup import Setup, start_of

if TYPE_CHECKING:
    from ...core.collision.clearance import MoveClearance
    from ...core.driving.driven_program import DrivenPart
    from ...core.errors import Note
    from ...core.handling.handling import Handling
    from ...core.program.program import Program


@dataclass(frozen=True)
class CellCourse:
    """What a program does in its cell.

    Args:
        program: its moves carry the parts that are held.
        given: as it was read.
        handling: of the cell's parts; None for no cell, or one without parts.
        notes: what there is to say of the parts.
    """

    program: Program
    given: Program
    handling: Handling | None = None
    notes: tuple[Note, ...] = ()

    @classmethod
    def of(cls, program: Program, setup: Setup) -> CellCourse:
        """Follow the parts of the setup's cell through a program.

        Raises:
            InputError: a statement both takes a part and lets go of it, or a mesh cannot be used.
        """
        if setup.cell is None or not setup.cell.parts:
            return cls(program, program)
        from ...core.handling.handling import handling_of
        from ...core.handling.loads import with_loads

        handling = handling_of(program, setup.cell, start_of(program))
        loaded, notes = with_loads(program, handling)
        return cls(loaded, program, handling, (*handling.notes, *notes))

    @property
    def handled(self) -> tuple[int, ...]:
        """Indices of the moves at whose targets parts are taken or released."""
        if self.handling is None:
            return ()
        return tuple(i for i, names in enumerate(self.handling.behind) if names)

    def loaded(self, program: Program) -> Program:
        """The same moves, zones and speeds changed, with the parts that they carry."""
        return _with_loads_of(program, self.program)

    def unloaded(self, program: Program) -> Program:
        """What `loaded` has made, without the parts."""
        return _with_loads_of(program, self.given)

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


def _with_loads_of(program: Program, other: Program) -> Program:
    if program is other or len(program.moves) != len(other.moves):
        return program
    pairs = zip(program.moves, other.moves, strict=True)
    return program.with_moves(tuple(replace(move, load=like.load) for move, like in pairs))
