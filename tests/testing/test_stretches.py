"""What a patch leaves of a text is found in its order, in time that grows with the text alone."""

from __future__ import annotations

import re

from hypothesis import given
from hypothesis import strategies as st

from flyby.testing.checks.patching import in_order

SHORT = st.text("ab\n", max_size=4)


@given(st.lists(SHORT, min_size=2, max_size=5), st.text("ab\n", max_size=14))
def test_pieces_in_order_are_what_the_pattern_finds(pieces: list[str], text: str) -> None:
    pattern = ".*?".join(map(re.escape, pieces))
    assert in_order(pieces, text) == bool(re.fullmatch(pattern, text, re.DOTALL))


@given(st.lists(SHORT, min_size=2, max_size=5), st.data())
def test_a_text_with_other_numbers_between_is_found(pieces: list[str], data: st.DataObject) -> None:
    between = [data.draw(SHORT) for _ in pieces[1:]]
    rest = (part for pair in zip(between, pieces[1:], strict=True) for part in pair)
    assert in_order(pieces, "".join([pieces[0], *rest]))
