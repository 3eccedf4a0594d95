"""Which changes of a program are made where its numbers stand, and which need numbers of their own.

A literal is changed where it stands if all moves that read it are to have the same new value. Else
the change is refused, or, as the options say, the move gets numbers of its own: in a datum, in a
literal at the move, or in settings before it, as the language has it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Protocol

from ...door import switched
from ...errors import FlybyError, InputError, Span
from ...program.origin import Ownership
from ...program.program import Program
from ..reading import Files
from ..write.options import PatcherOptions, Sharing
from .edits import Edit, alike, listed, patched, reading_of
from .uses import OtherChange, Use, UseKind, uses

Texts = Mapping[Span, str]
"""What shall stand at a span."""
Said = Callable[[Use], object]


def _value(use: Use) -> object:
    return use.new


@dataclass(frozen=True, slots=True)
class Wish:
    """What the literals that a part of a move reads must say.

    Args:
        texts: at each place; what is not named may say what it likes.
        complete: whether the part has its value then.
    """

    texts: Texts
    complete: bool = True


class Literals(Protocol):
    """The numbers in a program's files, as its language has them."""

    def text(self, span: Span) -> str:
        """What stands at a place."""

    def wish(self, use: Use) -> Wish:
        """What the literals of a part must say.

        Raises:
            InputError: the language has no words for its value.
        """


class PatchPlan:
    """Finds what changes in place.

    Args:
        in_place: whose literals may be changed where they stand.
    """

    def __init__(
        self,
        parts: Sequence[Use],
        literals: Literals,
        options: PatcherOptions,
        in_place: Collection[Ownership],
    ) -> None:
        self.parts = parts
        self.changes = [use for use in parts if use.changes]
        self._literals = literals
        self._options = options
        self._changeable = in_place
        self._wishes: dict[tuple[int, UseKind], Wish] = {}
        self._readers: defaultdict[Span, list[Use]] = defaultdict(list)
        self._executions: defaultdict[tuple[Span, UseKind], list[Use]] = defaultdict(list)
        self._votes: dict[Span, dict[str, list[int]]] = {}
        for use in parts:
            self._executions[use.statement, use.kind].append(use)
            for span in set(filter(None, use.origin.numbers)):
                self._readers[span].append(use)

    def readers(self, span: Span) -> Sequence[Use]:
        """The parts that read a number."""
        return self._readers[span]

    def changeable(self, use: Use) -> bool:
        """Whether its literals may be changed where they stand, as far as their owner goes."""
        return use.origin.ownership in self._changeable

    def wish(self, use: Use) -> Wish:
        """What the literals of a part must say; see `Literals.wish`."""
        key = (use.index, use.kind)
        if key not in self._wishes:
            self._wishes[key] = self._literals.wish(use)
        return self._wishes[key]

    def texts(self, use: Use) -> Texts:
        """The part of its wish that the text does not say yet."""
        wanted = self.wish(use).texts
        return {span: text for span, text in wanted.items() if text != self._literals.text(span)}

    def against(self, use: Use) -> list[int]:
        """The moves that want one of its literals to say anything else."""
        return sorted(
            {
                move
                for span, text in self.texts(use).items()
                for other, moves in self._votes_on(span).items()
                if other != text
                for move in moves
            }
        )

    def dissenters(self, use: Use, said: Said = _value) -> list[int]:
        """Moves of the same instruction that are to have another value.

        Args:
            said: what of a part stands at the instruction.
        """
        return [
            other.index
            for other in self._executions[use.statement, use.kind]
            if not alike(said(other), said(use))
        ]

    def check_computed(self, offered: bool = True) -> None:
        """Refuse numbers of its own for what no literal states, if the user has not asked.

        Args:
            offered: whether the language can give it some.

        Raises:
            InputError: so it is.
        """
        if self._options.derived is Sharing.REFUSE:
            own = f"have the move get its own ({switched('own')}), or " if offered else ""
            raise InputError(
                "the program computes it, or no literal in its files states it, so there is no "
                f"number to change: {own}leave it as it is"
            )

    def check_shared(self, use: Use, against: Sequence[int], offered: bool = True) -> None:
        """Refuse numbers of its own for what others read too, if the user has not asked.

        Args:
            against: the moves that are to have another value; none where the literal does not
                state all of it.
            offered: whether the language can give it some.

        Raises:
            InputError: so it is.
        """
        if self._options.shared is Sharing.REFUSE:
            who = f"is read by {listed(against)} as well, and that is to have another value"
            names = {use.origin.datum, *use.origin.data} - {None}
            own = f"have the move get its own ({switched('own')})"
            raise InputError(
                f"{names.pop() if len(names) == 1 else 'the literal'} "
                f"{who if against else 'does not state all of it'}: change them all alike, or "
                f"{own if offered else 'write the program anew'}"
            )

    def check_executions(self, use: Use, said: Said = _value) -> None:
        """What stands at the move holds for all executions of the instruction.

        Args:
            said: what of a part stands at the instruction.

        Raises:
            InputError: one of them is to have another value.
        """
        others = self.dissenters(use, said)
        if others:
            raise InputError(
                "the instruction is executed several times, and what is put there would hold for "
                f"{listed(others)} too, which is to have another value: change them all alike, or "
                "none"
            )

    def _votes_on(self, span: Span) -> Mapping[str, Sequence[int]]:
        """What is to stand at a place, and which moves want it."""
        if span not in self._votes:
            votes: defaultdict[str, list[int]] = defaultdict(list)
            for use in self._readers[span]:
                text = self.wish(use).texts.get(span)
                if text is not None:
                    votes[text].append(use.index)
            self._votes[span] = votes
        return self._votes[span]


_LITERALS = (Ownership.OWNED, Ownership.SHARED)
_IN_PLACE: dict[Sharing, list[tuple[Ownership, ...]]] = {
    Sharing.REFUSE: [_LITERALS],
    # Where expressions read what was changed in place, the moves get numbers of their own.
    Sharing.OWN: [_LITERALS, (Ownership.OWNED,), ()],
}
"""Whose literals are changed where they stand: what is tried, in turn."""


def patch_program(
    program: Program,
    options: PatcherOptions,
    literals: Literals,
    edits: Callable[[PatchPlan], Iterable[Edit]],
    other_change: OtherChange = lambda old, new: None,
) -> Files:
    """The files of a program with its targets, speeds and zones, every other byte kept.

    Args:
        program: read from files, then changed.
        edits: what a plan comes to in the language.
        other_change: what the language cannot change at a move, beside what none can.

    Returns:
        The files that changed, by name.

    Raises:
        FlybyError: a change has no place in the text, or the patched text is not read as
            ``program``: of the first attempt, if none succeeds.
    """
    reading = reading_of(program)
    parts = uses(reading.again({}), program, other_change)

    def attempt(in_place: Collection[Ownership], parts: Sequence[Use] = parts) -> Files:
        return patched(program, reading, edits(PatchPlan(parts, literals, options, in_place)))

    # What the program computes of changed numbers may come out as it is to be by itself.
    stated = [u for u in parts if not (u.changes and u.origin.ownership is Ownership.DERIVED)]
    if len(stated) < len(parts):
        with suppress(FlybyError):
            return attempt(_LITERALS, stated)
    first, *others = _IN_PLACE[options.shared]
    try:
        return attempt(first)
    except FlybyError as error:
        for in_place in others:
            with suppress(FlybyError):
                return attempt(in_place)
        raise error
