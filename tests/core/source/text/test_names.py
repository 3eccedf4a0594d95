"""Names that are legal, free, and as near to the wanted ones as they can be."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.source.text.names import NameRules, Names

FOLDING = NameRules(frozenset({"if", "do"}), longest=8)
STRICT = NameRules(frozenset({"if", "do"}), fold=str, legal=re.compile(r"[A-Za-z_]\w*", re.ASCII))

rules_of = st.sampled_from([FOLDING, STRICT])
wishes = st.lists(st.text(max_size=12) | st.text("aA_1 i", max_size=10), max_size=15)


@given(rules_of, wishes)
def test_every_name_is_legal_free_and_short_enough(rules: NameRules, wanted: list[str]) -> None:
    names = Names(rules, ["taken"])
    given_out = [names.claim(wish, "p") for wish in wanted]
    folded = [rules.fold(name) for name in given_out]
    assert len(set(folded)) == len(folded)
    assert not {*folded} & {"if", "do", "taken"}
    assert all(rules.legal.fullmatch(name) and len(name) <= rules.longest for name in given_out)


@given(rules_of, wishes)
def test_what_is_legal_and_free_is_kept(rules: NameRules, wanted: list[str]) -> None:
    names = Names(rules)
    known = set(rules.reserved)
    for wish in wanted:
        name = names.claim(wish, "p")
        legal = rules.legal.fullmatch(wish) and len(wish) <= rules.longest
        if legal and rules.fold(wish) not in known:
            assert name == wish
        known.add(rules.fold(name))


@pytest.mark.parametrize(
    ("rules", "wanted", "expected"),
    [
        (FOLDING, ["a", "A", "a"], ["a", "A_2", "a_3"]),
        (STRICT, ["a", "A", "a"], ["a", "A", "a_2"]),
        (FOLDING, ["IF", "do"], ["IF_2", "do_2"]),
        (STRICT, ["IF", "do"], ["IF", "do_2"]),
        (FOLDING, ["_a", "b_"], ["a", "b_"]),
        (STRICT, ["_a", "b_"], ["_a", "b_"]),
        (FOLDING, ["x[3].y", "ä", "", "3D"], ["x_3_y", "p", "p_2", "p_3D"]),
        (FOLDING, ["a" * 9, "a" * 8, "a" * 7], ["a" * 8, "aaaaaa_2", "a" * 7]),
        (STRICT, ["a" * 900], ["a" * 900]),
    ],
)
def test_names_near_to_the_wanted_ones(
    rules: NameRules, wanted: list[str], expected: list[str]
) -> None:
    names = Names(rules)
    assert [names.claim(wish, "p") for wish in wanted] == expected


def test_the_first_free_candidate_is_taken() -> None:
    names = Names(FOLDING, ["P1"])
    candidates = iter(["p1", "p2", "p3", "p4"])
    assert names.first_free(candidates) == "p2"
    assert names.claim("P3", "p") == "P3"
    assert names.first_free(candidates) == "p4"
    with pytest.raises(ValueError, match="no candidate"):
        names.first_free(candidates)
