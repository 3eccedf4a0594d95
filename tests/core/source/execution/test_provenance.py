"""Whose numbers a move's numbers are."""

from __future__ import annotations

from dataclasses import dataclass

from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import Span
from flyby.core.program.origin import Ownership
from flyby.core.source.execution.provenance import ELSEWHERE, MovePart, Reads


def span(start: int, end: int) -> Span:
    return Span("a.mod", 1, start + 1, start, end)


@dataclass(frozen=True)
class Literal:
    """A literal of the text; ``root`` is what it is part of."""

    span: Span
    root: Span
    datum: str | None = "p10"

    @property
    def numbers(self) -> tuple[Span | None, ...]:
        return (self.span, None)


AT = span(90, 93)
WHOLE = Literal(span(0, 10), span(0, 10))


def origin(reads: Reads, *sources: Literal | None, move: int = 0):  # type: ignore[no-untyped-def]
    return reads.origin(MovePart(AT, sources), move)


def test_without_a_source_a_part_is_derived() -> None:
    found = origin(Reads())
    assert (found.ownership, found.span, found.numbers) == (Ownership.DERIVED, AT, ())
    assert origin(Reads(), None, None).ownership is Ownership.DERIVED


def test_predefined_data_is_shared_and_has_no_numbers() -> None:
    found = Reads().origin(MovePart(AT, predefined="v100"), 0)
    assert (found.ownership, found.datum, found.numbers) == (Ownership.SHARED, "v100", ())


@given(st.lists(st.integers(0, 3), min_size=1, max_size=6))
def test_a_datum_is_owned_by_the_only_move_that_reads_it(moves: list[int]) -> None:
    reads = Reads()
    for move in moves:
        reads.by_move(WHOLE, move)
    alone = len(set(moves)) == 1
    found = origin(reads, WHOLE, move=moves[0])
    assert (found.ownership is Ownership.OWNED) == alone
    assert found.datum == "p10" and found.numbers == (WHOLE.span, None)


@given(
    st.tuples(st.integers(0, 9), st.integers(1, 10)).filter(lambda p: p[0] < p[1]),
    st.tuples(st.integers(0, 9), st.integers(1, 10)).filter(lambda p: p[0] < p[1]),
    st.sampled_from([0, 1, ELSEWHERE]),
)
def test_who_computes_with_a_part_of_it_shares_it(
    own: tuple[int, int], other: tuple[int, int], reader: int
) -> None:
    root = span(0, 10)
    mine, theirs = Literal(span(*own), root), Literal(span(*other), root)
    reads = Reads()
    reads.by_move(mine, 0)
    reads.by_expression(theirs, reader)
    overlap = own[0] < other[1] and other[0] < own[1]
    shared = overlap and reader != 0
    found = origin(reads, mine)
    assert (found.ownership is Ownership.SHARED) == shared


def test_other_literals_do_not_count() -> None:
    reads = Reads()
    reads.by_move(WHOLE, 0)
    elsewhere = Literal(span(20, 30), span(20, 30))
    reads.by_move(elsewhere, 1)
    reads.by_expression(elsewhere, ELSEWHERE)
    assert origin(reads, WHOLE).ownership is Ownership.OWNED


def test_a_part_of_several_literals_keeps_their_order_and_has_no_datum() -> None:
    first, second = Literal(span(0, 3), span(0, 3), "a"), Literal(span(5, 8), span(5, 8), "b")
    reads = Reads()
    reads.by_move(first, 0)
    reads.by_move(second, 0)
    found = origin(reads, first, None, second)
    assert found.numbers == (first.span, None, None, second.span, None)
    assert found.datum is None and found.ownership is Ownership.OWNED
    reads.by_move(second, 1)
    assert origin(reads, first, None, second).ownership is Ownership.SHARED
