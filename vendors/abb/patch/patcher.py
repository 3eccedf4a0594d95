"""A changed program → the user's own RAPID files with its numbers, every other byte kept.

What is changed where:

- Numbers that one move alone reads are changed where they stand, in a datum or at the move.
- A datum that several moves read is changed if all of them are to have the same new value; else
  the change is refused, or, under ``shared=own``, the move gets a datum of its own.
- A zone that becomes a stop becomes ``fine`` at the move.
- The controller's own data (``z10``, ``v500``) have no numbers in the text: at the move, another
  name takes the name's place, or ``z10\\Z:=12``, or a new datum.
- What an expression computes (``Offs(p10,0,0,50)``) is refused, or, under ``derived=own``, a new
  datum takes the expression's place, if all executions of the instruction get the same value.

New data are ``LOCAL CONST`` beside those of the same type in the module of the move.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ....core.errors import InputError
from ....core.program.move import Move
from ....core.program.origin import Ownership
from ....core.program.program import Program
from ....core.program.zone import Fine
from ....core.source.patch.edits import Edit, alike, reading_of
from ....core.source.patch.plan import PatchPlan, patch_program
from ....core.source.patch.uses import Use
from ....core.source.reading import Files
from ....core.source.write.options import PatcherOptions
from ..syntax.tree import Aggregate, Name
from .additions import Additions
from .inplace import RapidLiterals
from .places import Operand, Places
from .substitutes import Substitutes


def patch(program: Program, options: PatcherOptions, axis_kinds: Sequence[str] = ()) -> Files:
    """The program's files with its numbers; see `core.source.patch.plan.patch_program`.

    Args:
        axis_kinds: ``"linear"`` or ``"rotating"`` for eax_a, eax_b, …, as for the reader.
    """
    places = Places(reading_of(program).files)
    literals = RapidLiterals(places, axis_kinds)

    def edits(plan: PatchPlan) -> list[Edit]:
        return _Edits(plan, places, axis_kinds).all()

    return patch_program(program, options, literals, edits, _other_change)


class _Edits:
    """Finds the edits."""

    def __init__(self, plan: PatchPlan, places: Places, axis_kinds: Sequence[str]) -> None:
        self._plan = plan
        self._places = places
        self._additions = Additions(places)
        self._substitutes = Substitutes(places, self._additions, axis_kinds)

    def all(self) -> list[Edit]:
        """All edits.

        Raises:
            FlybyError: a change has no place.
        """
        found = [edit for use in self._plan.changes for edit in self._edits_for(use)]
        return [*found, *self._additions.edits()]

    def _edits_for(self, use: Use) -> Iterator[Edit]:
        plan = self._plan
        try:
            possible = plan.changeable(use) and plan.wish(use).complete
            against = plan.against(use) if possible else []
            if possible and not against and not self._stops_alone(use):
                for span, text in plan.texts(use).items():
                    yield Edit(span, text, use.index)
                return
            operand = self._places.operand(use.statement, use.origin.span)
            if use.origin.ownership is Ownership.DERIVED and not _plain_stop(operand):
                plan.check_computed()
            elif against:
                plan.check_shared(use, against)
            plan.check_executions(use)
            text = self._substitutes.text(use, operand)
        except InputError as error:
            raise use.error(str(error)) from None
        yield Edit(operand.span, text, use.index)

    def _stops_alone(self, use: Use) -> bool:
        """``fine`` at the instruction says that its zone has become a stop; a datum need not."""
        return isinstance(use.new, Fine) and not self._plan.dissenters(use)


_SETTINGS = ("tcp_acceleration", "joint_acceleration_fraction", "jerk_fraction")
"""Parts of a speed that instructions of their own set (AccSet, PathAccLim)."""


def _other_change(old: Move, new: Move) -> str | None:
    for name in _SETTINGS:
        if not alike(getattr(old.speed, name), getattr(new.speed, name)):
            return f"speed ({name.replace('_', ' ')})"
    return None


def _plain_stop(operand: Operand) -> bool:
    r"""``z10\Inpos:=inpos50``: a stop point whatever the zone is, and nothing computed."""
    return operand.option("inpos") is not None and isinstance(operand.expression, Name | Aggregate)
