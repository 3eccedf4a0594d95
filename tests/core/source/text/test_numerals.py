"""Decimals that come back as the same number."""

from __future__ import annotations

import math

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from flyby.core.source.text.numerals import nine_decimals, plain, shortest, with_decimals_of

FINITE = st.just(0.0) | st.floats(1e-12, 1e6) | st.floats(-1e6, -1e-12)
UNITS = [
    (lambda mm: mm / 1000, 1000.0),
    (math.radians, math.degrees(1)),
    (lambda percent: percent / 100, 100.0),
    (lambda same: same, 1.0),
]


@given(FINITE, st.sampled_from(UNITS))
@example(499881.7463813331, UNITS[2])  # its way to a share and back ends at another double
def test_what_a_reader_has_read_is_written_so_that_it_reads_it_again(written: float, unit) -> None:  # type: ignore[no-untyped-def]
    convert, back = unit
    value = convert(written)
    text = shortest(value, value * back, convert)
    assert convert(float(text)) == value
    assert len(text) <= len(plain(written)), "a decimal that was read is not made longer"


@given(FINITE, st.sampled_from(UNITS))
def test_any_number_comes_back_within_its_last_digits(value: float, unit) -> None:  # type: ignore[no-untyped-def]
    convert, back = unit
    text = shortest(value, value * back, convert)
    assert convert(float(text)) == pytest.approx(value, rel=1e-15, abs=1e-300)


@given(st.integers(-(10**7), 10**7), st.integers(0, 6))
def test_short_decimals_stay_short(digits: int, places: int) -> None:
    value = digits / 10**places
    text = shortest(value / 1000, value / 1000 * 1000, lambda mm: mm / 1000)
    assert float(text) == value
    assert len(text.strip("-").replace(".", "").strip("0")) <= len(str(abs(digits)))


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_plain_decimals_are_the_double_and_have_no_exponent(value: float) -> None:
    text = plain(value)
    assert float(text) == value
    assert set(text) <= set("-.0123456789")
    assert not text.endswith(".") and text != "-0"


@given(st.integers(-(2**53), 2**53))
def test_whole_numbers_have_no_point(value: int) -> None:
    assert plain(float(value)) == str(value)


@given(
    st.decimals(-9999, 9999, places=3).map(lambda d: f"{d:f}") | st.integers(-99, 99).map(str),
    st.floats(-1e4, 1e4).map(nine_decimals),
)
def test_a_changed_number_keeps_its_value_and_its_decimals(before: str, number: str) -> None:
    made = with_decimals_of(before, number)
    assert float(made) == float(number)
    assert made.startswith(number)
    least = len(before.partition(".")[2])
    assert len(made.partition(".")[2]) == max(least, len(number.partition(".")[2]))


@pytest.mark.parametrize(
    ("before", "number", "made"),
    [
        ("450.040", "0", "0.000"),
        (".000", "-10", "-10.000"),
        ("5.", "6", "6"),
        ("50", "72.5", "72.5"),
        ("1e3", "2000", "2000"),
        ("A1", "7", "7"),
        ("1.50", "1e-07", "1e-07"),
    ],
)
def test_the_way_of_writing_is_kept(before: str, number: str, made: str) -> None:
    assert with_decimals_of(before, number) == made
