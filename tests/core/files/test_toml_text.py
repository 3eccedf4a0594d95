"""What is written as TOML is read back as it was."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.files.toml_text import LINE, command_text, pair_text, value_text

WORDS = st.text(st.characters(exclude_categories=["Cs"]))
VALUES = st.recursive(
    WORDS
    | st.booleans()
    | st.integers(-(2**60), 2**60)
    | st.floats(allow_nan=False)
    | st.floats(allow_nan=False).map(np.float64)
    | st.dates()
    | st.times()
    | st.datetimes(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(WORDS, inner, max_size=3),
    max_leaves=6,
)


@given(VALUES)
def test_values(value: object) -> None:
    assert tomllib.loads(f"x = {value_text(value)}") == {"x": value}


@given(st.lists(WORDS | st.just(" --fit 'a b'")).map("".join))
def test_commands(command: str) -> None:
    assert tomllib.loads(f"x = {command_text(command)}") == {"x": command}


@given(WORDS, st.dictionaries(WORDS, VALUES, max_size=3))
def test_pairs(key: str, value: dict[str, object]) -> None:
    assert tomllib.loads(pair_text(key, value)) == {key: value}


def test_long_things_are_laid_over_lines() -> None:
    options = [f"--fit 'time.ramp_s[{k}]'" for k in range(4)]
    lines = command_text(" ".join(["flyby identify", *options])).splitlines()
    assert [line.strip(' \\"') for line in lines] == ["flyby identify", *options]
    pair = {"fitted": ["a" * 30, "b" * 30, "c" * 30], "by": "one"}
    assert len(pair_text("key", pair).splitlines()) == 5
    assert all(len(line) < LINE for line in pair_text("key", pair).splitlines())


def test_what_toml_does_not_know() -> None:
    with pytest.raises(InputError, match="None"):
        value_text([None])
