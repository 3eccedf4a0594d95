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

from collections import defaultdict
from collections.abc import Iterator, Sequence
from contextlib import suppress

from ....core.errors import InputError, Span
from ....core.program.move import Move
from ....core.program.origin import Ownership
from ....core.program.program import Program
from ....core.program.zone import Fine
from ....core.source.patch.edits import Edit, alike, listed, patched, reading_of
from ....core.source.patch.uses import Kind, Use, uses
from ....core.source.reading import Files
from ....core.source.write.options import PatchOptions, Sharing
from ..syntax.tree import Aggregate, Name
from .additions import Additions
from .inplace import InPlace, Texts
from .places import Operand, Places
from .substitutes import Substitutes


def patch(program: Program, options: PatchOptions, axis_kinds: Sequence[str] = ()) -> Files:
    """The files of ``program`` with its targets, speeds and zones.

    Args:
        program: read from files, then changed.
        options: how.
        axis_kinds: ``"linear"`` or ``"rotating"`` for eax_a, eax_b, …, as for the reader.

    Returns:
        The files that changed, by name.

    Raises:
        FlybyError: a change has no place in the text, or the patched text is not read as
            ``program``.
    """
    reading = reading_of(program)
    before = reading.again({})
    parts = uses(before, program, _other_change)
    places = Places(reading.files)

    def attempt(in_place: tuple[Ownership, ...]) -> Files:
        edits = _Plan(parts, places, options, axis_kinds, in_place).edits()
        return patched(program, reading, edits)

    first, *others = _IN_PLACE[options.shared]
    try:
        return attempt(first)
    except InputError as error:
        for in_place in others:
            with suppress(InputError):
                return attempt(in_place)
        raise error


_LITERALS = (Ownership.OWNED, Ownership.SHARED)
_IN_PLACE: dict[Sharing, list[tuple[Ownership, ...]]] = {
    Sharing.REFUSE: [_LITERALS],
    # Where expressions read what was changed in place, the moves get data of their own.
    Sharing.OWN: [_LITERALS, (Ownership.OWNED,), ()],
}
"""Whose literals are changed where they stand: what is tried, in turn."""


class _Plan:
    """Finds the edits.

    Args:
        parts: all parts of all moves.
        places: the program's files.
        options: how.
        axis_kinds: of the external axes.
        in_place: whose literals may be changed where they stand.
    """

    def __init__(
        self,
        parts: Sequence[Use],
        places: Places,
        options: PatchOptions,
        axis_kinds: Sequence[str],
        in_place: tuple[Ownership, ...],
    ) -> None:
        self._changes = [use for use in parts if use.changes]
        self._places = places
        self._options = options
        self._in_place = in_place
        self._literals = InPlace(parts, places, axis_kinds)
        self._additions = Additions(places)
        self._substitutes = Substitutes(places, self._additions, axis_kinds)
        self._executions: defaultdict[tuple[Span, Kind], list[Use]] = defaultdict(list)
        for use in parts:
            self._executions[use.statement, use.kind].append(use)

    def edits(self) -> list[Edit]:
        """All edits.

        Raises:
            FlybyError: a change has no place.
        """
        found = [edit for use in self._changes for edit in self._edits_for(use)]
        return [*found, *self._additions.edits()]

    def _edits_for(self, use: Use) -> Iterator[Edit]:
        try:
            texts, against = self._in_literal(use)
            if texts is not None and not against and not self._stops_alone(use):
                yield from (Edit(span, text, use.index) for span, text in texts.items())
                return
            operand = self._places.operand(use.statement, use.origin.span)
            self._check_allowed(use, operand, against)
            self._check_executions(use)
            text = self._substitutes.text(use, operand)
        except InputError as error:
            raise use.error(str(error)) from None
        yield Edit(operand.span, text, use.index)

    def _in_literal(self, use: Use) -> tuple[Texts | None, list[int]]:
        """What its literal has to say, and the moves that are against it."""
        if use.origin.ownership not in self._in_place or not use.origin.numbers:
            return None, []
        texts = self._literals.changed(use)
        return texts, [] if texts is None else self._literals.against(use, texts)

    def _check_allowed(self, use: Use, operand: Operand, against: list[int]) -> None:
        """Refuse a new operand that the user has not asked for."""
        origin, options = use.origin, self._options
        if origin.ownership is Ownership.DERIVED:
            if options.derived is Sharing.REFUSE and not _plain_stop(operand):
                raise use.error(
                    "the program computes it, so there is no number to change: have a datum put "
                    "in the expression's place (--own; in Python derived=own), or leave it as it is"
                )
        elif against and options.shared is Sharing.REFUSE:
            datum = origin.datum or "the literal"
            raise use.error(
                f"{datum} is read by {listed(against)} as well, and that is to have another "
                "value: change them all alike, or give the move a datum of its own (--own; in "
                "Python shared=own)"
            )

    def _stops_alone(self, use: Use) -> bool:
        """``fine`` at the instruction says that its zone has become a stop; a datum need not."""
        return isinstance(use.new, Fine) and not self._dissenters(use)

    def _dissenters(self, use: Use) -> list[int]:
        """Moves of the same instruction that are to have another value."""
        return [
            other.index
            for other in self._executions[use.statement, use.kind]
            if not alike(other.new, use.new)
        ]

    def _check_executions(self, use: Use) -> None:
        """What stands at the move holds for all executions of the instruction."""
        others = self._dissenters(use)
        if others:
            raise use.error(
                "the instruction is executed several times, and a datum there would hold for "
                f"{listed(others)} too, which is to have another value: change them all alike, or "
                "none"
            )


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
