"""Places of numbers that are looked for late are as the tuple of them."""

from __future__ import annotations

import pickle

from flyby.core.errors import Span
from flyby.core.program.origin import Spans

PLACES = (Span("a.mod", 1, 1, 0, 1), None, Span("a.mod", 1, 3, 2, 3))


def test_they_are_like_the_tuple_and_looked_for_once() -> None:
    asked = 0

    def find() -> tuple[Span | None, ...]:
        nonlocal asked
        asked += 1
        return PLACES

    spans = Spans(find)
    assert asked == 0
    assert spans == PLACES and spans == Spans(find) and spans != PLACES[1:]
    assert [PLACES].index(spans) == 0  # the tuple asked first
    assert hash(spans) == hash(PLACES) and len(spans) == 3 and spans[2] == PLACES[2]
    assert tuple(spans) == spans[:] == PLACES and repr(spans) == repr(PLACES)
    assert spans != list(PLACES) and bool(spans) and Spans(tuple) == ()
    assert asked == 2  # of two of them
    stored = pickle.loads(pickle.dumps(spans))
    assert type(stored) is tuple and stored == PLACES
