"""Which literals of the text a move's values were read from, and who else reads them.

A *source* is a literal that stands for a value unchanged: the initial value of a datum (or a part
of it), the value of an assignment, an argument at the move itself. Reading a datum through another
one keeps the source; computing with it loses it.

Ownership of a move's part follows from all reads of the run:

- *owned*: literals that this one executed move reads and nothing else;
- *shared*: a literal that several executed moves, or an expression elsewhere, read as well; and
  every predefined datum, which has no numbers in the text;
- *derived*: no source.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

from ...errors import Span
from ...program.origin import Origin, Ownership
from ..text.quick import quick

ELSEWHERE = -1
"""The reader that is no move."""


class Source(Protocol):
    """Where a value stands in the text."""

    @property
    def span(self) -> Span:
        """Of the literal."""
        ...

    @property
    def root(self) -> Span:
        """Of the literal that it is part of, or is."""
        ...

    @property
    def datum(self) -> str | None:
        """The datum it belongs to; None for a literal at the place of use."""
        ...

    @property
    def numbers(self) -> Sequence[Span | None]:
        """Its numbers, in the order of the vendor's own literal form: a tuple, or `Spans`."""
        ...


@quick(frozen=True, slots=True)
class MovePart:
    """A part of a move (target, speed, zone) before all reads are known.

    Args:
        span: of the expression at the move.
        sources: the literals that the part is made of: one datum, or one literal for each number
            where settings make it up (KRL's ``$VEL.CP``, URScript's arguments); none if the part
            is derived or predefined. None stands for a number that no literal states.
        predefined: name of the controller's own datum.
    """

    span: Span
    sources: tuple[Source | None, ...] = ()
    predefined: str | None = None


@dataclass
class Reads:
    """Every read of a literal during a run."""

    _whole: defaultdict[Span, set[int]] = field(default_factory=lambda: defaultdict(set))
    _inside: defaultdict[Span, set[tuple[int, int, int]]] = field(
        default_factory=lambda: defaultdict(set)
    )

    def by_move(self, source: Source, move: int) -> None:
        """A move takes its target, speed or zone from the literal as it stands."""
        self._whole[source.span].add(move)

    def by_expression(self, source: Source, reader: int) -> None:
        """An expression, of a move or `ELSEWHERE`, computes with the literal."""
        span = source.span
        self._inside[source.root].add((span.start, span.end, reader))

    def origin(self, part: MovePart, move: int) -> Origin:
        """The origin of a part of a move, when all reads are known."""
        if part.predefined is not None:
            return Origin(Ownership.SHARED, part.span, part.predefined)
        if not part.sources:
            return Origin(Ownership.DERIVED, part.span)
        first = part.sources[0]
        if first is not None and len(part.sources) == 1:
            own = Ownership.OWNED if self._alone(first, move) else Ownership.SHARED
            return Origin(own, part.span, first.datum, first.numbers)
        sources = [source for source in part.sources if source is not None]
        if not sources:
            return Origin(Ownership.DERIVED, part.span)
        alone = all(self._alone(source, move) for source in sources)
        numbers: list[Span | None] = []
        data: list[str | None] = []
        for source in part.sources:
            found = [None] if source is None else source.numbers
            numbers += found
            data += [None if source is None else source.datum] * len(found)
        return Origin(
            Ownership.OWNED if alone else Ownership.SHARED,
            part.span,
            None,
            tuple(numbers),
            tuple(data) if any(data) else (),
        )

    def _alone(self, source: Source, move: int) -> bool:
        return self._whole[source.span] == {move} and not self._read_inside(source, move)

    def _read_inside(self, source: Source, move: int) -> bool:
        reads = self._inside.get(source.root)
        if not reads:
            return False
        span = source.span
        return any(
            reader != move and start < span.end and span.start < end for start, end, reader in reads
        )
